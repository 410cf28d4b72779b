//! What a picture is drawn as and by which methods, by the names that the command line has for it.

use clap::ValueEnum;
use scanbeam::scene::{DepthFunction, DepthTest};
use std::fmt;

/// Longest side of a picture that is drawn, in pixels, inclusive.
pub const MAX_SIDE: u32 = 8192;
/// Slots of the object cache when nothing else is asked.
pub const DEFAULT_SLOTS: u16 = 64;

/// How a pixel is sent to the display.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum PixelFormatArg {
    /// 24 bits
    Rgb888,
    /// 16 bits
    Rgb565,
    /// 24 bits in a word of 32
    Xrgb8888,
    /// 8 bits of grey
    Grey8,
    /// 1 bit, dithered, 8 pixels a byte
    Mono,
    /// 16 bits, dithered: --dither on
    #[value(skip)]
    Dithered565,
}

/// How colours are taken from pixel to pixel of a line, and with the model also depth. All but auto and model are
/// methods of the laboratory.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum InterpArg {
    /// Planes stepped forward as they are
    Plane,
    /// Packed channels, anchored anew every 8 pixels
    Packed8,
    /// Packed channels, anchored anew every 16 pixels
    Packed16,
    /// One colour for 2 pixels
    Half,
    /// One colour for 4 pixels
    Quarter,
    /// LIRP from end to end, 10 bits of W
    Lirp10,
    /// LIRP from end to end, 12 bits of W
    Lirp12,
    /// LIRP from end to end, 16 bits of W
    Lirp16,
    /// LIRP from end to end, two channels a multiplication
    LirpPacked,
    /// What the renderer does: planes, by as few bits as a triangle needs
    #[default]
    Auto,
    /// The hardware model: 12-bit weights down edges, 10-bit weights along spans
    Model,
}

/// How what is seen is found.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default, ValueEnum)]
pub enum DepthArg {
    /// For each line the cheapest that shows the same: none where spans do not overlap, from front
    /// to back where there is an order, else 32 bits
    #[default]
    Auto,
    /// 32 bits of 1/w, compared at every pixel: the same picture
    Z32,
    /// 16 bits of block-fix 1/w
    BlockFix,
    /// 16 bits of 1/w, in RGB565 in one word with the pixel
    Word,
    /// First whose each pixel is, then colours: the same picture, no pixel shaded twice, as auto does it
    Id,
    /// None: what comes later in the model is in front
    Priority,
}

impl DepthArg {
    /// Whether it is a method of the laboratory, which draw calls do not have.
    #[must_use]
    pub fn is_of_laboratory(self) -> bool {
        matches!(self, Self::BlockFix | Self::Word)
    }

    /// What draw calls compare.
    pub(crate) fn test(self) -> DepthTest {
        match self {
            // Where depths are equal nothing has to be written, so this hides as the usual test does; as it is another
            // one, every pixel is compared.
            Self::Z32 => DepthTest {
                depth_if: DepthFunction::NEARER,
                ..DepthTest::HIDES
            },
            _ => DepthTest::HIDES,
        }
    }
}

/// The name that the command line has for a choice.
fn name_of(choice: &impl ValueEnum, f: &mut fmt::Formatter<'_>) -> fmt::Result {
    match choice.to_possible_value() {
        Some(value) => f.write_str(value.get_name()),
        None => Ok(()),
    }
}

impl fmt::Display for InterpArg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        name_of(self, f)
    }
}

impl fmt::Display for DepthArg {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        name_of(self, f)
    }
}
