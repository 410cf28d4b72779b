//! Scenes of a file by draw calls: several models, each with its place, blend, depth function, priority and window, in
//! several lights or in palettes a line.

mod palettes;

use crate::choice::PixelFormatArg;
use crate::formats::{Picture, draw_in, refused};
use crate::parts::{Job, Tile, draw_parts, room_for};
use crate::prepared::Chunk;
use crate::scene_file::{Item, Loaded, SceneFile};
use crate::setting::{focal, unit};
use crate::textured::Texels16;
use crate::{CrewSettings, DrawFailure, Drawn, Prepared, Skins, TextureSet};
use host_support::reference::View;
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::look::{Gouraud, Look, Textured, TexturedPhong};
use scanbeam::mesh::{Material, U1F15};
use scanbeam::pixel::{Index8, PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{Application, Budget, DrawError, Lights, Scissor, Skin, Texture};
use scanbeam::{Affine, Camera, Draw, Scene};

/// A scene in the crate's number formats.
pub struct SceneParts<'a> {
    scene: &'a SceneFile,
    parts: Vec<Placed<'a>>,
}

/// An object.
struct Placed<'a> {
    item: &'a Item,
    textures: &'a TextureSet,
    prepared: Prepared,
    model: Affine,
}

impl Placed<'_> {
    /// How far its texture places may be off.
    fn budget(&self) -> Budget {
        self.item.quality.map(Budget::from).unwrap_or_default()
    }
}

impl<'a> SceneParts<'a> {
    /// Rounds the models of a scene.
    ///
    /// # Errors
    /// A model that is too large or too far away.
    pub fn new(loaded: &'a Loaded) -> Result<Self, DrawFailure> {
        let mut parts = Vec::new();
        for (number, part) in loaded.parts.iter().enumerate() {
            let item = &part.item;
            let mut prepared = Prepared::textured(&part.model, &part.textures);
            if loaded.scene.has_palettes() {
                prepared.paint(Index8::colour(item.index.unwrap_or(0)));
            }
            let model = placed(&prepared, item).ok_or_else(|| {
                DrawFailure::View(format!("object {number} is too large, or too far away"))
            })?;
            parts.push(Placed {
                item,
                textures: &part.textures,
                prepared,
                model,
            });
        }
        Ok(Self {
            scene: &loaded.scene,
            parts,
        })
    }

    /// Whether anything has a texture.
    #[must_use]
    pub fn are_textured(&self) -> bool {
        self.parts.iter().any(|part| !part.textures.is_empty())
    }

    /// All parts of all objects, by their numbers, in order.
    fn steps(&self) -> Vec<(usize, usize)> {
        let of = |(number, part): (usize, &Placed<'_>)| {
            (0..part.prepared.chunks.len()).map(move |chunk| (number, chunk))
        };
        self.parts.iter().enumerate().flat_map(of).collect()
    }
}

/// Model space to the world; `None` where that leaves the ranges of matrices. What is not said rounds nothing.
fn placed(prepared: &Prepared, item: &Item) -> Option<Affine> {
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    let mut model = Affine::placed(prepared.scale as f32, single(prepared.centre))?;
    if let Some(scale) = item.scale {
        model = model.then(&Affine::placed(scale as f32, [0.0; 3])?);
    }
    if let Some(turn) = item.turn {
        let [x, y, z] = single(turn).map(f32::to_radians);
        model = model
            .then(&Affine::rotation_x(x))
            .then(&Affine::rotation_y(y))
            .then(&Affine::rotation_z(z));
    }
    if let Some(place) = item.place {
        model = model.then(&Affine::placed(1.0, single(place))?);
    }
    Some(model)
}

/// The window of an object, in pixels of a tile.
fn scissor(item: &Item, tile: &Tile) -> Option<Scissor> {
    item.window.map(|cut| {
        let within = |axis: usize, at: u32| {
            let at = at.saturating_sub(tile.first[axis]);
            at.min(u16::MAX.into()) as u16
        };
        let range = |axis: usize, first: u16, count: u16| {
            let end = u32::from(first) + u32::from(count);
            within(axis, first.into())..within(axis, end)
        };
        let (columns, lines) = (range(0, cut.left, cut.width), range(1, cut.top, cut.height));
        match cut.outside {
            true => Scissor::outside(columns, lines),
            false => Scissor::inside(columns, lines),
        }
    })
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
    let task = Task {
        parts,
        job: job(parts, view, crew)?,
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
    let room = room_for(chunks, parts.are_textured(), false);
    Ok(Job::new(view, camera, crew, room))
}

/// A scene of colours, in several lights.
struct Task<'a> {
    parts: &'a SceneParts<'a>,
    job: Job,
    dither: bool,
}

