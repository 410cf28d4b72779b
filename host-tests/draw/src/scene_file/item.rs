//! What a scene file says of an object, and what its words are to draw calls.

use crate::FilterArg;
use scanbeam::Cull;
use scanbeam::scene::{
    Application, Blend, BlendMode, Budget, DepthFunction, DepthTest, Factor, Texture,
};
use serde::Deserialize;
use serde_json::Value;
use std::path::PathBuf;

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
    /// Texels that are computed, in place of a picture.
    pub computed: Option<Computed>,
    /// What is done with the transparency of its pictures.
    pub texels: Option<TexelsKind>,
    /// How its pictures lie in memory.
    pub texel_form: Option<FormKind>,
    /// Whether compressed pictures are read through a cache.
    pub cached: Option<bool>,
    /// Whether places on its pictures are made of its normals.
    pub reflection: Option<bool>,
    /// How texels are taken from its pictures.
    pub filter: Option<FilterArg>,
    /// Whether its pictures have levels of detail.
    pub levels: Option<bool>,
    /// How far texture places may be off.
    pub quality: Option<QualityKind>,
    /// What texels do to its colours.
    pub application: Option<ApplicationKind>,
    /// Whether light falls on its corners or on its faces, or it shows its colours as they are.
    pub shade: Option<ShadeKind>,
    /// The level of its highlights.
    pub specular: Option<Specular>,
    /// Their power: the higher, the smaller they are.
    pub shininess: Option<u16>,
    /// Whether it throws a shadow.
    pub shadow: Option<bool>,
    /// Which triangles are dropped by the side that they show.
    pub cull: Option<CullSide>,
    /// How its colour and that behind it become one.
    pub blend: Option<BlendKind>,
    /// How much of it there is in the blend, 0 to 255.
    pub alpha: Option<u8>,
    /// Whether red, green and blue are written.
    pub channels: Option<[bool; 3]>,
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
    /// Which of the input queues its draw calls come through.
    pub source: Option<u8>,
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

/// How far texture places may be off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum QualityKind {
    /// 1/2 texel.
    Fast,
    /// 1/4 texel.
    Balanced,
    /// 1/100 texel.
    Exact,
}

impl From<QualityKind> for Budget {
    fn from(quality: QualityKind) -> Self {
        match quality {
            QualityKind::Fast => Self::FAST,
            QualityKind::Balanced => Self::BALANCED,
            QualityKind::Exact => Self::EXACT,
        }
    }
}

/// What texels do to colours.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ApplicationKind {
    /// Both are multiplied.
    Product,
    /// Texels hide them.
    Replace,
    /// Texels hide them where they are not transparent.
    Decal,
}

impl From<ApplicationKind> for Application {
    fn from(kind: ApplicationKind) -> Self {
        match kind {
            ApplicationKind::Product => Self::Product,
            ApplicationKind::Replace => Self::Replace,
            ApplicationKind::Decal => Self::Decal,
        }
    }
}

/// Texels without a picture.
#[derive(Debug, Clone, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum Computed {
    /// Squares of two colours in turn.
    Squares {
        /// Columns and rows of texels.
        size: [u32; 2],
        /// The first one's square is at the upper left.
        colours: [[u8; 3]; 2],
        /// Texels a side of a square.
        side: u32,
    },
    /// A colour that goes from one to another along the columns, and back again.
    Gradient {
        /// Columns and rows of texels.
        size: [u32; 2],
        /// The colour at the left.
        from: [u8; 3],
        /// The other one.
        to: [u8; 3],
        /// Columns from one to the other.
        length: u32,
    },
}

impl Computed {
    /// Columns and rows of texels.
    #[must_use]
    pub fn size(&self) -> [u32; 2] {
        match self {
            Self::Squares { size, .. } | Self::Gradient { size, .. } => *size,
        }
    }

    /// Why it cannot be drawn, if it cannot.
    pub(super) fn check(&self) -> Result<(), String> {
        let is_power = |value: u32, most: u32| value.is_power_of_two() && value <= most;
        if !(self.size().iter()).all(|&side| is_power(side, Texture::MAX_SIDE)) {
            let most = Texture::MAX_SIDE;
            return Err(format!(
                "`size` of `computed` must be powers of two up to {most}"
            ));
        }
        let (name, value, most) = match self {
            Self::Squares { side, .. } => ("side", *side, 1 << 15),
            Self::Gradient { length, .. } => ("length", *length, 1 << 11),
        };
        match is_power(value, most) {
            true => Ok(()),
            false => Err(format!(
                "`{name}` of `computed` must be a power of two up to {most}"
            )),
        }
    }
}

/// What is done with transparency.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum TexelsKind {
    /// Texels of an alpha below 128 are holes.
    Cutout,
    /// The alpha of texels is one of the blend.
    Alpha,
}

/// Forms of texels in memory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FormKind {
    /// 16 bits each.
    Words,
    /// 4 bits each: 16 colours.
    Palette,
    /// 4 bits each, in blocks of 4 x 4.
    Compressed,
}

