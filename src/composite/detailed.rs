//! Textured spans in levels of detail (H6).
//!
//! Each pixel has the level that its 1/w asks for: where the level changes along a span, the span
//! is cut, which is a division a cut and happens to few.

use super::texel::TexelOf;
use super::texels::{Light, TextureSource, alphas_part, paint_part};
use super::{PixelAlpha, PixelFormat};
use crate::geometry::texturing::{LevelEnds, Period, SpanPlace};
use crate::shade::Stretch;
use crate::shade::texture::{Levels, Texels};
use crate::visible::Visible;

/// Textures by number, each in four levels of detail; the shading is
/// [`Textured`](crate::pipeline::texture::Textured) with [`LevelEnds`].
#[derive(Debug)]
pub struct DetailedTextures<'t, T>(
    /// The textures; a face without one among them is drawn untextured.
    pub &'t [Levels<T>],
);

impl<T> Clone for DetailedTextures<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for DetailedTextures<'_, T> {}

impl<T> Default for DetailedTextures<'_, T> {
    fn default() -> Self {
        Self(&[])
    }
}

impl<F, T> TextureSource<F> for DetailedTextures<'_, T>
where
    F: PixelFormat,
    T: Texels<Texel: TexelOf<F>>,
{
    fn period(&self, index: u16) -> Period {
        let levels = self.0.get(usize::from(index));
        levels.map_or(Period::Long, |levels| levels.levels[0].period())
    }

    #[inline]
    fn fetches(&self, index: u16) -> u32 {
        let levels = self.0.get(usize::from(index));
        levels.map_or(0, |levels| levels.levels[0].fetches())
    }

    #[inline(never)]
    fn paint(
        &self,
        index: u16,
        pixels: &mut [F::Word],
        (place, ends): (SpanPlace, &LevelEnds),
        stretch: Stretch,
        visible: &mut impl Visible,
    ) -> bool {
        let Some(levels) = self.0.get(usize::from(index)) else {
            return false;
        };
        let mut light = Light::new::<F>(stretch);
        let mut rest = pixels;
        let mut place = place;
        while !rest.is_empty() {
            let (level, count, next) = part(place, ends, rest.len());
            let (now, later) = rest.split_at_mut(count);
            paint_part::<F, _, _>(&levels.level(level), now, place, &mut light, visible);
            (rest, place) = (later, next);
        }
        true
    }

    #[inline(never)]
    fn alphas(&self, index: u16, alphas: &mut [PixelAlpha], (at, ends): (SpanPlace, &LevelEnds)) {
        let Some(levels) = self.0.get(usize::from(index)) else {
            return;
        };
        let (mut rest, mut place) = (alphas, at);
        while !rest.is_empty() {
            let (level, count, next) = part(place, ends, rest.len());
            let (now, later) = rest.split_at_mut(count);
            alphas_part::<F, _>(&levels.level(level), now, place);
            (rest, place) = (later, next);
        }
    }
}

/// The level of the next pixels, how many have it, and the place of the pixel after them.
#[inline]
fn part(place: SpanPlace, ends: &LevelEnds, pixels: usize) -> (u32, usize, SpanPlace) {
    match place {
        SpanPlace::Straight(..) => (ends.level(0), pixels, place),
        SpanPlace::Perspective(at, step, budget) => {
            let q = at.q as u32;
            let count = ends.same(q, step.q, pixels);
            let next = at.plus(step.times(count as i32));
            let next = SpanPlace::Perspective(next, step, budget);
            (ends.level(q), count, next)
        }
    }
}
