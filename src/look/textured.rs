//! Texels times a shade that is linear between vertices (H3-H8, K18, X2).
//!
//! A span is two passes over its pixels: a fetcher writes plain texels, then a tint multiplies them by the shade.
//! Where all corners are in full light, or the draw call has no texture, there is one.
//!
//! | triangle | texels | shade |
//! |---|---|---|
//! | small, affine within its budget | one word that steps | two words that step |
//! | others that have planes | planes of u and v, or of u/w, v/w and 1/w | a plane a channel, anew every 64 pixels |
//! | thin | from both ends of each span | likewise |
//!
//! Corners of one colour have one shade, on triangles of any size.

use super::course::Course;
use super::fetch::{copy_from, copy_part};
use super::fields::is_even;
use super::gouraud::{Planes as Shades, course, even_pair, pair_at, thin_shades, wide_shades};
use super::mapping::{Corner, Mapping, Method, Values};
use super::phong::Shine;
use super::shades::{shade_at, shade_planes};
use super::stride::Reach;
use super::tint::{Shade, Texel};
use super::word_plane::Near;
use super::{Fill, Look, Place, Primitive, States, ThinSpan};
use crate::geometry::Scale;
use crate::num::rolled;
use crate::pixel::PixelFormat;
use crate::scene::{Budget, DrawState, Draws, Holes, ORIGIN, Texture, Words};
use crate::span::{Size, Triangle};
use core::{marker::PhantomData, slice::from_mut};

/// The look of textures, shaded smoothly, in the pixel format `F`: [`Rgb565`](crate::pixel::Rgb565),
/// [`Rgb565Be`](crate::pixel::Rgb565Be) or [`Rgb565Le`](crate::pixel::Rgb565Le), and texels have the same order of bytes;
/// or [`Rgb888`](crate::pixel::Rgb888) or [`Xrgb8888`](crate::pixel::Xrgb8888), with texels as `Rgb565` has them.
#[derive(Clone, Copy, Debug)]
pub struct Textured<F>(PhantomData<F>);

/// What a triangle keeps of its texture and its shade.
#[derive(Clone, Copy, Debug)]
pub struct Planes {
    pub(super) shade: Shades,
    mapping: Mapping,
    /// The number of its draw state.
    draw: u16,
    /// How the shade's planes are evaluated; `None` in full light. [`Fill::Plain`] is none of these ways: that is what
    /// is lit at pixels.
    shaded: Option<Fill>,
    /// Whether there is a mapping.
    mapped: bool,
}

impl Planes {
    /// The shade along a span from a place's pixel on; `None` in full light.
    #[inline(always)]
    pub(super) fn shade_course(&self, place: Place) -> Option<Course> {
        let fill = self.shaded?;
        let mut course = course(fill, &self.shade, place);
        if fill == Fill::Small {
            // Half a pixel beyond, where it may have left its 16 bits.
            for (value, step) in course.value.iter_mut().zip(course.step) {
                *value = value.wrapping_sub((step >> 1) as u32) & 0x7FFF_FFFF;
            }
        }
        Some(course)
    }

    /// What transparent texels are, where there may be any.
    pub(super) fn holes(&self, draws: States<'_>) -> Option<Holes> {
        self.state(draws)?.holes.filter(|_| self.mapped)
    }

    /// The texels of a run of [`Fill::Plain`], by a call.
    #[inline(always)]
    pub(super) fn copy_plain(&self, place: Place, draws: States<'_>, run: &mut [u16]) {
        if let Some((texture, _)) = self.state(draws).and_then(DrawState::texture) {
            let plane = self.mapping.planes[0];
            copy_part(run, texture, place.value(plane), plane[1]);
        }
    }

    /// What the triangle's draw call says.
    #[inline(always)]
    pub(super) fn state<'d, 't>(&self, draws: &'d [DrawState<'t>]) -> Option<&'d DrawState<'t>> {
        draws.get(usize::from(self.draw))
    }

    /// What shines on the triangle's pixels, if anything does.
    #[inline(always)]
    pub(super) fn shine<'t>(&self, draws: &[DrawState<'t>]) -> Option<Shine<'t>> {
        match self.shaded {
            Some(Fill::Plain) => Shine::of(self.draw, draws),
            _ => None,
        }
    }

    /// Lights a triangle of a format that has normals for colours: all of it alike where that is so and pixels have 16 bits,
    /// for which a shade is as exact; else at pixels, and then `true`.
    #[inline(never)]
    pub(super) fn light<F: PixelFormat>(
        &mut self,
        triangle: &Triangle<'_>,
        draws: States<'_>,
    ) -> bool {
        let Some(shine) = Shine::of(self.draw, draws) else {
            return false;
        };
        let once = F::MADE_OF.is_one_word().then_some(&Scale::SHADE);
        let even = once.and_then(|scale| shine.even(triangle, scale));
        self.shaded = match even {
            Some(colour) => even_shade(colour, &mut self.shade),
            None => Some(Fill::Plain),
        };
        even.is_none()
    }
}

