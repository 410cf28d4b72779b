//! Texture places as the pipeline has them: a model is drawn with a texture whose texel is its place, into pixels that
//! hold it whole. So what is measured is every bit of set-up, spans and choice of steps, and no rounding to texels.

use crate::draw::{DrawFailure, Prepared, Setting, TextureSet, rooms_for};
use crate::image_out::Frame;
use crate::lent::LineRooms;
use crate::model::Model;
use crate::reference::View;
use crate::texture_file::TextureImage;
use scanbeam::pipeline::texture::{
    FRACTION, Period, Quality, TexelOf, Texels, Textured, Textures, Uv,
};
use scanbeam::pipeline::{Depth32, Flat, Packed8, Parts, Precision};
use scanbeam::pixel::{PixelFormat, TwoWords};

/// What a pixel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shown {
    /// Nothing.
    #[default]
    Nothing,
    /// An object without its texture.
    Untextured,
    /// The texel at a place.
    Texel(Uv),
}

impl Shown {
    /// How far a texel's place is from where it should be, in texels to the right and down; whole repeats of 1024
    /// texels, which every texture's sides divide, do not count. `None` where no texel is shown.
    #[must_use]
    pub fn off(self, want: [f64; 2]) -> Option<[f64; 2]> {
        let Self::Texel(place) = self else {
            return None;
        };
        let got = [place.u, place.v].map(|x| f64::from(x) / f64::from(1 << FRACTION));
        let off = |i: usize| got[i] - want[i];
        Some([0, 1].map(|i| off(i) - (off(i) / 1024.0).round() * 1024.0))
    }

    /// Whether the texel itself, of the 1024 a side, is the one that holds the place.
    #[must_use]
    pub fn is_texel_of(self, want: [f64; 2]) -> bool {
        let Self::Texel(place) = self else {
            return false;
        };
        let texel = |x: i32| f64::from((x >> FRACTION) & 1023);
        [place.u, place.v].map(texel) == want.map(|x| x.floor().rem_euclid(1024.0))
    }
}

/// Pixels that are [`Shown`].
#[derive(Debug, Clone, Copy)]
pub struct PlaceFormat;

impl PixelFormat for PlaceFormat {
    type Word = Shown;
    const STEPS: [u16; 3] = [255; 3];
    const PRECISION: Precision = Precision { unit: 1, drift: 1 };
    const CUTS: bool = false;

    fn pack(_: [u8; 3]) -> Shown {
        Shown::Untextured
    }

    fn pack_words(_: u32, _: u32) -> Shown {
        Shown::Untextured
    }

    type Ramp = TwoWords;

    fn to_rgb8(_: Shown) -> [u8; 3] {
        [0; 3]
    }
}

/// A texture whose texel is its place.
#[derive(Debug, Clone, Copy)]
pub struct Places;

impl Texels for Places {
    type Texel = Place;

    /// That of a texture of up to 1,024 texels.
    fn period(&self) -> Period {
        Period::Short
    }

    fn at(&self, place: Uv) -> Place {
        Place(place)
    }
}

/// A place as a texel.
#[derive(Debug, Clone, Copy)]
pub struct Place(Uv);

impl TexelOf<PlaceFormat> for Place {
    fn word(self) -> Shown {
        Shown::Texel(self.0)
    }

    fn levels(self) -> [u8; 3] {
        [0; 3]
    }
}

/// Draws a model of white corners, each triangle with a texture of so many texels a side; what all pixels show, row by
/// row from the top.
///
/// # Errors
/// See [`DrawFailure`]; a model that does not fit the arenas as a whole is refused.
pub fn places(
    model: &Model,
    side: u32,
    quality: Quality,
    view: &View,
) -> Result<Vec<Shown>, DrawFailure> {
    type Look = Parts<Textured<Flat>, Depth32, PlaceFormat, (), Packed8, Textures<'static, Places>>;
    let failed = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
    let blank = Frame::new(side, side, vec![0; (3 * side * side) as usize])
        .ok_or_else(|| failed(&"a texture has texels"))?;
    let image = TextureImage::new(&blank).map_err(|error| failed(&error))?;
    let prepared = Prepared::textured(model, &TextureSet::whole(model, image), quality);
    let setting = Setting::new(&prepared, view)?;
    let (width, height) = (view.width as u16, view.height as u16);
    let mut rooms = rooms_for::<Look>(&prepared, height);
    rooms.textures = Textures(&[Places]);
    let mut lines = LineRooms::<Look>::new(64, rooms.objects(), width.into());
    let mut pixels = vec![Shown::Nothing; usize::from(width) * usize::from(height)];
    let bands = setting.bands(&prepared, &mut rooms, 0..height, |scene| {
        let mut renderer = lines.renderer();
        for (line, row) in (0..).zip(pixels.chunks_exact_mut(usize::from(width))) {
            let drawn = renderer.draw_line(scene, line, row);
            drawn.map_err(|error| failed(&error))?;
        }
        Ok(())
    })?;
    if bands.count > 1 || bands.overfull.is_some() {
        return Err(failed(&"the model does not fit the arenas as a whole"));
    }
    Ok(pixels)
}
