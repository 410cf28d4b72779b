//! The alpha of vertices along a span (K11): found once a span, exact at both ends, linear between.

use super::renderer::View;
use super::spans::Span;
use super::thin::thin_span;
use crate::scene::Alphas;

/// Alpha at the picture's first column, and its step, with 22 fraction bits.
#[derive(Clone, Copy)]
pub(super) struct Surface([u32; 2]);

impl Surface {
    const FRACTION: u32 = 22;

    /// Of what has no alphas.
    pub(super) const OPAQUE: Self = Self([255 << Self::FRACTION, 0]);

    /// Of a span of a triangle on a line.
    #[inline(never)]
    pub(super) fn of(
        alphas: Alphas,
        object: u16,
        span: Span,
        line: u32,
        view: &View<'_>,
    ) -> Option<Self> {
        let triangle = view.triangle_of(object)?;
        let of = alphas.of(triangle.object, view.vertices);
        let ends = thin_span(&triangle, span, line);
        let values = of.map(|alpha| i64::from(alpha) << (Self::FRACTION - 8));
        Some(Self(ends.line(values)))
    }

    /// At a column of the span, rounded to nearest.
    pub(super) fn at(self, column: u32) -> u8 {
        const HALF: u32 = 1 << (Surface::FRACTION - 1);
        let [at, step] = self.0;
        let alpha = at.wrapping_add(step.wrapping_mul(column));
        // Steps are rounded, so the last one may lie a little beyond.
        let level = alpha.wrapping_add(HALF) as i32 >> Self::FRACTION;
        level.clamp(0, 255) as u8
    }
}
