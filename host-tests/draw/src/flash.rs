//! A scene of a file as words in flash, for the firmware of the emulated boards: the draw calls that
//! [`draw_scene_file`](crate::draw_scene_file) makes of it, for a display of 16 bits.

use crate::DrawFailure;
use crate::prepared::{Chunk, ShadowMesh};
use crate::scene_file::{
    ApplicationKind, BlendKind, CullSide, FactorKind, Item, Palette, QualityKind, SceneFile,
    ShadeKind,
};
use crate::scenes::{self, SceneParts, Side, Step, TextureWords, What, directional, material};
use crate::setting::focal;
use crate::words::Words;
use host_support::reference::View;
use scanbeam::Affine;
use scanbeam::light::DirectionalLight;
use scanbeam::list::CameraWords;
use scanbeam::mesh::Material;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{DepthFunction, LARGEST, ShadowLight};
use scene_flash::{Counts, Head, Kind, LightCounts, Room, code};
use std::cmp::Ordering;

/// The words of a scene that is seen as its file says. They say nothing of the memory that it needs. Also the
/// object of each draw call, by its number.
///
/// # Errors
/// What is larger than boards draw, or beyond what the words can hold.
pub fn flash_words(parts: &SceneParts<'_>) -> Result<(Vec<u32>, Vec<usize>), DrawFailure> {
    // A field that this does not know does not compile: it would be left out of what boards draw.
    let SceneFile {
        size,
        // They are sent 16 bits.
        format: _,
        dither,
        background,
        camera: _,
        ambient: _,
        lights: _,
        phong,
        doubled,
        palettes,
        objects: _,
    } = parts.scene();
    let textures = TextureWords::of::<Rgb565Be>(parts.textures())?;
    let steps = parts.steps();
    let shadows = parts.shadow_lights()?;
    let lit = Lit::new(parts, &steps)?;
    let volumes: Vec<&ShadowMesh> = steps.iter().filter_map(|step| parts.volume(step)).collect();
    let counts = Counts {
        lights: lit.counts(*phong),
        textures: textures.counts,
        palettes: palettes.len() as u32,
        calls: steps.len() as u32,
        volumes: volumes.len() as u32,
        thrown: volumes
            .iter()
            .map(|mesh| mesh.faces.len() as u32)
            .max()
            .unwrap_or(0),
    };
    let mut words = Words::default();
    words.push(scenes::ambient(parts.scene()).to_bits().into());
    lit.write(&mut words);
    palettes
        .iter()
        .for_each(|palette| write_palette(&mut words, palette));
    words.append(textures.words.all().iter().copied());
    for step in &steps {
        let call = Call::new(parts, step, &textures, &lit, *dither);
        let written = match (call, parts.volume(step), &shadows[step.object]) {
            (Some(call), ..) => call.write(&mut words),
            (None, Some(mesh), Some(light)) => {
                write_volume(&mut words, mesh, parts.model(step.object), light)
            }
            (None, ..) => Err("its shadow has no light".into()),
        };
        written.map_err(|why| DrawFailure::View(format!("object {}: {why}", step.object)))?;
    }
    check_sides(*size)?;
    let view = parts.drawn_view();
    let head = Head {
        kind: match (palettes.is_empty(), parts.are_textured(), phong) {
            (false, ..) => Kind::Indexed,
            (true, true, false) => Kind::Textured,
            (true, false, false) => Kind::Smooth,
            (true, true, true) => Kind::TexturedPhong,
            (true, false, true) => Kind::Phong,
        },
        size: [view.width, view.height].map(|side| side as u16),
        doubled: *doubled,
        background: background.unwrap_or_default(),
        room: Room::default(),
        camera: camera_words(&view),
    };
    let length = Head::WORDS + Counts::WORDS + words.all().len();
    let head = head.to_words(u32::try_from(length).unwrap_or(u32::MAX));
    let objects = steps.iter().map(|step| step.object).collect();
    Ok((
        [&head[..], &counts.to_words(), words.all()].concat(),
        objects,
    ))
}

/// Refuses more columns and lines than boards show.
fn check_sides(size: [u32; 2]) -> Result<(), DrawFailure> {
    if size.iter().all(|side| *side <= u32::from(LARGEST)) {
        return Ok(());
    }
    let [width, height] = size;
    Err(DrawFailure::View(format!(
        "`size` is {width} x {height}: boards draw at most {LARGEST} columns and lines at once"
    )))
}

/// The camera of a view, as [`draw_scene_file`](crate::draw_scene_file) has it.
#[must_use]
pub fn camera_words(view: &View) -> CameraWords {
    let [eye, at, up] = [view.eye, view.at, view.up].map(|v| v.map(|c| c as f32));
    CameraWords {
        eye,
        at,
        up,
        focal: focal(view),
        near: view.near as f32,
        far: view.far as f32,
    }
}

/// The bits of a function, as its constants are numbered.
fn bits(function: DepthFunction) -> u32 {
    let orders = [Ordering::Less, Ordering::Equal, Ordering::Greater];
    (0..).zip(orders).fold(0, |bits, (n, order)| {
        bits | u32::from(function.passes(order)) << n
    })
}

