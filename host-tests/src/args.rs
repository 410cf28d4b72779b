//! The command line, checked whole before anything is read or written.
//!
//! [`parse`] gives a [`Command`] whose values hold together (the view has been through [`View::check`]), or a
//! [`Stop`]: text to print and the exit code. Refusals are one line.

use crate::image_out::ImageFormat;
use crate::lists::args::{BakeArgs, DisassembleArgs, RunListArgs};
use crate::reference::{Cull, Shade, View};
use clap::error::ErrorKind;
use clap::{Args, Parser, Subcommand, ValueEnum};
use std::ffi::OsString;
use std::path::PathBuf;

/// Longest side of a rendered picture, in pixels, inclusive.
pub const MAX_SIDE: u32 = 8192;
/// Most frames of a demo, inclusive.
pub const MAX_DEMO_FRAMES: u32 = 1000;
/// Slots of the object cache when nothing else is asked.
pub const DEFAULT_SLOTS: u16 = 64;
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

/// What is to be done.
#[derive(Debug, Clone, PartialEq, Subcommand)]
pub enum Command {
    /// Draw an OBJ model to a picture
    Render(RenderArgs),
    /// Draw the Utah teapot: frames, a strip, an animated picture (the default)
    Demo(DemoArgs),
    /// Print the tokens that the hardware model makes of one line
    Trace(TraceArgs),
    /// Model what the object cache saves: slow bytes and frame time against slots
    Cache(CacheArgs),
    /// Measure every method's error and cost against the f64 reference
    Accuracy(AccuracyArgs),
    /// Run the Cortex-M firmware in QEMU and compare its frames with the host's
    Firmware(FirmwareArgs),
    /// Make a list of a model: strips of quantised vertices for flash
    Bake(BakeArgs),
    /// Execute a list and draw it to a picture
    RunList(RunListArgs),
    /// Print a list, block by block
    Disassemble(DisassembleArgs),
}

/// How a pixel is sent to the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PixelFormatArg {
    /// 24 bits
    Rgb888,
    /// 16 bits
    Rgb565,
}

/// How colour and depth are found between the corners of a triangle.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum InterpArg {
    /// The fast path: planes
    Plane,
    /// The hardware model: 12-bit weights down edges, 10-bit weights along spans
    Model,
}

/// Width and height of a picture in pixels, each `1..=`[`MAX_SIDE`].
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Size {
    /// Pixels per row.
    pub width: u32,
    /// Rows.
    pub height: u32,
}

/// What picture is to be drawn: the flags that `render` and `trace` share.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct PictureArgs {
    /// Size of the picture in pixels, 1x1 to 8192x8192
    #[arg(long, value_name = "WxH", default_value = "320x240", value_parser = parse_size, allow_hyphen_values = true)]
    pub size: Size,
    /// Place of the eye
    #[arg(long, value_name = "x,y,z", default_value = "0,0,3", value_parser = parse_vector, allow_hyphen_values = true)]
    pub eye: [f64; 3],
    /// Place that the eye looks at
    #[arg(long, value_name = "x,y,z", default_value = "0,0,0", value_parser = parse_vector, allow_hyphen_values = true)]
    pub at: [f64; 3],
    /// Direction that is up in the picture
    #[arg(long, value_name = "x,y,z", default_value = "0,1,0", value_parser = parse_vector, allow_hyphen_values = true)]
    pub up: [f64; 3],
    /// Vertical field of view in degrees, above 0 and below 180
    #[arg(long, value_name = "DEG", default_value = "60", value_parser = parse_number, allow_hyphen_values = true)]
    pub fov: f64,
    /// Nearest distance along the view direction that is drawn, above 0
    #[arg(long, value_name = "N", default_value = "0.1", value_parser = parse_number, allow_hyphen_values = true)]
    pub near: f64,
    /// Farthest distance along the view direction that is drawn, above near
    #[arg(long, value_name = "F", default_value = "100", value_parser = parse_number, allow_hyphen_values = true)]
    pub far: f64,
    /// Direction to the light, not zero
    #[arg(long, value_name = "x,y,z", default_value = "0,0,1", value_parser = parse_vector, allow_hyphen_values = true)]
    pub light: [f64; 3],
    /// Light that comes from everywhere, 0 to 1
    #[arg(long, value_name = "A", default_value = "0.2", value_parser = parse_number, allow_hyphen_values = true)]
    pub ambient: f64,
    /// How light is applied
    #[arg(long, value_enum, default_value_t = Shade::None)]
    pub shade: Shade,
    /// Which triangles are dropped by the side that they show
    #[arg(long, value_enum, default_value_t = Cull::None)]
    pub cull: Cull,
    /// Pixel format that the display is sent
    #[arg(long, value_enum, default_value_t = PixelFormatArg::Rgb888)]
    pub format: PixelFormatArg,
    /// Colour where nothing is drawn, each 0 to 255
    #[arg(long, value_name = "r,g,b", default_value = "0,0,0", value_parser = parse_colour, allow_hyphen_values = true)]
    pub background: [u8; 3],
}

