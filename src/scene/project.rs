//! Vertices from model space to the screen, in one loop (K1).
//!
//! The focal length lies in the rows, so a place is `x / z` in units of 2^-17 of 1/8 pixel, without a
//! shift of its own. `1 / z = r 2^-47 (1 + m 2^-28)` with a reciprocal of 16 bits and a correction from
//! its remainder: 32-bit products alone, 59 instructions a vertex on a Cortex-M4 and 188 on a Cortex-M0+
//! for what lies inside. A place is within 0.501 units of 1/8 pixel of the exact one.
//!
//! The guard band reaches 2,047.7 pixels either way from the middle, so that all differences of places have
//! 16 bits, also of places that were rounded away from each other.

use super::record::{ORIGIN, TexturePlace, Vertex};
use crate::geometry::{Affine, Camera, Coordinate, Projection, Screen};
use crate::num::{SHORT, leading_zeros, mul_recip_16, recip_16, rounded};

/// `x / z` in units of 1/8 pixel is `2^17` of the rows' ratio.
const FOCAL_BITS: i32 = 17;
/// The guard band: `|x| < z / 2^3` is 2^14 units of 1/8 pixel.
const GUARD_BITS: u32 = 3;

/// How far across the guard band reaches at a distance: two units of 1/8 pixel less than 2^14, and one of `x`.
#[inline(always)]
fn guard(z: i32) -> i32 {
    (z >> GUARD_BITS).wrapping_add(!(z >> 16))
}

/// Planes that a vertex lies beyond.
pub(super) mod beyond {
    pub(in super::super) const NEAR: u32 = 1;
    pub(in super::super) const FAR: u32 = 2;
    pub(in super::super) const RIGHT: u32 = 4;
    pub(in super::super) const LEFT: u32 = 8;
    pub(in super::super) const BOTTOM: u32 = 16;
    pub(in super::super) const TOP: u32 = 32;
}

/// A point seen by the camera, in units of one draw call.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub(super) struct Point {
    pub(super) x: i32,
    pub(super) y: i32,
    pub(super) z: i32,
}

/// A point on the screen.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) struct OnScreen {
    pub(super) place: u32,
    pub(super) depth: u32,
    /// Units of 1/64 pixel beyond the place, -4 to 3.
    pub(super) fine: [i32; 2],
}

/// Model space to screen, for one draw call.
#[derive(Clone, Copy, Debug)]
pub(super) struct View {
    rows: [[i32; 3]; 3],
    offset: [i32; 3],
    pub(super) near: i32,
    pub(super) far: i32,
    /// Depth is `2^62 / z` shifted down by this, less the zeros above z.
    down: i32,
    /// The principal point and half a unit, in units of 2^-14 of 1/8 pixel.
    centre: [i32; 2],
}

impl View {
    #[inline(never)]
    pub(super) fn new(camera: &Camera, screen: Screen, model: &Affine) -> Self {
        let projection = Projection::new(camera, screen, model);
        let (mut rows, mut offset) = (projection.rows, projection.offset);
        let (near, far, near_down) = (projection.near, projection.far, projection.near_down);
        // What x and y lose, or, for long focal lengths, z.
        let down = FOCAL_BITS - projection.power;
        let (cross, along) = (down.clamp(0, 31), (-down).clamp(0, 31));
        for i in 0..3 {
            let shift = if i < 2 { cross } else { along };
            let scaled = |v: i32| rounded(v, shift);
            rows[i] = rows[i].map(scaled);
            offset[i] = scaled(offset[i]);
        }
        let range = |v: i32| rounded(v, along).max(1);
        let centre = |axis: usize| {
            let first = [screen.left(), screen.top()][axis];
            let from_first = i64::from(projection.centre[axis]) - 8 * i64::from(first);
            // Less the half space that a signed quotient is taken from.
            (((from_first + 8 * i64::from(ORIGIN) - 0x8000) << 14) + (1 << 13)) as i32
        };
        Self {
            rows,
            offset,
            near: range(near),
            far: range(far),
            down: near_down + along + 1,
            centre: [centre(0), centre(1)],
        }
    }

