//! The 77 bits of a token, field by field, as charts A to L list them (K13).
//!
//! The first field of a chart stands at the top: bit 76 is `PSetup`, bits 75 to 72 are
//! `TokenID`, so a token printed as a number reads like its chart. Two places where the charts
//! leave something open are settled here: B's fields add up to 76 bits, so its reserved field
//! has one bit more; and the delay that the text gives the DMA start token has no field in
//! chart H, and none here.

/// Bits of a token.
pub const TOKEN_BITS: u32 = 77;

/// A token as it travels: 77 bits, the first field on top.
#[derive(Clone, Copy, PartialEq, Eq, Default)]
pub struct TokenBits(u128);

impl TokenBits {
    /// From a number below 2^77.
    #[must_use]
    pub const fn new(bits: u128) -> Option<Self> {
        if bits >> TOKEN_BITS == 0 {
            Some(Self(bits))
        } else {
            None
        }
    }

    /// The lower 77 bits of a number.
    #[must_use]
    pub const fn truncated(bits: u128) -> Self {
        Self(bits & ((1 << TOKEN_BITS) - 1))
    }

    /// The bits as a number below 2^77.
    #[must_use]
    pub const fn get(self) -> u128 {
        self.0
    }

    /// `width` bits (at most 64) whose first is the `first`-th from the top.
    #[inline]
    #[must_use]
    pub const fn field(self, first: u32, width: u32) -> u64 {
        let down = TOKEN_BITS - first - width;
        ((self.0 >> down) as u64) & (u64::MAX >> (64 - width))
    }

    /// Whether it is a set-up token.
    #[must_use]
    pub const fn is_setup(self) -> bool {
        self.field(0, 1) == 1
    }

    /// The token's id, 0 to 15.
    #[must_use]
    pub const fn id(self) -> u8 {
        self.field(1, 4) as u8
    }

    /// The op-code of a control token.
    #[must_use]
    pub const fn op_code(self) -> u8 {
        self.field(5, 8) as u8
    }
}

impl core::fmt::Debug for TokenBits {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(f, "{:020x}", self.0)
    }
}

impl core::fmt::LowerHex for TokenBits {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        core::fmt::LowerHex::fmt(&self.0, f)
    }
}

/// One line of a chart.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// The field's name in the chart; what is not used has none.
    pub name: &'static str,
    /// Bits, 1 to 62.
    pub width: u32,
}

/// One chart: what a kind of token looks like.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Chart {
    /// The chart's letter.
    pub letter: char,
    /// What the token is.
    pub title: &'static str,
    /// `PSetup` of the token.
    pub setup: bool,
    /// `TokenID` of the token.
    pub id: u8,
    /// `OpCode` of a control token.
    pub op_code: Option<u8>,
    /// The fields behind `PSetup`, `TokenID` and `OpCode`, top to bottom.
    pub fields: &'static [Field],
}

/// The id of all control tokens.
pub const CONTROL: u8 = 15;

macro_rules! fields {
    ($($name:literal $width:literal),* $(,)?) => {
        &[$(Field { name: $name, width: $width }),*]
    };
}

const fn general(letter: char, title: &'static str, id: u8, fields: &'static [Field]) -> Chart {
    Chart {
        letter,
        title,
        setup: false,
        id,
        op_code: None,
        fields,
    }
}

const fn set_up(letter: char, title: &'static str, id: u8, fields: &'static [Field]) -> Chart {
    Chart {
        letter,
        title,
        setup: true,
        id,
        op_code: None,
        fields,
    }
}

const fn control(letter: char, title: &'static str, op: u8, fields: &'static [Field]) -> Chart {
    Chart {
        letter,
        title,
        setup: false,
        id: CONTROL,
        op_code: Some(op),
        fields,
    }
}

