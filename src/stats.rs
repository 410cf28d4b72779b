//! Counters of what was done and of what was skipped (M4), in pass one and along spans, and of the
//! object cache (C8).

use crate::link::Link;

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
    /// Spans of one colour: no colour was taken from pixel to pixel. Of presets alone.
    pub spans_flat: u32,
    /// Pixels that were given a colour, by each span that gave one: where nothing on a line is blended, cut or has a
    /// depth test of its own, each covered pixel once, and elsewhere once more for each span that was laid over it. What
    /// a line colours again, since spans were found to meet on it, is counted once.
    pub pixels_shaded: u32,
    /// Pixels of spans that lost against what was there, or what came after. Holes of textures do not count, where no
    /// depth was asked for them.
    pub pixels_hidden: u32,
    /// Pixels whose depth was compared with the one of their column: on lines with draw calls that blend, cut, have
    /// holes, dither, cast shadows or have a depth test, where spans meet or a call is blended or has such a test; and pixels
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

impl SpanCounter for SpanCounts {
    const COUNTS: bool = true;

    #[inline]
    fn span(&mut self, seen: u32, hidden: u32, tested: bool) {
        raise(&mut self.spans, 1);
        raise(&mut self.spans_hidden, u32::from(seen == 0));
        raise(&mut self.pixels_shaded, seen);
        raise(&mut self.pixels_hidden, hidden);
        if tested {
            raise(&mut self.depth_tests, seen.saturating_add(hidden));
        } else {
            raise(&mut self.spans_untested, 1);
        }
    }

    #[inline]
    fn flat(&mut self) {
        raise(&mut self.spans_flat, 1);
    }

    #[inline]
    fn fetched(&mut self, texels: u32) {
        raise(&mut self.texture_fetches, texels);
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
        raise(&mut self.spans, other.spans);
        raise(&mut self.spans_hidden, other.spans_hidden);
        raise(&mut self.spans_untested, other.spans_untested);
        raise(&mut self.spans_flat, other.spans_flat);
        raise(&mut self.pixels_shaded, other.pixels_shaded);
        raise(&mut self.pixels_hidden, other.pixels_hidden);
        raise(&mut self.depth_tests, other.depth_tests);
        raise(&mut self.texture_fetches, other.texture_fetches);
    }
}

/// How the cache has done since the list was cleared (C8).
///
/// `hits + misses` are all object-lines, each counted once.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CacheCounts {
    /// Object-lines served from the cache.
    pub hits: u32,
    /// Object-lines served from slow memory: the first line of an object that was not fetched
    /// ahead, and each line of one that found no slot.
    pub misses: u32,
    /// Objects that found the cache full when they became active.
    pub spills: u32,
    /// Times a cached object's record was read again: on its way past a corner that its edges
    /// do not reach, when a line first needs its depth, or on each line of a triangle too thin for
    /// planes.
    pub set_ups: u32,
    /// Objects fetched into slots ahead of their line (C4).
    pub fetched: u32,
    /// Objects that were in their slots when their first line came.
    pub fetched_hits: u32,
    /// Records read ahead for objects that end before this renderer's next line.
    pub fetched_in_vain: u32,
    /// Objects taken from buckets by their links alone; each costs one read of the chain, which
    /// for a fetched one comes with its record.
    pub admitted: u32,
    /// Buckets whose head was read.
    pub buckets: u32,
    /// Links written to slow memory, in this renderer's column.
    pub link_writes: u32,
    /// Links read from this renderer's column; one more for each miss.
    pub link_reads: u32,
    /// Most slots in use at once.
    pub peak_slots: u32,
}

impl CacheCounts {
    /// Records read from slow memory: an object and its corners.
    #[must_use]
    pub const fn records_read(&self) -> u32 {
        self.misses + self.set_ups + self.fetched + self.fetched_in_vain
    }

