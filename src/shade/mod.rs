//! Colour along a stretch of a line.
//!
//! | file | there |
//! |---|---|
//! | `interpolation.rs` | which method takes a span's colours from pixel to pixel |
//! | `quality.rs` | how far a picture may be off, and the method that follows from it |

mod interpolation;
mod quality;

pub use interpolation::{
    Auto, Forward, HalfRate, Interpolation, Lirp10, Lirp12, Lirp16, LirpPacked, Method, Packed8,
    Packed16, Precision, QuarterRate,
};
pub use quality::Quality;

pub mod texture;

use crate::geometry::texturing::{Detail, LevelEnds, SpanPlace, TexturedLevels};
use crate::geometry::{BlendedLevels, FlatLevels, GouraudLevels, ObjectFinish};

/// The colours of a span from its first pixel on, steps of the output.
#[derive(Clone, Copy, Debug)]
pub enum Stretch {
    /// One colour, in whole steps.
    Constant([u8; 3]),
    /// Two words, as [`GouraudLevels::Small`]; for spans of at most 64 pixels.
    Packed {
        /// Red in the upper and blue in the lower half.
        red_blue: i32,
        /// Green in the upper half.
        green: i32,
        /// The steps of the two words to the next pixel.
        steps: (i32, i32),
        /// The step in the fields of a vertex's colour.
        field_step: i32,
    },
    /// Red, green and blue in 16.16 steps, and their steps to the next pixel.
    Channels([i32; 3], [i32; 3]),
}

/// The levels of an object.
pub trait Levels: Copy {
    /// The colours from the centre of pixel (`column`, `line`) of guard space on.
    fn stretch(&self, column: i32, line: i32) -> Stretch;

    /// The texture that multiplies them, and the places on it from there on.
    #[inline(always)]
    fn texture(&self, _column: i32, _line: i32) -> Option<(u16, SpanPlace)> {
        None
    }

    /// How it is composited, where a finish says so.
    #[inline(always)]
    fn finish(&self) -> Option<&ObjectFinish> {
        None
    }

    /// Where which level of detail of it is right.
    #[inline(always)]
    fn detail(&self) -> &LevelEnds {
        const { &LevelEnds::FULL }
    }
}

impl<L: Levels> Levels for BlendedLevels<L> {
    #[inline(always)]
    fn stretch(&self, column: i32, line: i32) -> Stretch {
        self.inner.stretch(column, line)
    }

    #[inline(always)]
    fn texture(&self, column: i32, line: i32) -> Option<(u16, SpanPlace)> {
        self.inner.texture(column, line)
    }

    #[inline(always)]
    fn detail(&self) -> &LevelEnds {
        self.inner.detail()
    }

    #[inline(always)]
    fn finish(&self) -> Option<&ObjectFinish> {
        Some(&self.finish)
    }
}

impl<L: Levels, D: Detail> Levels for TexturedLevels<L, D> {
    #[inline(always)]
    fn stretch(&self, column: i32, line: i32) -> Stretch {
        self.colour.stretch(column, line)
    }

    #[inline(always)]
    fn texture(&self, column: i32, line: i32) -> Option<(u16, SpanPlace)> {
        self.planes.at(column, line)
    }

    #[inline(always)]
    fn detail(&self) -> &LevelEnds {
        self.detail.ends()
    }
}

impl Levels for FlatLevels {
    #[inline(always)]
    fn stretch(&self, _: i32, _: i32) -> Stretch {
        Stretch::Constant(self.0)
    }
}

impl Levels for GouraudLevels {
    #[inline(always)]
    fn stretch(&self, column: i32, line: i32) -> Stretch {
        match self {
            Self::Small {
                red_blue,
                green,
                step,
            } => Stretch::Packed {
                red_blue: red_blue.at(column, line),
                green: green.at(column, line),
                steps: (red_blue.dx, green.dx),
                field_step: *step,
            },
            Self::Large(planes) => {
                Stretch::Channels(planes.map(|p| p.at(column, line)), planes.map(|p| p.dx))
            }
        }
    }
}
