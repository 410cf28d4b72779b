//! Colours linear between vertices (K10, P3).
//!
//! | triangle | planes | error, units of a vertex's colour |
//! |---|---|---|
//! | of one colour | that colour | none |
//! | within 25 pixels, 16-bit pixels | one word of three fields | below half a step of blue: 16 |
//! | within 64 pixels | two words with 16 bits a channel, packed anew every 16 pixels | 4 |
//! | larger | a plane a channel with 20 fraction bits more; along spans of 16-bit pixels as above | 0.02; 1/64 each 16 pixels |
//! | thin | none: exact at both ends of each span, linear between | |
//!
//! Vertices keep half a step from either end of a field, so no colour leaves its field (P4).

use super::course::{Course, InParts};
use super::dither;
use super::fields::{fields, is_even, is_flat, packed_step, wide_fields};
use super::mapping::range;
use super::ramp::{self, Packed, Pair};
use super::{Fill, Look, Place, Primitive, States, ThinSpan};
use crate::geometry::Scale;
use crate::pixel::PixelFormat;
use crate::scene::{Draws, Vertex};
use crate::span::{Rise, Shares, Size, Triangle};
use core::marker::PhantomData;

/// The look of smooth colours, in the pixel format `F`.
#[derive(Clone, Copy, Debug)]
pub struct Gouraud<F>(PhantomData<F>);

/// What a triangle keeps of its colours. Plain: one word at the picture's first pixel, its steps across and
/// down. Small, and plain of formats of two words: the same of red and blue, then of green, then the packed step. Wide:
/// see [`keep_wide`].
pub type Planes = [u32; 8];

/// Bits of a plane's value at the first pixel that [`Fill::Wide`] has for others: what is left has 11 fraction bits and more.
const LENT: u32 = (1 << 10) - 1;

/// Keeps three planes, each a value at the picture's first pixel and its steps across and down, in eight words: the
/// last step down lies in the lowest bits of the values.
#[inline(always)]
fn keep_wide(of: [[u32; 3]; 3], planes: &mut Planes) {
    let [[red, rx, ry], [green, gx, gy], [blue, bx, by]] = of;
    let lent = |value: u32, bits: u32| value & !LENT | bits & LENT;
    let (red, green) = (lent(red, by >> 22), lent(green, by >> 12));
    *planes = [red, rx, ry, green, gx, gy, lent(blue, by >> 2), bx];
}

/// Three planes of [`Fill::Wide`] at a place, and their steps across.
#[inline(always)]
pub(super) fn wide_at(planes: &Planes, place: Place) -> [[u32; 3]; 2] {
    let [red, rx, ry, green, gx, gy, blue, bx] = *planes;
    let by = red << 22 | (green & LENT) << 12 | (blue & LENT) << 2;
    let red = place.value([red, rx, ry]);
    let green = place.value([green, gx, gy]);
    let blue = place.value([blue, bx, by]);
    [[red, green, blue], [rx, gx, bx]]
}

impl<F: PixelFormat> Gouraud<F> {
    /// One word of three fields.
    #[inline(never)]
    fn packed_planes(vertex: [&Vertex; 3], area: u32, planes: &mut Planes) {
        let [a, b, c] = vertex.map(|v| v.colour);
        if is_even([a, b, c]) {
            Self::even_word(a, planes);
            return;
        }
        let shares = Shares::new(area, vertex.map(|v| v.place)).cut::<5>();
        let rise = |shift: u32, bits: u32| {
            let field = |w: u32| (w >> shift & bits) as i32;
            shares.rise::<5, 0>(field(b) - field(a), field(c) - field(a))
        };
        let (red, blue, green) = (rise(21, 0x7FF), rise(11, 0x3FF), rise(0, 0x7FF));
        let join = |of: fn(&Rise) -> i32| {
            ((of(&red) as u32) << 21)
                .wrapping_add((of(&blue) as u32) << 11)
                .wrapping_add(of(&green) as u32)
        };
        planes[0] = a.wrapping_add(join(|r| r.at));
        planes[1] = join(|r| r.dx);
        planes[2] = join(|r| r.dy);
    }

    /// Planes of all that are not tiny, or not in one word.
    #[inline(never)]
    fn other_planes(triangle: &Triangle<'_>, size: Size, area: u32, planes: &mut Planes) -> Fill {
        let colour = triangle.vertex.map(|v| v.colour);
        if is_even(colour) {
            return Self::even_word(colour[0], planes);
        }
        if size == Size::Sharp && F::MADE_OF.is_one_word() && is_flat(colour) {
            Self::packed_planes(triangle.vertex, area, planes);
            return Fill::Plain;
        }
        if matches!(size, Size::Sharp | Size::Thin) {
            if let Some(fill) = Self::even_planes(colour, planes) {
                return fill;
            }
        }
        plane_shades(triangle, size, area, planes)
    }

