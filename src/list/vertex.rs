//! Parameters out of vertices and columns, in the units of a mesh (K15).
//!
//! The form is looked at once a column, not once a vertex; fields of 3 and 6 bytes are taken
//! three words at a time, so that no field costs a division or a 64-bit shift.

use super::format::{Field, FieldForm, VertexFormat};
use super::header::{Header, Id};
use super::words::Words;

/// A coordinate of a mesh, out of a list.
pub trait Place: Copy + Default + bytemuck::Pod {
    /// The form that can be used where it lies.
    const IN_PLACE: FieldForm;

    /// Of a field; `None` where the type cannot hold the form.
    fn of(form: FieldForm, field: [i32; 3]) -> Option<[Self; 3]>;
}

/// A place of a field in Q1.30.
#[inline(always)]
fn q30(form: FieldForm, f: [i32; 3]) -> [i32; 3] {
    let [x, y, z] = f;
    match form {
        FieldForm::S32x3 => f,
        FieldForm::S10x3 => [x << 20, y << 20, z << 21],
        FieldForm::S8x3 => f.map(|v| v << 23),
        _ => f.map(|v| v << 16),
    }
}

impl Place for i16 {
    const IN_PLACE: FieldForm = FieldForm::S16x3;

    #[inline(always)]
    fn of(form: FieldForm, f: [i32; 3]) -> Option<[Self; 3]> {
        let is_fine = matches!(form, FieldForm::S32x3);
        (!is_fine).then(|| q30(form, f).map(|v| (v >> 16) as i16))
    }
}

impl Place for i32 {
    const IN_PLACE: FieldForm = FieldForm::S32x3;

    #[inline(always)]
    fn of(form: FieldForm, f: [i32; 3]) -> Option<[Self; 3]> {
        Some(q30(form, f))
    }
}

impl FieldForm {
    /// A normal in Q1.14 of a field.
    #[inline(always)]
    #[must_use]
    pub fn normal(self, f: [i32; 3]) -> [i16; 3] {
        let [x, y, z] = f;
        let grown = match self {
            Self::S10x3 => [(x * 1025) >> 6, (y * 1025) >> 6, (z * 513) >> 4],
            Self::S8x3 => f.map(|v| v * 129),
            _ => f,
        };
        grown.map(|v| v as i16)
    }
}

/// A colour of a field.
#[inline(always)]
#[must_use]
pub fn colour(f: [i32; 3]) -> [u8; 3] {
    f.map(|v| v as u8)
}

/// Sign-extends the lowest `bits` of `v`.
#[inline(always)]
const fn signed(v: u32, bits: u32) -> i32 {
    (v << (32 - bits)) as i32 >> (32 - bits)
}

/// The first three fields of a form, from its first words.
#[inline(always)]
fn fields(form: FieldForm, w: [u32; 3]) -> [i32; 3] {
    let [w, x, y] = w;
    match form {
        FieldForm::U8x4 | FieldForm::U8x3 => [w, w >> 8, w >> 16].map(|v| (v & 0xFF) as i32),
        FieldForm::S8x3 => [signed(w, 8), signed(w >> 8, 8), signed(w >> 16, 8)],
        FieldForm::S10x3 => [signed(w, 11), signed(w >> 11, 11), w as i32 >> 22],
        FieldForm::S16x3 => [signed(w, 16), w as i32 >> 16, signed(x, 16)],
        FieldForm::S32x3 => [w as i32, x as i32, y as i32],
        FieldForm::U16x2 => [(w & 0xFFFF) as i32, (w >> 16) as i32, 0],
        FieldForm::U32x1 => [w as i32, 0, 0],
    }
}

/// A parameter's form and where it lies: words from the vertex, or from the table.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Slot {
    /// Its form.
    pub form: FieldForm,
    /// Words before it.
    pub word: u32,
}

/// Where the parameters lie that a mesh has.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Layout {
    /// Words of a vertex, or of a table.
    pub words: u32,
    /// The place.
    pub place: Slot,
    /// The diffuse colour.
    pub colour: Option<Slot>,
    /// The normal.
    pub normal: Option<Slot>,
    /// The texture place.
    pub texture: Option<Slot>,
}

impl Layout {
    /// Of the vertices of a block.
    #[must_use]
    pub fn new(format: &VertexFormat, header: Header) -> Self {
        let mut layout = Self {
            words: 0,
            place: Slot {
                form: FieldForm::S16x3,
                word: 0,
            },
            colour: None,
            normal: None,
            texture: None,
        };
        for field in format.fields_of(header) {
            let slot = Slot {
                form: field.form,
                word: layout.words,
            };
            match field.parameter {
                Field::PLACE => layout.place = slot,
                Field::DIFFUSE => layout.colour = Some(slot),
                Field::NORMAL => layout.normal = Some(slot),
                Field::TEXTURE => layout.texture = Some(slot),
                _ => {}
            }
            layout.words += if header.id == Id::Table {
                field.form.column_words(header.count)
            } else {
                field.form.words()
            };
        }
        layout
    }
}

impl Slot {
    /// Whether a colour has an alpha.
    pub(crate) fn has_alpha(self) -> bool {
        self.form == FieldForm::U8x4
    }

