//! From a list's vertices to meshes: faces are gathered until the state changes or the lent
//! memory is full, then handed over as one mesh.
//!
//! Columns of a table that lie in flash in the mesh's own form are used where they lie (positions
//! in 3x16S, normals in 3x16S, colours in 3x8U); others are unpacked once, when the table comes.
//!
//! | file | there |
//! |---|---|
//! | `gather/table.rs` | a table of vertices, and triangles of it |
//! | `gather/vertices.rs` | short vertices: strips, fans, quads, points |
//! | `gather/places.rs` | texture places in texels |
//! | `gather/fill.rs` | the loop that strips and fans of indices go through |
//!
//! Nothing here knows a scene: who draws is handed each mesh.

mod fill;
mod places;
mod table;
mod vertices;

use super::long::LongStrip;
use crate::geometry::{Coordinate, Faces, Mesh, QuadSplit};
use crate::list::{Layout, Place, Reason, Run, Slot, Strip, VertexFormat, Words};
use core::ops::Range;
pub(crate) use places::texels;

/// The table in force.
#[derive(Clone, Copy, Debug)]
struct Table {
    run: Run,
    layout: Layout,
    /// The sides of the texture for which places were unpacked.
    placed: Option<[u8; 2]>,
    /// Faces of it were passed over.
    lacks_faces: bool,
}

impl Table {
    /// Whether so few faces are drawn that to look for their vertices, 9 instructions a corner on a Cortex-M4, is cheaper
    /// than to move all, 90 each: of closed meshes half as many vertices have a face as there are faces, else all corners.
    fn is_partly(&self, faces: usize) -> bool {
        let count = usize::from(self.run.header.count);
        4 * faces < count || self.lacks_faces && faces < count
    }
}

/// What is being gathered.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
enum Kind {
    #[default]
    Nothing,
    /// Triangles of the table.
    Table,
    /// Triangles, quads, a quad strip or points of unpacked vertices with these attributes.
    Run { faces: RunFaces, has: Attributes },
}

/// What vertices have beside their places in space.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Attributes {
    normals: bool,
    colours: bool,
    alphas: bool,
    /// Places on a texture.
    places: bool,
    /// They are to be exact.
    prsp: bool,
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RunFaces {
    Triangles,
    Quads(QuadSplit),
    QuadStrip(QuadSplit),
    /// Of so many pixels each way.
    Points(u8),
}

/// A mesh that was gathered.
pub(crate) struct Gathered<'a, C> {
    pub(crate) mesh: Mesh<'a, C>,
    /// The places of its vertices on the texture that is drawn with, in texels with 8 fraction bits, if there are any; why
    /// there are none where they are lacking.
    pub(crate) places: Result<Option<&'a [[i32; 2]]>, Reason>,
    /// The alphas of its vertices, if there are any.
    pub(crate) alphas: &'a [u8],
    /// Whether they are to be exact.
    pub(crate) prsp: bool,
    /// Its vertices are points of so many pixels each way, and it has no faces.
    pub(crate) points: Option<u8>,
    /// Byte offset of the block of its first face.
    pub(crate) block: u32,
    /// Many of its vertices have no face.
    pub(crate) partly: bool,
}

/// Where meshes go, and where what they are made of comes from.
pub(crate) struct Out<'o, C, W> {
    pub(crate) words: W,
    pub(crate) format: &'o VertexFormat,
    /// Whether anything is ever textured: places are kept then.
    pub(crate) textured: bool,
    /// Binary logarithms of the sides of the texture that is drawn with.
    pub(crate) sides: Option<[u8; 2]>,
    /// Pixels each way that a point has.
    pub(crate) point_size: u8,
    /// Byte offset of the block that is taken.
    pub(crate) block: u32,
    /// Who draws them.
    pub(crate) draw: &'o mut dyn FnMut(&Gathered<'_, C>),
}

