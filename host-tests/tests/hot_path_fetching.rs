//! C4: what begins on the next line is fetched ahead, within so many bytes, and changes neither a pixel nor who gets a
//! slot.

use crate::common::Rng;
use crate::hot::{Corner, LineRooms, SceneRooms, camera, draw, frame, line};
use host_tests::mock::{HostLine, MockFrameBuffer};
use scanbeam::frame::{
    CacheUse, LineError, Renderer, draw_continuous, draw_frame, draw_frame_changed,
};
use scanbeam::look::Gouraud;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scan_out::{ContinuousPanel, Pump, ShownLines};
use scanbeam::scene::Scene;
use scanbeam::{Cull, Screen};

type L = Gouraud<Rgb565Be>;

const BACKGROUND: u16 = 0x1234;
const WIDTH: u16 = 40;
const HEIGHT: u16 = 75;
const RECORD: u32 = Renderer::<L, 4>::RECORD_BYTES;
const BYTES: [u32; 6] = [0, 1, RECORD + 1, RECORD + 2, 200, u32::MAX];
const SLOTS: [u16; 5] = [0, 1, 3, 9, 128];

/// Triangles of any size, of which every third begins on one of a few lines.
fn some(rng: &mut Rng, many: usize) -> Vec<[Corner; 3]> {
    (0..many)
        .map(|i| {
            let size = rng.pick(&[10, 60, 400]);
            let top = rng.within(-80, 620) / if i % 3 == 0 { 160 } else { 1 } * 3;
            [(); 3].map(|()| Corner {
                at: (rng.within(-60, 380), top + rng.within(0, size)),
                w: rng.between(1.01, 3.0),
                colour: [(); 3].map(|()| rng.below(256) as u8),
            })
        })
        .collect()
}

fn with_scene<R>(triangles: &[[Corner; 3]], see: impl FnOnce(&Scene<'_, 'static, L>) -> R) -> R {
    let mut rooms = SceneRooms::new(400, 200, HEIGHT.into(), 4);
    let mut scene = rooms.scene::<L>(Screen::new(WIDTH, HEIGHT).unwrap());
    scene.begin(&camera()).unwrap();
    if !triangles.is_empty() {
        draw(&mut scene, triangles, Cull::None).unwrap();
    }
    see(&scene)
}

/// What the cache did, but for what was fetched.
fn without_fetched(counts: CacheUse) -> CacheUse {
    CacheUse {
        fetched: 0,
        fetched_bytes: 0,
        ..counts
    }
}

/// Lines from the top: pictures and what the cache does are those of a renderer that fetches nothing, whatever is fetched
/// and in how many steps.
#[test]
fn any_bytes_and_slots_give_the_same_picture_and_the_same_hits() {
    let mut rng = Rng::new(0xFE7C);
    let mut fetched = [0; BYTES.len()];
    for round in 0..360 {
        let many = rng.pick(&[0, 1, 12, 60]);
        with_scene(&some(&mut rng, many), |scene| {
            let want = frame(scene, 128, true, BACKGROUND);
            for slots in SLOTS {
                let mut rooms = LineRooms::fitting(scene, slots, true);
                let mut renderer = rooms.renderer();
                for y in scene.lines() {
                    assert!(line(&mut renderer, scene, y, BACKGROUND) == want[usize::from(y)]);
                    assert_eq!(renderer.fetch_ahead(scene), Ok(0));
                }
                let usual = renderer.counts();
                assert_eq!(usual, without_fetched(usual));
                for (bytes, fetched) in BYTES.into_iter().zip(&mut fetched) {
                    let mut rooms = LineRooms::fitting(scene, slots, true);
                    let mut renderer = rooms.renderer().fetching(bytes);
                    let mut all = 0;
                    for y in scene.lines() {
                        for _ in 0..rng.below(3) {
                            let read = renderer.fetch_ahead(scene).unwrap();
                            assert!(read <= bytes);
                            all += read;
                        }
                        assert!(line(&mut renderer, scene, y, BACKGROUND) == want[usize::from(y)]);
                        // Once more, with what is fetched for the next.
                        if rng.below(4) == 0 {
                            all += renderer.fetch_ahead(scene).unwrap();
                            assert!(
                                line(&mut renderer, scene, y, BACKGROUND) == want[usize::from(y)]
                            );
                        }
                    }
                    let counts = renderer.counts();
                    assert_eq!(counts.fetched_bytes, all);
                    assert!(counts.fetched * RECORD <= all, "round {round}");
                    assert!(slots > 0 || counts.fetched == 0);
                    *fetched += counts.fetched;
                    if slots == 128 {
                        // Where lines are drawn twice from slow memory, they are missed twice.
                        assert_eq!(without_fetched(counts), usual);
                    }
                    let places = |c: CacheUse| [c.hits, c.spilled, c.moved_in, c.peak, c.turning];
                    assert_eq!(
                        places(counts),
                        places(usual),
                        "{bytes} bytes, {slots} slots"
                    );
                }
            }
        });
    }
    println!("{fetched:?}");
    assert_eq!(fetched[..2], [0; 2]);
    let rises = fetched[1..].windows(2).all(|two| two[0] < two[1]);
    assert!(fetched[2] > 2_000 && rises, "{fetched:?}");
}

