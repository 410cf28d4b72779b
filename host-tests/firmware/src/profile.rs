//! One frame alone, for whoever steps through it: between the marks is nothing but its drawing.
//!
//! The host asks for it by words that semihosting hands over, `qemu-firmware profile NAME`, or `scene profile` for what
//! it has laid into flash, and logs every instruction between the marks.

use crate::console::Console;
use crate::frames::{Receives, draw, lines_of};
use crate::rooms::Rooms;
use core::hint::black_box;
use cortex_m_semihosting::nr;
use scenes::{Frame, frames};

/// Bytes that the words may have.
const WORDS: usize = 128;

/// Where the host starts to count. Each mark has a number of its own, which nobody may leave out, so
/// that neither is dropped, nor folded into the other.
#[inline(never)]
#[unsafe(no_mangle)]
extern "C" fn scanbeam_profile_begin() {
    black_box(1);
}

/// Where it ends.
#[inline(never)]
#[unsafe(no_mangle)]
extern "C" fn scanbeam_profile_end() {
    black_box(2);
}

/// Draws the frame that the host asks for, if it asks for one: whether that went well.
pub(crate) fn asked(console: &mut Console) -> Option<bool> {
    let mut line = [0; WORDS];
    let mut words = words(&mut line)?.split_ascii_whitespace().skip(1);
    if words.next() != Some("profile") {
        return None;
    }
    let name = words.next().unwrap_or_default();
    let Some((_, frame)) = frames().find(|(known, _)| *known == name) else {
        console.line(format_args!("there is no frame `{name}`; there are:"));
        for (known, _) in frames() {
            console.line(format_args!("{known}"));
        }
        return Some(false);
    };
    let mut rooms = Rooms::take();
    if let Frame::InParts(suite) = frame {
        // It is cut once, which is not the frame's.
        rooms.in_parts(suite);
    }
    marked(&mut |to| draw(frame, lines_of(frame), &mut rooms, to));
    Some(true)
}

/// Draws between the marks.
pub(crate) fn marked(draw: &mut dyn FnMut(&mut dyn Receives)) {
    let mut bytes = 0;
    scanbeam_profile_begin();
    draw(&mut |line: &[u8]| bytes += black_box(line).len());
    scanbeam_profile_end();
    black_box(bytes);
}

/// Whether the host asks for something beyond frames: `bench` for kernels, units, lines and growth too, `paced` for lines
/// that may cost what they like alone, `scene` for the scene that it has laid into flash alone.
pub(crate) fn asks(what: &str) -> bool {
    says(1, what)
}

/// Whether that scene is to be stepped through: `qemu-firmware scene profile`.
pub(crate) fn asks_steps() -> bool {
    says(2, "profile")
}

/// Whether one of the words that the host hands over is this; the first is the program's own name.
fn says(at: usize, word: &str) -> bool {
    let mut line = [0; WORDS];
    words(&mut line).is_some_and(|said| said.split_ascii_whitespace().nth(at) == Some(word))
}

/// The words that the host hands over; `None` where there are none, or too many.
fn words(line: &mut [u8; WORDS]) -> Option<&str> {
    let mut block = [line.as_mut_ptr() as usize, line.len()];
    // SAFETY: the block names a room and its size; the call sets both to what it filled.
    let failed =
        unsafe { cortex_m_semihosting::syscall1(nr::GET_CMDLINE, (&raw mut block) as usize) != 0 };
    let said = line.get(..block[1]).filter(|_| !failed)?;
    Some(core::str::from_utf8(said).ok()?.trim_end_matches('\0'))
}
