//! X9: what a list draws is paced as what calls draw.

use host_support::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::Scene;
use scanbeam::frame::{Pace, Paid};
use scanbeam::input::{Player, PlayerMemory};
use scanbeam::list::ListCommand;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scenes::{DRAWS, OBJECTS, Played, Shot, SmoothLook, VERTICES};

const ROOM: Room = Room {
    vertices: VERTICES,
    places: VERTICES,
    objects: OBJECTS,
    draws: DRAWS,
};

/// The lines of a picture, with slots for all, and what was paid.
fn lines(scene: &Scene<'_, '_, SmoothLook>, pace: Option<Pace>) -> (Vec<Vec<u16>>, Paid) {
    let width = scene.screen().width();
    let mut rooms: LineRooms<SmoothLook, 7> = LineRooms::new(OBJECTS, width);
    let mut renderer = rooms.renderer();
    if let Some(pace) = pace {
        renderer = renderer.paced(pace);
    }
    let background = Rgb565Be::from_rgb8([24, 32, 48]);
    let lines = scene.lines().map(|y| {
        let mut line = vec![0; width.into()];
        let drawn = renderer.draw_line(scene, y, &mut line, background);
        drawn.unwrap();
        line
    });
    (lines.collect(), renderer.paid())
}

/// Kills: pixels that are not counted where runs have one colour.
#[test]
fn lists_are_paced_as_calls_are() {
    let played = Played::Teapot;
    let [table, indices] = played.sizes();
    let mut lent = (vec![[0; 3]; table], vec![[0; 3]; table], vec![0; indices]);
    let memory = PlayerMemory {
        positions: &mut lent.0,
        normals: &mut lent.1,
        indices: &mut lent.2,
        ..PlayerMemory::default()
    };
    let mut player = Player::new(memory, Played::Teapot.settings());
    let mut rooms = SceneRooms::new(ROOM, Shot::screen().height());
    let mut scene = rooms.scene::<SmoothLook>(Shot::screen());
    let counts = played.play(&mut player, ListCommand::Start(0), &mut scene);
    counts.unwrap();
    let (want, _) = lines(&scene, None);
    let (got, paid) = lines(&scene, Some(Pace::GOURAUD_M4));
    assert!(got == want);
    let dearest = paid.dearest;
    assert_eq!(
        paid,
        Paid {
            dearest,
            ..Paid::default()
        }
    );
    let mut before = 0;
    for most in [dearest, 20_000, 10_000, 5_000] {
        // Triangles begin on their lines.
        let pace = Pace {
            most,
            begin: 0,
            large: 0,
            turn: 0,
            ..Pace::GOURAUD_M4
        };
        let (got, paid) = lines(&scene, Some(pace));
        let pixels = got.iter().flatten().zip(want.iter().flatten());
        let differing = pixels.filter(|(got, want)| got != want).count() as u32;
        assert!(paid.even + paid.joined + paid.unsorted + paid.left_out >= differing);
        assert_eq!((paid.late, paid.lost), (0, 0));
        assert!(
            paid.dearest <= most && differing >= before,
            "{most}: {paid:?}"
        );
        before = differing;
    }
    assert!(before > 10_000, "{before}");
}
