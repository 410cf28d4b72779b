//! Draws the test scenes on a Cortex-M in QEMU (mps2-an386, an M4; mps2-an385, an M3).
//!
//! What it prints, a line each, is what the host's firmware runner reads:
//! ```text
//! count name=loop expected=2000000 counted=2000000 ok=1
//! count name=sheet_1 expected=76800 counted=76800 ok=1
//! frame scene=teapot crc=1234abcd instructions=123456
//! kernel name=smooth_565 pixels=2016 spans=63 instructions=12345
//! unit name=active_line count=480 instructions=17280
//! lines scene=sphere pass_one=123456 first=0 costs=1200,1205,1300
//! growth slots=64 triangles=72 objects=31 pass_one=12345 pass_two=123456
//! figure name=stack_bytes value=1234
//! done frames=1
//! ```
//! A `sheet` is a random mesh over the whole picture whose every pixel has to be hit exactly once.
//! The checksum is the CRC-32 of PNG and zip over the bytes of a frame in scan-out order. A frame is
//! drawn twice, once to hash it and once to count it, so that hashing is not counted; both must
//! give the same number of bytes. Kernels, units, lines and growth are there where the host says `bench`;
//! `costs` are those of lines one after the other, from the `first` of this row on. Exit code 0 only if everything held.
//! Where the host says `paced`, there are `lines` alone, of renderers that are paced and have time enough.
//! Where the host says `scene`, there is one frame, of the words that it has laid into flash, with its lines and figures.
#![no_std]
#![no_main]

mod bench;
mod bench_depth;
mod bench_texture;
mod console;
mod count;
mod flashed;
mod frames;
mod lend;
mod listed;
mod profile;
mod rest;
mod rooms;
mod unpacked;

use core::hint::black_box;

// Supplies the critical-section implementation, also where nothing else names it.
use cortex_m as _;
use cortex_m::Peripherals;
use cortex_m_rt::entry;
use crc::{CRC_32_ISO_HDLC, Crc};

use console::Console;
use count::Counter;
use frames::{draw, lines_of};
use rooms::Rooms;
use scanbeam::list::ListCommand;
use scenes::{Frame, PACED, SHEETS, Sheet, frames};

pub(crate) static CRC: Crc<u32> = Crc::<u32>::new(&CRC_32_ISO_HDLC);

/// Whether there are scenes out of flash and the bench: where everything is checked, frames alone are drawn.
const IS_WHOLE: bool = !cfg!(debug_assertions);

#[entry]
fn main() -> ! {
    let mut console = Console::open();
    if let Some(success) = profile::asked(&mut console) {
        console::exit(success);
    }
    if !IS_WHOLE && ["bench", "paced", "scene"].into_iter().any(profile::asks) {
        console.line(format_args!(
            "where everything is checked, there are frames alone"
        ));
        console::exit(false);
    }
    let peripherals = Peripherals::take().expect("main runs once");
    let mut counter = Counter::start(peripherals.SYST);
    if IS_WHOLE && profile::asks("scene") {
        flashed::run(&counter, &mut console);
        console::exit(true);
    }
    if IS_WHOLE && profile::asks("paced") {
        bench::run_unhurried(&counter, &mut console, &mut Rooms::take());
        console.line(format_args!("done frames=0"));
        console::exit(true);
    }
    let mut all_hold = true;

    for check in count::check(&mut counter) {
        all_hold &= check.holds();
        console.line(format_args!(
            "count name={} expected={} counted={} ok={}",
            check.name,
            check.expected,
            check.counted,
            u8::from(check.holds())
        ));
    }

    let mut rooms = Rooms::take();
    for seed in 1..=SHEETS {
        let (expected, seen) = (Sheet::pixels(), rooms.sheet_hits(seed));
        let holds = seen.hits == expected && seen.missed == 0 && seen.left_out == 0;
        all_hold &= holds;
        console.line(format_args!(
            "count name=sheet_{seed} expected={expected} counted={} ok={}",
            seen.hits,
            u8::from(holds)
        ));
    }

    let mut count = 0;
    for (name, frame) in frames() {
        let (crc, bytes) = hash(frame, &mut rooms);
        let mut counted_bytes = 0;
        let instructions = counter.instructions(|| {
            draw(frame, lines_of(frame), &mut rooms, &mut |line: &[u8]| {
                counted_bytes += black_box(line).len();
            });
        });
        assert_eq!(
            counted_bytes, bytes,
            "{name} has another length when redrawn"
        );
        console.line(format_args!(
            "frame scene={name} crc={crc:08x} instructions={instructions}"
        ));
        count += 1;
    }
    if IS_WHOLE {
        for paced in PACED {
            let worst = bench::worst_line(Frame::Paced(paced), &counter, &mut rooms);
            let name = paced.name;
            console.line(format_args!("figure name=worst_line_{name} value={worst}"));
        }
    }
    // What frames take; kernels lend memory from the stack.
    let stack = rooms::stack_peak();

    if IS_WHOLE && profile::asks("bench") {
        bench::run(&counter, &mut console, &mut rooms);
        bench_texture::run(&counter, &mut console);
        bench_depth::run(&counter, &mut console);
    }

    // What reading a list costs beyond the same immediate calls.
    let unpacked = rooms::unpacked();
    // Looked at and drawn, and drawn again.
    let (mut first, mut again) = ((0, 0), (0, 0));
    let by_start = counter.instructions(|| {
        first = black_box(listed::by_list(ListCommand::Start(0), &mut rooms));
    });
    let by_restart = counter.instructions(|| {
        again = black_box(listed::by_list(ListCommand::Restart, &mut rooms));
    });
    let mut called = (0, 0);
    let by_draws = counter.instructions(|| {
        called = black_box(listed::by_draws(&unpacked, &mut rooms));
    });
    // The same vertices, and the same objects of them.
    all_hold &= first == again && first == called && first.1 > 0;
    for (name, value) in [
        ("list_vertices", u64::from(first.0)),
        ("list_checked", by_start),
        ("list_pass_one", by_restart),
        ("calls_pass_one", by_draws),
    ] {
        console.line(format_args!("figure name={name} value={value}"));
    }

    console.line(format_args!("figure name=stack_bytes value={stack}"));
    console.line(format_args!("done frames={}", count));
    console::exit(all_hold)
}

/// Draws a frame for its checksum and its length in bytes.
fn hash(frame: Frame, rooms: &mut Rooms) -> (u32, usize) {
    let mut digest = CRC.digest();
    let mut bytes = 0;
    draw(frame, lines_of(frame), rooms, &mut |line: &[u8]| {
        digest.update(line);
        bytes += line.len();
    });
    (digest.finalize(), bytes)
}
