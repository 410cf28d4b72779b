//! The command line, checked whole before anything is read or written.
//!
//! [`parse`] gives a [`Command`] whose values hold together (the view has been through
//! [`View::check`](crate::reference::View::check)), or a
//! [`Stop`]: text to print and the exit code. Refusals are one line.

mod bench;
mod picture;
mod render;
mod view;

pub use crate::choice::{DEFAULT_SLOTS, DepthArg, InterpArg, MAX_SIDE, PixelFormatArg};
pub(crate) use bench::is_list;
pub use bench::{BenchArgs, BoardsArgs, BudgetsArgs, FirmwareArgs, PlanArgs};
pub use picture::{PictureArgs, ShadeArg, Size};
pub use render::{Method, QualityArg, RenderArgs, SwitchArg};
pub use view::ViewArgs;

use crate::lists::args::{BakeArgs, DisassembleArgs, RunListArgs};
use clap::error::ErrorKind;
use clap::parser::ValueSource;
use clap::{ArgMatches, Args, CommandFactory, FromArgMatches, Parser, Subcommand, ValueEnum};
use host_support::apart::apart;
use std::ffi::OsString;
use std::path::{Path, PathBuf};

/// Most frames of a demo, inclusive.
pub const MAX_DEMO_FRAMES: u32 = 1000;
/// Most slots of an object cache, inclusive.
pub const MAX_SLOTS: u16 = 4095;
/// Most line renderers, inclusive.
pub const MAX_RENDERERS: u16 = 16;
/// Frames of a demo when nothing else is asked.
pub const DEFAULT_DEMO_FRAMES: u32 = 24;
/// Exit code for bad input of any kind.
pub const EXIT_BAD_INPUT: u8 = 2;

#[derive(Debug, Parser)]
#[command(
    name = "scanbeam",
    version,
    about = "Draws 3D models scanline by scanline, in fixed point"
)]
struct Cli {
    #[command(subcommand)]
    command: Option<Command>,
}

/// What `render` can hold, for its help.
const RENDER_LIMITS: &str = "Limits: coordinates below 2^90; on one line of the picture 61,440 \
    triangles and 65,536 vertices, which some 15,000 triangles fill where all of them cross the \
    near plane. What finds no room is left out, and stderr tells it.";

/// What is to be done.
#[derive(Debug, Clone, PartialEq, Subcommand)]
pub enum Command {
    /// Draw an OBJ model, or a scene file, to a picture
    #[command(after_help = RENDER_LIMITS)]
    Render(RenderArgs),
    /// Show an OBJ model, or a scene file, that turns, live in the terminal
    View(ViewArgs),
    /// Draw the Utah teapot: frames, a strip, an animated picture (the default)
    Demo(DemoArgs),
    /// Print the tokens that the hardware model makes of one line
    Trace(TraceArgs),
    /// Model what the object cache saves: slow bytes and frame time against slots
    Cache(CacheArgs),
    /// Measure every method's error and cost against the f64 reference
    Accuracy(AccuracyArgs),
    /// Tell what memory, slots and instructions a scene file needs, before there is any firmware
    Plan(PlanArgs),
    /// Run the Cortex-M firmware in QEMU and compare its frames, or those of a scene file, with the host's
    Firmware(FirmwareArgs),
    /// Run the examples for boards in emulators, and judge what arrives at the panel
    Boards(BoardsArgs),
    /// Hold sizes of code and counts of the source against their limits
    Budgets(BudgetsArgs),
    /// Count and time frames on this machine, beside other renderers
    Bench(BenchArgs),
    /// Make a page with pictures, their errors and what they cost
    Report(ReportArgs),
    /// Make a list of a model: strips of quantised vertices for flash
    Bake(BakeArgs),
    /// Compress a picture for a texture of 4 bits a texel
    Compress(CompressArgs),
    /// Execute a list and draw it to a picture
    RunList(RunListArgs),
    /// Print a list, block by block
    Disassemble(DisassembleArgs),
}

/// Flags of `trace`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct TraceArgs {
    /// Model to draw
    #[arg(value_name = "MODEL.obj")]
    pub model: PathBuf,
    /// Line of the picture, 0 at the top
    #[arg(long, value_name = "N", allow_hyphen_values = true)]
    pub line: u16,
    /// What to draw.
    #[command(flatten)]
    pub picture: PictureArgs,
}

impl TraceArgs {
    fn check(&self) -> Result<(), String> {
        self.picture
            .view()
            .check()
            .map_err(|error| error.to_string())?;
        if self.picture.shade == ShadeArg::Phong {
            return Err("the hardware model has no --shade phong".into());
        }
        if self.picture.format != PixelFormatArg::Rgb888 {
            return Err("trace has no --format but rgb888: tokens come before pixels".into());
        }
        let height = self.picture.size.height;
        if u32::from(self.line) >= height {
            return Err(format!(
                "--line must be below the height, which is {height}"
            ));
        }
        Ok(())
    }
}

/// Flags of `demo`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct DemoArgs {
    /// Folder for the pictures, made when it is not there
    #[arg(
        short = 'o',
        long = "output",
        value_name = "DIR",
        default_value = "out"
    )]
    pub output: PathBuf,
    /// Frames of the animated picture, 1 to 1000
    #[arg(long, value_name = "N", default_value_t = DEFAULT_DEMO_FRAMES,
        value_parser = clap::value_parser!(u32).range(1..=i64::from(MAX_DEMO_FRAMES)))]
    pub frames: u32,
    /// What of each frame after the first is sent to the display
    #[arg(long, value_name = "PARTS", value_enum, default_value_t)]
    pub changed: ChangedArg,
}

impl Default for DemoArgs {
    fn default() -> Self {
        Self {
            output: PathBuf::from("out"),
            frames: DEFAULT_DEMO_FRAMES,
            changed: ChangedArg::default(),
        }
    }
}

