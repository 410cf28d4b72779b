//! Textures: how texels lie in memory, how they are found along a span, and what a pipeline that
//! has some is lent.

pub use crate::composite::{DetailedTextures, TexelOf, TextureSource, Textures};
pub use crate::shade::texture::{
    Address, AllSeen, Bilinear, BlockCache, BlockRun, BlockRuns, Blocked, Budget, CacheError,
    CacheReads, Checker, Clamp, Corner, Corners, Detail, FRACTION, Fetch, Gradient, Homogeneous,
    Indexed, LEVELS, Layout, Level, LevelEnds, Levels, Linear, MAX_SIDE, Mirror, PaintRun, Period,
    PerspectiveSpan, Quality, Rgb565Texel, Rgb888Texel, Rgba5551, Rgba8871, Rgbd5551, Size, Skin,
    Square, Square64, Square128, Square256, Store, Stride, Texel, TexelFormat, Texels, Texture,
    TextureError, TexturePlanes, Textured, Uv, Whole, Words, Wrap, build_level, level_words,
};
