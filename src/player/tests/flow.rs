//! Counts, positions, and what goes on with what.

use super::*;
use crate::geometry::{Affine, ShadowLight, ShadowMemory};
use crate::list::{self, Id, ListCommand, ListControl, Missing, Reason};
use crate::num::I2F14;
use crate::scene::{Draw, Shadow};
use std::boxed::Box;

/// Kills: words that were passed over are added without a look at how many there are already.
#[test]
fn counts_stay_at_the_largest_number() {
    let passed = 16 << 16;
    let mut list = behind(passed);
    for _ in 0..16 {
        list.push(block(8, 65_535, 0));
        list.resize(list.len() + 65_535, 0);
    }
    list.extend([flow(5), 0]);
    let list = listed(&list);
    let mut player = player(PlayerSettings::default(), Lent::SOME);
    drawn(|scene| {
        let mut budget = Budget {
            instructions: 17 + 2 * 4_099,
            vertices: 0,
            jumps: u32::MAX,
        };
        let said = player.run(list, scene, &mut budget, &mut |_: Notice| {});
        assert_eq!(said, Ok(Halt::Budget));
    });
    let counts = player.counts();
    assert!(counts.skipped > 4_096 && counts.skipped_words == u32::MAX);
}

/// The words of a ring from this position on.
#[derive(Clone, Copy)]
struct From(u32, &'static [u32]);

impl Words<'static> for From {
    fn first(self) -> u32 {
        self.0
    }

    fn end(self) -> u32 {
        self.0.wrapping_add(self.1.len() as u32)
    }

    fn word(self, at: u32) -> u32 {
        self.1.word(at.wrapping_sub(self.0))
    }

    fn slice(self, _: u32, _: u32) -> Option<&'static [u32]> {
        None
    }

    fn room(self) -> Option<u32> {
        Some(1 << 16)
    }
}

/// Kills: alphas of a table that are looked for behind the last position.
#[test]
fn a_table_lies_across_the_end_of_positions() {
    let mut table = vec![block(5, 4, SHADE)];
    table.extend([0; 6]);
    table.extend([0x80FF_FFFF; 4]);
    table.extend([0; 4]);
    for first in [0xFFFF_FFFD, 0xFFFF_FFFC, 0xFFFF_FFFB, 0xFFFF_FFF1, 0] {
        let mut player = player(PlayerSettings::default(), Lent::SOME);
        player.start(first);
        let words = From(first, listed(&table));
        assert_eq!(run(&mut player, words).0, Ok(Halt::Waiting));
        assert_eq!(player.position(), first.wrapping_add(15));
    }
}

/// Kills: points that a strip goes on behind, without the triangles of the vertices before them.
#[test]
fn no_strip_goes_on_behind_points() {
    let points = [&[block(3, 1, 0)], &CORNERS[0][..]].concat();
    let mut table = vec![block(5, 4, 0)];
    for [two, _] in CORNERS {
        table.extend([two; 2]);
    }
    table.truncate(7);
    let short = [strip(&CORNERS[..3], NEW), strip(&CORNERS[3..], 0)];
    let indexed = [vec![block(6, 3, NEW), 0x0002_0100], vec![block(6, 1, 0), 3]];
    for (before, [begins, goes_on], id) in
        [(vec![], short, Id::Short), (table, indexed, Id::Indexed)]
    {
        let whole = [&before, &begins, &goes_on, &[flow(0)][..]].concat();
        let mut player = player(PlayerSettings::default(), Lent::SOME);
        assert_eq!(run(&mut player, listed(&whole)).0, Ok(Halt::End));
        let parted = [&before, &begins, &points, &goes_on, &[flow(0)][..]].concat();
        let error = ListError {
            offset: 4 * (before.len() + begins.len() + points.len()) as u32,
            block: Some(id),
            reason: Reason::Continue,
        };
        player.start(0);
        assert_eq!(run(&mut player, listed(&parted)), (Err(error), 0));
    }
}

/// In place, and in a ring behind what was drawn. Kills: the event of the block before.
#[test]
fn what_is_malformed_is_told_where_it_stands() {
    let triangle = strip(&CORNERS[..3], NEW);
    let at = 4 * triangle.len() as u32;
    let bad = [0x0200_0000];
    let mut played = player(PlayerSettings::default(), Lent::SOME);
    let (said, told) = super::told(&mut played, listed(&[&triangle, &bad[..]].concat()));
    assert_eq!(said.unwrap_err().offset, at);
    assert_eq!(told, [(Event::Malformed, at)]);
    let (mut writer, reader) = ring(64).split();
    played.start(0);
    writer.append(listed(&triangle)).unwrap();
    assert_eq!(run(&mut played, reader.words()).0, Ok(Halt::Waiting));
    writer.append(listed(&bad)).unwrap();
    let (said, told) = super::told(&mut played, reader.words());
    assert_eq!(said.unwrap_err().offset, at);
    assert_eq!(told, [(Event::Malformed, at)]);
}

