//! A picture as text: half blocks in 24-bit colours, or in the 256 that older terminals have.

use crate::image_out::Frame;
use clap::ValueEnum;
use crossterm::style::available_color_count;
use std::fmt::Write;

/// The upper half of a cell in the foreground's colour; the rest is the background's.
const UPPER_HALF: char = '\u{2580}';
/// Ends colours.
const PLAIN: &str = "\x1b[0m";
/// Levels of a channel in the cube of 6 x 6 x 6 colours.
const CUBE: [u8; 6] = [0, 95, 135, 175, 215, 255];

/// How colours are told to the terminal.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum Colours {
    /// As the terminal says in COLORTERM and TERM; 24 bits where there is none
    #[default]
    Auto,
    /// 24 bits
    True,
    /// The nearest of 256
    #[value(name = "256")]
    Indexed,
}

impl Colours {
    /// What `Auto` means on the terminal that the environment tells of.
    #[must_use]
    pub fn of_terminal(self) -> Self {
        match self {
            Self::Auto if available_color_count() <= 256 => Self::Indexed,
            Self::Auto => Self::True,
            said => said,
        }
    }
}

/// A line of text for each two rows of pixels; an odd last row stands over black. A colour is said
/// where it differs from that of the cell before.
#[must_use]
pub fn half_blocks(frame: &Frame, colours: Colours) -> Vec<String> {
    let width = frame.width() as usize;
    let pixels: Vec<[u8; 3]> = frame
        .rgb()
        .chunks_exact(3)
        .map(|pixel| [pixel[0], pixel[1], pixel[2]])
        .collect();
    let rows: Vec<&[[u8; 3]]> = pixels.chunks_exact(width).collect();
    let black = vec![[0; 3]; width];
    let line = |pair: &[&[[u8; 3]]]| {
        let lower = pair.get(1).copied().unwrap_or(&black);
        let mut text = String::new();
        let (mut above, mut below) = (String::new(), String::new());
        for (&upper, &lower) in pair[0].iter().zip(lower) {
            say(&mut text, &mut above, colour(38, upper, colours));
            say(&mut text, &mut below, colour(48, lower, colours));
            text.push(UPPER_HALF);
        }
        text + PLAIN
    };
    rows.chunks(2).map(line).collect()
}

/// Says a colour, unless it is the last one that was said.
fn say(text: &mut String, last: &mut String, colour: String) {
    if *last != colour {
        // Writing to a String cannot fail.
        let _ = write!(text, "\x1b[{colour}m");
        *last = colour;
    }
}

fn colour(which: u8, [r, g, b]: [u8; 3], colours: Colours) -> String {
    match colours {
        Colours::Indexed => format!("{which};5;{}", nearest([r, g, b])),
        Colours::Auto | Colours::True => format!("{which};2;{r};{g};{b}"),
    }
}

/// The nearest of the colours 16 to 255: a cube, then 24 greys. The first 16 are the user's own.
#[must_use]
pub fn nearest(colour: [u8; 3]) -> u8 {
    let in_cube = colour.map(|level| {
        let off = |i: &usize| CUBE[*i].abs_diff(level);
        (0..CUBE.len()).min_by_key(off).unwrap_or(0)
    });
    let mean = colour.iter().map(|&level| u32::from(level)).sum::<u32>() / 3;
    let grey = (mean.saturating_sub(3) / 10).min(23) as u8;
    let distance = |other: [u8; 3]| -> u32 {
        let off = (0..3).map(|i| u32::from(colour[i].abs_diff(other[i])).pow(2));
        off.sum()
    };
    let [r, g, b] = in_cube.map(|i| i as u8);
    if distance([8 + 10 * grey; 3]) < distance(in_cube.map(|i| CUBE[i])) {
        232 + grey
    } else {
        16 + 36 * r + 6 * g + b
    }
}
