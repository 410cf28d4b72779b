//! Textures of 4 bits a texel, as BC1 (DXT1) has them (H7): a quarter of the memory of words.
//!
//! 4 x 4 texels are 8 bytes: two colours of 5, 6 and 5 bits, and two bits a texel that say whether it has the one, the
//! other or what is a third of the way between them. Every texel is decoded from its block alone, so a place costs the
//! same wherever it is, and a [`BlockCache`](super::BlockCache) decodes a block once for all that are read of it.
//!
//! A texture leads here by functions, so that a program which names no [`Compressed`] does not have the code.

use super::block::Blocked;
use super::block_cache::CacheWord;
use super::texture::Sides;
use super::{TexelWay, Texels, Texture, TextureError};

/// Bytes of a block.
const BYTES: usize = 8;

/// The parts of a channel are apart: green, red and blue, each with 5 bits above it, so that all three are mixed at once.
const CHANNELS: u32 = 0x07E0_F81F;

/// A half of 1/32 of each of them.
const HALF: u32 = 16 << 21 | 16 << 11 | 16;

/// A compressed texture, in memory that may be slow: it is read as it is by [`texture`](Self::texture), or through a
/// cache by [`BlockCache::compressed`](super::BlockCache::compressed).
///
/// ```
/// use scanbeam::scene::{BlockCache, CacheWord, Compressed};
///
/// // 8 x 4 texels: a block of one colour, and one that goes from black to white.
/// static BYTES: [u8; 16] = [0, 0xF8, 0, 0, 0, 0, 0, 0, 0xFF, 0xFF, 0, 0, 0x2D, 0x2D, 0x2D, 0x2D];
/// let bricks = Compressed::new(&BYTES, 8, 4, u16::to_be)?;
/// let texture = bricks.texture(); // for `Skin::texture`, without a cache
///
/// let mut fast = [const { CacheWord::new() }; 32]; // two blocks
/// let cache = BlockCache::compressed(bricks, &mut fast)?;
/// cache.load(0..8, 0..4, 2)?; // before it is drawn
/// let texture = cache.texture(); // for `Skin::texture`
/// # let _ = texture;
/// # Ok::<(), Box<dyn std::error::Error>>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Compressed<'t> {
    blocks: &'t [u8],
    pub(super) sides: Sides,
    /// What a number of 5, 6 and 5 bits is as a word of the panel.
    word: fn(u16) -> u16,
    key: Option<u16>,
}

impl<'t> Compressed<'t> {
    /// Blocks in rows from the top, those of a texture that is no block wide or high whole; what is lent beyond them is
    /// not read. `word` makes words of the panel of numbers: [`u16::to_be`] for `Rgb565Be`, [`u16::to_le`] for
    /// `Rgb565Le`, `|number| number` for `Rgb565`.
    ///
    /// A block is two colours, lowest byte first, and 4 bytes of indices, the leftmost texel of the top row in the lowest
    /// bits. With the first colour above the second as a number, indices are these two, 11/32 of the way to the second,
    /// and 21/32: the thirds of BC1, by the nearest 32nd. Else they are these two, their mean, and what is transparent.
    ///
    /// # Errors
    /// When a side is no power of two up to [`MAX_SIDE`](super::Texture::MAX_SIDE), or too little is lent.
    pub const fn new(
        blocks: &'t [u8],
        width: u32,
        height: u32,
        word: fn(u16) -> u16,
    ) -> Result<Self, TextureError> {
        let sides = match Sides::new(width, height) {
            Ok(sides) => sides,
            Err(error) => return Err(error),
        };
        let needed = (width.div_ceil(4) * height.div_ceil(4)) as usize * BYTES;
        let have = blocks.len();
        if have < needed {
            return Err(TextureError::Bytes { needed, have });
        }
        Ok(Self {
            blocks: blocks.split_at(needed).0,
            sides,
            word,
            key: None,
        })
    }

    /// The same texture, whose transparent texels are this word, the key of its [`texture`](Self::texture). Without one
    /// they are black.
    ///
    /// No other texel is a hole: one whose colour is this word has another lowest bit of blue.
    #[must_use]
    pub const fn keyed(self, key: u16) -> Self {
        Self {
            key: Some(key),
            ..self
        }
    }

