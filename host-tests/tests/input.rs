//! The input queues lose nothing, stall, and keep the order of their sources (K17).

use host_tests::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::input::{Command, Input, InputError, InputQueue, Refused};
use scanbeam::light::{DirectionalLight, Lighting};
use scanbeam::look::Gouraud;
use scanbeam::mesh::{Material, U1F15};
use scanbeam::pixel::Rgb888;
use scanbeam::scene::{BeginError, Blend, DrawError, Scissor};
use scanbeam::{Affine, Camera, Draw, Faces, Mesh, MeshError, Scene, Screen};
use scenes::{CUBE, SPHERE};
use std::task::Poll;

type Look = Gouraud<Rgb888>;

const ROOM: Room = Room {
    vertices: 30_000,
    places: 0,
    objects: 30_000,
    draws: 40,
};

fn screen() -> Screen {
    Screen::new(64, 48).unwrap()
}

fn camera() -> Camera {
    let up = [0.0, 1.0, 0.0];
    Camera::look_at([0.0, 1.0, 6.0], [0.0; 3], up, 60.0, 0.1, 99.0).unwrap()
}

/// A call of all kinds: what a source says, it says whole.
fn call<'c>(mesh: &Mesh<'c>, i: u8, lighting: &'c Lighting<'c>) -> Draw<'c, 'c> {
    let x = f32::from(i) / 4.0 - 1.5;
    Draw {
        model: Affine::placed(0.3, [x, 0.0, -x]).unwrap(),
        colour: [i, 255 - i, 9],
        lights: i.is_multiple_of(3).then_some(lighting),
        blend: (i % 4 == 1).then(|| Blend::filter(100)),
        scissor: (i % 5 == 2).then(|| Scissor::outside(20..30, 10..40)),
        ..Draw::new(Mesh {
            colours: &[],
            ..*mesh
        })
    }
}

/// A light from above.
fn lighting(lights: &[DirectionalLight]) -> Lighting<'_> {
    Lighting::new(lights, [U1F15::from_bits(9_000); 3], Material::default()).unwrap()
}

fn above() -> [DirectionalLight; 1] {
    [DirectionalLight::new([0.3, 1.0, 0.5], [1.0, 0.8, 0.6]).unwrap()]
}

