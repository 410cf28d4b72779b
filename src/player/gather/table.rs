//! A table of vertices, and triangles of it by index.

use super::fill::{End, Rules, fill};
use super::{Column, Gather, Kind, Out, Table};
use crate::geometry::Coordinate;
use crate::list::{
    FieldForm, Header, Layout, Lent, Missing, Place, Reason, Run, VertexFormat, Words, colour,
};

impl<C: Coordinate + Place> Gather<'_, C> {
    /// Takes a table: columns that cannot be used where they lie are unpacked.
    ///
    /// # Errors
    /// When there is no room, or the coordinates are too fine for `C`.
    #[inline(never)]
    pub(crate) fn table<'w>(
        &mut self,
        words: impl Words<'w>,
        format: &VertexFormat,
        run: Run,
        out: &mut Out<'_, C>,
    ) -> Result<(), Reason> {
        self.flush(words, out);
        self.reset();
        let layout = Layout::new(format, run.header);
        let (at, count) = (run.at, run.header.count);
        let mut table = Table {
            at,
            count,
            place: Column::Unpacked(layout.place),
            normal: layout.normal.map_or(Column::None, Column::Unpacked),
            colour: layout.colour.map_or(Column::None, Column::Unpacked),
            texture: layout.texture,
            alphas: false,
            prsp: run.header.prsp,
            placed: None,
            usable: true,
            lacks_faces: false,
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
        let alpha = layout.colour.filter(|slot| slot.has_alpha());
        let alpha = alpha.filter(|_| !m.alphas.is_empty());
        table.alphas = alpha.is_some();
        let short = |c: Column, len: usize| matches!(c, Column::Unpacked(_)) && len < n;
        if short(table.place, m.positions.len())
            || short(table.normal, m.normals.len())
            || short(table.colour, m.colours.len())
            || table.alphas && m.alphas.len() < n
        {
            table.usable = false;
            self.table = Some(table);
            return Err(Reason::Lent(Lent::Vertices));
        }
        if let (Column::Unpacked(place), Some(out)) = (table.place, m.positions.get_mut(..n)) {
            self.base = n;
            // One that is too fine is not used.
            place.column(words, at, out, |form, f| C::of(form, f).unwrap_or_default());
        }
        if let (Column::Unpacked(slot), Some(out)) = (table.normal, m.normals.get_mut(..n)) {
            self.base = n;
            slot.column(words, at, out, FieldForm::normal);
        }
        if let (Column::Unpacked(slot), Some(out)) = (table.colour, m.colours.get_mut(..n)) {
            self.base = n;
            slot.column(words, at, out, |_, f| colour(f));
        }
        if let (Some(slot), Some(out)) = (alpha, m.alphas.get_mut(..n)) {
            self.base = n;
            for (n, alpha) in (0..).zip(out.iter_mut()) {
                *alpha = slot.alpha(words, at.wrapping_add(n));
            }
        }
        // Room for texture places, which are unpacked when something is drawn: in a ring they are gone then.
        let texture = table.texture.filter(|_| out.textured);
        if let (Some(slot), Some(places)) = (texture, m.places.get_mut(..n)) {
            self.base = n;
            if words.room().is_some() {
                slot.column(words, at, places, |_, [u, v, _]| [u, v]);
                table.placed = Some(super::places::RAW);
            }
        }
        table.usable = C::of(place.form, [0; 3]).is_some();
        self.table = Some(table);
        let fine = Reason::Missing(Missing::FinePlaces);
        table.usable.then_some(()).ok_or(fine)
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
    #[inline(never)]
    pub(crate) fn indexed<'w>(
        &mut self,
        words: impl Words<'w>,
        run: Run,
        out: &mut Out<'_, C>,
    ) -> Result<(), Reason> {
        self.begin(out);
        let Some(table) = self.table.filter(|t| t.usable) else {
            return Err(Reason::Lent(Lent::Vertices));
        };
        if self.kind != Kind::Table {
            self.flush(words, out);
            self.kind = Kind::Table;
        }
        // What goes on stands behind others of the table, or the walker refuses it.
        if run.header.new {
            self.strip.restart();
        }
        let rules = Rules::of(run.header, table.count);
        let len = u32::from(run.header.count).div_ceil(4);
        if let (0, Some(slice)) = (run.header.low & Header::WIDE, words.slice(run.at, len)) {
            let bytes: &[u8] = bytemuck::cast_slice(slice);
            let bytes = bytes.get(..run.header.count.into()).unwrap_or_default();
            return self.faces(words, bytes, &rules, out);
        }
        let mut some = [0; AT_ONCE];
        let mut from = 0;
        while from < run.header.count {
            let n = usize::from(run.header.count - from).min(AT_ONCE);
            let some = some.get_mut(..n).unwrap_or_default();
            unpack(words, run, from, some);
            self.faces(words, &*some, &rules, out)?;
            from += n as u16;
        }
        Ok(())
    }

    /// Takes some indices.
    #[inline(never)]
    fn faces<'w, I: Copy + Into<u16>>(
        &mut self,
        words: impl Words<'w>,
        mut rest: &[I],
        rules: &Rules,
        out: &mut Out<'_, C>,
    ) -> Result<(), Reason> {
        loop {
            let free = self.memory.indices.get_mut(self.indices..);
            let free = free.unwrap_or_default();
            let (whole, _) = free.split_at_mut(free.len() / 3 * 3);
            // Three to a face, of whatever alignment.
            let free = bytemuck::try_cast_slice_mut(whole).unwrap_or_default();
            let filled = fill(rest, free, &mut self.strip, rules);
            self.indices += 3 * filled.faces;
            rest = rest.get(filled.read..).unwrap_or_default();
            match filled.end {
                End::All => return Ok(()),
                End::Bad(index) => {
                    let count = rules.count;
                    return Err(Reason::Index { index, count });
                }
                End::Full => {
                    self.flush(words, out);
                    if self.memory.indices.len() < 3 {
                        return Err(Reason::Lent(Lent::Indices));
                    }
                }
            }
        }
    }
}

/// Indices that are unpacked at once: whole words, and whole triangles.
const AT_ONCE: usize = 48;

/// Unpacks the indices of a block from one on, which is the first of a word.
#[inline(never)]
fn unpack<'w>(words: impl Words<'w>, run: Run, from: u16, some: &mut [u16]) {
    let wide = run.header.low & Header::WIDE != 0;
    let mut at = (run.at).wrapping_add(u32::from(from) / if wide { 2 } else { 4 });
    let mut next = || {
        let word = words.word(at);
        at = at.wrapping_add(1);
        word
    };
    if wide {
        for pair in some.chunks_mut(2) {
            let word = next();
            for (slot, half) in pair.iter_mut().zip([word as u16, (word >> 16) as u16]) {
                *slot = half;
            }
        }
        return;
    }
    for four in some.chunks_mut(4) {
        for (slot, byte) in four.iter_mut().zip(next().to_le_bytes()) {
            *slot = byte.into();
        }
    }
}
