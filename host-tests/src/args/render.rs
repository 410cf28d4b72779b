//! Flags of `render`.

use super::picture::{PictureArgs, ShadeArg, parse_number};
use super::{DEFAULT_SLOTS, MAX_RENDERERS, MAX_SLOTS};
use crate::choice::{DepthArg, InterpArg, PixelFormatArg};
use crate::draw::{Effects, FilterArg, MOST_SLOTS};
use crate::image_out::ImageFormat;
use crate::reference::View;
use clap::{Args, ValueEnum};
use scanbeam::pipeline::Quality;
use std::path::PathBuf;

/// How far a picture may be off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum QualityArg {
    /// 4 levels of 255
    Fast,
    /// 1.5 levels (when nothing is said)
    Balanced,
    /// Nothing beyond planes and rounding
    Exact,
}

impl QualityArg {
    /// What a renderer is told.
    #[must_use]
    pub fn quality(self) -> Quality {
        match self {
            Self::Fast => Quality::fast(),
            Self::Balanced => Quality::balanced(),
            Self::Exact => Quality::exact(),
        }
    }

    /// What textures are drawn by.
    #[must_use]
    pub fn texture_quality(self) -> scanbeam::pipeline::texture::Quality {
        use scanbeam::pipeline::texture::Quality;
        match self {
            Self::Fast => Quality::Fast,
            Self::Balanced => Quality::Balanced,
            Self::Exact => Quality::Exact,
        }
    }
}

/// Whether something is done.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum SwitchArg {
    /// It is
    On,
    /// It is not
    Off,
}

impl SwitchArg {
    /// Whether it is.
    #[must_use]
    pub fn is_on(self) -> bool {
        self == Self::On
    }
}

/// Flags of `render`.
#[derive(Debug, Clone, PartialEq, Args)]
pub struct RenderArgs {
    /// Model to draw, or a scene, .json, which says what most flags say
    #[arg(value_name = "MODEL.obj")]
    pub model: PathBuf,
    /// Picture to write, .png or .ppm
    #[arg(short = 'o', long = "output", value_name = "OUT")]
    pub output: PathBuf,
    /// What to draw.
    #[command(flatten)]
    pub picture: PictureArgs,
    /// How colours are taken from pixel to pixel; packed8 when not said, auto with --quality
    #[arg(long, value_enum, value_name = "METHOD")]
    pub interp: Option<InterpArg>,
    /// How what is seen is found
    #[arg(long, value_enum, value_name = "METHOD", default_value_t = DepthArg::Auto)]
    pub depth: DepthArg,
    /// Texture of the whole model, .png or .ppm; without it those of its materials (map_Kd).
    /// Its levels are rounded to 5, 6 and 5 bits, unless --interp, --depth or --prefetch are there too
    #[arg(long, value_name = "FILE")]
    pub texture: Option<PathBuf>,
    /// How texels are taken from textures
    #[arg(long, value_enum, value_name = "FILTER", default_value = "nearest")]
    pub filter: FilterArg,
    /// Whether textures have four levels of detail, each half of the one before, for where they
    /// are small on the picture
    #[arg(long, value_enum, value_name = "SWITCH", default_value = "on")]
    pub levels: SwitchArg,
    /// Highlights of a level S, 0 to 1, and a power N, 0 to 65535, on all surfaces; without it those
    /// of its materials (Ks, Ns)
    #[arg(long, value_name = "S,N", value_parser = parse_specular, allow_hyphen_values = true)]
    pub specular: Option<(f64, u16)>,
    /// Whether the model throws shadows onto itself
    #[arg(long, value_enum, value_name = "SWITCH", default_value = "off")]
    pub shadows: SwitchArg,
    /// Whether colours between two steps of rgb565 are mixed by an ordered 4x4 dither
    #[arg(long, value_enum, value_name = "SWITCH", default_value = "off")]
    pub dither: SwitchArg,
    /// How far colours and texture places may be off where the method is auto
    #[arg(long, value_enum, value_name = "BUDGET")]
    pub quality: Option<QualityArg>,
    /// Slots of each renderer's object cache, 0 to 4095
    #[arg(long, value_name = "SLOTS", default_value_t = DEFAULT_SLOTS,
        value_parser = clap::value_parser!(u16).range(0..=i64::from(MAX_SLOTS)))]
    pub cache: u16,
    /// Line renderers, each on a thread of its own when there are several, 1 to 16
    #[arg(long, value_name = "N", default_value_t = 1,
        value_parser = clap::value_parser!(u16).range(1..=i64::from(MAX_RENDERERS)))]
    pub renderers: u16,
    /// Bytes a line that each renderer fetches ahead into its cache
    #[arg(long, value_name = "BYTES", default_value_t = 0)]
    pub prefetch: u32,
    /// Also write figures of the frame, as JSON; with textures those of spans and pixels are left
    /// out where texels are rounded
    #[arg(long, value_name = "OUT.json")]
    pub stats: Option<PathBuf>,
}

