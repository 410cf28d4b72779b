//! How texels lie in memory, or who is asked for them (H7, H17).

use super::{Texels, Texture};

/// How texels lie in memory: rows from the top, but for those that are asked for. Slices have the exact length of the texture.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Form<'t> {
    /// A word of the panel each.
    Words(&'t [u16]),
    /// An index of 8 bits each.
    Index8(&'t [u8], &'t [u16; 256]),
    /// An index of 4 bits each; the first of a byte in its lower bits. Texels follow each other
    /// without gaps, whatever the width.
    Index4(&'t [u8], &'t [u16; 16]),
    /// An index of 2 bits each, likewise.
    Index2(&'t [u8], &'t [u16; 4]),
    /// An index of 1 bit each, likewise.
    Index1(&'t [u8], &'t [u16; 2]),
    /// Asked for by column and row; the power of two that the width is.
    Computed(&'t dyn Texels, u8),
}

/// Rows of a square of words, whose side is known to the compiler, so that no index needs a check.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Square<'t> {
    /// 32 texels a side.
    Side32(&'t [[u16; 32]; 32]),
    /// 64 texels a side.
    Side64(&'t [[u16; 64]; 64]),
    /// 128 texels a side.
    Side128(&'t [[u16; 128]; 128]),
    /// 256 texels a side.
    Side256(&'t [[u16; 256]; 256]),
}

/// A square of which texels are read along parabolas of places in one word.
#[derive(Clone, Copy, Debug)]
pub(crate) enum Bent<'t> {
    /// One that has loops of its own.
    Words(Square<'t>),
    /// One of indices of 8 or 4 bits, 32 to 128 texels a side.
    Indices(&'t Texture<'t>),
}

impl Bent<'_> {
    /// The power of two that its side is.
    #[inline(always)]
    pub(crate) const fn log(self) -> u32 {
        match self {
            Self::Words(square) => square.log(),
            Self::Indices(texture) => texture.log_width(),
        }
    }
}

impl Square<'_> {
    /// The power of two that its side is.
    #[inline(always)]
    pub(crate) const fn log(self) -> u32 {
        match self {
            Self::Side32(_) => 5,
            Self::Side64(_) => 6,
            Self::Side128(_) => 7,
            Self::Side256(_) => 8,
        }
    }
}

impl<'t> Texture<'t> {
    /// The rows, if it is one of the squares that have loops of their own.
    #[inline(always)]
    pub(crate) fn square(&self) -> Option<Square<'t>> {
        match (self.form, self.square) {
            (Form::Words(texels), 5) => rows(texels).map(Square::Side32),
            (Form::Words(texels), 6) => rows(texels).map(Square::Side64),
            (Form::Words(texels), 7) => rows(texels).map(Square::Side128),
            (Form::Words(texels), 8) => rows(texels).map(Square::Side256),
            _ => None,
        }
    }
}

impl Form<'_> {
    /// A texel by its index.
    #[inline(always)]
    pub(crate) fn get(&self, i: usize) -> Option<u16> {
        match *self {
            Form::Words(texels) => texels.get(i).copied(),
            Form::Index8(bytes, palette) => Some(palette[usize::from(*bytes.get(i)?)]),
            Form::Index4(bytes, palette) => {
                Some(palette[usize::from(*bytes.get(i / 2)? >> (4 * (i % 2))) % 16])
            }
            Form::Index2(bytes, palette) => {
                Some(palette[usize::from(*bytes.get(i / 4)? >> (2 * (i % 4))) % 4])
            }
            Form::Index1(bytes, palette) => {
                Some(palette[usize::from(*bytes.get(i / 8)? >> (i % 8)) % 2])
            }
            Form::Computed(texels, log_width) => Some(computed(texels, log_width, i)),
        }
    }
}

/// A computed texel by its index. Called, so that those of memory take no more code than a call.
#[inline(never)]
fn computed(texels: &dyn Texels, log_width: u8, i: usize) -> u16 {
    let log_width = log_width & 31;
    texels.texel((i & ((1 << log_width) - 1)) as u16, (i >> log_width) as u16)
}

/// Words as `N` rows of `N`.
#[inline(always)]
fn rows<const N: usize>(texels: &[u16]) -> Option<&[[u16; N]; N]>
where
    [u16; N]: bytemuck::Pod,
{
    bytemuck::try_cast_slice(texels).ok()?.try_into().ok()
}
