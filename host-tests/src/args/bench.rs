//! Flags of what measures speed.

use super::is_scene;
use crate::draw::MOST_SLOTS;
use crate::firmware::{BOARDS, Board};
use clap::Args;
use std::path::{Path, PathBuf};

/// Flags of `firmware`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Args)]
pub struct FirmwareArgs {
    /// Instead of the test scenes: a scene file, .json, or a list that `bake` has made, .list
    #[arg(value_name = "SCENE.json", conflicts_with_all = [
        "bench", "bless", "sizes", "markdown", "symbols", "paced", "profile", "function", "output",
    ])]
    pub scene: Option<PathBuf>,
    /// Print the figures as JSON
    #[arg(long)]
    pub json: bool,
    /// Also measure kernels, lines, single things and growth, and fail where one costs more than recorded
    #[arg(long)]
    pub bench: bool,
    /// Record what is measured, for every compiler that is complete here, and fail this once
    #[arg(long, requires = "bench")]
    pub bless: bool,
    /// Instead: build programs with one look and with all for each core, draw by them, and print what they take
    #[arg(long, conflicts_with_all = ["bench", "output"])]
    pub sizes: bool,
    /// Write the table of sizes into host-tests/figures/tables.md, between its markers
    #[arg(long, requires = "sizes")]
    pub markdown: bool,
    /// With the sizes also the largest functions of each program
    #[arg(long, requires = "sizes")]
    pub symbols: bool,
    /// Instead: hold the costs of paced lines against what lines take, and print the least that would do
    #[arg(long, conflicts_with_all = ["bench", "sizes", "profile", "output"])]
    pub paced: bool,
    /// Instead: step through one frame, or that of a scene file or a list, and print where its instructions go, by function
    #[arg(long, value_name = "FRAME", conflicts_with_all = ["bench", "sizes", "output"])]
    pub profile: Option<String>,
    /// With a profile also the listing of the functions whose names have this in them, each
    /// instruction with how often it ran
    #[arg(long, value_name = "NAME", requires = "profile")]
    pub function: Option<String>,
    /// The board of a profile, m4 when nothing is said, or the only one that is run; all when nothing is said
    #[arg(long, value_name = "BOARD", conflicts_with_all = ["bless", "sizes"], value_parser = ["m4", "m3", "m0plus"])]
    pub board: Option<String>,
    /// Folder for the plot of growth, made when it is not there
    #[arg(short = 'o', long = "output", value_name = "DIR", requires = "bench")]
    pub output: Option<PathBuf>,
}

impl FirmwareArgs {
    /// What flags alone cannot say.
    pub(super) fn check(&self) -> Result<(), String> {
        check_scene(self.scene.as_deref())
    }

    /// The boards that are run.
    pub fn boards(&self) -> Vec<Board> {
        let is_run = |board: &&Board| self.board.as_ref().is_none_or(|name| board.name == name);
        BOARDS.iter().filter(is_run).copied().collect()
    }
}

/// Flags of `plan`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Args)]
pub struct PlanArgs {
    /// A scene file, .json, or a list that `bake` has made, .list
    #[arg(value_name = "SCENE.json", required_unless_present = "bless")]
    pub file: Option<PathBuf>,
    /// Slots of the object cache, 0 to 224; 64 when nothing is said
    #[arg(long, value_name = "N",
        value_parser = clap::value_parser!(u16).range(..=i64::from(MOST_SLOTS)))]
    pub slots: Option<u16>,
    /// Print the figures as JSON
    #[arg(long)]
    pub json: bool,
    /// Instead: measure the samples in QEMU, and record what works take
    #[arg(long, conflicts_with_all = ["file", "slots", "json"])]
    pub bless: bool,
}

impl PlanArgs {
    /// What flags alone cannot say.
    pub(super) fn check(&self) -> Result<(), String> {
        check_scene(self.file.as_deref())
    }
}

/// Refuses what is neither a scene file nor a list.
fn check_scene(file: Option<&Path>) -> Result<(), String> {
    match file {
        Some(file) if !is_scene(file) && !is_list(file) => {
            let name = file.display();
            Err(format!(
                "{name}: is neither a scene file, .json, nor a list, .list"
            ))
        }
        _ => Ok(()),
    }
}

/// Whether a file is a list.
pub(crate) fn is_list(file: &Path) -> bool {
    file.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("list"))
}

/// Flags of `budgets`.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq, Args)]
pub struct BudgetsArgs {
    /// Count the source alone, and build nothing
    #[arg(long)]
    pub source: bool,
    /// Lower the limits to what is measured
    #[arg(long)]
    pub tighten: bool,
}

/// Flags of `bench`.
#[derive(Debug, Clone, Default, PartialEq, Eq, Args)]
pub struct BenchArgs {
    /// Print the figures as JSON
    #[arg(long)]
    pub json: bool,
    /// Also build and measure other renderers of the registry, here and on Cortex-M in QEMU
    #[arg(long)]
    pub peers: bool,
    /// Write the tables into host-tests/figures/tables.md, between their markers; also that of `firmware --sizes`
    #[arg(long)]
    pub markdown: bool,
}

/// Flags of `boards`.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct BoardsArgs {
    /// Print the figures as JSON
    #[arg(long)]
    pub json: bool,
    /// Also print what each function of a board with a flash cache reads and misses, in the order in which it is
    /// worth its bytes in RAM
    #[arg(long, conflicts_with = "json")]
    pub functions: bool,
    /// Run this board alone
    #[arg(value_name = "BOARD")]
    pub board: Option<String>,
    /// Frames of a run, 2 to 126
    #[arg(long, value_name = "N", default_value_t = 2,
        value_parser = clap::value_parser!(u16).range(2..=126))]
    pub frames: u16,
    /// Cycles that a miss of the RP2040's flash cache costs, in the model of it, up to 1000
    #[arg(long, value_name = "CYCLES", default_value_t = 56,
        value_parser = clap::value_parser!(u16).range(..=1000))]
    pub miss_cycles: u16,
    /// Folder with the built examples, TARGET/release/NAME
    #[arg(long, value_name = "DIR")]
    pub built: Option<PathBuf>,
    /// Folder with the emulators' packages, as .ci/boards installs them
    #[arg(long, value_name = "DIR")]
    pub packages: Option<PathBuf>,
}
