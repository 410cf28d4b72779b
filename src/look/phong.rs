//! Light at each pixel: normals linear between vertices, lit anew in every pixel (K10).
//!
//! In place of a colour, a vertex's word has its normal as the camera sees it: three planes take its components along
//! the line, exact in each pixel, and there it is lit, whatever its length, by
//! [`PixelLamps`](crate::light::PixelLamps), which is the formula of [`Lighting`](crate::light::Lighting). The way to
//! the eye is the ray through the pixel, so no depth is needed.
//!
//! | | |
//! |---|---|
//! | a vertex's normal | 11, 11 and 10 bits: 1/2000 of its length, 1/1000 along the way ahead |
//! | a thin triangle | exact at both ends of each span, linear between |
//!
//! A face of one normal is lit once, and drawn as one of that colour, where light only multiplies it: nothing is mirrored
//! or shines by itself, and no channel stops at full level.
//!
//! The colour is that of the draw call. Meshes without normals are lit as if they all looked at the eye. A call without
//! lamps is drawn as [`Gouraud`] draws it, bit for bit.

use super::dither::parts_of;
use super::fields::{is_even, wide_fields};
use super::gouraud::{Gouraud, Planes as Three, even_pair, thin_shades, wide_at, wide_shades};
use super::ramp::go_on;
use super::{Fill, Look, Place, Primitive, States, ThinSpan};
use crate::geometry::{Affine, PixelLamps, Scale};
use crate::pixel::{PixelFormat, threshold};
use crate::scene::{DrawState, Draws, WordOfNormal};
use crate::span::Triangle;
use core::marker::PhantomData;

/// The look of light at each pixel, in the pixel format `F`; what shines is
/// [`Draw::lamps`](crate::scene::Draw::lamps), and a call without them is drawn as [`Gouraud`] draws it.
#[derive(Clone, Copy, Debug)]
pub struct Phong<F>(PhantomData<F>);

/// What a triangle keeps: its normal or its colour, and the number of its draw state.
#[derive(Clone, Copy, Debug)]
pub struct Planes {
    of: Three,
    draw: u16,
    /// Kept, since planes that are made for a dither alone have no number.
    is_lit: bool,
    /// Whether light gave all of it one colour.
    is_even: bool,
}

/// A normal of length 1 in a field of 11 bits, which has 1024 in its middle; in one of 10 bits it is half of that.
const LENGTH: i32 = 1000;
/// Nothing in each field, with the bits below it that planes have, 15 of which are rounded off.
const MIDDLE: u32 = (1 << 30) - (1 << 14);

/// The word of a normal of a model, as the camera sees it.
pub(crate) fn word_of(turn: &Affine, normal: Option<[i16; 3]>) -> u32 {
    // What has none looks at the eye.
    let [x, y, z] = normal.map_or([0, 0, -1 << 14], |normal| turn.unit_normal(normal));
    // Half a unit, and the middle of the field.
    let field = |c: i16, length: i32| ((i32::from(c) * length + (1 << 13)) >> 14) as u32;
    let eleven = |c: i16| field(c, LENGTH).wrapping_add(1024) & 0x7FF;
    let ten = field(z, LENGTH / 2).wrapping_add(512) & 0x3FF;
    eleven(x) << 21 | ten << 11 | eleven(y)
}

/// The normal of three planes' values, with 15 fraction bits: no component of a normal of length 1 is beyond 32,000.
#[inline(always)]
fn normal_of(value: [u32; 3]) -> [i16; 3] {
    value.map(|v| (v.wrapping_sub(MIDDLE) as i32 >> 15) as i16)
}

/// What shines on the pixels of a draw call, and the colour that it falls on.
pub(super) struct Shine<'t> {
    lamps: &'t PixelLamps,
    colour: [u8; 3],
}

