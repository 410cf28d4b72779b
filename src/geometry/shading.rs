//! What a shading keeps at vertices, at faces and on the way along a line (H16).
//!
//! A shading that needs nothing somewhere has `()` there: no bytes in the records, no code.

use super::colour::Colour;
use crate::num::{InverseArea, Plane};

/// Which colours an object carries, from vertex to plane.
pub trait Shading {
    /// Kept at each vertex of the slow arena.
    type Vertex: Copy + Send + Sync + Default + 'static;
    /// Kept at each object of the slow arena.
    type Face: Copy + Send + Sync + Default + 'static;
    /// Set up when an object becomes active.
    type Levels: Copy + Send + Sync + 'static;
    /// What a slot holds before anything is set up.
    const NO_LEVELS: Self::Levels;
    /// Whether a face is lit as a whole, by its own normal, with its first corner's colour.
    const PER_FACE: bool;

    /// What to keep of a vertex's lit colour.
    fn vertex(colour: Colour) -> Self::Vertex;

    /// What to keep of a face's lit colour.
    fn face(colour: Colour) -> Self::Face;

    /// The vertex's value at `t` (0 to 2^30) on the way from `a` to `b`.
    fn lerp(a: Self::Vertex, b: Self::Vertex, t: i64) -> Self::Vertex;

    /// Sets up an object. `steps` are the output's steps a channel, such as 31, 63, 31.
    ///
    /// `None` when the triangle is too thin for planes.
    fn set_up(
        area: &InverseArea,
        corners: [Self::Vertex; 3],
        face: Self::Face,
        steps: [u16; 3],
    ) -> Option<Self::Levels>;

    /// The levels of one pixel from its weights at corners 1 and 2 (0 to 2^30 each, their sum
    /// too), for triangles that are too thin for planes.
    fn weighted(
        weights: [i64; 2],
        corners: [Self::Vertex; 3],
        face: Self::Face,
        steps: [u16; 3],
    ) -> Self::Levels;
}

/// One colour a face.
#[derive(Clone, Copy, Debug)]
pub struct Flat;

/// The levels of a face, in whole steps of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlatLevels(pub [u8; 3]);

/// Colours at the vertices, linear between them on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Gouraud;

/// The three channels as planes, 16.16 steps of the output, half a step added for rounding.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct GouraudPlanes(pub [Plane; 3]);

/// A channel from 8.8 levels to 16.16 steps of the output plus one half, so that cutting off
/// the fraction rounds to nearest.
///
/// The result is within `0.5 ..= steps + 0.5`: an error below one half at either end cannot
/// leave the range, so no colour ever wraps (P4).
#[inline]
fn to_steps(level: u32, steps: u16) -> i32 {
    // steps 2^16 / (255 * 2^8), in 2^-13: 255 gives 2^21 exactly.
    let factor = ((u32::from(steps) << 21) + 127) / 255;
    ((u64::from(level) * u64::from(factor) + (1 << 12)) >> 13) as i32 + (1 << 15)
}

fn all_to_steps(colour: Colour, steps: [u16; 3]) -> [i32; 3] {
    let level = colour.levels();
    [0, 1, 2].map(|i| to_steps(level[i], steps[i]))
}

impl Shading for Flat {
    type Vertex = ();
    type Face = Colour;
    type Levels = FlatLevels;
    const NO_LEVELS: FlatLevels = FlatLevels([0; 3]);
    const PER_FACE: bool = true;

    fn vertex(_: Colour) {}

    fn face(colour: Colour) -> Colour {
        colour
    }

    fn lerp((): (), (): (), _: i64) {}

    fn set_up(_: &InverseArea, _: [(); 3], face: Colour, steps: [u16; 3]) -> Option<FlatLevels> {
        Some(Self::weighted([0; 2], [(); 3], face, steps))
    }

    fn weighted(_: [i64; 2], _: [(); 3], face: Colour, steps: [u16; 3]) -> FlatLevels {
        FlatLevels(all_to_steps(face, steps).map(|c| (c >> 16) as u8))
    }
}

impl Shading for Gouraud {
    type Vertex = Colour;
    type Face = ();
    type Levels = GouraudPlanes;
    const NO_LEVELS: GouraudPlanes = GouraudPlanes([Plane::ZERO; 3]);
    const PER_FACE: bool = false;

    #[inline]
    fn vertex(colour: Colour) -> Colour {
        colour
    }

    fn face(_: Colour) {}

    fn lerp(a: Colour, b: Colour, t: i64) -> Colour {
        a.lerp(b, t)
    }

    #[inline]
    fn set_up(
        area: &InverseArea,
        corners: [Colour; 3],
        (): (),
        steps: [u16; 3],
    ) -> Option<GouraudPlanes> {
        let c = corners.map(|c| all_to_steps(c, steps));
        let plane = |i: usize| area.plane([c[0][i], c[1][i], c[2][i]]);
        Some(GouraudPlanes([plane(0)?, plane(1)?, plane(2)?]))
    }

    fn weighted(w: [i64; 2], corners: [Colour; 3], (): (), steps: [u16; 3]) -> GouraudPlanes {
        let c = corners.map(|c| all_to_steps(c, steps));
        GouraudPlanes([0, 1, 2].map(|i| {
            let to = |k: usize| i64::from(c[k][i] - c[0][i]) * w[k - 1];
            Plane {
                at: c[0][i] + ((to(1) + to(2)) >> 30) as i32,
                ..Plane::ZERO
            }
        }))
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn channels_reach_both_ends() {
        for steps in [255u16, 63, 31] {
            assert_eq!(to_steps(0, steps), 1 << 15);
            let top = to_steps(0xFF00, steps) - (1 << 15);
            assert!(
                (top - (i32::from(steps) << 16)).abs() <= 1,
                "{steps}: {top}"
            );
        }
        assert_eq!(to_steps(100 << 8, 255), (100 << 16) + (1 << 15));
    }
}
