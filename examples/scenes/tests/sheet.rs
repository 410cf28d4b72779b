//! Every pixel of a random sheet is hit exactly once (K4); the firmware asks the same in QEMU.

use scanbeam::Link;
use scanbeam::pipeline::{LineMemory, LineRenderer, ObjectOf, Scene, SceneMemory, VertexOf};
use scenes::{SHEET_TRIANGLES, SHEETS, Sheet, SheetPipeline, Shot};

#[test]
fn every_pixel_of_a_sheet_is_hit_once() {
    let mut vertices = vec![VertexOf::<SheetPipeline>::empty(); SHEET_TRIANGLES];
    let mut objects = vec![ObjectOf::<SheetPipeline>::default(); SHEET_TRIANGLES];
    let mut buckets = vec![Link::NONE; 240];
    let mut slots = vec![LineRenderer::<SheetPipeline>::empty_slot(); 16];
    let mut links = vec![Link::NONE; SHEET_TRIANGLES];
    let mut depth = [(); 320];
    for seed in 1..=SHEETS {
        let mut scene = Scene::new(
            Shot::screen(),
            SceneMemory {
                vertices: &mut vertices,
                objects: &mut objects,
                buckets: &mut buckets,
            },
        );
        let mut renderer = LineRenderer::new(LineMemory {
            slots: &mut slots,
            links: &mut links,
            depth: &mut depth,
        });
        let hits = Sheet::new(seed).hits(&mut scene, &mut renderer);
        assert_eq!(hits, Some((Sheet::pixels(), 0)), "seed {seed}");
    }
}
