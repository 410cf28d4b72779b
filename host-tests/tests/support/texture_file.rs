//! Pictures of any size become textures, and say what was done to them.

use host_support::image_out::write_image;
use host_support::image_out::{Cutout, Frame};
use host_support::model::Model;
use host_support::texture_file::*;

fn frame(width: u32, height: u32) -> Frame {
    let rgb = (0..height)
        .flat_map(|y| (0..width).flat_map(move |x| [x as u8, y as u8, (x * y) as u8]))
        .collect();
    Frame::new(width, height, rgb).expect("the size is legal")
}

#[test]
fn powers_of_two_are_taken_as_they_are() {
    let frame = frame(64, 16);
    let made = TextureImage::new(&frame).expect("it is a picture");
    assert_eq!(made.note, None);
    for y in 0..16 {
        for x in 0..64 {
            let texel = made.levels[0][(y * 64 + x) as usize];
            assert_eq!(Some(texel), frame.pixel(x, y));
        }
    }
    assert_eq!(made.levels.each_ref().map(Vec::len), [1024, 256, 64, 16]);
    assert_eq!(made.texels([0.0, 1.0]), (0, 0));
    assert_eq!(made.texels([0.5, 0.25]), (32 << 8, 12 << 8));
}

#[test]
fn other_sizes_grow_to_the_next_and_say_so() {
    let made = TextureImage::new(&frame(100, 33)).expect("it is a picture");
    assert_eq!((made.width, made.height), (128, 64));
    let note = made.note.expect("it was resized");
    assert!(note.contains("100x33") && note.contains("128x64"), "{note}");
    // A ramp stays a ramp, within the rounding.
    for x in 2..126u32 {
        let want = ((f64::from(x) + 0.5) * 100.0 / 128.0 - 0.5).clamp(0.0, 99.0);
        let got = made.levels[0][(20 * 128 + x) as usize][0];
        assert!((f64::from(got) - want).abs() <= 0.51, "{x}: {got}, {want}");
    }
}

#[test]
fn too_large_ones_are_averaged() {
    let wide = Frame::new(
        4096,
        1,
        (0..4096 * 3).map(|i| (i / 3 % 4 * 80) as u8).collect(),
    );
    let made = TextureImage::new(&wide.expect("it is legal")).expect("it is a picture");
    assert_eq!((made.width, made.height), (1024, 1));
    assert!(made.levels[0].iter().all(|texel| *texel == [120; 3]));
    // What falls on a texel adds up to one of it.
    for width in [1500, 7, 1, 8191] {
        let plain = Frame::new(width, 1, vec![201; 3 * width as usize]);
        let made = TextureImage::new(&plain.expect("it is legal")).expect("it is a picture");
        assert!(made.levels[0].iter().all(|texel| *texel == [201; 3]));
    }
}

/// Kills: means of the wrong texels, means rounded down, a side of one texel that is halved.
#[test]
fn levels_are_means_of_two_by_two() {
    for (width, height) in [(16, 8), (1, 4), (2, 1), (1, 1)] {
        let made = TextureImage::new(&frame(width, height)).expect("it is a picture");
        for level in 1..LEVELS {
            let [above, below] = [level - 1, level].map(|level| made.sides(level));
            let texels = &made.levels[level];
            assert_eq!(texels.len(), (below[0] * below[1]) as usize);
            for (i, texel) in (0u32..).zip(texels) {
                let sides = [0, 1].map(|axis| {
                    let at = [i % below[0], i / below[0]][axis];
                    let each = above[axis] / below[axis];
                    at * each..(at + 1) * each
                });
                let [columns, lines] = sides;
                let all = lines.flat_map(|y| columns.clone().map(move |x| (x, y)));
                let all: Vec<[u8; 3]> = all
                    .map(|(x, y)| made.levels[level - 1][(y * above[0] + x) as usize])
                    .collect();
                let mean = [0, 1, 2].map(|c| {
                    let sum: f64 = all.iter().map(|texel| f64::from(texel[c])).sum();
                    (sum / all.len() as f64 + 0.5).floor() as u8
                });
                assert_eq!(*texel, mean, "{width}x{height}, level {level}, {i}");
            }
        }
    }
}

