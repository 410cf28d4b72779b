//! Why a list cannot be read: the block, its offset, the reason (X7).

use super::header::Id;

/// A malformed block. Nothing of it was done; the list stops there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ListError {
    /// Byte offset of the block's header; in a ring, modulo 2^32.
    pub offset: u32,
    /// What the block is, where its header could be read.
    pub block: Option<Id>,
    /// What is wrong.
    pub reason: Reason,
}

impl ListError {
    /// At a word of the list.
    pub(crate) const fn at(word: u32, block: Option<Id>, reason: Reason) -> Self {
        Self {
            offset: word.wrapping_mul(4),
            block,
            reason,
        }
    }
}

/// What is wrong with a block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Reason {
    /// The list ends within the block.
    Truncated {
        /// Words that the block needs, its header included.
        need: u32,
        /// Words that are there.
        have: u32,
    },
    /// A block that a ring can never hold whole.
    TooLong {
        /// Words that the block needs.
        need: u32,
        /// Words of the ring.
        room: u32,
    },
    /// An unknown version.
    Version(u8),
    /// A bit is set that this kind of block does not have; the header.
    Reserved(u32),
    /// A FLOW or STATE block of an unknown kind; the kind.
    Kind(u8),
    /// A number that a block cannot have there.
    Value {
        /// Word of the block, the header being 0.
        word: u32,
        /// What stands there.
        value: u32,
    },
    /// A count that the block cannot have.
    Count(u16),
    /// A vertex description names a format that the parameter cannot have, or no place.
    Format {
        /// The parameter.
        parameter: u8,
        /// The format's code.
        format: u8,
    },
    /// NEW is 0 and there is nothing to go on with, or vertices of another form.
    Continue,
    /// INDEXED without a TABLE before it.
    NoTable,
    /// An index that the table does not have.
    Index {
        /// The index.
        index: u16,
        /// Vertices of the table.
        count: u16,
    },
    /// A camera that sees nothing: its eye is where it looks, or a length is out of range.
    Camera,
    /// The bytes are not whole words, or do not begin at a multiple of 4.
    Alignment,
    /// The block asks for what the player does not have.
    Missing(Missing),
    /// The block needs more memory than was lent.
    Lent(Lent),
    /// A material names a texture that was not defined; its number.
    NoTexture(u8),
    /// A texture names a palette that was not defined; the number of the texture.
    NoPalette(u8),
    /// The scene was not begun.
    NotBegun,
}

/// What a block can ask for that not every player has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Missing {
    /// Textures, in a scene whose look has none.
    Textures,
    /// Texels that do not lie in one piece as the processor reads them.
    TexelsInPieces,
    /// Places of 32 bits, in memory for those of 16.
    FinePlaces,
    /// Coloured lights, or others than number 0.
    Lights,
    /// Highlights.
    Highlights,
    /// Lights and colours at vertices, where the settings have lamps.
    LightAtVertices,
    /// Lamps, in a scene whose look is not lit at pixels.
    Lamps,
    /// Opacity, alphas or blends, in a scene whose pixels are numbers of a palette.
    Blends,
    /// Shadows where priority decides, of a light that they cannot have, or of points and triangles on the screen.
    Shadows,
    /// A window, where what is drawn is cut in another way already.
    SecondScissor,
}

/// Memory that is lent to a player.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum Lent {
    /// For positions, normals or colours of vertices.
    Vertices,
    /// For indices.
    Indices,
    /// For places on textures. Those of a table in a ring lose bits on a texture narrower than 16 texels: then there is none
    /// for places on another, once the table was freed.
    Places,
    /// For the numbers of textures and palettes.
    Names,
    /// For textures that are drawn with.
    Textures,
    /// For palettes and texels as the panel has them.
    Texels,
    /// For levels of detail.
    Levels,
    /// For overlays.
    Overlays,
    /// For shadow volumes.
    Shadows,
}

impl core::fmt::Display for Missing {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Textures => "textures in a scene whose look has none",
            Self::TexelsInPieces => "texels that do not lie in one piece",
            Self::FinePlaces => "places of 32 bits in memory for those of 16",
            Self::Lights => "coloured lights, or several",
            Self::Highlights => "highlights",
            Self::LightAtVertices => "lights and colours at vertices where pixels are lit",
            Self::Lamps => "lamps in a scene that is lit at vertices",
            Self::Blends => "blends of numbers of a palette",
            Self::Shadows => "shadows by priority, of that light, or of points",
            Self::SecondScissor => "a window where there is another scissor",
        })
    }
}

impl core::fmt::Display for Lent {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::Vertices => "vertices",
            Self::Indices => "indices",
            Self::Places => "texture places",
            Self::Names => "numbers of textures and palettes",
            Self::Textures => "textures",
            Self::Texels => "palettes and texels",
            Self::Levels => "levels of detail",
            Self::Overlays => "overlays",
            Self::Shadows => "shadow volumes",
        })
    }
}

impl core::fmt::Display for ListError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "list: offset {:#x}", self.offset)?;
        if let Some(block) = self.block {
            write!(f, ", {block:?}")?;
        }
        write!(f, ": {}", self.reason)
    }
}

impl core::fmt::Display for Reason {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Truncated { need, have } => {
                write!(f, "{need} words are needed, there are {have}")
            }
            Self::TooLong { need, room } => {
                write!(f, "{need} words are needed, the ring has {room}")
            }
            Self::Version(version) => write!(f, "version {version} is unknown"),
            Self::Reserved(word) => write!(f, "header {word:#010x} sets a reserved bit"),
            Self::Kind(kind) => write!(f, "kind {kind} is unknown"),
            Self::Value { word, value } => write!(f, "word {word} cannot be {value:#x}"),
            Self::Count(count) => write!(f, "the count cannot be {count}"),
            Self::Format { parameter, format } => {
                write!(f, "parameter {parameter} cannot have the format {format}")
            }
            Self::Continue => f.write_str("there is no strip of this form to go on with"),
            Self::NoTable => f.write_str("there is no table before it"),
            Self::Index { index, count } => {
                write!(f, "index {index} in a table of {count} vertices")
            }
            Self::Camera => f.write_str("the camera is not one that can see"),
            Self::Alignment => f.write_str("not whole words at a multiple of 4 bytes"),
            Self::Missing(missing) => write!(f, "the player does not have {missing}"),
            Self::Lent(lent) => write!(f, "the memory that was lent for {lent} is too small"),
            Self::NoTexture(number) => write!(f, "there is no texture {number}"),
            Self::NoPalette(number) => write!(f, "there is no palette for texture {number}"),
            Self::NotBegun => f.write_str("the scene was not begun"),
        }
    }
}

impl core::error::Error for ListError {}
