//! Texels lit at each pixel: [`Phong`](super::Phong) with a texture (K10, H8).
//!
//! Texels are those of [`Textured`] in the same format: of 16 bits. A span's texels are fetched as for that look, some at
//! a time; each times the draw call's colour is the colour that light falls on in its pixel. A call without lamps is
//! drawn as [`Textured`] draws it, bit for bit.

use super::gouraud::wide_shades;
use super::phong::{Shine, light, word_of};
use super::textured::{Planes, Textured};
use super::textured_wide::{each_holed, each_texels};
use super::tint::Texel;
use super::{Fill, Look, Place, Primitive, States, ThinSpan, WordOf};
use crate::geometry::Scale;
use crate::num::of_255;
use crate::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888, Xrgb8888};
use crate::scene::{Draws, WordOfNormal};
use core::marker::PhantomData;

/// The look of textures lit at each pixel, in the pixel format `F`; texels are as for [`Textured`], and what shines is
/// [`Draw::lamps`](crate::scene::Draw::lamps). A call without them is drawn as [`Textured`] draws it, and so is
/// [`Replace`](crate::scene::Application::Replace), texels that no light falls on.
#[derive(Clone, Copy, Debug)]
pub struct TexturedPhong<F>(PhantomData<F>);

/// What a level of 255 is multiplied by for 256 times that part of a channel of 16 bits: all of it for 255, and less
/// than a unit more for others.
#[inline(always)]
fn for_levels(channel: u32) -> u32 {
    channel + of_255(channel + 127)
}

/// Sets a triangle up; of one that is lit a vertex's colour is its normal, and the planes of the shade are the normal's.
fn set_up<F: PixelFormat, T: Texel>(of: &Primitive<'_>, planes: &mut Planes) -> Fill {
    let fill = Textured::<T>::set_up(of, planes);
    // The planes of small triangles have too few bits.
    if fill != Fill::Thin && planes.light::<F>(of.triangle, of.draws.states) {
        return wide_shades(of.triangle, &mut planes.shade);
    }
    fill
}

/// Lights pixels by their texels, which are words of `T`, dithered or not; those without one by white.
fn lit<F: PixelFormat, T: Texel>(
    shine: &Shine<'_>,
    planes: &Planes,
    place: Place,
    dithers: bool,
    texels: &[u16],
    run: &mut [F::Word],
) {
    let colour = shine.channels::<F>().map(for_levels);
    let mut texels = texels.iter();
    light::<F>(shine, &planes.shade, place, dithers, run, || {
        let texel = texels.next().map_or([255; 3], |&texel| T::to_rgb8(texel));
        [0, 1, 2].map(|i| (u32::from(texel[i]) * colour[i]) >> 8)
    });
}

#[inline(never)]
fn shone<F: PixelFormat, T: Texel>(
    shine: &Shine<'_>,
    planes: &Planes,
    place: Place,
    dithers: bool,
    draws: States<'_>,
    run: &mut [F::Word],
) {
    let how = Fill::Wide;
    each_texels::<_, T>(how, planes, place, draws, run, |place, texels, run| {
        lit::<F, T>(shine, planes, place, dithers, texels, run);
    });
}

/// The same of a run of up to 32 pixels whose texture may have transparent texels; a bit for each that is not a hole.
#[inline(never)]
fn opaque<F: PixelFormat, T: Texel>(
    shine: &Shine<'_>,
    planes: &Planes,
    place: Place,
    dithers: bool,
    draws: States<'_>,
    run: &mut [F::Word],
) -> u32 {
    let Some(holes) = planes.holes(draws) else {
        shone::<F, T>(shine, planes, place, dithers, draws, run);
        return u32::MAX;
    };
    each_holed::<F, T>(planes, place, draws, holes, run, |place, texels, run| {
        lit::<F, T>(shine, planes, place, dithers, texels, run);
    })
}

/// The look in a format, of texels of another or the same.
macro_rules! lit {
    ($($format:ty: $texel:ty),+) => {$(
        impl Look for TexturedPhong<$format> {
            type Pixel = $format;
            type Planes = Planes;
            const EMPTY: Planes = Textured::<$format>::EMPTY;
            const TEXTURED: bool = true;
            const LIT_AT_PIXELS: Option<WordOfNormal> = Some(word_of);
            const SCALE: Scale = Textured::<$format>::SCALE;

            fn set_up(of: &Primitive<'_>, planes: &mut Planes) -> Fill {
                set_up::<$format, $texel>(of, planes)
            }

            fn set_up_thin(of: &ThinSpan<'_>, object: u16, draws: &Draws<'_>, to: &mut Planes) {
                Textured::<$texel>::set_up_thin(of, object, draws, to);
                to.light::<$format>(of.triangle, draws.states);
            }

            // No triangle that is lit at pixels is plain.
            #[inline(always)]
            fn fill_plain(planes: &Planes, at: Place, draws: States<'_>, run: &mut [WordOf<Self>]) {
                Textured::<$format>::fill_plain(planes, at, draws, run);
            }

            fn fill(
                fill: Fill,
                planes: &Planes,
                place: Place,
                draws: States<'_>,
                run: &mut [WordOf<Self>],
            ) {
                match planes.shine(draws) {
                    Some(shine) => shone::<$format, $texel>(&shine, planes, place, false, draws, run),
                    None => Textured::<$format>::fill(fill, planes, place, draws, run),
                }
            }

            fn fill_opaque(
                fill: Fill,
                planes: &Planes,
                place: Place,
                draws: States<'_>,
                dithers: bool,
                run: &mut [WordOf<Self>],
            ) -> u32 {
                match planes.shine(draws) {
                    Some(shine) => opaque::<$format, $texel>(&shine, planes, place, dithers, draws, run),
                    None => Textured::<$format>::fill_opaque(fill, planes, place, draws, dithers, run),
                }
            }

            fn fill_mask(planes: &Planes, at: Place, draws: States<'_>, run: &mut [u16]) {
                Textured::<$texel>::fill_mask(planes, at, draws, run);
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

#[cfg(test)]
mod tests {
    use super::for_levels;

    /// Kills: a 255th that is rounded down, and one of too few bits.
    #[test]
    fn levels_of_a_channel_are_parts_of_it() {
        for channel in 0..=255 << 8 {
            let factor = for_levels(channel);
            assert_eq!((255 * factor) >> 8, channel);
            for level in (0..=255).step_by(15) {
                let (got, exact) = ((level * factor) >> 8, level * channel / 255);
                assert!(got == exact || got == exact + 1, "{level} of {channel}");
            }
        }
    }
}
