//! A scene as a file: everything that a picture is made of, in JSON, for `render` and `view`.
//!
//! [`SceneFile::parse`] reads the text and holds it against what can be drawn together;
//! [`Loaded::load`] reads the models and pictures that it names, from the folder of the file.
//! The guide's page `scene_files` has every field.

mod load;

pub use load::{Loaded, Part, SceneFileError};

use crate::choice::{MAX_SIDE, PixelFormatArg};
use host_support::reference::{Cull, View};
use serde::Deserialize;
use std::path::PathBuf;

/// Most objects of a scene.
const MAX_OBJECTS: usize = 1024;
/// Most lights.
const MAX_LIGHTS: usize = 8;
/// Most palettes, and most colours of one.
const MAX_PALETTES: usize = 256;

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

/// A model that stands in the scene.
#[derive(Debug, Clone, PartialEq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Item {
    /// OBJ file, from the folder of the scene.
    pub model: PathBuf,
    /// Times so much,
    pub scale: Option<f64>,
    /// then turned about x, y and z in that order, in degrees,
    pub turn: Option<[f64; 3]>,
    /// then moved here.
    pub place: Option<[f64; 3]>,
    /// Picture for all of it in place of those of its materials, from the folder of the scene.
    pub texture: Option<PathBuf>,
    /// Which triangles are dropped by the side that they show.
    pub cull: Option<CullSide>,
    /// How its colour and that behind it become one.
    pub blend: Option<BlendKind>,
    /// How much of it there is in the blend, 0 to 255.
    pub alpha: Option<u8>,
    /// Where it is drawn, by depth.
    pub depth: Option<DepthKind>,
    /// Whether its depth is written.
    pub writes_depth: Option<bool>,
    /// In a scene with priorities the higher is in front; of the same the later.
    pub priority: Option<u8>,
    /// The part of the picture that it keeps.
    pub window: Option<Cutout>,
    /// Its index in a scene with palettes.
    pub index: Option<u8>,
}

/// Sides of triangles.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum CullSide {
    /// None is dropped.
    None,
    /// What shows its back.
    Back,
}

impl From<CullSide> for Cull {
    fn from(side: CullSide) -> Self {
        match side {
            CullSide::None => Self::None,
            CullSide::Back => Self::Back,
        }
    }
}

/// Ways to blend.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum BlendKind {
    /// What is behind shines through by 1 - alpha.
    Filter,
    /// Its colour times alpha is added.
    Add,
    /// Its colour times alpha is taken away.
    Subtract,
}

/// Depth functions, of the surface against what is there.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum DepthKind {
    /// Nowhere.
    Never,
    /// Where it is farther.
    Farther,
    /// Where it is as far.
    Equal,
    /// Where it is not nearer.
    FartherOrEqual,
    /// Where it is nearer.
    Nearer,
    /// Where it is not as far.
    Different,
    /// Where it is not farther.
    NearerOrEqual,
    /// Everywhere.
    Always,
}

/// A window of the picture in pixels.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(deny_unknown_fields)]
pub struct Cutout {
    /// First column.
    pub left: u16,
    /// First line.
    pub top: u16,
    /// Columns.
    pub width: u16,
    /// Lines.
    pub height: u16,
    /// Whether what is outside is kept.
    #[serde(default)]
    pub outside: bool,
}

