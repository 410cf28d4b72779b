//! Lines that the display shows already are not sent, and it always shows the right picture (X4, M4).

use crate::common::changes::{
    self, Lines, Look, Mock, Picture, begun, buffers, camera, change, recovered, some_fault,
};
use crate::common::{LineRooms, Rng, SceneRooms};
use scanbeam::pipeline::send::{draw_frame_changed, send_changed};
use scanbeam::pipeline::{Instance, draw_frame};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{Pump, ScanStats, ShownLines};
use scanbeam::{Affine, Screen};

const WIDTH: u16 = 5;
const HEIGHT: u16 = 23;

/// Random changes of random pictures, through sinks of each sort that fail in each way: whenever
/// a frame is said to have arrived, the display shows it, every line of it.
#[test]
fn the_display_is_right_after_any_sequence_of_frames_and_faults() {
    let mut rng = Rng::new(0xC4A6_ED11);
    let mut rooms = SceneRooms::<Look>::new(8, 8, HEIGHT.into());
    let scene = begun(&mut rooms, WIDTH, HEIGHT);
    let (mut arrived, mut failed, mut unsent) = (0, 0, 0);
    for _ in 0..400 {
        let mut sink = Mock::new(WIDTH, HEIGHT).late_by(rng.below(4));
        if rng.below(2) == 0 {
            sink = sink.chained();
        }
        let band = 1 + rng.below(HEIGHT.into()) as u16;
        let words = usize::from(WIDTH * band);
        let mut pump = changes::pump(sink, words);
        let mut hashes = [0; HEIGHT as usize];
        let mut shown = ShownLines::new(&mut hashes);
        let mut picture = vec![vec![0u16; WIDTH.into()]; HEIGHT.into()];
        // What the display shows, if the last frame arrived.
        let mut last: Option<Picture> = None;
        for _ in 0..40 {
            change(&mut rng, &mut picture);
            let mut source = Lines {
                picture: &picture,
                fails_at: None,
            };
            let at = rng.below(HEIGHT.into()) as u16;
            pump.sink_mut().clear_fault();
            if let Some(fault) = some_fault(&mut rng, 2) {
                pump.sink_mut().fail_at(at, fault);
            } else if rng.below(6) == 0 {
                source.fails_at = Some(at);
            }
            pump.sink_mut().next_frame();
            match send_changed(&scene, &mut source, &mut pump, band, &mut shown) {
                Ok(stats) => {
                    let want: Vec<_> = picture.iter().flatten().copied().map(Some).collect();
                    assert_eq!(pump.sink().shown(), want);
                    let all = 2 * u64::from(WIDTH * HEIGHT);
                    assert_eq!(stats.bytes_sent + stats.bytes_unsent, all);
                    if let Some(last) = &last {
                        let same = picture.iter().zip(last).filter(|(a, b)| a == b).count();
                        assert_eq!(stats.lines_unsent as usize, same);
                    }
                    last = Some(picture.clone());
                    arrived += 1;
                    unsent += stats.lines_unsent;
                }
                Err(error) => {
                    last = None;
                    failed += 1;
                    pump = recovered(pump, &error, words);
                }
            }
        }
    }
    println!("{arrived} frames arrived, {failed} failed, {unsent} lines not sent");
    assert!(arrived > 5_000 && failed > 2_000 && unsent > 50_000);
}

/// Each run of changed lines has windows of its own; nothing changed: not even a window is opened.
#[test]
fn windows_begin_anew_at_each_run_of_changed_lines() {
    let mut rooms = SceneRooms::<Look>::new(8, 8, HEIGHT.into());
    let scene = begun(&mut rooms, WIDTH, HEIGHT);
    let mut pump = Pump::new(Mock::new(WIDTH, HEIGHT).late_by(2), buffers(4 * 5));
    let mut hashes = [0; HEIGHT as usize];
    let mut shown = ShownLines::new(&mut hashes);
    let mut picture = vec![vec![7u16; WIDTH.into()]; HEIGHT.into()];
    let mut send = |picture: &Picture| {
        pump.sink_mut().next_frame();
        let before = pump.sink().windows();
        let mut source = Lines {
            picture,
            fails_at: None,
        };
        let stats = send_changed(&scene, &mut source, &mut pump, 4, &mut shown).unwrap();
        (stats, pump.sink().windows() - before)
    };
    let (stats, windows) = send(&picture);
    assert_eq!((stats.lines_unsent, windows), (0, 6)); // 23 lines, 4 a transfer
    let (stats, windows) = send(&picture);
    assert_eq!((stats.lines_unsent, windows), (23, 0));
    assert_eq!((stats.bytes_sent, stats.bytes_unsent), (0, 230));
    for line in [0, 5, 6, 7, 8, 9, 22] {
        picture[line][3] += 1;
    }
    let (stats, windows) = send(&picture);
    let want = ScanStats {
        bytes_sent: 70,
        transfers: 4, // 0, 5 to 8, 9, 22
        lines_unsent: 16,
        bytes_unsent: 160,
        ..stats
    };
    assert_eq!((stats, windows), (want, 4));
}

/// A cube that stands still is sent once, another background sends all lines again, and a cube
/// that turns sends its lines alone.
#[test]
fn a_scene_sends_what_moves() {
    let (width, height) = (40, 48);
    let mut rooms = SceneRooms::<Look>::new(64, 64, height.into());
    let mut scene = rooms.scene(Screen::new(width, height).unwrap());
    let mut lines = LineRooms::<Look>::new(8, 64, width.into());
    let mut renderer = lines.renderer();
    let words = usize::from(width) * 8;
    let mut pump = Pump::new(Mock::new(width, height).late_by(1), buffers(words));
    let mut all = Pump::new(Mock::new(width, height), buffers(words));
    let mut hashes = [0; 48];
    let mut shown = ShownLines::new(&mut hashes);
    let mut frame = |angle: f32, level: u8| {
        scene.begin(&camera()).unwrap();
        let instance = Instance {
            model: Affine::rotation_y(angle),
            ..Instance::default()
        };
        scene.draw(&scenes::CUBE, &instance).unwrap();
        let background = Rgb565Be::from_rgb8([level; 3]);
        pump.sink_mut().next_frame();
        let stats = draw_frame_changed(&scene, &mut renderer, &mut pump, background, 8, &mut shown)
            .unwrap();
        let whole = draw_frame(&scene, &mut renderer, &mut all, background, 8).unwrap();
        assert_eq!(pump.sink().shown(), all.sink().shown());
        assert_eq!(whole.scan_out.lines_unsent, 0);
        assert_eq!(stats.scanlines_skipped, whole.scanlines_skipped);
        (stats.scan_out.lines_unsent, stats.scanlines_skipped)
    };
    let (unsent, empty) = frame(0.2, 0);
    assert_eq!(unsent, 0);
    assert!(empty > 5 && empty < 40);
    assert_eq!(frame(0.2, 0).0, 48);
    assert_eq!(frame(0.2, 200).0, 0);
    let (unsent, empty) = frame(0.9, 200);
    assert!(unsent >= empty.min(5) && unsent < 40, "{unsent}");
}
