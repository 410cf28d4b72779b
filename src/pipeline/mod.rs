//! Scenes whose choices are types: one type parameter says which method does each step.
//!
//! What a program does not choose has no code and no bytes. What is here and not yet in [`scene`](crate::scene),
//! [`look`](crate::look) and [`frame`](crate::frame): alpha of vertices, fetching ahead, counters of pixels. For all else
//! these draw in half to two thirds of the instructions.
//!
//! | preset | shading | depth | pixel | interpolation |
//! |---|---|---|---|---|
//! | [`GouraudDepth`] | [`Gouraud`] | [`Depth32`] | any | [`Packed8`] |
//! | [`FlatDepth`] | [`Flat`] | [`Depth32`] | any | none is needed |
//! | [`GouraudPainter`] | [`Gouraud`] | none: drawn in order of submission | any | [`Packed8`] |
//! | [`FlatPainter`] | [`Flat`] | none: drawn in order of submission | any | none is needed |
//! | [`TexturedDepth`] | [`Gouraud`] times a texture | [`Depth32`] | any | forward |
//! | [`DetailedDepth`] | [`Gouraud`] times a texture in levels of detail | [`Depth32`] | any | forward |
//! | [`Composited`] | as the preset it wraps | | any | surfaces have a finish |
//! | [`Counted`] | as the preset it wraps | | counts spans and pixels | |
//! | [`BlockFixed`] | as the preset it wraps | [`BlockFixDepth`]: 16 bits | | |
//! | [`Worded`] | as the preset it wraps | [`DepthAndColour`]: 16 bits, in one word with the pixel | | |
//! | [`Deferred`] | as the preset it wraps | [`DepthAndId`]: the same picture, each pixel shaded once | | |
//! | [`Interpolated`] | as the preset it wraps | | | any |

pub mod blend;
pub mod parallel;
pub mod send;
pub mod texture;

pub use crate::active::Slot;
use crate::composite::{
    Blending, Compositing, DetailedTextures, PixelFormat, TextureSource, Textures,
};
use crate::geometry::Blended;
use crate::geometry::texturing::{LevelEnds, Textured};
pub use crate::geometry::{Empty, Filed, Flat, Gouraud, Object, Scale, SceneVertex, Shading};
pub use crate::num::BlockFix16;
pub use crate::renderer::{
    DepthUse, DrawError, FrameError, FrameStats, Instance, LineMemory, LineRenderer, RendererError,
    Scene, SceneError, SceneMemory, draw_frame,
};
pub use crate::shade::{
    Auto, Forward, HalfRate, Interpolation, Levels, Lirp10, Lirp12, Lirp16, LirpPacked, Method,
    Packed8, Packed16, Precision, Quality, QuarterRate,
};
use crate::stats::{SpanCounter, SpanCounts};
pub use crate::visible::{
    BlockFixDepth, Depth32, DepthAndColour, DepthAndId, DepthCell, LineDepth,
};
use core::marker::PhantomData;

/// The choices of a renderer, made at compile time: what is not chosen has no code and no bytes.
pub trait Pipeline {
    /// What colours an object carries.
    type Shading: Shading<Levels: Levels>;
    /// How hidden surfaces are found.
    type Depth: LineDepth;
    /// What a pixel looks like in the line buffer.
    type Pixel: PixelFormat;
    /// Whether spans and pixels are counted: [`SpanCounts`] or `()`.
    type Counter: SpanCounter;
    /// How colours are taken from pixel to pixel.
    type Interpolation: Interpolation;
    /// Textures lent to a scene: [`Textures`], or `()` for none.
    type Textures: TextureSource<Self::Pixel>;
    /// Whether surfaces are composited by their finish: [`Blending`], or `()` where all are
    /// opaque. Shadings that are [`Blended`] have one.
    type Compositing: Compositing;
}

/// A pipeline by its parts.
#[derive(Clone, Copy, Debug)]
pub struct Parts<S, D, F, C = (), I = Packed8, X = (), B = ()>(
    PhantomData<(S, D, F, C, I)>,
    PhantomData<(X, B)>,
);

impl<S, D, F, C, I, X, B> Pipeline for Parts<S, D, F, C, I, X, B>
where
    S: Shading<Levels: Levels>,
    D: LineDepth,
    F: PixelFormat,
    C: SpanCounter,
    I: Interpolation,
    X: TextureSource<F>,
    B: Compositing,
{
    type Shading = S;
    type Depth = D;
    type Pixel = F;
    type Counter = C;
    type Interpolation = I;
    type Textures = X;
    type Compositing = B;
}

