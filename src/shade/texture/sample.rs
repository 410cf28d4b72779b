//! Textures in memory: sides, what lies beyond them, and filters (H6, H7).
//!
//! Sides are powers of two from 1 to 1024, so an index is made of masks. [`Texture`] serves every
//! size, layout and way beyond the sides; [`Square`] has its size in its type and reads two
//! places at once from two words, which is what the fastest loops need.

use super::block::{Layout, Linear};
use super::tlut::Store;
use super::{FRACTION, Period, Texels, Uv, place_by_place};
use crate::visible::Visible;
use core::marker::PhantomData;

/// Longest side of a texture, in texels.
pub const MAX_SIDE: u32 = 1024;

/// A texture cannot be made of what was lent.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum TextureError {
    /// A side is not a power of two from 1 to [`MAX_SIDE`].
    Side {
        /// Width asked for.
        width: u32,
        /// Height asked for.
        height: u32,
    },
    /// Fewer texels than the size has.
    Texels {
        /// Texels of the size.
        needed: usize,
        /// Texels lent.
        have: usize,
    },
    /// Fewer bytes than the texels take.
    Bytes {
        /// Bytes of the texels.
        needed: usize,
        /// Bytes lent.
        have: usize,
    },
}

impl core::fmt::Display for TextureError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Side { width, height } => write!(
                f,
                "texture: {width}x{height}, where sides are powers of two from 1 to {MAX_SIDE}"
            ),
            Self::Texels { needed, have } => {
                write!(f, "texture: {needed} texels are needed, there are {have}")
            }
            Self::Bytes { needed, have } => {
                write!(f, "texture: {needed} bytes are needed, there are {have}")
            }
        }
    }
}

impl core::error::Error for TextureError {}

/// The sides of a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Hash)]
pub struct Size {
    log_width: u8,
    log_height: u8,
}

impl Size {
    /// Both sides powers of two from 1 to [`MAX_SIDE`].
    ///
    /// # Errors
    /// When one is not.
    pub const fn new(width: u32, height: u32) -> Result<Self, TextureError> {
        if width.is_power_of_two()
            && height.is_power_of_two()
            && width <= MAX_SIDE
            && height <= MAX_SIDE
        {
            Ok(Self {
                log_width: width.trailing_zeros() as u8,
                log_height: height.trailing_zeros() as u8,
            })
        } else {
            Err(TextureError::Side { width, height })
        }
    }

    /// Texels a row.
    #[must_use]
    pub const fn width(self) -> u32 {
        1 << self.log_width
    }

    /// Rows.
    #[must_use]
    pub const fn height(self) -> u32 {
        1 << self.log_height
    }

    /// The power of two that the width is.
    #[inline(always)]
    #[must_use]
    pub const fn log_width(self) -> u32 {
        self.log_width as u32
    }

    /// The power of two that the height is.
    #[inline(always)]
    #[must_use]
    pub const fn log_height(self) -> u32 {
        self.log_height as u32
    }

    /// All texels.
    #[must_use]
    pub const fn texels(self) -> usize {
        1 << (self.log_width + self.log_height)
    }

    /// The size of a level of detail: half of it at each level, at least 1.
    #[must_use]
    pub const fn level(self, level: u32) -> Self {
        Self {
            log_width: (self.log_width as u32).saturating_sub(level) as u8,
            log_height: (self.log_height as u32).saturating_sub(level) as u8,
        }
    }
}

/// What lies beyond the sides of a texture.
pub trait Address: Copy {
    /// How sides of `2^log` texels go on.
    fn period(_log: u32) -> Period {
        Period::Long
    }

    /// The column or row that stands for `texel` on a side of `2^log` texels: below `2^log`.
    fn side(texel: i32, log: u32) -> u32;
}

/// The texture again.
#[derive(Clone, Copy, Debug)]
pub struct Wrap;

/// Its mirror image, and then the texture again.
#[derive(Clone, Copy, Debug)]
pub struct Mirror;

/// The texels at its rim.
#[derive(Clone, Copy, Debug)]
pub struct Clamp;

impl Address for Wrap {
    fn period(_: u32) -> Period {
        Period::Short
    }

    #[inline(always)]
    fn side(texel: i32, log: u32) -> u32 {
        texel as u32 & ((1 << log) - 1)
    }
}

impl Address for Mirror {
    /// It repeats after its image.
    fn period(log: u32) -> Period {
        if log < MAX_SIDE.ilog2() {
            Period::Short
        } else {
            Period::Long
        }
    }

    #[inline(always)]
    fn side(texel: i32, log: u32) -> u32 {
        // All ones in every second repeat, which runs backwards.
        let back = -(texel >> log & 1);
        (texel ^ back) as u32 & ((1 << log) - 1)
    }
}

