//! How long the memory accesses of a frame take, from their counts (C8).
//!
//! A memory is modelled as a cost for each burst (command, address, latency: paid anew whenever
//! the address jumps) and a cost for each word that a burst moves. Object records and vertices
//! are bursts of their own, links are bursts of two bytes. The slow memory is not behind a
//! hardware cache here, so the model is the upper end for a processor that has one.
//!
//! The processor's own work is the same counts times instructions, of which those
//! that the cache changes were measured on a Cortex-M4 in QEMU, at one instruction a cycle; instructions do not overlap with memory.

use scanbeam::frame::CacheUse;
use scanbeam::stats::SpanCounts;

/// The access time of a memory.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Memory {
    /// For reports.
    pub name: &'static str,
    /// Nanoseconds before the first word of a burst.
    pub burst_ns: f64,
    /// Nanoseconds for each word.
    pub word_ns: f64,
    /// Bytes of a word; a burst is rounded up to whole ones.
    pub word_bytes: u64,
    /// Where the figures are from.
    pub source: &'static str,
}

/// The slow memory of the object cache's text.
pub const DRAM_80: Memory = Memory {
    name: "DRAM 80 ns",
    burst_ns: 0.0,
    word_ns: 80.0,
    word_bytes: 4,
    source: "US 5,592,601: access time of the DRAM; one 32-bit word an access, no bursts",
};

/// The fast memory of the object cache's text.
pub const SRAM_12: Memory = Memory {
    name: "SRAM 12 ns",
    burst_ns: 0.0,
    word_ns: 12.0,
    word_bytes: 4,
    source: "US 5,592,601: access time of the SRAM; one 32-bit word an access",
};

/// Serial RAM on four wires, as on many RP2350 and ESP32 boards.
pub const QSPI_PSRAM: Memory = Memory {
    name: "QSPI PSRAM",
    burst_ns: 185.0,
    word_ns: 23.8,
    word_bytes: 1,
    source: "AP Memory APS6404L class at its 84 MHz for linear bursts: quad read EBh has 2 clocks \
             of command, 6 of address and 6 of waiting, then 2 clocks a byte; 18 ns of chip \
             select between bursts",
};

/// Synchronous DRAM, 16 bits wide, on the external bus of an STM32F4 or F7 class controller.
pub const SDRAM: Memory = Memory {
    name: "SDRAM",
    burst_ns: 77.8,
    word_ns: 11.1,
    word_bytes: 2,
    source: "SDR SDRAM of the 133 MHz class (CL 3) clocked at 90 MHz: precharge 2, activate 2, \
             CAS 3 clocks for a row that is not open, then a clock for each 16 bits",
};

/// Tightly coupled RAM of a Cortex-M7.
pub const DTCM: Memory = Memory {
    name: "DTCM",
    burst_ns: 0.0,
    word_ns: 2.1,
    word_bytes: 4,
    source: "Arm Cortex-M7: tightly coupled memory without wait states, here at 480 MHz",
};

/// Slow and fast memory that are found together.
pub const SYSTEMS: [(Memory, Memory); 3] = [(DRAM_80, SRAM_12), (QSPI_PSRAM, DTCM), (SDRAM, DTCM)];

impl Memory {
    /// Nanoseconds for `bursts` accesses of `bytes` each.
    #[must_use]
    pub fn time_ns(&self, bursts: u64, bytes: u64) -> f64 {
        let words = bytes.div_ceil(self.word_bytes);
        bursts as f64 * (self.burst_ns + words as f64 * self.word_ns)
    }
}

/// How an object lies in slow memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Layout {
    /// 8 bytes a triangle with indices, and 12 a vertex, shared: what the crate does.
    Indexed,
    /// 40 bytes a triangle: three vertices, its chain and one `next`, all in one burst.
    Copies,
}

impl Layout {
    /// Both.
    pub const ALL: [Self; 2] = [Self::Indexed, Self::Copies];

