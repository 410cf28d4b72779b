//! Tokens: what travels down the pipeline (K13).
//!
//! A [`Token`] is a token understood; [`TokenBits`] is the token on the wires. Both ways are
//! total: `decode(encode(t)) == t` for every token whose values fit their fields, and bits that
//! are no token are refused with the reason.

use super::format::Word36;
use super::layout::{CONTROL, TOKEN_BITS, TokenBits};

/// A level of red, green, blue and alpha in 10 bits each, as pixels have them inside.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Argb10 {
    /// Opacity; 1023 is opaque.
    pub a: u16,
    /// Red.
    pub r: u16,
    /// Green.
    pub g: u16,
    /// Blue.
    pub b: u16,
}

/// A pixel to be interpolated (chart A) or laid over (chart B).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct PixelToken {
    /// Pixel of the scanline segment, 11 bits.
    pub x: u16,
    /// Weight along the span, 12 bits. The circuit of K6 gives 10, which stand at the bottom.
    pub w: u16,
    /// What the stages have made of it so far.
    pub colour: Argb10,
    /// Blend additively, whatever the mode.
    pub force_additive: bool,
}

/// Depth at both ends of a span (chart C).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ZSetup {
    /// Depth at the left end; less is nearer.
    pub z0: u32,
    /// Depth at the right end.
    pub z1: u32,
    /// Lighting is to be done for this span.
    pub diffuse: bool,
    /// A shadow polygon that faces the viewer.
    pub front: bool,
}

/// A parameter at both ends of a span: charts D, E and F, and parameters that have no chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ParameterSetup {
    /// The processing word at the left end.
    pub left: Word36,
    /// The processing word at the right end.
    pub right: Word36,
}

/// Which units a control token is for.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Target {
    /// The compositing unit.
    pub rgb: bool,
    /// The Z unit.
    pub z: bool,
}

impl Target {
    /// Both units.
    pub const BOTH: Self = Self { rgb: true, z: true };
    /// The compositing unit alone.
    pub const RGB: Self = Self {
        rgb: true,
        z: false,
    };
    /// The Z unit alone.
    pub const Z: Self = Self {
        rgb: false,
        z: true,
    };
}

/// Set-up and start of a scanline DMA (chart H).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct StartDma {
    /// The units whose back buffer is run through.
    pub target: Target,
    /// First pixel, 11 bits.
    pub start: u16,
    /// Pixels, 11 bits.
    pub length: u16,
    /// Pixels are read and sent out.
    pub scanout_enable: bool,
    /// Levels are rounded to 8 bits; else their lower two bits are cut off.
    pub round: bool,
    /// The write register is written to the pixels, after they were read.
    pub write_enable: bool,
}

/// What is to be done with pixels (chart K).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct GlobalMode {
    /// Diffuse colour counts.
    pub diffuse_shade: bool,
    /// Specular colour is added.
    pub specular_shade: bool,
    /// Second pass: shadow polygons are counted (K9).
    pub shadow_count: bool,
    /// Third pass: what is in shadow is dropped (K9).
    pub shadow_test: bool,
    /// Blend additively; else by opacity (K11).
    pub additive: bool,
    /// Control or data, and the pipeline's interlock; 2 bits that the model hands on.
    pub control_flags: u8,
    /// What is in shadow is kept, what is lit is dropped.
    pub invert_shadow: bool,
    /// Every pixel counts as visible.
    pub force_z_visible: bool,
    /// Depth and shadow counts stay as they are.
    pub disable_z_write: bool,
}

/// A token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Token {
    /// A pixel that is done with.
    Null,
    /// Chart A.
    Pixel(PixelToken),
    /// Chart B.
    Overlay(PixelToken),
    /// Chart C.
    ZSetup(ZSetup),
    /// Chart D: alpha, red, green, blue in 9 bits.
    DiffuseSetup(ParameterSetup),
    /// Chart E: power, red, green, blue in 9 bits.
    SpecularSetup(ParameterSetup),
    /// Chart F: x, y, z in 12 bits with sign.
    NormalSetup(ParameterSetup),
    /// A parameter of one's own (K15): ids 5 to 15, two processing words as in charts D to F.
    ParameterSetup(u8, ParameterSetup),
    /// Chart G: the value that the scanline DMA writes, 40 bits.
    LoadWriteRegister(Target, u64),
    /// Chart H.
    StartDma(StartDma),
    /// Chart I.
    WaitDma(Target),
    /// Chart J.
    Swap(Target),
    /// Chart K.
    GlobalMode(GlobalMode),
    /// Chart L: 40 bits that leave the pipeline as they are.
    Jam(u64),
}

