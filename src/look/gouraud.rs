//! Colours linear between vertices (K10, P3).
//!
//! | triangle | planes | error, units of a vertex's colour |
//! |---|---|---|
//! | within 25 pixels, 16-bit pixels | one word of three fields | below half a step of blue: 16 |
//! | within 64 pixels | two words with 16 bits a channel, packed anew every 16 pixels | 4 |
//! | larger | a plane a channel with 20 fraction bits more | 0.02 |
//! | thin | none: exact at both ends of each span, linear between | |
//!
//! Vertices keep half a step from either end of a field, so no colour leaves its field (P4).

use super::ramp::{self, Packed, Pair};
use super::{Depths, Fill, Paint, Place, ThinSpan};
use crate::pixel::Pixel;
use crate::scene::DrawState;
use crate::span::{Rise, Shares, Size, Triangle};
use core::marker::PhantomData;

/// The look of smooth colours, in the pixel format `F`.
#[derive(Clone, Copy, Debug)]
pub struct Gouraud<F>(PhantomData<F>);

/// What a triangle keeps of its colours. Plain: one word at the picture's first pixel, its steps across and
/// down. Small: the same of red and blue, then of green, then the packed step. Wide: the same of red, green and blue.
pub type Planes = [u32; 9];

/// Red, green and blue of a word of colour: 11, 11 and 10 bits.
#[inline(always)]
fn fields(word: u32) -> [i32; 3] {
    [word >> 21, word & 0x7FF, word >> 11 & 0x3FF].map(|f| f as i32)
}

/// `values[0]` and what is to be added for each column and line, at a place.
#[inline(always)]
fn at(planes: &Planes, plane: usize, place: Place) -> u32 {
    planes[plane]
        .wrapping_add(planes[plane + 1].wrapping_mul(place.column))
        .wrapping_add(planes[plane + 2].wrapping_mul(place.line))
}

