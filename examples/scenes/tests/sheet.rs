//! Every pixel of a random sheet is hit exactly once (K4); the firmware asks the same in QEMU.

use scanbeam::frame::{FastMemory, Memory as LineMemory};
use scanbeam::scene::{DrawState, Memory, Object, Vertex};
use scanbeam::{Link, Renderer, Scene};
use scenes::{Hits, SHEET_TRIANGLES, SHEETS, Sheet, Shot, SmoothLook};

/// Kills: a side that turns a line late (`turn` in `span/triangle.rs`).
#[test]
fn every_pixel_of_a_sheet_is_hit_once() {
    let mut vertices = vec![Vertex::EMPTY; SHEET_TRIANGLES];
    let mut objects = vec![Object::EMPTY; SHEET_TRIANGLES];
    let mut bins = vec![0; 240];
    let mut draws = [DrawState::EMPTY];
    let mut cache = Box::new(FastMemory::<SmoothLook>::new());
    let mut links = vec![Link::EMPTY; SHEET_TRIANGLES];
    for slots in [64, 16] {
        cache.set_limit(slots);
        for seed in 1..=SHEETS {
            let memory = Memory {
                vertices: &mut vertices,
                places: &mut [],
                objects: &mut objects,
                bins: &mut bins,
                draws: &mut draws,
            };
            let mut scene = Scene::new(Shot::screen(), memory);
            let mut renderer = Renderer::new(LineMemory {
                cache: &mut cache,
                links: &mut links,
                depth: &mut [],
            });
            let hits = Sheet::new(seed).hits(&mut scene, &mut renderer);
            let once = Hits {
                hits: Sheet::pixels(),
                missed: 0,
                left_out: 0,
            };
            assert_eq!(hits, Ok(once), "seed {seed}");
        }
    }
}
