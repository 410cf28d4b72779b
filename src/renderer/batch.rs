//! From a list's vertices to meshes: faces are gathered until the state changes or the lent
//! memory is full, then drawn as one mesh.
//!
//! Columns of a table that lie in flash in the mesh's own form are used where they lie (positions
//! in 3x16S, normals in 3x16S, colours in 3x8U); others are unpacked once, when the table comes.

//!
//! | file | there |
//! |---|---|
//! | `batch/table.rs` | a table of vertices, and triangles of it |
//! | `batch/vertices.rs` | short vertices: strips, fans, quads, points |
//! | `batch/long.rs` | vertices that were set up beforehand |
//! | `batch/places.rs` | texture places in texels |

mod long;
mod places;
mod table;
mod vertices;

use super::error::DrawError;
use super::instance::Instance;
use super::scene::Scene;
use crate::event::{Event, EventSink, Notice};
use crate::geometry::texturing::{Quality, Skin};
use crate::geometry::{
    Assembled, Coordinate, Faces, Finish, LightingModel, Mesh, QuadSplit, Shading,
};
use crate::list::{Bound, OverlaySlot, OverlaySlots, Place, Slot, Strip, TextureSlot, Words};
use crate::pipeline::{Pipeline, SkinOf};
use long::LongStrip;

/// A coordinate that lists and meshes share: `i16` (Q1.14) or `i32` (Q1.30).
pub trait ListCoordinate: Coordinate + Place {}

impl<C: Coordinate + Place> ListCoordinate for C {}

/// Memory in which a list's vertices are unpacked, lent by the application.
///
/// The first three go together: as many vertices can be unpacked as the shortest of those that a
/// block needs has. 4 are the least; what a list's largest table needs is in its HEAD.
#[derive(Default)]
pub struct ListMemory<'m, C = i16> {
    /// Places, 6 bytes each, or 12.
    pub positions: &'m mut [[C; 3]],
    /// Normals, 6 bytes each.
    pub normals: &'m mut [[i16; 3]],
    /// Colours, 3 bytes each.
    pub colours: &'m mut [[u8; 3]],
    /// Indices of faces that are drawn together, at least 4; 3 a triangle. Each time they are
    /// full, the vertices of a table are transformed once more.
    pub indices: &'m mut [u16],
    /// Texture places, 8 bytes each, as many as positions; none where nothing is textured.
    pub places: &'m mut [[i32; 2]],
    /// Names of textures: one for each number of a texture and of a palette, and one for each
    /// pair of both that is drawn with; none where nothing is textured. The scene's
    /// [`ListTextures`](crate::texture::ListTextures) have the same ones.
    pub textures: &'m [TextureSlot],
    /// One for each overlay of a frame; none where there are none. The
    /// [`ListOverlays`](crate::overlay::ListOverlays) that paint them have the same ones.
    pub overlays: &'m [OverlaySlot],
}

/// Where an attribute of the table is.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Column {
    None,
    InPlace(Slot),
    Unpacked,
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
    prsp: bool,
    /// The sides of the texture for which places were unpacked.
    placed: Option<[u8; 2]>,
    /// Its vertices could be had.
    usable: bool,
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

/// What a batch did, since it was made.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct BatchCounts {
    pub(super) draws: u32,
    pub(super) vertices: u32,
    pub(super) triangles: u32,
    pub(super) dropped: u32,
}

/// Faces on their way into a scene.
pub(super) struct Batch<'m, C> {
    memory: ListMemory<'m, C>,
    kind: Kind,
    table: Option<Table>,
    /// Unpacked vertices of the table; those of runs come behind.
    base: usize,
    /// Unpacked vertices of runs.
    vertices: usize,
    /// Indices in use.
    indices: usize,
    /// The last vertices, from which a strip goes on.
    strip: Strip,
    /// The same, of long vertices.
    long: LongStrip,
    pub(super) counts: BatchCounts,
}

/// Where faces go and who is told.
pub(super) struct Target<'t, 'm, P: Pipeline, E, M> {
    pub(super) scene: &'t mut Scene<'m, P>,
    pub(super) instance: Instance<M>,
    /// The surface's, 255 for 1.
    pub(super) opacity: u8,
    /// The texture, where there is one.
    pub(super) texture: Option<(Bound, Quality)>,
    pub(super) events: &'t mut E,
    pub(super) offset: u32,
}

/// An index that the table does not have.
pub(super) struct BadIndex(pub(super) u16, pub(super) u16);

impl<'m, C: ListCoordinate> Batch<'m, C> {
    pub(super) fn new(memory: ListMemory<'m, C>) -> Self {
        Self {
            memory,
            kind: Kind::Nothing,
            table: None,
            base: 0,
            vertices: 0,
            indices: 0,
            strip: Strip::default(),
            long: LongStrip::default(),
            counts: BatchCounts::default(),
        }
    }

    /// Forgets everything that was gathered and kept.
    pub(super) fn reset(&mut self) {
        (self.kind, self.table) = (Kind::Nothing, None);
        (self.base, self.vertices, self.indices) = (0, 0, 0);
        self.strip.restart();
    }

