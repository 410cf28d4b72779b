//! The input queues lose nothing, stall, and keep the order of their sources (K17).

use crate::common::{self, SceneRooms};
use scanbeam::input::{Command, Input, InputError, InputQueue, Stalled};
use scanbeam::pipeline::{DrawError, GouraudDepth, Instance, Scene};
use scanbeam::pixel::Rgb888;
use scanbeam::{Affine, Camera, Faces, Mesh, MeshError, Screen};
use scenes::{CUBE, SPHERE};
use std::task::Poll;

type Plain = GouraudDepth<Rgb888>;

fn rooms() -> (Screen, SceneRooms<Plain>) {
    let screen = Screen::new(64, 48).unwrap();
    (screen, SceneRooms::new(30_000, 30_000, 48))
}

fn begin(scene: &mut Scene<'_, Plain>) {
    let camera = Camera::look_at([0.0, 1.0, 6.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0, 0.1, 99.0);
    scene.begin(&camera.unwrap()).unwrap();
}

fn at(i: u8) -> Instance {
    let x = f32::from(i) / 4.0 - 1.5;
    Instance {
        model: Affine::placed(0.3, [x, 0.0, -x]).unwrap(),
        colour: [i, 255 - i, 9],
        ..Instance::default()
    }
}

fn draw(mesh: &'static Mesh<'static>, i: u8) -> Command<'static> {
    Command::Draw {
        mesh,
        instance: at(i),
    }
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
    let Err(Stalled(Command::Draw { instance, .. })) = source.send(draw(&CUBE, 2)) else {
        panic!("a third of two");
    };
    assert_eq!(instance.colour, [2, 253, 9]);
    let (screen, mut rooms) = rooms();
    let mut scene = rooms.scene(screen);
    begin(&mut scene);
    let mut input = Input::new([stream]);
    assert_eq!(input.drain(&mut scene, 1), Poll::Pending);
    assert!(!source.stall() && !input.is_empty());
    source.send(Command::EndOfFrame).unwrap();
    assert_eq!(input.drain(&mut scene, 1), Poll::Pending);
    assert_eq!(input.drain(&mut scene, 9), Poll::Ready(Ok(())));
    assert!(input.is_empty() && source.is_empty());
    assert_eq!(scene.pass_one().triangles, 24);
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
    a.send(Command::EndOfFrame).unwrap();
    let (screen, mut rooms) = rooms();
    let mut scene = rooms.scene(screen);
    begin(&mut scene);
    let error = InputError {
        source: 2,
        error: DrawError::Mesh(MeshError::Index { face: 0 }),
    };
    assert_eq!(input.drain(&mut scene, 99), Poll::Ready(Err(error)));
    assert!(error.to_string().starts_with("source 2: mesh: "));
    assert_eq!(input.drain(&mut scene, 99), Poll::Ready(Ok(())));
    assert_eq!(scene.pass_one().triangles, 12);
}

#[test]
fn producers_on_threads_give_the_picture_of_their_order() {
    const COUNT: u8 = 12;
    let (screen, mut expected_rooms) = rooms();
    let mut expected = expected_rooms.scene(screen);
    begin(&mut expected);
    for i in 0..COUNT {
        expected.draw(&SPHERE, &at(i)).unwrap();
    }
    for i in 0..COUNT {
        expected.draw(&CUBE, &at(i)).unwrap();
    }
    let expected = common::frame(&expected, 64);
    for round in 0..10 {
        let mut queues = [InputQueue::<i16, 4>::new(), InputQueue::new()];
        let [a, b] = &mut queues;
        let ((a, a_stream), (b, b_stream)) = (a.split(0), b.split(1));
        let mut input = Input::new([a_stream, b_stream]);
        let (_, mut rooms) = rooms();
        let mut scene = rooms.scene(screen);
        begin(&mut scene);
        std::thread::scope(|threads| {
            for (mut source, mesh) in [(a, &SPHERE), (b, &CUBE)] {
                threads.spawn(move || {
                    let all = (0..COUNT)
                        .map(|i| draw(mesh, i))
                        .chain([Command::EndOfFrame]);
                    for mut command in all {
                        while let Err(Stalled(back)) = source.send(command) {
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
        assert!(common::frame(&scene, 3) == expected, "round {round}");
    }
}