impl<F: Pixel> Gouraud<F> {
    /// One word of three fields.
    #[inline(never)]
    fn packed_planes(triangle: &Triangle<'_>, area: u32, planes: &mut Planes) {
        let shares = triangle.shares(area).cut::<5>();
        let [a, b, c] = triangle.vertex.map(|v| v.colour);
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

    /// Two words with 16 bits a channel.
    #[inline(never)]
    fn pair_planes(shares: &Shares, colour: [u32; 3], planes: &mut Planes) {
        let shares = shares.cut::<6>();
        let [a, b, c] = colour.map(fields);
        let (e1, e2) = (
            [0, 1, 2].map(|i| b[i] - a[i]),
            [0, 1, 2].map(|i| c[i] - a[i]),
        );
        let red = shares.rise::<6, 5>(e1[0], e2[0]);
        let green = shares.rise::<6, 5>(e1[1], e2[1]);
        let blue = shares.rise::<6, 6>(e1[2], e2[2]);
        let join = |high: i32, low: i32| ((high << 16) as u32).wrapping_add(low as u32);
        planes[0] = join(
            red.at.wrapping_add(a[0] << 5),
            blue.at.wrapping_add(a[2] << 6),
        );
        planes[1] = join(red.dx, blue.dx);
        planes[2] = join(red.dy, blue.dy);
        planes[3] = (green.at.wrapping_add(a[1] << 5) << 16) as u32;
        planes[4] = (green.dx << 16) as u32;
        planes[5] = (green.dy << 16) as u32;
        planes[6] = packed_step([red.dx, green.dx, blue.dx], [5, 5, 6]);
    }

    /// A plane a channel; whether the triangle is not too thin for them.
    #[inline(never)]
    fn wide_planes(triangle: &Triangle<'_>, planes: &mut Planes) -> bool {
        let Some(area) = triangle.wide_area() else {
            return false;
        };
        let corners = triangle.vertex.map(|v| wide_fields(v.colour));
        for i in 0..3 {
            let Some(plane) = area.plane(corners.map(|c| c[i] as i32)) else {
                return false;
            };
            let plane = triangle.in_picture(plane);
            if let Some(three) = planes.get_mut(3 * i..3 * i + 3) {
                three.copy_from_slice(&plane);
            }
        }
        true
    }

    /// One colour for a thin triangle whose corners differ by less than a step.
    #[inline(never)]
    fn even_planes(colour: [u32; 3], planes: &mut Planes) -> Option<Fill> {
        let of = colour.map(fields);
        let mut mean = [0; 3];
        for i in 0..3 {
            let channel = of.map(|f| f[i]);
            let (low, high) = channel
                .iter()
                .fold((i32::MAX, 0), |(l, h), &c| (l.min(c), h.max(c)));
            if high - low > 32 {
                return None;
            }
            mean[i] = (low + high) >> 1;
        }
        *planes = [0; 9];
        if F::PACKED {
            planes[0] = ((mean[0] << 21) | (mean[2] << 11) | mean[1]) as u32;
            return Some(Fill::Plain);
        }
        planes[0] = ((mean[0] << 21) | (mean[2] << 6)) as u32;
        planes[3] = (mean[1] << 21) as u32;
        Some(Fill::Small)
    }

    #[inline(always)]
    fn packed(planes: &Planes, place: Place) -> Packed {
        Packed {
            word: at(planes, 0, place),
            step: planes[1],
        }
    }

    /// The colour at a place, its step and its packed step.
    #[inline(always)]
    fn pair(fill: Fill, planes: &Planes, place: Place) -> (Pair, Pair, u32) {
        if fill == Fill::Small {
            let pair = Pair {
                red_blue: at(planes, 0, place),
                green: at(planes, 3, place),
            };
            let step = Pair {
                red_blue: planes[1],
                green: planes[4],
            };
            return (pair, step, planes[6]);
        }
        let value = [0, 3, 6].map(|plane| at(planes, plane, place));
        let step = [1, 4, 7].map(|plane| planes[plane] as i32);
        let rounded = step.map(|s| (s + (1 << 14)) >> 15);
        let join = |high: i32, low: i32| ((high << 16) as u32).wrapping_add(low as u32);
        let pair = Pair {
            red_blue: value[0] << 1 & 0xFFFF_0000 | value[2] >> 15 & 0xFFFF,
            green: value[1] << 1 & 0xFFFF_0000,
        };
        let steps = Pair {
            red_blue: join(rounded[0], rounded[2]),
            green: (rounded[1] << 16) as u32,
        };
        (pair, steps, packed_step(step, [20, 20, 21]))
    }
}

/// Whether no field changes by more than a quarter of its range from the first corner on.
#[inline(always)]
fn is_flat(colour: [u32; 3]) -> bool {
    let [a, b, c] = colour.map(fields);
    let rise = |i: usize| {
        let (one, other) = (b[i] - a[i], c[i] - a[i]);
        (one ^ one >> 31) | (other ^ other >> 31)
    };
    rise(0) | rise(1) | rise(2) << 1 < 512
}

/// The fields with 20, 20 and 21 bits more: below 2^31 each.
#[inline(always)]
fn wide_fields(word: u32) -> [u32; 3] {
    let [red, green, blue] = fields(word);
    [
        (red << 20) as u32,
        (green << 20) as u32,
        (blue << 21) as u32,
    ]
}

/// Steps of red, green and blue with so many bits below a field's unit, rounded into one word.
#[inline(always)]
fn packed_step(step: [i32; 3], below: [u32; 3]) -> u32 {
    let round = |i: usize| (step[i] + (1 << below[i] >> 1)) >> below[i];
    ((round(0) << 21) as u32)
        .wrapping_add((round(2) << 11) as u32)
        .wrapping_add(round(1) as u32)
}

impl<F: Pixel> Paint for Gouraud<F> {
    type Pixel = F;
    type Planes = Planes;
    const EMPTY: Planes = [0; 9];
    const TEXTURED: bool = false;

    #[inline(always)]
    fn set_up(
        triangle: &Triangle<'_>,
        _: u16,
        size: Size,
        area: u32,
        _: &[DrawState<'_>],
        planes: &mut Planes,
    ) -> Fill {
        let colour = triangle.vertex.map(|v| v.colour);
        if size == Size::Tiny && F::PACKED {
            Self::packed_planes(triangle, area, planes);
            return Fill::Plain;
        }
        if matches!(size, Size::Tiny | Size::Small) {
            Self::pair_planes(&triangle.shares(area), colour, planes);
            return Fill::Small;
        }
        if size == Size::Sharp && F::PACKED && is_flat(colour) {
            Self::packed_planes(triangle, area, planes);
            return Fill::Plain;
        }
        if matches!(size, Size::Sharp | Size::Thin)
            && let Some(fill) = Self::even_planes(colour, planes)
        {
            return fill;
        }
        if Self::wide_planes(triangle, planes) {
            Fill::Wide
        } else {
            Fill::Thin
        }
    }

    fn set_up_thin(span: &ThinSpan<'_>, _: u16, _: &[DrawState<'_>], planes: &mut Planes) {
        let corners = span.triangle.vertex.map(|v| wide_fields(v.colour));
        for i in 0..3 {
            let [at, step] = span.line(corners.map(|c| c[i]));
            if let Some(three) = planes.get_mut(3 * i..3 * i + 3) {
                three.copy_from_slice(&[at, step, 0]);
            }
        }
    }

