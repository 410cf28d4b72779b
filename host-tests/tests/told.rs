//! How the tool ends and what it tells: readers that go away, files that contradict themselves,
//! what is left out, and outputs that are links.

use crate::command_line::Desk;
use base64::Engine as _;
use std::fs;
use std::path::Path;
use std::process::{Command, Stdio};

const TRIANGLE: &str = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";

/// What a line says on stderr; its exit code must be 0.
fn said(desk: &Desk, line: &str) -> String {
    let output = desk.run(line);
    let text = String::from_utf8(output.stderr).unwrap();
    assert_eq!(output.status.code(), Some(0), "{line}: {text}");
    text
}

#[test]
fn a_reader_that_goes_away_ends_the_tool_quietly() {
    let desk = Desk::new(TRIANGLE);
    assert_eq!(said(&desk, "bake m.obj -o m.list"), "");
    let helps = COMMANDS.map(|command| format!("{command} --help"));
    for line in helps.iter().map(String::as_str).chain([
        "--help",
        "--version",
        "trace m.obj --line 120",
        "view m.obj --frames 20",
        "disassemble m.list",
        "run-list m.list --print",
        "bake m.obj -o other.list --json",
        "demo -o out --frames 1",
        "cache",
        "cache --json",
    ]) {
        let mut child = Command::new(env!("CARGO_BIN_EXE_scanbeam"))
            .args(line.split_whitespace())
            .current_dir(desk.path(""))
            .stdout(Stdio::piped())
            .stderr(Stdio::piped())
            .spawn()
            .unwrap();
        drop(child.stdout.take());
        let output = child.wait_with_output().unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(
            (output.status.code(), text.as_str()),
            (Some(0), ""),
            "{line}"
        );
    }
    // What was to be written is there all the same.
    assert!(desk.path("other.list").exists());
}

/// All words that the tool has.
const COMMANDS: [&str; 16] = [
    "render",
    "view",
    "demo",
    "trace",
    "cache",
    "accuracy",
    "plan",
    "firmware",
    "boards",
    "budgets",
    "bench",
    "report",
    "bake",
    "compress",
    "run-list",
    "disassemble",
];

#[test]
fn all_commands_are_tried() {
    let desk = Desk::new(TRIANGLE);
    let help = String::from_utf8(desk.run("--help").stdout).unwrap();
    let (_, commands) = help.split_once("Commands:\n").unwrap();
    let (commands, _) = commands.split_once("\n\n").unwrap();
    let names = commands
        .lines()
        .filter(|line| line.starts_with("  ") && !line.starts_with("   "));
    let names: Vec<&str> = names
        .filter_map(|line| line.split_whitespace().next())
        .collect();
    let told = names.iter().filter(|name| **name != "help");
    assert_eq!(
        told.collect::<Vec<_>>(),
        COMMANDS.iter().collect::<Vec<_>>()
    );
}

/// Commands that take minutes are not tried above; what they print goes through the writer that all share, which a reader
/// that goes away does not disturb: nothing else in the tool prints.
#[test]
fn all_that_is_printed_goes_through_one_writer() {
    fn each(folder: &Path, look: &mut dyn FnMut(&Path, &str)) {
        for entry in fs::read_dir(folder).unwrap() {
            let path = entry.unwrap().path();
            if path.is_dir() {
                each(&path, look);
            } else if path.extension().is_some_and(|end| end == "rs") {
                look(&path, &fs::read_to_string(&path).unwrap());
            }
        }
    }
    let here = Path::new(env!("CARGO_MANIFEST_DIR"));
    let mut said = 0;
    for folder in ["src", "draw/src", "frames/src", "support/src"] {
        each(&here.join(folder), &mut |path, text| {
            // The writer itself, and what draws on a live terminal.
            let is_writer = path.ends_with("support/src/stdio.rs");
            let is_live = path.ends_with("view/terminal.rs");
            said += text.matches("say!(").count();
            for line in text.lines().filter(|_| !is_writer && !is_live) {
                let line = line.replace("eprint", "");
                let is_noted = !line.contains("stdout()") || line.contains("stdio::note(");
                let prints = line.contains("println!(") || line.contains("print!(");
                assert!(is_noted && !prints, "{}: {line}", path.display());
            }
        });
    }
    assert!(said > 40, "{said}");
}

