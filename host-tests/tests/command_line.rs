//! The command line tool from outside: bad input gives one line on stderr, exit code 2 and no
//! file; the smallest, largest and emptiest pictures come out whole.

use crate::common::Rng;
use host_tests::image_out::{Frame, read_image};
use host_tests::model::Model;
use host_tests::reference::{Options, View, compare, render, render_with};
use std::fmt::Write;
use std::fs;
use std::path::Path;
use std::process::{Command, Output};
use tempfile::TempDir;

const TRIANGLE: &str = "v -1 -1 0 1 0 0\nv 1 -1 0 0 1 0\nv 0 1 0 0 0 1\nf 1 2 3\n";

/// A folder with a model in it, and the tool run there.
pub(crate) struct Desk(TempDir);

impl Desk {
    pub(crate) fn new(obj: impl AsRef<[u8]>) -> Self {
        let desk = Self(tempfile::tempdir().unwrap());
        fs::write(desk.path("m.obj"), obj).unwrap();
        desk
    }

    pub(crate) fn path(&self, name: &str) -> std::path::PathBuf {
        self.0.path().join(name)
    }

    pub(crate) fn run(&self, line: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_scanbeam"))
            .args(line.split_whitespace())
            .current_dir(self.0.path())
            .output()
            .unwrap()
    }

    pub(crate) fn files(&self) -> Vec<String> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> = entries
            .map(|e| e.unwrap().file_name().into_string().unwrap())
            .collect();
        names.sort();
        names
    }

    /// Runs a line that must be refused; hands out what it says.
    pub(crate) fn refused(&self, line: &str) -> String {
        let before = self.files();
        let output = self.run(line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(output.stdout.is_empty(), "{line}: {:?}", output.stdout);
        assert_eq!(text.lines().count(), 1, "{line}: {text}");
        assert!(text.ends_with('\n') && text.len() > 15, "{line}: {text}");
        assert!(!text.contains("panicked"), "{line}: {text}");
        assert_eq!(self.files(), before, "{line}: something was written");
        text
    }

    /// Runs a line that must draw `o.png`; hands out the picture.
    pub(crate) fn drawn(&self, line: &str) -> Frame {
        let (frame, text) = self.told(line);
        assert_eq!(text, "", "{line}");
        frame
    }

    /// Runs a line that must draw `o.png`; hands out the picture, and what is told beside it.
    pub(crate) fn told(&self, line: &str) -> (Frame, String) {
        let output = self.run(line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}: {text}");
        (read_image(&self.path("o.png")).unwrap(), text)
    }
}

#[test]
fn malformed_models_are_refused_with_file_and_line() {
    for (obj, line) in [
        ("v 1 2\n", 1),
        ("v 1 2 x\n", 1),
        ("v 0 0 0\nv nan 0 0\n", 2),
        ("v 0 0 0\nv inf 0 0\n", 2),
        ("v 0 0 0\nv 1e999 0 0\n", 2),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2\n", 4),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 4\n", 4),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 0 1 2\n", 4),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf -1 -2 -4\n", 4),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 99999999999999999999\n", 4),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1//1 2//1 3//1\n", 4),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1/1 2/1 3/1\n", 4),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\nf a b c\n", 4),
    ] {
        let desk = Desk::new(obj);
        let text = desk.refused("render m.obj -o o.png --stats s.json");
        let place = format!("m.obj:{line}: ");
        assert!(text.contains(&place), "{obj:?}: {text}");
    }
    let desk = Desk::new(b"v 0 0 0\n\xFF\xFE\n");
    assert!(desk.refused("render m.obj -o o.png").contains("m.obj:2"));
}

#[test]
fn models_that_cannot_be_read_are_refused() {
    let desk = Desk::new(TRIANGLE);
    assert!(
        desk.refused("render nothing.obj -o o.png")
            .contains("nothing.obj")
    );
    fs::create_dir(desk.path("folder.obj")).unwrap();
    desk.refused("render folder.obj -o o.png");
}

