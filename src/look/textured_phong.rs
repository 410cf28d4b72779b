//! Texels lit at each pixel: [`Phong`](super::Phong) with a texture (K10, H8).
//!
//! Texels have 16 bits, as numbers ([`Rgb565`]), whatever the pixels are. A span's texels are fetched as for
//! [`Textured`], some at a time; each times the draw call's colour is the colour that light falls on in its pixel.

use super::gouraud::wide_shades;
use super::phong::{light, steps_of, word_of};
use super::textured::{Planes, Textured};
use super::textured_wide::levels;
use super::{Fill, Paint, Place, ThinSpan};
use crate::geometry::Scale;
use crate::pixel::{Pixel, Rgb565};
use crate::scene::{DrawState, WordOfNormal};
use crate::span::{Size, Triangle};
use core::marker::PhantomData;

/// The look of textures lit at each pixel, in the pixel format `F`; texels are as [`Rgb565`] has them, and what shines
/// is [`Draw::lamps`](crate::scene::Draw::lamps).
///
/// [`Replace`](crate::scene::Application::Replace) is texels that no light falls on.
#[derive(Clone, Copy, Debug)]
pub struct TexturedPhong<F>(PhantomData<F>);

/// The look that fetches texels; a vertex's colour is its normal, and the planes of the shade are the normal's.
type Texels = Textured<Rgb565>;

/// Texels that are fetched before any is lit.
const AT_ONCE: usize = 64;

/// A texel of 8 bits a channel times a colour in 16.16 steps, and one half.
fn times(texel: [u8; 3], colour: [u32; 3]) -> [i32; 3] {
    [0, 1, 2].map(|i| {
        let product = u32::from(texel[i]) * colour[i];
        // A 255th of it, but for three units of 2^-16 steps.
        ((product >> 8) + (product >> 16) + (product >> 24) + (1 << 15)) as i32
    })
}

/// Lights pixels by their texels.
fn lit<F: Pixel>(
    state: &DrawState<'_>,
    planes: &Planes,
    place: Place,
    texels: &[u16],
    run: &mut [F::Word],
) {
    let colour = steps_of::<F>(state);
    let mut texels = texels.iter();
    light::<F>(state, planes.shades(), place, run, || {
        times(
            texels.next().map_or([255; 3], |&texel| levels(texel)),
            colour,
        )
    });
}

impl<F: Pixel> Paint for TexturedPhong<F> {
    type Pixel = F;
    type Planes = Planes;
    const EMPTY: Planes = Texels::EMPTY;
    const TEXTURED: bool = true;
    const LIT_AT_PIXELS: Option<WordOfNormal> = Some(word_of);
    const SCALE: Scale = Scale::new(F::STEPS);

    fn set_up(
        triangle: &Triangle<'_>,
        object: u16,
        size: Size,
        area: u32,
        draws: &[DrawState<'_>],
        planes: &mut Planes,
    ) -> Fill {
        match Texels::set_up(triangle, object, size, area, draws, planes) {
            Fill::Thin => Fill::Thin,
            // Those of small triangles have 15 bits.
            _ => wide_shades(triangle, planes.shades_mut()),
        }
    }

    fn set_up_thin(span: &ThinSpan<'_>, object: u16, draws: &[DrawState<'_>], planes: &mut Planes) {
        Texels::set_up_thin(span, object, draws, planes);
    }

    fn fill_plain(planes: &Planes, place: Place, draws: &[DrawState<'_>], run: &mut [F::Word]) {
        Self::fill(Fill::Wide, planes, place, draws, run);
    }

    #[inline(never)]
    fn fill(_: Fill, planes: &Planes, place: Place, draws: &[DrawState<'_>], run: &mut [F::Word]) {
        let Some(state) = planes.state(draws) else {
            return;
        };
        let mut texels = [0; AT_ONCE];
        let mut place = place;
        for run in run.chunks_mut(AT_ONCE) {
            let texels = &mut texels[..run.len()];
            Texels::texels(planes, place, draws, texels);
            lit::<F>(state, planes, place, texels, run);
            place.column += run.len() as u32;
        }
    }

    fn fill_dithered(
        fill: Fill,
        planes: &Planes,
        place: Place,
        draws: &[DrawState<'_>],
        run: &mut [F::Word],
    ) {
        Self::fill(fill, planes, place, draws, run);
    }

    #[inline(never)]
    fn fill_holed(
        fill: Fill,
        planes: &Planes,
        place: Place,
        draws: &[DrawState<'_>],
        run: &mut [F::Word],
    ) -> u32 {
        let (Some(state), Some(holes)) = (planes.state(draws), planes.holes(draws)) else {
            Self::fill(fill, planes, place, draws, run);
            return u32::MAX;
        };
        let mut texels = [0; 32];
        let count = run.len().min(texels.len());
        let texels = &mut texels[..count];
        Texels::texels(planes, place, draws, texels);
        if !holes.are_filled {
            lit::<F>(state, planes, place, texels, run);
            return holes.opaque(texels);
        }
        lit::<F>(state, planes, place, &[], run);
        for (pixel, &texel) in run.iter_mut().zip(texels.iter()) {
            if texel != holes.key {
                *pixel = F::from_rgb8(levels(texel));
            }
        }
        u32::MAX
    }

    #[inline(always)]
    fn lacks_texture(planes: &Planes, draws: &[DrawState<'_>]) -> bool {
        Texels::lacks_texture(planes, draws)
    }
}
