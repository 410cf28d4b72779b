//! `bench`: frames on this machine, by counted instructions and by the clock, beside other renderers.
//!
//! | file | there |
//! |---|---|
//! | `scene.rs` | the scenes as numbers, for renderers that take any mesh |
//! | `table.rs` | the tables of the README |
//!
//! The programs that are measured are crates of their own, `host-tests/bench/ours` and
//! `host-tests/bench/peers`, built here with the profile of the firmware. Instructions are those
//! that callgrind counts for three frames less those for one, halved; without valgrind there are
//! none, and that is said. The clock is read in turns, and the fastest frame of each counts, since
//! whatever else the machine does only adds to it. Before anything is measured, pictures are compared: a renderer that does not draw
//! the same scene is refused.

mod scene;
mod table;

use crate::args::BenchArgs;
use crate::firmware::{clean_command, usual_target, workspace};
use scenes::{HEIGHT, Shot, WIDTH};
use serde_json::{Value, json};
use std::error::Error;
use std::path::{Path, PathBuf};
use std::process::{Command, Stdio};
use tempfile::TempDir;

/// The name of ours.
pub const OURS: &str = "scanbeam";
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
}

impl Row {
    fn per_pixel(&self) -> Option<f64> {
        self.instructions.map(|i| i / self.pixels.max(1) as f64)
    }

    fn to_json(&self) -> Value {
        json!({
            "scene": self.scene,
            "renderer": self.renderer,
            "instructions_per_frame": self.instructions,
            "instructions_per_shaded_pixel": self.per_pixel(),
            "pixels": self.pixels,
            "wall_ms": self.wall_ms,
            "ratio_to_us": self.ratio,
            "instructions_ratio_to_us": self.instructions_ratio,
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
        println!("{}", serde_json::to_string_pretty(&Value::from(list))?);
    } else {
        print!("{}", table::text(&rows));
    }
    if !bench.valgrind {
        eprintln!("note: no instructions were counted: valgrind is not installed");
    }
    if args.markdown {
        table::write(&workspace().join("README.md"), &rows)?;
    }
    Ok(())
}

/// The programs, and what they are handed.
struct Bench {
    ours: PathBuf,
    peers: Option<PathBuf>,
    /// Scenes and pictures.
    folder: TempDir,
    valgrind: bool,
}

/// A renderer on a scene, and how to run it: all words but the number of frames and the picture.
struct Entry<'b> {
    scene: Shot,
    renderer: &'static str,
    program: &'b Path,
    words: Vec<String>,
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
        Ok(Self {
            ours: build("ours")?,
            peers: if peers { Some(build("peers")?) } else { None },
            folder,
            valgrind: valgrind.is_ok_and(|status| status.success()),
        })
    }

    /// Everything that is to be measured, ours first on each scene.
    fn entries(&self) -> Vec<Entry<'_>> {
        let mut entries = Vec::new();
        for scene in scene::SHARED.into_iter().chain(ALONE) {
            entries.push(Entry {
                scene,
                renderer: OURS,
                program: &self.ours,
                words: vec![scene.name().to_owned()],
            });
            let Some(program) = self.peers.as_deref() else {
                continue;
            };
            if !scene::SHARED.contains(&scene) {
                continue;
            }
            for (renderer, word) in PEERS {
                let file = self.folder.path().join(format!("{}.json", scene.name()));
                entries.push(Entry {
                    scene,
                    renderer,
                    program,
                    words: vec![word.to_owned(), file.display().to_string()],
                });
            }
        }
        entries
    }

    fn rows(&self) -> Result<Vec<Row>, Box<dyn Error>> {
        let entries = self.entries();
        let mut rows: Vec<Row> = Vec::new();
        let mut ours: Vec<u16> = Vec::new();
        for entry in &entries {
            let picture = self.picture(entry)?;
            if entry.renderer == OURS {
                ours.clone_from(&picture);
            }
            let background = scene::background(entry.scene);
            let compared = Compared::new(&picture, &ours, background);
            compared.check(entry)?;
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
                pixels: compared.shown,
                wall_ms: f64::INFINITY,
                ratio: 0.0,
                instructions_ratio: None,
            });
        }
        for _ in 0..TURNS {
            for (entry, row) in entries.iter().zip(&mut rows) {
                let said = entry.run(&[&FRAMES.to_string()])?;
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
        Ok(rows)
    }

    /// The picture in RGB565.
    fn picture(&self, entry: &Entry<'_>) -> Result<Vec<u16>, Box<dyn Error>> {
        let file = self.folder.path().join("picture");
        entry.run(&["0", &file.display().to_string()])?;
        let bytes = std::fs::read(&file)?;
        Ok(bytes
            .chunks_exact(2)
            .map(|b| u16::from_le_bytes([b[0], b[1]]))
            .collect())
    }

    /// Instructions of a run of so many frames.
    fn counted(&self, entry: &Entry<'_>, frames: u32) -> Result<f64, Box<dyn Error>> {
        let out = self.folder.path().join("callgrind.out");
        let output = Command::new("valgrind")
            .arg("--tool=callgrind")
            .arg(format!("--callgrind-out-file={}", out.display()))
            .arg(entry.program)
            .args(&entry.words)
            .arg(frames.to_string())
            .output()?;
        let said = String::from_utf8_lossy(&output.stderr);
        collected(&said).ok_or_else(|| format!("valgrind counted nothing: {said}").into())
    }
}

