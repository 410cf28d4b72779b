//! What the planes of a textured triangle share: its sides, and the reciprocal of its area (H4).

use super::mapping::Corner;
use crate::num::{leading_zeros, mul_high, mul_wide, recip, recip_16};
use crate::span::Frame;

/// What the planes of a triangle share.
pub(super) enum Area {
    Small(Small),
    Large(Large),
}

impl Area {
    /// `None` where the triangle is too thin for planes.
    #[inline(always)]
    pub(super) fn new(corners: &[Corner; 3]) -> Option<Self> {
        let small = Small::new(corners).map(Self::Small);
        small.or_else(|| Large::of(corners))
    }

    /// The plane of values below 2^30 either way, modulo 2^32: at the picture's first pixel, and the steps to the right and
    /// down; `None` where it is too steep.
    ///
    /// That of 1/w comes first, with the picture: where the nearest corner lies far beside it, this plane and those after
    /// it are in a unit that is [finer](Self::finer).
    #[inline(never)]
    pub(super) fn plane(&mut self, value: [i32; 3], picture: Option<Frame>) -> Option<[u32; 3]> {
        match self {
            Self::Small(area) => area.plane(value),
            Self::Large(area) => area.plane(value, picture),
        }
    }

    /// By how many bits.
    pub(super) fn finer(&self) -> u32 {
        match self {
            Self::Small(_) => 0,
            Self::Large(area) => area.finer,
        }
    }
}

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
    fn new([a, b, c]: &[Corner; 3]) -> Option<Self> {
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

    #[inline(never)]
    fn plane(&self, value: [i32; 3]) -> Option<[u32; 3]> {
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
    side: [i32; 4],
    /// The doubled area's reciprocal, `mantissa 2^(up - 94)`.
    mantissa: u32,
    up: u32,
    x: i32,
    y: i32,
    /// By how many bits the unit of planes is finer than that of values.
    finer: u32,
    /// The pixel at which planes are exact, for steps are rounded: next to the farthest corner, where a place changes most
    /// by what a unit is.
    exact_at: [i32; 2],
}

impl Large {
    /// Fraction bits of steps on the way from a corner to the picture, which may be 2,048 pixels long.
    const FINER: u32 = 12;

    #[inline(never)]
    fn of([a, b, c]: &[Corner; 3]) -> Option<Area> {
        let way = |from: i32, to: i32| {
            let way = to.checked_sub(from)?;
            (way.unsigned_abs() <= 1 << 20).then_some(way)
        };
        let (dx1, dy1) = (way(a.x, b.x)?, way(a.y, b.y)?);
        let (dx2, dy2) = (way(a.x, c.x)?, way(a.y, c.y)?);
        let area = mul_wide(dx1, dy2) - mul_wide(dx2, dy1);
        if area <= 0 {
            return None;
        }
        let up = area.leading_zeros();
        Some(Area::Large(Self {
            side: [dy2, -dy1, dx1, -dx2],
            mantissa: recip((area << up >> 32) as u32),
            up,
            x: a.x,
            y: a.y,
            finer: 0,
            exact_at: [0; 2],
        }))
    }

    /// `64 (a b + c d) / area`, of a rise and a side each, with [`Self::FINER`] fraction bits, rounded down; `None` where 32
    /// bits do not hold it.
    fn step(&self, a: i32, b: i32, c: i32, d: i32) -> Option<i64> {
        let sum = mul_wide(a, b) + mul_wide(c, d);
        let down = 33u32.saturating_sub(sum.unsigned_abs().leading_zeros());
        let product = (sum >> down) * i64::from(self.mantissa);
        let step = product >> (88 - Self::FINER).checked_sub(self.up + down)?.min(63);
        i32::try_from(step >> Self::FINER).ok().map(|_| step)
    }

    /// The unit becomes finer by the bits by which 1/w is smaller anywhere in the picture than the 30 bits that the
    /// nearest corner's has.
    #[inline(never)]
    fn plane(&mut self, value: [i32; 3], picture: Option<Frame>) -> Option<[u32; 3]> {
        // Below 4,096 texels, and less than the greatest 1/w.
        let [e1, e2] = [1, 2].map(|i| value[i].wrapping_sub(value[0]));
        let [y2, y1, x1, x2] = self.side;
        let dx = self.step(e1, y2, e2, y1)?;
        let dy = self.step(e2, x1, e1, x2)?;
        let way = (dx * i64::from(self.x) + dy * i64::from(self.y)) >> 6;
        let at = (i64::from(value[0]) << Self::FINER) - way;
        if let Some(Frame { width, height }) = picture {
            let way = |step: i64, by: i32| mul_wide((step >> Self::FINER).max(0) as i32, by);
            let most = (at >> Self::FINER) + way(dx, width) + way(dy, height);
            let spare = |most| leading_zeros(most).saturating_sub(2).min(Self::FINER);
            self.finer = u32::try_from(most).map_or(0, spare);
            let [y2, y1, x1, x2] = self.side;
            let [x, y] = match (e1 < 0 && e1 <= e2, e2 < 0) {
                (true, _) => [self.x + x1, self.y - y1],
                (false, true) => [self.x - x2, self.y + y2],
                _ => [self.x, self.y],
            };
            self.exact_at = [(x >> 6).max(0).min(width), (y >> 6).max(0).min(height)];
        }
        let down = Self::FINER - self.finer;
        let half = i64::from(1u32 << (down & 31) >> 1);
        // Fewer instructions than a shift of 64 bits by any number.
        let lower = |v: i64| (v as u32) >> (down & 31) | ((v >> 32) as u32) << 1 << (!down & 31);
        let [column, line] = self.exact_at;
        let there = at + dx * i64::from(column) + dy * i64::from(line);
        let [there, dx, dy] = [there, dx + half, dy + half].map(lower);
        let way = dx
            .wrapping_mul(column as u32)
            .wrapping_add(dy.wrapping_mul(line as u32));
        Some([there.wrapping_sub(way), dx, dy])
    }
}
