//! What the planes of a textured triangle share: its sides, and the reciprocal of its area (H4).

use super::mapping::Corner;
use crate::num::{leading_zeros, mul_high, recip, recip_16};

/// What the planes of a triangle within 64 pixels share.
///
/// The reciprocal has 15 bits, but its error is the same in all planes: what they show is displaced
/// by 2^-15 of the triangle's size, less than 1/500 pixel.
pub(super) struct Small {
    /// Sides times the doubled area's reciprocal, times 2^(47 - up).
    share: [i32; 4],
    up: u32,
    x: i32,
    y: i32,
}

impl Small {
    #[inline(always)]
    pub(super) fn new([a, b, c]: &[Corner; 3]) -> Option<Self> {
        let (dx1, dy1) = (b.x.wrapping_sub(a.x), b.y.wrapping_sub(a.y));
        let (dx2, dy2) = (c.x.wrapping_sub(a.x), c.y.wrapping_sub(a.y));
        let magnitude = |d: i32| d ^ (d >> 31);
        if magnitude(dx1) | magnitude(dy1) | magnitude(dx2) | magnitude(dy2) >= 64 << 6 {
            return None;
        }
        let area = dx1 * dy2 - dx2 * dy1;
        if area < 2 << 12 {
            return None;
        }
        let up = leading_zeros(area as u32);
        let r = recip_16((area as u32) << up >> 16) as i32;
        Some(Self {
            share: [dy2, -dy1, dx1, -dx2].map(|d| d * r),
            up,
            x: a.x,
            y: a.y,
        })
    }

    /// `64 (a b + c d) / area`, of a rise and a share each; `None` where 32 bits do not hold it.
    #[inline(always)]
    fn step(&self, a: i32, b: i32, c: i32, d: i32) -> Option<i32> {
        // Products 2^(up - 41), upper words of them with two bits more.
        let sum = mul_high(a, b << 2) + mul_high(c, d << 2);
        if self.up <= 11 {
            return Some(sum >> (11 - self.up));
        }
        let left = self.up - 11;
        (leading_zeros((sum ^ (sum >> 31)) as u32) > left).then(|| sum << (left & 31))
    }

    /// Of values below 2^30 either way.
    #[inline(never)]
    pub(super) fn plane(&self, value: [i32; 3]) -> Option<[u32; 3]> {
        let (e1, e2) = (value[1] - value[0], value[2] - value[0]);
        let [y2, y1, x1, x2] = self.share;
        let dx = self.step(e1, y2, e2, y1)?;
        let dy = self.step(e2, x1, e1, x2)?;
        // Whole pixels apart from the rest: nothing is shifted right after a product has wrapped.
        let way = |step: i32, by: i32| {
            let part = (step >> 6) * (by & 63) + (((step & 63) * (by & 63)) >> 6);
            step.wrapping_mul(by >> 6).wrapping_add(part)
        };
        let at = value[0]
            .wrapping_sub(way(dx, self.x))
            .wrapping_sub(way(dy, self.y));
        Some([at, dx, dy].map(|v| v as u32))
    }
}

/// What the planes of a triangle of any size share. It takes long products: few triangles have it.
pub(super) struct Large {
    side: [i64; 4],
    /// The doubled area's reciprocal, `mantissa 2^(up - 94)`.
    mantissa: u32,
    up: u32,
    x: i32,
    y: i32,
}

impl Large {
    /// Fraction bits of steps on the way from a corner to the picture, which may be 2,048 pixels long.
    const FINER: u32 = 10;

    #[inline(never)]
    pub(super) fn new([a, b, c]: &[Corner; 3]) -> Option<Self> {
        let (dx1, dy1) = (
            i64::from(b.x) - i64::from(a.x),
            i64::from(b.y) - i64::from(a.y),
        );
        let (dx2, dy2) = (
            i64::from(c.x) - i64::from(a.x),
            i64::from(c.y) - i64::from(a.y),
        );
        let limit = 1 << 20;
        if [dx1, dy1, dx2, dy2].iter().any(|d| d.abs() > limit) {
            return None;
        }
        let area = dx1 * dy2 - dx2 * dy1;
        if area <= 0 {
            return None;
        }
        let up = area.leading_zeros();
        Some(Self {
            side: [dy2, -dy1, dx1, -dx2],
            mantissa: recip((area << up >> 32) as u32),
            up,
            x: a.x,
            y: a.y,
        })
    }

    /// `64 (a b + c d) / area` with [`Self::FINER`] fraction bits, rounded down; `None` where 32 bits do not hold it.
    fn step(&self, a: i64, b: i64, c: i64, d: i64) -> Option<i64> {
        let sum = a * b + c * d;
        let down = 33u32.saturating_sub(sum.unsigned_abs().leading_zeros());
        let product = (sum >> down) * i64::from(self.mantissa);
        let step = product >> (88 - Self::FINER - self.up - down).min(63);
        i32::try_from(step >> Self::FINER).ok().map(|_| step)
    }

    #[inline(never)]
    pub(super) fn plane(&self, value: [i32; 3]) -> Option<[u32; 3]> {
        let e1 = i64::from(value[1]) - i64::from(value[0]);
        let e2 = i64::from(value[2]) - i64::from(value[0]);
        let [y2, y1, x1, x2] = self.side;
        let dx = self.step(e1, y2, e2, y1)?;
        let dy = self.step(e2, x1, e1, x2)?;
        let way = (dx * i64::from(self.x) + dy * i64::from(self.y)) >> (6 + Self::FINER);
        let rounded = |step: i64| ((step + (1 << Self::FINER >> 1)) >> Self::FINER) as u32;
        let at = (i64::from(value[0]) - way) as u32;
        Some([at, rounded(dx), rounded(dy)])
    }
}
