//! Blocks into a lent slice of words: what the reader reads back.
//!
//! Nothing is written of a block that does not fit or contradicts itself.

use scanbeam::list::{
    Bounds, CameraWords, Cone, FieldForm, Flow, Head, Header, Id, LightWords, Matrix, Overlay,
    Palette, State, Texture, VertexFormat, Window,
};

/// Why a block was not written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[non_exhaustive]
pub enum WriteError {
    /// The slice is too short.
    Full {
        /// Words that are needed.
        need: u32,
        /// Words that are left.
        have: u32,
    },
    /// The data does not fit the header: other words than the vertices have.
    Length {
        /// Words that the header asks for.
        need: u32,
        /// Words that were given.
        have: u32,
    },
    /// More than 65,535 elements, or an index that does not fit.
    Count,
    /// There is no such block to write over.
    Place,
}

impl std::fmt::Display for WriteError {
    fn fmt(&self, f: &mut std::fmt::Formatter<'_>) -> std::fmt::Result {
        match self {
            Self::Full { need, have } => {
                write!(f, "list: {need} words are needed, {have} are left")
            }
            Self::Length { need, have } => {
                write!(
                    f,
                    "list: the header asks for {need} words, {have} are given"
                )
            }
            Self::Count => f.write_str("list: too many elements, or an index that does not fit"),
            Self::Place => f.write_str("list: no such word"),
        }
    }
}

impl std::error::Error for WriteError {}

/// How triangles are made of vertices.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Form {
    /// Each vertex replaces the oldest of three.
    Strip,
    /// Each vertex replaces the middle one of three.
    Fan,
}

/// Writes blocks one after the other.
#[derive(Debug)]
pub struct ListWriter<'m> {
    words: &'m mut [u32],
    len: usize,
    format: VertexFormat,
}

impl<'m> ListWriter<'m> {
    /// Into an empty slice.
    #[must_use]
    pub fn new(words: &'m mut [u32]) -> Self {
        Self {
            words,
            len: 0,
            format: VertexFormat::default(),
        }
    }

    /// What has been written, as it lies in memory: little-endian.
    #[must_use]
    pub fn words(&self) -> &[u32] {
        self.words.get(..self.len).unwrap_or(&[])
    }

    /// Position of the next block.
    #[must_use]
    pub fn position(&self) -> u32 {
        self.len as u32
    }

    /// The vertex format in force.
    #[must_use]
    pub fn format(&self) -> &VertexFormat {
        &self.format
    }

    /// A header and its data; the words come in number as `count` says.
    fn block(
        &mut self,
        header: u32,
        count: u32,
        data: impl Iterator<Item = u32>,
    ) -> Result<(), WriteError> {
        let need = count.saturating_add(1);
        let rest = self.words.get_mut(self.len..).unwrap_or(&mut []);
        let have = rest.len() as u32;
        let block = rest
            .get_mut(..need as usize)
            .ok_or(WriteError::Full { need, have })?;
        for (slot, word) in block.iter_mut().zip(std::iter::once(header).chain(data)) {
            *slot = word.to_le();
        }
        self.len += need as usize;
        Ok(())
    }

    fn block_of(&mut self, header: Header, data: &[u32]) -> Result<(), WriteError> {
        let count = u32::try_from(data.len()).map_err(|_| WriteError::Count)?;
        self.block(header.to_word(), count, data.iter().copied())
    }

    /// Flow control.
    ///
    /// # Errors
    /// When the slice is too short.
    pub fn flow(&mut self, flow: Flow) -> Result<(), WriteError> {
        let (what, argument) = flow.code();
        let header = Header::of(Id::Flow, u16::from_be_bytes([what, argument]));
        match flow {
            Flow::JumpRelative(by) => self.block_of(header, &[by as u32]),
            Flow::Jump(to) => self.block_of(header, &[to]),
            Flow::LoadTexture { at, .. } => self.block_of(header, &[at]),
            _ => self.block_of(header, &[]),
        }
    }

