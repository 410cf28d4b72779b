//! Draw calls in words, behind the head:
//!
//! 1. [`Counts`]: 11 words,
//! 2. lights: see [`Lights`],
//! 3. palettes: the first line and 256 words of the panel each,
//! 4. textures: see [`Textures`],
//! 5. calls: see [`Calls::read`].

use crate::lights::{LightCounts, LightMemory, Lights};
use crate::reader::{FlashError, Reader};
use crate::sources;
use crate::textures::{TextureCounts, TextureMemory, Textures, colour};
use scanbeam::list::Matrix;
use scanbeam::look::Look;
use scanbeam::mesh::I2F14;
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::{
    Application, BeginError, Blend, BlendMode, Budget, DepthFunction, DepthTest, DrawError, Factor,
    Scissor, Shading, Shadow, ShadowEdge, ShadowLight, ShadowMemory, Skin, TexGen,
};
use scanbeam::{Affine, Camera, Cull, Draw, Faces, Mesh, Scene, Screen};

/// The number of the light that throws shadows.
const LIGHT: u8 = 0;

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
    /// In the word of the blend, which is 0 for none: what is behind shines through.
    pub const FILTER: u32 = 1;
    /// It is added.
    pub const ADD: u32 = 2;
    /// It is taken away.
    pub const SUBTRACT: u32 = 3;
    /// Half of each is taken.
    pub const HALF: u32 = 4;
    /// Both are multiplied by what the next word says.
    pub const FACTORS: u32 = 5;
    /// It hides what is behind.
    pub const REPLACES: u32 = 6;
    /// The lowest bit of the channels that are written, red first.
    pub const CHANNELS: u32 = 4;
    /// The lowest bit of the alpha.
    pub const ALPHA: u32 = 8;
    /// A factor, of which the source's is in the lower half: its upper byte.
    pub const CONSTANT: u32 = 0;
    /// The colour that is there.
    pub const DESTINATION: u32 = 1;
    /// 1 less that.
    pub const INVERSE_DESTINATION: u32 = 2;
    /// The texel's alpha.
    pub const TEXTURE_ALPHA: u32 = 3;
    /// 1 less that.
    pub const INVERSE_TEXTURE_ALPHA: u32 = 4;
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
    /// It is seen where the light that throws shadows does not fall.
    pub const SHADOWED: u32 = 1 << 29;
    /// Places on its texture are made of normals.
    pub const REFLECTION: u32 = 1 << 30;
    /// It is a shadow volume, which has nothing of the above.
    pub const VOLUME: u32 = 1 << 31;
}

/// How many there are of what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Counts {
    /// Lights.
    pub lights: LightCounts,
    /// Textures.
    pub textures: TextureCounts,
    /// Palettes.
    pub palettes: u32,
    /// Draw calls.
    pub calls: u32,
    /// Shadow volumes among them.
    pub volumes: u32,
    /// Triangles of the largest of these.
    pub thrown: u32,
}

impl Counts {
    /// How many words they take.
    pub const WORDS: usize = 11;

    /// What is behind the head.
    ///
    /// # Errors
    /// When it ends too early.
    pub fn read(reader: &mut Reader<'_>) -> Result<Self, FlashError> {
        let [lights, lightings, lamps] = reader.array()?;
        let [textures, levels, others, caches] = reader.array()?;
        let [palettes, calls, volumes, thrown] = reader.array()?;
        Ok(Self {
            lights: LightCounts {
                lights,
                lightings,
                lamps,
            },
            textures: TextureCounts {
                textures,
                levels,
                others,
                caches,
            },
            palettes,
            calls,
            volumes,
            thrown,
        })
    }

    /// Its words.
    #[must_use]
    pub fn to_words(self) -> [u32; Self::WORDS] {
        let (lights, textures) = (self.lights, self.textures);
        [
            lights.lights,
            lights.lightings,
            lights.lamps,
            textures.textures,
            textures.levels,
            textures.others,
            textures.caches,
            self.palettes,
            self.calls,
            self.volumes,
            self.thrown,
        ]
    }

    /// States that calls take in a scene, at most: a volume takes two, and two more where the near plane cuts it.
    #[must_use]
    pub fn states(&self) -> u32 {
        self.calls + 3 * self.volumes
    }
}

