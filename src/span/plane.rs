//! Planes of a small triangle in 32-bit products, the same bits with and without long ones (B).
//!
//! A gradient is `8 (e1 dy2 - e2 dy1) / area` a pixel. What all planes of a triangle share is each
//! side times the reciprocal of the area, cut to what leaves room for rises of 11 bits.

use super::edge::{across, down};
use crate::num::{SHORT, leading_zeros_here, mul_high, recip_16};
use crate::scene::ORIGIN;

/// Sides times the reciprocal of the doubled area, `r 2^(up - 47)`, and the first corner's place.
#[derive(Clone, Copy, Debug)]
pub struct Shares {
    x1: i32,
    x2: i32,
    y1: i32,
    y2: i32,
    /// Zeros above the area's first bit.
    up: u32,
    /// Units of 1/8 pixel from the centre of the picture's first pixel to the first corner.
    x: i32,
    y: i32,
}

/// A plane: its value at the picture's first pixel less that at the first corner, and its steps.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Rise {
    pub(crate) at: i32,
    pub(crate) dx: i32,
    pub(crate) dy: i32,
}

impl Shares {
    /// For corners that go clockwise; `area` is the doubled area in units of 1/64 pixel, at least 1.
    #[inline(always)]
    pub(crate) fn new(area: u32, [a, b, c]: [u32; 3]) -> Self {
        let (d1, d2) = (b.wrapping_sub(a), c.wrapping_sub(a));
        let up = leading_zeros_here(area);
        let r = recip_16((area << (up & 31)) >> 16) as i32;
        Self {
            x1: down(d2).wrapping_mul(r),
            x2: down(d1).wrapping_mul(-r),
            y1: across(d1).wrapping_mul(r),
            y2: across(d2).wrapping_mul(-r),
            up,
            x: (a & 0xFFFF) as i32 - (8 * ORIGIN + 4),
            y: (a >> 16) as i32 - (8 * ORIGIN + 4),
        }
    }

    /// The same with `BITS` bits less.
    #[inline(always)]
    pub(crate) fn cut<const BITS: u32>(self) -> Self {
        Self {
            x1: self.x1 >> BITS,
            x2: self.x2 >> BITS,
            y1: self.y1 >> BITS,
            y2: self.y2 >> BITS,
            ..self
        }
    }

    /// A plane with `FRACTION` bits below its rises from the first corner to the others, of shares that
    /// were [cut](Shares::cut) by `CUT`; the sums must fit, see there.
    #[inline(always)]
    pub(crate) fn rise<const CUT: u32, const FRACTION: u32>(&self, e1: i32, e2: i32) -> Rise {
        let shift = (44 - CUT - FRACTION).wrapping_sub(self.up) & 31;
        let half = 1i32 << ((43 - CUT - FRACTION).wrapping_sub(self.up) & 31);
        let step = |a: i32, b: i32, c: i32, d: i32| {
            half.wrapping_add(a.wrapping_mul(b))
                .wrapping_add(c.wrapping_mul(d))
                >> shift
        };
        let dx = step(e1, self.x1, e2, self.x2);
        let dy = step(e2, self.y1, e1, self.y2);
        let at = if FRACTION == 0 {
            // Steps of 16 bits over 13 bits of way.
            let way = 4i32
                .wrapping_sub(dx.wrapping_mul(self.x))
                .wrapping_sub(dy.wrapping_mul(self.y));
            way >> 3
        } else {
            self.back(dx, dy)
        };
        Rise { at, dx, dy }
    }

