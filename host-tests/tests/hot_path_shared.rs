//! Two threads draw one frame: its bits are those of one renderer, and whatever fails, both come out of it and
//! the next frame is whole. And frames that are awaited, or fed to a panel with a clock of its own.

use crate::common::Rng;
use crate::hot::{Corner, LineRooms, SceneRooms, camera, draw, frame};
use host_tests::mock::{Fault, HostLine, MockFrameBuffer};
use scanbeam::frame::{
    Desk, FrameError, LineError, Peer, Relay, draw_continuous, draw_frame, draw_frame_async,
    draw_frame_shared,
};
use scanbeam::look::Gouraud;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scan_out::{
    AsyncLineWriter, AsyncPump, ContinuousPanel, ErrorKind, Pump, ScanError, Window,
};
use scanbeam::scene::Scene;
use scanbeam::{Cull, Screen};
use std::sync::atomic::{AtomicUsize, Ordering};
use std::task::{Context, Poll, Waker};

type L = Gouraud<Rgb565Be>;
type Sent = Result<Vec<u16>, FrameError<host_tests::mock::MockError>>;
const BACKGROUND: u16 = 0x1234;
const WIDTH: u16 = 48;
const HEIGHT: u16 = 40;
/// Waits after which a test that hangs ends.
const PATIENCE: usize = 20_000_000;

fn screen() -> Screen {
    Screen::new(WIDTH, HEIGHT).unwrap()
}

/// Scenes for frames one after the other: of the whole picture, of a part of it alone, of two parts with nothing
/// between them, of nothing.
fn scenes<'m>(rng: &mut Rng, rooms: &'m mut [SceneRooms]) -> Vec<Scene<'m, 'static, L>> {
    let mut made = Vec::new();
    for rooms in rooms {
        let mut scene = rooms.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        let parts = rng.pick(&[[(-60, 380); 2], [(100, 200); 2], [(0, 90), (230, 320)]]);
        let mut triangles = Vec::new();
        for number in 0..triangles_of(made.len()) {
            let (top, bottom) = parts[number % 2];
            let mut corner = || Corner {
                at: (rng.within(-60, 440), rng.within(top, bottom)),
                w: rng.between(1.01, 2.0),
                colour: [(); 3].map(|()| rng.below(256) as u8),
            };
            triangles.push([corner(), corner(), corner()]);
        }
        if !triangles.is_empty() {
            draw(&mut scene, &triangles, Cull::None).unwrap();
        }
        made.push(scene);
    }
    made
}

/// Triangles of a scene, by its number.
fn triangles_of(scene: usize) -> usize {
    [12, 1, 0, 30][scene % 4]
}

fn rooms(count: usize) -> Vec<SceneRooms> {
    (0..count)
        .map(|_| SceneRooms::new(300, 100, HEIGHT.into(), 4))
        .collect()
}

fn bits(scene: &Scene<'_, '_, L>) -> Vec<u16> {
    frame(scene, 16, true, BACKGROUND).concat()
}

/// What a run of frames is to meet.
struct Run {
    band: u16,
    buffers: usize,
    /// Words of a relay's buffer.
    words: usize,
    /// Links that the renderers lack: of the desk's core and of the worker's.
    lacks: [usize; 2],
    fault: Option<(u16, Fault)>,
    per_transfer: u16,
}

const USUAL: Run = Run {
    band: 4,
    buffers: 5,
    words: WIDTH as usize,
    lacks: [0; 2],
    fault: None,
    per_transfer: 3,
};

