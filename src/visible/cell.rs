//! What the depth line keeps for a pixel.

/// A cell of the depth line. Each method of depth says what numbers in it mean.
pub trait DepthCell: Copy + Send + Sync + 'static {
    /// The farthest value, to which a line is cleared.
    const FARTHEST: Self;

    /// The number that is kept, 0 where the cell is at its farthest.
    fn number(&self) -> u32;

    /// Keeps a number instead of a depth, where there is room for one; 0 makes the cell farthest.
    fn set_number(&mut self, number: u32);
}

impl DepthCell for u32 {
    const FARTHEST: Self = 0;

    #[inline(always)]
    fn number(&self) -> u32 {
        *self
    }

    #[inline(always)]
    fn set_number(&mut self, number: u32) {
        *self = number;
    }
}

impl DepthCell for () {
    const FARTHEST: Self = ();

    #[inline(always)]
    fn number(&self) -> u32 {
        0
    }

    #[inline(always)]
    fn set_number(&mut self, _: u32) {}
}
