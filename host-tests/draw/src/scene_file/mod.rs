//! A scene as a file: everything that a picture is made of, in JSON, for `render` and `view`.
//!
//! [`SceneFile::parse`] reads the text and holds it against what can be drawn together;
//! [`Loaded::load`] reads the models and pictures that it names, from the folder of the file.
//! The guide's page `scene_files` has every field.

mod check;
mod item;
mod load;

pub use item::{
    ApplicationKind, BlendKind, Computed, CullSide, Cutout, DepthKind, FactorKind, FormKind, Item,
    QualityKind, ShadeKind, Specular, TexelsKind,
};
pub use load::{Loaded, Part, SceneFileError};

use crate::choice::PixelFormatArg;
use host_support::reference::View;
use serde::Deserialize;

/// What a file says.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct SceneFile {
    /// Columns and lines.
    pub size: [u32; 2],
    /// What the display is sent.
    #[serde(default)]
    pub format: Format,
    /// Whether colours between two steps of RGB565 are mixed by an ordered dither.
    #[serde(default)]
    pub dither: bool,
    /// Colour where nothing is drawn.
    pub background: Option<[u8; 3]>,
    /// Where it is seen from.
    pub camera: Eye,
    /// Light that comes from everywhere, 0 to 1; of use with `lights` alone.
    pub ambient: Option<f64>,
    /// Lights; without any, surfaces show their colours as they are.
    #[serde(default)]
    pub lights: Vec<Lamp>,
    /// Whether light is reckoned at each pixel.
    #[serde(default)]
    pub phong: bool,
    /// Whether it is drawn at half its size and interpolated.
    #[serde(default)]
    pub doubled: bool,
    /// Palettes, each from a line on; with them surfaces have an index instead of colours.
    #[serde(default)]
    pub palettes: Vec<Palette>,
    /// What is seen, in the order in which it is submitted.
    pub objects: Vec<Item>,
}

/// How a pixel is sent.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum Format {
    /// 24 bits.
    #[default]
    Rgb888,
    /// 16 bits.
    Rgb565,
}

/// A camera.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Eye {
    /// Its place.
    pub eye: [f64; 3],
    /// The place in the middle of the picture.
    pub at: [f64; 3],
    /// What is up in the picture.
    #[serde(default = "Eye::up")]
    pub up: [f64; 3],
    /// Vertical field of view in degrees.
    #[serde(default = "Eye::fov")]
    pub fov: f64,
    /// Nearest distance that is drawn.
    #[serde(default = "Eye::near")]
    pub near: f64,
    /// Farthest distance that is drawn.
    #[serde(default = "Eye::far")]
    pub far: f64,
}

impl Eye {
    fn up() -> [f64; 3] {
        View::default().up
    }

    fn fov() -> f64 {
        View::default().fov
    }

    fn near() -> f64 {
        View::default().near
    }

    fn far() -> f64 {
        View::default().far
    }
}

/// A light, infinitely far away.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Lamp {
    /// The way to it.
    pub towards: [f64; 3],
    /// Its red, green and blue, 0 to 1.
    #[serde(default = "Lamp::white")]
    pub colour: [f64; 3],
    /// Whether it throws shadows.
    #[serde(default)]
    pub shadows: bool,
}

impl Lamp {
    fn white() -> [f64; 3] {
        [1.0; 3]
    }
}

/// A palette.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Palette {
    /// The first line that has it.
    pub from_line: u32,
    /// The first of its colours; the rest are black.
    pub colours: Vec<[u8; 3]>,
}

impl SceneFile {
    /// Reads a scene's text.
    ///
    /// # Errors
    /// One line: where the text is no scene, or which of its fields contradict each other.
    pub fn parse(text: &str) -> Result<Self, String> {
        let scene: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        scene.check()?;
        Ok(scene)
    }

    /// Whether its surfaces have an index instead of colours.
    #[must_use]
    pub fn has_palettes(&self) -> bool {
        !self.palettes.is_empty()
    }

    /// Whether what is seen is decided by priorities.
    #[must_use]
    pub fn has_priorities(&self) -> bool {
        self.objects.iter().any(|item| item.priority.is_some())
    }

    /// Whether a light throws shadows.
    #[must_use]
    pub fn has_shadows(&self) -> bool {
        self.lights.iter().any(|lamp| lamp.shadows)
    }

    /// Whether an object throws a shadow.
    pub(crate) fn casts(&self, item: &Item) -> bool {
        self.has_shadows() && item.blend.is_none() && item.shadow != Some(false)
    }

    /// The priority of a draw call: where the file has any, one is above 0.
    pub(crate) fn rank(&self, item: &Item) -> u8 {
        let most = self.objects.iter().filter_map(|item| item.priority).max();
        match most {
            // All alike, the later in front.
            Some(0) => 1,
            Some(_) => item.priority.unwrap_or(0),
            None => 0,
        }
    }

    /// What the display is sent.
    #[must_use]
    pub fn pixel_format(&self) -> PixelFormatArg {
        self.in_format(match self.format {
            Format::Rgb888 => PixelFormatArg::Rgb888,
            Format::Rgb565 => PixelFormatArg::Rgb565,
        })
    }

    /// A format with the scene's dither.
    #[must_use]
    pub fn in_format(&self, format: PixelFormatArg) -> PixelFormatArg {
        match (format, self.dither) {
            (PixelFormatArg::Rgb565, true) => PixelFormatArg::Dithered565,
            (format, _) => format,
        }
    }

    /// The view of its camera.
    #[must_use]
    pub fn view(&self) -> View {
        let eye = &self.camera;
        View {
            width: self.size[0],
            height: self.size[1],
            eye: eye.eye,
            at: eye.at,
            up: eye.up,
            fov: eye.fov,
            near: eye.near,
            far: eye.far,
            background: self.background.unwrap_or_default(),
            ..View::default()
        }
    }
}
