//! `bench`: frames on this machine, by counted instructions and by the clock, beside other renderers;
//! with those also on Cortex-M in QEMU.
//!
//! | file | there |
//! |---|---|
//! | `boards.rs` | the same programs on Cortex-M |
//! | `scene.rs` | the scenes as numbers, for renderers that take any mesh |
//! | `table.rs` | the tables of `host-tests/figures/tables.md` |
//!
//! The programs that are measured are crates of their own, `host-tests/bench/ours` and
//! `host-tests/bench/peers`, built here with the profile of the firmware, for this machine and for
//! each board. Instructions are those
//! that callgrind counts for three frames less those for one, halved; without valgrind there are
//! none, and that is said. The clock is read in turns, and the fastest frame of each counts, since
//! whatever else the machine does only adds to it. Before anything is measured, pictures are compared: a renderer that does not draw
//! the same scene is refused.

pub mod boards;
pub mod scene;
pub mod table;

pub use boards::{Counted, OnBoard};

use crate::args::BenchArgs;
use crate::firmware::{clean_command, usual_target, workspace};
use crate::{sizes, stdio};
use scenes::{HEIGHT, Shot, WIDTH};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;
use std::path::PathBuf;
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// The name of ours.
pub const OURS: &str = "scanbeam";
/// The packages of `host-tests/bench`: ours, and the one of all peers.
pub const PACKAGES: [&str; 2] = ["ours", "peers"];
/// Renderers of the registry: name of the package, as reports have it, and as its program does.
const PEERS: [(&str, &str); 3] = [
    ("euc 0.5", "euc"),
    ("retrofire-core 0.4", "retrofire-core"),
    ("embedded-3dgfx 0.7", "embedded-3dgfx"),
];
/// Scenes that only ours draws here.
const ALONE: [Shot; 2] = [Shot::Teapot, Shot::Cube];
/// Turns of the clock, and frames in each.
const TURNS: usize = 5;
const FRAMES: usize = 9;
/// What a picture may differ by from ours: of its pixels, one in so many shown by one of them
/// alone, and so many 8-bit levels in the mean of those that both show. Wide enough for corner
/// colours that are rounded to RGB565 and vertices to whole pixels; another scene is far off.
const OTHER_PIXELS: usize = 50;
const OTHER_LEVELS: f64 = 8.0;

/// A renderer on a scene.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// The scene's name.
    pub scene: &'static str,
    /// The renderer's.
    pub renderer: &'static str,
    /// Instructions a frame; none without valgrind.
    pub instructions: Option<f64>,
    /// Pixels of the picture that show the scene.
    pub pixels: usize,
    /// Milliseconds of the fastest frame.
    pub wall_ms: f64,
    /// How many times as long as ours it takes, by the clock.
    pub ratio: f64,
    /// The same by instructions.
    pub instructions_ratio: Option<f64>,
    /// On each board, where other renderers are measured too.
    pub boards: Vec<OnBoard>,
}

impl Row {
    fn per_pixel(&self) -> Option<f64> {
        self.instructions.map(|i| i / self.pixels.max(1) as f64)
    }

    /// As `bench --json` prints it.
    pub fn to_json(&self) -> Value {
        let boards = self.boards.iter();
        let boards: serde_json::Map<String, Value> = boards
            .map(|on| (on.board.name.to_owned(), on.to_json()))
            .collect();
        json!({
            "scene": self.scene,
            "renderer": self.renderer,
            "instructions_per_frame": self.instructions,
            "instructions_per_shaded_pixel": self.per_pixel(),
            "pixels": self.pixels,
            "wall_ms": self.wall_ms,
            "ratio_to_us": self.ratio,
            "instructions_ratio_to_us": self.instructions_ratio,
            "boards": boards,
        })
    }
}

/// Measures all scenes, with other renderers or without.
///
/// # Errors
/// When a program cannot be built or run, or a renderer draws something else.
pub fn rows(peers: bool) -> Result<Vec<Row>, Box<dyn Error>> {
    Bench::new(peers)?.rows()
}

/// Measures and prints, and writes the tables where that is asked.
///
/// # Errors
/// When a program cannot be built or run, or a renderer draws something else.
pub fn run(args: &BenchArgs) -> Result<(), Box<dyn Error>> {
    let bench = Bench::new(args.peers)?;
    let rows = bench.rows()?;
    if args.json {
        let list: Vec<Value> = rows.iter().map(Row::to_json).collect();
        say!("{}", serde_json::to_string_pretty(&Value::from(list))?);
    } else {
        stdio::out(format_args!("{}", table::text(&rows)));
    }
    if !bench.valgrind {
        tell!("note: no instructions were counted: valgrind is not installed");
    }
    for reason in missing(&rows) {
        tell!("note: not measured: {reason}");
    }
    if args.markdown {
        let tables = table::page();
        table::write(&tables, &rows)?;
        sizes::write(&tables, &sizes::measure()?)?;
    }
    Ok(())
}

