//! The pump, against the mock that forgives nothing (SPEC S5, K12, X5, M4).
//!
//! What must hold: whatever the band, the lateness and the sort of sink, the same frame arrives; every misuse is refused
//! with its line; and after any fault both buffers are home and the next frame is whole.

mod misuse;

use host_tests::mock::{Fault, HostLine, MockError, MockFrameBuffer};
use scanbeam::scan_out::{Error as _, ErrorKind, Pump, ScanError, ScanStats, ScanoutDma, Window};

const WIDTH: u16 = 6;
const HEIGHT: u16 = 7;
const FULL: Window = Window {
    x: 0,
    y: 0,
    width: WIDTH,
    height: HEIGHT,
};

type Mock = MockFrameBuffer<u16>;
type Result<T = ()> = std::result::Result<T, ScanError<MockError>>;

fn mock() -> Mock {
    Mock::new(WIDTH, HEIGHT)
}

fn buffers(words: usize) -> [HostLine<u16>; 2] {
    [HostLine::new(words), HostLine::new(words)]
}

fn whole_frame_buffers() -> [HostLine<u16>; 2] {
    buffers(usize::from(WIDTH) * usize::from(HEIGHT))
}

/// The pixel of a test frame; `tone` tells frames apart.
fn pixel(tone: u16, x: u16, y: u16) -> u16 {
    tone * 1000 + y * 10 + x
}

fn picture(tone: u16) -> Vec<u16> {
    (0..HEIGHT)
        .flat_map(|y| (0..WIDTH).map(move |x| pixel(tone, x, y)))
        .collect()
}

/// Draws the lines of a window through the pump.
fn send(pump: &mut Pump<Mock>, window: Window, band: u16, tone: u16) -> Result {
    pump.begin(window, band)?;
    for y in window.y..window.y + window.height {
        let line = pump.line()?;
        assert_eq!(line.len(), usize::from(window.width));
        for (x, word) in (window.x..).zip(line) {
            *word = pixel(tone, x, y);
        }
        pump.line_done()?;
    }
    pump.finish()
}

fn idle_count<B>(buffers: &[Option<B>]) -> usize {
    buffers.iter().flatten().count()
}

#[test]
fn the_same_frame_arrives_for_any_band_lateness_and_sort_of_sink() {
    for late in [0, 1, 7, 100] {
        for band in [1, 2, 3, 5, HEIGHT, HEIGHT + 9, u16::MAX] {
            for chained in [false, true] {
                let sink = if chained { mock().chained() } else { mock() };
                let mut pump = Pump::new(sink.late_by(late), whole_frame_buffers());
                for tone in 0..3 {
                    send(&mut pump, FULL, band, tone).unwrap();
                    assert_eq!(pump.sink().frame().unwrap(), picture(tone));
                }
                let transfers = 3 * HEIGHT.div_ceil(band.min(HEIGHT));
                assert_eq!(pump.sink().transfers(), usize::from(transfers));
                assert_eq!(pump.sink().windows(), 3);
                let stats = pump.take_stats();
                let expected = ScanStats {
                    bytes_sent: 3 * 2 * u64::from(WIDTH) * u64::from(HEIGHT),
                    transfers: transfers.into(),
                    // Nothing polls but the pump, so each poll of each transfer is a stall.
                    stall_polls: late * u32::from(transfers),
                    ..ScanStats::default()
                };
                assert_eq!(stats, expected);
                assert_eq!(pump.stats(), ScanStats::default());
                let (_, buffers) = pump.release();
                assert_eq!(idle_count(&buffers), 2);
            }
        }
    }
}

#[test]
fn two_buffers_are_filled_before_anything_waits() {
    let mut pump = Pump::new(mock().late_by(50), buffers(6));
    pump.begin(FULL, 1).unwrap();
    for _ in 0..2 {
        assert_eq!(pump.stats().stall_polls, 0);
        pump.line().unwrap();
        if pump.stats().transfers == 0 {
            pump.line_done().unwrap();
        }
    }
    // Both are full now: the swap waits for the running scan-out.
    assert_eq!(
        pump.stats(),
        ScanStats {
            bytes_sent: 12,
            transfers: 1,
            stall_polls: 0,
            ..ScanStats::default()
        }
    );
    pump.line_done().unwrap();
    assert_eq!(
        pump.stats(),
        ScanStats {
            bytes_sent: 24,
            transfers: 2,
            stall_polls: 50,
            ..ScanStats::default()
        }
    );

    // A chaining sink takes the second at once, and only the third line waits.
    let mut pump = Pump::new(mock().late_by(50).chained(), buffers(6));
    pump.begin(FULL, 1).unwrap();
    for _ in 0..2 {
        pump.line().unwrap();
        pump.line_done().unwrap();
    }
    assert_eq!(
        pump.stats(),
        ScanStats {
            bytes_sent: 24,
            transfers: 2,
            stall_polls: 0,
            ..ScanStats::default()
        }
    );
    pump.line().unwrap();
    assert_eq!(pump.stats().stall_polls, 50);
}

