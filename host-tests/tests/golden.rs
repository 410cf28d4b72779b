//! Golden pictures: frames of the firmware and pictures of the tool have the checksums that
//! `figures/golden.txt` keeps, so that a change of meaning is seen where firmware and host change alike.

use crate::command_line::Desk;
use crate::texture_cli::ROUNDED;
use host_tests::frames::host_frames;
use host_tests::golden::{self, BLESS_VARIABLE, Pictures};
use host_tests::image_out::{Frame, write_image};
use host_tests::model::obj_text;
use std::fs;
use std::path::Path;

/// Pictures that the tool draws, 160 x 120: a name, a model of [`desk`], and flags.
///
/// A new one is a line here; its name is that of the record.
const RENDERS: &[(&str, &str, &str)] = &[
    ("teapot", "teapot", "--shade gouraud"),
    ("teapot-flat", "teapot", "--shade flat"),
    ("teapot-none", "teapot", "--shade none"),
    ("teapot-phong", "teapot", "--shade phong --specular 0.6,20"),
    (
        "teapot-shadows",
        "teapot",
        "--shade gouraud --shadows on --light 1,1,0.3",
    ),
    (
        "teapot-phong-shadows",
        "teapot",
        "--shade phong --shadows on --light 1,1,0.3",
    ),
    (
        "teapot-dither",
        "teapot",
        "--shade gouraud --dither on --format rgb565",
    ),
    ("teapot-565", "teapot", "--shade gouraud --format rgb565"),
    ("teapot-xrgb", "teapot", "--shade gouraud --format xrgb8888"),
    ("teapot-grey", "teapot", "--shade gouraud --format grey8"),
    ("teapot-mono", "teapot", "--shade gouraud --format mono"),
    ("teapot-z32", "teapot", "--shade gouraud --depth z32"),
    (
        "teapot-block-fix",
        "teapot",
        "--shade gouraud --depth block-fix",
    ),
    (
        "teapot-word",
        "teapot",
        "--shade gouraud --depth word --format rgb565",
    ),
    ("teapot-id", "teapot", "--shade gouraud --depth id"),
    (
        "teapot-priority",
        "teapot",
        "--shade gouraud --depth priority",
    ),
    ("teapot-plane", "teapot", "--shade gouraud --interp plane"),
    (
        "teapot-packed16",
        "teapot",
        "--shade gouraud --interp packed16",
    ),
    ("teapot-half", "teapot", "--shade gouraud --interp half"),
    (
        "teapot-quarter",
        "teapot",
        "--shade gouraud --interp quarter",
    ),
    ("teapot-lirp10", "teapot", "--shade gouraud --interp lirp10"),
    ("teapot-lirp12", "teapot", "--shade gouraud --interp lirp12"),
    ("teapot-lirp16", "teapot", "--shade gouraud --interp lirp16"),
    (
        "teapot-lirp-packed",
        "teapot",
        "--shade gouraud --interp lirp-packed",
    ),
    (
        "teapot-auto-fast",
        "teapot",
        "--shade gouraud --quality fast",
    ),
    (
        "teapot-auto-exact",
        "teapot",
        "--shade gouraud --quality exact",
    ),
    ("teapot-model", "teapot", "--shade gouraud --interp model"),
    (
        "teapot-cull",
        "teapot",
        "--shade gouraud --cull back --near 2.2",
    ),
    ("cube", "cube", "--shade gouraud"),
    ("cube-inside", "cube", "--eye 0.3,0.2,0.9 --fov 100"),
    ("floor", "floor", "--eye 0,0.5,3"),
    ("floor-fast", "floor", "--eye 0,0.5,3 --quality fast"),
    ("floor-exact", "floor", "--eye 0,0.5,3 --quality exact"),
    ("floor-bilinear", "floor", "--eye 0,0.5,3 --filter bilinear"),
    ("floor-no-levels", "floor", "--eye 0,0.5,3 --levels off"),
    (
        "floor-lit",
        "floor",
        "--eye 0,0.5,3 --shade gouraud --light 0,1,0.4",
    ),
    ("glass", "glass", "--shade gouraud --eye 0.4,0.6,3"),
    (
        "glass-565",
        "glass",
        "--shade gouraud --eye 0.4,0.6,3 --format rgb565",
    ),
];

