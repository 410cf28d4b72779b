//! `cache`: what the object cache saves, for three scenes and any number of slots (C8).
//!
//! Each scene is drawn with every size of cache, with all accesses to slow memory counted; the
//! memory model makes times of the counts. The pictures must be the same, or there is no report.
//!
//! Texture memory follows, for people: what a texture in blocks saves against one in rows (B5).

use crate::args::CacheArgs;
use crate::draw::MOST_SLOTS;
use crate::image_out::{make_folder, write_atomically, write_image};
use crate::memory_model::{
    Counted as Model, DRAM_80, DTCM, Layout, QSPI_PSRAM, SDRAM, SRAM_12, SYSTEMS,
};
use crate::mock::{HostLine, MockFrameBuffer};
use crate::plot::{Chart, Marks, Series};
use crate::rooms::{LineRooms, Room, SceneRooms};
use crate::texture_report::texture_table;
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use scanbeam::frame::FastMemory;
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::Pump;
use scanbeam::scene::Assembled;
use scanbeam::{Renderer, draw_frame};
use scenes::{DRAWS, HEIGHT, OBJECTS, Shot, VERTICES, WIDTH};
use serde_json::{Value, json};
use std::error::Error;

type Look = Gouraud<Rgb565Be>;

/// Bytes of a triangle and its corners.
pub const RECORD_BYTES: u32 = Renderer::<Look, WORDS>::RECORD_BYTES;
/// Words of 32 slots of the largest cache.
const WORDS: usize = MOST_SLOTS as usize / 32;
/// The scenes.
pub const SHOTS: [Shot; 3] = [Shot::Teapot, Shot::Sphere, Shot::Crowd];
/// Sizes of the cache.
pub const SLOTS: [u16; 14] = [0, 1, 2, 4, 8, 16, 24, 32, 43, 64, 96, 128, 192, MOST_SLOTS];
/// The size whose figures are the goal's.
pub const GOAL_SLOTS: u16 = 64;
/// Bytes a line that are fetched ahead where anything is.
const AHEAD: u32 = 4_000;
/// Lines of a transfer.
const LINES: u16 = 4;

/// A scene drawn with one size of cache.
pub struct Row {
    /// Slots of the cache.
    pub slots: u16,
    /// Bytes a line that were fetched ahead.
    pub prefetch: u32,
    /// What was counted.
    pub model: Model,
}

/// A scene, and what it was drawn with.
pub struct Measured {
    pass: Assembled,
    objects: usize,
    vertices: usize,
    /// By sizes of the cache, the last one fetching ahead.
    pub rows: Vec<Row>,
}

/// Draws, prints and writes.
///
/// # Errors
/// When a file cannot be written. Drawing fails only when this file lends too little memory.
pub fn run(args: &CacheArgs) -> Result<(), Box<dyn Error>> {
    let mut reports = Vec::new();
    let mut charts = Vec::new();
    for shot in SHOTS {
        let measured = measure(shot)?;
        if !args.json {
            print(shot, &measured);
        }
        reports.push(to_json(shot, &measured));
        charts.push((shot.name(), chart(shot, &measured.rows)));
    }
    if args.json {
        say!("{}", serde_json::to_string_pretty(&Value::from(reports))?);
    } else {
        for memory in [DRAM_80, SRAM_12, QSPI_PSRAM, SDRAM, DTCM] {
            say!("{}: {}", memory.name, memory.source);
        }
        say!("a texture of 256 x 256 x 16 bits, pages of 1 KB, a cache of 32 lines of 32 bytes:");
        say!("{}", texture_table());
    }
    if let Some(folder) = &args.output {
        make_folder(folder)?;
        for (name, chart) in charts {
            let at = |extension| folder.join(format!("cache_{name}.{extension}"));
            write_atomically(&at("svg"), chart.to_svg().as_bytes())?;
            write_image(&at("png"), &chart.to_frame())?;
        }
    }
    Ok(())
}

/// The charts of all scenes.
///
/// # Errors
/// When this file lends too little memory.
pub fn charts() -> Result<Vec<Chart>, Box<dyn Error>> {
    SHOTS
        .into_iter()
        .map(|shot| Ok(chart(shot, &measure(shot)?.rows)))
        .collect()
}

/// Draws a scene with every size of cache, and once with fetching ahead.
pub fn measure(shot: Shot) -> Result<Measured, Box<dyn Error>> {
    let room = Room {
        vertices: VERTICES,
        places: 0,
        objects: OBJECTS,
        draws: DRAWS,
    };
    let mut lent = SceneRooms::new(room, HEIGHT);
    let mut scene = lent.scene::<Look>(Shot::screen());
    shot.build(&mut scene)
        .map_err(|error| format!("{}: {error:?}", shot.name()))?;
    let mut rows = Vec::new();
    let mut first = None;
    let settings = SLOTS.into_iter().map(|slots| (slots, 0));
    for (slots, prefetch) in settings.chain([(GOAL_SLOTS, AHEAD)]) {
        let rooms: LineRooms<Look, WORDS> = LineRooms::new(OBJECTS, WIDTH);
        let mut rooms = rooms.with_limit(slots);
        let mut renderer = rooms.renderer().counting().fetching(prefetch);
        let words = usize::from(WIDTH) * usize::from(LINES);
        let sink = MockFrameBuffer::new(WIDTH, HEIGHT).late_by(1);
        let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
        let background = Rgb565Be::from_rgb8(shot.background());
        let used = draw_frame(&scene, &mut renderer, &mut pump, background, LINES)?;
        let frame = pump.sink().frame()?;
        if first.get_or_insert_with(|| frame.clone()) != &frame {
            return Err(format!("{}: {slots} slots change the picture", shot.name()).into());
        }
        let spans = renderer.spans();
        let lines = u64::from(HEIGHT);
        rows.push(Row {
            slots,
            prefetch,
            model: Model {
                cache: used.cache,
                spans,
                size: (lines, u64::from(WIDTH)),
                slot_bytes: FastMemory::<Look, WORDS>::SLOT_BYTES as u64,
            },
        });
    }
    Ok(Measured {
        pass: scene.assembled(),
        objects: scene.objects(),
        vertices: scene.vertices(),
        rows,
    })
}

