//! Words one after the other, and tables among them.

use core::fmt;
use scanbeam::scene::TextureError;

/// Why words are no scene.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum FlashError {
    /// They end too early: at this word.
    Ends(usize),
    /// A number of this word cannot be.
    Word(usize),
    /// Less is lent than they need.
    Lent,
    /// A texture cannot be made of them.
    Texture(TextureError),
}

impl From<TextureError> for FlashError {
    fn from(error: TextureError) -> Self {
        Self::Texture(error)
    }
}

impl fmt::Display for FlashError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Ends(at) => write!(f, "the words of the scene end at {at}"),
            Self::Word(at) => write!(f, "word {at} of the scene cannot be"),
            Self::Texture(error) => error.fmt(f),
            Self::Lent => f.write_str("less is lent than the scene needs"),
        }
    }
}

impl core::error::Error for FlashError {}

/// Reads words from the front.
#[derive(Clone, Copy, Debug)]
pub struct Reader<'t> {
    words: &'t [u32],
    at: usize,
}

impl<'t> Reader<'t> {
    /// From a word on.
    #[must_use]
    pub fn new(words: &'t [u32], at: usize) -> Self {
        Self { words, at }
    }

    /// The next word.
    ///
    /// # Errors
    /// When there is none.
    pub fn word(&mut self) -> Result<u32, FlashError> {
        let word = self.words.get(self.at).ok_or(FlashError::Ends(self.at))?;
        self.at += 1;
        Ok(*word)
    }

    /// The halves of the next word, the lower first.
    ///
    /// # Errors
    /// When there is none.
    pub fn halves(&mut self) -> Result<[u16; 2], FlashError> {
        let word = self.word()?;
        Ok([word as u16, (word >> 16) as u16])
    }

    /// So many next words.
    ///
    /// # Errors
    /// When there are fewer.
    pub fn array<const N: usize>(&mut self) -> Result<[u32; N], FlashError> {
        let table = self.table::<u32>(N)?;
        <[u32; N]>::try_from(table).map_err(|_| FlashError::Ends(self.at))
    }

    /// A table of so many elements, where it lies; it is padded to a word.
    ///
    /// # Errors
    /// When there are fewer.
    pub fn table<T: bytemuck::AnyBitPattern>(
        &mut self,
        count: usize,
    ) -> Result<&'t [T], FlashError> {
        let ends = FlashError::Ends(self.at);
        let words = count
            .checked_mul(size_of::<T>())
            .map(|b| b.div_ceil(4))
            .ok_or(ends)?;
        let rest = self.words.get(self.at..).ok_or(ends)?;
        let bytes: &'t [u8] = bytemuck::cast_slice(rest.get(..words).ok_or(ends)?);
        let bytes = bytes.get(..count * size_of::<T>()).ok_or(ends)?;
        let table = bytemuck::try_cast_slice(bytes).map_err(|_| FlashError::Word(self.at))?;
        self.at += words;
        Ok(table)
    }

    /// The word that was read last cannot be.
    #[must_use]
    pub fn bad(&self) -> FlashError {
        FlashError::Word(self.at.saturating_sub(1))
    }
}