/// Planes of a shade that is one colour: how they are evaluated; `None` in full light.
#[inline(always)]
fn even_shade(colour: u32, planes: &mut Shades) -> Option<Fill> {
    const FULL: u32 = Scale::SHADE.full_word();
    if colour == FULL {
        return None;
    }
    even_pair(colour, planes);
    Some(Fill::Small)
}

/// Pixels between two evaluations of the shade's planes: steps are rounded to 2^-15 of full light.
const SHADE_RUN: u32 = 64;

impl<F: Texel> Textured<F> {
    /// The corners as a mapping wants them: fine places from the centre of the picture's first pixel.
    #[inline(always)]
    fn corners(triangle: &Triangle<'_>) -> [Corner; 3] {
        const FIRST: i32 = 64 * ORIGIN + 32;
        let corner = |i: usize| {
            let (vertex, texture) = (triangle.vertex[i], triangle.texture(i));
            let fine = texture.fine();
            Corner {
                x: 8 * (vertex.place & 0xFFFF) as i32 + fine[0] - FIRST,
                y: 8 * (vertex.place >> 16) as i32 + fine[1] - FIRST,
                depth: vertex.depth.clamp(1, i32::MAX as u32),
                texel: texture.texel(),
            }
        };
        [corner(0), corner(1), corner(2)]
    }

    /// Planes of the shade: how they are evaluated; `None` in full light.
    #[inline(always)]
    fn set_up_shade(of: &Primitive<'_>, planes: &mut Shades) -> Option<Fill> {
        let colour = of.triangle.vertex.map(|v| v.colour);
        if is_even(colour) {
            return even_shade(colour[0], planes);
        }
        let is_small = matches!(of.size, Size::Tiny | Size::Small);
        if is_small && shade_planes(&of.triangle.shares(of.area), colour, planes) {
            return Some(Fill::Small);
        }
        Some(wide_shades(of.triangle, planes))
    }

    /// The mapping of a triangle that [`Near`] does not serve at once; whether the triangle is too thin for planes.
    #[inline(never)]
    fn set_up_mapping(
        triangle: &Triangle<'_>,
        texture: &Texture<'_>,
        budget: Budget,
        planes: &mut Planes,
    ) -> bool {
        let word = texture.sampling.and_then(|sampling| sampling.word);
        let leveled =
            word.and_then(|of| of(triangle.vertex, &triangle.textures(), texture, budget));
        if let Some([at, right, below, level]) = leveled {
            let mapping = &mut planes.mapping;
            mapping.method = Method::Word;
            (mapping.planes[0], mapping.planes[1][0]) = ([at, right, below], level);
            planes.mapped = true;
            return false;
        }
        let corners = Self::corners(triangle);
        let Some(values) = Values::new(&corners, texture, budget) else {
            return false;
        };
        let mapping = &mut planes.mapping;
        let made = values.planes(&corners, triangle.frame, texture, budget, mapping);
        planes.mapped = made.is_some();
        !planes.mapped
    }

    /// The texels of a run, as they are; white without any.
    #[inline(always)]
    pub(super) fn texels(planes: &Planes, place: Place, draws: States<'_>, run: &mut [u16]) {
        let state = planes.state(draws);
        if let Some(square) = state.and_then(|state| state.square) {
            // Without a mapping none is short enough.
            if planes.mapping.draw_short(run, place, square) {
                return;
            }
        }
        Self::other_texels(planes, place, state, run);
    }

    /// The same of what is not short.
    #[inline(never)]
    fn other_texels(planes: &Planes, place: Place, state: Option<&DrawState<'_>>, run: &mut [u16]) {
        match state.and_then(DrawState::texture) {
            Some((texture, budget)) if planes.mapped => {
                let words = match F::ordered(1) {
                    1 => Words::Numbers,
                    _ => Words::Swapped,
                };
                planes.mapping.draw_long(run, place, texture, budget, words);
            }
            _ => run.fill(0xFFFF),
        }
    }

    /// [`fill_plain`](Look::fill_plain), called.
    #[inline(never)]
    fn fill_word(planes: &Planes, place: Place, draws: States<'_>, run: &mut [u16]) {
        Self::fill_plain(planes, place, draws, run);
    }

