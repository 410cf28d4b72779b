//! Short vertices: strips, fans, quads, quad strips and points.

use super::{Attributes, Gather, Kind, Out, RunFaces};
use crate::geometry::{Coordinate, QuadSplit};
use crate::list::{Header, Id, Layout, Lent, Missing, Place, Reason, Run, Words, colour};

impl<C: Coordinate + Place> Gather<'_, C> {
    /// Takes the vertices of a block of SHORT, QUADS or POINTS.
    ///
    /// # Errors
    /// When there is no room, or the coordinates are too fine for `C`.
    #[inline(never)]
    pub(crate) fn run<'w>(
        &mut self,
        run: Run,
        out: &mut Out<'_, C, impl Words<'w>>,
    ) -> Result<(), Reason> {
        self.begin(out.block);
        let (header, words, point_size) = (run.header, out.words, out.point_size);
        let (quads, points) = (header.id == Id::Quads, header.id == Id::Points);
        let layout = Layout::new(out.format, header);
        if C::of(layout.place.form, [0; 3]).is_none() {
            return Err(Reason::Missing(Missing::FinePlaces));
        }
        let texture = layout.texture.filter(|_| out.textured);
        let alpha = self.alpha(&layout);
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
        if self.indices.len() < 4 {
            return Err(Reason::Lent(Lent::Indices));
        }
        let one_strip = quads && header.rm;
        if points || quads && !header.rm || header.new {
            self.strip.restart();
        }
        let split = match header.low & Header::SPLIT != 0 {
            false => QuadSplit::Corner0To2,
            true => QuadSplit::Corner1To3,
        };
        let kind = |odd: bool| {
            let faces = match (quads, header.rm) {
                _ if points => RunFaces::Points(point_size),
                (false, _) => RunFaces::Triangles,
                (true, false) => RunFaces::Quads(split),
                (true, true) if odd => RunFaces::QuadStrip(split.other()),
                (true, true) => RunFaces::QuadStrip(split),
            };
            Kind::Run { faces, has }
        };
        if self.kind != kind(self.strip.odd) || (one_strip && header.new) {
            self.flush(out);
            self.kind = kind(self.strip.odd);
            if self.strip.have == 0 {
                self.vertices = 0;
            }
        }
        // A quad is never parted, nor the two vertices that a strip of them takes.
        let (vertices, indices) = match (quads, header.rm) {
            (false, _) => (1, 3),
            (true, false) => (4, 4),
            (true, true) => (2, 2),
        };
        let mut at = run.at;
        for n in 0..usize::from(header.count) {
            let is_full =
                self.vertices + vertices > room || self.used + indices > self.indices.len();
            if is_full && n % vertices == 0 {
                self.flush(out);
                self.kind = kind(self.strip.odd);
            }
            if one_strip && self.used == 0 && self.strip.have == 2 {
                self.push(&[0, 1]);
            }
            let index = self.vertices;
            let to = self.base + index;
            let place = C::of(layout.place.form, layout.place.field(words, at));
            if let (Some(place), Some(slot)) = (place, self.positions.get_mut(to)) {
                *slot = place;
            }
            if let (Some(from), Some(slot)) = (layout.normal, self.normals.get_mut(to)) {
                *slot = from.form.normal(from.field(words, at));
            }
            if let (Some(from), Some(slot)) = (layout.colour, self.colours.get_mut(to)) {
                *slot = colour(from.field(words, at));
            }
            if let (Some(from), Some(slot)) = (alpha, self.alphas.get_mut(to)) {
                *slot = from.alpha(words, at);
            }
            if let (Some(from), Some(slot)) = (texture, self.places.get_mut(to)) {
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
