//! What picture is to be drawn: the flags that `render` and `trace` share.

use super::MAX_SIDE;
use crate::choice::PixelFormatArg;
use crate::reference::{Cull, Shade, View};
use clap::{Args, ValueEnum};

/// How light is applied.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum ShadeArg {
    /// Vertex colours as they are
    None,
    /// One light level for a face
    Flat,
    /// Light at the corners, linear between
    Gouraud,
    /// Light at each pixel, by normals linear between the corners
    Phong,
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
    #[arg(long, value_enum, default_value_t = ShadeArg::None)]
    pub shade: ShadeArg,
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
    /// The view that the flags describe, with light at the corners where it is to be at each
    /// pixel; already checked when it comes from [`parse`](super::parse).
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
            shade: match self.shade {
                ShadeArg::None => Shade::None,
                ShadeArg::Flat => Shade::Flat,
                ShadeArg::Gouraud | ShadeArg::Phong => Shade::Gouraud,
            },
            cull: self.cull,
            background: self.background,
        }
    }
}

pub(super) fn parse_number(text: &str) -> Result<f64, String> {
    match text.trim().parse::<f64>() {
        Ok(value) if value.is_finite() => Ok(value),
        _ => Err("a finite number is needed".into()),
    }
}

pub(super) fn parse_vector(text: &str) -> Result<[f64; 3], String> {
    let numbers: Result<Vec<f64>, String> = text.split(',').map(parse_number).collect();
    numbers
        .ok()
        .and_then(|numbers| numbers.try_into().ok())
        .ok_or_else(|| "three finite numbers x,y,z are needed".into())
}

pub(super) fn parse_colour(text: &str) -> Result<[u8; 3], String> {
    let levels: Result<Vec<u8>, _> = text
        .split(',')
        .map(|part| part.trim().parse::<u8>())
        .collect();
    levels
        .ok()
        .and_then(|levels| levels.try_into().ok())
        .ok_or_else(|| "three whole numbers r,g,b from 0 to 255 are needed".into())
}

pub(super) fn parse_size(text: &str) -> Result<Size, String> {
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
