//! What a scene file says of how pictures lie in memory, of their transparency, of computed texels and of reflections,
//! against the texels themselves: a square over the whole picture shows one on each pixel.

use crate::command_line::Desk;
use crate::scene_files::{at, desk, near, scene, square};
use host_tests::compress::Blocks;
use host_tests::image_out::Frame;
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::{Compressed, Texels};
use serde_json::{Value, json};
use std::fs;

/// Texels a side, and pixels.
const SIDE: usize = 16;
/// What is behind the square.
const BLUE: [u8; 3] = [0, 0, 255];

/// A picture with alphas.
type Picture = [[[u8; 4]; SIDE]; SIDE];

/// By a rule of column and row.
fn picture(texel: impl Fn(usize, usize) -> [u8; 4]) -> Picture {
    std::array::from_fn(|y| std::array::from_fn(|x| texel(x, y)))
}

/// A folder with the squares, one of them blue, and the picture.
fn with(picture: &Picture) -> Desk {
    let desk = desk();
    fs::write(desk.path("blue.obj"), square("0 0 1")).unwrap();
    write(&desk, picture);
    desk
}

fn write(desk: &Desk, picture: &Picture) {
    let file = fs::File::create(desk.path("t.png")).unwrap();
    let mut encoder = png::Encoder::new(file, SIDE as u32, SIDE as u32);
    encoder.set_color(png::ColorType::Rgba);
    encoder.set_depth(png::BitDepth::Eight);
    let mut writer = encoder.write_header().unwrap();
    let bytes: Vec<u8> = picture.iter().flatten().flatten().copied().collect();
    writer.write_image_data(&bytes).unwrap();
}

/// A white square with the picture and more fields, and a blue one that comes later, behind it.
fn over_blue(fields: &Value) -> Value {
    let mut square = json!({ "model": "white.obj", "texture": "t.png" });
    for (name, value) in fields.as_object().unwrap() {
        square[name] = value.clone();
    }
    let behind = json!({ "model": "blue.obj", "place": [0, 0, -1], "scale": 2 });
    scene(json!([square, behind]))
}

fn drawn(desk: &Desk, scene: &Value) -> Frame {
    fs::write(desk.path("s.json"), scene.to_string()).unwrap();
    desk.told("render s.json -o o.png").0
}

fn refused(desk: &Desk, scene: &Value) -> String {
    fs::write(desk.path("s.json"), scene.to_string()).unwrap();
    desk.refused("render s.json -o p.png")
}

/// What 16 bits show of a colour.
fn rounded(rgb: [u8; 3]) -> [u8; 3] {
    Rgb565::to_rgb8(Rgb565::from_rgb8(rgb))
}

/// Holds each pixel against what the texel at its place makes of it, within so many levels.
fn hold(frame: &Frame, picture: &Picture, within: u8, want: impl Fn([u8; 4]) -> [u8; 3]) {
    for (y, row) in picture.iter().enumerate() {
        for (x, texel) in row.iter().enumerate() {
            let (got, want) = (at(frame, x, y), want(*texel));
            let is_near = got.iter().zip(want).all(|(a, b)| a.abs_diff(b) <= within);
            assert!(is_near, "({x}, {y}), {texel:?}: {got:?}, not {want:?}");
        }
    }
}

/// Of a block of 4 x 4 texels two colours, 14 in all, black among them, each opaque or not.
fn holed() -> Picture {
    picture(|x, y| {
        let block = y / 4 * 4 + x / 4;
        let colour = (2 * (block % 7) + (x ^ y) % 2) as u8;
        let alpha = [0, 127, 128, 255][(3 * x + y) % 4];
        [
            (colour * 16) & 0xF8,
            (colour % 3) * 124,
            255 * (colour % 2),
            alpha,
        ]
    })
}

/// Kills: alphas of 128 that are holes, or of 127 that are not; a key that is a colour of the picture; holes that keep
/// their depth; a form that is not what the file says; alphas that count where nothing is said of them.
#[test]
fn texels_that_are_clear_are_holes_in_all_forms() {
    let picture = holed();
    let desk = with(&picture);
    for (form, fields) in [
        ("words", json!({})),
        ("palette", json!({ "texel_form": "palette" })),
        ("compressed", json!({ "texel_form": "compressed" })),
        (
            "cached",
            json!({ "texel_form": "compressed", "cached": true }),
        ),
    ] {
        let opaque = drawn(&desk, &over_blue(&fields));
        let within = if form == "words" { 0 } else { 1 };
        hold(&opaque, &picture, within, |[r, g, b, _]| rounded([r, g, b]));
        let mut fields = fields;
        fields["texels"] = json!("cutout");
        let cut = drawn(&desk, &over_blue(&fields));
        hold(&cut, &picture, within, |[r, g, b, alpha]| {
            match alpha < 128 {
                true => BLUE,
                false => rounded([r, g, b]),
            }
        });
    }
    // Where texels are not transparent a decal hides the colour.
    let decal = json!({ "model": "red.obj", "application": "decal", "texels": "cutout" });
    let decal = drawn(&desk, &over_blue(&decal));
    hold(&decal, &picture, 0, |[r, g, b, alpha]| match alpha < 128 {
        true => [255, 0, 0],
        false => rounded([r, g, b]),
    });
}

