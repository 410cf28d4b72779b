//! Colours of a triangle's spans that are taken from its planes on some lines alone, and kept on those between (P3).
//!
//! Planes are linear, so a span with the colours of a line before is off by the same amount from end to end: by what the
//! planes differ between where the two spans begin. Where the kept colours would leave their range within the span they
//! are taken anew, so none wraps (P4), and likewise where a side turns at a corner.
//!
//! The renderer takes them on every line. `scanbeam accuracy`, family `lines`, has what keeping would err and gain.

use crate::colours::Colours;
use crate::format::{FRACTION, Format};
use crate::lines::Triangle;

/// Red, green and blue over the picture, in units of [`Colours`]. Sums wrap; within the triangle they are right.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ColourPlanes {
    /// At the middle of the picture's first pixel.
    at: [i32; 3],
    /// To the next column.
    right: [i32; 3],
    /// To the next line.
    down: [i32; 3],
}

impl ColourPlanes {
    /// Those of a triangle.
    #[must_use]
    pub fn new<F: Format>(triangle: &Triangle) -> Self {
        let [at, right, down] = triangle.planes::<F>();
        let half = 1 << (FRACTION - 1);
        Self {
            at: at.map(|at: i32| at.wrapping_add(half)),
            right,
            down,
        }
    }

    /// Colours of the span that begins at a column.
    #[inline(always)]
    #[must_use]
    pub fn at(&self, column: i32, line: u16) -> Colours {
        let at = [0, 1, 2].map(|i| {
            self.at[i]
                .wrapping_add(self.right[i].wrapping_mul(column))
                .wrapping_add(self.down[i].wrapping_mul(line.into()))
        });
        Colours {
            at,
            step: self.right,
        }
    }
}

/// A span whose colours are asked for.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// Its first column.
    pub column: i32,
    /// Pixels, at least 1.
    pub pixels: u32,
    /// Its line.
    pub line: u16,
    /// Whether a side has turned since the line before.
    pub turns: bool,
}

impl Span {
    /// That of a triangle on a line; none if it is empty.
    #[must_use]
    pub fn of(triangle: &Triangle, line: u16) -> Option<Self> {
        let columns = triangle.span(line);
        (!columns.is_empty()).then(|| Self {
            column: columns.start,
            pixels: (columns.end - columns.start) as u32,
            line,
            turns: triangle.turns(line),
        })
    }
}

/// Colours that are kept from line to line.
#[derive(Clone, Copy, Debug)]
pub struct Kept {
    every: u16,
    /// The line on which they are taken anew at the latest.
    until: u16,
    colours: Colours,
}

impl Kept {
    /// Of a triangle of which no line was drawn: to be taken anew on every so many lines, 1 being each.
    #[must_use]
    pub const fn new(every: u16) -> Self {
        Self {
            every,
            until: 0,
            colours: Colours {
                at: [0; 3],
                step: [0; 3],
            },
        }
    }

    /// Colours of a span below those that were asked for before.
    #[inline(always)]
    #[must_use]
    pub fn of_span<F: Format>(&mut self, planes: &ColourPlanes, span: &Span) -> Colours {
        if span.line >= self.until || span.turns || !self.colours.stay::<F>(span.pixels) {
            self.colours = planes.at(span.column, span.line);
            self.until = span.line.saturating_add(self.every);
        }
        self.colours
    }
}