    /// One colour for a thin triangle whose corners differ by less than a step of the format: of 5 bits, or of 8.
    #[inline(never)]
    fn even_planes(colour: [u32; 3], planes: &mut Planes) -> Option<Fill> {
        let of = colour.map(fields);
        let step = if F::MADE_OF.is_one_word() { 32 } else { 4 };
        let mut mean = [0; 3];
        for i in 0..3 {
            let [low, high] = range(of.map(|f| f[i]));
            if high - low > step {
                return None;
            }
            mean[i] = (low + high) >> 1;
        }
        let word = mean[0] << 21 | mean[2] << 11 | mean[1];
        Some(Self::even_word(word as u32, planes))
    }

    /// Planes of one colour.
    #[inline(always)]
    pub(super) fn even_word(colour: u32, planes: &mut Planes) -> Fill {
        if F::MADE_OF.is_one_word() {
            planes[..3].copy_from_slice(&[colour, 0, 0]);
            return Fill::Plain;
        }
        even_pair(colour, planes);
        Fill::Small
    }

    /// A run of what is not in one word.
    #[inline(never)]
    fn fill_other(fill: Fill, planes: &Planes, place: Place, run: &mut [F::Word]) {
        match (fill, F::MADE_OF.is_one_word()) {
            (Fill::Small, true) => Self::fill_small(planes, place, run),
            (Fill::Plain | Fill::Small, false) => Self::fill_words(planes, place, run),
            // Of what is one word nothing else is left.
            _ => Self::fill_wide(planes, place, run),
        }
    }

    /// A run of [`Fill::Small`], packed anew every 16 pixels from its span's first on.
    #[inline(always)]
    fn fill_small(planes: &Planes, place: Place, run: &mut [F::Word]) {
        let ([at, _], off) = Self::at_anchor(planes, place);
        if run.len() > 16 - off as usize {
            return Self::fill_small_long(planes, place, run);
        }
        let step = planes[6];
        let word = at.word(Pair::FIELDS).wrapping_add(step.wrapping_mul(off));
        ramp::fill::<F>(run, Packed { word, step });
    }

    /// The same of a format of two words, which holds all bits of the planes.
    #[inline(always)]
    fn fill_words(planes: &Planes, place: Place, run: &mut [F::Word]) {
        let [at, step] = pair_at(planes, place);
        if step.is_none() {
            return ramp::fill_even::<F>(run, at.pixel::<F>());
        }
        ramp::fill_pair::<F>(run, at, step);
    }

    /// The same of more than one part.
    #[inline(never)]
    fn fill_small_long(planes: &Planes, place: Place, run: &mut [F::Word]) {
        let ([at, step], off) = Self::at_anchor(planes, place);
        InParts::new(at, step.times(16), planes[6]).fill_long::<F>(run, off);
    }

    /// [`pair_at`] the last pixel at or before a place that is a multiple of 16 from its span's first one, and how many
    /// pixels lie between.
    #[inline(always)]
    fn at_anchor(planes: &Planes, place: Place) -> ([Pair; 2], u32) {
        let off = place.skipped() & 15;
        let column = place.column.wrapping_sub(off);
        (pair_at(planes, Place { column, ..place }), off)
    }

    /// A run of what keeps more bits, likewise.
    #[inline(never)]
    fn fill_wide(planes: &Planes, place: Place, run: &mut [F::Word]) {
        let course = course(Fill::Wide, planes, place.first());
        if course.is_even() {
            return ramp::fill_even::<F>(run, course.pair().pixel::<F>());
        }
        let skipped = place.skipped();
        if F::MADE_OF.is_one_word() {
            return course.in_parts(skipped >> 4).fill::<F>(run, skipped & 15);
        }
        course.each_part(run, skipped, |part, [at, step]| {
            ramp::fill_pair::<F>(part, at, step);
        });
    }
}

/// The colour at a place of a span, and its steps.
#[inline(always)]
pub(super) fn course(fill: Fill, planes: &Planes, place: Place) -> Course {
    if fill == Fill::Small {
        let [at, step] = pair_at(planes, place);
        let wide = |sixteen: u32| (sixteen & 0xFFFF) << 15;
        return Course {
            value: [at.red_blue >> 16, at.green >> 16, at.red_blue].map(wide),
            step: step.parts().map(|part| part << 15),
            packed: planes[6],
        };
    }
    let [value, step] = wide_at(planes, place);
    let step = step.map(|step| step as i32);
    Course {
        value,
        step,
        packed: packed_step(step, [20, 20, 21]),
    }
}

