//! What is painted over a finished line: runs and sprites, for a HUD, cursors, tiles (K14).
//!
//! An [`Overlay`] is a lent slice of sprites sorted by their first line, so a line looks only at
//! those that have begun and not all ended, and a line above, between or below them at one:
//! besides, a HUD costs its own pixels. Nothing is read back but by what is additive.

use crate::pixel::PixelFormat;

/// How the pixels of a sprite meet those below.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Ink<W> {
    /// They replace them.
    #[default]
    Opaque,
    /// They replace them, but for pixels of this word, which are left out.
    Keyed(W),
    /// They are added, and each channel stops at its full light.
    Additive,
}

/// The pixels of a sprite.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Pixels<'s, W> {
    /// Lines from top to bottom without gaps; lines that are not there are left out.
    Image(&'s [W]),
    /// One colour: a run, a bar, a box.
    Colour(W),
}

/// A rectangle of pixels somewhere on the picture, or partly or wholly beside it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sprite<'s, W> {
    /// The leftmost column, from the picture's left edge.
    pub x: i16,
    /// The topmost line, from the picture's top.
    pub y: i16,
    /// Columns.
    pub width: u16,
    /// Lines.
    pub height: u16,
    /// What is in it.
    pub pixels: Pixels<'s, W>,
    /// How it meets what is below.
    pub ink: Ink<W>,
}

impl<W: Copy + PartialEq> Sprite<'_, W> {
    /// The line after the last.
    #[inline]
    const fn end(&self) -> i32 {
        self.y as i32 + self.height as i32
    }

    /// Paints what there is on a line.
    fn paint<F: PixelFormat<Word = W>>(&self, line: i32, pixels: &mut [W]) {
        let (row, x) = (line - i32::from(self.y), i32::from(self.x));
        if row < 0 || row >= i32::from(self.height) {
            return;
        }
        // Columns beyond the left edge are skipped, those beyond the right one cut off.
        let skipped = (-x).max(0) as usize;
        let Some(below) = pixels.get_mut(x.max(0) as usize..) else {
            return;
        };
        let Some(count) = usize::from(self.width).checked_sub(skipped) else {
            return;
        };
        let count = count.min(below.len());
        let below = &mut below[..count];
        match self.pixels {
            Pixels::Colour(word) => match self.ink {
                Ink::Keyed(key) if key == word => {}
                Ink::Opaque | Ink::Keyed(_) => F::fill(below, word),
                Ink::Additive => below
                    .iter_mut()
                    .for_each(|pixel| *pixel = F::add(*pixel, word)),
            },
            Pixels::Image(image) => {
                let mut lines = image.chunks_exact(usize::from(self.width).max(1));
                let line = lines.nth(row as usize);
                let Some(above) = line.and_then(|line| line.get(skipped..skipped + count)) else {
                    return;
                };
                let pairs = below.iter_mut().zip(above);
                match self.ink {
                    Ink::Opaque => below.copy_from_slice(above),
                    Ink::Keyed(key) => pairs.for_each(|(pixel, word)| {
                        if *word != key {
                            *pixel = *word;
                        }
                    }),
                    Ink::Additive => {
                        pairs.for_each(|(pixel, word)| *pixel = F::add(*pixel, *word));
                    }
                }
            }
        }
    }
}

/// A sprite begins above the one before it in the slice.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct UnsortedSprites {
    /// Its place in the slice.
    pub index: usize,
}

impl core::fmt::Display for UnsortedSprites {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "overlay: sprite {} begins above the one before it",
            self.index
        )
    }
}

impl core::error::Error for UnsortedSprites {}

/// Sprites over a picture, sorted by their first lines; where two meet, the later one is on top.
///
/// Lines may be painted in any order; downwards is fast.
///
/// ```
/// use scanbeam::overlay::{Ink, Overlay, Pixels, Sprite};
/// use scanbeam::pixel::Rgb565;
///
/// // A bar of 3 x 2 pixels, and a cross whose corners let the picture through.
/// let cross = [0, 7, 0, 7, 7, 7, 0, 7, 0];
/// let sprites = [
///     Sprite { x: 1, y: 0, width: 3, height: 2, pixels: Pixels::Colour(9), ink: Ink::Opaque },
///     Sprite { x: 0, y: 1, width: 3, height: 3, pixels: Pixels::Image(&cross), ink: Ink::Keyed(0) },
/// ];
/// let mut overlay = Overlay::<Rgb565>::new(&sprites)?;
/// let mut picture = [[1; 5]; 4];
/// for (line, pixels) in picture.iter_mut().enumerate() {
///     overlay.paint(line as u16, pixels);
/// }
/// assert_eq!(picture, [
///     [1, 9, 9, 9, 1],
///     [1, 7, 9, 9, 1],
///     [7, 7, 7, 1, 1],
///     [1, 7, 1, 1, 1],
/// ]);
/// # Ok::<(), scanbeam::overlay::UnsortedSprites>(())
/// ```
#[derive(Debug)]
pub struct Overlay<'o, F: PixelFormat> {
    sprites: &'o [Sprite<'o, F::Word>],
    /// Those before this one have ended above `line`.
    first: usize,
    /// Those before this one begin on or above `line`.
    begun: usize,
    line: i32,
}

