//! Frames whose lines cost no more than they may, beside the same with time enough.

use crate::{ROOM, crc, said};
use host_support::rooms::{LineRooms, SceneRooms};
use scanbeam::frame::Paid;
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scenes::{OBJECTS, Paced, Shot, SmoothLook, TexturedLook};
use std::error::Error;

/// A frame that is paced.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct PacedFrame {
    /// Its words in scan-out order, as an SPI panel takes them.
    pub words: Vec<u16>,
    /// Those of a renderer that takes its time.
    pub unpaced: Vec<u16>,
    /// What was paid.
    pub paid: Paid,
}

impl PacedFrame {
    /// The checksum that the firmware has of the same bytes.
    #[must_use]
    pub fn crc(&self) -> u32 {
        crc(&self.words)
    }

    /// How many pixels are not those of a renderer that takes its time.
    #[must_use]
    pub fn differing(&self) -> usize {
        let both = self.words.iter().zip(&self.unpaced);
        both.filter(|(paced, unpaced)| paced != unpaced).count()
    }
}

/// A scene of the suite whose lines cost no more than they may.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn paced_frame(paced: Paced) -> Result<PacedFrame, Box<dyn Error>> {
    if paced.suite.texture().is_some() {
        drawn::<TexturedLook>(paced)
    } else {
        drawn::<SmoothLook>(paced)
    }
}

fn drawn<L: Look<Pixel = Rgb565Be>>(paced: Paced) -> Result<PacedFrame, Box<dyn Error>> {
    let screen = Shot::screen();
    let mut memory = SceneRooms::new(ROOM, screen.height());
    let mut scene = memory.scene::<L>(screen);
    said(paced.name, paced.build(&mut scene))?;
    let background = Rgb565Be::from_rgb8(paced.suite.background());
    let (mut frames, mut paid) = (Vec::new(), Paid::default());
    for is_paced in [true, false] {
        let mut lines: LineRooms<L> = LineRooms::new(OBJECTS, screen.width());
        let mut renderer = lines.renderer();
        if is_paced {
            renderer = renderer.paced(paced.pace);
        }
        let (mut words, mut line) = (Vec::new(), vec![background; screen.width().into()]);
        for y in scene.lines() {
            renderer.draw_line(&scene, y, &mut line, background)?;
            words.extend_from_slice(&line);
        }
        frames.push(words);
        if is_paced {
            paid = renderer.paid();
        }
    }
    let unpaced = frames.pop().unwrap_or_default();
    let words = frames.pop().unwrap_or_default();
    Ok(PacedFrame {
        words,
        unpaced,
        paid,
    })
}
