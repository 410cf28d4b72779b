//! Displays that are sent what changed alone: pictures that change, lines out of them, sinks that
//! fail, and what an application does then.

use super::Rng;
use host_tests::mock::{Fault, HostLine, MockError, MockFrameBuffer};
use scanbeam::scan_out::{Pump, ScanError, ScanStats, ScanoutDma, ShownRuns, Window};

pub type Mock = MockFrameBuffer<u16>;
/// Lines from the top.
pub type Picture = Vec<Vec<u16>>;

/// Lines out of a picture; fails at one of them, if told to.
pub struct Lines<'a> {
    pub picture: &'a Picture,
    pub fails_at: Option<u16>,
}

/// Why a picture did not arrive.
#[derive(Debug)]
pub enum Failed {
    Sink(ScanError<MockError>),
    /// The line was not drawn.
    Source,
}

impl From<ScanError<MockError>> for Failed {
    fn from(error: ScanError<MockError>) -> Self {
        Self::Sink(error)
    }
}

impl Lines<'_> {
    /// Sends the runs that changed.
    pub fn send<D>(
        &self,
        pump: &mut Pump<D>,
        band: u16,
        shown: &mut ShownRuns<'_>,
    ) -> Result<ScanStats, Failed>
    where
        D: ScanoutDma<Buf = HostLine<u16>, Error = MockError>,
    {
        let window = Window {
            x: 0,
            y: 0,
            width: self.picture[0].len() as u16,
            height: self.picture.len() as u16,
        };
        pump.take_stats();
        let mut frame = pump.begin_in_runs(window, band, shown)?;
        for (line, pixels) in (0..).zip(self.picture) {
            let out = frame.line()?;
            if self.fails_at == Some(line) {
                return Err(Failed::Source);
            }
            out.copy_from_slice(pixels);
            frame.line_done()?;
        }
        frame.finish()?;
        Ok(pump.stats())
    }
}

pub fn buffers(words: usize) -> [HostLine<u16>; 2] {
    [HostLine::new(words), HostLine::new(words)]
}

/// A pump that gives up on sinks that hang.
pub fn pump<D: ScanoutDma<Buf = HostLine<u16>>>(sink: D, words: usize) -> Pump<D> {
    let mut pump = Pump::new(sink, buffers(words));
    pump.set_max_polls(Some(9));
    pump
}

/// What an application does after a frame that failed: where a buffer was lost it makes new ones,
/// for the same display.
pub fn recovered<D>(pump: Pump<D>, error: &Failed, words: usize) -> Pump<D>
where
    D: ScanoutDma<Buf = HostLine<u16>, Error = MockError>,
{
    match error {
        Failed::Sink(ScanError::BufferLost { .. }) => {
            let (sink, _) = pump.release();
            self::pump(sink, words)
        }
        _ => pump,
    }
}

/// Changes a picture: not at all, everywhere, by scrolling, or at some places.
pub fn change(rng: &mut Rng, picture: &mut Picture) {
    match rng.below(6) {
        0 => {}
        1 => picture
            .iter_mut()
            .for_each(|line| line.fill(rng.below(3) as u16)),
        2 => picture.rotate_left(1),
        _ => {
            for _ in 0..1 + rng.below(5) {
                let line = rng.below(picture.len() as u32) as usize;
                let x = rng.below(picture[line].len() as u32) as usize;
                picture[line][x] ^= 1 << rng.below(16);
            }
        }
    }
}

/// None, for `sound` of them, or one of the faults.
pub fn some_fault(rng: &mut Rng, sound: u32) -> Option<Fault> {
    const FAULTS: [Fault; 6] = [
        Fault::Begin,
        Fault::Start,
        Fault::Poll,
        Fault::Hang,
        Fault::Lose,
        Fault::End,
    ];
    let at = rng.below(sound + FAULTS.len() as u32);
    at.checked_sub(sound).map(|at| FAULTS[at as usize])
}