#[cfg(target_os = "linux")]
#[test]
fn lost_output_is_an_error() {
    let desk = Desk::new(TRIANGLE);
    for line in ["render --help", "trace m.obj --line 120"] {
        let full = fs::OpenOptions::new()
            .write(true)
            .open("/dev/full")
            .unwrap();
        let output = Command::new(env!("CARGO_BIN_EXE_scanbeam"))
            .args(line.split_whitespace())
            .current_dir(desk.path(""))
            .stdout(full)
            .output()
            .unwrap();
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert_eq!(text, "error: standard output: No space left on device\n");
    }
}

/// A triangle as glTF: its asset, the attributes of its primitive and what follows, its accessor,
/// its view, and more of the document.
struct Document<'a> {
    asset: &'a str,
    primitive: &'a str,
    accessor: &'a str,
    view: &'a str,
    more: &'a str,
}

const GOOD: Document<'_> = Document {
    asset: r#""version":"2.0""#,
    primitive: r#""attributes":{"POSITION":0}"#,
    accessor: r#"{"bufferView":0,"componentType":5126,"count":3,"type":"VEC3","min":[0,0,0],"max":[1,1,0]}"#,
    view: r#""byteOffset":0,"byteLength":36"#,
    more: r#","scene":0,"scenes":[{"nodes":[0]}]"#,
};

impl Document<'_> {
    fn text(&self) -> String {
        let places = [[0.0f32, 0.0, 0.0], [1.0, 0.0, 0.0], [0.0, 1.0, 0.0]];
        let bytes: Vec<u8> = places
            .iter()
            .flatten()
            .flat_map(|c| c.to_le_bytes())
            .collect();
        let data = base64::engine::general_purpose::STANDARD.encode(bytes);
        let Self {
            asset,
            primitive,
            accessor,
            view,
            more,
        } = self;
        format!(
            r#"{{"asset":{{{asset}}},"nodes":[{{"mesh":0}}],
            "meshes":[{{"primitives":[{{{primitive}}}]}}],"accessors":[{accessor}],
            "bufferViews":[{{"buffer":0,{view}}}],
            "buffers":[{{"byteLength":36,"uri":"data:;base64,{data}"}}]{more}}}"#
        )
    }
}

