//! `firmware`: every frame of the firmware against the same frame drawn here, bit for bit (X1).

use crate::args::FirmwareArgs;
use crate::figures::gate::{Record, Verdict};
use crate::figures::{Bench, Figure, Size, goals, growth, suite};
use crate::firmware::{
    self, BOARDS, Board, COMPARER, DEFAULT_TIMEOUT, Measured, Profile, Sections, Toolchain,
};
use crate::frames::{FrameCounts, host_counts, host_frames};
use crate::image_out::{make_folder, write_atomically, write_image};
use crate::{flashed, paced_report, profile_report, sizes};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::Path;

/// Builds and runs the firmware on every board and compares; `false` when a frame differs, or when
/// something costs more than recorded, or has just been recorded.
///
/// # Errors
/// When the firmware cannot be built or run, or did not say what it should.
pub fn run(args: &FirmwareArgs) -> Result<bool, Box<dyn Error>> {
    if let Some(scene) = &args.scene {
        return flashed::run(scene, args);
    }
    if args.sizes {
        return sizes::run(args).map(|()| true);
    }
    if args.paced {
        return paced_report::run(args);
    }
    if let Some(frame) = &args.profile {
        return profile_report::run(frame, args).map(|()| true);
    }
    let host = host_frames()?;
    if args.bless {
        return bless(&host);
    }
    let toolchain = Toolchain::find()?;
    let asked = args.boards();
    let boards = compared(&toolchain, &asked, &host, args.bench)?;
    let verdict = if args.bench {
        let record = Record::read(&Record::path())?
            .of_boards(|name| asked.iter().any(|board| board.name == name));
        record.judge(&toolchain.version, &figures(&boards))
    } else {
        Verdict::default()
    };
    if args.json {
        let reports: Vec<Value> = boards.iter().map(Compared::to_json).collect();
        // The first board's figures stand at the top, where the contract has them.
        let mut report = reports.first().cloned().unwrap_or_default();
        report["toolchain"] = json!(toolchain.version);
        report["targets"] = json!(reports);
        say!("{}", serde_json::to_string_pretty(&report)?);
    } else {
        say!("{}", toolchain.version);
        for board in &boards {
            board.print();
        }
    }
    if let Some(folder) = &args.output {
        plot(folder, &boards)?;
    }
    for refusal in &verdict.refused {
        tell!("slower: {refusal}");
    }
    if let Some(other) = &verdict.other {
        tell!("note: no figures of this compiler are recorded; those of {other} were used");
    }
    if verdict.better > 0 {
        let better = verdict.better;
        tell!("note: {better} figures are better than recorded: {BLESS} would keep that");
    }
    if !verdict.refused.is_empty() {
        tell!("if it has to be so, {BLESS} records it");
    }
    Ok(boards.iter().all(Compared::matches) && verdict.refused.is_empty())
}

/// The command that records figures.
const BLESS: &str = "`cargo run --release -p host-tests -- firmware --bench --bless`";

/// Records the figures of every complete compiler; `false`, because nothing was judged.
fn bless(host: &BTreeMap<&str, u32>) -> Result<bool, Box<dyn Error>> {
    let path = Record::path();
    let mut record = Record::read(&path)?;
    for toolchain in Toolchain::all()? {
        let boards = compared(&toolchain, &BOARDS, host, true)?;
        if let Some(wrong) = boards.iter().find(|board| !board.matches()) {
            let name = wrong.measured.board.name;
            return Err(format!("{name}: a frame differs, so nothing is recorded").into());
        }
        record.bless(&toolchain.version, &figures(&boards));
        record.write(&path)?;
        tell!("recorded: {}", toolchain.version);
    }
    suite::write(&record)?;
    goals::write(&record)?;
    tell!("{} is new: look at what changed in it", path.display());
    Ok(false)
}

/// Runs boards.
fn compared(
    toolchain: &Toolchain,
    asked: &[Board],
    host: &BTreeMap<&str, u32>,
    bench: bool,
) -> Result<Vec<Compared>, Box<dyn Error>> {
    let mut boards = Vec::new();
    let spans = growth::spans()?;
    let programs = if bench {
        &[COMPARER, SIZES[0], SIZES[1]][..]
    } else {
        &[COMPARER]
    };
    firmware::build_all(toolchain, asked, Profile::Release, programs, &[])?;
    let words = if bench { &["bench"][..] } else { &[] };
    for board in asked {
        let measured = firmware::measure(toolchain, board, Profile::Release, words)?;
        let mut compared = Compared::new(measured, host)?;
        if bench {
            let sizes = small_programs(toolchain, board)?;
            compared.bench = Some(Bench::new(&compared.measured.output, &spans, sizes)?);
        }
        boards.push(compared);
    }
    Ok(boards)
}

