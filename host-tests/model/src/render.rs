//! Whole scenes through the model: a scene's triangles into tokens, tokens into pixels.
//!
//! The conductor. It takes the triangles as pass one has filed them, corners and all,
//! hands each one that a line meets to stage one as the words of a draw command, and lets the
//! pipeline have the tokens. No plane, no edge and no walker of the fast path is used, so the
//! two can be held against each other: the same pixels are covered (K4), colours and depths are
//! as exact as 12 and 10 bits of weight make them (M1).
//!
//! A line that is wider than the buffers is drawn in segments. Every line starts from the
//! scene, so any line can be drawn alone (K5).

use super::buffers::WORD;
use super::format::InputFormat;
use super::interpreter::{Output, Pipe, PipeCounts, PipeMemory};
use super::token::{Argb10, GlobalMode, StartDma, Target, Token};
use super::vertex::{FormatWord, PLACE, ParameterRam, VertexFormat};
use super::walker::{Segment, ZFlags, draw};
use core::fmt;
use scanbeam::Scene;
use scanbeam::look::Gouraud;
use scanbeam::pixel::{MadeOf, PixelFormat};
use scanbeam::scan_out::{self, LineBuf, Pump, ScanError, ScanoutDma, Window};
use scanbeam::scene::{FiledCorner, FiledTriangle};

/// Pixels of a segment, at most: what the 11 bits of a DMA's length count.
pub const SEGMENT: usize = 2047;

/// The vertex of a scene: place, depth, and alpha, red, green and blue.
pub const SCENE_VERTEX: [FormatWord; 4] = [
    FormatWord::count(3),
    FormatWord::parameter(PLACE, InputFormat::U16x2),
    FormatWord::parameter(1, InputFormat::U32x1),
    FormatWord::parameter(2, InputFormat::U8x4),
];

/// Columns and lines of the device's space before a picture's first: no corner of a scene lies
/// farther out.
const ORIGIN: i32 = 3072;

/// Why the model does not draw a line.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelError {
    /// The pixels are not those of a line.
    Pixels {
        /// Pixels of a line.
        needed: usize,
        /// How many there are.
        have: usize,
    },
    /// The line is not of the scene.
    Line {
        /// The line.
        line: u16,
    },
    /// The pipeline was lent no memory.
    Memory,
    /// A draw call has more than the colours of its corners, and the model has no stage for it.
    Call {
        /// The number of its [state](Scene::draw_state).
        call: u16,
    },
    /// Pixels are numbers of a palette, which have no levels.
    Indices,
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::Pixels { needed, have } => {
                write!(f, "model: a line of {needed} pixels was lent {have}")
            }
            Self::Line { line } => write!(f, "model: line {line} is not part of the scene"),
            Self::Memory => f.write_str("model: a line buffer of no pixels was lent"),
            Self::Call { call } => write!(
                f,
                "model: draw call {call} has a texture, blend, scissor, dither, shadow, priority or depth test"
            ),
            Self::Indices => f.write_str("model: pixels of a palette have no levels"),
        }
    }
}

impl core::error::Error for ModelError {}

/// Draws lines of scenes with the model.
#[derive(Debug)]
pub struct ModelRenderer<'m> {
    pipe: Pipe<'m>,
    ram: ParameterRam,
    format: VertexFormat,
    /// The write register's colour, once both buffers are filled with it.
    cleared: Option<u64>,
    has_depth: bool,
}

impl<'m> ModelRenderer<'m> {
    /// A renderer over two scanlines of each unit. The shortest of them says how wide a segment
    /// is.
    #[must_use]
    pub fn new(memory: PipeMemory<'m>) -> Self {
        Self {
            pipe: Pipe::new(memory),
            ram: ParameterRam::new(),
            format: VertexFormat::SCENE,
            cleared: None,
            has_depth: true,
        }
    }

    /// Whether depths are compared, as they are at first; if not, what is drawn last is seen. What the scene has switched
    /// off is not asked.
    pub fn set_depth(&mut self, has_depth: bool) {
        self.has_depth = has_depth;
    }

