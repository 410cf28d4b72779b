//! What a parameter looks like when it comes in, and while it is worked on (K15).
//!
//! | input | fields | words | becomes | typical use |
//! |---|---|---|---|---|
//! | 4x8U | four of 8 bits, first on top | 1 | 4x9U | alpha, red, green, blue |
//! | 3x10S | signed 11, 11 and 10 bits | 1 | 3x12S | vector |
//! | 3x16S | three signed of 16 bits, two in the first word | 2 | 3x12S | vector |
//! | 2x16U | two of 16 bits | 1 | 2x16U | x and y, 13.3 |
//! | 1x32U | one of 32 bits | 1 | 1x32U | depth |
//!
//! A processing word has 36 bits; fields stand at its top, first field first, and what is left
//! over below is 0. A set-up token is two such words behind its five leading bits, so stage one
//! moves parameters without knowing what they mean.
//!
//! Unsigned fields grow by repeating their top bits below, so that full stays full; signed ones
//! are shifted up, or lose their lowest bits.

use super::lirp::lirp;

/// Bits of a processing word.
pub const WORD_BITS: u32 = 36;

/// A processing word: 36 bits.
pub type Word36 = u64;

/// How a parameter comes in (chart M).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum InputFormat {
    /// Four unsigned fields of 8 bits.
    U8x4,
    /// Three signed fields of 11, 11 and 10 bits.
    S10x3,
    /// Three signed fields of 16 bits, in two words.
    S16x3,
    /// Two unsigned fields of 16 bits.
    U16x2,
    /// One unsigned field of 32 bits.
    U32x1,
}

/// How a parameter is stored and interpolated (chart N).
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ProcessingFormat {
    /// Four unsigned fields of 9 bits.
    U9x4,
    /// Three signed fields of 12 bits.
    S12x3,
    /// Two unsigned fields of 16 bits.
    U16x2,
    /// One unsigned field of 32 bits.
    U32x1,
}

/// `value` of `from` bits in `to` bits, its top bits repeated below: 0 stays 0, all ones stay
/// all ones. `from <= to <= 2 from`.
#[inline]
#[must_use]
pub const fn widen(value: u32, from: u32, to: u32) -> u32 {
    value << (to - from) | value >> (2 * from - to)
}

/// A 10-bit level as 8 bits, off by at most 0.76 levels; undoes [`widen`] from 8 bits (K12).
#[inline]
#[must_use]
pub const fn round_to_8(level: u16) -> u8 {
    let level = level & 0x3FF;
    ((level - (level >> 8) + 2) >> 2) as u8
}

impl InputFormat {
    /// All five, in the order of chart M; the place is the format's code in the format RAM.
    pub const ALL: [Self; 5] = [
        Self::U8x4,
        Self::S10x3,
        Self::S16x3,
        Self::U16x2,
        Self::U32x1,
    ];

    /// Words of 32 bits that the parameter takes in the input stream.
    #[must_use]
    pub const fn words(self) -> usize {
        match self {
            Self::S16x3 => 2,
            _ => 1,
        }
    }

    /// What it becomes.
    #[must_use]
    pub const fn processing(self) -> ProcessingFormat {
        match self {
            Self::U8x4 => ProcessingFormat::U9x4,
            Self::S10x3 | Self::S16x3 => ProcessingFormat::S12x3,
            Self::U16x2 => ProcessingFormat::U16x2,
            Self::U32x1 => ProcessingFormat::U32x1,
        }
    }

    /// The code by which the format RAM names it.
    #[must_use]
    pub const fn code(self) -> u16 {
        self as u16
    }

    /// The format of a code.
    #[must_use]
    pub fn from_code(code: u16) -> Option<Self> {
        Self::ALL.get(usize::from(code)).copied()
    }

    /// The processing word of a parameter; `low` is the second word, looked at by
    /// [`S16x3`](Self::S16x3) alone.
    #[must_use]
    pub fn convert(self, word: u32, low: u32) -> Word36 {
        let signed = |bits: u32, word: u32, up: u32| i64::from((word << up) as i32 >> (32 - bits));
        let fields = match self {
            Self::U8x4 => [24, 16, 8, 0].map(|down| i64::from(widen(word >> down & 0xFF, 8, 9))),
            Self::S10x3 => [
                signed(11, word, 0) << 1,
                signed(11, word, 11) << 1,
                signed(10, word, 22) << 2,
                0,
            ],
            Self::S16x3 => [
                signed(16, word, 0) >> 4,
                signed(16, word, 16) >> 4,
                signed(16, low, 0) >> 4,
                0,
            ],
            Self::U16x2 => [i64::from(word >> 16), i64::from(word & 0xFFFF), 0, 0],
            Self::U32x1 => [i64::from(word), 0, 0, 0],
        };
        self.processing().pack(fields)
    }
}

impl ProcessingFormat {
    /// How many fields a word has.
    #[must_use]
    pub const fn fields(self) -> usize {
        match self {
            Self::U9x4 => 4,
            Self::S12x3 => 3,
            Self::U16x2 => 2,
            Self::U32x1 => 1,
        }
    }

