//! Flow control, events, privilege and rings (H12-H14).

use crate::common::Rng;
use crate::listing::{HEIGHT, PLENTY, Room, Smooth, WIDTH, drawn, triangle};
use host_tests::lists::writer::ListWriter;
use scanbeam::Light;
use scanbeam::event::{Event, EventFlags, EventSet, Notice};
use scanbeam::input::{ListRunner, ListSettings, OnViolation};
use scanbeam::list::{
    Budget, Flow, Halt, LightWords, ListCommand, ListControl, ListRing, Material, State, Window,
};
use std::sync::atomic::AtomicU32;

#[test]
fn a_list_that_grows_while_it_is_drawn_is_drawn_once() {
    const ALL: u32 = 80;
    let whole: Vec<u32> = (0..ALL).flat_map(triangle).collect();
    let want = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings::default());
        runner.start(0);
        let halt = runner.run(&whole[..], scene, &mut PLENTY.clone(), &mut |_| {});
        assert_eq!(halt, Ok(Halt::End));
        assert_eq!(runner.counts().triangles, ALL);
    });
    // Another thread writes into a ring that holds three blocks and a half, and waits for room.
    for seed in 0..20 {
        let mut rng = Rng::new(seed);
        let mut memory = [const { AtomicU32::new(0) }; 64];
        let mut ring = ListRing::new(&mut memory);
        let (mut writer, mut reader) = ring.split();
        let mut pauses: Vec<u32> = (0..ALL).map(|_| rng.below(40)).collect();
        let got = drawn::<Smooth>(|scene| {
            std::thread::scope(|threads| {
                threads.spawn(move || {
                    for i in 0..ALL {
                        let block = triangle(i);
                        while writer.append(&block).is_err() {
                            std::thread::yield_now();
                        }
                        for _ in 0..pauses.pop().unwrap() {
                            std::hint::spin_loop();
                        }
                    }
                    let mut memory = [0; 1];
                    let mut end = ListWriter::new(&mut memory);
                    end.flow(Flow::End).unwrap();
                    while writer.append(end.words()).is_err() {}
                });
                let mut room = Room::<i16>::new(64, 64);
                let mut runner = room.runner(ListSettings::default());
                runner.start(0);
                let flags = EventFlags::new(EventSet::ALL);
                loop {
                    // Small budgets, so that it halts between any two blocks.
                    let mut budget = Budget {
                        instructions: 1 + rng.below(4),
                        ..PLENTY
                    };
                    let halt = runner.run(reader.words(), scene, &mut budget, &mut &flags);
                    reader.free_to(runner.position());
                    match halt.unwrap() {
                        Halt::End => break,
                        Halt::Waiting | Halt::Budget => {}
                        other => panic!("{other:?}"),
                    }
                }
                assert!(flags.take().has(Event::ListEnd));
                assert_eq!(runner.counts().triangles, ALL);
            });
        });
        assert!(got == want, "seed {seed}");
    }
}

#[test]
fn what_a_list_must_not_do_is_an_event() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    writer.master(0x77).unwrap();
    let all = Window {
        left: 0,
        top: 0,
        right: WIDTH,
        bottom: HEIGHT,
    };
    let wide = Window {
        right: WIDTH + 1,
        ..all
    };
    writer.state(&State::Window(wide)).unwrap();
    writer.state(&State::Window(all)).unwrap();
    writer.flow(Flow::Jump(0xFFFF_FF00)).unwrap();
    let camera = scanbeam::list::CameraWords {
        eye: [0.0; 3],
        at: [1.0; 3],
        up: [0.0, 1.0, 0.0],
        focal: 100.0,
        near: 0.1,
        far: 9.0,
    };
    writer.state(&State::Camera(camera)).unwrap();
    writer.flow(Flow::LoadTexture { number: 0, at: 0 }).unwrap();
    let violations = 5;
    let from = writer.position();
    let drawn_part = triangle(7);
    let list: Vec<u32> = writer.words().iter().chain(&drawn_part).copied().collect();
    let want = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings::default());
        runner.start(from);
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut |_| {});
        assert_eq!((halt, runner.counts().violations), (Ok(Halt::End), 0));
    });
    let got = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings::default());
        runner.start(0);
        let mut seen = Vec::new();
        let mut events = |n: Notice| seen.push((n.event, n.offset));
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut events);
        assert_eq!(
            (halt, runner.counts().violations),
            (Ok(Halt::End), violations)
        );
        let offsets: Vec<u32> = seen
            .iter()
            .filter(|(event, _)| *event == Event::AccessViolation)
            .map(|(_, offset)| *offset)
            .collect();
        assert_eq!(offsets, [0, 8, 32, 40, 92]);
    });
    assert!(got == want);
    let stopped = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings {
            on_violation: OnViolation::Stop,
            ..ListSettings::default()
        });
        runner.start(0);
        for _ in 0..violations {
            let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut |_| {});
            assert_eq!(halt, Ok(Halt::Violation));
            runner.command(ListCommand::Resume);
        }
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut |_| {});
        assert_eq!(halt, Ok(Halt::End));
    });
    assert!(stopped == want);
}

