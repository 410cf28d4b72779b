//! What the tool writes: never over what it reads, and all of it or nothing.

use crate::command_line::Desk;
use host_tests::image_out::{Frame, write_image};
use std::fs;

const SQUARE: &str = "mtllib m.mtl\nusemtl a\nv -1 -1 0\nv 1 -1 0\nv 1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\n\
    f 1/1 2/2 3/3\n";
const SCENE: &str = r#"{"size": [8, 8], "camera": {"eye": [0, 0, 3], "at": [0, 0, 0]},
    "objects": [{"model": "m.obj", "texture": "u.png"}]}"#;
const GLTF: &str = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
    "meshes":[{"primitives":[{"attributes":{"POSITION":0,"TEXCOORD_0":1},"material":0}]}],
    "materials":[{"pbrMetallicRoughness":{"baseColorTexture":{"index":0}}}],
    "textures":[{"source":0}],"images":[{"uri":"p.png"}],
    "accessors":[{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]},
    {"bufferView":0,"componentType":5126,"count":3,"type":"VEC2"}],
    "bufferViews":[{"buffer":0,"byteLength":36}],"buffers":[{"byteLength":36,"uri":"m.bin"}]}"#;

/// A model, its material and pictures, a scene, a glTF file with its buffer, and a list.
fn desk() -> Desk {
    let desk = Desk::new(SQUARE);
    fs::write(desk.path("m.mtl"), "newmtl a\nmap_Kd p.png\n").unwrap();
    fs::write(desk.path("s.json"), SCENE).unwrap();
    let grey = Frame::new(2, 2, vec![9; 12]).unwrap();
    write_image(&desk.path("p.png"), &grey).unwrap();
    write_image(&desk.path("u.png"), &grey).unwrap();
    fs::write(desk.path("m.gltf"), GLTF).unwrap();
    let places = [0.0f32, 0.0, 0.0, 1.0, 0.0, 0.0, 0.0, 1.0, 0.0];
    let bytes: Vec<u8> = places.iter().flat_map(|c| c.to_le_bytes()).collect();
    fs::write(desk.path("m.bin"), bytes).unwrap();
    fs::create_dir(desk.path("d")).unwrap();
    fs::write(desk.path("l.png"), [0; 4]).unwrap();
    desk
}

/// Every file that a run reads, however it is named, in the place of every output. Kills: names compared instead of
/// places; files left out that models, materials, scenes or glTF name; outputs in one place.
#[test]
fn what_is_read_is_not_written_over() {
    let desk = desk();
    let bytes = |name: &String| fs::read(desk.path(name)).ok();
    let all = || desk.files().iter().map(bytes).collect::<Vec<_>>();
    let before = all();
    for line in [
        "bake m.obj -o ./m.obj",
        "bake m.obj -o d/../m.mtl",
        "bake m.obj -o ./p.png",
        "bake m.obj -o ./u.png --texture u.png",
        "bake m.gltf -o ./m.gltf",
        "bake m.gltf -o m.bin",
        "bake m.gltf -o d/../p.png",
        "compress p.png -o ./p.png",
        "run-list l.png -o ./l.png",
        "render m.obj -o p.png",
        "render m.obj -o ./u.png --texture u.png",
        "render m.obj -o o.png --stats ./m.obj",
        "render m.obj -o o.png --stats m.mtl",
        "render m.obj -o o.png --stats d/../o.png",
        "render s.json -o ./u.png",
        "render s.json -o o.png --stats m.mtl",
        "render s.json -o o.png --stats ./s.json",
    ] {
        let text = desk.refused(line);
        let is_told = text.contains(", which is read") || text.contains("a file of its own");
        assert!(is_told, "{line}: {text}");
        assert!(all() == before, "{line}");
    }
    // With other names all is written, over what was there too.
    fs::write(desk.path("m.list"), "old").unwrap();
    for line in [
        "bake m.gltf -o m.list",
        "bake m.obj -o ./m.list",
        "render m.obj -o ./o.png --stats d/m.obj",
        "render s.json -o d/u.png",
    ] {
        assert!(desk.run(line).status.success(), "{line}");
    }
}

/// Kills: links that are not followed to what is read.
#[cfg(unix)]
#[test]
fn what_is_read_is_not_written_over_through_links() {
    use std::os::unix::fs::symlink;
    let desk = desk();
    symlink("p.png", desk.path("o.png")).unwrap();
    symlink("m.obj", desk.path("n.obj")).unwrap();
    symlink("none.json", desk.path("a.json")).unwrap();
    for (line, what) in [
        ("render m.obj -o o.png", "o.png, which is read"),
        (
            "render n.obj -o q.png --stats m.obj",
            "m.obj, which is read",
        ),
        ("bake n.obj -o m.obj", "m.obj, which is read"),
    ] {
        let text = desk.refused(line);
        assert!(text.contains(what), "{line}: {text}");
    }
    // A link to what is not there yet.
    symlink("none.png", desk.path("b.png")).unwrap();
    let text = desk.refused("render m.obj -o b.png --stats none.png");
    assert!(text.contains("a file of its own"), "{text}");
}
