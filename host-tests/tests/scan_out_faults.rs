//! Each sink, failing at each of its operations: the error says where, the buffers come home, and the next frame is
//! whole (SPEC S5, X5). Sinks that hang or are late are the mock's, in `scan_out.rs`.

use std::cell::Cell;
use std::task::{Context, Poll, Waker};

use crate::glass::{Broken, Bus, Glass, Nothing, Pin, Sent, Shared, Target};
use embedded_graphics_core::pixelcolor::{Rgb565, raw::RawU16};
use mipidsi::interface::Interface as _;
use mipidsi::models::ILI9341Rgb565;
use mipidsi::options::{Orientation, Rotation};
use scanbeam::scan_out::{
    AsyncLineWriter, AsyncPump, Blocking, BlockingError, DrawTargetLines, Error as _, ErrorKind,
    FrameBuffer, FrameBufferError, MipidsiLines, MipidsiWire, PanelError, Pump, ScanError,
    ScanoutDma, SpiPanel, SwapFlag, Window,
};

const WIDTH: u16 = 6;
const HEIGHT: u16 = 7;
const FULL: Window = Window {
    x: 0,
    y: 0,
    width: WIDTH,
    height: HEIGHT,
};
const BANDS: [u16; 4] = [1, 2, 3, HEIGHT];

type Line = &'static mut [u16];

fn buffers() -> [Line; 2] {
    [(); 2].map(|()| Box::leak(Box::new([0; (WIDTH * HEIGHT) as usize])).as_mut_slice())
}

/// The pixel of a test frame; `tone` tells frames apart.
fn pixel(tone: u16, x: u16, y: u16) -> u16 {
    tone.wrapping_mul(1000) + y * 10 + x
}

fn picture(tone: u16) -> Vec<Option<u16>> {
    (0..HEIGHT)
        .flat_map(|y| (0..WIDTH).map(move |x| Some(pixel(tone, x, y))))
        .collect()
}

fn draw(tone: u16, y: u16, words: &mut [u16], big_endian: bool) {
    for (x, word) in (0..).zip(words) {
        let pixel = pixel(tone, x, y);
        *word = if big_endian { pixel.to_be() } else { pixel };
    }
}

fn send<D: ScanoutDma<Buf = Line>>(
    pump: &mut Pump<D>,
    band: u16,
    tone: u16,
    big_endian: bool,
) -> Result<(), ScanError<D::Error>> {
    pump.begin(FULL, band)?;
    for y in 0..HEIGHT {
        draw(tone, y, pump.line()?, big_endian);
        pump.line_done()?;
    }
    pump.finish()
}

/// Fails at the first operation of a frame, at the second, and so on until the frame has no more.
fn fails_anywhere(
    glass: &Shared,
    mut send: impl FnMut(u16, u16) -> Result<(), (u16, ErrorKind)>,
) -> usize {
    let mut tone = 0;
    let mut faults = 0;
    for band in BANDS {
        for at in 0.. {
            tone += 2;
            send(band, tone).unwrap();
            assert_eq!(glass.borrow().shown, picture(tone));
            let first = glass.borrow().operations;
            glass.borrow_mut().fail_after(at);
            let sent = send(band, tone + 1);
            let struck = glass.borrow().operations > first + at;
            let written = glass.borrow().lines_written();
            glass.borrow_mut().fails_at = None;
            match sent {
                Ok(()) => {
                    assert!(!struck, "an error was swallowed");
                    assert_eq!(glass.borrow().shown, picture(tone + 1));
                    break;
                }
                // What was written before the transfer that failed is there, and the error names the next line.
                Err((line, kind)) => {
                    assert_eq!((line, kind), (written, ErrorKind::Bus), "band {band}, {at}");
                    let lines = usize::from(line * WIDTH);
                    assert_eq!(glass.borrow().shown[..lines], picture(tone + 1)[..lines]);
                    faults += 1;
                }
            }
        }
    }
    faults
}

/// As [`fails_anywhere`], for a sink behind a pump, whose buffers must be home in the end.
fn sink_fails_anywhere<D: ScanoutDma<Buf = Line>>(glass: &Shared, sink: D, big: bool) -> usize {
    let mut pump = Pump::new(sink, buffers());
    let faults = fails_anywhere(glass, |band, tone| {
        send(&mut pump, band, tone, big).map_err(|error| match error {
            ScanError::Sink { line, error } => (line, error.kind()),
            other => panic!("{other:?}"),
        })
    });
    assert_eq!(pump.release().1.iter().flatten().count(), 2);
    faults
}

