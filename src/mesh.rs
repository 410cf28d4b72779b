//! What a [`Mesh`](crate::Mesh) is made of, and what became of it when it was drawn.

pub use crate::geometry::{
    Assembled, Colour, Coordinate, Dropped, Material, MatrixRange, QuadSplit, Room, ScreenVertex,
    Sphere,
};
pub use crate::num::{I2F14, U1F15};
pub use crate::renderer::Vertices;