    #[inline(always)]
    fn fill_plain(planes: &Planes, place: Place, _: &[DrawState<'_>], run: &mut [F::Word]) {
        ramp::fill::<F>(run, Self::packed(planes, place));
    }

    #[inline(never)]
    fn fill(fill: Fill, planes: &Planes, place: Place, _: &[DrawState<'_>], run: &mut [F::Word]) {
        if fill == Fill::Plain {
            return ramp::fill_long::<F>(run, Self::packed(planes, place));
        }
        for (run, chunk) in Chunks::of(run, place) {
            let (at, step, packed) = Self::pair(fill, planes, chunk.anchor);
            if F::PACKED {
                ramp::fill_long::<F>(run, chunk.packed(at, packed));
            } else {
                ramp::fill_pair::<F>(run, chunk.pair(at, step), step);
            }
        }
    }

    #[inline(never)]
    fn fill_nearer(
        fill: Fill,
        planes: &Planes,
        place: Place,
        _: &[DrawState<'_>],
        run: &mut [F::Word],
        depth: Depths<'_>,
    ) {
        if fill == Fill::Plain {
            return ramp::fill_nearer::<F>(run, Self::packed(planes, place), depth);
        }
        let (mut z, mut cells) = (depth.at, depth.cells);
        for (run, chunk) in Chunks::of(run, place) {
            let (at, step, packed) = Self::pair(fill, planes, chunk.anchor);
            let Some((now, rest)) = core::mem::take(&mut cells).split_at_mut_checked(run.len())
            else {
                return;
            };
            let part = Depths {
                cells: now,
                at: z,
                step: depth.step,
            };
            z = z.wrapping_add(depth.step.wrapping_mul(run.len() as u32));
            cells = rest;
            if F::PACKED {
                ramp::fill_nearer::<F>(run, chunk.packed(at, packed), part);
            } else {
                ramp::fill_pair_nearer::<F>(run, chunk.pair(at, step), step, part);
            }
        }
    }
}

/// The parts of a run that are coloured from one anchor: every 16 columns of its span.
struct Chunks<'a, W> {
    run: &'a mut [W],
    place: Place,
}

/// A part of a run.
struct Chunk {
    /// The span's column from which it is coloured.
    anchor: Place,
    /// How many columns it begins to the right of that.
    off: u32,
}

impl<'a, W> Chunks<'a, W> {
    fn of(run: &'a mut [W], place: Place) -> Self {
        Self { run, place }
    }
}

impl<'a, W> Iterator for Chunks<'a, W> {
    type Item = (&'a mut [W], Chunk);

    #[inline(always)]
    fn next(&mut self) -> Option<Self::Item> {
        if self.run.is_empty() {
            return None;
        }
        let off = self.place.column.wrapping_sub(self.place.span) & 15;
        let pixels = self.run.len().min(16 - off as usize);
        let (now, rest) = core::mem::take(&mut self.run).split_at_mut_checked(pixels)?;
        let anchor = Place {
            column: self.place.column.wrapping_sub(off),
            ..self.place
        };
        self.run = rest;
        self.place.column = self.place.column.wrapping_add(pixels as u32);
        Some((now, Chunk { anchor, off }))
    }
}

impl Chunk {
    /// The first pixel's word of colour, from that of the anchor.
    #[inline(always)]
    fn packed(&self, at: Pair, step: u32) -> Packed {
        Packed {
            word: at.packed().wrapping_add(step.wrapping_mul(self.off)),
            step,
        }
    }

    /// The first pixel's colour, from that of the anchor.
    #[inline(always)]
    fn pair(&self, at: Pair, step: Pair) -> Pair {
        Pair {
            red_blue: at
                .red_blue
                .wrapping_add(step.red_blue.wrapping_mul(self.off)),
            green: at.green.wrapping_add(step.green.wrapping_mul(self.off)),
        }
    }
}
