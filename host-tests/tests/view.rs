//! `view`: printed frames are the crate's pictures, keys change what they say, and without a
//! terminal there is one clear line.

use host_tests::args::{self, Command, PixelFormatArg, QualityArg, ViewArgs};
use host_tests::image_out::Frame;
use host_tests::model::Model;
use host_tests::reference::Shade;
use host_tests::view::{Colours, KEYS, Scenery, State, Step, half_blocks, nearest};
use std::path::Path;
use std::process;

use crossterm::event::KeyCode;

/// A pyramid of four colours, off the origin, with a hidden side from everywhere.
const OBJ: &str = "v 9 -1 1 1 0 0\nv 11 -1 1 0 1 0\nv 10 -1 -1 0 0 1\nv 10 1 0 1 1 0\n\
                   f 1 2 4\nf 2 3 4\nf 3 1 4\nf 1 3 2\n";

fn model() -> Model {
    Model::from_obj_text(OBJ, Path::new("m.obj")).unwrap()
}

fn flags(line: &str) -> ViewArgs {
    let words = ["scanbeam", "view"].into_iter().chain(line.split(' '));
    match args::parse(words) {
        Ok(Command::View(view)) => view,
        other => panic!("{other:?}"),
    }
}

/// Reads half blocks back into pixels: a terminal for the two colours and nothing else.
fn pixels_of(text: &str) -> (usize, Vec<[u8; 3]>) {
    let (mut width, mut pixels) = (0, Vec::new());
    for line in text.lines() {
        let (mut colours, mut rows) = ([[0; 3]; 2], [Vec::new(), Vec::new()]);
        let mut parts = line.split('\x1b');
        assert_eq!(parts.next(), Some(""));
        for part in parts {
            let (code, shown) = part.split_once('m').expect("a colour ends with m");
            let numbers: Vec<u8> = code[1..].split(';').map(|n| n.parse().unwrap()).collect();
            match numbers[..] {
                [38, 2, r, g, b] => colours[0] = [r, g, b],
                [48, 2, r, g, b] => colours[1] = [r, g, b],
                [0] => assert_eq!(shown, ""),
                _ => panic!("{code}"),
            }
            for block in shown.chars() {
                assert_eq!(block, '\u{2580}');
                rows[0].push(colours[0]);
                rows[1].push(colours[1]);
            }
        }
        width = rows[0].len();
        pixels.extend(rows.concat());
    }
    (width, pixels)
}

#[test]
fn blocks_are_the_pixels_of_any_picture() {
    let mut seed = 7u32;
    for (width, height) in [(1, 1), (1, 2), (5, 3), (17, 8), (40, 21)] {
        let mut rgb = vec![0; width * height * 3];
        for pixel in rgb.chunks_exact_mut(3) {
            // Few colours, so that runs of one colour are among them.
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            pixel.fill((seed >> 30) as u8 * 85);
        }
        let frame = Frame::new(width as u32, height as u32, rgb.clone()).unwrap();
        let (cells, mut pixels) = pixels_of(&half_blocks(&frame, Colours::True).join("\n"));
        assert_eq!(cells, width);
        if height % 2 == 1 {
            let last = pixels.split_off(width * height);
            assert_eq!(last, vec![[0; 3]; width]);
        }
        assert_eq!(pixels.concat(), rgb, "{width}x{height}");
    }
}

/// Of the 240 colours that are the same everywhere, the one that is said is the nearest.
#[test]
fn the_nearest_of_256_colours_is_taken() {
    let level = |i: u32| if i == 0 { 0 } else { 55 + 40 * i };
    let cube = (0..216).map(|i| [i / 36, i / 6 % 6, i % 6].map(level));
    let greys = (0..24).map(|i| [8 + 10 * i; 3]);
    let palette: Vec<[u32; 3]> = cube.chain(greys).collect();
    let mut seed = 1u32;
    for _ in 0..20_000 {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        let colour = [seed >> 24, seed >> 16 & 255, seed >> 8 & 255];
        let off =
            |other: [u32; 3]| -> u32 { (0..3).map(|i| colour[i].abs_diff(other[i]).pow(2)).sum() };
        let least = palette.iter().map(|&other| off(other)).min();
        let said = usize::from(nearest(colour.map(|level| level as u8)) - 16);
        assert_eq!(Some(off(palette[said])), least, "{colour:?}");
    }
}

