//! Triangles with vertices of their own: cut by a plane, of one colour, or made on the screen (K1, K11).

use super::alpha;
use super::assemble::bin_of;
use super::cut::{Corner, cut_all};
use super::pass::{Own, Pass};
use super::project::View;
use super::{Full, Object, Scene, TexturePlace, Vertex};
use crate::geometry::{Coordinate, Mesh, place_of};
use core::hint::black_box;

impl<L> Scene<'_, '_, L> {
    /// A face that brings its own vertices, and is cut where needed; of one colour, if it has one.
    #[cold]
    #[inline(never)]
    pub(super) fn file_one<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        face: u32,
        corners: [u16; 3],
        colour: Option<u32>,
        pass: &mut Pass<'_>,
    ) {
        if self.leaves_out(corners, pass) {
            return;
        }
        // Loops over slices of any length: what is rare is not there three times.
        let mut corners = corners.map(Corner::of_vertex);
        let (mut every, mut any) = (u32::MAX, 0);
        for corner in black_box(corners.as_mut_slice()) {
            corner.point = pass.view.point_of(mesh.positions, corner.vertex.into());
            let beyond = pass.view.beyond(corner.point);
            (every, any) = (every & beyond, any | beyond);
        }
        if every != 0 {
            pass.culled += 1;
            return;
        }
        for corner in black_box(corners.as_mut_slice()) {
            dress(mesh, colour, pass, corner);
        }
        let before = self.objects.len();
        let mut filed = Ok(());
        if any == 0 {
            filed = self.file_piece(&corners, &corners, pass);
        } else {
            pass.clipped += 1;
            let pass = &*pass;
            let mut finer = corners;
            make_finer(mesh, black_box(finer.as_mut_slice()), &pass.view);
            cut_all(&finer, &pass.view, any, &mut |piece| {
                filed = filed.and(self.file_piece(piece, &corners, pass));
            });
        }
        pass.count_face(face, filed, self.objects.len() == before);
    }

    /// Counts a face whose vertices are known to lie beyond one plane, all of them; whether they are.
    #[inline(never)]
    pub(super) fn leaves_out(&mut self, corners: [u16; 3], pass: &mut Pass<'_>) -> bool {
        let vertices = self.shared(pass);
        let beyond = corners.map(|i| match vertices.get(usize::from(i)) {
            Some(vertex) if vertex.place == Vertex::OUTSIDE => vertex.depth,
            _ => 0,
        });
        let is_beyond = beyond[0] & beyond[1] & beyond[2] != 0;
        pass.culled += u32::from(is_beyond);
        is_beyond
    }

    /// A triangle within all planes, corners of which are among those of a face that was cut; an error names the memory
    /// that is full.
    #[inline(never)]
    pub(super) fn file_piece(
        &mut self,
        piece: &[Corner; 3],
        whole: &[Corner],
        pass: &Pass<'_>,
    ) -> Result<(), Full> {
        let vertices = self.shared(pass);
        let mut own = [Own::EMPTY; 3];
        for (own, corner) in own.iter_mut().zip(black_box(piece.as_slice())) {
            *own = own_of(corner, whole, vertices, pass);
        }
        self.file_own(&own, pass)
    }

    /// A triangle with vertices of its own; an error names the memory that is full.
    pub(super) fn file_own(&mut self, own: &[Own; 3], pass: &Pass<'_>) -> Result<(), Full> {
        let places = [0, 1, 2].map(|i| own[i].vertex.place);
        let Some((order, places)) = pass.order(places) else {
            return Ok(());
        };
        let bin = bin_of(places, &self.picture());
        let Some(head) = bin.and_then(|bin| self.bins.get_mut(bin)) else {
            return Ok(());
        };
        let own = order.map(|i| &own[usize::from(i) % 3]);
        let base = self.vertices.len();
        let record = usize::from(!pass.alphas.is_empty());
        let vertices = self.vertices.append(3 + record).ok_or(Full::Vertices)?;
        if let Some(record) = vertices.get_mut(3) {
            *record = alpha::own_record(own.map(|own| own.alpha));
        }
        for (vertex, own) in vertices.iter_mut().zip(own) {
            *vertex = own.vertex;
        }
        if pass.texels.is_some() {
            let Some(places) = self.places.get_mut(base..base + 3) else {
                self.vertices.truncate(base);
                return Err(Full::Places);
            };
            for (place, own) in places.iter_mut().zip(own) {
                *place = own.place;
            }
        }
        let corner = [0, 1, 2].map(|i| base as u16 + i);
        let next = *head;
        let Some(number) = self.objects.push(Object { corner, next }) else {
            self.vertices.truncate(base);
            return Err(Full::Objects);
        };
        *head = number;
        Ok(())
    }
}

/// Gives a corner the colour that it has, or is lit with, its place on the texture and its alpha.
#[inline(never)]
fn dress<C: Coordinate>(
    mesh: &Mesh<'_, C>,
    colour: Option<u32>,
    pass: &Pass<'_>,
    corner: &mut Corner,
) {
    let i = usize::from(corner.vertex);
    corner.colour = colour.unwrap_or_else(|| pass.colour_of(mesh, i));
    corner.texel = pass.texel(i);
    corner.alpha = pass.alpha(i);
}

/// Gives points of corners of a mesh all bits.
#[inline(never)]
fn make_finer<C: Coordinate>(mesh: &Mesh<'_, C>, corners: &mut [Corner], view: &View) {
    for corner in corners {
        let at = place_of(mesh.positions, corner.vertex.into());
        corner.point = view.finer(at, corner.point);
    }
}

/// A corner within all planes as a vertex: where the mesh's has been seen already, if it is one. Out of line, since a
/// triangle has three.
#[inline(never)]
fn own_of(corner: &Corner, whole: &[Corner], vertices: &[Vertex], pass: &Pass<'_>) -> Own {
    // What is no new corner is where others see it, who may not be cut.
    let is_whole = |one: &&Corner| one.vertex == corner.vertex && one.vertex != Corner::CUT;
    let (point, finer) = match whole.iter().find(is_whole) {
        Some(seen) => (seen.point, 0),
        None => (corner.point, pass.view.finer),
    };
    let mut on = pass.view.project_finer(point, finer);
    let known = vertices.get(usize::from(corner.vertex));
    if let Some(known) = known.filter(|known| known.place != Vertex::OUTSIDE) {
        (on.place, on.depth) = (known.place, known.depth);
    }
    Own {
        vertex: Vertex::new(on.place, on.depth, corner.colour),
        place: TexturePlace::new(corner.texel, on.fine),
        alpha: corner.alpha,
    }
}