impl SceneFile {
    /// Reads a scene's text.
    ///
    /// # Errors
    /// One line: where the text is no scene, or which of its fields contradict each other.
    pub fn parse(text: &str) -> Result<Self, String> {
        let scene: Self = serde_json::from_str(text).map_err(|error| error.to_string())?;
        scene.check()?;
        for (number, item) in scene.objects.iter().enumerate() {
            let checked = scene.check_item(item);
            checked.map_err(|why| format!("object {number}: {why}"))?;
        }
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

    /// What is not of one object.
    fn check(&self) -> Result<(), String> {
        if !self.size.iter().all(|side| (1..=MAX_SIDE).contains(side)) {
            return Err(format!("`size` must be 1 to {MAX_SIDE} each way"));
        }
        self.view().check().map_err(|error| error.to_string())?;
        if self.objects.len() > MAX_OBJECTS {
            return Err(format!("at most {MAX_OBJECTS} `objects`"));
        }
        if self.lights.len() > MAX_LIGHTS {
            return Err(format!("at most {MAX_LIGHTS} `lights`"));
        }
        let within = |value: &f64| (0.0..=1.0).contains(value);
        for lamp in &self.lights {
            let fits = lamp.towards.iter().all(|c| c.abs() <= f64::from(f32::MAX));
            if !fits || lamp.towards == [0.0; 3] {
                return Err("`towards` of a light must be finite, and not zero".into());
            }
            if !lamp.colour.iter().all(within) {
                return Err("`colour` of a light must be from 0 to 1".into());
            }
        }
        if self.ambient.is_some() && self.lights.is_empty() {
            return Err("`ambient` needs `lights`".into());
        }
        if !self.ambient.iter().all(within) {
            return Err("`ambient` must be from 0 to 1".into());
        }
        if self.dither && self.format != Format::Rgb565 && !self.has_palettes() {
            return Err("`dither` needs `format` rgb565".into());
        }
        self.check_palettes()
    }

    fn check_palettes(&self) -> Result<(), String> {
        if !self.has_palettes() {
            return Ok(());
        }
        let others = [
            ("lights", !self.lights.is_empty()),
            ("dither", self.dither),
            ("background", self.background.is_some()),
        ];
        if let Some((other, _)) = others.iter().find(|(_, said)| *said) {
            return Err(format!(
                "`palettes` and `{other}` cannot be had together: surfaces have an index there"
            ));
        }
        if self.palettes.len() > MAX_PALETTES {
            return Err(format!("at most {MAX_PALETTES} `palettes`"));
        }
        let sizes = 1..=MAX_PALETTES;
        if !(self.palettes.iter()).all(|p| sizes.contains(&p.colours.len())) {
            return Err(format!("a palette has 1 to {MAX_PALETTES} `colours`"));
        }
        let lines: Vec<u32> = self.palettes.iter().map(|p| p.from_line).collect();
        let rise = lines.windows(2).all(|pair| pair[0] < pair[1]);
        let last = lines.last().copied().unwrap_or(0);
        if lines.first() != Some(&0) || !rise || last >= self.size[1] {
            return Err(
                "`from_line` of palettes must begin at 0, rise, and stay below the height".into(),
            );
        }
        Ok(())
    }

    /// What one object says, against itself and the scene.
    fn check_item(&self, item: &Item) -> Result<(), String> {
        let names = [Some(&item.model), item.texture.as_ref()];
        let is_plain = |name: &&PathBuf| !name.to_string_lossy().contains(char::is_control);
        if !names.iter().flatten().all(is_plain) {
            return Err("names of files must not have control characters".into());
        }
        let finite = |v: &[f64]| v.iter().all(|c| c.abs() <= f64::from(f32::MAX));
        if item.scale.is_some_and(|s| !(finite(&[s]) && s > 0.0)) {
            return Err("`scale` must be above 0".into());
        }
        if !item.turn.iter().chain(&item.place).all(|v| finite(v)) {
            return Err("`turn` and `place` must be finite".into());
        }
        if item.alpha.is_some() && item.blend.is_none() {
            return Err("`alpha` needs `blend`".into());
        }
        if item.blend.is_some() && item.writes_depth == Some(true) {
            return Err("`blend` writes no depth: `writes_depth` cannot be true".into());
        }
        if item.window.is_some_and(|w| w.width == 0 || w.height == 0) {
            return Err("`window` has no pixels".into());
        }
        let says = [
            ("texture", item.texture.is_some()),
            ("blend", item.blend.is_some()),
            ("depth", item.depth.is_some()),
            ("writes_depth", item.writes_depth.is_some()),
            ("priority", item.priority.is_some()),
        ];
        let said = |names: &[&'static str]| {
            let found = says.iter().find(|(name, is)| *is && names.contains(name));
            found.map(|(name, _)| *name)
        };
        if self.has_palettes() {
            if let Some(name) = said(&["texture", "blend", "depth", "writes_depth", "priority"]) {
                return Err(format!(
                    "`{name}` and `palettes` cannot be had together: surfaces have an index there"
                ));
            }
        } else if item.index.is_some() {
            return Err("`index` needs `palettes`".into());
        }
        if self.has_priorities() {
            if let Some(name) = said(&["depth", "writes_depth"]) {
                return Err(format!(
                    "`{name}` and `priority` cannot be had together: what has priorities has no depth"
                ));
            }
        }
        Ok(())
    }
}