impl<'t> Shine<'t> {
    /// That of the draw call of this number; none where the call has no lamps.
    #[inline(always)]
    pub(super) fn of(draw: u16, draws: &[DrawState<'t>]) -> Option<Self> {
        let DrawState { lamps, colour, .. } = *draws.get(usize::from(draw))?;
        lamps.map(|lamps| Self { lamps, colour })
    }

    /// The word of the colour of a triangle, if light gives all of it the same.
    #[inline(never)]
    pub(super) fn even(&self, triangle: &Triangle<'_>, scale: &Scale) -> Option<u32> {
        let normals = triangle.vertex.map(|v| v.colour);
        if !is_even(normals) {
            return None;
        }
        let normal = normal_of(wide_fields(normals[0]));
        self.lamps.matt(normal, self.colour, scale)
    }

    /// The call's colour in channels of 16 bits of the format.
    #[inline(always)]
    pub(super) fn channels<F: PixelFormat>(&self) -> [u32; 3] {
        [0, 1, 2].map(|i| {
            let full = u32::from(F::STEPS[i]) << F::STEPS[i].leading_zeros();
            let product = u32::from(self.colour[i]) * full;
            // A 255th of it, to the nearest.
            (product + (product >> 8) + (product >> 16) + 128) >> 8
        })
    }
}

/// Lights a run of pixels from a place on, dithered or not; `own` is the colour of each, in channels of 16 bits.
#[inline(always)]
pub(super) fn light<F: PixelFormat>(
    shine: &Shine<'_>,
    planes: &Three,
    place: Place,
    dithers: bool,
    run: &mut [F::Word],
    mut own: impl FnMut() -> [u32; 3],
) {
    // What is dithered is dithered in 16 bits.
    let dithers = dithers && F::MADE_OF.is_one_word();
    let [mut value, steps] = wide_at(planes, place);
    for (pixel, column) in run.iter_mut().zip(place.column..) {
        let at = [column, place.line];
        let lit = shine.lamps.lit(normal_of(value), at, own(), F::STEPS);
        // Parts of 32 of a step, 16 for the nearest: below a whole one, so that no channel gets more than 16 bits.
        let mut parts = 16;
        if dithers {
            parts += threshold(column, place.line);
        }
        let raised = |i: usize| lit[i] + parts_of(parts, F::STEPS[i]) as u32;
        *pixel = F::pack_words(raised(0) << 16 | raised(2), raised(1) << 16);
        go_on(&mut value, steps, 1);
    }
}

/// Lights a run of pixels from a place on, dithered or not.
#[inline(never)]
fn lit<F: PixelFormat>(
    planes: &Planes,
    place: Place,
    dithers: bool,
    draws: States<'_>,
    run: &mut [F::Word],
) {
    if let Some(shine) = Shine::of(planes.draw, draws) {
        let colour = shine.channels::<F>();
        light::<F>(&shine, &planes.of, place, dithers, run, || colour);
    }
}

impl Planes {
    /// Says whose triangle they are, and whether it is lit at pixels; what shines on it.
    fn begin<'t>(&mut self, object: u16, draws: &Draws<'t>) -> Option<Shine<'t>> {
        self.draw = draws.number_of(object);
        let shine = Shine::of(self.draw, draws.states);
        (self.is_lit, self.is_even) = (shine.is_some(), false);
        shine
    }
}

impl<F: PixelFormat> Look for Phong<F> {
    type Pixel = F;
    type Planes = Planes;
    const EMPTY: Planes = Planes {
        of: [0; 8],
        draw: 0,
        is_lit: false,
        is_even: false,
    };
    const TEXTURED: bool = false;
    const LIT_AT_PIXELS: Option<WordOfNormal> = Some(word_of);
    const SCALE: Scale = Scale::new(F::STEPS);

    fn set_up(of: &Primitive<'_>, planes: &mut Planes) -> Fill {
        let Some(shine) = planes.begin(of.object, of.draws) else {
            return Gouraud::<F>::set_up(of, &mut planes.of);
        };
        let Some(colour) = shine.even(of.triangle, &Self::SCALE) else {
            return wide_shades(of.triangle, &mut planes.of);
        };
        (planes.is_lit, planes.is_even) = (false, true);
        Gouraud::<F>::even_word(colour, &mut planes.of)
    }

    fn set_up_thin(span: &ThinSpan<'_>, object: u16, draws: &Draws<'_>, planes: &mut Planes) {
        planes.begin(object, draws);
        thin_shades(span, &mut planes.of);
    }

    // No triangle that is lit at pixels is plain.
    #[inline(always)]
    fn fill_plain(planes: &Planes, at: Place, draws: States<'_>, run: &mut [F::Word]) {
        Gouraud::<F>::fill_plain(&planes.of, at, draws, run);
    }

    fn fill(fill: Fill, planes: &Planes, at: Place, draws: States<'_>, run: &mut [F::Word]) {
        Self::fill_opaque(fill, planes, at, draws, false, run);
    }

    fn set_up_dithered(triangle: &Triangle<'_>, planes: &mut Planes) -> Option<Fill> {
        if planes.is_even {
            even_pair(planes.of[0], &mut planes.of);
            return Some(Fill::Small);
        }
        Gouraud::<F>::set_up_dithered(triangle, &mut planes.of)
    }

    fn fill_opaque(
        fill: Fill,
        planes: &Planes,
        at: Place,
        draws: States<'_>,
        dithers: bool,
        run: &mut [F::Word],
    ) -> u32 {
        if planes.is_lit {
            lit::<F>(planes, at, dithers, draws, run);
            return u32::MAX;
        }
        Gouraud::<F>::fill_opaque(fill, &planes.of, at, draws, dithers, run)
    }
}
