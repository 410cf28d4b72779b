//! Which lines of a picture belong to which of several renderers (B3, K16).

use core::ops::Range;

/// The lines of one of several renderers: every `factor`th band of `band` lines, from band
/// `offset` on. Lines are counted from 0 at the top of the picture.
///
/// Single lines balance the load best, as neighbours are alike; bands keep a renderer's objects
/// longer on its own lines, so that fewer are set up by several.
///
/// ```
/// use scanbeam::frame::Interleave;
/// let odd = Interleave::lines(2, 1).unwrap();
/// assert!(odd.of(0..8).eq([1, 3, 5, 7]));
/// let bands = Interleave::bands(3, 1, 2).unwrap();
/// assert!(bands.of(0..12).eq([2, 3, 8, 9]));
/// ```
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Interleave {
    /// How many renderers share the picture, at least 1.
    factor: u16,
    /// Which of them this is, below `factor`.
    offset: u16,
    /// Lines of a band, at least 1.
    band: u16,
}

impl Interleave {
    /// Every line: one renderer alone.
    pub const ALL: Self = Self {
        factor: 1,
        offset: 0,
        band: 1,
    };

    /// Every `factor`th line from line `offset` on; `None` unless `offset` is below `factor`.
    #[must_use]
    pub const fn lines(factor: u16, offset: u16) -> Option<Self> {
        Self::bands(factor, offset, 1)
    }

    /// Every `factor`th band of `band` lines from band `offset` on; `None` unless `offset` is
    /// below `factor` and a band has lines.
    #[must_use]
    pub const fn bands(factor: u16, offset: u16, band: u16) -> Option<Self> {
        if offset < factor && band > 0 {
            Some(Self {
                factor,
                offset,
                band,
            })
        } else {
            None
        }
    }

    /// Which of the renderers draws `line`: the one whose offset this is.
    #[must_use]
    pub const fn owner(&self, line: u16) -> u16 {
        line / self.band % self.factor
    }

    /// Whether `line` is one of these.
    #[must_use]
    pub const fn owns(&self, line: u16) -> bool {
        self.owner(line) == self.offset
    }

    /// The first of these lines that is not above `line`; it may be beyond any picture.
    #[inline]
    #[must_use]
    pub const fn at_or_after(&self, line: u32) -> u32 {
        let (factor, band) = (self.factor as u32, self.band as u32);
        let at = line / band;
        let ahead = (factor + self.offset as u32 - at % factor) % factor;
        if ahead == 0 {
            line
        } else {
            at.saturating_add(ahead).saturating_mul(band)
        }
    }

    /// These lines among `range`, from the top.
    pub fn of(self, range: Range<u16>) -> impl Iterator<Item = u16> {
        let end = u32::from(range.end);
        let first = self.at_or_after(u32::from(range.start));
        core::iter::successors(Some(first), move |line| Some(self.at_or_after(line + 1)))
            .take_while(move |line| *line < end)
            .map(|line| line as u16)
    }
}

impl Default for Interleave {
    fn default() -> Self {
        Self::ALL
    }
}

#[cfg(test)]
mod tests {
    use super::Interleave;

    /// Kills: a line beyond all lines that overflows.
    #[test]
    fn lines_end_with_the_last_number() {
        for (offset, band) in [(0, 3), (1, 3), (2, 1), (1, 65_535)] {
            let lines = Interleave::bands(65_535, offset, band).unwrap();
            assert!(lines.at_or_after(u32::MAX) >= u32::MAX - u32::from(band));
            let first = u32::from(offset) * u32::from(band);
            let count = usize::from(band).min(65_535usize.saturating_sub(first as usize));
            assert_eq!(lines.of(0..65_535).count(), count, "{offset} {band}");
        }
    }

    #[test]
    fn every_line_has_one_owner() {
        for factor in 1..6 {
            for band in [1, 2, 3, 7, 65_535] {
                let all: [_; 6] =
                    core::array::from_fn(|i| Interleave::bands(factor, i as u16, band));
                let mut owners = [0u8; 100];
                for (offset, lines) in all.into_iter().enumerate() {
                    let Some(lines) = lines else {
                        assert!(offset >= usize::from(factor));
                        continue;
                    };
                    let mut last = None;
                    for line in lines.of(3..90) {
                        assert!(last < Some(line));
                        last = Some(line);
                        assert!(lines.owns(line));
                        assert_eq!(usize::from(lines.owner(line)), offset);
                        owners[usize::from(line)] += 1;
                    }
                }
                for (line, count) in owners.into_iter().enumerate() {
                    assert_eq!(count, u8::from((3..90).contains(&line)), "{factor} {band}");
                }
            }
        }
    }

    #[test]
    fn limits() {
        assert_eq!(Interleave::lines(0, 0), None);
        assert_eq!(Interleave::lines(2, 2), None);
        assert_eq!(Interleave::bands(2, 1, 0), None);
        let widest = Interleave::bands(u16::MAX, u16::MAX - 1, u16::MAX).unwrap();
        assert_eq!(widest.at_or_after(0), 65_534 * 65_535);
        assert_eq!(widest.of(0..u16::MAX).count(), 0);
        assert!(Interleave::ALL.of(5..9).eq(5..9));
        assert!(Interleave::lines(4, 3).unwrap().of(9..9).next().is_none());
    }
}