/// Draws a frame of each scene by two threads; what came of each, and the lines that the worker set triangles up on.
/// A frame begins when the worker has asked, so that it gets lines.
fn run(scenes: &[Scene<'_, 'static, L>], run: &Run) -> (Vec<Sent>, u32) {
    let largest = scenes.iter().max_by_key(|scene| scene.objects()).unwrap();
    let mut lines = run.lacks.map(|lacks| {
        let mut lines = LineRooms::fitting(largest, 6, true);
        lines
            .links
            .truncate(lines.links.len().saturating_sub(lacks));
        lines
    });
    let [near, far] = &mut lines;
    let mut relay = Relay::<_, 6>::new((0..run.buffers).map(|_| HostLine::<u16>::new(run.words)));
    let (mut worker, mut desk) = relay.split();
    desk.set_band(run.band);
    let mut sink = MockFrameBuffer::new(WIDTH, HEIGHT).late_by(2);
    if let Some((line, fault)) = run.fault {
        sink.fail_at(line, fault);
    }
    let words = usize::from(WIDTH * run.per_transfer);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let (asked, waits) = (AtomicUsize::new(0), AtomicUsize::new(0));
    let woken = AtomicUsize::new(0);
    let wait = || {
        std::thread::yield_now();
        waits.fetch_add(1, Ordering::Relaxed) < PATIENCE
    };
    std::thread::scope(|threads| {
        let (asked, wait) = (&asked, &wait);
        let helps = threads.spawn(move || {
            let (mut renderer, mut set_ups) = (far.renderer(), 0);
            for (number, scene) in scenes.iter().enumerate() {
                let wake = || asked.store(number + 1, Ordering::Release);
                let peer = Peer { wait, wake: &wake };
                assert!(
                    worker.help(scene, &mut renderer, BACKGROUND, peer),
                    "given up"
                );
                let counts = renderer.counts();
                assert!(scene.objects() > 0 || counts.set_ups == 0);
                set_ups += counts.set_ups;
            }
            set_ups
        });
        let (mut renderer, mut frames) = (near.renderer(), Vec::new());
        for (number, scene) in scenes.iter().enumerate() {
            while asked.load(Ordering::Acquire) <= number && wait() {}
            let wake = || {
                woken.fetch_add(1, Ordering::Relaxed);
            };
            let peer = Peer { wait, wake: &wake };
            let sent = draw_frame_shared(
                scene,
                &mut renderer,
                &mut desk,
                &mut pump,
                BACKGROUND,
                run.per_transfer,
                peer,
            );
            let shown = pump.sink().frame();
            frames.push(sent.map(|_| shown.expect("a frame that was sent is whole")));
            // Each frame's end is told. Kills: answers that wake nobody.
            assert!(woken.swap(0, Ordering::Relaxed) > 0, "frame {number}");
        }
        (frames, helps.join().expect("the worker was not given up"))
    })
}

#[test]
fn two_threads_draw_what_one_does() {
    let mut rng = Rng::new(611);
    let mut helped = 0;
    for round in 0..60 {
        let mut rooms = rooms(8);
        let scenes = scenes(&mut rng, &mut rooms);
        let how = Run {
            band: rng.pick(&[1, 2, 4, 9, 100]),
            buffers: rng.pick(&[1, 2, 5]),
            words: usize::from(WIDTH) + rng.pick(&[0, 7]),
            per_transfer: rng.pick(&[1, 3, 40]),
            ..USUAL
        };
        let (frames, set_ups) = run(&scenes, &how);
        for (number, (sent, scene)) in frames.into_iter().zip(&scenes).enumerate() {
            assert!(
                sent.unwrap() == bits(scene),
                "round {round}, frame {number}"
            );
        }
        helped += set_ups;
    }
    assert!(helped > 2_000, "the worker had {helped} triangles alone");
}

#[test]
fn without_buffers_the_desk_draws_alone() {
    let mut rooms = rooms(4);
    let scenes = scenes(&mut Rng::new(612), &mut rooms);
    let how = Run {
        buffers: 0,
        ..USUAL
    };
    let (frames, set_ups) = run(&scenes, &how);
    for (sent, scene) in frames.into_iter().zip(&scenes) {
        assert_eq!(sent.unwrap(), bits(scene));
    }
    assert_eq!(set_ups, 0);
}

#[test]
fn a_sink_that_fails_ends_the_frame_for_both() {
    let faults = [Fault::Begin, Fault::Start, Fault::Poll, Fault::End];
    for (seed, fault) in (613..).zip(faults) {
        for (line, buffers) in [(0, 1), (1, 5), (13, 1), (20, 5), (38, 1), (39, 5)] {
            let mut rooms = rooms(4);
            let scenes = scenes(&mut Rng::new(seed), &mut rooms);
            let how = Run {
                fault: Some((line, fault)),
                buffers,
                ..USUAL
            };
            let (frames, _) = run(&scenes, &how);
            for (number, (sent, scene)) in frames.into_iter().zip(&scenes).enumerate() {
                if number == 0 {
                    let error = sent.expect_err("the sink fails once");
                    let FrameError::ScanOut(ScanError::Sink { error, .. }) = error else {
                        panic!("{fault:?} at line {line}: {error:?}");
                    };
                    assert_eq!(error.kind, ErrorKind::Bus);
                } else {
                    assert!(sent.unwrap() == bits(scene), "{fault:?} {line}, {number}");
                }
            }
        }
    }
}

