//! How a draw call compares its depth with the one that is there (H9).

/// Which pixels pass a comparison with the depth that is there: any set of nearer, equal and
/// farther, which are the eight functions of H9.
///
/// | H9, of 1/w | here | | H9 | here |
/// |---|---|---|---|---|
/// | never | [`NEVER`](Self::NEVER) | | always | [`ALWAYS`](Self::ALWAYS) |
/// | > | [`NEARER`](Self::NEARER) | | <= | [`FARTHER_OR_EQUAL`](Self::FARTHER_OR_EQUAL) |
/// | = | [`EQUAL`](Self::EQUAL) | | != | [`DIFFERENT`](Self::DIFFERENT) |
/// | >= | [`NEARER_OR_EQUAL`](Self::NEARER_OR_EQUAL) | | < | [`FARTHER`](Self::FARTHER) |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthFunction(u8);

impl DepthFunction {
    /// None.
    pub const NEVER: Self = Self(0);
    /// What is farther than what is there.
    pub const FARTHER: Self = Self(1);
    /// What is as far.
    pub const EQUAL: Self = Self(2);
    /// What is as far or farther.
    pub const FARTHER_OR_EQUAL: Self = Self(3);
    /// What is nearer.
    pub const NEARER: Self = Self(4);
    /// What is nearer or farther.
    pub const DIFFERENT: Self = Self(5);
    /// What is nearer or as far: how surfaces hide each other.
    pub const NEARER_OR_EQUAL: Self = Self(6);
    /// All.
    pub const ALWAYS: Self = Self(7);

    /// Whether a pixel passes, by how its 1/w compares with the one that is there: greater is
    /// nearer.
    #[inline(always)]
    #[must_use]
    pub const fn passes(self, order: core::cmp::Ordering) -> bool {
        // Less, equal and greater are -1, 0 and 1.
        self.0 >> (order as i8 + 1) & 1 != 0
    }

    /// Which pass of pixels that have a bit each in one of three words: those that are farther, equal and nearer.
    #[inline(always)]
    pub(crate) fn among(self, [farther, equal, nearer]: [u32; 3]) -> u32 {
        let passing =
            |bit: u32, pixels: u32| pixels & 0u32.wrapping_sub(u32::from(self.0) >> bit & 1);
        passing(0, farther) | passing(1, equal) | passing(2, nearer)
    }
}

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