impl PictureArgs {
    /// The view that the flags describe; already checked when it comes from [`parse`].
    #[must_use]
    pub fn view(&self) -> View {
        View {
            width: self.size.width,
            height: self.size.height,
            eye: self.eye,
            at: self.at,
            up: self.up,
            fov: self.fov,
            near: self.near,
            far: self.far,
            light: self.light,
            ambient: self.ambient,
            shade: self.shade,
            cull: self.cull,
            background: self.background,
        }
    }
}

/// Flags of `render`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct RenderArgs {
    /// Model to draw
    #[arg(value_name = "MODEL.obj")]
    pub model: PathBuf,
    /// Picture to write, .png or .ppm
    #[arg(short = 'o', long = "output", value_name = "OUT")]
    pub output: PathBuf,
    /// What to draw.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// How colour and depth are interpolated
    #[arg(long, value_enum, default_value_t = InterpArg::Plane)]
    pub interp: InterpArg,
    /// Slots of each renderer's object cache, 0 to 4095
    #[arg(long, value_name = "SLOTS", default_value_t = DEFAULT_SLOTS,
        value_parser = clap::value_parser!(u16).range(0..=i64::from(MAX_SLOTS)))]
    pub cache: u16,
    /// Line renderers, each on a thread of its own when there are several, 1 to 16
    #[arg(long, value_name = "N", default_value_t = 1,
        value_parser = clap::value_parser!(u16).range(1..=i64::from(MAX_RENDERERS)))]
    pub renderers: u16,
    /// Bytes a line that each renderer fetches ahead into its cache
    #[arg(long, value_name = "BYTES", default_value_t = 0)]
    pub prefetch: u32,
    /// Also write figures of the frame, as JSON
    #[arg(long, value_name = "OUT.json")]
    pub stats: Option<PathBuf>,
}

impl RenderArgs {
    /// The view that the flags describe; already checked when it comes from [`parse`].
    #[must_use]
    pub fn view(&self) -> View {
        self.picture.view()
    }

    fn check(&self) -> Result<(), String> {
        let crew = (self.cache, self.renderers, self.prefetch);
        if self.interp == InterpArg::Model && crew != (DEFAULT_SLOTS, 1, 0) {
            return Err("--interp model has no --cache, --renderers or --prefetch".into());
        }
        self.view().check().map_err(|error| error.to_string())?;
        ImageFormat::from_path(&self.output).map_err(|error| error.to_string())?;
        if self.output == self.model {
            return Err("-o must not be the model itself".into());
        }
        if self
            .stats
            .as_ref()
            .is_some_and(|stats| *stats == self.output || *stats == self.model)
        {
            return Err("--stats must be a file of its own".into());
        }
        Ok(())
    }
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
}

impl Default for DemoArgs {
    fn default() -> Self {
        Self {
            output: PathBuf::from("out"),
            frames: DEFAULT_DEMO_FRAMES,
        }
    }
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

/// Flags of `firmware`.
#[derive(Debug, Clone, PartialEq, Eq, Args)]
pub struct FirmwareArgs {
    /// Print the figures as JSON
    #[arg(long)]
    pub json: bool,
}

/// Why no command is to be run.
#[derive(Debug, Clone, PartialEq, Eq)]
pub enum Stop {
    /// Help or version was asked for: print it on stdout, exit with 0.
    Text(String),
    /// Bad input: print this one line on stderr, exit with [`EXIT_BAD_INPUT`].
    Refused(String),
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
    let cli = Cli::try_parse_from(words).map_err(|error| match error.kind() {
        ErrorKind::DisplayHelp | ErrorKind::DisplayVersion => Stop::Text(error.to_string()),
        _ => Stop::Refused(one_line(&error.to_string())),
    })?;
    let command = cli.command.unwrap_or(Command::Demo(DemoArgs::default()));
    let checked = match &command {
        Command::Render(render) => render.check(),
        Command::Trace(trace) => trace.check(),
        Command::Bake(bake) => bake.check(),
        Command::RunList(list) => list.check(),
        Command::Disassemble(_) => Ok(()),
        Command::Demo(_) | Command::Cache(_) | Command::Accuracy(_) | Command::Firmware(_) => {
            Ok(())
        }
    };
    checked.map_err(|reason| Stop::Refused(format!("error: {}", plain(&reason))))?;
    Ok(command)
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

fn parse_number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("a finite number is needed".into()),
    }
}

