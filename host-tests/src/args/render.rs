//! Flags of `render`.

use super::picture::{PictureArgs, ShadeArg, parse_number};
use super::{DEFAULT_SLOTS, MAX_RENDERERS, MAX_SLOTS};
use crate::choice::{DepthArg, InterpArg, PixelFormatArg};
use crate::draw::{CrewSettings, Effects, FilterArg};
use crate::image_out::ImageFormat;
use crate::reference::View;
use clap::{Args, ValueEnum};
use host_support::apart::apart;
use scanbeam::scene::Budget;
use std::fmt;
use std::path::{Path, PathBuf};

/// How far texture places may be off.
#[derive(Debug, Clone, Copy, PartialEq, Eq, ValueEnum)]
pub enum QualityArg {
    /// 1/2 texel
    Fast,
    /// 1/4 texel
    Balanced,
    /// 1/100 texel
    Exact,
}

impl QualityArg {
    /// What draw calls are told.
    #[must_use]
    pub fn budget(self) -> Budget {
        match self {
            Self::Fast => Budget::FAST,
            Self::Balanced => Budget::BALANCED,
            Self::Exact => Budget::EXACT,
        }
    }
}

/// By what a picture is drawn.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Method {
    /// By draw calls.
    DrawCalls,
    /// By the hardware model, or by a method of the laboratory for colours.
    Interp(InterpArg),
    /// By a method of the laboratory for depth.
    Depth(DepthArg),
}

impl fmt::Display for Method {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::DrawCalls => f.write_str("--interp auto"),
            Self::Interp(interp) => write!(f, "--interp {interp}"),
            Self::Depth(depth) => write!(f, "--depth {depth}"),
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
    /// How colours are taken from pixel to pixel
    #[arg(long, value_enum, value_name = "METHOD", default_value_t = InterpArg::Auto)]
    pub interp: InterpArg,
    /// How what is seen is found
    #[arg(long, value_enum, value_name = "METHOD", default_value_t = DepthArg::Auto)]
    pub depth: DepthArg,
    /// Texture of the whole model, .png or .ppm; without it those of its materials (map_Kd).
    /// Its levels are rounded to 5, 6 and 5 bits
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
    /// How far texture places may be off; balanced when not said
    #[arg(long, value_enum, value_name = "BUDGET")]
    pub quality: Option<QualityArg>,
    /// Slots of each renderer's object cache, 0 to 4095, of which up to 224 are used
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
    /// Most that a line may cost, in instructions of a Cortex-M4; where one would cost more, quality is lowered
    #[arg(long, value_name = "COST")]
    pub pace: Option<u32>,
    /// Also write figures of the frame, as JSON
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
    pub fn method(&self) -> Method {
        match (self.interp, self.depth) {
            (InterpArg::Auto, depth) if depth.is_of_laboratory() => Method::Depth(depth),
            (InterpArg::Auto, _) => Method::DrawCalls,
            (interp, _) => Method::Interp(interp),
        }
    }

    /// Who draws.
    #[must_use]
    pub fn crew(&self) -> CrewSettings {
        CrewSettings {
            renderers: self.renderers,
            slots: self.cache,
            prefetch: self.prefetch,
            // What has a pace counts nothing else.
            counts: self.stats.is_some() && self.pace.is_none(),
            depth: self.depth,
            pace: self.pace,
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
    pub fn budget(&self) -> Budget {
        self.quality.map(QualityArg::budget).unwrap_or_default()
    }

    /// Whether the rest goes with the hardware model, or with a method of the laboratory.
    fn check_method(&self) -> Result<(), String> {
        let method = self.method();
        if method == Method::DrawCalls {
            return Ok(());
        }
        if matches!(method, Method::Interp(_)) && self.depth != DepthArg::Auto {
            return Err(format!("{method} has no --depth: its own is what it is"));
        }
        let crew = (self.cache, self.renderers, self.prefetch);
        if crew != (DEFAULT_SLOTS, 1, 0) || (self.pace, self.quality) != (None, None) {
            return Err(format!(
                "{method} has no --cache, --renderers, --prefetch, --pace or --quality"
            ));
        }
        if self.texture.is_some() || self.has_effects() {
            return Err(format!(
                "{method} has no --texture, --specular, --shadows on or --shade phong"
            ));
        }
        if ![PixelFormatArg::Rgb888, PixelFormatArg::Rgb565].contains(&self.format()) {
            return Err(format!(
                "{method} needs --format rgb888 or rgb565, and --dither off"
            ));
        }
        Ok(())
    }

    /// Whether the rest goes with a pace.
    fn check_pace(&self) -> Result<(), String> {
        if self.pace.is_none() {
            return Ok(());
        }
        if (self.renderers, self.prefetch, self.depth) != (1, 0, DepthArg::Auto) {
            return Err("--pace has no --renderers, --prefetch or --depth".into());
        }
        let is_plain = self.format() == PixelFormatArg::Rgb565 && !self.has_effects();
        if !is_plain || self.filter != FilterArg::Nearest {
            return Err(
                "--pace needs --format rgb565, --dither off, --filter nearest, and no --specular, --shadows on or \
                 --shade phong: no other costs are known"
                    .into(),
            );
        }
        Ok(())
    }

    pub(super) fn check(&self) -> Result<(), String> {
        if self.dither.is_on() && self.picture.format != PixelFormatArg::Rgb565 {
            return Err("--dither on needs --format rgb565".into());
        }
        self.check_method()?;
        self.check_pace()?;
        let is_grey = [PixelFormatArg::Grey8, PixelFormatArg::Mono].contains(&self.picture.format);
        if is_grey && self.texture.is_some() {
            return Err("--texture needs --format rgb888, rgb565 or xrgb8888".into());
        }
        if self.depth == DepthArg::Priority && self.shadows.is_on() {
            return Err("--depth priority has no --shadows on, which are found by depth".into());
        }
        if self.specular.is_some() && self.picture.shade == ShadeArg::None {
            return Err("--specular needs --shade flat, gouraud or phong".into());
        }
        self.view().check().map_err(|error| error.to_string())?;
        ImageFormat::from_path(&self.output).map_err(|error| error.to_string())?;
        self.check_apart([self.model.as_path()])
    }

    /// Whether what is written is none of the files that are read: those, and the flags' picture.
    ///
    /// # Errors
    /// One line, which names the flag.
    pub fn check_apart<'p>(
        &'p self,
        read: impl IntoIterator<Item = &'p Path>,
    ) -> Result<(), String> {
        let mut outputs = vec![("-o", self.output.as_path())];
        outputs.extend(self.stats.iter().map(|stats| ("--stats", stats.as_path())));
        apart(&outputs, read.into_iter().chain(self.texture.as_deref()))
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
