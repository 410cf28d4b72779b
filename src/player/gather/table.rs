//! A table of vertices, and triangles of it by index.

use super::fill::{End, Rules, fill};
use super::places::RAW;
use super::{Gather, Kind, Out, Table};
use crate::geometry::Coordinate;
use crate::list::{FieldForm, Header, Layout, Lent, Missing, Place, Reason, Run, Words, colour};

impl<C: Coordinate + Place> Gather<'_, C> {
    /// Takes a table: columns that cannot be used where they lie are unpacked.
    ///
    /// # Errors
    /// When there is no room, or the coordinates are too fine for `C`.
    #[inline(never)]
    pub(crate) fn table<'w>(
        &mut self,
        run: Run,
        out: &mut Out<'_, C, impl Words<'w>>,
    ) -> Result<(), Reason> {
        self.flush(out);
        self.reset();
        let layout = Layout::new(out.format, run.header);
        let (words, at, count) = (out.words, run.at, run.header.count);
        let n = usize::from(count);
        let place = Some(layout.place).filter(|s| s.in_place::<C>(words, at, count).is_none());
        let normal = layout
            .normal
            .filter(|s| s.in_place::<i16>(words, at, count).is_none());
        let colours = layout
            .colour
            .filter(|s| s.in_place::<u8>(words, at, count).is_none());
        let alpha = self.alpha(&layout);
        if place.is_some() && self.positions.len() < n
            || normal.is_some() && self.normals.len() < n
            || colours.is_some() && self.colours.len() < n
            || alpha.is_some() && self.alphas.len() < n
        {
            return Err(Reason::Lent(Lent::Vertices));
        }
        if C::of(layout.place.form, [0; 3]).is_none() {
            return Err(Reason::Missing(Missing::FinePlaces));
        }
        if let (Some(slot), Some(to)) = (place, self.positions.get_mut(..n)) {
            self.base = n;
            slot.column(words, at, to, |form, f| C::of(form, f).unwrap_or_default());
        }
        if let (Some(slot), Some(to)) = (normal, self.normals.get_mut(..n)) {
            self.base = n;
            slot.column(words, at, to, FieldForm::normal);
        }
        if let (Some(slot), Some(to)) = (colours, self.colours.get_mut(..n)) {
            self.base = n;
            slot.column(words, at, to, |_, f| colour(f));
        }
        if let (Some(slot), Some(to)) = (alpha, self.alphas.get_mut(..n)) {
            self.base = n;
            for (n, alpha) in (0..).zip(to.iter_mut()) {
                *alpha = slot.alpha(words, at.wrapping_add(n));
            }
        }
        let mut placed = None;
        // Room for texture places, which are unpacked when something is drawn: in a ring they are gone then.
        let texture = layout.texture.filter(|_| out.textured);
        if let (Some(slot), Some(to)) = (texture, self.places.get_mut(..n)) {
            self.base = n;
            if words.room().is_some() {
                slot.column(words, at, to, |_, [u, v, _]| [u, v]);
                placed = Some(RAW);
            }
        }
        self.table = Some(Table {
            run,
            layout,
            placed,
            lacks_faces: false,
        });
        Ok(())
    }

    /// Whether the table in force has texture places, for which there is no memory.
    pub(crate) fn lacks_table_places(&self) -> bool {
        let lacks = |table: &Table| {
            let count = usize::from(table.run.header.count);
            table.layout.texture.is_some() && self.places.len() < count
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
        run: Run,
        out: &mut Out<'_, C, impl Words<'w>>,
    ) -> Result<(), Reason> {
        self.begin(out.block);
        let (words, table) = (out.words, self.table);
        let table = table.ok_or(Reason::Lent(Lent::Vertices))?;
        if self.kind != Kind::Table {
            self.flush(out);
            self.kind = Kind::Table;
        }
        // What goes on stands behind others of the table, or the walker refuses it.
        if run.header.new {
            self.strip.restart();
        }
        let rules = Rules::of(run.header, table.run.header.count);
        let len = u32::from(run.header.count).div_ceil(4);
        if let (0, Some(slice)) = (run.header.low & Header::WIDE, words.slice(run.at, len)) {
            let bytes: &[u8] = bytemuck::cast_slice(slice);
            let bytes = bytes.get(..run.header.count.into()).unwrap_or_default();
            return self.faces(bytes, &rules, out);
        }
        let mut some = [0; AT_ONCE];
        let mut from = 0;
        while from < run.header.count {
            let n = usize::from(run.header.count - from).min(AT_ONCE);
            let some = some.get_mut(..n).unwrap_or_default();
            unpack(words, run, from, some);
            self.faces(&*some, &rules, out)?;
            from += n as u16;
        }
        Ok(())
    }

    /// Takes some indices.
    #[inline(never)]
    fn faces<'w, I: Copy + Into<u16>>(
        &mut self,
        mut rest: &[I],
        rules: &Rules,
        out: &mut Out<'_, C, impl Words<'w>>,
    ) -> Result<(), Reason> {
        loop {
            let free = self.indices.get_mut(self.used..);
            let free = free.unwrap_or_default();
            let (whole, _) = free.split_at_mut(free.len() / 3 * 3);
            // Three to a face, of whatever alignment.
            let free = bytemuck::try_cast_slice_mut(whole).unwrap_or_default();
            let filled = fill(rest, free, &mut self.strip, rules);
            self.used += 3 * filled.faces;
            rest = rest.get(filled.read..).unwrap_or_default();
            match filled.end {
                End::All => return Ok(()),
                End::Bad(index) => {
                    let count = rules.count;
                    return Err(Reason::Index { index, count });
                }
                End::Full => {
                    self.flush(out);
                    if self.indices.len() < 3 {
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
    let (a_word, bits) = if wide { (2, 16) } else { (4, 8) };
    let at = (run.at).wrapping_add(u32::from(from) / a_word);
    for (n, part) in (0..).zip(some.chunks_mut(a_word as usize)) {
        let mut word = words.word(at.wrapping_add(n));
        for slot in part {
            *slot = (word & ((1 << bits) - 1)) as u16;
            word >>= bits;
        }
    }
}
