//! The loadable description of a vertex, and the memory its parameters go to (K15).
//!
//! A vertex is a run of 32-bit words. What they mean is data: a format RAM, loaded by the host,
//! lists the parameters by number and input format. Parameter 0 is the place, x and y in 13.3;
//! the others go to the set-up token whose id is their number (1 depth, 2 diffuse, 3 specular,
//! 4 normal). A new parameter is a new line of the table and no new code.

use super::format::{InputFormat, ProcessingFormat, Word36};

/// Parameters of a vertex, at most.
pub const PARAMETERS: usize = 16;
/// Streams that can be loaded side by side.
pub const STREAMS: usize = 4;
/// Vertices that a stream holds: a triangle or a quad.
pub const VERTICES: usize = 4;
/// The parameter that is the vertex's place on the screen.
pub const PLACE: u8 = 0;

/// One word of the format RAM.
///
/// A description begins with a count: the 32-bit words of a vertex, 1 to 31. Entries follow
/// until their words add up to it.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct FormatWord(pub u16);

impl FormatWord {
    /// The first word of a description: how many words a vertex has.
    #[must_use]
    pub const fn count(words: u8) -> Self {
        Self(words as u16)
    }

    /// An entry: parameter 0 to 15 in this input format.
    #[must_use]
    pub const fn parameter(number: u8, format: InputFormat) -> Self {
        Self(format.code() << 4 | (number & 15) as u16)
    }
}

/// Why a vertex cannot be read.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum FormatError {
    /// The description runs off the end of the format RAM.
    Address {
        /// The word that is not there.
        address: usize,
    },
    /// A count of 0 or above 31, or a format that does not exist.
    Word {
        /// Where it stands.
        address: usize,
        /// What stands there.
        word: u16,
    },
    /// The entries have more words than the count says.
    Count {
        /// Where the description begins.
        address: usize,
    },
    /// The description has no place in the format 2x16U, or the place in another.
    Place {
        /// Where the description begins.
        address: usize,
    },
    /// Fewer words than a vertex has.
    Words {
        /// Words of a vertex.
        needed: usize,
        /// Words there are.
        have: usize,
    },
}

impl core::fmt::Display for FormatError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Address { address } => write!(f, "format RAM: there is no word {address}"),
            Self::Word { address, word } => {
                write!(
                    f,
                    "format RAM: word {address} is {word:#06x}, which means nothing"
                )
            }
            Self::Count { address } => write!(
                f,
                "format RAM: the entries at {address} do not add up to their count"
            ),
            Self::Place { address } => {
                write!(
                    f,
                    "format RAM: the vertex at {address} has no place in 2x16U"
                )
            }
            Self::Words { needed, have } => {
                write!(f, "vertex: {needed} words are needed, there are {have}")
            }
        }
    }
}

impl core::error::Error for FormatError {}

/// One parameter of a description.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Entry {
    /// Parameter number, 0 to 15.
    pub number: u8,
    /// How it comes in.
    pub format: InputFormat,
    /// The first of its words in the vertex.
    pub word: usize,
}

/// A description that was read from the format RAM whole: it cannot be wrong any more.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexFormat {
    /// Words of a vertex, 1 to 31.
    words: u8,
    /// Input format of each parameter, and the first of its words.
    entries: [Option<(InputFormat, u8)>; PARAMETERS],
}

impl VertexFormat {
    /// [`SCENE_VERTEX`](super::SCENE_VERTEX), read.
    pub const SCENE: Self = {
        let mut entries = [None; PARAMETERS];
        entries[PLACE as usize] = Some((InputFormat::U16x2, 0));
        entries[1] = Some((InputFormat::U32x1, 1));
        entries[2] = Some((InputFormat::U8x4, 2));
        Self { words: 3, entries }
    };

    /// Reads the description at `address` of a format RAM.
    ///
    /// # Errors
    /// See [`FormatError`]; a parameter that is named twice keeps its last entry.
    pub fn read(ram: &[FormatWord], address: usize) -> Result<Self, FormatError> {
        let at = |address: usize| {
            let word = ram.get(address).ok_or(FormatError::Address { address })?;
            Ok::<u16, FormatError>(word.0)
        };
        let word = at(address)?;
        // A 5-bit counter counts them.
        let count = match word {
            1..=31 => word as u8,
            _ => return Err(FormatError::Word { address, word }),
        };
        let mut entries = [None; PARAMETERS];
        let mut first = 0;
        let mut next = address;
        while first < count {
            next += 1;
            let word = at(next)?;
            let format = InputFormat::from_code(word >> 4).ok_or(FormatError::Word {
                address: next,
                word,
            })?;
            entries[usize::from(word & 15)] = Some((format, first));
            first += format.words() as u8;
        }
        if first != count {
            return Err(FormatError::Count { address });
        }
        match entries[usize::from(PLACE)] {
            Some((InputFormat::U16x2, _)) => Ok(Self {
                words: count,
                entries,
            }),
            _ => Err(FormatError::Place { address }),
        }
    }

    /// 32-bit words of a vertex.
    #[must_use]
    pub fn words(&self) -> usize {
        usize::from(self.words)
    }

    /// The parameters, by number.
    pub fn entries(&self) -> impl Iterator<Item = Entry> + '_ {
        (0..).zip(&self.entries).filter_map(|(number, entry)| {
            let (format, word) = (*entry)?;
            Some(Entry {
                number,
                format,
                word: usize::from(word),
            })
        })
    }
}