    /// Writes a state over the one of the same kind at `position`, once more is known: HEAD's
    /// words, say.
    ///
    /// # Errors
    /// When no block of this kind and length stands there.
    pub fn rewrite(&mut self, position: u32, state: &State) -> Result<(), WriteError> {
        let (what, argument, data, len) = words_of_state(state);
        let header = Header::of(Id::State, u16::from_be_bytes([what, argument])).to_word();
        let at = position as usize;
        let block = self.words[..self.len]
            .get_mut(at..)
            .and_then(|rest| rest.get_mut(..=len))
            .filter(|block| block[0] == header.to_le() && !matches!(what, 8..=10))
            .ok_or(WriteError::Place)?;
        for (slot, word) in block[1..].iter_mut().zip(data) {
            *slot = word.to_le();
        }
        Ok(())
    }

    /// Writes where the jump at `position` leads, once it is known: a word of the list, or for a
    /// relative jump how many words behind its end, as a signed number.
    ///
    /// # Errors
    /// When no jump stands there.
    pub fn lead(&mut self, position: u32, target: u32) -> Result<(), WriteError> {
        let at = position as usize;
        let jump = match self.words[..self.len].get_mut(at..) {
            Some([header, target, ..]) => match Header::read(u32::from_le(*header)) {
                Ok(h) if h.id == Id::Flow && matches!(h.what(), 4..=6) => Some(target),
                _ => None,
            },
            _ => None,
        };
        *jump.ok_or(WriteError::Place)? = target.to_le();
        Ok(())
    }

    /// State without bulk data.
    ///
    /// # Errors
    /// When the slice is too short; [`WriteError::Length`] for what has bulk data.
    pub fn state(&mut self, state: &State) -> Result<(), WriteError> {
        let (what, argument, data, len) = words_of_state(state);
        if matches!(what, 8..=10) {
            return Err(WriteError::Length { need: 1, have: 0 });
        }
        let header = Header::of(Id::State, u16::from_be_bytes([what, argument]));
        self.block_of(header, data.get(..len).unwrap_or(&data))?;
        if let State::Format(format) = state {
            self.format = *format;
        }
        Ok(())
    }

    /// A texture, palette or overlay with its words; where it says that they lie does not count.
    ///
    /// # Errors
    /// When the slice is too short, or there are not as many words as there must be.
    pub fn bulk(&mut self, state: &State, data: &[u32]) -> Result<(), WriteError> {
        let need = match state {
            State::Texture(texture) => texture.words(),
            State::Palette(palette) => u32::from(palette.count),
            State::Overlay(overlay) => overlay.words(),
            _ => 0,
        };
        let have = data.len() as u32;
        if need == 0 || need != have {
            return Err(WriteError::Length { need, have });
        }
        let (what, argument, head, len) = words_of_state(state);
        let header = Header::of(Id::State, u16::from_be_bytes([what, argument]));
        let head = head.get(..len).unwrap_or(&head).iter().copied();
        let count = len as u32 + need;
        self.block(header.to_word(), count, head.chain(data.iter().copied()))
    }

    /// Vertices in the format in force (in LONG, of its fixed form): `header` says what they are,
    /// its CNT how many; or a TABLE, column by column.
    ///
    /// # Errors
    /// When the slice is too short, or the words are not as many as the header asks for.
    pub fn vertices(&mut self, header: Header, data: &[u32]) -> Result<(), WriteError> {
        let count = u32::from(header.count);
        let need = match header.id {
            Id::Short | Id::Points | Id::Quads => self.format.words(header) * count,
            Id::Table => self.format.table_words(header, header.count),
            Id::Long => header.long_words() * count,
            _ => return Err(WriteError::Place),
        };
        let have = data.len() as u32;
        if need != have {
            return Err(WriteError::Length { need, have });
        }
        self.block_of(header, data)
    }

