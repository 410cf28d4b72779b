//! What a draw call has to do with the shadows of a light, and shadow volumes of meshes (K9).
//!
//! A scene with shadows has three kinds of calls: what is seen, drawn as always; the volumes, most of them by
//! [`Scene::draw_shadow`]; and what is seen again, with what shadow or light makes of it. Which pixels that is, is
//! counted on each line, light by light, after all that is opaque and before what is translucent.
//!
//! A volume's faces are filed twice, those seen from outside and those seen from inside, with a draw state each: so
//! which side is seen is known once a draw call, and no record of a triangle has anything for it.

use super::DepthFunction;
use super::cut::{Corner, cut_all, near_ends};
use super::pass::{Pass, colour_all};
use super::project::{Point, View};
use super::{DepthTest, Draw, DrawError, DrawState, Master, Moved, Scene, Vertex};
use crate::geometry::{
    Affine, Camera, Coordinate, Cull, Extrusion, Faces, Mesh, ShadowLight, ShadowMemory, check,
    each_triangle, place_of, triangles,
};

/// What a draw call has to do with the shadows of a light, by the light's number, below [`Shadow::LIGHTS`].
///
/// A call with a shadow writes no depth. Where it compares with what is there is said by the shadow, unless the
/// call's own [`depth`](Draw::depth) is another than [`DepthTest::HIDES`]: then that says so.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Shadow {
    /// The call bounds the shadow volume of the light: it is not seen, but counted where it is nearer than what is
    /// seen, one way for faces that are seen from outside, and the other for those from inside. Neither is dropped.
    /// Pixels in front of which they do not balance are in the light's shadow. What a face is less than 1/64 pixel of its
    /// slope away from is inside: so surfaces that a volume begins at are in shadow where they are turned from the light.
    /// A face that is too steep for a plane has the slope between its pixels of a line.
    ///
    /// Colours, light, textures, blends and dither do nothing. Counts are modulo 256: no more than 255 volumes of a
    /// light may lie over each other.
    Volume(u8),
    /// The call is a surface drawn again, for pixels that the light reaches, where it is as far as what is seen: what
    /// the light adds, or how the surface looks in it.
    Lit(u8),
    /// The same for pixels that are in the light's shadow.
    Shadowed(u8),
}

impl Shadow {
    /// How many lights can have shadows.
    pub const LIGHTS: u8 = 8;

    pub(crate) fn light(self) -> u8 {
        match self {
            Self::Volume(light) | Self::Lit(light) | Self::Shadowed(light) => light,
        }
    }
}

impl Master {
    /// What a call with this shadow has to do without: a volume has no colours.
    pub(super) fn with_shadow(self, shadow: Option<Shadow>) -> Self {
        if !matches!(shadow, Some(Shadow::Volume(_))) {
            return self;
        }
        let dark = self.without(Self::SHADING).without(Self::TEXTURE);
        dark.without(Self::BLEND).without(Self::DITHER)
    }

    /// Whether a call with this shadow is left out.
    pub(super) fn leaves_out(self, shadow: Option<Shadow>) -> bool {
        let is_counted = matches!(shadow, Some(Shadow::Volume(_) | Shadow::Shadowed(_)));
        let are_on = self.has(Self::SHADOWS) && self.has(Self::DEPTH);
        is_counted && !are_on
    }
}