    /// For reports.
    #[must_use]
    pub const fn name(self) -> &'static str {
        match self {
            Self::Indexed => "indexed",
            Self::Copies => "copies",
        }
    }

    /// The bursts that read one record: how many, and how many bytes each.
    #[must_use]
    pub const fn bursts(self) -> &'static [(u64, u64)] {
        match self {
            Self::Indexed => &[(1, 8), (3, 12)],
            Self::Copies => &[(1, 40)],
        }
    }

    /// Bytes that reading one record moves.
    #[must_use]
    pub fn record_bytes(self) -> u64 {
        self.bursts()
            .iter()
            .map(|(count, bytes)| count * bytes)
            .sum()
    }

    /// Bytes that a scene takes, all of which pass one writes.
    #[must_use]
    pub fn scene_bytes(self, objects: u64, vertices: u64) -> u64 {
        match self {
            Self::Indexed => 8 * objects + 12 * vertices,
            Self::Copies => 40 * objects,
        }
    }
}

/// What was counted of a frame.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Counted {
    /// The cache.
    pub cache: CacheUse,
    /// Spans and pixels.
    pub spans: SpanCounts,
    /// Lines, and pixels a line.
    pub size: (u64, u64),
    /// Bytes of a slot.
    pub slot_bytes: u64,
}

/// Instructions on a Cortex-M4 to set an object up: the difference between the teapot's frames without a slot and with
/// slots for all that `scanbeam firmware` reports, for each set-up more. Where some 60 without a slot are on a line, as of
/// the crowd, it is 14,000, since each is compared with the others; the model leaves that out.
pub const SET_UP: f64 = 1_040.0;
/// Instructions of an object on a line, without its pixels: a round figure, which moves the whole
/// curve and not its shape.
pub const OBJECT_LINE: f64 = 110.0;
/// Instructions of a pixel that is compared, and coloured when it is seen: a round figure too.
pub const PIXEL: f64 = 13.0;
/// Cycles a second of the modelled processor.
pub const CLOCK_HZ: f64 = 150e6;

/// Where the time of a frame's second pass goes, in milliseconds.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct FrameTime {
    /// Reading records and links from slow memory and writing links.
    pub slow_ms: f64,
    /// Slots, the depth of a line and its pixels in fast memory.
    pub fast_ms: f64,
    /// Instructions.
    pub work_ms: f64,
}

impl FrameTime {
    /// All of it.
    #[must_use]
    pub fn total_ms(&self) -> f64 {
        self.slow_ms + self.fast_ms + self.work_ms
    }
}

impl Counted {
    /// Spans that were drawn from a slot.
    #[must_use]
    pub fn hits(&self) -> u64 {
        u64::from(self.spans.spans.saturating_sub(self.cache.misses))
    }

    /// Their share of all.
    #[must_use]
    pub fn hit_rate(&self) -> f64 {
        self.hits() as f64 / f64::from(self.spans.spans.max(1))
    }

    /// Bytes read from and written to slow memory.
    #[must_use]
    pub fn slow_bytes(&self, layout: Layout) -> u64 {
        let record = layout.record_bytes() as u32;
        self.cache.slow_read_bytes(record) + self.cache.slow_write_bytes()
    }

    /// The time of the frame.
    #[must_use]
    pub fn time(&self, layout: Layout, (slow, fast): (Memory, Memory)) -> FrameTime {
        let (c, s) = (&self.cache, &self.spans);
        let records = c.records_read();
        let links = (c.slow_read_bytes(0) + c.slow_write_bytes()) / 2;
        let mut slow_ns = slow.time_ns(links, 2);
        for (count, bytes) in layout.bursts() {
            slow_ns += slow.time_ns(records * count, *bytes);
        }
        let tested = u64::from(s.pixels_shaded + s.pixels_hidden);
        let (lines, width) = self.size;
        let fast_ns = fast.time_ns(self.hits() + records, self.slot_bytes)
            + fast.time_ns(tested + u64::from(s.pixels_shaded), 4)
            + fast.time_ns(u64::from(s.pixels_shaded), 2)
            + fast.time_ns(lines, width * 6);
        let instructions = f64::from(c.set_ups) * SET_UP
            + f64::from(s.spans) * OBJECT_LINE
            + tested as f64 * PIXEL;
        FrameTime {
            slow_ms: slow_ns / 1e6,
            fast_ms: fast_ns / 1e6,
            work_ms: instructions / CLOCK_HZ * 1e3,
        }
    }
}