fn draw(mesh: &Mesh<'static>, i: u8) -> Command<'static> {
    Command::Draw(Draw {
        colour: [i, 255 - i, 9],
        ..Draw::new(*mesh)
    })
}

/// All lines with so many slots.
fn frame(scene: &Scene<'_, '_, Look>, slots: u16) -> Vec<[u8; 3]> {
    let mut rooms: LineRooms<Look> = LineRooms::new(ROOM.objects, 64).with_limit(slots);
    let mut renderer = rooms.renderer();
    let line = |y| {
        let mut line = vec![[0; 3]; 64];
        renderer.draw_line(scene, y, &mut line, [7; 3]).unwrap();
        line
    };
    scene.lines().flat_map(line).collect()
}

#[test]
fn a_full_queue_stalls_and_hands_back() {
    let mut queue = InputQueue::<i16, 3>::new();
    let (mut source, stream) = queue.split(7);
    assert_eq!(
        (source.id(), source.stall(), source.is_empty()),
        (7, false, true)
    );
    source.send(draw(&CUBE, 0)).unwrap();
    source.send(draw(&CUBE, 1)).unwrap();
    assert!(source.stall() && !source.is_empty() && !stream.is_empty());
    let Err(Command::Draw(back)) = source.send(draw(&CUBE, 2)) else {
        panic!("a third of two");
    };
    assert_eq!(back.colour, [2, 253, 9]);
    let mut rooms = SceneRooms::new(ROOM, 48);
    let mut scene = rooms.scene::<Look>(screen());
    scene.begin(&camera()).unwrap();
    let mut input = Input::new([stream]);
    assert_eq!(input.drain(&mut scene, 1), Poll::Pending);
    assert!(!source.stall() && !input.is_empty());
    source.send(Command::EndOfFrame).unwrap();
    assert_eq!(input.drain(&mut scene, 1), Poll::Pending);
    assert_eq!(input.drain(&mut scene, 9), Poll::Ready(Ok(())));
    assert!(input.is_empty() && source.is_empty());
    assert_eq!(scene.assembled().triangles, 24);
    assert_eq!(input.drain(&mut scene, 9), Poll::Pending);
    assert_eq!(
        Input::<i16, 0>::new([]).drain(&mut scene, 0),
        Poll::Ready(Ok(()))
    );
}

#[test]
fn bad_meshes_are_named_by_their_source_and_the_rest_goes_on() {
    static BAD: Mesh<'static> = Mesh {
        positions: &[[0; 3]],
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[[0, 1, 2]]),
    };
    let mut queues = [InputQueue::<i16, 8>::new(), InputQueue::new()];
    let [a, b] = &mut queues;
    let ((mut a, a_stream), (mut b, b_stream)) = (a.split(1), b.split(2));
    let mut input = Input::new([a_stream, b_stream]);
    for command in [draw(&BAD, 0), draw(&CUBE, 1), Command::EndOfFrame] {
        b.send(command).unwrap();
    }
    for command in [Command::Begin(camera()), Command::EndOfFrame] {
        a.send(command).unwrap();
    }
    let mut rooms = SceneRooms::new(ROOM, 48);
    let mut scene = rooms.scene::<Look>(screen());
    let error = InputError {
        source: 2,
        error: Refused::Draw(DrawError::Mesh(MeshError::Index { face: 0 })),
    };
    assert_eq!(input.drain(&mut scene, 99), Poll::Ready(Err(error)));
    assert!(error.to_string().starts_with("source 2: mesh: "));
    assert_eq!(input.drain(&mut scene, 99), Poll::Ready(Ok(())));
    assert_eq!(scene.assembled().triangles, 12);
    // A scene that cannot be begun, and what is said to it all the same.
    for command in [
        Command::Begin(camera()),
        draw(&CUBE, 1),
        Command::EndOfFrame,
    ] {
        a.send(command).unwrap();
    }
    b.send(Command::EndOfFrame).unwrap();
    let mut rooms = SceneRooms::new(ROOM, 47);
    let mut scene = rooms.scene::<Look>(screen());
    let bins = BeginError::Bins {
        needed: 48,
        have: 47,
    };
    for (source, error) in [
        (1, Refused::Begin(bins)),
        (1, Refused::Draw(DrawError::NotBegun)),
    ] {
        let error = InputError { source, error };
        assert_eq!(input.drain(&mut scene, 99), Poll::Ready(Err(error)));
        assert!(error.to_string().starts_with("source 1: scene: "));
    }
    assert_eq!(input.drain(&mut scene, 99), Poll::Ready(Ok(())));
}

#[test]
fn producers_on_threads_give_the_picture_of_their_order() {
    const COUNT: u8 = 12;
    let lights = above();
    let lighting = lighting(&lights);
    let mut rooms = SceneRooms::new(ROOM, 48);
    let mut expected = rooms.scene::<Look>(screen());
    expected.begin(&camera()).unwrap();
    for mesh in [&SPHERE, &CUBE] {
        for i in 0..COUNT {
            expected.draw(&call(mesh, i, &lighting)).unwrap();
        }
    }
    let expected = frame(&expected, 64);
    for round in 0..10 {
        let mut queues = [InputQueue::<i16, 4>::new(), InputQueue::new()];
        let [a, b] = &mut queues;
        let ((a, a_stream), (b, b_stream)) = (a.split(0), b.split(1));
        let mut input = Input::new([a_stream, b_stream]);
        let mut rooms = SceneRooms::new(ROOM, 48);
        let mut scene = rooms.scene::<Look>(screen());
        std::thread::scope(|threads| {
            let lighting = &lighting;
            for (mut source, mesh, begins) in [(a, &SPHERE, true), (b, &CUBE, false)] {
                threads.spawn(move || {
                    let begin = begins.then(|| Command::Begin(camera()));
                    let calls = (0..COUNT).map(|i| Command::Draw(call(mesh, i, lighting)));
                    let all = begin.into_iter().chain(calls);
                    for mut command in all.chain([Command::EndOfFrame]) {
                        while let Err(back) = source.send(command) {
                            command = back;
                            std::thread::yield_now();
                        }
                    }
                });
            }
            loop {
                match input.drain(&mut scene, 1 + round) {
                    Poll::Ready(done) => break done.unwrap(),
                    Poll::Pending => std::thread::yield_now(),
                }
            }
        });
        assert!(frame(&scene, 3) == expected, "round {round}");
    }
}