#[test]
fn bad_flags_are_refused() {
    let desk = Desk::new(TRIANGLE);
    for line in [
        "paint m.obj",
        "render",
        "render m.obj",
        "render -o o.png",
        "render m.obj -o o.bmp",
        "render m.obj -o o",
        "render m.obj -o o.png --size 0x0",
        "render m.obj -o o.png --size 0x10",
        "render m.obj -o o.png --size 10x0",
        "render m.obj -o o.png --size 8193x1",
        "render m.obj -o o.png --size 1x8193",
        "render m.obj -o o.png --size 99999999999999999999x1",
        "render m.obj -o o.png --size 16",
        "render m.obj -o o.png --what",
        "render m.obj -o o.png --fov 0",
        "render m.obj -o o.png --fov 180",
        "render m.obj -o o.png --near 0",
        "render m.obj -o o.png --near 5 --far 4",
        "render m.obj -o o.png --eye 0,0,0",
        "render m.obj -o o.png --eye nan,0,0",
        "render m.obj -o o.png --up 0,0,1",
        "render m.obj -o o.png --light 0,0,0",
        "render m.obj -o o.png --ambient 2",
        "render m.obj -o o.png --shade best",
        "render m.obj -o o.png --cull front",
        "render m.obj -o o.png --background 1,2,256",
        "render m.obj -o m.obj",
        "render m.obj -o o.png --stats o.png",
    ] {
        desk.refused(line);
    }
}

#[test]
fn what_cannot_be_written_leaves_nothing() {
    let desk = Desk::new(TRIANGLE);
    desk.refused("render m.obj -o nowhere/o.png");
    desk.refused("render m.obj -o m.obj/o.png");
    fs::create_dir(desk.path("folder.png")).unwrap();
    desk.refused("render m.obj -o folder.png");
    // The picture alone is not half of what was asked for.
    desk.refused("render m.obj -o o.png --stats nowhere/s.json");
    fs::create_dir(desk.path("folder.json")).unwrap();
    desk.refused("render m.obj -o o.png --stats folder.json");
    // A picture that was there is still the old one.
    fs::write(desk.path("o.png"), "old").unwrap();
    desk.refused("render m.obj -o o.png --size 0x0");
    desk.refused("render nothing.obj -o o.png");
    desk.refused("render m.obj -o o.png --stats nowhere/s.json");
    assert_eq!(fs::read(desk.path("o.png")).unwrap(), b"old");
}

#[test]
fn empty_models_give_the_background() {
    let nothing = "warning: m.obj: it has no faces, so nothing is drawn\n";
    for (obj, said) in [
        ("", nothing),
        ("# nothing\n", nothing),
        ("v 0 0 0\nv 1 0 0\nv 0 1 0\n", nothing),
        // No area.
        ("v 0 0 0\nv 1 0 0\nv 2 0 0\nf 1 2 3\nf 1 1 1\n", ""),
        // Behind the eye.
        ("v 0 0 9\nv 1 0 9\nv 0 1 9\nf 1 2 3\n", ""),
    ] {
        let desk = Desk::new(obj);
        let (frame, told) = desk.told("render m.obj -o o.png --size 17x9 --background 9,8,7");
        assert_eq!(told, said, "{obj:?}");
        assert_eq!((frame.width(), frame.height()), (17, 9));
        assert!(frame.rgb().chunks(3).all(|p| p == [9, 8, 7]), "{obj:?}");
        assert_eq!(desk.files(), ["m.obj", "o.png"]);
    }
}

#[test]
fn the_smallest_and_largest_pictures_come_out_whole() {
    let desk = Desk::new(TRIANGLE);
    let model = Model::from_obj_text(TRIANGLE, Path::new("m.obj")).unwrap();
    for (width, height) in [
        (1, 1),
        (8192, 16),
        (16, 8192),
        (8191, 3),
        (8192, 1),
        (1, 8192),
    ] {
        let frame = desk.drawn(&format!(
            "render m.obj -o o.png --size {width}x{height} --fov 120"
        ));
        let view = View {
            width,
            height,
            fov: 120.0,
            ..View::default()
        };
        let reference = render(&model, &view).unwrap();
        let c = compare(&reference, [0; 3], &frame).unwrap();
        assert!(
            c.differing_pixels == 0 && c.covered_differently_away == 0,
            "{width}x{height}: {c:?}"
        );
    }
    // Both formats hold the same picture.
    let png = desk.drawn("render m.obj -o o.png");
    assert!(desk.run("render m.obj -o o.ppm").status.success());
    assert_eq!(read_image(&desk.path("o.ppm")).unwrap(), png);
}

/// A wavy sheet of `2 n n` triangles that fills the picture.
fn sheet(n: u32) -> String {
    let mut text = String::new();
    for y in 0..=n {
        for x in 0..=n {
            let (u, v) = (f64::from(x) / f64::from(n), f64::from(y) / f64::from(n));
            let z = 0.2 * (7.0 * u).sin() * (5.0 * v).cos();
            let (x, y) = (5.0 * u - 2.5, 4.0 * v - 2.0);
            writeln!(text, "v {x:.6} {y:.6} {z:.6} {u:.6} {v:.6} {:.6}", 1.0 - u).unwrap();
        }
    }
    for y in 0..n {
        for x in 0..n {
            let a = y * (n + 1) + x + 1;
            let (b, c, d) = (a + 1, a + n + 2, a + n + 1);
            writeln!(text, "f {a} {b} {c}\nf {a} {c} {d}").unwrap();
        }
    }
    text
}

