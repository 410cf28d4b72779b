//! Texels lit at each pixel: [`Phong`](super::Phong) with a texture (K10, H8).
//!
//! Texels are those of [`Textured`] in the same format: of 16 bits. A span's texels are fetched as for that look, some at
//! a time; each times the draw call's colour is the colour that light falls on in its pixel.

use super::gouraud::wide_shades;
use super::phong::{light, steps_of, word_of};
use super::textured::{Planes, Textured};
use super::textured_wide::{each_holed, each_texels};
use super::tint::Texel;
use super::{Fill, Look, Place, ThinSpan};
use crate::geometry::Scale;
use crate::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888, Xrgb8888};
use crate::scene::{DrawState, WordOfNormal};
use crate::span::{Size, Triangle};
use core::marker::PhantomData;

/// The look of textures lit at each pixel, in the pixel format `F`; texels are as for [`Textured`], and what shines is
/// [`Draw::lamps`](crate::scene::Draw::lamps).
///
/// [`Replace`](crate::scene::Application::Replace) is texels that no light falls on.
#[derive(Clone, Copy, Debug)]
pub struct TexturedPhong<F>(PhantomData<F>);

/// A texel of 8 bits a channel times a colour in 16.16 steps, and one half.
fn times(texel: [u8; 3], colour: [u32; 3]) -> [i32; 3] {
    [0, 1, 2].map(|i| {
        let product = u32::from(texel[i]) * colour[i];
        // A 255th of it, but for three units of 2^-16 steps.
        ((product >> 8) + (product >> 16) + (product >> 24) + (1 << 15)) as i32
    })
}

/// Sets a triangle up: a vertex's colour is its normal, and the planes of the shade are the normal's.
fn set_up<T: Texel>(
    triangle: &Triangle<'_>,
    object: u16,
    size: Size,
    area: u32,
    draws: &[DrawState<'_>],
    planes: &mut Planes,
) -> Fill {
    match Textured::<T>::set_up(triangle, object, size, area, draws, planes) {
        Fill::Thin => Fill::Thin,
        // The planes of small triangles have too few bits.
        _ => wide_shades(triangle, planes.shades_mut()),
    }
}

/// Lights pixels by their texels, which are words of `T`, dithered or not; those without one by white.
fn lit<F: PixelFormat, T: Texel>(
    state: &DrawState<'_>,
    planes: &Planes,
    place: Place,
    dithers: bool,
    texels: &[u16],
    run: &mut [F::Word],
) {
    let colour = steps_of::<F>(state);
    let mut texels = texels.iter();
    light::<F>(state, planes.shades(), place, dithers, run, || {
        let texel = texels.next().map_or([255; 3], |&texel| T::to_rgb8(texel));
        times(texel, colour)
    });
}

#[inline(never)]
fn fill<F: PixelFormat, T: Texel>(
    planes: &Planes,
    place: Place,
    dithers: bool,
    draws: &[DrawState<'_>],
    run: &mut [F::Word],
) {
    if let Some(state) = planes.state(draws) {
        each_texels::<_, T>(planes, place, draws, run, |place, texels, run| {
            lit::<F, T>(state, planes, place, dithers, texels, run);
        });
    }
}

/// The same of a run of up to 32 pixels whose texture has transparent texels; a bit for each that is not a hole.
#[inline(never)]
fn fill_opaque<F: PixelFormat, T: Texel>(
    planes: &Planes,
    place: Place,
    draws: &[DrawState<'_>],
    dithers: bool,
    run: &mut [F::Word],
) -> u32 {
    let (Some(state), Some(holes)) = (planes.state(draws), planes.holes(draws)) else {
        fill::<F, T>(planes, place, dithers, draws, run);
        return u32::MAX;
    };
    each_holed::<F, T>(planes, place, draws, holes, run, |place, texels, run| {
        lit::<F, T>(state, planes, place, dithers, texels, run);
    })
}

/// The look in a format, of texels of another or the same.
macro_rules! lit {
    ($($format:ty: $texel:ty),+) => {$(
        impl Look for TexturedPhong<$format> {
            type Pixel = $format;
            type Planes = Planes;
            const EMPTY: Planes = Textured::<$texel>::EMPTY;
            const TEXTURED: bool = true;
            const LIT_AT_PIXELS: Option<WordOfNormal> = Some(word_of);
            const SCALE: Scale = Scale::new(<$format as PixelFormat>::STEPS);

            fn set_up(
                triangle: &Triangle<'_>,
                object: u16,
                size: Size,
                area: u32,
                draws: &[DrawState<'_>],
                planes: &mut Planes,
            ) -> Fill {
                set_up::<$texel>(triangle, object, size, area, draws, planes)
            }

            fn set_up_thin(
                span: &ThinSpan<'_>,
                object: u16,
                draws: &[DrawState<'_>],
                planes: &mut Planes,
            ) {
                Textured::<$texel>::set_up_thin(span, object, draws, planes);
            }

            fn fill(
                _: Fill,
                planes: &Planes,
                place: Place,
                draws: &[DrawState<'_>],
                run: &mut [<$format as PixelFormat>::Word],
            ) {
                fill::<$format, $texel>(planes, place, false, draws, run);
            }

            fn fill_opaque(
                _: Fill,
                planes: &Planes,
                place: Place,
                draws: &[DrawState<'_>],
                dithers: bool,
                run: &mut [<$format as PixelFormat>::Word],
            ) -> u32 {
                fill_opaque::<$format, $texel>(planes, place, draws, dithers, run)
            }

            fn fill_mask(
                planes: &Planes,
                place: Place,
                draws: &[DrawState<'_>],
                run: &mut [u16],
            ) {
                Textured::<$texel>::fill_mask(planes, place, draws, run);
            }
        }
    )+};
}
lit!(
    Rgb565: Rgb565,
    Rgb565Be: Rgb565Be,
    Rgb565Le: Rgb565Le,
    Rgb888: Rgb565,
    Xrgb8888: Rgb565
);