    /// Triangles of the last table: three indices each, or with a form as strips or fans, where
    /// `None` ends one and begins another.
    ///
    /// # Errors
    /// When the slice is too short, there are too many, or an index does not fit 8 bits where
    /// they are not `wide`.
    pub fn indexed<I>(
        &mut self,
        form: Option<Form>,
        wide: bool,
        indices: I,
    ) -> Result<(), WriteError>
    where
        I: ExactSizeIterator<Item = Option<u16>> + Clone,
    {
        let count = u16::try_from(indices.len()).map_err(|_| WriteError::Count)?;
        let restart = if wide { 0xFFFF } else { 0xFF };
        let misfit = |i: Option<u16>| match i {
            Some(i) => u32::from(i) >= restart,
            None => form.is_none(),
        };
        if indices.clone().any(misfit) || (form.is_none() && count % 3 != 0) {
            return Err(WriteError::Count);
        }
        let header = Header {
            new: true,
            rm: form == Some(Form::Fan),
            low: u8::from(wide) * Header::WIDE + u8::from(form.is_none()) * Header::SEPARATE,
            ..Header::of(Id::Indexed, count)
        };
        let (a_word, bits) = if wide { (2, 16) } else { (4, 8) };
        let words = u32::from(count).div_ceil(a_word);
        let mut rest = indices.map(|i| i.map_or(restart, u32::from));
        let data = (0..words).map(|_| {
            (0..a_word).fold(0, |word, n| {
                word | rest.next().unwrap_or(restart) << (bits * n)
            })
        });
        self.block(header.to_word(), words, data)
    }

    /// A try to reach the master state: for tests of readers.
    ///
    /// # Errors
    /// When the slice is too short.
    pub fn master(&mut self, register: u32) -> Result<(), WriteError> {
        self.block_of(Header::of(Id::Master, 1), &[register])
    }
}

/// Kind, argument, and the words behind the header but for bulk data.
fn words_of_state(state: &State) -> (u8, u8, [u32; 13], usize) {
    let mut w = [0; 13];
    let pair = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
    let (what, argument, len) = match state {
        State::Head(Head {
            words,
            table,
            triangles,
        }) => {
            w[..4].copy_from_slice(&[Head::MAGIC, *words, *table, *triangles]);
            (0, 0, 4)
        }
        State::Format(format) => {
            let fields = format.fields();
            for (i, field) in fields.iter().enumerate() {
                w[i / 4] |= u32::from(field.to_byte()) << (8 * (i % 4));
            }
            (1, fields.len() as u8, fields.len().div_ceil(4))
        }
        State::Matrix(Matrix {
            linear,
            linear_exponent,
            offset,
            offset_exponent,
        }) => {
            for (slot, m) in w.iter_mut().zip(linear) {
                *slot = *m as u32;
            }
            w[9] = pair(*linear_exponent as u16, *offset_exponent as u16);
            for (slot, m) in w[10..].iter_mut().zip(offset) {
                *slot = *m as u32;
            }
            (2, 0, 13)
        }
        State::Light {
            number,
            light:
                LightWords {
                    direction,
                    ambient,
                    colour: [r, g, b],
                },
        } => {
            w[0] = pair(direction[0] as u16, direction[1] as u16);
            w[1] = pair(direction[2] as u16, *ambient);
            w[2] = u32::from_le_bytes([*r, *g, *b, 0]);
            (3, *number, 3)
        }
        State::LightOff { number } => (4, *number, 0),
        State::Material(m) => {
            let [r, g, b] = m.diffuse;
            w[0] = u32::from_le_bytes([r, g, b, m.opacity]);
            let [r, g, b] = m.specular;
            w[1] = u32::from_le_bytes([r, g, b, m.exponent]);
            w[2] = u32::from(m.two_sided)
                | u32::from(m.unlit) << 1
                | m.texture.map_or(0, |n| 4 | u32::from(n) << 8);
            (5, 0, 3)
        }
        State::Camera(CameraWords {
            eye,
            at,
            up,
            focal,
            near,
            far,
        }) => {
            let all = eye.iter().chain(at).chain(up).chain([focal, near, far]);
            for (slot, v) in w.iter_mut().zip(all) {
                *slot = v.to_bits();
            }
            (6, 0, 12)
        }
        State::Window(Window {
            left,
            top,
            right,
            bottom,
        }) => {
            w[0] = pair(*left, *top);
            w[1] = pair(*right, *bottom);
            (7, 0, 2)
        }
        State::Texture(t @ Texture { number, form, .. }) => {
            w[0] = u32::from(t.log_width)
                | u32::from(t.log_height) << 4
                | u32::from(*form as u8) << 8
                | u32::from(t.levels.wrapping_sub(1) & 3) << 12
                | u32::from(t.palette) << 16
                | u32::from(t.clamped) << 24;
            w[1] = t.words();
            (8, *number, 2)
        }
        State::Palette(Palette { number, count, .. }) => {
            w[0] = u32::from(*count);
            (9, *number, 1)
        }
        State::Overlay(o @ Overlay { form, .. }) => {
            w[0] = pair(o.left, o.top);
            w[1] = pair(o.width, o.height);
            w[2] = u32::from(*form as u8) | u32::from(o.additive) << 4 | u32::from(o.palette) << 8;
            (10, 0, 3)
        }
        State::Bounds(Bounds {
            centre,
            radius,
            exponent,
            words,
        }) => {
            for (slot, m) in w.iter_mut().zip(centre.iter().chain([radius])) {
                *slot = *m as u32;
            }
            w[4] = i32::from(*exponent) as u32;
            w[5] = *words;
            (11, 0, 6)
        }
        State::PointSize(pixels) => (12, *pixels, 0),
        State::Cone(Cone {
            apex,
            axis: [x, y, z],
            spread,
            words,
        }) => {
            let axis = [pair(*x as u16, *y as u16), pair(*z as u16, *spread)];
            for (slot, word) in w
                .iter_mut()
                .zip(apex.map(|a| a as u32).into_iter().chain(axis))
            {
                *slot = word;
            }
            w[5] = *words;
            (13, 0, 6)
        }
    };
    (what, argument, w, len)
}

