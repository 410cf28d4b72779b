//! Stages two and three: which pixels are seen, what colour they have, what becomes of them.
//!
//! Both are the same unit wired differently. Each keeps the ends of the current span from
//! set-up tokens, and each pixel brings nothing but a weight (K8, K9, K11).

use super::buffers::{LineBuffers, WORD, Word40};
use super::format::{ProcessingFormat, Word36, widen};
use super::lirp::{SPAN_BITS, lirp};
use super::token::{Argb10, GlobalMode, ParameterSetup, PixelToken, ZSetup};

/// A level of 1: opaque, full.
const FULL: u16 = 0x3FF;

impl Argb10 {
    /// From 8-bit levels, opaque; full stays full.
    #[must_use]
    pub fn from_rgb8(rgb: [u8; 3]) -> Self {
        let [r, g, b] = rgb.map(|level| widen(widen(level.into(), 8, 9), 9, 10) as u16);
        Self { a: FULL, r, g, b }
    }

    /// The four levels as a word of a scanline.
    #[must_use]
    pub fn to_word(self) -> Word40 {
        self.channels()
            .iter()
            .fold(0, |word, level| word << 10 | u64::from(level & FULL))
    }

    /// The four levels of a word of a scanline.
    #[must_use]
    pub fn from_word(word: Word40) -> Self {
        Self::from_channels([30, 20, 10, 0].map(|down| (word >> down) as u16 & FULL))
    }

    const fn channels(self) -> [u16; 4] {
        [self.a, self.r, self.g, self.b]
    }

    const fn from_channels([a, r, g, b]: [u16; 4]) -> Self {
        Self { a, r, g, b }
    }

    fn zip(self, other: Self, f: impl Fn(u16, u16) -> u16) -> Self {
        let (a, b) = (self.channels(), other.channels());
        Self::from_channels([0, 1, 2, 3].map(|i| f(a[i], b[i])))
    }

    /// The sum, channel by channel, full at most (P4).
    fn plus(self, other: Self) -> Self {
        self.zip(other, |a, b| (a + b).min(FULL))
    }
}

/// Stage two: the Z unit and the RGB unit.
#[derive(Debug)]
pub struct ZUnit<'m> {
    /// Depth and shadow counts of two scanlines.
    pub buffers: LineBuffers<'m>,
    pub(super) mode: GlobalMode,
    pub(super) z: ZSetup,
    pub(super) diffuse: ParameterSetup,
    pub(super) specular: ParameterSetup,
}

impl<'m> ZUnit<'m> {
    pub(super) fn new(buffers: LineBuffers<'m>) -> Self {
        Self {
            buffers,
            mode: GlobalMode::default(),
            z: ZSetup::default(),
            diffuse: ParameterSetup::default(),
            specular: ParameterSetup::default(),
        }
    }

    /// A pixel with its colour, or nothing where it is hidden: a null token.
    #[inline]
    pub(super) fn pixel(&mut self, token: PixelToken) -> Option<PixelToken> {
        let w = u32::from(token.w);
        let z = lirp(self.z.z0.into(), self.z.z1.into(), w, SPAN_BITS) as u32;
        if !self.is_visible(token.x, z) {
            return None;
        }
        let mut colour = Argb10::default();
        if self.mode.diffuse_shade {
            colour = interpolate(self.diffuse, w);
        }
        if self.mode.specular_shade {
            // The specular set-up has its power where the diffuse one has opacity.
            let specular = interpolate(self.specular, w);
            colour = colour.plus(Argb10 { a: 0, ..specular });
        }
        Some(PixelToken { colour, ..token })
    }

    /// The Z unit: compares, and in the first pass keeps the nearer or equal depth.
    fn is_visible(&mut self, x: u16, z: u32) -> bool {
        let mode = self.mode;
        let front = self.z.front;
        let Some(word) = self.buffers.word(x) else {
            return false;
        };
        let kept = (*word >> 8) as u32;
        let count = *word as i8;
        if mode.shadow_count {
            // Second pass: shadow polygons in front are counted, depth stays, nothing is drawn.
            if z < kept && !mode.disable_z_write {
                let count = count.saturating_add(if front { -1 } else { 1 });
                *word = u64::from(kept) << 8 | u64::from(count as u8);
            }
            return false;
        }
        if mode.shadow_test {
            // Third pass: what is in sight anyway, where it is lit.
            let seen = mode.force_z_visible || z == kept;
            return seen && (count == 0) != mode.invert_shadow;
        }
        let seen = mode.force_z_visible || z <= kept;
        if seen && !mode.disable_z_write {
            *word = u64::from(z) << 8 | u64::from(count as u8);
        }
        seen
    }
}

/// The RGB unit: four 9-bit fields between the ends of a span, in 10 bits.
#[inline]
fn interpolate(ends: ParameterSetup, w: u32) -> Argb10 {
    let levels = |word: Word36| {
        ProcessingFormat::U9x4
            .unpack(word)
            .map(|level| i64::from(widen(level as u32, 9, 10)))
    };
    let (a, b) = (levels(ends.left), levels(ends.right));
    Argb10::from_channels([0, 1, 2, 3].map(|i| lirp(a[i], b[i], w, SPAN_BITS) as u16))
}

/// Stage three: the compositing unit.
#[derive(Debug)]
pub struct CompositingUnit<'m> {
    /// Colours of two scanlines.
    pub buffers: LineBuffers<'m>,
    pub(super) mode: GlobalMode,
}

impl<'m> CompositingUnit<'m> {
    pub(super) fn new(buffers: LineBuffers<'m>) -> Self {
        Self {
            buffers,
            mode: GlobalMode::default(),
        }
    }

    /// Blends a pixel into the line (K11): what is opaque replaces, unless the pixel itself asks
    /// to be added.
    #[inline]
    pub(super) fn pixel(&mut self, token: PixelToken) {
        let additive = self.mode.additive;
        let Some(word) = self.buffers.word(token.x) else {
            return;
        };
        let new = token.colour;
        let weight = u32::from(new.a);
        let blend = |a: u16, b: u16| lirp(a.into(), b.into(), weight, SPAN_BITS) as u16;
        let old = Argb10::from_word(*word);
        let mixed = if token.force_additive || (additive && new.a != FULL) {
            old.plus(Argb10::default().zip(new, blend))
        } else if new.a == FULL {
            new
        } else {
            old.zip(new, blend)
        };
        *word = mixed.to_word() & WORD;
    }
}
