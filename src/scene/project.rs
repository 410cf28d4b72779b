//! Vertices from model space to the screen, in one loop (K1).
//!
//! The focal length lies in the rows, so a place is `x / z` in units of 2^-17 of 1/8 pixel, without a
//! shift of its own. `1 / z = r 2^-47 (1 + m 2^-28)` with a reciprocal of 16 bits and a correction from
//! its remainder: 32-bit products alone, 81 instructions a vertex on a Cortex-M4 and 220 on a Cortex-M0+
//! for what lies inside (scene A, by `firmware --profile a`). A place is within 0.501 units of 1/8 pixel of the exact one.
//!
//! The guard band reaches 2,047.7 pixels either way from the middle, so that all differences of places have
//! 16 bits, also of places that were rounded away from each other.

use super::record::{ORIGIN, TexturePlace, Vertex};
use crate::geometry::{Affine, Camera, Coordinate, Projection, Screen, along};
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
    /// Rows and offsets of x and y before what they lose: so many bits.
    finer_rows: [[i32; 3]; 2],
    finer_offset: [i32; 2],
    pub(super) finer: i32,
}

impl View {
    #[inline(never)]
    pub(super) fn new(camera: &Camera, screen: Screen, model: &Affine) -> Self {
        let projection = Projection::new(camera, model);
        let (mut rows, mut offset) = (projection.rows, projection.offset);
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
        // In the middle, less the half space that a signed quotient is taken from.
        let centre = |side: u16| ((4 * i32::from(side) + 8 * ORIGIN - 0x8000) << 14) + (1 << 13);
        Self {
            rows,
            offset,
            near: range(projection.near),
            far: range(projection.far),
            down: projection.near_down + along + 1,
            centre: [centre(screen.width()), centre(screen.height())],
            finer_rows: [projection.rows[0], projection.rows[1]],
            finer_offset: [projection.offset[0], projection.offset[1]],
            finer: cross,
        }
    }

    /// A position's vertex, which is not lit yet, and its finer place; `all` is false from the first that does not lie
    /// within the planes.
    #[inline(always)]
    fn vertex<C: Coordinate>(&self, position: [C; 3], all: &mut bool) -> (Vertex, [i32; 2]) {
        let p = self.point(position);
        if self.is_within(p) {
            let on = self.project(p);
            return (Vertex::unused(on.place, on.depth), on.fine);
        }
        *all = false;
        (self.outside(p.x, p.y, p.z), [0; 2])
    }

    /// Nine products.
    #[inline(always)]
    pub(super) fn point<C: Coordinate>(&self, p: [C; 3]) -> Point {
        let row = |i: usize| along(self.rows[i], p, self.offset[i]);
        let [x, y, z] = [row(0), row(1), row(2)];
        Point { x, y, z }
    }

    /// The point of a position that is seen at a point, with all bits that x and y can have: a cut at the near plane
    /// magnifies what they lose.
    ///
    /// What lies between two guard planes does so here as well.
    #[inline(never)]
    pub(super) fn finer(&self, p: [i32; 3], seen: Point) -> Point {
        let (beyond, reach) = (self.beyond(seen), self.reach(seen.z));
        let row = |i: usize, planes: u32| {
            let v = along(self.finer_rows[i], p, self.finer_offset[i]);
            if beyond & planes == 0 {
                v.max(-reach).min(reach)
            } else {
                v
            }
        };
        Point {
            x: row(0, beyond::RIGHT | beyond::LEFT),
            y: row(1, beyond::BOTTOM | beyond::TOP),
            z: seen.z,
        }
    }

    /// Whether a [finer](Self::finer) point lies within all guard planes.
    #[inline(never)]
    pub(super) fn is_between(&self, p: Point) -> bool {
        p.x.abs().max(p.y.abs()) <= self.reach(p.z)
    }

    /// How far the guard band reaches, for a [finer](Self::finer) point: more than it can have, where it would be.
    fn reach(&self, z: i32) -> i32 {
        let finer = self.finer & 31;
        guard(z).min(i32::MAX >> finer) << finer
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

    /// How far a [finer](Self::finer) point lies within a plane; below 0 beyond it.
    #[inline(never)]
    pub(super) fn within(&self, plane: u32, p: Point) -> i64 {
        let reach = self.reach(p.z);
        let (most, at) = match plane {
            beyond::NEAR => (p.z, self.near),
            beyond::FAR => (self.far, p.z),
            beyond::RIGHT => (reach, p.x),
            beyond::LEFT => (reach, -p.x),
            beyond::BOTTOM => (reach, p.y),
            _ => (reach, -p.y),
        };
        i64::from(most) - i64::from(at)
    }

    /// A point within all planes to the screen, x and y of which have so many bits more.
    #[inline(never)]
    pub(super) fn project_finer(&self, p: Point, finer: i32) -> OnScreen {
        // Only ratios count, so z may be as large as it can.
        let up = leading_zeros(p.z as u32) as i32 - 1;
        let more = up - finer;
        let scaled = |v: i32| match more {
            ..=-1 => rounded(v, -more),
            _ => v << (more & 31),
        };
        let (x, y) = (scaled(p.x), scaled(p.y));
        self.place(x, y, p.z << (up & 31), up)
    }

    /// A point within all planes to the screen.
    #[inline(always)]
    pub(super) fn project(&self, p: Point) -> OnScreen {
        self.place(p.x, p.y, p.z, 0)
    }

    /// A point within all planes, made larger by so many bits, to the screen.
    #[inline(always)]
    fn place(&self, mut x: i32, mut y: i32, mut z: i32, mut up: i32) -> OnScreen {
        if SHORT {
            // A round or two: cheaper than a count of zeros.
            if z >> 28 == 0 {
                (x, y, z, up) = (x << 3, y << 3, z << 3, up + 3);
            }
            while z > 0 {
                (x, y, z, up) = (x << 1, y << 1, z << 1, up + 1);
            }
        } else {
            let more = leading_zeros(z as u32) as i32;
            (x, y, z) = (x << (more & 31), y << (more & 31), z << (more & 31));
            up += more;
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
        (*vertex, _) = view.vertex(position, &mut all);
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
        let fine;
        (*vertex, fine) = view.vertex(position, &mut all);
        *place = TexturePlace::of_mesh(texel, fine);
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
        let fine;
        (*vertex, fine) = view.vertex(position, &mut all);
        placed(i, fine);
    }
    all
}

#[cfg(test)]
mod tests;