/// Four memories of 64 words of 36 bits, one for each vertex, so that all four can be read at
/// once; within one, parameters of four streams.
#[derive(Clone, Debug)]
pub struct ParameterRam {
    words: [[Word36; PARAMETERS * STREAMS]; VERTICES],
}

impl Default for ParameterRam {
    fn default() -> Self {
        Self::new()
    }
}

impl ParameterRam {
    /// All words 0.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            words: [[0; PARAMETERS * STREAMS]; VERTICES],
        }
    }

    const fn address(stream: u8, number: u8) -> usize {
        (number as usize % PARAMETERS) * STREAMS + stream as usize % STREAMS
    }

    /// Converts the words of a vertex and stores its parameters; `vertex` and `stream` are 0 to
    /// 3, of larger numbers the lower two bits count.
    ///
    /// # Errors
    /// When there are fewer words than the format has; then nothing is stored.
    pub fn load(
        &mut self,
        stream: u8,
        vertex: u8,
        format: &VertexFormat,
        words: &[u32],
    ) -> Result<(), FormatError> {
        let (needed, have) = (format.words(), words.len());
        if have < needed {
            return Err(FormatError::Words { needed, have });
        }
        let ram = &mut self.words[usize::from(vertex) % VERTICES];
        for entry in format.entries() {
            let at = |i: usize| words.get(entry.word + i).copied().unwrap_or(0);
            ram[Self::address(stream, entry.number)] = entry.format.convert(at(0), at(1));
        }
        Ok(())
    }

    /// A parameter of a vertex, as it is stored.
    #[inline]
    #[must_use]
    pub const fn get(&self, stream: u8, vertex: u8, number: u8) -> Word36 {
        self.words[vertex as usize % VERTICES][Self::address(stream, number)]
    }

    /// The place of a vertex, 13.3.
    #[inline]
    #[must_use]
    pub fn place(&self, stream: u8, vertex: u8) -> (u16, u16) {
        let [x, y, ..] = ProcessingFormat::U16x2.unpack(self.get(stream, vertex, PLACE));
        (x as u16, y as u16)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    const TABLE: [FormatWord; 5] = [
        FormatWord::count(5),
        FormatWord::parameter(4, InputFormat::S16x3),
        FormatWord::parameter(PLACE, InputFormat::U16x2),
        FormatWord::parameter(1, InputFormat::U32x1),
        FormatWord::parameter(2, InputFormat::U8x4),
    ];

    #[test]
    fn a_table_says_what_the_words_are() {
        let format = VertexFormat::read(&TABLE, 0).unwrap();
        let words = [0x8000_7FFF, 0xFFFF_0000, 0x0140_0088, 77, 0xFF80_0001];
        let mut ram = ParameterRam::new();
        ram.load(2, 3, &format, &words).unwrap();
        assert_eq!(ram.place(2, 3), (0x140, 0x88));
        assert_eq!(ram.get(2, 3, 1), 77 << 4);
        assert_eq!(
            ProcessingFormat::U9x4.unpack(ram.get(2, 3, 2)),
            [511, 257, 0, 2]
        );
        assert_eq!(
            ProcessingFormat::S12x3.unpack(ram.get(2, 3, 4)),
            [-2048, 2047, -1, 0]
        );
        // Neither another stream nor another vertex was touched.
        for (stream, vertex) in [(1, 3), (2, 2)] {
            assert!((0..16).all(|n| ram.get(stream, vertex, n) == 0));
        }
        let short = ram.load(0, 0, &format, &words[..4]);
        assert_eq!(short, Err(FormatError::Words { needed: 5, have: 4 }));
        assert_eq!(ram.place(0, 0), (0, 0));
    }

    #[test]
    fn the_table_of_scenes_is_read_as_it_stands() {
        let read = VertexFormat::read(&crate::SCENE_VERTEX, 0);
        assert_eq!(read, Ok(VertexFormat::SCENE));
    }

    #[test]
    fn every_bad_table_is_refused() {
        use FormatError::{Address, Count, Place, Word};
        let read = |table: &[FormatWord]| VertexFormat::read(table, 0);
        assert_eq!(read(&[]), Err(Address { address: 0 }));
        assert_eq!(read(&TABLE[..4]), Err(Address { address: 4 }));
        let zero = FormatWord::count(0);
        assert_eq!(
            read(&[zero]),
            Err(Word {
                address: 0,
                word: 0
            })
        );
        let word = 32;
        assert_eq!(read(&[FormatWord(word)]), Err(Word { address: 0, word }));
        let unknown = [FormatWord::count(1), FormatWord(5 << 4)];
        assert_eq!(
            read(&unknown),
            Err(Word {
                address: 1,
                word: 80
            })
        );
        // A vector of two words where one is left.
        let long = [FormatWord::count(1), TABLE[1]];
        assert_eq!(read(&long), Err(Count { address: 0 }));
        let nowhere = [FormatWord::count(1), TABLE[3]];
        assert_eq!(read(&nowhere), Err(Place { address: 0 }));
        let place = FormatWord::parameter(PLACE, InputFormat::U32x1);
        assert_eq!(
            read(&[FormatWord::count(1), place]),
            Err(Place { address: 0 })
        );
        // No table of three words does anything but succeed or be refused.
        for a in 0..=u8::MAX {
            for b in 0..=u8::MAX {
                let _ = read(&[FormatWord(2), FormatWord(a.into()), FormatWord(b.into())]);
            }
        }
    }
}
