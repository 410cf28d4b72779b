//! How the colour of a draw call and the one that is there become one (K11, H8, P5).

use super::alpha::PixelAlpha;

/// How a new colour and the one that is there become one, channel by channel.
///
/// The alpha of a mode is multiplied by those of [vertices](super::Draw::alphas) and of [texels](super::Texture::masked),
/// if the call has any: so [`Blend::ALPHA`] is by these alone. Pixels of 5, 6 and 5 bits are blended by the nearest 32nd of
/// the product.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum BlendMode {
    /// The new one: what it hides is hidden.
    Replace,
    /// `old + (new - old) alpha`; 255 is 1.
    Filter(u8),
    /// Half of each, rounded down.
    Half,
    /// `old + new alpha`, at most full; 255 is 1.
    Add(u8),
    /// `old - new alpha`, at least 0; 255 is 1.
    Subtract(u8),
    /// `new source + old destination`, at most full.
    Factors {
        /// What the new colour is multiplied by.
        source: Factor,
        /// What the old one is multiplied by.
        destination: Factor,
    },
}

/// What a colour is multiplied by, 0 to 1. A line has no alpha, so the destination is its colour.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    /// A number, 255 for 1.
    Constant(u8),
    /// The colour that is there.
    Destination,
    /// 1 less the colour that is there.
    InverseDestination,
    /// The alpha of the call's vertices; 1 where it has none.
    SourceAlpha,
    /// 1 less that alpha.
    InverseSourceAlpha,
    /// The alpha of the texel; 1 where there is no mask.
    TextureAlpha,
    /// 1 less that alpha.
    InverseTextureAlpha,
}

impl Factor {
    /// Nothing of it.
    pub const ZERO: Self = Self::Constant(0);
    /// All of it.
    pub const ONE: Self = Self::Constant(255);

    /// What it is where alphas are known.
    fn by(self, alpha: PixelAlpha) -> Self {
        let texel = alpha.of_texel();
        match self {
            Self::SourceAlpha => Self::Constant(alpha.surface()),
            Self::InverseSourceAlpha => Self::Constant(255 - alpha.surface()),
            Self::TextureAlpha => Self::Constant(texel),
            Self::InverseTextureAlpha => Self::Constant(255 - texel),
            Self::Constant(_) | Self::Destination | Self::InverseDestination => self,
        }
    }
}

/// What a draw call does to the colours that are there: a mode, and the channels that are written.
///
/// With any mode but [`BlendMode::Replace`] the call is drawn after all that is opaque, from far to near pixel by
/// pixel, where it is in front; its depth is not written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blend {
    pub(crate) mode: BlendMode,
    /// Bits 0, 1 and 2: red, green and blue.
    pub(crate) channels: u8,
}

impl Blend {
    /// All channels.
    pub(crate) const ALL: u8 = 7;

    /// What is behind shines through where the alphas of vertices and texels are below 1.
    pub const ALPHA: Self = Self::filter(255);

    /// All channels, by this mode.
    #[must_use]
    pub const fn new(mode: BlendMode) -> Self {
        Self {
            mode,
            channels: Self::ALL,
        }
    }

    /// What is behind shines through, by 1 - alpha.
    #[must_use]
    pub const fn filter(alpha: u8) -> Self {
        Self::new(BlendMode::Filter(alpha))
    }

    /// Adds the colour times alpha.
    #[must_use]
    pub const fn add(alpha: u8) -> Self {
        Self::new(BlendMode::Add(alpha))
    }

    /// The same, of red, green and blue only those that are named.
    #[must_use]
    pub const fn writing(self, rgb: [bool; 3]) -> Self {
        let channels = rgb[0] as u8 | (rgb[1] as u8) << 1 | (rgb[2] as u8) << 2;
        Self { channels, ..self }
    }

    /// What it is for a pixel of these alphas, which they are multiplied into.
    #[inline(always)]
    pub(crate) fn by(self, alpha: PixelAlpha) -> Self {
        let mode = match self.mode {
            BlendMode::Filter(own) | BlendMode::Subtract(own) if alpha.texel().is_added() => {
                BlendMode::Add(alpha.times(own))
            }
            BlendMode::Half | BlendMode::Factors { .. } if alpha.texel().is_added() => {
                BlendMode::Add(alpha.times(255))
            }
            BlendMode::Filter(own) => BlendMode::Filter(alpha.times(own)),
            BlendMode::Add(own) => BlendMode::Add(alpha.times(own)),
            BlendMode::Subtract(own) => BlendMode::Subtract(alpha.times(own)),
            BlendMode::Factors {
                source,
                destination,
            } => BlendMode::Factors {
                source: source.by(alpha),
                destination: destination.by(alpha),
            },
            mode @ (BlendMode::Half | BlendMode::Replace) => mode,
        };
        Self { mode, ..self }
    }

    /// The same, by alpha where it only hides what is behind.
    pub(crate) fn by_alpha(self) -> Self {
        match self.mode {
            BlendMode::Replace => Self {
                mode: Self::ALPHA.mode,
                ..self
            },
            _ => self,
        }
    }

    /// Whether what is behind matters.
    pub(crate) fn is_translucent(&self) -> bool {
        self.mode != BlendMode::Replace
    }
}
