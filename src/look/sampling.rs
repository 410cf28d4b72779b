//! Texels of textures that are [sampled](Texture::sampled): which level of detail, and through which filter (H6).
//!
//! Within a triangle the texture's area under a pixel is `D q^-3`, with one constant D and the 1/w q, since it is a
//! projective map. So a span finds D once, from the planes at its first pixel, and with it the 1/w at which each level
//! begins; there the span is cut. A level is taken where its texels are at least `1 / sqrt 2` pixels wide on average
//! and the next one's more than `sqrt 2`; so a texture that is magnified is always taken whole. A triangle that is
//! drawn without 1/w has one level. One that is too thin for planes has the finest, as has one seen from its edge.
//! Places in one word are parts of the texture's period, so that they serve all levels.
//!
//! Cuts and exact places count from the span's first pixel, so that a pixel has the same bits in whatever runs its span
//! is drawn.

use super::fetch::{Uv, Way, copy_exact};
use super::linear::copy_linear;
use super::mapping::Method;
use super::perspective::{Homogeneous, Perspective, Within};
use super::stride::stride_within;
use super::word_plane::Near;
use crate::num::{exp2, log2, mul_high, mul_wide};
use crate::scene::{SampledSpan, Sampling, Texture, Words};

impl Sampling {
    /// The nearest texel of the level that fits.
    pub const NEAREST: Self = Self {
        draw: |span, run| draw(span, run, nearest),
        word: Some(|vertices, places, texture, budget| {
            Near::new(vertices, places).leveled(texture, budget)
        }),
    };

    /// The weighted mean of the four nearest texels of the level that fits, with 4 bits of weight each way: off by half a
    /// step of the format, and by 1/64 of the difference between the sums of opposite texels.
    ///
    /// A pixel takes 94 instructions on a Cortex-M4 and 135 on a Cortex-M0+ where texels are words that repeat, in runs
    /// of 5 pixels, all in; 34 and 49 where it lies between the same four texels as the one before. Of texels that are
    /// transparent the nearest alone counts, and it counts for those beside it.
    pub const LINEAR: Self = Self {
        draw: |span, run| draw(span, run, copy_linear),
        word: None,
    };
}

/// Copies texels of a texture along a way.
type Read = fn(&mut [u16], &Texture<'_>, Way, Words);

fn nearest(run: &mut [u16], texture: &Texture<'_>, way: Way, _: Words) {
    copy_exact(run, texture, way);
}

/// Most levels below a texture.
const MOST: usize = Texture::MAX_SIDE.trailing_zeros() as usize;

/// A run of a span.
#[inline(never)]
fn draw(span: &SampledSpan<'_>, run: &mut [u16], read: Read) {
    match span.method {
        Method::Perspective => span.perspective(run, read),
        // Places in one word are drawn without a question for levels.
        Method::Word | Method::Wide => span.affine(run, read),
    }
}

/// A quarter of the area that two ways span.
fn area(across: Uv, down: Uv) -> u64 {
    let product = |a: i32, b: i32| mul_wide(a, b) >> 2;
    (product(across.u, down.v) - product(across.v, down.u)).unsigned_abs()
}

/// The level where a pixel has so many texels, as a logarithm rounded down.
pub(super) fn level_of(texels: i32, levels: usize) -> usize {
    let level = (texels + 1) >> 1;
    level.clamp(0, levels as i32) as usize
}

impl Way {
    /// The same on a level of detail.
    fn coarser(self, level: usize) -> Self {
        Self {
            base: self.base.map(|texels| texels >> level),
            at: self.at.part(level as u32),
            step: self.step.part(level as u32),
        }
    }
}

impl SampledSpan<'_> {
    /// A run of a triangle that is affine.
    fn affine(&self, run: &mut [u16], read: Read) {
        let way = Way::of(self.base, self.planes, self.place);
        let [u, v, _] = self.planes;
        let level = match area(way.step, Uv::new(u[2] as i32, v[2] as i32)) {
            0 => 0,
            // Of which one texel has 2^36.
            area => level_of((log2(area) >> 8) - 36, self.texture.levels()),
        };
        let way = way.skip(self.place.skipped() as usize).coarser(level);
        read(run, &self.texture.level(level), way, self.words);
    }

    /// A run whose pixels have a 1/w each.
    fn perspective(&self, run: &mut [u16], read: Read) {
        let place = self.place;
        let Perspective { base, at, step } = Perspective::of(self.base, self.planes, place);
        let down = Homogeneous::of(self.planes.map(|plane| plane[2]));
        let ends = Ends::new(at, [step, down], self.texture.levels());
        let pixels = place.pixels() as usize;
        let (mut rest, mut skipped) = (run, place.skipped() as usize);
        let mut first = 0;
        while !rest.is_empty() && first < pixels {
            let at = at.plus(step.times(first));
            let level = ends.level(at.q);
            let count = ends.same(at.q, step.q as i32, pixels - first);
            let within = Within {
                skipped,
                pixels: count,
            };
            (first, skipped) = match skipped.checked_sub(count) {
                Some(skipped) => (first + count, skipped),
                None => {
                    let (now, more) = rest.split_at_mut(rest.len().min(count - skipped));
                    let texture = self.texture.level(level);
                    let part = Perspective { base, at, step }.coarser(level);
                    part.ways(now, within, stride_within(self.steps), |run, way| {
                        read(run, &texture, way, self.words);
                    });
                    rest = more;
                    (first + count, 0)
                }
            };
        }
    }
}

