//! Frames that end before their last line, and windows that no display has.

use super::{Pump, ScanError, ScanoutDma, Window};
use crate::scan_out::{ErrorKind, ShownRuns, send_doubled};
use core::task::Poll;
use std::{vec, vec::Vec};

type Words = &'static mut [u16];

/// A display of 8 columns that shows what it is sent, transfer by transfer, and fails as it is told.
#[derive(Default)]
struct Panel {
    shown: Vec<u16>,
    window: Option<Window>,
    held: Option<Words>,
    is_overrun: bool,
    started: usize,
    /// Counted from 0.
    fails_at: Option<usize>,
    /// A buffer that it gives back in place of another, once it was sent so many transfers.
    swapped: Option<(usize, Words)>,
}

impl ScanoutDma for Panel {
    type Error = ErrorKind;
    type Buf = Words;

    fn begin(&mut self, window: Window) -> Result<(), ErrorKind> {
        self.window = Some(window);
        Ok(())
    }

    fn start(&mut self, buf: Words, len: usize) -> Result<(), (ErrorKind, Words)> {
        let number = self.started;
        self.started += 1;
        self.is_overrun |= buf.len() < len;
        if self.fails_at == Some(number) || self.is_overrun {
            return Err((ErrorKind::Bus, buf));
        }
        let window = self.window.expect("a rectangle is open");
        for (y, row) in (usize::from(window.y)..).zip(buf[..len].chunks(window.width.into())) {
            let at = 8 * y + usize::from(window.x);
            if let Some(to) = self.shown.get_mut(at..at + row.len()) {
                to.copy_from_slice(row);
            }
        }
        self.held = Some(buf);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Words>, ErrorKind>> {
        let home = self.held.take();
        let is_swapped = |(after, _): &mut (usize, Words)| self.started == *after;
        let swapped = self.swapped.take_if(is_swapped);
        Poll::Ready(Ok(swapped.map(|(_, buffer)| buffer).or(home)))
    }

    fn end(&mut self) -> Result<(), ErrorKind> {
        self.window = None;
        Ok(())
    }
}

fn words(count: usize) -> Words {
    vec![0; count].leak()
}

fn pump(panel: Panel) -> Pump<Panel> {
    let shown = vec![0xEEEE; 8 * 4];
    Pump::new(Panel { shown, ..panel }, [words(8), words(8)])
}

const WHOLE: Window = Window {
    x: 0,
    y: 0,
    width: 8,
    height: 4,
};

/// Sends lines of their number in runs, and ends the frame as one does who leaves the loop at an error.
fn send(
    pump: &mut Pump<Panel>,
    window: Window,
    shown: &mut ShownRuns<'_>,
) -> [Result<(), ScanError<ErrorKind>>; 2] {
    let mut frame = pump.begin_in_runs(window, 1, shown).unwrap();
    let mut lines = || {
        for y in 0..window.height {
            frame.line()?.fill(y);
            frame.line_done()?;
        }
        Ok(())
    };
    let done = lines();
    [done, frame.finish()]
}

/// Kills: a frame in runs that is finished after an error, and what it did not send taken for shown.
#[test]
fn a_frame_in_runs_is_not_whole_after_an_error() {
    for at in 0..4 {
        let mut pump = pump(Panel {
            fails_at: Some(at),
            ..Panel::default()
        });
        let mut hashes = [0; ShownRuns::words(8, 4, 4, 1)];
        let mut shown = ShownRuns::new(&mut hashes, 8, 4, 1);
        let [sent, finished] = send(&mut pump, WHOLE, &mut shown);
        let refused = ScanError::Sink {
            line: at as u16,
            error: ErrorKind::Bus,
        };
        assert_eq!(sent, Err(refused));
        assert!(matches!(finished, Err(ScanError::OutOfTurn { .. })));
        assert_eq!(send(&mut pump, WHOLE, &mut shown), [Ok(()); 2]);
        let want: Vec<u16> = (0..4).flat_map(|y| [y; 8]).collect();
        assert_eq!(pump.sink().shown, want);
    }
}

/// Kills: cells beside a window that count as changed.
#[test]
fn a_window_leaves_the_cells_beside_it_as_they_are() {
    let mut pump = pump(Panel::default());
    let mut hashes = [0; ShownRuns::words(8, 4, 4, 1)];
    let mut shown = ShownRuns::new(&mut hashes, 8, 4, 1);
    let sent = [0, 4, 0, 4].map(|x| {
        let window = Window {
            x,
            width: 4,
            ..WHOLE
        };
        assert_eq!(send(&mut pump, window, &mut shown), [Ok(()); 2]);
        pump.take_stats().bytes_sent
    });
    assert_eq!(sent, [32, 32, 0, 0]);
}

/// Kills: a transfer that is longer than its buffer.
#[test]
fn a_buffer_that_came_back_shorter_is_told() {
    let mut pump = pump(Panel::default());
    let mut hashes = [0; ShownRuns::words(8, 4, 1, 1)];
    let mut shown = ShownRuns::new(&mut hashes, 8, 1, 1);
    assert_eq!(send(&mut pump, WHOLE, &mut shown), [Ok(()); 2]);
    // Line 1 has the first buffer again when its first run needs another.
    pump.sink_mut().swapped = Some((pump.sink().started + 2, words(5)));
    let mut frame = pump.begin_in_runs(WHOLE, 1, &mut shown).unwrap();
    let mut lines = || {
        for y in 0..WHOLE.height {
            // Two runs, since column 6 is as it was.
            let line = frame.line()?;
            line.fill(100);
            line[6] = y;
            frame.line_done()?;
        }
        Ok(())
    };
    let short = ScanError::BufferTooShort { needed: 8, have: 5 };
    assert_eq!(lines(), Err(short));
    assert!(!pump.sink().is_overrun);
}

/// Kills: a frame whose buffers stay away, and whose rectangle stays open, when drawing fails.
#[test]
fn drawing_that_fails_ends_the_frame() {
    #[derive(Debug, PartialEq)]
    enum Why {
        Sent,
        Drawn,
    }
    impl From<ScanError<ErrorKind>> for Why {
        fn from(_: ScanError<ErrorKind>) -> Self {
            Self::Sent
        }
    }
    for fails in 1..3 {
        let mut pump = pump(Panel::default());
        let window = Window {
            width: 4,
            height: 3,
            ..WHOLE
        };
        let memory = [&mut [0; 4][..], &mut [0; 4]];
        let mix = |_: &[u16], _: &[u16], _: &mut [u16]| {};
        let done = send_doubled(&mut pump, window, 1, memory, mix, |line, _| {
            if line == fails {
                return Err(Why::Drawn);
            }
            Ok(())
        });
        assert_eq!(done, Err(Why::Drawn));
        assert!(pump.sink().held.is_none() && pump.sink().window.is_none());
        assert_eq!(pump.line(), Err(ScanError::OutOfTurn { line: 0 }));
    }
}

/// Kills: lines of a window that are no lines of a display.
#[test]
fn windows_beyond_16_bits_are_refused() {
    for (x, y) in [(65_528, 0), (0, 65_532)] {
        let ends = Window { x, y, ..WHOLE };
        let mut pump = pump(Panel::default());
        assert_eq!(
            pump.begin(
                Window {
                    x: x.min(65_527),
                    y: y.min(65_531),
                    ..ends
                },
                1
            ),
            Ok(())
        );
        assert_eq!(pump.begin(ends, 1), Err(ScanError::Empty));
        assert_eq!(pump.begin_in_parts(ends, 1), Err(ScanError::Empty));
        let mut shown = ShownRuns::new(&mut [], 8, 4, 1);
        let begun = pump.begin_in_runs(ends, 1, &mut shown);
        assert_eq!(begun.err(), Some(ScanError::Empty));
    }
}