    /// The texels of a run, times its shade.
    #[inline(never)]
    fn fill_shaded(planes: &Planes, place: Place, draws: States<'_>, run: &mut [u16]) {
        Self::texels(planes, place, draws, run);
        Self::shade(planes, place, run, false);
    }

    /// Multiplies a run by the shade of a triangle within 64 pixels.
    #[inline(always)]
    fn shade_small(planes: &Shades, place: Place, run: &mut [u16]) {
        let [at, step] = pair_at(planes, place);
        if run.len() as u32 == place.pixels() {
            return F::tint(run, at, step);
        }
        Self::shade_part(run, place, [at, step]);
    }

    /// Multiplies a run by the shade of a triangle, dithered or not.
    #[inline(always)]
    fn shade(planes: &Planes, place: Place, run: &mut [u16], dithers: bool) {
        match planes.shaded {
            Some(Fill::Small) if dithers => {
                let [half, step] = pair_at(&planes.shade, place);
                let shade = half.minus_quarter(step.times(2));
                F::tint_dithered(run, shade, step, [place.column, place.line]);
            }
            Some(Fill::Small) => Self::shade_small(&planes.shade, place, run),
            Some(fill) => Self::shade_long(fill, &planes.shade, place, run, dithers),
            None => {}
        }
    }

    /// The same, called.
    #[inline(never)]
    fn shade_any(planes: &Planes, place: Place, run: &mut [u16], dithers: bool) {
        Self::shade(planes, place, run, dithers);
    }

    /// Multiplies a run by the shade of a triangle that is not within 64 pixels.
    #[inline(never)]
    fn shade_long(fill: Fill, planes: &Shades, place: Place, run: &mut [u16], dithers: bool) {
        let mut at = place;
        let mut rest = run;
        while !rest.is_empty() {
            let skipped = at.skipped() % SHADE_RUN;
            let pixels = rest.len().min((SHADE_RUN - skipped) as usize);
            let (run, more) = rest.split_at_mut(pixels);
            let column = at.column - skipped;
            let course = course(fill, planes, Place { column, ..at });
            let [half, step] = shade_at(&course, SHADE_RUN.min(at.end - column));
            let way = step.times(skipped);
            if dithers {
                // Each pixel has the shade of its own place.
                let mut still = course;
                still.step = [0; 3];
                let [own, _] = shade_at(&still, 1);
                F::tint_dithered(run, own.plus(way), step, [at.column, at.line]);
            } else {
                Self::shade_part(run, at, [half.plus(way), step]);
            }
            at.column += pixels as u32;
            rest = more;
        }
    }

    /// Multiplies a run by a shade, two pixels from an even number of pixels behind the span's first one alike.
    #[inline(never)]
    fn shade_part(run: &mut [u16], place: Place, [mut shade, step]: [Shade; 2]) {
        let pixels = run.len() as u32;
        let mut rest = run;
        if place.skipped() & 1 != 0 {
            let Some((one, more)) = rest.split_first_mut() else {
                return;
            };
            F::tint(from_mut(one), shade.minus(step), Shade::default());
            shade = shade.plus(step);
            rest = more;
        }
        let ends = place.column + pixels == place.end;
        let pairs = if ends { rest.len() } else { rest.len() & !1 };
        let (pairs, one) = rest.split_at_mut(pairs);
        F::tint(pairs, shade, step);
        if !one.is_empty() {
            let shade = shade.plus(step.times(pairs.len() as u32));
            F::tint(one, shade, Shade::default());
        }
    }
}

impl<F: Texel> Look for Textured<F> {
    type Pixel = F;
    type Planes = Planes;
    const EMPTY: Planes = Planes {
        shade: [0; 8],
        mapping: Mapping::EMPTY,
        draw: 0,
        shaded: Some(Fill::Plain), // A zero, as all of it.
        mapped: false,
    };
    const TEXTURED: bool = true;
    const SCALE: Scale = Scale::SHADE;

