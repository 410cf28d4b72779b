//! One line of a picture of twice the lines and columns, from two drawn ones.
//!
//! A pixel's fields are widened until 16 times a field fits, which RGB565 does in one word: 3 near +
//! 1 far of the two lines is reckoned once for a column, and so again from column to column. With its
//! bytes swapped a line of 320 pixels takes 5,098 instructions on a Cortex-M4, the pump's part with it
//! (`firmware --profile values_doubled`): 1.2 million for a picture of 320 x 240, of which a quarter is
//! drawn.

use super::PixelFormat;

/// Where the fields of RGB565 are when four bits are free above each: green, red, blue.
pub(super) const FIELDS_565: u32 = 0x07E0_F81F;

/// The fields of a pixel of RGB565, apart.
#[inline(always)]
pub(super) const fn apart_565(word: u16) -> u32 {
    (word as u32 | (word as u32) << 16) & FIELDS_565
}

/// The pixel of fields that are apart, with nothing else between them.
#[inline(always)]
pub(super) const fn joined_565(fields: u32) -> u16 {
    (fields | fields >> 16) as u16
}

/// A sent line: its pixels lie a quarter of a drawn one away from the drawn ones' centres, so that
/// it is 9, 3, 3 and 1 sixteenths of the four around.
#[inline(always)]
pub(super) fn mix<P: PixelFormat>(near: &[P::Word], far: &[P::Word], sent: &mut [P::Word]) {
    let part = |near: [u32; 2], far: [u32; 2]| [0, 1].map(|i| 3 * near[i] + far[i]);
    let column = |near: P::Word, far: P::Word| part(P::widen(near), P::widen(far));
    let ([near, nears @ ..], [far, fars @ ..], [first, rest @ ..]) = (near, far, sent) else {
        return;
    };
    let mut last = column(*near, *far);
    *first = P::narrow(part(last, last));
    // One count for all: none of them is taken before.
    for ((near, far), pair) in nears.iter().zip(fars).zip(rest.chunks_exact_mut(2)) {
        let next = column(*near, *far);
        if let [left, right] = pair {
            *left = P::narrow(part(last, next));
            *right = P::narrow(part(next, last));
        }
        last = next;
    }
    if let [end] = rest.chunks_exact_mut(2).into_remainder() {
        *end = P::narrow(part(last, last));
    }
}