/// Operations of a frame: 3 commands of pin low, byte, pin high, two of them with data; then the bands.
fn operations(per_window: usize) -> usize {
    let bands: u16 = BANDS.iter().map(|band| HEIGHT.div_ceil(*band)).sum();
    BANDS.len() * per_window + usize::from(bands)
}

#[test]
fn spi_panels() {
    let glass = Glass::shared(WIDTH, HEIGHT);
    let sink = Blocking::over(SpiPanel::new(Bus(glass.clone()), Pin(glass.clone())));
    assert_eq!(sink_fails_anywhere(&glass, sink, true), operations(11));
}

#[test]
fn draw_targets() {
    let glass = Glass::shared(WIDTH, HEIGHT);
    let colour = |word: u16| Rgb565::from(RawU16::new(word));
    let target = DrawTargetLines::new(Target(glass.clone()), colour);
    let sink = Blocking::over(target);
    assert_eq!(sink_fails_anywhere(&glass, sink, false), operations(0));
    // Beyond the target, which would draw nothing there.
    let mut sink = Blocking::<_, Line>::over(DrawTargetLines::new(Target(glass.clone()), colour));
    for window in [Window { x: 1, ..FULL }, Window { y: 1, ..FULL }] {
        assert_eq!(sink.begin(window).unwrap_err().kind(), ErrorKind::Length);
    }
}

#[test]
fn panels_of_mipidsi() {
    // As wide as it is high when it is turned: 7 x 6 of the controller's memory.
    let glass = Glass::shared(320, 240);
    let wire = MipidsiWire::new(Bus(glass.clone()), Pin(glass.clone()));
    let display = mipidsi::Builder::new(ILI9341Rgb565, &wire)
        .orientation(Orientation::new().rotate(Rotation::Deg90))
        .init(&mut Nothing)
        .unwrap();
    let lines = MipidsiLines::<_, _, _, _, u16>::new(display, &wire);
    let mut pump = Pump::new(Blocking::over(lines), buffers());
    glass.borrow_mut().sent.clear();
    let window = Window {
        x: 0x101,
        y: 2,
        width: 2,
        height: 3,
    };
    pump.begin(window, 2).unwrap();
    for y in 0..3 {
        pump.line().unwrap().fill((0xAB00_u16 + y).to_be());
        pump.line_done().unwrap();
    }
    pump.finish().unwrap();
    let data = |bytes: &[u8]| Sent::Data(bytes.to_vec());
    let want = [
        Sent::Command(0x2A),
        data(&[1, 1, 1, 2]),
        Sent::Command(0x2B),
        data(&[0, 2, 0, 4]),
        Sent::Command(0x2C),
        data(&[0xAB, 0, 0xAB, 0, 0xAB, 1, 0xAB, 1]), // raw lines, two at once
        data(&[0xAB, 2, 0xAB, 2]),
    ];
    assert_eq!(glass.borrow().sent, want);
    // Windows that the display does not have, which mipidsi itself would not notice.
    for (x, y, width, height) in [(319, 0, 2, 1), (0, 239, 1, 2), (u16::MAX - 2, 0, 2, 1)] {
        let window = Window {
            x,
            y,
            width,
            height,
        };
        let error = ScanError::Sink {
            line: 0,
            error: BlockingError::Writer(PanelError::Window),
        };
        assert_eq!(pump.begin(window, 1), Err(error));
    }
    // Its own drawing goes over the same wire, with orientation and all.
    let display = pump.sink_mut().writer_mut().display_mut();
    display.set_pixel(300, 200, Rgb565::new(31, 0, 1)).unwrap();
    assert_eq!(glass.borrow().shown[200 * 320 + 300], Some(0xF801));
    // Kills: one byte that is left is not sent.
    let mut wire = &wire;
    wire.send_command(0, &[]).unwrap();
    wire.send_pixels([[0xAB]]).unwrap();
    assert_eq!(glass.borrow().sent.last(), Some(&data(&[0xAB])));
}

#[test]
fn panels_of_mipidsi_that_fail() {
    let glass = Glass::shared(WIDTH, HEIGHT);
    let wire = MipidsiWire::new(Bus(glass.clone()), Pin(glass.clone()));
    let display = mipidsi::Builder::new(ILI9341Rgb565, &wire)
        .display_size(WIDTH, HEIGHT)
        .init(&mut Nothing)
        .unwrap();
    let lines = MipidsiLines::<_, _, _, _, u16>::new(display, &wire);
    let faults = sink_fails_anywhere(&glass, Blocking::over(lines), true);
    assert_eq!(faults, operations(11));
}