    #[inline(never)]
    fn set_up(of: &Primitive<'_>, planes: &mut Planes) -> Fill {
        let (triangle, draws) = (of.triangle, of.draws);
        planes.draw = draws.number_of(of.object);
        planes.shaded = Self::set_up_shade(of, &mut planes.shade);
        planes.mapped = false;
        planes.mapping.quick = 0;
        planes.mapping.reach = Reach::NONE;
        let mut is_plain = false;
        let mut thin = planes.shaded == Some(Fill::Thin);
        let state = draws.states.get(usize::from(planes.draw));
        if let Some((texture, budget)) = state.and_then(DrawState::texture) {
            let places = triangle.textures();
            let near = Near::new(triangle.vertex, &places);
            if let Some(plane) = near.word_plane(texture, texture.spare, budget) {
                planes.mapping.method = Method::Word;
                planes.mapping.planes[0] = plane;
                planes.mapped = true;
                is_plain = state.and_then(|state| state.square).is_some();
            } else {
                thin |= Self::set_up_mapping(triangle, texture, budget, planes);
            }
        }
        match planes.shaded {
            _ if thin => Fill::Thin,
            None | Some(Fill::Small) if is_plain => Fill::Plain,
            _ => Fill::Wide,
        }
    }

    fn set_up_thin(span: &ThinSpan<'_>, object: u16, draws: &Draws<'_>, planes: &mut Planes) {
        planes.draw = draws.number_of(object);
        thin_shades(span, &mut planes.shade);
        planes.shaded = Some(Fill::Wide);
        let texture = planes.state(draws.states).and_then(DrawState::texture);
        let Some(values) = texture.and_then(|(texture, budget)| {
            Values::new(&Self::corners(span.triangle), texture, budget)
        }) else {
            return;
        };
        planes.mapping.method = values.method;
        planes.mapping.base = values.base;
        planes.mapping.reach = Reach::NONE;
        for (plane, of) in planes.mapping.planes.iter_mut().zip(values.of) {
            let [at, step] = span.line(of.map(i64::from));
            *plane = [at, step, 0];
        }
        planes.mapped = true;
    }

    #[inline(always)]
    fn fill_plain(planes: &Planes, place: Place, draws: States<'_>, run: &mut [u16]) {
        let Some(square) = planes.state(draws).and_then(|state| state.square) else {
            return;
        };
        let plane = planes.mapping.planes[0];
        copy_from(run, square, place.value(plane), plane[1]);
        if planes.shaded.is_some() {
            Self::shade_small(&planes.shade, place, run);
        }
    }

    #[inline(never)]
    fn fill(fill: Fill, planes: &Planes, place: Place, draws: States<'_>, run: &mut [u16]) {
        Self::fill_slot(fill, planes, place, draws, run);
    }

    #[inline(always)]
    fn fill_slot(how: Fill, planes: &Planes, at: Place, draws: States<'_>, run: &mut [u16]) {
        if how == Fill::Plain {
            return Self::fill_word(planes, at, draws, run);
        }
        if planes.shaded.is_none() {
            return Self::texels(planes, at, draws, run);
        }
        Self::fill_shaded(planes, at, draws, run);
    }

    fn halves(fill: Fill, planes: &Planes, pixels: u32) -> u32 {
        match (fill, planes.shaded) {
            (Fill::Plain, shade) => 1 + u32::from(shade.is_some()),
            (_, None) if planes.mapping.is_quick(pixels, true) => 2,
            (_, Some(Fill::Small)) if planes.mapping.is_quick(pixels, false) => 2,
            _ => 4,
        }
    }

    #[inline(never)]
    fn fill_opaque(
        fill: Fill,
        planes: &Planes,
        place: Place,
        draws: States<'_>,
        dithers: bool,
        run: &mut [u16],
    ) -> u32 {
        let holes = planes.holes(draws);
        if holes.is_none() && !dithers {
            Self::fill(fill, planes, place, draws, run);
            return u32::MAX;
        }
        Self::texels(planes, place, draws, run);
        if let Some(holes) = holes.filter(|holes| holes.are_filled) {
            let mut colours = [0xFFFF; 32];
            let count = run.len().min(colours.len());
            Self::shade_any(planes, place, &mut colours[..count], dithers);
            for (texel, &colour) in run.iter_mut().zip(&colours) {
                rolled();
                if *texel == holes.key {
                    *texel = colour;
                }
            }
            return u32::MAX;
        }
        let opaque = holes.map_or(u32::MAX, |holes| holes.opaque(run));
        Self::shade_any(planes, place, run, dithers);
        opaque
    }

    #[inline(never)]
    fn fill_mask(planes: &Planes, place: Place, draws: States<'_>, run: &mut [u16]) {
        let texture = planes.state(draws).and_then(DrawState::texture);
        let (true, Some((texture, budget))) = (planes.mapped, texture) else {
            return;
        };
        if let Some(mask) = texture.mask() {
            let mapping = &planes.mapping;
            mapping.draw_as(run, place, &mask, budget, Words::Masks);
        }
    }
}
