//! Texels in memory: whole words, and indices into a lookup table (H7).
//!
//! A [`Store`] is a number of texels by index. It has no sides and no layout; those belong to
//! [`Texture`](super::Texture). An index beyond the end wraps into the store, whatever its length,
//! so that no read needs a check that can fail.

use super::TextureError;

/// Texels by index.
pub trait Store: Copy {
    /// A texel as it is stored, or as its table has it.
    type Texel: Copy;

    /// Whether a texel takes long: see [`Texels::LONG`](super::Texels::LONG).
    const LONG: bool = false;

    /// How many texels there are.
    fn count(&self) -> usize;

    /// The texel at an index below [`count`](Store::count), which is a power of two; at other
    /// indices, any texel.
    fn fetch(&self, index: usize) -> Self::Texel;

    /// [`fetch`](Store::fetch) for the texels of a run, one after the other: a store that keeps
    /// something may remember where it found the last one.
    #[inline(always)]
    fn reader(&self) -> impl FnMut(usize) -> Self::Texel {
        let store = *self;
        move |index| store.fetch(index)
    }

    /// [`fetch`](Store::fetch) for a store of exactly `N` texels, a power of two, which needs no
    /// length at run time; `None` where there are not as many, or the form has no such way.
    fn fetch_in<const N: usize>(&self) -> Option<impl Fn(usize) -> Self::Texel + Copy>;
}

/// Texels of a word each: 16, 24 or 32 bits, or words of the display.
#[derive(Clone, Copy, Debug)]
pub struct Words<'t, W>(
    /// The texels, in the layout of the texture.
    pub &'t [W],
);

impl<W: Copy + Default> Store for Words<'_, W> {
    type Texel = W;

    fn count(&self) -> usize {
        self.0.len()
    }

    #[inline(always)]
    fn fetch(&self, index: usize) -> W {
        let count = self.0.len();
        if count == 0 {
            return W::default();
        }
        self.0[index & (count - 1)]
    }

    #[inline(always)]
    fn fetch_in<const N: usize>(&self) -> Option<impl Fn(usize) -> W + Copy> {
        let texels: &[W; N] = self.0.try_into().ok()?;
        Some(move |index: usize| texels[index & (N - 1)])
    }
}

/// Texels of `BITS` bits (1, 2, 4, 6 or 8) that a table of `COLOURS = 2^BITS` words expands.
///
/// Bits are taken from the low end of each byte on, and follow each other without gaps: 8
/// texels of 4 bits fill a 32-bit word, 4 texels of 6 bits fill 3 bytes.
#[derive(Clone, Copy, Debug)]
pub struct Indexed<'t, const BITS: u32, const COLOURS: usize, W> {
    bytes: &'t [u8],
    table: &'t [W; COLOURS],
    count: usize,
}

impl<'t, const BITS: u32, const COLOURS: usize, W> Indexed<'t, BITS, COLOURS, W> {
    /// `count` texels, a power of two, and their table. A table of another length than `2^BITS`,
    /// or another number of bits than 1, 2, 4, 6 or 8, does not compile.
    ///
    /// # Errors
    /// When there are fewer bytes than `count` texels take.
    pub fn new(
        bytes: &'t [u8],
        table: &'t [W; COLOURS],
        count: usize,
    ) -> Result<Self, TextureError> {
        const {
            assert!(matches!(BITS, 1 | 2 | 4 | 6 | 8) && COLOURS == 1 << BITS);
        }
        let needed = count.saturating_mul(BITS as usize).div_ceil(8);
        let have = bytes.len();
        let bytes = bytes
            .get(..needed)
            .ok_or(TextureError::Bytes { needed, have })?;
        Ok(Self {
            bytes,
            table,
            count,
        })
    }

