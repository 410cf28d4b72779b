//! Commands that come while others are taken.

use super::{ListCommand, ListControl};
use core::sync::atomic::{AtomicU32, Ordering};

const COMMANDS: [ListCommand; 7] = [
    ListCommand::Start(7),
    ListCommand::Restart,
    ListCommand::Resume,
    ListCommand::StopNow,
    ListCommand::StopAtEnd,
    ListCommand::Step,
    ListCommand::Start(u32::MAX),
];

fn word(of: &AtomicU32) -> u32 {
    of.load(Ordering::SeqCst)
}

/// A command that comes between any two steps of the one who takes is taken next, and once.
///
/// Kills: one who takes and writes what the sender writes, so that a command is lost; commands that are alike and taken
/// for one; a command that is taken twice.
#[test]
fn no_command_is_lost_while_another_is_taken() {
    let control = ListControl::new();
    assert_eq!(control.take(), None);
    for first in COMMANDS {
        for second in COMMANDS {
            control.send(first);
            let (sent, start) = (word(&control.sent), word(&control.start));
            assert_eq!(control.take(), Some(first));
            // Only the sender writes these.
            assert_eq!((word(&control.sent), word(&control.start)), (sent, start));
            // What was written comes after the second command instead, which no step of it sees.
            let taken = word(&control.taken);
            control.send(second);
            assert_eq!(word(&control.taken), taken);
            assert_eq!([(); 2].map(|()| control.take()), [Some(second), None]);
            // The last counts.
            control.send(first);
            control.send(second);
            assert_eq!([(); 2].map(|()| control.take()), [Some(second), None]);
        }
    }
    control.sent.store(u32::MAX, Ordering::SeqCst);
    control.taken.store(u32::MAX, Ordering::SeqCst);
    control.send(ListCommand::Step);
    assert_eq!(control.take(), Some(ListCommand::Step));
}
