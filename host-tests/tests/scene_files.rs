//! Scene files from outside: each thing that a file can say is seen in the picture; what cannot be
//! drawn is one line on stderr, exit code 2 and no file; the examples draw all that they name.

use crate::command_line::Desk;
use crate::texture_cli::ROUNDED;
use host_tests::image_out::{Frame, read_image, write_image};
use serde_json::{Value, json};
use std::collections::BTreeSet;
use std::fs;
use std::path::{Path, PathBuf};

/// Two triangles from -1 to 1 in x and y, in one colour.
pub(crate) fn square(colour: &str) -> String {
    let corners = [(-1, -1), (1, -1), (1, 1), (-1, 1)];
    let vertex = |(x, y)| format!("v {x} {y} 0 {colour}\nvn 0 0 1\n");
    let vertices: String = corners.map(vertex).concat();
    let places = "vt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
    format!("{vertices}{places}f 1/1/1 2/2/2 3/3/3 4/4/4\n")
}

/// A folder with a red and a white square.
pub(crate) fn desk() -> Desk {
    let desk = Desk::new("");
    fs::write(desk.path("red.obj"), square("1 0 0")).unwrap();
    fs::write(desk.path("white.obj"), square("1 1 1")).unwrap();
    desk
}

/// A picture of 16 x 16 pixels over -1 to 1 at z = 0.
pub(crate) fn scene(objects: Value) -> Value {
    json!({
        "size": [16, 16],
        "camera": { "eye": [0, 0, 4], "at": [0, 0, 0], "fov": 28.072486935852957 },
        "objects": objects,
    })
}

pub(crate) fn drawn(desk: &Desk, scene: &Value) -> Frame {
    fs::write(desk.path("s.json"), scene.to_string()).unwrap();
    let (frame, said) = desk.told("render s.json -o o.png");
    // Models of the tests have textures where an object has one.
    let objects = scene["objects"].as_array().unwrap();
    let is_textured =
        |object: &Value| object.get("texture").is_some() || object.get("computed").is_some();
    let textured = objects.iter().any(is_textured);
    let is_rounded = textured && scene["format"] != "rgb565";
    assert_eq!(said, if is_rounded { ROUNDED } else { "" }, "{scene}");
    frame
}

pub(crate) fn at(frame: &Frame, x: usize, y: usize) -> [u8; 3] {
    let at = 3 * (16 * y + x);
    frame.rgb()[at..at + 3].try_into().unwrap()
}

/// Whether each channel is within a level.
pub(crate) fn near(a: [u8; 3], b: [u8; 3]) -> bool {
    a.iter().zip(b).all(|(a, b)| a.abs_diff(b) <= 1)
}

pub(crate) const RED: [u8; 3] = [255, 0, 0];
pub(crate) const WHITE: [u8; 3] = [255; 3];

#[test]
fn objects_stand_where_they_are_placed() {
    let desk = desk();
    let picture = |object: Value| {
        let mut scene = scene(json!([object]));
        scene["background"] = json!([1, 2, 3]);
        drawn(&desk, &scene)
    };
    let is_at = |picture: &Frame, left: usize, top: usize, what: &str| {
        for y in 0..16 {
            for x in 0..16 {
                let inside = (left..left + 4).contains(&x) && (top..top + 4).contains(&y);
                let want = if inside { RED } else { [1, 2, 3] };
                assert_eq!(at(picture, x, y), want, "{what}: ({x}, {y})");
            }
        }
    };
    let small = json!({ "model": "red.obj", "scale": 0.25, "place": [0.5, 0.5, 0] });
    is_at(&picture(small.clone()), 10, 2, "moved");
    let mut thin = small;
    thin["turn"] = json!([0, 90, 0]);
    is_at(
        &picture(thin),
        16,
        16,
        "from the side there is nothing of it",
    );
    // To the right of its middle: which way it goes tells the order of turns.
    let aside = square("1 0 0").replace("v -1", "v 3");
    fs::write(desk.path("aside.obj"), aside).unwrap();
    for (turn, left, top) in [
        ([0, 0, 0], 10, 6),
        ([0, 0, 90], 6, 2),
        ([180, 0, 90], 6, 2),
        ([0, 180, 90], 6, 10),
    ] {
        let object = json!({ "model": "aside.obj", "scale": 0.25, "turn": turn });
        is_at(&picture(object), left, top, &format!("{turn:?}"));
    }
}

/// A blend by factors.
fn factors(source: Value, destination: Value) -> Value {
    json!({ "factors": { "source": source, "destination": destination } })
}

