//! Whole frames on awaited sinks: what `draw_frame_async` and `send_frame_async` send, count and
//! refuse is what `draw_frame` and `send_frame` do (X5, H14).

use std::cell::RefCell;

use crate::common::{LineRooms, Rng, SceneRooms};
use embassy_futures::block_on;
use host_tests::mock::{HostLine, MockFrameBuffer};
use scanbeam::event::Event;
use scanbeam::mesh::ScreenVertex;
use scanbeam::parallel::LineSource;
use scanbeam::pipeline::{Counted, DepthUse, FlatDepth};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{
    AsyncLineWriter, AsyncPump, ErrorKind, ErrorType, Pump, ScanError, Window,
};
use scanbeam::send::{draw_frame_async, send_frame_async};
use scanbeam::{Camera, Cull, FrameError, RendererError, Scene, Screen, draw_frame};

type Look = Counted<FlatDepth<Rgb565Be>>;

const WIDTH: u16 = 24;
const HEIGHT: u16 = 17;

/// What an awaited display shows, from its first line on; fails at the write of that number.
#[derive(Default)]
struct Panel {
    shown: RefCell<Vec<u16>>,
    writes: RefCell<usize>,
    fails_at: Option<usize>,
}

impl ErrorType for &Panel {
    type Error = ErrorKind;
}

impl AsyncLineWriter for &Panel {
    type Word = u16;

    async fn open(&mut self, window: Window) -> Result<(), ErrorKind> {
        assert_eq!((window.x, window.width), (0, WIDTH));
        self.shown.borrow_mut().clear();
        Ok(())
    }

    async fn write(&mut self, lines: Window, words: &[u16]) -> Result<(), ErrorKind> {
        embassy_futures::yield_now().await;
        let at = *self.writes.borrow();
        *self.writes.borrow_mut() += 1;
        if self.fails_at == Some(at) {
            return Err(ErrorKind::Bus);
        }
        assert_eq!(words.len(), usize::from(lines.width * lines.height));
        self.shown.borrow_mut().extend_from_slice(words);
        Ok(())
    }
}

/// A few triangles over each other on the lines of a band.
fn build(scene: &mut Scene<'_, Look>, rng: &mut Rng, lines: std::ops::Range<u16>) {
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at([0.0; 3], ahead, up, 20.0, 0.1, 99.0).unwrap();
    scene.begin_band(&camera, lines).unwrap();
    for _ in 0..6 {
        let colour = [(); 3].map(|()| rng.below(256) as u8);
        let corners = [(); 3].map(|()| ScreenVertex {
            x: rng.below(8 * u32::from(WIDTH)) as i16,
            y: rng.below(8 * u32::from(HEIGHT)) as i16,
            depth: rng.below(1 << 30),
            colour,
        });
        scene
            .draw_screen(&corners, &[[0, 1, 2]], (), Cull::None)
            .unwrap();
    }
}

fn rooms() -> SceneRooms<Look> {
    SceneRooms::new(32, 16, usize::from(HEIGHT))
}

fn background() -> u16 {
    Rgb565Be::from_rgb8([1, 2, 3])
}

