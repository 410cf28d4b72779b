//! The model of slow and fast memory.

use host_tests::memory_model::*;
use scanbeam::Renderer;
use scanbeam::frame::CacheUse;
use scanbeam::look::Gouraud;
use scanbeam::pixel::Rgb565Be;
use scanbeam::stats::SpanCounts;

#[test]
fn bursts_are_whole_words() {
    assert_eq!(DRAM_80.time_ns(1, 2), 80.0);
    assert_eq!(DRAM_80.time_ns(3, 12), 720.0);
    assert_eq!(SDRAM.time_ns(2, 3), 2.0 * (77.8 + 2.0 * 11.1));
    assert_eq!(DTCM.time_ns(0, 100), 0.0);
}

#[test]
fn the_indexed_layout_is_the_crates() {
    let record = Renderer::<Gouraud<Rgb565Be>>::RECORD_BYTES;
    assert_eq!(Layout::Indexed.record_bytes(), u64::from(record));
    assert_eq!(Layout::Copies.record_bytes(), 40);
    assert_eq!(Layout::Indexed.scene_bytes(2, 3), 52);
}

#[test]
fn slow_accesses_cost_what_they_count() {
    let counted = Counted {
        cache: CacheUse {
            hits: 3,
            spilled: 1,
            misses: 4,
            set_ups: 7,
            turning: 2,
            ..CacheUse::default()
        },
        spans: SpanCounts {
            spans: 9,
            ..SpanCounts::default()
        },
        size: (0, 0),
        slot_bytes: 100,
    };
    assert_eq!(counted.hits(), 5);
    // 13 records, 4 links read and 5 written.
    assert_eq!(counted.slow_bytes(Layout::Indexed), 13 * 44 + 8 + 10);
    assert_eq!(counted.slow_bytes(Layout::Copies), 13 * 40 + 8 + 10);
    let time = counted.time(Layout::Copies, (DRAM_80, SRAM_12));
    assert!((time.slow_ms * 1e6 - (9.0 + 130.0) * 80.0).abs() < 1e-6);
    // Slots of 5 spans and of 13 records.
    assert!((time.fast_ms * 1e6 - 18.0 * 25.0 * 12.0).abs() < 1e-6);
    let work = 7.0 * SET_UP + 9.0 * OBJECT_LINE;
    assert!((time.work_ms - work / CLOCK_HZ * 1e3).abs() < 1e-9);
    assert!(time.total_ms() > time.slow_ms + time.fast_ms);
}