impl Address for Clamp {
    fn period(_: u32) -> Period {
        Period::Never
    }

    #[inline(always)]
    fn side(texel: i32, log: u32) -> u32 {
        texel.clamp(0, (1 << log) - 1) as u32
    }
}

/// A texture of any size, the nearest texel.
#[derive(Clone, Copy, Debug)]
pub struct Texture<S, A = Wrap, L = Linear> {
    store: S,
    size: Size,
    layout: L,
    address: PhantomData<A>,
}

impl<S: Store, A: Address> Texture<S, A> {
    /// Rows of texels from the top.
    ///
    /// # Errors
    /// When the store has fewer texels than the size.
    pub fn new(store: S, size: Size) -> Result<Self, TextureError> {
        Self::arranged(store, size, Linear)
    }
}

impl<S: Store, A: Address, L: Layout> Texture<S, A, L> {
    /// Texels in another layout.
    ///
    /// # Errors
    /// When the store has fewer texels than the size.
    pub fn arranged(store: S, size: Size, layout: L) -> Result<Self, TextureError> {
        let (needed, have) = (size.texels(), store.count());
        if have < needed {
            return Err(TextureError::Texels { needed, have });
        }
        Ok(Self {
            store,
            size,
            layout,
            address: PhantomData,
        })
    }

    /// The sides.
    #[must_use]
    pub fn size(&self) -> Size {
        self.size
    }

    /// The index in the store of the texel that stands at a column and row.
    #[inline(always)]
    pub fn index(&self, (column, row): (i32, i32)) -> usize {
        let x = A::side(column, self.size.log_width());
        let y = A::side(row, self.size.log_height());
        self.layout.index((x, y), self.size)
    }

    /// The texel that stands at a column and row.
    #[inline(always)]
    pub fn texel(&self, at: (i32, i32)) -> S::Texel {
        self.store.fetch(self.index(at))
    }
}

impl<S: Store> Texture<S> {
    /// The texture as one of `2^LOG` texels each side, `N` in all, which has the fastest loops;
    /// `None` when it has another size, or its store no such way.
    #[inline(always)]
    #[must_use]
    pub fn square<const LOG: u32, const N: usize>(
        &self,
    ) -> Option<Square<impl Fn(usize) -> S::Texel + Copy, LOG>> {
        const {
            assert!(LOG <= 8 && N == 1 << (2 * LOG));
        }
        let fits = self.size.log_width() == LOG && self.size.log_height() == LOG;
        self.store.fetch_in::<N>().filter(|_| fits).map(Square)
    }
}

impl<S: Store, A: Address, L: Layout> Texels for Texture<S, A, L> {
    type Texel = S::Texel;
    const LONG: bool = S::LONG;

    #[inline(always)]
    fn at(&self, place: Uv) -> S::Texel {
        self.texel(place.texel())
    }

    fn period(&self) -> Period {
        A::period(self.size.log_width().max(self.size.log_height()))
    }

    #[inline(always)]
    fn singly<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        each: impl FnMut(&mut W, Option<S::Texel>),
    ) {
        // A copy that nothing else can see stays in registers whatever is written meanwhile.
        let texture = *self;
        let mut fetch = texture.store.reader();
        let at = |place: Uv| fetch(texture.index(place.texel()));
        place_by_place(pixels, (from, step), visible, at, each);
    }
}

/// A texture of `2^LOG` texels each side, at most 256, repeating, in rows.
///
/// A run is read two pixels at a time: u of both in one word, v of both in another, 16 bits each,
/// so that two indices cost three logical instructions. In 16 pixels a place gets at most
/// 10/256 texel off at 256 texels a side, and 1/256 more each time it goes beyond a side, so it is
/// taken anew every 16 pixels, every 32 with 128 texels a side, and so on: less than 1/16 texel,
/// where a pixel's step is less than a quarter of the side.
///
/// The places of pixels do not depend on which are seen.
#[derive(Clone, Copy, Debug)]
pub struct Square<F, const LOG: u32>(F);

/// Texels by index, for [`Square`]: a function, or [`Whole`].
pub trait Fetch {
    /// A texel as it is stored.
    type Texel: Copy;

    /// The texel at an index below the square of the side; any texel at others.
    fn fetch(&self, index: usize) -> Self::Texel;
}

impl<T: Copy, F: Fn(usize) -> T> Fetch for F {
    type Texel = T;

    #[inline(always)]
    fn fetch(&self, index: usize) -> T {
        self(index)
    }
}

/// `N` texels, a power of two, whose number is known when it is compiled.
#[derive(Clone, Copy, Debug)]
pub struct Whole<'t, W, const N: usize>(&'t [W; N]);

impl<W: Copy, const N: usize> Fetch for Whole<'_, W, N> {
    type Texel = W;

    #[inline(always)]
    fn fetch(&self, index: usize) -> W {
        self.0[index & (N - 1)]
    }
}

