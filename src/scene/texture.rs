//! Textures as values: form, sides, palette and what lies beyond the sides, all known at run time (H7).
//!
//! Textures of all forms and sizes serve one scene: a span looks once which loop reads its texels
//! (room `look`). All constructors are `const`, so that a texture can be a static:
//!
//! ```
//! # use scanbeam::scene::Texture;
//! # static TEXELS: [u16; 4096] = [0; 4096];
//! static BRICKS: Texture = match Texture::words(&TEXELS, 64, 64) {
//!     Ok(texture) => texture,
//!     Err(_) => panic!("64 x 64 texels"),
//! };
//! ```
//!
//! Texels are words of the panel, in its byte order, so that a copy is a copy.

use super::form::{Bent, Form, Square};
use super::{Sampling, Texels};
use core::fmt;

/// A texture cannot be made of what was lent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TextureError {
    /// A side is not a power of two from 1 to [`MAX_SIDE`](Texture::MAX_SIDE).
    Side {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// Fewer words than the sides need.
    Words {
        /// Words of the sides.
        needed: usize,
        /// Words lent.
        have: usize,
    },
    /// Fewer bytes than the sides need.
    Bytes {
        /// Bytes of the sides.
        needed: usize,
        /// Bytes lent.
        have: usize,
    },
    /// A level of detail does not have half the sides of the one before.
    Level {
        /// Its number, 1 for the first below the texture.
        level: usize,
        /// Its width.
        width: u32,
        /// Its height.
        height: u32,
    },
    /// A mask has other sides, another form or another number of levels than its texture.
    Mask,
    /// Fewer colours than an index can name.
    Palette {
        /// Colours that an index can name.
        needed: usize,
        /// Colours lent.
        have: usize,
    },
}

impl fmt::Display for TextureError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let (needed, have, what) = match self {
            Self::Side { width, height } => {
                return write!(
                    f,
                    "texture: {width}x{height}, where sides are powers of two from 1 to {}",
                    Texture::MAX_SIDE
                );
            }
            Self::Level {
                level,
                width,
                height,
            } => {
                return write!(
                    f,
                    "texture: level {level} has {width}x{height} texels, not half the sides of the one before"
                );
            }
            Self::Mask => return f.write_str("texture: its mask is not of the same form"),
            Self::Words { needed, have } => (needed, have, "words"),
            Self::Bytes { needed, have } => (needed, have, "bytes"),
            Self::Palette { needed, have } => (needed, have, "colours of the palette"),
        };
        write!(f, "texture: {needed} {what} are needed, there are {have}")
    }
}

impl core::error::Error for TextureError {}

/// What lies beyond the sides of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash, Default)]
pub enum Wrap {
    /// The texture again.
    #[default]
    Repeat,
    /// The texels at its rim.
    Clamp,
    /// Its mirror image, and then the texture again.
    Mirror,
}

/// A texture: texels or indices that somebody else keeps or computes, and how they are read.
#[derive(Clone, Copy, Debug)]
pub struct Texture<'t> {
    pub(crate) form: Form<'t>,
    pub(super) sides: Sides,
    /// The power of two of both sides of what is [`Bent`]; else 0.
    pub(super) square: u8,
    /// Spare bits of places in one word, where that is how places are found; none where texels are sampled.
    pub(crate) spare: u8,
    pub(super) wrap: Wrap,
    pub(super) key: Option<u16>,
    /// How its texels are taken, if not by the nearest one of this size.
    pub(crate) sampling: Option<Sampling>,
    /// What its texels say of themselves beside their colour: of the same form, sides and levels.
    pub(super) mask: Option<&'t Texture<'t>>,
    /// Each half of the one before.
    coarser: &'t [Texture<'t>],
}

/// The powers of two that the sides are.
#[derive(Clone, Copy, Debug)]
pub(super) struct Sides {
    pub(super) log_width: u8,
    pub(super) log_height: u8,
}

impl Sides {
    pub(super) const fn new(width: u32, height: u32) -> Result<Self, TextureError> {
        let are_powers = width.is_power_of_two() && height.is_power_of_two();
        if !are_powers || width > Texture::MAX_SIDE || height > Texture::MAX_SIDE {
            return Err(TextureError::Side { width, height });
        }
        Ok(Self {
            log_width: width.trailing_zeros() as u8,
            log_height: height.trailing_zeros() as u8,
        })
    }

    pub(super) const fn texels(self) -> usize {
        1 << (self.log_width + self.log_height)
    }

    /// Spare bits of places in one word: 2 where no side is above 128, 1 up to 256, else none.
    const fn spare(self) -> u8 {
        let longest = if self.log_width > self.log_height {
            self.log_width
        } else {
            self.log_height
        };
        match longest {
            0..=7 => 2,
            8 => 1,
            _ => 0,
        }
    }
}

