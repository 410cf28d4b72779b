//! Scenes of a file by draw calls: several models, each with its place, blend, depth function, priority and window, in
//! several lights or in palettes a line.

use crate::choice::PixelFormatArg;
use crate::formats::{Picture, draw_in, refused};
use crate::parts::{Job, Tile, draw_parts, room_for};
use crate::prepared::Chunk;
use crate::scene_file::{BlendKind, DepthKind, Item, Loaded, SceneFile};
use crate::setting::{focal, unit};
use crate::textured::Texels16;
use crate::{CrewSettings, DrawFailure, Drawn, FilterArg, Prepared, Skins, TextureSet};
use host_support::image_out::Frame;
use host_support::reference::{Cull, View};
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::look::{Gouraud, Look, Textured, TexturedPhong};
use scanbeam::mesh::{Material, U1F15};
use scanbeam::pixel::{Index8, PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{
    Blend, BlendMode, Budget, DepthFunction, DepthTest, DrawError, LARGEST, Lights, Scissor, Skin,
    Texture,
};
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

    /// What the file says.
    pub(crate) fn scene(&self) -> &'a SceneFile {
        self.scene
    }

    /// The textures of each object.
    pub(crate) fn textures(&self) -> impl Iterator<Item = &'a TextureSet> {
        self.parts.iter().map(|part| part.textures)
    }

    /// All parts of all objects in order: the object's number, what the file says of it, where it stands, and the part.
    pub(crate) fn pieces(&self) -> impl Iterator<Item = (usize, &Item, &Affine, &Chunk)> {
        let of = |(object, chunk): (usize, usize)| {
            let part = &self.parts[object];
            let chunk = &part.prepared.chunks[chunk];
            (object, part.item, &part.model, chunk)
        };
        self.steps().into_iter().map(of)
    }

    /// All parts of all objects, by their numbers, in order.
    fn steps(&self) -> Vec<(usize, usize)> {
        let of = |(number, part): (usize, &Placed<'_>)| {
            (0..part.prepared.chunks.len()).map(move |chunk| (number, chunk))
        };
        self.parts.iter().enumerate().flat_map(of).collect()
    }
}

/// Model space to the world; `None` where that leaves the ranges of matrices.
fn placed(prepared: &Prepared, item: &Item) -> Option<Affine> {
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    let turn = single(item.turn.unwrap_or_default()).map(f32::to_radians);
    let model = Affine::placed(prepared.scale as f32, single(prepared.centre))?
        .then(&Affine::placed(item.scale.unwrap_or(1.0) as f32, [0.0; 3])?)
        .then(&Affine::rotation_x(turn[0]))
        .then(&Affine::rotation_y(turn[1]))
        .then(&Affine::rotation_z(turn[2]));
    let place = single(item.place.unwrap_or_default());
    Some(model.then(&Affine::placed(1.0, place)?))
}

fn blend(item: &Item) -> Option<Blend> {
    let alpha = item.alpha.unwrap_or(255);
    item.blend.map(|kind| match kind {
        BlendKind::Filter => Blend::filter(alpha),
        BlendKind::Add => Blend::add(alpha),
        BlendKind::Subtract => Blend::new(BlendMode::Subtract(alpha)),
    })
}

pub(crate) fn depth(item: &Item) -> DepthTest {
    let test = item
        .depth
        .map_or(DepthTest::HIDES, |kind| DepthTest::new(function(kind)));
    match item.writes_depth {
        Some(false) => test.without_write(),
        _ => test,
    }
}

fn function(kind: DepthKind) -> DepthFunction {
    match kind {
        DepthKind::Never => DepthFunction::NEVER,
        DepthKind::Farther => DepthFunction::FARTHER,
        DepthKind::Equal => DepthFunction::EQUAL,
        DepthKind::FartherOrEqual => DepthFunction::FARTHER_OR_EQUAL,
        DepthKind::Nearer => DepthFunction::NEARER,
        DepthKind::Different => DepthFunction::DIFFERENT,
        DepthKind::NearerOrEqual => DepthFunction::NEARER_OR_EQUAL,
        DepthKind::Always => DepthFunction::ALWAYS,
    }
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

fn cull(item: &Item) -> scanbeam::Cull {
    match item.cull.map(Cull::from) {
        Some(Cull::Back) => scanbeam::Cull::Back,
        Some(Cull::None) | None => scanbeam::Cull::None,
    }
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
        (PixelFormatArg::Rgb888, true) => by_palettes::<Rgb888>(parts, &task.job),
        (PixelFormatArg::Rgb565, true) => by_palettes::<Rgb565Be>(parts, &task.job),
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
        let sets = || self.parts.parts.iter().map(|part| part.textures);
        let texels: Vec<_> = sets().map(Texels16::of::<T>).collect();
        let coarser: Result<Vec<_>, _> = texels.iter().map(Texels16::coarser).collect();
        let coarser = coarser?;
        let mut textures = Vec::new();
        for ((set, texels), coarser) in sets().zip(&texels).zip(&coarser) {
            let skins = Skins {
                set,
                filter: FilterArg::Nearest,
                budget: Budget::BALANCED,
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
            cull: cull(part.item),
            lights: self.lights,
            texture: texture.map(|texture| Skin {
                texture,
                places: &chunk.places,
                budget: Budget::BALANCED,
            }),
            scissor: scissor(part.item, tile),
            depth: depth(part.item),
            blend: blend(part.item),
            dither: self.dither,
            priority: self.parts.scene.rank(part.item),
            ..Draw::new(chunk.mesh())
        })
    }
}

/// Indices, which become colours by the palette of each line.
fn by_palettes<F: PixelFormat>(parts: &SceneParts<'_>, job: &Job) -> Result<Drawn, DrawFailure> {
    let worn = Worn {
        parts,
        textures: &[],
        lights: None,
        dither: false,
    };
    let indices = Job {
        background: Index8::colour(0),
        ..*job
    };
    let mut drawn = worn.draw_all::<Gouraud<Index8>, Index8>(&indices)?;
    let [width, height] = job.size;
    let palettes = &parts.scene.palettes;
    let lines = drawn.frame.rgb().chunks_exact(3 * width as usize);
    let rgb = (0..height).zip(lines).flat_map(|(line, row)| {
        let palette = &palettes[palette_of(parts.scene, line, height)].colours;
        let colour = |index: u8| palette.get(usize::from(index)).copied().unwrap_or([0; 3]);
        // An index is a level of grey.
        row.chunks_exact(3)
            .flat_map(move |pixel| F::to_rgb8(F::from_rgb8(colour(pixel[0]))))
    });
    drawn.frame = Frame::new(width, height, rgb.collect())
        .ok_or_else(|| DrawFailure::View("the picture has another size".into()))?;
    let word = size_of::<F::Word>();
    // The line that is drawn has a byte a pixel; what is sent of it, a word.
    drawn.used.scan_out.bytes_sent *= word as u64;
    drawn.figures.line_bytes = drawn.figures.line_bytes * word + width.min(LARGEST.into()) as usize;
    Ok(drawn)
}

/// The palette of a line of a picture of this height: of one of another height than the file's, the lines in proportion.
fn palette_of(scene: &SceneFile, line: u32, height: u32) -> usize {
    let line = u64::from(line) * u64::from(scene.size[1]) / u64::from(height);
    let begun = (scene.palettes.iter()).filter(|palette| u64::from(palette.from_line) <= line);
    begun.count() - 1
}
