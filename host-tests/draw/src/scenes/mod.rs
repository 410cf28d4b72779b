//! Scenes of a file by draw calls: several models, each with its place, blend, depth function, priority and window, in
//! several lights or in palettes a line.
//!
//! | file | there |
//! |---|---|
//! | `placed.rs` | an object where it stands |
//! | `light.rs` | the lights, on each object |
//! | `store.rs` | what is in memory of pictures |
//! | `texels.rs` | textures that read it |
//! | `worn.rs` | the draw calls and their order |
//! | `doubled.rs` | scenes that are drawn at half their size |
//! | `palettes.rs` | scenes in palettes |

mod doubled;
mod light;
mod palettes;
mod placed;
mod store;
mod texels;
mod worn;

pub use doubled::{Twice, twice};
pub(crate) use light::{Side, ambient, directional, material};
pub(crate) use store::check;
pub(crate) use texels::TextureWords;
pub(crate) use worn::{Step, What};

use crate::choice::PixelFormatArg;
use crate::formats::{Picture, draw_in, refused};
use crate::parts::{Job, MOST_OBJECTS, MOST_VERTICES, room_for};
use crate::prepared::{Chunk, ShadowMesh};
use crate::scene_file::{Item, Loaded, SceneFile, ShadeKind};
use crate::setting::focal;
use crate::{CrewSettings, DrawFailure, Drawn, TextureSet};
use host_support::reference::View;
use light::{AtPixels, SceneLights};
use placed::Placed;
use scanbeam::look::{Gouraud, Look, Phong, Textured, TexturedPhong};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::Texture;
use scanbeam::{Affine, Camera};
use worn::Worn;

/// A scene in the crate's number formats.
pub struct SceneParts<'a> {
    scene: &'a SceneFile,
    parts: Vec<Placed<'a>>,
}

impl<'a> SceneParts<'a> {
    /// Rounds the models of a scene.
    ///
    /// # Errors
    /// A model that is too large or too far away, or that is of several colours where it may have one.
    pub fn new(loaded: &'a Loaded) -> Result<Self, DrawFailure> {
        Ok(Self {
            scene: &loaded.scene,
            parts: placed::place(&loaded.parts, &loaded.scene)?,
        })
    }

    /// Whether anything has a texture.
    #[must_use]
    pub fn are_textured(&self) -> bool {
        self.parts.iter().any(|part| !part.textures.is_empty())
    }

    /// What the file says.
    pub(crate) fn scene(&self) -> &'a SceneFile {
        self.scene
    }

    /// The textures of each object, and what the file says of it.
    pub(crate) fn textures(&self) -> impl Iterator<Item = (&'a Item, &'a TextureSet)> {
        self.parts.iter().map(|part| (part.item, part.textures))
    }

    /// What the file says of an object.
    pub(crate) fn item(&self, object: usize) -> &'a Item {
        self.parts[object].item
    }

    /// Where an object stands.
    pub(crate) fn model(&self, object: usize) -> &Affine {
        &self.parts[object].model
    }

    /// The colour of an object's parts with a look.
    pub(crate) fn colour(&self, object: usize, look: u16) -> [u8; 3] {
        self.parts[object].colour(look)
    }

    /// The part of an object that a step draws, unless it is a volume.
    pub(crate) fn chunk(&self, step: &Step) -> Option<&Chunk> {
        match step.what {
            What::Part(number) | What::InShadow(number) => {
                self.parts[step.object].prepared.chunks.get(number)
            }
            What::Volume(_) => None,
        }
    }

    /// What throws the shadow that a step draws, if it is a volume.
    pub(crate) fn volume(&self, step: &Step) -> Option<&ShadowMesh> {
        match step.what {
            What::Volume(number) => self.parts[step.object].shadows.get(number),
            What::Part(_) | What::InShadow(_) => None,
        }
    }

    /// The view of what is drawn.
    pub(crate) fn drawn_view(&self) -> View {
        drawn_view(self.scene, self.scene.view())
    }
}

/// The view of what is drawn of a scene that is seen so.
fn drawn_view(scene: &SceneFile, mut view: View) -> View {
    if scene.doubled {
        (view.width, view.height) = (doubled::half(view.width), doubled::half(view.height));
    }
    view
}

