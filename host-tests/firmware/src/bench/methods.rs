//! The methods of the laboratory, each on the spans of a right triangle of [`LINES`] lines.
//!
//! Names: method, pixel format, `_large` for spans of up to 320 pixels in place of 63, `_depth` where each span is drawn
//! before another one that it hides: a pixel is one of both. Both widths are large, one twice the other: what differs is
//! pixels alone, and what a method takes to begin and to end counts for the span.
//!
//! `kept1` to `kept8` are `packed16` with what it takes to have the span's colours, from planes on every line, or on every
//! second, third and eighth.

use super::{LINES, Run, WIDEST, WIDTH};
use crate::console::Console;
use crate::count::Counter;
use core::hint::black_box;
use core::slice::IterMut;
use scanbeam::pixel::{Rgb565, Rgb888};
use scanbeam_lab::bits::{BITS, bits};
use scanbeam_lab::depth::{Depths, resolve, words};
use scanbeam_lab::format::FRACTION;
use scanbeam_lab::kept::{ColourPlanes, Kept, Span};
use scanbeam_lab::{Colours, Format, Method, Triangle, paint};
use scanbeam_model::BlockFix16;

const METHODS: [(&str, Method); 12] = [
    ("forward", Method::Plane),
    ("packed8", Method::Packed8),
    ("packed16", Method::Packed16),
    ("half", Method::Half),
    ("quarter", Method::Quarter),
    ("lirp10", Method::Lirp(10)),
    ("lirp12", Method::Lirp(12)),
    ("lirp16", Method::Lirp(16)),
    ("lirp_packed", Method::LirpPacked),
    ("auto_fast", Method::FAST),
    ("auto_balanced", Method::BALANCED),
    ("auto_exact", Method::EXACT),
];

/// Lines after which colours are taken anew.
const KEPT: [(&str, u16); 4] = [("kept1", 1), ("kept2", 2), ("kept3", 3), ("kept8", 8)];

/// Colours of a triangle's corners: at the left of its top, at the right of it, and below.
const ENDS: [[u8; 3]; 3] = [[255, 0, 30], [0, 200, 60], [90, 255, 255]];

/// Spans of a triangle but for its first line's.
const SPANS: usize = LINES as usize - 1;

/// A line of pixels, and one of depths.
struct Lines<F: Format> {
    pixels: [F::Word; WIDTH as usize],
    cells: [u32; WIDTH as usize],
}

/// Times all methods and prints them, and whether they draw what they draw elsewhere.
pub(super) fn run(counter: &Counter, console: &mut Console) {
    let counted = bits();
    console.line(format_args!(
        "count name=methods expected={BITS} counted={counted} ok={}",
        u8::from(counted == BITS)
    ));
    assert_eq!(counted, BITS, "methods draw other bits than elsewhere");
    for (size, widest) in [("", WIDEST[0]), ("_large", WIDEST[1])] {
        for width in [widest, widest / 2] {
            let of_565 = spans::<Rgb565>(width, widest);
            let of_888 = spans::<Rgb888>(width, widest);
            for (method, how) in METHODS {
                let mut print = |format, depth, run: Run| {
                    run.print(format_args!("{method}_{format}{size}{depth}"), console);
                };
                print("565", "", plain::<Rgb565>(how, &of_565, counter));
                print("888", "", plain::<Rgb888>(how, &of_888, counter));
                print("565", "_depth", hidden(how, &of_565, counter));
            }
            for (name, every) in KEPT {
                kept(every, width, counter).print(format_args!("{name}_565{size}"), console);
            }
            block_fixed(&of_565, counter).print(format_args!("block_fix_565{size}"), console);
            worded(&of_565, counter).print(format_args!("word_565{size}"), console);
        }
    }
}

/// The spans of a triangle that is so wide at its top. The slope of colours is that of the widest.
fn spans<F: Format>(width: i32, widest: i32) -> [(Colours, usize); SPANS] {
    let level = |corner: usize, i: usize| {
        i64::from(F::STEPS[i]) * (i64::from(ENDS[corner][i]) << FRACTION) / 255
            + (1 << (FRACTION - 1))
    };
    core::array::from_fn(|line| {
        let left = LINES as i32 - 1 - line as i32;
        let at = [0, 1, 2].map(|i| {
            let down = level(2, i) - level(0, i);
            (level(0, i) + down * line as i64 / i64::from(LINES)) as i32
        });
        let step = [0, 1, 2].map(|i| ((level(1, i) - level(0, i)) / i64::from(widest)) as i32);
        let pixels = (width * left / i32::from(LINES)).max(1);
        (Colours { at, step }, pixels as usize)
    })
}