#[test]
fn a_line_is_the_same_slice_until_it_is_done() {
    let mut pump = Pump::new(mock(), buffers(12));
    pump.begin(FULL, 2).unwrap();
    pump.line().unwrap().fill(3);
    assert_eq!(pump.line().unwrap(), [3; 6]);
    pump.line_done().unwrap();
    pump.line().unwrap().fill(4);
    pump.line_done().unwrap();
    pump.finish().unwrap_err();
    assert_eq!(
        pump.sink().shown()[..12],
        [[Some(3); 6], [Some(4); 6]].concat()
    );
}

#[test]
fn parts_of_a_frame() {
    let mut pump = Pump::new(mock().late_by(3), buffers(18));
    send(&mut pump, FULL, 3, 1).unwrap();
    // Two columns of a later frame change, the rest stays.
    pump.sink_mut().next_frame();
    let left = Window {
        x: 1,
        y: 2,
        width: 2,
        height: 3,
    };
    let right = Window {
        x: 4,
        y: 3,
        width: 1,
        height: 4,
    };
    send(&mut pump, left, 2, 2).unwrap();
    send(&mut pump, right, 9, 2).unwrap();
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let inside =
                |w: Window| (w.x..w.x + w.width).contains(&x) && (w.y..w.y + w.height).contains(&y);
            let tone = if inside(left) || inside(right) { 2 } else { 1 };
            let at = usize::from(y * WIDTH + x);
            assert_eq!(pump.sink().shown()[at], Some(pixel(tone, x, y)));
        }
    }
    // Such a frame is not whole.
    assert_eq!(pump.sink().frame().unwrap_err().line, 0);
    assert_eq!(pump.stats().bytes_sent, 2 * (42 + 6 + 4));
}

#[test]
fn the_pump_refuses_calls_out_of_turn() {
    let mut pump = Pump::new(mock(), buffers(12));
    assert_eq!(pump.line().unwrap_err(), ScanError::OutOfTurn { line: 0 });
    assert_eq!(pump.line_done(), Err(ScanError::OutOfTurn { line: 0 }));
    assert_eq!(pump.finish(), Err(ScanError::OutOfTurn { line: 0 }));

    pump.begin(FULL, 2).unwrap();
    assert_eq!(pump.line_done(), Err(ScanError::OutOfTurn { line: 0 }));
    for y in 0..HEIGHT {
        pump.line().unwrap().fill(y);
        pump.line_done().unwrap();
        assert_eq!(pump.line_done(), Err(ScanError::OutOfTurn { line: y + 1 }));
    }
    assert_eq!(
        pump.line().unwrap_err(),
        ScanError::OutOfTurn { line: HEIGHT }
    );
    // None of this has changed anything.
    pump.finish().unwrap();
    assert!(pump.sink().frame().is_ok());
}

#[test]
fn the_pump_checks_sizes_before_anything_is_sent() {
    let mut pump = Pump::new(mock(), [HostLine::new(12), HostLine::new(11)]);
    let short = ScanError::BufferTooShort {
        needed: 12,
        have: 11,
    };
    assert_eq!(pump.begin(FULL, 2), Err(short));
    assert_eq!(pump.begin(FULL, 0), Err(ScanError::Empty));
    for (width, height) in [(0, 1), (1, 0), (0, 0)] {
        let window = Window {
            width,
            height,
            ..FULL
        };
        assert_eq!(pump.begin(window, 1), Err(ScanError::Empty));
    }
    let huge = Window {
        x: 0,
        y: 0,
        width: u16::MAX,
        height: u16::MAX,
    };
    assert!(matches!(
        pump.begin(huge, u16::MAX),
        Err(ScanError::BufferTooShort {
            needed: 0xFFFE_0001,
            have: 12
        })
    ));
    assert_eq!(pump.sink().windows(), 0);
    assert_eq!(pump.stats(), ScanStats::default());
    // A band is cut to the window before it is measured.
    let two = Window { height: 1, ..FULL };
    send(&mut pump, two, 2, 0).unwrap();
    pump.sink_mut().next_frame();
    send(&mut pump, FULL, 1, 0).unwrap();
}

#[test]
fn finishing_early_sends_what_is_complete_and_names_the_missing_line() {
    for done in 0..HEIGHT {
        for band in 1..=HEIGHT {
            let mut pump = Pump::new(mock().late_by(2), whole_frame_buffers());
            pump.begin(FULL, band).unwrap();
            for _ in 0..done {
                pump.line().unwrap().fill(1);
                pump.line_done().unwrap();
            }
            pump.line().unwrap().fill(9); // begun, but not done
            assert_eq!(pump.finish(), Err(ScanError::LinesMissing { line: done }));
            let words = usize::from(done) * usize::from(WIDTH);
            assert_eq!(pump.sink().words(), words);
            assert_eq!(pump.sink().frame().unwrap_err().line, done);
            send(&mut pump, FULL, band, 2).unwrap();
            assert_eq!(pump.sink().frame().unwrap(), picture(2));
        }
    }
}

