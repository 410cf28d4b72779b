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
//! # Memory
//!
//! You lend all of it, as slices. Sizes are lengths; none is fixed at compile time.
//!
//! | lent in | what | where | how many |
//! |---|---|---|---|
//! | [`SceneMemory`] | `vertices`, `objects` | large, slow RAM | what the scene needs; when full, [`DrawError::Full`], and the rest is drawn |
//! | [`SceneMemory`] | `buckets` | large, slow RAM | one a line of the picture |
//! | [`LineMemory`] | `links` | large, slow RAM | one an object |
//! | [`LineMemory`] | `slots`: the object cache | fast RAM | any number, also none: the picture is the same |
//! | [`LineMemory`] | `depth` | fast RAM | one a pixel of a line |
//! | [`LineMemory`] | `spans` | fast RAM | any number, also none |
//! | [`Pump`](scan_out::Pump) | two line buffers | RAM that the DMA reaches | one or more lines each |
//!
//! # One triangle, without a display
//!
//! ```
//! use scanbeam::{
//!     Camera, Faces, GouraudDepth, Instance, LineMemory, LineRenderer, Link, Mesh, ObjectOf,
//!     PixelFormat, Rgb565, Scene, SceneMemory, Screen, VertexOf,
//! };
//!
//! // Colours linear between corners, 32-bit depth, 16-bit pixels.
//! type Look = GouraudDepth<Rgb565>;
//! const WIDTH: usize = 32;
//! const HEIGHT: usize = 24;
//!
//! // Slow memory. A triangle that is clipped may need a few more than 3 vertices and 1 object.
//! let mut vertices = [VertexOf::<Look>::empty(); 16];
//! let mut objects = [ObjectOf::<Look>::default(); 8];
//! let mut buckets = [Link::NONE; HEIGHT];
//! let mut links = [Link::NONE; 8];
//! // Fast memory.
//! let mut slots = [LineRenderer::<Look>::empty_slot(); 4];
//! let mut depth = [0; WIDTH];
//!
//! // Pass one. Coordinates are Q1.14: `ONE` is 1.0. Corners go counter-clockwise.
//! const ONE: i16 = 1 << 14;
//! let mesh = Mesh {
//!     positions: &[[-ONE, -ONE, 0], [ONE, -ONE, 0], [0, ONE, 0]],
//!     normals: &[],
//!     colours: &[[255, 0, 0], [0, 255, 0], [0, 0, 255]],
//!     faces: Faces::Triangles(&[[0, 1, 2]]),
//! };
//! let screen = Screen::new(WIDTH as u16, HEIGHT as u16)?;
//! let memory = SceneMemory { vertices: &mut vertices, objects: &mut objects, buckets: &mut buckets };
//! let mut scene = Scene::<Look>::new(screen, memory);
//! // From (0, 0, 3) to the origin; focal length 30 pixels; from 0.1 to 10 units away.
//! let camera = Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 30.0, 0.1, 10.0)?;
//! scene.begin(&camera)?;
//! scene.draw(&mesh, &Instance::default())?;
//!
//! // Pass two. `picture` stands for the display; a real one takes each line as it is finished.
//! let mut renderer = LineRenderer::<Look>::new(LineMemory {
//!     slots: &mut slots,
//!     links: &mut links,
//!     depth: &mut depth,
//! });
//! let black = Rgb565::from_rgb8([0, 0, 0]);
//! let mut picture = [[black; WIDTH]; HEIGHT];
//! for (line, pixels) in picture.iter_mut().enumerate() {
//!     renderer.draw_line(&scene, line as u16, pixels)?;
//! }
//!
//! assert_eq!(picture[0][0], black);
//! assert_ne!(picture[12][16], black);
//! let covered = picture.as_flattened().iter().filter(|&&pixel| pixel != black).count();
//! // 20 pixels wide and 20 high: focal length 30, size 2, distance 3.
//! assert_eq!(covered, 200);
//! # Ok::<(), Box<dyn core::error::Error>>(())
//! ```
//!
//! # To a display
//!
//! Implement [`ScanoutDma`](scan_out::ScanoutDma) for your DMA (its page shows how, in about 25
//! lines), or take [`SpiSink`](scan_out::SpiSink) for any `embedded-hal` SPI bus. Then a frame is
//! one call: [`draw_frame`] clears, draws and sends all lines, while the line before is on its way.
//!
//! ```
//! # use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma};
//! # use scanbeam::{draw_frame, FrameError, FrameStats, GouraudDepth, LineRenderer, Rgb565, Scene};
//! # type Look = GouraudDepth<Rgb565>;
//! fn frame<D: ScanoutDma<Buf: LineBuf<Word = u16>>>(
//!     scene: &Scene<Look>,
//!     renderer: &mut LineRenderer<Look>,
//!     pump: &mut Pump<D>, // `Pump::new(dma, [buffer, other])`, made once
//! ) -> Result<FrameStats, FrameError<D::Error>> {
//!     let black = 0;
//!     draw_frame(scene, renderer, pump, black, 8) // 8 lines a transfer
//! }
//! ```
//!
//! Two cores, or several threads, draw alternate lines of one scene: see [`LineWorker`],
//! [`LineDesk`] and [`Interleave`]. Other choices, such as flat shading or no depth, are the
//! presets beside [`GouraudDepth`]; [`Counted`] makes [`FrameStats`] count spans and pixels.
//!
//! # From requirement to code
//!
//! Tests of rooms lie in the rooms themselves; the others are files of `host-tests/tests`.
//!
//! | row | what | code in `src` | tests |
//! |---|---|---|---|
//! | S1 | `no_std`, no heap, no `unsafe` | `lib.rs` | the firmware of `examples` builds and runs |
//! | S2 | top level | `lib.rs`, `memory.x` | |
//! | S3 | arenas in slow and fast memory | `arena.rs`, `link.rs`, `renderer/scene.rs`, `memory.x` | `arenas.rs`, sections in `host-tests/src/firmware/tests.rs` |
//! | S4 | fixed point, the same bits everywhere | `num/`, `geometry/` | `against_reference.rs`, `host-tests/src/firmware/tests.rs` |
//! | S5 | lines to a DMA | `scan_out/` | `scan_out.rs`, `scan_out_spi.rs` |
//! | S6 | the same code on the host | | all, with `host-tests/src/mock.rs` |
//! | K1 | two passes, activation buckets | `renderer/scene.rs`, `renderer/lines.rs`, `active/bucket.rs` | `lines_alone.rs` |
//! | K2 | triangles, quads, strips | `geometry/mesh.rs`, `geometry/assemble.rs` | `watertight.rs` |
//! | K3 | screen in 13.3 | `num/mod.rs`, `geometry/camera.rs`, `geometry/project.rs` | `watertight.rs` |
//! | K4 | edges exact, no gap, no pixel twice | `num/edge.rs`, `geometry/setup.rs`, `span/` | `watertight.rs`, `model_scenes.rs` |
//! | K5 | any line alone | `renderer/lines.rs`, `num/plane.rs` | `lines_alone.rs`, `model_scenes.rs` |
//! | K6, K7, P3 | colour along a span: LIRP, packed, forward, half and quarter rate | `shade/interpolation.rs`, `composite/` | `composite/tests.rs`, `host-tests/src/accuracy/` |
//! | X2 | an error budget | `shade/quality.rs`, `shade/interpolation.rs` | `shade/interpolation.rs`, `composite/tests.rs`, `host-tests/src/accuracy/` |
//! | X3, X4, M4 | skipping, counted | `geometry/bounds.rs`, `scan_out/changed.rs`, `renderer/frame.rs`, `stats.rs` | `skipped.rs`, `changed.rs` |
//! | K8 | line depth | `visible/` | `against_reference.rs`, `model_pipe.rs` |
//! | K9 | shadow volumes, counted on a line | `geometry/shadow.rs`, `visible/shadow.rs`, `renderer/shadow.rs` | `visible/shadow.rs`, `shadows.rs` |
//! | K10 | ambient, diffuse, specular at vertices, several coloured lights | `geometry/light.rs`, `geometry/lighting.rs` | `geometry/light.rs`, `geometry/lighting/tests.rs` |
//! | K10, K15 | the same at pixels, by interpolated 12-bit normals | `geometry/phong.rs`, `shade/lights.rs` | `phong.rs` |
//! | K11, P5, H8, H9 | blends, alpha, write masks, depth functions | `geometry/finish.rs`, `composite/blend/`, `visible/function.rs`, `renderer/transparent.rs` | `composite/blend/tests.rs`, `visible/function.rs`, `composite.rs` |
//! | K12 | double-buffered lines, pixel formats | `scan_out/pump.rs`, `composite/`, `renderer/frame.rs` | `scan_out.rs` |
//! | K15, H11, H12, H16 | instruction lists: form, vertices by a table, flow control | `list/`, `renderer/batch/`, `renderer/lights.rs`, `geometry/assemble/screen.rs`, `composite/listed.rs` | `list/tests.rs`, `lists.rs`, `list_screen.rs`, `list_textures.rs`, `list_looks.rs` |
//! | H13, X7 | lists are safe against any bytes, within a budget | `list/reader.rs`, `list/flow.rs`, `renderer/run.rs` | `list/tests.rs`, `list_fuzz.rs`, `list_flow.rs` |
//! | H14 | status events | `event.rs`, `renderer/run.rs` | `event.rs`, `list_flow.rs` |
//! | K14 | overlays: runs, sprites, drawables, those of lists | `composite/overlay.rs`, `composite/canvas.rs`, `composite/listed.rs`, `list/overlays.rs`, `renderer/overlay.rs` | the first of these, `output.rs`, `list_looks.rs` |
//! | H10, K12 | ordered dither, bypassed by D; rounding or cutting | `composite/dither.rs`, `composite/texels.rs` | the first of these, `output.rs` |
//! | C1, C2 | active objects are copied to the cache, and leave at once | `active/list.rs` | `active/list/tests.rs`, `cache.rs` |
//! | C3 | a hit is one comparison of a link | `link.rs` | `active/list/tests.rs` |
//! | C4 | fetched one line ahead | `active/list.rs`, `renderer/place.rs` | `cache.rs` |
//! | C5 | a full cache spills, the picture stays | `active/list.rs` | `cache.rs`, `arenas.rs`, `lines_alone.rs` |
//! | C6, C7 | a link column for each renderer, changes in the cache | `active/list.rs` | `active/list/tests.rs`, `cache.rs` |
//! | C8 | counters, memory model | `active/counts.rs`, `renderer/frame.rs` | `cache.rs`, `host-tests/src/memory_model.rs` |
//! | P4 | no colour wraps | `geometry/colour.rs`, `num/small.rs`, `composite/ramp.rs` | `stress_shapes.rs`, `stress_near.rs`, `fuzz.rs` |
//! | M3 | bounds that hold under stress | | `stress_shapes.rs` has the table of bounds; `stress_near.rs`, `stress_input.rs`, `geometry/transform.rs`, `fuzz.rs` |
//! | X1 | the same bits on every target | all | `host-tests/src/firmware/tests.rs`, `scanbeam firmware` |
//! | K16, B3 | renderers by lines or bands | `active/interleave.rs`, `renderer/relay.rs` | `cache.rs` |
//! | K17 | input queues: stall, empty, sources | `renderer/input.rs` | `input.rs` |
//! | H2 | block-fix depth | `num/block_fix.rs` | the same file, `host-tests/src/texture_report.rs` |
//! | H3-H5, K18 | perspective places along a span | `shade/texture/perspective.rs`, `corners.rs`, `num/recip_table.rs` | `shade/texture/tests.rs` |
//! | H6, H7, H17 | levels of detail, filters, formats, tables, computed textures | `shade/texture/` | `shade/texture/tests.rs`, `texels` frames of the firmware |
//! | B1, B5 | texture memory in blocks | `shade/texture/block.rs`, `cache.rs` | `host-tests/src/texture_report.rs` |
//! | B2-B4, B6 | clusters, interleave, edge functions, traversal | `model/traverse.rs`, `model/edge_function.rs` | the same files, `host-tests/src/texture_report.rs` |
//! | X2 | an error budget picks the cheapest way | `shade/texture/select.rs` | `shade/texture/tests.rs` |
//! | X6 | two cores, one scene | `renderer/relay.rs` | `cache.rs`, `examples/rp2040-two-cores` builds |
//!
//! [`list`] is a scene as data, for flash or for a ring that grows while it is drawn; a
//! [`ListRunner`] draws it.
//!
//! [`model`] is the hardware that the ideas come from, told bit for bit, to measure against.
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
mod geometry;
mod link;
pub mod list;
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
pub use composite::{
    Blender, Blending, Compositing, Cut, CutOff, DetailedTextures, Dithered, Grey8, Ink,
    LineOverlay, ListOverlays, ListTexel, ListTextures, Mix, Ordered, Overlay, PixelAlpha,
    PixelFormat, Pixels, Ranks, Rgb565, Rgb565Be, Rgb565Bytes, Rgb565Le, Rgb888, Sprite, TexelOf,
    TextureSource, Textures, Threshold, UnsortedSprites, Xrgb8888, mono_page, mono_row,
};
#[cfg(feature = "embedded-graphics")]
pub use composite::{Canvas, DrawnLines};
pub use event::{Event, EventFlags, EventSet, EventSink, Notice};
pub use geometry::{
    Affine, Assembled, Blend, Blended, Camera, CameraError, Colour, Coordinate, Cull,
    DepthFunction, DirectionalLight, Dropped, Faces, Factor, Finish, Flat, Gouraud, Light,
    Lighting, LightingModel, ListLamps, ListLighting, LitSkin, Material, MatrixRange, Mesh,
    MeshError, Object, Phong, PixelLamps, QuadSplit, Room, Scale, SceneVertex, Screen, ScreenError,
    ScreenVertex, Shading, Shadow, ShadowEdge, ShadowLight, ShadowMemory, ShadowRoom, Sphere,
    Surface,
};
pub use link::Link;
pub use num::{BlockFix16, I2F14, I2F30, U1F15, U13F3};
pub use pipeline::{
    BlockFixed, CellOf, Composited, Counted, Deferred, DetailedDepth, DrawableOf, FlatDepth,
    FlatPainter, GouraudDepth, GouraudPainter, Interpolated, ListedDepth, ObjectOf, Parts,
    PhongDepth, Pipeline, Shadowed, SkinOf, SlotOf, TexturedDepth, VertexOf, WithDepth, WordOf,
};
pub use renderer::{
    Command, Crew, DepthUse, DrawError, EightLights, FrameError, FrameStats, Input, InputError,
    InputQueue, Instance, LineDesk, LineMemory, LineRenderer, LineSource, LineWorker,
    ListCoordinate, ListLights, ListMemory, ListRunner, ListSettings, OnViolation, OneLight,
    Overlaid, PassOne, Prefetched, Relay, RendererError, RunCounts, Scene, SceneError, SceneMemory,
    ShadowError, Source, Stalled, Stream, Vertices, draw_continuous, draw_frame,
    draw_frame_changed, draw_frame_changed_runs, draw_frame_overlaid, draw_frame_overlaid_changed,
    send_changed, send_changed_runs, send_frame,
};
#[cfg(feature = "async")]
pub use renderer::{draw_frame_async, send_frame_async};
pub use shade::{
    Auto, Forward, HalfRate, Interpolation, Lamplight, Lirp10, Lirp12, Lirp16, LirpPacked, Method,
    Packed8, Packed16, PixelLights, Precision, Quality, QuarterRate,
};
pub use shade::{Levels, texture};
pub use stats::{SpanCounter, SpanCounts};
pub use visible::{BlockFixDepth, Depth32, DepthAndId, LineDepth, ShadowCell, ShadowDepth32};