/// The first line that has it, and its colours as words of the panel.
pub type Palette<'t> = (u32, &'t [u16]);

/// What calls are read into: as many of each as [`Counts`] says.
pub struct CallMemory<'t> {
    /// Lights.
    pub lights: LightMemory<'t>,
    /// Textures.
    pub textures: TextureMemory<'t>,
    /// Palettes.
    pub palettes: &'t mut [Palette<'t>],
    /// Calls.
    pub calls: &'t mut [Call<'t>],
}

/// What draws something.
#[derive(Clone, Copy, Debug)]
pub enum Call<'t> {
    /// A mesh.
    Mesh(Draw<'t, 't, i32>),
    /// The same, which one of the [`SOURCES`](crate::SOURCES) says.
    Said(u8, Draw<'t, 't, i32>),
    /// The shadow of one.
    Volume(Mesh<'t, i32>, Affine, ShadowLight),
}

/// What a scene refused.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum CallError {
    /// To be begun.
    Begin(BeginError),
    /// A call, by its number.
    Draw(usize, DrawError),
}

/// What shadow volumes are made in: as much as the largest of them needs.
pub struct VolumeMemory<'m> {
    /// Three for each triangle.
    pub edges: &'m mut [ShadowEdge],
    /// Six for each triangle.
    pub positions: &'m mut [[i32; 3]],
    /// Six for each triangle.
    pub faces: &'m mut [[u16; 3]],
}

/// Draw calls, and the palettes that their indices have.
#[derive(Clone, Copy, Debug)]
pub struct Calls<'t> {
    /// One after the other.
    pub calls: &'t [Call<'t>],
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
    pub const EMPTY: Call<'t> = Call::Mesh(NOTHING);

    /// All that is behind the counts, for pixels of the format `T`. A call is: its first word, by `code`; a word of the
    /// functions of colour and depth, and the number of its texture, plus 1, in the upper half; two words of its blend; a word of its colour, and
    /// one of the number of what falls on it, plus 1, and of its source, plus 1, in the upper half; the window's columns and lines; vertices and triangles, and normals
    /// and colours of vertices; a MATRIX of lists; places, normals, colours, triangles and, with a texture, places on it.
    /// A volume is: its first word; the light's direction and how far it is drawn out; vertices and triangles; a MATRIX;
    /// places and triangles.
    ///
    /// # Errors
    /// When words cannot be, or less is lent than they need.
    pub fn read<T: PixelFormat<Word = u16>>(
        reader: &mut Reader<'t>,
        lent: CallMemory<'t>,
        camera: &Camera,
        screen: Screen,
    ) -> Result<Self, FlashError> {
        let lights = Lights::read(reader, lent.lights, camera, screen)?;
        for slot in lent.palettes.iter_mut() {
            *slot = (reader.word()?, reader.table(256)?);
        }
        let textures = Textures::read::<T>(reader, lent.textures)?;
        for slot in lent.calls.iter_mut() {
            let first = reader.word()?;
            *slot = match first & code::VOLUME {
                0 => call(reader, first, &textures, &lights)?,
                _ => volume(reader)?,
            };
        }
        Ok(Self {
            calls: lent.calls,
            palettes: lent.palettes,
        })
    }

    /// Begins a scene and draws them: directly, or, where one is said by a source, all through queues.
    ///
    /// # Errors
    /// What the scene says, and of which call.
    pub fn draw<L: Look>(
        &self,
        camera: &Camera,
        scene: &mut Scene<'_, 't, L>,
        memory: &mut VolumeMemory<'_>,
    ) -> Result<(), CallError> {
        if self.calls.iter().any(|call| matches!(call, Call::Said(..))) {
            return sources::draw(self.calls, camera, scene);
        }
        scene.begin(camera).map_err(CallError::Begin)?;
        for (number, call) in self.calls.iter().enumerate() {
            let drawn = match call {
                Call::Mesh(draw) | Call::Said(_, draw) => scene.draw(draw),
                Call::Volume(mesh, model, light) => {
                    let memory = ShadowMemory {
                        edges: memory.edges,
                        positions: memory.positions,
                        faces: memory.faces,
                    };
                    scene.draw_shadow(mesh, model, light, memory)
                }
            };
            drawn.map_err(|error| CallError::Draw(number, error))?;
        }
        Ok(())
    }

    /// The palette of a line.
    #[must_use]
    pub fn palette(&self, line: u16) -> &'t [u16] {
        let begun = |palette: &&Palette<'t>| palette.0 <= u32::from(line);
        let last = self.palettes.iter().rev().find(begun);
        last.map_or(&[], |palette| palette.1)
    }
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
    first: u32,
    textures: &Textures<'t>,
    lights: &Lights<'t>,
) -> Result<Call<'t>, FlashError> {
    let has = |bit: u32| first & bit != 0;
    let second = reader.word()?;
    let texture = (second >> 16).checked_sub(1);
    let texture = texture.map(|number| textures.all.get(number as usize).ok_or(reader.bad()));
    let texture = texture.transpose()?;
    let blend = blend(reader)?;
    let colour = colour(reader)?;
    let [lit, source] = reader.halves()?;
    let falls = lights.on(lit).ok_or(reader.bad())?;
    let ([left, right], [top, bottom]) = (reader.halves()?, reader.halves()?);
    let (columns, lines) = (left..right, top..bottom);
    let [vertices, faces, normals, colours] = reader.array()?.map(|count| count as usize);
    let matrix = matrix(reader)?;
    let mesh = Mesh {
        positions: reader.table(vertices)?,
        normals: reader.table(normals)?,
        colours: reader.table(colours)?,
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
    let draw = Draw {
        model: Affine::from(&matrix),
        texture: skin,
        colour,
        lights: falls.at_corners.map(|lighting| lighting as _),
        lamps: falls.at_pixels,
        scissor: has(code::WINDOW).then(|| match has(code::OUTSIDE) {
            true => Scissor::outside(columns, lines),
            false => Scissor::inside(columns, lines),
        }),
        depth: DepthTest {
            colour_if: function(second),
            depth_if: function(second >> 8),
        },
        blend,
        shadow: has(code::SHADOWED).then_some(Shadow::Shadowed(LIGHT)),
        ..coded(first, mesh)
    };
    Ok(match source.checked_sub(1) {
        Some(source) => Call::Said(source as u8, draw),
        None => Call::Mesh(draw),
    })
}