#[test]
fn awaited_frames_are_those_of_the_pump_and_count_the_same() {
    let mut rng = Rng::new(5);
    for round in 0..60 {
        let mut memory = rooms();
        let mut scene = memory.scene(Screen::new(WIDTH, HEIGHT).unwrap());
        let (top, bottom) = rng.pick(&[(0, HEIGHT), (3, 9), (16, 17), (0, 1)]);
        build(&mut scene, &mut rng, top..bottom);
        let lines = rng.pick(&[1u16, 2, 5, HEIGHT]);
        let words = usize::from(WIDTH * lines);
        let (slots, prefetch) = (rng.pick(&[0, 2, 16]), rng.pick(&[0u32, 300]));

        let mut lent = [(); 2].map(|()| LineRooms::fitting(slots, &scene));
        let [here, there] = &mut lent;
        let (mut polled, mut awaited) = (here.renderer(), there.renderer());
        polled.set_prefetch(prefetch);
        awaited.set_prefetch(prefetch);
        let sink = MockFrameBuffer::new(WIDTH, HEIGHT);
        let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
        let panel = Panel::default();
        let (mut one, mut other) = (vec![0; words], vec![0; words]);
        let mut async_pump = AsyncPump::new(&panel, [&mut one, &mut other]);
        // Twice: the figures of a frame are its own.
        for _ in 0..2 {
            pump.sink_mut().next_frame();
            let want = draw_frame(&scene, &mut polled, &mut pump, background(), lines).unwrap();
            let shown = pump.sink().shown();
            let of = |line: u16| usize::from(line * WIDTH);
            let shown: Option<Vec<u16>> = shown[of(top)..of(bottom)].iter().copied().collect();
            let frame =
                draw_frame_async(&scene, &mut awaited, &mut async_pump, background(), lines);
            let mut got = block_on(frame).unwrap();
            assert_eq!(
                Some(&*panel.shown.borrow()),
                shown.as_ref(),
                "round {round}"
            );
            // Nobody polls what is awaited.
            got.scan_out.stall_polls = want.scan_out.stall_polls;
            assert_eq!(got, want, "round {round}");
        }
    }
}

#[test]
fn awaited_frames_name_what_failed_and_the_next_is_whole() {
    let mut memory = rooms();
    let mut scene = memory.scene(Screen::new(WIDTH, HEIGHT).unwrap());
    build(&mut scene, &mut Rng::new(8), 0..HEIGHT);
    let mut lent = LineRooms::fitting(16, &scene);
    let mut renderer = lent.renderer();
    let words = usize::from(3 * WIDTH);
    let (mut one, mut other) = (vec![0; words], vec![0; words]);
    let mut draw = |panel: &Panel, lines| {
        let mut pump = AsyncPump::new(panel, [&mut one, &mut other]);
        let frame = draw_frame_async(&scene, &mut renderer, &mut pump, background(), lines);
        block_on(frame).map(|_| ())
    };
    let whole = Panel::default();
    draw(&whole, 3).unwrap();
    for at in 0..6 {
        let panel = Panel {
            fails_at: Some(at),
            ..Panel::default()
        };
        let (line, error) = (3 * at as u16, ErrorKind::Bus);
        let failed = FrameError::ScanOut(ScanError::Sink { line, error });
        assert_eq!(draw(&panel, 3), Err(failed));
        draw(&panel, 3).unwrap();
        assert!(panel.shown == whole.shown, "after a fault at write {at}");
    }
    // Refused before anything is sent: buffers too short, and a renderer without room.
    let panel = Panel::default();
    let (needed, have) = (words + usize::from(WIDTH), words);
    let short = ScanError::BufferTooShort { needed, have };
    assert_eq!(draw(&panel, 4), Err(FrameError::ScanOut(short)));
    let mut lent = LineRooms::new(16, 0, WIDTH.into());
    let mut renderer = lent.renderer();
    let mut pump = AsyncPump::new(&panel, [&mut one, &mut other]);
    let frame = block_on(draw_frame_async(&scene, &mut renderer, &mut pump, 0, 3));
    assert!(matches!(frame, Err(FrameError::Renderer(_))), "{frame:?}");
    assert_eq!(*panel.writes.borrow(), 0);
}

/// Gives lines that say where they are, until one that it has no memory for.
struct Ruler {
    asked: Vec<(u16, bool)>,
    ends_at: u16,
}

impl LineSource<Look> for Ruler {
    fn line(&mut self, line: u16, pixels: &mut [u16]) -> Result<(), RendererError> {
        self.asked.push((line, false));
        pixels.fill(line);
        if line == self.ends_at {
            return Err(RendererError::Depth { needed: 7, have: 6 });
        }
        Ok(())
    }

    fn idle(&mut self, line: u16) {
        self.asked.push((line, true));
    }
}

