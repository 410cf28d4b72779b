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
    let fail = |block, reason| ListError {
        offset: at.wrapping_mul(4),
        block,
        reason,
    };
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

    /// Refuses the word `n`.
    fn bad<T>(&self, n: u32) -> Result<T, Reason> {
        Err(Reason::Value {
            word: n,
            value: self.word(n),
        })
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
        let uneven = match (id, rm) {
            (Id::Quads, false) => count % 4 != 0,
            (Id::Quads, true) => count % 2 != 0,
            _ => false,
        };
        if uneven {
            return Err(Reason::Count(count));
        }
        self.run(format.words(self.header) * u32::from(count))
    }

    fn indexed(&self) -> Result<Parsed, Reason> {
        let Header {
            count,
            low,
            new,
            rm,
            ..
        } = self.header;
        let separate = low & Header::SEPARATE != 0;
        if separate && (count % 3 != 0 || rm || !new) {
            return Err(if count % 3 != 0 {
                Reason::Count(count)
            } else {
                Reason::Reserved(self.header.to_word())
            });
        }
        let a_word = if low & Header::WIDE != 0 { 2 } else { 4 };
        self.run(u32::from(count).div_ceil(a_word))
    }

    /// A block of which only its length is known.
    fn foreign(&self) -> Result<Parsed, Reason> {
        let words = self.length(u32::from(self.header.count))?;
        let instruction = match self.header.id {
            Id::Master if words > 1 => Instruction::Master(self.word(1)),
            Id::Master => Instruction::Master(0),
            _ => Instruction::Later,
        };
        Ok(Parsed { instruction, words })
    }

    fn flow(&self) -> Result<Parsed, Reason> {
        let (what, argument) = (self.header.what(), self.header.argument());
        let data = match what {
            0..=3 => 0,
            4..=6 => 1,
            kind => return Err(Reason::Kind(kind)),
        };
        if !matches!(what, 3 | 6) && argument != 0 {
            return Err(Reason::Count(self.header.count));
        }
        let words = self.length(data)?;
        let flow = match what {
            0 => Flow::End,
            1 => Flow::Pause,
            2 => Flow::Sync,
            3 => Flow::Interrupt(argument),
            4 => Flow::JumpRelative(self.signed(1)),
            5 => Flow::Jump(self.word(1)),
            _ => Flow::LoadTexture {
                number: argument,
                at: self.word(1),
            },
        };
        Ok(Parsed {
            instruction: Instruction::Flow(flow),
            words,
        })
    }

    fn state(&self) -> Result<Parsed, Reason> {
        let number = self.header.argument();
        let what = self.header.what();
        if !matches!(what, 1 | 3 | 4 | 8 | 9 | 12) && number != 0 {
            return Err(Reason::Count(self.header.count));
        }
        let (state, words) = match what {
            0 => (State::Head(self.head()?), 5),
            1 => {
                let words = self.length(u32::from(number).div_ceil(4))?;
                let byte = |n: u32| (self.word(1 + n / 4) >> (8 * (n % 4))) as u8;
                let format = VertexFormat::from_bytes(usize::from(number), (0..).map(byte))?;
                (State::Format(format), words)
            }
            2 => (State::Matrix(self.matrix()?), 14),
            3 => {
                let light = self.light()?;
                (State::Light { number, light }, 4)
            }
            4 => (State::LightOff { number }, 1),
            5 => (State::Material(self.material()?), 4),
            6 => (State::Camera(self.camera()?), 13),
            7 => (State::Window(self.window()?), 3),
            8 => {
                let texture = self.texture(number)?;
                (State::Texture(texture), 3 + texture.words())
            }
            9 => {
                let palette = self.palette(number)?;
                (State::Palette(palette), 2 + u32::from(palette.count))
            }
            10 => {
                let overlay = self.overlay()?;
                (State::Overlay(overlay), 4 + overlay.words())
            }
            11 => (State::Bounds(self.bounds()?), 7),
            12 if number == 0 => return Err(Reason::Count(self.header.count)),
            12 => (State::PointSize(number), 1),
            13 => (State::Cone(self.cone()?), 7),
            kind => return Err(Reason::Kind(kind)),
        };
        Ok(Parsed {
            instruction: Instruction::State(state),
            words: self.length(words - 1)?,
        })
    }

    fn head(&self) -> Result<Head, Reason> {
        self.length(4)?;
        if self.word(1) != Head::MAGIC {
            return self.bad(1);
        }
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
        if (-128..=96).contains(&value) {
            Ok(value)
        } else {
            self.bad(n)
        }
    }

    fn mantissas<const N: usize>(&self, first: u32) -> Result<[i32; N], Reason> {
        let mut mantissa = [0; N];
        for (n, m) in (first..).zip(&mut mantissa) {
            *m = self.signed(n);
            if m.unsigned_abs() >> 30 != 0 {
                return self.bad(n);
            }
        }
        Ok(mantissa)
    }

    fn matrix(&self) -> Result<Matrix, Reason> {
        self.length(13)?;
        let exponents = self.word(10);
        Ok(Matrix {
            linear: self.mantissas(1)?,
            linear_exponent: self.exponent(10, exponents as i16)?,
            offset: self.mantissas(11)?,
            offset_exponent: self.exponent(10, (exponents >> 16) as i16)?,
        })
    }

    fn light(&self) -> Result<LightWords, Reason> {
        self.length(3)?;
        let (xy, za) = (self.word(1), self.word(2));
        let [r, g, b, none] = self.word(3).to_le_bytes();
        if none != 0 {
            return self.bad(3);
        }
        let ambient = (za >> 16) as u16;
        if ambient > 1 << 15 {
            return self.bad(2);
        }
        Ok(LightWords {
            direction: [xy as i16, (xy >> 16) as i16, za as i16],
            ambient,
            colour: [r, g, b],
        })
    }

    fn material(&self) -> Result<Material, Reason> {
        self.length(3)?;
        let [r, g, b, opacity] = self.word(1).to_le_bytes();
        let [sr, sg, sb, exponent] = self.word(2).to_le_bytes();
        let flags = self.word(3);
        let textured = flags & 4 != 0;
        if flags & !0xFF07 != 0 || (!textured && flags & 0xFF00 != 0) {
            return self.bad(3);
        }
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
        self.length(12)?;
        let float = |n| f32::from_bits(self.word(n));
        for n in 1..=12 {
            if !float(n).is_finite() {
                return self.bad(n);
            }
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
        self.length(2)?;
        let (from, to) = (self.word(1), self.word(2));
        let window = Window {
            left: from as u16,
            top: (from >> 16) as u16,
            right: to as u16,
            bottom: (to >> 16) as u16,
        };
        if window.left >= window.right || window.top >= window.bottom {
            return self.bad(2);
        }
        Ok(window)
    }

    fn form(&self, n: u32, code: u32) -> Result<TexelForm, Reason> {
        match TexelForm::ALL.get(code as usize) {
            Some(form) => Ok(*form),
            None => self.bad(n),
        }
    }

    fn texture(&self, number: u8) -> Result<Texture, Reason> {
        self.length(2)?;
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
        if texture.log_width > 10 || texture.log_height > 10 || word & 0xFE00_C000 != 0 {
            return self.bad(1);
        }
        if self.word(2) != texture.words() {
            return self.bad(2);
        }
        Ok(texture)
    }

    fn palette(&self, number: u8) -> Result<Palette, Reason> {
        self.length(1)?;
        match self.word(1) {
            count @ 1..=256 => Ok(Palette {
                number,
                count: count as u16,
                at: self.at.wrapping_add(2),
            }),
            _ => self.bad(1),
        }
    }

    fn overlay(&self) -> Result<Overlay, Reason> {
        self.length(3)?;
        let (place, size, word) = (self.word(1), self.word(2), self.word(3));
        let overlay = Overlay {
            left: place as u16,
            top: (place >> 16) as u16,
            width: size as u16,
            height: (size >> 16) as u16,
            form: self.form(3, word & 15)?,
            additive: word >> 4 & 1 != 0,
            palette: (word >> 8) as u8,
            at: self.at.wrapping_add(4),
        };
        let sides = 1..=1024;
        if !sides.contains(&overlay.width) || !sides.contains(&overlay.height) {
            return self.bad(2);
        }
        if word & !0xFF1F != 0 {
            return self.bad(3);
        }
        Ok(overlay)
    }

    fn bounds(&self) -> Result<Bounds, Reason> {
        self.length(6)?;
        let [x, y, z, radius] = self.mantissas(1)?;
        if radius < 0 {
            return self.bad(4);
        }
        let exponent = match i16::try_from(self.signed(5)) {
            Ok(exponent) => self.exponent(5, exponent)?,
            Err(_) => return self.bad(5),
        };
        Ok(Bounds {
            centre: [x, y, z],
            radius,
            exponent,
            words: self.word(6),
        })
    }

    fn cone(&self) -> Result<Cone, Reason> {
        self.length(6)?;
        let halves = |n: u32| [self.word(n) as u16, (self.word(n) >> 16) as u16];
        let ([x, y], [z, spread]) = (halves(4), halves(5));
        Ok(Cone {
            apex: [self.signed(1), self.signed(2), self.signed(3)],
            axis: [x as i16, y as i16, z as i16],
            spread,
            words: self.word(6),
        })
    }
}
