//! Lines and columns doubled at scan-out, against the definition in plain numbers: each of the four
//! pixels of a drawn one is the mean of the four drawn ones around it by 9, 3, 3 and 1, rounded
//! once (S7, X5).

use crate::common::Rng;
use host_tests::mock::{Fault, HostLine, MockError, MockFrameBuffer};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888, Xrgb8888};
use scanbeam::scan_out::{Pump, ScanError, Window, send_doubled};

/// A pixel as numbers of steps, whatever its word.
type Steps = [u32; 4];

/// A word of a format, and back.
struct Format<W: 'static> {
    most: Steps,
    word: fn(Steps) -> W,
    steps: fn(W) -> Steps,
    mix: fn(&[W], &[W], &mut [W]),
}

fn pack_565([r, g, b, _]: Steps) -> u16 {
    (r << 11 | g << 5 | b) as u16
}

fn steps_565(word: u16) -> Steps {
    let word = u32::from(word);
    [word >> 11, word >> 5 & 63, word & 31, 0]
}

const NATIVE: Format<u16> = Format {
    most: [31, 63, 31, 0],
    word: pack_565,
    steps: steps_565,
    mix: Rgb565::mix_lines,
};
const BIG: Format<u16> = Format {
    most: [31, 63, 31, 0],
    word: |steps| pack_565(steps).to_be(),
    steps: |word| steps_565(u16::from_be(word)),
    mix: Rgb565Be::mix_lines,
};
const LITTLE: Format<u16> = Format {
    most: [31, 63, 31, 0],
    word: |steps| pack_565(steps).to_le(),
    steps: |word| steps_565(u16::from_le(word)),
    mix: Rgb565Le::mix_lines,
};
const BYTES: Format<[u8; 3]> = Format {
    most: [255, 255, 255, 0],
    word: |[r, g, b, _]| [r as u8, g as u8, b as u8],
    steps: |[r, g, b]| [r.into(), g.into(), b.into(), 0],
    mix: Rgb888::mix_lines,
};
const WORDS: Format<u32> = Format {
    most: [255, 255, 255, 0],
    word: |[r, g, b, _]| r << 16 | g << 8 | b,
    steps: |word| [word >> 16 & 255, word >> 8 & 255, word & 255, word >> 24],
    mix: Xrgb8888::mix_lines,
};

/// The pixel at a place of the sent picture, from the drawn one.
fn wanted(drawn: &[Vec<Steps>], x: usize, y: usize) -> Steps {
    // The drawn line or column that a sent one lies in, and the one on its other side.
    let around = |at: usize, count: usize| {
        let far = if at.is_multiple_of(2) {
            (at / 2).saturating_sub(1)
        } else {
            (at / 2 + 1).min(count - 1)
        };
        [(at / 2, 3), (far, 1)]
    };
    let mut sums = [0; 4];
    for (line, down) in around(y, drawn.len()) {
        for (column, across) in around(x, drawn[0].len()) {
            for (sum, step) in sums.iter_mut().zip(drawn[line][column]) {
                *sum += down * across * step;
            }
        }
    }
    sums.map(|sum| (sum + 8) / 16)
}

/// Random pictures in a format, through a pump and a display that forgives nothing.
fn compare<W>(format: &Format<W>, seed: u64)
where
    W: Copy + Default + PartialEq + std::fmt::Debug + 'static,
{
    let mut rng = Rng::new(seed);
    for round in 0..200 {
        let (width, height) = (1 + rng.below(17) as u16, 1 + rng.below(9) as u16);
        let (x, y) = (rng.below(5) as u16, rng.below(5) as u16);
        let band = 1 + rng.below(5) as u16;
        let words = usize::from(2 * width * band);
        let mut sink = MockFrameBuffer::new(2 * (x + width), 2 * (y + height));
        sink = sink.late_by(rng.below(4));
        if rng.below(2) == 0 {
            sink = sink.chained();
        }
        let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
        // Few colours, at both ends of their range, or any.
        let ends = rng.below(2) == 0;
        let mut pixel = || {
            format.most.map(|most| match ends {
                true => most * rng.below(2),
                false => rng.below(most + 1),
            })
        };
        let drawn: Vec<Vec<Steps>> = (0..height)
            .map(|_| (0..width).map(|_| pixel()).collect())
            .collect();
        // Longer than a line, and not clean.
        let mut memory = [
            vec![(format.word)(pixel()); 40],
            vec![(format.word)(pixel()); 18],
        ];
        let [one, other] = &mut memory;
        let window = Window {
            x,
            y,
            width,
            height,
        };
        let mut next = 0;
        send_doubled::<_, ScanError<MockError>>(
            &mut pump,
            window,
            band,
            [one, other],
            format.mix,
            |line, pixels| {
                assert_eq!((line, pixels.len()), (next, usize::from(width)));
                next += 1;
                for (pixel, steps) in pixels.iter_mut().zip(&drawn[usize::from(line)]) {
                    *pixel = (format.word)(*steps);
                }
                Ok(())
            },
        )
        .unwrap();
        assert_eq!(next, height);
        let across = usize::from(2 * (x + width));
        for (at, word) in pump.sink().shown().iter().enumerate() {
            let (column, line) = (at % across, at / across);
            let inside = column
                .checked_sub(usize::from(2 * x))
                .zip(line.checked_sub(usize::from(2 * y)));
            let want = inside.map(|(column, line)| wanted(&drawn, column, line));
            assert_eq!(
                word.map(format.steps),
                want,
                "round {round}, ({column}, {line}) of {width} x {height}"
            );
        }
    }
}