/// The same panel, awaited: each write takes three polls.
struct Slow(Bus);

impl embedded_hal::spi::ErrorType for Slow {
    type Error = Broken;
}

impl embedded_hal_async::spi::SpiDevice for Slow {
    async fn transaction(
        &mut self,
        operations: &mut [embedded_hal::spi::Operation<'_, u8>],
    ) -> Result<(), Broken> {
        for _ in 0..2 {
            embassy_futures::yield_now().await;
        }
        embedded_hal::spi::SpiDevice::transaction(&mut self.0, operations)
    }
}

fn frame(
    pump: &mut AsyncPump<'_, SpiPanel<Slow, Pin, u16>>,
    band: u16,
    tone: u16,
) -> impl Future<Output = Result<(), ScanError<PanelError<Broken, Broken>>>> {
    pump.frame(FULL, band, move |y, words| {
        draw(tone, y, words, true);
        Ok(())
    })
}

#[test]
fn panels_that_are_awaited() {
    let glass = Glass::shared(WIDTH, HEIGHT);
    let panel = SpiPanel::<_, _, u16>::new(Slow(Bus(glass.clone())), Pin(glass.clone()));
    let (mut one, mut other) = ([0; 42], [0; 42]);
    let mut pump = AsyncPump::new(panel, [&mut one, &mut other]);
    let faults = fails_anywhere(&glass, |band, tone| {
        let sent = embassy_futures::block_on(frame(&mut pump, band, tone));
        sent.map_err(|error| match error {
            ScanError::Sink { line, error } => (line, error.kind()),
            other => panic!("{other:?}"),
        })
    });
    assert_eq!(faults, operations(11));
    // Of no lines, of no columns, and of no lines a transfer.
    for (width, height, band) in [(6, 0, 1), (0, 7, 1), (6, 7, 0)] {
        let window = Window {
            width,
            height,
            ..FULL
        };
        let empty = pump.frame::<ScanError<_>>(window, band, |_, _| panic!("nothing is drawn"));
        assert_eq!(embassy_futures::block_on(empty), Err(ScanError::Empty));
    }
    // Given up after any number of polls, as a timeout does: the next frame is whole.
    let mut context = Context::from_waker(Waker::noop());
    for band in BANDS {
        for polls in 0.. {
            {
                let mut given_up = Box::pin(frame(&mut pump, band, 1));
                let mut poll = || given_up.as_mut().poll(&mut context);
                if (0..polls).any(|_| poll().is_ready()) {
                    assert!(polls > 10);
                    break;
                }
            }
            embassy_futures::block_on(frame(&mut pump, band, 2)).unwrap();
            assert_eq!(glass.borrow().shown, picture(2));
        }
    }
}

/// What is drawn while a band is sent is the next one: the order of all events.
#[test]
fn drawing_and_sending_overlap() {
    use std::cell::RefCell;

    #[derive(Debug, PartialEq)]
    enum Event {
        Open,
        Drawn(u16),
        Start(u16),
        End(u16),
        Close,
    }
    use Event::{Close, Drawn, End, Open, Start};

    struct Logger<'l>(&'l RefCell<Vec<Event>>);
    impl AsyncLineWriter for Logger<'_> {
        type Error = ErrorKind;
        type Word = u16;
        async fn open(&mut self, _: Window) -> Result<(), ErrorKind> {
            self.0.borrow_mut().push(Open);
            Ok(())
        }
        async fn write(&mut self, lines: Window, words: &[u16]) -> Result<(), ErrorKind> {
            // As the bands were drawn, not yet as the next ones are.
            assert_eq!(words[0], lines.y);
            self.0.borrow_mut().push(Start(lines.y));
            for _ in 0..3 {
                embassy_futures::yield_now().await;
            }
            assert_eq!(words[0], lines.y);
            self.0.borrow_mut().push(End(lines.y));
            Ok(())
        }
        async fn close(&mut self, whole: bool) -> Result<(), ErrorKind> {
            assert!(whole);
            self.0.borrow_mut().push(Close);
            Ok(())
        }
    }

    let log = RefCell::new(Vec::new());
    let (mut one, mut other) = ([0; 12], [0; 12]);
    let mut pump = AsyncPump::new(Logger(&log), [&mut one, &mut other]);
    let window = Window { height: 5, ..FULL };
    embassy_futures::block_on(pump.frame::<ScanError<_>>(window, 2, |line, words| {
        words.fill(line);
        log.borrow_mut().push(Drawn(line));
        Ok(())
    }))
    .unwrap();
    let want = [
        Open,
        Drawn(0),
        Drawn(1),
        Start(0),
        Drawn(2), // while 0 and 1 are sent
        Drawn(3),
        End(0),
        Start(2),
        Drawn(4),
        End(2),
        Start(4),
        End(4),
        Close,
    ];
    assert_eq!(*log.borrow(), want);
    assert_eq!(pump.stats().transfers, 3);
    assert_eq!(pump.stats().bytes_sent, 2 * 30);
}