impl RenderArgs {
    /// What pixels are sent, dithered ones being a format of their own.
    #[must_use]
    pub fn format(&self) -> PixelFormatArg {
        match (self.picture.format, self.dither) {
            (PixelFormatArg::Rgb565, SwitchArg::On) => PixelFormatArg::Dithered565,
            (format, _) => format,
        }
    }

    /// The view that the flags describe; already checked when it comes from [`parse`](super::parse).
    #[must_use]
    pub fn view(&self) -> View {
        self.picture.view()
    }

    /// The method that the flags ask for.
    #[must_use]
    pub fn method(&self) -> InterpArg {
        match (self.interp, self.quality) {
            (Some(interp), _) => interp,
            (None, Some(_)) => InterpArg::Auto,
            (None, None) => InterpArg::Packed8,
        }
    }

    /// Whether something is asked for that materials have a part in.
    fn has_effects(&self) -> bool {
        self.specular.is_some() || self.shadows.is_on() || self.picture.shade == ShadeArg::Phong
    }

    /// What light and materials are to do beside one matt light.
    #[must_use]
    pub fn effects(&self) -> Effects {
        Effects {
            specular: self.specular,
            shadows: self.shadows.is_on(),
            phong: self.picture.shade == ShadeArg::Phong,
        }
    }

    /// How far texture places may be off.
    #[must_use]
    pub fn texture_quality(&self) -> scanbeam::pipeline::texture::Quality {
        let quality = self.quality.unwrap_or(QualityArg::Balanced);
        quality.texture_quality()
    }

    /// Whether the method by which what is seen is found goes with the rest.
    fn check_depth(&self) -> Result<(), String> {
        let depth = self.depth;
        if depth != DepthArg::Auto && self.interp == Some(InterpArg::Model) {
            return Err("--interp model has no --depth: its own is what it is".into());
        }
        if !depth.is_a_pipeline() {
            return Ok(());
        }
        if self.method() != InterpArg::Packed8 {
            return Err(format!("--depth {depth} goes with --interp packed8 alone"));
        }
        if self.texture.is_some() || self.has_effects() {
            return Err(format!(
                "--depth {depth} has no --texture, --specular, --shadows on or --shade phong"
            ));
        }
        if ![PixelFormatArg::Rgb888, PixelFormatArg::Rgb565].contains(&self.format()) {
            return Err(format!(
                "--depth {depth} needs --format rgb888 or rgb565, and --dither off"
            ));
        }
        Ok(())
    }

    pub(super) fn check(&self) -> Result<(), String> {
        let crew = (self.cache, self.renderers, self.prefetch, self.quality);
        if self.interp == Some(InterpArg::Model) && crew != (DEFAULT_SLOTS, 1, 0, None) {
            return Err(
                "--interp model has no --cache, --renderers, --prefetch or --quality".into(),
            );
        }
        self.check_depth()?;
        let common = [PixelFormatArg::Rgb888, PixelFormatArg::Rgb565];
        let is_common = common.contains(&self.picture.format);
        let by_calls = self.dither.is_on() || self.has_effects();
        let is_usual = self.depth == DepthArg::Auto && self.prefetch == 0;
        if by_calls && !(is_usual && self.cache <= MOST_SLOTS) {
            return Err(format!(
                "--dither on, --specular, --shadows on and --shade phong have no --depth, no --prefetch and at most {MOST_SLOTS} slots"
            ));
        }
        if self.dither.is_on() && self.picture.format != PixelFormatArg::Rgb565 {
            return Err("--dither on needs --format rgb565".into());
        }
        if self.interp.is_some() && !common.contains(&self.format()) {
            return Err("--interp needs --format rgb888 or rgb565, and --dither off".into());
        }
        if !is_common && (self.texture.is_some() || self.quality.is_some() || self.has_effects()) {
            return Err(
                "--texture, --quality, --specular, --shadows and --shade phong need --format rgb888 or rgb565"
                    .into(),
            );
        }
        if self.interp.is_some() && self.has_effects() {
            return Err("--interp has no --specular, --shadows on or --shade phong".into());
        }
        if self.specular.is_some() && self.picture.shade == ShadeArg::None {
            return Err("--specular needs --shade flat, gouraud or phong".into());
        }
        self.view().check().map_err(|error| error.to_string())?;
        ImageFormat::from_path(&self.output).map_err(|error| error.to_string())?;
        if self.texture.as_ref() == Some(&self.output) {
            return Err("-o must not be the texture itself".into());
        }
        if self.texture.is_some() && self.interp == Some(InterpArg::Model) {
            return Err("--interp model has no --texture".into());
        }
        if self.output == self.model {
            return Err("-o must not be the model itself".into());
        }
        if self
            .stats
            .as_ref()
            .is_some_and(|stats| *stats == self.output || *stats == self.model)
        {
            return Err("--stats must be a file of its own".into());
        }
        Ok(())
    }
}

fn parse_specular(text: &str) -> Result<(f64, u16), String> {
    text.split_once(',')
        .and_then(|(level, power)| {
            let level = parse_number(level)
                .ok()
                .filter(|s| (0.0..=1.0).contains(s))?;
            Some((level, power.trim().parse().ok()?))
        })
        .ok_or_else(|| "a level from 0 to 1 and a whole power up to 65535, S,N, are needed".into())
}