/// Kills: the alpha of the object or of the texel alone, colours of another texel than the alpha, a palette by colours
/// without their alphas.
#[test]
fn texels_have_alphas_in_the_blend() {
    let picture = picture(|x, y| {
        let n = (x / 2 + 3 * (y / 3)) % 14;
        [
            (n * 16) as u8 & 0xF8,
            132,
            (n % 2 * 255) as u8,
            (n / 2 * 40) as u8,
        ]
    });
    let desk = with(&picture);
    for form in ["words", "palette"] {
        for (blend, own) in [("filter", 255), ("filter", 120), ("add", 200)] {
            let fields = json!({
                "texels": "alpha", "texel_form": form, "blend": blend, "alpha": own,
            });
            let frame = drawn(&desk, &over_blue(&fields));
            hold(&frame, &picture, 2, |[r, g, b, alpha]| {
                let part = f64::from(alpha) * f64::from(own) / (255.0 * 255.0);
                let left = if blend == "add" { 1.0 } else { 1.0 - part };
                let [new, old] = [rounded([r, g, b]), BLUE].map(|c| c.map(f64::from));
                [0, 1, 2].map(|i| (new[i] * part + old[i] * left).round().min(255.0) as u8)
            });
        }
    }
}

/// Kills: another compressor, levels in place of the picture, blocks in another order; a cache that is made and not
/// read, or read and not counted.
#[test]
fn blocks_are_those_of_the_compressor_and_come_through_the_cache() {
    let picture = picture(|x, y| [(x * 16) as u8, (y * 16) as u8, (x * y) as u8, 255]);
    let desk = with(&picture);
    let texels: Vec<_> = (picture.iter().flatten())
        .map(|[r, g, b, _]| Some([*r, *g, *b]))
        .collect();
    let blocks = Blocks::new([SIDE as u32; 2], &texels).unwrap();
    let blocks = Compressed::new(&blocks.bytes, 16, 16, |number| number).unwrap();
    let plain = drawn(&desk, &over_blue(&json!({})));
    for cached in [false, true] {
        let mut fields = json!({ "texel_form": "compressed" });
        if cached {
            fields["cached"] = json!(true);
        }
        let scene = over_blue(&fields);
        fs::write(desk.path("s.json"), scene.to_string()).unwrap();
        let frame = desk.told("render s.json -o o.png --stats s.txt").0;
        for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
            let want = Rgb565::to_rgb8(blocks.texel(x as u16, y as u16));
            assert_eq!(at(&frame, x, y), want, "({x}, {y})");
        }
        assert!(frame != plain);
        let stats = fs::read_to_string(desk.path("s.txt")).unwrap();
        let stats: Value = serde_json::from_str(&stats).unwrap();
        let cache = &stats["texel_cache"];
        assert_eq!(cache.is_null(), !cached);
        if cached {
            assert_eq!(
                (&cache["reads"], &cache["misses"]),
                (&json!(256), &json!(16))
            );
        }
    }
}

/// Kills: 17 colours that are taken, 16 that are not; colours between those of the palette where the picture is small.
#[test]
fn palettes_have_sixteen_colours() {
    let colours = |count: usize| picture(|x, y| [((x + y * 16) % count * 15) as u8, 0, 255, 255]);
    let palette = json!({ "texel_form": "palette" });
    let desk = with(&colours(17));
    let line = refused(&desk, &over_blue(&palette));
    let want = "s.json: object 0: its picture has 17 colours, and `texel_form` palette 16 at most";
    assert!(line.contains(want), "{line}");
    let picture = colours(16);
    write(&desk, &picture);
    let whole = drawn(&desk, &over_blue(&palette));
    hold(&whole, &picture, 0, |[r, g, b, _]| rounded([r, g, b]));
    // A quarter of the size: the level below the one below, by colours of the palette.
    let mut small = palette.clone();
    small["scale"] = json!(0.25);
    let words = drawn(&desk, &over_blue(&json!({ "scale": 0.25 })));
    let frame = drawn(&desk, &over_blue(&small));
    let is_listed = |pixel: [u8; 3]| {
        let listed = picture[0].map(|[r, g, b, _]| rounded([r, g, b]));
        listed.contains(&pixel)
    };
    let all = (6..10).flat_map(|y| (6..10).map(move |x| (x, y)));
    assert!(all.clone().all(|(x, y)| is_listed(at(&frame, x, y))));
    assert!(!all.clone().all(|(x, y)| is_listed(at(&words, x, y))));
    // Near the means all the same.
    for (x, y) in all {
        let [got, want] = [&frame, &words].map(|frame| at(frame, x, y));
        assert!(
            got[0].abs_diff(want[0]) <= 16,
            "({x}, {y}): {got:?}, {want:?}"
        );
    }
}