fn parse_vector(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, String> = text.split(',').map(parse_number).collect();
    numbers
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| "three finite numbers x,y,z are needed".into())
}

fn parse_colour(text: &str) -> Result<[u8; 3], String> {
    let levels: Result<Vec<u8>, _> = text
        .split(',')
        .map(|part| part.trim().parse::<u8>())
        .collect();
    levels
        .ok()
        .and_then(|levels| levels.try_into().ok())
        .ok_or_else(|| "three whole numbers r,g,b from 0 to 255 are needed".into())
}

fn parse_size(text: &str) -> Result<Size, String> {
    let side = |part: &str| {
        part.parse::<u32>()
            .ok()
            .filter(|side| (1..=MAX_SIDE).contains(side))
    };
    text.split_once(['x', 'X'])
        .and_then(|(width, height)| {
            Some(Size {
                width: side(width)?,
                height: side(height)?,
            })
        })
        .ok_or_else(|| format!("WIDTHxHEIGHT is needed, each 1 to {MAX_SIDE}"))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn words(line: &str) -> Result<Command, Stop> {
        parse(std::iter::once("scanbeam").chain(line.split_whitespace()))
    }

    fn render(flags: &str) -> RenderArgs {
        match words(&format!("render m.obj -o o.png {flags}")) {
            Ok(Command::Render(render)) => render,
            other => panic!("{flags}: {other:?}"),
        }
    }

    #[test]
    fn the_definitions_hold_together() {
        use clap::CommandFactory;
        Cli::command().debug_assert();
    }

    #[test]
    fn defaults_are_those_of_the_design() {
        let args = render("");
        assert_eq!(args.view(), View::default());
        assert_eq!(args.picture.format, PixelFormatArg::Rgb888);
        assert_eq!(args.interp, InterpArg::Plane);
        assert_eq!(args.stats, None);
        assert_eq!(words(""), Ok(Command::Demo(DemoArgs::default())));
        assert_eq!(words("demo"), words(""));
        assert_eq!((args.cache, args.renderers, args.prefetch), (64, 1, 0));
        let plain = CacheArgs {
            json: false,
            output: None,
        };
        assert_eq!(words("cache"), Ok(Command::Cache(plain)));
        assert_eq!(
            words("firmware"),
            Ok(Command::Firmware(FirmwareArgs { json: false }))
        );
        assert_eq!(
            words("firmware --json"),
            Ok(Command::Firmware(FirmwareArgs { json: true }))
        );
    }

    #[test]
    fn every_flag_arrives() {
        let view = render(
            "--size 17x8192 --eye -1,0,3 --at=-2,-3.5,1e-2 --up 0,0,-1 --fov 179.9 --near 1 --far 2.5 --light -1,-1,-1 \
             --ambient 1 --shade gouraud --cull back --background 255,0,7 --format rgb565 --interp plane --stats s.json \
             --cache 0 --renderers 16 --prefetch 99",
        );
        assert_eq!((view.cache, view.renderers, view.prefetch), (0, 16, 99));
        assert_eq!(view.stats, Some(PathBuf::from("s.json")));
        assert_eq!(view.picture.format, PixelFormatArg::Rgb565);
        assert_eq!(view.interp, InterpArg::Plane);
        let expected = View {
            width: 17,
            height: 8192,
            eye: [-1.0, 0.0, 3.0],
            at: [-2.0, -3.5, 0.01],
            up: [0.0, 0.0, -1.0],
            fov: 179.9,
            near: 1.0,
            far: 2.5,
            light: [-1.0; 3],
            ambient: 1.0,
            shade: Shade::Gouraud,
            cull: Cull::Back,
            background: [255, 0, 7],
        };
        assert_eq!(view.view(), expected);
        match words("trace m.obj --line 8191 --size 17x8192 --shade flat") {
            Ok(Command::Trace(trace)) => {
                assert_eq!((trace.line, trace.model), (8191, PathBuf::from("m.obj")));
                assert_eq!(trace.picture.shade, Shade::Flat);
            }
            other => panic!("{other:?}"),
        }
        let demo = DemoArgs {
            output: "d".into(),
            frames: 3,
        };
        assert_eq!(words("demo -o d --frames 3"), Ok(Command::Demo(demo)));
        assert_eq!(render("--interp model").interp, InterpArg::Model);
        assert!(words("render m.obj -o o.png --interp model --cache 3").is_err());
    }

    #[test]
    fn bad_lines_are_refused_in_one_line() {
        for flags in [
            "--size 0x10",
            "--size 10x0",
            "--size 8193x1",
            "--size 1x8193",
            "--size 10",
            "--size -1x5",
            "--size ax5",
            "--size 99999999999x1",
            "--size 1x2x3",
            "--eye 1,2",
            "--eye 1,2,3,4",
            "--eye nan,0,0",
            "--eye inf,0,0",
            "--eye 1e999,0,0",
            "--eye 1e300,0,0",
            "--eye",
            "--eye --at 0,0,0",
            "--eye 0,0,0",
            "--at 0,0,3",
            "--up 0,0,0",
            "--up 0,0,-2",
            "--up nan,0,0",
            "--fov 0",
            "--fov 180",
            "--fov -10",
            "--fov nan",
            "--near 0",
            "--near -1",
            "--near 100",
            "--far 0.1",
            "--far inf",
            "--far 0.05",
            "--light 0,0,0",
            "--light 1,1",
            "--ambient -0.1",
            "--ambient 1.1",
            "--ambient x",
            "--shade phong",
            "--shade",
            "--cull front",
            "--format rgb666",
            "--interp fast",
            "--background 256,0,0",
            "--background -1,0,0",
            "--background 1,2",
            "--background 1.5,0,0",
            "--cache -1",
            "--cache 4096",
            "--renderers 0",
            "--renderers 17",
            "--prefetch -1",
            "--unknown",
            "--unknown 3",
            "--texture a.png",
            "--size 1x1 --size 2x2",
            "extra",
            "-o p.png",
            "--stats o.png",
            "--stats m.obj",
        ] {
            match words(&format!("render m.obj -o o.png {flags}")) {
                Err(Stop::Refused(line)) => {
                    assert!(line.starts_with("error: "), "{flags}: {line}");
                    assert!(!line.contains('\n') && line.len() > 15, "{flags}: {line}");
                }
                other => panic!("{flags}: {other:?}"),
            }
        }
        for line in [
            "render",
            "render m.obj",
            "render -o o.png",
            "render m.obj -o",
            "render m.obj -o o.bmp",
            "render m.obj -o o",
            "render m.png -o m.png",
            "paint",
            "--unknown",
            "demo --frames 0",
            "demo --frames 1001",
            "demo --frames -1",
            "demo x",
            "trace m.obj",
            "trace --line 3",
            "trace m.obj --line 240",
            "trace m.obj --line -1",
            "trace m.obj --line 65536",
            "trace m.obj --line 3 --size 4x3",
            "trace m.obj --line 3 --fov 0",
            "trace m.obj --line 3 -o x.png",
            "firmware --jsn",
            "bake m.obj",
            "bake m.stl -o m.list",
            "bake m.obj -o m.obj",
            "bake m.obj -o m.list --error 0",
            "bake m.obj -o m.list --error nan",
            "bake m.obj -o m.list --normals maybe",
            "run-list m.list",
            "run-list m.list -o m.list",
            "run-list m.list -o m.png --print",
            "run-list m.list -o m.png --budget -1",
            "run-list m.list -o m.png --size 0x1",
            "disassemble",
            "disassemble m.list x",
            "firmware x",
            "--frames 3",
        ] {
            match words(line) {
                Err(Stop::Refused(text)) => assert!(!text.contains('\n'), "{line}: {text}"),
                other => panic!("{line}: {other:?}"),
            }
        }
        let broken = parse(["scanbeam", "render", "a\nb.obj", "-o", "c\n\nd.bmp"]);
        assert!(matches!(broken, Err(Stop::Refused(text)) if !text.contains('\n')));
    }

    #[test]
    fn refusals_say_what_is_wrong() {
        let refusal = |flags: &str| match words(&format!("render m.obj -o o.png {flags}")) {
            Err(Stop::Refused(line)) => line,
            other => panic!("{other:?}"),
        };
        assert_eq!(
            refusal("--size 0x4"),
            "error: invalid value '0x4' for '--size <WxH>': WIDTHxHEIGHT is needed, each 1 to 8192"
        );
        assert_eq!(
            refusal("--eye 0,0,0"),
            "error: eye and at are the same place"
        );
        assert_eq!(
            refusal("--up 0,0,5"),
            "error: up is parallel to the view direction"
        );
        assert_eq!(refusal("--near 5 --far 5"), "error: near must be below far");
        assert_eq!(
            refusal("--texture x.png"),
            "error: unexpected argument '--texture' found"
        );
        assert_eq!(
            words("render"),
            Err(Stop::Refused(
                "error: the following required arguments were not provided: --output <OUT> <MODEL.obj>".into()
            ))
        );
    }

    #[test]
    fn help_is_text_not_a_refusal() {
        for line in ["--help", "render --help", "--version", "help"] {
            assert!(matches!(words(line), Err(Stop::Text(_))), "{line}");
        }
    }
}