    /// Links read from slow memory: columns, chains and the heads of buckets.
    #[must_use]
    pub const fn links_read(&self) -> u32 {
        self.link_reads + self.misses + self.admitted + self.buckets
    }

    /// Bytes read from slow memory, where an object and its corners take `record_bytes`.
    #[must_use]
    pub const fn slow_read_bytes(&self, record_bytes: usize) -> u64 {
        self.records_read() as u64 * record_bytes as u64
            + self.links_read() as u64 * size_of::<Link>() as u64
    }

    /// Bytes written to slow memory while lines were drawn: links alone (C7).
    #[must_use]
    pub const fn slow_write_bytes(&self) -> u64 {
        self.link_writes as u64 * size_of::<Link>() as u64
    }

    /// Object-lines served from the cache, of 1,000.
    #[must_use]
    pub const fn hits_per_mille(&self) -> u32 {
        let all = self.hits as u64 + self.misses as u64;
        if all == 0 {
            return 1000;
        }
        (self.hits as u64 * 1000 / all) as u32
    }
}

impl core::ops::AddAssign for CacheCounts {
    /// Sums everything but `peak_slots`, of which the largest counts: caches are as large as the
    /// fullest of them.
    fn add_assign(&mut self, other: Self) {
        self.hits += other.hits;
        self.misses += other.misses;
        self.spills += other.spills;
        self.set_ups += other.set_ups;
        self.fetched += other.fetched;
        self.fetched_hits += other.fetched_hits;
        self.fetched_in_vain += other.fetched_in_vain;
        self.admitted += other.admitted;
        self.buckets += other.buckets;
        self.link_writes += other.link_writes;
        self.link_reads += other.link_reads;
        self.peak_slots = self.peak_slots.max(other.peak_slots);
    }
}

/// What pass one has done since the scene was begun.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct PassOne {
    /// Triangles submitted.
    pub triangles: u32,
    /// Triangles that cannot be seen, and never cost anything again.
    pub culled: u32,
    /// Triangles that crossed a near, far or guard plane.
    pub clipped: u32,
    /// Objects in the arena.
    pub objects: u32,
    /// Vertices in the arena.
    pub vertices: u32,
    /// Triangles that found no room.
    pub dropped: u32,
    /// Triangles that are drawn without their texture, as they stretch over more of its texels than
    /// a [`Skin`](crate::pipeline::texture::Skin) may say.
    pub untextured: u32,
    /// Meshes wholly outside the view, which were not looked at (M4). Their triangles are among
    /// the culled.
    pub meshes_skipped: u32,
    /// Triangles of these meshes.
    pub triangles_skipped: u32,
    /// Vertices of these meshes: neither transformed nor lit.
    pub vertices_skipped: u32,
}

/// Adds, up to the maximum.
#[inline(always)]
fn raise(counter: &mut u32, by: u32) {
    *counter = counter.saturating_add(by);
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn counters_stay_at_their_maximum() {
        let full = SpanCounts {
            spans: u32::MAX,
            spans_hidden: u32::MAX,
            spans_untested: u32::MAX,
            spans_flat: u32::MAX,
            pixels_shaded: u32::MAX,
            pixels_hidden: u32::MAX,
            depth_tests: u32::MAX,
            texture_fetches: u32::MAX,
        };
        let mut counts = full;
        counts.span(8192, u32::MAX, true);
        counts.span(0, 1, false);
        counts.flat();
        counts.fetched(9);
        assert_eq!(counts, full);
        counts += full;
        assert_eq!(counts, full);
        let mut few = SpanCounts::default();
        few.span(3, 4, true);
        few.span(0, 5, false);
        few += few;
        assert_eq!(
            (few.spans, few.pixels_shaded, few.pixels_hidden),
            (4, 6, 18)
        );
        assert_eq!(
            (few.depth_tests, few.spans_untested, few.spans_hidden),
            (14, 2, 2)
        );
    }
}