/// Kills: the other colour first, sides of half the size, rows for columns, a way back that is missing.
#[test]
fn computed_texels_are_squares_and_gradients() {
    let desk = with(&holed());
    let computed = |computed: Value| {
        let object = json!({ "model": "white.obj", "computed": computed });
        drawn(&desk, &scene(json!([object])))
    };
    let colours = [[248, 0, 0], [0, 252, 248]];
    for side in [2, 4] {
        let squares = json!({ "size": [16, 16], "colours": colours, "side": side });
        let frame = computed(json!({ "squares": squares }));
        for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
            let want = rounded(colours[(x / side + y / side) % 2]);
            assert_eq!(at(&frame, x, y), want, "({x}, {y})");
        }
    }
    for length in [8, 16] {
        let ramp =
            json!({ "size": [16, 8], "from": [0, 0, 248], "to": [248, 0, 0], "length": length });
        let frame = computed(json!({ "gradient": ramp }));
        for (x, y) in (0..SIDE).flat_map(|y| (0..SIDE).map(move |x| (x, y))) {
            let way = (x as f64 + 0.5) / length as f64;
            let part = way.min(2.0 - way) * 248.0;
            let got = at(&frame, x, y);
            let off = [got[0], got[2]].map(f64::from);
            let is_near = (off[0] - part).abs() < 7.0 && (off[1] - (248.0 - part)).abs() < 7.0;
            assert!(is_near, "({x}, {y}): {got:?}, not {part}");
        }
    }
    let bare = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nf 1 2 3\n";
    fs::write(desk.path("bare.obj"), bare).unwrap();
    let squares = json!({ "squares": { "size": [8, 8], "colours": colours, "side": 2 } });
    let object = json!({ "model": "bare.obj", "computed": squares });
    assert!(refused(&desk, &scene(json!([object]))).contains("no texture places"));
}

/// A square that is turned shows all over it the texel that its normal names. Kills: places of the file, normals that do
/// not turn with the object, columns for rows, a sphere map that is upside down.
#[test]
fn reflections_are_where_normals_point() {
    let picture = picture(|x, y| [(x * 16) as u8, (y * 16) as u8, 0, 255]);
    let desk = with(&picture);
    let bare = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvn 0 0 1\nf 1//1 2//1 3//1 4//1\n";
    fs::write(desk.path("bare.obj"), bare).unwrap();
    for turn in [
        [0.0, 0.0],
        [0.0, 30.0],
        [0.0, -50.0],
        [40.0, 0.0],
        [-25.0, 0.0],
    ] {
        for model in ["white.obj", "bare.obj"] {
            let object = json!({
                "model": model, "texture": "t.png", "reflection": true, "levels": false,
                "turn": [turn[0], turn[1], 0], "scale": 2,
            });
            let mut scene = scene(json!([object]));
            scene["camera"]["eye"] = json!([0, 0, 9]);
            let [up, right] = [turn[0], turn[1]].map(|angle: f64| angle.to_radians().sin());
            // Turned about x the normal goes down, and rows count from the top.
            let texel = [right, up].map(|part| (8.0 + part * 7.5) as usize);
            let [r, g, b, _] = picture[texel[1]][texel[0]];
            assert_eq!(
                at(&drawn(&desk, &scene), 8, 8),
                rounded([r, g, b]),
                "{turn:?}"
            );
        }
    }
}

/// Kills: what is said of transparency where there is none, and what needs pictures without one.
#[test]
fn what_is_said_in_vain_of_texels_is_named() {
    let desk = with(&picture(|_, _| [8, 8, 8, 255]));
    let line = refused(&desk, &over_blue(&json!({ "texels": "cutout" })));
    assert!(
        line.contains("s.json: object 0: `texels` needs a picture"),
        "{line}"
    );
    for (name, value) in [
        ("texels", json!("cutout")),
        ("texel_form", json!("palette")),
        ("reflection", json!(true)),
    ] {
        let mut object = json!({ "model": "red.obj" });
        object[name] = value;
        let line = refused(&desk, &scene(json!([object])));
        assert!(
            line.contains(&format!("object 0: `{name}` needs `texture`")),
            "{line}"
        );
    }
    assert!(near(
        at(&drawn(&desk, &over_blue(&json!({}))), 8, 8),
        [8, 8, 8]
    ));
}
