//! Texels along a parabola of places in one word.
//!
//! Instructions a texel (rustc 1.95, opt-level 3, counted in QEMU): of words as [`perspective`](super::perspective) says;
//! of indices of 8 bits 12 on a Cortex-M4 and 22 on a Cortex-M0+, of 4 bits 16 and 27.

use super::fetch::texel;
use crate::num::rolled;
use crate::scene::{Bent, Form, Square, Texture};
use core::hint::black_box as unknown;

/// Copies a square's texels into `run` along a parabola: as `fetch::copy_from`, and the step grows by a second one at each
/// pixel.
#[inline(always)]
pub(super) fn copy_arc(run: &mut [u16], square: Bent<'_>, at: u32, steps: [u32; 2]) {
    match square {
        Bent::Words(Square::Side32(t)) => copy_square(run, t, at, steps),
        Bent::Words(Square::Side64(t)) => copy_square(run, t, at, steps),
        Bent::Words(Square::Side128(t)) => copy_square(run, t, at, steps),
        Bent::Words(Square::Side256(t)) => copy_square(run, t, at, steps),
        Bent::Indices(t) => copy_indices(run, t, at, steps),
    }
}

/// [`copy_arc`] from a square of words.
#[inline(never)]
fn copy_square<const SIDE: usize>(
    run: &mut [u16],
    t: &[[u16; SIDE]; SIDE],
    mut at: u32,
    [mut step, turn]: [u32; 2],
) {
    let mut draw = |pixel: &mut u16, turn: u32| {
        *pixel = texel(t, at);
        at = at.wrapping_add(step);
        step = step.wrapping_add(turn);
    };
    let mut eights = run.chunks_exact_mut(8);
    for eight in eights.by_ref() {
        // Unknown to the compiler, which would keep multiples of it.
        let turn = unknown(turn);
        if let Ok(eight) = <&mut [u16; 8]>::try_from(eight) {
            eight.iter_mut().for_each(|pixel| draw(pixel, turn));
        }
    }
    for pixel in eights.into_remainder() {
        rolled();
        draw(pixel, turn);
    }
}

/// [`copy_arc`] from a square of indices.
#[inline(never)]
pub(super) fn copy_indices(run: &mut [u16], texture: &Texture<'_>, at: u32, steps: [u32; 2]) {
    match texture.log_width() {
        5 => bent_indices::<5>(run, texture.form, at, steps),
        6 => bent_indices::<6>(run, texture.form, at, steps),
        _ => bent_indices::<7>(run, texture.form, at, steps),
    }
}

/// The same of `2^LOG` texels a side.
#[inline(always)]
fn bent_indices<const LOG: u32>(run: &mut [u16], form: Form<'_>, at: u32, steps: [u32; 2]) {
    match form {
        Form::Index8(..) => bent::<LOG>(run, at, steps, |i| form.get(i)),
        Form::Index4(..) => bent::<LOG>(run, at, steps, |i| form.get(i)),
        _ => {}
    }
}

/// The loop of [`bent_indices`]: one check a texel, which never fails and keeps the loop from being unrolled.
#[inline(always)]
fn bent<const LOG: u32>(
    run: &mut [u16],
    mut at: u32,
    [mut step, turn]: [u32; 2],
    texel: impl Fn(usize) -> Option<u16>,
) {
    for pixel in run {
        let (row, column) = (at >> (32 - LOG), (at & 0xFFFF) >> (16 - LOG));
        let Some(texel) = texel((row << LOG | column) as usize) else {
            return;
        };
        *pixel = texel;
        at = at.wrapping_add(step);
        step = step.wrapping_add(turn);
    }
}
