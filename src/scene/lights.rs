//! Several lights in a draw call (K10). Their code is in a program only where a call has them.

use crate::geometry::{Affine, LampsInModel, Lighting};
use core::fmt;

/// What may stand in [`Draw::lights`](super::Draw::lights): a [`Lighting`].
///
/// It is named through a reference, so that a program whose draw calls have one light, or none, does not have the
/// code of several: 13 KB on a Cortex-M4, with what makes them.
pub trait Lights: fmt::Debug + Sync {
    /// Taken to the space of a model, by the maps from there to the world and on to the camera.
    #[doc(hidden)]
    fn to_model(&self, model: &Affine, view: &Affine) -> LampsInModel;
}

impl Lights for Lighting<'_> {
    fn to_model(&self, model: &Affine, view: &Affine) -> LampsInModel {
        self.in_model(model, view)
    }
}