/// Why bits are no token.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum TokenError {
    /// No token has this id.
    Id {
        /// Whether it was a set-up token.
        setup: bool,
        /// The id.
        id: u8,
    },
    /// No control token has this op-code.
    OpCode(u8),
    /// A reserved bit is not 0.
    Reserved,
}

impl core::fmt::Display for TokenError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Id { setup: true, id } => write!(f, "no set-up token has the id {id}"),
            Self::Id { setup: false, id } => write!(f, "no general token has the id {id}"),
            Self::OpCode(op) => write!(f, "no control token has the op-code {op}"),
            Self::Reserved => f.write_str("a reserved bit of the token is not 0"),
        }
    }
}

impl core::error::Error for TokenError {}

/// Fills a token from the top.
struct Fill {
    bits: u128,
    left: u32,
}

impl Fill {
    fn new(setup: bool, id: u8) -> Self {
        let empty = Self {
            bits: 0,
            left: TOKEN_BITS,
        };
        empty.flag(setup).put(id.into(), 4)
    }

    fn control(op: u8) -> Self {
        Self::new(false, CONTROL).put(op.into(), 8)
    }

    fn put(self, value: u64, width: u32) -> Self {
        let value = value & (u64::MAX >> (64 - width));
        let left = self.left - width;
        Self {
            bits: self.bits | u128::from(value) << left,
            left,
        }
    }

    fn flag(self, value: bool) -> Self {
        self.put(value.into(), 1)
    }

    fn target(self, target: Target) -> Self {
        self.flag(target.rgb).flag(target.z)
    }

    /// Leaves out reserved bits.
    fn skip(self, width: u32) -> Self {
        self.put(0, width)
    }

    fn done(self) -> TokenBits {
        debug_assert_eq!(self.left, 0);
        TokenBits::truncated(self.bits)
    }
}

/// Empties a token from the top.
struct Drain {
    bits: TokenBits,
    first: u32,
    /// Whether all reserved bits so far were 0.
    clean: bool,
}

impl Drain {
    fn take(&mut self, width: u32) -> u64 {
        let value = self.bits.field(self.first, width);
        self.first += width;
        value
    }

    fn short(&mut self, width: u32) -> u16 {
        self.take(width) as u16
    }

    fn flag(&mut self) -> bool {
        self.take(1) == 1
    }

    fn target(&mut self) -> Target {
        Target {
            rgb: self.flag(),
            z: self.flag(),
        }
    }

    fn reserved(&mut self, width: u32) {
        self.clean &= self.take(width) == 0;
    }

    fn parameter(&mut self) -> ParameterSetup {
        ParameterSetup {
            left: self.take(36),
            right: self.take(36),
        }
    }
}

impl Token {
    /// The token on the wires. A value that is wider than its field loses its upper bits.
    #[must_use]
    pub fn encode(&self) -> TokenBits {
        match *self {
            Self::Null => TokenBits::default(),
            Self::Pixel(p) => {
                let Argb10 { a, r, g, b } = p.colour;
                pixel(1, p, [a, r, g, b])
            }
            Self::Overlay(p) => {
                let Argb10 { a, r, g, b } = p.colour;
                pixel(2, p, [r, g, b, a])
            }
            Self::ZSetup(s) => Fill::new(true, 1)
                .put(s.z0.into(), 32)
                .flag(s.diffuse)
                .flag(s.front)
                .skip(2)
                .put(s.z1.into(), 32)
                .skip(4)
                .done(),
            Self::DiffuseSetup(s) => parameter(2, s),
            Self::SpecularSetup(s) => parameter(3, s),
            Self::NormalSetup(s) => parameter(4, s),
            Self::ParameterSetup(id, s) => parameter(id, s),
            Self::LoadWriteRegister(target, value) => Fill::control(1)
                .target(target)
                .skip(22)
                .put(value, 40)
                .done(),
            Self::StartDma(s) => Fill::control(2)
                .target(s.target)
                .put(s.start.into(), 11)
                .put(s.length.into(), 11)
                .skip(14)
                .flag(s.scanout_enable)
                .skip(1)
                .flag(s.round)
                .flag(s.write_enable)
                .skip(22)
                .done(),
            Self::WaitDma(target) => Fill::control(3).target(target).skip(62).done(),
            Self::Swap(target) => Fill::control(4).target(target).skip(62).done(),
            Self::GlobalMode(m) => Fill::control(5)
                .flag(m.diffuse_shade)
                .flag(m.specular_shade)
                .flag(m.shadow_count)
                .flag(m.shadow_test)
                .flag(m.additive)
                .put(m.control_flags.into(), 2)
                .flag(m.invert_shadow)
                .flag(m.force_z_visible)
                .flag(m.disable_z_write)
                .skip(54)
                .done(),
            Self::Jam(data) => Fill::control(6).skip(24).put(data, 40).done(),
        }
    }

