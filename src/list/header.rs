//! The block header: one word, to the bit as H11 has it.
//!
//! | bits | field | meaning |
//! |---|---|---|
//! | 31..28 | ID | the kind of block ([`Id`]) |
//! | 27..24 | VER | 1 |
//! | 23..8 | CNT | vertices, indices or words; of FLOW and STATE: what (8 bits) and argument (8 bits) |
//! | 7 | SHADE | vertices carry colour, specular and normal |
//! | 6 | PRSP | vertices carry depth; textures are perspective-correct |
//! | 5 | TEXT | vertices carry a texture place |
//! | 4 | NEW | a strip or fan begins; 0: that of the block before goes on |
//! | 3 | RM | each vertex replaces the middle one (fan); 0: the oldest (strip) |
//! | 2..0 | LOW | reserved, 0; of QUADS and INDEXED: flags ([`Header::SPLIT`], [`Header::WIDE`], [`Header::SEPARATE`]) |

use super::error::Reason;

/// The version of the format that is here; blocks of others are refused.
const VERSION: u8 = 1;

/// Kinds of blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum Id {
    /// Flow control (H12): CNT is what and argument.
    Flow = 0,
    /// Short vertices: a strip or a fan.
    Short = 1,
    /// Long vertices, set up beforehand: a strip or a fan on the screen.
    Long = 2,
    /// Short vertices, each a point.
    Points = 3,
    /// Short vertices: separate quads, or with RM a quad strip.
    Quads = 4,
    /// Vertices in columns, kept for INDEXED.
    Table = 5,
    /// Indices into the last TABLE.
    Indexed = 6,
    /// Matrices, lights, materials and the like: CNT is what and argument.
    State = 7,
    /// 8 to 14: of later versions; CNT counts their words, so that they can be passed over.
    Later = 8,
    /// Master state, which a list must not touch (H13); CNT counts its words.
    Master = 15,
}

impl Id {
    /// Of a header's upper four bits.
    const fn of(bits: u32) -> Self {
        match bits & 15 {
            0 => Self::Flow,
            1 => Self::Short,
            2 => Self::Long,
            3 => Self::Points,
            4 => Self::Quads,
            5 => Self::Table,
            6 => Self::Indexed,
            7 => Self::State,
            15 => Self::Master,
            _ => Self::Later,
        }
    }

    /// Bits 7 to 0 of the header that a block of this kind may set.
    const fn allowed(self) -> u32 {
        match self {
            Self::Flow | Self::State | Self::Later | Self::Master => 0,
            Self::Short | Self::Long => 0xF8,
            Self::Points | Self::Table => 0xE0,
            Self::Quads => 0xF8 | Header::SPLIT as u32,
            Self::Indexed => 0x18 | (Header::WIDE | Header::SEPARATE) as u32,
        }
    }
}

/// A header, taken apart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Header {
    /// What the block is.
    pub id: Id,
    /// CNT.
    pub count: u16,
    /// Vertices carry colour, specular and normal.
    pub shade: bool,
    /// Vertices carry depth.
    pub prsp: bool,
    /// Vertices carry a texture place.
    pub text: bool,
    /// A strip or fan begins.
    pub new: bool,
    /// Replace the middle vertex.
    pub rm: bool,
    /// Bits 2 to 0.
    pub low: u8,
}

impl Header {
    /// LOW of QUADS: split from the second corner to the fourth (K2).
    pub const SPLIT: u8 = 1;
    /// LOW of INDEXED: indices of 16 bits; else 8.
    pub const WIDE: u8 = 1;
    /// LOW of INDEXED: three indices a triangle, no strips.
    pub const SEPARATE: u8 = 2;

    /// A header with no bit set but CNT.
    #[must_use]
    pub const fn of(id: Id, count: u16) -> Self {
        Self {
            id,
            count,
            shade: false,
            prsp: false,
            text: false,
            new: false,
            rm: false,
            low: 0,
        }
    }

    /// The word.
    #[must_use]
    pub const fn to_word(self) -> u32 {
        (self.id as u32) << 28
            | (VERSION as u32) << 24
            | (self.count as u32) << 8
            | (self.shade as u32) << 7
            | (self.prsp as u32) << 6
            | (self.text as u32) << 5
            | (self.new as u32) << 4
            | (self.rm as u32) << 3
            | (self.low & 7) as u32
    }

    /// Takes a word apart.
    ///
    /// # Errors
    /// When the version is unknown, or a bit is set that the kind does not have.
    #[inline]
    pub const fn read(word: u32) -> Result<Self, Reason> {
        let version = (word >> 24) as u8 & 15;
        if version != VERSION {
            return Err(Reason::Version(version));
        }
        let id = Id::of(word >> 28);
        if word & 0xFF & !id.allowed() != 0 {
            return Err(Reason::Reserved(word));
        }
        Ok(Self {
            id,
            count: (word >> 8) as u16,
            shade: word >> 7 & 1 != 0,
            prsp: word >> 6 & 1 != 0,
            text: word >> 5 & 1 != 0,
            new: word >> 4 & 1 != 0,
            rm: word >> 3 & 1 != 0,
            low: word as u8 & 7,
        })
    }

    /// Words of a vertex of a LONG block: x and y, with PRSP depth, with SHADE the colour, with TEXT u and v.
    #[must_use]
    pub const fn long_words(self) -> u32 {
        1 + self.prsp as u32 + self.shade as u32 + self.text as u32
    }

    /// CNT's upper half: what a FLOW or STATE block does.
    #[must_use]
    pub const fn what(self) -> u8 {
        (self.count >> 8) as u8
    }

    /// CNT's lower half: the argument of a FLOW or STATE block.
    #[must_use]
    pub const fn argument(self) -> u8 {
        self.count as u8
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// Every one of the 2^20 headers that differ in more than CNT.
    #[test]
    fn every_header_is_refused_or_comes_back() {
        let mut good = 0;
        for high in 0..=255u32 {
            for low in 0..=255u32 {
                for count in [0, 1, 0x1234, 0xFFFF] {
                    let word = high << 24 | count << 8 | low;
                    match Header::read(word) {
                        Ok(header) if header.id == Id::Later => assert_eq!(low, 0),
                        Ok(header) => {
                            good += 1;
                            assert_eq!(header.to_word(), word);
                        }
                        Err(Reason::Version(v)) => assert_eq!(u32::from(v), high & 15),
                        Err(Reason::Reserved(w)) => assert_eq!(w, word),
                        Err(other) => panic!("{other:?}"),
                    }
                }
            }
        }
        // FLOW, STATE and MASTER 1 each, SHORT and LONG 32, POINTS and TABLE 8, QUADS 64,
        // INDEXED 16; four counts.
        assert_eq!(good, 4 * (3 + 2 * 32 + 2 * 8 + 64 + 16));
    }
}