impl<'o, F: PixelFormat> Overlay<'o, F> {
    /// Over these sprites.
    ///
    /// # Errors
    /// When they are not sorted by their first lines.
    pub fn new(sprites: &'o [Sprite<'o, F::Word>]) -> Result<Self, UnsortedSprites> {
        if let Some(before) = sprites.windows(2).position(|pair| pair[1].y < pair[0].y) {
            return Err(UnsortedSprites { index: before + 1 });
        }
        Ok(Self {
            sprites,
            first: 0,
            begun: 0,
            line: 0,
        })
    }

    /// Paints over `line` of the picture, all of whose pixels are there, before it is sent.
    pub fn paint(&mut self, line: u16, pixels: &mut [F::Word]) {
        let line = i32::from(line);
        if line < self.line {
            (self.first, self.begun) = (0, 0);
        }
        self.line = line;
        let begins = |sprite: &Sprite<'_, F::Word>| i32::from(sprite.y) <= line;
        while self.sprites.get(self.begun).is_some_and(begins) {
            self.begun += 1;
        }
        let Some(begun) = self.sprites.get(self.first..self.begun) else {
            return;
        };
        let ended = begun.iter().take_while(|sprite| sprite.end() <= line);
        let ended = ended.count();
        self.first += ended;
        for sprite in &begun[ended..] {
            sprite.paint::<F>(line, pixels);
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::{Grey8, Rgb565, Rgb565Be, Rgb888, Xrgb8888};
    use std::{vec, vec::Vec};

    struct Rng(u32);

    impl Rng {
        fn below(&mut self, n: u32) -> u32 {
            self.0 = self.0.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((u64::from(self.0) * u64::from(n)) >> 32) as u32
        }
    }

    /// Every pixel of every sprite, one by one, over a whole picture.
    fn naive(picture: &mut [Vec<u16>], sprites: &[Sprite<'_, u16>], add: impl Fn(u16, u16) -> u16) {
        for sprite in sprites {
            for row in 0..i32::from(sprite.height) {
                for column in 0..i32::from(sprite.width) {
                    let index = (row * i32::from(sprite.width) + column) as usize;
                    let word = match sprite.pixels {
                        Pixels::Colour(word) => word,
                        Pixels::Image(image) => image[index],
                    };
                    let (x, y) = (i32::from(sprite.x) + column, i32::from(sprite.y) + row);
                    let (Ok(x), Ok(y)) = (usize::try_from(x), usize::try_from(y)) else {
                        continue;
                    };
                    let Some(pixel) = picture.get_mut(y).and_then(|line| line.get_mut(x)) else {
                        continue;
                    };
                    *pixel = match sprite.ink {
                        Ink::Opaque => word,
                        Ink::Keyed(key) if word == key => *pixel,
                        Ink::Keyed(_) => word,
                        Ink::Additive => add(*pixel, word),
                    };
                }
            }
        }
    }

    /// Steps of 565, one channel after the other.
    fn added(a: u16, b: u16) -> u16 {
        let channel = |at: u32, most: u16| ((a >> at & most) + (b >> at & most)).min(most) << at;
        channel(11, 31) | channel(5, 63) | channel(0, 31)
    }

    /// Kills: a line of an image, the end of which is not there, painted where the end is not seen.
    #[test]
    fn a_line_that_is_not_whole_is_left_out_wherever_it_is_cut() {
        for x in [0, 1, 2] {
            let sprites = [Sprite {
                x,
                y: 0,
                width: 3,
                height: 2,
                pixels: Pixels::Image(&[1, 2, 3, 5, 6]),
                ink: Ink::Opaque,
            }];
            let mut line = [9; 3];
            let mut overlay = Overlay::<Rgb565>::new(&sprites).unwrap();
            overlay.paint(1, &mut line);
            assert_eq!(line, [9; 3]);
            overlay.paint(0, &mut line);
            assert_eq!(line[x as usize], 1);
        }
    }

    #[test]
    fn lines_are_those_of_a_whole_picture_painted_naively() {
        let mut rng = Rng(3);
        for _ in 0..400 {
            let (width, height) = (1 + rng.below(40) as usize, 1 + rng.below(30) as usize);
            let image: Vec<u16> = (0..24 * 24).map(|_| rng.below(9) as u16 * 0x1C73).collect();
            let mut sprites: Vec<Sprite<'_, u16>> = (0..rng.below(12))
                .map(|_| Sprite {
                    x: rng.below(70) as i16 - 20,
                    y: rng.below(60) as i16 - 20,
                    width: rng.below(25) as u16,
                    height: rng.below(25) as u16,
                    pixels: match rng.below(2) {
                        0 => Pixels::Image(&image),
                        _ => Pixels::Colour(rng.below(0x1_0000) as u16),
                    },
                    ink: match rng.below(3) {
                        0 => Ink::Opaque,
                        1 => Ink::Keyed(0x1C73),
                        _ => Ink::Additive,
                    },
                })
                .collect();
            sprites.sort_by_key(|sprite| sprite.y);
            let mut expected = vec![vec![0x8410; width]; height];
            let mut painted = expected.clone();
            naive(&mut expected, &sprites, added);
            let mut overlay = Overlay::<Rgb565>::new(&sprites).unwrap();
            for (line, pixels) in painted.iter_mut().enumerate() {
                overlay.paint(line as u16, pixels);
            }
            assert_eq!(painted, expected);
            // In any order.
            for _ in 0..10 {
                let line = rng.below(height as u32) as usize;
                let mut pixels = vec![0x8410; width];
                overlay.paint(line as u16, &mut pixels);
                assert_eq!(pixels, expected[line]);
            }
        }
    }

    #[test]
    fn extreme_places_and_short_images_are_left_out() {
        let image = [5; 7];
        let at = |x, y, width, height| Sprite {
            x,
            y,
            width,
            height,
            pixels: Pixels::Image(&image),
            ink: Ink::Opaque,
        };
        let sprites = [
            at(i16::MIN, i16::MIN, u16::MAX, u16::MAX),
            at(i16::MIN, -3, u16::MAX, 9),
            at(2, 0, 3, u16::MAX),
            at(i16::MAX, 0, u16::MAX, 9),
            at(0, i16::MAX, 1, u16::MAX),
        ];
        let mut overlay = Overlay::<Rgb565>::new(&sprites).unwrap();
        let mut lines = [[0; 4]; 4];
        for (line, pixels) in lines.iter_mut().enumerate() {
            overlay.paint(line as u16, pixels);
        }
        // Two whole lines of the third sprite are there, cut at the right edge.
        assert_eq!(lines, [[0, 0, 5, 5], [0, 0, 5, 5], [0; 4], [0; 4]]);
        overlay.paint(u16::MAX, &mut []);
        let unsorted = [at(0, 1, 1, 1), at(0, 0, 1, 1)];
        let refused = Overlay::<Rgb565>::new(&unsorted).err();
        assert_eq!(refused, Some(UnsortedSprites { index: 1 }));
    }

    #[test]
    fn sums_saturate_in_every_format() {
        // All pairs of all steps of each channel, in each of them.
        for a in 0..64u16 {
            for b in 0..64u16 {
                let words = |c: u16| {
                    [
                        (c & 31) << 11,
                        c << 5,
                        c & 31,
                        ((c & 31) * 0x801) | (c << 5),
                    ]
                };
                for (a, b) in words(a).into_iter().zip(words(b)) {
                    assert_eq!(Rgb565::add(a, b), added(a, b), "{a:04x} {b:04x}");
                    let be = Rgb565Be::add(a.to_be(), b.to_be());
                    assert_eq!(be, added(a, b).to_be());
                }
            }
        }
        for a in 0..=255u8 {
            for b in 0..=255u8 {
                let sum = a.saturating_add(b);
                assert_eq!(Rgb888::add([a, b, 0], [b, a, 255]), [sum, sum, 255]);
                assert_eq!(Grey8::add(a, b), sum);
                let [wide, other] = [[a, b, a], [b, a, b]].map(Xrgb8888::pack);
                assert_eq!(Xrgb8888::add(wide, other), Xrgb8888::pack([sum; 3]));
            }
        }
    }
}
