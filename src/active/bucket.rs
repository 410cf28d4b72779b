//! Activation lists: one bucket a scanline, built in O(objects) (K1).
//!
//! A bucket is the index of the object filed last; the chain goes on in the objects themselves,
//! latest first. Filing costs two stores, no matter how many objects a line has.

use crate::link::Link;
use core::ops::Range;

/// The heads of the activation lists of the lines `range`.
#[derive(Debug)]
pub struct Buckets<'m> {
    heads: &'m mut [Link],
    /// The lines of guard space that have a bucket; no longer than `heads`.
    lines: Range<i32>,
}

impl<'m> Buckets<'m> {
    /// No line has a bucket yet.
    pub(crate) fn new(heads: &'m mut [Link]) -> Self {
        Self { heads, lines: 0..0 }
    }

    /// Empties the buckets and gives one to each of `lines`, or to as many as there is room for.
    pub(crate) fn reset(&mut self, lines: Range<i32>) {
        let room = self.room().min(1 << 13) as i32;
        self.lines = lines.start..lines.end.min(lines.start + room);
        let count = self.lines.len();
        self.heads[..count].fill(Link::NONE);
    }

    /// How many lines can have a bucket.
    pub(crate) fn room(&self) -> usize {
        self.heads.len()
    }

    /// The lines that have a bucket.
    pub(crate) fn lines(&self) -> Range<i32> {
        self.lines.clone()
    }

    /// Files `object` under `line` and returns the link that its chain has to hold.
    ///
    /// `None` when the line has no bucket.
    #[inline]
    pub(crate) fn file(&mut self, object: u16, line: i32) -> Option<Link> {
        let head = self.heads.get_mut((line - self.lines.start) as usize)?;
        Some(core::mem::replace(head, Link::slow(object)))
    }

    /// The object filed last under `line`.
    #[inline]
    pub(crate) fn head(&self, line: i32) -> Link {
        if self.lines.contains(&line) {
            self.heads[(line - self.lines.start) as usize]
        } else {
            Link::NONE
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn chains_run_backwards() {
        let mut heads = [Link::NONE; 3];
        let mut buckets = Buckets::new(&mut heads);
        buckets.reset(100..103);
        assert_eq!(buckets.file(0, 101), Some(Link::NONE));
        assert_eq!(buckets.file(1, 101), Some(Link::slow(0)));
        assert_eq!(buckets.file(2, 103), None);
        assert_eq!(buckets.file(2, 99), None);
        assert_eq!(buckets.head(101), Link::slow(1));
        assert_eq!(buckets.head(102), Link::NONE);
        assert_eq!(buckets.head(99), Link::NONE);
        buckets.reset(0..9);
        assert_eq!(buckets.lines(), 0..3);
        assert_eq!(buckets.head(1), Link::NONE);
    }
}
