//! The small frames of what few draw calls have, as this machine draws them.

use host_support::image_out::Frame;
use host_support::mock::HostLine;
use scanbeam::Link;
use scanbeam::frame::FastMemory;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{Blocking, LineWriter, Pump, Window};
use scanbeam::scene::{Object, TexturePlace, Vertex};
use scenes::{
    VALUES, VALUES_HEIGHT, VALUES_ROOM, VALUES_SHOWN, VALUES_WIDTH, Values, ValuesMemory,
};
use std::convert::Infallible;
use std::error::Error;

/// What a display was sent, and what it shows.
#[derive(Debug)]
pub struct Sent {
    /// All words, in the order in which they came.
    pub words: Vec<u16>,
    /// The display's words; 0 where nothing came.
    pub shown: Vec<u16>,
    /// Its words a line.
    width: usize,
}

impl LineWriter for Sent {
    type Error = Infallible;
    type Word = u16;

    fn open(&mut self, _: Window) -> Result<(), Infallible> {
        Ok(())
    }

    fn write(&mut self, lines: Window, words: &[u16]) -> Result<(), Infallible> {
        self.words.extend(words);
        let rows = self.shown.chunks_mut(self.width).skip(lines.y.into());
        for (row, line) in rows.zip(words.chunks(lines.width.into())) {
            row[lines.x.into()..][..line.len()].copy_from_slice(line);
        }
        Ok(())
    }
}

/// What a frame sends with so many slots.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn values_sent(values: Values, slots: u16) -> Result<Sent, Box<dyn Error>> {
    let (mut smooth, mut textured) = (Box::new(FastMemory::new()), Box::new(FastMemory::new()));
    let (mut lit, mut lit_texels) = (Box::new(FastMemory::new()), Box::new(FastMemory::new()));
    let (mut indexed, mut banded) = (Box::new(FastMemory::new()), Box::new(FastMemory::new()));
    smooth.set_limit(slots);
    textured.set_limit(slots);
    lit.set_limit(slots);
    lit_texels.set_limit(slots);
    indexed.set_limit(slots);
    banded.set_limit(slots);
    let lent = ValuesMemory {
        vertices: &mut vec![Vertex::EMPTY; VALUES_ROOM],
        places: &mut vec![TexturePlace::EMPTY; VALUES_ROOM],
        objects: &mut vec![Object::EMPTY; VALUES_ROOM],
        links: &mut vec![Link::NONE; VALUES_ROOM],
        bins: &mut [0; VALUES_HEIGHT as usize],
        depth: &mut [0; VALUES_WIDTH as usize],
        shown: &mut [0; VALUES_SHOWN],
        smooth: &mut smooth,
        textured: &mut textured,
        lit: &mut lit,
        lit_texels: &mut lit_texels,
        indexed: &mut indexed,
        banded: &mut banded,
    };
    // A transfer of 3 lines at most.
    let buffer = || HostLine::new(3 * usize::from(VALUES_WIDTH));
    let (width, height) = values.size();
    let sent = Sent {
        words: Vec::new(),
        shown: vec![0; usize::from(width) * usize::from(height)],
        width: width.into(),
    };
    let mut pump = Pump::new(Blocking::over(sent), [buffer(), buffer()]);
    let drawn = values.draw(lent, &mut pump);
    drawn.map_err(|error| format!("{values:?}: {error:?}"))?;
    Ok(pump.release().0.into_writer())
}

/// What the display shows after each of them, by name.
///
/// # Errors
/// As [`values_sent`].
pub fn values_pictures() -> Result<Vec<(&'static str, Frame)>, Box<dyn Error>> {
    let frames = VALUES.into_iter().map(|(name, values)| {
        let shown = values_sent(values, 64)?.shown;
        let rgb = shown.into_iter().flat_map(Rgb565Be::to_rgb8).collect();
        let (width, height) = values.size();
        let frame = Frame::new(width.into(), height.into(), rgb);
        Ok((name, frame.ok_or("a frame of another size")?))
    });
    frames.collect()
}
