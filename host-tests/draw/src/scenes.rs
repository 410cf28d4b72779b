//! Scenes of a file: several models, each with its place, blend, depth function, priority and
//! window, in several lights or in palettes a line.
//!
//! | what the file says | pipeline |
//! |---|---|
//! | neither palettes nor priorities | surfaces with a finish and windows, 32 bits of depth |
//! | `priority` | the same with priorities in place of depth |
//! | `palettes` | flat indices and windows, 32 bits of depth |

use super::prepared::{Dress, Prepared};
use super::textured::{HostTexture, textures};
use super::{
    Bands, CrewSettings, DrawFailure, Drawn, FilterArg, LINES_PER_TRANSFER, Setting, add,
    draw_scenes,
};
use crate::choice::PixelFormatArg;
use crate::scene_file::{BlendKind, DepthKind, Item, Loaded, SceneFile};
use host_support::image_out::Frame;
use host_support::lent::{LineRooms, SceneRooms};
use host_support::mock::{HostLine, MockFrameBuffer};
use host_support::reference::{Cull, View};
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::list::Window;
use scanbeam::mesh::{Material, U1F15};
use scanbeam::pipeline::blend::{DepthFunction, Finish, ShadowError, Surface};
use scanbeam::pipeline::send::draw_frame_indexed;
use scanbeam::pipeline::texture::{DetailedTextures, LevelEnds, Levels, Quality, Skin, Textured};
use scanbeam::pipeline::{
    Auto, Clip, Composited, Counted, Depth32, FlatDepth, FrameStats, Gouraud, Instance, Parts,
    Pipeline, Prioritised, Priority, Scene, Shading, SkinOf, Windowed,
};
use scanbeam::pixel::{Dithered, Index8, PaletteTable, PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scan_out::Pump;
use scanbeam::{Affine, Camera, Link, Screen};

/// Colours linear over faces, times texels in levels of detail.
type Plain<'t, F> = Counted<
    Parts<
        Textured<Gouraud, LevelEnds>,
        Depth32,
        F,
        (),
        Auto,
        DetailedTextures<'t, HostTexture<'t>>,
    >,
>;
/// Surfaces with a finish, cut to windows.
type Finished<'t, F> = Windowed<Composited<Plain<'t, F>>>;
/// Indices of palettes.
type Numbered = Windowed<Counted<FlatDepth<Index8>>>;

/// Steps of the palettes of [`Numbered`].
const PALETTE: usize = 256;

/// A scene in the crate's number formats.
pub struct SceneParts<'a> {
    scene: &'a SceneFile,
    parts: Vec<Placed<'a>>,
    textures: Vec<Levels<HostTexture<'a>>>,
}

/// An object.
struct Placed<'a> {
    item: &'a Item,
    prepared: Prepared,
    model: Affine,
    worn: Worn,
}

/// A finish, and the number of the first of an object's textures.
#[derive(Clone, Copy)]
struct Worn {
    finish: Finish,
    first: u16,
}

impl<P> Dress<P> for Worn
where
    P: Pipeline<Shading: for<'a> Shading<Skin<'a> = Surface<'a, Skin<'a>>>>,
{
    fn dress<'a>(&self, skin: Skin<'a>) -> SkinOf<'a, P> {
        let texture = match skin.texture {
            Skin::TEXTURES => Skin::TEXTURES,
            number => number + self.first,
        };
        Surface {
            skin: Skin { texture, ..skin },
            finish: self.finish,
            alphas: &[],
        }
    }
}

