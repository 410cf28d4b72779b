//! Parts of a mesh that are turned away at one go (X3, M4).
//!
//! A part has up to 64 vertices, a sphere that holds them, and a cone: a point behind all of its faces, and the normals
//! about an axis. An eye from which the way `d` to that point has `d axis >= s |d|`, with `s` the sine of the cone's half
//! angle, lies behind all of them, and nothing of the part is looked at. All is 32 bits, with roundings to the safe side.

use super::bounds::Sphere;
use super::faces::{MeshError, face_normal};
use super::mesh::{Coordinate, Faces, place_of};
use super::transform::{Affine, cross, dot, unit};
use core::fmt;

/// Vertices of a part at most.
const MOST_VERTICES: usize = 64;
/// Faces of a part at most: of a strip in two rows.
const MOST_FACES: usize = 126;

/// A part of a mesh: the faces that follow those of the part before, and the vertices that they have.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Meshlet {
    /// How many faces it has.
    pub faces: u16,
    /// How many entries of the table of vertices.
    pub vertices: u16,
    /// Holds all of its vertices.
    pub sphere: Sphere,
    /// A point in Q1.30 that lies behind all of its faces.
    pub apex: [i32; 3],
    /// The middle of the normals of its faces, a unit vector in Q1.14; zero where they look everywhere.
    pub axis: [i16; 3],
    /// The square of the sine of the widest angle between the axis and a normal, in 1/65536, rounded up.
    pub spread: u16,
}

impl Meshlet {
    /// What fresh memory is filled with.
    pub const EMPTY: Self = Self {
        faces: 0,
        vertices: 0,
        sphere: Sphere {
            centre: [0; 3],
            radius: 0,
        },
        apex: [0; 3],
        axis: [0; 3],
        spread: 0,
    };
}

/// A mesh in parts, for [`Scene::draw_meshlets`](crate::Scene::draw_meshlets): to be [cut](Meshlets::cut) once for a mesh, or to
/// be made [of tables](Meshlets::of) that were cut before.
///
/// ```
/// use scanbeam::mesh::{Meshlet, Meshlets};
///
/// // Two faces that share a side.
/// let positions = [[0_i16, 0, 0], [1000, 0, 0], [1000, 1000, 0], [0, 1000, 0]];
/// let mut faces = [[0, 1, 2], [0, 2, 3]];
/// let (mut parts, mut vertices) = ([Meshlet::EMPTY; 1], [0; 6]);
/// let meshlets = Meshlets::cut(&positions, &mut faces, &mut parts, &mut vertices)?;
/// assert_eq!((meshlets.parts().len(), meshlets.vertices().len()), (1, 4));
/// # Ok::<(), scanbeam::mesh::CutError>(())
/// ```
#[derive(Clone, Copy, Debug)]
pub struct Meshlets<'a> {
    faces: &'a [[u16; 3]],
    parts: &'a [Meshlet],
    vertices: &'a [u16],
    /// More than any number of a vertex.
    pub(crate) end: usize,
}

/// Why a mesh cannot be cut.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CutError {
    /// This face names a vertex that does not exist.
    Index {
        /// Index of the face.
        face: u32,
    },
    /// There are more parts than memory: one for 11 faces suffices always.
    Parts {
        /// How many there is room for.
        have: usize,
    },
    /// There are more entries of vertices than memory: three for a face suffice always.
    Vertices {
        /// How many there is room for.
        have: usize,
    },
}

impl fmt::Display for CutError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("mesh: ")?;
        match self {
            Self::Index { face } => write!(f, "face {face} names a vertex that is not there"),
            Self::Parts { have } => write!(f, "more parts than the {have} there is room for"),
            Self::Vertices { have } => {
                write!(
                    f,
                    "more vertices of parts than the {have} there is room for"
                )
            }
        }
    }
}

impl core::error::Error for CutError {}

impl<'a> Meshlets<'a> {
    /// Cuts a mesh into parts of faces that are near to each other, by which its faces are sorted then. The same parts
    /// everywhere.
    ///
    /// # Errors
    /// When a face is wrong, before anything is sorted, or memory does not suffice.
    pub fn cut<C: Coordinate>(
        positions: &[[C; 3]],
        faces: &'a mut [[u16; 3]],
        parts: &'a mut [Meshlet],
        vertices: &'a mut [u16],
    ) -> Result<Self, CutError> {
        let is_there = |&i: &u16| usize::from(i) < positions.len();
        if let Some(face) = faces.iter().position(|face| !face.iter().all(is_there)) {
            return Err(CutError::Index { face: face as u32 });
        }
        let mut cutter = Cutter {
            positions,
            parts,
            vertices,
            parts_made: 0,
            listed: 0,
        };
        cutter.cut(faces)?;
        let (parts_made, listed) = (cutter.parts_made, cutter.listed);
        Ok(Self {
            faces,
            parts: parts.get(..parts_made).unwrap_or_default(),
            vertices: vertices.get(..listed).unwrap_or_default(),
            end: positions.len(),
        })
    }