/// Draws a scene as its file says, seen as `view` says.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_scene_file(
    parts: &SceneParts<'_>,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    let size = [view.width, view.height];
    let view = drawn_view(parts.scene, view.clone());
    let task = Task {
        parts,
        job: job(parts, &view, crew)?,
        size,
        dither: format == PixelFormatArg::Dithered565,
    };
    match (format, parts.scene.has_palettes()) {
        (_, false) => draw_in(&task, format),
        (PixelFormatArg::Rgb888, true) => palettes::by_palettes::<Rgb888>(parts, &task.job),
        (PixelFormatArg::Rgb565, true) => palettes::by_palettes::<Rgb565Be>(parts, &task.job),
        _ => Err(refused("scenes with palettes are drawn")),
    }
}

/// What is drawn, and by whom.
fn job(parts: &SceneParts<'_>, view: &View, crew: CrewSettings) -> Result<Job, DrawFailure> {
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    let places = [view.eye, view.at, view.up].map(single);
    let camera = Camera::look_at(
        places[0],
        places[1],
        places[2],
        focal(view),
        view.near as f32,
        view.far as f32,
    );
    let camera = camera.map_err(|error| DrawFailure::View(error.to_string()))?;
    let chunks = parts.parts.iter().flat_map(|part| &part.prepared.chunks);
    let is_flat = |part: &Placed<'_>| part.item.shade == Some(ShadeKind::Flat);
    let mut room = room_for(
        chunks,
        parts.are_textured(),
        parts.parts.iter().any(is_flat),
    );
    let shadows = parts.scene.has_shadows();
    if shadows {
        // Each opaque part twice, and volumes of unknown size.
        (room.vertices, room.objects) = (MOST_VERTICES, MOST_OBJECTS);
        room.places = if parts.are_textured() {
            MOST_VERTICES
        } else {
            0
        };
        // A volume has two states, and two more where the near plane cuts it.
        let volumes = parts.parts.iter().map(|part| part.shadows.len());
        room.draws = 2 * room.draws + 4 * volumes.sum::<usize>();
    }
    Ok(Job {
        shadows,
        ..Job::new(view, camera, crew, room)
    })
}

/// A scene of colours, in several lights.
struct Task<'a> {
    parts: &'a SceneParts<'a>,
    job: Job,
    /// Columns and lines that are shown.
    size: [u32; 2],
    dither: bool,
}

impl Picture for Task<'_> {
    fn is_textured(&self) -> bool {
        self.parts.are_textured()
    }

    fn plain<F: PixelFormat + Sync>(&self) -> Result<Drawn, DrawFailure> {
        match self.parts.scene.phong {
            false => self.draw::<Gouraud<F>, F>(&[]),
            true => self.draw::<Phong<F>, F>(&[]),
        }
    }

    fn textured<F, T>(&self) -> Result<Drawn, DrawFailure>
    where
        F: PixelFormat + Sync,
        T: PixelFormat<Word = u16>,
        Textured<F>: Look<Pixel = F, Planes: Send>,
        TexturedPhong<F>: Look<Pixel = F, Planes: Send>,
    {
        let is_phong = self.parts.scene.phong;
        texels::with_textures::<T>(&self.parts.parts, |textures| match is_phong {
            false => self.draw::<Textured<F>, F>(textures),
            true => self.draw::<TexturedPhong<F>, F>(textures),
        })
    }
}

impl Task<'_> {
    /// Draws surfaces in several lights, with the textures of each object.
    fn draw<L, F>(&self, textures: &[&[Texture<'_>]]) -> Result<Drawn, DrawFailure>
    where
        L: Look<Pixel = F, Planes: Send> + Sync,
        F: PixelFormat + Sync,
    {
        let lights = SceneLights::of(self.parts.scene)?;
        let is_phong = self.parts.scene.phong;
        let at_pixels = match lights.as_ref().filter(|_| is_phong) {
            Some(lights) => lights.at_pixels(&self.parts.parts, &self.job)?,
            None => AtPixels::default(),
        };
        let worn = Worn {
            parts: self.parts,
            textures,
            lights: lights.as_ref().filter(|_| !is_phong),
            at_pixels: &at_pixels,
            dither: self.dither,
        };
        let drawn = worn.draw_all::<L, F>(&self.job)?;
        match self.parts.scene.doubled {
            true => doubled::doubled::<F>(drawn, self.size),
            false => Ok(drawn),
        }
    }
}