/// The lights of a scene, and what falls of them on its surfaces.
struct Lit {
    /// Those of what is in their light, then those of what is in the shadow.
    lights: Vec<DirectionalLight>,
    /// How many are the former.
    in_light: usize,
    /// Without those that throw shadows, and of what material.
    surfaces: Vec<(Side, Material)>,
}

impl Lit {
    fn new(parts: &SceneParts<'_>, steps: &[Step]) -> Result<Self, DrawFailure> {
        let lamps = &parts.scene().lights;
        let all = lamps
            .iter()
            .chain(lamps.iter().filter(|lamp| !lamp.shadows));
        let lights: Vec<_> = all.map(directional).collect::<Result<_, _>>()?;
        let mut lit = Self {
            lights,
            in_light: lamps.len(),
            surfaces: Vec::new(),
        };
        for step in steps {
            let surface = lit.surface(parts.item(step.object), step);
            if let Some(surface) = surface.filter(|surface| !lit.surfaces.contains(surface)) {
                lit.surfaces.push(surface);
            }
        }
        Ok(lit)
    }

    /// What light falls on, unless it is none.
    fn surface(&self, item: &Item, step: &Step) -> Option<(Side, Material)> {
        let is_seen = !matches!(step.what, What::Volume(_));
        let is_lit = self.in_light > 0 && item.shade != Some(ShadeKind::None);
        (is_seen && is_lit).then(|| (step.side(), material(item)))
    }

    /// The number of a surface, plus 1, or 0.
    fn number(&self, item: &Item, step: &Step) -> u32 {
        let surface = self.surface(item, step);
        let at = surface.and_then(|own| self.surfaces.iter().position(|one| *one == own));
        at.map_or(0, |at| at as u32 + 1)
    }

    fn counts(&self, phong: bool) -> LightCounts {
        let lightings = self.surfaces.len() as u32;
        LightCounts {
            lights: self.lights.len() as u32,
            lightings,
            lamps: if phong { lightings } else { 0 },
        }
    }

    fn write(&self, words: &mut Words) {
        for light in &self.lights {
            let direction = light.direction.map(|c| c.to_bits() as u16);
            let colour = light.colour.map(|c| c.to_bits());
            words.halves(direction.into_iter().chain(colour));
        }
        for (side, material) in &self.surfaces {
            let (first, end) = match side {
                Side::Lit => (0, self.in_light),
                Side::Dark => (self.in_light, self.lights.len()),
            };
            let [r, g, b] = material.specular.map(|level| level.to_bits());
            let range = [first, end - first].map(|n| n as u16);
            words.halves(range.into_iter().chain([r, g, b, material.shininess]));
        }
    }
}

fn write_palette(words: &mut Words, palette: &Palette) {
    let Palette { from_line, colours } = palette;
    words.push(*from_line);
    let colours = colours.iter().copied();
    let all = colours.chain(std::iter::repeat([0; 3])).take(256);
    words.halves(all.map(Rgb565Be::from_rgb8));
}

/// The shadow of an object.
fn write_volume(
    words: &mut Words,
    mesh: &ShadowMesh,
    model: &Affine,
    light: &ShadowLight,
) -> Result<(), String> {
    words.push(code::VOLUME);
    let direction = light.direction.map(|c| c.to_bits() as u16);
    words.halves(direction.into_iter().chain([light.reach.into()]));
    words.append([mesh.positions.len() as u32, mesh.faces.len() as u32]);
    words.matrix(model)?;
    words.append(mesh.positions.iter().flatten().map(|c| *c as u32));
    words.halves(mesh.faces.iter().flatten().copied());
    Ok(())
}

/// What a colour is multiplied by.
fn factor(kind: FactorKind) -> u32 {
    let constant = |part: u8| code::CONSTANT | u32::from(part) << 8;
    match kind {
        FactorKind::Zero => constant(0),
        FactorKind::One => constant(255),
        FactorKind::Constant(part) => constant(part),
        FactorKind::Destination => code::DESTINATION,
        FactorKind::InverseDestination => code::INVERSE_DESTINATION,
        FactorKind::TextureAlpha => code::TEXTURE_ALPHA,
        FactorKind::InverseTextureAlpha => code::INVERSE_TEXTURE_ALPHA,
    }
}

/// A part of an object.
struct Call<'a> {
    item: &'a Item,
    model: &'a Affine,
    chunk: &'a Chunk,
    colour: [u8; 3],
    /// Its number plus 1, or 0.
    texture: u32,
    /// The number of what falls on it, plus 1, or 0.
    lit: u32,
    side: Side,
    phong: bool,
    dither: bool,
    priority: u8,
}