#[test]
fn gltf_that_contradicts_itself_is_refused_in_one_line() {
    let desk = Desk::new(TRIANGLE);
    let refused = |document: &str| {
        fs::write(desk.path("m.gltf"), document).unwrap();
        desk.refused("bake m.gltf -o m.list")
    };
    let changed = |change: &dyn Fn(&mut Document<'static>)| {
        let mut document = GOOD;
        change(&mut document);
        refused(&document.text())
    };
    fs::write(desk.path("m.gltf"), GOOD.text()).unwrap();
    assert_eq!(said(&desk, "bake m.gltf -o good.list"), "");

    let bare = r#"{"asset":{"version":"2.0"},"scene":0,"scenes":[{"nodes":[0]}],"nodes":[{"mesh":0}],
        "meshes":[{"primitives":[{"attributes":{"POSITION":0}}]}]}"#;
    assert!(refused(bare).contains("accessor 0 of its positions is not there"));
    let emptied = bare.replace(
        r#""nodes":[{"mesh":0}]"#,
        r#""nodes":[{"mesh":0}],"accessors":[]"#,
    );
    assert!(refused(&emptied).contains("accessor 0 of its positions is not there"));
    let stride = changed(&|d| d.view = r#""byteOffset":0,"byteLength":36,"byteStride":4"#);
    assert!(
        stride.contains("accessor 0: 4 bytes from one element"),
        "{stride}"
    );
    for (accessor, reason) in [
        (GOOD.accessor.replace("5126", "5121"), "another type"),
        (GOOD.accessor.replace("VEC3", "VEC2"), "another type"),
        (
            GOOD.accessor.replace(r#""count":3"#, r#""count":0"#),
            "no elements",
        ),
        (
            GOOD.accessor.replace(r#""count":3"#, r#""count":4"#),
            "not within its buffer",
        ),
    ] {
        let document = Document {
            accessor: &accessor,
            ..GOOD
        };
        let text = refused(&document.text());
        assert!(text.contains(reason), "{accessor}: {text}");
    }
    // Indices that are no whole numbers, texture places of three, colours of one.
    for primitive in [
        r#""attributes":{"POSITION":0},"indices":0"#,
        r#""attributes":{"POSITION":0,"TEXCOORD_0":0}"#,
        r#""attributes":{"POSITION":0,"COLOR_0":1}"#,
    ] {
        let two = format!(
            r#"{},{{"bufferView":0,"componentType":5126,"count":3,"type":"SCALAR"}}"#,
            GOOD.accessor
        );
        let document = Document {
            primitive,
            accessor: &two,
            ..GOOD
        };
        let text = refused(&document.text());
        assert!(text.contains("another type"), "{primitive}: {text}");
    }
    // Pictures: in a view without a type, and nowhere.
    for image in [r#"{"bufferView":0}"#, "{}"] {
        let more = format!(
            r#"{},"materials":[{{"pbrMetallicRoughness":{{"baseColorTexture":{{"index":0}}}}}}],
            "textures":[{{"source":0}}],"images":[{image}]"#,
            GOOD.more
        );
        let document = Document {
            more: &more,
            ..GOOD
        };
        let text = refused(&document.text());
        assert!(text.contains("picture 0 "), "{image}: {text}");
    }
    // Another version, in the shape of 2.0 and in its own.
    let one = changed(&|d| d.asset = r#""version":"1.0""#);
    assert!(one.contains(r#"it is glTF "1.0""#), "{one}");
    let one = refused(r#"{"asset":{"version":"1.1"},"accessors":{"a":{}},"meshes":{}}"#);
    assert!(one.contains(r#"it is glTF "1.1""#), "{one}");
}

#[test]
fn gltf_without_triangles_is_told() {
    let desk = Desk::new(TRIANGLE);
    for (document, told) in [
        (
            Document { more: "", ..GOOD },
            "warning: m.gltf: it has no scene, so nothing is drawn\n",
        ),
        (
            Document {
                primitive: r#""attributes":{"POSITION":0},"mode":0"#,
                ..GOOD
            },
            "warning: m.gltf: its scene has no triangles\n\
             warning: m.gltf: primitives of points and lines are left out: 1\n",
        ),
    ] {
        fs::write(desk.path("m.gltf"), document.text()).unwrap();
        assert_eq!(said(&desk, "bake m.gltf -o m.list"), told);
    }
}

#[test]
fn a_picture_that_was_resized_is_told_once() {
    let materials = "newmtl a\nmap_Kd p.png\nnewmtl b\nmap_Kd p.png\n";
    let obj = "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nvt 0 0\nvt 1 0\nvt 0 1\n\
        usemtl a\nf 1/1 2/2 3/3\nusemtl b\nf 3/3 2/2 1/1\n";
    let desk = Desk::new(obj);
    fs::write(desk.path("m.mtl"), materials).unwrap();
    let grey = host_tests::image_out::Frame::new(3, 5, vec![128; 45]).unwrap();
    host_tests::image_out::write_image(&desk.path("p.png"), &grey).unwrap();
    for (line, lines) in [
        ("bake m.obj -o m.list", 1),
        ("bake m.obj -o m.list --texture p.png", 1),
        // And that its texels are rounded.
        ("render m.obj -o o.png", 2),
    ] {
        let text = said(&desk, line);
        assert_eq!(
            text.matches("resized from 3x5").count(),
            1,
            "{line}: {text}"
        );
        assert_eq!(text.lines().count(), lines, "{line}: {text}");
    }
}

#[test]
fn missing_files_are_told_in_the_same_words() {
    let desk = Desk::new(TRIANGLE);
    for line in [
        "render none.obj -o o.png",
        "trace none.obj --line 0",
        "bake none.obj -o m.list",
        "bake none.gltf -o m.list",
        "bake m.obj -o none/m.list",
        "run-list none.list --print",
        "render m.obj -o none/o.png",
        "render m.obj -o o.png --texture none.png",
        "render m.obj -o o.png --stats none/s.json",
        "render none.json -o o.png",
        "plan none.json",
        "view none.json --frames 1",
    ] {
        let text = desk.refused(line);
        assert!(
            text.ends_with(": No such file or directory\n"),
            "{line}: {text}"
        );
        assert!(!text.contains("os error"), "{line}: {text}");
    }
}

/// Kills: a picture of a material, a list or a scene that is refused without the file and the place that name it.
#[test]
fn what_is_wrong_is_named_with_its_place() {
    let desk =
        Desk::new("mtllib m.mtl\nusemtl a\nv 0 0 0\nv 1 0 0\nv 0 1 0\nvt 1 1\nf 1/1 2/1 3/1\n");
    fs::write(desk.path("m.mtl"), "newmtl a\nKd 1 1 1\nmap_Kd p.gif\n").unwrap();
    let picture =
        "error: m.mtl:3: texture p.gif: unknown picture extension, .png, .jpg or .ppm is needed\n";
    for line in [
        "render m.obj -o o.png",
        "bake m.obj -o m.list",
        "view m.obj --frames 1",
    ] {
        assert_eq!(desk.refused(line), picture);
    }
    // What is written has two forms alone.
    let written = desk.refused("render m.obj -o o.gif");
    assert!(written.ends_with(".png or .ppm is needed\n"), "{written}");
    // A list of version 2.
    fs::write(desk.path("m.list"), 0x0200_0000_u32.to_ne_bytes()).unwrap();
    let version = "error: m.list: list: offset 0x0: version 2 is unknown\n";
    for line in [
        "disassemble m.list",
        "run-list m.list --print",
        "run-list m.list -o o.png",
    ] {
        assert_eq!(desk.refused(line), version);
    }
    let size = desk.refused("run-list m.list -o o.png --size 9x1017");
    assert!(size.contains("no --size above 1016x1016"), "{size}");
    let help = |command: &str| String::from_utf8(desk.run(command).stdout).unwrap();
    assert!(help("run-list --help").contains("1x1 to 1016x1016"));
    assert!(help("render --help").contains("1x1 to 8192x8192"));
    for (object, field) in [
        (r#"{"model": ""}"#, "model"),
        (r#"{"model": "m.obj", "texture": ""}"#, "texture"),
    ] {
        let camera = r#"{"eye": [0, 0, 3], "at": [0, 0, 0]}"#;
        let scene = format!(r#"{{"size": [8, 8], "camera": {camera}, "objects": [{object}]}}"#);
        fs::write(desk.path("s.json"), scene).unwrap();
        let want = format!("error: s.json: object 0: `{field}` needs a name\n");
        assert_eq!(desk.refused("render s.json -o o.png"), want);
    }
}

/// Words of lists: one reaches for the master's state, one is of a later version; jumps lead before the list and into it.
/// Kills: a plan that is silent where a player is not; offsets before the list as if they were far behind it.
#[test]
fn plans_tell_of_lists_what_players_tell() {
    let desk = Desk::new(TRIANGLE);
    let list = |words: &[u32]| {
        let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
        fs::write(desk.path("m.list"), bytes).unwrap();
    };
    const END: u32 = 1 << 24;
    for (block, event) in [(15 << 28, "AccessViolation"), (8 << 28, "Unimplemented")] {
        list(&[END, END]);
        assert_eq!(said(&desk, "plan m.list"), "");
        list(&[block | 1 << 24, END]);
        let want = format!("warning: m.list: {event}, first at offset 0x0, 1 times\n");
        assert_eq!(said(&desk, "run-list m.list -o o.png"), want);
        assert_eq!(said(&desk, "plan m.list"), want);
    }
    let jump = 1 << 24 | 4 << 16;
    list(&[jump, 0, jump, -9_i32 as u32]);
    let output = desk.run("disassemble m.list");
    let text = String::from_utf8(output.stdout).unwrap();
    assert!(text.contains("jump by 0 words to 00000008\n"), "{text}");
    assert!(text.contains("jump by -9 words to -00000014\n"), "{text}");
}

#[test]
fn a_model_out_of_range_is_named() {
    let desk = Desk::new("v 0 0 0\nv 1e37 0 0\nv 0 1e37 0\nf 1 2 3\n");
    for line in [
        "render m.obj -o o.png",
        "trace m.obj --line 3",
        "view m.obj --frames 1",
    ] {
        let text = desk.refused(line);
        assert!(
            text.starts_with("error: m.obj: the model is too large"),
            "{line}: {text}"
        );
    }
}

#[cfg(unix)]
#[test]
fn links_are_written_through() {
    use std::os::unix::fs::symlink;
    let desk = Desk::new(TRIANGLE);
    fs::create_dir(desk.path("far")).unwrap();
    fs::write(desk.path("far/old.png"), "old").unwrap();
    // To a file, by two links, and to nothing yet.
    symlink("far/old.png", desk.path("a.png")).unwrap();
    symlink("a.png", desk.path("b.png")).unwrap();
    symlink("far/new.png", desk.path("c.png")).unwrap();
    for (link, target) in [
        ("a.png", "far/old.png"),
        ("b.png", "far/old.png"),
        ("c.png", "far/new.png"),
    ] {
        fs::write(desk.path("far/old.png"), "old").unwrap();
        assert_eq!(
            said(&desk, &format!("render m.obj -o {link} --size 9x9")),
            ""
        );
        let is_link = fs::symlink_metadata(desk.path(link)).unwrap().is_symlink();
        assert!(is_link, "{link}");
        let picture = host_tests::image_out::read_image(&desk.path(target)).unwrap();
        assert_eq!((picture.width(), picture.height()), (9, 9), "{link}");
    }
    // In a circle.
    symlink("e.png", desk.path("d.png")).unwrap();
    symlink("d.png", desk.path("e.png")).unwrap();
    assert!(
        desk.refused("render m.obj -o d.png")
            .contains("in a circle")
    );
}

/// Kills: a file that is made beside a pipe or a device, or takes its place.
#[cfg(target_os = "linux")]
#[test]
fn pipes_and_devices_are_written_as_they_are() {
    let desk = Desk::new(TRIANGLE);
    let output = desk.run("render m.obj -o a.png --size 9x9 --stats /dev/stdout");
    assert_eq!(output.status.code(), Some(0), "{output:?}");
    let figures: serde_json::Value = serde_json::from_slice(&output.stdout).unwrap();
    assert_eq!(figures["objects_in"], 1);
    std::os::unix::fs::symlink("/dev/null", desk.path("f.png")).unwrap();
    assert_eq!(said(&desk, "render m.obj -o f.png --size 9x9"), "");
    assert!(fs::read(desk.path("f.png")).unwrap().is_empty());
    let line = "render m.obj -o a.png --size 9x9 --stats /dev/full";
    let end = "/dev/full: cannot be written: No space left on device";
    assert!(desk.refused(line).contains(end));
}
