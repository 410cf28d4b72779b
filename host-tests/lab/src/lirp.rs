//! LIRP along a span: a weight that counts from end to end, and a product a channel (K6, K7).
//!
//! K7 blends A and B by `((~w) A + w B + (A below the middle, else B)) >> n`. With `t` the top bit of w that is
//! `(2^n A + (w + t) (B - A)) >> n`: one multiply-add, and the same bits.
//!
//! A and B are the colours at the centres of the span's first and last pixel, and `m = 1 / (Xright - Xleft)` is one
//! division by the pixels between them. The weight is a 32-bit fraction of which the upper n bits are W: 2^-n half at the
//! first pixel, so W is rounded, and all ones at the last. W is off by at most one unit of 2^-n, in the middle.

use crate::format::Format;

/// The weight of the next pixel.
struct Weight<const N: u32> {
    at: u32,
    step: u32,
}

impl<const N: u32> Weight<N> {
    /// For so many pixels, at most 8192; N is at most 16.
    #[inline(always)]
    fn new(pixels: usize) -> Self {
        Self {
            at: 1 << (31 - N),
            step: 0u32.wrapping_sub(1 << (32 - N)) / (pixels as u32 - 1).max(1),
        }
    }

    /// `w + t`, 0 to 2^N inclusive; goes on.
    #[inline(always)]
    fn next(&mut self) -> u32 {
        let w = self.at >> (32 - N);
        self.at = self.at.wrapping_add(self.step);
        w + (w >> (N - 1))
    }
}

/// Three channels with `N` bits of W, between ends with 16 bits a channel.
#[inline(never)]
pub(crate) fn blend<F: Format, const N: u32>(
    [first, last]: [[u32; 3]; 2],
    pixels: &mut [F::Word],
    seen: &mut impl FnMut() -> bool,
) {
    let mut weight = Weight::<N>::new(pixels.len());
    let base = first.map(|a| a << 16);
    let rise = [0, 1, 2].map(|i| last[i].wrapping_sub(first[i]) << (16 - N));
    for pixel in pixels {
        let w = weight.next();
        if seen() {
            let level =
                |i: usize| base[i].wrapping_add(w.wrapping_mul(rise[i])) >> (32 - F::WIDTH[i]);
            *pixel = F::pack([level(0) as u8, level(1) as u8, level(2) as u8]);
        }
    }
}

/// Two channels a product: 8 bits of W and 8 of each channel.
#[inline(never)]
pub(crate) fn blend_packed<F: Format>(
    [first, last]: [[u32; 3]; 2],
    pixels: &mut [F::Word],
    seen: &mut impl FnMut() -> bool,
) {
    let mut weight = Weight::<8>::new(pixels.len());
    let (a, b) = (first.map(|a| a >> 8), last.map(|b| b >> 8));
    let base = (a[0] << 24 | a[2] << 8, a[1] << 24);
    // The sum of two products in one word is the product of the sum, whatever the signs.
    let rise = [0, 1, 2].map(|i| b[i].wrapping_sub(a[i]));
    let rise = ((rise[0] << 16).wrapping_add(rise[2]), rise[1] << 16);
    for pixel in pixels {
        let w = weight.next();
        if seen() {
            let red_blue = base.0.wrapping_add(w.wrapping_mul(rise.0));
            let green = base.1.wrapping_add(w.wrapping_mul(rise.1));
            *pixel = F::pack_words(red_blue, green);
        }
    }
}
