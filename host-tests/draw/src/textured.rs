//! Models with textures: one file for all of it, or those that its materials name.

use super::{CrewSettings, DrawFailure, Drawn, Prepared, draw_with};
use crate::choice::PixelFormatArg;
use clap::ValueEnum;
use host_support::model::Model;
use host_support::reference::{Shade, View};
use host_support::texture_file::{TextureFileError, TextureImage, of_materials};
use scanbeam::pipeline::texture::{
    Bilinear, Detail, DetailedTextures, LEVELS, LevelEnds, Levels, Period, Quality, Rgba8871, Size,
    Texel, TexelFormat, Texels, Texture, TextureSource, Textured, Textures, Uv, Words,
};
use scanbeam::pipeline::{Counted, Depth32, Flat, Gouraud, Packed8, Parts, Shading};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{self, Budget, Sampling};
use std::collections::BTreeSet;
use std::path::Path;

/// How texels are taken from a texture.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum FilterArg {
    /// The nearest texel
    #[default]
    Nearest,
    /// The weighted mean of four
    Bilinear,
}

/// Why a model cannot be textured.
#[derive(Debug, thiserror::Error)]
pub enum TextureSetError {
    /// A picture.
    #[error("{0}")]
    File(#[from] TextureFileError),
    /// There is nothing to place a texture by.
    #[error("the model has no texture places (vt), which a texture needs")]
    NoPlaces,
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
    /// A picture that cannot be read; a model without texture places.
    pub fn load(model: &Model, file: Option<&Path>) -> Result<Self, TextureSetError> {
        let set = match file {
            Some(file) => Self::whole(model, TextureImage::load(file)?),
            None => {
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
        };
        let placeless = model.vertices.iter().all(|v| v.uv == [0.0; 2]);
        if placeless && !model.vertices.is_empty() && !set.is_empty() {
            return Err(TextureSetError::NoPlaces);
        }
        Ok(set)
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
    pub quality: Quality,
}

impl Skins<'_> {
    /// How far that is in texels.
    pub(super) fn budget(&self) -> Budget {
        match self.quality {
            Quality::Fast => Budget::FAST,
            Quality::Balanced => Budget::BALANCED,
            Quality::Exact => Budget::EXACT,
        }
    }

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
    size: Size,
}

impl Level {
    fn texture(&self) -> Result<scene::Texture<'_>, scene::TextureError> {
        scene::Texture::words(&self.words, self.size.width(), self.size.height())
    }
}

/// The texels of a set's textures as draw calls read them: of each the levels of detail, the picture first.
pub(super) struct Texels16(Vec<Vec<Level>>);

impl Texels16 {
    /// Levels rounded to those of the format `F`; coarser ones only where the set has them.
    pub(super) fn of<F: PixelFormat<Word = u16>>(set: &TextureSet) -> Self {
        let count = if set.levels { LEVELS } else { 1 };
        let levels = |image: &TextureImage| {
            let mut levels: Vec<Level> = Vec::new();
            for (level, words) in (0..).zip(&image.levels).take(count) {
                let size = image.size.level(level);
                // One texel has no level below it.
                if levels.last().is_some_and(|above| above.size == size) {
                    break;
                }
                let word = |&word: &u32| F::from_rgb8(Rgba8871::expand(word).rgb);
                let words = words.iter().map(word).collect();
                levels.push(Level { words, size });
            }
            levels
        };
        Self(set.images.iter().map(levels).collect())
    }

    /// The levels below each picture.
    pub(super) fn coarser(&self) -> Result<Vec<Vec<scene::Texture<'_>>>, scene::TextureError> {
        let below = self.0.iter().map(|levels| levels.iter().skip(1));
        below
            .map(|below| below.map(Level::texture).collect())
            .collect()
    }

    /// The textures, read as `skins` says.
    pub(super) fn textures<'t>(
        &'t self,
        coarser: &'t [Vec<scene::Texture<'t>>],
        skins: Skins<'_>,
    ) -> Result<Vec<scene::Texture<'t>>, scene::TextureError> {
        let texture = |(levels, coarser): (&'t Vec<Level>, &'t Vec<scene::Texture<'t>>)| {
            let texture = levels[0].texture()?;
            match skins.sampling() {
                Some(sampling) => texture.sampled(sampling, coarser),
                None => Ok(texture),
            }
        };
        self.0.iter().zip(coarser).map(texture).collect()
    }
}