impl<'t, L> Scene<'_, 't, L> {
    /// Draws the shadow volume of a mesh that stands at `model`: what is inside is in the shadow of the light.
    ///
    /// The mesh should be closed; of one that is not, faces that look at the light cast shadows. It has to be drawn
    /// as well, or what is behind its lit faces is in the shadow of their own backs. Where `model` stretches it, it
    /// must do so by the same factor in all directions. The camera may be inside the volume.
    ///
    /// It takes two vertices and two triangles for each edge of the silhouette, and two draw states; where the near
    /// plane cuts it, two states more, and a triangle with three vertices of its own for each face that is cut.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw), and [`DrawError::Shadow`] when the memory lent for the volume is too short. What was
    /// kept of a volume that found no room is wrong; of no triangles where it is there, and has no room for what closes
    /// it at the near plane.
    pub fn draw_shadow<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        model: &Affine,
        light: &ShadowLight,
        mut memory: ShadowMemory<'_>,
    ) -> Result<(), DrawError> {
        let camera = self.camera.ok_or(DrawError::NotBegun)?;
        check(mesh, false).map_err(DrawError::Mesh)?;
        let shadow = Some(Shadow::Volume(light.light));
        self.check_shadow(shadow, 0)?;
        if self.master.leaves_out(shadow) {
            self.has_shadows = true;
            return Ok(());
        }
        let extrusion = Extrusion::new(light, model);
        let sides = extrusion.sides(mesh, &mut memory);
        let sides = sides.map_err(DrawError::Shadow)?;
        let volume = Draw {
            model: extrusion.model(model),
            shadow,
            ..Draw::new(Mesh {
                positions: sides.positions,
                faces: Faces::Triangles(sides.faces),
                ..Mesh::EMPTY
            })
        };
        let view = View::new(&camera, self.screen, model);
        self.assemble_volume(&volume, triangles(volume.mesh.faces), &mut |scene, pass| {
            scene.share(&volume.mesh, Moved::All, pass);
            // Where the mesh that casts the shadow has them, to the bit: what is between its border and the volume's would be
            // in shadow or in light by mistake.
            let near = scene.shared(pass).iter_mut().step_by(2);
            for (vertex, edge) in near.zip(&*sides.edges) {
                let [corner, _] = edge.directed();
                let point = view.point_of(mesh.positions, corner.into());
                if view.beyond(point) == 0 {
                    let on = view.project(point);
                    *vertex = Vertex::unused(on.place, on.depth);
                }
            }
            scene.file_volume(&volume.mesh, pass)
        })?;
        let cap = Draw {
            // In front of all that is seen, wherever rounding puts it.
            depth: DepthTest::new(DepthFunction::ALWAYS),
            colour: [0; 3],
            ..volume
        };
        self.close_near(&cap, &camera, &extrusion, mesh)
    }

    /// Draws what `file` brings of a volume, so many triangles; one copy for all.
    #[inline(never)]
    fn assemble_volume(
        &mut self,
        volume: &Draw<'_, 't, i32>,
        submitted: u32,
        file: &mut dyn FnMut(&mut Self, &mut Pass<'_>) -> Result<(), DrawError>,
    ) -> Result<(), DrawError> {
        self.assemble_by(volume, false, None, submitted, file)
    }

    /// Closes a shadow volume where the near plane cuts it: triangles from the border of the cut to one point of it,
    /// each with its own sign, count as the cut does.
    fn close_near<C: Coordinate>(
        &mut self,
        cap: &Draw<'_, 't, i32>,
        camera: &Camera,
        extrusion: &Extrusion,
        mesh: &Mesh<'_, C>,
    ) -> Result<(), DrawError> {
        let view = View::new(camera, self.screen, &cap.model);
        let is_before = |p: [i32; 3]| view.point(p).z < view.near;
        let mut ends = mesh.positions.iter().map(|&p| extrusion.ends(p));
        if !ends.any(|[a, b]| is_before(a) || is_before(b)) {
            return Ok(());
        }
        // The volume's triangles are counted already.
        self.assemble_volume(cap, 0, &mut |scene, pass| {
            let mut submitted = 0;
            scene.file_both(0, pass, &mut |scene, is_back, pass| {
                submitted = 0;
                let mut hub = None;
                let mut close = |corners: [[i32; 3]; 3]| {
                    let points = corners.map(|p| pass.view.finer(p, pass.view.point(p)));
                    // The border of the cut goes against the way of the triangle.
                    if let Some([to, from]) = near_ends(points, &pass.view) {
                        let hub = *hub.get_or_insert(from);
                        let [a, b] = if is_back { [to, from] } else { [from, to] };
                        scene.file_cut([hub, a, b], submitted, pass);
                        submitted += 1;
                    }
                };
                extrusion.each_lit(mesh, |_, corners| {
                    let [a, b, c] = corners.map(|corner| extrusion.ends(corner));
                    close([a[0], b[0], c[0]]);
                    close([c[1], b[1], a[1]]);
                });
                let place = |i: u16| place_of(cap.mesh.positions, i.into());
                each_triangle(cap.mesh.faces, |_, corners, _| close(corners.map(place)));
            })?;
            // One of both passes cannot see it.
            pass.culled = pass.culled.saturating_sub(submitted);
            scene.assembled.triangles += submitted;
            Ok(())
        })
    }

    /// Files a triangle that lies in the near plane, cut to the guard band.
    fn file_cut(&mut self, points: [Point; 3], number: u32, pass: &mut Pass<'_>) {
        let colour = pass.one.unwrap_or_default();
        let (view, before, mut filed) = (pass.view, self.objects.len(), Ok(()));
        let corners = points.map(|point| Corner::cut(point, colour));
        cut_all(&corners, &view, 0, &mut |piece| {
            filed = filed.and(self.file_piece(piece, &[], pass));
        });
        pass.count_face(number, filed, self.objects.len() == before);
    }

    /// Whether a call of this shadow and priority may be drawn beside those that were.
    pub(crate) fn check_shadow(
        &self,
        shadow: Option<Shadow>,
        priority: u8,
    ) -> Result<(), DrawError> {
        match shadow {
            Some(shadow) if shadow.light() >= Shadow::LIGHTS => Err(DrawError::ShadowLight),
            Some(_) if self.is_ranked || priority != 0 => Err(DrawError::ShadowRanked),
            None if self.has_shadows && priority != 0 => Err(DrawError::ShadowRanked),
            _ => Ok(()),
        }
    }

    /// Files what `file` brings of a volume's faces: those seen from outside, then those from inside, which have a state
    /// of their own. Where there is no room for that, none of so many triangles are kept.
    fn file_both(
        &mut self,
        triangles: u32,
        pass: &mut Pass<'_>,
        file: &mut dyn FnMut(&mut Self, bool, &mut Pass<'_>),
    ) -> Result<(), DrawError> {
        let kept = self.draws.len();
        let front = self.draws.as_slice().last().copied();
        let mut back = front.unwrap_or(DrawState::EMPTY);
        back.turn();
        if self.draws.push(back).is_none() {
            self.draws.truncate(kept.saturating_sub(1));
            self.vertices.truncate(pass.base);
            return Err(self.lose_call(triangles));
        }
        file(self, false, pass);
        let first = self.objects.len() as u16;
        if let Some(state) = self.draws.last_mut() {
            state.first = first;
        }
        pass.clipped = 0;
        file(self, true, pass);
        Ok(())
    }

    /// Files the faces of a volume: those seen from outside, then those from inside.
    #[inline(never)]
    pub(super) fn file_volume<C: Coordinate>(
        &mut self,
        mesh: &Mesh<'_, C>,
        pass: &mut Pass<'_>,
    ) -> Result<(), DrawError> {
        let submitted = triangles(mesh.faces);
        pass.cull = Cull::Back;
        self.file_both(submitted, pass, &mut |scene, is_back, pass| {
            each_triangle(mesh.faces, |face, [a, b, c], _| {
                let corners = if is_back { [a, c, b] } else { [a, b, c] };
                scene.file_face(mesh, face, corners, pass);
            });
        })?;
        // No face is seen from both sides.
        pass.culled = pass.culled.saturating_sub(submitted);
        if let Some(colour) = pass.one {
            colour_all(colour, self.shared(pass));
        }
        Ok(())
    }
}
