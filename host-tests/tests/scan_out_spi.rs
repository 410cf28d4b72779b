//! The blocking SPI sink, against a mocked bus and pin that know each byte they expect (SPEC S5, X5).
//!
//! What must hold: the exact bytes on the bus, both ends of a window inclusive, and none at all for a call that is refused.

use std::task::Poll;

use embedded_hal_mock::eh1::digital::{
    Mock as PinMock, State as PinState, Transaction as PinTransaction,
};
use embedded_hal_mock::eh1::spi::{Mock as SpiMock, Transaction as SpiTransaction};
use scanbeam::scan_out::{
    Blocking, BlockingError, Error as _, ErrorKind, PanelError, Pump, ScanError, ScanStats,
    ScanoutDma, SpiPanel, Window,
};

/// One `SpiDevice` transaction that writes `bytes`.
fn write(bytes: &[u8]) -> [SpiTransaction<u8>; 3] {
    [
        SpiTransaction::transaction_start(),
        SpiTransaction::write_vec(bytes.to_vec()),
        SpiTransaction::transaction_end(),
    ]
}

/// The pin for `commands` commands, each low for the command, then high.
fn dc(commands: usize) -> PinMock {
    let one = [
        PinTransaction::set(PinState::Low),
        PinTransaction::set(PinState::High),
    ];
    let all: Vec<_> = (0..commands).flat_map(|_| one.clone()).collect();
    PinMock::new(&all)
}

fn leak<const N: usize>(words: usize) -> &'static mut [[u8; N]] {
    Box::leak(vec![[0; N]; words].into())
}

#[test]
fn the_spi_sink_sends_exactly_these_bytes() {
    let mut spi = SpiMock::new(
        &[
            write(&[0x2A]),
            write(&[0x01, 0x05, 0x01, 0x06]), // columns 0x103 + 2 ..= 0x104 + 2
            write(&[0x2B]),
            write(&[0x00, 0x09, 0x00, 0x0B]), // lines 1 + 8 ..= 3 + 8
            write(&[0x2C]),
            write(&[0xAB, 0, 0xAB, 1, 0xAB, 10, 0xAB, 11]), // two lines
            write(&[0xAB, 20, 0xAB, 21]),                   // the last band is shorter
        ]
        .concat(),
    );
    let mut pin = dc(3);
    let sink = Blocking::over(SpiPanel::new(spi.clone(), pin.clone()).with_offset(2, 8));
    let mut pump = Pump::new(sink, [leak::<2>(4), leak(5)]);
    pump.begin(
        Window {
            x: 0x103,
            y: 1,
            width: 2,
            height: 3,
        },
        2,
    )
    .unwrap();
    for y in 0..3 {
        for (x, word) in (0..).zip(pump.line().unwrap()) {
            *word = [0xAB, y * 10 + x];
        }
        pump.line_done().unwrap();
    }
    pump.finish().unwrap();
    let expected = ScanStats {
        bytes_sent: 12,
        transfers: 2,
        stall_polls: 0,
        ..ScanStats::default()
    };
    assert_eq!(pump.stats(), expected);
    let (sink, buffers) = pump.release();
    assert_eq!(buffers.iter().flatten().count(), 2);
    drop(sink.into_writer().release());
    spi.done();
    pin.done();
}

#[test]
fn the_spi_sink_sends_three_byte_pixels() {
    let mut spi = SpiMock::new(
        &[
            write(&[0x2A]),
            write(&[0, 0, 0, 1]),
            write(&[0x2B]),
            write(&[0, 0, 0, 0]),
            write(&[0x2C]),
            write(&[1, 2, 3, 4, 5, 6]),
        ]
        .concat(),
    );
    let mut pin = dc(3);
    let mut sink = Blocking::over(SpiPanel::<_, _, [u8; 3]>::new(spi.clone(), pin.clone()));
    sink.begin(Window {
        x: 0,
        y: 0,
        width: 2,
        height: 1,
    })
    .unwrap();
    let line = leak::<3>(3);
    line.copy_from_slice(&[[1, 2, 3], [4, 5, 6], [7, 8, 9]]);
    sink.start(line, 2).unwrap();
    assert!(matches!(sink.poll(), Poll::Ready(Ok(Some(buf))) if buf.len() == 3));
    assert!(matches!(sink.poll(), Poll::Ready(Ok(None))));
    sink.end().unwrap();
    spi.done();
    pin.done();
}

#[test]
fn the_spi_sink_refuses_misuse_without_a_byte_on_the_bus() {
    let window = Window {
        x: 0,
        y: 0,
        width: 2,
        height: 2,
    };
    let mut spi = SpiMock::new(
        &[
            write(&[0x2A]),
            write(&[0, 0, 0, 1]),
            write(&[0x2B]),
            write(&[0, 0, 0, 1]),
            write(&[0x2C]),
            write(&[0; 4]),
        ]
        .concat(),
    );
    let mut pin = dc(3);
    let mut sink = Blocking::over(SpiPanel::<_, _, [u8; 2]>::new(spi.clone(), pin.clone()));
    let (error, _) = sink.start(leak(2), 2).unwrap_err();
    assert_eq!(error, BlockingError::Sequence);
    for window in [
        Window { width: 0, ..window },
        Window {
            height: 0,
            ..window
        },
        Window {
            x: u16::MAX,
            ..window
        },
        Window {
            y: u16::MAX,
            ..window
        },
    ] {
        assert_eq!(sink.begin(window).unwrap_err().kind(), ErrorKind::Length);
    }
    sink.begin(window).unwrap();
    for len in [0, 1, 3, 6, 9] {
        let (error, buf) = sink.start(leak(8), len).unwrap_err();
        assert_eq!((error, buf.len()), (BlockingError::Length, 8));
    }
    sink.start(leak(2), 2).unwrap();
    let (error, _) = sink.start(leak(2), 2).unwrap_err();
    assert_eq!(error.kind(), ErrorKind::Sequence); // the first buffer was not polled
    assert_eq!(sink.end(), Err(BlockingError::Sequence)); // a line is missing
    assert_eq!(sink.end(), Ok(())); // closed all the same
    spi.done();
    pin.done();
}

#[test]
fn an_spi_sink_whose_pin_fails_says_so() {
    let mut spi = SpiMock::<u8>::new(&[]);
    let failed = embedded_hal_mock::eh1::MockError::Io(std::io::ErrorKind::Other);
    let mut pin = PinMock::new(&[PinTransaction::set(PinState::Low).with_error(failed.clone())]);
    let sink = Blocking::over(SpiPanel::<_, _, [u8; 2]>::new(spi.clone(), pin.clone()));
    let mut pump = Pump::new(sink, [leak(6), leak(6)]);
    let window = Window {
        x: 0,
        y: 0,
        width: 6,
        height: 7,
    };
    let error = pump.begin(window, 1).unwrap_err();
    assert_eq!(
        error,
        ScanError::Sink {
            line: 0,
            error: BlockingError::Writer(PanelError::Pin(failed))
        }
    );
    assert_eq!(error.kind(), ErrorKind::Bus);
    drop(pump);
    spi.done();
    pin.done();
}
