//! Pixel formats of the line buffer, byte order included (K12).

/// How a pixel looks in the line buffer.
pub trait PixelFormat {
    /// One pixel.
    type Word: Copy + Send + Sync + PartialEq + Default + 'static;
    /// Steps a channel above 0: 255 for 8 bits.
    const STEPS: [u16; 3];

    /// A pixel from whole steps, each at most [`STEPS`](PixelFormat::STEPS).
    fn pack(steps: [u8; 3]) -> Self::Word;

    /// A pixel from 8-bit levels, rounded to nearest.
    fn from_rgb8(rgb: [u8; 3]) -> Self::Word {
        let mut steps = [0; 3];
        for i in 0..3 {
            steps[i] = ((u32::from(rgb[i]) * u32::from(Self::STEPS[i]) + 127) / 255) as u8;
        }
        Self::pack(steps)
    }

    /// The 8-bit levels a display shows for a pixel, rounded to nearest.
    fn to_rgb8(word: Self::Word) -> [u8; 3];
}

/// Three bytes, red first.
#[derive(Clone, Copy, Debug)]
pub struct Rgb888;

/// Five, six and five bits as a 16-bit number, for parallel buses and frame buffers.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565;

/// Five, six and five bits as two bytes, high byte first, for SPI panels.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Be;

/// Five, six and five bits as two bytes, low byte first.
#[derive(Clone, Copy, Debug)]
pub struct Rgb565Le;

impl PixelFormat for Rgb888 {
    type Word = [u8; 3];
    const STEPS: [u16; 3] = [255; 3];

    #[inline(always)]
    fn pack(steps: [u8; 3]) -> [u8; 3] {
        steps
    }

    fn to_rgb8(word: [u8; 3]) -> [u8; 3] {
        word
    }
}

impl PixelFormat for Rgb565 {
    type Word = u16;
    const STEPS: [u16; 3] = [31, 63, 31];

    #[inline(always)]
    fn pack(s: [u8; 3]) -> u16 {
        u16::from(s[0]) << 11 | u16::from(s[1]) << 5 | u16::from(s[2])
    }

    fn to_rgb8(word: u16) -> [u8; 3] {
        let scale = |v: u16, steps: u16| {
            ((u32::from(v) * 510 + u32::from(steps)) / (2 * u32::from(steps))) as u8
        };
        [
            scale(word >> 11, 31),
            scale(word >> 5 & 63, 63),
            scale(word & 31, 31),
        ]
    }
}

impl PixelFormat for Rgb565Be {
    type Word = [u8; 2];
    const STEPS: [u16; 3] = Rgb565::STEPS;

    #[inline(always)]
    fn pack(s: [u8; 3]) -> [u8; 2] {
        Rgb565::pack(s).to_be_bytes()
    }

    fn to_rgb8(word: [u8; 2]) -> [u8; 3] {
        Rgb565::to_rgb8(u16::from_be_bytes(word))
    }
}

impl PixelFormat for Rgb565Le {
    type Word = [u8; 2];
    const STEPS: [u16; 3] = Rgb565::STEPS;

    #[inline(always)]
    fn pack(s: [u8; 3]) -> [u8; 2] {
        Rgb565::pack(s).to_le_bytes()
    }

    fn to_rgb8(word: [u8; 2]) -> [u8; 3] {
        Rgb565::to_rgb8(u16::from_le_bytes(word))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn formats_round_trip_and_keep_their_bytes() {
        for word in 0..=u16::MAX {
            assert_eq!(Rgb565::from_rgb8(Rgb565::to_rgb8(word)), word);
        }
        assert_eq!(Rgb565Be::from_rgb8([255, 0, 0]), [0xF8, 0x00]);
        assert_eq!(Rgb565Le::from_rgb8([255, 0, 0]), [0x00, 0xF8]);
        assert_eq!(Rgb565Be::to_rgb8([0x07, 0xE0]), [0, 255, 0]);
        assert_eq!(Rgb888::from_rgb8([1, 2, 3]), [1, 2, 3]);
    }
}
