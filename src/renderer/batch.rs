//! From a list's vertices to meshes: faces are gathered until the state changes or the lent
//! memory is full, then drawn as one mesh.
//!
//! Columns of a table that lie in flash in the mesh's own form are used where they lie (positions
//! in 3x16S, normals in 3x16S, colours in 3x8U); others are unpacked once, when the table comes.

use super::fill::{Filled, fill, fill_one};
use super::scene::{DrawError, Instance, Scene};
use crate::event::{Event, EventSink, Notice};
use crate::geometry::{Coordinate, Faces, Mesh, QuadSplit};
use crate::list::{
    FieldForm, Layout, Place, Run, SEPARATE, SPLIT, Slot, Strip, VertexFormat, WIDE, Words, colour,
    normal,
};
use crate::pipeline::Pipeline;

/// A coordinate that lists and meshes share: `i16` (Q1.14) or `i32` (Q1.30).
pub trait ListCoordinate: Coordinate + Place {}

impl<C: Coordinate + Place> ListCoordinate for C {}

/// Memory in which a list's vertices are unpacked, lent by the application.
///
/// The first three go together: as many vertices can be unpacked as the shortest of those that a
/// block needs has. 4 are the least; what a list's largest table needs is in its HEAD.
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
    /// Its vertices could be had.
    usable: bool,
}

/// What is being gathered.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Kind {
    Nothing,
    /// Triangles of the table.
    Table,
    /// Triangles, quads or a quad strip of unpacked vertices with these attributes.
    Run {
        faces: RunFaces,
        normals: bool,
        colours: bool,
    },
}

#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum RunFaces {
    Triangles,
    Quads(QuadSplit),
    QuadStrip(QuadSplit),
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
    pub(super) counts: BatchCounts,
}

