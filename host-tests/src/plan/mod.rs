//! `plan FILE`: what a scene or a list needs of a chip, and what its frames take, before there is any firmware (X10).
//!
//! ```text
//! file -> drawn here, counted ----------> works, bytes, slots -> instructions, frames a second
//! samples -> drawn on boards (`--bless`) -> instructions of one work --^
//! ```
//! No cross compiler and no emulator is needed: what works take is on record. Bytes are exact, but for lists, where they are
//! an upper bound; instructions are within [`BOUND`] where [`Reckoned::is_within`] says so.
//!
//! | file | there |
//! |---|---|
//! | `shapes.rs`, `samples.rs`, `lists.rs` | the scenes and lists that costs are measured on |
//! | `model.rs` | works of a frame, and what one of each takes |
//! | `record.rs` | the record of it, and how it is written |
//! | `scope.rs` | which scenes have their instructions reckoned |
//! | `program.rs` | the program that draws them |
//! | `chips.rs` | clocks and buses |
//! | `report.rs` | all of it as a table and as JSON |

pub mod chips;
pub mod lists;
pub mod model;
pub mod program;
pub mod record;
mod report;
pub mod samples;
pub mod scope;
pub mod shapes;

use crate::args::{PlanArgs, is_list};
use crate::draw::MOST_SLOTS;
use crate::firmware::BOARDS;
use crate::flashed::tally::Tally;
use crate::flashed::{Flashed, memory};
use crate::lists::heard;
use crate::scene_file::Loaded;
use model::{Parts, reckon, works};
use program::Program;
use record::{OfBoard, Record, SLOTS};
use scanbeam::look::Look;
use scene_flash::Kind;
use scenes::{IndexedLook, PhongLook, SmoothLook, TexturedLook, TexturedPhongLook};
use std::error::Error;
use std::path::Path;

/// How far reckoned instructions are off of measured ones at most, as a part of these.
pub const BOUND: f64 = 0.10;
/// Which part of the spans may be drawn without a slot where there are slots enough.
pub const FEW: f64 = 0.02;
/// Numbers of slots that are tried.
const STEPS: [u16; 11] = [8, 16, 24, 32, 48, 64, 96, 128, 160, 192, MOST_SLOTS];

/// A number of slots, and what a frame does with so many.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Row {
    /// Slots.
    pub slots: u16,
    /// Bytes of the object cache.
    pub cache_bytes: usize,
    /// Slots in use at a time.
    pub peak: u32,
    /// Spans.
    pub spans: u32,
    /// Those that are drawn without a slot.
    pub without: u32,
}

/// Reckoned instructions of a frame.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct Reckoned {
    /// How many.
    pub instructions: f64,
    /// Whether they are within [`BOUND`] of what is measured: not where its [parts](model::Parts) that are less
    /// certain are large, nor where slots are not those of the samples or textures larger than theirs.
    pub is_within: bool,
}

/// What a scene needs on a core.
#[derive(Debug, Clone, PartialEq)]
pub struct OnBoard {
    /// The core, as its board is called.
    pub name: &'static str,
    /// Bytes of code.
    pub code: Option<u64>,
    /// Bytes of slow memory: vertices, triangles with their links, draw calls, a number for each line, and what lists and
    /// shadows need.
    pub slow_bytes: usize,
    /// Instructions of a frame, sent a line a transfer; `None` where the scene is beyond what is reckoned.
    pub reckoned: Option<Reckoned>,
}

/// What a scene needs.
pub struct Plan {
    /// The scene, drawn here.
    pub flashed: Flashed,
    /// What it has that is not reckoned.
    pub beyond: Option<&'static str>,
    /// The program that draws it.
    pub program: Option<Program>,
    /// The compiler of what is on record.
    pub release: String,
    /// The number of slots that bytes and instructions are of.
    pub slots: u16,
    /// By numbers of slots.
    pub rows: Vec<Row>,
    /// Bytes of fast memory: the object cache, the depth of a line, and what few scenes have.
    pub fast_bytes: usize,
    /// On each core.
    pub boards: Vec<OnBoard>,
}

/// Plans and prints, or writes the record anew.
///
/// # Errors
/// When the file cannot be read or drawn, or is too large for the boards; when there is no record; with `--bless` when
/// the firmware cannot be built or run.
pub fn run(args: &PlanArgs) -> Result<(), Box<dyn Error>> {
    let Some(file) = &args.file else {
        record::bless()?;
        tell!(
            "{} is new: look at what changed in it",
            Record::path().display()
        );
        return Ok(());
    };
    let plan = Plan::of(
        file,
        args.slots.unwrap_or(SLOTS),
        &Record::read(&Record::path())?,
    )?;
    report::print(file, &plan, args.json)?;
    heard::tell_all(file.display(), &plan.flashed.shown.heard);
    for note in &plan.flashed.notes {
        tell!("note: {note}");
    }
    Ok(())
}