/// Kills: alphas that are dropped, or not resized; what is clear in the levels; other levels of what is opaque.
#[test]
fn levels_with_alpha_show_what_is_seen() {
    let opaque = TextureImage::new(&frame(16, 8)).expect("it is a picture");
    for (level, texels) in opaque.levels_with_alpha(LEVELS).iter().enumerate() {
        let plain = opaque.levels[level]
            .iter()
            .map(|[r, g, b]| [*r, *g, *b, 255]);
        assert!(plain.eq(texels.iter().copied()), "level {level}");
    }
    // Red where it is clear; columns of 0, 255, 100, 200, and again.
    let alphas = [0, 255, 100, 200];
    let rgb = (0..8 * 4).flat_map(|i| match i % 4 {
        0 => [255, 0, 0],
        n => [0, 40 * n as u8, 0],
    });
    let picture = Cutout {
        frame: Frame::new(8, 4, rgb.collect()).expect("it is legal"),
        alpha: Some((0..8 * 4).map(|i| alphas[i % 4]).collect()),
    };
    let made = TextureImage::of(&picture).expect("it is a picture");
    let levels = made.levels_with_alpha(2);
    assert_eq!(levels.len(), 2);
    assert_eq!(levels[0][..2], [[255, 0, 0, 0], [0, 40, 0, 255]]);
    // (80 x 100 + 120 x 200) / 300.
    assert_eq!(levels[1][..2], [[0, 40, 0, 128], [0, 107, 0, 150]]);
    let wide = Cutout {
        frame: Frame::new(3, 1, vec![9; 9]).expect("it is legal"),
        alpha: Some(vec![0, 0, 255]),
    };
    let alpha = TextureImage::of(&wide).expect("it is a picture").alpha;
    let alpha = alpha.expect("it is not opaque");
    assert!(
        alpha.len() == 4 && alpha[0] == 0 && alpha[3] > 200,
        "{alpha:?}"
    );
}

#[test]
fn missing_and_broken_files_are_named_in_one_line() {
    let folder = tempfile::tempdir().expect("there is room");
    let missing = folder.path().join("no.png");
    let broken = folder.path().join("broken.png");
    std::fs::write(&broken, b"not a picture").expect("there is room");
    let strange = folder.path().join("picture.gif");
    for path in [&missing, &broken, &strange] {
        let error = TextureImage::load(path)
            .expect_err("no picture")
            .to_string();
        assert!(
            error.contains(path.to_str().expect("it is UTF-8")),
            "{error}"
        );
        assert_eq!(error.lines().count(), 1, "{error}");
    }
}

#[test]
fn materials_bring_their_pictures() {
    let folder = tempfile::tempdir().expect("there is room");
    let at = |name: &str| folder.path().join(name);
    write_image(&at("a b.png"), &frame(20, 8)).expect("there is room");
    let mtl = "newmtl one\nmap_Kd a b.png\nnewmtl plain\nnewmtl two\nmap_Kd a b.png\n";
    std::fs::write(at("m.mtl"), mtl).expect("there is room");
    let obj = "mtllib m.mtl\nv 0 0 0\nv 1 0 0\nv 0 1 0\nusemtl one\nf 1 2 3\n";
    std::fs::write(at("m.obj"), obj).expect("there is room");
    let model = Model::load(&at("m.obj")).expect("it is a model");
    let textures = of_materials(&model).expect("the picture is there");
    assert_eq!(textures.len(), 3);
    assert_eq!(textures[1], None);
    let image = textures[0].as_ref().expect("it has one");
    assert_eq!((image.width, image.height), (32, 8));
    assert_eq!(textures[0], textures[2]);
    std::fs::remove_file(at("a b.png")).expect("it is there");
    let error = of_materials(&model).expect_err("it is gone").to_string();
    assert!(error.contains("a b.png"), "{error}");
}
