//! Draws 3D scenes line by line and hands each finished line to a display: fixed point, no heap,
//! no frame buffer, a few kilobytes of fast RAM.
//!
//! ```text
//!  Mesh, Camera, Draw              Scene                   Renderer                 Pump
//!  ──────────────────────  ──►  ────────────  ──►  ───────────────────────  ──►  ─────────
//!   from flash                  slow RAM           fast RAM: cache, depth         two line
//!                                                                                 buffers
//!                       pass one            pass two, line by line        your DMA or SPI
//! ```
//!
//! **Pass one**, once a frame: [`Scene::draw`] moves, lights, culls, clips and projects a
//! [`Mesh`], and files each triangle under the first line it touches.
//!
//! **Pass two**, once a line: [`Renderer::draw_line`] takes in what begins on the line, keeps
//! what is active, and writes the pixels. Any line can be drawn alone, in any order, with the same
//! bits.
//!
//! # A frame
//!
//! You lend all memory, as slices; sizes are lengths, and none is fixed at compile time but that of the cache. Implement
//! [`ScanoutDma`](scan_out::ScanoutDma) for your DMA, or take a sink of [`scan_out`]. Then:
//!
//! ```
//! # use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma};
//! # use scanbeam::{look::Gouraud, pixel::{PixelFormat, Rgb565Be}, *};
//! type Look = Gouraud<Rgb565Be>; // smooth colours, 16-bit pixels for SPI
//!
//! // `Box` is for the host. Firmware has no heap: it handles errors where they come from.
//! fn frame<D: ScanoutDma<Buf: LineBuf<Word = u16>>>(
//!     model: Mesh,
//!     scene: &mut Scene<'_, 'static, Look>, // Scene::new(screen, slow memory)
//!     renderer: &mut Renderer<Look>,        // Renderer::new(fast memory)
//!     pump: &mut Pump<D>,                   // Pump::new(dma, [buffer, other])
//!     turn: f32,
//! ) -> Result<frame::FrameUse, Box<dyn std::error::Error>>
//! # where D::Error: std::error::Error + 'static
//! {
//!     let (eye, middle, up) = ([0.0, 1.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0]);
//!     let camera = Camera::look_at(eye, middle, up, 300.0, 0.1, 10.0)?;
//!     scene.begin(&camera)?;
//!     let drawn = scene.draw(&Draw {
//!         model: Affine::rotation_y(turn),
//!         light: Light::new([-0.9, 0.8, 0.5], 0.2),
//!         ..Draw::new(model)
//!     });
//!     let background = Rgb565Be::from_rgb8([24, 32, 48]);
//!     let used = draw_frame(scene, renderer, pump, background, 8)?; // 8 lines a transfer
//!     drawn?; // what did not fit in memory: the rest is shown
//!     Ok(used)
//! }
//! ```
//!
//! # Where things are
//!
//! What a first frame needs is here at the root. The rest is in modules, in the order in which data walks:
//!
//! | module | there |
//! |---|---|
//! | [`mesh`], [`light`], [`list`], [`input`] | what is drawn, by calls or as data |
//! | [`scene`] | pass one: draw calls, their textures, blends, scissors, priorities, shadows |
//! | [`look`], [`pixel`] | what a triangle's pixels look like |
//! | [`frame`] | pass two: lines, frames, two cores |
//! | [`overlay`], [`scan_out`] | what is painted over lines, and how they get to displays |
//! | [`stats`], [`event`] | what happened |
//!
//! # Where to go on
//!
//! | for | see |
//! |---|---|
//! | a whole program, memory and all | [`guide::first_triangle`] |
//! | textures | [`guide::textures`] |
//! | blends, scissors, priorities, shadows, reflections, lists | [`guide::draw_calls`] |
//! | your display, your memory, two cores | [`guide::own_display`], [`guide::own_memory`], [`guide::two_cores`] |
//! | speed against error, and what a frame did | [`guide::quality`], [`guide::figures`] |
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
pub mod pixel;
mod player;
pub mod scan_out;
pub mod scene;
mod span;
pub mod stats;
mod visible;

pub use frame::{Renderer, draw_frame};
pub use geometry::{Affine, Camera, CameraError, Cull, Faces, Light, Mesh, MeshError, Screen};
pub use link::Link;
pub use scene::{Draw, Scene};