/// Its shadow has no room. Kills: an error of what stands before a restart, which is handed on and not told.
#[test]
fn what_cannot_be_drawn_before_a_restart_is_told() {
    let control = Box::leak(Box::new(ListControl::new()));
    let light = ShadowLight {
        light: 0,
        direction: [I2F14::ZERO, I2F14::ZERO, I2F14::ONE],
        reach: 4,
    };
    let settings = PlayerSettings {
        casts: Vec::leak(vec![light]),
        control: Some(control),
        ..PlayerSettings::default()
    };
    let memory = ShadowMemory {
        edges: &mut [],
        positions: &mut [],
        faces: &mut [],
    };
    let mut player = player(settings, Lent::SOME).with_shadows(memory);
    let list = listed(&[&strip(&CORNERS, NEW)[..], &[flow(3)], &[flow(0)]].concat());
    let mut told = Vec::new();
    drawn(|scene| {
        let said = player.run(list, scene, &mut PLENTY.clone(), &mut |notice| {
            if notice.event == Event::Interrupt {
                control.send(ListCommand::Restart);
            }
            told.push(notice.event);
        });
        assert_eq!(said.unwrap_err().reason, Reason::Lent(list::Lent::Shadows));
    });
    assert_eq!(told, [Event::Interrupt, Event::Malformed]);
}

/// Kills: a block that asks for what there is not, and is read again.
#[test]
fn what_is_refused_is_passed_over_by_a_resume() {
    let (asks, triangle) = (material(Some(7)), strip(&CORNERS[..3], NEW));
    let behind = 4 * (asks.len() + 2 * triangle.len() + 1) as u32;
    let list = listed(&[&asks[..], &triangle, &triangle, &[flow(0)]].concat());
    let mut player = player(PlayerSettings::default(), Lent::SOME);
    let (said, _) = run(&mut player, list);
    let error = said.unwrap_err();
    assert_eq!(error.reason, Reason::NoTexture(7));
    assert_eq!(error.offset, 4 * asks.len() as u32);
    player.command(ListCommand::Resume);
    let (said, objects) = run(&mut player, list);
    assert_eq!((said, objects), (Ok(Halt::End), 1));
    assert_eq!(4 * player.position(), behind);
}

/// Kills: a model that what is drawn has only from the next matrix on, where BOUNDS has it at once.
#[test]
fn another_model_counts_from_the_next_block_on() {
    let settings = |x| {
        let plain = PlayerSettings::default();
        PlayerSettings {
            draw: Draw {
                model: Affine::placed(1.0, [x, 0.0, 0.0]).unwrap(),
                ..plain.draw
            },
            ..plain
        }
    };
    let square = strip(&CORNERS, NEW);
    let near = [state(11, 0), 0, 0, 0, 1 << 29, 2, square.len() as u32];
    // A quarter to the left.
    let mut matrix = vec![state(2, 0), 1 << 29, 0, 0, 0, 1 << 29, 0, 0, 0, 1 << 29];
    matrix.extend([1 | 0xFFFF_0000, (-1i32 << 29) as u32, 0, 0]);
    for before in [vec![], matrix] {
        for bounds in [&[][..], &near] {
            let list = |halt: &[u32]| {
                let rest = [bounds, &square].concat();
                let parts = [&material(None), &before, &square[..], halt, &rest];
                listed(&parts.concat())
            };
            let want = picture(
                &mut player(settings(0.25), Lent::SOME),
                list(&[]),
                Halt::End,
            );
            let mut player = player(settings(0.0), Lent::SOME);
            let list = list(&[flow(2)]);
            let first = picture(&mut player, list, Halt::Sync);
            player.set(settings(0.25));
            let second = picture(&mut player, list, Halt::End);
            assert!(second == want && first != want && player.counts().skipped == 0);
            // Out of sight, by BOUNDS where there is one.
            player.set(settings(50.0));
            player.start(0);
            picture(&mut player, list, Halt::Sync);
            let unseen = picture(&mut player, list, Halt::End);
            assert!(unseen.iter().all(|pixel| *pixel == 0));
            assert_eq!(player.counts().skipped > 0, !bounds.is_empty());
        }
    }
}

/// Kills: points and triangles on the screen that are refused where something else is drawn, behind what stands before.
#[test]
fn what_bounds_no_volume_is_refused_before_anything_is_drawn() {
    let plain = PlayerSettings::default();
    let settings = PlayerSettings {
        draw: Draw {
            shadow: Some(Shadow::Volume(0)),
            ..plain.draw
        },
        ..plain
    };
    let triangle = strip(&CORNERS[..3], NEW);
    let points = [&[block(3, 1, 0)], &CORNERS[0][..]].concat();
    let long = vec![block(2, 3, NEW), 0, 0x0000_0100, 0x0100_0000];
    for (block, id) in [(points, Id::Points), (long, Id::Long)] {
        let list = listed(&[&triangle, &block, &[flow(0)][..]].concat());
        let error = ListError {
            offset: 4 * triangle.len() as u32,
            block: Some(id),
            reason: Reason::Missing(Missing::Shadows),
        };
        assert_eq!(
            run(&mut player(settings, Lent::SOME), list),
            (Err(error), 0)
        );
        assert_eq!(run(&mut player(plain, Lent::SOME), list).0, Ok(Halt::End));
    }
}

/// Kills: words that are passed over to within a block, of which the rest is read as something else in silence.
#[test]
fn words_that_end_within_a_block_are_malformed_where_they_are_passed_over() {
    let triangle = strip(&CORNERS[..3], NEW);
    let bounds = behind(2);
    let list = listed(&[&triangle, &bounds, &triangle, &[flow(0)][..]].concat());
    let (said, objects) = run(&mut player(PlayerSettings::default(), Lent::SOME), list);
    let at = 4 * (triangle.len() + bounds.len() + 2) as u32;
    assert_eq!((said.unwrap_err().offset, objects), (at, 1));
}
