//! Four levels of detail (H6).
//!
//! Each is the 2x2 average of the one before, channel by channel, rounded to nearest. Which one is
//! right follows from 1/w: see [`LevelEnds`](super::LevelEnds).

use super::format::{Texel, TexelFormat};
use super::sample::{Size, TextureError};
use super::{LEVELS, Texels, Uv};
use crate::visible::Visible;

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
    fn along<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        each: impl FnMut(&mut W, Option<T::Texel>),
    ) {
        let (from, step) = (self.scaled(from), self.scaled(step));
        self.texels.along(pixels, from, step, visible, each);
    }
}