impl Plan {
    /// What a file needs with so many slots, by what is on record.
    ///
    /// # Errors
    /// As [`run`].
    pub fn of(file: &Path, slots: u16, record: &Record) -> Result<Self, Box<dyn Error>> {
        let (flashed, beyond, is_usual) = match is_list(file) {
            true => {
                let flashed = Flashed::load(file)?;
                let beyond = flashed.shown.listed.and_then(|listed| listed.beyond);
                (flashed, beyond, true)
            }
            false => {
                let loaded = Loaded::load(file)?;
                (
                    Flashed::of_scene(file, &loaded)?,
                    scope::beyond(&loaded.scene),
                    scope::has_usual_textures(&loaded),
                )
            }
        };
        let (release, known) = record.latest().ok_or("no costs are on record")?;
        let is_step = STEPS.contains(&slots);
        let asked: Vec<u16> = (STEPS.into_iter())
            .chain((!is_step).then_some(slots))
            .collect();
        let tallies = record::tally(&flashed, &asked)?;
        let tally = tallies.iter().find(|tally| tally.slots == slots);
        let tally = tally.ok_or("nothing was counted")?;
        let kind = flashed.shown.head.kind;
        let program = program::program(kind, beyond.is_none())?;
        let mut boards = Vec::new();
        for (at, board) in BOARDS.iter().enumerate() {
            let of = known.get(board.name);
            let of = of.ok_or_else(|| format!("no costs of {} are on record", board.name))?;
            boards.push(OnBoard {
                name: board.name,
                code: program.as_ref().map(|program| program.code[at]),
                slow_bytes: flashed.slow_bytes(of.draw_bytes),
                reckoned: beyond.is_none().then(|| reckoned(of, tally, is_usual)),
            });
        }
        let row = |tally: &Tally| row(kind, tally);
        Ok(Self {
            rows: tallies[..STEPS.len()].iter().map(row).collect(),
            fast_bytes: flashed.rest_of_fast_bytes()? + CacheSizes::of_kind(kind).bytes(slots),
            beyond,
            program,
            release: release.to_owned(),
            slots,
            boards,
            flashed,
        })
    }

    /// The smallest number of slots that was tried with which no more than [`FEW`] of the spans are drawn without one.
    #[must_use]
    pub fn enough(&self) -> Option<&Row> {
        let few = |row: &&Row| f64::from(row.without) <= FEW * f64::from(row.spans);
        self.rows.iter().find(few)
    }
}

/// Instructions of a frame on a board, with textures as the samples have them or with larger ones.
fn reckoned(of: &OfBoard, tally: &Tally, is_usual: bool) -> Reckoned {
    let works = works(tally);
    let are_small = Parts::of(&of.costs, &works).are_small();
    Reckoned {
        instructions: reckon(&of.costs, &works),
        is_within: are_small && is_usual && tally.slots == SLOTS,
    }
}

fn row(kind: Kind, tally: &Tally) -> Row {
    Row {
        slots: tally.slots,
        cache_bytes: CacheSizes::of_kind(kind).bytes(tally.slots),
        peak: tally.peak,
        spans: tally.lines.iter().map(|line| line.spans.spans).sum(),
        without: tally.lines.iter().map(|line| line.cache.misses).sum(),
    }
}

/// Sizes of the object cache of a look.
#[derive(Debug, Clone, Copy)]
pub struct CacheSizes {
    of: fn(u16) -> usize,
}

impl CacheSizes {
    fn of<L: Look>() -> Self {
        Self {
            of: memory::cache_bytes::<L>,
        }
    }

    /// Those of the look that draws a kind of scenes.
    #[must_use]
    pub fn of_kind(kind: Kind) -> Self {
        match kind {
            Kind::Smooth | Kind::ListSmooth => Self::of::<SmoothLook>(),
            Kind::Textured | Kind::ListTextured => Self::of::<TexturedLook>(),
            Kind::Indexed => Self::of::<IndexedLook>(),
            Kind::Phong => Self::of::<PhongLook>(),
            Kind::TexturedPhong => Self::of::<TexturedPhongLook>(),
        }
    }

    /// Bytes of a cache of so many slots, with what it keeps beside them.
    #[must_use]
    pub fn bytes(&self, slots: u16) -> usize {
        (self.of)(slots)
    }
}
