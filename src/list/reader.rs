//! Words into blocks: total, in place, and bounded (X7).
//!
//! A block is checked whole, its length included, before any of it is done. What it costs to
//! read one is bounded by a constant: bulk data is not touched here.

use super::block::{
    Bounds, CameraWords, Cone, Flow, Head, Instruction, LightWords, Material, Matrix, Overlay,
    Palette, Run, State, TexelForm, Texture, Window,
};
use super::error::{ListError, Reason};
use super::format::VertexFormat;
use super::header::{Header, Id};
use super::words::Words;

/// A block and how long it is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Parsed {
    /// What it says.
    pub instruction: Instruction,
    /// Its words, the header included.
    pub words: u32,
}

/// Reads the block at word `at`; vertices are as `format` describes them.
///
/// # Errors
/// [`ListError`]: it says where the block is, what it is, and what is wrong.
#[inline]
pub fn read_block<'w>(
    words: impl Words<'w>,
    at: u32,
    format: &VertexFormat,
) -> Result<Parsed, ListError> {
    let have = words.end().wrapping_sub(at);
    let fail = |block, reason| ListError::at(at, block, reason);
    if have == 0 {
        return Err(fail(None, Reason::Truncated { need: 1, have }));
    }
    let header = Header::read(words.word(at)).map_err(|r| fail(None, r))?;
    let block = Block {
        words,
        at,
        have,
        header,
    };
    let read = match header.id {
        Id::Short | Id::Points | Id::Quads => block.vertices(format),
        Id::Long => block.run(header.long_words() * u32::from(header.count)),
        Id::Table => block.run(format.table_words(header, header.count)),
        Id::Indexed => block.indexed(),
        Id::Flow => block.flow(),
        Id::State => block.state(),
        Id::Later | Id::Master => block.foreign(),
    };
    read.map_err(|reason| fail(Some(header.id), reason))
}

/// Words behind the header that each kind of STATE has, without those of fields, texels, colours and pixels.
const STATE_WORDS: [u8; 14] = [4, 0, 13, 3, 0, 3, 12, 2, 2, 1, 3, 6, 0, 6];

/// A block whose header was read.
struct Block<W> {
    words: W,
    at: u32,
    have: u32,
    header: Header,
}

impl<'w, W: Words<'w>> Block<W> {
    /// The word `n` of the block, the header being 0.
    fn word(&self, n: u32) -> u32 {
        self.words.word(self.at.wrapping_add(n))
    }

    fn signed(&self, n: u32) -> i32 {
        self.word(n) as i32
    }

    /// The lower and the upper half of the word `n`.
    fn halves(&self, n: u32) -> [u16; 2] {
        [self.word(n) as u16, (self.word(n) >> 16) as u16]
    }

    /// Why the word `word` is refused.
    fn bad(&self, word: u32) -> Reason {
        let value = self.word(word);
        Reason::Value { word, value }
    }

    /// Refuses the word `n`, unless it is as it may be.
    fn require(&self, n: u32, is_good: bool) -> Result<(), Reason> {
        is_good.then_some(()).ok_or_else(|| self.bad(n))
    }

    /// Refuses the count, unless it is as it may be.
    fn require_count(&self, is_good: bool) -> Result<(), Reason> {
        let bad = Reason::Count(self.header.count);
        is_good.then_some(()).ok_or(bad)
    }

    /// Whether `data` words behind the header are there; the block's length.
    #[inline]
    fn length(&self, data: u32) -> Result<u32, Reason> {
        let need = 1 + data;
        if need <= self.have {
            return Ok(need);
        }
        let have = self.have;
        match self.words.room() {
            Some(room) if need > room => Err(Reason::TooLong { need, room }),
            _ => Err(Reason::Truncated { need, have }),
        }
    }

    #[inline]
    fn run(&self, data: u32) -> Result<Parsed, Reason> {
        let words = self.length(data)?;
        let run = Run {
            header: self.header,
            at: self.at.wrapping_add(1),
        };
        let instruction = match self.header.id {
            Id::Long => Instruction::Long(run),
            Id::Points => Instruction::Points(run),
            Id::Quads => Instruction::Quads(run),
            Id::Table => Instruction::Table(run),
            Id::Indexed => Instruction::Indexed(run),
            _ => Instruction::Short(run),
        };
        Ok(Parsed { instruction, words })
    }

    fn vertices(&self, format: &VertexFormat) -> Result<Parsed, Reason> {
        let Header { count, rm, id, .. } = self.header;
        let group = match id {
            Id::Quads if rm => 2,
            Id::Quads => 4,
            _ => 1,
        };
        self.require_count(count % group == 0)?;
        self.run(format.words(self.header) * u32::from(count))
    }