    /// Nine products.
    #[inline(always)]
    pub(super) fn point<C: Coordinate>(&self, p: [C; 3]) -> Point {
        let row = |i: usize| {
            let r = &self.rows[i];
            let sum = p[0].times(r[0]).wrapping_add(p[1].times(r[1]));
            sum.wrapping_add(p[2].times(r[2]))
                .wrapping_add(self.offset[i])
        };
        Point {
            x: row(0),
            y: row(1),
            z: row(2),
        }
    }

    /// The point of one of these positions; at the eye, which is before the near plane, where there is none.
    #[inline(never)]
    pub(super) fn point_of<C: Coordinate>(&self, positions: &[[C; 3]], i: usize) -> Point {
        let at = positions.get(i);
        at.map_or(Point::default(), |&at| self.point(at))
    }

    /// Whether a point lies within near, far and guard planes.
    #[inline(always)]
    fn is_within(&self, p: Point) -> bool {
        let guard = guard(p.z);
        // Most points lie well within: the bits of both magnitudes together are below the guard band.
        let most = (p.x ^ (p.x >> 31)) | (p.y ^ (p.y >> 31));
        let range = p.z.wrapping_sub(self.near) | self.far.wrapping_sub(p.z);
        range | !most.wrapping_sub(guard) >= 0 || self.is_just_within(p.x, p.y, p.z)
    }

    /// By numbers alone, so that no point lies in memory.
    #[cold]
    #[inline(never)]
    fn is_just_within(&self, x: i32, y: i32, z: i32) -> bool {
        self.beyond(Point { x, y, z }) == 0
    }

    /// The vertex of a point that is not within, likewise.
    #[cold]
    #[inline(never)]
    fn outside(&self, x: i32, y: i32, z: i32) -> Vertex {
        Vertex::unused(Vertex::OUTSIDE, self.beyond(Point { x, y, z }))
    }

    /// The planes that a point lies beyond.
    #[inline(never)]
    pub(super) fn beyond(&self, p: Point) -> u32 {
        let guard = i64::from(guard(p.z));
        let (x, y) = (i64::from(p.x), i64::from(p.y));
        [
            (p.z < self.near, beyond::NEAR),
            (p.z > self.far, beyond::FAR),
            (x > guard, beyond::RIGHT),
            (-x > guard, beyond::LEFT),
            (y > guard, beyond::BOTTOM),
            (-y > guard, beyond::TOP),
        ]
        .into_iter()
        .fold(0, |all, (is, bit)| if is { all | bit } else { all })
    }

    /// How far a point lies within a plane; below 0 beyond it.
    pub(super) fn within(&self, plane: u32, p: Point) -> i64 {
        let (x, y, z) = (i64::from(p.x), i64::from(p.y), i64::from(p.z));
        let guard = i64::from(guard(p.z));
        match plane {
            beyond::NEAR => z - i64::from(self.near),
            beyond::FAR => i64::from(self.far) - z,
            beyond::RIGHT => guard - x,
            beyond::LEFT => guard + x,
            beyond::BOTTOM => guard - y,
            _ => guard + y,
        }
    }

    /// A point within all planes to the screen.
    #[inline(always)]
    pub(super) fn project(&self, p: Point) -> OnScreen {
        let (mut x, mut y, mut z, mut up) = (p.x, p.y, p.z, 0);
        if SHORT {
            // One or two rounds: cheaper than a count of zeros.
            while z > 0 {
                (x, y, z, up) = (x << 1, y << 1, z << 1, up + 1);
            }
        } else {
            up = leading_zeros(z as u32) as i32;
            (x, y, z) = (x << (up & 31), y << (up & 31), z << (up & 31));
        }
        let z = z as u32;
        let r = recip_16(z >> 16);
        let miss = (z >> 3).wrapping_mul(r).wrapping_neg() as i32 >> 16;
        let coordinate = |v: i32, centre: i32| {
            let q = mul_recip_16(v, r);
            q.wrapping_add((q >> 14).wrapping_mul(miss) >> 14)
                .wrapping_add(centre)
        };
        let (qx, qy) = (coordinate(x, self.centre[0]), coordinate(y, self.centre[1]));
        let (sx, sy) = (qx >> 14, qy >> 14);
        let depth = (r << 15).wrapping_add(((r as i32).wrapping_mul(miss) >> 13) as u32);
        // The half that is added goes to the place; an eighth of it to the finer one.
        let fine = |q: i32, s: i32| {
            let f = (q - (1 << 13) + (1 << 10)) >> 11;
            (f - (s << 3)).clamp(-4, 3)
        };
        OnScreen {
            place: (((sy as u32) << 16) ^ 0x8000_0000) | ((sx as u32 & 0xFFFF) ^ 0x8000),
            depth: depth >> (self.down - up).clamp(0, 31),
            fine: [fine(qx, sx), fine(qy, sy)],
        }
    }
}

