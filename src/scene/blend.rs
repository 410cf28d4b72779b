//! How the colour of a draw call and the one that is there become one (K11, H8, P5).

/// How a new colour and the one that is there become one, channel by channel.
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
}

impl Factor {
    /// Nothing of it.
    pub const ZERO: Self = Self::Constant(0);
    /// All of it.
    pub const ONE: Self = Self::Constant(255);
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

    /// Whether what is behind matters.
    pub(crate) fn is_translucent(&self) -> bool {
        self.mode != BlendMode::Replace
    }
}