/// What callgrind says it has collected.
fn collected(said: &str) -> Option<f64> {
    let line = said.lines().find(|line| line.contains("Collected :"))?;
    line.rsplit(':').next()?.trim().parse().ok()
}

impl Entry<'_> {
    fn run(&self, words: &[&str]) -> Result<String, Box<dyn Error>> {
        let output = Command::new(self.program)
            .args(&self.words)
            .args(words)
            .output()?;
        if !output.status.success() {
            let said = String::from_utf8_lossy(&output.stderr);
            return Err(format!("{} on {}: {said}", self.renderer, self.scene.name()).into());
        }
        Ok(String::from_utf8_lossy(&output.stdout).into_owned())
    }
}

/// A picture beside ours.
#[derive(Debug, PartialEq)]
struct Compared {
    /// Pixels that show the scene.
    shown: usize,
    /// Pixels that show it in one of the two alone.
    other: usize,
    /// Mean difference of a channel where both show it, 8-bit levels.
    levels: f64,
}

impl Compared {
    fn new(picture: &[u16], ours: &[u16], background: u16) -> Self {
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

    /// Refuses what is another picture.
    fn check(&self, entry: &Entry<'_>) -> Result<(), String> {
        if self.shown == 0 || self.other * OTHER_PIXELS > self.shown || self.levels > OTHER_LEVELS {
            return Err(format!(
                "{} draws something else on {}: {self:?}",
                entry.renderer,
                entry.scene.name()
            ));
        }
        Ok(())
    }
}

/// How far two pixels are apart, summed over the channels, in 8-bit levels.
fn distance(a: u16, b: u16) -> u32 {
    use scanbeam::{PixelFormat, Rgb565};
    let (a, b) = (Rgb565::to_rgb8(a), Rgb565::to_rgb8(b));
    (0..3).map(|i| u32::from(a[i].abs_diff(b[i]))).sum()
}

/// Builds a crate of `host-tests/bench` and gives the path of its program.
fn build(name: &str) -> Result<PathBuf, Box<dyn Error>> {
    let directory = usual_target().join("bench");
    let output = clean_command("cargo")
        .current_dir(workspace().join("host-tests/bench").join(name))
        .args(["build", "--release", "--locked", "--target-dir"])
        .arg(&directory)
        .output()
        .map_err(|error| format!("cargo: {error}"))?;
    if !output.status.success() {
        let said = String::from_utf8_lossy(&output.stderr);
        return Err(format!("host-tests/bench/{name} does not build:\n{said}").into());
    }
    Ok(directory.join("release").join(name))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn callgrind_is_understood() {
        let said = "==1== Events    : Ir\n==1== Collected : 123456\n";
        assert_eq!(collected(said), Some(123_456.0));
        assert_eq!(collected("nothing"), None);
    }

    #[test]
    fn another_picture_is_noticed() {
        let size = usize::from(WIDTH) * usize::from(HEIGHT);
        let mut ours = vec![0; size];
        ours[..1000].fill(0x8410);
        let program = PathBuf::new();
        let entry = Entry {
            scene: Shot::Sphere,
            renderer: "x",
            program: &program,
            words: Vec::new(),
        };
        let check = |picture: &[u16]| Compared::new(picture, &ours, 0).check(&entry);
        assert_eq!(check(&ours), Ok(()));
        assert!(check(&ours[..size - 100]).is_err());
        assert!(check(&vec![0; size]).is_err());
        let mut moved = ours.clone();
        moved.rotate_right(30);
        assert!(check(&moved).is_err());
        let mut darker = ours.clone();
        darker[..1000].fill(0x4208);
        assert!(check(&darker).is_err());
    }

    #[test]
    fn shared_scenes_have_numbers() {
        for shot in scene::SHARED {
            let data = serde_json::to_value(scene::Data::new(shot).unwrap()).unwrap();
            let faces = data["faces"].as_array().unwrap().len();
            assert_eq!(faces, if shot == Shot::Sphere { 2048 } else { 32 });
        }
        assert!(scene::Data::new(Shot::Cube).is_none());
    }
}
