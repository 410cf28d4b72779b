//! Runs within lines that the display shows already are not sent, windows keep to the cells that were
//! set, and the display always shows the right picture (X4).

use std::task::Poll;

use crate::common::Rng;
use crate::common::changes::{self, Lines, Mock, Picture, buffers, change, recovered, some_fault};
use host_tests::mock::{HostLine, MockError};
use scanbeam::scan_out::{Pump, ScanError, ScanStats, ScanoutDma, ShownRuns, Window};

/// The mock, with the windows that were opened.
struct Recorder {
    mock: Mock,
    windows: Vec<Window>,
    ends: usize,
}

impl ScanoutDma for Recorder {
    type Error = MockError;
    type Buf = HostLine<u16>;

    fn begin(&mut self, window: Window) -> Result<(), MockError> {
        self.windows.push(window);
        self.mock.begin(window)
    }

    fn start(&mut self, buf: Self::Buf, len: usize) -> Result<(), (MockError, Self::Buf)> {
        self.mock.start(buf, len)
    }

    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, MockError>> {
        self.mock.poll()
    }

    fn end(&mut self) -> Result<(), MockError> {
        self.ends += 1;
        self.mock.end()
    }

    fn chains(&self) -> bool {
        self.mock.chains()
    }
}

/// Pixels of the cells in which two pictures differ, counted from the definition.
fn changed_pixels(a: &Picture, b: &Picture, columns: usize, lines: usize) -> usize {
    let (width, height) = (a[0].len(), a.len());
    let mut pixels = 0;
    for y in (0..height).step_by(lines) {
        for x in (0..width).step_by(columns) {
            let (right, bottom) = ((x + columns).min(width), (y + lines).min(height));
            if (y..bottom).any(|y| a[y][x..right] != b[y][x..right]) {
                pixels += (right - x) * (bottom - y);
            }
        }
    }
    pixels
}

/// Random changes of random pictures on displays and cells of any size, through sinks of each sort that
/// fail in each way: whenever a frame is said to have arrived, the display shows it, nothing was sent but
/// cells that changed or were unknown, and every window begins and ends at an edge of a cell.
#[test]
fn the_display_is_right_and_sent_what_changed_alone() {
    let mut rng = Rng::new(0x2B5E_11A7);
    let (mut arrived, mut failed, mut sent, mut unsent) = (0, 0, 0, 0);
    for round in 0..500 {
        let (width, height) = (1 + rng.below(40) as u16, 1 + rng.below(20) as u16);
        let (columns, lines) = (rng.pick(&[1, 2, 3, 8, 16]), rng.pick(&[1, 1, 2, 5]));
        let mut mock = Mock::new(width, height).late_by(rng.below(4));
        if rng.below(2) == 0 {
            mock = mock.chained();
        }
        let band = 1 + rng.below(u32::from(height) + 4) as u16;
        // As long as it must be, and no longer.
        let rows = (band / lines).max(1) * lines;
        let words = usize::from(width) * usize::from(rows.min(height));
        let sink = Recorder {
            mock,
            windows: Vec::new(),
            ends: 0,
        };
        let mut pump = changes::pump(sink, words);
        let mut words_shown = vec![3; ShownRuns::words(width, height, columns, lines)];
        let mut shown = ShownRuns::new(&mut words_shown, width, columns, lines);
        let mut picture = vec![vec![0u16; width.into()]; height.into()];
        // What the display shows, if the last frame arrived.
        let mut last: Option<Picture> = None;
        for _ in 0..30 {
            change(&mut rng, &mut picture);
            let mut source = Lines {
                picture: &picture,
                fails_at: None,
            };
            let at = rng.below(height.into()) as u16;
            pump.sink_mut().mock.clear_fault();
            if let Some(fault) = some_fault(&mut rng, 3) {
                pump.sink_mut().mock.fail_at(at, fault);
            } else if rng.below(6) == 0 {
                source.fails_at = Some(at);
            }
            pump.sink_mut().mock.next_frame();
            pump.sink_mut().windows.clear();
            let result = source.send(&mut pump, band, &mut shown);
            for w in &pump.sink().windows {
                let on_edge = |at: u16, cell: u16, end: u16| at.is_multiple_of(cell) || at == end;
                assert!(w.x.is_multiple_of(columns) && on_edge(w.x + w.width, columns, width));
                assert!(w.y.is_multiple_of(lines) && on_edge(w.y + w.height, lines, height));
            }
            match result {
                Ok(stats) => {
                    let want: Vec<_> = picture.iter().flatten().copied().map(Some).collect();
                    assert_eq!(pump.sink().mock.shown(), want, "round {round}");
                    let all = 2 * u64::from(width) * u64::from(height);
                    assert_eq!(stats.bytes_sent + stats.bytes_unsent, all);
                    let areas = pump.sink().windows.iter();
                    let opened: u64 = areas
                        .map(|w| u64::from(w.width) * u64::from(w.height))
                        .sum();
                    assert_eq!(stats.bytes_sent, 2 * opened);
                    if let Some(last) = &last {
                        let pixels = changed_pixels(last, &picture, columns.into(), lines.into());
                        assert_eq!(stats.bytes_sent, 2 * pixels as u64, "round {round}");
                    }
                    last = Some(picture.clone());
                    arrived += 1;
                    sent += stats.bytes_sent;
                    unsent += stats.bytes_unsent;
                }
                Err(error) => {
                    last = None;
                    failed += 1;
                    pump = recovered(pump, &error, words);
                }
            }
        }
    }
    println!("{arrived} frames arrived, {failed} failed, {sent} bytes sent, {unsent} not sent");
    assert!(arrived > 6_000 && failed > 2_000 && unsent > 1_000_000);
}

