//! A rectangle that a draw call is cut to, or that is cut out of it (H15).

use core::ops::Range;

/// Which pixels of the picture a draw call keeps: those inside of a rectangle, or those outside.
///
/// A rectangle may reach beyond the picture, or be empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Scissor {
    /// Columns and lines: the first, and the one after the last.
    columns: [u16; 2],
    lines: [u16; 2],
    outside: bool,
}

impl Scissor {
    /// Keeps what is inside of these columns and lines of the picture.
    #[must_use]
    pub const fn inside(columns: Range<u16>, lines: Range<u16>) -> Self {
        Self {
            columns: [columns.start, columns.end],
            lines: [lines.start, lines.end],
            outside: false,
        }
    }

    /// Keeps what is outside of them.
    #[must_use]
    pub const fn outside(columns: Range<u16>, lines: Range<u16>) -> Self {
        Self {
            outside: true,
            ..Self::inside(columns, lines)
        }
    }

    /// What is kept of some columns of a line, from left to right; either run may be empty.
    pub(crate) fn cut(&self, line: u32, columns: Range<u32>) -> [Range<u32>; 2] {
        let Range { start, end } = columns;
        let [top, bottom] = self.lines.map(u32::from);
        let [left, right] = self.columns.map(u32::from);
        let is_beside = line < top || line >= bottom || left >= right;
        match (self.outside, is_beside) {
            (true, true) => [start..end, end..end],
            (false, true) => [end..end, end..end],
            (false, false) => [start.max(left)..end.min(right), end..end],
            (true, false) => [start..end.min(left), start.max(right)..end],
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    #[test]
    fn runs_are_the_pixels_that_are_kept() {
        let mut rng = Rng(31);
        let mut kept = [0; 2];
        for i in 0..40_000 {
            let mut range = || {
                let [a, b] = [(); 2].map(|()| rng.below(24) as u16);
                a..b
            };
            let (columns, lines, span) = (range(), range(), range());
            let outside = i % 2 == 0;
            let scissor = if outside {
                Scissor::outside(columns.clone(), lines.clone())
            } else {
                Scissor::inside(columns.clone(), lines.clone())
            };
            let line = rng.below(24) as u16;
            let (start, end) = (span.start.min(span.end), span.start.max(span.end));
            let runs = scissor.cut(u32::from(line), u32::from(start)..u32::from(end));
            for x in 0..30 {
                let inside = columns.contains(&x) && lines.contains(&line);
                let want = (start..end).contains(&x) && inside != outside;
                let got = runs
                    .iter()
                    .filter(|run| run.contains(&u32::from(x)))
                    .count();
                assert_eq!(
                    got,
                    usize::from(want),
                    "{x} of {span:?}: {scissor:?} {line}"
                );
                kept[usize::from(outside)] += got;
            }
        }
        assert!(kept.iter().all(|&n| n > 5000), "{kept:?}");
    }
}
