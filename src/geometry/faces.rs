//! What is known of faces before there are objects: their indices, and their normals (K2).

use super::mesh::{Faces, Mesh, QuadSplit};
use super::transform::{unit, wide_cross};

/// Which faces are dropped.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Cull {
    /// Those seen from behind.
    #[default]
    Back,
    /// None.
    None,
}

/// A mesh that contradicts itself. Nothing of it is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum MeshError {
    /// An attribute slice is neither empty nor as long as the positions.
    AttributeLength,
    /// This face names a vertex that does not exist.
    Index {
        /// Index of the face.
        face: u32,
    },
    /// A quad strip has an odd number of indices, or two.
    StripLength,
    /// Meshlets are of other faces, or of more vertices than there are.
    Meshlets,
}

/// How many triangles there are.
pub(crate) fn triangles(faces: Faces<'_>) -> u32 {
    (match faces {
        Faces::Triangles(faces) => faces.len(),
        Faces::Quads(faces, _) => 2 * faces.len(),
        Faces::QuadStrip(strip, _) => strip.len().saturating_sub(2),
    }) as u32
}

/// Whether all slices agree and all indices exist, of which those that are looked at later are not looked at.
pub(crate) fn check<C>(mesh: &Mesh<'_, C>, are_late: bool) -> Result<(), MeshError> {
    let count = mesh.positions.len();
    let fits = |len: usize| len == 0 || len == count;
    if !fits(mesh.normals.len()) || !fits(mesh.colours.len()) {
        return Err(MeshError::AttributeLength);
    }
    // Faces take so many indices each, a strip two more before the first.
    let (indices, first, each) = match mesh.faces {
        Faces::Triangles(faces) => (faces.as_flattened(), 0, 3),
        Faces::Quads(faces, _) => (faces.as_flattened(), 0, 4),
        Faces::QuadStrip(strip, _) if strip.len() % 2 != 0 || strip.len() == 2 => {
            return Err(MeshError::StripLength);
        }
        Faces::QuadStrip(strip, _) => (strip, 2, 2),
    };
    if are_late || are_below(indices, count) {
        return Ok(());
    }
    match indices.iter().position(|&i| usize::from(i) >= count) {
        Some(bad) => Err(MeshError::Index {
            face: (bad.saturating_sub(first) / each) as u32,
        }),
        None => Ok(()),
    }
}

/// Whether all indices are below `count`: three instructions each on a Cortex-M4.
#[inline(never)]
fn are_below(indices: &[u16], count: usize) -> bool {
    let last = count.min(1 << 16) as i32 - 1;
    // The sign of the least distance from the last.
    indices
        .iter()
        .fold(0, |all, &i| all | (last - i32::from(i)))
        >= 0
}

/// Calls `f` with face, corners and provoking vertex of each triangle.
#[inline]
pub(crate) fn each_triangle(faces: Faces<'_>, mut f: impl FnMut(u32, [u16; 3], u16)) {
    let mut quad = |face: u32, q: [u16; 4], split| {
        let [a, b, c, d] = q;
        let triangles = match split {
            QuadSplit::Corner0To2 => [[a, b, c], [a, c, d]],
            QuadSplit::Corner1To3 => [[a, b, d], [b, c, d]],
        };
        for corners in triangles {
            f(face, corners, a);
        }
    };
    match faces {
        Faces::Triangles(faces) => {
            for (face, &corners) in (0..).zip(faces) {
                f(face, corners, corners[0]);
            }
        }
        Faces::Quads(faces, split) => {
            for (face, &q) in (0..).zip(faces) {
                quad(face, q, split);
            }
        }
        Faces::QuadStrip(strip, split) => {
            // Two new vertices reuse the last two and take their roles crosswise, so a constant
            // split gives a cross-hatch.
            for (face, p) in (0..).zip(strip.windows(4).step_by(2)) {
                let split = if face % 2 == 0 { split } else { split.other() };
                quad(face, [p[0], p[1], p[3], p[2]], split);
            }
        }
    }
}

/// The unit normal of a face in Q1.14, from corners in Q1.30; counter-clockwise is outside.
pub(crate) fn face_normal(corners: [[i32; 3]; 3]) -> [i16; 3] {
    unit(wide_normal(corners, 30)).map(|c| c.to_bits())
}