/// 64 x 64 texels of a word each.
pub type Square64<'t, W> = Square<Whole<'t, W, 4096>, 6>;
/// 128 x 128 texels of a word each.
pub type Square128<'t, W> = Square<Whole<'t, W, 16_384>, 7>;
/// 256 x 256 texels of a word each.
pub type Square256<'t, W> = Square<Whole<'t, W, 65_536>, 8>;

impl<'t, W, const N: usize, const LOG: u32> Square<Whole<'t, W, N>, LOG> {
    /// Rows of texels from the top.
    #[must_use]
    pub const fn new(texels: &'t [W; N]) -> Self {
        const {
            assert!(LOG <= 8 && N == 1 << (2 * LOG));
        }
        Self(Whole(texels))
    }
}

/// A value in both halves of a word.
const fn twice(half: u32) -> u32 {
    half & 0xFFFF | half << 16
}

impl<F: Fetch, const LOG: u32> Texels for Square<F, LOG> {
    type Texel = F::Texel;

    fn period(&self) -> Period {
        Period::Short
    }

    #[inline(always)]
    fn at(&self, place: Uv) -> F::Texel {
        let mask = (1 << LOG) - 1;
        let row = (place.v >> (FRACTION - LOG)) as u32 & mask << LOG;
        self.0
            .fetch((row | (place.u >> FRACTION) as u32 & mask) as usize)
    }

    #[inline(always)]
    fn along<W>(
        &self,
        pixels: &mut [W],
        mut from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        mut each: impl FnMut(&mut W, Option<F::Texel>),
    ) {
        let anchor = const { 16 << (8 - LOG) };
        let ahead = Uv {
            u: step.u.wrapping_mul(anchor as i32),
            v: step.v.wrapping_mul(anchor as i32),
        };
        let mut rest = pixels;
        while rest.len() > anchor {
            let (run, more) = rest.split_at_mut(anchor);
            self.pairs(run, from, step, visible, &mut each);
            from = from.plus(ahead);
            rest = more;
        }
        self.pairs(rest, from, step, visible, &mut each);
    }
}

impl<F: Fetch, const LOG: u32> Square<F, LOG> {
    /// [`along`](Texels::along), from one pair of words on.
    #[inline(always)]
    fn pairs<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        mut each: impl FnMut(&mut W, Option<F::Texel>),
    ) {
        // Packing pays from the third pair on.
        if pixels.len() <= 4 {
            self.singly(pixels, from, step, visible, each);
            return;
        }
        // 16 bits hold a whole side, 16 - LOG of them fractions.
        let half = |x: i32| x >> (FRACTION - 16 + LOG);
        let both =
            |x: i32, dx: i32| half(x) as u32 & 0xFFFF | (half(x.wrapping_add(dx)) as u32) << 16;
        // The step of two pixels, rounded down. Added as a number with its sign, so that the lower
        // half's carry is made up for.
        let two = |dx: i32| {
            let d = dx >> (FRACTION - 17 + LOG);
            d.wrapping_add(d << 16) as u32
        };
        let (mut u, mut v) = (both(from.u, step.u), both(from.v, step.v));
        let (du, dv) = (two(step.u), two(step.v));
        let columns = twice((1 << LOG) - 1);
        let rows = twice(((1 << LOG) - 1) << LOG);
        let mut two_pixels = |pair: &mut [W; 2]| {
            let both = u >> (16 - LOG) & columns | v >> (16 - 2 * LOG) & rows;
            u = u.wrapping_add(du);
            v = v.wrapping_add(dv);
            let (mut now, next) = ((both & 0xFFFF) as usize, (both >> 16) as usize);
            visible.block(pair, |pixel, shown| {
                each(pixel, shown.then(|| self.0.fetch(now)));
                now = next;
            });
        };
        let (blocks, rest) = pixels.split_at_mut(pixels.len() & !7);
        for block in blocks.chunks_exact_mut(8) {
            for pair in block.chunks_exact_mut(2).filter_map(two_of) {
                two_pixels(pair);
            }
        }
        let (pairs, last) = rest.split_at_mut(rest.len() & !1);
        for pair in pairs.chunks_exact_mut(2).filter_map(two_of) {
            two_pixels(pair);
        }
        if !last.is_empty() {
            let index = u >> (16 - LOG) & columns | v >> (16 - 2 * LOG) & rows;
            let index = (index & 0xFFFF) as usize;
            visible.each(last, |pixel, shown| {
                each(pixel, shown.then(|| self.0.fetch(index)));
            });
        }
    }
}

/// Two pixels as an array.
#[inline(always)]
fn two_of<W>(pair: &mut [W]) -> Option<&mut [W; 2]> {
    pair.try_into().ok()
}
