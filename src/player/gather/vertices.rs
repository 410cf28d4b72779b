//! Short vertices: strips, fans, quads, quad strips and points.

use super::{Attributes, Gather, Kind, Out, RunFaces};
use crate::geometry::{Coordinate, QuadSplit};
use crate::list::{
    Header, Id, Layout, Lent, Missing, Place, Reason, Run, VertexFormat, Words, colour,
};

impl<C: Coordinate + Place> Gather<'_, C> {
    /// Takes the vertices of a block of SHORT, QUADS, or POINTS of so many pixels each way.
    ///
    /// # Errors
    /// When there is no room, or the coordinates are too fine for `C`.
    #[inline(never)]
    pub(crate) fn run<'w>(
        &mut self,
        words: impl Words<'w>,
        format: &VertexFormat,
        run: Run,
        point_size: u8,
        out: &mut Out<'_, C>,
    ) -> Result<(), Reason> {
        self.begin(out);
        let header = run.header;
        let (quads, points) = (header.id == Id::Quads, header.id == Id::Points);
        let layout = Layout::new(format, header);
        if C::of(layout.place.form, [0; 3]).is_none() {
            return Err(Reason::Missing(Missing::FinePlaces));
        }
        let texture = layout.texture.filter(|_| out.textured);
        let keeps_alphas = !self.memory.alphas.is_empty();
        let alpha = layout
            .colour
            .filter(|slot| slot.has_alpha() && keeps_alphas);
        let has = Attributes {
            normals: layout.normal.is_some(),
            colours: layout.colour.is_some(),
            alphas: alpha.is_some(),
            places: texture.is_some(),
            prsp: texture.is_some() && header.prsp,
        };
        let room = self.room(has).saturating_sub(self.base);
        if room < 4 {
            return Err(Reason::Lent(Lent::Vertices));
        }
        if self.memory.indices.len() < 4 {
            return Err(Reason::Lent(Lent::Indices));
        }
        let strip = !points && (!quads || header.rm);
        if !strip || header.new {
            self.strip.restart();
        }
        let split = match header.low & Header::SPLIT != 0 {
            false => QuadSplit::Corner0To2,
            true => QuadSplit::Corner1To3,
        };
        let faces = |odd: bool| match (quads, header.rm) {
            _ if points => RunFaces::Points(point_size),
            (false, _) => RunFaces::Triangles,
            (true, false) => RunFaces::Quads(split),
            (true, true) if odd => RunFaces::QuadStrip(split.other()),
            (true, true) => RunFaces::QuadStrip(split),
        };
        let kind = |odd| Kind::Run {
            faces: faces(odd),
            has,
        };
        let one_strip = quads && header.rm;
        if self.kind != kind(self.strip.odd) || (one_strip && header.new) {
            self.flush(words, out);
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
                self.flush(words, out);
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
                *slot = from.form.normal(from.field(words, at));
            }
            if let (Some(from), Some(slot)) = (layout.colour, self.memory.colours.get_mut(to)) {
                *slot = colour(from.field(words, at));
            }
            if let (Some(from), Some(slot)) = (alpha, self.memory.alphas.get_mut(to)) {
                *slot = from.alpha(words, at);
            }
            if let (Some(from), Some(slot)) = (texture, self.memory.places.get_mut(to)) {
                let [u, v, _] = from.field(words, at);
                *slot = [u, v];
            }
            at = at.wrapping_add(layout.words);
            self.vertices += 1;
            let index = index as u16;
            match (quads, header.rm) {
                _ if points => {}
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
}
