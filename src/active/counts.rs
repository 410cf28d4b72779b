//! Counters of the object cache (C8), and what they mean in bytes of slow memory.

use crate::link::Link;

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