/// Red, green and blue of corners with 16 bits each, as planes.
#[inline(always)]
pub(super) fn rises(shares: &Shares, colour: [u32; 3]) -> [Rise; 3] {
    let shares = shares.cut::<6>();
    let [a, b, c] = colour.map(fields);
    let mut rises = [
        shares.rise::<6, 5>(b[0] - a[0], c[0] - a[0]),
        shares.rise::<6, 5>(b[1] - a[1], c[1] - a[1]),
        shares.rise::<6, 6>(b[2] - a[2], c[2] - a[2]),
    ];
    for (rise, first) in rises.iter_mut().zip([a[0] << 5, a[1] << 5, a[2] << 6]) {
        rise.at = rise.at.wrapping_add(first);
    }
    rises
}

/// Keeps them in pairs of words.
#[inline(always)]
pub(super) fn keep_pairs(rises: [Rise; 3], planes: &mut Planes) {
    let [red, green, blue] = rises;
    let at = Pair::of([red.at, green.at, blue.at]);
    let dx = Pair::of([red.dx, green.dx, blue.dx]);
    let dy = Pair::of([red.dy, green.dy, blue.dy]);
    [planes[0], planes[1], planes[2]] = [at.red_blue, dx.red_blue, dy.red_blue];
    [planes[3], planes[4], planes[5]] = [at.green, dx.green, dy.green];
}

/// What was kept so, at a place, and its step.
#[inline(always)]
pub(super) fn pair_at(planes: &Planes, place: Place) -> [Pair; 2] {
    let [red_blue, rx, ry, green, gx, gy, ..] = *planes;
    let red_blue = place.value([red_blue, rx, ry]);
    let green = place.value([green, gx, gy]);
    [Pair::new(red_blue, green), Pair::new(rx, gx)]
}

/// Two words with 16 bits a channel.
#[inline(never)]
fn pair_planes(shares: &Shares, colour: [u32; 3], planes: &mut Planes) {
    let rises = rises(shares, colour);
    keep_pairs(rises, planes);
    planes[6] = packed_step(rises.map(|r| r.dx), [5, 5, 6]);
}

/// Planes of the two ways that keep 16 bits a channel or more.
#[inline(always)]
fn plane_shades(triangle: &Triangle<'_>, size: Size, area: u32, planes: &mut Planes) -> Fill {
    if matches!(size, Size::Tiny | Size::Small) {
        let colour = triangle.vertex.map(|v| v.colour);
        pair_planes(&triangle.shares(area), colour, planes);
        Fill::Small
    } else {
        wide_shades(triangle, planes)
    }
}

/// Planes of the way that keeps most bits, one a channel, if the triangle is not too thin for them.
#[inline(never)]
pub(super) fn wide_shades(triangle: &Triangle<'_>, planes: &mut Planes) -> Fill {
    let Some(area) = &triangle.wide_area() else {
        return Fill::Thin;
    };
    let corners = triangle.vertex.map(|v| wide_fields(v.colour));
    let mut three = [[0; 3]; 3];
    for (i, to) in three.iter_mut().enumerate() {
        let Some(plane) = area.plane(corners.map(|c| c[i] as i32)) else {
            return Fill::Thin;
        };
        *to = plane;
    }
    keep_wide(three, planes);
    Fill::Wide
}

/// Planes of a thin triangle on one line, for [`Fill::Wide`].
pub(super) fn thin_shades(span: &ThinSpan<'_>, planes: &mut Planes) {
    let corners = span.triangle.vertex.map(|v| wide_fields(v.colour));
    let three = [0, 1, 2].map(|i| {
        let [at, step] = span.line(corners.map(|c| i64::from(c[i])));
        [at, step, 0]
    });
    keep_wide(three, planes);
}

/// Planes of [`Fill::Small`] of one colour.
#[inline(never)]
pub(super) fn even_pair(colour: u32, planes: &mut Planes) {
    let red_blue = colour & 0xFFE0_0000 | colour >> 5 & 0xFFC0;
    *planes = [red_blue, 0, 0, colour << 21, 0, 0, 0, 0];
}

impl<F: PixelFormat> Look for Gouraud<F> {
    type Pixel = F;
    type Planes = Planes;
    const EMPTY: Planes = [0; 8];
    const TEXTURED: bool = false;
    const SCALE: Scale = Scale::new(F::STEPS);

    #[inline(always)]
    fn set_up(of: &Primitive<'_>, planes: &mut Planes) -> Fill {
        if of.size == Size::Tiny && F::MADE_OF.is_one_word() {
            Self::packed_planes(of.triangle.vertex, of.area, planes);
            return Fill::Plain;
        }
        match Self::other_planes(of.triangle, of.size, of.area, planes) {
            // Most triangles of formats of two words have these.
            Fill::Small if !F::MADE_OF.is_one_word() => Fill::Plain,
            fill => fill,
        }
    }

    fn set_up_thin(span: &ThinSpan<'_>, _: u16, _: &Draws<'_>, planes: &mut Planes) {
        thin_shades(span, planes);
    }

