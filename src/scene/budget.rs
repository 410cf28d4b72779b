//! How exact a texture is drawn (X2).

/// How far a texel may be from its place, in texels with 8 fraction bits: 0 to 256 texels.
#[derive(Clone, Copy, Debug, PartialEq, Eq, PartialOrd, Ord)]
pub struct Budget(u16);

impl Default for Budget {
    /// [`BALANCED`](Budget::BALANCED).
    fn default() -> Self {
        Self::BALANCED
    }
}

impl Budget {
    /// 1/2 texel.
    pub const FAST: Self = Self(128);
    /// 1/4 texel.
    pub const BALANCED: Self = Self(64);
    /// 1/100 texel.
    pub const EXACT: Self = Self(2);

    /// In texels with 8 fraction bits.
    #[must_use]
    pub const fn new(texels: u16) -> Self {
        Self(texels)
    }

    /// In texels with 8 fraction bits.
    #[inline(always)]
    #[must_use]
    pub const fn texels(self) -> u32 {
        self.0 as u32
    }

    /// Whether it leaves room for places in one word, which are off by up to 1/16 texel.
    #[inline(always)]
    pub(crate) const fn is_coarse(self) -> bool {
        self.texels() >= 2 * RESERVE
    }

    /// What is left for taking a curve as straight.
    #[inline(always)]
    pub(crate) const fn for_curves(self) -> u32 {
        if self.is_coarse() {
            self.texels() - RESERVE
        } else {
            self.texels()
        }
    }
}

/// What fixed point may add between exact places, in texels with 8 fraction bits: 1/16 texel.
const RESERVE: u32 = 16;