/// Colours linear between vertices, 32-bit depth.
pub type GouraudDepth<F> = Parts<Gouraud, Depth32, F>;
/// One colour a face, 32-bit depth.
pub type FlatDepth<F> = Parts<Flat, Depth32, F>;
/// Colours linear between vertices, later objects over earlier ones.
pub type GouraudPainter<F> = Parts<Gouraud, (), F>;
/// One colour a face, later objects over earlier ones.
pub type FlatPainter<F> = Parts<Flat, (), F>;
/// Colours linear between vertices times textures `T`, 32-bit depth; see [`Scene::set_textures`].
///
/// [`Scene::set_textures`]: crate::pipeline::Scene::set_textures
pub type TexturedDepth<'t, F, T> =
    Parts<Textured<Gouraud>, Depth32, F, (), Packed8, Textures<'t, T>>;
/// The same with textures in levels of detail.
pub type DetailedDepth<'t, F, T> =
    Parts<Textured<Gouraud, LevelEnds>, Depth32, F, (), Packed8, DetailedTextures<'t, T>>;
/// The pipeline `P`, and surfaces have a finish: some may be transparent.
pub type Composited<P> = Parts<
    Blended<<P as Pipeline>::Shading>,
    <P as Pipeline>::Depth,
    <P as Pipeline>::Pixel,
    <P as Pipeline>::Counter,
    <P as Pipeline>::Interpolation,
    <P as Pipeline>::Textures,
    Blending,
>;
/// The pipeline `P`, and its spans and pixels are counted.
pub type Counted<P> = Parts<
    <P as Pipeline>::Shading,
    <P as Pipeline>::Depth,
    <P as Pipeline>::Pixel,
    SpanCounts,
    <P as Pipeline>::Interpolation,
    <P as Pipeline>::Textures,
    <P as Pipeline>::Compositing,
>;
/// The pipeline `P`, with 16 bits of block-fix depth (H2).
pub type BlockFixed<P> = WithDepth<P, BlockFixDepth>;
/// The pipeline `P`, with 16 bits of depth in one word with the pixel (K8).
pub type Worded<P> = WithDepth<P, DepthAndColour>;
/// The pipeline `P`, which shades no pixel before it is known whose it is (X3).
pub type Deferred<P> = WithDepth<P, DepthAndId>;
/// The pipeline `P`, with the depth `D`.
pub type WithDepth<P, D> = Parts<
    <P as Pipeline>::Shading,
    D,
    <P as Pipeline>::Pixel,
    <P as Pipeline>::Counter,
    <P as Pipeline>::Interpolation,
    <P as Pipeline>::Textures,
    <P as Pipeline>::Compositing,
>;
/// The pipeline `P`, with colours by the method `I`.
pub type Interpolated<P, I> = Parts<
    <P as Pipeline>::Shading,
    <P as Pipeline>::Depth,
    <P as Pipeline>::Pixel,
    <P as Pipeline>::Counter,
    I,
    <P as Pipeline>::Textures,
    <P as Pipeline>::Compositing,
>;

/// The word of a pipeline's pixels.
pub type WordOf<P> = <<P as Pipeline>::Pixel as PixelFormat>::Word;
/// A triangle read back from a scene of a pipeline.
pub type FiledOf<P> = crate::geometry::Filed<
    <<P as Pipeline>::Shading as Shading>::Vertex,
    <<P as Pipeline>::Shading as Shading>::Face,
>;
/// The vertex record of a pipeline.
pub type VertexOf<P> = crate::geometry::SceneVertex<<<P as Pipeline>::Shading as Shading>::Vertex>;
/// The object record of a pipeline.
pub type ObjectOf<P> = crate::geometry::Object<<<P as Pipeline>::Shading as Shading>::Face>;
/// The cache slot of a pipeline.
pub type SlotOf<P> = crate::active::Slot<DrawableOf<P>>;
/// An object of a pipeline, set up for drawing.
pub type DrawableOf<P> = crate::geometry::Drawable<LevelsOf<P>>;
/// What a mesh of a pipeline brings beside its colours.
pub type SkinOf<'a, P> = <<P as Pipeline>::Shading as Shading>::Skin<'a>;
/// What an object of a pipeline is coloured by.
pub type LevelsOf<P> = <<P as Pipeline>::Shading as Shading>::Levels;
/// The depth cell of a pipeline.
pub type CellOf<P> = <<P as Pipeline>::Depth as LineDepth>::Cell;