#[test]
fn sent_pixels_are_the_rounded_means_of_four() {
    compare(&NATIVE, 1);
    compare(&BIG, 2);
    compare(&LITTLE, 3);
    compare(&BYTES, 4);
    compare(&WORDS, 5);
}

/// Away from the rim, what is linear over the drawn picture is linear over the sent one, where it
/// was: at a quarter of a drawn pixel from its centre.
#[test]
fn what_is_linear_stays_where_it_is() {
    let line = |y: u8| -> Vec<[u8; 3]> { (0..10).map(|x| [16 * x, 16 * y, 8 * (x + y)]).collect() };
    let mut sent = [[0; 3]; 20];
    Rgb888::mix_lines(&line(4), &line(5), &mut sent);
    for (x, pixel) in sent.iter().enumerate().take(19).skip(1) {
        // In quarters of a drawn pixel from the middle of the first.
        let (x, y) = (2 * x as i32 - 1, 4 * 4 + 1);
        let want = [4 * x, 4 * y, 2 * (x + y)];
        assert_eq!(pixel.map(i32::from), want, "x = {x}");
    }
}

#[test]
fn what_cannot_be_sent_is_refused_and_the_next_frame_is_whole() {
    let words = 24 * 2;
    let sink = MockFrameBuffer::<u16>::new(24, 12);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let (mut one, mut other) = ([0; 12], [0; 12]);
    let mut send = |pump: &mut Pump<_>, window: Window, short: usize, ends_at: u16| {
        let memory = [&mut one[short..], &mut other[..]];
        send_doubled(
            pump,
            window,
            2,
            memory,
            Rgb565::mix_lines,
            |line, pixels| {
                pixels.fill(0x1234);
                if line == ends_at {
                    return Err(ScanError::LinesMissing { line });
                }
                Ok(())
            },
        )
    };
    let whole = Window {
        x: 0,
        y: 0,
        width: 12,
        height: 6,
    };
    for window in [
        Window { width: 0, ..whole },
        Window { height: 0, ..whole },
        Window {
            width: 0x8000,
            ..whole
        },
        Window {
            height: 0x8001,
            ..whole
        },
        Window { x: 0x8000, ..whole },
        Window { y: 0xFFFF, ..whole },
    ] {
        assert_eq!(send(&mut pump, window, 0, 99), Err(ScanError::Empty));
    }
    let short = ScanError::BufferTooShort {
        needed: 12,
        have: 9,
    };
    assert_eq!(send(&mut pump, whole, 3, 99), Err(short));
    assert_eq!(pump.sink().transfers(), 0);
    let shows_all = |pump: &Pump<MockFrameBuffer<u16>>| {
        let mut shown = pump.sink().shown().iter();
        shown.all(|word| *word == Some(0x1234))
    };
    // What draws has its word, at the first line and at the last.
    for line in [0, 3, 5] {
        let missing = ScanError::LinesMissing { line };
        assert_eq!(send(&mut pump, whole, 0, line), Err(missing));
        assert!(!shows_all(&pump));
        pump.sink_mut().next_frame();
    }
    // And so has the sink, whose lines are those that are sent.
    pump.sink_mut().fail_at(6, Fault::Start);
    let failed = send(&mut pump, whole, 0, 99);
    assert!(
        matches!(failed, Err(ScanError::Sink { line: 6, .. })),
        "{failed:?}"
    );
    pump.sink_mut().clear_fault();
    pump.sink_mut().next_frame();
    send(&mut pump, whole, 0, 99).unwrap();
    assert!(shows_all(&pump));
}
