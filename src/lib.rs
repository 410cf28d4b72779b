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
//! # use scanbeam::{pipeline::GouraudDepth, pixel::{PixelFormat, Rgb565Be}, *};
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
//! # Where things are
//!
//! What a first frame needs is here at the root; the rest is in modules by task: [`mesh`], [`light`],
//! [`texture`], [`blend`] and [`overlay`] for what is drawn, [`pipeline`] and [`pixel`] for how,
//! [`list`] and [`input`] for scenes as data, [`parallel`], [`send`] and [`scan_out`] for frames on
//! their way to displays, [`stats`] and [`event`] for what happened.
//!
//! # Where to go on
//!
//! | for | see |
//! |---|---|
//! | a whole program, memory and all | [`guide::first_triangle`] |
//! | your display, your memory, two cores | [`guide::own_display`], [`guide::own_memory`], [`guide::two_cores`] |
//! | speed against error, and what a frame did | [`guide::quality`], [`guide::figures`] |
//! | smooth or textured meshes in half to two thirds of the instructions | [`guide::fewer_instructions`], [`scene`], [`look`], [`frame`] |
//! | other choices: flat, no depth, textures, blending | the presets of [`pipeline`], [`texture`], [`blend`] |
//! | a scene as data, in flash or in a ring that grows | [`list`], [`input`] |
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
pub mod blend;
mod composite;
pub mod event;
pub mod frame;
mod geometry;
pub mod guide;
pub mod input;
pub mod light;
mod link;
pub mod list;
pub mod look;
pub mod mesh;
mod num;
pub mod overlay;
pub mod parallel;
pub mod pipeline;
pub mod pixel;
mod player;
mod renderer;
pub mod scan_out;
pub mod scene;
pub mod send;
mod shade;
mod span;
pub mod stats;
pub mod texture;
mod visible;

pub use geometry::{Affine, Camera, CameraError, Cull, Faces, Light, Mesh, MeshError, Screen};
pub use link::Link;
pub use renderer::{
    DrawError, FrameError, FrameStats, Instance, LineMemory, LineRenderer, RendererError, Scene,
    SceneError, SceneMemory, draw_frame,
};
pub use shade::Quality;
