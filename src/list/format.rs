//! The table that describes a vertex (K15): which parameters it has, in which order and form.
//!
//! A parameter's number says what it is and which bit of the header brings it in; what no bit
//! names is always there and passed over, so that a list may carry what this reader does not know.
//!
//! | number | parameter | there when | forms |
//! |---|---|---|---|
//! | 0 | place | always | 1, 2, 5, 7 |
//! | 1 | depth | PRSP | 4 |
//! | 2 | diffuse colour | SHADE | 0, 6 |
//! | 3 | specular colour | SHADE | 0, 6 |
//! | 4 | normal | SHADE | 1, 2, 7 |
//! | 5 | texture place | TEXT | 3 |
//! | 6..15 | the application's own | always | any |
//!
//! | code | form | fields, first lowest | words in a vertex | bytes in a column |
//! |---|---|---|---|---|
//! | 0 | 4x8U | 8, 8, 8, 8 | 1 | 4 |
//! | 1 | 3x10S | signed 11, 11, 10 | 1 | 4 |
//! | 2 | 3x16S | signed 16, 16, 16, then 16 unused bits in a vertex | 2 | 6 |
//! | 3 | 2x16U | 16, 16 | 1 | 4 |
//! | 4 | 1x32U | 32 | 1 | 4 |
//! | 5 | 3x32S | signed 32, 32, 32 | 3 | 12 |
//! | 6 | 3x8U | 8, 8, 8, then 8 unused bits in a vertex | 1 | 3 |
//! | 7 | 3x8S | signed 8, 8, 8, then 8 unused bits in a vertex | 1 | 3 |
//!
//! Places: 3x16S is Q1.14 and 3x32S Q1.30, -2 ..< 2; 3x10S and 3x8S are -1 ..< 1 with 10 or 9, and
//! 7 fraction bits. Normals: 3x16S is Q1.14; in the others a field of n fraction bits is `1 + 2^-n`
//! times its place's meaning, so that the largest is 1, rounded down to 14 bits. Colours: red,
//! green, blue, and in 4x8U alpha; the specular one is passed over here, since a material has it.
//! Texture places: u and v in 4.12, v downwards.

use super::error::Reason;
use super::header::Header;

/// Parameters of a vertex, at most.
const PARAMETERS: usize = 16;

/// How a parameter is stored.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[repr(u8)]
pub enum FieldForm {
    /// Four unsigned fields of 8 bits.
    U8x4 = 0,
    /// Signed fields of 11, 11 and 10 bits.
    S10x3 = 1,
    /// Three signed fields of 16 bits.
    S16x3 = 2,
    /// Two unsigned fields of 16 bits.
    U16x2 = 3,
    /// One unsigned field of 32 bits.
    U32x1 = 4,
    /// Three signed fields of 32 bits.
    S32x3 = 5,
    /// Three unsigned fields of 8 bits.
    U8x3 = 6,
    /// Three signed fields of 8 bits.
    S8x3 = 7,
}

impl FieldForm {
    /// All, in the order of their codes.
    pub const ALL: [Self; 8] = [
        Self::U8x4,
        Self::S10x3,
        Self::S16x3,
        Self::U16x2,
        Self::U32x1,
        Self::S32x3,
        Self::U8x3,
        Self::S8x3,
    ];

    /// 32-bit words of a column of a table that has `count` vertices.
    #[must_use]
    pub const fn column_words(self, count: u16) -> u32 {
        (self.column_bytes() * count as u32).div_ceil(4)
    }

    /// 32-bit words in a vertex.
    #[must_use]
    pub const fn words(self) -> u32 {
        match self {
            Self::S16x3 => 2,
            Self::S32x3 => 3,
            _ => 1,
        }
    }

    /// Bytes in a column.
    #[must_use]
    pub const fn column_bytes(self) -> u32 {
        match self {
            Self::U8x3 | Self::S8x3 => 3,
            Self::S16x3 => 6,
            Self::S32x3 => 12,
            _ => 4,
        }
    }
}

/// One line of the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Field {
    /// Number of the parameter, 0 to 15.
    pub parameter: u8,
    /// Its form.
    pub form: FieldForm,
}

/// The parameters that have a meaning here, by their numbers.
impl Field {
    /// Where the vertex is.
    pub const PLACE: u8 = 0;
    /// 1/w.
    pub const DEPTH: u8 = 1;
    /// Diffuse colour.
    pub const DIFFUSE: u8 = 2;
    /// Specular colour.
    pub const SPECULAR: u8 = 3;
    /// Normal.
    pub const NORMAL: u8 = 4;
    /// Texture place.
    pub const TEXTURE: u8 = 5;

    const fn new(parameter: u8, form: FieldForm) -> Self {
        Self { parameter, form }
    }

    /// The table's byte: parameter above, form below.
    #[must_use]
    pub const fn to_byte(self) -> u8 {
        self.parameter << 4 | self.form as u8
    }

    fn read(byte: u8) -> Result<Self, Reason> {
        use FieldForm::{S8x3, S10x3, S16x3, S32x3, U8x3, U8x4, U16x2, U32x1};
        let (parameter, format) = (byte >> 4, byte & 15);
        let bad = Reason::Format { parameter, format };
        let form = *FieldForm::ALL.get(usize::from(format)).ok_or(bad)?;
        let good = match parameter {
            Field::PLACE => matches!(form, S10x3 | S16x3 | S32x3 | S8x3),
            Field::DEPTH => form == U32x1,
            Field::DIFFUSE | Field::SPECULAR => matches!(form, U8x4 | U8x3),
            Field::NORMAL => matches!(form, S10x3 | S16x3 | S8x3),
            Field::TEXTURE => form == U16x2,
            _ => true,
        };
        good.then_some(Self { parameter, form }).ok_or(bad)
    }

