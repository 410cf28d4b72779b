//! What each board should have sent: the commands that light an ILI9341, and the host's own frames.

use super::panel::{HEIGHT, WIDTH};
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::{DrawState, Memory, Object, Scene, Vertex};
use scanbeam::{Link, Screen};
use spinner::{BACKGROUND, OBJECTS, VERTICES, build};
use std::error::Error;

/// Reset, sleep out, 16 bits a pixel, landscape with blue first, display on: what the panel's data
/// sheet asks for, and not what the examples say.
const SET_UP: [&[u8]; 5] = [&[0x01], &[0x11], &[0x3A, 0x55], &[0x36, 0x28], &[0x29]];
/// The whole picture: columns, lines, pixels.
const FRAME: [&[u8]; 3] = [&[0x2A, 0, 0, 1, 0x3F], &[0x2B, 0, 0, 0, 0xEF], &[0x2C]];

/// In this machine's order, whatever the examples choose: it is put on the wire here.
type Look = Gouraud<Rgb565>;

/// What a run of some frames sends.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct Expected {
    /// Checksums of the frames' bytes on the wire.
    pub frames: Vec<u32>,
    /// Commands with their data; a run ends when one more frame begins.
    pub commands: Vec<Vec<u8>>,
}

impl Expected {
    /// For frames with these checksums.
    pub fn of(frames: Vec<u32>) -> Self {
        let opened = frames.len() + 1;
        let each = std::iter::repeat_n(FRAME, opened).flatten();
        let commands = SET_UP.into_iter().chain(each).map(<[u8]>::to_vec).collect();
        Self { frames, commands }
    }

    /// The same frames, for a panel that is fed from memory and gets no commands.
    pub fn without_commands(&self) -> Self {
        Self {
            frames: self.frames.clone(),
            commands: Vec::new(),
        }
    }

    /// Draws the frames here.
    ///
    /// # Errors
    /// When the memory that is lent does not hold the teapot.
    pub fn drawn(count: u16) -> Result<Self, Box<dyn Error>> {
        let screen = Screen::new(WIDTH, HEIGHT).map_err(|error| format!("{error:?}"))?;
        let mut vertices = vec![Vertex::EMPTY; VERTICES];
        let mut objects = vec![Object::EMPTY; OBJECTS];
        let (mut bins, mut draws) = ([0; HEIGHT as usize], [DrawState::EMPTY]);
        let memory = Memory {
            vertices: &mut vertices,
            places: &mut [],
            objects: &mut objects,
            bins: &mut bins,
            draws: &mut draws,
        };
        let mut scene = Scene::<Look>::new(screen, memory);
        let mut cache = Box::new(FastMemory::<Look>::new());
        let (mut links, mut depth) = (vec![Link::NONE; OBJECTS], [0; WIDTH as usize]);
        let mut renderer = Renderer::new(LineMemory {
            cache: &mut cache,
            links: &mut links,
            depth: &mut depth,
        });
        let mut pixels = [0; WIDTH as usize];
        let mut frames = Vec::new();
        for turn in 0..count {
            build(&mut scene, turn);
            renderer.restart();
            let mut sum = crc32fast::Hasher::new();
            for line in 0..HEIGHT {
                let background = Rgb565::from_rgb8(BACKGROUND);
                renderer.draw_line(&scene, line, &mut pixels, background)?;
                pixels
                    .iter()
                    .for_each(|pixel| sum.update(&pixel.to_be_bytes()));
            }
            frames.push(sum.finalize());
        }
        Ok(Self::of(frames))
    }
}
