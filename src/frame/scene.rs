//! A scene of a look: what its pixels are is what its vertices' colours are steps of.

use crate::geometry::{Coordinate, Screen};
use crate::look::Look;
use crate::pixel::{MadeOf, Pixel};
use crate::scene::{Draw, DrawError, Memory, Scene, ScreenCorner};

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
        if <L::Pixel as Pixel>::MADE_OF == MadeOf::Index && draw.blend.is_some() {
            return Err(DrawError::Indices);
        }
        self.assemble(draw, L::TEXTURED, L::LIT_AT_PIXELS)
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
        if <L::Pixel as Pixel>::MADE_OF == MadeOf::Index && draw.blend.is_some() {
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
        if <L::Pixel as Pixel>::MADE_OF == MadeOf::Index && draw.blend.is_some() {
            return Err(DrawError::Indices);
        }
        self.assemble_points(draw, size, L::TEXTURED, L::LIT_AT_PIXELS)
    }
}