    /// Whether a block with this header has the parameter.
    #[inline]
    const fn is_in(self, header: Header) -> bool {
        match self.parameter {
            Field::DEPTH => header.prsp,
            Field::DIFFUSE | Field::SPECULAR | Field::NORMAL => header.shade,
            Field::TEXTURE => header.text,
            _ => true,
        }
    }
}

/// A table that was read whole: each parameter at most once, a place among them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct VertexFormat {
    fields: [Field; PARAMETERS],
    /// 1 to [`PARAMETERS`].
    len: u8,
}

impl Default for VertexFormat {
    /// What a list begins with: place 3x16S, diffuse 4x8U, normal 3x10S, texture place 2x16U.
    fn default() -> Self {
        use FieldForm::{S10x3, S16x3, U8x4, U16x2};
        let mut fields = [Field::new(Field::PLACE, S16x3); PARAMETERS];
        fields[1] = Field::new(Field::DIFFUSE, U8x4);
        fields[2] = Field::new(Field::NORMAL, S10x3);
        fields[3] = Field::new(Field::TEXTURE, U16x2);
        Self { fields, len: 4 }
    }
}

impl VertexFormat {
    /// Of these fields.
    ///
    /// # Errors
    /// When there is none or more than 16, a parameter comes twice or in a form that
    /// it cannot have, or there is no place.
    pub fn new(fields: &[Field]) -> Result<Self, Reason> {
        Self::from_bytes(fields.len(), fields.iter().map(|f| f.to_byte()))
    }

    pub(super) fn from_bytes(len: usize, bytes: impl Iterator<Item = u8>) -> Result<Self, Reason> {
        if len == 0 || len > PARAMETERS {
            return Err(Reason::Count(len.min(0xFFFF) as u16));
        }
        let mut format = Self {
            len: len as u8,
            ..Self::default()
        };
        let bad = |parameter, format| Err(Reason::Format { parameter, format });
        let mut seen = 0u32;
        for (slot, byte) in format.fields.iter_mut().zip(bytes.take(len)) {
            let field = Field::read(byte)?;
            let bit = 1 << field.parameter;
            if seen & bit != 0 {
                return bad(field.parameter, field.form as u8);
            }
            seen |= bit;
            *slot = field;
        }
        if seen & 1 == 0 {
            return bad(Field::PLACE, 0xFF);
        }
        Ok(format)
    }

    /// The fields, in order.
    #[must_use]
    pub fn fields(&self) -> &[Field] {
        self.fields.get(..usize::from(self.len)).unwrap_or(&[])
    }

    /// The fields that a block with this header has.
    pub fn fields_of(&self, header: Header) -> impl Iterator<Item = Field> + '_ {
        let all = self.fields().iter().copied();
        all.filter(move |f| f.is_in(header))
    }

    /// Words of a vertex, 1 to 48.
    #[must_use]
    pub fn words(&self, header: Header) -> u32 {
        self.sum(header, &FieldForm::words)
    }

    /// The sum over the fields of a block; called through a pointer, since a loop over 16 fields unrolls to 2 KB.
    #[inline(never)]
    fn sum(&self, header: Header, of: &dyn Fn(FieldForm) -> u32) -> u32 {
        self.fields_of(header).map(|f| of(f.form)).sum()
    }

    /// Words of a table of `count` vertices: each column is padded to a word.
    #[must_use]
    pub fn table_words(&self, header: Header, count: u16) -> u32 {
        self.sum(header, &|form| form.column_words(count))
    }
}

#[cfg(test)]
mod tests {
    use super::super::header::Id;
    use super::*;

    #[test]
    fn header_bits_choose_the_fields() {
        let format = VertexFormat::default();
        let mut header = Header::of(Id::Short, 3);
        assert_eq!(format.words(header), 2);
        header.shade = true;
        assert_eq!(format.words(header), 4);
        header.text = true;
        assert_eq!(format.words(header), 5);
        assert_eq!(format.table_words(header, 3), 5 + 3 + 3 + 3);
    }

    #[test]
    fn bad_tables_are_refused() {
        let read = |bytes: &[u8]| VertexFormat::from_bytes(bytes.len(), bytes.iter().copied());
        assert!(read(&[0x02]).is_ok());
        assert!(read(&[0x24, 0x02]).is_err(), "a colour in 32 bits");
        assert!(read(&[0x20]).is_err(), "no place");
        assert!(read(&[0x02, 0x02]).is_err(), "twice");
        assert!(read(&[]).is_err() && read(&[0x02; 17]).is_err());
        assert!(read(&[0x08]).is_err(), "no such form");
        assert!(read(&[0x62, 0x05, 0xF7]).is_ok(), "parameters of one's own");
        let mut good = 0;
        for byte in 0..=255u8 {
            good += u32::from(Field::read(byte).is_ok());
        }
        assert_eq!(good, 4 + 1 + 2 + 2 + 3 + 1 + 10 * 8);
    }
}