/// Why figures of boards are missing, each reason once.
pub fn missing(rows: &[Row]) -> Vec<&str> {
    let mut reasons: Vec<&str> = Vec::new();
    for on in rows.iter().flat_map(|row| &row.boards) {
        match &on.counted {
            Err(reason) if !reasons.contains(&reason.as_str()) => reasons.push(reason),
            _ => {}
        }
    }
    reasons
}

/// The programs, which are built, and what they are handed.
struct Bench {
    peers: bool,
    /// Scenes and pictures.
    folder: TempDir,
    valgrind: bool,
}

/// A renderer on a scene, and how to run it: all words but the number of frames and the picture.
/// Files are named as seen from the folder of scenes and pictures.
pub struct Entry {
    /// The scene.
    pub scene: Shot,
    /// The renderer's name, as reports have it.
    pub renderer: &'static str,
    /// The package that has it.
    pub package: &'static str,
    /// The words.
    pub words: Vec<String>,
}

impl Bench {
    fn new(peers: bool) -> Result<Self, Box<dyn Error>> {
        let folder = tempfile::tempdir()?;
        for shot in scene::SHARED {
            let data = scene::Data::new(shot).ok_or("a shared scene has no numbers")?;
            let file = folder.path().join(format!("{}.json", shot.name()));
            std::fs::write(file, serde_json::to_vec(&data)?)?;
        }
        let valgrind = Command::new("valgrind")
            .arg("--version")
            .stdout(Stdio::null())
            .stderr(Stdio::null())
            .status();
        for package in PACKAGES.iter().take(1 + usize::from(peers)) {
            build(package)?;
        }
        Ok(Self {
            peers,
            folder,
            valgrind: valgrind.is_ok_and(|status| status.success()),
        })
    }

    /// Everything that is to be measured, ours first on each scene.
    fn entries(&self) -> Vec<Entry> {
        let [ours, others] = PACKAGES;
        let mut entries = Vec::new();
        for scene in scene::SHARED.into_iter().chain(ALONE) {
            entries.push(Entry {
                scene,
                renderer: OURS,
                package: ours,
                words: vec![scene.name().to_owned()],
            });
            if !self.peers || !scene::SHARED.contains(&scene) {
                continue;
            }
            for (renderer, word) in PEERS {
                let file = format!("{}.json", scene.name());
                entries.push(Entry {
                    scene,
                    renderer,
                    package: others,
                    words: vec![word.to_owned(), file],
                });
            }
        }
        entries
    }

    fn rows(&self) -> Result<Vec<Row>, Box<dyn Error>> {
        let entries = self.entries();
        let mut rows: Vec<Row> = Vec::new();
        let mut ours = Pictures::new();
        for entry in &entries {
            let picture = self.picture(entry)?;
            let shown = Compared::new(entry, &picture, &ours)?.shown;
            if entry.renderer == OURS {
                ours.insert(entry.scene.name(), picture);
            }
            let counted = |frames| self.counted(entry, frames);
            let instructions = if self.valgrind {
                Some((counted(3)? - counted(1)?) / 2.0)
            } else {
                None
            };
            rows.push(Row {
                scene: entry.scene.name(),
                renderer: entry.renderer,
                instructions,
                pixels: shown,
                wall_ms: f64::INFINITY,
                ratio: 0.0,
                instructions_ratio: None,
                boards: Vec::new(),
            });
        }
        for _ in 0..TURNS {
            for (entry, row) in entries.iter().zip(&mut rows) {
                let said = self.run(entry, &[&FRAMES.to_string()])?;
                row.wall_ms = row.wall_ms.min(said.trim().parse()?);
            }
        }
        let of_ours: Vec<Row> = rows
            .iter()
            .filter(|row| row.renderer == OURS)
            .cloned()
            .collect();
        for row in &mut rows {
            if let Some(ours) = of_ours.iter().find(|ours| ours.scene == row.scene) {
                row.ratio = row.wall_ms / ours.wall_ms;
                row.instructions_ratio =
                    row.instructions.zip(ours.instructions).map(|(a, b)| a / b);
            }
        }
        if self.peers {
            let boards = boards::measure(&entries, &ours, self.folder.path())?;
            for (row, boards) in rows.iter_mut().zip(boards) {
                row.boards = boards;
            }
        }
        Ok(rows)
    }

    /// The picture in RGB565.
    fn picture(&self, entry: &Entry) -> Result<Vec<u16>, Box<dyn Error>> {
        let file = "picture";
        self.run(entry, &["0", file])?;
        Ok(pixels(&std::fs::read(self.folder.path().join(file))?))
    }

