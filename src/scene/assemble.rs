//! Meshes into triangles under the first line that they are on (K1, K2).
//!
//! Where a mesh's vertices find room, all are projected and lit once and shared; where they do not, each
//! face brings its own. Triangles keep the order in which they were submitted.

use super::cut::{Corner, cut_all};
use super::project::{View, project_all, project_textured};
use super::{Draw, DrawError, DrawState, Full, NONE, ORIGIN, Object, Scene, TexturePlace, Vertex};
use crate::geometry::{
    Colour, Coordinate, Cull, Faces, Light, LightingModel, Mesh, MeshError, ModelLight, Scale,
    Tint, check_mesh, each_triangle, triangles,
};
use core::cell::Cell;
use core::ops::Range;

/// What of a mesh found no room.
#[derive(Clone, Copy, Default)]
struct Lost {
    triangles: u32,
    first: Option<(Full, u32)>,
}

/// What is known of a draw call while its faces are filed.
struct Pass<'a> {
    view: View,
    /// The light in model space.
    light: Option<Light>,
    tint: Tint,
    cull: Cull,
    /// Texture places of the mesh's vertices; empty without a texture.
    texels: &'a [[i32; 2]],
    /// The first of the mesh's vertices in memory.
    base: usize,
    /// How many of them are there: all or none.
    shared: usize,
    /// Whether they all lie within the planes.
    within: bool,
    culled: u32,
    clipped: u32,
    lost: Lost,
}

/// The lines and columns of guard space that are drawn.
#[derive(Clone)]
struct Picture {
    lines: Range<u32>,
    /// The column after the last, in units of 1/8 pixel.
    right: u32,
}