#[test]
fn a_hundred_thousand_triangles_of_a_sheet_give_a_whole_picture() {
    // 100,352 of them.
    let fine = Desk::new(sheet(224));
    let flags = "render m.obj -o o.png --size 320x240 --background 255,0,255 --stats s.json";
    let frame = fine.drawn(flags);
    // A sheet of far fewer triangles has nearly the same colours everywhere.
    let coarse = Desk::new(sheet(56)).drawn(flags);
    for (i, (a, b)) in frame.rgb().iter().zip(coarse.rgb()).enumerate() {
        assert!(a.abs_diff(*b) <= 4, "pixel {}: {a} and {b}", i / 3);
    }
    assert!(frame.rgb().chunks(3).all(|p| p != [255, 0, 255]), "a hole");
    let stats = figures(&fine);
    assert!(stats["bands"].as_u64().unwrap() > 1, "{stats}");
    assert_eq!(stats["objects_in"], 2 * 224 * 224);

    // Whatever the bands, a triangle counts once: as in two halves that need no bands.
    let text = sheet(224);
    let (vertices, faces) = text.split_at(text.find("f ").unwrap());
    let faces: Vec<&str> = faces.lines().collect();
    let mut sums = [0; ONCE.len()];
    for half in faces.chunks(faces.len().div_ceil(2)) {
        let desk = Desk::new(format!("{vertices}{}", half.join("\n")));
        desk.drawn(flags);
        let stats = figures(&desk);
        assert_eq!(stats["bands"], 1);
        for (sum, key) in sums.iter_mut().zip(ONCE) {
            *sum += stats[key].as_u64().unwrap();
        }
    }
    assert_eq!(ONCE.map(|key| stats[key].as_u64().unwrap()), sums);
    // Those on the borders of parts count in each of these; as many as that are no tenth.
    let vertices = stats["vertices_kept"].as_u64().unwrap();
    assert!(
        (225 * 225..225 * 225 * 11 / 10).contains(&vertices),
        "{vertices}"
    );
}

/// Figures of triangles, each counted once however many bands it is on.
const ONCE: [&str; 4] = [
    "objects_in",
    "objects_culled",
    "objects_clipped",
    "objects_kept",
];

/// What `--stats s.json` wrote.
fn figures(desk: &Desk) -> serde_json::Value {
    let text = fs::read_to_string(desk.path("s.json")).unwrap();
    serde_json::from_str(&text).unwrap()
}

#[test]
fn a_missing_material_file_is_a_warning_and_the_picture_is_drawn() {
    let desk = Desk::new(format!("mtllib missing.mtl\nusemtl red\n{TRIANGLE}"));
    let output = desk.run("render m.obj -o o.png --size 40x30");
    assert!(output.status.success());
    let said = String::from_utf8(output.stderr).unwrap();
    assert_eq!(
        said.trim_end(),
        "warning: m.obj:1: material file \"missing.mtl\" is not there"
    );
    assert_eq!(desk.files(), ["m.obj", "o.png"]);
}

#[test]
fn a_hundred_thousand_triangles_at_random_are_drawn() {
    let mut rng = Rng::new(41);
    let mut text = String::new();
    for _ in 0..100_000 {
        let centre = [(); 3].map(|()| 1.3 * rng.signed());
        for _ in 0..3 {
            let [x, y, z] = centre.map(|c| c + 0.03 * rng.signed());
            let [r, g, b] = [(); 3].map(|()| f64::from(rng.below(101)) / 100.0);
            writeln!(text, "v {x:.5} {y:.5} {z:.5} {r} {g} {b}").unwrap();
        }
        text.push_str("f -3 -2 -1\n");
    }
    let desk = Desk::new(&text);
    let frame = desk.drawn("render m.obj -o o.png --size 200x150");
    let model = Model::from_obj_text(&text, Path::new("m.obj")).unwrap();
    let view = View {
        width: 200,
        height: 150,
        ..View::default()
    };
    // All of it is beside edges, so the reference takes its corners from the 1/8-pixel grid too
    // and every pixel is compared.
    let options = Options {
        steps_per_pixel: Some(8.0),
    };
    let reference = render_with(&model, &view, options).unwrap();
    let differs = reference
        .colour
        .iter()
        .zip(frame.rgb().chunks(3))
        .filter(|(want, got)| (0..3).any(|i| (want[i] - f64::from(got[i])).abs() > 2.0))
        .count();
    assert!(differs < 200 * 150 / 500, "{differs} pixels differ");
    let c = compare(&reference, [0; 3], &frame).unwrap();
    assert!(
        c.differing_pixels == 0 && c.covered_reference > 15_000,
        "{c:?}"
    );
}

