//! Set-up of texture coordinates: how a triangle's are found, and its planes (H1, H3, K18).
//!
//! | [`Method`] | where | off by at most |
//! |---|---|---|
//! | `Word`, from [`word_plane`](super::word_plane) | within 50 pixels, or 25 for sides of 256, less than 128 texels wide, affine | 1/16 texel |
//! | `Wide` | any triangle that is affine within the budget | 2^-15 of its width |
//! | `Perspective` | all others | see [`Perspective`] |
//!
//! A triangle may stretch over 4,096 texels, wherever on the texture it lies: places count from a base
//! near its middle, in whole repeats where the texture repeats.

use super::Place;
use super::area::Area;
use super::fetch::{Uv, Way, copy, copy_exact, copy_wide};
use super::perspective::{Homogeneous, Perspective, Within};
use super::stride::{Range, Reach, reach, stride_within};
#[cfg(test)]
use super::word_plane::Near;
use crate::num::{few_leading_zeros, leading_zeros_here, mul_high, mul_high_unsigned};
pub(crate) use crate::scene::Method;
#[cfg(test)]
use crate::scene::TexturePlace;
use crate::scene::{Budget, SampledSpan, Square, Stretch, Texture, Words};
use crate::span::Frame;

/// A corner of a triangle; corners go clockwise.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Corner {
    /// To the right of the centre of the picture's first pixel, 1/64 pixel, below 2^20 either way.
    pub x: i32,
    /// Down from there, likewise.
    pub y: i32,
    /// 1/w in any unit, 1 ..< 2^31.
    pub depth: u32,
    /// Place on the texture, to the right and down: texels with 14 fraction bits, modulo 2^18.
    pub texel: [i32; 2],
}

/// What a triangle keeps of its texture coordinates.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Mapping {
    /// What the planes are.
    pub method: Method,
    /// In perspective, how far exact places may be apart.
    pub reach: Reach,
    /// How many pixels of a span are drawn with exact places at its ends alone: that, or none where the texture or the
    /// budget does not allow texels at one go.
    pub quick: u8,
    /// What comes on top of what the planes give, to the right and down, in steps of [`GRAIN`] texels.
    pub base: [i16; 2],
    /// Value at the picture's first pixel, step to the right, step down: u or u/w or both of u and v
    /// in a word, then v or v/w, then 1/w.
    pub planes: [[u32; 3]; 3],
}

/// Texels of a step of a base, as a power of two: places have 18 bits before the point.
const GRAIN: u32 = 3;

/// A base in texels.
#[inline(always)]
pub fn texels_of(base: [i16; 2]) -> [i32; 2] {
    base.map(|steps| i32::from(steps) << GRAIN)
}

/// What planes go through at the corners, for triangles that are too thin for planes too.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Values {
    /// [`Method::Wide`] or [`Method::Perspective`].
    pub method: Method,
    /// As in [`Mapping`].
    pub base: [i16; 2],
    /// Of each plane, the values at the corners.
    pub of: [[i32; 3]; 3],
    /// On each axis, the least and the most of the places at the corners, as in [`Uv`].
    pub places: [[i32; 2]; 2],
}

/// Least and most of three numbers.
#[inline(always)]
pub(super) fn range<T: Ord + Copy>([a, b, c]: [T; 3]) -> [T; 2] {
    [a.min(b).min(c), a.max(b).max(c)]
}

/// Whether u and v may be taken as linear on the screen: `width (max - min) <= 4 budget min`, of
/// the depths, for a triangle of `width` on the texture, with 14 fraction bits. See [`perspective`](super::perspective).
#[inline(always)]
#[must_use]
pub fn is_affine(width: u32, depth: [u32; 3], budget: Budget) -> bool {
    let [least, most] = range(depth);
    let up = leading_zeros_here(most) & 31;
    // Both sides by 2^-21, the left one rounded up.
    let off = mul_high_unsigned(width << 5, (most - least) << up);
    let may = mul_high_unsigned(budget.for_curves() << 13, least << up);
    most == least || off < may
}

