//! A scene of a look: what its pixels are is what its vertices' colours are steps of.

use crate::geometry::{Coordinate, Screen};
use crate::look::Look;
use crate::pixel::{MadeOf, Pixel};
use crate::scene::{Draw, DrawError, Memory, Scene};

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
}
