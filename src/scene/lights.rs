//! Several lights in a draw call (K10). Their code is in a program only where a call has them.

use crate::geometry::{Affine, Colour, LampsInModel, Lighting, Scale, Tint};
use core::fmt;

/// What may stand in [`Draw::lights`](super::Draw::lights): a [`Lighting`].
///
/// It is named through a reference, so that a program whose draw calls have one light, or none, does not have the
/// code of several: 13 KB on a Cortex-M4, with what makes them.
pub trait Lights: fmt::Debug + Sync {
    /// Taken to the space of a model, by the maps from there to the world and on to the camera.
    #[doc(hidden)]
    fn to_model(&self, model: &Affine, view: &Affine) -> LampsInModel;

    /// The colour of a vertex in these lights there.
    #[doc(hidden)]
    fn colour(&self, lamps: &LampsInModel, vertex: LitVertex<'_>) -> Colour;
}

/// A vertex that is lit, with a normal at a place in Q1.30.
#[derive(Clone, Copy, Debug)]
pub struct LitVertex<'a> {
    pub(super) tint: &'a Tint,
    pub(super) scale: &'a Scale,
    pub(super) normal: [i16; 3],
    pub(super) place: [i32; 3],
}

impl Lights for Lighting<'_> {
    fn to_model(&self, model: &Affine, view: &Affine) -> LampsInModel {
        self.in_model(model, view)
    }

    fn colour(&self, lamps: &LampsInModel, vertex: LitVertex<'_>) -> Colour {
        lamps.lit(vertex.tint, vertex.scale, vertex.normal, vertex.place)
    }
}

/// Several lights in the space of a model.
#[derive(Clone, Copy)]
pub(super) struct Lamps<'a> {
    pub(super) lights: &'a dyn Lights,
    pub(super) in_model: LampsInModel,
}

impl Lamps<'_> {
    /// The colour of a vertex.
    pub(super) fn lit(&self, vertex: LitVertex<'_>) -> Colour {
        self.lights.colour(&self.in_model, vertex)
    }
}