/// Where faces go and who is told.
pub(super) struct Target<'t, 'm, P: Pipeline, E> {
    pub(super) scene: &'t mut Scene<'m, P>,
    pub(super) instance: &'t Instance,
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
            counts: BatchCounts::default(),
        }
    }

    /// Forgets everything that was gathered and kept.
    pub(super) fn reset(&mut self) {
        (self.kind, self.table) = (Kind::Nothing, None);
        (self.base, self.vertices, self.indices) = (0, 0, 0);
        self.strip.restart();
    }

    /// Vertices that can be unpacked where these attributes are.
    fn room(&self, normals: bool, colours: bool) -> usize {
        let mut room = self.memory.positions.len().min(1 << 16);
        if normals {
            room = room.min(self.memory.normals.len());
        }
        if colours {
            room = room.min(self.memory.colours.len());
        }
        room
    }

    /// Draws what was gathered. Vertices from which a strip may go on stay.
    pub(super) fn flush<'w, P: Pipeline, E: EventSink>(
        &mut self,
        words: impl Words<'w>,
        target: &mut Target<'_, '_, P, E>,
    ) {
        let m = &self.memory;
        let indices = m.indices.get(..self.indices).unwrap_or(&[]);
        let run = self.base..self.base + self.vertices;
        let (mesh, kept) = match self.kind {
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
                (mesh, None)
            }
            Kind::Run {
                faces,
                normals,
                colours,
            } => {
                let faces = match faces {
                    RunFaces::Triangles => triangles(indices),
                    RunFaces::Quads(split) => {
                        Faces::Quads(bytemuck::try_cast_slice(indices).unwrap_or(&[]), split)
                    }
                    // Two vertices alone are no quad yet.
                    RunFaces::QuadStrip(_) if indices.len() < 4 => Faces::Triangles(&[]),
                    RunFaces::QuadStrip(split) => Faces::QuadStrip(indices, split),
                };
                let mesh = Mesh {
                    positions: m.positions.get(run.clone()).unwrap_or(&[]),
                    normals: m
                        .normals
                        .get(run.clone())
                        .filter(|_| normals)
                        .unwrap_or(&[]),
                    colours: m.colours.get(run).filter(|_| colours).unwrap_or(&[]),
                    faces,
                };
                (mesh, Some((normals, colours)))
            }
        };
        if self.indices > 0 {
            self.counts.draws += 1;
            self.counts.vertices += mesh.positions.len() as u32;
            match target.scene.draw(&mesh, target.instance) {
                Ok(done) => {
                    self.counts.triangles += done.triangles;
                    if done.clipped > 0 {
                        target.notice(Event::Clipped, done.clipped);
                    }
                }
                Err(DrawError::Full(dropped)) => {
                    self.counts.dropped += dropped.triangles;
                    target.notice(Event::Full, dropped.triangles);
                }
                // Lengths and indices were checked when they were gathered.
                Err(DrawError::Mesh(_)) => target.notice(Event::Malformed, 0),
            }
        }
        self.indices = 0;
        if let Some((normals, colours)) = kept {
            self.keep(normals, colours);
        }
    }

    /// Moves the vertices of the strip to the front.
    fn keep(&mut self, normals: bool, colours: bool) {
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
        if normals {
            moved(self.memory.normals, self.base, from, have);
        }
        if colours {
            moved(self.memory.colours, self.base, from, have);
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

    /// Takes a table: columns that cannot be used where they lie are unpacked. `false`: there is
    /// no room, or the coordinates are too fine for `C`.
    pub(super) fn table<'w, P: Pipeline, E: EventSink>(
        &mut self,
        words: impl Words<'w>,
        format: &VertexFormat,
        run: Run,
        target: &mut Target<'_, '_, P, E>,
    ) -> Result<(), Event> {
        self.flush(words, target);
        self.reset();
        let layout = Layout::new(format, run.header);
        let (at, count) = (run.at, run.header.count);
        let mut table = Table {
            at,
            count,
            place: Column::Unpacked,
            normal: layout.normal.map_or(Column::None, |_| Column::Unpacked),
            colour: layout.colour.map_or(Column::None, |_| Column::Unpacked),
            usable: true,
        };
        let place = layout.place;
        if place.form == C::IN_PLACE && place.in_place::<C>(words, at, count).is_some() {
            table.place = Column::InPlace(place);
        }
        if let Some(slot) = layout.normal.filter(|s| s.form == FieldForm::S16x3)
            && slot.in_place::<i16>(words, at, count).is_some()
        {
            table.normal = Column::InPlace(slot);
        }
        if let Some(slot) = layout.colour.filter(|s| s.form == FieldForm::U8x3)
            && slot.in_place::<u8>(words, at, count).is_some()
        {
            table.colour = Column::InPlace(slot);
        }
        let n = usize::from(count);
        let m = &mut self.memory;
        let short = |c: Column, len: usize| c == Column::Unpacked && len < n;
        if short(table.place, m.positions.len())
            || short(table.normal, m.normals.len())
            || short(table.colour, m.colours.len())
        {
            table.usable = false;
            self.table = Some(table);
            return Err(Event::Full);
        }
        let fine = C::of(place.form, [0; 3]).is_none();
        if let (Column::Unpacked, Some(out)) = (table.place, m.positions.get_mut(..n)) {
            self.base = n;
            // One that is too fine is not used.
            place.column(words, at, out, |f| C::of(place.form, f).unwrap_or_default());
        }
        if let (Column::Unpacked, Some(slot), Some(out)) =
            (table.normal, layout.normal, m.normals.get_mut(..n))
        {
            self.base = n;
            match slot.form {
                FieldForm::S8x3 => slot.column(words, at, out, |f| normal(FieldForm::S8x3, f)),
                FieldForm::S10x3 => slot.column(words, at, out, |f| normal(FieldForm::S10x3, f)),
                form => slot.column(words, at, out, |f| normal(form, f)),
            }
        }
        if let (Column::Unpacked, Some(slot), Some(out)) =
            (table.colour, layout.colour, m.colours.get_mut(..n))
        {
            self.base = n;
            slot.column(words, at, out, colour);
        }
        table.usable = !fine;
        self.table = Some(table);
        if fine {
            Err(Event::Unimplemented)
        } else {
            Ok(())
        }
    }

    /// Takes triangles of the table.
    pub(super) fn indexed<'w, P: Pipeline, E: EventSink>(
        &mut self,
        words: impl Words<'w>,
        run: Run,
        target: &mut Target<'_, '_, P, E>,
    ) -> Result<(), BadIndex> {
        let Some(table) = self.table.filter(|t| t.usable) else {
            target.notice(Event::Full, u32::from(run.header.count));
            return Ok(());
        };
        if self.kind != Kind::Table {
            self.flush(words, target);
            self.kind = Kind::Table;
            self.strip.restart();
        }
        if run.header.new {
            self.strip.restart();
        }
        let count = usize::from(run.header.count);
        let wide = run.header.low & WIDE != 0;
        let len = count.div_ceil(if wide { 2 } else { 4 });
        let slice = words.slice(run.at, len as u32);
        let in_place = slice.filter(|_| cfg!(target_endian = "little"));
        match (in_place, wide) {
            (Some(slice), false) => {
                let bytes: &[u8] = bytemuck::cast_slice(slice);
                let bytes = bytes.get(..count).unwrap_or(&[]);
                let indices = bytes.iter().map(|i| u16::from(*i));
                self.faces(words, table.count, run, 0xFF, indices, target)
            }
            (Some(slice), true) => {
                let halves: &[u16] = bytemuck::cast_slice(slice);
                let indices = halves.get(..count).unwrap_or(&[]).iter().copied();
                self.faces(words, table.count, run, 0xFFFF, indices, target)
            }
            (None, _) => {
                let (each, bits, restart) = if wide { (2, 16, 0xFFFF) } else { (4, 8, 0xFF) };
                let indices = (0..count as u32).map(|n| {
                    let word = words.word(run.at.wrapping_add(n / each));
                    (word >> (bits * (n % each))) as u16 & restart
                });
                self.faces(words, table.count, run, restart, indices, target)
            }
        }
    }

    /// Strips and fans each in a loop of their own: what is asked once a block is not asked once
    /// an index.
    #[inline]
    fn faces<'w, P: Pipeline, E: EventSink>(
        &mut self,
        words: impl Words<'w>,
        count: u16,
        run: Run,
        restart: u16,
        indices: impl Iterator<Item = u16>,
        target: &mut Target<'_, '_, P, E>,
    ) -> Result<(), BadIndex> {
        if run.header.rm {
            self.faces_as::<P, E, true>(words, count, run, restart, indices, target)
        } else {
            self.faces_as::<P, E, false>(words, count, run, restart, indices, target)
        }
    }

    #[inline]
    fn faces_as<'w, P: Pipeline, E: EventSink, const FAN: bool>(
        &mut self,
        words: impl Words<'w>,
        count: u16,
        run: Run,
        restart: u16,
        indices: impl Iterator<Item = u16>,
        target: &mut Target<'_, '_, P, E>,
    ) -> Result<(), BadIndex> {
        let separate = run.header.low & SEPARATE != 0;
        let mut indices = indices;
        let mut used = self.indices;
        let mut result = Ok(());
        'all: while let Some(index) = indices.next() {
            if index >= count {
                if index == restart && !separate {
                    self.strip.restart();
                    continue;
                }
                result = Err(BadIndex(index, count));
                break;
            }
            let Some(mut face) = self.strip.push(index, FAN) else {
                continue;
            };
            if separate {
                self.strip.restart();
            }
            let mut odd = self.strip.odd;
            loop {
                let out = self.memory.indices.get_mut(used..).unwrap_or(&mut []);
                let (faces, end) = if separate {
                    fill_one(out, face)
                } else {
                    fill::<FAN>(&mut indices, out, count, &mut face, &mut odd)
                };
                used += 3 * faces;
                match end {
                    Filled::Full => {
                        self.indices = used;
                        self.flush(words, target);
                        used = 0;
                        if self.memory.indices.len() < 3 {
                            target.notice(Event::Full, 1);
                            break 'all;
                        }
                    }
                    Filled::One => break,
                    Filled::Until(other) => {
                        let [p, q, newest] = face;
                        self.strip.corners = if odd { [q, p, newest] } else { face };
                        self.strip.odd = odd;
                        match other {
                            None => break 'all,
                            Some(index) if index == restart => {
                                self.strip.restart();
                                break;
                            }
                            Some(index) => {
                                result = Err(BadIndex(index, count));
                                break 'all;
                            }
                        }
                    }
                }
            }
        }
        self.indices = used;
        result
    }

    /// Takes short vertices: a strip, a fan, quads or a quad strip.
    pub(super) fn run<'w, P: Pipeline, E: EventSink>(
        &mut self,
        words: impl Words<'w>,
        format: &VertexFormat,
        run: Run,
        quads: bool,
        target: &mut Target<'_, '_, P, E>,
    ) -> Result<(), Event> {
        let header = run.header;
        let layout = Layout::new(format, header);
        if C::of(layout.place.form, [0; 3]).is_none() {
            return Err(Event::Unimplemented);
        }
        let (normals, colours) = (layout.normal.is_some(), layout.colour.is_some());
        let room = self.room(normals, colours).saturating_sub(self.base);
        if room < 4 || self.memory.indices.len() < 4 {
            return Err(Event::Full);
        }
        let strip = !quads || header.rm;
        if !strip || header.new {
            self.strip.restart();
        }
        let split = match header.low & SPLIT != 0 {
            false => QuadSplit::Corner0To2,
            true => QuadSplit::Corner1To3,
        };
        let faces = |odd: bool| match (quads, header.rm) {
            (false, _) => RunFaces::Triangles,
            (true, false) => RunFaces::Quads(split),
            (true, true) if odd => RunFaces::QuadStrip(split.other()),
            (true, true) => RunFaces::QuadStrip(split),
        };
        let kind = |odd| Kind::Run {
            faces: faces(odd),
            normals,
            colours,
        };
        let one_strip = quads && header.rm;
        if self.kind != kind(self.strip.odd) || (one_strip && header.new) {
            self.flush(words, target);
            self.kind = kind(self.strip.odd);
            if self.strip.have == 0 {
                self.vertices = 0;
            }
        }
        let group = if quads && !header.rm { 4 } else { 2 };
        let mut at = run.at;
        for n in 0..usize::from(header.count) {
            // A quad is never parted, nor the two vertices that a strip of them takes.
            let parts = if quads { n % group == 0 } else { true };
            let vertices = if quads { group } else { 1 };
            let indices = if quads { group } else { 3 };
            if parts
                && (self.vertices + vertices > room
                    || self.indices + indices > self.memory.indices.len())
            {
                self.flush(words, target);
                self.kind = kind(self.strip.odd);
            }
            if one_strip && self.indices == 0 && self.strip.have == 2 {
                self.push(&[0, 1]);
            }
            let index = self.vertices;
            let to = self.base + index;
            let place = C::of(layout.place.form, layout.place.field(words, at));
            if let (Some(place), Some(slot)) = (place, self.memory.positions.get_mut(to)) {
                *slot = place;
            }
            if let (Some(from), Some(slot)) = (layout.normal, self.memory.normals.get_mut(to)) {
                *slot = normal(from.form, from.field(words, at));
            }
            if let (Some(from), Some(slot)) = (layout.colour, self.memory.colours.get_mut(to)) {
                *slot = colour(from.field(words, at));
            }
            at = at.wrapping_add(layout.words);
            self.vertices += 1;
            let index = index as u16;
            match (quads, header.rm) {
                (false, fan) => {
                    if let Some(face) = self.strip.push(index, fan) {
                        self.push(&face);
                    }
                }
                (true, false) => self.push(&[index]),
                (true, true) => {
                    self.push(&[index]);
                    let strip = &mut self.strip;
                    if strip.have < 2 {
                        strip.corners[usize::from(strip.have)] = index;
                        strip.have += 1;
                    } else {
                        strip.corners = [strip.corners[1], index, 0];
                        // A quad is whole after each second vertex.
                        strip.odd ^= n % 2 == 1;
                    }
                }
            }
        }
        Ok(())
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

impl<P: Pipeline, E: EventSink> Target<'_, '_, P, E> {
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