    fn indexed(&self) -> Result<Parsed, Reason> {
        let header = self.header;
        let separate = header.low & Header::SEPARATE != 0;
        self.require_count(!separate || header.count.is_multiple_of(3))?;
        if separate && (header.rm || !header.new) {
            return Err(Reason::Reserved(header.to_word()));
        }
        let a_word = if header.low & Header::WIDE != 0 { 2 } else { 4 };
        self.run(u32::from(header.count).div_ceil(a_word))
    }

    /// A block of which only its length is known.
    fn foreign(&self) -> Result<Parsed, Reason> {
        let words = self.length(u32::from(self.header.count))?;
        let instruction = match self.header.id {
            Id::Master => Instruction::Master(if words > 1 { self.word(1) } else { 0 }),
            _ => Instruction::Later,
        };
        Ok(Parsed { instruction, words })
    }

    fn flow(&self) -> Result<Parsed, Reason> {
        let (what, argument) = (self.header.what(), self.header.argument());
        let (at, number) = (self.word(1), argument);
        let (flow, data) = match what {
            0 => (Flow::End, 0),
            1 => (Flow::Pause, 0),
            2 => (Flow::Sync, 0),
            3 => (Flow::Interrupt(argument), 0),
            4 => (Flow::JumpRelative(self.signed(1)), 1),
            5 => (Flow::Jump(at), 1),
            6 => (Flow::LoadTexture { number, at }, 1),
            kind => return Err(Reason::Kind(kind)),
        };
        self.require_count(argument == 0 || matches!(what, 3 | 6))?;
        Ok(Parsed {
            instruction: Instruction::Flow(flow),
            words: self.length(data)?,
        })
    }

    fn state(&self) -> Result<Parsed, Reason> {
        let (what, number) = (self.header.what(), self.header.argument());
        self.require_count(match what {
            1 | 3 | 4 | 8 | 9 => true,
            12 => number != 0,
            _ => number == 0,
        })?;
        let least = STATE_WORDS.get(usize::from(what));
        let least = u32::from(*least.ok_or(Reason::Kind(what))?);
        self.length(least)?;
        let state = match what {
            0 => State::Head(self.head()?),
            1 => State::Format(self.format(number)?),
            2 => State::Matrix(self.matrix()?),
            3 => {
                let light = self.light()?;
                State::Light { number, light }
            }
            4 => State::LightOff { number },
            5 => State::Material(self.material()?),
            6 => State::Camera(self.camera()?),
            7 => State::Window(self.window()?),
            8 => State::Texture(self.texture(number)?),
            9 => State::Palette(self.palette(number)?),
            10 => State::Overlay(self.overlay()?),
            11 => State::Bounds(self.bounds()?),
            12 => State::PointSize(number),
            _ => State::Cone(self.cone()?),
        };
        let more = match state {
            State::Format(_) => u32::from(number).div_ceil(4),
            State::Texture(texture) => texture.words(),
            State::Palette(palette) => palette.count.into(),
            State::Overlay(overlay) => overlay.words(),
            _ => 0,
        };
        Ok(Parsed {
            instruction: Instruction::State(state),
            words: self.length(least + more)?,
        })
    }

    fn format(&self, count: u8) -> Result<VertexFormat, Reason> {
        self.length(u32::from(count).div_ceil(4))?;
        let byte = |n: u32| (self.word(1 + n / 4) >> (8 * (n % 4))) as u8;
        VertexFormat::from_bytes(count.into(), (0..).map(byte))
    }

    fn head(&self) -> Result<Head, Reason> {
        self.require(1, self.word(1) == Head::MAGIC)?;
        let head = Head {
            words: self.word(2),
            table: self.word(3),
            triangles: self.word(4),
        };
        // A list that was cut short is noticed at its beginning; a ring is never whole.
        if self.words.room().is_none() && head.words > self.have {
            let (need, have) = (head.words, self.have);
            return Err(Reason::Truncated { need, have });
        }
        Ok(head)
    }

    /// An exponent as blocks of fixed point may have it.
    fn exponent(&self, n: u32, value: i16) -> Result<i16, Reason> {
        self.require(n, (-128..=96).contains(&value))?;
        Ok(value)
    }

    fn mantissas<const N: usize>(&self, first: u32) -> Result<[i32; N], Reason> {
        let mut mantissa = [0; N];
        for (n, m) in (first..).zip(&mut mantissa) {
            *m = self.signed(n);
            self.require(n, m.unsigned_abs() >> 30 == 0)?;
        }
        Ok(mantissa)
    }

