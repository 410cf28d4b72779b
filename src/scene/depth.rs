//! How a draw call compares its depth with the one that is there (H9).

use crate::geometry::DepthFunction;

/// Where a draw call is seen, and where its depth is kept, by how it compares with what is there.
///
/// Calls are compared in order of submission, those that are blended after all others. A renderer without depth, and
/// a scene that is drawn by priority, compare nothing.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthTest {
    /// Where its colour is written.
    pub colour_if: DepthFunction,
    /// Where its depth is written. What is blended never writes it.
    pub depth_if: DepthFunction,
}

impl Default for DepthTest {
    /// [`HIDES`](DepthTest::HIDES).
    fn default() -> Self {
        Self::HIDES
    }
}

impl DepthTest {
    /// Surfaces hide each other: what is at least as near is seen and kept.
    pub const HIDES: Self = Self {
        colour_if: DepthFunction::NEARER_OR_EQUAL,
        depth_if: DepthFunction::NEARER_OR_EQUAL,
    };

    /// The same of this function, for colour and depth.
    #[must_use]
    pub const fn new(function: DepthFunction) -> Self {
        Self {
            colour_if: function,
            depth_if: function,
        }
    }

    /// The same, and depth is left as it is.
    #[must_use]
    pub const fn without_write(self) -> Self {
        Self {
            depth_if: DepthFunction::NEVER,
            ..self
        }
    }
}