/// How light falls on surfaces.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum ShadeKind {
    /// On corners, or on pixels in a scene where it does.
    Gouraud,
    /// On each face as a whole.
    Flat,
    /// Not at all.
    None,
}

/// The level of highlights.
#[derive(Debug, Clone, Copy, PartialEq, Deserialize)]
#[serde(try_from = "Value")]
pub enum Specular {
    /// One, 0 to 1.
    Level(f64),
    /// Of red, green and blue, 0 to 1 each.
    Colour([f64; 3]),
}

impl TryFrom<Value> for Specular {
    type Error = String;

    fn try_from(value: Value) -> Result<Self, String> {
        let channels: Option<Vec<f64>> = match &value {
            Value::Array(channels) => channels.iter().map(Value::as_f64).collect(),
            _ => None,
        };
        let colour = channels.and_then(|channels| <[f64; 3]>::try_from(channels).ok());
        let level = value.as_f64().map(Self::Level);
        let specular = level.or(colour.map(Self::Colour));
        specular.ok_or_else(|| "`specular` must be a number, or three".into())
    }
}

impl From<Specular> for [f64; 3] {
    fn from(specular: Specular) -> Self {
        match specular {
            Specular::Level(level) => [level; 3],
            Specular::Colour(colour) => colour,
        }
    }
}

/// Ways to blend.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "lowercase", deny_unknown_fields)]
pub enum BlendKind {
    /// What is behind shines through by 1 - alpha.
    Filter,
    /// Half of each.
    Half,
    /// Its colour times alpha is added.
    Add,
    /// Its colour times alpha is taken away.
    Subtract,
    /// The sum of both, each multiplied by something.
    Factors {
        /// What its colour is multiplied by.
        source: FactorKind,
        /// What that behind it is.
        destination: FactorKind,
    },
}

impl BlendKind {
    /// The mode, of so much alpha.
    fn mode(self, alpha: u8) -> BlendMode {
        match self {
            Self::Filter => BlendMode::Filter(alpha),
            Self::Half => BlendMode::Half,
            Self::Add => BlendMode::Add(alpha),
            Self::Subtract => BlendMode::Subtract(alpha),
            Self::Factors {
                source,
                destination,
            } => BlendMode::Factors {
                source: source.into(),
                destination: destination.into(),
            },
        }
    }
}

/// What a colour is multiplied by.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Deserialize)]
#[serde(rename_all = "snake_case")]
pub enum FactorKind {
    /// Nothing of it is taken.
    Zero,
    /// All of it.
    One,
    /// A number of 255ths.
    Constant(u8),
    /// The colour behind.
    Destination,
    /// 1 less that.
    InverseDestination,
    /// The alpha of the texel.
    TextureAlpha,
    /// 1 less that.
    InverseTextureAlpha,
}

impl From<FactorKind> for Factor {
    fn from(kind: FactorKind) -> Self {
        match kind {
            FactorKind::Zero => Self::ZERO,
            FactorKind::One => Self::ONE,
            FactorKind::Constant(part) => Self::Constant(part),
            FactorKind::Destination => Self::Destination,
            FactorKind::InverseDestination => Self::InverseDestination,
            FactorKind::TextureAlpha => Self::TextureAlpha,
            FactorKind::InverseTextureAlpha => Self::InverseTextureAlpha,
        }
    }
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

impl From<DepthKind> for DepthFunction {
    fn from(kind: DepthKind) -> Self {
        match kind {
            DepthKind::Never => Self::NEVER,
            DepthKind::Farther => Self::FARTHER,
            DepthKind::Equal => Self::EQUAL,
            DepthKind::FartherOrEqual => Self::FARTHER_OR_EQUAL,
            DepthKind::Nearer => Self::NEARER,
            DepthKind::Different => Self::DIFFERENT,
            DepthKind::NearerOrEqual => Self::NEARER_OR_EQUAL,
            DepthKind::Always => Self::ALWAYS,
        }
    }
}

impl Item {
    /// The power of highlights where none is said.
    pub(crate) const SHININESS: u16 = 32;

    /// The input queue that its draw calls come through, where any do.
    pub(crate) fn source(&self) -> u8 {
        self.source.unwrap_or(0)
    }

    /// How it and what is behind it become one.
    pub(crate) fn blend(&self) -> Option<Blend> {
        let mode = self.blend.map(|kind| kind.mode(self.alpha.unwrap_or(255)));
        match self.channels {
            Some(rgb) => Some(Blend::new(mode.unwrap_or(BlendMode::Replace)).writing(rgb)),
            None => mode.map(Blend::new),
        }
    }

    /// Where it is drawn, and whether its depth is kept.
    pub(crate) fn depth(&self) -> DepthTest {
        let test = self
            .depth
            .map_or(DepthTest::HIDES, |kind| DepthTest::new(kind.into()));
        match self.writes_depth {
            Some(false) => test.without_write(),
            _ => test,
        }
    }

    /// Which of its triangles are dropped.
    pub(crate) fn cull(&self) -> Cull {
        self.cull.map_or(Cull::None, Cull::from)
    }
}