fn volume<'t>(reader: &mut Reader<'t>) -> Result<Call<'t>, FlashError> {
    let ([x, y], [z, reach]) = (reader.halves()?, reader.halves()?);
    let light = ShadowLight {
        light: LIGHT,
        direction: [x, y, z].map(|bits| I2F14::from_bits(bits as i16)),
        reach: reach as u8,
    };
    let [vertices, faces] = reader.array()?.map(|count| count as usize);
    let matrix = matrix(reader)?;
    let mesh = Mesh {
        positions: reader.table(vertices)?,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(reader.table(faces)?),
    };
    Ok(Call::Volume(mesh, Affine::from(&matrix), light))
}

/// How a call and what is behind it become one.
fn blend(reader: &mut Reader<'_>) -> Result<Option<Blend>, FlashError> {
    let word = reader.word()?;
    let factors = reader.halves()?.map(|half| {
        let [kind, part] = half.to_le_bytes();
        match kind.into() {
            code::DESTINATION => Factor::Destination,
            code::INVERSE_DESTINATION => Factor::InverseDestination,
            code::TEXTURE_ALPHA => Factor::TextureAlpha,
            code::INVERSE_TEXTURE_ALPHA => Factor::InverseTextureAlpha,
            _ => Factor::Constant(part),
        }
    });
    let alpha = (word >> code::ALPHA) as u8;
    let mode = match word & 15 {
        0 => return Ok(None),
        code::FILTER => BlendMode::Filter(alpha),
        code::ADD => BlendMode::Add(alpha),
        code::SUBTRACT => BlendMode::Subtract(alpha),
        code::HALF => BlendMode::Half,
        code::FACTORS => BlendMode::Factors {
            source: factors[0],
            destination: factors[1],
        },
        code::REPLACES => BlendMode::Replace,
        _ => return Err(reader.bad()),
    };
    let rgb = [0, 1, 2].map(|bit| word >> (code::CHANNELS + bit) & 1 != 0);
    Ok(Some(Blend::new(mode).writing(rgb)))
}

/// What the first word of a call says of a mesh.
fn coded<'t>(first: u32, mesh: Mesh<'t, i32>) -> Draw<'t, 't, i32> {
    let has = |bit: u32| first & bit != 0;
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