    /// The texture without a cache: each texel is decoded where it is shown. It repeats.
    #[must_use]
    pub fn texture(&self) -> Texture<'_> {
        self.dressed(self)
    }

    /// A texture of its sides, with its key.
    pub(super) fn dressed<'a>(&self, texels: &'a dyn Texels) -> Texture<'a> {
        let mut texture = Texture::asked(texels, self.sides);
        texture.key = self.key;
        texture
    }

    /// A block by its number: two numbers of 5, 6 and 5 bits, one above the other, and its indices, two bits a texel, those
    /// of the first one lowest.
    #[inline(always)]
    fn block(&self, number: u32) -> [u32; 2] {
        let bytes = self.blocks.get(number as usize * BYTES..);
        let bytes = bytes.and_then(|bytes| bytes.first_chunk());
        let [a, b, c, d, e, f, g, h] = *bytes.unwrap_or(&[0; BYTES]);
        [[a, b, c, d], [e, f, g, h]].map(u32::from_le_bytes)
    }

    /// The word of an index.
    #[inline(always)]
    fn shown(&self, ends: u32, index: u32) -> u16 {
        let (first, second) = (ends as u16, (ends >> 16) as u16);
        let number = match (index, first > second) {
            (0, _) => first,
            (1, _) => second,
            (2, true) => mixed(first, second, 11),
            (2, false) => mixed(first, second, 16),
            (_, true) => mixed(first, second, 21),
            (_, false) => return self.key.unwrap_or((self.word)(0)),
        };
        let word = (self.word)(number);
        match self.key {
            Some(key) if key == word => (self.word)(number ^ 1),
            _ => word,
        }
    }

    /// The number of a texel's block, and how many bits of the block's indices lie below its own.
    #[inline(always)]
    fn place(&self, [column, row]: [u16; 2]) -> [u32; 2] {
        let [column, row] = [column, row].map(u32::from);
        let block = ((row / 4) << self.sides.log_width.saturating_sub(2)) | (column / 4);
        [block, 8 * (row % 4) + 2 * (column % 4)]
    }

    /// Decodes the block of an index into the words of a cache, whose blocks are `layout`; the texel of that index.
    #[inline(never)]
    pub(super) fn load(&self, index: u32, layout: Blocked, upper: u32, words: &[CacheWord]) -> u16 {
        let [ends, indices] = self.block(index >> layout.log_texels());
        let colours = [0, 1, 2, 3].map(|index| self.shown(ends, index));
        let mut down = indices;
        for row in words.chunks(layout.width() as usize) {
            let mut right = down;
            for word in row {
                word.set(upper, colours[right as usize % 4]);
                right >>= 2;
            }
            down >>= 8;
        }
        let [column, row] = layout.inside(index);
        colours[(indices >> (8 * row + 2 * column)) as usize % 4]
    }
}

impl Texels for Compressed<'_> {
    fn texel(&self, column: u16, row: u16) -> u16 {
        let [number, right] = self.place([column, row]);
        let [ends, indices] = self.block(number);
        self.shown(ends, indices >> right & 3)
    }

    /// A block is read once for all texels in succession that are its, and each of its colours is made once.
    fn fetch(&self, run: &mut [u16], way: TexelWay) {
        let (mut number, mut block) = (u32::MAX, [0; 2]);
        let (mut made, mut colours) = (0, [0; 4]);
        for (pixel, texel) in run.iter_mut().zip(way) {
            let [here, right] = self.place(texel);
            if here != number {
                (number, block, made) = (here, self.block(here), 0);
            }
            let index = block[1] >> right & 3;
            if made >> index & 1 == 0 {
                made |= 1 << index;
                colours[index as usize] = self.shown(block[0], index);
            }
            *pixel = colours[index as usize];
        }
    }
}

/// So many 32nds of the way from one number of 5, 6 and 5 bits to another, each channel rounded.
#[inline(always)]
fn mixed(from: u16, to: u16, part: u32) -> u16 {
    let [from, to] = [from, to].map(|number| (u32::from(number) * 0x1_0001) & CHANNELS);
    let mixed = (from * (32 - part) + to * part + HALF) >> 5 & CHANNELS;
    (mixed | mixed >> 16) as u16
}
