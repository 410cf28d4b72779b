//! Clipping of the triangles that cross the near, far or guard planes (K1).
//!
//! Sutherland and Hodgman, plane by plane. Near and far cut in space, so attributes follow the
//! edge linearly; the guard band cuts on the screen, where colour is linear, so there they
//! follow the projected edge and clipping leaves the shading as if nothing had been cut.
//! Each cut is reckoned from the inner to the outer end, so two triangles that share an edge
//! get the same new vertex.

use super::project::{ClipPoint, Projection};
use super::shading::Shading;
use heapless::Vec;

/// A corner on its way through the planes.
#[derive(Clone, Copy, Debug)]
pub(super) struct Corner<A> {
    pub(super) point: ClipPoint,
    pub(super) attribute: A,
}

/// A convex polygon: a triangle gains at most one corner a plane.
pub(super) type Polygon<A> = Vec<Corner<A>, 9, u8>;

/// Clips at the near and far planes.
pub(super) fn near_far<S: Shading>(
    triangle: [Corner<S::Vertex>; 3],
    projection: &Projection,
) -> Polygon<S::Vertex> {
    let mut polygon = Polygon::new();
    // Three of nine places: cannot be full.
    let _ = polygon.extend_from_slice(&triangle);
    let (near, far) = (i64::from(projection.near), i64::from(projection.far));
    polygon = cut::<S>(&polygon, &|p| i64::from(p.z) - near, false);
    cut::<S>(&polygon, &|p| far - i64::from(p.z), false)
}

/// Clips a triangle, already within near and far, at the four sides of the guard band.
pub(super) fn guard<S: Shading>(
    triangle: [Corner<S::Vertex>; 3],
    projection: &Projection,
) -> Polygon<S::Vertex> {
    let mut polygon = Polygon::new();
    let _ = polygon.extend_from_slice(&triangle);
    let power = projection.power();
    for axis in 0..2 {
        let guard = projection.guard(axis);
        for sign in [1, -1] {
            // |X| = |x| 2^power / z <= guard, in 64 bits: 15 + 30 and 30 + 20.
            let inside = |p: ClipPoint| {
                let v = i64::from(if axis == 0 { p.x } else { p.y });
                let (z, v) = (guard * i64::from(p.z), sign * v);
                if power >= 0 {
                    z - (v << power.min(30))
                } else {
                    (z << (-power).min(16)) - v
                }
            };
            polygon = cut::<S>(&polygon, &inside, true);
        }
    }
    polygon
}

/// Keeps what lies where `inside` is not negative.
///
/// The result begins with the first corner inside, or with the new one just before it: of a
/// polygon drawn as a fan, the first corner decides how colours run.
#[inline(never)]
fn cut<S: Shading>(
    polygon: &[Corner<S::Vertex>],
    inside: &dyn Fn(ClipPoint) -> i64,
    on_screen: bool,
) -> Polygon<S::Vertex> {
    let mut kept = Polygon::new();
    let Some(first) = polygon.first() else {
        return kept;
    };
    let first_in = inside(first.point);
    let (mut this, mut this_in) = (first, first_in);
    for i in 1..=polygon.len() {
        let (next, next_in) = match polygon.get(i) {
            Some(next) => (next, inside(next.point)),
            None => (first, first_in),
        };
        if this_in >= 0 {
            let _ = kept.push(*this);
        }
        if (this_in < 0) != (next_in < 0) {
            let (mut inner, mut outer) = ((this, this_in), (next, next_in));
            if this_in < 0 {
                (inner, outer) = (outer, inner);
            }
            let new = between::<S>(inner, outer, on_screen);
            // A convex polygon crosses a plane twice and loses a corner for the two it gains.
            let _ = kept.push(new);
        }
        (this, this_in) = (next, next_in);
    }
    kept
}

/// The point where the edge from `inner` to `outer` meets the plane.
fn between<S: Shading>(
    (inner, near): (&Corner<S::Vertex>, i64),
    (outer, far): (&Corner<S::Vertex>, i64),
    on_screen: bool,
) -> Corner<S::Vertex> {
    // t = near / (near - far) in 2^-30; both below 2^61, normalised to 33 bits first.
    let whole = near.unsigned_abs() + far.unsigned_abs();
    let down = 31u32.saturating_sub(whole.leading_zeros());
    let t = ((near.unsigned_abs() >> down) << 30) / (whole >> down).max(1);
    let t = (t as i64).min(1 << 30);
    let mix = |a: i32, b: i32| {
        (i64::from(a) + (((i64::from(b) - i64::from(a)) * t + (1 << 29)) >> 30)) as i32
    };
    let (a, b) = (inner.point, outer.point);
    let point = ClipPoint {
        x: mix(a.x, b.x),
        y: mix(a.y, b.y),
        z: mix(a.z, b.z),
    };
    // On the screen the same point is at t zb / z of the projected edge.
    let space = t;
    let t = if on_screen && point.z > 0 {
        ((((t >> 1) * i64::from(b.z)) / i64::from(point.z)) << 1).clamp(0, 1 << 30)
    } else {
        t
    };
    Corner {
        point,
        attribute: S::lerp(inner.attribute, outer.attribute, t, space),
    }
}

#[cfg(test)]
mod tests {
    use super::super::camera::{Camera, Screen};
    use super::super::shading::Flat;
    use super::super::transform::Affine;
    use super::*;
    use crate::num::random::Rng;

    /// Two triangles on either side of an edge get the same points where planes cut it, whichever
    /// way either goes along it.
    #[test]
    fn neighbours_are_cut_at_the_same_points() {
        let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at([0.0; 3], ahead, up, 2000.0, 0.1, 1.0).unwrap();
        let screen = Screen::new(320, 240).unwrap();
        let projection = Projection::new(&camera, screen, &Affine::IDENTITY);
        let mut rng = Rng(23);
        let mut compared = 0;
        for _ in 0..40_000 {
            let mut corner = || Corner {
                point: projection.transform([(); 3].map(|()| rng.bits() as i32)),
                attribute: (),
            };
            let (p, q, r, s) = (corner(), corner(), corner(), corner());
            let on_edge = |polygon: &[Corner<()>], own: ClipPoint, sides: [i64; 2]| {
                let [near, far] = sides;
                let at = |c: &&Corner<()>| {
                    let z = i64::from(c.point.z);
                    c.point != own && (z == near || z == far)
                };
                let mut points: std::vec::Vec<_> =
                    polygon.iter().filter(at).map(|c| c.point).collect();
                points.sort_by_key(|p| (p.z, p.x, p.y));
                points
            };
            let sides = [i64::from(projection.near), i64::from(projection.far)];
            let [a, b] = [[p, q, r], [q, p, s]].map(|t| near_far::<Flat>(t, &projection));
            let (a, b) = (on_edge(&a, r.point, sides), on_edge(&b, s.point, sides));
            // One end within and one beyond a plane: of that edge there is one point in both.
            let within = |c: &Corner<()>| (sides[0]..=sides[1]).contains(&i64::from(c.point.z));
            if within(&p) != within(&q) {
                assert!(
                    a.iter().any(|point| b.contains(point)),
                    "{p:?} {q:?}: {a:?} {b:?}"
                );
                compared += 1;
            }
        }
        assert!(compared > 5_000, "{compared}");
    }
}
