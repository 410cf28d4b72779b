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

use crate::geometry::{Coordinate, Faces, Mesh, QuadSplit};
use crate::list::{Place, Reason, Slot, Strip, Words};
use core::ops::Range;
pub(crate) use places::texels;

/// Memory in which vertices are unpacked.
pub(crate) struct Unpacked<'m, C> {
    pub(crate) positions: &'m mut [[C; 3]],
    pub(crate) normals: &'m mut [[i16; 3]],
    pub(crate) colours: &'m mut [[u8; 3]],
    pub(crate) indices: &'m mut [u16],
    pub(crate) places: &'m mut [[i32; 2]],
    /// None where alphas are passed over.
    pub(crate) alphas: &'m mut [u8],
}

/// Where an attribute of the table is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    None,
    InPlace(Slot),
    Unpacked(Slot),
}

/// The table in force.
#[derive(Clone, Copy, Debug)]
struct Table {
    at: u32,
    count: u16,
    place: Column,
    normal: Column,
    colour: Column,
    texture: Option<Slot>,
    /// Whether alphas were unpacked.
    alphas: bool,
    prsp: bool,
    /// The sides of the texture for which places were unpacked.
    placed: Option<[u8; 2]>,
    /// Its vertices could be had.
    usable: bool,
    /// Faces of it were passed over.
    lacks_faces: bool,
}

impl Table {
    /// Whether so few faces are drawn that to look for their vertices, 9 instructions a corner on a Cortex-M4, is cheaper
    /// than to move all, 90 each: of closed meshes half as many vertices have a face as there are faces, else all corners.
    fn is_partly(&self, faces: usize) -> bool {
        let count = usize::from(self.count);
        4 * faces < count || self.lacks_faces && faces < count
    }
}

/// What is being gathered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Nothing,
    /// Triangles of the table.
    Table,
    /// Triangles, quads, a quad strip or points of unpacked vertices with these attributes.
    Run {
        faces: RunFaces,
        has: Attributes,
    },
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

/// Where meshes go.
pub(crate) struct Out<'o, C> {
    /// Whether anything is ever textured: places are kept then.
    pub(crate) textured: bool,
    /// Binary logarithms of the sides of the texture that is drawn with.
    pub(crate) sides: Option<[u8; 2]>,
    /// Byte offset of the block that is taken.
    pub(crate) block: u32,
    /// Who draws them.
    pub(crate) draw: &'o mut dyn FnMut(&Gathered<'_, C>),
}

/// Faces on their way into a scene.
pub(crate) struct Gather<'m, C> {
    memory: Unpacked<'m, C>,
    kind: Kind,
    table: Option<Table>,
    /// Unpacked vertices of the table; those of runs come behind.
    base: usize,
    /// Unpacked vertices of runs.
    vertices: usize,
    /// Indices in use.
    indices: usize,
    /// Byte offset of the block of the first of them.
    block: u32,
    /// The last vertices, from which a strip goes on.
    strip: Strip,
}

impl<'m, C: Coordinate + Place> Gather<'m, C> {
    pub(crate) fn new(memory: Unpacked<'m, C>) -> Self {
        Self {
            memory,
            kind: Kind::Nothing,
            table: None,
            base: 0,
            vertices: 0,
            indices: 0,
            block: 0,
            strip: Strip::default(),
        }
    }

