//! Counters of what was done and of what was skipped (M4).

/// Counts the work along spans; `()` counts nothing and costs nothing.
pub trait SpanCounter: Copy + Default + Send {
    /// One span was drawn: so many of its pixels were seen, so many hidden, tested or not.
    fn span(&mut self, seen: u32, hidden: u32, tested: bool);

    /// The next span has one colour, and is filled with it.
    fn flat(&mut self);
    /// So many texels were fetched.
    fn fetched(&mut self, texels: u32);

    /// What has been counted.
    fn counts(&self) -> SpanCounts;

    /// Whether pixels have to be counted at all.
    const COUNTS: bool;
}

/// What happened along the spans of a frame.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpanCounts {
    /// Spans that covered a pixel of the picture.
    pub spans: u32,
    /// Spans of which no pixel was seen.
    pub spans_hidden: u32,
    /// Spans that shared no pixel with another, as far as was asked: drawn without depth.
    pub spans_untested: u32,
    /// Spans of one colour: no colour was taken from pixel to pixel.
    pub spans_flat: u32,
    /// Pixels that were given a colour.
    pub pixels_shaded: u32,
    /// Pixels that were covered and lost against what was there.
    pub pixels_hidden: u32,
    /// Depth comparisons.
    pub depth_tests: u32,
    /// Texels that were read for pixels that were seen.
    pub texture_fetches: u32,
}

impl SpanCounter for SpanCounts {
    const COUNTS: bool = true;

    #[inline]
    fn span(&mut self, seen: u32, hidden: u32, tested: bool) {
        self.spans += 1;
        self.spans_hidden += u32::from(seen == 0);
        self.pixels_shaded += seen;
        self.pixels_hidden += hidden;
        if tested {
            self.depth_tests += seen + hidden;
        } else {
            self.spans_untested += 1;
        }
    }

    #[inline]
    fn flat(&mut self) {
        self.spans_flat += 1;
    }

    #[inline]
    fn fetched(&mut self, texels: u32) {
        self.texture_fetches += texels;
    }

    fn counts(&self) -> SpanCounts {
        *self
    }
}

impl SpanCounter for () {
    const COUNTS: bool = false;

    #[inline(always)]
    fn span(&mut self, _: u32, _: u32, _: bool) {}

    #[inline(always)]
    fn flat(&mut self) {}

    #[inline(always)]
    fn fetched(&mut self, _: u32) {}

    fn counts(&self) -> SpanCounts {
        SpanCounts::default()
    }
}

impl core::ops::AddAssign for SpanCounts {
    fn add_assign(&mut self, other: Self) {
        self.spans += other.spans;
        self.spans_hidden += other.spans_hidden;
        self.spans_untested += other.spans_untested;
        self.spans_flat += other.spans_flat;
        self.pixels_shaded += other.pixels_shaded;
        self.pixels_hidden += other.pixels_hidden;
        self.depth_tests += other.depth_tests;
        self.texture_fetches += other.texture_fetches;
    }
}
