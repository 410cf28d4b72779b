//! Flags of `bake`, `run-list` and `disassemble`.

use crate::args::{PictureArgs, PixelFormatArg, ShadeArg};
use crate::image_out::ImageFormat;
use clap::{Args, ValueEnum};
use host_support::apart::apart;
use scanbeam::scene::LARGEST;
use std::path::{Path, PathBuf};

/// Flags of `bake`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct BakeArgs {
    /// Model to bake: .obj, .gltf or .glb
    #[arg(value_name = "MODEL")]
    pub model: PathBuf,
    /// List to write
    #[arg(short = 'o', long = "output", value_name = "OUT.list")]
    pub output: PathBuf,
    /// How far a vertex may be moved, in units of the model; none: a thousandth of half its longest side
    #[arg(long, value_name = "E", value_parser = parse_positive, allow_hyphen_values = true)]
    pub error: Option<f64>,
    /// How far a normal may be turned, in degrees
    #[arg(long, value_name = "DEG", default_value = "1", value_parser = parse_positive, allow_hyphen_values = true)]
    pub normal_error: f64,
    /// Whether normals are kept
    #[arg(long, value_enum, default_value_t = Normals::Keep)]
    pub normals: Normals,
    /// Whether textures are kept
    #[arg(long, value_enum, default_value_t = Pictures::Keep)]
    pub textures: Pictures,
    /// Picture for all of the model instead of those that its materials name, .png, .jpg or .ppm
    #[arg(long, value_name = "FILE", conflicts_with = "textures")]
    pub texture: Option<PathBuf>,
    /// How far texels may be off: root of the mean square, in levels of 255. 0 keeps every texel
    #[arg(long, value_name = "LEVELS", default_value = "4", value_parser = parse_level, allow_hyphen_values = true)]
    pub texel_error: f64,
    /// Cut the model into parts that are passed over where all of their faces are turned away: for closed models of
    /// some thousand triangles
    #[arg(long)]
    pub meshlets: bool,
    /// Print the sizes as JSON
    #[arg(long)]
    pub json: bool,
}

/// Whether normals are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Normals {
    /// For lit surfaces
    Keep,
    /// For surfaces that show their colours alone
    Drop,
}

/// Whether textures are kept.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum Pictures {
    /// With their palettes
    Keep,
    /// For firmware that draws none
    Drop,
}

/// Flags that say what is drawn and how, for what draws nothing.
const DRAWING: [&str; 15] = [
    "output",
    "budget",
    "size",
    "eye",
    "at",
    "up",
    "fov",
    "near",
    "far",
    "light",
    "ambient",
    "shade",
    "cull",
    "format",
    "background",
];

/// Flags of `run-list`.
#[derive(Debug, Clone, PartialEq, Args)]
#[command(mut_arg("size", |size| size.help("Size of the picture in pixels, 1x1 to 1016x1016: one scene")))]
pub struct RunListArgs {
    /// List to execute
    #[arg(value_name = "FILE")]
    pub list: PathBuf,
    /// Picture to write, .png or .ppm
    #[arg(
        short = 'o',
        long = "output",
        value_name = "OUT",
        required_unless_present = "print"
    )]
    pub output: Option<PathBuf>,
    /// Print the list, block by block, instead
    #[arg(long, conflicts_with_all = DRAWING)]
    pub print: bool,
    /// Most blocks, most vertices and indices, and most jumps
    #[arg(long, value_name = "N", default_value_t = 1 << 24)]
    pub budget: u32,
    /// What to draw.
    #[command(flatten)]
    pub picture: PictureArgs,
}

/// Flags of `disassemble`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct DisassembleArgs {
    /// List to print
    #[arg(value_name = "FILE")]
    pub list: PathBuf,
}

impl BakeArgs {
    /// What flags alone cannot say.
    pub(crate) fn check(&self) -> Result<(), String> {
        let known = ["obj", "gltf", "glb"];
        let extension = self.model.extension().map(|e| e.to_ascii_lowercase());
        if !extension.is_some_and(|e| known.iter().any(|k| e == *k)) {
            return Err("the model must be .obj, .gltf or .glb".into());
        }
        self.check_apart([self.model.as_path()])
    }

    /// Whether the list is none of the files that are read: those, and the flags' picture.
    pub(crate) fn check_apart<'p>(
        &'p self,
        read: impl IntoIterator<Item = &'p Path>,
    ) -> Result<(), String> {
        let read = read.into_iter().chain(self.texture.as_deref());
        apart(&[("-o", &self.output)], read)
    }
}

impl RunListArgs {
    /// What flags alone cannot say.
    pub(crate) fn check(&self) -> Result<(), String> {
        let view = self.picture.view();
        view.check().map_err(|error| error.to_string())?;
        if view.width.max(view.height) > u32::from(LARGEST) {
            return Err(format!(
                "run-list has no --size above {LARGEST}x{LARGEST}: lists are drawn as one scene"
            ));
        }
        if self.picture.shade == ShadeArg::Phong {
            return Err("run-list has no --shade phong: lists are lit at corners".into());
        }
        if self.picture.format != PixelFormatArg::Rgb888 {
            return Err("run-list has no --format but rgb888".into());
        }
        let Some(output) = &self.output else {
            return Ok(());
        };
        ImageFormat::from_path(output).map_err(|error| error.to_string())?;
        apart(&[("-o", output)], [self.list.as_path()])
    }
}

fn parse_level(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if (0.0..=255.0).contains(&value) => Ok(value),
        _ => Err("a number from 0 to 255 is needed".into()),
    }
}

fn parse_positive(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() && value > 0.0 => Ok(value),
        _ => Err("a number above 0 is needed".into()),
    }
}
