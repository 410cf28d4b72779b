//! What things cost, by instructions.
//!
//! | file | there |
//! |---|---|
//! | `methods.rs` | the methods of the laboratory |
//! | `triangle.rs` | one triangle in the ways that draw calls have, and its spans |
//! | `lines.rs` | each line of a scene (X8), and pass one |
//! | `units.rs` | an active line, a span's entry, a triangle's set-up, a vertex |
//! | `growth.rs` | spheres of 72 to 20,000 triangles |
//!
//! Here are the kernels, each alone, over long and over short spans: two equations for what a pixel and what a span
//! costs.
//!
//! All but LIRP are what the line renderer runs: a right triangle of [`LINES`] lines that is alone
//! on the picture, drawn once it is set up. What a span costs is then all that is not the pixels:
//! the line's entry, the active list, the edges, the planes' values.

mod growth;
mod lines;
mod methods;
mod triangle;
mod units;

pub(crate) use lines::{Listed, run_unhurried, worst_line};

use crate::console::Console;
use crate::count::Counter;
use crate::rooms::Rooms;
use core::fmt::Display;
use core::hint::black_box;
use scanbeam_model::{SPAN_BITS, SpanWeight, divided_weight, lirp, round_to_8, widen};

/// Lines of a triangle. The first sets it up, and is not counted.
const LINES: u16 = 63;
/// Pixels of a line.
const WIDTH: u16 = 320;
/// Widest spans of a small triangle, and of any.
const WIDEST: [i32; 2] = [63, 320];
/// Widest spans where they are to be short.
const SHORT: i32 = 8;

/// What a kernel took.
#[derive(Clone, Copy)]
struct Run {
    instructions: u64,
    spans: u32,
    pixels: u32,
}

impl Run {
    fn print(self, name: impl Display, console: &mut Console) {
        let Self {
            instructions,
            spans,
            pixels,
        } = self;
        console.line(format_args!(
            "kernel name={name} pixels={pixels} spans={spans} instructions={instructions}"
        ));
    }
}

/// Measures everything and prints it.
pub(crate) fn run(counter: &Counter, console: &mut Console, rooms: &mut Rooms) {
    triangle::run(counter, console, rooms);
    for width in [WIDEST[1], SHORT] {
        blend::<10>(width as u16, counter).print("model_lirp_10", console);
        blend::<12>(width as u16, counter).print("model_lirp_12", console);
        blend::<16>(width as u16, counter).print("model_lirp_16", console);
    }
    triangle::run_beside_methods(counter, console, rooms);
    methods::run(counter, console);
    units::run(counter, console, rooms);
    lines::run(counter, console, rooms);
    growth::run(counter, console, rooms);
}

/// Spans by LIRP with `N` bits of W: by the circuit of W(X) for 10, by division for more.
#[inline(never)]
fn blend<const N: u32>(width: u16, counter: &Counter) -> Run {
    let mut line = [[0u8; 3]; WIDTH as usize];
    let instructions = counter.finely(|| {
        for _ in 0..LINES {
            let pixels = black_box(&mut line[..usize::from(width)]);
            blend_span::<N>(pixels, black_box([[250, 10, 128], [3, 200, 90]]));
        }
    });
    Run {
        instructions,
        spans: LINES.into(),
        pixels: u32::from(LINES) * u32::from(width),
    }
}

#[inline(never)]
fn blend_span<const N: u32>(pixels: &mut [[u8; 3]], ends: [[u8; 3]; 2]) {
    let [a, b] = ends.map(|end| end.map(|level| i64::from(widen(level.into(), 8, 10))));
    let length = 8 * pixels.len() as u16;
    let circuit = SpanWeight::new(length);
    for (pixel, distance) in pixels.iter_mut().zip((4..).step_by(8)) {
        let w = if N == SPAN_BITS {
            circuit.at(distance).into()
        } else {
            divided_weight(distance, length, N)
        };
        *pixel = [0, 1, 2].map(|i| round_to_8(lirp(a[i], b[i], w, N) as u16));
    }
}
