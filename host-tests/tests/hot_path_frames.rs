//! K14, X4: frames with overlays, and frames of which what the display shows already is not sent.
//!
//! What the display shows is held against lines drawn one by one and painted over sprite by sprite.

use crate::common::Rng;
use crate::hot::{Corner, LineRooms, SceneRooms, camera, draw_with, frame};
use host_tests::mock::{Fault, HostLine, MockFrameBuffer};
use scanbeam::Cull;
use scanbeam::Screen;
use scanbeam::frame::{
    FrameError, draw_frame, draw_frame_changed, draw_frame_changed_runs, draw_frame_overlaid,
};
use scanbeam::look::Gouraud;
use scanbeam::overlay::Pixels;
use scanbeam::overlay::{Ink, Overlay, Sprite};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scan_out::{Pump, ScanError, ShownLines, ShownRuns};
use scanbeam::scene::Scene;

type L = Gouraud<Rgb565Be>;
type Mock = MockFrameBuffer<u16>;

const WIDTH: u16 = 24;
const HEIGHT: u16 = 17;
const BACKGROUND: u16 = 0x1234;

fn pump(sink: Mock, words: usize) -> Pump<Mock> {
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    pump.set_max_polls(Some(9));
    pump
}

/// What is on the picture: triangles of one colour, and bars over them.
#[derive(Clone)]
struct Content {
    triangles: Vec<[Corner; 3]>,
    bars: Vec<Sprite<'static, u16>>,
}

impl Content {
    fn new() -> Self {
        Self {
            triangles: Vec::new(),
            bars: Vec::new(),
        }
    }

    /// Adds or takes away something, or nothing.
    fn change(&mut self, rng: &mut Rng) {
        match rng.below(5) {
            0 => self.triangles.push([(); 3].map(|()| Corner {
                at: (rng.within(0, 190), rng.within(0, 130)),
                w: 1.5,
                colour: [200, 30 * rng.below(8) as u8, 80],
            })),
            1 if self.triangles.len() > 2 => {
                self.triangles.remove(0);
            }
            2 => self.bars.push(Sprite {
                x: rng.within(-3, 22) as i16,
                y: rng.within(-3, 15) as i16,
                width: 1 + rng.below(9) as u16,
                height: 1 + rng.below(5) as u16,
                pixels: Pixels::Colour(rng.below(0xFFFF) as u16),
                ink: Ink::Opaque,
            }),
            3 if self.bars.len() > 2 => {
                self.bars.remove(0);
            }
            _ => {}
        }
        self.triangles.truncate(8);
        self.bars.truncate(6);
        self.bars.sort_by_key(|bar| bar.y);
    }

    fn scene<'m>(&self, rooms: &'m mut SceneRooms) -> Scene<'m, 'static, L> {
        let mut scene = rooms.scene::<L>(Screen::new(WIDTH, HEIGHT).expect("a screen"));
        scene.begin(&camera()).expect("the rooms are large enough");
        for triangle in &self.triangles {
            draw_with(&mut scene, &[*triangle], |call| call.cull = Cull::None)
                .expect("there is room");
        }
        scene
    }

    /// The whole picture, with the bars or without.
    fn picture(&self, scene: &Scene<'_, 'static, L>, has_bars: bool) -> Vec<Vec<u16>> {
        let mut lines = frame(scene, 64, true, BACKGROUND);
        for bar in self.bars.iter().filter(|_| has_bars) {
            let Pixels::Colour(word) = bar.pixels else {
                panic!("bars have one colour");
            };
            for (y, line) in (0..).zip(&mut lines) {
                for (x, pixel) in (0..).zip(line) {
                    let (right, below) = (x - i32::from(bar.x), y - i32::from(bar.y));
                    let is_inside = (0..i32::from(bar.width)).contains(&right)
                        && (0..i32::from(bar.height)).contains(&below);
                    if is_inside {
                        *pixel = word;
                    }
                }
            }
        }
        lines
    }
}

