//! Lines that cost no more than they may, of a picture that may have several parts (X9).

use scanbeam::Renderer;
use scanbeam::frame::{Pace, Paid};
use scanbeam::look::Look;
use serde_json::{Value, json};

/// A renderer whose lines cost so much at most, in M4 code, if there is a limit.
pub(crate) fn paced<L: Look, const WORDS: usize>(
    renderer: Renderer<'_, L, WORDS>,
    most: Option<u32>,
) -> Renderer<'_, L, WORDS> {
    let costs = match L::TEXTURED {
        true => Pace::TEXTURED_M4,
        false => Pace::GOURAUD_M4,
    };
    match most {
        None => renderer,
        Some(most) => renderer.paced(Pace { most, ..costs }),
    }
}

/// Adds what was paid in another part.
pub(crate) fn add(all: &mut Paid, one: &Paid) {
    all.lines += one.lines;
    all.even += one.even;
    all.joined += one.joined;
    all.unsorted += one.unsorted;
    all.left_out += one.left_out;
    all.late += one.late;
    all.lost += one.lost;
    all.dearest = all.dearest.max(one.dearest);
}

/// What was paid, as `render --stats` writes it.
pub(crate) fn to_json(paid: &Paid) -> Value {
    json!({
        "lines": paid.lines,
        "even": paid.even,
        "joined": paid.joined,
        "unsorted": paid.unsorted,
        "left_out": paid.left_out,
        "late": paid.late,
        "lost": paid.lost,
        "dearest": paid.dearest,
    })
}
