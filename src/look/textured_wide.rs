//! The look of textures in pixels of 24 and 32 bits: [`Textured`] of [`Rgb888`] and of [`Xrgb8888`].
//!
//! Texels have 16 bits, as numbers ([`Rgb565`]), so that a texture takes as little memory as for any panel. A span's
//! texels are fetched as for a panel of 16 bits, some at a time, and become pixels when they are shaded: the product
//! of a texel's steps and of the levels that one is worth in the shade of the pixel, rounded once. On a Cortex-M4 that
//! takes 23 instructions a pixel, and 17 in full light.
//!
//! A run with which a span begins has functions of its own: asked within the loop where a shade begins, whole frames
//! take 4 to 12 % more (scene B, `firmware --bench`).

use super::course::Course;
use super::ramp::go_on;
use super::textured::{Planes, Textured};
use super::tint::{Shade, Texel};
use super::{Fill, Look, Place, Primitive, States, ThinSpan, WordOf};
use crate::geometry::Scale;
use crate::num::{mul_high, rolled};
use crate::pixel::{PixelFormat, Rgb565, Rgb888, Xrgb8888};
use crate::scene::{Draws, Holes};
use core::hint::black_box;

/// The look that fetches texels.
type Texels = Textured<Rgb565>;

/// Texels that are fetched before any is shaded.
const AT_ONCE: usize = 64;
/// Texels of spans that take less memory, which is cleared for each.
const FEW: usize = 16;

/// Levels of a step of a texel's red, green and blue, in 2^-26.
const LEVELS: [i32; 3] = [levels(31), levels(63), levels(31)];

/// Those of a channel with so many steps: 2^-14 of them less than is right, so that the most light that planes err to,
/// half a level more than full light, stays below the next level.
const fn levels(steps: u64) -> i32 {
    let exact = ((255 << 26) / steps) as i32;
    exact - (exact >> 14)
}

/// Light of a pixel, or its step: what a step of each channel of a texel is worth there, in 2^-24 levels.
#[derive(Clone, Copy)]
struct Light([u32; 3]);

impl Light {
    const FULL: Self = Self::of([1 << 30; 3]);
    const NONE: Self = Self([0; 3]);

    /// Of channels of which full light is 2^30.
    #[inline(always)]
    const fn of([red, green, blue]: [i32; 3]) -> Self {
        Self([
            mul_high(red, LEVELS[0]) as u32,
            mul_high(green, LEVELS[1]) as u32,
            mul_high(blue, LEVELS[2]) as u32,
        ])
    }

    /// A texel in this light, where `half` is half a level. A little less than none rounds to 0.
    #[inline(always)]
    fn on<F: PixelFormat>(self, texel: u16, half: u32) -> F::Word {
        let steps = [texel >> 11, texel >> 5 & 63, texel & 31];
        F::pack([0, 1, 2].map(|i| {
            let level = u32::from(steps[i]).wrapping_mul(self.0[i]);
            (level.wrapping_add(half) >> 24) as u8
        }))
    }
}

/// Texels as pixels, in light of which each pixel has a step more.
#[inline(always)]
fn light<F: PixelFormat>(mut light: Light, step: Light, texels: &[u16], run: &mut [F::Word]) {
    // Not added up with what is known of the light.
    let half = black_box(1 << 23);
    for (&texel, pixel) in texels.iter().zip(run) {
        *pixel = light.on::<F>(texel, half);
        rolled();
        go_on(&mut light.0, step.0, 1);
    }
}

/// The light where a shade's course begins, and its step.
#[inline(always)]
fn lights(course: &Course) -> [Light; 2] {
    let margin = (Shade::MARGIN << 15) as i32;
    let at = course.value.map(|at| (at as i32).wrapping_sub(margin));
    [Light::of(at), Light::of(course.step)]
}

/// Texels as pixels: up to 64 at `place`, where the triangle's shade begins anew. Out of line: where it is called there are
/// no registers left for it.
#[inline(never)]
fn shade<F: PixelFormat>(planes: &Planes, place: Place, texels: &[u16], run: &mut [F::Word]) {
    let Some(course) = planes.shade_course(place) else {
        return light::<F>(Light::FULL, Light::NONE, texels, run);
    };
    let [first, step] = lights(&course);
    light::<F>(first, step, texels, run);
}

/// The same of any run: the shade, whose steps are rounded, begins anew every 64 pixels of the span.
#[inline(never)]
fn shade_part<F: PixelFormat>(
    planes: &Planes,
    mut place: Place,
    mut texels: &[u16],
    mut run: &mut [F::Word],
) {
    while !run.is_empty() {
        let part = place.skipped() as usize % AT_ONCE;
        let pixels = run.len().min(AT_ONCE - part);
        place.column -= part as u32;
        let Some(course) = planes.shade_course(place) else {
            return light::<F>(Light::FULL, Light::NONE, texels, run);
        };
        let (now, rest) = run.split_at_mut(pixels);
        let [mut first, step] = lights(&course);
        go_on(&mut first.0, step.0, part as u32);
        light::<F>(first, step, texels, now);
        texels = texels.get(pixels..).unwrap_or_default();
        place.column += AT_ONCE as u32;
        run = rest;
    }
}

/// Fetches the texels of a run, words of `T`, and calls `shade` with its parts and theirs; `how` is that of the triangle.
#[inline(always)]
pub(super) fn each_texels<W, T: Texel>(
    how: Fill,
    planes: &Planes,
    mut place: Place,
    draws: States<'_>,
    run: &mut [W],
    mut shade: impl FnMut(Place, &[u16], &mut [W]),
) {
    let (mut few, mut many);
    let texels: &mut [u16] = if run.len() <= FEW {
        few = [0; FEW];
        &mut few
    } else {
        many = [0; AT_ONCE];
        &mut many
    };
    for run in run.chunks_mut(texels.len()) {
        let texels = &mut texels[..run.len()];
        match how {
            Fill::Plain => planes.copy_plain(place, draws, texels),
            _ => Textured::<T>::texels(planes, place, draws, texels),
        }
        shade(place, texels, run);
        place.column += run.len() as u32;
    }
}