impl<'t, L> Scene<'_, 't, L> {
    /// Draws a mesh, with its texture if `textured`.
    ///
    /// # Errors
    /// What is wrong with the mesh, or which memory is full.
    pub(crate) fn assemble<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        textured: bool,
    ) -> Result<(), DrawError> {
        let Some(camera) = self.camera else {
            return Err(DrawError::NotBegun);
        };
        let mesh = &draw.mesh;
        // Indices of triangles are looked at on the way.
        let is_looked_at = matches!(mesh.faces, Faces::Triangles(_));
        let below = if is_looked_at { 0 } else { usize::MAX };
        check_mesh(mesh, below).map_err(DrawError::Mesh)?;
        let skin = draw.texture.filter(|_| textured);
        let texels = skin.map_or(&[][..], |skin| skin.places);
        if skin.is_some() && texels.len() != mesh.positions.len() {
            return Err(DrawError::Mesh(MeshError::AttributeLength));
        }
        let submitted = triangles(mesh.faces);
        let state = DrawState::new(self.objects.len() as u16, draw, skin.as_ref());
        if self.draws.push(state).is_none() {
            return Err(DrawError::Full {
                memory: Full::Draws,
                triangles: submitted,
                first_face: 0,
            });
        }
        self.has_values |= state.has_values();
        self.is_ranked |= state.priority != 0;
        self.generation = self.generation.wrapping_add(1);
        let mut pass = Pass {
            view: View::new(&camera, self.screen, &draw.model),
            light: draw.light.map(|l| l.in_model(&draw.model, camera.view())),
            tint: Tint::new(draw.colour, &self.scale),
            cull: draw.cull,
            texels,
            base: self.vertices.len(),
            shared: 0,
            within: false,
            culled: 0,
            clipped: 0,
            lost: Lost::default(),
        };
        self.share(mesh, &mut pass);
        let before = self.objects.len();
        if let Err(error) = self.file_faces(mesh, &mut pass) {
            self.forget_from(before, pass.base);
            return Err(DrawError::Mesh(error));
        }
        if self.objects.len() == before {
            self.vertices.truncate(pass.base);
        } else {
            self.light(mesh, &pass);
        }
        self.assembled.triangles += submitted;
        self.assembled.culled += pass.culled;
        self.assembled.clipped += pass.clipped;
        self.assembled.dropped += pass.lost.triangles;
        match pass.lost.first {
            None => Ok(()),
            Some((memory, first_face)) => Err(DrawError::Full {
                memory,
                triangles: pass.lost.triangles,
                first_face,
            }),
        }
    }

    /// Takes all vertices of a mesh into memory, if there is room for them.
    fn share<C: Coordinate>(&mut self, mesh: &Mesh<'_, C>, pass: &mut Pass<'_>) {
        let count = mesh.positions.len();
        let end = pass.base + count;
        let has_places = pass.texels.is_empty() || self.places.len() >= end;
        let Some(vertices) = has_places.then(|| self.vertices.append(count)).flatten() else {
            return;
        };
        pass.shared = count;
        if pass.texels.is_empty() {
            pass.within = project_all(&pass.view, mesh.positions, vertices);
        } else if let Some(places) = self.places.get_mut(pass.base..end) {
            let (positions, texels) = (mesh.positions, pass.texels);
            pass.within = project_textured(&pass.view, positions, texels, vertices, places);
        }
    }

    /// The vertices of the mesh, if they are in memory.
    #[inline(always)]
    fn shared(&mut self, pass: &Pass<'_>) -> &mut [Vertex] {
        let all = self.vertices.as_mut_slice();
        let mesh = all.get_mut(pass.base..pass.base + pass.shared);
        mesh.unwrap_or_default()
    }

    /// Gives those vertices their colours that triangles have.
    fn light<C: Coordinate>(&mut self, mesh: &Mesh<'_, C>, pass: &Pass<'_>) {
        let scale = self.scale;
        let vertices = self.shared(pass);
        match &pass.light {
            Some(light) if mesh.colours.is_empty() && !mesh.normals.is_empty() => {
                light_all(light, &pass.tint, &scale, mesh.normals, vertices);
            }
            _ => {
                for (i, vertex) in vertices.iter_mut().enumerate() {
                    if vertex.is_used() {
                        vertex.colour = colour_of(mesh, i, pass, &scale);
                    }
                }
            }
        }
    }

    fn picture(&self) -> Picture {
        let line = |line: u16| u32::from(line) + ORIGIN as u32;
        Picture {
            lines: line(self.lines.start)..line(self.lines.end),
            right: 8 * line(self.screen.width()),
        }
    }

    /// Files all faces of a mesh.
    fn file_faces<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        pass: &mut Pass<'_>,
    ) -> Result<(), MeshError> {
        let Faces::Triangles(faces) = mesh.faces else {
            each_triangle(mesh.faces, |face, corners, _| {
                let filed = pass.shared > 0 && self.file_known(corners, pass);
                if !filed {
                    self.file_one(mesh, face, corners, pass);
                }
            });
            return Ok(());
        };
        let mut from = 0;
        while from < faces.len() {
            if pass.shared > 0 {
                let rest = faces.get(from..).unwrap_or_default();
                from += self.file_run(rest, pass);
            }
            if let Some(&corners) = faces.get(from) {
                if corners
                    .iter()
                    .any(|&i| usize::from(i) >= mesh.positions.len())
                {
                    return Err(MeshError::Index { face: from as u32 });
                }
                self.file_one(mesh, from as u32, corners, pass);
            }
            from += 1;
        }
        Ok(())
    }

    /// Files one triangle, unless it has to be looked at more closely.
    fn file_known(&mut self, corners: [u16; 3], pass: &mut Pass<'_>) -> bool {
        self.file_run(&[corners], pass) == 1
    }

    /// Files faces up to the first that has to be looked at more closely; how many it took.
    fn file_run(&mut self, faces: &[[u16; 3]], pass: &mut Pass<'_>) -> usize {
        match pass.cull {
            Cull::Back => self.file_culled::<true>(faces, pass),
            Cull::None => self.file_culled::<false>(faces, pass),
        }
    }

    /// [`file_run`](Scene::file_run), with or without those seen from behind.
    ///
    /// A face that is seen from behind takes 33 instructions on a Cortex-M4, one that is kept about 85.
    #[inline(never)]
    fn file_culled<const CULLS: bool>(&mut self, faces: &[[u16; 3]], pass: &mut Pass<'_>) -> usize {
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
        // Cells, since a face may have a corner twice.
        let vertices = Cell::from_mut(vertices).as_slice_of_cells();
        let bins = &mut *self.bins;
        let (mut rest, mut filed) = (faces.iter(), first);
        let done = loop {
            let left = rest.len();
            let Some(&[i, j, k]) = rest.next() else {
                break faces.len();
            };
            let at = |i: u16| vertices.get(usize::from(i));
            let (Some(a), Some(b), Some(c)) = (at(i), at(j), at(k)) else {
                break faces.len() - left;
            };
            let place = [a.get().place, b.get().place, c.get().place];
            if !within && place.contains(&Vertex::OUTSIDE) {
                break faces.len() - left;
            }
            let Some((corner, places)) = top_first::<CULLS>([i, j, k], place) else {
                continue;
            };
            let Some(bin) = bin_of(places, &picture) else {
                continue;
            };
            let (Some(head), Some(object)) = (bins.get_mut(bin), room.next()) else {
                break faces.len() - left;
            };
            for vertex in [a, b, c] {
                vertex.set(vertex.get().used());
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

    /// A face that brings its own vertices, and is cut where needed.
    #[cold]
    #[inline(never)]
    fn file_one<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        face: u32,
        corners: [u16; 3],
        pass: &mut Pass<'_>,
    ) {
        let corners = corners.map(|i| {
            let i = usize::from(i);
            Corner {
                point: pass.view.point(mesh.positions[i]),
                colour: colour_of(mesh, i, pass, &self.scale),
                texel: pass.texels.get(i).copied().unwrap_or_default(),
            }
        });
        let beyond = corners.map(|c| pass.view.beyond(c.point));
        let any = beyond[0] | beyond[1] | beyond[2];
        let before = self.objects.len();
        let mut lost = None;
        if beyond[0] & beyond[1] & beyond[2] == 0 {
            if any == 0 {
                lost = self.file_piece(corners, pass).err();
            } else {
                pass.clipped += 1;
                let polygon = cut_all(corners, &pass.view, any);
                for i in 2..polygon.len() {
                    let piece = [polygon[0], polygon[i - 1], polygon[i]];
                    lost = lost.or(self.file_piece(piece, pass).err());
                }
            }
        }
        if let Some(memory) = lost {
            pass.lost.triangles += 1;
            pass.lost.first.get_or_insert((memory, face));
        } else if self.objects.len() == before {
            pass.culled += 1;
        }
    }

    /// A triangle within all planes; an error names the memory that is full.
    fn file_piece(&mut self, corners: [Corner; 3], pass: &Pass<'_>) -> Result<(), Full> {
        let on = corners.map(|c| pass.view.project(c.point));
        let order = match pass.cull {
            Cull::Back => top_first::<true>([0, 1, 2], on.map(|o| o.place)),
            Cull::None => top_first::<false>([0, 1, 2], on.map(|o| o.place)),
        };
        let Some((order, places)) = order else {
            return Ok(());
        };
        let Some(bin) = bin_of(places, &self.picture()) else {
            return Ok(());
        };
        let base = self.vertices.len();
        let Some(vertices) = self.vertices.append(3) else {
            return Err(Full::Vertices);
        };
        for (vertex, &i) in vertices.iter_mut().zip(&order) {
            let i = usize::from(i) % 3;
            *vertex = Vertex {
                place: on[i].place,
                depth: on[i].depth,
                colour: corners[i].colour,
            };
        }
        if !pass.texels.is_empty() {
            let Some(places) = self.places.get_mut(base..base + 3) else {
                self.vertices.truncate(base);
                return Err(Full::Vertices);
            };
            for (place, &i) in places.iter_mut().zip(&order) {
                let i = usize::from(i) % 3;
                *place = TexturePlace::new(corners[i].texel, on[i].fine);
            }
        }
        let next = self.bins.get(bin).copied().unwrap_or(NONE);
        let corner = [0, 1, 2].map(|i| base as u16 + i);
        let Some(number) = self.objects.push(Object { corner, next }) else {
            self.vertices.truncate(base);
            return Err(Full::Objects);
        };
        if let Some(head) = self.bins.get_mut(bin) {
            *head = number;
        }
        Ok(())
    }

    /// Takes back a mesh that turned out to contradict itself.
    #[cold]
    fn forget_from(&mut self, objects: usize, vertices: usize) {
        let picture = self.picture();
        while let Some((index, &object)) = self
            .objects
            .as_slice()
            .iter()
            .enumerate()
            .next_back()
            .filter(|(index, _)| *index >= objects)
        {
            let at = |i: u16| {
                self.vertices
                    .as_slice()
                    .get(usize::from(i))
                    .map(|v| v.place)
            };
            let bin = match object.corner.map(at) {
                [Some(a), Some(b), Some(c)] => bin_of([a, b, c], &picture),
                _ => None,
            };
            if let Some(head) = bin.and_then(|bin| self.bins.get_mut(bin)) {
                *head = object.next;
            }
            self.objects.truncate(index);
        }
        self.vertices.truncate(vertices);
        self.draws.truncate(self.draws.len().saturating_sub(1));
    }
}

/// The corners from the topmost on (of two the left one), clockwise; `None` where nothing is covered or the
/// face is seen from behind and `CULLS`.
#[inline(always)]
fn top_first<const CULLS: bool>(
    corner: [u16; 3],
    [a, mut b, mut c]: [u32; 3],
) -> Option<([u16; 3], [u32; 3])> {
    let [i, mut j, mut k] = corner;
    let (d1, d2) = (b.wrapping_sub(a), c.wrapping_sub(a));
    let x = |d: u32| i32::from(d as i16);
    let y = |d: u32| d.wrapping_add(0x8000) as i32 >> 16;
    // Faces go counter-clockwise seen from outside, and clockwise in a picture whose lines go down.
    let (one, other) = (x(d1).wrapping_mul(y(d2)), x(d2).wrapping_mul(y(d1)));
    if one >= other {
        if CULLS || one == other {
            return None;
        }
    } else {
        (b, c, j, k) = (c, b, k, j);
    }
    if a < b {
        if a < c {
            Some(([i, j, k], [a, b, c]))
        } else {
            Some(([k, i, j], [c, a, b]))
        }
    } else if b < c {
        Some(([j, k, i], [b, c, a]))
    } else {
        Some(([k, i, j], [c, a, b]))
    }
}

/// The bin of a triangle by its places, the topmost first; `None` where it lies between the lines, or
/// beside the picture.
#[inline(always)]
fn bin_of([a, b, c]: [u32; 3], picture: &Picture) -> Option<usize> {
    let line = |place: u32| place.wrapping_add(4 << 16) >> 19;
    let first = line(a).max(picture.lines.start);
    let end = line(b.max(c)).min(picture.lines.end);
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

/// Colours of those vertices that triangles have, by one light and one colour.
#[inline(never)]
fn light_all(
    light: &Light,
    tint: &Tint,
    scale: &Scale,
    normals: &[[i16; 3]],
    vertices: &mut [Vertex],
) {
    let (light, tint) = (*light, *tint);
    for (vertex, &normal) in vertices.iter_mut().zip(normals) {
        if !vertex.is_used() {
            continue;
        }
        let lit = light.lit::<i16>(&tint, scale, normal, || [0; 3]);
        vertex.colour = lit.word();
    }
}

/// The colour of a vertex, lit if it is to be.
fn colour_of<C>(mesh: &Mesh<'_, C>, i: usize, pass: &Pass<'_>, scale: &Scale) -> u32 {
    let tint = match mesh.colours.get(i) {
        Some(&colour) => Tint::new(colour, scale),
        None => pass.tint,
    };
    let colour: Colour = match (&pass.light, mesh.normals.get(i)) {
        (Some(light), Some(&normal)) => light.lit::<i16>(&tint, scale, normal, || [0; 3]),
        _ => tint.lit(1 << 15),
    };
    colour.word()
}