    #[inline(always)]
    fn fill_plain(planes: &Planes, place: Place, _: States<'_>, run: &mut [F::Word]) {
        if !F::MADE_OF.is_one_word() {
            return Self::fill_words(planes, place, run);
        }
        let [at, step, below, ..] = *planes;
        let word = place.value([at, step, below]);
        ramp::fill::<F>(run, Packed { word, step });
    }

    #[inline(always)]
    fn fill(fill: Fill, planes: &Planes, place: Place, draws: States<'_>, run: &mut [F::Word]) {
        if fill == Fill::Plain && F::MADE_OF.is_one_word() {
            return Self::fill_plain(planes, place, draws, run);
        }
        Self::fill_other(fill, planes, place, run);
    }

    fn set_up_dithered(triangle: &Triangle<'_>, planes: &mut Planes) -> Option<Fill> {
        let colour = triangle.vertex.map(|v| v.colour);
        if is_even(colour) {
            even_pair(colour[0], planes);
            return Some(Fill::Small);
        }
        let area = triangle.area();
        Some(plane_shades(triangle, triangle.size(area), area, planes))
    }

    fn fill_opaque(
        fill: Fill,
        planes: &Planes,
        place: Place,
        draws: States<'_>,
        dithers: bool,
        run: &mut [F::Word],
    ) -> u32 {
        if !dithers || !F::MADE_OF.is_one_word() || fill == Fill::Plain {
            Self::fill(fill, planes, place, draws, run);
        } else {
            dither::fill::<F>(course(fill, planes, place.first()), place, run);
        }
        u32::MAX
    }
}

#[cfg(test)]
mod tests {
    use super::{Gouraud, even_pair, keep_wide, pair_planes, wide_at, wide_fields};
    use crate::look::{Fill, Look, Place};
    use crate::num::random::Rng;
    use crate::pixel::Rgb565;
    use crate::span::Shares;

    fn place(column: u32, line: u32) -> Place {
        Place {
            span: 0,
            end: 1023,
            column,
            line,
        }
    }

    /// Kills: a field in the place of another, or with another number of bits.
    #[test]
    fn one_colour_has_the_planes_of_three_equal_ones() {
        let mut rng = Rng(6);
        let shares = Shares::new(1 << 14, [0x0080_0100, 0x0100_0180, 0x0100_0080]);
        for _ in 0..1000 {
            let (colour, mut want, mut got) = (rng.bits(), [1; 8], [2; 8]);
            pair_planes(&shares, [colour; 3], &mut want);
            even_pair(colour, &mut got);
            assert_eq!(got[..7], want[..7], "{colour:#x}");
        }
    }

    /// Kills: another colour, or one that steps, where faces of one colour are dithered.
    #[test]
    fn one_colour_is_dithered_as_a_plane_of_it() {
        let mut rng = Rng(7);
        for _ in 0..200 {
            let colour = rng.bits();
            let (mut one, mut wide) = ([1; 8], [0; 8]);
            even_pair(colour, &mut one);
            keep_wide(wide_fields(colour).map(|field| [field, 0, 0]), &mut wide);
            let place = place(rng.below(200), rng.below(200));
            let drawn = |fill, planes| {
                let mut run = [0; 40];
                Gouraud::<Rgb565>::fill_opaque(fill, planes, place, &[], true, &mut run);
                run
            };
            assert_eq!(
                drawn(Fill::Small, &one),
                drawn(Fill::Wide, &wide),
                "{colour:#x}"
            );
        }
    }

    /// Kills: a word or a bit in the place of another, and bits that are lent from what is multiplied.
    #[test]
    fn nine_words_in_eight_are_planes_with_eleven_bits_fewer() {
        let mut rng = Rng(5);
        let mut most = 0;
        for _ in 0..20_000 {
            let of: [[u32; 3]; 3] = [(); 3].map(|()| [(); 3].map(|()| rng.bits()));
            let mut planes = [0; 8];
            keep_wide(of, &mut planes);
            let (column, line) = (rng.below(1023), rng.below(1023));
            let [value, step] = wide_at(&planes, place(column, line));
            for i in 0..3 {
                let [at, across, down] = of[i];
                assert_eq!(step[i], across);
                let moved = across
                    .wrapping_mul(column)
                    .wrapping_add(down.wrapping_mul(line));
                let off = value[i].wrapping_sub(at.wrapping_add(moved)) as i32;
                // A field's unit is 2^20, or 2^21: below 1/200 of it.
                let limit = if i == 2 { 1023 + 3 * 1023 } else { 1023 };
                assert!(off.abs() <= limit, "{off} of {i}");
                most = most.max(off.abs());
            }
        }
        assert!(most > 3500, "{most}");
    }
}
