//! Status events of whole frames (H14).

use crate::common::{LineRooms, SceneRooms};
use host_tests::mock::{HostLine, MockFrameBuffer};
use scanbeam::event::Event;
use scanbeam::mesh::ScreenVertex;
use scanbeam::pipeline::{Counted, DepthUse, FlatDepth, draw_frame};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::Pump;
use scanbeam::{Camera, Cull, Screen};

type Look = Counted<FlatDepth<Rgb565Be>>;

const WIDTH: u16 = 24;
const HEIGHT: u16 = 17;

fn background() -> u16 {
    Rgb565Be::from_rgb8([1, 2, 3])
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