#[test]
fn keys_change_the_state_and_the_picture() {
    let model = model();
    let scenery = Scenery::new(&model).unwrap();
    let start = State::new(&flags("m.obj"));
    let picture = |state: &State| scenery.frame(state, 60, 40).unwrap();
    let first = picture(&start);
    let after = |keys: &str| {
        let mut state = start.clone();
        for key in keys.chars() {
            let key = match key {
                '<' => KeyCode::Left,
                '>' => KeyCode::Right,
                '^' => KeyCode::Up,
                'v' => KeyCode::Down,
                other => KeyCode::Char(other),
            };
            assert_eq!(state.key(key), Step::On);
        }
        state
    };
    // What moves the eye or the colours changes the picture.
    for keys in [">", "<", "^", "v", "+", "-", "s", "ss", "f"] {
        assert_ne!(picture(&after(keys)).frame, first.frame, "{keys}");
    }
    // What is there and back again does not.
    for keys in ["<>", "^v", "sss", "qqq", "ff", "  ", "?"] {
        let (state, what) = (after(keys), keys);
        assert_eq!(picture(&state).frame, first.frame, "{what}");
        assert_eq!(state.choices(), start.choices(), "{what}");
    }
    // What only makes it cheaper does not either, and is said.
    for keys in ["c", "cc", "r", "rrr", "crcr"] {
        let state = after(keys);
        assert_eq!(picture(&state).frame, first.frame, "{keys}");
        assert_ne!(state.choices(), start.choices(), "{keys}");
    }
    assert_eq!(after("q").quality, QualityArg::Exact);
    assert_eq!(after("s").shade, Shade::None);
    assert_eq!(after("f").format, PixelFormatArg::Rgb888);
    assert_eq!((after("c").slots, after("cc").slots), (224, 0));
    assert_eq!((after("r").renderers, after("rrrr").renderers), (2, 1));
    for end in [KeyCode::Esc, KeyCode::Char('x')] {
        assert_eq!(start.clone().key(end), Step::End);
    }
    let (mut still, mut turned) = (after(" "), start.clone());
    still.spin(1.0);
    turned.spin(1.0);
    assert_eq!(still.yaw, start.yaw);
    assert_ne!(picture(&turned).frame, first.frame);
    // Every key that is told of is one that does something.
    for key in [
        "q quality",
        "s shading",
        "c cache",
        "r renderers",
        "f format",
    ] {
        assert!(KEYS.contains(key), "{key}");
        assert_ne!(after(&key[..1]), start);
    }
}

#[test]
fn the_whole_model_is_seen_from_everywhere() {
    let model = model();
    let scenery = Scenery::new(&model).unwrap();
    let mut state = State::new(&flags("m.obj --shade none --format rgb888"));
    for (width, height) in [(60, 40), (20, 60), (90, 10)] {
        for turn in 0..24 {
            let key = if turn % 5 < 3 {
                KeyCode::Up
            } else {
                KeyCode::Right
            };
            assert_eq!(state.key(key), Step::On);
            let shown = scenery.frame(&state, width, height).unwrap();
            assert_eq!(shown.used.assembled.clipped, 0);
            let (w, rgb) = (width as usize, shown.frame.rgb());
            let pixel = |x: usize, y: usize| &rgb[3 * (y * w + x)..][..3];
            let back = pixel(0, 0);
            for x in 0..w {
                assert_eq!((pixel(x, 0), pixel(x, height as usize - 1)), (back, back));
            }
            for y in 0..height as usize {
                assert_eq!((pixel(0, y), pixel(w - 1, y)), (back, back));
            }
            assert!(rgb.chunks_exact(3).any(|pixel| pixel != back));
        }
    }
}

fn run(folder: &Path, line: &str) -> process::Output {
    process::Command::new(env!("CARGO_BIN_EXE_scanbeam"))
        .args(line.split(' '))
        .current_dir(folder)
        .stdin(process::Stdio::null())
        .output()
        .unwrap()
}

#[test]
fn frames_are_printed_and_nothing_live_without_a_terminal() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.obj"), OBJ).unwrap();
    let output = run(folder.path(), "view m.obj --frames 3 --size 50x30");
    assert!(output.status.success());
    let text = String::from_utf8(output.stdout).unwrap();
    let lines: Vec<&str> = text.lines().collect();
    assert_eq!(lines.len(), 3 * (15 + 2));
    // The pictures are those that the states in between draw.
    let model = model();
    let scenery = Scenery::new(&model).unwrap();
    let mut state = State::new(&flags("m.obj"));
    for printed in lines.chunks(17) {
        let shown = scenery.frame(&state, 50, 30).unwrap();
        let (width, pixels) = pixels_of(&printed[..15].join("\n"));
        assert_eq!((width, pixels.concat()), (50, shown.frame.rgb().to_vec()));
        assert_eq!(printed[15], state.choices());
        assert_eq!(printed[16], shown.figures());
        assert!(printed[16].contains("no slot") && printed[16].contains("left out"));
        state.spin(std::f64::consts::TAU / 64.0);
    }

    // Without a model it is the teapot.
    let output = run(folder.path(), "view --frames 1 --size 8x4 --colours 256");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("of 2256 triangles") && text.contains("\x1b[38;5;"));

    for (line, said) in [
        ("view m.obj", "--frames"),
        ("view none.obj", "none.obj"),
        ("view m.obj --frames 0", "0"),
        ("view --size 2000x10", "1024"),
        ("view --colours 8", "256"),
        ("view m.obj --renderers 17", "17"),
    ] {
        let output = run(folder.path(), line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(output.stdout.is_empty(), "{line}");
        assert_eq!(text.lines().count(), 1, "{line}: {text}");
        assert!(text.contains(said), "{line}: {text}");
    }
}
