//! A scene of a file as words in flash, for the firmware of the emulated boards: the draw calls that
//! [`draw_scene_file`](crate::draw_scene_file) makes of it, for a display of 16 bits.

use crate::DrawFailure;
use crate::FilterArg;
use crate::prepared::Chunk;
use crate::scene_file::{
    ApplicationKind, BlendKind, CullSide, FormKind, Item, Lamp, Palette, QualityKind, SceneFile,
    ShadeKind,
};
use crate::scenes::{self, SceneParts, directional};
use crate::setting::focal;
use crate::textured::Texels16;
use host_support::reference::View;
use scanbeam::Affine;
use scanbeam::list::{CameraWords, Matrix};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{DepthFunction, LARGEST};
use scene_flash::{Counts, Head, Kind, Room, code};
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
        lights,
        phong,
        doubled,
        palettes,
        objects: _,
    } = parts.scene();
    let shadows = parts.scene().has_shadows();
    refuse(&[
        ("phong", *phong),
        ("doubled", *doubled),
        ("shadows", shadows),
    ])
    .map_err(DrawFailure::View)?;
    let size = sides(*size)?;
    let mut words = Words(Vec::new());
    let mut counts = Counts {
        lights: lights.len() as u32,
        palettes: palettes.len() as u32,
        calls: parts.pieces().count() as u32,
        ..Counts::default()
    };
    words.push(scenes::ambient(parts.scene()).to_bits().into());
    for lamp in lights {
        words.lamp(lamp)?;
    }
    palettes.iter().for_each(|palette| words.palette(palette));
    let first = words.textures(parts, &mut counts);
    for (object, item, model, chunk) in parts.pieces() {
        let texture = chunk
            .texture
            .map_or(0, |number| first[object] + u32::from(number) + 1);
        let call = Call {
            item,
            model,
            chunk,
            texture,
            dither: *dither,
            priority: parts.scene().rank(item),
        };
        let written = words.call(&call);
        written.map_err(|why| DrawFailure::View(format!("object {object}: {why}")))?;
    }
    let head = Head {
        kind: match (palettes.is_empty(), parts.are_textured()) {
            (false, _) => Kind::Indexed,
            (true, true) => Kind::Textured,
            (true, false) => Kind::Smooth,
        },
        size,
        background: background.unwrap_or_default(),
        room: Room::default(),
        camera: camera_words(&parts.scene().view()),
    };
    let length = Head::WORDS + counts.to_words().len() + words.0.len();
    let head = head.to_words(u32::try_from(length).unwrap_or(u32::MAX));
    let objects = parts.pieces().map(|(object, ..)| object).collect();
    Ok(([&head[..], &counts.to_words(), &words.0].concat(), objects))
}

/// Refuses the first field that is said, of those that boards do not draw.
fn refuse(fields: &[(&str, bool)]) -> Result<(), String> {
    match fields.iter().find(|(_, is_said)| *is_said) {
        Some((name, _)) => Err(format!("`{name}` is not drawn on boards")),
        None => Ok(()),
    }
}

/// Columns and lines that boards draw.
fn sides(size: [u32; 2]) -> Result<[u16; 2], DrawFailure> {
    if size.iter().all(|side| *side <= u32::from(LARGEST)) {
        return Ok(size.map(|side| side as u16));
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

/// A part of an object.
struct Call<'a> {
    item: &'a Item,
    model: &'a Affine,
    chunk: &'a Chunk,
    /// Its number plus 1, or 0.
    texture: u32,
    dither: bool,
    priority: u8,
}

impl Call<'_> {
    /// Refuses what boards do not draw.
    fn is_drawn(&self) -> Result<(), String> {
        // As above. All that is not looked at here is in the call, in its code, or in its words.
        let Item {
            model: _,
            scale: _,
            turn: _,
            place: _,
            texture: _,
            computed,
            texels,
            texel_form,
            cached,
            reflection: _,
            // In the words of its textures.
            filter: _,
            // Its pictures have them or not.
            levels: _,
            quality: _,
            application: _,
            shade: _,
            specular,
            // Of no use without highlights, and without shadows.
            shininess: _,
            shadow: _,
            cull: _,
            blend: _,
            alpha: _,
            depth: _,
            writes_depth: _,
            priority: _,
            window: _,
            index: _,
        } = self.item;
        refuse(&[
            ("computed", computed.is_some()),
            ("texels", texels.is_some()),
            (
                "texel_form",
                texel_form.is_some_and(|form| form != FormKind::Words),
            ),
            ("cached", *cached == Some(true)),
            ("specular", specular.is_some()),
        ])
    }

    /// Its first word.
    fn code(&self) -> u32 {
        let item = self.item;
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
        let blend = item.blend.map_or(0, |kind| match kind {
            BlendKind::Filter => code::FILTER,
            BlendKind::Add => code::ADD,
            BlendKind::Subtract => code::SUBTRACT,
        });
        flag(item.cull == Some(CullSide::Back), code::CULL_BACK)
            | flag(item.window.is_some(), code::WINDOW)
            | flag(item.window.is_some_and(|cut| cut.outside), code::OUTSIDE)
            | flag(self.dither, code::DITHER)
            | blend << code::BLEND
            | u32::from(item.alpha.unwrap_or(255)) << code::ALPHA
            | u32::from(self.priority) << code::PRIORITY
            | quality << code::QUALITY
            | application << code::APPLICATION
            | flag(item.shade == Some(ShadeKind::Flat), code::FLAT)
            | flag(item.shade == Some(ShadeKind::None), code::UNLIT)
            | flag(item.reflection == Some(true), code::REFLECTION)
    }
}

