//! What is written is read, and errors leave nothing.

use host_support::image_out::{
    Frame, Staged, encode_image, read_image, write_animation, write_image, write_strip,
};
use std::io::Cursor;
use std::path::Path;

fn frame(width: u32, height: u32, seed: u8) -> Frame {
    let count = width * height * 3;
    let rgb = (0..count).map(|i| (i as u8).wrapping_mul(7) ^ seed);
    Frame::new(width, height, rgb.collect()).unwrap()
}

fn names(folder: &Path) -> Vec<String> {
    let entries = std::fs::read_dir(folder).unwrap();
    let mut names: Vec<_> = entries
        .map(|entry| entry.unwrap().file_name().into_string().unwrap())
        .collect();
    names.sort();
    names
}

#[test]
fn what_is_written_is_read() {
    let folder = tempfile::tempdir().unwrap();
    for (width, height) in [(1, 1), (5, 3), (320, 2), (1, 40)] {
        for name in ["a.png", "a.ppm", "A.PNG"] {
            let path = folder.path().join(name);
            let picture = frame(width, height, 3);
            write_image(&path, &picture).unwrap();
            assert_eq!(read_image(&path).unwrap(), picture);
        }
    }
    assert_eq!(names(folder.path()), ["A.PNG", "a.png", "a.ppm"]);
}

#[test]
fn a_strip_holds_the_frames_side_by_side() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("s.png");
    let frames = [frame(3, 2, 1), frame(2, 2, 2), frame(4, 2, 3)];
    write_strip(&path, &frames).unwrap();
    let strip = read_image(&path).unwrap();
    assert_eq!((strip.width(), strip.height()), (9, 2));
    assert_eq!(strip.pixel(2, 1), frames[0].pixel(2, 1));
    assert_eq!(strip.pixel(3, 1), frames[1].pixel(0, 1));
    assert_eq!(strip.pixel(8, 0), frames[2].pixel(3, 0));
    assert_eq!(strip.pixel(9, 0), None);
    assert_eq!(strip.pixel(0, 2), None);
    for bad in [&[][..], &[frame(1, 1, 0), frame(1, 2, 0)]] {
        assert!(write_strip(&path, bad).is_err());
    }
    assert_eq!(read_image(&path).unwrap(), strip, "left as it was");
}

#[test]
fn an_animation_holds_all_frames() {
    let folder = tempfile::tempdir().unwrap();
    let path = folder.path().join("a.png");
    let frames = [frame(6, 4, 1), frame(6, 4, 2), frame(6, 4, 3)];
    write_animation(&path, &frames, 40).unwrap();
    assert_eq!(read_image(&path).unwrap(), frames[0]);
    let bytes = std::fs::read(&path).unwrap();
    let mut reader = png::Decoder::new(Cursor::new(bytes)).read_info().unwrap();
    assert_eq!(reader.info().animation_control().unwrap().num_frames, 3);
    for frame in &frames {
        let mut data = vec![0; frame.rgb().len()];
        reader.next_frame(&mut data).unwrap();
        assert_eq!(data, frame.rgb());
    }
    assert!(write_animation(&folder.path().join("a.ppm"), &frames, 40).is_err());
    assert!(write_animation(&path, &[], 40).is_err());
    assert!(write_animation(&path, &[frame(1, 1, 0), frame(1, 2, 0)], 40).is_err());
}

#[test]
fn an_error_leaves_nothing() {
    let folder = tempfile::tempdir().unwrap();
    for name in ["x.bmp", "x", "png", ".png", "no/such/x.png"] {
        let error = write_image(&folder.path().join(name), &frame(2, 2, 0)).unwrap_err();
        assert_eq!(error.to_string().lines().count(), 1, "{error}");
    }
    std::fs::create_dir(folder.path().join("d.png")).unwrap();
    assert!(write_image(&folder.path().join("d.png"), &frame(2, 2, 0)).is_err());
    assert_eq!(names(folder.path()), ["d.png"]);
}

/// A folder in the place of the second, made after that is staged, refuses it. Kills: the first left in its place; what
/// was there before lost; a name that is left beside.
#[test]
fn of_two_files_there_are_both_or_none() {
    let folder = tempfile::tempdir().unwrap();
    let [first, second] = ["s.json", "o.png"].map(|name| folder.path().join(name));
    let staged = || [&first, &second].map(|path| Staged::new(path, b"new").unwrap());
    for old in [None, Some("old")] {
        old.iter()
            .for_each(|old| std::fs::write(&first, old).unwrap());
        let [a, b] = staged();
        std::fs::create_dir(&second).unwrap();
        let error = a.commit_with(b).unwrap_err();
        assert_eq!(error.file, second);
        assert_eq!(std::fs::read_to_string(&first).ok().as_deref(), old);
        std::fs::remove_dir(&second).unwrap();
        assert_eq!(names(folder.path()).len(), old.iter().count());
    }
    // The first is refused: the second is not there.
    let [a, b] = staged();
    std::fs::remove_file(&first).unwrap();
    std::fs::create_dir_all(first.join("full")).unwrap();
    assert_eq!(a.commit_with(b).unwrap_err().file, first);
    assert_eq!(names(folder.path()), ["s.json"]);
    std::fs::remove_dir_all(&first).unwrap();
    let [a, b] = staged();
    a.commit_with(b).unwrap();
    assert_eq!(names(folder.path()), ["o.png", "s.json"]);
}

#[test]
fn bad_pictures_are_refused() {
    let folder = tempfile::tempdir().unwrap();
    let good = encode_image(Path::new("c.png"), &frame(9, 9, 0)).unwrap();
    let mut cases: Vec<(&str, Vec<u8>)> = (0..good.len() - 16)
        .map(|length| ("c.png", good[..length].to_vec()))
        .collect();
    for text in [
        "",
        "P6",
        "P6\n",
        "P6 1 1 255",
        "P6 1 1 255\n12",
        "P6 0 1 255\n",
        "P6 2 2 254\n123456789012",
        "P5 1 1 255\n123",
        "P6 99999999999 1 255\n",
        "P6 65536 65536 255\n",
        "P6 -1 1 255\n123",
        "P6 # no end",
    ] {
        cases.push(("c.ppm", text.as_bytes().to_vec()));
    }
    for (name, bytes) in cases {
        let path = folder.path().join(name);
        std::fs::write(&path, &bytes).unwrap();
        assert!(read_image(&path).is_err(), "{name} {bytes:?}");
    }
    assert!(read_image(&folder.path().join("none.png")).is_err());
    let path = folder.path().join("c.ppm");
    std::fs::write(&path, b"P6 # c\n1 #\n1 255\nabc!").unwrap();
    assert_eq!(read_image(&path).unwrap().rgb(), b"abc");
    assert!(Frame::new(1, 1, vec![0; 4]).is_none());
    assert!(Frame::new(0, 1, vec![]).is_none());
    assert!(Frame::new(u32::MAX, u32::MAX, vec![]).is_none());
}
