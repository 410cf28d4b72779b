//! Draws 3D scenes line by line and hands each finished line to a display: fixed point, no heap,
//! no frame buffer, a few kilobytes of fast RAM.
//!
//! ```text
//!  Mesh, Camera, Instance          Scene                 LineRenderer              Pump
//!  ──────────────────────  ──►  ────────────  ──►  ───────────────────────  ──►  ─────────
//!   from flash                  slow RAM           fast RAM: cache, depth         two line
//!                                                                                 buffers
//!                       pass one            pass two, line by line        your DMA or SPI
//! ```
//!
//! **Pass one**, once a frame: [`Scene::draw`] moves, lights, culls, clips and projects a
//! [`Mesh`], and files each triangle under the first line it touches.
//!
//! **Pass two**, once a line: [`LineRenderer::draw_line`] takes in what begins on the line, keeps
//! what is active, and writes the pixels. Any line can be drawn alone, in any order, with the same
//! bits.
//!
//! # A frame
//!
//! You lend all memory, as slices; sizes are lengths, and none is fixed at compile time. Implement
//! [`ScanoutDma`](scan_out::ScanoutDma) for your DMA, or take a sink of [`scan_out`]. Then:
//!
//! ```
//! # use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma};
//! # use scanbeam::*;
//! type Look = GouraudDepth<Rgb565Be>; // smooth colours, 32-bit depth, 16-bit pixels for SPI
//!
//! fn frame<D: ScanoutDma<Buf: LineBuf<Word = u16>>>(
//!     model: &Mesh,
//!     scene: &mut Scene<Look>,           // Scene::new(screen, slow memory)
//!     renderer: &mut LineRenderer<Look>, // LineRenderer::new(fast memory)
//!     pump: &mut Pump<D>,                // Pump::new(dma, [buffer, other])
//!     turn: f32,
//! ) -> Result<FrameStats, Box<dyn std::error::Error>>
//! # where D::Error: std::error::Error + 'static
//! {
//!     let camera = Camera::look_at([0.0, 1.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 300.0, 0.1, 10.0)?;
//!     scene.begin(&camera)?;
//!     scene.draw(model, &Instance { model: Affine::rotation_y(turn), ..Instance::default() })?;
//!     let background = Rgb565Be::from_rgb8([24, 32, 48]);
//!     Ok(draw_frame(scene, renderer, pump, background, 8)?) // 8 lines a transfer
//! }
//! ```
//!
//! # Where to go on
//!
//! | for | see |
//! |---|---|
//! | a whole program, memory and all | [`guide::first_triangle`] |
//! | your display, your memory, two cores | [`guide::own_display`], [`guide::own_memory`], [`guide::two_cores`] |
//! | speed against error, and what a frame did | [`guide::quality`], [`guide::figures`] |
//! | smooth or textured meshes in half to two thirds of the instructions | [`guide::fewer_instructions`], [`scene`], [`look`], [`frame`] |
//! | other choices: flat, no depth, textures, blending | the presets beside [`GouraudDepth`] |
//! | a scene as data, in flash or in a ring that grows | [`list`], [`ListRunner`] |
//! | which requirement is met where, and which test says so | [`guide::rows`] |
#![no_std]
#![forbid(unsafe_code)]

#[cfg(test)]
extern crate std;

/// The code of the README compiles.
#[cfg(doctest)]
#[doc = include_str!("../README.md")]
struct Readme;

mod active;
mod arena;
mod composite;
mod event;
pub mod frame;
mod geometry;
pub mod guide;
mod link;
pub mod list;
pub mod look;
mod num;
mod pipeline;
mod pixel;
mod renderer;
pub mod scan_out;
pub mod scene;
mod shade;
mod span;
mod stats;
mod visible;

pub use active::{CacheCounts, Interleave, Slot};
pub use composite::{
    Blender, Blending, Compositing, Cut, CutOff, DetailedTextures, Dithered, Grey8, Index4, Index8,
    Indexed, Ink, LineOverlay, LinePalettes, ListOverlays, ListTexel, ListTextures, Mix, OneWord,
    Ordered, Overlay, PaletteTable, PixelAlpha, PixelFormat, Pixels, Ramp, Ranks, Rgb565, Rgb565Be,
    Rgb565Bytes, Rgb565Le, Rgb888, Sprite, TexelOf, TextureSource, Textures, Threshold, TwoWords,
    UnsortedSprites, Xrgb8888, expand_indices, mono_page, mono_row,
};
#[cfg(feature = "embedded-graphics")]
pub use composite::{Canvas, DrawnLines};
pub use event::{Event, EventFlags, EventSet, EventSink, Notice};
pub use geometry::{
    Affine, Assembled, Blend, Blended, Camera, CameraError, Clip, Colour, Coordinate, Cull,
    DepthFunction, DirectionalLight, Dropped, Empty, Faces, Factor, Filed, Finish, Flat, Gouraud,
    Kept, Light, Lighting, LightingModel, ListLamps, ListLighting, LitSkin, Mark, Marked, Material,
    MatrixRange, Mesh, MeshError, Object, Phong, PixelLamps, Priority, QuadSplit, Room, Scale,
    SceneVertex, Screen, ScreenError, ScreenVertex, Shading, Shadow, ShadowEdge, ShadowLight,
    ShadowMemory, ShadowRoom, Sphere, Surface,
};
pub use link::Link;
pub use num::{BlockFix16, I2F14, I2F30, U1F15, U13F3};
pub use pipeline::{
    BlockFixed, CellOf, Composited, Counted, Deferred, DetailedDepth, DrawableOf, FiledOf,
    FlatDepth, FlatPainter, GouraudDepth, GouraudPainter, Interpolated, ListedDepth, ObjectOf,
    Parts, PhongDepth, Pipeline, Prioritised, Shadowed, SkinOf, SlotOf, TexturedDepth, VertexOf,
    Windowed, WithDepth, WithShading, WordOf, Worded,
};
pub use renderer::{
    Command, Crew, DepthUse, DrawError, EightLights, FrameError, FrameStats, Input, InputError,
    InputQueue, Instance, LineDesk, LineMemory, LineRenderer, LineSource, LineWorker,
    ListCoordinate, ListLights, ListMemory, ListRunner, ListSettings, OnViolation, OneLight,
    Overlaid, PassOne, Prefetched, Relay, RendererError, RunCounts, Scene, SceneError, SceneMemory,
    ShadowError, Source, Stalled, Stream, Vertices, draw_continuous, draw_frame,
    draw_frame_changed, draw_frame_changed_runs, draw_frame_indexed, draw_frame_overlaid,
    draw_frame_overlaid_changed, send_changed, send_changed_runs, send_frame, send_frame_indexed,
};
#[cfg(feature = "async")]
pub use renderer::{draw_frame_async, send_frame_async};
pub use shade::{
    Auto, Forward, HalfRate, Interpolation, Lamplight, Lirp10, Lirp12, Lirp16, LirpPacked, Method,
    Packed8, Packed16, PixelLights, Precision, Quality, QuarterRate,
};
pub use shade::{Levels, texture};
pub use stats::{SpanCounter, SpanCounts};
pub use visible::{
    BlockFixDepth, Depth32, DepthAndColour, DepthAndId, DepthCell, LineDepth, ShadowCell,
    ShadowDepth32,
};
