//! Frames of pipelines that differ from a preset in one choice: how depth is kept, and textures.

use crate::frames::{LINES_PER_TRANSFER, Smooth};
use crate::rooms::{Rooms, RoomsOf, SLOTS};
use scanbeam::pipeline::texture::{
    BlockCache, CacheReads, Quality, Size, Textured, Textures, Words,
};
use scanbeam::pipeline::{
    CellOf, Depth32, DepthUse, Gouraud, LineMemory, LineRenderer, Pipeline, Scene, SceneMemory,
    draw_frame,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{Pump, ScanoutDma};
use scenes::{
    BLOCK_TEXELS_B, BLOCKS_B, CachedB, CachedLookB, LookB, LookF, SCENE_B_BLOCKS, SUITE_LINES,
    SUITE_SLOTS, SceneB, Shot, Suite, TEXEL_SIDE, TEXELS_PANEL, TEXTURES_B, TEXTURES_F,
};

/// Draws a shot with another depth than 32 bits, on every line.
pub(crate) fn draw_seen<P, D>(
    shot: Shot,
    rooms: &mut RoomsOf<Smooth>,
    depth: &mut [CellOf<P>],
    pump: &mut Pump<D>,
) where
    P: Pipeline<Pixel = Rgb565Be, Shading = Gouraud>,
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let mut scene = Scene::<P>::new(
        Shot::screen(),
        SceneMemory {
            vertices: rooms.vertices,
            objects: rooms.objects,
            buckets: rooms.buckets,
        },
    );
    shot.build(&mut scene).expect("the rooms are large enough");
    let mut renderer = LineRenderer::<P>::new(LineMemory {
        slots: &mut rooms.slots[..SLOTS],
        links: rooms.links,
        depth,
    });
    renderer.set_depth_use(DepthUse::Always);
    let background = Rgb565Be::from_rgb8(shot.background());
    draw_frame(&scene, &mut renderer, pump, background, LINES_PER_TRANSFER)
        .expect("the sink cannot fail and the rooms are large enough");
}

/// Draws scene B with textures of any kind, so many lines a transfer.
pub(crate) fn draw_b<P, D>(
    how: SceneB,
    textures: P::Textures,
    rooms: &mut RoomsOf<LookB>,
    pump: &mut Pump<D>,
    lines_per_transfer: u16,
) where
    P: Pipeline<Pixel = Rgb565Be, Shading = Textured<Gouraud>, Depth = Depth32>,
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let (mut scene, mut renderer) = rooms.lend::<P>(Shot::screen(), SLOTS);
    scene.set_textures(textures);
    how.build_preset(&mut scene)
        .expect("the rooms are large enough");
    let background = Rgb565Be::from_rgb8(Shot::Sphere.background());
    draw_frame(&scene, &mut renderer, pump, background, lines_per_transfer)
        .expect("the sink cannot fail and the rooms are large enough");
}

/// Draws scene B from a texture in blocks in slow memory, through a cache of them.
#[inline(never)]
pub(crate) fn draw_b_cached<D>(rooms: &mut Rooms, pump: &mut Pump<D>)
where
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let size = Size::new(TEXEL_SIDE, TEXEL_SIDE).expect("the side is legal");
    BLOCKS_B
        .arrange(size, &TEXELS_PANEL, rooms.blocks)
        .expect("the room is large enough");
    let mut reads = CacheReads::default();
    let cache = BlockCache::new(
        Words(&*rooms.blocks),
        BLOCK_TEXELS_B,
        rooms.tags,
        rooms.cached,
        &mut reads,
    )
    .expect("the rooms are large enough");
    let textures = [CachedB::arranged(cache, size, BLOCKS_B).expect("it has its texels")];
    let (how, textured) = (SCENE_B_BLOCKS, &mut rooms.textured);
    draw_b::<CachedLookB<'_>, _>(how, Textures(&textures), textured, pump, LINES_PER_TRANSFER);
}

/// Draws a scene of the suite: 64 slots, one line a transfer.
#[inline(never)]
pub(crate) fn draw_suite<D>(suite: Suite, rooms: &mut Rooms, pump: &mut Pump<D>)
where
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    match suite {
        Suite::B | Suite::BUnlit => {
            let textures = Textures(&TEXTURES_B);
            draw_suite_textured::<LookB, _>(suite, textures, &mut rooms.textured, pump);
        }
        Suite::F => {
            let textures = Textures(&TEXTURES_F);
            draw_suite_textured::<LookF, _>(suite, textures, &mut rooms.textured, pump);
        }
        _ => {
            let (small, large) = (&mut rooms.smooth, &mut rooms.second);
            core::mem::swap(&mut small.slots, &mut large.slots);
            let (mut scene, mut renderer) = small.lend::<Smooth>(Shot::screen(), SUITE_SLOTS);
            suite.build(&mut scene).expect("the rooms are large enough");
            let background = Rgb565Be::from_rgb8(suite.background());
            draw_frame(&scene, &mut renderer, pump, background, SUITE_LINES)
                .expect("the sink cannot fail and the rooms are large enough");
            core::mem::swap(&mut small.slots, &mut large.slots);
        }
    }
}

fn draw_suite_textured<P, D>(
    suite: Suite,
    textures: P::Textures,
    rooms: &mut RoomsOf<LookB>,
    pump: &mut Pump<D>,
) where
    P: Pipeline<Pixel = Rgb565Be, Shading = Textured<Gouraud>, Depth = Depth32>,
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let (mut scene, mut renderer) = rooms.lend::<P>(Shot::screen(), SUITE_SLOTS);
    scene.set_textures(textures);
    suite
        .build_textured(Quality::Balanced, &mut scene)
        .expect("the rooms are large enough");
    let background = Rgb565Be::from_rgb8(suite.background());
    draw_frame(&scene, &mut renderer, pump, background, SUITE_LINES)
        .expect("the sink cannot fail and the rooms are large enough");
}
