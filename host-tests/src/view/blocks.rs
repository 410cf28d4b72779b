//! A picture as text: half blocks in 24-bit colours.

use crate::image_out::Frame;
use std::fmt::Write;

/// The upper half of a cell in the foreground's colour; the rest is the background's.
const UPPER_HALF: char = '\u{2580}';
/// Ends colours.
const PLAIN: &str = "\x1b[0m";

/// A line of text for each two rows of pixels, each ended by `line_end`; an odd last row stands
/// over black. A colour is said where it differs from that of the cell before.
#[must_use]
pub fn half_blocks(frame: &Frame, line_end: &str) -> String {
    let width = frame.width() as usize;
    let pixels: Vec<[u8; 3]> = frame
        .rgb()
        .chunks_exact(3)
        .map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    let rows: Vec<&[[u8; 3]]> = pixels.chunks_exact(width).collect();
    let black = vec![[0; 3]; width];
    let mut text = String::new();
    for pair in rows.chunks(2) {
        let lower = pair.get(1).copied().unwrap_or(&black);
        let (mut above, mut below) = (None, None);
        for (&upper, &lower) in pair[0].iter().zip(lower) {
            say(&mut text, &mut above, 38, upper);
            say(&mut text, &mut below, 48, lower);
            text.push(UPPER_HALF);
        }
        text.push_str(PLAIN);
        text.push_str(line_end);
    }
    text
}

/// Says a colour, unless it is the last one that was said.
fn say(text: &mut String, last: &mut Option<[u8; 3]>, which: u8, colour: [u8; 3]) {
    if last.replace(colour) != Some(colour) {
        let [r, g, b] = colour;
        // Writing to a String cannot fail.
        let _ = write!(text, "\x1b[{which};2;{r};{g};{b}m");
    }
}
