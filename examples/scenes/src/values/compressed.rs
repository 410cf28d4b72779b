//! Floors and cubes of texels of 4 bits: through a cache that is loaded ahead, mixed, texel by texel, and with holes (H7).

use super::sampled::{cube, floor};
use super::scenes::draw_all;
use crate::ShotError;
use crate::looks::TexturedLook;
use scanbeam::scene::{BlockCache, CacheWord, Compressed, Sampling, Scene, Texture};

/// Texels a side of [`STONE`].
const STONE_SIDE: u32 = 64;

/// Slabs of stone: made by the compressor of the host tools, whose tests make it anew and compare.
pub static STONE: Compressed<'static> = match Compressed::new(
    include_bytes!("../../stone.bc1"),
    STONE_SIDE,
    STONE_SIDE,
    u16::to_be,
) {
    Ok(stone) => stone,
    Err(_) => panic!("as many blocks as the sides need"),
};

/// Leaves with nothing between them, likewise.
static LEAVES: Compressed<'static> =
    match Compressed::new(include_bytes!("../../leaves.bc1"), 32, 32, u16::to_be) {
        Ok(leaves) => leaves.keyed(0xF81F_u16.to_be()),
        Err(_) => panic!("as many blocks as the sides need"),
    };

/// Rows of texels that the cache has room for: two of blocks.
const ROWS: u32 = 8;

/// Fast memory.
pub(super) type Words = [CacheWord; (STONE_SIDE * ROWS) as usize];

/// None yet.
pub(super) const fn empty() -> Words {
    [const { CacheWord::new() }; (STONE_SIDE * ROWS) as usize]
}

/// A cache of the stone, of which as much is there as there is room for.
pub(super) fn cache(words: &mut Words) -> Result<BlockCache<'_>, ShotError> {
    let cache = BlockCache::compressed(STONE, words).map_err(ShotError::Cache)?;
    let loaded = cache.load(0..STONE_SIDE, 0..ROWS, u32::MAX);
    loaded.map_err(ShotError::Cache)?;
    Ok(cache)
}

/// The textures: through the cache, through it and mixed, alone, and with holes.
pub(super) fn pressed<'t>(cache: &'t BlockCache<'_>) -> Result<[Texture<'t>; 4], ShotError> {
    let mixed = cache.texture().sampled(Sampling::LINEAR, &[]);
    Ok([
        cache.texture(),
        mixed.map_err(ShotError::Texture)?,
        STONE.texture(),
        LEAVES.texture(),
    ])
}

/// Makes the scene.
pub(super) fn compressed<'t>(
    scene: &mut Scene<'_, 't, TexturedLook>,
    [cached, mixed, alone, holes]: &'t [Texture<'t>; 4],
) -> Result<(), ShotError> {
    let calls = [
        floor(cached, -6.0),
        floor(holes, 6.0),
        cube(mixed, 0.5, [-0.1, 0.0, 1.2]),
        cube(alone, 0.9, [0.8, 0.2, 0.8]),
        cube(holes, 0.2, [-0.7, 0.3, 0.6]),
    ];
    draw_all(scene, &calls)
}