#[test]
fn sources_give_awaited_lines_in_order_and_end_the_frame() {
    let mut memory = rooms();
    let mut scene = memory.scene(Screen::new(WIDTH, HEIGHT).unwrap());
    build(&mut scene, &mut Rng::new(9), 2..HEIGHT);
    let panel = Panel::default();
    let words = usize::from(4 * WIDTH);
    let (mut one, mut other) = (vec![0; words], vec![0; words]);
    let mut pump = AsyncPump::new(&panel, [&mut one, &mut other]);
    let mut ruler = Ruler {
        asked: Vec::new(),
        ends_at: u16::MAX,
    };
    for _ in 0..2 {
        ruler.asked.clear();
        let sent = block_on(send_frame_async(&scene, &mut ruler, &mut pump, 4)).unwrap();
        // 15 lines, 4 at once.
        assert_eq!((sent.transfers, sent.bytes_sent), (4, 15 * 24 * 2));
        let want: Vec<_> = (2..HEIGHT)
            .flat_map(|y| [(y, false), (y + 1, true)])
            .collect();
        assert_eq!(ruler.asked, want);
        let lines = (2..HEIGHT).flat_map(|y| [y; WIDTH as usize]);
        assert!(lines.eq(panel.shown.borrow().iter().copied()));
    }
    // Lines 2 to 5 are on their way while 6 to 9 are drawn; nothing of those is sent.
    ruler.ends_at = 9;
    let sent = block_on(send_frame_async(&scene, &mut ruler, &mut pump, 4));
    let depth = RendererError::Depth { needed: 7, have: 6 };
    assert_eq!(sent, Err(FrameError::Renderer(depth)));
    assert_eq!(panel.shown.borrow().len(), words);
}

/// H14: events of frames that are drawn, each with what makes it happen and without.
#[test]
fn frames_that_are_drawn_tell_their_events() {
    let near = |x: i16, depth| {
        let at = |dx, y| ScreenVertex {
            x: x + dx,
            y,
            depth,
            colour: [200; 3],
        };
        [at(0, 0), at(0, 120), at(80, 0)]
    };
    let events_by = |depth_use, triangles: &[[ScreenVertex; 3]], objects| {
        let mut memory = SceneRooms::<Look>::new(32, objects, usize::from(HEIGHT));
        let mut scene = memory.scene(Screen::new(WIDTH, HEIGHT).unwrap());
        let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at([0.0; 3], ahead, up, 20.0, 0.1, 99.0).unwrap();
        scene.begin(&camera).unwrap();
        for triangle in triangles {
            // The arena that is full is one of the events.
            let _ = scene.draw_screen(triangle, &[[0, 1, 2]], (), Cull::None);
        }
        let mut lent = LineRooms::fitting(8, &scene);
        let mut renderer = lent.renderer();
        renderer.set_depth_use(depth_use);
        let sink = MockFrameBuffer::new(WIDTH, HEIGHT);
        let words = usize::from(WIDTH);
        let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
        let stats = draw_frame(&scene, &mut renderer, &mut pump, background(), 1).unwrap();
        stats.events().iter().collect::<Vec<_>>()
    };
    use Event::{DepthFailed, DepthPassed, Full, PixelRendered};
    let events = |triangles: &[_]| events_by(DepthUse::WhereNeeded, triangles, 4);
    let compared = |triangles: &[_]| events_by(DepthUse::Always, triangles, 4);
    let apart = [near(0, 1 << 20), near(96, 1 << 20)];
    assert_eq!(events(&[]), []);
    assert_eq!(events(&apart[..1]), [PixelRendered]);
    assert_eq!(events(&apart), [PixelRendered]);
    assert_eq!(compared(&[]), []);
    assert_eq!(compared(&apart), [PixelRendered, DepthPassed]);
    let over = [near(0, 1 << 20), near(8, 1 << 29)];
    assert_eq!(compared(&over), [PixelRendered, DepthPassed]);
    let behind = [near(0, 1 << 29), near(8, 1 << 20)];
    assert_eq!(compared(&behind), [PixelRendered, DepthPassed, DepthFailed]);
    let full = events_by(DepthUse::WhereNeeded, &apart, 1);
    assert_eq!(full, [PixelRendered, Full]);
}