impl<'a> Call<'a> {
    /// What a step draws, unless it is a volume.
    fn new(
        parts: &'a SceneParts<'_>,
        step: &Step,
        textures: &TextureWords,
        lit: &Lit,
        dither: bool,
    ) -> Option<Self> {
        let (item, chunk) = (parts.item(step.object), parts.chunk(step)?);
        let first = textures.first[step.object];
        Some(Self {
            item,
            model: parts.model(step.object),
            chunk,
            colour: parts.colour(step.object, chunk.look),
            texture: (chunk.texture).map_or(0, |number| first + u32::from(number) + 1),
            lit: lit.number(item, step),
            side: step.side(),
            phong: parts.scene().phong,
            dither,
            priority: parts.scene().rank(item),
        })
    }

    /// Its first word.
    fn code(&self) -> u32 {
        // As above. All that is not looked at here is in the matrix, in its textures, or in what falls on it.
        let item = self.item;
        let Item {
            model: _,
            scale: _,
            turn: _,
            place: _,
            texture: _,
            computed: _,
            texels: _,
            texel_form: _,
            cached: _,
            reflection: _,
            filter: _,
            levels: _,
            quality: _,
            application: _,
            shade: _,
            specular: _,
            shininess: _,
            // It has volumes or not.
            shadow: _,
            cull: _,
            blend: _,
            alpha: _,
            channels: _,
            depth: _,
            writes_depth: _,
            priority: _,
            window: _,
            // Its colours are indices.
            index: _,
            source: _,
        } = item;
        let flag = |is: bool, bit: u32| if is { bit } else { 0 };
        let quality = item.quality.map_or(0, |kind| match kind {
            QualityKind::Balanced => 0,
            QualityKind::Fast => code::FAST,
            QualityKind::Exact => code::EXACT,
        });
        let application = item.application.map_or(0, |kind| match kind {
            ApplicationKind::Product => 0,
            ApplicationKind::Replace => code::REPLACE,
            ApplicationKind::Decal => code::DECAL,
        });
        flag(item.cull == Some(CullSide::Back), code::CULL_BACK)
            | flag(item.window.is_some(), code::WINDOW)
            | flag(item.window.is_some_and(|cut| cut.outside), code::OUTSIDE)
            | flag(self.dither, code::DITHER)
            | u32::from(self.priority) << code::PRIORITY
            | quality << code::QUALITY
            | application << code::APPLICATION
            | flag(item.shade == Some(ShadeKind::Flat), code::FLAT)
            | flag(self.side == Side::Dark, code::SHADOWED)
            | flag(item.reflection == Some(true), code::REFLECTION)
    }

    /// How it and what is behind it become one.
    fn blend(&self) -> [u32; 2] {
        let item = self.item;
        let (mode, factors) = match item.blend {
            None if item.channels.is_none() => return [0; 2],
            None => (code::REPLACES, [0; 2]),
            Some(BlendKind::Filter) => (code::FILTER, [0; 2]),
            Some(BlendKind::Half) => (code::HALF, [0; 2]),
            Some(BlendKind::Add) => (code::ADD, [0; 2]),
            Some(BlendKind::Subtract) => (code::SUBTRACT, [0; 2]),
            Some(BlendKind::Factors {
                source,
                destination,
            }) => (code::FACTORS, [source, destination].map(factor)),
        };
        let [red, green, blue] = item.channels.unwrap_or([true; 3]).map(u32::from);
        let channels = red | green << 1 | blue << 2;
        let alpha = u32::from(item.alpha.unwrap_or(255));
        [
            mode | channels << code::CHANNELS | alpha << code::ALPHA,
            factors[0] | factors[1] << 16,
        ]
    }

    /// Its words.
    fn write(&self, words: &mut Words) -> Result<(), String> {
        words.push(self.code());
        let test = self.side.depth(self.item);
        if self.texture > u32::from(u16::MAX) {
            return Err("`texture`: boards have at most 65,535".into());
        }
        words.push(bits(test.colour_if) | bits(test.depth_if) << 8 | self.texture << 16);
        words.append(self.blend());
        words.colour(self.colour);
        let source = self.item.source.map_or(0, |source| u32::from(source) + 1);
        words.push(self.lit | source << 16);
        let range = |first: u16, count: u16| [first, first.saturating_add(count)];
        let window = self.item.window.map_or([[0; 2]; 2], |cut| {
            [range(cut.left, cut.width), range(cut.top, cut.height)]
        });
        words.halves(window.into_iter().flatten());
        let mesh = self.chunk.mesh();
        let colours = if self.phong { &[] } else { mesh.colours };
        let tables = [self.chunk.faces.len(), mesh.normals.len(), colours.len()];
        words.push(mesh.positions.len() as u32);
        words.append(tables.map(|count| count as u32));
        words.matrix(self.model)?;
        words.append(mesh.positions.iter().flatten().map(|c| *c as u32));
        words.halves(mesh.normals.iter().flatten().map(|c| *c as u16));
        words.bytes(colours.iter().flatten().copied());
        words.halves(self.chunk.faces.iter().flatten().copied());
        if self.texture > 0 {
            let places = self.chunk.places.iter().flatten();
            words.append(places.map(|c| *c as u32));
        }
        Ok(())
    }
}