/// Frames in memory: shown whole or not at all, and never while one is filled.
#[test]
fn frame_buffers() {
    let flag = SwapFlag::new();
    let (mut one, mut other) = ([0; 42], [0; 42]);
    let frames = FrameBuffer::new([&mut one, &mut other], WIDTH, HEIGHT, &flag);
    let mut pump = Pump::new(Blocking::over(frames.with_max_polls(Some(5))), buffers());
    let whole = |tone| -> Vec<u16> { picture(tone).into_iter().flatten().collect() };
    let mut before = vec![0; 42];
    for tone in 1..40 {
        let band = BANDS[usize::from(tone) % 4];
        // Given up at any line: what is shown stays, also when the vertical blank comes.
        for given_up in 0..HEIGHT {
            pump.begin(FULL, band).unwrap();
            for y in 0..given_up {
                draw(99, y, pump.line().unwrap(), false);
                pump.line_done().unwrap();
                flag.vertical_blank();
                assert_eq!(pump.sink().writer().shown(), before);
            }
            pump.finish().unwrap_err();
            flag.vertical_blank();
            assert_eq!(pump.sink().writer().shown(), before);
        }
        send(&mut pump, band, tone, false).unwrap();
        assert!(flag.is_pending());
        assert_eq!(pump.sink().writer().shown(), before);
        // No vertical blank: the next frame is not begun, since its memory is not free.
        let no_blank = ScanError::Sink {
            line: 0,
            error: BlockingError::Writer(FrameBufferError::NoBlank),
        };
        assert_eq!(pump.begin(FULL, band), Err(no_blank));
        assert_eq!(pump.sink().writer().shown(), before);
        assert_eq!(flag.vertical_blank(), usize::from(tone % 2));
        assert_eq!(pump.sink().writer().shown(), whole(tone));
        before = whole(tone);
    }
    assert_eq!(pump.release().1.iter().flatten().count(), 2);
}

/// Parts of a picture in a pair of frames: the rest is what was shown.
#[test]
fn parts_of_frame_buffers() {
    let flag = SwapFlag::new();
    let blanks = Cell::new(0);
    let (mut one, mut other) = ([0u16; 42], [0; 42]);
    let frames = FrameBuffer::new([&mut one, &mut other], WIDTH, HEIGHT, &flag);
    let mut pump = Pump::new(Blocking::over(frames), buffers());
    let mut want = [0u16; 42];
    for round in 1..60u16 {
        let (x, y) = (round % WIDTH, round * 5 % HEIGHT);
        let (width, height) = (1 + round * 7 % (WIDTH - x), 1 + round * 11 % (HEIGHT - y));
        let window = Window {
            x,
            y,
            width,
            height,
        };
        pump.begin(window, 2).unwrap();
        for line in y..y + height {
            pump.line().unwrap().fill(round);
            pump.line_done().unwrap();
            let at = usize::from(line * WIDTH + x);
            want[at..at + usize::from(width)].fill(round);
        }
        pump.finish().unwrap();
        flag.vertical_blank();
        blanks.set(blanks.get() + 1);
        assert_eq!(pump.sink().writer().shown(), want, "round {round}");
    }
    for window in [Window { x: 1, ..FULL }, Window { height: 8, ..FULL }] {
        let error = pump.begin(window, 1).unwrap_err();
        assert_eq!(error.kind(), ErrorKind::Length);
    }
    // Frames too short for the display.
    let (mut one, mut other) = ([0u16; 42], [0; 41]);
    let frames = FrameBuffer::new([&mut one, &mut other], WIDTH, HEIGHT, &flag);
    let mut sink = Blocking::<_, Line>::over(frames);
    assert!(sink.begin(FULL).is_err());
    assert!(matches!(sink.poll(), Poll::Ready(Ok(None))));
}
