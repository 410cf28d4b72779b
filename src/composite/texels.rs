//! Textured spans: a texel times the shaded colour (H3, H17).
//!
//! A span that is lit by white alone copies its texels; another takes some 60 instructions a pixel
//! more on a Cortex-M4. What is hidden is not fetched. The places
//! of all pixels follow from the span's first and last pixel, seen or not, so the bits do not
//! depend on what hides what.

use super::course::apart;
use super::texel::TexelOf;
use super::{PixelAlpha, PixelFormat, Threshold};
use crate::geometry::texturing::{LevelEnds, Period, SpanPlace};
use crate::shade::Stretch;
use crate::shade::texture::{PaintRun, PerspectiveSpan, Texels, Uv};
use crate::visible::Visible;
use core::marker::PhantomData;
use core::slice;

/// The textures that are lent to a scene: [`Textures`], or `()` for none.
///
/// Where they can be shared between cores (`Sync`), the scene can; those that are read through a
/// [`BlockCache`](crate::pipeline::texture::BlockCache) cannot, as one core alone may use a cache.
pub trait TextureSource<F: PixelFormat>: Copy + Default {
    /// How texture `index` goes on beyond its sides.
    fn period(&self, _index: u16) -> Period {
        Period::Long
    }

    /// Texels that one pixel of texture `index` fetches; 0 where there is no such texture.
    fn fetches(&self, index: u16) -> u32;

    /// Draws a span with texture `index`, if it exists, in the detail that is right by 1/w;
    /// `false` otherwise.
    fn paint(
        &self,
        index: u16,
        pixels: &mut [F::Word],
        course: (SpanPlace, &LevelEnds),
        stretch: Stretch,
        visible: &mut impl Visible,
    ) -> bool;

    /// What the texels of a span with texture `index` say of their alpha, if it exists.
    fn alphas(&self, _: u16, _: &mut [PixelAlpha], _: (SpanPlace, &LevelEnds)) {}
}

impl<F: PixelFormat> TextureSource<F> for () {
    #[inline(always)]
    fn fetches(&self, _: u16) -> u32 {
        0
    }

    #[inline(always)]
    fn paint(
        &self,
        _: u16,
        _: &mut [F::Word],
        _: (SpanPlace, &LevelEnds),
        _: Stretch,
        _: &mut impl Visible,
    ) -> bool {
        false
    }
}

/// Textures by number, each drawn as it is whatever its size on the screen; those with levels of
/// detail are [`DetailedTextures`](super::DetailedTextures).
#[derive(Debug)]
pub struct Textures<'t, T>(
    /// The textures; a face without one among them is drawn untextured.
    pub &'t [T],
);

impl<T> Clone for Textures<'_, T> {
    fn clone(&self) -> Self {
        *self
    }
}

impl<T> Copy for Textures<'_, T> {}

impl<T> Default for Textures<'_, T> {
    fn default() -> Self {
        Self(&[])
    }
}

impl<F, T> TextureSource<F> for Textures<'_, T>
where
    F: PixelFormat,
    T: Texels<Texel: TexelOf<F>>,
{
    fn period(&self, index: u16) -> Period {
        let texels = self.0.get(usize::from(index));
        texels.map_or(Period::Long, Texels::period)
    }

    #[inline]
    fn fetches(&self, index: u16) -> u32 {
        self.0.get(usize::from(index)).map_or(0, Texels::fetches)
    }

    #[inline(never)]
    fn paint(
        &self,
        index: u16,
        pixels: &mut [F::Word],
        (place, _): (SpanPlace, &LevelEnds),
        stretch: Stretch,
        visible: &mut impl Visible,
    ) -> bool {
        let Some(texels) = self.0.get(usize::from(index)) else {
            return false;
        };
        let mut light = Light::new::<F>(stretch);
        paint_part::<F, _, _>(texels, pixels, place, &mut light, visible);
        true
    }

    #[inline(never)]
    fn alphas(&self, index: u16, alphas: &mut [PixelAlpha], (place, _): (SpanPlace, &LevelEnds)) {
        if let Some(texels) = self.0.get(usize::from(index)) {
            alphas_part::<F, _>(texels, alphas, place);
        }
    }
}

/// The alphas of the next pixels of a span from `place` on.
pub(super) fn alphas_part<F, T>(texels: &T, alphas: &mut [PixelAlpha], place: SpanPlace)
where
    F: PixelFormat,
    T: Texels<Texel: TexelOf<F>>,
{
    let paint = Alphas::<F, _> {
        texels,
        format: PhantomData,
    };
    walk(place, alphas, paint);
}

/// Alphas of texels.
struct Alphas<'a, F, T> {
    texels: &'a T,
    format: PhantomData<F>,
}