/// A constructor of textures with indices of `$bits` bits.
macro_rules! indexed {
    ($name:ident, $form:ident, $bits:literal, $order:literal) => {
        #[doc = concat!("Indices of ", $bits, " bits into a palette of words of the panel.")]
        #[doc = concat!($order, "; rows follow without gaps.")]
        /// Repeats; see [`wrapping`](Self::wrapping). What is lent beyond the need is not read.
        ///
        /// # Errors
        /// When a side is not a power of two up to [`MAX_SIDE`](Texture::MAX_SIDE), or too little is lent.
        pub const fn $name(
            bytes: &'t [u8],
            palette: &'t [u16],
            width: u32,
            height: u32,
        ) -> Result<Self, TextureError> {
            let sides = match Sides::new(width, height) {
                Ok(sides) => sides,
                Err(error) => return Err(error),
            };
            let (needed, have) = ((sides.texels() * $bits).div_ceil(8), bytes.len());
            if have < needed {
                return Err(TextureError::Bytes { needed, have });
            }
            let Some(palette) = palette.first_chunk() else {
                let (needed, have) = (1 << $bits, palette.len());
                return Err(TextureError::Palette { needed, have });
            };
            let bytes = bytes.split_at(needed).0;
            Ok(Self::new(Form::$form(bytes, palette), sides))
        }
    };
}

impl<'t> Texture<'t> {
    /// Longest side of a texture, in texels.
    pub const MAX_SIDE: u32 = 1024;
    /// A black texel, for memory that textures are to be put into.
    pub const EMPTY: Self = match Self::words(&[0], 1, 1) {
        Ok(texture) => texture,
        Err(_) => unreachable!(),
    };

    const fn new(form: Form<'t>, sides: Sides) -> Self {
        let square = match (&form, sides.log_width) {
            _ if sides.log_width != sides.log_height => 0,
            (Form::Words(_), log @ 5..=8) => log,
            (Form::Index8(..) | Form::Index4(..), log @ 5..=7) => log,
            _ => 0,
        };
        Self {
            form,
            sides,
            square,
            spare: sides.spare(),
            wrap: Wrap::Repeat,
            key: None,
            sampling: None,
            mask: None,
            coarser: &[],
        }
    }

    /// Words of the panel, in its byte order, in rows from the top.
    ///
    /// Repeats; see [`wrapping`](Self::wrapping). What is lent beyond the need is not read.
    ///
    /// # Errors
    /// When a side is not a power of two up to [`MAX_SIDE`](Texture::MAX_SIDE), or too little is lent.
    pub const fn words(texels: &'t [u16], width: u32, height: u32) -> Result<Self, TextureError> {
        let sides = match Sides::new(width, height) {
            Ok(sides) => sides,
            Err(error) => return Err(error),
        };
        let (needed, have) = (sides.texels(), texels.len());
        if have < needed {
            return Err(TextureError::Words { needed, have });
        }
        let texels = texels.split_at(needed).0;
        Ok(Self::new(Form::Words(texels), sides))
    }

    indexed!(index8, Index8, 8, "A byte a texel, in rows from the top");
    indexed!(
        index4,
        Index4,
        4,
        "The left one of two texels is in a byte's lower bits"
    );
    indexed!(
        index2,
        Index2,
        2,
        "The leftmost texel is in a byte's lowest bits"
    );
    indexed!(
        index1,
        Index1,
        1,
        "The leftmost texel is in a byte's lowest bit"
    );

    /// Texels that are computed where they are shown (H17), or fetched from somewhere (B5): words of the panel, in its
    /// byte order, for each column and row below the sides.
    ///
    /// Repeats; see [`wrapping`](Self::wrapping). It has what others have: wraps, a key, levels of detail, filters.
    ///
    /// # Errors
    /// When a side is not a power of two up to [`MAX_SIDE`](Texture::MAX_SIDE).
    pub const fn computed(
        texels: &'t dyn Texels,
        width: u32,
        height: u32,
    ) -> Result<Self, TextureError> {
        match Sides::new(width, height) {
            Ok(sides) => Ok(Self::asked(texels, sides)),
            Err(error) => Err(error),
        }
    }

    /// The same of known sides.
    pub(super) const fn asked(texels: &'t dyn Texels, sides: Sides) -> Self {
        Self::new(Form::Computed(texels, sides.log_width), sides)
    }

    /// The same texture with something else beyond its sides.
    #[must_use]
    pub const fn wrapping(self, wrap: Wrap) -> Self {
        Self { wrap, ..self }
    }

