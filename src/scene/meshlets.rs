//! Draw calls of meshes in parts: what is turned away, or beside the picture, is not looked at (X3, M4).
//!
//! Vertices are transformed as the first part that has them is drawn.

use super::WordOfNormal;
use super::check::check_alphas;
use super::pass::Pass;
use super::project::project_listed;
use super::{Draw, DrawError, Moved, Scene, Shading, TexturePlace, Vertex};
use crate::geometry::{Coordinate, Eye, Mesh, MeshError, Meshlets, triangles};

impl<'t, L> Scene<'_, 't, L> {
    /// [`assemble`](Self::assemble) of a mesh in parts.
    ///
    /// # Errors
    /// As that, and where the parts are of another mesh.
    pub(crate) fn assemble_meshlets<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        meshlets: &Meshlets<'_>,
        textured: bool,
        word_of: Option<WordOfNormal>,
    ) -> Result<(), DrawError> {
        let mesh = Mesh {
            faces: meshlets.faces(),
            ..draw.mesh
        };
        let draw = &Draw { mesh, ..*draw };
        if mesh.positions.len() < meshlets.end {
            return Err(DrawError::Mesh(MeshError::Meshlets));
        }
        let camera = self.camera.ok_or(DrawError::NotBegun)?;
        let is_flat = draw.shading == Shading::Flat && !self.is_plain(draw);
        if draw.is_volume() || is_flat || draw.texgen.is_some() {
            return self.assemble(draw, Moved::All, textured, word_of);
        }
        check_alphas(draw.alphas, mesh.positions.len())?;
        // None where faces are seen from behind too, or normals do not tell.
        let eye = match draw.is_one_sided() {
            true => Eye::new(&draw.model, &camera.view),
            false => None,
        };
        let submitted = triangles(mesh.faces);
        self.assemble_by(draw, textured, word_of, submitted, |scene, pass| {
            let has_room = scene.reserve(mesh.positions.len(), pass);
            scene.file(&mesh, pass, |scene, pass| match has_room {
                true => scene.file_meshlets(draw, eye, meshlets, pass),
                false => scene.file_faces(&mesh, 0..usize::MAX, pass),
            })
        })
    }

    /// Files the faces of all parts that may be seen.
    fn file_meshlets<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        eye: Option<Eye>,
        meshlets: &Meshlets<'_>,
        pass: &mut Pass<'_>,
    ) -> Result<(), MeshError> {
        let (mesh, model) = (&draw.mesh, &draw.model);
        self.wait(pass);
        let (mut from, mut listed) = (0, meshlets.vertices());
        for part in meshlets.parts() {
            let end = from + usize::from(part.faces);
            let (list, rest) = listed.split_at(usize::from(part.vertices).min(listed.len()));
            listed = rest;
            let is_turned_away = eye.is_some_and(|eye| eye.is_behind(part));
            let (sphere, screen, lines) = (&part.sphere, self.screen, &self.lines);
            let is_outside = |camera| sphere.is_outside(camera, screen, lines, model);
            // While all was within the planes, the rest is not held against the picture.
            let is_unseen =
                is_turned_away || !pass.within && self.camera.as_ref().is_some_and(is_outside);
            if is_unseen {
                self.assembled.triangles_skipped += u32::from(part.faces);
                pass.culled += u32::from(part.faces);
            } else {
                self.transform(mesh.positions, list, pass);
                self.file_faces(mesh, from..end, pass)?;
            }
            from = end;
        }
        Ok(())
    }

    /// Begins a mesh of which no vertex is transformed yet.
    pub(super) fn wait(&mut self, pass: &mut Pass<'_>) {
        self.shared(pass).fill(Vertex::WAITING);
        // All of those that are transformed.
        pass.within = true;
    }

    /// Transforms the listed vertices of a mesh that are not yet.
    pub(super) fn transform<C: Coordinate>(
        &mut self,
        positions: &[[C; 3]],
        list: &[u16],
        pass: &mut Pass<'_>,
    ) {
        let view = &pass.view;
        let (vertices, places) = self.shared_and_placed(pass);
        pass.within &= match pass.texels {
            None => project_listed(view, list, positions, vertices, |_, _| {}),
            Some(texels) => project_listed(view, list, positions, vertices, |i, fine| {
                if let (Some(place), Some(&texel)) = (places.get_mut(i), texels.get(i)) {
                    *place = TexturePlace::of_mesh(texel, fine);
                }
            }),
        };
    }
}
