//! One vertex from model space to the screen (K1).
//!
//! Only ratios of clip coordinates count, so each draw call scales its own: the rows are chosen
//! such that no vertex of the mesh can leave 31 bits, whatever the matrices are. The screen's
//! focal length enters as a mantissa in the x and y rows and a power of two at the very end.

use super::camera::{Camera, Screen};
use super::mesh::Coordinate;
use super::transform::Affine;
use crate::num::{leading_zeros, mul_high, mul_high_unsigned, recip, shift_round};

/// Depth of the near plane, the largest a vertex gets.
///
/// A margin of 2^15 is kept at both ends of 0 ..= 2^31, more than a plane can err.
pub(super) const DEPTH_MAX: u32 = (1 << 31) - (1 << 15);
/// Depth of what is infinitely far, the smallest a vertex gets.
pub(super) const DEPTH_MIN: u32 = 1 << 15;

/// A vertex in clip coordinates of its draw call: x and y times the mantissa of the focal
/// length, z along the view; each within 2^30.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ClipPoint {
    pub(super) x: i32,
    pub(super) y: i32,
    pub(super) z: i32,
}

/// A vertex on the screen: 13.3 coordinates of guard space and depth.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct ScreenPoint {
    pub(super) x: u16,
    pub(super) y: u16,
    pub(super) depth: u32,
}

/// Where a vertex lies beyond a plane: bits of an outcode.
pub(super) mod outcode {
    pub(in super::super) const NEAR: u16 = 1;
    pub(in super::super) const FAR: u16 = 2;
    pub(in super::super) const LEFT: u16 = 4;
    pub(in super::super) const RIGHT: u16 = 8;
    pub(in super::super) const UP: u16 = 16;
    pub(in super::super) const DOWN: u16 = 32;
}

/// Model space to screen, for one draw call.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    rows: [[i32; 3]; 3],
    offset: [i32; 3],
    /// `X = x 2^power / z` in units of 1/8 pixel from the principal point.
    power: i32,
    /// Near plane in clip coordinates, at least 1.
    pub(super) near: i32,
    /// Far plane in clip coordinates.
    pub(super) far: i32,
    /// `near = near_mantissa 2^-near_down`, the mantissa in 2^30 ..< 2^31.
    near_mantissa: u32,
    near_down: i32,
    centre: [i32; 2],
    /// Of what lies beyond one of these planes with all corners, nothing is seen.
    hiding: u16,
}

impl Projection {
    #[inline(never)]
    pub(crate) fn new(camera: &Camera, screen: Screen, model: &Affine) -> Self {
        let map = model.then(&camera.seen);
        // A vertex is within 2 each way, so a row reaches at most twice the sum of its entries.
        let mut row_bits = -200;
        for i in 0..3 {
            let m = &map.linear.mantissa[3 * i..3 * i + 3];
            let sum: u32 = m.iter().map(|m| m.unsigned_abs()).sum();
            row_bits = row_bits.max(32 - sum.leading_zeros() as i32);
        }
        let reach = (row_bits + 1 + map.linear.exponent - 30).max(map.offset.magnitude_bits()) + 1;
        let scale = 29 - reach.max(-100);
        let focal = camera.focal.mantissa[0];
        let mut rows = [[0; 3]; 3];
        let mut offset = [0; 3];
        for i in 0..3 {
            // x and y take the focal length's mantissa, 2^29 ..< 2^30 for 1/2 ..< 1.
            let times = |m: i32| {
                if i < 2 {
                    i64::from(m) * i64::from(focal)
                } else {
                    i64::from(m) << 30
                }
            };
            for (k, entry) in rows[i].iter_mut().enumerate() {
                let m = times(map.linear.mantissa[3 * i + k]);
                *entry = shift_round(m, map.linear.exponent - 60 + scale + 2) as i32;
            }
            let m = times(map.offset.mantissa[i]);
            offset[i] = shift_round(m, map.offset.exponent - 60 + scale) as i32;
        }
        let clamp = |v: i64| v.clamp(1, i64::from(i32::MAX)) as i32;
        Self {
            rows,
            offset,
            power: camera.focal.exponent,
            near: clamp(camera.near.scaled(0, scale)),
            far: clamp(camera.far.scaled(0, scale)),
            near_mantissa: (camera.near.mantissa[0] as u32) << 1,
            near_down: 31 - camera.near.exponent - scale,
            centre: screen.centre(),
            hiding: hiding(screen),
        }
    }

