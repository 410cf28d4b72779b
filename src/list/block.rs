//! Blocks as values: what the reader gives and the writer takes.
//!
//! Bulk data (vertices, indices, texels) stays where it is: a block names its first word.

use super::format::VertexFormat;
use super::header::Header;

/// What a block says.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum Instruction {
    /// Flow control.
    Flow(Flow),
    /// A strip or fan of short vertices.
    Short(Run),
    /// A strip or fan of long vertices.
    Long(Run),
    /// Points.
    Points(Run),
    /// Quads, or a strip of them.
    Quads(Run),
    /// Vertices for INDEXED.
    Table(Run),
    /// Triangles of the last table.
    Indexed(Run),
    /// Something that stays in force.
    State(State),
    /// A block of a later version, passed over.
    Later,
    /// A try to reach the master state; the register, where one is named.
    Master(u32),
}

impl Instruction {
    /// Vertices or indices, where it has some.
    pub(crate) const fn run(&self) -> Option<Run> {
        match self {
            Self::Short(run)
            | Self::Long(run)
            | Self::Points(run)
            | Self::Quads(run)
            | Self::Table(run)
            | Self::Indexed(run) => Some(*run),
            _ => None,
        }
    }

    /// How many words behind the block it lets pass over.
    pub(crate) const fn reach(&self) -> u32 {
        match self {
            Self::State(State::Bounds(Bounds { words, .. }) | State::Cone(Cone { words, .. })) => {
                *words
            }
            _ => 0,
        }
    }
}

/// Elements that follow a header.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Run {
    /// The header.
    pub header: Header,
    /// Position of the first word behind it.
    pub at: u32,
}

/// Flow control (H12): kind in CNT's upper half, argument in its lower.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Flow {
    /// 0: the list ends here.
    End,
    /// 1: wait until started again.
    Pause,
    /// 2: what stands before is drawn before what comes.
    Sync,
    /// 3: an interrupt with this vector, the argument.
    Interrupt(u8),
    /// 4: go on so many words behind the end of this block, or before it; one word, signed.
    JumpRelative(i32),
    /// 5: go on at this word of the list; one word.
    Jump(u32),
    /// 6: make the texture that is defined by the TEXTURE block at this word of the list the one
    /// of a number, the argument; one word.
    LoadTexture {
        /// Number of the texture.
        number: u8,
        /// Position of the block.
        at: u32,
    },
}

impl Flow {
    /// Kind and argument.
    #[must_use]
    pub const fn code(self) -> (u8, u8) {
        match self {
            Self::End => (0, 0),
            Self::Pause => (1, 0),
            Self::Sync => (2, 0),
            Self::Interrupt(vector) => (3, vector),
            Self::JumpRelative(_) => (4, 0),
            Self::Jump(_) => (5, 0),
            Self::LoadTexture { number, .. } => (6, number),
        }
    }
}

/// What stays in force until it is said otherwise: kind in CNT's upper half, argument below.
///
/// Words are those behind the header.
#[derive(Clone, Copy, Debug, PartialEq)]
pub enum State {
    /// 0: what the list is; 4 words.
    Head(Head),
    /// 1: the vertex format; the argument counts its fields, whose bytes follow, 4 a word.
    Format(VertexFormat),
    /// 2: model space to the list's world; 13 words.
    Matrix(Matrix),
    /// 3: the light of a number; 3 words.
    Light {
        /// The argument.
        number: u8,
        /// The light.
        light: LightWords,
    },
    /// 4: the light of a number is off; no word.
    LightOff {
        /// The argument.
        number: u8,
    },
    /// 5: the material; 3 words.
    Material(Material),
    /// 6: the camera; 12 words.
    Camera(CameraWords),
    /// 7: only this part of the picture is drawn to; 2 words.
    Window(Window),
    /// 8: a texture; 2 words and the texels.
    Texture(Texture),
    /// 9: a palette; 1 word and a word for each colour.
    Palette(Palette),
    /// 10: pixels over the picture (K14); 3 words and the pixels.
    Overlay(Overlay),
    /// 11: a sphere around what follows; 6 words.
    Bounds(Bounds),
    /// 12: pixels of a point each way, the argument, 1 to 255; no word.
    PointSize(u8),
    /// 13: a cone around the normals of what follows; 6 words.
    Cone(Cone),
}

/// What a list is, at its beginning, so that memory can be lent to suit.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Head {
    /// Word 2: words of the whole list, counted from this block's header.
    pub words: u32,
    /// Word 3: vertices of the largest TABLE.
    pub table: u32,
    /// Word 4: triangles, each drawn once.
    pub triangles: u32,
}

impl Head {
    /// Word 1: the letters `SCBL`.
    pub const MAGIC: u32 = u32::from_le_bytes(*b"SCBL");
}