impl Picture for Task<'_> {
    fn is_textured(&self) -> bool {
        self.parts.are_textured()
    }

    fn plain<F: PixelFormat + Sync>(&self) -> Result<Drawn, DrawFailure> {
        self.draw::<Gouraud<F>, F>(&[])
    }

    fn textured<F, T>(&self) -> Result<Drawn, DrawFailure>
    where
        F: PixelFormat + Sync,
        T: PixelFormat<Word = u16>,
        Textured<F>: Look<Pixel = F, Planes: Send>,
        TexturedPhong<F>: Look<Pixel = F, Planes: Send>,
    {
        let parts = &self.parts.parts;
        let texels: Vec<_> = (parts.iter())
            .map(|part| Texels16::of::<T>(part.textures))
            .collect();
        let coarser: Result<Vec<_>, _> = texels.iter().map(Texels16::coarser).collect();
        let coarser = coarser?;
        let mut textures = Vec::new();
        for ((part, texels), coarser) in parts.iter().zip(&texels).zip(&coarser) {
            let skins = Skins {
                set: part.textures,
                filter: part.item.filter.unwrap_or_default(),
                budget: part.budget(),
            };
            textures.push(texels.textures(coarser, skins)?);
        }
        self.draw::<Textured<F>, F>(&textures)
    }
}

impl Task<'_> {
    /// Draws surfaces in several lights, with the textures of each object.
    fn draw<L, F>(&self, textures: &[Vec<Texture<'_>>]) -> Result<Drawn, DrawFailure>
    where
        L: Look<Pixel = F, Planes: Send> + Sync,
        F: PixelFormat + Sync,
    {
        let scene = self.parts.scene;
        let lamps: Option<Vec<DirectionalLight>> = (scene.lights.iter())
            .map(|lamp| {
                let colour = lamp.colour.map(|c| c as f32);
                DirectionalLight::new(unit(lamp.towards), colour)
            })
            .collect();
        let lamps = lamps.ok_or_else(|| DrawFailure::View("a light has no direction".into()))?;
        let material = Material {
            ambient: [U1F15::ONE; 3],
            diffuse: [U1F15::ONE; 3],
            ..Material::default()
        };
        let level = |value: f64| U1F15::from_bits((value * 32_768.0).round() as u16);
        let ambient = level(scene.ambient.unwrap_or(0.2));
        let light = Lighting::new(&lamps, [ambient; 3], material).filter(|_| !lamps.is_empty());
        let worn = Worn {
            parts: self.parts,
            textures,
            lights: light.as_ref().map(|light| light as &dyn Lights),
            dither: self.dither,
        };
        worn.draw_all::<L, F>(&self.job)
    }
}

/// What the parts of a scene have in common.
struct Worn<'s, 't> {
    parts: &'s SceneParts<'s>,
    /// The textures of each object.
    textures: &'t [Vec<Texture<'t>>],
    lights: Option<&'s dyn Lights>,
    dither: bool,
}

impl<'t> Worn<'_, 't> {
    /// Draws all parts of all objects.
    fn draw_all<L, F>(&self, job: &Job) -> Result<Drawn, DrawFailure>
    where
        L: Look<Pixel = F, Planes: Send> + Sync,
        F: PixelFormat + Sync,
    {
        let steps = self.parts.steps();
        let chunk = |(object, chunk): (usize, usize)| -> &Chunk {
            &self.parts.parts[object].prepared.chunks[chunk]
        };
        let counted: Vec<_> = steps.iter().map(|step| Some(chunk(*step))).collect();
        draw_parts::<L, F>(job, &counted, |scene, tile, step, instead| {
            let chunk = instead.unwrap_or_else(|| chunk(steps[step]));
            self.draw(scene, tile, (steps[step].0, chunk))
        })
    }

    /// Draws a part of an object, by its number.
    fn draw<L: Look>(
        &self,
        scene: &mut Scene<'_, 't, L>,
        tile: &Tile,
        (number, chunk): (usize, &Chunk),
    ) -> Result<(), DrawError> {
        let part = &self.parts.parts[number];
        let textures = self.textures.get(number);
        let texture = chunk
            .texture
            .and_then(|texture| textures?.get(usize::from(texture)));
        scene.draw(&Draw {
            model: part.model,
            cull: part.item.cull(),
            lights: self.lights,
            texture: texture.map(|texture| Skin {
                texture,
                places: &chunk.places,
                budget: part.budget(),
            }),
            application: (part.item.application).map_or(Application::Product, Application::from),
            scissor: scissor(part.item, tile),
            depth: part.item.depth(),
            blend: part.item.blend(),
            dither: self.dither,
            priority: self.parts.scene.rank(part.item),
            ..Draw::new(chunk.mesh())
        })
    }
}