/// Kills: channels that are written and are not to be, in another order, or of opaque surfaces or blended ones alone.
#[test]
fn surfaces_are_written_by_channels() {
    let desk = desk();
    for (channels, blend, want) in [
        ([false, true, false], Value::Null, [255, 255, 0]),
        ([true, false, false], Value::Null, [255, 0, 0]),
        ([false, false, true], json!("add"), [255, 0, 255]),
        ([true; 3], json!("subtract"), [0; 3]),
        ([false, true, true], json!("subtract"), [255, 0, 0]),
    ] {
        let above = json!({ "model": "white.obj", "place": [0, 0, 0.1], "blend": blend, "channels": channels });
        let picture = drawn(&desk, &scene(json!([{ "model": "red.obj" }, above])));
        assert!(
            near(at(&picture, 8, 8), want),
            "{channels:?} {blend}: {:?}",
            at(&picture, 8, 8)
        );
    }
}

#[test]
fn surfaces_blend_as_they_say() {
    let desk = desk();
    for (blend, alpha, want) in [
        (json!("filter"), json!(128), [255, 128, 128]),
        (json!("add"), json!(64), [255, 64, 64]),
        (json!("subtract"), json!(51), [204, 0, 0]),
        (json!("filter"), json!(255), WHITE),
        (json!("half"), Value::Null, [255, 128, 128]),
        (
            factors(json!("destination"), json!("zero")),
            Value::Null,
            [255, 0, 0],
        ),
        (
            factors(json!("inverse_destination"), json!("zero")),
            Value::Null,
            [0, 255, 255],
        ),
        (
            factors(json!({ "constant": 51 }), json!("one")),
            Value::Null,
            [255, 51, 51],
        ),
        (
            factors(json!("one"), json!({ "constant": 51 })),
            Value::Null,
            WHITE,
        ),
        (
            factors(json!("zero"), json!({ "constant": 51 })),
            Value::Null,
            [51, 0, 0],
        ),
    ] {
        let clear =
            json!({ "model": "white.obj", "place": [0, 0, 0.1], "blend": blend, "alpha": alpha });
        let picture = drawn(&desk, &scene(json!([{ "model": "red.obj" }, clear])));
        assert!(
            near(at(&picture, 8, 8), want),
            "{blend}: {:?}",
            at(&picture, 8, 8)
        );
    }
}

#[test]
fn depth_functions_and_priorities_decide_who_is_seen() {
    let desk = desk();
    let behind = |more: Value| {
        let mut object = json!({ "model": "white.obj", "place": [0, 0, -1] });
        for (name, value) in more.as_object().unwrap() {
            object[name] = value.clone();
        }
        at(
            &drawn(&desk, &scene(json!([{ "model": "red.obj" }, object]))),
            8,
            8,
        )
    };
    assert_eq!(behind(json!({})), RED);
    assert_eq!(behind(json!({ "depth": "farther" })), WHITE);
    assert_eq!(behind(json!({ "depth": "always" })), WHITE);
    assert_eq!(behind(json!({ "depth": "never" })), RED);
    // Priorities know no depth: of the same the later, else the higher.
    assert_eq!(behind(json!({ "priority": 0 })), WHITE);
    let third = json!({ "model": "red.obj", "place": [0, 0, -2], "priority": 1 });
    let ranked = json!([third, { "model": "white.obj", "priority": 0 }]);
    assert_eq!(at(&drawn(&desk, &scene(ranked)), 8, 8), RED);
    // What writes no depth hides nothing that comes later.
    let first = |writes: bool| json!({ "model": "red.obj", "writes_depth": writes });
    let pair = |writes| json!([first(writes), { "model": "white.obj", "place": [0, 0, -1] }]);
    assert_eq!(at(&drawn(&desk, &scene(pair(true))), 8, 8), RED);
    assert_eq!(at(&drawn(&desk, &scene(pair(false))), 8, 8), WHITE);
}

#[test]
fn windows_keep_their_inside_or_their_outside() {
    let desk = desk();
    for outside in [false, true] {
        let window = json!({ "left": 3, "top": 5, "width": 4, "height": 9, "outside": outside });
        let objects = json!([{ "model": "red.obj", "scale": 2, "window": window }]);
        let picture = drawn(&desk, &scene(objects));
        for y in 0..16 {
            for x in 0..16 {
                let inside = (3..7).contains(&x) && (5..14).contains(&y);
                let want = if inside != outside { RED } else { [0; 3] };
                assert_eq!(at(&picture, x, y), want, "({x}, {y}), outside: {outside}");
            }
        }
    }
}