    /// Forgets everything that was gathered and kept.
    pub(crate) fn reset(&mut self) {
        (self.kind, self.table) = (Kind::Nothing, None);
        (self.base, self.vertices, self.indices) = (0, 0, 0);
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

    /// Faces of a block follow.
    fn begin(&mut self, out: &Out<'_, C>) {
        if self.indices == 0 {
            self.block = out.block;
        }
    }

    /// Vertices that can be unpacked where these attributes are.
    fn room(&self, has: Attributes) -> usize {
        let m = &self.memory;
        let mut room = m.positions.len().min(1 << 16);
        for (is, len) in [
            (has.normals, m.normals.len()),
            (has.colours, m.colours.len()),
            (has.alphas, m.alphas.len()),
            (has.places && !m.places.is_empty(), m.places.len()),
        ] {
            room = if is { room.min(len) } else { room };
        }
        room
    }

    /// Hands over what was gathered. Vertices from which a strip may go on stay.
    pub(crate) fn flush<'w>(&mut self, words: impl Words<'w>, out: &mut Out<'_, C>) {
        if self.kind == Kind::Nothing {
            return;
        }
        let run = self.base..self.base + self.vertices;
        let kept = self.kept_places();
        let placed = self.place(words, run.clone(), out.sides);
        if let Some(gathered) = self.gathered(words, run, placed) {
            (out.draw)(&gathered);
        }
        (self.indices, self.block) = (0, out.block);
        if let Kind::Run { has, .. } = self.kind {
            self.keep(has, kept);
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
        let m = &self.memory;
        let indices = m.indices.get(..self.indices).unwrap_or(&[]);
        let (mut points, mut partly) = (None, false);
        let (mesh, alphas, prsp) = match self.kind {
            Kind::Nothing => return None,
            Kind::Table => {
                let t = self.table.as_ref()?;
                let n = usize::from(t.count);
                partly = t.is_partly(self.indices / 3);
                let mesh = Mesh {
                    positions: column(words, t, t.place, m.positions.get(..n)),
                    normals: column(words, t, t.normal, m.normals.get(..n)),
                    colours: column(words, t, t.colour, m.colours.get(..n)),
                    faces: triangles(indices),
                };
                (mesh, m.alphas.get(..n).filter(|_| t.alphas), t.prsp)
            }
            Kind::Run { faces, has } => {
                let normals = m.normals.get(run.clone()).filter(|_| has.normals);
                let colours = m.colours.get(run.clone()).filter(|_| has.colours);
                let alphas = m.alphas.get(run.clone()).filter(|_| has.alphas);
                if let RunFaces::Points(size) = faces {
                    points = Some(size);
                }
                let mesh = Mesh {
                    positions: m.positions.get(run).unwrap_or(&[]),
                    normals: normals.unwrap_or(&[]),
                    colours: colours.unwrap_or(&[]),
                    faces: faces.of(indices),
                };
                (mesh, alphas, has.prsp)
            }
        };
        let drawn = match points {
            Some(_) => !mesh.positions.is_empty(),
            None => self.indices > 0,
        };
        drawn.then(|| Gathered {
            mesh,
            places: placed.map(|range| m.places.get(range?)),
            alphas: alphas.unwrap_or(&[]),
            prsp,
            points,
            block: self.block,
            partly,
        })
    }

    /// Moves the vertices of the strip to the front; places on a texture as they were gathered.
    #[inline(never)]
    fn keep(&mut self, has: Attributes, places: [[i32; 2]; 3]) {
        fn moved<T: Copy>(slice: &mut [T], base: usize, from: [u16; 3], have: usize) {
            let mut kept = [None; 3];
            for (slot, i) in kept.iter_mut().zip(from).take(have) {
                *slot = slice.get(base + usize::from(i)).copied();
            }
            for (n, value) in kept.into_iter().enumerate() {
                if let (Some(value), Some(slot)) = (value, slice.get_mut(base + n)) {
                    *slot = value;
                }
            }
        }
        let (from, have) = (self.strip.corners, usize::from(self.strip.have));
        moved(self.memory.positions, self.base, from, have);
        if has.normals {
            moved(self.memory.normals, self.base, from, have);
        }
        if has.colours {
            moved(self.memory.colours, self.base, from, have);
        }
        if has.alphas {
            moved(self.memory.alphas, self.base, from, have);
        }
        if has.places {
            let slots = self.memory.places.get_mut(self.base..).unwrap_or(&mut []);
            for (slot, place) in slots.iter_mut().zip(places).take(have) {
                *slot = place;
            }
        }
        self.strip.corners = [0, 1, 2];
        self.vertices = have;
        if let Kind::Run {
            faces: RunFaces::QuadStrip(_),
            ..
        } = self.kind
        {
            // Behind the kept two the strip goes on; its split is chosen by its parity.
            self.kind = Kind::Nothing;
        }
    }

    /// Appends indices, for which there is room.
    #[inline(always)]
    fn push(&mut self, indices: &[u16]) {
        let used = self.indices;
        if let Some(slot) = self.memory.indices.get_mut(used..used + indices.len()) {
            slot.copy_from_slice(indices);
            self.indices = used + indices.len();
        }
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

/// An attribute of the table.
fn column<'s, 'w: 's, T: bytemuck::Pod>(
    words: impl Words<'w>,
    table: &Table,
    column: Column,
    unpacked: Option<&'s [[T; 3]]>,
) -> &'s [[T; 3]]
where
    [T; 3]: bytemuck::Pod,
{
    match column {
        Column::None => &[],
        Column::Unpacked(_) => unpacked.unwrap_or(&[]),
        Column::InPlace(slot) => slot.in_place(words, table.at, table.count).unwrap_or(&[]),
    }
}

fn triangles(indices: &[u16]) -> Faces<'_> {
    Faces::Triangles(bytemuck::try_cast_slice(indices).unwrap_or(&[]))
}
