//! The table of caches.

use host_tests::args::CacheArgs;
use host_tests::cache_report::*;
use host_tests::memory_model::{Layout, SYSTEMS};
use scenes::Shot;

#[test]
fn more_slots_are_fewer_slow_bytes_and_less_time() {
    let rows = measure(Shot::Sphere).unwrap().rows;
    for pair in rows[..SLOTS.len()].windows(2) {
        let bytes = |row: &Row| row.model.slow_bytes(Layout::Indexed);
        assert!(
            bytes(&pair[1]) <= bytes(&pair[0]),
            "{} slots",
            pair[1].slots
        );
        for system in SYSTEMS {
            let ms = |row: &Row| row.model.time(Layout::Indexed, system).total_ms();
            assert!(ms(&pair[1]) <= ms(&pair[0]) * 1.02);
        }
    }
    let goal = rows.iter().find(|row| row.slots == GOAL_SLOTS).unwrap();
    assert!(saving(goal, &rows[0]) >= 5.0, "{}", saving(goal, &rows[0]));
    // Fetched ahead it is no more that is read, and hardly anything is left for when its line comes.
    let ahead = rows.last().unwrap();
    let read = |row: &Row| row.model.cache.slow_read_bytes(RECORD_BYTES);
    assert!(ahead.model.cache.fetched * 5 > 4 * ahead.model.cache.hits);
    assert!(read(ahead) <= read(goal));
}

#[test]
fn plots_are_written_whole() {
    let folder = tempfile::tempdir().unwrap();
    let args = CacheArgs {
        json: false,
        output: Some(folder.path().join("new")),
    };
    run(&args).unwrap();
    for shot in SHOTS {
        let svg = folder.path().join(format!("new/cache_{}.svg", shot.name()));
        let svg = std::fs::read_to_string(svg).unwrap();
        assert!(svg.starts_with("<svg ") && svg.trim_end().ends_with("</svg>"));
        let png = folder.path().join(format!("new/cache_{}.png", shot.name()));
        host_tests::image_out::read_image(&png).unwrap();
    }
}