/// Faces on their way into a scene, and memory in which their vertices are unpacked.
#[derive(Default)]
pub(crate) struct Gather<'m, C> {
    pub(crate) positions: &'m mut [[C; 3]],
    pub(crate) normals: &'m mut [[i16; 3]],
    pub(crate) colours: &'m mut [[u8; 3]],
    pub(crate) indices: &'m mut [u16],
    pub(crate) places: &'m mut [[i32; 2]],
    /// None where alphas are passed over.
    pub(crate) alphas: &'m mut [u8],
    kind: Kind,
    table: Option<Table>,
    /// Unpacked vertices of the table; those of runs come behind.
    base: usize,
    /// Unpacked vertices of runs.
    vertices: usize,
    /// Indices in use.
    used: usize,
    /// Byte offset of the block of the first of them.
    block: u32,
    /// The last vertices, from which a strip goes on.
    strip: Strip,
    /// The same of vertices that were set up beforehand.
    pub(crate) long: LongStrip,
}

impl<C: Coordinate + Place> Gather<'_, C> {
    /// Forgets everything that was gathered and kept.
    pub(crate) fn reset(&mut self) {
        (self.kind, self.table) = (Kind::Nothing, None);
        (self.base, self.vertices, self.used) = (0, 0, 0);
        self.strip.restart();
    }

    /// Vertices of another kind come, which are not gathered here; what was gathered was handed over.
    pub(crate) fn pause(&mut self) {
        self.kind = Kind::Nothing;
        self.strip.restart();
    }

    /// Faces of the table in force are passed over.
    pub(crate) fn lacks_faces(&mut self) {
        if let Some(table) = &mut self.table {
            table.lacks_faces = true;
        }
    }

    /// Faces of a block at an offset follow.
    fn begin(&mut self, block: u32) {
        if self.used == 0 {
            self.block = block;
        }
    }

    /// The alphas of vertices, where they have some and they are not passed over.
    fn alpha(&self, layout: &Layout) -> Option<Slot> {
        let has_alpha = |slot: &Slot| slot.has_alpha() && !self.alphas.is_empty();
        layout.colour.filter(has_alpha)
    }

    /// Vertices that can be unpacked where these attributes are.
    fn room(&self, has: Attributes) -> usize {
        let lengths = [
            (true, self.positions.len().min(1 << 16)),
            (has.normals, self.normals.len()),
            (has.colours, self.colours.len()),
            (has.alphas, self.alphas.len()),
            (has.places && !self.places.is_empty(), self.places.len()),
        ];
        let asked = lengths.iter().filter(|(is_asked, _)| *is_asked);
        asked.map(|(_, len)| *len).min().unwrap_or(0)
    }

    /// Hands over what was gathered. Vertices from which a strip may go on stay.
    pub(crate) fn flush<'w>(&mut self, out: &mut Out<'_, C, impl Words<'w>>) {
        if self.kind == Kind::Nothing {
            return;
        }
        let run = self.base..self.base + self.vertices;
        let kept = corners(self.places, self.base, self.strip);
        let placed = self.place(run.clone(), out);
        if let Some(gathered) = self.gathered(out.words, run, placed) {
            (out.draw)(&gathered);
        }
        (self.used, self.block) = (0, out.block);
        if self.kind != Kind::Table {
            self.keep(kept);
        }
    }

    /// The mesh; `None` where it has nothing that is drawn.
    #[inline(never)]
    fn gathered<'s, 'w: 's>(
        &'s self,
        words: impl Words<'w>,
        run: Range<usize>,
        placed: Result<Option<Range<usize>>, Reason>,
    ) -> Option<Gathered<'s, C>> {
        let indices = self.indices.get(..self.used).unwrap_or(&[]);
        let (mut points, mut partly) = (None, false);
        let (mesh, alphas, prsp) = match self.kind {
            Kind::Nothing => return None,
            Kind::Table => {
                let t = self.table.as_ref()?;
                let n = usize::from(t.run.header.count);
                partly = t.is_partly(self.used / 3);
                let (place, normal, colour) = (t.layout.place, t.layout.normal, t.layout.colour);
                let mesh = Mesh {
                    positions: column(words, t.run, Some(place), self.positions.get(..n)),
                    normals: column(words, t.run, normal, self.normals.get(..n)),
                    colours: column(words, t.run, colour, self.colours.get(..n)),
                    faces: triangles(indices),
                };
                let alphas = self.alpha(&t.layout).and_then(|_| self.alphas.get(..n));
                (mesh, alphas, t.run.header.prsp)
            }
            Kind::Run { faces, has } => {
                let normals = self.normals.get(run.clone()).filter(|_| has.normals);
                let colours = self.colours.get(run.clone()).filter(|_| has.colours);
                let alphas = self.alphas.get(run.clone()).filter(|_| has.alphas);
                if let RunFaces::Points(size) = faces {
                    points = Some(size);
                }
                let mesh = Mesh {
                    positions: self.positions.get(run).unwrap_or(&[]),
                    normals: normals.unwrap_or(&[]),
                    colours: colours.unwrap_or(&[]),
                    faces: faces.of(indices),
                };
                (mesh, alphas, has.prsp)
            }
        };
        let drawn = match points {
            Some(_) => !mesh.positions.is_empty(),
            None => self.used > 0,
        };
        drawn.then(|| Gathered {
            mesh,
            places: placed.map(|range| self.places.get(range?)),
            alphas: alphas.unwrap_or(&[]),
            prsp,
            points,
            block: self.block,
            partly,
        })
    }

    /// Moves the vertices of the strip to the front; places on a texture as they were gathered.
    #[inline(never)]
    fn keep(&mut self, places: Kept<[i32; 2]>) {
        let (base, strip) = (self.base, self.strip);
        put(self.positions, base, corners(self.positions, base, strip));
        put(self.normals, base, corners(self.normals, base, strip));
        put(self.colours, base, corners(self.colours, base, strip));
        put(self.alphas, base, corners(self.alphas, base, strip));
        put(self.places, base, places);
        self.strip.corners = [0, 1, 2];
        self.vertices = strip.have.into();
        // Behind those a strip of quads goes on with a split that is chosen by its parity.
        self.kind = Kind::Nothing;
    }

    /// Appends indices, for which there is room.
    #[inline(always)]
    fn push(&mut self, indices: &[u16]) {
        let used = self.used;
        if let Some(slot) = self.indices.get_mut(used..used + indices.len()) {
            slot.copy_from_slice(indices);
            self.used = used + indices.len();
        }
    }
}

