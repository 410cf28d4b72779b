//! Lines of triangles, by any of the methods: exact spans, exact values at their ends, and what is seen by depth (K4,
//! K5).
//!
//! It is for pictures and figures of methods, not for speed: a line goes through all triangles, and planes are divided
//! at each span in 128 bits, so that nothing is off but what the methods themselves are off.

use crate::colours::Colours;
use crate::depth::{DepthMethod, Depths};
use crate::format::{FRACTION, Format};
use crate::method::Method;
use crate::paint::paint;
use core::ops::Range;
use scanbeam::scene::FiledTriangle;

/// A triangle on the screen, with an area.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Triangle {
    /// Column and line of each corner in 13.3.
    pub place: [[i32; 2]; 3],
    /// 1/w of each, 1 to 2^31 - 1.
    pub depth: [u32; 3],
    /// Colour of each, 0 to 255 a channel.
    pub colour: [[u8; 3]; 3],
}

impl From<FiledTriangle> for Triangle {
    fn from(filed: FiledTriangle) -> Self {
        Self {
            place: filed.corners.map(|c| [c.x.into(), c.y.into()]),
            depth: filed.corners.map(|c| c.depth),
            colour: filed.corners.map(|c| c.colour),
        }
    }
}

impl Triangle {
    /// The pixels of a line, not below column 0: `min < x <= max` between the two edges with
    /// `Ytop < Y <= Ybottom`, at pixels' middles.
    #[must_use]
    pub fn span(&self, line: u16) -> Range<i32> {
        let y = 8 * i32::from(line) + 4;
        let mut ends: Option<Range<i32>> = None;
        for k in 0..3 {
            let (a, b) = (self.place[k], self.place[(k + 1) % 3]);
            let ([x, top], [to, bottom]) = if a[1] <= b[1] { (a, b) } else { (b, a) };
            if !(top < y && y <= bottom) {
                continue;
            }
            let tall = i64::from(bottom - top);
            let across = i64::from(y - top) * i64::from(to - x);
            // The first column whose middle lies beyond the edge.
            let beyond = (i64::from(x - 4) * tall + across).div_euclid(8 * tall) + 1;
            let beyond = beyond.max(0) as i32;
            ends = Some(match ends {
                None => beyond..beyond,
                Some(other) => other.start.min(beyond)..other.end.max(beyond),
            });
        }
        ends.unwrap_or_default()
    }

    /// What each corner weighs at a pixel's middle, and the sum of all, which is above 0.
    fn weights(&self, column: i32, line: u16) -> [i64; 4] {
        let [x, y] = [8 * i64::from(column) + 4, 8 * i64::from(line) + 4];
        let place = self.place.map(|p| p.map(i64::from));
        let of = |i: usize| {
            let ([ax, ay], [bx, by]) = (place[(i + 1) % 3], place[(i + 2) % 3]);
            (ax - x) * (by - y) - (ay - y) * (bx - x)
        };
        let [a, b, c] = [of(0), of(1), of(2)];
        let sum = a + b + c;
        // Whichever way round the corners are.
        [a, b, c, sum].map(|weight| weight * sum.signum())
    }

    /// What is linear between the corners at a pixel, times `scale / whole`, rounded.
    fn at(weights: [i64; 4], values: [u32; 3], (scale, whole): (u32, u32)) -> i32 {
        let sum = (0..3).fold(0, |sum, i| {
            sum + i128::from(weights[i]) * i128::from(values[i])
        });
        let (sum, area) = (2 * sum * i128::from(scale), i128::from(weights[3]));
        let whole = area * i128::from(whole);
        ((sum + whole).div_euclid(2 * whole)) as i32
    }

    /// Values at the first pixel of a span and their step, exact at its last one too but for rounding.
    fn along(
        first: [i64; 4],
        last: [i64; 4],
        pixels: i32,
        values: [u32; 3],
        scale: (u32, u32),
    ) -> [i32; 2] {
        let [from, to] = [first, last].map(|w| i64::from(Self::at(w, values, scale)));
        let steps = i64::from(pixels - 1).max(1);
        [
            from as i32,
            (2 * (to - from) + steps).div_euclid(2 * steps) as i32,
        ]
    }

