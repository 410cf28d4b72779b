//! A scene of a look: what its pixels are is what its vertices' colours are steps of.

use crate::geometry::{Coordinate, Meshlets, Screen, Sphere, triangles};
use crate::look::Look;
use crate::pixel::{MadeOf, PixelFormat};
use crate::scene::{Draw, DrawError, FiledTriangle, Memory, Scene, ScreenCorner, Shadow};

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
        if <L::Pixel as PixelFormat>::MADE_OF == MadeOf::Index && draw.blend.is_some() {
            return Err(DrawError::Indices);
        }
        self.assemble(draw, L::TEXTURED, L::LIT_AT_PIXELS)
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
        let Some(camera) = self.camera else {
            return Err(DrawError::NotBegun);
        };
        let is_volume = matches!(draw.shadow, Some(Shadow::Volume(_)));
        if is_volume || !sphere.is_outside(&camera, self.screen, &self.lines, &draw.model) {
            return self.draw(draw).map(|()| true);
        }
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
        if <L::Pixel as PixelFormat>::MADE_OF == MadeOf::Index && draw.blend.is_some() {
            return Err(DrawError::Indices);
        }
        self.assemble_meshlets(draw, meshlets, L::TEXTURED, L::LIT_AT_PIXELS)
    }

    /// Draws triangles that were set up beforehand, each with vertices of its own: no camera, no light, and nothing to
    /// clip (H11). Of the call its mesh, its light and its texture places are not looked at. 1/w is 2^31 at the near plane
    /// of the camera that the scene was begun with.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw); [`DrawError::Light`] where the look is lit at pixels.
    pub fn draw_screen(
        &mut self,
        draw: &Draw<'_, 't>,
        triangles: &[[ScreenCorner; 3]],
    ) -> Result<(), DrawError> {
        if <L::Pixel as PixelFormat>::MADE_OF == MadeOf::Index && draw.blend.is_some() {
            return Err(DrawError::Indices);
        }
        if L::LIT_AT_PIXELS.is_some() {
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
        if <L::Pixel as PixelFormat>::MADE_OF == MadeOf::Index && draw.blend.is_some() {
            return Err(DrawError::Indices);
        }
        self.assemble_points(draw, size, L::TEXTURED, L::LIT_AT_PIXELS)
    }

    /// The triangles that pass one has filed, in order of submission: pieces of those that were cut, none that is culled
    /// or found no room, those of shadow volumes too. All corners lie on the screen, or beside it.
    ///
    /// ```
    /// use scanbeam::look::Gouraud;
    /// use scanbeam::mesh::ScreenVertex;
    /// use scanbeam::pixel::Rgb565;
    /// use scanbeam::scene::{Draw, DrawState, Memory, Object, Scene, ScreenCorner, Vertex};
    /// use scanbeam::{Camera, Faces, Mesh, Screen};
    ///
    /// let (mut vertices, mut objects) = ([Vertex::EMPTY; 3], [Object::EMPTY; 1]);
    /// let (mut bins, mut draws) = ([0; 48], [DrawState::EMPTY; 1]);
    /// let memory = Memory {
    ///     vertices: &mut vertices, places: &mut [], objects: &mut objects, bins: &mut bins, draws: &mut draws,
    /// };
    /// let mut scene = Scene::<Gouraud<Rgb565>>::new(Screen::new(64, 48)?, memory);
    /// scene.begin(&Camera::look_at([0.0, 0.0, 1.0], [0.0; 3], [0.0, 1.0, 0.0], 64.0, 0.1, 10.0)?)?;
    /// let corner = |x, y, colour| ScreenCorner {
    ///     vertex: ScreenVertex { x, y, depth: 1 << 30, colour },
    ///     ..ScreenCorner::default()
    /// };
    /// let (red, blue) = ([255, 0, 0], [0, 0, 255]);
    /// let empty = Mesh { positions: &[], normals: &[], colours: &[], faces: Faces::Triangles(&[]) };
    /// scene.draw_screen(&Draw::new(empty), &[[corner(80, 8, red), corner(0, 40, blue), corner(160, 90, blue)]])?;
    /// let triangle = scene.triangles().next().unwrap();
    /// let [top, right, left] = triangle.corners;
    /// // Clockwise from the topmost corner on.
    /// assert_eq!([(top.x, top.y), (right.x, right.y), (left.x, left.y)], [(80, 8), (160, 90), (0, 40)]);
    /// assert_eq!((top.colour, left.colour, triangle.call), (red, blue, 0));
    /// // From line 1, whose middle is 12 units down, to line 10 at 84.
    /// assert_eq!(triangle.lines(), 1..11);
    /// # Ok::<(), Box<dyn std::error::Error>>(())
    /// ```
    #[must_use]
    pub fn triangles(&self) -> impl DoubleEndedIterator<Item = FiledTriangle> + ExactSizeIterator {
        self.filed(L::LIT_AT_PIXELS.is_some())
    }
}
