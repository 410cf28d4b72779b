//! Frames whose lines cost no more than they may, beside the same with time enough.

use crate::{Picture, ROOM, crc, picture_of, said};
use host_support::rooms::{LineRooms, SceneRooms};
use scanbeam::Scene;
use scanbeam::frame::{Pace, Paid};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scenes::{Frame, OBJECTS, Paced, Shot, SmoothLook, TexturedLook};
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

    /// Pictures of the renderer that takes its time, and of the one that is paced.
    ///
    /// # Errors
    /// When they have another size than a shot.
    pub fn pictures(&self) -> Result<[Picture; 2], Box<dyn Error>> {
        Ok([picture_of(&self.unpaced)?, picture_of(&self.words)?])
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

/// What each line of a frame is reckoned to cost, one after the other from the top, where it may cost what it likes.
///
/// # Errors
/// When it does not fit the memory that it asks for, or is none of [`unhurried`](scenes::unhurried).
pub fn reckoned_lines(frame: Frame, costs: Pace) -> Result<Vec<u32>, Box<dyn Error>> {
    if frame.is_textured() {
        reckoned::<TexturedLook>(frame, costs)
    } else {
        reckoned::<SmoothLook>(frame, costs)
    }
}

/// Draws such a frame into a scene.
fn build<L: Look>(frame: Frame, scene: &mut Scene<'_, '_, L>) -> Result<(), String> {
    match frame {
        Frame::Suite(suite) => said(suite.name(), suite.build(scene)),
        Frame::Paced(paced) => said(paced.name, paced.build(scene)),
        Frame::Shot(how) => said(how.name, how.shot.build_shaded(how.shading, scene)),
        Frame::B(how) => said(how.name, how.build(scene)),
        _ => Err("this frame is not paced".into()),
    }
}

fn reckoned<L: Look<Pixel = Rgb565Be>>(
    frame: Frame,
    costs: Pace,
) -> Result<Vec<u32>, Box<dyn Error>> {
    let screen = Shot::screen();
    let mut memory = SceneRooms::new(ROOM, screen.height());
    let mut scene = memory.scene::<L>(screen);
    build(frame, &mut scene)?;
    let mut lines: LineRooms<L> = LineRooms::new(OBJECTS, screen.width());
    let mut renderer = lines.renderer().paced(Pace {
        most: u32::MAX,
        ..costs
    });
    let mut line = vec![0; screen.width().into()];
    let mut reckoned = Vec::new();
    // From the last one up: what was paid begins anew with each.
    for y in scene.lines().rev() {
        renderer.draw_line(&scene, y, &mut line, 0)?;
        reckoned.push(renderer.paid().dearest);
    }
    reckoned.reverse();
    Ok(reckoned)
}