#[test]
fn a_frame_that_was_left_open_is_abandoned_by_the_next() {
    for done in 0..=HEIGHT {
        for chained in [false, true] {
            let sink = if chained { mock().chained() } else { mock() };
            let mut pump = Pump::new(sink.late_by(5), buffers(12));
            pump.begin(FULL, 2).unwrap();
            for _ in 0..done {
                pump.line().unwrap().fill(1);
                pump.line_done().unwrap();
            }
            send(&mut pump, FULL, 1, 2).unwrap();
            assert_eq!(pump.sink().frame().unwrap(), picture(2));
        }
    }
}

#[test]
fn after_a_fault_at_any_line_the_next_frame_is_whole() {
    for fault in [Fault::Begin, Fault::Start, Fault::Poll, Fault::End] {
        for at in 0..HEIGHT {
            for band in [1, 2, 3, 5, HEIGHT] {
                for (late, chained) in [(0, false), (0, true), (7, false), (7, true)] {
                    let sink = if chained { mock().chained() } else { mock() };
                    let mut pump = Pump::new(sink.late_by(late), whole_frame_buffers());
                    send(&mut pump, FULL, band, 1).unwrap();
                    pump.sink_mut().fail_at(at, fault);
                    let error = send(&mut pump, FULL, band, 2).unwrap_err();
                    let expected = match fault {
                        Fault::Begin => 0,
                        Fault::End => HEIGHT,
                        _ => at / band * band,
                    };
                    let ScanError::Sink { line, error: told } = error else {
                        panic!("{error:?}");
                    };
                    assert_eq!((line, told.kind()), (expected, ErrorKind::Bus));
                    assert_eq!(pump.line().unwrap_err(), ScanError::OutOfTurn { line: 0 });
                    send(&mut pump, FULL, band, 3).unwrap();
                    assert_eq!(pump.sink().frame().unwrap(), picture(3));
                    let (_, buffers) = pump.release();
                    assert_eq!(idle_count(&buffers), 2);
                }
            }
        }
    }
}

#[test]
fn a_transfer_that_hangs_is_given_up_and_taken_up_again() {
    for at in 0..HEIGHT {
        for chained in [false, true] {
            let sink = if chained { mock().chained() } else { mock() };
            let mut pump = Pump::new(sink.late_by(3), buffers(12));
            pump.set_max_polls(Some(20));
            send(&mut pump, FULL, 2, 1).unwrap();
            pump.sink_mut().fail_at(at, Fault::Hang);
            let timeout = ScanError::Timeout { line: at / 2 * 2 };
            assert_eq!(send(&mut pump, FULL, 2, 2), Err(timeout));
            assert_eq!(send(&mut pump, FULL, 2, 3), Err(timeout));
            pump.sink_mut().clear_fault();
            send(&mut pump, FULL, 2, 4).unwrap();
            assert_eq!(pump.sink().frame().unwrap(), picture(4));
        }
    }
    // The bound is on one wait, and counts the polls that may find the sink busy.
    let mut pump = Pump::new(mock().late_by(20), buffers(6));
    pump.set_max_polls(Some(20));
    send(&mut pump, FULL, 1, 1).unwrap();
    pump.set_max_polls(Some(19));
    assert_eq!(
        send(&mut pump, FULL, 1, 1),
        Err(ScanError::Timeout { line: 0 })
    );
    pump.sink_mut().fail_at(0, Fault::Hang);
    assert_eq!(idle_count(&pump.release().1), 1);
}

#[test]
fn a_lost_buffer_is_told_and_stays_lost() {
    let mut pump = Pump::new(mock().late_by(1), buffers(6));
    pump.sink_mut().fail_at(3, Fault::Lose);
    assert_eq!(
        send(&mut pump, FULL, 1, 1),
        Err(ScanError::BufferLost { line: 3 })
    );
    assert_eq!(
        send(&mut pump, FULL, 1, 1),
        Err(ScanError::BufferLost { line: 0 })
    );
    assert_eq!(idle_count(&pump.release().1), 1);
}

#[test]
fn errors_say_what_and_where() {
    let mut pump = Pump::new(mock(), buffers(6));
    pump.sink_mut().fail_at(4, Fault::Poll);
    let error = send(&mut pump, FULL, 1, 1).unwrap_err();
    assert_eq!(error.to_string(), "scan-out at line 4: the bus failed");
    let error: ScanError<ErrorKind> = ScanError::LinesMissing { line: 5 };
    assert_eq!(
        error.to_string(),
        "the frame was finished, but line 5 is missing"
    );
    assert_eq!(error.kind(), ErrorKind::Sequence);
}

#[test]
fn a_pump_can_borrow_its_sink() {
    let mut sink = mock().chained();
    let mut pump = Pump::new(&mut sink, buffers(6));
    assert!(pump.sink().chains());
    pump.begin(FULL, 1).unwrap();
    for y in 0..HEIGHT {
        for (x, word) in (0..).zip(pump.line().unwrap()) {
            *word = pixel(5, x, y);
        }
        pump.line_done().unwrap();
    }
    pump.finish().unwrap();
    assert_eq!(sink.frame().unwrap(), picture(5));
}