    /// The index into the table.
    #[inline(always)]
    fn code(&self, index: usize) -> u8 {
        let length = self.bytes.len();
        if length == 0 {
            return 0;
        }
        if BITS == 6 {
            // 4 texels in 3 bytes; a texel reaches into the next byte, but never beyond the last.
            let index = index & (self.count.wrapping_sub(1));
            let bit = 6 * index;
            let low = self.bytes.get(bit / 8).map_or(0, |b| u32::from(*b));
            let high = self.bytes.get(bit / 8 + 1).map_or(0, |b| u32::from(*b));
            return ((low | high << 8) >> (bit % 8)) as u8;
        }
        let per_byte = (8 / BITS.clamp(1, 8)) as usize;
        let byte = self.bytes[(index / per_byte) & (length - 1)];
        byte >> ((index % per_byte) as u32 * BITS)
    }
}

impl<const BITS: u32, const COLOURS: usize, W: Copy> Store for Indexed<'_, BITS, COLOURS, W> {
    type Texel = W;

    fn count(&self) -> usize {
        self.count
    }

    #[inline(always)]
    fn fetch(&self, index: usize) -> W {
        self.table[usize::from(self.code(index)) & (COLOURS - 1)]
    }

    #[inline(always)]
    fn fetch_in<const N: usize>(&self) -> Option<impl Fn(usize) -> W + Copy> {
        // Others than whole bytes have no short way.
        let bytes: &[u8; N] = self.bytes.try_into().ok().filter(|_| BITS == 8)?;
        let table = self.table;
        Some(move |index: usize| table[usize::from(bytes[index & (N - 1)]) & (COLOURS - 1)])
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    /// Packs codes from the low end of each byte on, bit by bit.
    fn packed(codes: &[u8], bits: usize) -> Vec<u8> {
        let mut bytes = std::vec![0u8; (codes.len() * bits).div_ceil(8)];
        for (i, code) in codes.iter().enumerate() {
            for bit in 0..bits {
                let at = i * bits + bit;
                bytes[at / 8] |= (code >> bit & 1) << (at % 8);
            }
        }
        bytes
    }

    fn round_trip<const BITS: u32, const COLOURS: usize>() {
        let table: [u16; COLOURS] = core::array::from_fn(|i| 0x4000 | i as u16);
        for log in 0..12 {
            let count = 1usize << log;
            let codes: Vec<u8> = (0..count)
                .map(|i| ((i * 37 + i / 7) % COLOURS) as u8)
                .collect();
            let bytes = packed(&codes, BITS as usize);
            let store = Indexed::<BITS, COLOURS, u16>::new(&bytes, &table, count).unwrap();
            for (i, code) in codes.iter().enumerate() {
                assert_eq!(
                    store.fetch(i),
                    0x4000 | u16::from(*code),
                    "{BITS} bits, {i}"
                );
                assert_eq!(store.fetch(i + 8 * count), store.fetch(i), "wraps");
            }
            let short = Indexed::<BITS, COLOURS, u16>::new(&bytes[1..], &table, count);
            assert_eq!(
                short.unwrap_err(),
                TextureError::Bytes {
                    needed: bytes.len(),
                    have: bytes.len() - 1
                }
            );
        }
    }

    #[test]
    fn every_depth_reads_what_was_packed() {
        round_trip::<1, 2>();
        round_trip::<2, 4>();
        round_trip::<4, 16>();
        round_trip::<6, 64>();
        round_trip::<8, 256>();
    }

    #[test]
    fn words_wrap_and_none_is_no_panic() {
        assert_eq!(Words::<u32>(&[]).fetch(3), 0);
        assert_eq!(Words(&[1, 2, 3, 4]).fetch(6), 3);
        // Not a power of two: some texel.
        assert!((1..4).contains(&Words(&[1, 2, 3]).fetch(7)));
        let table = [0; 2];
        let none = Indexed::<1, 2, i32>::new(&[], &table, 0).unwrap();
        assert_eq!(none.fetch(9), 0);
        assert!(Words(&[1, 2, 3, 4]).fetch_in::<8>().is_none());
        assert_eq!(Words(&[1, 2, 3, 4]).fetch_in::<4>().unwrap()(5), 2);
    }
}