/// Positions into vertices, which are not lit yet; whether all of them lie within the planes.
#[inline(never)]
pub(super) fn project_all<C: Coordinate>(
    view: &View,
    positions: &[[C; 3]],
    vertices: &mut [Vertex],
) -> bool {
    let view = *view;
    let mut all = true;
    for (vertex, &position) in vertices.iter_mut().zip(positions) {
        let p = view.point(position);
        if view.is_within(p) {
            let on = view.project(p);
            *vertex = Vertex::unused(on.place, on.depth);
        } else {
            *vertex = view.outside(p.x, p.y, p.z);
            all = false;
        }
    }
    all
}

/// [`project_all`] with texture places.
#[inline(never)]
pub(super) fn project_textured<C: Coordinate>(
    view: &View,
    positions: &[[C; 3]],
    texels: &[[i32; 2]],
    vertices: &mut [Vertex],
    places: &mut [TexturePlace],
) -> bool {
    let view = *view;
    let mut all = true;
    let out = vertices.iter_mut().zip(places);
    for ((vertex, place), (&position, &texel)) in out.zip(positions.iter().zip(texels)) {
        let p = view.point(position);
        if view.is_within(p) {
            let on = view.project(p);
            *vertex = Vertex::unused(on.place, on.depth);
            *place = TexturePlace::of_mesh(texel, on.fine);
        } else {
            *vertex = view.outside(p.x, p.y, p.z);
            *place = TexturePlace::of_mesh(texel, [0; 2]);
            all = false;
        }
    }
    all
}

