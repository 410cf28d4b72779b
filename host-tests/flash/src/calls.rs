//! Draw calls in words, behind the head:
//!
//! 1. [`Counts`]: 5 words,
//! 2. the light from everywhere: 1 word, and lights: 3 words each,
//! 3. palettes: the first line and 256 words of the panel each,
//! 4. textures: a word of how many levels and how texels are taken, and of each the sides and its words of the panel,
//! 5. calls: see [`Calls::read`].

use crate::reader::{FlashError, Reader};
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::list::Matrix;
use scanbeam::mesh::{I2F14, Material, U1F15};
use scanbeam::scene::{
    Application, Blend, BlendMode, Budget, DepthFunction, DepthTest, Sampling, Scissor, Shading,
    Skin, TexGen, Texture,
};
use scanbeam::{Affine, Cull, Draw, Faces, Mesh};

/// How values of a call are written.
pub mod code {
    /// In the first word: what shows its back is dropped.
    pub const CULL_BACK: u32 = 1;
    /// There is a window.
    pub const WINDOW: u32 = 2;
    /// What is outside of it is kept.
    pub const OUTSIDE: u32 = 4;
    /// It is dithered.
    pub const DITHER: u32 = 8;
    /// What is behind shines through: where the blend is, 0 for none.
    pub const FILTER: u32 = 1;
    /// It is added.
    pub const ADD: u32 = 2;
    /// It is taken away.
    pub const SUBTRACT: u32 = 3;
    /// The lowest bit of the blend.
    pub const BLEND: u32 = 4;
    /// The lowest bit of the alpha.
    pub const ALPHA: u32 = 8;
    /// The lowest bit of the priority.
    pub const PRIORITY: u32 = 16;
    /// The lowest bit of the quality, 0 for balanced.
    pub const QUALITY: u32 = 24;
    /// Places may be off by half a texel.
    pub const FAST: u32 = 1;
    /// By a hundredth.
    pub const EXACT: u32 = 2;
    /// The lowest bit of the application, 0 for the product.
    pub const APPLICATION: u32 = 26;
    /// Texels hide colours.
    pub const REPLACE: u32 = 1;
    /// They do where they are not transparent.
    pub const DECAL: u32 = 2;
    /// Light falls on each face as a whole.
    pub const FLAT: u32 = 1 << 28;
    /// No light falls on it.
    pub const UNLIT: u32 = 1 << 29;
    /// Places on its texture are made of normals.
    pub const REFLECTION: u32 = 1 << 30;
    /// Of a texture, beside how many levels it has: its texels are mixed.
    pub const MIXED: u32 = 1 << 16;
}

/// How many there are of what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Lights.
    pub lights: u32,
    /// Palettes.
    pub palettes: u32,
    /// Textures.
    pub textures: u32,
    /// Levels of detail below the first, of all textures.
    pub levels: u32,
    /// Draw calls.
    pub calls: u32,
}

impl Counts {
    /// What is behind the head.
    ///
    /// # Errors
    /// When it ends too early.
    pub fn read(reader: &mut Reader<'_>) -> Result<Self, FlashError> {
        let [lights, palettes, textures, levels, calls] = reader.array()?;
        Ok(Self {
            lights,
            palettes,
            textures,
            levels,
            calls,
        })
    }

    /// Its words.
    #[must_use]
    pub fn to_words(self) -> [u32; 5] {
        [
            self.lights,
            self.palettes,
            self.textures,
            self.levels,
            self.calls,
        ]
    }
}

/// The first line that has it, and its colours as words of the panel.
pub type Palette<'t> = (u32, &'t [u16]);

/// What calls are read into: as many of each as [`Counts`] says.
pub struct CallMemory<'t> {
    /// Lights.
    pub lights: &'t mut [DirectionalLight],
    /// What falls from them.
    pub lighting: &'t mut Option<Lighting<'t>>,
    /// Palettes.
    pub palettes: &'t mut [Palette<'t>],
    /// Textures.
    pub textures: &'t mut [Texture<'t>],
    /// Levels below them.
    pub levels: &'t mut [Texture<'t>],
    /// Calls.
    pub calls: &'t mut [Draw<'t, 't, i32>],
}

