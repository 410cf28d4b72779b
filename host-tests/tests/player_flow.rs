//! Players halt where lists and commands say, pay for jumps, and draw within windows (H12, H13, X7).

use crate::listing::{PLENTY, triangle};
use crate::played::{Kept, WIDTH, drawn, played};
use host_tests::lists::writer::{FieldPacker, ListWriter};
use scanbeam::event::{Event, Notice};
use scanbeam::input::{Player, PlayerSettings};
use scanbeam::list::{
    Budget, FieldForm, Flow, Halt, Header, Id, ListCommand, ListControl, State, Window,
};
use scanbeam::look::Gouraud;
use scanbeam::pixel::Rgb565Be;

type Smooth = Gouraud<Rgb565Be>;

#[test]
fn pauses_syncs_interrupts_and_commands_halt_where_they_stand() {
    let mut memory = vec![0; 256];
    let mut writer = ListWriter::new(&mut memory);
    writer.flow(Flow::Interrupt(42)).unwrap();
    writer.flow(Flow::Pause).unwrap();
    writer.flow(Flow::Sync).unwrap();
    let mut list = writer.words().to_vec();
    list.extend(triangle(4));
    let list: &'static [u32] = Vec::leak(list);
    let control = ListControl::new();
    let mut kept = Kept::new(64, 64);
    let mut player = kept.player::<Smooth>(PlayerSettings {
        control: Some(&control),
        ..PlayerSettings::default()
    });
    drawn::<Smooth>(|scene| {
        let mut seen = Vec::new();
        let mut budget = PLENTY;
        let mut call = |player: &mut Player<'_, 'static, Smooth>| {
            player.run(list, scene, &mut budget, &mut |n: Notice| {
                seen.push((n.event, n.value));
            })
        };
        assert_eq!(call(&mut player), Ok(Halt::Stopped));
        control.send(ListCommand::Start(0));
        assert_eq!(call(&mut player), Ok(Halt::Paused));
        assert_eq!(call(&mut player), Ok(Halt::Stopped));
        control.send(ListCommand::Resume);
        assert_eq!(call(&mut player), Ok(Halt::Sync));
        control.send(ListCommand::Step);
        assert_eq!(call(&mut player), Ok(Halt::Stepped));
        assert_eq!(player.counts().triangles, 0, "the matrix alone");
        control.send(ListCommand::Step);
        assert_eq!(call(&mut player), Ok(Halt::Stepped));
        assert_eq!(player.counts().triangles, 1);
        control.send(ListCommand::Resume);
        assert_eq!(call(&mut player), Ok(Halt::End));
        control.send(ListCommand::Restart);
        assert_eq!(call(&mut player), Ok(Halt::Paused));
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

/// X7: each jump is paid for, and with none left the list waits where it is.
#[test]
fn jumps_are_counted() {
    let mut memory = [0; 16];
    let mut writer = ListWriter::new(&mut memory);
    let at = writer.position();
    writer.flow(Flow::Jump(at)).unwrap();
    let words = writer.words().to_vec();
    let mut kept = Kept::new(4, 4);
    let mut player = kept.player::<Smooth>(PlayerSettings::default());
    player.start(0);
    drawn::<Smooth>(|scene| {
        for jumps in [0, 3, 20] {
            let mut budget = Budget {
                instructions: 1000,
                jumps,
                ..PLENTY
            };
            let halt = player.run(&words[..], scene, &mut budget, &mut |_: Notice| {});
            assert_eq!(halt, Ok(Halt::Budget));
            assert_eq!((budget.jumps, budget.instructions), (0, 1000 - jumps));
        }
    });
}

/// A triangle over all of the picture, as a list's block.
fn everywhere(writer: &mut ListWriter<'_>) {
    let header = Header {
        new: true,
        ..Header::of(Id::Short, 3)
    };
    let mut words = Vec::new();
    let mut packer = FieldPacker::new(|word| words.push(word));
    for [x, y] in [[-32_000, -32_000], [32_000, -32_000], [0, 32_000]] {
        packer.field(FieldForm::S16x3, [x, y, 0, 0]);
        packer.align();
    }
    writer.vertices(header, &words).unwrap();
}

/// H13: a list draws within the window that it asks for, and within the one that it was granted.
#[test]
fn the_windows_of_lists_cut() {
    let granted = Window {
        left: 4,
        top: 3,
        right: 60,
        bottom: 50,
    };
    let asked = Window {
        left: 20,
        top: 15,
        right: 59,
        bottom: 42,
    };
    let wide = Window { left: 3, ..asked };
    let has = |w: Window, x, y| (w.left..w.right).contains(&x) && (w.top..w.bottom).contains(&y);
    let draw = |windows: &[Window], settings: PlayerSettings<'static, 'static>| {
        let mut words = [0; 64];
        let mut writer = ListWriter::new(&mut words);
        for window in windows {
            writer.state(&State::Window(*window)).unwrap();
        }
        everywhere(&mut writer);
        let list = writer.words().to_vec();
        let mut kept = Kept::new(9, 9);
        let mut player = kept.player::<Smooth>(settings);
        let frame = drawn::<Smooth>(|scene| {
            player.start(0);
            assert_eq!(played(&mut player, &list[..], scene, PLENTY), Ok(Halt::End));
        });
        (frame, player.counts().violations)
    };
    let whole = draw(&[], PlayerSettings::default()).0;
    let confined = PlayerSettings {
        window: Some(granted),
        ..PlayerSettings::default()
    };
    let ways = [
        (&[asked][..], PlayerSettings::default(), asked, 0),
        (&[], confined, granted, 0),
        (&[asked], confined, asked, 0),
        // What is not granted changes nothing.
        (&[asked, wide], confined, asked, 1),
        (&[wide], confined, granted, 1),
    ];
    for (windows, settings, window, violations) in ways {
        let (frame, count) = draw(windows, settings);
        assert_eq!(count, violations);
        let mut seen = 0;
        for (i, (pixel, open)) in frame.iter().zip(&whole).enumerate() {
            let (x, y) = (i as u16 % WIDTH, i as u16 / WIDTH);
            let expected = if has(window, x, y) { *open } else { 0 };
            assert_eq!(*pixel, expected, "{window:?} {x} {y}");
            seen += u32::from(*pixel != 0);
        }
        assert!(seen > 50, "{seen}");
    }
}
