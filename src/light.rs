//! Lights beyond the [`Light`](crate::Light) of an instance, at vertices and at pixels.

pub use crate::geometry::{DirectionalLight, Lighting, PixelLamps};
