//! `firmware SCENE.json` from outside: what cannot be had on a board is one line on stderr and exit code 2, before
//! anything is built or run. What boards draw is tried beside the code.

use crate::command_line::Desk;
use host_tests::image_out::{Frame, write_image};
use serde_json::{Value, json};
use std::fs;
use std::path::Path;

const SQUARE: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\nvn 0 0 1\n\
    f 1/1/1 2/2/1 3/3/1 4/4/1\n";

fn scene(objects: Value) -> Value {
    json!({
        "size": [16, 16],
        "format": "rgb565",
        "camera": { "eye": [0, 0, 4], "at": [0, 0, 0] },
        "objects": objects,
    })
}

/// Kills: a missing file or field that is not named, a picture that is drawn in parts on the host and one scene on boards,
/// and an object that is not named where the scene is too large.
#[test]
fn scenes_that_boards_cannot_draw_are_refused() {
    let desk = Desk::new(SQUARE);
    let refused = |scene: &Value| {
        fs::write(desk.path("s.json"), scene.to_string()).unwrap();
        desk.refused("firmware s.json --board m4")
    };
    assert!(
        desk.refused("firmware nothing.json")
            .contains("nothing.json")
    );
    let said = refused(&scene(json!([{ "model": "nothing.obj" }])));
    assert!(said.contains("nothing.obj"), "{said}");
    let mut wide = scene(json!([{ "model": "m.obj" }]));
    wide["size"] = json!([1017, 16]);
    let said = refused(&wide);
    assert!(said.contains("s.json: `size` is 1017 x 16"), "{said}");
    let mut unknown = scene(json!([]));
    unknown["shadows"] = json!(true);
    assert!(refused(&unknown).contains("`shadows`"));
    // A sheet of more triangles than a scene holds.
    let side = 190;
    let vertex = |n: usize| format!("v {} {} 0\n", n % side, n / side);
    let faces = (0..side * (side - 1))
        .filter(|n| n % side != side - 1)
        .map(|n| {
            let n = n + 1;
            format!("f {n} {} {} {}\n", n + 1, n + 1 + side, n + side)
        });
    let sheet: String = (0..side * side).map(vertex).chain(faces).collect();
    fs::write(desk.path("sheet.obj"), sheet).unwrap();
    let sheet = json!({ "model": "sheet.obj", "scale": 0.01, "place": [-1, -1, 0] });
    let mut full = scene(json!([{ "model": "m.obj" }, sheet]));
    full["size"] = json!([1000, 1000]);
    let said = refused(&full);
    assert!(said.contains("s.json: object 1: "), "{said}");
}

/// Kills: a scene that reaches over the end of the flash.
#[test]
fn more_than_the_flash_holds_is_refused_with_how_much_it_is() {
    let desk = Desk::new(SQUARE);
    let side = 1024;
    let frame = Frame::new(side, side, vec![200; 3 * 1024 * 1024]).unwrap();
    write_image(&desk.path("large.png"), &frame).unwrap();
    let object = json!({ "model": "m.obj", "texture": "large.png" });
    fs::write(desk.path("s.json"), scene(json!([object])).to_string()).unwrap();
    let said = desk.refused("firmware s.json");
    assert!(
        said.contains("s.json: needs 27") && said.contains(" bytes of flash"),
        "{said}"
    );
}

/// Kills: a model that is read as a list, and a refusal that does not name the file.
#[test]
fn what_is_neither_a_scene_nor_a_list_is_named() {
    let desk = Desk::new("v -1 -1 0\n");
    let not_a_list = ": is not a list: `render` draws models and scene files\n";
    fs::write(desk.path("other.list"), "# no list").unwrap();
    for line in [
        "run-list m.obj -o o.png",
        "disassemble m.obj",
        "firmware other.list",
    ] {
        let said = desk.refused(line);
        assert!(said.ends_with(not_a_list), "{said}");
    }
    for line in ["plan m.obj", "firmware m.obj"] {
        let said = desk.refused(line);
        let want = "m.obj: is neither a scene file, .json, nor a list, .list\n";
        assert!(said.ends_with(want), "{said}");
    }
}

/// Kills: a list that is cut off and drawn as far as it goes, and bytes that are no words.
#[test]
fn lists_that_are_cut_off_are_refused() {
    let desk = Desk::new("");
    let list = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes/teapot.list");
    let list = fs::read(list).unwrap();
    for (length, want) in [
        (list.len() - 3, "not whole words"),
        (list.len() - 4, "3595 words are needed, there are 3594"),
        (12, "list: offset 0x0"),
    ] {
        fs::write(desk.path("m.list"), &list[..length]).unwrap();
        let said = desk.refused("firmware m.list");
        assert!(
            said.contains("m.list") && said.contains(want),
            "{length}: {said}"
        );
    }
}