impl<F, T> PaintRun<PixelAlpha> for Alphas<'_, F, T>
where
    F: PixelFormat,
    T: Texels<Texel: TexelOf<F>>,
{
    fn run(&mut self, alphas: &mut [PixelAlpha], from: Uv, step: Uv) {
        self.texels.run(alphas, from, step, |pixel, texel| {
            pixel.texel = texel.alpha();
            pixel.additive = texel.is_additive();
        });
    }
}

/// Draws the next pixels of a span from `place` on.
#[inline(always)]
pub(super) fn paint_part<F, T, V>(
    texels: &T,
    pixels: &mut [F::Word],
    place: SpanPlace,
    light: &mut Light,
    visible: &mut V,
) where
    F: PixelFormat,
    T: Texels<Texel: TexelOf<F>>,
    V: Visible,
{
    if light.white {
        let paint = Copies::<F, _, _> {
            texels,
            visible,
            format: PhantomData,
        };
        walk(place, pixels, paint);
    } else {
        let paint = Lit::<F, _, _> {
            texels,
            visible,
            light,
            format: PhantomData,
        };
        walk(place, pixels, paint);
    }
}

/// Spans up to this long are divided at each pixel: to choose would cost more.
const SHORT: usize = 8;

#[inline(always)]
fn walk<W>(place: SpanPlace, pixels: &mut [W], mut paint: impl PaintRun<W>) {
    match place {
        SpanPlace::Straight(from, step) => paint.run(pixels, from, step),
        SpanPlace::Perspective(at, step, budget) => {
            let span = PerspectiveSpan { at, step };
            if pixels.len() <= SHORT {
                span.exact(pixels, &mut paint);
            } else {
                let stride = budget.stride(&span, pixels.len());
                span.walk(stride, pixels, &mut paint);
            }
        }
    }
}

/// The thresholds of the pixels to come, none where the format does not dither.
#[inline(always)]
fn thresholds<F: PixelFormat>(tile: (u8, u8)) -> impl Iterator<Item = Threshold> {
    let mut row = F::thresholds(tile);
    core::iter::from_fn(move || {
        if !F::DITHERS {
            return None;
        }
        row.rotate_left(1);
        Some(row[3])
    })
}

/// Whole steps of 8-bit levels, rounded to nearest.
#[inline(always)]
fn steps<F: PixelFormat>(levels: [u8; 3]) -> [u8; 3] {
    let step = |i: usize| ((u32::from(levels[i]) * u32::from(F::STEPS[i]) + 127) / 255) as u8;
    [step(0), step(1), step(2)]
}

/// Texels as they are.
struct Copies<'a, F, T, V> {
    texels: &'a T,
    visible: &'a mut V,
    format: PhantomData<F>,
}

impl<F, T, V> Copies<'_, F, T, V>
where
    F: PixelFormat,
    T: Texels<Texel: TexelOf<F>>,
    V: Visible,
{
    #[inline(always)]
    fn inline(&mut self, pixels: &mut [F::Word], from: Uv, step: Uv) {
        let mut thresholds = thresholds::<F>(self.visible.tile());
        self.texels
            .along(pixels, from, step, self.visible, |pixel, texel| {
                copy::<F, _>(pixel, texel, thresholds.next());
            });
    }

    #[inline(never)]
    fn called(&mut self, pixels: &mut [F::Word], from: Uv, step: Uv) {
        self.inline(pixels, from, step);
    }
}

impl<F, T, V> PaintRun<F::Word> for Copies<'_, F, T, V>
where
    F: PixelFormat,
    T: Texels<Texel: TexelOf<F>>,
    V: Visible,
{
    #[inline(always)]
    fn run(&mut self, pixels: &mut [F::Word], from: Uv, step: Uv) {
        if T::LONG {
            self.called(pixels, from, step);
        } else {
            self.inline(pixels, from, step);
        }
    }

    #[inline(always)]
    fn one(&mut self, pixel: &mut F::Word, at: Uv) {
        let threshold = thresholds::<F>(self.visible.tile()).next();
        self.visible.each(slice::from_mut(pixel), |pixel, shown| {
            copy::<F, _>(pixel, shown.then(|| self.texels.at(at)), threshold);
        });
    }
}

/// Makes a pixel of a texel, if there is one.
#[inline(always)]
fn copy<F: PixelFormat, T: TexelOf<F>>(
    pixel: &mut F::Word,
    texel: Option<T>,
    threshold: Option<Threshold>,
) {
    if let Some(texel) = texel {
        *pixel = match threshold {
            Some(threshold) if !texel.undithered() => {
                F::pack_at(steps::<F>(texel.levels()), threshold)
            }
            _ => texel.word(),
        };
    }
}

