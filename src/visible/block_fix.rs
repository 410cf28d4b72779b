//! Block-fix depth on a line: 2 bits of range, 14 of significand (H2).

use super::LineDepth;
use crate::num::BlockFix16;

/// 16 bits of block-fix 1/w: nearer or equal wins. Each triangle has the range of its nearest
/// corner.
///
/// It is there for its precision, which is that of a historic design: the relative grain is
/// 2^-14 to 2^-11 in ranges 0 to 2, where [`Depth32`](super::Depth32) has 2^-31 of the nearest
/// depth. What is nearer by less than a grain may lose to what is submitted later. A cell keeps
/// the value of the 16 bits, so that comparing takes one instruction in every range.
#[derive(Clone, Copy, Debug)]
pub struct BlockFixDepth;

impl LineDepth for BlockFixDepth {
    type Cell = u32;
    const TESTS: bool = true;
    // Two ranges of depth that do not meet may lie within one grain.
    const ORDERS: bool = false;
    /// The range of the triangle.
    type Grain = u32;

    #[inline(always)]
    fn grain(nearest: u16) -> u32 {
        // `nearest` is rounded up.
        BlockFix16::range_of(u32::from(nearest.saturating_sub(1)) << 15)
    }

    #[inline(always)]
    fn test(cell: &mut u32, depth: u32, range: u32) -> bool {
        let depth = Self::rounded(depth, range);
        let seen = depth >= *cell;
        if seen {
            *cell = depth;
        }
        seen
    }

    #[inline(always)]
    fn rounded(depth: u32, range: u32) -> u32 {
        BlockFix16::new(depth, range).to_depth()
    }
}
