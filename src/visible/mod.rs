//! Which pixels of a span are seen: the depth of one line (K8).
//!
//! A method is a type; the one without depth is `()`, and then the object submitted last wins.

/// A way to find hidden surfaces along one line.
pub trait LineDepth {
    /// What is kept for each pixel of the line.
    type Cell: Copy + Send + Sync + 'static;
    /// The farthest value, to which a line is cleared.
    const FARTHEST: Self::Cell;
    /// Whether pixels are tested at all.
    const TESTS: bool;

    /// Whether a pixel at `depth` (larger is nearer) is seen; if so the cell takes its depth.
    fn test(cell: &mut Self::Cell, depth: u32) -> bool;
}

/// 32 bits of 1/w: nearer or equal wins.
#[derive(Clone, Copy, Debug)]
pub struct Depth32;

impl LineDepth for Depth32 {
    type Cell = u32;
    const FARTHEST: u32 = 0;
    const TESTS: bool = true;

    #[inline(always)]
    fn test(cell: &mut u32, depth: u32) -> bool {
        let seen = depth >= *cell;
        if seen {
            *cell = depth;
        }
        seen
    }
}

impl LineDepth for () {
    type Cell = ();
    const FARTHEST: () = ();
    const TESTS: bool = false;

    #[inline(always)]
    fn test((): &mut (), _: u32) -> bool {
        true
    }
}