    /// Model space to clip coordinates: nine products.
    #[inline]
    pub(super) fn transform<C: Coordinate>(&self, p: [C; 3]) -> ClipPoint {
        let row = |i: usize| {
            let r = &self.rows[i];
            let xy = p[0].times(r[0]).wrapping_add(p[1].times(r[1]));
            xy.wrapping_add(p[2].times(r[2]))
                .wrapping_add(self.offset[i])
        };
        ClipPoint {
            x: row(0),
            y: row(1),
            z: row(2),
        }
    }

    /// The planes that `p` lies beyond, 0 for none.
    ///
    /// The sides are the guard band with a 256th to spare, so that whatever passes projects into
    /// 13.3; what does not is clipped exactly.
    #[inline]
    pub(super) fn outcode(&self, p: ClipPoint) -> u16 {
        let mut code = 0;
        if p.z < self.near {
            code |= outcode::NEAR;
        }
        if p.z > self.far {
            code |= outcode::FAR;
        }
        // |x| 2^power < 2^15 z
        let limit = p.z - (p.z >> 8);
        let down = 15 - self.power;
        let (x, y, limit) = if down >= 0 {
            let down = down.min(31);
            (p.x >> down, p.y >> down, limit)
        } else {
            (p.x, p.y, limit >> (-down).min(31))
        };
        if x >= limit {
            code |= outcode::RIGHT;
        }
        if x <= -limit {
            code |= outcode::LEFT;
        }
        if y >= limit {
            code |= outcode::DOWN;
        }
        if y <= -limit {
            code |= outcode::UP;
        }
        code
    }

    /// Whether `p` lies beyond no plane, so that its [`outcode`](Projection::outcode) is 0.
    #[inline(always)]
    pub(super) fn is_within(&self, p: ClipPoint) -> bool {
        let limit = p.z - (p.z >> 8);
        let down = 15 - self.power;
        if down < 0 {
            return self.outcode(p) == 0;
        }
        let down = down.min(31);
        // -limit < v < limit; a limit below 1 admits nothing, and is behind the near plane.
        let between = |v: i32| (((v >> down) + limit - 1) as u32) < (2 * limit - 1) as u32;
        p.z >= self.near && p.z <= self.far && between(p.x) && between(p.y)
    }

    /// Whether of a triangle whose corners have these outcodes nothing is seen, as all of it lies
    /// beyond one plane.
    #[inline]
    pub(super) fn hides(&self, codes: [u16; 3]) -> bool {
        codes[0] & codes[1] & codes[2] & self.hiding != 0
    }

    /// Clip coordinates to the screen; `p` must have outcode 0, or have been clipped.
    ///
    /// Coordinates are rounded to 1/8 pixel and err by 2^-26 of the distance from the middle
    /// before that; depth is `near / z` in 1/2^31, 2^-27 of itself off.
    pub(super) fn project(&self, p: ClipPoint) -> ScreenPoint {
        self.project_within(ClipPoint { z: p.z.max(1), ..p })
    }

    /// The same of a point whose z is positive.
    #[inline(always)]
    pub(super) fn project_within(&self, p: ClipPoint) -> ScreenPoint {
        let z = p.z as u32;
        // z 2^up in 2^30 ..< 2^31
        let up = leading_zeros(z) as i32 - 1;
        let inverse = recip(z << (up + 1));
        // near / z is at most 1, so `up` is at most `near_down`, but for rounding when clipped.
        let depth = mul_high_unsigned(self.near_mantissa, inverse);
        // depth < 2^30, and near / z = 4 depth 2^(up - near_down)
        let depth = (depth << 2) >> (self.near_down - up).clamp(0, 31);
        // x 2^(up + power - 15) is below z 2^up in magnitude, that is, within 31 bits.
        let shift = up + self.power - 15;
        let (x, y) = if shift >= 0 {
            (
                p.x.wrapping_shl(shift as u32),
                p.y.wrapping_shl(shift as u32),
            )
        } else {
            let down = (-shift).min(31);
            (p.x >> down, p.y >> down)
        };
        // 2^31 itself, for a power of two, is a unit less: so a signed product will do.
        let inverse = (inverse - (inverse >> 31)) as i32;
        let place = |v: i32, centre: i32| {
            let q = mul_high(v, inverse);
            (((q + (1 << 13)) >> 14) + centre).clamp(0, 0xFFFF) as u16
        };
        ScreenPoint {
            x: place(x, self.centre[0]),
            y: place(y, self.centre[1]),
            depth: depth.clamp(DEPTH_MIN, DEPTH_MAX),
        }
    }

