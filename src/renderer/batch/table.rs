//! A table of vertices, and triangles of it by index.

use super::super::fill::{Filled, fill, fill_one};
use super::{BadIndex, Batch, Column, Kind, ListCoordinate, Table, Target};
use crate::event::{Event, EventSink};
use crate::geometry::{LightingModel, Shading};
use crate::list::{FieldForm, Layout, Run, SEPARATE, VertexFormat, WIDE, Words, colour, normal};
use crate::pipeline::Pipeline;

impl<C: ListCoordinate> Batch<'_, C> {
    /// Takes a table: columns that cannot be used where they lie are unpacked. `false`: there is
    /// no room, or the coordinates are too fine for `C`.
    pub(in super::super) fn table<'w, P: Pipeline, E: EventSink, M: LightingModel>(
        &mut self,
        words: impl Words<'w>,
        format: &VertexFormat,
        run: Run,
        target: &mut Target<'_, '_, P, E, M>,
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
            texture: layout.texture,
            prsp: run.header.prsp,
            placed: None,
            usable: true,
        };
        let place = layout.place;
        if place.form == C::IN_PLACE && place.in_place::<C>(words, at, count).is_some() {
            table.place = Column::InPlace(place);
        }
        let normals = layout.normal.filter(|s| s.form == FieldForm::S16x3);
        if let Some(slot) = normals.filter(|s| s.in_place::<i16>(words, at, count).is_some()) {
            table.normal = Column::InPlace(slot);
        }
        let colours = layout.colour.filter(|s| s.form == FieldForm::U8x3);
        if let Some(slot) = colours.filter(|s| s.in_place::<u8>(words, at, count).is_some()) {
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
        // Room for texture places, which are unpacked when something is drawn.
        let placed = P::Shading::TEXTURED && table.texture.is_some();
        if placed && m.places.len() >= n {
            self.base = n;
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
    pub(in super::super) fn indexed<'w, P: Pipeline, E: EventSink, M: LightingModel>(
        &mut self,
        words: impl Words<'w>,
        run: Run,
        target: &mut Target<'_, '_, P, E, M>,
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
    fn faces<'w, P: Pipeline, E: EventSink, M: LightingModel>(
        &mut self,
        words: impl Words<'w>,
        count: u16,
        run: Run,
        restart: u16,
        indices: impl Iterator<Item = u16>,
        target: &mut Target<'_, '_, P, E, M>,
    ) -> Result<(), BadIndex> {
        if run.header.rm {
            self.faces_as::<P, E, M, true>(words, count, run, restart, indices, target)
        } else {
            self.faces_as::<P, E, M, false>(words, count, run, restart, indices, target)
        }
    }

    #[inline]
    fn faces_as<'w, P: Pipeline, E: EventSink, M: LightingModel, const FAN: bool>(
        &mut self,
        words: impl Words<'w>,
        count: u16,
        run: Run,
        restart: u16,
        indices: impl Iterator<Item = u16>,
        target: &mut Target<'_, '_, P, E, M>,
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
}