#[test]
fn lights_add_up_and_backs_are_dropped() {
    let desk = desk();
    let lit = |more: Value, ambient: f64| {
        let mut scene = scene(json!([{ "model": "white.obj" }]));
        (scene["lights"], scene["ambient"]) = (more, json!(ambient));
        at(&drawn(&desk, &scene), 8, 8)
    };
    let ahead = json!({ "towards": [0, 0, 5], "colour": [0.5, 0, 0.25] });
    // 60 degrees off: half of it.
    let aside = json!({ "towards": [3f64.sqrt(), 0, 1], "colour": [0, 1, 0.5] });
    let one = lit(json!([ahead]), 0.0);
    assert!(near(one, [128, 0, 64]), "{one:?}");
    let two = lit(json!([ahead, aside]), 0.0);
    assert!(near(two, [128, 128, 128]), "{two:?}");
    let ambient = lit(json!([ahead, aside]), 0.25);
    assert!(near(ambient, [191, 191, 191]), "{ambient:?}");
    for (cull, want) in [("none", RED), ("back", [0; 3])] {
        let object = json!({ "model": "red.obj", "turn": [0, 180, 0], "cull": cull });
        assert_eq!(at(&drawn(&desk, &scene(json!([object]))), 8, 8), want);
    }
}

#[test]
fn textures_formats_and_dither_are_those_of_the_file() {
    let desk = desk();
    let texels: Vec<u8> = (0..64 * 64)
        .flat_map(|i| {
            if i % 64 < 32 {
                [200, 100, 50]
            } else {
                [8, 80, 160]
            }
        })
        .collect();
    write_image(&desk.path("t.png"), &Frame::new(64, 64, texels).unwrap()).unwrap();
    let textured = json!([{ "model": "white.obj", "scale": 2, "texture": "t.png" }]);
    let picture = drawn(&desk, &scene(textured.clone()));
    // Texels have 5, 6 and 5 bits.
    assert_eq!(at(&picture, 4, 8), [197, 101, 49]);
    assert_eq!(at(&picture, 12, 8), [8, 81, 156]);
    fs::write(desk.path("brown.obj"), square("0.8 0.4 0.2")).unwrap();
    let plain = json!([{ "model": "brown.obj", "scale": 2 }]);
    let distinct = |objects: &Value, format: &str, dither: bool| {
        let mut scene = scene(objects.clone());
        (scene["format"], scene["dither"]) = (json!(format), json!(dither));
        let picture = drawn(&desk, &scene);
        let colours = (0..16).flat_map(|y| (0..6).map(move |x| (x, y)));
        let colours: Vec<[u8; 3]> = colours.map(|(x, y)| at(&picture, x, y)).collect();
        let distinct: BTreeSet<_> = colours.iter().collect();
        (distinct.len(), colours[0])
    };
    for objects in [&textured, &plain] {
        assert_eq!(distinct(objects, "rgb888", false).0, 1);
        assert_eq!(distinct(objects, "rgb565", false).0, 1);
    }
    assert_eq!(distinct(&textured, "rgb565", false).1, [197, 101, 49]);
    // Texels in full light are what they are; colours are mixed.
    assert_eq!(distinct(&textured, "rgb565", true), (1, [197, 101, 49]));
    assert!(distinct(&plain, "rgb565", true).0 > 1);
}

#[test]
fn palettes_differ_from_line_to_line() {
    let desk = desk();
    let mut scene = scene(json!([{ "model": "red.obj", "scale": 0.5, "index": 2 }]));
    scene["palettes"] = json!([
        { "from_line": 0, "colours": [[1, 2, 3], [9, 9, 9], [10, 20, 30]] },
        { "from_line": 7, "colours": [[4, 5, 6], [9, 9, 9], [40, 50, 60]] },
    ]);
    let picture = drawn(&desk, &scene);
    for y in 0..16 {
        let first = y < 7;
        assert_eq!(
            at(&picture, 1, y),
            if first { [1, 2, 3] } else { [4, 5, 6] }
        );
        let on = (4..12).contains(&y);
        let want = match (on, first) {
            (true, true) => [10, 20, 30],
            (true, false) => [40, 50, 60],
            (false, _) => at(&picture, 1, y),
        };
        assert_eq!(at(&picture, 8, y), want, "line {y}");
    }
    let shared = desk.run("render s.json -o p.png --renderers 2");
    assert!(shared.status.success(), "{shared:?}");
    assert_eq!(read_image(&desk.path("p.png")).unwrap(), picture);
}