/// Texels times the shaded colour: a pixel at a time, in code that is there once for all ways along
/// a span, or its loop would call it for each pixel.
struct Lit<'a, F, T, V> {
    texels: &'a T,
    visible: &'a mut V,
    light: &'a mut Light,
    format: PhantomData<F>,
}

impl<F, T, V> PaintRun<F::Word> for Lit<'_, F, T, V>
where
    F: PixelFormat,
    T: Texels<Texel: TexelOf<F>>,
    V: Visible,
{
    #[inline(never)]
    fn run(&mut self, pixels: &mut [F::Word], from: Uv, step: Uv) {
        // A copy, which stays in registers.
        let mut light = *self.light;
        let mut thresholds = thresholds::<F>(self.visible.tile());
        self.texels
            .singly(pixels, from, step, self.visible, |pixel, texel| {
                light.shine::<F, _>(pixel, texel, thresholds.next());
                light.advance();
            });
        *self.light = light;
    }

    #[inline(always)]
    fn one(&mut self, pixel: &mut F::Word, at: Uv) {
        let threshold = thresholds::<F>(self.visible.tile()).next();
        self.visible.each(slice::from_mut(pixel), |pixel, shown| {
            let texel = shown.then(|| self.texels.at(at));
            self.light.shine::<F, _>(pixel, texel, threshold);
        });
        self.light.advance();
    }
}

/// The shaded colour along a span: channels of 16 bits and as many fraction bits as the format has
/// bits, without the half step that vertices have; times 256/255, so that 8-bit levels are multiplied
/// by a shift.
#[derive(Clone, Copy)]
pub(super) struct Light {
    at: [i32; 3],
    step: [i32; 3],
    /// Whether every pixel is in full light.
    white: bool,
}

/// Times 256/255, within a unit.
#[inline(always)]
const fn widened(x: i32) -> i32 {
    x.wrapping_add(x >> 8).wrapping_add(x >> 16)
}

impl Light {
    #[inline(always)]
    pub(super) fn new<F: PixelFormat>(stretch: Stretch) -> Self {
        // The channels, half a step too large, and their steps; how many fraction bits they lack.
        let (at, step, up) = match stretch {
            Stretch::Constant(steps) => {
                // Half a step is added, as vertices have it.
                let at = |i: usize| ((2 * i32::from(steps[i]) + 1) << (16 - F::BITS[i])) >> 1;
                ([at(0), at(1), at(2)], [0; 3], F::BITS)
            }
            Stretch::Packed {
                red_blue,
                green,
                steps,
                ..
            } => {
                // Channels are not negative.
                let high = |word: i32| (word as u32 >> 16) as i32;
                let at = [high(red_blue), high(green), red_blue & 0xFFFF];
                (at, apart(steps), F::BITS)
            }
            Stretch::Channels(at, step) => (at, step, [0; 3]),
        };
        let each = |i: usize| {
            let fields = F::BITS[i];
            let half = 1 << (15 - fields) << fields;
            (at[i] << up[i]).wrapping_sub(half)
        };
        let at = [each(0), each(1), each(2)];
        // Full light is half a step below all steps.
        let full = |i: usize| {
            let step = 1 << 16 >> F::BITS[i];
            (i32::from(F::STEPS[i]) * step - step / 2) << F::BITS[i]
        };
        Self {
            at: at.map(widened),
            step: [0, 1, 2].map(|i| widened(step[i] << up[i])),
            white: step == [0; 3] && (0..3).all(|i| at[i] >= full(i)),
        }
    }

    #[inline(always)]
    fn advance(&mut self) {
        for i in 0..3 {
            self.at[i] = self.at[i].wrapping_add(self.step[i]);
        }
    }

    /// Makes a pixel of a texel in this light, if there is one.
    #[inline(always)]
    fn shine<F: PixelFormat, T: TexelOf<F>>(
        &self,
        pixel: &mut F::Word,
        texel: Option<T>,
        threshold: Option<Threshold>,
    ) {
        if let Some(texel) = texel {
            let steps = self.times::<F>(texel.levels());
            *pixel = match threshold {
                Some(threshold) if !texel.undithered() => F::pack_at(steps, threshold),
                _ => F::pack(steps),
            };
        }
    }

    /// Whole steps of a texel of these 8-bit levels, rounded to nearest.
    #[inline(always)]
    fn times<F: PixelFormat>(&self, levels: [u8; 3]) -> [u8; 3] {
        let channel = |i: usize| {
            let half = 1 << (15 - F::BITS[i]);
            let light = (self.at[i] >> F::BITS[i]).max(0) as u32;
            let part = (u32::from(levels[i]) * light) >> 8;
            ((part + half) >> (16 - F::BITS[i])) as u8
        };
        [channel(0), channel(1), channel(2)]
    }
}
