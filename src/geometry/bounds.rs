//! A sphere around a mesh, against the view: what lies wholly outside is not transformed (X3, M4).
//!
//! Each plane of the view is a linear function of model space that is negative beyond it. At the
//! sphere's centre it is evaluated with the very rows that vertices are transformed by; its
//! gradient times the radius is how much it can rise within the sphere. All roundings go to the
//! safe side, and the units that vertices and cuts may err are added: a sphere is only said to
//! be outside when every triangle in it would have been culled.
//!
//! Asked once a mesh, and only by [`Scene::draw_within`](crate::Scene::draw_within) and players of lists: who does not
//! call either has no code for it.

use super::camera::{Camera, Screen};
use super::mesh::Coordinate;
use super::project::{Projection, along};
use super::transform::Affine;
use core::ops::Range;

/// A sphere in model space that holds all vertices of a mesh.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Sphere {
    /// Its centre in Q1.30, as far as a coordinate reaches: -2.0 ..< 2.0.
    pub centre: [i32; 3],
    /// Its radius in units of 2^-30, inclusive.
    pub radius: u32,
}

/// Units of clip coordinates that the functions of two points may differ by beyond what is exact:
/// 3 for the products of either, 1 for each of 6 cuts, and some to spare.
const SLACK: i64 = 16;
/// Units of 1/8 pixel by which the picture is taken to be larger on each side: what a projected
/// vertex errs, rounded up.
const MARGIN: i64 = 2;

impl Sphere {
    /// The sphere around the middle of the box that holds `positions`; its radius is at most
    /// twice that of the smallest, and rounded up. To be made once for a mesh.
    #[must_use]
    pub fn around<C: Coordinate>(positions: &[[C; 3]]) -> Self {
        Self::of(positions.iter().map(|p| p.map(C::to_q30)))
    }

    /// The same of points in Q1.30.
    pub(super) fn of(points: impl Iterator<Item = [i32; 3]> + Clone) -> Self {
        let (mut low, mut high) = ([i32::MAX; 3], [i32::MIN; 3]);
        for point in points.clone() {
            for (i, c) in point.into_iter().enumerate() {
                (low[i], high[i]) = (low[i].min(c), high[i].max(c));
            }
        }
        let middle = |i: usize| ((i64::from(low[i]) + i64::from(high[i])) >> 1) as i32;
        let centre = [0, 1, 2].map(middle);
        let mut most = 0;
        for p in points {
            // Half a box and a unit: at most 2^31, so the sum of three squares is below 2^64.
            let square = |i: usize| u64::from(p[i].abs_diff(centre[i])).pow(2);
            most = most.max(square(0) + square(1) + square(2));
        }
        let radius = if most == 0 { 0 } else { most.isqrt() + 1 };
        Self {
            centre,
            radius: u32::try_from(radius).unwrap_or(u32::MAX),
        }
    }

    /// Whether nothing within the sphere, at `model`, can be seen on `lines` of the picture.
    pub(crate) fn is_outside(
        &self,
        camera: &Camera,
        screen: Screen,
        lines: &Range<u16>,
        model: &Affine,
    ) -> bool {
        let projection = Projection::new(camera, model);
        let (width, height) = (screen.width(), screen.height());
        let rows = projection.rows.map(|row| row.map(i64::from));
        let at = |i: usize| along(projection.rows[i], self.centre, projection.offset[i]);
        let z = i64::from(at(2));
        if self.is_beyond(rows[2], z - i64::from(projection.near), SLACK)
            || self.is_beyond(rows[2], i64::from(projection.far) - z, SLACK)
        {
            return true;
        }
        // X = v 2^power / z in units of 1/8 pixel; both sides are multiplied by z > 0.
        let up = projection.power.clamp(0, 30);
        let down = (-projection.power).clamp(0, 16);
        [(width, &(0..width)), (height, lines)]
            .into_iter()
            .enumerate()
            .any(|(axis, (side, range))| {
                let (v, middle) = (at(axis), 4 * i64::from(side));
                let edges = [
                    (8 * i64::from(range.start) - middle - MARGIN, 1),
                    (8 * i64::from(range.end) - middle + MARGIN, -1),
                ];
                edges.into_iter().any(|(edge, sign)| {
                    let edge = edge << down;
                    let of = |v: i64, z: i64| sign * ((v << up) - edge * z);
                    let gradient = [0, 1, 2].map(|k| of(rows[axis][k], rows[2][k]));
                    let slack = SLACK * ((1 << up) + edge.abs());
                    self.is_beyond(gradient, of(i64::from(v), z), slack)
                })
            })
    }

    /// Whether a function with this gradient a matrix unit, and `at` in the centre, is below
    /// `-slack` in the whole sphere.
    fn is_beyond(&self, gradient: [i64; 3], at: i64, slack: i64) -> bool {
        let g = gradient.map(i64::unsigned_abs);
        let bits = 64 - (g[0] | g[1] | g[2]).leading_zeros();
        let down = bits.saturating_sub(30);
        // At most 2^30 each, rounded up.
        let squares = g.map(|g| ((g >> down) + 1).pow(2));
        let steepest = (squares[0] + squares[1] + squares[2]).isqrt() + 1;
        // Below 2^31 times below 2^32; a coordinate times an entry is in units of 2^-32.
        let reach = (((steepest * u64::from(self.radius)) >> 32) + 1) << down;
        at + slack + (reach as i64) < 0
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn spheres_hold_their_points() {
        let mut seed = 7u32;
        let mut random = || {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed ^ seed >> 13) as i32
        };
        for i in 0..2_000 {
            let down = i % 31;
            let points: std::vec::Vec<[i32; 3]> = (0..1 + i % 9)
                .map(|_| [random(), random(), random()].map(|c| c >> down))
                .collect();
            let sphere = Sphere::around(&points);
            for p in points {
                let square = |k: usize| {
                    let d = i128::from(p[k]) - i128::from(sphere.centre[k]);
                    d * d
                };
                let away = square(0) + square(1) + square(2);
                assert!(away <= i128::from(sphere.radius).pow(2), "{p:?} {sphere:?}");
            }
        }
        assert_eq!(Sphere::around(&[[5i32, -7, 9]]).radius, 0);
        let corners = [[i32::MIN; 3], [i32::MAX; 3]];
        assert_eq!(Sphere::around(&corners).radius, 3_719_550_787);
    }

    /// Kills: other roundings of the steepest way and of how far it reaches.
    #[test]
    fn a_sphere_is_beyond_from_its_radius_on() {
        let sphere = Sphere {
            centre: [0; 3],
            radius: 1 << 31,
        };
        // The root of (2^29 + 1)^2 + 2 is rounded up, half of that is, and 2^32 is taken as 2^30 four times.
        for (gradient, reach) in [
            ([1 << 29, 0, 0], (1 << 28) + 2),
            ([0, -(1 << 29), 0], (1 << 28) + 2),
            ([0, 0, 1 << 32], 8 * ((1 << 28) + 2)),
        ] {
            for slack in [0, 5] {
                assert!(sphere.is_beyond(gradient, -reach - 1 - slack, slack));
                assert!(!sphere.is_beyond(gradient, -reach - slack, slack));
            }
        }
    }
}