impl Values {
    /// The values of a triangle; `None` where it is wider than 4,096 texels, or a depth is not in
    /// 1 ..< 2^31.
    #[inline(never)]
    #[must_use]
    pub fn new(corners: &[Corner; 3], texture: &Texture<'_>, budget: Budget) -> Option<Self> {
        let Stretch { ways, width } = Stretch::of(&corners.map(|c| c.texel))?;
        let depth = corners.map(|c| c.depth);
        let [least, most] = range(depth);
        if least == 0 || most >> 31 != 0 {
            return None;
        }
        let (mut base, mut of, mut places) = ([0; 2], [[0; 3]; 3], [[0; 2]; 2]);
        let logs = [texture.log_width(), texture.log_height()];
        for (axis, log) in logs.into_iter().enumerate() {
            let [low, high] = ways[axis];
            let first = corners[0].texel[axis];
            let middle = first.wrapping_add((low + high) >> 1) >> 14;
            let grain = 1 << log.clamp(GRAIN, 8);
            let near = middle.wrapping_add(grain >> 1) & -grain;
            base[axis] = (near >> GRAIN) as i16;
            let least = first.wrapping_add(low).wrapping_sub(near << 14);
            // Below 2,177 texels, 19 fraction bits. 32 bits do not hold a rise of 4,096, so that it is 2^-14 less.
            for (value, corner) in of[axis].iter_mut().zip(corners) {
                let rise = corner.texel[axis].wrapping_sub(first.wrapping_add(low));
                *value = (least + rise - (rise >> 26)) << 5;
            }
            places[axis] = [least, least + (high - low)].map(|e| e << 5);
        }
        let method = if is_affine(width, depth, budget) {
            Method::Wide
        } else {
            // The largest has 30 bits. Of the 19 fraction bits of a place 11 are left.
            let up = few_leading_zeros(most) & 31;
            let q = depth.map(|d| d << (up & 31) >> 2);
            for i in 0..3 {
                let product = |value: i32| mul_high((q[i] << 1) as i32, value) << 1;
                (of[0][i], of[1][i]) = (product(of[0][i]), product(of[1][i]));
                of[2][i] = q[i] as i32;
            }
            Method::Perspective
        };
        Some(Self {
            method,
            base,
            of,
            places,
        })
    }

    /// The mapping by planes through the values, of a triangle in a picture; `None` where it is too thin for them.
    #[inline(never)]
    #[must_use]
    pub fn planes(
        &self,
        corners: &[Corner; 3],
        frame: Frame,
        texture: &Texture<'_>,
        budget: Budget,
        mapping: &mut Mapping,
    ) -> Option<()> {
        mapping.method = self.method;
        mapping.base = self.base;
        let mut area = Area::new(corners)?;
        let used = if self.method == Method::Wide { 2 } else { 3 };
        for i in (0..used).rev() {
            mapping.planes[i] = area.plane(self.of[i], (i == 2).then_some(frame))?;
        }
        if self.method == Method::Perspective {
            self.stride(area.finer(), mapping, texture, budget);
        }
        Some(())
    }

    /// How far exact places may be apart, from planes that are made.
    #[inline(always)]
    fn stride(&self, finer: u32, mapping: &mut Mapping, texture: &Texture<'_>, budget: Budget) {
        let low = range(self.of[2])[0].min(i32::MAX >> finer) << finer;
        let of = |axis: usize| {
            let [low, high] = self.places[axis];
            let step = mapping.planes[axis][1] as i32;
            Range { low, high, step }
        };
        let step = mapping.planes[2][1] as i32;
        let log = texture.repeated();
        mapping.reach = reach(low as u32, step, [of(0), of(1)], budget, log);
        if budget.is_coarse() && log != 0 && texture.is_of_words() {
            // Rounded steps stay within 1/32 texel.
            let exact = 16u8 << (8 - log).min(2);
            mapping.quick = mapping.reach.line.min(exact) + 1;
        }
    }
}

impl Mapping {
    /// That of no triangle: zeros, as all empty planes are.
    pub const EMPTY: Self = Self {
        method: Method::Word,
        reach: Reach { line: 0, arc: 0 },
        quick: 0,
        base: [0; 2],
        planes: [[0; 3]; 3],
    };

    /// The mapping of a triangle in a picture of 320 x 240 pixels; `None` where [`Values`] has none or planes have none.
    #[cfg(test)]
    #[must_use]
    pub fn new(corners: &[Corner; 3], texture: &Texture<'_>, budget: Budget) -> Option<Self> {
        let places = corners.map(|c| TexturePlace::new(c.texel, [0; 2]));
        if let Some(plane) = Near::of(corners, &places).word_plane(texture, texture.spare, budget) {
            let mut mapping = Self::EMPTY;
            mapping.planes[0] = plane;
            return Some(mapping);
        }
        let values = Values::new(corners, texture, budget)?;
        let frame = Frame {
            width: 320,
            height: 240,
        };
        let mut mapping = Self::EMPTY;
        values.planes(corners, frame, texture, budget, &mut mapping)?;
        Some(mapping)
    }

    /// Copies a square's texels into `run`, which begins at `place` of the picture, if its span is drawn at one go.
    #[inline(always)]
    pub fn draw_short(&self, run: &mut [u16], place: Place, square: Square<'_>) -> bool {
        let pixels = place.pixels();
        if pixels <= u32::from(self.quick) {
            self.draw_straight(run, place, square);
        } else if pixels <= u32::from(self.reach.arc) {
            self.draw_arc(run, place, square);
        } else {
            return false;
        }
        true
    }