#[test]
fn memory_that_is_too_short_ends_the_frame_for_both() {
    let mut rooms = rooms(4);
    let scenes = scenes(&mut Rng::new(617), &mut rooms);
    let most = scenes.iter().map(Scene::objects).max().unwrap();
    for (lacks, words) in [([1, 0], 48), ([0, 1], 48), ([0, 0], 47), ([0, 0], 0)] {
        let how = Run {
            lacks,
            words,
            ..USUAL
        };
        let (frames, _) = run(&scenes, &how);
        let links = LineError::Links {
            needed: most,
            have: most - 1,
        };
        let pixels = LineError::Pixels {
            needed: 48,
            have: words,
        };
        let mut failed = 0;
        for (sent, scene) in frames.into_iter().zip(&scenes) {
            match sent {
                Ok(sent) => assert!(sent == bits(scene), "{lacks:?} {words}"),
                Err(FrameError::Line(error)) => {
                    assert_eq!(error, if words < 48 { pixels } else { links });
                    failed += 1;
                }
                Err(error) => panic!("{lacks:?} {words}: {error:?}"),
            }
        }
        // Three scenes have triangles; of them only the largest wants all links.
        assert_eq!(failed, if words < 48 { 3 } else { 1 }, "{lacks:?} {words}");
    }
}

#[test]
fn who_gives_up_leaves_the_relay_to_be_split_anew() {
    let mut rooms = rooms(1);
    let scenes = scenes(&mut Rng::new(618), &mut rooms);
    let scene = &scenes[0];
    let mut relay = Relay::<_, 4>::new((0..3).map(|_| HostLine::<u16>::new(WIDTH.into())));
    let words = usize::from(WIDTH);
    let mut pump = Pump::new(
        MockFrameBuffer::new(WIDTH, HEIGHT),
        [HostLine::new(words), HostLine::new(words)],
    );
    let mut lines = [(); 2].map(|()| LineRooms::fitting(scene, 16, true));
    let [near, far] = &mut lines;
    let gives_up = Peer {
        wait: &|| false,
        wake: &|| (),
    };
    let mut stopped_at = |desk: &mut Desk<'_, _>| {
        let mut near = near.renderer();
        let sent = draw_frame_shared(scene, &mut near, desk, &mut pump, BACKGROUND, 1, gives_up);
        match sent.expect_err("nobody draws what is lent") {
            FrameError::Line(LineError::Stopped { line }) => line,
            error => panic!("{error:?}"),
        }
    };
    for _ in 0..3 {
        // The worker asks, is answered by nobody, and leaves its question behind: it is lent lines then.
        let (mut worker, mut desk) = relay.split();
        assert!(!worker.help(scene, &mut far.renderer(), BACKGROUND, gives_up));
        assert!(stopped_at(&mut desk) < HEIGHT);
        // And now with its question forgotten: the desk draws all, and waits for it in vain.
        let (mut worker, _) = relay.split();
        assert!(!worker.help(scene, &mut far.renderer(), BACKGROUND, gives_up));
        let (_, mut desk) = relay.split();
        assert_eq!(stopped_at(&mut desk), HEIGHT);
    }
}

/// Keeps what it is sent, and may fail at a line.
#[derive(Default)]
struct Sheet {
    words: Vec<u16>,
    fails_at: Option<u16>,
}

impl AsyncLineWriter for Sheet {
    type Error = ErrorKind;
    type Word = u16;

    async fn open(&mut self, _: Window) -> Result<(), ErrorKind> {
        self.words.clear();
        Ok(())
    }

    async fn write(&mut self, lines: Window, words: &[u16]) -> Result<(), ErrorKind> {
        let reached = |line| (lines.y..lines.y + lines.height).contains(&line);
        if self.fails_at.take_if(|line| reached(*line)).is_some() {
            return Err(ErrorKind::Bus);
        }
        self.words.extend(words);
        Ok(())
    }
}

/// Runs what is never long away.
fn block_on<T>(future: impl Future<Output = T>) -> T {
    let mut future = std::pin::pin!(future);
    let mut context = Context::from_waker(Waker::noop());
    loop {
        if let Poll::Ready(value) = future.as_mut().poll(&mut context) {
            return value;
        }
    }
}