    /// The same texture, whose texels of this word of the panel are transparent (H7): holes, or where the colour of a
    /// triangle is seen, as [`Application`](super::Application) says.
    ///
    /// Of indices the word is that of the palette: one that stands for nothing else is an index that is transparent.
    /// Where fixed point is between two texels, it is one of them, so no colour is between a texel and the key.
    #[must_use]
    pub const fn keyed(self, key: u16) -> Self {
        Self {
            key: Some(key),
            ..self
        }
    }

    /// The same texture, whose texels are taken in another way than the nearest one of this size (H6).
    ///
    /// `coarser` are levels of detail below it, each half as wide and half as high as the one before (a side of one
    /// texel stays), for where the texture is small on the picture; there may be any number, or none. Their wrap and
    /// their key are those of the texture.
    ///
    /// # Errors
    /// A level of other sides; a [mask](Texture::masked) with another number of levels.
    pub const fn sampled(
        self,
        sampling: Sampling,
        coarser: &'t [Texture<'t>],
    ) -> Result<Self, TextureError> {
        let (mut width, mut height) = (self.width(), self.height());
        let mut i = 0;
        while i < coarser.len() {
            let is_least = width == 1 && height == 1;
            (width, height) = (half(width), half(height));
            let (of, level) = (&coarser[i], i + 1);
            if is_least || of.width() != width || of.height() != height {
                let (width, height) = (of.width(), of.height());
                return Err(TextureError::Level {
                    level,
                    width,
                    height,
                });
            }
            i = level;
        }
        if matches!(self.mask, Some(mask) if mask.levels() != coarser.len()) {
            return Err(TextureError::Mask);
        }
        Ok(Self {
            spare: 0,
            sampling: Some(sampling),
            coarser,
            ..self
        })
    }

    /// How many levels there are below it.
    pub(crate) const fn levels(&self) -> usize {
        self.coarser.len()
    }

    /// One of its levels, 0 for itself, with its wrap and its key.
    pub(crate) fn level(&self, level: usize) -> Self {
        Self {
            wrap: self.wrap,
            key: self.key,
            ..*self.texels_of(level)
        }
    }

    /// The same as it was lent: with a wrap and a key that mean nothing.
    #[inline(always)]
    pub(crate) fn texels_of(&self, level: usize) -> &Self {
        let coarser = level.checked_sub(1).and_then(|i| self.coarser.get(i));
        coarser.unwrap_or(self)
    }

    /// The word of texels that are transparent.
    #[must_use]
    pub const fn key(&self) -> Option<u16> {
        self.key
    }

    /// What lies beyond the sides.
    #[inline(always)]
    #[must_use]
    pub const fn wrap(&self) -> Wrap {
        self.wrap
    }

    /// Texels a row.
    #[must_use]
    pub const fn width(&self) -> u32 {
        1 << self.sides.log_width
    }

    /// Rows.
    #[must_use]
    pub const fn height(&self) -> u32 {
        1 << self.sides.log_height
    }

    /// The power of two that the width is: 0 to 10.
    #[inline(always)]
    #[must_use]
    pub const fn log_width(&self) -> u32 {
        self.sides.log_width as u32
    }

    /// The power of two that the height is: 0 to 10.
    #[inline(always)]
    #[must_use]
    pub const fn log_height(&self) -> u32 {
        self.sides.log_height as u32
    }

    /// [`spare`](Self::spare) of a texture that has levels of detail.
    pub(crate) const fn spare_of_sides(&self) -> u8 {
        self.sides.spare()
    }

    /// The power of two of both sides where it is [`bent`](Self::bent); else 0.
    #[inline(always)]
    pub(crate) fn repeated(&self) -> u32 {
        match self.wrap {
            Wrap::Repeat => self.square.into(),
            _ => 0,
        }
    }

    /// It as what is read along parabolas, if it is such a square and repeats.
    #[inline(always)]
    pub(crate) fn bent(&self) -> Option<Bent<'_>> {
        if self.repeated() == 0 {
            return None;
        }
        Some(self.square().map_or(Bent::Indices(self), Bent::Words))
    }

    /// Whether its texels are words, of which the nearest is taken.
    #[inline(always)]
    pub(crate) fn is_of_words(&self) -> bool {
        self.sampling.is_none() && matches!(self.form, Form::Words(_))
    }

    /// The rows, if it is one of the squares that have loops of their own, and the nearest texel is taken.
    #[inline(always)]
    pub(crate) fn plain_square(&self) -> Option<Square<'t>> {
        self.square().filter(|_| self.sampling.is_none())
    }
}

/// Half of a side, which has one texel at least.
pub(crate) const fn half(side: u32) -> u32 {
    if side > 1 { side / 2 } else { 1 }
}