/// More triangles on one line than an arena can hold: those that fit are drawn, and what does not
/// is told in one line.
#[test]
fn of_too_many_triangles_on_one_line_the_rest_is_drawn_and_told() {
    let mut text = String::from("v -1 -1 0\nv 1 -1 0\nv 0 1 0\n");
    for _ in 0..70_000 {
        text.push_str("f 1 2 3\n");
    }
    let line = "render m.obj -o o.png --size 64x64";
    let (frame, said) = Desk::new(&text).told(line);
    assert_eq!(said.lines().count(), 1, "{said}");
    assert!(said.starts_with("warning: m.obj: line "), "{said}");
    assert!(
        said.contains("full") && said.contains("the rest is drawn"),
        "{said}"
    );
    // They are all the same.
    let one = "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n";
    assert_eq!(frame, Desk::new(one).drawn(line));
    let help = Desk::new(one).run("render --help");
    let help = String::from_utf8(help.stdout).unwrap();
    assert!(
        help.contains("61,440 triangles and 65,536 vertices"),
        "{help}"
    );
}

#[test]
fn stats_have_every_key_of_the_contract() {
    let desk = Desk::new(TRIANGLE);
    desk.drawn("render m.obj -o o.png --stats s.json --size 40x30");
    let stats = figures(&desk);
    for key in [
        "/objects_in",
        "/objects_culled",
        "/spans",
        "/spans_hidden",
        "/pixels_shaded",
        "/pixels_hidden",
        "/depth_tests",
        "/texture_fetches",
        "/scanlines_skipped",
        "/bytes_sent",
        "/cache/hits",
        "/cache/misses",
        "/cache/spills",
        "/cache/slow_read_bytes",
        "/cache/slow_write_bytes",
        "/cache/peak_slots",
        "/ram/slow_bytes",
        "/ram/fast_bytes",
        "/ram/line_bytes",
    ] {
        let value = stats.pointer(key);
        assert!(
            value.is_some_and(serde_json::Value::is_u64),
            "{key}: {value:?}"
        );
    }
    let number = |key: &str| stats.pointer(key).unwrap().as_u64().unwrap();
    assert_eq!(number("/objects_in"), 1);
    assert_eq!(number("/bytes_sent"), 40 * 30 * 3);
    assert_eq!(number("/pixels_hidden"), 0);
    let frame = read_image(&desk.path("o.png")).unwrap();
    let covered = frame.rgb().chunks(3).filter(|p| *p != [0; 3]).count();
    assert_eq!(number("/pixels_shaded"), covered as u64);
    assert_eq!(desk.files(), ["m.obj", "o.png", "s.json"]);
}

/// Kills: a pace that is not handed on, and figures that are not those of the picture.
#[test]
fn a_pace_lowers_quality_and_tells_what_was_paid() {
    let desk = Desk::new(sheet(14));
    let flags = "render m.obj -o o.png --size 320x240 --format rgb565 --stats s.json";
    let whole = desk.drawn(flags);
    assert_eq!(figures(&desk)["paid"], serde_json::Value::Null);
    let paid = |key: &str| figures(&desk)["paid"][key].as_u64().unwrap();
    assert!(desk.drawn(&format!("{flags} --pace 4000000")) == whole);
    assert!(paid("dearest") > 2280 && paid("lines") == 0);
    let (frame, text) = desk.told(&format!("{flags} --pace 12000"));
    let [lines, even, joined, unsorted] = ["lines", "even", "joined", "unsorted"].map(paid);
    let [left_out, late, lost] = ["left_out", "late", "lost"].map(paid);
    let told = format!(
        "note: {lines} lines would have cost too much: pixels of even runs {even}, of runs joined to others {joined}, not \
         compared {unsorted}, left out {left_out}; triangles late {late}, lost {lost}\n"
    );
    assert_eq!(text, told);
    assert!(lines > 50 && even > 1000 && joined > 1000, "{text}");
    assert!((9_000..=12_000).contains(&paid("dearest")));
    let pairs = frame.rgb().chunks(3).zip(whole.rgb().chunks(3));
    let differ = pairs.filter(|(a, b)| a != b).count();
    assert!(differ > 1000, "{differ}");
}
