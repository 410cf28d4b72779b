//! What a scene file says of texels: each field against `render` with the flag that says the same of a model, bit by bit,
//! or against the texels themselves.

use crate::command_line::Desk;
use crate::scene_files::{at, desk, drawn, scene};
use crate::texture_cli::ROUNDED;
use host_tests::image_out::{Frame, write_image};
use serde_json::{Value, json};
use std::fs;

/// A floor that goes away to the horizon, about the origin, with a picture of squares and ramps many times on it.
fn floor() -> Desk {
    let desk = desk();
    let corners = "v -2 -1 2\nv 2 -1 2\nv 2 1 -2\nv -2 1 -2\n";
    let places = "vt 0 0\nvt 6 0\nvt 6 8\nvt 0 8\n";
    let floor = format!("{corners}{places}f 1/1 2/2 3/3 4/4\n");
    fs::write(desk.path("floor.obj"), floor).unwrap();
    let texel = |x: u32, y: u32| {
        let square = if (x ^ y) & 4 == 0 { 200 } else { 60 };
        [square, (8 * x) as u8, (8 * y) as u8]
    };
    let texels = (0..32).flat_map(|y| (0..32).flat_map(move |x| texel(x, y)));
    let picture = Frame::new(32, 32, texels.collect()).unwrap();
    write_image(&desk.path("p.png"), &picture).unwrap();
    desk
}

/// The floor of a file with more fields.
fn with(fields: &Value) -> Value {
    let mut floor = json!({ "model": "floor.obj", "texture": "p.png" });
    for (name, value) in fields.as_object().unwrap() {
        floor[name] = value.clone();
    }
    let mut scene = scene(json!([floor]));
    scene["size"] = json!([80, 60]);
    scene["camera"] = json!({ "eye": [0.5, 1, 3], "at": [0, 0, 0], "fov": 60 });
    scene
}

/// A field and a flag that say the same draw the same picture, which is another than without them. Kills: a field that
/// is read and forgotten, that of another object, fast for exact, levels that are always there.
#[test]
fn texels_are_taken_as_with_flags() {
    let desk = floor();
    let plain = drawn(&desk, &with(&json!({})));
    let view = "--texture p.png --size 80x60 --eye 0.5,1,3 --fov 60";
    let of_flag = |flag: &str| {
        let (frame, said) = desk.told(&format!("render floor.obj -o o.png {view} {flag}"));
        assert_eq!(said, ROUNDED);
        frame
    };
    assert!(plain == of_flag(""));
    for (field, flag) in [
        (json!({ "filter": "bilinear" }), "--filter bilinear"),
        (json!({ "levels": false }), "--levels off"),
        (
            json!({ "quality": "fast", "levels": false }),
            "--quality fast --levels off",
        ),
        (
            json!({ "quality": "exact", "levels": false }),
            "--quality exact --levels off",
        ),
    ] {
        let said = drawn(&desk, &with(&field));
        assert!(said == of_flag(flag), "{field}");
        assert!(said != plain, "{field}");
    }
    // What is said when nothing is, and places that differ by quality alone.
    let said = json!({ "filter": "nearest", "levels": true, "quality": "balanced" });
    assert!(drawn(&desk, &with(&said)) == plain);
    let by = |quality| {
        drawn(
            &desk,
            &with(&json!({ "quality": quality, "levels": false })),
        )
    };
    assert!(by("fast") != by("balanced") && by("exact") != by("balanced"));
    // Each object has its own.
    let mut pair = with(&json!({ "filter": "bilinear" }));
    let unseen = json!({ "model": "floor.obj", "texture": "p.png", "place": [0, -50, 0] });
    pair["objects"].as_array_mut().unwrap().insert(0, unseen);
    assert!(drawn(&desk, &pair) == drawn(&desk, &with(&json!({ "filter": "bilinear" }))));
}