/// Lines in any order, and of several scenes, with fetches between.
#[test]
fn lines_in_any_order_with_fetches_between() {
    let mut rng = Rng::new(0xA11);
    for _ in 0..40 {
        let [a, b] = [(); 2].map(|()| some(&mut rng, 40));
        with_scene(&a, |first| {
            with_scene(&b, |second| {
                let scenes = [first, second];
                let want = scenes.map(|scene| frame(scene, 128, true, BACKGROUND));
                let mut rooms = LineRooms::fitting(first, rng.pick(&SLOTS), true);
                rooms.links.resize(200, scanbeam::Link::EMPTY);
                let mut renderer = rooms.renderer().fetching(rng.pick(&BYTES));
                let mut y = 0;
                for _ in 0..400 {
                    let which = usize::from(rng.below(30) == 0);
                    y = match rng.below(6) {
                        0 => rng.below(HEIGHT.into()) as u16,
                        1 => y,
                        _ => (y + 1 + rng.below(3) as u16) % HEIGHT,
                    };
                    let got = line(&mut renderer, scenes[which], y, BACKGROUND);
                    assert!(got == want[which][usize::from(y)]);
                    for _ in 0..rng.below(3) {
                        renderer.fetch_ahead(scenes[which]).unwrap();
                    }
                }
            });
        });
    }
}

/// 20 triangles that begin on the first line, of which a call reads no more than it may; a side of 7 turns farther down.
#[test]
fn fetching_is_bounded_goes_on_and_is_counted() {
    let mut rng = Rng::new(5);
    let tall: Vec<_> = (0..20)
        .map(|i| {
            let left = rng.within(0, 200);
            let turn = if i < 7 { 200 } else { -30 };
            [(left, -40), (left + 90, turn), (left, 700)].map(|at| Corner {
                at,
                w: rng.between(1.01, 2.0),
                colour: [200; 3],
            })
        })
        .collect();
    with_scene(&tall, |scene| {
        let mut rooms = LineRooms::fitting(scene, 128, true);
        // What leads to the first is 2 bytes; what is left is not a record, and then it is.
        let mut renderer = rooms.renderer().fetching(RECORD + 1);
        assert_eq!(renderer.fetch_ahead(scene), Ok(2));
        assert_eq!(renderer.fetch_ahead(scene), Ok(RECORD));
        for read in 2..=20 {
            assert_eq!(renderer.fetch_ahead(scene), Ok(RECORD), "{read}");
        }
        assert_eq!(renderer.fetch_ahead(scene), Ok(0));
        let counts = renderer.counts();
        assert_eq!(
            (counts.fetched, counts.fetched_bytes),
            (20, 2 + 20 * RECORD)
        );
        assert_eq!((counts.hits, counts.set_ups), (0, 20));
        line(&mut renderer, scene, 0, BACKGROUND);
        let counts = renderer.counts();
        assert_eq!((counts.hits, counts.set_ups, counts.misses), (20, 20, 0));
        assert_eq!(counts.turning, 7);
        assert_eq!(counts.slow_read_bytes(RECORD), u64::from(27 * RECORD));
        assert_eq!(counts.slow_write_bytes(), 40);
        // Behind the last line there is nothing.
        line(&mut renderer, scene, HEIGHT - 1, BACKGROUND);
        assert_eq!(renderer.fetch_ahead(scene), Ok(0));
    });
    with_scene(&tall, |scene| {
        let mut rooms = LineRooms::fitting(scene, 128, true);
        rooms.links.truncate(3);
        let mut renderer = rooms.renderer().fetching(99);
        let (needed, have) = (20, 3);
        assert_eq!(
            renderer.fetch_ahead(scene),
            Err(LineError::Links { needed, have })
        );
    });
}

/// A panel of lines.
struct Panel(Vec<u16>);

impl ContinuousPanel for Panel {
    type Word = u16;

    fn now(&mut self) -> u32 {
        0
    }

    fn deadline(&mut self, _: u16) -> u32 {
        9
    }

    fn buffer(&mut self, line: u16) -> &mut [u16] {
        let at = usize::from(line) * usize::from(WIDTH);
        &mut self.0[at..at + usize::from(WIDTH)]
    }
}

/// Frames of all kinds fetch after each line.
#[test]
fn frames_fetch_between_lines() {
    let mut rng = Rng::new(77);
    with_scene(&some(&mut rng, 60), |scene| {
        let want = frame(scene, 128, true, BACKGROUND).concat();
        for bytes in BYTES {
            let mut rooms = LineRooms::fitting(scene, 128, true);
            let mut renderer = rooms.renderer().fetching(bytes);
            let words = 3 * usize::from(WIDTH);
            let lines = [(); 2].map(|()| HostLine::new(words));
            let mut pump = Pump::new(MockFrameBuffer::new(WIDTH, HEIGHT), lines);
            let mut all = Vec::new();
            all.push(
                draw_frame(scene, &mut renderer, &mut pump, BACKGROUND, 3)
                    .unwrap()
                    .cache,
            );
            assert!(pump.sink().frame().unwrap() == want);
            let mut sums = [0; HEIGHT as usize];
            let mut shown = ShownLines::new(&mut sums);
            let changed = draw_frame_changed(
                scene,
                &mut renderer,
                &mut pump,
                BACKGROUND,
                3,
                &mut shown,
                |_, _| {},
            );
            all.push(changed.unwrap().cache);
            let mut panel = Panel(vec![0; want.len()]);
            let (_, used) = draw_continuous(scene, &mut renderer, &mut panel, BACKGROUND).unwrap();
            assert!(panel.0 == want);
            all.push(used.cache);
            for used in all {
                assert_eq!(used.fetched > 0, bytes >= RECORD + 2, "{bytes}");
                assert_eq!(used.fetched_bytes > 0, bytes > 1);
                let objects = scene.objects() as u32;
                assert_eq!(used.hits, objects);
                if bytes == u32::MAX {
                    // All but what begins on the first line.
                    assert!(used.fetched < objects && used.fetched > objects / 2);
                }
            }
        }
    });
}