    /// A plane of rises of 31 bits and a sign; `None` where it is too steep for 32 bits. Of whole shares, of sides below
    /// 256 units.
    #[inline(always)]
    pub(crate) fn steep(&self, e1: i32, e2: i32) -> Option<[u32; 3]> {
        // Small rises, which all of what is far away are, have 13 bits more.
        let is_small = ((e1 ^ e1 >> 31) | (e2 ^ e2 >> 31)) < 1 << 17;
        let more = if is_small { 13 } else { 0 };
        let product = |e: i32, share: i32| mul_high(e << more, share << 6);
        let gx = product(e1, self.x1) + product(e2, self.x2);
        let gy = product(e2, self.y1) + product(e1, self.y2);
        // 1 to 16, as the area is.
        let left = self.up.wrapping_sub(15) & 31;
        let most = (gx ^ gx >> 31) | (gy ^ gy >> 31);
        // Below 2^27, as they are shifted.
        if most >> 30u32.wrapping_sub(left).wrapping_add(more).min(31) != 0 {
            return None;
        }
        let [dx, dy] = if is_small {
            let down = 16u32.wrapping_sub(left) & 31;
            let half = 1 << down >> 1;
            [gx, gy].map(|g| (g + half) >> down)
        } else {
            [gx, gy].map(|g| (g << left) >> 3)
        };
        let at = if SHORT {
            self.back(dx, dy)
        } else {
            let way = |d: i32, to: i32| i64::from(d) * i64::from(to);
            ((4 - way(dx, self.x) - way(dy, self.y)) >> 3) as i32
        };
        Some([at, dx, dy].map(|v| v as u32))
    }

    /// From the first corner back to the picture's first pixel: whole pixels apart from the rest, as nothing is shifted
    /// right then after a product has wrapped.
    #[inline(always)]
    fn back(&self, dx: i32, dy: i32) -> i32 {
        let rest = 4i32
            .wrapping_sub(dx.wrapping_mul(self.x & 7))
            .wrapping_sub(dy.wrapping_mul(self.y & 7));
        (rest >> 3)
            .wrapping_sub(dx.wrapping_mul(self.x >> 3))
            .wrapping_sub(dy.wrapping_mul(self.y >> 3))
    }
}

#[cfg(test)]
mod tests {
    use super::{Rise, Shares};
    use crate::num::random::Rng;
    use crate::scene::ORIGIN;

    /// Kills: a value at the picture's first pixel of which the highest bits are lost, where the steps to it are more than
    /// 32 bits hold.
    #[test]
    fn values_far_from_the_corner_keep_all_bits() {
        let mut rng = Rng(78);
        let mut far = 0;
        for _ in 0..20_000 {
            let mut within = |count: u32| rng.below(count);
            let (x, y) = (
                8 * ORIGIN as u32 + within(8_000),
                8 * ORIGIN as u32 + within(8_000),
            );
            // Thin ones rise most.
            let (right, down) = (1 + within(198), 1 + within(2));
            let place = [y << 16 | x, y << 16 | (x + right), (y + down) << 16 | x];
            let area = right * down;
            let [e1, e2] = [(); 2].map(|()| within(2 << 10) as i32 - (1 << 10));
            if area < 128 {
                continue;
            }
            let shares = Shares::new(area, place).cut::<6>();
            let Rise { at, dx, dy } = shares.rise::<6, 6>(e1, e2);
            let way = |d: i32, to: i32| i64::from(d) * i64::from(to);
            let exact = 4 - way(dx, shares.x) - way(dy, shares.y);
            assert_eq!(at, (exact >> 3) as i32, "{place:x?} {e1} {e2}");
            far += u32::from(i32::try_from(exact).is_err());
        }
        assert!(far > 100, "{far}");
    }

