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

use super::gouraud::{Course, Planes as Shades, course, plane_shades, thin_shades};
use super::mapping::{Corner, Mapping, Method, Values};
use super::ramp::nearer_bits;
use super::tint::{Shade, tint, tint_swapped};
use super::{Depths, Fill, Paint, Place, ThinSpan};
use crate::composite::{Rgb565, Rgb565Bytes};
use crate::geometry::Scale;
use crate::pixel::Pixel;
use crate::scene::{DrawState, ORIGIN};
use crate::span::{Size, Triangle};
use core::marker::PhantomData;

/// The look of textures, shaded smoothly, in the pixel format `F`: [`Rgb565`] or
/// [`Rgb565Be`](crate::Rgb565Be). Texels have the same order of bytes.
#[derive(Clone, Copy, Debug)]
pub struct Textured<F>(PhantomData<F>);

/// A pixel of 16 bits that can be tinted.
pub trait Texel: Pixel<Word = u16> {
    /// Multiplies a run by a shade, which is that of the place half a pixel beyond the first.
    fn tint(run: &mut [u16], shade: Shade, step: Shade);
}

impl Texel for Rgb565 {
    #[inline(always)]
    fn tint(run: &mut [u16], shade: Shade, step: Shade) {
        tint(run, shade, step);
    }
}

impl<const BIG: bool> Texel for Rgb565Bytes<BIG> {
    #[inline(always)]
    fn tint(run: &mut [u16], shade: Shade, step: Shade) {
        if BIG == cfg!(target_endian = "big") {
            tint(run, shade, step);
        } else {
            tint_swapped(run, shade, step);
        }
    }
}

/// What a triangle keeps of its texture and its shade.
#[derive(Clone, Copy, Debug)]
pub struct Planes {
    shade: Shades,
    mapping: Mapping,
    /// The number of its draw state.
    draw: u16,
    /// How the shade's planes are evaluated; `None` in full light.
    shaded: Option<Fill>,
    /// Whether there is a mapping.
    mapped: bool,
}

/// Pixels between two evaluations of the shade's planes: steps are rounded to 2^-15 of full light.
const SHADE_RUN: usize = 64;

impl<F: Texel> Textured<F> {
    /// The draw state of an object: that of the last call that began at it or before.
    #[inline(always)]
    fn draw_of(object: u16, draws: &[DrawState<'_>]) -> u16 {
        if draws.len() < 2 {
            return 0;
        }
        let after = draws.partition_point(|draw| draw.first <= object);
        after.saturating_sub(1) as u16
    }

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

    /// Whether all corners are in full light.
    #[inline(always)]
    fn is_full(triangle: &Triangle<'_>) -> bool {
        const FULL: u32 = Scale::SHADE.full_word();
        triangle.vertex.iter().all(|v| v.colour == FULL)
    }

    /// Multiplies a run by the shade.
    #[inline(always)]
    fn shade(fill: Fill, planes: &Shades, place: Place, run: &mut [u16]) {
        if fill == Fill::Small && run.len() <= SHADE_RUN {
            let [shade, step] = shade_at(&course(fill, planes, place));
            return F::tint(run, shade, step);
        }
        Self::shade_long(fill, planes, place, run);
    }

    #[inline(never)]
    fn shade_long(fill: Fill, planes: &Shades, place: Place, run: &mut [u16]) {
        let columns = (place.column..).step_by(SHADE_RUN);
        for (run, column) in run.chunks_mut(SHADE_RUN).zip(columns) {
            let [shade, step] = shade_at(&course(fill, planes, Place { column, ..place }));
            F::tint(run, shade, step);
        }
    }
}

/// The shade half a pixel beyond a place, and its step.
#[inline(always)]
fn shade_at(course: &Course) -> [Shade; 2] {
    let half = |i: usize| course.value[i].wrapping_add((course.step[i] >> 1) as u32);
    let rounded = |i: usize| (course.step[i] + (1 << 14)) >> 15;
    let shade = Shade {
        red_blue: half(0) << 1 & 0xFFFF_0000 | half(2) >> 15 & 0xFFFF,
        green: half(1) << 1 & 0xFFFF_0000,
    };
    let step = Shade {
        red_blue: ((rounded(0) << 16) as u32).wrapping_add(rounded(2) as u32),
        green: (rounded(1) << 16) as u32,
    };
    [shade, step]
}

impl<F: Texel> Paint for Textured<F> {
    type Pixel = F;
    type Planes = Planes;
    const EMPTY: Planes = Planes {
        shade: [0; 9],
        mapping: Mapping::EMPTY,
        draw: 0,
        shaded: None,
        mapped: false,
    };
    const TEXTURED: bool = true;
    const ANY_RUNS: bool = false;
    const SCALE: Scale = Scale::SHADE;

