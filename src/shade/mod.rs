//! Colour along a span.

use crate::geometry::{FlatLevels, GouraudPlanes};

/// The levels of an object, evaluated along a line.
pub trait Levels: Copy {
    /// What steps from pixel to pixel.
    type Walker: Walker;

    /// Starts at the centre of pixel (`column`, `line`) of guard space.
    fn walk(&self, column: i32, line: i32) -> Self::Walker;
}

/// Colour that steps along a line.
pub trait Walker {
    /// The colour of this pixel, in whole steps of the output.
    fn colour(&self) -> [u8; 3];

    /// Goes to the next pixel.
    fn step(&mut self);
}

impl Levels for FlatLevels {
    type Walker = Self;

    #[inline(always)]
    fn walk(&self, _: i32, _: i32) -> Self {
        *self
    }
}

impl Walker for FlatLevels {
    #[inline(always)]
    fn colour(&self) -> [u8; 3] {
        self.0
    }

    #[inline(always)]
    fn step(&mut self) {}
}

/// Three 16.16 accumulators and their steps.
#[derive(Clone, Copy, Debug)]
pub struct GouraudWalker {
    value: [i32; 3],
    step: [i32; 3],
}

impl Levels for GouraudPlanes {
    type Walker = GouraudWalker;

    #[inline(always)]
    fn walk(&self, column: i32, line: i32) -> GouraudWalker {
        let [r, g, b] = &self.0;
        GouraudWalker {
            value: [r.at(column, line), g.at(column, line), b.at(column, line)],
            step: [r.dx, g.dx, b.dx],
        }
    }
}

impl Walker for GouraudWalker {
    #[inline(always)]
    fn colour(&self) -> [u8; 3] {
        let [r, g, b] = self.value;
        [(r >> 16) as u8, (g >> 16) as u8, (b >> 16) as u8]
    }

    #[inline(always)]
    fn step(&mut self) {
        for (v, s) in self.value.iter_mut().zip(self.step) {
            *v = v.wrapping_add(s);
        }
    }
}
