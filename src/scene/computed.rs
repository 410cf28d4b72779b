//! Textures that are computed where they are shown (H17): no memory at all.
//!
//! A [`Texture`](super::Texture) of them asks once a run of a span, through a pointer: textures that lie in memory pay
//! nothing, and a program that names none has none of the code.

/// Texels that are asked for: computed, or fetched from somewhere.
///
/// One core or two may ask at once, so whatever it keeps in itself is atomic.
///
/// ```
/// use scanbeam::scene::{Texels, Texture};
///
/// /// Rings about the middle of 64 x 64 texels.
/// struct Rings([u16; 2]);
///
/// impl Texels for Rings {
///     fn texel(&self, column: u16, row: u16) -> u16 {
///         let [x, y] = [column, row].map(|at| i32::from(at) - 32);
///         self.0[((x * x + y * y) >> 7) as usize & 1]
///     }
/// }
///
/// static RINGS: Rings = Rings([0xF800, 0xFFFF]);
/// static TARGET: Texture = match Texture::computed(&RINGS, 64, 64) {
///     Ok(texture) => texture,
///     Err(_) => panic!("64 x 64 texels"),
/// };
/// ```
pub trait Texels: Sync {
    /// The word of the panel, in its byte order, of the texel in a column and row; both are below the sides that the
    /// texture was made with.
    fn texel(&self, column: u16, row: u16) -> u16;

    /// The texels of a run of pixels, each at a place of `way`. Where the exact place of each pixel is found alone, and
    /// where four texels are mixed, [`texel`](Self::texel) is asked instead.
    fn fetch(&self, run: &mut [u16], way: TexelWay) {
        for (pixel, [column, row]) in run.iter_mut().zip(way) {
            *pixel = self.texel(column, row);
        }
    }
}

impl core::fmt::Debug for dyn Texels + '_ {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str("Texels")
    }
}

/// Columns and rows of the texels on a straight way over a texture, one for each pixel, without an end. What lies beyond
/// the sides is within them, as the texture's wrap says.
#[derive(Clone, Copy, Debug)]
pub struct TexelWay {
    /// To the right and down: the place of the next pixel and the step from there, in 2^-32 of a side.
    pub(crate) ways: [[u32; 2]; 2],
    /// Fraction bits of columns and of rows.
    pub(crate) fraction: [u8; 2],
}

impl TexelWay {
    /// From fractions of sides that are these powers of two.
    #[inline(always)]
    pub(crate) fn new(u: [u32; 2], v: [u32; 2], [log_width, log_height]: [u32; 2]) -> Self {
        // A side of one texel has no bits: nothing is shifted by 32.
        let side = |way, log: u32| match log {
            0 => ([0; 2], 0),
            log => (way, 32 - log as u8),
        };
        let ((u, right), (v, down)) = (side(u, log_width), side(v, log_height));
        Self {
            ways: [u, v],
            fraction: [right, down],
        }
    }
}

impl Iterator for TexelWay {
    type Item = [u16; 2];

    #[inline(always)]
    fn next(&mut self) -> Option<[u16; 2]> {
        let place = [0, 1].map(|i| (self.ways[i][0] >> (self.fraction[i] & 31)) as u16);
        for [at, step] in &mut self.ways {
            *at = at.wrapping_add(*step);
        }
        Some(place)
    }
}

/// Squares of two colours in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Checker {
    /// Words of the panel, in its byte order; the first one's square lies at column and row 0.
    pub colours: [u16; 2],
    /// A square's side is 2 to the power of this texels, 0 to 15.
    pub log_side: u8,
}

impl Texels for Checker {
    #[inline(always)]
    fn texel(&self, column: u16, row: u16) -> u16 {
        self.colours[usize::from((column ^ row) >> (self.log_side & 15) & 1)]
    }
}

/// A colour that goes evenly from one to another along the columns, and back again.
#[derive(Clone, Copy, Debug)]
pub struct Gradient {
    /// Red, green and blue before the first column.
    pub from: [u8; 3],
    /// Red, green and blue behind column `2^log_length - 1`.
    pub to: [u8; 3],
    /// 2 to the power of this columns from one to the other, 0 to 11. A texture of twice as many columns shows the way
    /// back too.
    pub log_length: u8,
    /// What makes a word of the panel of a colour: [`from_rgb8`](crate::pixel::PixelFormat::from_rgb8) of its format.
    pub word: fn([u8; 3]) -> u16,
}

