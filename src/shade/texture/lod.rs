//! Four levels of detail (H6).
//!
//! Each is the 2x2 average of the one before, channel by channel, rounded to nearest. Which one is
//! right follows from 1/w: within a triangle the texture's area under a pixel is `D q^-3` with one
//! constant D, since it is a projective map. So three limits of 1/w are found once a triangle, and
//! a span compares. A level is taken where its texels are at least `1 / sqrt 2` pixels wide on
//! average and the next one's more than `sqrt 2`.

use super::format::{Texel, TexelFormat};
use super::sample::{Size, TextureError};
use super::{Texels, Uv};

/// How many levels there are, the texture itself among them.
pub const LEVELS: usize = 4;

/// Words that the levels below the first need together.
#[must_use]
pub const fn level_words(size: Size) -> usize {
    size.level(1).texels() + size.level(2).texels() + size.level(3).texels()
}

/// Builds the level below one of `size` whose texel at an index (rows from the top) is
/// `texel(index)`, into the start of `words`; how many that are.
///
/// A side of one texel stays: then two texels are averaged, or one is copied. D is set where it is
/// in at least half of the texels.
///
/// # Errors
/// When there are too few words.
pub fn build_level<F: TexelFormat>(
    size: Size,
    texel: impl Fn(usize) -> Texel,
    words: &mut [F::Word],
) -> Result<usize, TextureError> {
    let below = size.level(1);
    let (needed, have) = (below.texels(), words.len());
    let words = words
        .get_mut(..needed)
        .ok_or(TextureError::Texels { needed, have })?;
    let right = size.width() as usize - below.width() as usize;
    let down = size.height() as usize - below.height() as usize;
    for (i, word) in words.iter_mut().enumerate() {
        let x = i & (below.width() as usize - 1);
        let y = i >> below.log_width();
        // Twice the place where the side is halved, and the texel beside it.
        let at = |dx: usize, dy: usize| {
            let x = if right > 0 { 2 * x + dx } else { x };
            let y = if down > 0 { 2 * y + dy } else { y };
            texel(y << size.log_width() | x)
        };
        *word = F::pack(average([at(0, 0), at(1, 0), at(0, 1), at(1, 1)]));
    }
    Ok(needed)
}

fn average(four: [Texel; 4]) -> Texel {
    let mean = |get: &dyn Fn(&Texel) -> u8| {
        let sum: u32 = four.iter().map(|t| u32::from(get(t))).sum();
        ((sum + 2) >> 2) as u8
    };
    Texel {
        rgb: [0, 1, 2].map(|i| mean(&|t: &Texel| t.rgb[i])),
        alpha: mean(&|t| t.alpha),
        undithered: four.iter().filter(|t| t.undithered).count() >= 2,
    }
}

/// At which 1/w each coarser level begins, in the triangle's exponent.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct LevelEnds([u32; LEVELS - 1]);

impl LevelEnds {
    /// The full texture everywhere.
    pub const FULL: Self = Self([0; LEVELS - 1]);

    /// From a triangle's doubled areas on the texture (units of 2^-16 texel) and on the screen
    /// (units of 2^-6 pixel), and 1/w of its corners.
    #[must_use]
    pub fn new(texels: u64, pixels: u64, q: [u32; 3]) -> Self {
        if texels == 0 || pixels == 0 {
            return Self::FULL;
        }
        // The ratio of the areas is D / (q0 q1 q2). D q^-3 = 2 4^(level - 1), by logarithms.
        let product: i32 = q.iter().map(|&q| log2(u64::from(q.max(1)))).sum();
        let constant = log2(texels) - log2(pixels) - (10 << 8) + product;
        Self(core::array::from_fn(|i| {
            exp2((constant - ((2 * i as i32 + 1) << 8)).div_euclid(3))
        }))
    }

    /// The level where 1/w is `q`: 0 to 3, coarser as 1/w falls.
    #[inline(always)]
    #[must_use]
    pub const fn level(&self, q: u32) -> u32 {
        let [a, b, c] = self.0;
        (q < a) as u32 + (q < b) as u32 + (q < c) as u32
    }
}

/// The logarithm of a number above 0, 8 fraction bits, within 3 of 2^-8.
fn log2(x: u64) -> i32 {
    let whole = 63 - x.leading_zeros() as i32;
    let part = ((x << x.leading_zeros() >> 55) & 0xFF) as i32;
    // log2(1 + f) is above f by about 0.344 f (1 - f).
    (whole << 8) + part + ((part * (256 - part) * 88) >> 16)
}

/// 2 to the power of a number with 8 fraction bits; 0 below 2^0, the largest above 2^32.
fn exp2(log: i32) -> u32 {
    if log < 0 {
        return 0;
    }
    let part = log & 0xFF;
    let part = (256 + part - ((part * (256 - part) * 88) >> 16)) as u64;
    let value = part.checked_shl(log as u32 >> 8).unwrap_or(u64::MAX) >> 8;
    if log >= 32 << 8 {
        u32::MAX
    } else {
        value as u32
    }
}

/// A texture in four levels of detail.
#[derive(Clone, Copy, Debug)]
pub struct Levels<T> {
    /// The texture, then each level below it; a level may be the same as the one before, where
    /// there is nothing coarser.
    pub levels: [T; LEVELS],
}

/// One level, whose places are those of the texture itself.
#[derive(Clone, Copy, Debug)]
pub struct Level<'a, T> {
    texels: &'a T,
    level: u32,
}

impl<T: Texels> Levels<T> {
    /// The texture at a level, 0 to 3 (more is 3).
    #[inline(always)]
    pub fn level(&self, level: u32) -> Level<'_, T> {
        let level = level.min(LEVELS as u32 - 1);
        Level {
            texels: &self.levels[level as usize],
            level,
        }
    }
}

impl<T: Texels> Level<'_, T> {
    #[inline(always)]
    fn scaled(&self, place: Uv) -> Uv {
        Uv {
            u: place.u >> self.level,
            v: place.v >> self.level,
        }
    }
}

impl<T: Texels> Texels for Level<'_, T> {
    type Texel = T::Texel;

    #[inline(always)]
    fn at(&self, place: Uv) -> T::Texel {
        self.texels.at(self.scaled(place))
    }

    #[inline(always)]
    fn run<W>(&self, pixels: &mut [W], from: Uv, step: Uv, each: impl FnMut(&mut W, T::Texel)) {
        self.texels
            .run(pixels, self.scaled(from), self.scaled(step), each);
    }
}