    /// Parts that were cut before, of tables in flash, say. All faces are looked at here, and not when they are drawn.
    ///
    /// # Errors
    /// Where parts have not as many faces and vertices as there are, or a face has a vertex that its part has not.
    pub fn of(
        faces: &'a [[u16; 3]],
        parts: &'a [Meshlet],
        vertices: &'a [u16],
    ) -> Result<Self, MeshError> {
        let (mut rest, mut listed) = (faces, vertices);
        let wrong = MeshError::Meshlets;
        for part in parts {
            let (some, list);
            (some, rest) = rest.split_at_checked(part.faces.into()).ok_or(wrong)?;
            (list, listed) = listed.split_at_checked(part.vertices.into()).ok_or(wrong)?;
            if !some.as_flattened().iter().all(|i| list.contains(i)) {
                return Err(wrong);
            }
        }
        if !rest.is_empty() || !listed.is_empty() {
            return Err(wrong);
        }
        let most = vertices.iter().max();
        let end = most.map_or(0, |&most| usize::from(most) + 1);
        Ok(Self {
            faces,
            parts,
            vertices,
            end,
        })
    }

    /// The faces, sorted by parts.
    #[must_use]
    pub const fn faces(&self) -> Faces<'a> {
        Faces::Triangles(self.faces)
    }

    /// The parts, which have all faces between them.
    #[must_use]
    pub const fn parts(&self) -> &'a [Meshlet] {
        self.parts
    }

    /// Vertices of the mesh by number, part by part: each that a face of the part has, once.
    #[must_use]
    pub const fn vertices(&self) -> &'a [u16] {
        self.vertices
    }
}

/// A mesh that is being cut.
struct Cutter<'p, C> {
    positions: &'p [[C; 3]],
    parts: &'p mut [Meshlet],
    vertices: &'p mut [u16],
    parts_made: usize,
    listed: usize,
}

