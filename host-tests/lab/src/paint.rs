//! Colours into the pixels of a span, by a method (K6, K7, P3).

use crate::colours::Colours;
use crate::format::{FRACTION, Format};
use crate::lirp::{blend, blend_packed};
use crate::method::Method;

/// Writes the pixels of a span that are `seen`, which is asked once a pixel, from the first on.
#[inline(always)]
pub fn paint<F: Format>(
    method: Method,
    colours: &Colours,
    pixels: &mut [F::Word],
    seen: &mut impl FnMut() -> bool,
) {
    let count = pixels.len() as u32;
    if count == 0 {
        return;
    }
    match method.of_span(count, || colours.slope::<F>(), F::PACKING) {
        Method::Packed8 => packed::<F, 8>(colours, pixels, seen),
        Method::Packed16 => packed::<F, 16>(colours, pixels, seen),
        Method::Half => rate::<F, 2>(colours, pixels, seen),
        Method::Quarter => rate::<F, 4>(colours, pixels, seen),
        Method::Whole => {
            let middle = colours.after_halves(count - 1);
            group(pixels, middle.pixel::<F>(), seen);
        }
        Method::Lirp(10) => blend::<F, 10>(ends::<F>(colours, count), pixels, seen),
        Method::Lirp(12) => blend::<F, 12>(ends::<F>(colours, count), pixels, seen),
        Method::Lirp(_) => blend::<F, 16>(ends::<F>(colours, count), pixels, seen),
        Method::LirpPacked => blend_packed::<F>(ends::<F>(colours, count), pixels, seen),
        Method::Plane | Method::Within(_) => plane::<F>(colours, pixels, seen),
    }
}

/// The colours of the first and the last pixel.
#[inline(always)]
fn ends<F: Format>(colours: &Colours, count: u32) -> [[u32; 3]; 2] {
    [*colours, colours.after(count - 1)].map(|end| end.channels::<F>())
}

/// Some pixels of one colour.
#[inline(always)]
fn group<W: Copy>(pixels: &mut [W], word: W, seen: &mut impl FnMut() -> bool) {
    for pixel in pixels {
        if seen() {
            *pixel = word;
        }
    }
}

/// A chunk as an array, so that loops over it have no end to watch for.
#[inline(always)]
fn array<W, const N: usize>(chunk: &mut [W]) -> Option<&mut [W; N]> {
    chunk.try_into().ok()
}

/// Three channels stepped forward.
#[inline(never)]
fn plane<F: Format>(colours: &Colours, pixels: &mut [F::Word], seen: &mut impl FnMut() -> bool) {
    let Colours { mut at, step } = *colours;
    for pixel in pixels {
        if seen() {
            *pixel = F::pack(at.map(|at| (at >> FRACTION) as u8));
        }
        at = [0, 1, 2].map(|i| at[i].wrapping_add(step[i]));
    }
}

/// A packed ramp, anchored anew every `RUN` pixels.
#[inline(never)]
fn packed<F: Format, const RUN: usize>(
    colours: &Colours,
    pixels: &mut [F::Word],
    seen: &mut impl FnMut() -> bool,
) {
    let mut from = *colours;
    let mut runs = pixels.chunks_exact_mut(RUN);
    for run in runs.by_ref().filter_map(array::<_, RUN>) {
        ramped::<F>(&from, run, seen);
        from = from.after(RUN as u32);
    }
    ramped::<F>(&from, runs.into_remainder(), seen);
}

#[inline(always)]
fn ramped<F: Format>(from: &Colours, pixels: &mut [F::Word], seen: &mut impl FnMut() -> bool) {
    let mut ramp = from.ramp::<F>();
    for pixel in pixels {
        if seen() {
            *pixel = F::pixel(&ramp);
        }
        ramp.step();
    }
}

/// One colour for `N` pixels, that of their middle, by a ramp that steps from group to group and is anchored anew every 4
/// groups. The pixels left over at the end have their own middle, so no colour is asked for beyond the span.
#[inline(never)]
fn rate<F: Format, const N: usize>(
    colours: &Colours,
    pixels: &mut [F::Word],
    seen: &mut impl FnMut() -> bool,
) {
    let count = pixels.len() as u32;
    let over = count % N as u32;
    let mut middle = colours.after_halves(N as u32 - 1).coarse(N as u32);
    let (whole, last) = pixels.split_at_mut((count - over) as usize);
    for run in whole.chunks_mut(4 * N) {
        let mut ramp = middle.ramp::<F>();
        for some in run.chunks_exact_mut(N).filter_map(array::<_, N>) {
            group(some, F::pixel(&ramp), seen);
            ramp.step();
        }
        middle = middle.after(4);
    }
    if over > 0 {
        let end = colours.after(count - over).after_halves(over - 1);
        group(last, end.pixel::<F>(), seen);
    }
}