/// A texture with its filter.
#[derive(Debug, Clone, Copy)]
pub enum HostTexture<'t> {
    /// The nearest texel.
    Nearest(Texture<Words<'t, u32>>),
    /// The weighted mean of four.
    Bilinear(Bilinear<Texture<Words<'t, u32>>, Rgba8871>),
}

impl Texels for HostTexture<'_> {
    type Texel = Texel;

    fn at(&self, place: Uv) -> Texel {
        match self {
            Self::Nearest(texture) => Rgba8871::expand(texture.at(place)),
            Self::Bilinear(texture) => texture.at(place),
        }
    }

    fn period(&self) -> Period {
        match self {
            Self::Nearest(texture) => texture.period(),
            Self::Bilinear(texture) => texture.period(),
        }
    }

    fn fetches(&self) -> u32 {
        match self {
            Self::Nearest(_) => 1,
            Self::Bilinear(_) => 4,
        }
    }
}

/// Draws a model with its textures: colours linear on the screen, times texels in perspective.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_textured(
    model: &Model,
    set: &TextureSet,
    (filter, quality): (FilterArg, Quality),
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    let prepared = Prepared::textured(model, set, quality);
    let textures = textures(set, filter)?;
    let how = (&prepared, view, crew);
    if set.levels {
        return by::<LevelEnds, _>(how, format, DetailedTextures(&textures));
    }
    let whole: Vec<HostTexture<'_>> = textures.iter().map(|t| t.levels[0]).collect();
    by::<(), _>(how, format, Textures(&whole))
}

/// The textures of a set, read through a filter.
fn textures(
    set: &TextureSet,
    filter: FilterArg,
) -> Result<Vec<Levels<HostTexture<'_>>>, DrawFailure> {
    set.images
        .iter()
        .map(|image| {
            let mut levels = Vec::new();
            for (level, words) in (0..).zip(&image.levels) {
                let texture = Texture::new(Words(words), image.size.level(level))
                    .map_err(|error| DrawFailure::View(error.to_string()))?;
                levels.push(match filter {
                    FilterArg::Nearest => HostTexture::Nearest(texture),
                    FilterArg::Bilinear => HostTexture::Bilinear(Bilinear::new(texture)),
                });
            }
            let levels: [_; LEVELS] = std::array::from_fn(|i| levels[i]);
            Ok(Levels { levels })
        })
        .collect()
}

/// Draws with textures of some kind, in the detail `D`.
fn by<D, X>(
    (prepared, view, crew): (&Prepared, &View, CrewSettings),
    format: PixelFormatArg,
    textures: X,
) -> Result<Drawn, DrawFailure>
where
    D: Detail,
    X: TextureSource<Rgb888> + TextureSource<Rgb565Be> + Sync,
{
    match (view.shade, format) {
        (Shade::Flat, PixelFormatArg::Rgb888) => {
            by_shading::<Textured<Flat, D>, Rgb888, X>(prepared, textures, view, crew)
        }
        (Shade::Flat, PixelFormatArg::Rgb565) => {
            by_shading::<Textured<Flat, D>, Rgb565Be, X>(prepared, textures, view, crew)
        }
        (_, PixelFormatArg::Rgb888) => {
            by_shading::<Textured<Gouraud, D>, Rgb888, X>(prepared, textures, view, crew)
        }
        (_, PixelFormatArg::Rgb565) => {
            by_shading::<Textured<Gouraud, D>, Rgb565Be, X>(prepared, textures, view, crew)
        }
        _ => Err(super::formats::refused("textures are drawn")),
    }
}

fn by_shading<S, F, X>(
    prepared: &Prepared,
    textures: X,
    view: &View,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure>
where
    S: Shading<Levels: scanbeam::pipeline::Levels>,
    F: PixelFormat,
    X: TextureSource<F> + Sync,
{
    draw_with::<Counted<Parts<S, Depth32, F, (), Packed8, X>>>(prepared, view, crew, textures)
}
