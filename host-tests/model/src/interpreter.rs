//! The pipeline behind stage one: a token a clock, both units' DMA a word a clock (K8-K14).

use super::buffers::{LineBuffers, Word40};
use super::format::round_to_8;
use super::layout::TokenBits;
use super::stage::{CompositingUnit, ZUnit};
use super::token::{Argb10, Target, Token, TokenError};

/// What comes out at the bottom.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Output {
    /// A pixel that the compositing unit has scanned out.
    Pixel {
        /// Pixel of the segment.
        x: u16,
        /// Alpha, red, green and blue in 8 bits.
        argb: [u8; 4],
    },
    /// 40 bits of a jam token; the Z unit scans out as such tokens.
    Data(u64),
}

/// What the pipeline has done since it was built.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PipeCounts {
    /// Clocks: one a token, and those it waited.
    pub clocks: u64,
    /// Clocks that a wait, a swap or a start waited for a running DMA.
    pub stalls: u64,
    /// Pixel interpolation tokens.
    pub pixels: u64,
    /// Pixel interpolation tokens that became null tokens.
    pub hidden: u64,
}

/// Stages two and three, driven by tokens.
#[derive(Debug)]
pub struct Pipe<'m> {
    /// Stage two.
    pub z: ZUnit<'m>,
    /// Stage three.
    pub rgb: CompositingUnit<'m>,
    counts: PipeCounts,
}

/// The memory of the pipeline: two scanlines of each unit, lent by the application.
///
/// As many words as a segment has pixels, 2,047 at most. The hardware has 648.
#[derive(Debug)]
pub struct PipeMemory<'m> {
    /// Depth.
    pub z: [&'m mut [Word40]; 2],
    /// Colour.
    pub rgb: [&'m mut [Word40]; 2],
}

impl<'m> Pipe<'m> {
    /// A pipeline at rest. What is in its memory stays there until tokens clear it.
    #[must_use]
    pub fn new(memory: PipeMemory<'m>) -> Self {
        Self {
            z: ZUnit::new(LineBuffers::new(memory.z)),
            rgb: CompositingUnit::new(LineBuffers::new(memory.rgb)),
            counts: PipeCounts::default(),
        }
    }

    /// What has been done so far.
    #[must_use]
    pub fn counts(&self) -> PipeCounts {
        self.counts
    }

    /// Pixels of a scanline: what both units have room for.
    #[must_use]
    pub fn width(&self) -> usize {
        self.z.buffers.len().min(self.rgb.buffers.len())
    }

    /// Takes a token from the wires.
    ///
    /// # Errors
    /// When the bits are no token; then nothing happens.
    pub fn bits(
        &mut self,
        bits: TokenBits,
        out: &mut impl FnMut(Output),
    ) -> Result<(), TokenError> {
        self.token(Token::decode(bits)?, out);
        Ok(())
    }

    /// Takes a token; what leaves the pipeline meanwhile goes to `out`.
    pub fn token(&mut self, token: Token, out: &mut impl FnMut(Output)) {
        self.clock(out);
        match token {
            Token::Null | Token::NormalSetup(_) | Token::ParameterSetup(..) => {}
            Token::Pixel(pixel) => {
                self.counts.pixels += 1;
                match self.z.pixel(pixel) {
                    Some(pixel) => self.rgb.pixel(pixel),
                    None => self.counts.hidden += 1,
                }
            }
            Token::Overlay(pixel) => self.rgb.pixel(pixel),
            Token::ZSetup(set_up) => self.z.z = set_up,
            Token::DiffuseSetup(set_up) => self.z.diffuse = set_up,
            Token::SpecularSetup(set_up) => self.z.specular = set_up,
            Token::LoadWriteRegister(target, value) => {
                self.each(target, |buffers| buffers.load_write_register(value));
            }
            Token::StartDma(set_up) => {
                self.wait(set_up.target, out);
                self.each(set_up.target, |buffers| buffers.start(set_up));
            }
            Token::WaitDma(target) => self.wait(target, out),
            Token::Swap(target) => {
                self.wait(target, out);
                self.each(target, LineBuffers::swap);
            }
            Token::GlobalMode(mode) => {
                self.z.mode = mode;
                self.rgb.mode = mode;
            }
            Token::Jam(data) => out(Output::Data(data)),
        }
    }

    fn each(&mut self, target: Target, mut f: impl FnMut(&mut LineBuffers<'m>)) {
        if target.z {
            f(&mut self.z.buffers);
        }
        if target.rgb {
            f(&mut self.rgb.buffers);
        }
    }

    /// Stalls until the DMA of the units is over; it ends by itself.
    fn wait(&mut self, target: Target, out: &mut impl FnMut(Output)) {
        while (target.z && self.z.buffers.is_busy()) || (target.rgb && self.rgb.buffers.is_busy()) {
            self.counts.stalls += 1;
            self.clock(out);
        }
    }

    /// One clock of both DMAs.
    #[inline]
    fn clock(&mut self, out: &mut impl FnMut(Output)) {
        self.counts.clocks += 1;
        if let Some(read) = self.z.buffers.clock() {
            out(Output::Data(read.word));
        }
        if let Some(read) = self.rgb.buffers.clock() {
            let Argb10 { a, r, g, b } = Argb10::from_word(read.word);
            let argb = [a, r, g, b].map(|level| {
                if read.round {
                    round_to_8(level)
                } else {
                    (level >> 2) as u8
                }
            });
            out(Output::Pixel { x: read.x, argb });
        }
    }
}