/// The same of a run of up to 32 pixels whose texture has transparent texels, where `shade` without texels is that of the
/// triangle's colour; a bit for each pixel that is not a hole.
#[inline(always)]
pub(super) fn each_holed<F: PixelFormat, T: Texel>(
    planes: &Planes,
    place: Place,
    draws: States<'_>,
    holes: Holes,
    run: &mut [F::Word],
    mut shade: impl FnMut(Place, &[u16], &mut [F::Word]),
) -> u32 {
    let mut texels = [0; 32];
    let count = run.len().min(texels.len());
    let texels = &mut texels[..count];
    Textured::<T>::texels(planes, place, draws, texels);
    shade(place, if holes.are_filled { &[] } else { texels }, run);
    if !holes.are_filled {
        return holes.opaque(texels);
    }
    for (pixel, &texel) in run.iter_mut().zip(texels.iter()) {
        if texel != holes.key {
            *pixel = recoloured::<F, T>(texel);
        }
    }
    u32::MAX
}

/// A texel as a pixel of another format: one copy, since few are shown so.
#[inline(never)]
fn recoloured<F: PixelFormat, T: Texel>(texel: u16) -> F::Word {
    F::from_rgb8(T::to_rgb8(texel))
}

/// Colours a run, with which its span begins or not, texels first.
#[inline(never)]
fn fill<F: PixelFormat, const BEGINS: bool>(
    how: Fill,
    planes: &Planes,
    place: Place,
    draws: States<'_>,
    run: &mut [F::Word],
) {
    each_texels::<_, Rgb565>(how, planes, place, draws, run, |place, texels, run| {
        let shade = if BEGINS { shade::<F> } else { shade_part::<F> };
        shade(planes, place, texels, run);
    });
}

/// Colours a run of up to 32 pixels whose texture has transparent texels; a bit for each that is not a hole.
#[inline(never)]
fn fill_opaque<F: PixelFormat>(
    planes: &Planes,
    place: Place,
    draws: States<'_>,
    run: &mut [F::Word],
) -> u32 {
    let Some(holes) = planes.holes(draws) else {
        fill::<F, false>(Fill::Wide, planes, place, draws, run);
        return u32::MAX;
    };
    each_holed::<F, Rgb565>(planes, place, draws, holes, run, |place, texels, run| {
        let white = &[0xFFFF; 32];
        let texels = if texels.is_empty() { white } else { texels };
        shade_part::<F>(planes, place, texels, run);
    })
}

/// The look in a format of more than 16 bits.
macro_rules! wide {
    ($($format:ty),+) => {$(
        impl Look for Textured<$format> {
            type Pixel = $format;
            type Planes = Planes;
            const EMPTY: Planes = Texels::EMPTY;
            const TEXTURED: bool = true;
            const SCALE: Scale = Texels::SCALE;

            #[inline(always)]
            fn set_up(of: &Primitive<'_>, planes: &mut Planes) -> Fill {
                Texels::set_up(of, planes)
            }

            fn set_up_thin(of: &ThinSpan<'_>, object: u16, draws: &Draws<'_>, to: &mut Planes) {
                Texels::set_up_thin(of, object, draws, to);
            }

            #[inline(always)]
            fn fill(
                how: Fill,
                planes: &Planes,
                place: Place,
                draws: States<'_>,
                run: &mut [WordOf<Self>],
            ) {
                if place.skipped() == 0 {
                    fill::<$format, true>(how, planes, place, draws, run);
                } else {
                    fill::<$format, false>(how, planes, place, draws, run);
                }
            }

            #[inline(always)]
            fn fill_opaque(
                _: Fill,
                planes: &Planes,
                place: Place,
                draws: States<'_>,
                _: bool,
                run: &mut [WordOf<Self>],
            ) -> u32 {
                fill_opaque::<$format>(planes, place, draws, run)
            }

            fn fill_mask(planes: &Planes, at: Place, draws: States<'_>, run: &mut [u16]) {
                Texels::fill_mask(planes, at, draws, run);
            }
        }
    )+};
}
wide!(Rgb888, Xrgb8888);

#[cfg(test)]
mod tests {
    use super::*;

    const HALF: u32 = 1 << 23;

    /// Kills: levels of a texel that are not the nearest.
    #[test]
    fn texels_in_full_light_have_the_levels_that_a_panel_of_16_bits_shows() {
        for texel in 0..=u16::MAX {
            let level = Rgb565::to_rgb8(texel);
            assert_eq!(Light::FULL.on::<Rgb888>(texel, HALF), level);
            let word = Light::FULL.on::<Xrgb8888>(texel, HALF);
            assert_eq!(Xrgb8888::to_rgb8(word), level);
        }
    }

    /// Kills: light that planes err to and that is white as black, or black as white.
    #[test]
    fn light_beside_the_ends_is_that_of_the_ends() {
        for beyond in 0..=Shade::MARGIN as i32 {
            let light = |channel: i32| Light::of([channel << 15; 3]);
            let (least, most) = (light(-beyond), light((1 << 15) + beyond));
            assert_eq!(most.on::<Rgb888>(0xFFFF, HALF), [255; 3]);
            for texel in 0..=u16::MAX {
                assert_eq!(least.on::<Rgb888>(texel, HALF), [0; 3]);
            }
        }
    }
}