    /// Whether a line's span has another side than that of the line before: a corner lies between their middles.
    #[must_use]
    pub fn turns(&self, line: u16) -> bool {
        let y = 8 * i32::from(line) + 4;
        self.place.iter().any(|p| (y - 8..y).contains(&p[1]))
    }

    /// Channels at the middle of the picture's first pixel, and what each next column and line has more, rounded. Values
    /// beyond 32 bits wrap.
    #[must_use]
    pub(crate) fn planes<F: Format>(&self) -> [[i32; 3]; 3] {
        let first = self.weights(0, 0);
        let more = |next: [i64; 4]| {
            let [a, b, c] = [0, 1, 2].map(|i| next[i] - first[i]);
            [a, b, c, first[3]]
        };
        [first, more(self.weights(1, 0)), more(self.weights(0, 1))].map(|weights| {
            [0, 1, 2].map(|i| {
                let (values, scale) = self.channel::<F>(i);
                Self::at(weights, values, scale)
            })
        })
    }

    /// A channel at the corners, and what [`at`](Self::at) takes to have it in units of [`Colours`].
    fn channel<F: Format>(&self, i: usize) -> ([u32; 3], (u32, u32)) {
        let steps = u32::from(F::STEPS[i]) << FRACTION;
        (self.colour.map(|c| c[i].into()), (steps, 255))
    }

    /// Colours and 1/w along a span that is not empty.
    #[must_use]
    pub fn course<F: Format>(&self, span: &Range<i32>, line: u16) -> (Colours, Depths) {
        let (first, last) = (
            self.weights(span.start, line),
            self.weights(span.end - 1, line),
        );
        let along = |values, scale| Self::along(first, last, span.end - span.start, values, scale);
        let channels = [0, 1, 2].map(|i| {
            let (values, scale) = self.channel::<F>(i);
            along(values, scale)
        });
        let colours = Colours {
            at: channels.map(|[at, _]| at + (1 << (FRACTION - 1))),
            step: channels.map(|[_, step]| step),
        };
        let [at, step] = along(self.depth, (1, 1)).map(|v| v as u32);
        (colours, Depths { at, step })
    }
}

/// Pixels of spans: those that were seen when they were drawn, and those that were not.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// In front of all before.
    pub shaded: u32,
    /// Behind one of them.
    pub hidden: u32,
}

/// Draws a line of triangles over what is there, and counts their pixels. `cells` are as many as pixels, and are cleared
/// first.
pub fn draw_line<F: Format>(
    (method, depth): (Method, DepthMethod),
    triangles: impl IntoIterator<Item = Triangle>,
    line: u16,
    pixels: &mut [F::Word],
    cells: &mut [u32],
) -> Counts {
    let mut counts = Counts::default();
    cells.fill(0);
    for triangle in triangles {
        let span = triangle.span(line);
        let end = span.end.min(pixels.len().min(cells.len()) as i32);
        if span.start >= end {
            continue;
        }
        let (colours, mut at) = triangle.course::<F>(&(span.start..end), line);
        let run = span.start as usize..end as usize;
        let nearest = triangle.depth.into_iter().fold(0, u32::max);
        let range = depth.range(nearest);
        let (Some(pixels), Some(cells)) = (pixels.get_mut(run.clone()), cells.get_mut(run)) else {
            continue;
        };
        let mut cells = cells.iter_mut();
        paint::<F>(method, &colours, pixels, &mut || {
            let key = depth.key(at.at, range);
            at.at = at.at.wrapping_add(at.step);
            // As many cells as pixels: there is always one.
            cells.next().is_some_and(|cell| {
                let seen = key >= *cell;
                if seen {
                    *cell = key;
                }
                counts.shaded += u32::from(seen);
                counts.hidden += u32::from(!seen);
                seen
            })
        });
    }
    counts
}
