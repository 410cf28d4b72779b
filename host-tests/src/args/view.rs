//! Flags of `view`.

use super::picture::{Size, parse_size};
use super::{DEFAULT_SLOTS, MAX_RENDERERS, MAX_SLOTS, QualityArg};
use crate::choice::PixelFormatArg;
use crate::reference::Shade;
use crate::view::Colours;
use clap::Args;
use std::path::PathBuf;

/// Most frames that `view` prints, inclusive.
const MAX_FRAMES: i64 = 10_000;
/// Most pixels of a side of what `view` shows, inclusive.
const MAX_VIEW_SIDE: u32 = 1024;

/// Flags of `view`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct ViewArgs {
    /// Model to show, or a scene, .json; the teapot when there is none
    #[arg(value_name = "MODEL.obj")]
    pub model: Option<PathBuf>,
    /// Print so many frames and stop, without a terminal
    #[arg(long, value_name = "N", value_parser = clap::value_parser!(u32).range(1..=MAX_FRAMES))]
    pub frames: Option<u32>,
    /// Size of the picture in pixels, up to 1024x1024: at most, and when not said, what the terminal
    /// holds; for --frames 80x48, in a window 480x360
    #[arg(long, value_name = "WxH", value_parser = parse_size, allow_hyphen_values = true)]
    pub size: Option<Size>,
    /// How colours are told to the terminal
    #[arg(long, value_enum, value_name = "COLOURS", default_value_t = Colours::Auto)]
    pub colours: Colours,
    /// How light is applied
    #[arg(long, value_enum, default_value_t = Shade::Gouraud)]
    pub shade: Shade,
    /// Pixel format that the display is sent
    #[arg(long, value_enum, default_value_t = PixelFormatArg::Rgb565)]
    pub format: PixelFormatArg,
    /// How far texture places may be off
    #[arg(long, value_enum, value_name = "BUDGET", default_value = "balanced")]
    pub quality: QualityArg,
    /// Slots of each renderer's object cache, 0 to 4095, of which up to 224 are used
    #[arg(long, value_name = "SLOTS", default_value_t = DEFAULT_SLOTS,
        value_parser = clap::value_parser!(u16).range(0..=i64::from(MAX_SLOTS)))]
    pub cache: u16,
    /// Line renderers, each on a thread of its own when there are several, 1 to 16
    #[arg(long, value_name = "N", default_value_t = 1,
        value_parser = clap::value_parser!(u16).range(1..=i64::from(MAX_RENDERERS)))]
    pub renderers: u16,
    /// Show it in a window of its own, with the figures in its title and the same keys
    #[cfg(feature = "window")]
    #[arg(long, conflicts_with = "frames")]
    pub window: bool,
}

impl ViewArgs {
    pub(super) fn check(&self) -> Result<(), String> {
        let large = |size: &Size| size.width.max(size.height) > MAX_VIEW_SIDE;
        if self.size.as_ref().is_some_and(large) {
            return Err(format!(
                "--size may be {MAX_VIEW_SIDE}x{MAX_VIEW_SIDE} at most"
            ));
        }
        Ok(())
    }
}