    /// The focal length's power of two, for clipping at the guard band.
    pub(crate) fn power(&self) -> i32 {
        self.power
    }

    /// The rows that coordinates are multiplied by.
    pub(crate) fn rows(&self) -> &[[i32; 3]; 3] {
        &self.rows
    }

    /// What is added to the rows' products.
    pub(crate) fn offset(&self) -> [i32; 3] {
        self.offset
    }

    /// Near and far plane in clip coordinates, and the shift from there to the near plane's mantissa.
    pub(crate) fn range(&self) -> (i32, i32, i32) {
        (self.near, self.far, self.near_down)
    }

    /// The principal point in units of 1/8 pixel of guard space.
    pub(crate) fn centre(&self, axis: usize) -> i64 {
        i64::from(self.centre[axis])
    }

    /// How far a coordinate may lie from the principal point, in units of 1/8 pixel.
    pub(super) fn guard(&self, axis: usize) -> i64 {
        i64::from(0xFFFF - self.centre[axis])
    }
}

/// The planes beyond which nothing is seen: not the sides of the guard band where these, with the
/// 256th that they have to spare, lie within the picture.
const fn hiding(screen: Screen) -> u16 {
    /// Twice 255/256 of the 4,096 pixels from the middle of guard space to its rim.
    const WITHIN: u16 = 8160;
    let mut planes = outcode::NEAR | outcode::FAR;
    if screen.width() <= WITHIN {
        planes |= outcode::LEFT | outcode::RIGHT;
    }
    if screen.height() <= WITHIN {
        planes |= outcode::UP | outcode::DOWN;
    }
    planes
}

#[cfg(test)]
mod tests {
    use super::*;

    /// A camera at the origin that looks along -z, focal length 200 pixels.
    fn camera(near: f32, far: f32) -> Camera {
        Camera::look_at(
            [0.0; 3],
            [0.0, 0.0, -1.0],
            [0.0, 1.0, 0.0],
            200.0,
            near,
            far,
        )
        .unwrap()
    }

    #[test]
    fn projection_agrees_with_division() {
        let screen = Screen::new(320, 240).unwrap();
        let mut worst = 0f64;
        let mut worst_depth = 0f64;
        let mut seed = 1u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            f64::from((seed >> 8) as i32 - (1 << 23)) / f64::from(1 << 23)
        };
        for i in 0..20_000 {
            let size = [0.001f32, 1.0, 5000.0][i % 3];
            let away = f64::from(size) * (3.0 + 40.0 * random().abs());
            let near = size;
            let model = Affine::placed(size, [0.0, 0.0, -away as f32]).unwrap();
            let projection = Projection::new(&camera(near, size * 1000.0), screen, &model);
            let q = [random(), random(), random()].map(|c| (c * f64::from(1 << 30)) as i32);
            let [x, y, z] = q.map(|c| f64::from(c) / f64::from(1 << 30) * f64::from(size));
            let z = f64::from(away as f32) - z;
            let p = projection.transform(q);
            assert_eq!(projection.outcode(p), 0);
            let s = projection.project(p);
            let want_x = 32_768.0 + 1600.0 * x / z;
            let want_y = 32_768.0 - 1600.0 * y / z;
            worst = worst
                .max((f64::from(s.x) - want_x).abs())
                .max((f64::from(s.y) - want_y).abs());
            let want_depth = f64::from(near) / z;
            worst_depth =
                worst_depth.max((f64::from(s.depth) / 2147483648.0 / want_depth - 1.0).abs());
        }
        assert!(worst < 0.501, "{worst} units of 1/8 pixel");
        assert!(worst_depth < 2e-6, "{worst_depth}");
    }

    #[test]
    fn outcodes_name_the_sides() {
        let screen = Screen::new(320, 240).unwrap();
        let projection = Projection::new(&camera(0.1, 1.5), screen, &Affine::IDENTITY);
        let code = |x: f64, y: f64, z: f64| {
            let q = [x, y, z].map(|c| (c * f64::from(1 << 14)) as i16);
            projection.outcode(projection.transform(q))
        };
        assert_eq!(code(0.0, 0.0, -1.0), 0);
        assert_eq!(code(0.0, 0.0, -1.9), outcode::FAR);
        assert_eq!(code(0.0, 0.0, -0.05), outcode::NEAR);
        assert_eq!(code(1.9, 0.0, -0.05), outcode::NEAR | outcode::RIGHT);
        assert_eq!(
            code(-1.9, 1.9, -0.05),
            outcode::NEAR | outcode::LEFT | outcode::UP
        );
    }
}