    /// The token that the bits are. What follows the head of a null token is not looked at, nor
    /// are the 24 idle bits of chart L.
    ///
    /// # Errors
    /// An id or op-code that no token has, or a reserved bit that is not 0.
    pub fn decode(bits: TokenBits) -> Result<Self, TokenError> {
        let (setup, id) = (bits.is_setup(), bits.id());
        let mut d = Drain {
            bits,
            first: 5,
            clean: true,
        };
        let token = match (setup, id) {
            (false, 0) => return Ok(Self::Null),
            (false, 1 | 2) => {
                let (x, w) = (d.short(11), d.short(12));
                let c = [d.short(10), d.short(10), d.short(10), d.short(10)];
                let [a, r, g, b] = if id == 1 { c } else { [c[3], c[0], c[1], c[2]] };
                let token = PixelToken {
                    x,
                    w,
                    colour: Argb10 { a, r, g, b },
                    force_additive: d.flag(),
                };
                d.reserved(8);
                if id == 1 {
                    Self::Pixel(token)
                } else {
                    Self::Overlay(token)
                }
            }
            (false, CONTROL) => Self::decode_control(&mut d)?,
            (true, 1) => {
                let z0 = d.take(32) as u32;
                let (diffuse, front) = (d.flag(), d.flag());
                d.reserved(2);
                let z1 = d.take(32) as u32;
                d.reserved(4);
                Self::ZSetup(ZSetup {
                    z0,
                    z1,
                    diffuse,
                    front,
                })
            }
            (true, 2) => Self::DiffuseSetup(d.parameter()),
            (true, 3) => Self::SpecularSetup(d.parameter()),
            (true, 4) => Self::NormalSetup(d.parameter()),
            (true, 5..) => Self::ParameterSetup(id, d.parameter()),
            _ => return Err(TokenError::Id { setup, id }),
        };
        if d.clean {
            Ok(token)
        } else {
            Err(TokenError::Reserved)
        }
    }

    fn decode_control(d: &mut Drain) -> Result<Self, TokenError> {
        Ok(match d.take(8) as u8 {
            1 => {
                let target = d.target();
                d.reserved(22);
                Self::LoadWriteRegister(target, d.take(40))
            }
            2 => {
                let target = d.target();
                let (start, length) = (d.short(11), d.short(11));
                d.reserved(14);
                let scanout_enable = d.flag();
                d.reserved(1);
                let (round, write_enable) = (d.flag(), d.flag());
                d.reserved(22);
                Self::StartDma(StartDma {
                    target,
                    start,
                    length,
                    scanout_enable,
                    round,
                    write_enable,
                })
            }
            op @ (3 | 4) => {
                let target = d.target();
                d.reserved(62);
                if op == 3 {
                    Self::WaitDma(target)
                } else {
                    Self::Swap(target)
                }
            }
            5 => {
                let mode = GlobalMode {
                    diffuse_shade: d.flag(),
                    specular_shade: d.flag(),
                    shadow_count: d.flag(),
                    shadow_test: d.flag(),
                    additive: d.flag(),
                    control_flags: d.take(2) as u8,
                    invert_shadow: d.flag(),
                    force_z_visible: d.flag(),
                    disable_z_write: d.flag(),
                };
                d.reserved(54);
                Self::GlobalMode(mode)
            }
            6 => {
                d.take(24);
                Self::Jam(d.take(40))
            }
            op => return Err(TokenError::OpCode(op)),
        })
    }

    /// The set-up token of parameter `number` (1 to 15): its id is the number (K15).
    #[must_use]
    pub const fn set_up(number: u8, left: Word36, right: Word36) -> Self {
        let both = ParameterSetup { left, right };
        match number {
            1 => Self::ZSetup(ZSetup {
                z0: (left >> 4) as u32,
                z1: (right >> 4) as u32,
                diffuse: left >> 3 & 1 == 1,
                front: left >> 2 & 1 == 1,
            }),
            2 => Self::DiffuseSetup(both),
            3 => Self::SpecularSetup(both),
            4 => Self::NormalSetup(both),
            _ => Self::ParameterSetup(number, both),
        }
    }
}

fn pixel(id: u8, p: PixelToken, colour: [u16; 4]) -> TokenBits {
    let head = Fill::new(false, id).put(p.x.into(), 11).put(p.w.into(), 12);
    let filled = colour
        .iter()
        .fold(head, |fill, level| fill.put((*level).into(), 10));
    filled.flag(p.force_additive).skip(8).done()
}

fn parameter(id: u8, s: ParameterSetup) -> TokenBits {
    Fill::new(true, id).put(s.left, 36).put(s.right, 36).done()
}