impl Perspective {
    /// The same on a level of detail.
    fn coarser(self, level: usize) -> Self {
        let of = |value: Homogeneous| Homogeneous {
            q: value.q,
            s: value.s >> level,
            t: value.t >> level,
        };
        Self {
            base: self.base.map(|texels| texels >> level),
            at: of(self.at),
            step: of(self.step),
        }
    }
}

/// At which 1/w each coarser level begins.
struct Ends {
    at: [u32; MOST],
    levels: usize,
}

impl Ends {
    /// From a place in the triangle, with the steps to the right and down.
    fn new(at: Homogeneous, steps: [Homogeneous; 2], levels: usize) -> Self {
        let mut ends = Self {
            at: [0; MOST],
            levels: levels.min(MOST),
        };
        if levels == 0 || at.q == 0 {
            return ends;
        }
        // Times q 2^-11: the ways of u and v.
        let place = at.place();
        let [across, down] = steps.map(|step| {
            let way = |s: i32, place: i32| s.wrapping_sub(mul_high(place, step.q as i32) << 2);
            Uv::new(way(step.s, place.u), way(step.t, place.v))
        });
        let area = area(across, down);
        if area == 0 {
            return ends;
        }
        // Texels under a pixel, times q^3; of which the area is a quarter, times q^2 2^-22.
        let texels = log2(area) + (24 << 8) + log2(at.q.into());
        for (i, end) in (0..).zip(ends.at.iter_mut().take(levels)) {
            *end = exp2((texels - ((2 * i + 1) << 8)).div_euclid(3));
        }
        ends
    }

    /// The level where 1/w is `q`, coarser as 1/w falls.
    fn level(&self, q: u32) -> usize {
        let ends = self.at.iter().take(self.levels);
        ends.take_while(|&&end| q < end).count()
    }

    /// How many of `pixels` pixels (at least 1), with 1/w of `q` at the first and a step of `step`, have its level.
    fn same(&self, q: u32, step: i32, pixels: usize) -> usize {
        let level = self.level(q);
        let ahead = level.checked_sub(usize::from(step >= 0));
        let end = ahead
            .filter(|&i| i < self.levels)
            .and_then(|i| self.at.get(i));
        let (Some(&end), 1..) = (end, step.unsigned_abs()) else {
            return pixels;
        };
        let way = if step < 0 {
            q.wrapping_sub(end)
        } else {
            end.wrapping_sub(q).wrapping_sub(1)
        };
        pixels.min((way / step.unsigned_abs()).saturating_add(1) as usize)
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::look::fetch::FRACTION;
    use crate::look::mapping::{Corner, Mapping, texels_of};
    use crate::num::random::Rng;
    use crate::scene::{Budget, Place};

    /// Kills: a level that begins one unit of 1/w too early or too late, a part of a run that goes on into the next
    /// level or ends before it, and a run without a step that is cut.
    #[test]
    fn runs_are_cut_where_their_level_ends() {
        let mut rng = Rng(5);
        let mut cut = 0;
        for i in 0..20_000 {
            let levels = 1 + rng.below(MOST as u32) as usize;
            let mut at = [0; MOST];
            let mut end = 1 << 30;
            for place in &mut at {
                end -= 1 + rng.below(end / 2);
                *place = end;
            }
            let ends = Ends { at, levels };
            // At an end, beside it, or anywhere, by short and long steps.
            let near = at[rng.below(levels as u32) as usize];
            let q = match i % 4 {
                0 => near,
                1 => near - rng.below(99).min(near),
                2 => near + 1,
                _ => rng.below(1 << 30),
            };
            let most = 1 + rng.below(64) as usize;
            let room = [q, (1 << 30) - q][i / 4 % 2] / most as u32;
            let step = rng.below(room.clamp(1, 1 << [2, 24][i / 8 % 2])) as i32;
            let step = if i / 4 % 2 == 0 { -step } else { step };
            let count = ends.same(q, step, most);
            let level = |pixel: usize| ends.level(q.wrapping_add_signed(step * pixel as i32));
            assert!((1..=most).contains(&count), "{count} of {most}");
            assert!(
                (0..count).all(|pixel| level(pixel) == level(0)),
                "{q} {step}"
            );
            assert!(count == most || level(count) != level(0), "{q} {step}");
            cut += u32::from(count < most);
        }
        assert!(cut > 1000, "{cut}");
        let ends = Ends {
            at: [100; MOST],
            levels: 1,
        };
        assert_eq!([99, 100, 101].map(|q| ends.level(q)), [1, 0, 0]);
    }

    /// A texture of so many texels a side, as a power of two.
    fn square(log: u32) -> Texture<'static> {
        const TEXELS: &[u16] = &[0; 1 << 16];
        Texture::words(&TEXELS[..1 << (2 * log)], 1 << log, 1 << log).unwrap()
    }

