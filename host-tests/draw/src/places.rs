//! Texture places as a renderer has them: a model is drawn with a computed texture of 1,024 texels a side whose texel is
//! its column, and with one whose texel is its row. A texture of fewer texels is drawn so as if it were magnified, so
//! fractions of its texels are seen.

use crate::parts::{Job, draw_parts, room_for};
use crate::{CrewSettings, DrawFailure, Prepared, Setting, TextureSet};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use host_support::texture_file::TextureImage;
use scanbeam::Draw;
use scanbeam::look::Textured;
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::{Budget, Skin, Texels, Texture};

/// What a pixel shows.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Shown {
    /// Nothing.
    #[default]
    Nothing,
    /// An object without its texture.
    Untextured,
    /// A place on a texture of so many texels a side.
    Texel {
        /// In 1/1024 of the side, to the right and down, rounded down.
        place: [u16; 2],
        /// Texels a side.
        side: u32,
    },
}

impl Shown {
    /// How far a pixel's place is from where it should be, at the least, in texels to the right and down; whole repeats
    /// of the texture do not count. `None` where no texel is shown.
    #[must_use]
    pub fn off(self, want: [f64; 2]) -> Option<[f64; 2]> {
        let Self::Texel { place, side } = self else {
            return None;
        };
        let steps = f64::from(Texture::MAX_SIDE) / f64::from(side);
        let off = |i: usize| {
            let all = f64::from(Texture::MAX_SIDE);
            let middle = f64::from(place[i]) + 0.5 - want[i] * steps;
            let middle = middle - (middle / all).round() * all;
            // Anywhere on the step.
            (middle.abs() - 0.5).max(0.0).copysign(middle) / steps
        };
        Some([0, 1].map(off))
    }

    /// Whether the texel itself is the one that holds the place.
    #[must_use]
    pub fn is_texel_of(self, want: [f64; 2]) -> bool {
        let Self::Texel { place, side } = self else {
            return false;
        };
        let texel = place.map(|at| f64::from(u32::from(at) * side / Texture::MAX_SIDE));
        texel == want.map(|at| at.floor().rem_euclid(side.into()))
    }
}

/// The column or the row of a texel.
struct Axis(usize);

impl Texels for Axis {
    fn texel(&self, column: u16, row: u16) -> u16 {
        [column, row][self.0]
    }
}

/// What is no column and no row.
const NOTHING: [u8; 3] = [128, 0, 0];

/// Draws a model of white corners, each triangle with a texture of so many texels a side, a power of two; what all
/// pixels show, row by row from the top. Places may be off by `budget`.
///
/// # Errors
/// See [`DrawFailure`]; a model that does not fit memory as a whole is refused.
pub fn places(
    model: &Model,
    side: u32,
    budget: Budget,
    view: &View,
) -> Result<Vec<Shown>, DrawFailure> {
    let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
    let steps = Texture::MAX_SIDE / side.clamp(1, Texture::MAX_SIDE);
    // Texels are computed; of a picture the sides alone are asked.
    let image = TextureImage {
        width: Texture::MAX_SIDE,
        height: Texture::MAX_SIDE,
        levels: Default::default(),
        alpha: None,
        note: None,
    };
    let prepared = Prepared::textured(model, &TextureSet::whole(model, image));
    let magnified = (budget.texels() * steps).min(u16::MAX.into());
    let budget = Budget::new(magnified as u16);
    let along = |axis: usize| -> Result<Vec<u16>, DrawFailure> {
        let axis = Axis(axis);
        let texture = Texture::computed(&axis, Texture::MAX_SIDE, Texture::MAX_SIDE)
            .map_err(|error| bad(&error))?;
        words(&prepared, &texture, budget, view)
    };
    let white = Rgb565::from_rgb8([255; 3]);
    let nothing = Rgb565::from_rgb8(NOTHING);
    let shown = |(column, row): (u16, u16)| match column {
        word if word == white => Shown::Untextured,
        word if word == nothing => Shown::Nothing,
        _ => Shown::Texel {
            place: [column, row],
            side,
        },
    };
    Ok(along(0)?.into_iter().zip(along(1)?).map(shown).collect())
}

/// The words of a picture with a texture.
fn words(
    prepared: &Prepared,
    texture: &Texture<'_>,
    budget: Budget,
    view: &View,
) -> Result<Vec<u16>, DrawFailure> {
    let setting = Setting::new(prepared, view)?;
    let chunks = &prepared.chunks;
    let room = room_for(chunks.iter(), true, view.shade == Shade::Flat);
    let job = Job {
        background: NOTHING,
        ..Job::new(view, setting.camera, CrewSettings::default(), room)
    };
    let counted: Vec<_> = chunks.iter().map(Some).collect();
    let drawn =
        draw_parts::<Textured<Rgb565>, Rgb565>(&job, &counted, &mut |scene, _, i, instead| {
            let chunk = instead.unwrap_or(&chunks[i]);
            scene.draw(&Draw {
                model: setting.model,
                cull: setting.cull,
                texture: Some(Skin {
                    texture,
                    places: &chunk.places,
                    budget,
                }),
                ..Draw::new(chunk.mesh())
            })
        })?;
    if let Some(overfull) = drawn.overfull {
        return Err(DrawFailure::View(overfull.to_string()));
    }
    let pixels = drawn.frame.rgb().chunks_exact(3);
    Ok(pixels
        .map(|rgb| Rgb565::from_rgb8([rgb[0], rgb[1], rgb[2]]))
        .collect())
}