/// The small programs.
const SIZES: [&str; 2] = ["small", "looks"];

/// Builds the small programs, and runs them, so that what is measured also draws.
fn small_programs(toolchain: &Toolchain, board: &Board) -> Result<Vec<Size>, Box<dyn Error>> {
    let known = sizes::pictures()?;
    let mut sizes = Vec::new();
    for program in SIZES {
        let elf = firmware::build(toolchain, board, Profile::Release, program, &[])?;
        let said = firmware::run(board, &elf, DEFAULT_TIMEOUT)?;
        if !sizes::draws(&known, &said) {
            let name = board.name;
            return Err(format!("{name}: {program} draws something else: {said:?}").into());
        }
        sizes.push(Size {
            program,
            sections: Sections::read(&elf)?,
        });
    }
    Ok(sizes)
}

/// Everything that is recorded, by board.
fn figures(boards: &[Compared]) -> BTreeMap<String, Vec<Figure>> {
    let of = |board: &Compared| {
        let frames = board
            .frames
            .iter()
            .map(|(scene, _, _, instructions)| Figure {
                name: format!("frame {scene}"),
                value: *instructions as f64,
                // Two ticks.
                grain: 80.0,
            });
        let mut figures: Vec<Figure> = frames.collect();
        figures.extend(board.bench.iter().flat_map(Bench::figures));
        (board.measured.board.name.to_owned(), figures)
    };
    boards.iter().map(of).collect()
}

/// Writes the growth of the first board.
fn plot(folder: &Path, boards: &[Compared]) -> Result<(), Box<dyn Error>> {
    make_folder(folder)?;
    let curves = boards.first().and_then(|board| board.bench.as_ref());
    let plot = growth::plot(curves.map_or(&[], |bench| &bench.growth));
    write_atomically(&folder.join("growth.svg"), plot.to_svg().as_bytes())?;
    write_image(&folder.join("growth.png"), &plot.to_frame())?;
    Ok(())
}

/// A board's frames beside the host's.
struct Compared {
    measured: Measured,
    /// Name, host's checksum, target's checksum, instructions.
    frames: Vec<(String, u32, u32, u64)>,
    /// What the frames of the shots have.
    counts: BTreeMap<&'static str, FrameCounts>,
    /// What `--bench` measures.
    bench: Option<Bench>,
}

impl Compared {
    fn new(measured: Measured, host: &BTreeMap<&str, u32>) -> Result<Self, Box<dyn Error>> {
        let name = measured.board.name;
        let mut frames = Vec::new();
        for frame in &measured.output.frames {
            let host = host
                .get(frame.scene.as_str())
                .ok_or_else(|| format!("{name}: the host has no frame `{}`", frame.scene))?;
            frames.push((frame.scene.clone(), *host, frame.crc, frame.instructions));
        }
        if frames.len() != host.len() {
            return Err(format!("{name}: drew {} frames of {}", frames.len(), host.len()).into());
        }
        Ok(Self {
            measured,
            frames,
            counts: host_counts()?,
            bench: None,
        })
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
                let stats = self.counts.get(scene.as_str());
                let each = |of: fn(&FrameCounts) -> u32| {
                    stats.map(|stats| *instructions as f64 / f64::from(of(stats).max(1)))
                };
                json!({
                    "per_pixel": each(|stats| stats.spans.pixels_shaded),
                    "per_span": each(|stats| stats.spans.spans),
                    "per_triangle": each(|stats| stats.pass_one.triangles),
                    "scene": scene,
                    "crc_host": format!("{host:08x}"),
                    "crc_target": format!("{target:08x}"),
                    "match": host == target,
                    "instructions": instructions,
                })
            })
            .collect();
        let mut report = json!({
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
        });
        if let Some(bench) = &self.bench {
            bench.add_to(&mut report);
        }
        report
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
            "pass_one_checked_first": figure("list_checked"),
        })
    }

    fn print(&self) {
        let (board, sections) = (&self.measured.board, &self.measured.sections);
        say!(
            "{} ({}, {}): code {} bytes, fast RAM {}, line buffers {}, slow RAM {}",
            board.name,
            board.target,
            board.machine,
            sections.text_bytes(),
            sections.fast.bytes,
            sections.dma.bytes,
            sections.slow_bytes()
        );
        say!(
            "  pass one of the teapot, from a list and drawn at once: {}",
            self.list()
        );
        for (scene, host, target, instructions) in &self.frames {
            let verdict = if host == target {
                "same bits"
            } else {
                "DIFFERS"
            };
            say!("  {scene:15} {host:08x} {target:08x} {verdict}  {instructions:>10} instructions");
        }
        if let Some(bench) = &self.bench {
            bench.print();
        }
    }
}