#[test]
fn what_cannot_be_read_or_does_nothing_is_refused() {
    let desk = desk();
    let write = |scene: &Value| fs::write(desk.path("s.json"), scene.to_string()).unwrap();
    write(&scene(json!([{ "model": "none.obj" }])));
    assert!(desk.refused("render s.json -o p.png").contains("none.obj"));
    write(&scene(
        json!([{ "model": "red.obj", "texture": "none.png" }]),
    ));
    assert!(desk.refused("render s.json -o p.png").contains("none.png"));
    let far = json!([{ "model": "red.obj" }, { "model": "red.obj", "scale": 1e38 }]);
    write(&scene(far));
    assert!(desk.refused("render s.json -o p.png").contains("object 1"));
    write(&scene(json!([{ "model": "red.obj", "dept": "never" }])));
    let line = desk.refused("view s.json --frames 1");
    assert!(line.contains("s.json") && line.contains("dept"), "{line}");
    assert!(desk.refused("render t.json -o p.png").contains("t.json"));
    let kept = json!([{ "model": "red.obj", "blend": "add", "writes_depth": true }]);
    write(&scene(kept));
    assert!(
        desk.refused("render s.json -o p.png")
            .contains("`writes_depth` cannot be true")
    );
    write(&scene(json!([{ "model": "red.obj" }])));
    for flag in [
        "--size 4x4",
        "--fov 50",
        "--shade flat",
        "--dither on",
        "--format rgb565",
    ] {
        let line = desk.refused(&format!("render s.json -o p.png {flag}"));
        let name = flag.split(' ').next().unwrap();
        assert!(
            line.contains(&format!("{name} goes with a model")),
            "{line}"
        );
    }
    assert!(
        desk.refused("view s.json --frames 1 --shade flat")
            .contains("--shade")
    );
    let shown = desk.run("view s.json --frames 2 --size 8x8 --colours 256");
    assert!(shown.status.success(), "{shown:?}");
}

/// The folder of the examples.
fn examples() -> PathBuf {
    Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scene-files")
}

/// The scene files in it.
fn example_files() -> Vec<PathBuf> {
    let entries = fs::read_dir(examples()).unwrap();
    let files = entries.map(|entry| entry.unwrap().path());
    let is_scene = |file: &PathBuf| {
        file.extension()
            .is_some_and(|extension| extension == "json")
    };
    files.filter(is_scene).collect()
}

/// Each field that the guide has is in an example, and each field of an example is in the guide. Kills: a field that is in
/// no table, or in none of the files.
#[test]
fn the_guide_has_the_fields_of_the_examples() {
    let guide = Path::new(env!("CARGO_MANIFEST_DIR")).join("../src/guide/scene_files.md");
    let guide = fs::read_to_string(guide).unwrap();
    let rows = guide.lines().filter(|line| line.starts_with("| `"));
    let fields: BTreeSet<&str> = rows
        .flat_map(|row| row.split('|').nth(1).unwrap().split('`').skip(1).step_by(2))
        .collect();
    let mut said = BTreeSet::new();
    for file in example_files() {
        let scene: Value = serde_json::from_str(&fs::read_to_string(file).unwrap()).unwrap();
        let objects = scene["objects"].as_array().unwrap();
        for part in objects.iter().chain([&scene]) {
            said.extend(part.as_object().unwrap().keys().cloned());
        }
        for lamp in scene["lights"].as_array().into_iter().flatten() {
            for name in lamp.as_object().unwrap().keys() {
                assert!(guide.contains(&format!("`{name}`")), "{name}");
            }
        }
    }
    let said: BTreeSet<&str> = said.iter().map(String::as_str).collect();
    assert_eq!(fields, said);
}

/// The examples in the repository draw, and nothing in them is in vain.
#[test]
fn every_object_of_the_examples_is_seen() {
    let files = example_files();
    for file in &files {
        let desk = Desk::new("");
        for entry in fs::read_dir(examples()).unwrap() {
            let file = entry.unwrap().path();
            fs::copy(
                &file,
                desk.path(file.file_name().unwrap().to_str().unwrap()),
            )
            .unwrap();
        }
        let text = fs::read_to_string(file).unwrap();
        let scene: Value = serde_json::from_str(&text).unwrap();
        let whole = drawn(&desk, &scene);
        for (number, _) in scene["objects"].as_array().unwrap().iter().enumerate() {
            let mut less = scene.clone();
            less["objects"].as_array_mut().unwrap().remove(number);
            // That a scene has priorities is said by any object.
            assert!(
                drawn(&desk, &less) != whole,
                "{}: object {number}",
                file.display()
            );
        }
    }
    assert_eq!(files.len(), 5);
}