    #[inline(never)]
    fn set_up(
        triangle: &Triangle<'_>,
        object: u16,
        size: Size,
        area: u32,
        draws: &[DrawState<'_>],
        planes: &mut Planes,
    ) -> Fill {
        planes.draw = Self::draw_of(object, draws);
        planes.shaded = None;
        let mut thin = false;
        if !Self::is_full(triangle) {
            let fill = plane_shades(triangle, size, area, &mut planes.shade);
            thin = fill == Fill::Thin;
            planes.shaded = Some(fill);
        }
        planes.mapped = false;
        let state = draws.get(usize::from(planes.draw));
        if let Some((texture, budget)) = state.and_then(DrawState::texture) {
            let corners = Self::corners(triangle);
            match Mapping::new(&corners, texture, budget) {
                Some(mapping) => {
                    planes.mapping = mapping;
                    planes.mapped = true;
                }
                None => thin |= Values::new(&corners, texture, budget).is_some(),
            }
        }
        let is_plain = planes.mapping.method == Method::Word || !planes.mapped;
        match planes.shaded {
            _ if thin => Fill::Thin,
            None | Some(Fill::Small) if is_plain => Fill::Plain,
            _ => Fill::Wide,
        }
    }

    fn set_up_thin(span: &ThinSpan<'_>, object: u16, draws: &[DrawState<'_>], planes: &mut Planes) {
        *planes = Self::EMPTY;
        planes.draw = Self::draw_of(object, draws);
        thin_shades(span, &mut planes.shade);
        planes.shaded = Some(Fill::Wide);
        let state = draws.get(usize::from(planes.draw));
        let Some((texture, budget)) = state.and_then(DrawState::texture) else {
            return;
        };
        let Some(values) = Values::new(&Self::corners(span.triangle), texture, budget) else {
            return;
        };
        planes.mapping.method = values.method;
        planes.mapping.base = values.base;
        for (plane, of) in planes.mapping.planes.iter_mut().zip(values.of) {
            let [at, step] = span.line(of.map(i64::from));
            *plane = [at, step, 0];
        }
        planes.mapped = true;
    }

    #[inline(always)]
    fn fill_plain(planes: &Planes, place: Place, draws: &[DrawState<'_>], run: &mut [u16]) {
        let state = draws.get(usize::from(planes.draw));
        match state.and_then(DrawState::texture) {
            Some((texture, budget)) if planes.mapped => {
                let at = [place.column, place.line];
                planes.mapping.draw(run, at, texture, budget);
            }
            _ => run.fill(0xFFFF),
        }
        if let Some(fill) = planes.shaded {
            Self::shade(fill, &planes.shade, place, run);
        }
    }

    #[inline(never)]
    fn fill(_: Fill, planes: &Planes, place: Place, draws: &[DrawState<'_>], run: &mut [u16]) {
        Self::fill_plain(planes, place, draws, run);
    }

    #[inline(never)]
    fn fill_nearer(
        fill: Fill,
        planes: &Planes,
        place: Place,
        draws: &[DrawState<'_>],
        run: &mut [u16],
        depth: Depths<'_>,
    ) {
        nearer_bits(run, depth, |from, run| {
            let place = Place {
                column: place.column + from,
                ..place
            };
            Self::fill(fill, planes, place, draws, run);
        });
    }

    #[inline(always)]
    fn lacks_texture(planes: &Planes, draws: &[DrawState<'_>]) -> bool {
        let state = draws.get(usize::from(planes.draw));
        !planes.mapped && state.and_then(DrawState::texture).is_some()
    }
}