    /// Instructions of a run of so many frames.
    fn counted(&self, entry: &Entry, frames: u32) -> Result<f64, Box<dyn Error>> {
        let output = Command::new("valgrind")
            .current_dir(&self.folder)
            .args(["--tool=callgrind", "--callgrind-out-file=callgrind.out"])
            .arg(program(entry.package))
            .args(&entry.words)
            .arg(frames.to_string())
            .output()?;
        let said = String::from_utf8_lossy(&output.stderr);
        collected(&said).ok_or_else(|| format!("valgrind counted nothing: {said}").into())
    }

    /// Runs a program and gives what it prints.
    fn run(&self, entry: &Entry, words: &[&str]) -> Result<String, Box<dyn Error>> {
        let output = Command::new(program(entry.package))
            .current_dir(&self.folder)
            .args(&entry.words)
            .args(words)
            .output()?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{} on {}: {said}", entry.renderer, entry.scene.name()).into());
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }
}

/// What callgrind says it has collected.
pub fn collected(said: &str) -> Option<f64> {
    let line = said.lines().find(|line| line.contains("Collected :"))?;
    line.rsplit(':').next()?.trim().parse().ok()
}

/// A picture as programs write it.
pub fn pixels(bytes: &[u8]) -> Vec<u16> {
    let pixels = bytes.chunks_exact(2);
    pixels.map(|b| u16::from_le_bytes([b[0], b[1]])).collect()
}

/// Our pictures, by the scene's name.
pub type Pictures = BTreeMap<&'static str, Vec<u16>>;

/// A picture beside ours.
#[derive(Debug, PartialEq)]
pub struct Compared {
    /// Pixels that show the scene.
    pub shown: usize,
    /// Pixels that show it in one of the two alone.
    pub other: usize,
    /// Mean difference of a channel where both show it, 8-bit levels.
    pub levels: f64,
}

impl Compared {
    /// Refuses what is another picture than ours; what is ours has none to be held against.
    pub fn new(entry: &Entry, picture: &[u16], ours: &Pictures) -> Result<Self, String> {
        let ours = ours.get(entry.scene.name()).map_or(picture, Vec::as_slice);
        let compared = Self::beside(picture, ours, scene::background(entry.scene));
        if compared.is_the_same() {
            return Ok(compared);
        }
        let (renderer, scene) = (entry.renderer, entry.scene.name());
        Err(format!(
            "{renderer} draws something else on {scene}: {compared:?}"
        ))
    }

    fn beside(picture: &[u16], ours: &[u16], background: u16) -> Self {
        let pairs = || picture.iter().copied().zip(ours.iter().copied());
        let seen = |pixel: u16| pixel != background;
        let both: Vec<u32> = pairs()
            .filter(|&(a, b)| seen(a) && seen(b))
            .map(|(a, b)| distance(a, b))
            .collect();
        let apart: u32 = both.iter().sum();
        let missing = picture
            .len()
            .abs_diff(usize::from(WIDTH) * usize::from(HEIGHT));
        Self {
            shown: picture.iter().filter(|pixel| seen(**pixel)).count(),
            other: pairs().filter(|&(a, b)| seen(a) != seen(b)).count() + missing,
            levels: f64::from(apart) / (3 * both.len().max(1)) as f64,
        }
    }

    fn is_the_same(&self) -> bool {
        self.shown > 0 && self.other * OTHER_PIXELS <= self.shown && self.levels <= OTHER_LEVELS
    }
}

/// How far two pixels are apart, summed over the channels, in 8-bit levels.
fn distance(a: u16, b: u16) -> u32 {
    use scanbeam::pixel::{PixelFormat, Rgb565};
    let (a, b) = (Rgb565::to_rgb8(a), Rgb565::to_rgb8(b));
    (0..3).map(|i| u32::from(a[i].abs_diff(b[i]))).sum()
}

/// Where the packages of `host-tests/bench` are built.
fn target() -> PathBuf {
    usual_target().join("bench")
}

/// Where a package is.
fn package(name: &str) -> PathBuf {
    workspace().join("host-tests/bench").join(name)
}

/// A package's program for this machine.
fn program(name: &str) -> PathBuf {
    target().join("release").join(name)
}

/// Builds a package for this machine.
fn build(name: &str) -> Result<(), Box<dyn Error>> {
    let output = clean_command("cargo")
        .current_dir(package(name))
        .args(["build", "--release", "--locked", "--target-dir"])
        .arg(target())
        .output()
        .map_err(|error| format!("cargo: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("host-tests/bench/{name} does not build:\n{said}").into());
    }
    Ok(())
}
