//! Whether surfaces have a finish: the choice of a pipeline.

/// What a pipeline does with the finishes of surfaces: [`Blended`](crate::pipeline::blend::Blended) shadings have
/// them.
pub trait Compositing {
    /// Whether it looks at them at all.
    const BLENDS: bool;
}

/// Every object is opaque; nobody asks.
impl Compositing for () {
    const BLENDS: bool = false;
}

/// Each object is composited as its [`Finish`](crate::pipeline::blend::Finish) says.
#[derive(Clone, Copy, Debug)]
pub struct Blending;

impl Compositing for Blending {
    const BLENDS: bool = true;
}