    /// Which level of a texture of 256 texels a side it is.
    fn level_below(texture: &Texture<'_>) -> u32 {
        8 - texture.log_width()
    }

    /// Tells the place of each pixel, with the base, in units of 1/128 texel of the finest level.
    fn told(run: &mut [u16], texture: &Texture<'_>, way: Way, _: Words) {
        let level = level_below(texture);
        for (i, word) in (0..).zip(run) {
            let at = way.at.u.wrapping_add(way.step.u.wrapping_mul(i));
            *word = ((at << level >> 12) + (way.base[0] << (level + 7))) as u16;
        }
    }

    /// The first and the last pixel of a span have exact places, whatever levels lie between. Kills: the last part of a
    /// span that has levels is reckoned to an end beyond it.
    #[test]
    fn ends_of_spans_of_several_levels_are_exact() {
        let coarser = [7, 6, 5, 4].map(square);
        let texture = square(8).sampled(Sampling::NEAREST, &coarser).unwrap();
        let mut cut = 0;
        for far in 2..40 {
            let corner = |x: i32, y: i32, depth, texel| Corner {
                x: 64 * x,
                y: 64 * y,
                depth,
                texel,
            };
            let corners = [
                corner(0, 0, 1 << 30, [0, 0]),
                corner(300, 0, (1 << 30) / far, [256 << 14, 0]),
                corner(0, 200, 1 << 30, [0, 256 << 14]),
            ];
            let mapping = Mapping::new(&corners, &texture, Budget::FAST).unwrap();
            for (line, end) in [(3, 290), (50, 220), (90, 161)] {
                let span = SampledSpan {
                    texture: &texture,
                    words: Words::Numbers,
                    method: mapping.method,
                    steps: 16,
                    base: texels_of(mapping.base),
                    planes: &mapping.planes,
                    place: Place {
                        span: 0,
                        end,
                        column: 0,
                        line,
                    },
                };
                let mut run = [0; 300];
                let run = &mut run[..end as usize];
                span.perspective(run, told);
                let value = |plane: usize, column| {
                    let place = Place {
                        span: 0,
                        end,
                        column,
                        line,
                    };
                    place.value(mapping.planes[plane])
                };
                for (column, &shown) in [(0, &run[0]), (end - 1, &run[run.len() - 1])] {
                    let [s, t] = [0, 1].map(|plane| value(plane, column) as i32);
                    let q = value(2, column);
                    let want = (Homogeneous { q, s, t }.place().u >> 12)
                        + (texels_of(mapping.base)[0] << 7);
                    let off = i32::from(shown as i16) - i32::from(want as i16);
                    assert!(off.abs() <= 16, "{far} {line} {column}: {shown} {want}");
                }
                cut += u32::from(value(2, 0) / value(2, end - 1) >= 2);
            }
        }
        assert!(cut > 90, "{cut}");
    }

    /// Tells the level of each pixel, and the base in texels of the finest level.
    fn level_told(run: &mut [u16], texture: &Texture<'_>, way: Way, _: Words) {
        let level = level_below(texture);
        run.fill((way.base[0] << level) as u16 + level as u16);
    }

    /// Kills: a texture that is seen from its edge, or all of whose places lie on a line, is taken coarser than it is; a base
    /// that is not in texels of the level.
    #[test]
    fn places_on_a_line_have_the_finest_level() {
        let coarser = [7, 6].map(square);
        let texture = square(8).sampled(Sampling::NEAREST, &coarser).unwrap();
        for (across, down, want) in [
            ([4, 0], [0, 0], 0),
            ([4, 0], [0, 4], 2),
            ([1, 0], [0, 1], 0),
        ] {
            let [u, v] = [0, 1].map(|i| [0, across[i] << FRACTION, down[i] << FRACTION]);
            let span = SampledSpan {
                texture: &texture,
                words: Words::Numbers,
                method: Method::Wide,
                steps: 1,
                base: [64; 2],
                planes: &[u, v, [0; 3]],
                place: Place {
                    span: 0,
                    end: 9,
                    column: 0,
                    line: 0,
                },
            };
            let mut run = [9; 9];
            draw(&span, &mut run, level_told);
            assert_eq!(run, [64 + want; 9], "{across:?} {down:?}");
        }
    }
}