/// Counts what is done for all spans.
fn timed<F: Format>(
    spans: &[(Colours, usize); SPANS],
    counter: &Counter,
    mut each: impl FnMut(&mut Lines<F>, &Colours, usize),
) -> Run {
    let mut lines = Lines::<F> {
        pixels: [F::Word::default(); WIDTH as usize],
        cells: [0; WIDTH as usize],
    };
    let instructions = counter.finely(|| {
        for (colours, pixels) in black_box(spans) {
            each(black_box(&mut lines), colours, *pixels);
        }
    });
    Run {
        instructions,
        spans: SPANS as u32,
        pixels: spans.iter().map(|(_, pixels)| *pixels as u32).sum(),
    }
}

#[inline(never)]
fn plain<F: Format>(method: Method, spans: &[(Colours, usize); SPANS], counter: &Counter) -> Run {
    timed::<F>(spans, counter, |lines, colours, pixels| {
        paint::<F>(method, colours, &mut lines.pixels[..pixels], &mut || true);
    })
}

/// Those of a right triangle that is so wide at its top, each of a pixel at least; colours are taken on every line without
/// asking whether there are some.
#[inline(never)]
fn kept(every: u16, width: i32, counter: &Counter) -> Run {
    let triangle = Triangle {
        place: [[0, 0], [8 * width, 0], [0, 8 * i32::from(LINES)]],
        depth: [1; 3],
        colour: ENDS,
    };
    let spans: [Span; SPANS] = core::array::from_fn(|line| {
        let line = line as u16;
        Span::of(&triangle, line).unwrap_or(Span {
            column: 0,
            pixels: 1,
            line,
            turns: false,
        })
    });
    let planes = ColourPlanes::new::<Rgb565>(&triangle);
    let mut pixels = [0; WIDTH as usize];
    let mut painted = |colours: &Colours, span: &Span| {
        let run = &mut pixels[..span.pixels as usize];
        paint::<Rgb565>(Method::Packed16, colours, run, &mut || true);
    };
    let instructions = counter.finely(|| {
        let mut kept = Kept::new(every);
        for span in black_box(&spans) {
            let colours = if every == 1 {
                planes.at(span.column, span.line)
            } else {
                kept.of_span::<Rgb565>(&planes, span)
            };
            painted(&colours, span);
        }
    });
    Run {
        instructions,
        spans: SPANS as u32,
        pixels: spans.iter().map(|span| span.pixels).sum(),
    }
}

/// 1/w of what is in front and of what is behind.
const DEPTHS: [Depths; 2] = [
    Depths {
        at: 1 << 30,
        step: 1 << 16,
    },
    Depths {
        at: 1 << 29,
        step: 1 << 15,
    },
];

/// Whether the next pixel is not behind what is in its cell.
#[inline(always)]
fn is_seen<C: Copy>(cells: &mut IterMut<'_, C>, keep: impl FnOnce(C) -> Option<C>) -> bool {
    let Some(cell) = cells.next() else {
        return false;
    };
    let kept = keep(*cell);
    if let Some(kept) = kept {
        *cell = kept;
    }
    kept.is_some()
}

#[inline(never)]
fn hidden(method: Method, spans: &[(Colours, usize); SPANS], counter: &Counter) -> Run {
    timed::<Rgb565>(spans, counter, |lines, colours, pixels| {
        for Depths { mut at, step } in black_box(DEPTHS) {
            let mut cells = lines.cells[..pixels].iter_mut();
            paint::<Rgb565>(method, colours, &mut lines.pixels[..pixels], &mut || {
                let depth = at;
                at = at.wrapping_add(step);
                is_seen(&mut cells, |kept| (depth >= kept).then_some(depth))
            });
        }
    })
}

#[inline(never)]
fn block_fixed(spans: &[(Colours, usize); SPANS], counter: &Counter) -> Run {
    let mut line = [0u16; WIDTH as usize];
    timed::<Rgb565>(spans, counter, |lines, colours, pixels| {
        for Depths { mut at, step } in black_box(DEPTHS) {
            let range = BlockFix16::range_of(at);
            let mut cells = line[..pixels].iter_mut();
            let pixels = &mut lines.pixels[..pixels];
            paint::<Rgb565>(Method::Packed16, colours, pixels, &mut || {
                let depth = BlockFix16::new(at, range);
                at = at.wrapping_add(step);
                is_seen(&mut cells, |kept| {
                    let nearer = depth.covers(BlockFix16::from_bits(kept));
                    nearer.then_some(depth.to_bits())
                })
            });
        }
    })
}

/// What it takes to read the line out of the words is in it.
#[inline(never)]
fn worded(spans: &[(Colours, usize); SPANS], counter: &Counter) -> Run {
    timed::<Rgb565>(spans, counter, |lines, colours, pixels| {
        for depths in black_box(DEPTHS) {
            words(&mut lines.cells[..pixels], depths, colours);
        }
        resolve(&mut lines.cells[..pixels], &mut lines.pixels[..pixels]);
    })
}