impl<'a> SceneParts<'a> {
    /// Rounds the models of a scene.
    ///
    /// # Errors
    /// A model that is too large or too far away.
    pub fn new(loaded: &'a Loaded) -> Result<Self, DrawFailure> {
        let mut all = Vec::new();
        let mut parts = Vec::new();
        for (number, part) in loaded.parts.iter().enumerate() {
            let item = &part.item;
            let mut prepared = Prepared::textured(&part.model, &part.textures, Quality::default());
            if loaded.scene.has_palettes() {
                prepared.paint(Index8::colour(item.index.unwrap_or(0)));
            }
            let model = placed(&prepared, item).ok_or_else(|| {
                DrawFailure::View(format!("object {number} is too large, or too far away"))
            })?;
            let worn = Worn {
                finish: finish(item),
                first: all.len() as u16,
            };
            all.extend(textures(&part.textures, FilterArg::Nearest)?);
            if all.len() > usize::from(Skin::TEXTURES) {
                return Err(DrawFailure::View("the scene has too many textures".into()));
            }
            parts.push(Placed {
                item,
                prepared,
                model,
                worn,
            });
        }
        Ok(Self {
            scene: &loaded.scene,
            parts,
            textures: all,
        })
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

fn finish(item: &Item) -> Finish {
    let alpha = item.alpha.unwrap_or(255);
    let mut finish = match item.blend {
        None => Finish::OPAQUE,
        Some(BlendKind::Filter) => Finish::filtered(alpha),
        Some(BlendKind::Add) => Finish::additive(alpha),
        Some(BlendKind::Subtract) => Finish::subtractive(alpha),
    };
    let writes = item.writes_depth.unwrap_or(item.blend.is_none());
    finish.colour_if = item.depth.map_or(finish.colour_if, function);
    finish.depth_if = match writes {
        true => finish.colour_if,
        false => DepthFunction::NEVER,
    };
    finish
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

fn clip(item: &Item) -> Clip {
    let Some(cut) = item.window else {
        return Clip::Picture;
    };
    let window = Window {
        left: cut.left,
        top: cut.top,
        right: cut.left.saturating_add(cut.width),
        bottom: cut.top.saturating_add(cut.height),
    };
    match cut.outside {
        true => Clip::Outside(window),
        false => Clip::Inside(window),
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
    let (palettes, ranks) = (parts.scene.has_palettes(), parts.scene.has_priorities());
    match (format, palettes, ranks) {
        (PixelFormatArg::Rgb888, true, _) => by_palettes::<Rgb888>(parts, view, crew),
        (PixelFormatArg::Rgb565, true, _) => by_palettes::<Rgb565Be>(parts, view, crew),
        (PixelFormatArg::Rgb888, _, true) => by_priority::<Rgb888>(parts, view, crew),
        (PixelFormatArg::Rgb565, _, true) => by_priority::<Rgb565Be>(parts, view, crew),
        (PixelFormatArg::Rgb888, ..) => by_depth::<Rgb888>(parts, view, crew),
        (PixelFormatArg::Rgb565, ..) => by_depth::<Rgb565Be>(parts, view, crew),
        (PixelFormatArg::Dithered565, ..) => by_depth::<Dithered<Rgb565Be>>(parts, view, crew),
        _ => Err(super::formats::refused("scenes are drawn")),
    }
}

/// The camera of a view, and nothing that is one model's.
fn setting(view: &View) -> Result<Setting, DrawFailure> {
    let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    let focal = f64::from(view.height) / 2.0 / (view.fov.to_radians() / 2.0).tan();
    let (near, far) = (view.near as f32, view.far as f32);
    let places = [view.eye, view.at, view.up].map(single);
    let camera = Camera::look_at(places[0], places[1], places[2], focal as f32, near, far);
    Ok(Setting {
        screen: Screen::new(view.width as u16, view.height as u16).map_err(|e| bad(&e))?,
        camera: camera.map_err(|e| bad(&e))?,
        instance: Instance::default(),
    })
}

/// Memory for any scene: what finds no room is drawn in bands.
fn rooms<P: Pipeline>(view: &View) -> SceneRooms<P> {
    SceneRooms::new(1 << 16, usize::from(Link::CACHED), view.height as usize)
}

fn cull(item: &Item) -> scanbeam::Cull {
    match item.cull.map(Cull::from) {
        Some(Cull::Back) => scanbeam::Cull::Back,
        Some(Cull::None) | None => scanbeam::Cull::None,
    }
}

/// Surfaces with a finish, by depth.
fn by_depth<F>(
    parts: &SceneParts<'_>,
    view: &View,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure>
where
    F: PixelFormat,
    for<'t> DetailedTextures<'t, HostTexture<'t>>: scanbeam::pipeline::texture::TextureSource<F>,
{
    by::<Finished<'_, F>>(parts, view, crew, |_, _| {})
}

/// The same by priority.
fn by_priority<F>(
    parts: &SceneParts<'_>,
    view: &View,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure>
where
    F: PixelFormat,
    for<'t> DetailedTextures<'t, HostTexture<'t>>: scanbeam::pipeline::texture::TextureSource<F>,
{
    let rank = |scene: &mut Scene<'_, Prioritised<Finished<'_, F>>>, item: &Item| {
        scene.set_priority(Priority(item.priority.unwrap_or(0)));
    };
    by::<Prioritised<Finished<'_, F>>>(parts, view, crew, rank)
}

/// Surfaces with a finish in several lights; `rank` gives each its priority, where there are any.
fn by<'t, P>(
    parts: &'t SceneParts<'t>,
    view: &View,
    crew: CrewSettings,
    rank: impl Fn(&mut Scene<'_, P>, &Item),
) -> Result<Drawn, DrawFailure>
where
    P: Pipeline<
            Shading: for<'a> Shading<Skin<'a> = Surface<'a, Skin<'a>>>,
            Textures = DetailedTextures<'t, HostTexture<'t>>,
        >,
{
    let level = |value: f64| U1F15::from_bits((value * 32_768.0).round() as u16);
    let lamps: Option<Vec<DirectionalLight>> = (parts.scene.lights.iter())
        .map(|lamp| {
            let largest = lamp.towards.iter().fold(0.0f64, |m, c| m.max(c.abs()));
            let towards = lamp.towards.map(|c| (c / largest) as f32);
            DirectionalLight::new(towards, lamp.colour.map(|c| c as f32))
        })
        .collect();
    let lamps = lamps.ok_or_else(|| DrawFailure::View("a light has no direction".into()))?;
    let material = Material {
        ambient: [U1F15::ONE; 3],
        diffuse: [U1F15::ONE; 3],
        ..Material::default()
    };
    let ambient = level(parts.scene.ambient.unwrap_or(0.2));
    let light = Lighting::new(&lamps, [ambient; 3], material).filter(|_| !lamps.is_empty());
    let steps = steps(parts);
    let build = |scene: &mut Scene<'_, P>, step: usize, alone: bool| {
        let (part, chunk) = steps[step];
        scene.set_clip(clip(part.item));
        rank(scene, part.item);
        let instance = Instance {
            model: part.model,
            cull: cull(part.item),
            light,
            colour: [255; 3],
        };
        let done = part.prepared.chunks[chunk].draw(scene, (&instance, &part.worn), alone);
        done.map_err(ShadowError::Draw)
    };
    let mut rooms = rooms::<P>(view);
    rooms.textures = DetailedTextures(&parts.textures);
    let setting = setting(view)?;
    draw_scenes::<P>((None, &setting, rooms), (view, crew), (steps.len(), build))
}

/// The chunks of all objects, in order.
fn steps<'p>(parts: &'p SceneParts<'_>) -> Vec<(&'p Placed<'p>, usize)> {
    let of = |part: &'p Placed<'p>| (0..part.prepared.chunks.len()).map(move |i| (part, i));
    parts.parts.iter().flat_map(of).collect()
}

/// Indices, and a palette for each line; by one renderer.
fn by_palettes<F: PixelFormat>(
    parts: &SceneParts<'_>,
    view: &View,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    let steps = steps(parts);
    let build = |scene: &mut Scene<'_, Numbered>, step: usize, alone: bool| {
        let (part, chunk) = steps[step];
        scene.set_clip(clip(part.item));
        let instance = Instance {
            model: part.model,
            cull: cull(part.item),
            ..Instance::default()
        };
        let done = part.prepared.chunks[chunk].draw(scene, (&instance, &()), alone);
        done.map_err(ShadowError::Draw)
    };
    let (width, height) = (view.width as u16, view.height as u16);
    let (palettes, of_line) = palettes::<F>(parts.scene, view.height);
    let table = PaletteTable::new(&palettes, &of_line)
        .ok_or_else(|| DrawFailure::View("there are no palettes".into()))?;
    let mut rooms = rooms::<Numbered>(view);
    let mut lines = LineRooms::<Numbered>::new(crew.slots, rooms.objects(), width.into());
    let fast_bytes = lines.fast_bytes();
    let mut renderer = lines.renderer();
    renderer.set_prefetch(crew.prefetch);
    let transfer = LINES_PER_TRANSFER.min(height);
    let words = usize::from(width) * usize::from(transfer);
    let sink = MockFrameBuffer::<F::Word>::new(width, height);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let mut indices = vec![0; usize::from(width)];
    let (mut stats, mut slow_bytes) = (FrameStats::default(), 0);
    let all = (&mut rooms, 0..height);
    let bands: Bands = setting(view)?.bands_of(all, (steps.len(), build), |scene| {
        let by = (&mut indices[..], table);
        let band = draw_frame_indexed(scene, &mut renderer, &mut pump, 0, transfer, by);
        add(&mut stats, &band.map_err(DrawFailure::Display)?);
        slow_bytes = slow_bytes.max(scene.bytes());
        Ok(())
    })?;
    let pixels = pump.sink().frame().map_err(DrawFailure::Incomplete)?;
    let rgb = pixels.into_iter().flat_map(F::to_rgb8).collect();
    Ok(Drawn {
        frame: Frame::new(view.width, view.height, rgb)
            .ok_or_else(|| DrawFailure::View("the picture has another size".into()))?,
        stats,
        bands: bands.count,
        overfull: bands.overfull,
        slow_bytes,
        fast_bytes,
        line_bytes: 2 * words * size_of::<F::Word>() + indices.len(),
    })
}

/// The palettes of a scene, and which of them each line of a picture of this height has: of one of
/// another height than the file's, the lines in proportion.
fn palettes<F: PixelFormat>(scene: &SceneFile, height: u32) -> (Vec<[F::Word; PALETTE]>, Vec<u8>) {
    let black = F::from_rgb8([0; 3]);
    let filled = |colours: &Vec<[u8; 3]>| {
        let mut words = [black; PALETTE];
        for (word, colour) in words.iter_mut().zip(colours) {
            *word = F::from_rgb8(*colour);
        }
        words
    };
    let words = scene.palettes.iter().map(|p| filled(&p.colours)).collect();
    let number = |line: u32| {
        let line = u64::from(line) * u64::from(scene.size[1]) / u64::from(height);
        let begun = scene
            .palettes
            .iter()
            .filter(|p| u64::from(p.from_line) <= line);
        (begun.count() - 1) as u8
    };
    (words, (0..height).map(number).collect())
}