/// How many times fewer slow bytes than `without`.
pub fn saving(row: &Row, without: &Row) -> f64 {
    let bytes = |row: &Row| row.model.slow_bytes(Layout::Indexed) as f64;
    bytes(without) / bytes(row).max(1.0)
}

fn print(shot: Shot, measured: &Measured) {
    let Measured {
        pass,
        objects,
        vertices,
        rows,
    } = measured;
    let [without, ..] = &rows[..] else { return };
    say!(
        "{}: {} triangles in, {} objects, {} vertices kept; a slot is {} bytes",
        shot.name(),
        pass.triangles,
        objects,
        vertices,
        without.model.slot_bytes
    );
    let mut table = Table::new();
    table.load_preset(UTF8_FULL_CONDENSED);
    let mut header: Vec<String> = ["slots", "hits %", "misses", "slow bytes", "times fewer"]
        .map(String::from)
        .into();
    header.extend(SYSTEMS.map(|(slow, fast)| format!("ms: {} + {}", slow.name, fast.name)));
    table.set_header(header);
    for row in rows {
        let ahead = if row.prefetch > 0 { " ahead" } else { "" };
        let mut cells = vec![
            format!("{}{ahead}", row.slots),
            format!("{:.1}", 100.0 * row.model.hit_rate()),
            row.model.cache.misses.to_string(),
            row.model.slow_bytes(Layout::Indexed).to_string(),
            format!("{:.1}", saving(row, without)),
        ];
        for system in SYSTEMS {
            let time = row.model.time(Layout::Indexed, system);
            cells.push(format!("{:.2} (slow {:.2})", time.total_ms(), time.slow_ms));
        }
        table.add_row(cells);
    }
    for column in table.column_iter_mut() {
        column.set_cell_alignment(CellAlignment::Right);
    }
    say!("{table}");
    for layout in Layout::ALL {
        let scene = layout.scene_bytes(*objects as u64, *vertices as u64);
        let mut line = format!("  {}: scene {scene} bytes;", layout.name());
        for row in rows.iter().filter(|r| matches!(r.slots, 0 | GOAL_SLOTS)) {
            let bytes = row.model.slow_bytes(layout);
            let ms = SYSTEMS.map(|s| format!("{:.2}", row.model.time(layout, s).slow_ms));
            let ahead = if row.prefetch > 0 { " ahead" } else { "" };
            line.push_str(&format!(
                " {} slots{ahead} {bytes} bytes, {} ms;",
                row.slots,
                ms.join(" / ")
            ));
        }
        say!("{line}");
    }
}

fn to_json(shot: Shot, measured: &Measured) -> Value {
    let Measured {
        objects,
        vertices,
        rows,
        ..
    } = measured;
    let without = &rows[0];
    let figures: Vec<Value> = rows
        .iter()
        .map(|row| {
            let layouts: Vec<Value> = Layout::ALL
                .iter()
                .map(|layout| {
                    let systems: Vec<Value> = SYSTEMS
                        .iter()
                        .map(|system| {
                            let time = row.model.time(*layout, *system);
                            json!({
                                "slow": system.0.name,
                                "fast": system.1.name,
                                "frame_ms": time.total_ms(),
                                "slow_ms": time.slow_ms,
                                "fast_ms": time.fast_ms,
                                "work_ms": time.work_ms,
                            })
                        })
                        .collect();
                    json!({
                        "layout": layout.name(),
                        "record_bytes": layout.record_bytes(),
                        "scene_bytes": layout.scene_bytes(*objects as u64, *vertices as u64),
                        "slow_bytes": row.model.slow_bytes(*layout),
                        "times": systems,
                    })
                })
                .collect();
            let model = &row.model;
            let cache = &model.cache;
            json!({
                "slots": row.slots,
                "prefetch_budget": row.prefetch,
                "hits": model.hits(),
                "misses": cache.misses,
                "hit_rate": model.hit_rate(),
                "spills": cache.spilled,
                "records_read": cache.records_read(),
                "prefetched": cache.fetched,
                "prefetch_bytes": cache.fetched_bytes,
                "peak_slots": cache.peak,
                "slow_read_bytes": cache.slow_read_bytes(RECORD_BYTES),
                "slow_write_bytes": cache.slow_write_bytes(),
                "times_fewer_slow_bytes": saving(row, without),
                "layouts": layouts,
            })
        })
        .collect();
    json!({
        "scene": shot.name(),
        "objects": objects,
        "vertices": vertices,
        "slot_bytes": without.model.slot_bytes,
        "caches": figures,
    })
}

fn chart(shot: Shot, rows: &[Row]) -> Chart {
    let plain = || rows.iter().filter(|row| row.prefetch == 0);
    let series = SYSTEMS.map(|system| Series {
        name: format!("{} + {}", system.0.name, system.1.name),
        values: plain()
            .map(|row| row.model.time(Layout::Indexed, system).total_ms())
            .collect(),
    });
    Chart {
        title: format!("{}: frame time against cache slots", shot.name()),
        x: plain().map(|row| row.slots.to_string()).collect(),
        x_name: "cache slots".into(),
        y_name: "ms, second pass, 150 MHz".into(),
        series: series.into(),
        marks: Marks::Lines,
    }
}
