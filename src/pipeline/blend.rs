//! Surfaces that meet what is behind them: transparency, depth functions.

pub use crate::composite::{Blender, Blending, Compositing, Mix, PixelAlpha};
pub use crate::geometry::{Blend, Blended, DepthFunction, Factor, Finish, Surface};