/// The cross product of two sides of a face, shifted together until they have so many bits: products fit then, and small
/// faces keep all of theirs.
#[inline(always)]
pub(super) fn wide_normal(p: [[i32; 3]; 3], bits: u32) -> [i64; 3] {
    let [a, b] = [1, 2].map(|k| [0, 1, 2].map(|i| i64::from(p[k][i]) - i64::from(p[0][i])));
    let all = a.iter().chain(&b);
    let magnitudes = all.fold(1, |all, d| all | d.unsigned_abs());
    let down = (64 - bits).saturating_sub(magnitudes.leading_zeros());
    let [a, b] = [a, b].map(|d| d.map(|d| (d >> down) as i32));
    wide_cross(a, b)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::QuadSplit::Corner0To2;
    use crate::num::random::Rng;

    const PLACES: [[i16; 3]; 4] = [[0; 3]; 4];

    fn checked(faces: Faces<'_>) -> Result<(), MeshError> {
        check(
            &Mesh {
                positions: &PLACES,
                normals: &[],
                colours: &[],
                faces,
            },
            false,
        )
    }

    /// Kills: sides in the other order; more bits than products hold, and fewer than small faces have.
    #[test]
    fn normals_of_faces_of_any_size_are_those_of_f64() {
        let mut rng = Rng(83);
        let mut seen = 0;
        for i in 0..40_000 {
            let corners = [(); 3].map(|()| [(); 3].map(|()| (rng.bits() as i32) >> (i % 30)));
            let side =
                |k: usize| [0, 1, 2].map(|i| f64::from(corners[k][i]) - f64::from(corners[0][i]));
            let (a, b) = (side(1), side(2));
            let across = |i: usize, k: usize| a[i] * b[k] - a[k] * b[i];
            let normal = [across(1, 2), across(2, 0), across(0, 1)];
            let length = |v: [f64; 3]| v.iter().map(|c| c * c).sum::<f64>().sqrt();
            if length(normal) <= 0.01 * length(a) * length(b) {
                continue;
            }
            let got = face_normal(corners);
            for axis in 0..3 {
                let want = normal[axis] / length(normal) * 16384.0;
                let off = f64::from(got[axis]) - want;
                assert!(off.abs() < 0.51, "{corners:?}: {got:?}, {want}");
            }
            seen += 1;
        }
        assert!(seen > 35_000, "{seen}");
    }

    /// Kills: strips of two or an odd number that are let in, and a count of their triangles without its end.
    #[test]
    fn strips_have_an_even_number_of_corners_and_not_two() {
        let strip = [0, 1, 2, 3, 0, 1];
        for (len, count) in [
            (0, Some(0)),
            (1, None),
            (2, None),
            (3, None),
            (4, Some(2)),
            (5, None),
            (6, Some(4)),
        ] {
            let faces = Faces::QuadStrip(&strip[..len], Corner0To2);
            match count {
                Some(count) => assert_eq!((checked(faces), triangles(faces)), (Ok(()), count)),
                None => assert_eq!(checked(faces), Err(MeshError::StripLength), "{len}"),
            }
        }
    }

    /// Kills: a corner right behind the last that is let in, the last that is refused, and the wrong face.
    #[test]
    fn the_face_of_a_corner_that_is_not_there_is_named() {
        let index = |face| Err(MeshError::Index { face });
        assert_eq!(checked(Faces::Triangles(&[[0, 1, 3], [3, 2, 1]])), Ok(()));
        assert_eq!(
            checked(Faces::Triangles(&[[0, 1, 3], [0, 1, 2], [3, 2, 4]])),
            index(2)
        );
        let quads = [[0, 1, 2, 3], [0, 4, 2, 3]];
        assert_eq!(checked(Faces::Quads(&quads[..1], Corner0To2)), Ok(()));
        assert_eq!(triangles(Faces::Quads(&[quads[0]; 3], Corner0To2)), 6);
        assert_eq!(checked(Faces::Quads(&quads, Corner0To2)), index(1));
        for (at, face) in [(0, 0), (1, 0), (2, 0), (3, 0), (4, 1), (5, 1)] {
            let mut strip = [0, 1, 2, 3, 0, 1];
            strip[at] = 4;
            assert_eq!(
                checked(Faces::QuadStrip(&strip, Corner0To2)),
                index(face),
                "{at}"
            );
        }
    }

    /// Kills: attributes of another length that are let in, and none that are refused.
    #[test]
    fn attributes_are_none_or_as_many_as_places() {
        for (normals, colours, is_good) in [
            (4, 0, true),
            (0, 4, true),
            (3, 0, false),
            (0, 5, false),
            (4, 3, false),
        ] {
            let result = check(
                &Mesh {
                    positions: &PLACES,
                    normals: &[[0; 3]; 5][..normals],
                    colours: &[[0; 3]; 5][..colours],
                    faces: Faces::Triangles(&[]),
                },
                false,
            );
            let want = if is_good {
                Ok(())
            } else {
                Err(MeshError::AttributeLength)
            };
            assert_eq!(result, want, "{normals} {colours}");
        }
    }
}
