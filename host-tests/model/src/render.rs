//! Whole scenes through the model: a scene's objects into tokens, tokens into pixels.
//!
//! The conductor. It takes the objects as they lie in the scene, corners and all,
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
use scanbeam::mesh::Colour;
use scanbeam::pipeline::{
    Filed, Flat, Gouraud, LineDepth, Pipeline, RendererError, Scale, Scene, Shading, WordOf,
};
use scanbeam::pixel::PixelFormat;
use scanbeam::scan_out::{LineBuf, Pump, ScanError, ScanoutDma, Window};

/// Pixels of a segment, at most: what the 11 bits of a DMA's length count.
pub const SEGMENT: usize = 2047;

/// The vertex of a scene: place, depth, and alpha, red, green and blue.
pub const SCENE_VERTEX: [FormatWord; 4] = [
    FormatWord::count(3),
    FormatWord::parameter(PLACE, InputFormat::U16x2),
    FormatWord::parameter(1, InputFormat::U32x1),
    FormatWord::parameter(2, InputFormat::U8x4),
];

/// A shading whose corners have a colour each.
pub trait CornerColours: Shading {
    /// The colours of an object's corners from what is kept of them and of the face.
    fn colours(corners: [Self::Vertex; 3], face: Self::Face) -> [Colour; 3];
}

impl CornerColours for Gouraud {
    fn colours(corners: [Colour; 3], (): ()) -> [Colour; 3] {
        corners
    }
}

impl CornerColours for Flat {
    fn colours(_: [(); 3], face: Colour) -> [Colour; 3] {
        [face; 3]
    }
}

/// Draws lines of scenes with the model.
#[derive(Debug)]
pub struct ModelRenderer<'m> {
    pipe: Pipe<'m>,
    ram: ParameterRam,
    format: VertexFormat,
    /// The write register's colour, once both buffers are filled with it.
    cleared: Option<u64>,
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
        }
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
    /// When there is no memory, the pixels are not a line, or the line is not of the scene.
    pub fn draw_line<P>(
        &mut self,
        scene: &Scene<'_, P>,
        line: u16,
        background: WordOf<P>,
        pixels: &mut [WordOf<P>],
    ) -> Result<(), RendererError>
    where
        P: Pipeline<Shading: CornerColours>,
    {
        self.trace_line(scene, line, background, pixels, &mut |_| ())
    }

    /// As [`draw_line`](Self::draw_line), and every token is shown to `trace` before it goes
    /// down the pipeline.
    ///
    /// # Errors
    /// As [`draw_line`](Self::draw_line).
    pub fn trace_line<P>(
        &mut self,
        scene: &Scene<'_, P>,
        line: u16,
        background: WordOf<P>,
        pixels: &mut [WordOf<P>],
        trace: &mut impl FnMut(&Token),
    ) -> Result<(), RendererError>
    where
        P: Pipeline<Shading: CornerColours>,
    {
        let screen = scene.screen();
        let needed = usize::from(screen.width());
        if pixels.len() != needed {
            let have = pixels.len();
            return Err(RendererError::Pixels { needed, have });
        }
        if !scene.lines().contains(&line) {
            return Err(RendererError::Line { line });
        }
        let segment = self.segment();
        if segment == 0 {
            return Err(RendererError::Depth { needed: 1, have: 0 });
        }
        let clear = Argb10::from_rgb8(P::Pixel::to_rgb8(background)).to_word();
        let y = 8 * (screen.top() + i32::from(line)) + 4;
        for (i, pixels) in pixels.chunks_mut(segment).enumerate() {
            let part = Segment {
                column: screen.left() + (i * segment) as i32,
                width: pixels.len() as u16,
                y: y as u16,
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
                        *pixel = P::Pixel::from_rgb8(rgb);
                    }
                }
            };
            let mut emit = |token: Token| {
                trace(&token);
                pipe.token(token, &mut out);
            };
            begin::<P>(&mut emit);
            if !filled {
                fill(clear, segment as u16, &mut emit);
            }
            objects(scene, &mut self.ram, &self.format, part, &mut emit);
            finish(part.width, &mut emit);
            // Both buffers are clear again: of this one no more than the part was drawn, and that
            // is cleared behind what is sent.
            self.cleared = Some(clear);
        }
        Ok(())
    }
}

/// The mode of a pipeline `P`: without depth every pixel counts as visible.
fn begin<P: Pipeline>(emit: &mut impl FnMut(Token)) {
    emit(Token::GlobalMode(GlobalMode {
        diffuse_shade: true,
        force_z_visible: !P::Depth::TESTS,
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

/// The tokens of every object on the segment, in order of submission.
fn objects<P>(
    scene: &Scene<'_, P>,
    ram: &mut ParameterRam,
    format: &VertexFormat,
    segment: Segment,
    emit: &mut impl FnMut(Token),
) where
    P: Pipeline<Shading: CornerColours>,
{
    let scale = Scale::new(P::Pixel::STEPS);
    for index in 0..scene.pass_one().objects {
        let Some(filed) = scene.filed(index as u16) else {
            break;
        };
        let y = filed.places.map(|(_, y)| y);
        let above = y.iter().all(|y| *y < segment.y);
        let below = y.iter().all(|y| *y >= segment.y);
        if above || below {
            continue;
        }
        for (v, words) in (0..).zip(words::<P::Shading>(&filed, &scale)) {
            // The format has as many words as these arrays, so this does not fail.
            let _ = ram.load(0, v, format, &words);
        }
        draw(
            ram,
            format,
            (0, [0, 1, 2]),
            segment,
            ZFlags::default(),
            emit,
        );
    }
}

/// The words of an object's corners, as [`SCENE_VERTEX`] describes them.
fn words<S: CornerColours>(filed: &Filed<S::Vertex, S::Face>, scale: &Scale) -> [[u32; 3]; 3] {
    let colours = S::colours(filed.attributes, filed.face);
    [0, 1, 2].map(|i| {
        let (x, y) = filed.places[i];
        let argb = colours[i]
            .to_rgb8(scale)
            .iter()
            .fold(0xFF, |word, &level| word << 8 | u32::from(level));
        // Scenes keep 1/w, where more is nearer; tokens keep what is nearer below.
        [u32::from(x) << 16 | u32::from(y), !filed.depths[i], argb]
    })
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
    Renderer(RendererError),
}

/// Draws all lines of `scene` with the model and sends them through `pump`, as
/// [`draw_frame`](scanbeam::pipeline::draw_frame) does with the fast path.
///
/// # Errors
/// When the sink fails, naming the line, or there is too little memory.
pub fn draw_model_frame<P, D>(
    scene: &Scene<'_, P>,
    renderer: &mut ModelRenderer<'_>,
    pump: &mut Pump<D>,
    background: WordOf<P>,
    lines_per_transfer: u16,
) -> Result<(), ModelFrameError<D::Error>>
where
    P: Pipeline<Shading: CornerColours>,
    D: ScanoutDma<Buf: LineBuf<Word = WordOf<P>>>,
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
            .map_err(ModelFrameError::Renderer)?;
        pump.line_done().map_err(ModelFrameError::ScanOut)?;
    }
    pump.finish().map_err(ModelFrameError::ScanOut)
}
