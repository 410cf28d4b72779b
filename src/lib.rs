//! scanbeam draws 3D scenes scanline by scanline and streams them to a display: fixed point,
//! no heap, a few kilobytes of fast RAM where others need a frame buffer and a z-buffer.
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

mod active;
mod arena;
mod composite;
mod geometry;
mod link;
pub mod model;
mod num;
mod pipeline;
mod renderer;
pub mod scan_out;
mod shade;
mod span;
mod stats;
mod visible;

pub use active::{CacheCounts, Interleave, Slot};
pub use composite::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888};
pub use geometry::{
    Affine, Assembled, Camera, CameraError, Colour, Coordinate, Cull, Dropped, Faces, Flat,
    Gouraud, Light, Mesh, MeshError, Object, QuadSplit, Room, Scale, SceneVertex, Screen,
    ScreenError, Shading,
};
pub use link::Link;
pub use num::{I2F14, I2F30, U1F15, U13F3};
pub use pipeline::{
    CellOf, Counted, DrawableOf, FlatDepth, FlatPainter, GouraudDepth, GouraudPainter, ObjectOf,
    Parts, Pipeline, SlotOf, VertexOf, WordOf,
};
pub use renderer::{
    Command, Crew, DrawError, FrameError, FrameStats, Input, InputError, InputQueue, Instance,
    LineDesk, LineMemory, LineRenderer, LineSource, LineWorker, PassOne, Prefetched, Relay,
    RendererError, Scene, SceneError, SceneMemory, Source, SpanRecord, Stalled, Stream, draw_frame,
    send_frame,
};
pub use stats::{SpanCounter, SpanCounts};
pub use visible::{Depth32, LineDepth};