    /// Copies texels, or what is said of them, into `run`, which begins at `place` of the picture.
    #[inline(never)]
    pub fn draw_as(
        &self,
        run: &mut [u16],
        place: Place,
        texture: &Texture<'_>,
        budget: Budget,
        words: Words,
    ) {
        let square = texture.plain_square();
        if !square.is_some_and(|square| self.draw_short(run, place, square)) {
            self.draw_long(run, place, texture, budget, words);
        }
    }

    /// The same of a span that is not drawn at one go.
    #[inline(always)]
    pub fn draw_long(
        &self,
        run: &mut [u16],
        place: Place,
        texture: &Texture<'_>,
        budget: Budget,
        words: Words,
    ) {
        match texture.sampling {
            None => self.draw_any(run, place, texture, budget),
            // Places in one word serve all levels.
            Some(_) if self.method == Method::Word => {
                let level = texture.texels_of(self.planes[1][0] as usize);
                self.draw_any(run, place, level, budget);
            }
            Some(sampling) => {
                let span = SampledSpan {
                    texture,
                    words,
                    method: self.method,
                    steps: self.reach.line,
                    base: texels_of(self.base),
                    planes: &self.planes,
                    place,
                };
                (sampling.draw)(&span, run);
            }
        }
    }

    /// Whether all of a span of so many pixels is drawn at one go, straight or along an arc, within a coarse budget.
    pub fn is_quick(&self, pixels: u32, along_arcs: bool) -> bool {
        let is_within = |most: u8| pixels <= u32::from(most);
        self.quick > 0 && (is_within(self.quick) || along_arcs && is_within(self.reach.arc))
    }

    /// Copies a square's texels into `run`, which begins at `place` of the picture, of a span that is straight between
    /// its ends.
    #[inline(never)]
    fn draw_straight(&self, run: &mut [u16], place: Place, square: Square<'_>) {
        self.span(place).between(run, place.within(), square);
    }

    /// The same of a span that is one arc.
    #[inline(never)]
    fn draw_arc(&self, run: &mut [u16], place: Place, square: Square<'_>) {
        self.span(place).arc(run, place.within(), square);
    }

    /// The whole span of a run.
    #[inline(always)]
    fn span(&self, place: Place) -> Perspective {
        Perspective::of(texels_of(self.base), &self.planes, place)
    }

    /// Copies texels into `run`, which begins at `place` of the picture.
    #[inline(never)]
    pub fn draw_any(&self, run: &mut [u16], place: Place, texture: &Texture<'_>, budget: Budget) {
        match self.method {
            Method::Word => {
                let plane = self.planes[0];
                copy(run, texture, place.value(plane), plane[1]);
            }
            Method::Wide => {
                let way = Way::of(texels_of(self.base), &self.planes, place);
                if budget.is_coarse() {
                    copy_wide(run, place.within().skipped, texture, way);
                } else {
                    copy_exact(run, texture, way.skip(place.within().skipped));
                }
            }
            Method::Perspective => {
                let (span, within) = (self.span(place), place.within());
                let mut reach = self.reach;
                let steps = within.pixels.saturating_sub(1);
                // Far from the triangle's nearest corner they may be further apart: long spans repay the question.
                if steps > (8 * usize::from(reach.line)).max(24) && steps > usize::from(reach.arc) {
                    reach = span.reach(within.pixels, budget, texture.repeated());
                }
                if reach.arc > 0 {
                    if let Some(square) = texture.bent() {
                        return span.arcs(run, within, square, reach.arc);
                    }
                }
                if !budget.is_coarse() {
                    reach.line = reach.line.min(4);
                }
                span.draw(run, within, texture, stride_within(reach.line));
            }
        }
    }
}

impl Way {
    /// The span that begins at a place's first pixel, of planes of u and v.
    #[inline(always)]
    pub(super) fn of(base: [i32; 2], [u, v, _]: &[[u32; 3]; 3], place: Place) -> Self {
        let at = [u, v].map(|plane| place.first().value(*plane) as i32);
        Self {
            base,
            at: Uv::new(at[0], at[1]),
            step: Uv::new(u[1] as i32, v[1] as i32),
        }
    }
}

impl Perspective {
    /// The same of planes of u/w, v/w and 1/w.
    #[inline(always)]
    pub(super) fn of(base: [i32; 2], planes: &[[u32; 3]; 3], place: Place) -> Self {
        let place = place.first();
        Self {
            base,
            at: Homogeneous::of([0, 1, 2].map(|i| place.value(planes[i]))),
            step: Homogeneous::of(planes.map(|[_, right, _]| right)),
        }
    }
}

impl Place {
    /// Which pixels of its span a run has.
    #[inline(always)]
    fn within(self) -> Within {
        Within {
            skipped: self.skipped() as usize,
            pixels: self.pixels() as usize,
        }
    }
}
