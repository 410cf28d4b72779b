//! `firmware`: every frame of the firmware against the same frame drawn here, bit for bit (X1).

use crate::args::FirmwareArgs;
use crate::draw::ModelLines;
use crate::firmware::{self, BOARDS, Measured, Profile, Toolchain};
use crate::mock::{HostLine, MockFrameBuffer};
use scanbeam::model::draw_model_frame;
use scanbeam::scan_out::Pump;
use scanbeam::{
    FlatDepth, GouraudDepth, LineMemory, LineRenderer, Link, ListMemory, ObjectOf, Pipeline,
    PixelFormat, Rgb565Be, Scene, SceneMemory, SpanRecord, VertexOf, draw_frame,
};
use scenes::{
    HEIGHT, LIST_INDICES, LIST_TABLE, OBJECTS, SHOTS, Shot, VARIANTS, VERTICES, WIDTH, build_listed,
};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;

/// Builds and runs the firmware on every board and compares; `false` when a frame differs.
///
/// # Errors
/// When the firmware cannot be built or run, or did not say what it should.
pub fn run(args: &FirmwareArgs) -> Result<bool, Box<dyn Error>> {
    let toolchain = Toolchain::find()?;
    let host = host_frames()?;
    let mut boards = Vec::new();
    for board in &BOARDS {
        let measured = firmware::measure(&toolchain, board, Profile::Release, &[])?;
        boards.push(Compared::new(measured, &host)?);
    }
    let all_match = boards.iter().all(Compared::matches);
    if args.json {
        let reports: Vec<Value> = boards.iter().map(Compared::to_json).collect();
        // The first board's figures stand at the top, where the contract has them.
        let mut report = reports.first().cloned().unwrap_or_default();
        report["toolchain"] = json!(toolchain.version);
        report["targets"] = json!(reports);
        println!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        println!("{}", toolchain.version);
        for board in &boards {
            board.print();
        }
    }
    Ok(all_match)
}

/// The checksums of all frames as this machine draws them, by name.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn host_frames() -> Result<BTreeMap<&'static str, u32>, Box<dyn Error>> {
    let mut frames = BTreeMap::new();
    for shot in SHOTS {
        frames.insert(
            shot.name(),
            crc32fast::hash(&draw::<GouraudDepth<Rgb565Be>>(shot)?),
        );
    }
    let flat = draw::<FlatDepth<Rgb565Be>>(Shot::Teapot)?;
    frames.insert("teapot_flat", crc32fast::hash(&flat));
    let model = draw_by_model(Shot::Teapot)?;
    frames.insert("teapot_model", crc32fast::hash(&model));
    let listed = shown(Shot::Teapot, build_list, by_lines)?;
    frames.insert("teapot_list", crc32fast::hash(&listed));
    for variant in VARIANTS {
        // However it is drawn there, it is the shot that one renderer draws here.
        let plain = draw::<GouraudDepth<Rgb565Be>>(variant.shot)?;
        frames.insert(variant.name, crc32fast::hash(&plain));
    }
    Ok(frames)
}

/// Lines that one transfer takes.
const LINES: u16 = 3;

/// The bytes of a shot in scan-out order.
fn draw<P: Pipeline<Pixel = Rgb565Be>>(shot: Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    shown::<P>(shot, |scene| build(shot, scene), by_lines)
}

/// Draws all lines with one renderer.
fn by_lines<P: Pipeline<Pixel = Rgb565Be>>(
    scene: &Scene<'_, P>,
    pump: &mut Display,
    background: u16,
) -> Result<(), Box<dyn Error>> {
    use scanbeam::LineDepth;
    const SLOTS: usize = 64;
    let mut slots = vec![LineRenderer::<P>::empty_slot(); SLOTS];
    let mut links = vec![Link::NONE; OBJECTS];
    let mut depth = vec![P::Depth::FARTHEST; usize::from(WIDTH)];
    let mut spans = vec![SpanRecord::default(); SLOTS];
    let mut renderer = LineRenderer::new(LineMemory {
        slots: &mut slots,
        links: &mut links,
        depth: &mut depth,
        spans: &mut spans,
    });
    draw_frame(scene, &mut renderer, pump, background, LINES)?;
    Ok(())
}

/// The bytes of a shot as the hardware model draws it.
fn draw_by_model(shot: Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    type Smooth = GouraudDepth<Rgb565Be>;
    let mut lines = ModelLines::new(WIDTH);
    let mut renderer = lines.renderer();
    shown::<Smooth>(
        shot,
        |scene| build(shot, scene),
        |scene, pump, background| {
            draw_model_frame(scene, &mut renderer, pump, background, LINES)
                .map_err(|error| format!("{error:?}"))?;
            Ok(())
        },
    )
}

/// Draws a shot into a scene.
fn build<P: Pipeline>(shot: Shot, scene: &mut Scene<'_, P>) -> Result<(), Box<dyn Error>> {
    shot.build(scene)
        .map_err(|error| format!("{}: {error:?}", shot.name()))?;
    Ok(())
}

