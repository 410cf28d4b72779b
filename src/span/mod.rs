//! From triangles to spans: sides, planes, columns (K4, K5, B).
//!
//! | file | there |
//! |---|---|
//! | `edge` | the sides of a triangle on a line |
//! | `plane` | planes of small triangles |
//! | `triangle` | how large a triangle is, and what follows from it |

mod edge;
mod plane;
mod triangle;

pub use edge::{Edge, Frame};
pub(crate) use edge::{across, down};
pub use plane::{Rise, Shares};
pub(crate) use triangle::end_line;
pub use triangle::{Sides, Size, Triangle, Way};

/// The pixels of one object on one line, clipped to the picture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Span {
    /// First column of guard space.
    pub column: i32,
    /// Line of guard space.
    pub line: i32,
    /// First pixel of the line buffer.
    pub start: usize,
    /// Pixel after the last; above `start`.
    pub end: usize,
}

impl Span {
    /// Clips the columns `from .. to` of guard space exactly to the `width` columns that begin at
    /// `left`.
    ///
    /// `None` when nothing is left.
    #[inline(always)]
    #[must_use]
    pub fn clipped(line: i32, (from, to): (i32, i32), left: i32, width: usize) -> Option<Self> {
        let from = (from - left).max(0);
        let to = (to - left).min(width as i32);
        (from < to).then(|| Self {
            column: left + from,
            line,
            start: from as usize,
            end: to as usize,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spans_are_cut_at_both_sides() {
        let span =
            |from, to| Span::clipped(7, (from, to), 100, 10).map(|s| (s.column, s.start, s.end));
        assert_eq!(span(90, 120), Some((100, 0, 10)));
        assert_eq!(span(103, 105), Some((103, 3, 5)));
        assert_eq!(span(103, 103), None);
        assert_eq!(span(105, 103), None);
        assert_eq!(span(90, 100), None);
        assert_eq!(span(110, 120), None);
    }
}
