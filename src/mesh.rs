//! What a [`Mesh`](crate::Mesh) is made of, what became of it when it was drawn, and which screens
//! there cannot be.

pub use crate::geometry::{
    Colour, Coordinate, CutError, Material, Meshlet, Meshlets, QuadSplit, ScreenError, Sphere,
};
pub use crate::num::{I2F14, U1F15};
pub use crate::scene::ScreenVertex;
