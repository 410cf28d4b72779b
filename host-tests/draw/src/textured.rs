//! Models with textures: one file for all of it, or those that its materials name.

use super::DrawFailure;
use clap::ValueEnum;
use host_support::model::Model;
use host_support::texture_file::{LEVELS, TextureFileError, TextureImage, of_materials};
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::{self, Budget, Sampling};
use serde::Deserialize;
use std::collections::BTreeSet;
use std::path::Path;

/// How texels are taken from a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum, Deserialize)]
#[serde(rename_all = "lowercase")]
pub enum FilterArg {
    /// The nearest texel
    #[default]
    Nearest,
    /// The weighted mean of four
    Bilinear,
}

/// Most textures of a model: its triangles have numbers of 16 bits.
const MAX_TEXTURES: usize = 65_535;

/// Why a model cannot be textured.
#[derive(Debug, thiserror::Error)]
pub enum TextureSetError {
    /// A picture.
    #[error("{0}")]
    File(#[from] TextureFileError),
    /// There is nothing to place a texture by.
    #[error("the model has no texture places (vt), which a texture needs")]
    NoPlaces,
    /// More materials have pictures than there are numbers of textures.
    #[error("{0} materials have pictures (map_Kd), of at most {MAX_TEXTURES}")]
    TooMany(usize),
}

impl TextureSetError {
    /// The error as one line that names a file: the model, where it is not about a picture.
    #[must_use]
    pub fn named(&self, model: &Path) -> String {
        match self {
            Self::File(error) => error.to_string(),
            Self::NoPlaces | Self::TooMany(_) => format!("{}: {self}", model.display()),
        }
    }
}

/// The textures of a model, and which of them its triangles have.
#[derive(Debug, Default)]
pub struct TextureSet {
    images: Vec<TextureImage>,
    /// One for each triangle.
    of_triangle: Vec<Option<u16>>,
    /// Whether they are drawn in levels of detail.
    levels: bool,
}

impl TextureSet {
    /// One picture for the whole model, or, without, what its materials name.
    ///
    /// # Errors
    /// A picture that cannot be read; too many of them; a model without texture places.
    pub fn load(model: &Model, file: Option<&Path>) -> Result<Self, TextureSetError> {
        Self::load_any(model, file)?.placed(model)
    }

    /// The same, whether or not the model has texture places.
    pub(crate) fn load_any(model: &Model, file: Option<&Path>) -> Result<Self, TextureSetError> {
        Ok(match file {
            Some(file) => Self::whole(model, TextureImage::load(file)?),
            None => {
                let pictures = model.materials.iter().filter(|m| m.map_kd.is_some());
                let pictures = pictures.count();
                if pictures > MAX_TEXTURES {
                    return Err(TextureSetError::TooMany(pictures));
                }
                let mut set = Self::default();
                let numbers: Vec<Option<u16>> = of_materials(model)?
                    .into_iter()
                    .map(|image| {
                        set.images.push(image?);
                        Some(set.images.len() as u16 - 1)
                    })
                    .collect();
                let number = |material: &Option<u32>| numbers[(*material)? as usize];
                set.of_triangle = model.triangle_materials.iter().map(number).collect();
                set
            }
        })
    }

    /// The set, unless its model has no texture places.
    pub(crate) fn placed(self, model: &Model) -> Result<Self, TextureSetError> {
        match self.is_empty() || model.has_places() {
            true => Ok(self),
            false => Err(TextureSetError::NoPlaces),
        }
    }

    /// One texture for all triangles.
    #[must_use]
    pub fn whole(model: &Model, image: TextureImage) -> Self {
        Self {
            images: vec![image],
            of_triangle: vec![Some(0); model.triangles.len()],
            levels: false,
        }
    }

    /// Whether its textures are drawn in levels of detail, as they grow smaller on the screen; at
    /// first they are not.
    #[must_use]
    pub fn with_levels(self, levels: bool) -> Self {
        Self { levels, ..self }
    }