/// [`project_all`] of the listed vertices that wait for it, with what `placed` does with the finer places of each; whether
/// all of them lie within the planes.
#[inline(never)]
pub(super) fn project_listed<C: Coordinate>(
    view: &View,
    list: &[u16],
    positions: &[[C; 3]],
    vertices: &mut [Vertex],
    mut placed: impl FnMut(usize, [i32; 2]),
) -> bool {
    let view = *view;
    let mut all = true;
    for &i in list {
        let i = usize::from(i);
        let (Some(vertex), Some(&position)) = (vertices.get_mut(i), positions.get(i)) else {
            continue;
        };
        if !vertex.is_waiting() {
            continue;
        }
        let p = view.point(position);
        if view.is_within(p) {
            let on = view.project(p);
            *vertex = Vertex::unused(on.place, on.depth);
            placed(i, on.fine);
        } else {
            *vertex = view.outside(p.x, p.y, p.z);
            placed(i, [0; 2]);
            all = false;
        }
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::CameraError;
    use crate::num::random::Rng;

    #[test]
    fn places_are_the_nearest_to_those_of_a_division() {
        let screen = Screen::new(320, 240).unwrap();
        let mut rng = Rng(9);
        let (mut worst, mut worst_fine, mut worst_depth) = (0f64, 0f64, 0f64);
        for i in 0..60_000 {
            let size = [0.001f32, 1.0, 5000.0][i % 3];
            let focal = [20.0f32, 200.0, 3000.0][i / 3 % 3];
            let away = size * (3.0 + 40.0 * rng.signed().abs());
            let (o, z, y) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
            let camera = Camera::look_at(o, z, y, focal, size, size * 1000.0).unwrap();
            let model = Affine::placed(size, [0.0, 0.0, -away]).unwrap();
            let view = View::new(&camera, screen, &model);
            let q = [rng.signed(), rng.signed(), rng.signed()].map(|c| (c * 16_384.0) as i16);
            let p = view.point(q);
            if view.beyond(p) != 0 {
                assert!(!view.is_within(p));
                continue;
            }
            assert!(view.is_within(p));
            let on = view.project(p);
            let [x, y, z] = q.map(|c| f64::from(c) / 16_384.0 * f64::from(size));
            let z = f64::from(away) - z;
            let want = [
                8.0 * (f64::from(ORIGIN) + 160.0 + f64::from(focal) * x / z),
                8.0 * (f64::from(ORIGIN) + 120.0 - f64::from(focal) * y / z),
            ];
            let got = [on.place & 0xFFFF, on.place >> 16].map(f64::from);
            for k in 0..2 {
                worst = worst.max((got[k] - want[k]).abs());
                let fine = got[k] + f64::from(on.fine[k]) / 8.0;
                worst_fine = worst_fine.max((fine - want[k]).abs());
            }
            // All depths of a camera have the same factor, 1/2 to 1.
            let depth = f64::from(on.depth) / 2f64.powi(31) * z / f64::from(size);
            let near = View::new(&camera, screen, &Affine::placed(size, [0.0; 3]).unwrap());
            let at_near = near.project(near.point([0i16, 0, -32_768]));
            let factor = f64::from(at_near.depth) / 2f64.powi(30);
            assert!(factor > 0.49 && factor < 1.0001, "{factor}");
            worst_depth = worst_depth.max((depth / factor - 1.0).abs());
        }
        std::println!("{worst} {worst_fine} of 1/8 pixel, {worst_depth}");
        assert!(worst < 0.505, "{worst}");
        assert!(worst_fine < 0.13, "{worst_fine}");
        assert!(worst_depth < 3e-5, "{worst_depth}");
    }

    /// Kills: points on a plane that lie beyond it, or one unit beyond it that do not.
    #[test]
    fn planes_belong_to_what_is_seen() {
        let screen = Screen::new(320, 240).unwrap();
        let (o, ahead, up) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at(o, ahead, up, 200.0, 0.1, 2.0).unwrap();
        let view = View::new(&camera, screen, &Affine::IDENTITY);
        let at = |x: i32, y: i32, z: i32| view.beyond(Point { x, y, z });
        assert_eq!([at(0, 0, view.near), at(0, 0, view.far)], [0, 0]);
        let outside = [at(0, 0, view.near - 1), at(0, 0, view.far + 1)];
        assert_eq!(outside, [beyond::NEAR, beyond::FAR]);
        let z = view.near * 2;
        let side = guard(z);
        for (x, y, plane) in [
            (1, 0, beyond::RIGHT),
            (-1, 0, beyond::LEFT),
            (0, 1, beyond::BOTTOM),
            (0, -1, beyond::TOP),
        ] {
            assert_eq!(at(x * side, y * side, z), 0);
            assert_eq!(at(x * (side + 1), y * (side + 1), z), plane);
        }
    }

    #[test]
    fn cameras_that_are_shifted_see_the_same_from_another_middle() {
        let screen = Screen::new(320, 240).unwrap();
        let mut rng = Rng(10);
        let mut worst = 0;
        for i in 0..20_000 {
            let focal = [90.0f32, 700.0, 3000.0][i % 3];
            let (o, ahead, y) = ([0.0; 3], [0.2, 0.1, -1.0], [0.0, 1.0, 0.0]);
            let camera = Camera::look_at(o, ahead, y, focal, 0.1, 100.0).unwrap();
            let shift = [rng.signed(), rng.signed()].map(|s| s * 900.0);
            let shifted = camera.shifted(shift).unwrap();
            let model = Affine::placed(1.0, [0.0, 0.0, -4.0]).unwrap();
            let q = [rng.signed(), rng.signed(), rng.signed()].map(|c| (c * 16_384.0) as i16);
            let place = |camera: &Camera| {
                let view = View::new(camera, screen, &model);
                let p = view.point(q);
                let on = (view.beyond(p) == 0).then(|| view.project(p).place)?;
                Some([on & 0xFFFF, on >> 16].map(|c| c as i32))
            };
            let (Some(one), Some(other)) = (place(&camera), place(&shifted)) else {
                continue;
            };
            for k in 0..2 {
                let by = (f64::from(shift[k]) * 8.0).round() as i32;
                worst = worst.max((one[k] - by - other[k]).abs());
            }
        }
        assert_eq!(worst, 1);
        let camera = Camera::look_at([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 2.0, 0.1, 9.0);
        let camera = camera.unwrap();
        assert!(camera.shifted([128.0, -128.0]).is_ok());
        for far in [[129.0, 0.0], [0.0, -129.0], [f32::NAN, 0.0], [0.0, 1e9]] {
            assert_eq!(
                camera.shifted(far).err(),
                Some(CameraError::Shift),
                "{far:?}"
            );
        }
    }
}
