//! Meshes into triangles under the first line that they are on (K1, K2).
//!
//! Where a mesh's vertices find room, all are projected and lit once and shared; where they do not, each
//! face brings its own. Triangles keep the order in which they were submitted.

use super::alpha::{self, Alphas};
use super::check::{check_alphas, check_draw};
use super::pass::{Pass, WordOfNormal, colour_all, light_all, light_each, top_first};
use super::project::{View, project_all, project_textured};
use super::texgen::{TexGen, project_generated};
use super::{
    Application, Draw, DrawError, DrawState, Full, Master, NONE, ORIGIN, Object, Scene, Shading,
    TexturePlace, Vertex, first_line, next_change,
};
use crate::geometry::{Coordinate, Cull, Faces, Mesh, MeshError, Tint, each_triangle, triangles};
use crate::num::rolled;
use core::ops::Range;

/// Which vertices of a mesh are moved.
#[derive(Clone, Copy, PartialEq, Eq)]
pub(crate) enum Moved {
    /// All, one after the other.
    All,
    /// Those that faces have, where few of them do.
    OfFaces,
}

/// The lines and columns of guard space that are drawn.
#[derive(Clone)]
pub(super) struct Picture {
    lines: Range<u32>,
    /// The column after the last, in units of 1/8 pixel.
    right: u32,
}