/// Kills: replaced for multiplied, the other way round, light on texels that are as they are.
#[test]
fn texels_hide_colours_or_are_multiplied() {
    let desk = desk();
    let grey = Frame::new(8, 8, vec![132; 3 * 64]).unwrap();
    write_image(&desk.path("t.png"), &grey).unwrap();
    for lit in [false, true] {
        for (application, colour) in [
            (json!("product"), [132, 0, 0]),
            (json!("replace"), [132, 134, 132]),
            // No texel is transparent.
            (json!("decal"), [132, 134, 132]),
            (Value::Null, [132, 0, 0]),
        ] {
            let object =
                json!({ "model": "red.obj", "texture": "t.png", "application": application });
            let mut scene = scene(json!([object]));
            let mut want = colour;
            if lit {
                scene["lights"] = json!([{ "towards": [0, 0, 1], "colour": [0.5, 0.5, 0.5] }]);
                scene["ambient"] = json!(0);
                if application != "replace" && application != "decal" {
                    want[0] /= 2;
                }
            }
            let got = at(&drawn(&desk, &scene), 8, 8);
            assert!(
                got.iter()
                    .zip(want)
                    .all(|(got, want)| got.abs_diff(want) <= 2),
                "{application}, lit {lit}: {got:?}, not {want:?}"
            );
        }
    }
}

/// Kills: fields of pictures that are accepted where there is none.
#[test]
fn what_is_said_of_pictures_needs_one() {
    let desk = desk();
    for (name, value) in [
        ("filter", json!("bilinear")),
        ("levels", json!(false)),
        ("quality", json!("fast")),
        ("application", json!("replace")),
    ] {
        let mut object = json!({ "model": "red.obj" });
        object[name] = value;
        let scene = scene(json!([{ "model": "red.obj" }, object]));
        fs::write(desk.path("s.json"), scene.to_string()).unwrap();
        let line = desk.refused("render s.json -o p.png");
        let want = format!("s.json: object 1: `{name}` needs `texture`");
        assert!(line.contains(&want), "{line}");
    }
}

/// A picture of twice the size lies between the pixels of the one that is drawn, each a quarter of a pixel away from the
/// middle of its own. Kills: a picture drawn whole, pixels repeated, the other neighbour, means of another format.
#[test]
fn doubled_scenes_lie_between_what_is_drawn() {
    let desk = floor();
    for format in ["rgb888", "rgb565"] {
        let mut scene = with(&json!({}));
        (scene["format"], scene["background"]) = (json!(format), json!([40, 80, 160]));
        let drawn_at = |scene: &Value| {
            fs::write(desk.path("s.json"), scene.to_string()).unwrap();
            desk.told("render s.json -o o.png").0
        };
        scene["size"] = json!([40, 30]);
        let half = drawn_at(&scene);
        (scene["size"], scene["doubled"]) = (json!([80, 60]), json!(true));
        let whole = drawn_at(&scene);
        assert_eq!((whole.width(), whole.height()), (80, 60));
        let steps: [f64; 3] = match format {
            "rgb888" => [255.0; 3],
            _ => [31.0, 63.0, 31.0],
        };
        for (x, y) in (0..60).flat_map(|y| (0..80).map(move |x| (x, y))) {
            let beside = |at: u32, most: u32| match at % 2 {
                0 => (at / 2).saturating_sub(1),
                _ => (at / 2 + 1).min(most - 1),
            };
            let places = [(x / 2, 0.75), (beside(x, 40), 0.25)];
            let lines = [(y / 2, 0.75), (beside(y, 30), 0.25)];
            let want = [0, 1, 2].map(|i| {
                let level = |x, y| {
                    let level = f64::from(half.pixel(x, y).unwrap()[i]);
                    (level * steps[i] / 255.0).round()
                };
                let parts = lines.iter().flat_map(|(y, down)| {
                    let along = places.iter();
                    along.map(move |(x, across)| level(*x, *y) * across * down)
                });
                // Halves up, in steps of the format.
                let step = (parts.sum::<f64>() + 0.5).floor();
                (step * 255.0 / steps[i]).round() as u8
            });
            let got = whole.pixel(x, y).unwrap();
            let is_near = got
                .iter()
                .zip(want)
                .all(|(got, want)| got.abs_diff(want) <= 1);
            assert!(is_near, "{format} ({x}, {y}): {got:?}, not {want:?}");
        }
    }
    // Of an odd size, which `view` may ask for, what fits is shown.
    let mut scene = with(&json!({}));
    scene["doubled"] = json!(true);
    fs::write(desk.path("s.json"), scene.to_string()).unwrap();
    let shown = desk.run("view s.json --frames 1 --size 15x9 --colours 256");
    assert!(shown.status.success(), "{shown:?}");
}