/// An affine map in block fixed point: numbers are `mantissa 2^(exponent - 30)`.
///
/// Words 1 to 9 are the linear part, row by row; word 10 both exponents, the linear part's in the
/// lower half, signed; words 11 to 13 the offset. Mantissas are below 2^30 in magnitude,
/// exponents within -128 ..= 96.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Matrix {
    /// Linear part, row by row.
    pub linear: [i32; 9],
    /// Its exponent.
    pub linear_exponent: i16,
    /// Offset.
    pub offset: [i32; 3],
    /// Its exponent.
    pub offset_exponent: i16,
}

impl Matrix {
    /// The map that changes nothing.
    pub const IDENTITY: Self = Self {
        linear: [1 << 29, 0, 0, 0, 1 << 29, 0, 0, 0, 1 << 29],
        linear_exponent: 1,
        offset: [0; 3],
        offset_exponent: -128,
    };
}

/// An infinite light with ambient light. Word 1: x and y; word 2: z and the ambient level; word 3:
/// red, green and blue, 8 bits each, red lowest.
///
/// It gives `ambient` everywhere, and `1 - ambient` of its colour where it falls. What several
/// lights give is added up; the ambient level ends at 1.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct LightWords {
    /// Towards the light, Q1.14, of length 1 in the list's world.
    pub direction: [i16; 3],
    /// 0 to 2^15 for 0 to 1.
    pub ambient: u16,
    /// Of what falls; all 255: white.
    pub colour: [u8; 3],
}

/// How surfaces look. Word 1: diffuse red, green, blue and opacity, 8 bits each, red lowest;
/// word 2: specular red, green, blue and exponent; word 3: bit 0 two-sided, bit 1 not lit, bit 2
/// textured with the texture of the number in bits 15 to 8.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Material {
    /// Colour of vertices that have none of their own.
    pub diffuse: [u8; 3],
    /// 255: opaque.
    pub opacity: u8,
    /// Colour of highlights; black: none.
    pub specular: [u8; 3],
    /// Exponent of highlights.
    pub exponent: u8,
    /// Drawn from behind too.
    pub two_sided: bool,
    /// No light, even where there are normals.
    pub unlit: bool,
    /// Number of the texture.
    pub texture: Option<u8>,
}

impl Default for Material {
    /// White, opaque, one-sided, lit.
    fn default() -> Self {
        Self {
            diffuse: [255; 3],
            opacity: 255,
            specular: [0; 3],
            exponent: 0,
            two_sided: false,
            unlit: false,
            texture: None,
        }
    }
}

/// A camera, as `Camera::look_at` takes it: 12 words of IEEE 754 singles in this order.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct CameraWords {
    /// Words 1 to 3.
    pub eye: [f32; 3],
    /// Words 4 to 6.
    pub at: [f32; 3],
    /// Words 7 to 9.
    pub up: [f32; 3],
    /// Word 10: focal length, in pixels of a picture of 240 lines.
    pub focal: f32,
    /// Word 11.
    pub near: f32,
    /// Word 12.
    pub far: f32,
}

/// A rectangle of the picture. Word 1: left and top; word 2: right and bottom, not inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Window {
    /// First column.
    pub left: u16,
    /// First line.
    pub top: u16,
    /// Column after the last; above `left`.
    pub right: u16,
    /// Line after the last; above `top`.
    pub bottom: u16,
}

impl Window {
    /// All of a picture.
    pub(crate) const fn all(width: u16, height: u16) -> Self {
        Self {
            left: 0,
            top: 0,
            right: width,
            bottom: height,
        }
    }

    /// Whether another one lies within.
    pub(crate) const fn contains(self, other: Self) -> bool {
        other.left >= self.left
            && other.top >= self.top
            && other.right <= self.right
            && other.bottom <= self.bottom
    }
}

/// How texels and overlay pixels are stored (H7), by code.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[repr(u8)]
pub enum TexelForm {
    /// 1 bit, through a palette.
    Index1 = 0,
    /// 2 bits.
    Index2 = 1,
    /// 4 bits.
    Index4 = 2,
    /// 6 bits, in bytes.
    Index6 = 3,
    /// 8 bits.
    Index8 = 4,
    /// 16 bits: blue 5, green 6, red 5, blue lowest.
    Rgb565 = 5,
    /// 24 bits: red, green, blue, red lowest.
    Rgb888 = 6,
    /// 32 bits: red, green, blue, 7 bits alpha, 1 bit D.
    Rgba = 7,
    /// 16 bits: 1 bit alpha, blue 5, green 5, red 5, alpha lowest.
    Rgba5551 = 8,
    /// 16 bits: 1 bit D, blue 5, green 5, red 5, D lowest.
    Rgbd5551 = 9,
}

impl TexelForm {
    /// All, in the order of their codes.
    pub const ALL: [Self; 10] = [
        Self::Index1,
        Self::Index2,
        Self::Index4,
        Self::Index6,
        Self::Index8,
        Self::Rgb565,
        Self::Rgb888,
        Self::Rgba,
        Self::Rgba5551,
        Self::Rgbd5551,
    ];

    /// Whether texels name colours of a palette.
    #[must_use]
    pub const fn is_indexed(self) -> bool {
        (self as u32) < Self::Rgb565 as u32
    }