/// Draw calls, and the palettes that their indices have.
#[derive(Clone, Copy, Debug)]
pub struct Calls<'t> {
    /// One after the other.
    pub draws: &'t [Draw<'t, 't, i32>],
    /// In the order of their lines.
    pub palettes: &'t [Palette<'t>],
}

/// A call that draws nothing.
const NOTHING: Draw<'static, 'static, i32> = Draw::new(Mesh {
    positions: &[],
    normals: &[],
    colours: &[],
    faces: Faces::Triangles(&[]),
});

impl<'t> Calls<'t> {
    /// A call for memory that is to be lent.
    pub const EMPTY: Draw<'t, 't, i32> = NOTHING;

    /// A light for memory that is to be lent.
    pub const DARK: DirectionalLight = DirectionalLight {
        direction: [I2F14::ZERO; 3],
        colour: [U1F15::ZERO; 3],
    };

    /// All that is behind the counts. A call is: its first word, by `code`; a word of the functions of colour and depth, and
    /// the number of its texture, plus 1, in the upper half; the window's columns and lines; vertices and triangles; a
    /// MATRIX of lists; places, normals, colours, triangles and, with a texture, places on it.
    ///
    /// # Errors
    /// When words cannot be, or less is lent than they need.
    pub fn read(reader: &mut Reader<'t>, lent: CallMemory<'t>) -> Result<Self, FlashError> {
        let ambient = U1F15::from_bits(reader.word()? as u16);
        for slot in lent.lights.iter_mut() {
            *slot = light(reader)?;
        }
        let lights: &'t [DirectionalLight] = lent.lights;
        let matt = Material::default();
        *lent.lighting = match lights {
            [] => None,
            lights => Some(Lighting::new(lights, [ambient; 3], matt).ok_or(FlashError::Lent)?),
        };
        for slot in lent.palettes.iter_mut() {
            *slot = (reader.word()?, reader.table(256)?);
        }
        textures(reader, lent.textures, lent.levels)?;
        let lighting: &'t Option<Lighting<'t>> = lent.lighting;
        let textures: &'t [Texture<'t>] = lent.textures;
        for slot in lent.calls.iter_mut() {
            *slot = call(reader, textures, lighting.as_ref())?;
        }
        Ok(Self {
            draws: lent.calls,
            palettes: lent.palettes,
        })
    }

    /// The palette of a line.
    #[must_use]
    pub fn palette(&self, line: u16) -> &'t [u16] {
        let begun = |palette: &&Palette<'t>| palette.0 <= u32::from(line);
        let last = self.palettes.iter().rev().find(begun);
        last.map_or(&[], |palette| palette.1)
    }
}

fn light(reader: &mut Reader<'_>) -> Result<DirectionalLight, FlashError> {
    let ([x, y], [z, r], [g, b]) = (reader.halves()?, reader.halves()?, reader.halves()?);
    Ok(DirectionalLight {
        direction: [x, y, z].map(|bits| I2F14::from_bits(bits as i16)),
        colour: [r, g, b].map(U1F15::from_bits),
    })
}

/// Textures with the levels below them.
fn textures<'t>(
    reader: &mut Reader<'t>,
    slots: &mut [Texture<'t>],
    mut levels: &'t mut [Texture<'t>],
) -> Result<(), FlashError> {
    for slot in slots {
        let taken = reader.word()?;
        let count = (taken & (code::MIXED - 1)).checked_sub(1);
        let count = count.map(|count| count as usize);
        let count = count.ok_or(reader.bad())?;
        let first = level(reader)?;
        let (own, rest) = core::mem::take(&mut levels)
            .split_at_mut_checked(count)
            .ok_or(FlashError::Lent)?;
        for coarser in own.iter_mut() {
            *coarser = level(reader)?;
        }
        levels = rest;
        let sampling = match taken & code::MIXED {
            0 => Sampling::NEAREST,
            _ => Sampling::LINEAR,
        };
        let sampled = first.sampled(sampling, own);
        *slot = sampled.map_err(|_| reader.bad())?;
    }
    Ok(())
}

fn level<'t>(reader: &mut Reader<'t>) -> Result<Texture<'t>, FlashError> {
    let [width, height] = reader.halves()?.map(u32::from);
    let words = reader.table(width as usize * height as usize)?;
    Texture::words(words, width, height).map_err(|_| reader.bad())
}