#[test]
fn what_the_pipeline_lacks_is_an_event_and_the_rest_is_drawn() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    let glass = Material {
        diffuse: [10, 200, 30],
        opacity: 128,
        ..Material::default()
    };
    writer.state(&State::Material(glass)).unwrap();
    let light = Light::new([0.0, 1.0, 1.0], 0.3).unwrap();
    let light = LightWords::from(light);
    writer.state(&State::Light { number: 0, light }).unwrap();
    writer.state(&State::Light { number: 3, light }).unwrap();
    let list: Vec<u32> = writer
        .words()
        .iter()
        .chain(&triangle(40))
        .copied()
        .collect();
    let got = drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings::default());
        runner.start(0);
        let flags = EventFlags::new(EventSet::ALL);
        let halt = runner.run(&list[..], scene, &mut PLENTY.clone(), &mut &flags);
        assert_eq!(halt, Ok(Halt::End));
        assert_eq!(runner.counts().unimplemented, 2);
        assert!(flags.take().has(Event::Unimplemented));
    });
    let want = [10u8, 200, 30];
    let pixels = got.iter().flatten().filter(|p| **p == want);
    assert!(pixels.count() > 20);
}

#[test]
fn pauses_syncs_interrupts_and_commands_halt_where_they_stand() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    writer.flow(Flow::Interrupt(42)).unwrap();
    writer.flow(Flow::Pause).unwrap();
    writer.flow(Flow::Sync).unwrap();
    let mut list = writer.words().to_vec();
    list.extend(triangle(4));
    let control = ListControl::new();
    drawn::<Smooth>(|scene| {
        let mut room = Room::<i16>::new(64, 64);
        let mut runner = room.runner(ListSettings {
            control: Some(&control),
            ..ListSettings::default()
        });
        let mut seen = Vec::new();
        let mut budget = PLENTY;
        let mut call = |runner: &mut ListRunner<'_, '_>| {
            runner.run(&list[..], scene, &mut budget, &mut |n: Notice| {
                seen.push((n.event, n.value));
            })
        };
        assert_eq!(call(&mut runner), Ok(Halt::Stopped));
        control.send(ListCommand::Start(0));
        assert_eq!(call(&mut runner), Ok(Halt::Paused));
        assert_eq!(call(&mut runner), Ok(Halt::Stopped));
        control.send(ListCommand::Resume);
        assert_eq!(call(&mut runner), Ok(Halt::Sync));
        control.send(ListCommand::Step);
        assert_eq!(call(&mut runner), Ok(Halt::Stepped));
        assert_eq!(runner.counts().triangles, 0, "the matrix alone");
        control.send(ListCommand::Step);
        assert_eq!(call(&mut runner), Ok(Halt::Stepped));
        assert_eq!(runner.counts().triangles, 1);
        control.send(ListCommand::Resume);
        assert_eq!(call(&mut runner), Ok(Halt::End));
        control.send(ListCommand::Restart);
        assert_eq!(call(&mut runner), Ok(Halt::Paused));
        assert_eq!(
            seen,
            [
                (Event::Interrupt, 42),
                (Event::Paused, 0),
                (Event::Sync, 0),
                (Event::ListEnd, 0),
                (Event::Interrupt, 42),
                (Event::Paused, 0),
            ]
        );
    });
}