/// Runs that are alike go out as one rectangle; two runs in a line are two.
#[test]
fn runs_are_packed_into_rectangles() {
    let (width, height) = (32, 12);
    let sink = Recorder {
        mock: Mock::new(width, height).late_by(1),
        windows: Vec::new(),
        ends: 0,
    };
    let mut pump = Pump::new(sink, buffers(32 * 4));
    let mut words = vec![0; ShownRuns::words(width, height, 8, 1)];
    let mut shown = ShownRuns::new(&mut words, width, 8, 1);
    let mut picture = vec![vec![7u16; 32]; 12];
    let mut send = |picture: &Picture| {
        pump.sink_mut().mock.next_frame();
        pump.sink_mut().windows.clear();
        let source = Lines {
            picture,
            fails_at: None,
        };
        let stats = source.send(&mut pump, 4, &mut shown).unwrap();
        let corners = |w: &Window| (w.x, w.y, w.width, w.height);
        let windows: Vec<_> = pump.sink().windows.iter().map(corners).collect();
        (stats, windows)
    };
    assert_eq!(
        send(&picture).1,
        [(0, 0, 32, 4), (0, 4, 32, 4), (0, 8, 32, 4)]
    );
    let (stats, windows) = send(&picture);
    assert_eq!((stats.lines_unsent, windows.len()), (12, 0));
    // A block of 10 columns by 6 lines, and two dots in one line.
    for line in &mut picture[1..7] {
        line[10..20].fill(9);
    }
    picture[9][0] = 1;
    picture[9][31] = 2;
    let (stats, windows) = send(&picture);
    let want = [(8, 1, 16, 4), (8, 5, 16, 2), (0, 9, 8, 1), (24, 9, 8, 1)];
    assert_eq!(windows, want);
    let want = ScanStats {
        bytes_sent: 2 * (16 * 6 + 16),
        transfers: 4,
        lines_unsent: 5,
        bytes_unsent: 2 * (32 * 12 - 16 * 6 - 16),
        ..stats
    };
    assert_eq!(stats, want);
}

/// A frame that was sent whole is closed once: one in runs can follow. Kills: a rectangle that counts as open when its frame
/// is done.
#[test]
fn a_frame_in_runs_follows_a_whole_one() {
    let sink = Recorder {
        mock: Mock::new(32, 12),
        windows: Vec::new(),
        ends: 0,
    };
    let mut pump = Pump::new(sink, buffers(32 * 4));
    let window = Window {
        x: 0,
        y: 0,
        width: 32,
        height: 12,
    };
    pump.begin(window, 4).unwrap();
    for _ in 0..12 {
        pump.line().unwrap().fill(3);
        pump.line_done().unwrap();
    }
    pump.finish().unwrap();
    pump.sink_mut().mock.next_frame();
    let mut words = vec![0; ShownRuns::words(32, 12, 8, 1)];
    let mut shown = ShownRuns::new(&mut words, 32, 8, 1);
    let picture = vec![vec![7u16; 32]; 12];
    let source = Lines {
        picture: &picture,
        fails_at: None,
    };
    source.send(&mut pump, 4, &mut shown).unwrap();
    assert_eq!((pump.sink().windows.len(), pump.sink().ends), (4, 4));
}

/// A window off the grid of cells is refused before anything is sent.
#[test]
fn a_window_that_does_not_begin_at_a_cell_is_refused() {
    let mut pump = Pump::new(Mock::new(32, 12), buffers(32 * 4));
    let mut words = vec![0; ShownRuns::words(32, 12, 8, 2)];
    let mut shown = ShownRuns::new(&mut words, 32, 8, 2);
    for (x, y) in [(4, 0), (0, 1), (9, 3)] {
        let window = Window {
            x,
            y,
            width: 8,
            height: 4,
        };
        let want = ScanError::Misaligned {
            cell: (8, 2),
            corner: (x, y),
        };
        let refused = pump.begin_in_runs(window, 4, &mut shown).err();
        assert_eq!(refused, Some(want));
    }
    assert_eq!(pump.sink().windows(), 0);
}
