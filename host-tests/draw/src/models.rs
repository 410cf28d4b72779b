//! A model in one matt light, or in none.

use crate::choice::PixelFormatArg;
use crate::formats::{Picture, draw_in};
use crate::parts::{Job, draw_parts, room_for};
use crate::prepared::Chunk;
use crate::textured::{Skins, Texels16};
use crate::{CrewSettings, DrawFailure, Drawn, Prepared, Setting};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use scanbeam::Draw;
use scanbeam::look::{Gouraud, Look, Textured, TexturedPhong};
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::{Budget, Skin, Texture};

/// Draws a model without textures.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    draw_prepared(&Prepared::new(model), None, view, format, crew)
}

/// Draws a model with its textures: colours linear on the screen, times texels in perspective.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_textured(
    model: &Model,
    skins: Skins<'_>,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    let prepared = Prepared::textured(model, skins.set);
    draw_prepared(&prepared, Some(skins), view, format, crew)
}

/// Draws a model, each of its parts by a draw call: for many frames of one. `skins` are the textures that it was
/// prepared with.
///
/// Texels have 16 bits whatever the format: the levels of a picture are rounded to 5, 6 and 5 bits.
///
/// A picture that is larger than a scene can be, or shows more than the memory of one holds, is put together from parts.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_prepared(
    prepared: &Prepared,
    skins: Option<Skins<'_>>,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    let task = Task {
        prepared,
        skins: skins.filter(|skins| !skins.set.is_empty()),
        view,
        setting: Setting::new(prepared, view)?,
        crew,
        dither: format == PixelFormatArg::Dithered565,
    };
    draw_in(&task, format)
}

/// What is drawn, and by whom.
struct Task<'a> {
    prepared: &'a Prepared,
    /// Only where there is a texture.
    skins: Option<Skins<'a>>,
    view: &'a View,
    setting: Setting,
    crew: CrewSettings,
    dither: bool,
}

impl Picture for Task<'_> {
    fn is_textured(&self) -> bool {
        self.skins.is_some()
    }

    fn plain<F: PixelFormat + Sync>(&self) -> Result<Drawn, DrawFailure> {
        self.draw::<Gouraud<F>, F>(&[], Budget::default())
    }

    fn textured<F, T>(&self) -> Result<Drawn, DrawFailure>
    where
        F: PixelFormat + Sync,
        T: PixelFormat<Word = u16>,
        Textured<F>: Look<Pixel = F, Planes: Send>,
        TexturedPhong<F>: Look<Pixel = F, Planes: Send>,
    {
        let Some(skins) = self.skins else {
            return self.plain::<F>();
        };
        let texels = Texels16::of::<T>(skins.set);
        let coarser = texels.coarser()?;
        let textures = texels.textures(&coarser, skins)?;
        self.draw::<Textured<F>, F>(&textures, skins.budget)
    }
}

impl Task<'_> {
    fn draw<L, F>(&self, textures: &[Texture<'_>], budget: Budget) -> Result<Drawn, DrawFailure>
    where
        L: Look<Pixel = F, Planes: Send> + Sync,
        F: PixelFormat + Sync,
    {
        let (chunks, setting) = (&self.prepared.chunks, &self.setting);
        let is_flat = self.view.shade == Shade::Flat;
        let room = room_for(chunks.iter(), !textures.is_empty(), is_flat);
        let job = Job {
            is_ahead: setting.is_ahead,
            ..Job::new(self.view, setting.camera, self.crew, room)
        };
        let counted: Vec<_> = chunks.iter().map(Some).collect();
        draw_parts::<L, F>(&job, &counted, &mut |scene, _, number, instead| {
            let chunk: &Chunk = instead.unwrap_or(&chunks[number]);
            let texture = chunk
                .texture
                .and_then(|number| textures.get(usize::from(number)));
            let draw = Draw {
                model: setting.model,
                cull: setting.cull,
                light: setting.light,
                shading: setting.shading,
                texture: texture.map(|texture| Skin {
                    texture,
                    places: &chunk.places,
                    budget,
                }),
                depth: self.crew.depth.test(),
                dither: self.dither,
                ..Draw::new(chunk.mesh())
            };
            scene.draw_within(&draw, &chunk.sphere).map(drop)
        })
    }
}
