//! Status events of whole frames (H14).

use crate::hot::{LineRooms, NO_MESH, SceneRooms, camera};
use host_tests::mock::{HostLine, MockFrameBuffer};
use scanbeam::event::Event;
use scanbeam::look::Gouraud;
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::Pump;
use scanbeam::scene::{DepthFunction, DepthTest, ScreenCorner};
use scanbeam::{Cull, Draw, Screen, draw_frame};

type Look = Gouraud<Rgb565Be>;

const WIDTH: u16 = 24;
const HEIGHT: u16 = 17;
/// A triangle at a column, so near.
fn near(x: i16, depth: u32) -> [ScreenCorner; 3] {
    let at = |dx, y| ScreenCorner {
        vertex: ScreenVertex {
            x: x + dx,
            y,
            depth,
            colour: [200; 3],
        },
        texel: [0; 2],
    };
    [at(0, 0), at(0, 120), at(80, 0)]
}

/// The events of a frame of these triangles, each a call of its own, for so many of which there is room.
fn events(triangles: &[[ScreenCorner; 3]], depth: DepthTest, room: usize) -> Vec<Event> {
    let screen = Screen::new(WIDTH, HEIGHT).unwrap();
    let mut memory = SceneRooms::new(32, room, HEIGHT.into(), 4);
    let mut scene = memory.scene::<Look>(screen);
    scene.begin(&camera()).unwrap();
    let call = Draw {
        cull: Cull::None,
        depth,
        ..Draw::new(NO_MESH)
    };
    for triangle in triangles {
        // That memory is full is one of the events.
        let _ = scene.draw_screen(&call, &[*triangle]);
    }
    let mut lent = LineRooms::fitting(&scene, 32, true);
    let mut renderer = lent.renderer().counting();
    let words = usize::from(WIDTH);
    let sink = MockFrameBuffer::new(WIDTH, HEIGHT);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let background = Rgb565Be::from_rgb8([1, 2, 3]);
    let used = draw_frame(&scene, &mut renderer, &mut pump, background, 1).unwrap();
    let events = used.assembled.events().union(renderer.spans().events());
    events.iter().collect()
}

/// H14: events of frames that are drawn, each with what makes it happen and without.
///
/// Kills: a condition that is turned round, an event in the place of another, a union that keeps one set alone.
#[test]
fn frames_that_are_drawn_tell_their_events() {
    use Event::{DepthFailed, DepthPassed, Full, PixelRendered};
    let usual = |triangles: &[_]| events(triangles, DepthTest::default(), 4);
    let never = DepthTest {
        colour_if: DepthFunction::NEVER,
        ..DepthTest::default()
    };
    let apart = [near(0, 1 << 20), near(96, 1 << 20)];
    assert_eq!(usual(&[]), []);
    assert_eq!(usual(&apart[..1]), [PixelRendered]);
    assert_eq!(usual(&apart), [PixelRendered]);
    // The same columns: one hides a part of the other.
    let over = [near(0, 1 << 20), near(8, 1 << 29)];
    assert_eq!(usual(&over), [PixelRendered, DepthPassed, DepthFailed]);
    assert_eq!(events(&apart, never, 4), [DepthFailed]);
    let full = events(&apart, DepthTest::default(), 1);
    assert_eq!(full, [PixelRendered, Full]);
}