/// What the vertices of a strip have of something.
type Kept<T> = [Option<T>; 3];

/// What the vertices of a strip have, whose indices count from `base`.
fn corners<T: Copy>(slice: &[T], base: usize, strip: Strip) -> Kept<T> {
    let mut have = 0..strip.have;
    strip.corners.map(|corner| {
        have.next()?;
        slice.get(base + usize::from(corner)).copied()
    })
}

/// Puts that at `base`.
fn put<T>(slice: &mut [T], base: usize, kept: Kept<T>) {
    let slots = slice.get_mut(base..).unwrap_or_default();
    for (slot, value) in slots.iter_mut().zip(kept.into_iter().flatten()) {
        *slot = value;
    }
}

impl RunFaces {
    /// Faces of these indices.
    fn of(self, indices: &[u16]) -> Faces<'_> {
        match self {
            Self::Triangles => triangles(indices),
            Self::Quads(split) => {
                let quads = bytemuck::try_cast_slice(indices).unwrap_or(&[]);
                Faces::Quads(quads, split)
            }
            // Two vertices alone are no quad yet.
            Self::QuadStrip(split) if indices.len() >= 4 => Faces::QuadStrip(indices, split),
            Self::QuadStrip(_) | Self::Points(_) => Faces::Triangles(&[]),
        }
    }
}

/// An attribute of the table: where it lies in a mesh's own form, or else as it was unpacked.
fn column<'s, 'w: 's, T: bytemuck::Pod>(
    words: impl Words<'w>,
    table: Run,
    slot: Option<Slot>,
    unpacked: Option<&'s [[T; 3]]>,
) -> &'s [[T; 3]]
where
    [T; 3]: bytemuck::Pod,
{
    let found = |slot: Slot| {
        slot.in_place(words, table.at, table.header.count)
            .or(unpacked)
    };
    slot.and_then(found).unwrap_or(&[])
}

fn triangles(indices: &[u16]) -> Faces<'_> {
    Faces::Triangles(bytemuck::try_cast_slice(indices).unwrap_or(&[]))
}
