//! The demo writes whole pictures of a teapot, and nothing where it cannot.

use host_tests::args::DemoArgs;
use host_tests::demo::{self, BACKGROUND, HEIGHT, WIDTH};
use host_tests::image_out::{Frame, read_image};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use std::fs::File;
use std::io::BufReader;

const SIZE: (u32, u32) = (WIDTH as u32, HEIGHT as u32);

/// The share of pixels that are not background, in per cent.
fn covered(frame: &Frame) -> usize {
    let background = Rgb565Be::to_rgb8(Rgb565Be::from_rgb8(BACKGROUND));
    let pixels = frame.rgb().chunks_exact(3);
    let count = pixels.len();
    pixels.filter(|pixel| **pixel != background).count() * 100 / count
}

#[test]
fn three_frames_become_three_pictures() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("made/by/the demo");
    let args = DemoArgs {
        output: output.clone(),
        frames: 3,
        ..DemoArgs::default()
    };
    demo::run(&args).unwrap();
    let mut names: Vec<_> = std::fs::read_dir(&output)
        .unwrap()
        .map(|entry| entry.unwrap().file_name())
        .collect();
    names.sort();
    assert_eq!(names, ["strip.png", "teapot.png", "turn.png"]);

    let teapot = read_image(&output.join("teapot.png")).unwrap();
    assert_eq!((teapot.width(), teapot.height()), SIZE);
    assert!((25..45).contains(&covered(&teapot)), "{}", covered(&teapot));
    let border = (0..SIZE.0).flat_map(|x| [(x, 0), (x, SIZE.1 - 1)]);
    for (x, y) in border.chain((0..SIZE.1).flat_map(|y| [(0, y), (SIZE.0 - 1, y)])) {
        assert_eq!(
            teapot.pixel(x, y),
            teapot.pixel(0, 0),
            "cut off at {x}, {y}"
        );
    }

    let strip = read_image(&output.join("strip.png")).unwrap();
    assert_eq!((strip.width(), strip.height()), (3 * SIZE.0, SIZE.1));
    assert!((25..45).contains(&covered(&strip)), "{}", covered(&strip));
    for y in 0..SIZE.1 {
        for x in 0..SIZE.0 {
            assert_eq!(strip.pixel(x, y), teapot.pixel(x, y), "{x}, {y}");
        }
    }

    let file = BufReader::new(File::open(output.join("turn.png")).unwrap());
    let mut reader = png::Decoder::new(file).read_info().unwrap();
    let info = reader.info();
    assert_eq!(info.size(), SIZE);
    assert_eq!(info.animation_control().unwrap().num_frames, 3);
    for number in 0..3 {
        let mut rgb = vec![0; teapot.rgb().len()];
        reader.next_frame(&mut rgb).unwrap();
        let frame = Frame::new(SIZE.0, SIZE.1, rgb).unwrap();
        for y in 0..SIZE.1 {
            let x = SIZE.0 / 2;
            let in_strip = strip.pixel(number * SIZE.0 + x, y);
            assert_eq!(frame.pixel(x, y), in_strip, "frame {number}, {x}, {y}");
        }
    }
}

#[test]
fn the_picture_of_the_readme_is_what_the_demo_draws() {
    let folder = tempfile::tempdir().unwrap();
    let args = DemoArgs {
        output: folder.path().to_path_buf(),
        frames: 1,
        ..DemoArgs::default()
    };
    demo::run(&args).unwrap();
    let drawn = read_image(&folder.path().join("teapot.png")).unwrap();
    let shown = concat!(env!("CARGO_MANIFEST_DIR"), "/pictures/teapot.png");
    assert!(
        read_image(shown.as_ref()).unwrap() == drawn,
        "copy out/teapot.png of the demo to {shown}"
    );
}

#[test]
fn a_file_in_the_way_is_said_in_one_line() {
    let folder = tempfile::tempdir().unwrap();
    let output = folder.path().join("file");
    std::fs::write(&output, "kept").unwrap();
    let args = DemoArgs {
        output: output.clone(),
        frames: 1,
        ..DemoArgs::default()
    };
    let error = demo::run(&args).unwrap_err().to_string();
    assert!(error.contains("file: cannot be made"), "{error}");
    assert_eq!(error.lines().count(), 1);
    assert_eq!(std::fs::read(&output).unwrap(), b"kept");
}