    /// Pixels of a segment.
    #[must_use]
    pub fn segment(&self) -> usize {
        self.pipe.width().min(SEGMENT)
    }

    /// What the pipeline has done since it was built.
    #[must_use]
    pub fn counts(&self) -> PipeCounts {
        self.pipe.counts()
    }

    /// Draws a line of the picture over `background` into `pixels`.
    ///
    /// # Errors
    /// When there is no memory, the pixels are not a line, the line is not of the scene, or the
    /// scene has what the model does not draw.
    pub fn draw_line<F: PixelFormat>(
        &mut self,
        scene: &Scene<'_, '_, Gouraud<F>>,
        line: u16,
        background: F::Word,
        pixels: &mut [F::Word],
    ) -> Result<(), ModelError> {
        self.trace_line(scene, line, background, pixels, &mut |_| ())
    }

    /// As [`draw_line`](Self::draw_line), and every token is shown to `trace` before it goes
    /// down the pipeline.
    ///
    /// # Errors
    /// As [`draw_line`](Self::draw_line).
    pub fn trace_line<F: PixelFormat>(
        &mut self,
        scene: &Scene<'_, '_, Gouraud<F>>,
        line: u16,
        background: F::Word,
        pixels: &mut [F::Word],
        trace: &mut impl FnMut(&Token),
    ) -> Result<(), ModelError> {
        self.check(scene, line, pixels.len())?;
        let segment = self.segment();
        let clear = Argb10::from_rgb8(F::to_rgb8(background)).to_word();
        for (i, pixels) in pixels.chunks_mut(segment).enumerate() {
            let part = Segment {
                column: ORIGIN + (i * segment) as i32,
                width: pixels.len() as u16,
                y: (8 * (ORIGIN + i32::from(line)) + 4) as u16,
            };
            let filled = self.cleared == Some(clear);
            let pipe = &mut self.pipe;
            let mut out = |output: Output| {
                if let Output::Pixel {
                    x,
                    argb: [_, rgb @ ..],
                } = output
                {
                    if let Some(pixel) = pixels.get_mut(usize::from(x)) {
                        *pixel = F::from_rgb8(rgb);
                    }
                }
            };
            let mut emit = |token: Token| {
                trace(&token);
                pipe.token(token, &mut out);
            };
            begin(self.has_depth, &mut emit);
            if !filled {
                fill(clear, segment as u16, &mut emit);
            }
            let on_line = |t: &FiledTriangle| t.lines().contains(&i32::from(line));
            for triangle in scene.triangles().filter(on_line) {
                draw_triangle(&triangle, &mut self.ram, &self.format, part, &mut emit);
            }
            finish(part.width, &mut emit);
            // Both buffers are clear again: of this one no more than the part was drawn, and that
            // is cleared behind what is sent.
            self.cleared = Some(clear);
        }
        Ok(())
    }

    /// Whether a line of the scene can be drawn into so many pixels.
    fn check<F: PixelFormat>(
        &self,
        scene: &Scene<'_, '_, Gouraud<F>>,
        line: u16,
        have: usize,
    ) -> Result<(), ModelError> {
        let needed = usize::from(scene.screen().width());
        let mut calls = (0..).map_while(|call| Some((call, scene.draw_state(call)?)));
        if have != needed {
            Err(ModelError::Pixels { needed, have })
        } else if !scene.lines().contains(&line) {
            Err(ModelError::Line { line })
        } else if self.segment() == 0 {
            Err(ModelError::Memory)
        } else if F::MADE_OF == MadeOf::Index {
            Err(ModelError::Indices)
        } else if let Some((call, _)) = calls.find(|(_, state)| !state.is_colours_alone()) {
            Err(ModelError::Call { call })
        } else {
            Ok(())
        }
    }
}

/// The mode: without depth every pixel counts as visible.
fn begin(has_depth: bool, emit: &mut impl FnMut(Token)) {
    emit(Token::GlobalMode(GlobalMode {
        diffuse_shade: true,
        force_z_visible: !has_depth,
        ..GlobalMode::default()
    }));
}