/// The function with these bits.
fn function(bits: u32) -> DepthFunction {
    const ALL: [DepthFunction; 8] = [
        DepthFunction::NEVER,
        DepthFunction::FARTHER,
        DepthFunction::EQUAL,
        DepthFunction::FARTHER_OR_EQUAL,
        DepthFunction::NEARER,
        DepthFunction::DIFFERENT,
        DepthFunction::NEARER_OR_EQUAL,
        DepthFunction::ALWAYS,
    ];
    ALL[(bits & 7) as usize]
}

fn call<'t>(
    reader: &mut Reader<'t>,
    textures: &'t [Texture<'t>],
    lighting: Option<&'t Lighting<'t>>,
) -> Result<Draw<'t, 't, i32>, FlashError> {
    let first = reader.word()?;
    let has = |bit: u32| first & bit != 0;
    let second = reader.word()?;
    let texture = (second >> 16).checked_sub(1);
    let texture = texture.map(|number| textures.get(number as usize).ok_or(reader.bad()));
    let texture = texture.transpose()?;
    let ([left, right], [top, bottom]) = (reader.halves()?, reader.halves()?);
    let (columns, lines) = (left..right, top..bottom);
    let [vertices, faces] = reader.array::<2>()?.map(|count| count as usize);
    let matrix = matrix(reader)?;
    let mesh = Mesh {
        positions: reader.table(vertices)?,
        normals: reader.table(vertices)?,
        colours: reader.table(vertices)?,
        faces: Faces::Triangles(reader.table(faces)?),
    };
    let places = match texture {
        Some(_) => reader.table(vertices)?,
        None => &[],
    };
    let skin = texture.map(|texture| Skin {
        texture,
        places,
        budget: match first >> code::QUALITY & 3 {
            code::FAST => Budget::FAST,
            code::EXACT => Budget::EXACT,
            _ => Budget::BALANCED,
        },
    });
    Ok(Draw {
        model: Affine::from(&matrix),
        texture: skin,
        lights: match lighting {
            Some(lighting) if first & code::UNLIT == 0 => Some(lighting),
            _ => None,
        },
        scissor: has(code::WINDOW).then(|| match has(code::OUTSIDE) {
            true => Scissor::outside(columns, lines),
            false => Scissor::inside(columns, lines),
        }),
        depth: DepthTest {
            colour_if: function(second),
            depth_if: function(second >> 8),
        },
        ..coded(first, mesh)
    })
}

/// What the first word of a call says of a mesh.
fn coded<'t>(first: u32, mesh: Mesh<'t, i32>) -> Draw<'t, 't, i32> {
    let has = |bit: u32| first & bit != 0;
    let alpha = (first >> code::ALPHA) as u8;
    Draw {
        cull: match has(code::CULL_BACK) {
            true => Cull::Back,
            false => Cull::None,
        },
        shading: match has(code::FLAT) {
            true => Shading::Flat,
            false => Shading::Smooth,
        },
        texgen: has(code::REFLECTION).then_some(TexGen::SPHERE),
        application: match first >> code::APPLICATION & 3 {
            code::REPLACE => Application::Replace,
            code::DECAL => Application::Decal,
            _ => Application::Product,
        },
        blend: match first >> code::BLEND & 3 {
            code::FILTER => Some(Blend::filter(alpha)),
            code::ADD => Some(Blend::add(alpha)),
            code::SUBTRACT => Some(Blend::new(BlendMode::Subtract(alpha))),
            _ => None,
        },
        dither: has(code::DITHER),
        priority: (first >> code::PRIORITY) as u8,
        ..Draw::new(mesh)
    }
}

fn matrix(reader: &mut Reader<'_>) -> Result<Matrix, FlashError> {
    let linear = reader.array::<9>()?.map(|word| word as i32);
    let exponents = reader.halves()?.map(|half| half as i16);
    let offset = reader.array::<3>()?.map(|word| word as i32);
    // As lists have them.
    let is_good = |exponent: &i16| (-128..=96).contains(exponent);
    if !exponents.iter().all(is_good) {
        return Err(reader.bad());
    }
    Ok(Matrix {
        linear,
        linear_exponent: exponents[0],
        offset,
        offset_exponent: exponents[1],
    })
}
