//! What was done along spans, and what was skipped (M4). Pass one counts in [`scene::Assembled`](crate::scene::Assembled),
//! the object cache in [`frame::CacheUse`](crate::frame::CacheUse).

use crate::event::{Event, EventSet};

/// What happened along the spans of lines (M4): of a renderer that is [`counting`](crate::Renderer::counting).
///
/// A span is the pixels of a triangle on a line, within the scissor of its draw call. The figures hang on the scene and
/// on which lines were drawn, and not on slots of the cache; those of several renderers of one frame add up to those of
/// one. A counter stays at its maximum when it gets there.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct SpanCounts {
    /// Spans of at least one pixel. Those of shadow volumes do not count, nor do what shadows fall on and volumes on a
    /// line without depth, where they are not drawn.
    pub spans: u32,
    /// Of these, spans of which no pixel was seen: all its pixels are hidden, or holes of its texture.
    pub spans_hidden: u32,
    /// Of these, spans that share no column with another of their line, and whose call blends nothing and has the depth
    /// test that all have where no other is named: nobody asked for their depth.
    pub spans_untested: u32,
    /// Pixels that were given a colour, by each span that gave one: where nothing on a line is blended, cut or has a
    /// depth test of its own, each covered pixel once, and elsewhere once more for each span that was laid over it. What
    /// a line colours again, since spans were found to meet on it, is counted once.
    pub pixels_shaded: u32,
    /// Pixels of spans that lost against what was there, or what came after. Holes of textures do not count, where no
    /// depth was asked for them.
    pub pixels_hidden: u32,
    /// Pixels whose depth was compared with the one of their column: on lines with draw calls that blend, cut, have
    /// holes, cast shadows or have a depth test, where spans meet or a call is blended or has such a test; and pixels
    /// of shadow volumes, and of what is drawn again by them. Other lines sort spans and compare no pixels.
    pub depth_tests: u32,
    /// Pixels that texels were read for; a filter reads four at each. A texture with holes is read for pixels that turn
    /// out to be hidden, too.
    pub texture_fetches: u32,
}

/// What became of the pixels of a span.
#[derive(Clone, Copy, Debug, Default)]
pub(crate) struct SpanPixels {
    /// Within the scissor.
    pub(crate) all: u32,
    pub(crate) seen: u32,
    pub(crate) hidden: u32,
    pub(crate) tested: u32,
    pub(crate) fetched: u32,
}

impl SpanCounts {
    /// The events that these figures tell (H14): pixels were given a colour; a span whose depth was asked for is seen; a
    /// pixel of a span lost against another. With those of pass one
    /// ([`Assembled::events`](crate::scene::Assembled::events)) they are all that a frame has.
    #[must_use]
    pub fn events(&self) -> EventSet {
        let asked = self.spans.saturating_sub(self.spans_untested);
        EventSet::of([
            (Event::PixelRendered, self.pixels_shaded > 0),
            (Event::DepthPassed, asked > self.spans_hidden),
            (Event::DepthFailed, self.pixels_hidden > 0),
        ])
    }

    /// Adds a span, if it has pixels.
    pub(crate) fn add_span(&mut self, pixels: SpanPixels, is_untested: bool) {
        if pixels.all == 0 {
            return;
        }
        raise(&mut self.spans, 1);
        raise(&mut self.spans_hidden, u32::from(pixels.seen == 0));
        raise(&mut self.spans_untested, u32::from(is_untested));
        raise(&mut self.pixels_shaded, pixels.seen);
        raise(&mut self.pixels_hidden, pixels.hidden);
        raise(&mut self.depth_tests, pixels.tested);
        raise(&mut self.texture_fetches, pixels.fetched);
    }

    /// Adds pixels of a shadow volume, all of which are compared.
    pub(crate) fn add_volume(&mut self, pixels: u32) {
        raise(&mut self.depth_tests, pixels);
    }
}

impl core::ops::AddAssign for SpanCounts {
    fn add_assign(&mut self, other: Self) {
        raise(&mut self.spans, other.spans);
        raise(&mut self.spans_hidden, other.spans_hidden);
        raise(&mut self.spans_untested, other.spans_untested);
        raise(&mut self.pixels_shaded, other.pixels_shaded);
        raise(&mut self.pixels_hidden, other.pixels_hidden);
        raise(&mut self.depth_tests, other.depth_tests);
        raise(&mut self.texture_fetches, other.texture_fetches);
    }
}

/// Adds, up to the maximum.
#[inline(always)]
fn raise(counter: &mut u32, by: u32) {
    *counter = counter.saturating_add(by);
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Kills: an addition that wraps, a counter that is left out of a sum.
    #[test]
    fn counters_stay_at_their_maximum() {
        let full = SpanCounts {
            spans: u32::MAX,
            spans_hidden: u32::MAX,
            spans_untested: u32::MAX,
            pixels_shaded: u32::MAX,
            pixels_hidden: u32::MAX,
            depth_tests: u32::MAX,
            texture_fetches: u32::MAX,
        };
        let pixels = |seen| SpanPixels {
            all: 7,
            seen,
            hidden: 7 - seen,
            tested: 5,
            fetched: 2,
        };
        let mut counts = full;
        counts.add_span(pixels(3), true);
        counts.add_span(pixels(0), false);
        counts.add_volume(9);
        assert_eq!(counts, full);
        counts += full;
        assert_eq!(counts, full);
        let mut few = SpanCounts::default();
        few.add_span(pixels(3), true);
        few.add_span(pixels(0), false);
        few.add_volume(4);
        few += few;
        let twice = SpanCounts {
            spans: 4,
            spans_hidden: 2,
            spans_untested: 2,
            pixels_shaded: 6,
            pixels_hidden: 22,
            depth_tests: 28,
            texture_fetches: 8,
        };
        assert_eq!(few, twice);
    }
}