impl Texels for Gradient {
    fn texel(&self, column: u16, _: u16) -> u16 {
        // 8 bits of the way to the middle of the column, and the bit above them, which turns it round.
        let way = (2 * u32::from(column) + 1) << 7 >> self.log_length.min(11);
        let part = if way & 256 == 0 { way } else { !way } & 255;
        // 255 is all of it.
        let part = (part + (part >> 7)) as i32;
        (self.word)([0, 1, 2].map(|i| {
            let (a, b) = (i32::from(self.from[i]), i32::from(self.to[i]));
            (a + (((b - a) * part + 128) >> 8)) as u8
        }))
    }

    /// A column's word is made once for all texels of it that follow each other.
    fn fetch(&self, run: &mut [u16], way: TexelWay) {
        let mut last = None;
        for (pixel, [column, row]) in run.iter_mut().zip(way) {
            *pixel = match last {
                Some((same, word)) if same == column => word,
                _ => self.texel(column, row),
            };
            last = Some((column, *pixel));
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// Kills: a fraction of `31 - log` bits, rows by the fraction of columns, a step of v for u; a shift by 32.
    #[test]
    fn ways_go_through_the_texels_of_a_line_in_real_numbers() {
        let mut rng = Rng(1);
        for _ in 0..4000 {
            let logs = [rng.below(11), rng.below(11)];
            let [u, v] = [(); 2].map(|()| [rng.bits(), rng.bits()]);
            let drawn: Vec<_> = TexelWay::new(u, v, logs).take(40).collect();
            for (n, texel) in drawn.iter().enumerate() {
                let want = [u, v].map(|[at, step]| {
                    // Of the period, in 64 bits that no place leaves.
                    (u64::from(at) + n as u64 * u64::from(step)) % (1 << 32)
                });
                for axis in 0..2 {
                    let want = (want[axis] as f64 / 4_294_967_296.0) * f64::from(1 << logs[axis]);
                    assert_eq!(f64::from(texel[axis]), want.floor(), "{logs:?} {n}");
                }
            }
        }
    }

    /// Kills: squares of half the side, the other colour first, columns alone.
    #[test]
    fn squares_alternate_both_ways() {
        let checker = Checker {
            colours: [b'.'.into(), b'#'.into()],
            log_side: 2,
        };
        let row = |row: u16| -> std::string::String {
            (0..12)
                .map(|column| char::from(checker.texel(column, row) as u8))
                .collect()
        };
        assert_eq!(row(3), "....####....");
        assert_eq!(row(4), "####....####");
    }

    /// Against real numbers: within 1/2 level of rounding and 1/256 of the way.
    ///
    /// Kills: the place at the column's rim, a way that is not turned round, parts of 255.
    #[test]
    fn gradients_go_there_and_back() {
        for log_length in 0..=9 {
            let gradient = Gradient {
                from: [0, 255, 10],
                to: [255, 0, 200],
                log_length,
                word: |[r, g, b]| u16::from(r) << 8 | u16::from(g ^ b),
            };
            let length = f64::from(1 << log_length);
            for column in 0..1024u16 {
                let way = ((f64::from(column) + 0.5) / length).rem_euclid(2.0);
                let part = way.min(2.0 - way);
                let level = |a: f64, b: f64| a + (b - a) * part;
                let word = gradient.texel(column, 7);
                let red = f64::from(word >> 8);
                assert!((red - level(0.0, 255.0)).abs() <= 1.5, "{column}: {red}");
                let (green, blue) = (level(255.0, 0.0), level(10.0, 200.0));
                let mixed = [-2, -1, 0, 1, 2].iter().any(|d| {
                    [-2, -1, 0, 1, 2].iter().any(|e| {
                        let (g, b) = (green.round() as i32 + d, blue.round() as i32 + e);
                        (g ^ b) & 255 == i32::from(word & 255)
                    })
                });
                assert!(mixed, "{column}");
            }
        }
        let ends = Gradient {
            from: [1, 2, 3],
            to: [1, 2, 3],
            log_length: 0,
            word: |rgb| rgb.map(u16::from).iter().sum(),
        };
        assert_eq!(ends.texel(0, 0), 6);
    }
}