    /// The alpha of a colour of four bytes, where a vertex begins; in a table, as many words on as there are vertices
    /// before.
    pub(crate) fn alpha<'w>(self, words: impl Words<'w>, at: u32) -> u8 {
        (words.word(at.wrapping_add(self.word)) >> 24) as u8
    }

    /// The field of the vertex that begins at `at`.
    #[inline(always)]
    pub fn field<'w>(self, words: impl Words<'w>, at: u32) -> [i32; 3] {
        let at = at.wrapping_add(self.word);
        let word = |n: u32| words.word(at.wrapping_add(n));
        let w = match self.form.words() {
            1 => [word(0), 0, 0],
            2 => [word(0), word(1), 0],
            _ => [word(0), word(1), word(2)],
        };
        fields(self.form, w)
    }

    /// Fills `out` with the column of the table that begins at `at`: as many as `out` is long,
    /// at most 65,535. `of` is told the form, which the compiler knows where it is called.
    #[inline]
    pub fn column<'w, T>(
        self,
        words: impl Words<'w>,
        at: u32,
        out: &mut [T],
        of: impl Fn(FieldForm, [i32; 3]) -> T,
    ) {
        let at = at.wrapping_add(self.word);
        let len = self.form.column_words(out.len().min(0xFFFF) as u16);
        if let (FieldForm::S8x3, Some(slice)) = (self.form, words.slice(at, len)) {
            // Whole threes of words, without a question for each whether it is there.
            let whole = out.len() / 4;
            let (fours, end) = out.split_at_mut(4 * whole);
            for (three, four) in slice.chunks_exact(3).zip(fours.chunks_exact_mut(4)) {
                if let ([a, b, c], [p, q, r, s]) = (three, four) {
                    let w = four_of([a, b, c].map(|w| u32::from_le(*w)));
                    let value = |w| of(FieldForm::S8x3, fields(FieldForm::S8x3, [w, 0, 0]));
                    (*p, *q, *r, *s) = (value(w[0]), value(w[1]), value(w[2]), value(w[3]));
                }
            }
            let rest = slice.get(3 * whole..).unwrap_or_default();
            let mut rest = rest.iter().map(|w| u32::from_le(*w));
            let next = || rest.next().unwrap_or(0);
            bytes(FieldForm::S8x3, next, end, |f| of(FieldForm::S8x3, f));
            return;
        }
        let mut rest = (0..).map(|n| words.word(at.wrapping_add(n)));
        column(self.form, || rest.next().unwrap_or(0), out, of);
    }

    /// The column itself, where it lies in one piece and is of this type: `[T; 3]` for each.
    #[inline]
    pub fn in_place<'w, T: bytemuck::Pod>(
        self,
        words: impl Words<'w>,
        at: u32,
        count: u16,
    ) -> Option<&'w [[T; 3]]>
    where
        [T; 3]: bytemuck::Pod,
    {
        let one = size_of::<[T; 3]>();
        if cfg!(target_endian = "big") || self.form.column_bytes() as usize != one {
            return None;
        }
        let len = self.form.column_words(count);
        let slice = words.slice(at.wrapping_add(self.word), len)?;
        let bytes: &[u8] = bytemuck::cast_slice(slice);
        let bytes = bytes.get(..usize::from(count) * one)?;
        bytemuck::try_cast_slice(bytes).ok()
    }
}

/// Takes a column's words apart.
#[inline(always)]
fn column<T>(
    form: FieldForm,
    mut next: impl FnMut() -> u32,
    out: &mut [T],
    of: impl Fn(FieldForm, [i32; 3]) -> T,
) {
    const TEN: FieldForm = FieldForm::S10x3;
    match form {
        FieldForm::U8x3 | FieldForm::S8x3 => bytes(form, next, out, |f| of(form, f)),
        FieldForm::S16x3 => {
            let value = |words| of(form, fields(form, words));
            for pair in out.chunks_mut(2) {
                let (a, b) = (next(), next());
                if let [first, rest @ ..] = pair {
                    *first = value([a, b, 0]);
                    if let [second, ..] = rest {
                        let c = next();
                        *second = value([b >> 16 | c << 16, c >> 16, 0]);
                    }
                }
            }
        }
        FieldForm::S32x3 => out.fill_with(|| of(form, fields(form, [next(), next(), next()]))),
        TEN => out.fill_with(|| of(TEN, fields(TEN, [next(), 0, 0]))),
        FieldForm::U8x4 | FieldForm::U16x2 | FieldForm::U32x1 => {
            out.fill_with(|| of(form, fields(form, [next(), 0, 0])));
        }
    }
}

/// Four fields of three bytes each, in three words.
#[inline(always)]
const fn four_of([a, b, c]: [u32; 3]) -> [u32; 4] {
    [a, a >> 24 | b << 8, b >> 16 | c << 16, c >> 8]
}

/// Fields of three bytes out of words.
#[inline(always)]
fn bytes<T>(
    form: FieldForm,
    mut next: impl FnMut() -> u32,
    out: &mut [T],
    of: impl Fn([i32; 3]) -> T,
) {
    let mut four = || four_of([next(), next(), next()]);
    for part in out.chunks_mut(4) {
        for (slot, word) in part.iter_mut().zip(four()) {
            *slot = of(fields(form, [word, 0, 0]));
        }
    }
}
