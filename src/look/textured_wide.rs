//! The look of textures in pixels of 24 and 32 bits: [`Textured`] of [`Rgb888`] and of [`Xrgb8888`].
//!
//! Texels have 16 bits, as numbers ([`Rgb565`]), so that a texture takes as little memory as for any panel. A span's
//! texels are fetched as for a panel of 16 bits, some at a time, and become pixels when they are shaded: the product
//! of 8 bits a channel and a shade of 15, rounded once.

use super::textured::{Planes, Textured};
use super::tint::{Shade, Texel};
use super::{Fill, Look, Place, Primitive, ThinSpan};
use crate::geometry::Scale;
use crate::pixel::{PixelFormat, Rgb565, Rgb888, Xrgb8888};
use crate::scene::{DrawState, Draws, Holes};

/// The look that fetches texels.
type Texels = Textured<Rgb565>;

/// Texels that are fetched before any is shaded.
const AT_ONCE: usize = 64;

/// A texel times a shade.
#[inline(always)]
fn shaded<F: PixelFormat>(texel: u16, shade: Shade) -> F::Word {
    const FULL: u32 = 1 << 15;
    let by = [
        shade.red_blue >> 16,
        shade.green >> 16,
        shade.red_blue & 0xFFFF,
    ];
    let texel = Rgb565::to_rgb8(texel);
    // A little more than full light is full light.
    F::from_rgb8([0, 1, 2].map(|i| {
        let product = u32::from(texel[i]) * by[i].min(FULL);
        (product.wrapping_add(FULL / 2) >> 15) as u8
    }))
}

/// Texels as pixels: those at `place`, times the triangle's shade.
fn shade<F: PixelFormat>(planes: &Planes, place: Place, texels: &[u16], run: &mut [F::Word]) {
    let mut pairs = texels.iter().zip(run);
    if !planes.is_shaded() {
        return pairs.for_each(|(&texel, pixel)| *pixel = F::from_rgb8(Rgb565::to_rgb8(texel)));
    }
    planes.each_shade(place, |shade| match pairs.next() {
        Some((&texel, pixel)) => {
            *pixel = shaded::<F>(texel, shade);
            true
        }
        None => false,
    });
}

/// Fetches the texels of a run, words of `T`, and calls `shade` with its parts and theirs.
#[inline(always)]
pub(super) fn each_texels<W, T: Texel>(
    planes: &Planes,
    mut place: Place,
    draws: &[DrawState<'_>],
    run: &mut [W],
    mut shade: impl FnMut(Place, &[u16], &mut [W]),
) {
    let mut texels = [0; AT_ONCE];
    for run in run.chunks_mut(AT_ONCE) {
        let texels = &mut texels[..run.len()];
        Textured::<T>::texels(planes, place, draws, texels);
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
    draws: &[DrawState<'_>],
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

/// Colours a run, texels first.
#[inline(never)]
fn fill<F: PixelFormat>(
    planes: &Planes,
    place: Place,
    draws: &[DrawState<'_>],
    run: &mut [F::Word],
) {
    each_texels::<_, Rgb565>(planes, place, draws, run, |place, texels, run| {
        shade::<F>(planes, place, texels, run);
    });
}

/// Colours a run of up to 32 pixels whose texture has transparent texels; a bit for each that is not a hole.
#[inline(never)]
fn fill_opaque<F: PixelFormat>(
    planes: &Planes,
    place: Place,
    draws: &[DrawState<'_>],
    run: &mut [F::Word],
) -> u32 {
    let Some(holes) = planes.holes(draws) else {
        fill::<F>(planes, place, draws, run);
        return u32::MAX;
    };
    each_holed::<F, Rgb565>(planes, place, draws, holes, run, |place, texels, run| {
        let texels = if texels.is_empty() {
            &[0xFFFF; 32]
        } else {
            texels
        };
        shade::<F>(planes, place, texels, run);
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
                _: Fill,
                planes: &Planes,
                place: Place,
                draws: &[DrawState<'_>],
                run: &mut [<$format as PixelFormat>::Word],
            ) {
                fill::<$format>(planes, place, draws, run);
            }

            #[inline(always)]
            fn fill_opaque(
                _: Fill,
                planes: &Planes,
                place: Place,
                draws: &[DrawState<'_>],
                _: bool,
                run: &mut [<$format as PixelFormat>::Word],
            ) -> u32 {
                fill_opaque::<$format>(planes, place, draws, run)
            }

            fn fill_mask(planes: &Planes, at: Place, draws: &[DrawState<'_>], run: &mut [u16]) {
                Texels::fill_mask(planes, at, draws, run);
            }
        }
    )+};
}
wide!(Rgb888, Xrgb8888);