/// The scene files of the repository.
const SCENES: &[&str] = &["cards", "court", "dusk", "room", "yard"];

/// The models, and what they need beside them.
fn desk() -> Desk {
    let desk = Desk::new("");
    let write = |name: &str, text: String| fs::write(desk.path(name), text).unwrap();
    write("teapot.obj", obj_text(&scenes::TEAPOT).unwrap());
    write("cube.obj", obj_text(&scenes::CUBE).unwrap());
    let mut texels = Vec::new();
    for (x, y) in (0..32u32).flat_map(|y| (0..32u32).map(move |x| (x, y))) {
        let square = if (x ^ y) & 4 == 0 { 200 } else { 60 };
        texels.extend([square as u8, (8 * x) as u8, (8 * y) as u8]);
    }
    write_image(&desk.path("p.png"), &Frame::new(32, 32, texels).unwrap()).unwrap();
    write("floor.mtl", "newmtl floor\nmap_Kd p.png\n".to_owned());
    let corners = "v -9 -1 3\nv 9 -1 3\nv 9 -1 -20\nv -9 -1 -20\n";
    let places = "vt 0 0\nvt 6 0\nvt 6 8\nvt 0 8\n";
    let normal = "vn 0 1 0\n";
    write(
        "floor.obj",
        format!(
            "mtllib floor.mtl\n{corners}{places}{normal}usemtl floor\nf 1/1/1 2/2/1 3/3/1 4/4/1\n"
        ),
    );
    let materials = "newmtl red\nKd 1 0.2 0.1\nd 0.5\nnewmtl blue\nKd 0.1 0.3 1\nd 0.3\nnewmtl shiny\nKs 0.8 0.8 0.8\nNs 30\n";
    write("glass.mtl", materials.to_owned());
    let panes = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nv -1 -1 0.5\nv 1 -1 -0.5\nv 1 1 -0.5\nv -1 1 0.5\n";
    let back = "v -2 -2 -1\nv 2 -2 -1\nv 0 2 -1\n";
    write(
        "glass.obj",
        format!(
            "mtllib glass.mtl\n{panes}{back}usemtl shiny\nf 9 10 11\nusemtl red\nf 1 2 3 4\nusemtl blue\nf 5 6 7 8\n"
        ),
    );
    desk
}

#[test]
fn pictures_are_those_of_the_record() {
    let mut drawn = Pictures::new();
    for (name, crc) in host_frames().unwrap() {
        drawn.insert(format!("frame {name}"), crc);
    }
    let desk = desk();
    for (name, model, flags) in RENDERS {
        let eye = if flags.contains("--eye") {
            ""
        } else {
            " --eye 0.6,0.9,2.4"
        };
        let view = "--size 160x120 --background 24,32,48";
        let line = format!("render {model}.obj -o o.png {view}{eye} {flags}");
        let (frame, told) = desk.told(&line);
        let note = if *model == "floor" { ROUNDED } else { "" };
        assert_eq!(told, note, "{line}");
        let crc = crc32fast::hash(frame.rgb());
        assert!(
            drawn.insert(format!("render {name}"), crc).is_none(),
            "{name} twice"
        );
    }
    for name in SCENES {
        let file = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scene-files");
        let (frame, _) = desk.told(&format!("render {}/{name}.json -o o.png", file.display()));
        let crc = crc32fast::hash(frame.rgb());
        drawn.insert(format!("scene {name}"), crc);
    }
    let bless = std::env::var_os(BLESS_VARIABLE).is_some_and(|value| !value.is_empty());
    if let Err(error) = golden::judge(&golden::path(), &drawn, bless) {
        panic!("{error}");
    }
}