/// What is sent of a frame after another.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum ChangedArg {
    /// All of it
    All,
    /// Lines that change
    #[default]
    Lines,
    /// Runs of cells of 16 columns and 8 lines that change
    Runs,
}

/// Flags of `cache`.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct CacheArgs {
    /// Print the figures as JSON
    #[arg(long)]
    pub json: bool,
    /// Folder for the plots, made when it is not there; none: no plots
    #[arg(short = 'o', long = "output", value_name = "DIR")]
    pub output: Option<PathBuf>,
}

/// Flags of `accuracy`: those of `cache`.
pub type AccuracyArgs = CacheArgs;

/// Flags of `compress`.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct CompressArgs {
    /// Picture to compress, .png, .jpg or .ppm; its sides become powers of two
    #[arg(value_name = "PICTURE")]
    pub picture: PathBuf,
    /// Blocks to write, 8 bytes each, rows from the top
    #[arg(short = 'o', long = "output", value_name = "OUT.bc1")]
    pub output: PathBuf,
}

impl CompressArgs {
    fn check(&self) -> Result<(), String> {
        apart(&[("-o", &self.output)], [self.picture.as_path()])
    }
}

/// Flags of `report`.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct ReportArgs {
    /// Folder for the page, made when it is not there
    #[arg(
        short = 'o',
        long = "output",
        value_name = "DIR",
        default_value = "report"
    )]
    pub output: PathBuf,
    /// Draw with other renderers too, which are fetched and built for it
    #[arg(long)]
    pub peers: bool,
}

/// Why no command is to be run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stop {
    /// Help or version was asked for: print it on stdout, exit with 0.
    Text(String),
    /// Bad input: print this one line on stderr, exit with [`EXIT_BAD_INPUT`].
    Refused(String),
}

/// All flags, as they are defined.
#[must_use]
pub fn definitions() -> clap::Command {
    Cli::command()
}

/// Reads the command line; `words` starts with the program's name, as `std::env::args_os` does. No command is `demo`.
///
/// # Errors
/// [`Stop::Refused`] for anything unknown, malformed, out of range or contradictory; [`Stop::Text`] for help.
pub fn parse<I>(words: I) -> Result<Command, Stop>
where
    I: IntoIterator,
    I::Item: Into<OsString> + Clone,
{
    let stop = |error: clap::Error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Stop::Text(error.to_string()),
        _ => Stop::Refused(one_line(&error.to_string())),
    };
    let matches = definitions().try_get_matches_from(words).map_err(stop)?;
    let cli = Cli::from_arg_matches(&matches).map_err(stop)?;
    let command = cli.command.unwrap_or(Command::Demo(DemoArgs::default()));
    let checked = match &command {
        Command::Render(args) if is_scene(&args.model) => beside_scene(&matches, &OF_RENDER),
        Command::View(args) if args.model.as_deref().is_some_and(is_scene) => {
            beside_scene(&matches, &OF_VIEW)
        }
        _ => Ok(()),
    };
    let checked = checked.and_then(|()| match &command {
        Command::Render(render) => render.check(),
        Command::View(view) => view.check(),
        Command::Trace(trace) => trace.check(),
        Command::Bake(bake) => bake.check(),
        Command::Compress(compress) => compress.check(),
        Command::RunList(list) => list.check(),
        Command::Firmware(firmware) => firmware.check(),
        Command::Plan(plan) => plan.check(),
        Command::Demo(_)
        | Command::Cache(_)
        | Command::Accuracy(_)
        | Command::Boards(_)
        | Command::Budgets(_)
        | Command::Bench(_)
        | Command::Report(_)
        | Command::Disassemble(_) => Ok(()),
    });
    checked.map_err(|reason| Stop::Refused(format!("error: {}", plain(&reason))))?;
    Ok(command)
}

/// Flags that `render` has beside a scene file.
const OF_RENDER: [&str; 7] = [
    "model",
    "output",
    "quality",
    "cache",
    "renderers",
    "prefetch",
    "stats",
];
/// Flags that `view` has beside one.
const OF_VIEW: [&str; 8] = [
    "model",
    "frames",
    "size",
    "colours",
    "quality",
    "cache",
    "renderers",
    "window",
];

/// Whether a file is a scene, not a model.
#[must_use]
pub fn is_scene(file: &Path) -> bool {
    file.extension()
        .is_some_and(|extension| extension.eq_ignore_ascii_case("json"))
}

/// Refuses flags that say what the scene file says.
fn beside_scene(matches: &ArgMatches, allowed: &[&str]) -> Result<(), String> {
    let Some((name, given)) = matches.subcommand() else {
        return Ok(());
    };
    let all = definitions();
    let flags = all.find_subcommand(name).into_iter();
    let mut flags = flags.flat_map(|command| command.get_arguments());
    let is_said = |id: &str| given.value_source(id) == Some(ValueSource::CommandLine);
    match flags
        .find(|flag| !allowed.contains(&flag.get_id().as_str()) && is_said(flag.get_id().as_str()))
    {
        Some(flag) => {
            let flag = flag.get_long().unwrap_or_default();
            Err(format!(
                "--{flag} goes with a model: a scene file says it all"
            ))
        }
        None => Ok(()),
    }
}

/// The first paragraph of clap's message (then come usage and tips) as one line.
fn one_line(message: &str) -> String {
    let lines = message.lines().take_while(|line| !line.trim().is_empty());
    plain(&lines.map(str::trim).collect::<Vec<_>>().join(" "))
}

/// Without control characters, which may come from outside.
fn plain(text: &str) -> String {
    let clean = |c: char| if c.is_control() { '?' } else { c };
    text.chars().map(clean).collect()
}
