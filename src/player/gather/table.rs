//! A table of vertices, and triangles of it by index.

use super::fill::{Filled, fill, fill_one};
use super::{Column, Gather, Kind, ListCoordinate, Out, Refusal, Table};
use crate::list::{FieldForm, Layout, Run, SEPARATE, VertexFormat, WIDE, Words, colour, normal};

impl<C: ListCoordinate> Gather<'_, C> {
    /// Takes a table: columns that cannot be used where they lie are unpacked.
    ///
    /// # Errors
    /// When there is no room, or the coordinates are too fine for `C`.
    pub(crate) fn table<'w>(
        &mut self,
        words: impl Words<'w>,
        format: &VertexFormat,
        run: Run,
        out: &mut Out<'_, C>,
    ) -> Result<(), Refusal> {
        self.flush(words, out);
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
            return Err(Refusal::Vertices);
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
        let placed = out.textured && table.texture.is_some();
        if placed && m.places.len() >= n {
            self.base = n;
        }
        table.usable = !fine;
        self.table = Some(table);
        if fine { Err(Refusal::Fine) } else { Ok(()) }
    }

    /// Whether the table in force has texture places, for which there is no memory.
    pub(crate) fn lacks_table_places(&self) -> bool {
        let lacks = |table: &Table| {
            table.texture.is_some() && self.memory.places.len() < usize::from(table.count)
        };
        self.table.as_ref().is_some_and(lacks)
    }

    /// Takes triangles of the table.
    ///
    /// # Errors
    /// When the table was refused, an index is not one of it, or there is no room for a face.
    pub(crate) fn indexed<'w>(
        &mut self,
        words: impl Words<'w>,
        run: Run,
        out: &mut Out<'_, C>,
    ) -> Result<(), Refusal> {
        let Some(table) = self.table.filter(|t| t.usable) else {
            return Err(Refusal::Table);
        };
        if self.kind != Kind::Table {
            self.flush(words, out);
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
                self.faces(words, table.count, run, 0xFF, indices, out)
            }
            (Some(slice), true) => {
                let halves: &[u16] = bytemuck::cast_slice(slice);
                let indices = halves.get(..count).unwrap_or(&[]).iter().copied();
                self.faces(words, table.count, run, 0xFFFF, indices, out)
            }
            (None, _) => {
                let (each, bits, restart) = if wide { (2, 16, 0xFFFF) } else { (4, 8, 0xFF) };
                let indices = (0..count as u32).map(|n| {
                    let word = words.word(run.at.wrapping_add(n / each));
                    (word >> (bits * (n % each))) as u16 & restart
                });
                self.faces(words, table.count, run, restart, indices, out)
            }
        }
    }

    /// Strips and fans each in a loop of their own: what is asked once a block is not asked once
    /// an index.
    #[inline]
    fn faces<'w>(
        &mut self,
        words: impl Words<'w>,
        count: u16,
        run: Run,
        restart: u16,
        indices: impl Iterator<Item = u16>,
        out: &mut Out<'_, C>,
    ) -> Result<(), Refusal> {
        if run.header.rm {
            self.faces_as::<true>(words, count, run, restart, indices, out)
        } else {
            self.faces_as::<false>(words, count, run, restart, indices, out)
        }
    }

    #[inline]
    fn faces_as<'w, const FAN: bool>(
        &mut self,
        words: impl Words<'w>,
        count: u16,
        run: Run,
        restart: u16,
        indices: impl Iterator<Item = u16>,
        out: &mut Out<'_, C>,
    ) -> Result<(), Refusal> {
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
                result = Err(Refusal::Index { index, count });
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
                let free = self.memory.indices.get_mut(used..).unwrap_or(&mut []);
                let (faces, end) = if separate {
                    fill_one(free, face)
                } else {
                    fill::<FAN>(&mut indices, free, count, &mut face, &mut odd)
                };
                used += 3 * faces;
                match end {
                    Filled::Full => {
                        self.indices = used;
                        self.flush(words, out);
                        used = 0;
                        if self.memory.indices.len() < 3 {
                            result = Err(Refusal::Indices);
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
                                result = Err(Refusal::Index { index, count });
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