    /// What is far away has small rises, and small triangles may be thin: planes of both are a few units off.
    ///
    /// Kills: small rises without bits of their own, steps that are rounded down, or to whole units of 1/8 pixel.
    #[test]
    fn steep_planes_are_off_by_few_units_where_rises_are_small() {
        let mut rng = Rng(79);
        let (mut made, mut worst) = (0, 0f64);
        while made < 40_000 {
            let mut corner = || [(); 2].map(|()| rng.below(224) as i32);
            let [[ax, ay], [bx, by], [cx, cy]] = [(); 3].map(|()| corner());
            let area = (bx - ax) * (cy - ay) - (by - ay) * (cx - ax);
            if area <= 0 {
                continue;
            }
            let [e1, e2] = [(); 2].map(|()| rng.below(2 << 12) as i32 - (1 << 12));
            let first = 8 * ORIGIN + 8 * rng.below(300) as i32;
            let place = [[ax, ay], [bx, by], [cx, cy]];
            let place = place.map(|[x, y]| ((first + y) << 16 | (first + x)) as u32);
            let shares = Shares::new(area as u32, place);
            let Some([at, dx, dy]) = shares.steep(e1, e2) else {
                continue;
            };
            made += 1;
            // In the middle, as far as a pixel's may be from the first corner.
            let (column, row) = (first / 8 - ORIGIN + 14, first / 8 - ORIGIN + 14);
            let got = [(dx, column), (dy, row)]
                .iter()
                .fold(at, |sum, (step, by)| {
                    sum.wrapping_add(step.wrapping_mul(*by as u32))
                });
            let (x, y) = (f64::from(116 - ax), f64::from(116 - ay));
            let [e1, e2, area] = [e1, e2, area].map(f64::from);
            let gx = (e1 * f64::from(cy - ay) - e2 * f64::from(by - ay)) / area;
            let gy = (e2 * f64::from(bx - ax) - e1 * f64::from(cx - ax)) / area;
            let want = gx * x + gy * y;
            let most = (gx.abs() * 16.0 + gy.abs() * 16.0) / 64.0;
            let off = (f64::from(got as i32) - want).abs();
            worst = worst.max(off - most);
        }
        std::println!("{worst} units");
        assert!(worst < 20.0, "{worst}");
    }

    /// A step of a pixel that 27 bits and a sign do not hold is refused, whether rises are small or not.
    ///
    /// Kills: a bound that is half or twice as much, for either.
    #[test]
    fn steps_of_more_than_27_bits_are_refused() {
        let mut rng = Rng(80);
        let mut counts = [[0; 2]; 2];
        for i in 0..400_000 {
            // Any, and those with the least areas.
            let mut below = |most: u32| rng.below(most) as i32;
            let ([bx, by], [cx, cy]) = match i % 2 {
                0 => ([below(224), below(224)], [below(224), below(224)]),
                _ => {
                    let wide = 100 + below(124);
                    ([wide, 1], [wide - 1 - below(3), 1])
                }
            };
            let area = bx * cy - by * cx;
            if area <= 0 {
                continue;
            }
            let bits = [15, 2][i / 2 % 2];
            let [e1, e2] = [(); 2].map(|()| rng.below(u32::MAX) as i32 >> bits);
            let first = ((8 * ORIGIN) << 16 | (8 * ORIGIN)) as u32;
            let place = [[0, 0], [bx, by], [cx, cy]].map(|[x, y]| first + (y << 16 | x) as u32);
            let is_made = Shares::new(area as u32, place).steep(e1, e2).is_some();
            let step = |a: i32, b: i32, c: i32, d: i32| {
                let [a, b, c, d] = [a, b, c, d].map(i64::from);
                8.0 * (a * b - c * d).abs() as f64 / f64::from(area)
            };
            let most = step(e1, cy, e2, by).max(step(e2, bx, e1, cx)) / f64::from(1 << 27);
            // The reciprocal of the area has 16 bits.
            if (most - 1.0).abs() > 0.01 {
                assert_eq!(is_made, most < 1.0, "{most}: {bx} {by} {cx} {cy} {e1} {e2}");
                let is_small = e1.unsigned_abs().max(e2.unsigned_abs()) < 1 << 16;
                counts[usize::from(is_small)][usize::from(is_made)] += 1;
            }
        }
        std::println!("{counts:?}");
        assert!(counts.as_flattened().iter().all(|&count| count > 1_000));
    }
}