    fn matrix(&self) -> Result<Matrix, Reason> {
        let [linear, offset] = self.halves(10);
        Ok(Matrix {
            linear: self.mantissas(1)?,
            linear_exponent: self.exponent(10, linear as i16)?,
            offset: self.mantissas(11)?,
            offset_exponent: self.exponent(10, offset as i16)?,
        })
    }

    fn light(&self) -> Result<LightWords, Reason> {
        let ([x, y], [z, ambient]) = (self.halves(1), self.halves(2));
        let [r, g, b, none] = self.word(3).to_le_bytes();
        self.require(3, none == 0)?;
        self.require(2, ambient <= 1 << 15)?;
        Ok(LightWords {
            direction: [x, y, z].map(|part| part as i16),
            ambient,
            colour: [r, g, b],
        })
    }

    fn material(&self) -> Result<Material, Reason> {
        let [r, g, b, opacity] = self.word(1).to_le_bytes();
        let [sr, sg, sb, exponent] = self.word(2).to_le_bytes();
        let flags = self.word(3);
        let textured = flags & 4 != 0;
        let known = if textured { 0xFF07 } else { 7 };
        self.require(3, flags & !known == 0)?;
        Ok(Material {
            diffuse: [r, g, b],
            opacity,
            specular: [sr, sg, sb],
            exponent,
            two_sided: flags & 1 != 0,
            unlit: flags & 2 != 0,
            texture: textured.then_some((flags >> 8) as u8),
        })
    }

    fn camera(&self) -> Result<CameraWords, Reason> {
        let float = |n| f32::from_bits(self.word(n));
        for n in 1..=12 {
            self.require(n, float(n).is_finite())?;
        }
        let vector = |n| [float(n), float(n + 1), float(n + 2)];
        Ok(CameraWords {
            eye: vector(1),
            at: vector(4),
            up: vector(7),
            focal: float(10),
            near: float(11),
            far: float(12),
        })
    }

    fn window(&self) -> Result<Window, Reason> {
        let ([left, top], [right, bottom]) = (self.halves(1), self.halves(2));
        self.require(2, left < right && top < bottom)?;
        Ok(Window {
            left,
            top,
            right,
            bottom,
        })
    }

    fn form(&self, n: u32, code: u32) -> Result<TexelForm, Reason> {
        let form = TexelForm::ALL.get(code as usize);
        form.copied().ok_or_else(|| self.bad(n))
    }

    fn texture(&self, number: u8) -> Result<Texture, Reason> {
        let word = self.word(1);
        let texture = Texture {
            number,
            log_width: word as u8 & 15,
            log_height: (word >> 4) as u8 & 15,
            form: self.form(1, word >> 8 & 15)?,
            levels: 1 + (word >> 12 & 3) as u8,
            palette: (word >> 16) as u8,
            clamped: word >> 24 & 1 != 0,
            at: self.at.wrapping_add(3),
        };
        let sides = texture.log_width.max(texture.log_height);
        self.require(1, sides <= 10 && word & 0xFE00_C000 == 0)?;
        self.require(2, self.word(2) == texture.words())?;
        Ok(texture)
    }

    fn palette(&self, number: u8) -> Result<Palette, Reason> {
        let count = self.word(1);
        self.require(1, (1..=256).contains(&count))?;
        Ok(Palette {
            number,
            count: count as u16,
            at: self.at.wrapping_add(2),
        })
    }

    fn overlay(&self) -> Result<Overlay, Reason> {
        let ([left, top], [width, height]) = (self.halves(1), self.halves(2));
        let word = self.word(3);
        let form = self.form(3, word & 15)?;
        let sides = 1..=1024;
        self.require(2, sides.contains(&width) && sides.contains(&height))?;
        self.require(3, word & !0xFF1F == 0)?;
        Ok(Overlay {
            left,
            top,
            width,
            height,
            form,
            additive: word >> 4 & 1 != 0,
            palette: (word >> 8) as u8,
            at: self.at.wrapping_add(4),
        })
    }

    fn bounds(&self) -> Result<Bounds, Reason> {
        let [x, y, z, radius] = self.mantissas(1)?;
        self.require(4, radius >= 0)?;
        // What takes more bits is out of range as well.
        let exponent = i16::try_from(self.signed(5)).unwrap_or(i16::MAX);
        Ok(Bounds {
            centre: [x, y, z],
            radius,
            exponent: self.exponent(5, exponent)?,
            words: self.word(6),
        })
    }

    fn cone(&self) -> Result<Cone, Reason> {
        let ([x, y], [z, spread]) = (self.halves(4), self.halves(5));
        Ok(Cone {
            apex: [1, 2, 3].map(|n| self.signed(n)),
            axis: [x, y, z].map(|part| part as i16),
            spread,
            words: self.word(6),
        })
    }
}