/// Packs numbers into the words of a vertex or of a column, as a form has them.
#[derive(Debug)]
pub struct FieldPacker<F: FnMut(u32)> {
    emit: F,
    bits: u64,
    have: u32,
}

impl<F: FnMut(u32)> FieldPacker<F> {
    /// Words go to `emit`.
    pub fn new(emit: F) -> Self {
        Self {
            emit,
            bits: 0,
            have: 0,
        }
    }

    fn push(&mut self, value: u32, bits: u32) {
        let value = u64::from(value) & ((1 << bits) - 1);
        self.bits |= value << self.have;
        self.have += bits;
        if self.have >= 32 {
            (self.emit)(self.bits as u32);
            self.bits >>= 32;
            self.have -= 32;
        }
    }

    /// One parameter: as many of `values` as the form has fields, each cut to its bits.
    pub fn field(&mut self, form: FieldForm, values: [i32; 4]) {
        let v = values.map(|v| v as u32);
        let (bits, fields): ([u32; 4], usize) = match form {
            FieldForm::U8x4 => ([8; 4], 4),
            FieldForm::S10x3 => ([11, 11, 10, 0], 3),
            FieldForm::S16x3 => ([16; 4], 3),
            FieldForm::U16x2 => ([16; 4], 2),
            FieldForm::U32x1 => ([32; 4], 1),
            FieldForm::S32x3 => ([32; 4], 3),
            FieldForm::U8x3 | FieldForm::S8x3 => ([8; 4], 3),
        };
        for (value, bits) in v.into_iter().zip(bits).take(fields) {
            self.push(value, bits);
        }
    }

    /// Fills up to a whole word: after each parameter of a vertex, and after a column.
    pub fn align(&mut self) {
        if self.have > 0 {
            self.push(0, 32 - self.have);
        }
    }
}