impl<'t, L> Scene<'_, 't, L> {
    /// Draws a mesh, with its texture, which only a look that is `textured` has. Where light falls on pixels, vertices
    /// have words of normals.
    ///
    /// # Errors
    /// What is wrong with the mesh, or which memory is full.
    pub(crate) fn assemble<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        moved: Moved,
        textured: bool,
        word_of: Option<WordOfNormal>,
    ) -> Result<(), DrawError> {
        let mesh = &draw.mesh;
        check_alphas(draw.alphas, mesh.positions.len())?;
        let is_flat = draw.shading == Shading::Flat && !self.is_plain(draw);
        let is_volume = draw.is_volume();
        let file = |scene: &mut Self, pass: &mut Pass<'_>| {
            scene.share(mesh, moved, pass);
            match (is_volume, is_flat) {
                (true, _) => scene.file_volume(mesh, pass),
                (_, true) => scene.file_flat(mesh, pass),
                _ => scene.file(mesh, pass, |scene, pass| {
                    scene.file_faces(mesh, 0..usize::MAX, pass)
                }),
            }
        };
        self.assemble_by(draw, textured, word_of, triangles(mesh.faces), file)
    }

    /// Whether colours and light of a draw call are seen nowhere: where texels are drawn as they are, or shading is
    /// switched off.
    #[inline(always)]
    pub(super) fn is_plain<C>(&self, draw: &Draw<'_, 't, C>) -> bool {
        let master = self.master.with_shadow(draw.shadow);
        master.applied(draw) == Some(Application::Replace) || !master.has(Master::SHADING)
    }

    /// Draws what `file` brings of a draw call, so many triangles; in line, so that a program has no code of what its
    /// calls never have.
    ///
    /// # Errors
    /// As [`assemble`](Self::assemble).
    #[inline(always)]
    pub(super) fn assemble_by<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        textured: bool,
        word_of: Option<WordOfNormal>,
        submitted: u32,
        file: impl FnOnce(&mut Self, &mut Pass<'_>) -> Result<(), DrawError>,
    ) -> Result<(), DrawError> {
        let camera = self.camera.as_ref().ok_or(DrawError::NotBegun)?;
        check_draw(draw, textured, word_of.is_some())?;
        self.check_shadow(draw.shadow, draw.priority)?;
        if self.master.leaves_out(draw.shadow) {
            self.has_shadows = true;
            return Ok(());
        }
        let master = self.master.with_shadow(draw.shadow);
        let mut state = DrawState::new(self.objects.len() as u16, draw, master);
        let is_replaced = master.applied(draw) == Some(Application::Replace);
        // Texels that are seen as they are have no light.
        state.lamps = state.lamps.filter(|_| !is_replaced);
        let word_of = word_of.filter(|_| state.lamps.is_some());
        let is_blended = state.blend.is_some_and(|blend| blend.is_translucent());
        if self.draws.push(state).is_none() {
            return Err(self.lose_call(submitted));
        }
        self.generation = next_change();
        let is_plain = self.is_plain(draw);
        let colour = if is_replaced { [255; 3] } else { draw.colour };
        let (model, seen) = (&draw.model, &camera.view);
        let lamps = draw.lights.map(|lights| lights.to_model(model, seen));
        let light = draw.light.filter(|_| lamps.is_none());
        let light = light.map(|light| light.in_model(model));
        let is_lit = light.is_some() || lamps.is_some() || word_of.is_some();
        let has_one = is_plain || !is_lit && draw.mesh.colours.is_empty();
        let generated = draw
            .texgen
            .zip(draw.texture)
            .map(|(TexGen(rule), skin)| rule(draw.mesh.normals, &model.then(seen), skin.texture));
        let view = View::new(camera, self.screen, model);
        let (scale, tint) = (self.scale, Tint::new(colour, &self.scale));
        let mut pass = Pass {
            view,
            light,
            lamps: lamps.as_ref(),
            normals: word_of.map(|word| (model.then(seen), word)),
            scale,
            tint,
            one: has_one.then(|| tint.lit(1 << 15).word()),
            cull: draw.cull,
            texels: draw.texture.map(|skin| skin.places),
            generated: generated.as_ref(),
            alphas: if is_blended { draw.alphas } else { &[] },
            base: self.vertices.len(),
            shared: 0,
            within: false,
            culled: 0,
            clipped: 0,
            lost: 0,
            first_lost: None,
        };
        file(self, &mut pass)?;
        self.has_shadows |= draw.shadow.is_some();
        self.assembled.triangles += submitted;
        self.finish(&state, &pass)
    }

    /// Counts the triangles of a draw call whose state found no room.
    #[cold]
    #[inline(never)]
    pub(super) fn lose_call(&mut self, triangles: u32) -> DrawError {
        self.assembled.triangles += triangles;
        self.assembled.dropped += triangles;
        DrawError::Full {
            memory: Full::Draws,
            triangles,
            first_face: 0,
        }
    }

    /// Keeps and counts what was filed of a draw call; an error where some triangles found no room.
    #[inline(always)]
    fn finish(&mut self, state: &DrawState<'_>, pass: &Pass<'_>) -> Result<(), DrawError> {
        if self.objects.len() == usize::from(state.first) {
            self.vertices.truncate(pass.base);
        }
        if let (false, Some(kept)) = (pass.alphas.is_empty(), self.draws.last_mut()) {
            kept.alphas = Some(Alphas::new(pass.base, pass.shared));
        }
        if state.texture.is_some() && pass.may_stretch() {
            self.count_untextured(state.first.into());
        }
        self.has_values |= state.has_values();
        self.is_ruled |= state.rules();
        self.is_ranked |= state.priority != 0;
        self.assembled.culled += pass.culled;
        self.assembled.clipped += pass.clipped;
        self.assembled.dropped += pass.lost;
        match pass.first_lost {
            None => Ok(()),
            Some((memory, first_face)) => Err(DrawError::Full {
                memory,
                triangles: pass.lost,
                first_face,
            }),
        }
    }

    /// Files faces of a mesh by `file`, and lights their vertices; or takes all back, where the mesh turned out to
    /// contradict itself.
    #[inline(never)]
    pub(super) fn file<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        pass: &mut Pass<'_>,
        file: impl FnOnce(&mut Self, &mut Pass<'_>) -> Result<(), MeshError>,
    ) -> Result<(), DrawError> {
        let before = self.objects.len();
        if let Err(error) = file(self, pass) {
            self.forget_from(before, pass.base);
            return Err(DrawError::Mesh(error));
        }
        if self.objects.len() > before {
            self.light(mesh, pass);
        }
        Ok(())
    }

    /// Takes all vertices of a mesh into memory, if there is room for them.
    pub(super) fn share<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        moved: Moved,
        pass: &mut Pass<'_>,
    ) {
        if !self.reserve(mesh.positions.len(), pass) {
            return;
        }
        if let (Moved::OfFaces, None, Faces::Triangles(faces)) = (moved, pass.generated, mesh.faces)
        {
            self.wait(pass);
            return self.transform(mesh.positions, faces.as_flattened(), pass);
        }
        let (view, positions) = (&pass.view, mesh.positions);
        let (vertices, places) = self.shared_and_placed(pass);
        pass.within = match (pass.texels, pass.generated) {
            (None, _) => project_all(view, positions, vertices),
            (_, Some(generated)) => project_generated(generated, view, positions, vertices, places),
            (Some(texels), _) => project_textured(view, positions, texels, vertices, places),
        };
    }

    /// Room for so many vertices, with their alphas and texture places; whether there is any.
    pub(super) fn reserve(&mut self, count: usize, pass: &mut Pass<'_>) -> bool {
        if pass.texels.is_some() && self.places.len() < pass.base + count {
            return false;
        }
        let records = pass.alphas.len().div_ceil(alpha::A_RECORD);
        let room = self.vertices.append(count + records);
        let Some(records) = room.and_then(|room| room.get_mut(count..)) else {
            return false;
        };
        if !pass.alphas.is_empty() {
            alpha::keep(pass.alphas, records);
        }
        pass.shared = count;
        true
    }

    /// The vertices of the mesh, if they are in memory.
    #[inline(always)]
    pub(super) fn shared(&mut self, pass: &Pass<'_>) -> &mut [Vertex] {
        self.shared_and_placed(pass).0
    }

    /// The same, and their places on the texture.
    #[inline(always)]
    pub(super) fn shared_and_placed(
        &mut self,
        pass: &Pass<'_>,
    ) -> (&mut [Vertex], &mut [TexturePlace]) {
        let range = pass.base..pass.base + pass.shared;
        let places = self.places.get_mut(range.clone());
        let vertices = self.vertices.as_mut_slice().get_mut(range);
        (vertices.unwrap_or_default(), places.unwrap_or_default())
    }

    /// Gives those vertices their colours that triangles have.
    fn light<C: Coordinate>(&mut self, mesh: &Mesh<'_, C>, pass: &Pass<'_>) {
        let vertices = self.shared(pass);
        match (pass.one, &pass.light, mesh.normals, mesh.colours) {
            (Some(colour), ..) => colour_all(colour, vertices),
            (_, None, ..) | (_, _, [], _) => {
                for (i, vertex) in vertices.iter_mut().enumerate() {
                    if vertex.is_used() {
                        vertex.colour = pass.colour_of(mesh, i);
                    }
                }
            }
            (_, Some(light), normals, []) => light_all(light, &pass.tint, normals, vertices),
            (_, Some(light), normals, colours) => {
                light_each(light, &pass.scale, normals, colours, vertices);
            }
        }
    }

    pub(super) fn picture(&self) -> Picture {
        let line = |line: u16| u32::from(line) + ORIGIN as u32;
        Picture {
            lines: line(self.lines.start)..line(self.lines.end),
            right: 8 * line(self.screen.width()),
        }
    }

    /// Files faces of a mesh: these, where they are triangles, and else all.
    pub(super) fn file_faces<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        range: Range<usize>,
        pass: &mut Pass<'_>,
    ) -> Result<(), MeshError> {
        let Faces::Triangles(faces) = mesh.faces else {
            each_triangle(mesh.faces, |face, corners, _| {
                self.file_face(mesh, face, corners, pass);
            });
            return Ok(());
        };
        // What is before them is skipped, so that a face has its number.
        let faces = faces.get(..range.end).unwrap_or(faces);
        let is_there = |&i: &u16| usize::from(i) < mesh.positions.len();
        let mut from = range.start;
        loop {
            from += self.file_run(faces.get(from..).unwrap_or_default(), pass);
            let Some(&corners) = faces.get(from) else {
                return Ok(());
            };
            if !corners.iter().all(is_there) {
                return Err(MeshError::Index { face: from as u32 });
            }
            self.file_one(mesh, from as u32, corners, pass.one, pass);
            from += 1;
        }
    }

    /// Files a triangle of a face, whose corners exist.
    #[inline(never)]
    pub(super) fn file_face<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        face: u32,
        corners: [u16; 3],
        pass: &mut Pass<'_>,
    ) {
        if self.file_run(&[corners], pass) == 0 {
            self.file_one(mesh, face, corners, pass.one, pass);
        }
    }

    /// Files faces up to the first that has to be looked at more closely; how many it took.
    ///
    /// A face that is seen from behind takes 36 instructions on a Cortex-M4, one that is kept about 85.
    #[inline(never)]
    fn file_run(&mut self, faces: &[[u16; 3]], pass: &mut Pass<'_>) -> usize {
        let culls = pass.cull == Cull::Back;
        let picture = self.picture();
        let (base, within) = (pass.base, pass.within);
        let first = self.objects.len();
        let vertices = self.vertices.as_mut_slice();
        let (Some(vertices), Some(mut room)) = (
            vertices.get_mut(base..base + pass.shared),
            self.objects.rest(),
        ) else {
            return 0;
        };
        let bins = &mut *self.bins;
        let (mut rest, mut filed) = (faces.iter(), first);
        let done = loop {
            let left = rest.len();
            let Some(&[i, j, k]) = rest.next() else {
                break faces.len();
            };
            let at = |i: u16| Some(vertices.get(usize::from(i))?.place);
            // One after the other: together they are looked up twice.
            let Some(a) = at(i) else {
                break faces.len() - left;
            };
            let Some(b) = at(j) else {
                break faces.len() - left;
            };
            let Some(c) = at(k) else {
                break faces.len() - left;
            };
            let place = [a, b, c];
            if !within && place.contains(&Vertex::OUTSIDE) {
                break faces.len() - left;
            }
            let Some((corner, places)) = top_first(culls, [i, j, k], place) else {
                continue;
            };
            let Some(bin) = bin_of(places, &picture) else {
                continue;
            };
            let (Some(head), Some(object)) = (bins.get_mut(bin), room.next()) else {
                break faces.len() - left;
            };
            for i in [i, j, k] {
                if let Some(vertex) = vertices.get_mut(usize::from(i)) {
                    vertex.mark_used();
                }
            }
            *object = Object {
                corner: corner.map(|c| c + base as u16),
                next: *head,
            };
            *head = filed as u16;
            filed += 1;
        };
        self.objects.take(filed - first);
        pass.culled += (done + first - filed) as u32;
        done
    }

    /// Takes back a mesh that turned out to contradict itself.
    #[cold]
    fn forget_from(&mut self, objects: usize, vertices: usize) {
        // The triangles of a line are chained from the last one on.
        for head in self.bins.iter_mut().take(self.lines.len()) {
            while *head != NONE && usize::from(*head) >= objects {
                let object = self.objects.as_slice().get(usize::from(*head));
                *head = object.map_or(NONE, |object| object.next);
                rolled();
            }
        }
        self.objects.truncate(objects);
        self.vertices.truncate(vertices);
        self.draws.truncate(self.draws.len().saturating_sub(1));
    }
}

/// The bin of a triangle by its places, the topmost first; `None` where it lies between the lines, or
/// beside the picture.
#[inline(always)]
pub(super) fn bin_of([a, b, c]: [u32; 3], picture: &Picture) -> Option<usize> {
    let first = (first_line(a) as u32).max(picture.lines.start);
    let end = (first_line(b.max(c)) as u32).min(picture.lines.end);
    if first >= end {
        return None;
    }
    const LEFT: u32 = 8 * ORIGIN as u32;
    let x = a & 0xFFFF;
    if x <= LEFT {
        if b & 0xFFFF <= LEFT && c & 0xFFFF <= LEFT {
            return None;
        }
    } else if x >= picture.right && b & 0xFFFF >= picture.right && c & 0xFFFF >= picture.right {
        return None;
    }
    Some((first - picture.lines.start) as usize)
}