    /// Bits of a field.
    #[must_use]
    pub const fn bits(self) -> u32 {
        match self {
            Self::U9x4 => 9,
            Self::S12x3 => 12,
            Self::U16x2 => 16,
            Self::U32x1 => 32,
        }
    }

    /// Whether fields have a sign: those of vectors alone.
    #[must_use]
    pub const fn is_signed(self) -> bool {
        matches!(self, Self::S12x3)
    }

    /// The place of the `i`-th field's lowest bit.
    #[inline]
    const fn place(self, i: usize) -> u32 {
        WORD_BITS - (i as u32 + 1) * self.bits()
    }

    /// The word of these fields; each loses what its width does not hold, and fields that the
    /// format has not are dropped.
    #[inline]
    #[must_use]
    pub fn pack(self, fields: [i64; 4]) -> Word36 {
        let mask = (1u64 << self.bits()) - 1;
        (0..self.fields()).fold(0, |word, i| {
            word | (fields[i] as u64 & mask) << self.place(i)
        })
    }

    /// The fields of a word; those that the format has not are 0.
    #[inline]
    #[must_use]
    pub fn unpack(self, word: Word36) -> [i64; 4] {
        let mut fields = [0; 4];
        let bits = self.bits();
        for (i, field) in fields.iter_mut().enumerate().take(self.fields()) {
            let value = (word >> self.place(i)) & ((1 << bits) - 1);
            *field = if self.is_signed() {
                ((value << (64 - bits)) as i64) >> (64 - bits)
            } else {
                value as i64
            };
        }
        fields
    }

    /// Every field of `a` and `b` blended by [`lirp`] with an n-bit weight.
    #[inline]
    #[must_use]
    pub fn lirp(self, a: Word36, b: Word36, w: u32, n: u32) -> Word36 {
        let (a, b) = (self.unpack(a), self.unpack(b));
        let mut fields = [0; 4];
        for i in 0..self.fields() {
            fields[i] = lirp(a[i], b[i], w, n);
        }
        self.pack(fields)
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn full_stays_full_and_nothing_stays_nothing() {
        assert_eq!(
            InputFormat::U8x4.convert(0xFF00_FF00, 0),
            0x1FF << 27 | 0x1FF << 9
        );
        assert_eq!(widen(0x1FF, 9, 10), 0x3FF);
        for level in 0..=255u8 {
            let nine = widen(u32::from(level), 8, 9);
            let ten = widen(nine, 9, 10);
            assert_eq!(round_to_8(ten as u16), level);
            assert_eq!(ten >> 2, u32::from(level));
        }
        assert_eq!(round_to_8(0x3FF), 255);
    }

    #[test]
    fn rounding_keeps_its_bound() {
        let mut last = 0;
        for level in 0..1024u16 {
            let exact = f64::from(level) * 255.0 / 1023.0;
            let rounded = round_to_8(level);
            assert!((f64::from(rounded) - exact).abs() <= 0.76, "{level}");
            assert!(rounded >= last);
            last = rounded;
        }
    }

    #[test]
    fn vectors_keep_their_sign() {
        let low = |x: i32, bits: u32| x as u32 & ((1 << bits) - 1);
        let word = low(-1024, 11) << 21 | low(1023, 11) << 10 | low(-512, 10);
        let vector = InputFormat::S10x3.convert(word, 0);
        assert_eq!(
            ProcessingFormat::S12x3.unpack(vector),
            [-2048, 2046, -2048, 0]
        );
        let (x, y, z) = (-32_768i16, 32_767i16, -1i16);
        let high = u32::from(x as u16) << 16 | u32::from(y as u16);
        let vector = InputFormat::S16x3.convert(high, u32::from(z as u16) << 16 | 0xFFFF);
        assert_eq!(ProcessingFormat::S12x3.unpack(vector), [-2048, 2047, -1, 0]);
    }

    #[test]
    fn places_and_depth_pass_unchanged() {
        let word = 0x1234_FEDC;
        let place = InputFormat::U16x2.convert(word, 0);
        assert_eq!(
            ProcessingFormat::U16x2.unpack(place),
            [0x1234, 0xFEDC, 0, 0]
        );
        assert_eq!(InputFormat::U32x1.convert(word, 9), u64::from(word) << 4);
    }

    #[test]
    fn words_round_trip_and_have_36_bits() {
        let formats = InputFormat::ALL.map(InputFormat::processing);
        for format in formats {
            assert!(format.fields() as u32 * format.bits() <= WORD_BITS);
            for word in [0, (1 << 36) - 1, 0xA_5A5A_5A5A, 0x5_1234_8765] {
                let packed = format.pack(format.unpack(word));
                assert_eq!(format.unpack(packed), format.unpack(word));
                assert_eq!(packed >> 36, 0);
                assert_eq!(format.lirp(packed, 0, 0, 12), packed);
                assert_eq!(format.lirp(0, packed, 4095, 12), packed);
            }
        }
        for format in InputFormat::ALL {
            assert_eq!(InputFormat::from_code(format.code()), Some(format));
        }
        assert_eq!(InputFormat::from_code(5), None);
    }
}