/// Charts A to L.
pub const CHARTS: [Chart; 12] = [
    general(
        'A',
        "pixel interpolation",
        1,
        fields![
            "X" 11, "W" 12, "A" 10, "R" 10, "G" 10, "B" 10, "ForceAdditive" 1, "" 8,
        ],
    ),
    general(
        'B',
        "pixel overlay",
        2,
        fields![
            "X" 11, "W" 12, "R" 10, "G" 10, "B" 10, "A" 10, "ForceAdditive" 1, "" 8,
        ],
    ),
    set_up(
        'C',
        "Z set-up",
        1,
        fields![
            "Z0" 32, "Diffuse" 1, "Front" 1, "" 2, "Z1" 32, "" 4,
        ],
    ),
    set_up(
        'D',
        "diffuse RGB set-up",
        2,
        fields![
            "Ad0" 9, "Rd0" 9, "Gd0" 9, "Bd0" 9, "Ad1" 9, "Rd1" 9, "Gd1" 9, "Bd1" 9,
        ],
    ),
    set_up(
        'E',
        "specular RGB set-up",
        3,
        fields![
            "Ns0" 9, "Rs0" 9, "Gs0" 9, "Bs0" 9, "Ns1" 9, "Rs1" 9, "Gs1" 9, "Bs1" 9,
        ],
    ),
    set_up(
        'F',
        "normal set-up",
        4,
        fields![
            "Nx0" 12, "Ny0" 12, "Nz0" 12, "Nx1" 12, "Ny1" 12, "Nz1" 12,
        ],
    ),
    control(
        'G',
        "load scanline DMA write register",
        1,
        fields![
            "RGB" 1, "Z" 1, "" 22, "WriteValue" 40,
        ],
    ),
    control(
        'H',
        "scanline DMA set-up/start",
        2,
        fields![
            "RGB" 1, "Z" 1, "Start" 11, "Length" 11, "" 14, "ScanoutEnable" 1, "" 1,
            "ScanoutMode" 1, "WriteEnable" 1, "" 22,
        ],
    ),
    control(
        'I',
        "wait for scanline DMA completion",
        3,
        fields!["RGB" 1, "Z" 1, "" 62],
    ),
    control('J', "swap buffers", 4, fields!["RGB" 1, "Z" 1, "" 62]),
    control(
        'K',
        "global mode set-up",
        5,
        fields![
            "DiffuseShade" 1, "SpecularShade" 1, "ShadowCount" 1, "ShadowTest" 1, "TransMode" 1,
            "ControlFlags" 2, "InvertShadow" 1, "ForceZVisible" 1, "DisableZWrite" 1, "" 54,
        ],
    ),
    control('L', "jam data", 6, fields!["" 24, "Data" 40]),
];

impl Chart {
    /// The chart of a token; null tokens, set-up tokens without a chart and unknown ids have
    /// none.
    #[must_use]
    pub fn of(bits: TokenBits) -> Option<&'static Self> {
        CHARTS.iter().find(|chart| {
            chart.setup == bits.is_setup()
                && chart.id == bits.id()
                && chart.op_code.is_none_or(|op| op == bits.op_code())
        })
    }

    /// Bits in front of [`fields`](Self::fields).
    #[must_use]
    pub const fn head(&self) -> u32 {
        if self.op_code.is_some() { 13 } else { 5 }
    }

    /// Every named field of a token of this kind, and its value.
    pub fn values(&self, bits: TokenBits) -> impl Iterator<Item = (Field, u64)> + '_ {
        let mut first = self.head();
        self.fields.iter().filter_map(move |field| {
            let value = bits.field(first, field.width);
            first += field.width;
            (!field.name.is_empty()).then_some((*field, value))
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_chart_has_77_bits_and_a_head_of_its_own() {
        for (i, chart) in CHARTS.iter().enumerate() {
            let fields: u32 = chart.fields.iter().map(|f| f.width).sum();
            assert_eq!(chart.head() + fields, TOKEN_BITS, "chart {}", chart.letter);
            assert_eq!(chart.letter, char::from(b'A' + i as u8));
            let op = chart.op_code.unwrap_or(0);
            let head = u128::from(chart.setup) << 76 | u128::from(chart.id) << 72;
            let bits = TokenBits::new(head | u128::from(op) << 64).unwrap();
            assert_eq!(Chart::of(bits), Some(chart));
        }
        assert_eq!(Chart::of(TokenBits::default()), None);
        assert_eq!(TokenBits::new(1 << 77), None);
        assert_eq!(TokenBits::truncated(u128::MAX).get(), (1 << 77) - 1);
    }
}