/// Fills both buffers of both units: the farthest depth, and a colour.
fn fill(colour: u64, length: u16, emit: &mut impl FnMut(Token)) {
    emit(Token::LoadWriteRegister(Target::Z, WORD & !0xFF));
    emit(Token::LoadWriteRegister(Target::RGB, colour));
    let start = Token::StartDma(StartDma {
        target: Target::BOTH,
        length,
        write_enable: true,
        ..StartDma::default()
    });
    for token in [
        start,
        Token::WaitDma(Target::BOTH),
        Token::Swap(Target::BOTH),
        start,
    ] {
        emit(token);
    }
}

/// The tokens of a triangle on the segment.
fn draw_triangle(
    triangle: &FiledTriangle,
    ram: &mut ParameterRam,
    format: &VertexFormat,
    segment: Segment,
    emit: &mut impl FnMut(Token),
) {
    for (v, corner) in (0..).zip(&triangle.corners) {
        // The format has as many words as these arrays, so this does not fail.
        let _ = ram.load(0, v, format, &words(corner));
    }
    let flags = ZFlags::default();
    draw(ram, format, (0, [0, 1, 2]), segment, flags, emit);
}

/// The words of a corner, as [`SCENE_VERTEX`] describes them.
fn words(corner: &FiledCorner) -> [u32; 3] {
    let place = |at: i16| (i32::from(at) + 8 * ORIGIN) as u16;
    let levels = corner.colour.iter();
    let argb = levels.fold(0xFF, |word, &level| word << 8 | u32::from(level));
    let (x, y) = (place(corner.x), place(corner.y));
    // Scenes keep 1/w, where more is nearer; tokens keep what is nearer below.
    [u32::from(x) << 16 | u32::from(y), !corner.depth, argb]
}

/// Sends the line and clears it behind (K12).
fn finish(width: u16, emit: &mut impl FnMut(Token)) {
    let start = |target, scanout_enable| {
        Token::StartDma(StartDma {
            target,
            start: 0,
            length: width,
            scanout_enable,
            round: scanout_enable,
            write_enable: true,
        })
    };
    for token in [
        Token::WaitDma(Target::BOTH),
        Token::Swap(Target::BOTH),
        start(Target::Z, false),
        start(Target::RGB, true),
        Token::WaitDma(Target::BOTH),
    ] {
        emit(token);
    }
}

/// Why a frame of the model was not finished.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum ModelFrameError<E> {
    /// The sink failed.
    ScanOut(ScanError<E>),
    /// A line could not be drawn.
    Line(ModelError),
}

impl<E: scan_out::Error> fmt::Display for ModelFrameError<E> {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::ScanOut(error) => error.fmt(f),
            Self::Line(error) => error.fmt(f),
        }
    }
}

impl<E: scan_out::Error> core::error::Error for ModelFrameError<E> {}

/// Draws all lines of `scene` with the model and sends them through `pump`, as
/// [`draw_frame`](scanbeam::draw_frame) does with the fast path.
///
/// # Errors
/// When the sink fails, naming the line, or there is too little memory.
pub fn draw_model_frame<F, D>(
    scene: &Scene<'_, '_, Gouraud<F>>,
    renderer: &mut ModelRenderer<'_>,
    pump: &mut Pump<D>,
    background: F::Word,
    lines_per_transfer: u16,
) -> Result<(), ModelFrameError<D::Error>>
where
    F: PixelFormat,
    D: ScanoutDma<Buf: LineBuf<Word = F::Word>>,
{
    let lines = scene.lines();
    let window = Window {
        x: 0,
        y: lines.start,
        width: scene.screen().width(),
        height: lines.len() as u16,
    };
    pump.take_stats();
    pump.begin(window, lines_per_transfer)
        .map_err(ModelFrameError::ScanOut)?;
    for line in lines {
        let pixels = pump.line().map_err(ModelFrameError::ScanOut)?;
        renderer
            .draw_line(scene, line, background, pixels)
            .map_err(ModelFrameError::Line)?;
        pump.line_done().map_err(ModelFrameError::ScanOut)?;
    }
    pump.finish().map_err(ModelFrameError::ScanOut)
}
