//! What is shown: the model, and a frame of it in a state.

use super::State;
use crate::draw::{
    CrewSettings, DrawFailure, Drawn, FilterArg, Prepared, SceneParts, Skins, TextureSet,
    TextureSetError, draw_prepared, draw_scene_file,
};
use crate::image_out::Frame;
use crate::model::Model;
use crate::reference::View;
use crate::scene_file::{Loaded, SceneFile};
use scanbeam::frame::FrameUse;
use std::time::{Duration, Instant};

/// What is shown.
enum What<'m> {
    Model {
        prepared: Prepared,
        textures: TextureSet,
    },
    Scene {
        scene: &'m SceneFile,
        parts: SceneParts<'m>,
        notes: Vec<String>,
    },
}

/// A model or a scene, and what all its frames share.
pub struct Scenery<'m> {
    what: What<'m>,
    /// The middle of the model's box.
    pub(super) centre: [f64; 3],
    /// From there to the farthest vertex; 1 for a model without any size.
    pub(super) radius: f64,
}

impl<'m> Scenery<'m> {
    /// Reads the textures that the model names.
    ///
    /// # Errors
    /// A texture that cannot be read.
    pub fn new(model: &Model) -> Result<Self, TextureSetError> {
        let (low, high) = model.bounds().unwrap_or_default();
        let centre: [f64; 3] = std::array::from_fn(|i| low[i] / 2.0 + high[i] / 2.0);
        let radius = model.vertices.iter().fold(0.0, |most: f64, vertex| {
            let off = vertex.position.iter().zip(centre);
            most.max(off.fold(0.0, |sum: f64, (at, centre)| sum.hypot(at - centre)))
        });
        let textures = TextureSet::load(model, None)?.with_levels(true);
        Ok(Self {
            what: What::Model {
                prepared: Prepared::textured(model, &textures),
                textures,
            },
            centre,
            radius: if radius > 0.0 { radius } else { 1.0 },
        })
    }

    /// A scene of a file, about the place that its camera looks at.
    ///
    /// # Errors
    /// An object that is too large or too far away.
    pub fn of_scene(loaded: &'m Loaded) -> Result<Self, DrawFailure> {
        Ok(Self {
            what: What::Scene {
                scene: &loaded.scene,
                parts: SceneParts::new(loaded)?,
                notes: loaded.notes(),
            },
            centre: loaded.scene.camera.at,
            radius: 1.0,
        })
    }

    /// The view that a scene's file says.
    pub(super) fn own_view(&self) -> Option<View> {
        match &self.what {
            What::Scene { scene, .. } => Some(scene.view()),
            What::Model { .. } => None,
        }
    }

    /// What is not drawn as it is in the files, a line each.
    #[must_use]
    pub fn notes(&self) -> Vec<String> {
        match &self.what {
            What::Model { textures, .. } => textures.notes().map(str::to_owned).collect(),
            What::Scene { notes, .. } => notes.clone(),
        }
    }

    /// Draws a frame of so many pixels.
    ///
    /// # Errors
    /// See [`DrawFailure`].
    pub fn frame(&self, state: &State, width: u32, height: u32) -> Result<Shown, DrawFailure> {
        let start = Instant::now();
        let view = state.view(self, width, height);
        let drawn = self.draw(state, &view)?;
        Ok(Shown {
            frame: drawn.frame,
            used: drawn.used,
            took: start.elapsed(),
        })
    }

    fn draw(&self, state: &State, view: &View) -> Result<Drawn, DrawFailure> {
        match &self.what {
            What::Model { prepared, textures } => {
                let skins = Skins {
                    set: textures,
                    filter: FilterArg::Nearest,
                    budget: state.quality.budget(),
                };
                draw_prepared(prepared, Some(skins), view, state.format, crew(state))
            }
            What::Scene { scene, parts, .. } => {
                let format = scene.in_format(state.format);
                draw_scene_file(parts, view, format, crew(state))
            }
        }
    }
}

/// Who draws in a state.
fn crew(state: &State) -> CrewSettings {
    CrewSettings {
        renderers: state.renderers,
        slots: state.slots,
        ..CrewSettings::default()
    }
}

/// A frame, and how long it took on this machine.
pub struct Shown {
    /// The picture.
    pub frame: Frame,
    /// What was done for it.
    pub used: FrameUse,
    /// To set the scene up and draw it.
    pub took: Duration,
}

impl Shown {
    /// What was done and what was skipped, in one line without times.
    #[must_use]
    pub fn figures(&self) -> String {
        let (done, cache) = (&self.used.assembled, &self.used.cache);
        format!(
            "{} of {} triangles left out, {} of {} found no slot at first, {} set-ups, {} lines empty",
            done.culled,
            done.triangles,
            cache.spilled,
            cache.hits + cache.spilled,
            cache.set_ups,
            self.used.lines_skipped,
        )
    }
}