    /// The names of textures.
    pub(super) fn textures(&self) -> &'m [TextureSlot] {
        self.memory.textures
    }

    /// The overlays.
    pub(super) fn overlays(&self) -> OverlaySlots<'m> {
        OverlaySlots(self.memory.overlays)
    }

    /// Vertices that can be unpacked where these attributes are.
    fn room(&self, has: Attributes) -> usize {
        let m = &self.memory;
        let mut room = m.positions.len().min(1 << 16);
        for (is, len) in [
            (has.normals, m.normals.len()),
            (has.colours, m.colours.len()),
            (has.places, m.places.len()),
        ] {
            room = if is { room.min(len) } else { room };
        }
        room
    }

    /// Draws what was gathered. Vertices from which a strip may go on stay.
    pub(super) fn flush<'w, P: Pipeline, E: EventSink, M: LightingModel>(
        &mut self,
        words: impl Words<'w>,
        target: &mut Target<'_, '_, P, E, M>,
    ) {
        let run = self.base..self.base + self.vertices;
        let kept = self.kept_places::<P>();
        let placed = self.place(words, run.clone(), target);
        let m = &self.memory;
        let indices = m.indices.get(..self.indices).unwrap_or(&[]);
        let places = placed.and_then(|range| m.places.get(range)).unwrap_or(&[]);
        let (mesh, points, prsp) = match self.kind {
            Kind::Nothing => return,
            Kind::Table => {
                let Some(t) = &self.table else { return };
                let n = usize::from(t.count);
                let mesh = Mesh {
                    positions: column(words, t, t.place, m.positions.get(..n)),
                    normals: column(words, t, t.normal, m.normals.get(..n)),
                    colours: column(words, t, t.colour, m.colours.get(..n)),
                    faces: triangles(indices),
                };
                (mesh, None, t.prsp)
            }
            Kind::Run { faces, has } => {
                let (faces, points) = match faces {
                    RunFaces::Triangles => (triangles(indices), None),
                    RunFaces::Quads(split) => {
                        let quads = bytemuck::try_cast_slice(indices).unwrap_or(&[]);
                        (Faces::Quads(quads, split), None)
                    }
                    // Two vertices alone are no quad yet.
                    RunFaces::QuadStrip(_) if indices.len() < 4 => (Faces::Triangles(&[]), None),
                    RunFaces::QuadStrip(split) => (Faces::QuadStrip(indices, split), None),
                    RunFaces::Points(size) => (Faces::Triangles(&[]), Some(size)),
                };
                let normals = m.normals.get(run.clone()).filter(|_| has.normals);
                let colours = m.colours.get(run.clone()).filter(|_| has.colours);
                let mesh = Mesh {
                    positions: m.positions.get(run).unwrap_or(&[]),
                    normals: normals.unwrap_or(&[]),
                    colours: colours.unwrap_or(&[]),
                    faces,
                };
                (mesh, points, has.prsp)
            }
        };
        let skin = target.skin(places, prsp);
        let vertices = mesh.positions.len() as u32;
        let before = target.scene.pass_one().untextured;
        let done = match points {
            Some(size) if vertices > 0 => Some(target.scene.draw_points(
                &mesh,
                size,
                skin,
                &target.instance,
            )),
            None if self.indices > 0 => {
                // Those of a table were checked as they were gathered.
                let below = match (self.kind, &self.table) {
                    (Kind::Table, Some(table)) => usize::from(table.count),
                    _ => usize::MAX,
                };
                let mesh = (&mesh, below);
                Some(target.scene.draw_known(mesh, skin, &target.instance))
            }
            _ => None,
        };
        if let Some(done) = done {
            self.counts.take(vertices, done, target);
            target.tell_untextured(before);
        }
        self.indices = 0;
        if let Kind::Run { has, .. } = self.kind {
            self.keep(has, kept);
        }
    }

    /// Moves the vertices of the strip to the front; places on a texture as they were gathered.
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

impl BatchCounts {
    /// Counts what a call has done with some vertices, and tells what was lost.
    fn take<P: Pipeline, E: EventSink, M: LightingModel>(
        &mut self,
        vertices: u32,
        done: Result<Assembled, DrawError>,
        target: &mut Target<'_, '_, P, E, M>,
    ) {
        self.draws += 1;
        self.vertices += vertices;
        match done {
            Ok(done) => {
                self.triangles += done.triangles;
                if done.clipped > 0 {
                    target.notice(Event::Clipped, done.clipped);
                }
            }
            Err(DrawError::Full(dropped)) => {
                self.dropped += dropped.triangles;
                target.notice(Event::Full, dropped.triangles);
            }
            // Lengths and indices were checked when they were gathered.
            Err(DrawError::Mesh(_)) => target.notice(Event::Malformed, 0),
        }
    }
}

impl<P: Pipeline, E: EventSink, M: LightingModel> Target<'_, '_, P, E, M> {
    /// The texture with these places on it, that are to be exact or not, and how it is composited.
    fn skin<'p>(&self, places: &'p [[i32; 2]], prsp: bool) -> SkinOf<'p, P> {
        let skin = match self.texture {
            Some((bound, quality)) if P::Shading::TEXTURED => Skin {
                places,
                texture: bound.index,
                quality: if prsp { quality } else { Quality::Fast },
            }
            .into(),
            _ => SkinOf::<P>::default(),
        };
        if P::Shading::COMPOSITED && self.opacity != 255 {
            return P::Shading::finished(skin, Finish::filtered(self.opacity));
        }
        skin
    }

    /// Tells of triangles that have no texture since there were so many.
    pub(super) fn tell_untextured(&mut self, before: u32) {
        let more = self.scene.pass_one().untextured - before;
        if more > 0 {
            self.notice(Event::Untextured, more);
        }
    }

    #[cold]
    pub(super) fn notice(&mut self, event: Event, value: u32) {
        self.events.notice(Notice {
            event,
            offset: self.offset,
            value,
        });
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
        Column::Unpacked => unpacked.unwrap_or(&[]),
        Column::InPlace(slot) => slot.in_place(words, table.at, table.count).unwrap_or(&[]),
    }
}

fn triangles(indices: &[u16]) -> Faces<'_> {
    Faces::Triangles(bytemuck::try_cast_slice(indices).unwrap_or(&[]))
}