    /// Bits of a texel.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::Index1 => 1,
            Self::Index2 => 2,
            Self::Index4 => 4,
            Self::Index6 | Self::Index8 => 8,
            Self::Rgb565 | Self::Rgba5551 | Self::Rgbd5551 => 16,
            Self::Rgb888 => 24,
            Self::Rgba => 32,
        }
    }
}

/// A texture. Word 1: bits 3..0 and 7..4 the binary logarithms of width and height (0 to 10),
/// bits 11..8 the form, bits 13..12 levels of detail less one (each half the size of the one
/// before), bits 23..16 the palette, bit 24 clamped instead of repeated; word 2: how many words
/// of texels follow. Texels lie row by row from the top, lowest bits first; levels one after
/// the other, each padded to a word. Those below a level of one texel are not drawn with.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Texture {
    /// The argument.
    pub number: u8,
    /// Width is `1 << log_width`.
    pub log_width: u8,
    /// Height is `1 << log_height`.
    pub log_height: u8,
    /// Form of a texel.
    pub form: TexelForm,
    /// Levels of detail, 1 to 4 (H6).
    pub levels: u8,
    /// Number of the palette, for the forms that need one.
    pub palette: u8,
    /// The edge goes on outside; else the picture repeats.
    pub clamped: bool,
    /// Position of the first texel.
    pub at: u32,
}

impl Texture {
    /// Words of texels, all levels together.
    #[must_use]
    pub const fn words(&self) -> u32 {
        let (mut words, mut level) = (0, 0);
        while level < self.levels && level < 4 {
            let w = (self.log_width & 15).saturating_sub(level);
            let h = (self.log_height & 15).saturating_sub(level);
            words += ((self.form.bits() as u64) << w << h).div_ceil(32);
            level += 1;
        }
        // Sides that are too long are refused by the reader.
        if words >> 31 == 0 {
            words as u32
        } else {
            u32::MAX >> 1
        }
    }
}

/// A palette. Word 1: how many colours, 1 to 256; then each: red, green, blue and alpha, 8 bits
/// each, red lowest.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Palette {
    /// The argument.
    pub number: u8,
    /// 1 to 256.
    pub count: u16,
    /// Position of the first colour.
    pub at: u32,
}

/// Pixels over the picture. Word 1: left and top; word 2: width and height, 1 to 1024 each;
/// word 3: bits 3..0 the form, bit 4 added instead of replacing, bits 15..8 the palette. Rows
/// from the top, lowest bits first, all together padded to a word. Pixels of alpha 0 are left out.
///
/// It lies over all that is drawn until the next SYNC, and over the overlays before it, with the
/// palette that has the number now.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Overlay {
    /// Column of the first pixel.
    pub left: u16,
    /// Line of the first pixel.
    pub top: u16,
    /// Pixels a row.
    pub width: u16,
    /// Rows.
    pub height: u16,
    /// Form of a pixel.
    pub form: TexelForm,
    /// Added to what is there.
    pub additive: bool,
    /// Number of the palette.
    pub palette: u8,
    /// Position of the first pixel.
    pub at: u32,
}

impl Overlay {
    /// Words of pixels.
    #[must_use]
    pub const fn words(&self) -> u32 {
        let bits = self.width as u64 * self.height as u64 * self.form.bits() as u64;
        // Sides that are too long are refused by the reader.
        if bits >> 36 == 0 {
            bits.div_ceil(32) as u32
        } else {
            u32::MAX >> 1
        }
    }
}

/// A sphere around all that the words behind this block draw, in the list's world, as
/// `mantissa 2^(exponent - 30)`. Words 1 to 3: middle; word 4: radius, not negative; word 5:
/// exponent, -128 ..= 96; word 6: how many words may be passed over when it is out of sight.
///
/// The words are whole blocks; a list where they end within one is malformed from there on, once they are passed over.
/// What is passed over sets no state, so what comes behind must not count on any from there. LONG
/// vertices, and squares of points beyond one pixel, count as they are: the sphere has to hold them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Bounds {
    /// Middle.
    pub centre: [i32; 3],
    /// Radius.
    pub radius: i32,
    /// Exponent of all four.
    pub exponent: i16,
    /// Words behind this block that it speaks of.
    pub words: u32,
}

/// A cone around the normals of all faces that the words behind this block draw, in the space of their vertices. Words 1
/// to 3: a point that lies behind all of them, in units of 2^-30 of a place; word 4: x and y of the middle of the normals,
/// Q1.14, of length 1, or 0 where they look everywhere; word 5: z of it, and in the upper half the square of the sine of
/// the widest angle to it, in 1/65536; word 6: how many words may be passed over where all are seen from behind.
///
/// Nothing is passed over where faces are drawn from behind too, or under a matrix that stretches or mirrors. What is
/// passed over sets no state, as with BOUNDS; LONG vertices and points have no side, and do not belong there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cone {
    /// The point behind all faces.
    pub apex: [i32; 3],
    /// The middle of the normals.
    pub axis: [i16; 3],
    /// How far normals are from it.
    pub spread: u16,
    /// Words behind this block that it speaks of.
    pub words: u32,
}