impl<C: Coordinate> Cutter<'_, C> {
    fn corners(&self, face: &[u16; 3]) -> [[i32; 3]; 3] {
        face.map(|i| place_of(self.positions, i.into()))
    }

    /// Where a face lies on an axis.
    fn key(&self, face: &[u16; 3], axis: usize) -> i64 {
        self.corners(face).iter().map(|p| i64::from(p[axis])).sum()
    }

    /// How far faces reach on an axis.
    fn range(&self, faces: &[[u16; 3]], axis: usize) -> i64 {
        let keys = faces.iter().map(|face| self.key(face, axis));
        let (low, high) = (keys.clone().min(), keys.max());
        high.unwrap_or(0) - low.unwrap_or(0)
    }

    /// Parts of some faces.
    fn cut(&mut self, faces: &mut [[u16; 3]]) -> Result<(), CutError> {
        if faces.len() <= MOST_FACES {
            if let Some(listed) = self.list(faces)? {
                return self.keep(faces, listed);
            }
        }
        let axis = (0..3)
            .max_by_key(|&axis| self.range(faces, axis))
            .unwrap_or(0);
        let middle = faces.len() / 2;
        // No two keys are the same, so both halves are known, if not their order.
        faces.select_nth_unstable_by_key(middle, |face| (self.key(face, axis), *face));
        let (some, others) = faces.split_at_mut(middle);
        self.cut(some)?;
        self.cut(others)
    }

    /// Lists the vertices of faces behind those that are listed; how many, unless they are too many for a part.
    fn list(&mut self, faces: &[[u16; 3]]) -> Result<Option<usize>, CutError> {
        let have = self.vertices.len();
        let rest = self.vertices.get_mut(self.listed..).unwrap_or_default();
        let mut count = 0;
        for &i in faces.as_flattened() {
            let (before, free) = rest.split_at_mut(count);
            if before.contains(&i) {
                continue;
            }
            if count == MOST_VERTICES {
                return Ok(None);
            }
            *free.first_mut().ok_or(CutError::Vertices { have })? = i;
            count += 1;
        }
        Ok(Some(count))
    }

    /// A part of faces whose vertices have just been listed.
    fn keep(&mut self, faces: &mut [[u16; 3]], listed: usize) -> Result<(), CutError> {
        if faces.is_empty() {
            return Ok(());
        }
        faces.sort_unstable();
        let have = self.parts.len();
        let points = self.vertices.get_mut(self.listed..self.listed + listed);
        let points = points.unwrap_or_default();
        points.sort_unstable();
        let of = |&i: &u16| place_of(self.positions, i.into());
        let mut part = Meshlet {
            faces: faces.len() as u16,
            vertices: listed as u16,
            sphere: Sphere::of(points.iter().map(of)),
            ..Meshlet::EMPTY
        };
        self.find_cone(faces, &mut part);
        let slot = self.parts.get_mut(self.parts_made);
        *slot.ok_or(CutError::Parts { have })? = part;
        self.parts_made += 1;
        self.listed += listed;
        Ok(())
    }

    /// The cone of a part, from the middle of its sphere back until it lies behind all faces; none where they look
    /// everywhere, or it would begin beyond the space of the model.
    fn find_cone(&self, faces: &[[u16; 3]], part: &mut Meshlet) {
        let normal = |face: &[u16; 3]| face_normal(self.corners(face));
        let mut sum = [0; 3];
        for normal in faces.iter().map(normal) {
            sum = [0, 1, 2].map(|i| sum[i] + i64::from(normal[i]));
        }
        let axis = unit(sum).map(|c| c.to_bits());
        let dot =
            |a: [i64; 3], b: [i16; 3]| (0..3).map(|i| a[i] * i64::from(b[i])).sum::<i64>() >> 14;
        let (mut least, mut back) = (1 << 14, 0);
        for face in faces {
            let normal = normal(face);
            // A face without an area has no normal, and is not seen.
            if normal == [0; 3] {
                continue;
            }
            let along = dot(axis.map(i64::from), normal);
            if along < 1 << 8 {
                return;
            }
            least = along.min(least);
            let [corner, ..] = self.corners(face);
            let way = [0, 1, 2].map(|i| i64::from(part.sphere.centre[i]) - i64::from(corner[i]));
            back = back.max((dot(way, normal) << 14) / along);
        }
        let apex = [0, 1, 2].map(|i| {
            let at = i64::from(part.sphere.centre[i]) - ((back * i64::from(axis[i])) >> 14);
            i32::try_from(at)
        });
        if let [Ok(x), Ok(y), Ok(z)] = apex {
            // Both vectors are rounded.
            let square = (1 << 16) - (((least - 4) * (least - 4)) >> 12) + 1;
            part.apex = [x, y, z];
            part.axis = axis;
            part.spread = square.clamp(0, 0xFFFF) as u16;
        }
    }
}

/// The eye in the space of a model, in units in which all ways from it to the model are below 2^15.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Eye {
    at: [i32; 3],
    down: u32,
}

/// What the roundings of a way to an apex, of its length along an axis, of the eye and of normals are less than.
const SLACK: i32 = 12;

impl Eye {
    /// The eye of a view; `None` where it is too far away, or where the model is stretched or mirrored, so that
    /// normals are not those that are seen.
    pub(crate) fn new(model: &Affine, view: &Affine) -> Option<Self> {
        if !is_similar(model) {
            return None;
        }
        let at = model.then(view).origin_in_model();
        let size = at.exponent.max(1);
        // Whoever is 256 times as far away as a model is large sees little of it.
        (size <= 8).then(|| Self {
            at: [0, 1, 2].map(|i| at.scaled(i, 14 - size) as i32),
            down: 16 + size as u32,
        })
    }

    /// Whether all faces of a part are seen from behind.
    pub(crate) fn is_behind(&self, part: &Meshlet) -> bool {
        let way = [0, 1, 2].map(|i| (part.apex[i] >> self.down) - self.at[i]);
        let dot = |other: [i32; 3]| (0..3).map(|i| way[i] * other[i]).fold(0, i32::wrapping_add);
        let along = (dot(part.axis.map(i32::from)) >> 14) - SLACK;
        if along <= 0 {
            return false;
        }
        let square = dot(way) as u32;
        along.wrapping_mul(along) as u32 >= ((square >> 16) + 1) * u32::from(part.spread)
    }
}

/// Whether a map turns and scales, and does not stretch or mirror: to 2^-14.
fn is_similar(map: &Affine) -> bool {
    let m = map.linear.mantissa.map(|m| m >> 1);
    let row = |i: usize| [m[3 * i], m[3 * i + 1], m[3 * i + 2]];
    let [a, b, c] = [row(0), row(1), row(2)];
    let square = dot(a, a);
    let stretch = [dot(b, b) - square, dot(c, c) - square];
    let skew = [dot(a, b), dot(b, c), dot(c, a)];
    let mut all = stretch.iter().chain(&skew);
    all.all(|value| value.abs() <= square >> 14) && dot(cross(a, b), c) > 0
}
