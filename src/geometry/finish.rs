//! What a surface does to the pixels that are there: blend, alpha, depth functions
//! (K11, H8, H9, P5).
//!
//! Plain data, kept with a face; what it means is done where pixels are drawn. Of a pipeline that
//! does not composite no record has any of it.

/// How a new colour and the one that is there become one, channel by channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Blend {
    /// The new one. With [`texel_alpha`](Finish::texel_alpha), texels of alpha 0 are cut out.
    #[default]
    Replace,
    /// `old + (new - old) alpha` (K11).
    Filter,
    /// Half of each, whatever alpha is; rounded down.
    Half,
    /// `old + new alpha`, at most full (K11).
    Add,
    /// `old - new alpha`, at least 0 (P5).
    Subtract,
    /// `new source + old destination`, at most full (H8).
    Factors {
        /// What the new colour is multiplied by.
        source: Factor,
        /// What the old one is multiplied by.
        destination: Factor,
    },
}

/// What a colour is multiplied by in [`Blend::Factors`], 0 to 1 (H8). A line has no alpha, so the
/// destination is its colour, channel by channel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Factor {
    /// A number, 255 for 1.
    Constant(u8),
    /// The surface's alpha: that of the finish times that of the vertices.
    SourceAlpha,
    /// 1 less the surface's alpha.
    InverseSourceAlpha,
    /// The texel's alpha; 1 where there is no texture.
    TextureAlpha,
    /// 1 less the texel's alpha.
    InverseTextureAlpha,
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

/// Which pixels pass a comparison with the depth that is there: any set of nearer, equal and
/// farther, which are the eight functions of H9.
///
/// | H9, of 1/w | here | | H9 | here |
/// |---|---|---|---|---|
/// | never | [`NEVER`](Self::NEVER) | | always | [`ALWAYS`](Self::ALWAYS) |
/// | > | [`NEARER`](Self::NEARER) | | <= | [`FARTHER_OR_EQUAL`](Self::FARTHER_OR_EQUAL) |
/// | = | [`EQUAL`](Self::EQUAL) | | != | [`DIFFERENT`](Self::DIFFERENT) |
/// | >= | [`NEARER_OR_EQUAL`](Self::NEARER_OR_EQUAL) | | < | [`FARTHER`](Self::FARTHER) |
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct DepthFunction(u8);

impl DepthFunction {
    /// None.
    pub const NEVER: Self = Self(0);
    /// What is farther than what is there.
    pub const FARTHER: Self = Self(1);
    /// What is as far.
    pub const EQUAL: Self = Self(2);
    /// What is as far or farther.
    pub const FARTHER_OR_EQUAL: Self = Self(3);
    /// What is nearer.
    pub const NEARER: Self = Self(4);
    /// What is nearer or farther.
    pub const DIFFERENT: Self = Self(5);
    /// What is nearer or as far: how surfaces hide each other.
    pub const NEARER_OR_EQUAL: Self = Self(6);
    /// All.
    pub const ALWAYS: Self = Self(7);

    /// Whether a pixel passes, by how its 1/w compares with the one that is there: greater is
    /// nearer.
    #[inline(always)]
    #[must_use]
    pub const fn passes(self, order: core::cmp::Ordering) -> bool {
        // Less, equal and greater are -1, 0 and 1.
        self.0 >> (order as i8 + 1) & 1 != 0
    }
}

/// What a surface does to the pixels that are there.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Finish {
    /// How its colour and that which is there become one.
    pub blend: Blend,
    /// Alpha of the whole surface, 255 for opaque.
    pub alpha: u8,
    /// Whether the alpha of texels counts.
    pub texel_alpha: bool,
    /// Whether texels with the D bit are added, whatever the blend is (ForceAdditive of K11).
    pub force_additive: bool,
    /// Which of red, green and blue (bits 0, 1 and 2) are written (H8).
    pub channels: u8,
    /// Where its colour is written, by depth (H9). [`DepthFunction::ALWAYS`] is ForceZVisible.
    pub colour_if: DepthFunction,
    /// Where its depth is written (H9). [`DepthFunction::NEVER`] is DisableZWrite.
    pub depth_if: DepthFunction,
}

const _: () = assert!(size_of::<Finish>() <= 14);

impl Default for Finish {
    fn default() -> Self {
        Self::OPAQUE
    }
}

impl Finish {
    /// All channels.
    pub const RGB: u8 = 7;
    /// Hides what is behind it.
    pub const OPAQUE: Self = Self {
        blend: Blend::Replace,
        alpha: 255,
        texel_alpha: false,
        force_additive: false,
        channels: Self::RGB,
        colour_if: DepthFunction::NEARER_OR_EQUAL,
        depth_if: DepthFunction::NEARER_OR_EQUAL,
    };
    /// Opaque, but texels of alpha 0 are cut out.
    pub const CUT_OUT: Self = Self {
        texel_alpha: true,
        ..Self::OPAQUE
    };

    /// Not opaque: blended where it is in front, and its depth is not written.
    #[must_use]
    pub const fn blended(blend: Blend, alpha: u8) -> Self {
        Self {
            blend,
            alpha,
            depth_if: DepthFunction::NEVER,
            ..Self::OPAQUE
        }
    }

    /// What is behind it shines through, by 1 - alpha.
    #[must_use]
    pub const fn filtered(alpha: u8) -> Self {
        Self::blended(Blend::Filter, alpha)
    }

    /// It adds its colour times alpha.
    #[must_use]
    pub const fn additive(alpha: u8) -> Self {
        Self::blended(Blend::Add, alpha)
    }

    /// It takes its colour times alpha away.
    #[must_use]
    pub const fn subtractive(alpha: u8) -> Self {
        Self::blended(Blend::Subtract, alpha)
    }

    /// When it is drawn.
    #[inline]
    #[must_use]
    pub(crate) fn role(&self) -> Role {
        match self.blend {
            _ if *self == Self::OPAQUE => Role::Plain,
            Blend::Replace => Role::Opaque,
            Blend::Add | Blend::Subtract if !self.force_additive => Role::Unsorted,
            _ => Role::Sorted,
        }
    }
}

/// When a surface is drawn on a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Role {
    /// First, in the usual way.
    Plain,
    /// With the plain ones, in order of submission, by its own rules.
    Opaque,
    /// Last, from back to front.
    Sorted,
    /// Last, and the order does not matter among its like.
    Unsorted,
}