/// Words, as `scene_flash` reads them.
struct Words(Vec<u32>);

impl Words {
    fn push(&mut self, word: u32) {
        self.0.push(word);
    }

    /// Bytes, padded to a word.
    fn bytes(&mut self, bytes: impl Iterator<Item = u8>) {
        let bytes: Vec<u8> = bytes.collect();
        self.0.extend(bytes.chunks(4).map(|four| {
            let mut word = [0; 4];
            word[..four.len()].copy_from_slice(four);
            u32::from_le_bytes(word)
        }));
    }

    /// Numbers of 16 bits, padded to a word.
    fn halves(&mut self, halves: impl Iterator<Item = u16>) {
        self.bytes(halves.flat_map(u16::to_le_bytes));
    }

    fn lamp(&mut self, lamp: &Lamp) -> Result<(), DrawFailure> {
        // Its direction and its colour are in the light.
        let Lamp {
            towards: _,
            colour: _,
            // None has them: they are refused before.
            shadows: _,
        } = lamp;
        let light = directional(lamp)?;
        let direction = light.direction.map(|c| c.to_bits() as u16);
        let colour = light.colour.map(|c| c.to_bits());
        self.halves(direction.into_iter().chain(colour));
        Ok(())
    }

    fn palette(&mut self, palette: &Palette) {
        let Palette { from_line, colours } = palette;
        self.push(*from_line);
        let colours = colours.iter().copied();
        let all = colours.chain(std::iter::repeat([0; 3])).take(256);
        self.halves(all.map(Rgb565Be::from_rgb8));
    }

    /// The textures of all objects; the number of the first one of each.
    fn textures(&mut self, parts: &SceneParts<'_>, counts: &mut Counts) -> Vec<u32> {
        let mut first = Vec::new();
        for (item, set) in parts.textures() {
            let mixed = match item.filter {
                Some(FilterArg::Bilinear) => code::MIXED,
                Some(FilterArg::Nearest) | None => 0,
            };
            first.push(counts.textures);
            for levels in Texels16::of::<Rgb565Be>(set).levels() {
                counts.textures += 1;
                counts.levels += levels.len() as u32 - 1;
                self.push(levels.len() as u32 | mixed);
                for ([width, height], texels) in levels {
                    self.push(width | height << 16);
                    self.halves(texels.iter().copied());
                }
            }
        }
        first
    }

    /// A draw call.
    fn call(&mut self, call: &Call<'_>) -> Result<(), String> {
        call.is_drawn()?;
        self.push(call.code());
        let test = call.item.depth();
        if call.texture > u32::from(u16::MAX) {
            return Err("`texture`: boards have at most 65,535".into());
        }
        self.push(bits(test.colour_if) | bits(test.depth_if) << 8 | call.texture << 16);
        let range = |first: u16, count: u16| [first, first.saturating_add(count)];
        let window = call.item.window.map_or([[0; 2]; 2], |cut| {
            [range(cut.left, cut.width), range(cut.top, cut.height)]
        });
        self.halves(window.into_iter().flatten());
        let mesh = call.chunk.mesh();
        self.push(mesh.positions.len() as u32);
        self.push(call.chunk.faces.len() as u32);
        self.matrix(call.model)?;
        let positions = mesh.positions.iter().flatten();
        self.0.extend(positions.map(|c| *c as u32));
        self.halves(mesh.normals.iter().flatten().map(|c| *c as u16));
        self.bytes(mesh.colours.iter().flatten().copied());
        self.halves(call.chunk.faces.iter().flatten().copied());
        if call.texture > 0 {
            let places = call.chunk.places.iter().flatten();
            self.0.extend(places.map(|c| *c as u32));
        }
        Ok(())
    }

    fn matrix(&mut self, model: &Affine) -> Result<(), String> {
        let matrix = Matrix::try_from(model);
        let matrix = matrix.map_err(|_| "`scale` and `place` are too large".to_owned())?;
        self.0.extend(matrix.linear.map(|c| c as u32));
        let exponents = [matrix.linear_exponent, matrix.offset_exponent];
        self.halves(exponents.into_iter().map(|e| e as u16));
        self.0.extend(matrix.offset.map(|c| c as u32));
        Ok(())
    }
}
