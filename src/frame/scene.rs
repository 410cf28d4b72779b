//! A scene of a look: what its pixels are is what its vertices' colours are steps of.

use crate::geometry::{Coordinate, Meshlets, Screen, Sphere, triangles};
use crate::look::{Look, check_blend};
use crate::scene::{Draw, DrawError, Memory, Moved, Scene, ScreenCorner};

impl<'m, 't, L: Look> Scene<'m, 't, L> {
    /// A scene for pictures of this size. Nothing is drawn before it is [begun](Scene::begin).
    #[must_use]
    pub fn new(screen: Screen, memory: Memory<'m, 't>) -> Self {
        Self::with_scale(screen, memory, L::SCALE)
    }

    /// Draws a mesh: pass one.
    ///
    /// # Errors
    /// What is wrong with the mesh, after which nothing of it is drawn; or which memory is full, after which the rest
    /// is drawn.
    pub fn draw<C: Coordinate>(&mut self, draw: &Draw<'_, 't, C>) -> Result<(), DrawError> {
        check_blend::<L>(draw.blend)?;
        self.assemble(draw, Moved::All, L::TEXTURED, L::LIT_AT_PIXELS)
    }

    /// Draws some faces of a large table of vertices, as [`draw`](Scene::draw) does, and moves only the vertices that they
    /// have: for those of one material of a model, say. On a Cortex-M4 a corner takes 9 instructions more, and a vertex
    /// that is not moved some 85 less; there is to be room for all. Strips, quads and reflections are drawn whole.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw).
    pub fn draw_partly<C: Coordinate>(&mut self, draw: &Draw<'_, 't, C>) -> Result<(), DrawError> {
        check_blend::<L>(draw.blend)?;
        self.assemble(draw, Moved::OfFaces, L::TEXTURED, L::LIT_AT_PIXELS)
    }

    /// Draws a mesh all of whose vertices lie in `sphere`, as [`draw`](Scene::draw) does, and does not look at it where
    /// the sphere is wholly outside the lines of the picture, or nearer or farther than what is seen: some 1,500
    /// instructions on a Cortex-M4, whatever the mesh. Whether it was looked at; the picture is the same.
    /// [`Assembled`](crate::scene::Assembled) counts what is skipped, among the culled too. What bounds a shadow is always drawn.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw); a mesh that is skipped is not checked.
    pub fn draw_within<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        sphere: &Sphere,
    ) -> Result<bool, DrawError> {
        let camera = self.camera.as_ref().ok_or(DrawError::NotBegun)?;
        if draw.is_volume() || !sphere.is_outside(camera, self.screen, &self.lines, &draw.model) {
            return self.draw(draw).map(|()| true);
        }
        self.check_shadow(draw.shadow, draw.priority)?;
        self.is_ranked |= draw.priority != 0;
        self.has_shadows |= draw.shadow.is_some();
        let skipped = triangles(draw.mesh.faces);
        let done = &mut self.assembled;
        done.triangles += skipped;
        done.culled += skipped;
        done.meshes_skipped += 1;
        done.triangles_skipped += skipped;
        done.vertices_skipped += draw.mesh.positions.len() as u32;
        Ok(false)
    }

    /// Draws a mesh in parts, as [`draw`](Scene::draw) does, and looks neither at parts whose faces are all seen from
    /// behind nor at the vertices that they alone have: some 50 instructions a part on a Cortex-M4. Once a vertex lay
    /// beyond the planes of the view, parts that lie beside the picture are not looked at either.
    /// [`Assembled`](crate::scene::Assembled) counts the triangles that are skipped, among the culled too.
    ///
    /// The same picture, but for faces that are told from behind only after their corners were rounded to 1/8 pixel:
    /// edges of what is not closed may lack a pixel. Faces of one colour, reflections, what bounds a shadow, and models
    /// that are stretched or mirrored are drawn whole. The faces of the call's mesh are not looked at, only those of the parts.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw), and where the parts are of another mesh.
    pub fn draw_meshlets<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        meshlets: &Meshlets<'_>,
    ) -> Result<(), DrawError> {
        check_blend::<L>(draw.blend)?;
        self.assemble_meshlets(draw, meshlets, L::TEXTURED, L::LIT_AT_PIXELS)
    }

    /// Draws triangles that were set up beforehand, each with vertices of its own: no camera, no light, and nothing to
    /// clip (H11). Of the call its mesh, its light and its texture places are not looked at. 1/w is 2^31 at the near plane
    /// of the camera that the scene was begun with.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw); [`DrawError::Light`] where the call has lamps.
    pub fn draw_screen(
        &mut self,
        draw: &Draw<'_, 't>,
        triangles: &[[ScreenCorner; 3]],
    ) -> Result<(), DrawError> {
        check_blend::<L>(draw.blend)?;
        if draw.lamps.is_some() {
            return Err(DrawError::Light);
        }
        self.assemble_screen(draw, triangles, L::TEXTURED)
    }

    /// Draws the vertices of a mesh as points: squares of `size` pixels each way around them, with their depths (H11);
    /// of 0 pixels nothing. A point that is lit needs a normal, and one that is textured has the texel of its place. One
    /// whose place lies beyond the guard band is culled.
    ///
    /// A point of one pixel is a triangle with vertices of its own, a larger one two.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw); a face is a vertex here.
    pub fn draw_points<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        size: u8,
    ) -> Result<(), DrawError> {
        check_blend::<L>(draw.blend)?;
        self.assemble_points(draw, size, L::TEXTURED, L::LIT_AT_PIXELS)
    }
}