/// The baked list, as the firmware runs it from flash.
fn build_list(scene: &mut Scene<'_, GouraudDepth<Rgb565Be>>) -> Result<(), Box<dyn Error>> {
    let (mut normals, mut indices) = ([[0; 3]; LIST_TABLE], [0; LIST_INDICES]);
    let memory = ListMemory {
        positions: &mut [],
        normals: &mut normals,
        colours: &mut [],
        indices: &mut indices,
    };
    build_listed(scene, memory).map_err(|error| format!("teapot.list: {error:?}"))?;
    Ok(())
}

type Display = Pump<MockFrameBuffer<u16>>;

/// What arrives at the display when `draw` draws what `build` has built, over a shot's background.
fn shown<P: Pipeline<Pixel = Rgb565Be>>(
    shot: Shot,
    build: impl FnOnce(&mut Scene<'_, P>) -> Result<(), Box<dyn Error>>,
    draw: impl FnOnce(&Scene<'_, P>, &mut Display, u16) -> Result<(), Box<dyn Error>>,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut vertices = vec![VertexOf::<P>::empty(); VERTICES];
    let mut objects = vec![ObjectOf::<P>::default(); OBJECTS];
    let mut buckets = vec![Link::NONE; usize::from(HEIGHT)];
    let mut scene = Scene::<P>::new(
        Shot::screen(),
        SceneMemory {
            vertices: &mut vertices,
            objects: &mut objects,
            buckets: &mut buckets,
        },
    );
    build(&mut scene)?;
    let words = usize::from(WIDTH) * usize::from(LINES);
    let sink = MockFrameBuffer::new(WIDTH, HEIGHT).late_by(1);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let background = Rgb565Be::from_rgb8(shot.background());
    draw(&scene, &mut pump, background)?;
    let words = pump.sink().frame()?;
    Ok(words.into_iter().flat_map(u16::to_ne_bytes).collect())
}

/// A board's frames beside the host's.
struct Compared {
    measured: Measured,
    /// Name, host's checksum, target's checksum, instructions.
    frames: Vec<(String, u32, u32, u64)>,
}

impl Compared {
    fn new(measured: Measured, host: &BTreeMap<&str, u32>) -> Result<Self, String> {
        let name = measured.board.name;
        let mut frames = Vec::new();
        for frame in &measured.output.frames {
            let host = host
                .get(frame.scene.as_str())
                .ok_or_else(|| format!("{name}: the host has no frame `{}`", frame.scene))?;
            frames.push((frame.scene.clone(), *host, frame.crc, frame.instructions));
        }
        if frames.len() != host.len() {
            return Err(format!(
                "{name}: drew {} frames of {}",
                frames.len(),
                host.len()
            ));
        }
        Ok(Self { measured, frames })
    }

    fn matches(&self) -> bool {
        self.frames
            .iter()
            .all(|(_, host, target, _)| host == target)
    }

    fn to_json(&self) -> Value {
        let sections = &self.measured.sections;
        let frames: Vec<Value> = self
            .frames
            .iter()
            .map(|(scene, host, target, instructions)| {
                json!({
                    "scene": scene,
                    "crc_host": format!("{host:08x}"),
                    "crc_target": format!("{target:08x}"),
                    "match": host == target,
                    "instructions": instructions,
                })
            })
            .collect();
        json!({
            "board": self.measured.board.name,
            "target": self.measured.board.target,
            "machine": self.measured.board.machine,
            "text_bytes": sections.text_bytes(),
            "ram_bytes": sections.ram_bytes(),
            "fast_bytes": sections.fast.bytes,
            "line_bytes": sections.dma.bytes,
            "slow_bytes": sections.slow_bytes(),
            "stack_bytes": self.measured.output.figures.get("stack_bytes"),
            "list": self.list(),
            "frames": frames,
        })
    }

    /// What pass one of the baked teapot costs, beside the same tables by immediate calls.
    fn list(&self) -> Value {
        let figure = |name: &str| {
            let figures = &self.measured.output.figures;
            figures.get(name).copied().unwrap_or_default()
        };
        let (listed, called) = (figure("list_pass_one"), figure("calls_pass_one"));
        let vertices = figure("list_vertices");
        json!({
            "pass_one": listed,
            "pass_one_by_calls": called,
            "vertices": vertices,
            "more_per_vertex": (listed as f64 - called as f64) / vertices.max(1) as f64,
        })
    }

    fn print(&self) {
        let (board, sections) = (&self.measured.board, &self.measured.sections);
        println!(
            "{} ({}, {}): code {} bytes, fast RAM {}, line buffers {}, slow RAM {}",
            board.name,
            board.target,
            board.machine,
            sections.text_bytes(),
            sections.fast.bytes,
            sections.dma.bytes,
            sections.slow_bytes()
        );
        println!(
            "  pass one of the teapot, from a list and drawn at once: {}",
            self.list()
        );
        for (scene, host, target, instructions) in &self.frames {
            let verdict = if host == target {
                "same bits"
            } else {
                "DIFFERS"
            };
            println!(
                "  {scene:15} {host:08x} {target:08x} {verdict}  {instructions:>10} instructions"
            );
        }
    }
}
