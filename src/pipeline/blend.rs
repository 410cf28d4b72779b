//! Surfaces that meet what is behind them: transparency, depth functions, shadows.

pub use crate::composite::{Blender, Blending, Compositing, Mix, PixelAlpha};
pub use crate::geometry::{
    Blend, Blended, DepthFunction, Factor, Finish, Shadow, ShadowEdge, ShadowLight, ShadowMemory,
    ShadowRoom, Surface,
};
pub use crate::renderer::ShadowError;
pub use crate::visible::{ShadowCell, ShadowDepth32};
