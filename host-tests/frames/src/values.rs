//! The small frames of what few draw calls have, as this machine draws them.

use host_support::image_out::Frame;
use host_support::mock::HostLine;
use scanbeam::Link;
use scanbeam::frame::FastMemory;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma, Window};
use scanbeam::scene::{Object, TexturePlace, Vertex};
use scenes::{
    VALUES, VALUES_HEIGHT, VALUES_ROOM, VALUES_SHOWN, VALUES_WIDTH, Values, ValuesMemory,
};
use std::convert::Infallible;
use std::error::Error;
use std::task::Poll;

/// What a display was sent, and what it shows.
#[derive(Debug)]
pub struct Sent {
    /// All words, in the order in which they came.
    pub words: Vec<u16>,
    /// The display's words; 0 where nothing came.
    pub shown: Vec<u16>,
    /// Its words a line.
    width: usize,
    /// Where the next word goes: columns and lines that are open, and how many of their words have come.
    open: (Window, usize),
    line: Option<HostLine<u16>>,
}

impl Sent {
    fn new((width, height): (u16, u16)) -> Self {
        let nothing = Window {
            x: 0,
            y: 0,
            width: 0,
            height: 0,
        };
        Self {
            words: Vec::new(),
            shown: vec![0; usize::from(width) * usize::from(height)],
            width: width.into(),
            open: (nothing, 0),
            line: None,
        }
    }
}

impl ScanoutDma for Sent {
    type Error = Infallible;
    type Buf = HostLine<u16>;

    fn begin(&mut self, window: Window) -> Result<(), Infallible> {
        self.open = (window, 0);
        Ok(())
    }

    fn start(&mut self, mut line: Self::Buf, len: usize) -> Result<(), (Infallible, Self::Buf)> {
        let (window, come) = &mut self.open;
        for &word in &line.pixels()[..len] {
            let (x, y) = (
                *come % usize::from(window.width),
                *come / usize::from(window.width),
            );
            let (x, y) = (x + usize::from(window.x), y + usize::from(window.y));
            self.shown[y * self.width + x] = word;
            self.words.push(word);
            *come += 1;
        }
        self.line = Some(line);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, Infallible>> {
        Poll::Ready(Ok(self.line.take()))
    }

    fn end(&mut self) -> Result<(), Infallible> {
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
    let mut pump = Pump::new(Sent::new(values.size()), [buffer(), buffer()]);
    let drawn = values.draw(lent, &mut pump);
    drawn.map_err(|error| format!("{values:?}: {error:?}"))?;
    Ok(pump.release().0)
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