    /// Whether nothing is textured.
    #[must_use]
    pub fn is_empty(&self) -> bool {
        self.images.is_empty()
    }

    /// What was done to the pictures, a line each; what is on several materials is told once.
    pub fn notes(&self) -> impl Iterator<Item = &str> {
        let notes = self.images.iter().filter_map(|image| image.note.as_deref());
        notes.collect::<BTreeSet<_>>().into_iter()
    }

    /// Its pictures, by their numbers.
    #[must_use]
    pub fn images(&self) -> &[TextureImage] {
        &self.images
    }

    /// The texture of a triangle.
    pub(super) fn of(&self, triangle: usize) -> Option<(u16, &TextureImage)> {
        let number = self.of_triangle.get(triangle).copied().flatten()?;
        Some((number, self.images.get(usize::from(number))?))
    }
}

/// Textures for draw calls, and how they are read.
#[derive(Debug, Clone, Copy)]
pub struct Skins<'s> {
    /// Those that a model was prepared with.
    pub set: &'s TextureSet,
    /// How texels are taken.
    pub filter: FilterArg,
    /// How far texture places may be off.
    pub budget: Budget,
}

impl Skins<'_> {
    fn sampling(&self) -> Option<Sampling> {
        match self.filter {
            FilterArg::Bilinear => Some(Sampling::LINEAR),
            FilterArg::Nearest => self.set.levels.then_some(Sampling::NEAREST),
        }
    }
}

/// A level of a texture in words of 16 bits.
struct Level {
    words: Vec<u16>,
    sides: [u32; 2],
}

impl Level {
    fn texture(&self) -> Result<scene::Texture<'_>, scene::TextureError> {
        scene::Texture::words(&self.words, self.sides[0], self.sides[1])
    }
}

/// The texels of a set's textures as draw calls read them: of each the levels of detail, the picture first.
pub(super) struct Texels16(Vec<Vec<Level>>);

/// What a texture is refused by.
fn bad(error: scene::TextureError) -> DrawFailure {
    DrawFailure::View(format!("a texture: {error}"))
}

impl Texels16 {
    /// Levels rounded to those of the format `F`; coarser ones only where the set has them.
    pub(super) fn of<F: PixelFormat<Word = u16>>(set: &TextureSet) -> Self {
        let count = if set.levels { LEVELS } else { 1 };
        let levels = |image: &TextureImage| {
            let mut levels: Vec<Level> = Vec::new();
            for (level, texels) in image.levels.iter().enumerate().take(count) {
                let sides = image.sides(level);
                // One texel has no level below it.
                if levels.last().is_some_and(|above| above.sides == sides) {
                    break;
                }
                let words = texels.iter().map(|&rgb| F::from_rgb8(rgb)).collect();
                levels.push(Level { words, sides });
            }
            levels
        };
        Self(set.images.iter().map(levels).collect())
    }

    /// The levels below each picture.
    pub(super) fn coarser(&self) -> Result<Vec<Vec<scene::Texture<'_>>>, DrawFailure> {
        let below = self.0.iter().map(|levels| levels.iter().skip(1));
        let textures: Result<_, _> = below
            .map(|below| below.map(Level::texture).collect())
            .collect();
        textures.map_err(bad)
    }

    /// The textures, read as `skins` says.
    pub(super) fn textures<'t>(
        &'t self,
        coarser: &'t [Vec<scene::Texture<'t>>],
        skins: Skins<'_>,
    ) -> Result<Vec<scene::Texture<'t>>, DrawFailure> {
        let texture = |(levels, coarser): (&'t Vec<Level>, &'t Vec<scene::Texture<'t>>)| {
            let texture = levels[0].texture()?;
            match skins.sampling() {
                Some(sampling) => texture.sampled(sampling, coarser),
                None => Ok(texture),
            }
        };
        let textures: Result<_, _> = self.0.iter().zip(coarser).map(texture).collect();
        textures.map_err(bad)
    }
}