/// Kills: an awaited frame that fetches nothing ahead, or counts other lines, or sends after what failed.
#[test]
fn awaited_frames_are_the_same() {
    let mut fetched = 0;
    let mut rooms = rooms(4);
    let scenes = scenes(&mut Rng::new(619), &mut rooms);
    let mut buffers = [[0; 7 * WIDTH as usize]; 2];
    let [one, other] = &mut buffers;
    let mut pump = AsyncPump::new(Sheet::default(), [one, other]);
    for scene in &scenes {
        let mut lines = LineRooms::fitting(scene, 16, true);
        pump.writer_mut().fails_at = Some(22);
        let mut renderer = lines.renderer().fetching(200);
        let sent = draw_frame_async(scene, &mut renderer, &mut pump, BACKGROUND, 7);
        let error = block_on(sent).expect_err("the writer fails once");
        let line = 21;
        let bus = ErrorKind::Bus;
        assert_eq!(
            error,
            FrameError::ScanOut(ScanError::Sink { line, error: bus })
        );
        let sent = draw_frame_async(scene, &mut renderer, &mut pump, BACKGROUND, 7);
        let sent = block_on(sent).unwrap();
        assert_eq!(pump.writer().words, bits(scene));
        let buffers = [(); 2].map(|()| HostLine::new(7 * usize::from(WIDTH)));
        let mut polled = Pump::new(MockFrameBuffer::new(WIDTH, HEIGHT), buffers);
        let mut want = draw_frame(scene, &mut renderer, &mut polled, BACKGROUND, 7).unwrap();
        // Nobody polls what is awaited.
        want.scan_out.stall_polls = sent.scan_out.stall_polls;
        assert_eq!(sent, want);
        assert_eq!(sent.scan_out.transfers, 6);
        fetched += sent.cache.fetched;
    }
    assert!(fetched > 0);
    // Refused before anything is sent.
    let mut lines = LineRooms::fitting(&scenes[0], 16, true);
    let shown = pump.writer().words.clone();
    let mut renderer = lines.renderer();
    let sent = draw_frame_async(&scenes[0], &mut renderer, &mut pump, BACKGROUND, 8);
    let error = block_on(sent).expect_err("a buffer is short");
    let [needed, have] = [8, 7].map(|lines| lines * usize::from(WIDTH));
    let short = ScanError::BufferTooShort { needed, have };
    assert_eq!(error, FrameError::ScanOut(short));
    let mut lines = LineRooms::fitting(&scenes[0], 16, true);
    lines.links.pop();
    let mut renderer = lines.renderer();
    let sent = draw_frame_async(&scenes[0], &mut renderer, &mut pump, BACKGROUND, 7);
    let error = block_on(sent).expect_err("a link is missing");
    assert!(matches!(error, FrameError::Line(LineError::Links { .. })));
    assert_eq!(pump.writer().words, shown);
}

/// A panel that has time, but for one line.
struct Glass {
    lines: Vec<Vec<u16>>,
    late: u16,
}

impl ContinuousPanel for Glass {
    type Word = u16;

    fn now(&mut self) -> u32 {
        100
    }

    fn deadline(&mut self, line: u16) -> u32 {
        if line == self.late { 99 } else { 200 }
    }

    fn buffer(&mut self, line: u16) -> &mut [u16] {
        &mut self.lines[usize::from(line)]
    }
}

#[test]
fn panels_with_a_clock_get_the_same_lines_or_none() {
    let mut rooms = rooms(4);
    let scenes = scenes(&mut Rng::new(620), &mut rooms);
    for (late, scene) in [0, 17, 39, 100].into_iter().zip(&scenes) {
        let lines = vec![vec![0xAAAA; WIDTH.into()]; HEIGHT.into()];
        let mut panel = Glass { lines, late };
        let mut lines = LineRooms::fitting(scene, 16, true);
        let drawn = draw_continuous(scene, &mut lines.renderer(), &mut panel, BACKGROUND);
        let (fed, used) = drawn.unwrap();
        let is_late = late < HEIGHT;
        assert_eq!(fed.lines_left_out, u32::from(is_late));
        assert_eq!(fed.lines_in_time, u32::from(HEIGHT) - u32::from(is_late));
        assert_eq!(used.assembled, scene.assembled());
        for (line, want) in (0..).zip(frame(scene, 16, true, BACKGROUND)) {
            let got = &panel.lines[usize::from(line)];
            if line == late {
                assert!(got.iter().all(|word| *word == 0xAAAA));
            } else {
                assert_eq!(got, &want, "line {line}");
            }
        }
        panel.lines[3].pop();
        let drawn = draw_continuous(scene, &mut lines.renderer(), &mut panel, BACKGROUND);
        let error = LineError::Pixels {
            needed: 48,
            have: 47,
        };
        assert_eq!(drawn.expect_err("a line is short"), error);
    }
}