/// Kills: an overlay that is painted before the line is drawn, or not at all.
#[test]
fn what_lies_over_a_frame_is_sent_with_it() {
    let mut rng = Rng::new(1_901);
    let mut content = Content::new();
    for _ in 0..300 {
        content.change(&mut rng);
        let mut rooms = SceneRooms::of_triangles(8, Screen::new(WIDTH, HEIGHT).expect("a screen"));
        let scene = content.scene(&mut rooms);
        let mut lent = LineRooms::fitting(&scene, 4, true);
        let mut renderer = lent.renderer();
        let mut pump = pump(Mock::new(WIDTH, HEIGHT), 4 * usize::from(WIDTH));
        let mut overlay = Overlay::<Rgb565Be>::new(&content.bars).expect("they are sorted");
        let has_bars = rng.below(4) > 0;
        let used = if has_bars {
            draw_frame_overlaid(
                &scene,
                &mut renderer,
                &mut pump,
                BACKGROUND,
                4,
                |line, pixels| overlay.paint(line, pixels),
            )
        } else {
            draw_frame(&scene, &mut renderer, &mut pump, BACKGROUND, 4)
        };
        assert_eq!(used.expect("the sink works").assembled, scene.assembled());
        let want = content.picture(&scene, has_bars).concat();
        assert_eq!(pump.sink().frame().expect("all lines are there"), want);
    }
}

/// Kills: changes of the overlay that are not told, lines that count as shown after a fault, lines sent for nothing, lines
/// that count as skipped where something is active.
#[test]
fn the_display_is_right_whatever_changes_and_fails() {
    let mut rng = Rng::new(1_902);
    let (mut arrived, mut failed, mut unsent) = (0, 0, 0);
    for round in 0..120 {
        let by_runs = round % 2 == 1;
        let band = 1 + rng.below(5) as u16;
        let words = usize::from(WIDTH * band);
        let mut sink = pump(Mock::new(WIDTH, HEIGHT).late_by(rng.below(4)), words);
        let mut hashes = [0; HEIGHT as usize];
        let mut lines = ShownLines::new(&mut hashes);
        let mut cells = [0; 6 * (HEIGHT as usize + 1)];
        let mut runs = ShownRuns::new(&mut cells, WIDTH, 4, 1);
        let mut content = Content::new();
        let mut last: Option<Vec<Vec<u16>>> = None;
        for _ in 0..30 {
            content.change(&mut rng);
            let mut rooms =
                SceneRooms::of_triangles(8, Screen::new(WIDTH, HEIGHT).expect("a screen"));
            let scene = content.scene(&mut rooms);
            let want = content.picture(&scene, true);
            let mut lent = LineRooms::fitting(&scene, 4, true);
            let mut renderer = lent.renderer();
            let mut is_empty = |line: u16| {
                let mut pixels = [0; WIDTH as usize];
                let drawn = renderer.draw_line(&scene, line, &mut pixels, BACKGROUND);
                !drawn.expect("there is memory")
            };
            let skipped = scene.lines().filter(|line| is_empty(*line)).count();
            let mut overlay = Overlay::<Rgb565Be>::new(&content.bars).expect("they are sorted");
            sink.sink_mut().clear_fault();
            if rng.below(4) == 0 {
                let at = rng.below(HEIGHT.into()) as u16;
                let faults = [
                    Fault::Begin,
                    Fault::Start,
                    Fault::Poll,
                    Fault::Hang,
                    Fault::Lose,
                ];
                sink.sink_mut().fail_at(at, rng.pick(&faults));
            }
            sink.sink_mut().next_frame();
            let renderer = &mut renderer;
            let overlay = |line, pixels: &mut [u16]| overlay.paint(line, pixels);
            let used = if by_runs {
                let runs = &mut runs;
                draw_frame_changed_runs(
                    &scene, renderer, &mut sink, BACKGROUND, band, runs, overlay,
                )
            } else {
                let lines = &mut lines;
                draw_frame_changed(
                    &scene, renderer, &mut sink, BACKGROUND, band, lines, overlay,
                )
            };
            match used {
                Ok(used) => {
                    let shown: Vec<_> = want.concat().into_iter().map(Some).collect();
                    assert_eq!(sink.sink().shown(), shown);
                    assert_eq!(used.lines_skipped as usize, skipped);
                    if let Some(last) = &last {
                        let same = want.iter().zip(last).filter(|(a, b)| a == b).count();
                        assert_eq!(used.scan_out.lines_unsent as usize, same);
                        if !by_runs {
                            let bytes = 2 * same * usize::from(WIDTH);
                            assert_eq!(used.scan_out.bytes_unsent, bytes as u64);
                        }
                    }
                    unsent += used.scan_out.lines_unsent;
                    arrived += 1;
                    last = Some(want);
                }
                Err(error) => {
                    failed += 1;
                    last = None;
                    if let FrameError::ScanOut(ScanError::BufferLost { .. }) = error {
                        let (display, _) = sink.release();
                        sink = pump(display, words);
                    }
                }
            }
        }
    }
    println!("{arrived} arrived, {failed} failed, {unsent} lines not sent");
    assert!(arrived > 2_000 && failed > 200 && unsent > 10_000);
}
