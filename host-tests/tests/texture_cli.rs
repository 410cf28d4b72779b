//! `render --texture` and `map_Kd` from outside: what cannot be read gives one line on stderr, exit
//! code 2 and no file; pictures of other sizes are resized, with a note.

use host_tests::image_out::{Frame, read_image, write_image};
use std::fs;
use std::path::PathBuf;
use std::process::{Command, Output};
use tempfile::TempDir;

/// A square over the picture's middle, with the texture once on it.
const SQUARE: &str = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\nvt 0 0\nvt 1 0\nvt 1 1\nvt 0 1\n";
const FACE: &str = "f 1/1 2/2 3/3 4/4\n";

/// A folder with models and pictures in it, and the tool run there.
struct Desk(TempDir);

impl Desk {
    fn new() -> Self {
        let desk = Self(tempfile::tempdir().unwrap());
        desk.write("m.obj", format!("{SQUARE}{FACE}"));
        write_image(&desk.path("t.png"), &picture(16, 16)).unwrap();
        desk
    }

    fn path(&self, name: &str) -> PathBuf {
        self.0.path().join(name)
    }

    fn write(&self, name: &str, bytes: impl AsRef<[u8]>) {
        fs::write(self.path(name), bytes).unwrap();
    }

    fn run(&self, line: &str) -> Output {
        Command::new(env!("CARGO_BIN_EXE_scanbeam"))
            .args(line.split_whitespace())
            .current_dir(self.0.path())
            .output()
            .unwrap()
    }

    fn files(&self) -> Vec<std::ffi::OsString> {
        let entries = fs::read_dir(self.0.path()).unwrap();
        let mut names: Vec<_> = entries.map(|e| e.unwrap().file_name()).collect();
        names.sort();
        names
    }

    /// Runs a line that must be refused with a word about `what`, and leave nothing behind.
    fn refused(&self, line: &str, what: &str) {
        let before = self.files();
        let output = self.run(line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(2), "{line}: {text}");
        assert!(output.stdout.is_empty(), "{line}");
        assert_eq!(text.lines().count(), 1, "{line}: {text}");
        assert!(text.contains(what), "{line}: {text}");
        assert!(!text.contains("panicked"), "{line}: {text}");
        assert_eq!(self.files(), before, "{line}: something was written");
    }

    /// Runs a line that must draw `o.png` with a texture, of 24 bits; the picture, and what was said beside [`ROUNDED`].
    fn drawn(&self, line: &str) -> (Frame, String) {
        let output = self.run(line);
        let text = String::from_utf8(output.stderr).unwrap();
        assert_eq!(output.status.code(), Some(0), "{line}: {text}");
        assert_eq!(text.matches(ROUNDED).count(), 1, "{line}: {text}");
        let rest = text.replace(ROUNDED, "");
        (read_image(&self.path("o.png")).unwrap(), rest)
    }
}

/// Red to the right, green down.
fn picture(width: u32, height: u32) -> Frame {
    let level = |at: u32, side: u32| (40 + at * 200 / side.max(1)) as u8;
    let rgb = (0..height)
        .flat_map(|y| (0..width).flat_map(move |x| [level(x, width), level(y, height), 90]));
    Frame::new(width, height, rgb.collect()).unwrap()
}

/// What is said of every textured picture of 24 bits.
pub(crate) const ROUNDED: &str = "note: texels of textures are rounded to 5, 6 and 5 bits\n";
const DRAW: &str = "render m.obj -o o.png --size 64x64 --fov 60 --eye 0,0,1.7320508 --stats s.json";

#[test]
fn textures_that_cannot_be_read_are_refused() {
    let desk = Desk::new();
    desk.refused(&format!("{DRAW} --texture none.png"), "none.png");
    desk.write("text.png", "this is no picture");
    desk.refused(&format!("{DRAW} --texture text.png"), "text.png");
    desk.write("empty.png", "");
    desk.refused(&format!("{DRAW} --texture empty.png"), "empty.png");
    let whole = fs::read(desk.path("t.png")).unwrap();
    for part in [8, 20, 33, whole.len() / 2, whole.len() - 13] {
        desk.write("cut.png", &whole[..part]);
        desk.refused(&format!("{DRAW} --texture cut.png"), "cut.png");
    }
    let mut broken = whole.clone();
    broken[whole.len() / 2] ^= 0x55;
    desk.write("broken.png", &broken);
    desk.refused(&format!("{DRAW} --texture broken.png"), "broken.png");
    desk.write("t.gif", &whole);
    desk.refused(&format!("{DRAW} --texture t.gif"), "t.gif");
    desk.write("short.ppm", "P6 4 4 255\n123");
    desk.refused(&format!("{DRAW} --texture short.ppm"), "short.ppm");
    for size in ["0 4", "4 0", "99999999 99999999"] {
        desk.write("size.ppm", format!("P6 {size} 255\n"));
        desk.refused(&format!("{DRAW} --texture size.ppm"), "size.ppm");
    }
    fs::create_dir(desk.path("folder.png")).unwrap();
    desk.refused(&format!("{DRAW} --texture folder.png"), "folder.png");
    // The texture itself is not written over, and flags that do not go together are named.
    desk.refused("render m.obj -o t.png --texture t.png", "t.png, which");
    desk.refused(
        &format!("{DRAW} --texture t.png --interp model"),
        "--texture",
    );
    desk.refused(
        &format!("{DRAW} --texture t.png --format rgb565 --pace 9000"),
        "--levels off",
    );
    desk.refused(&format!("{DRAW} --texture t.png --filter cubic"), "cubic");
    desk.refused(&format!("{DRAW} --texture"), "--texture");
    desk.write("bare.obj", "v -1 -1 0\nv 1 -1 0\nv 0 1 0\nf 1 2 3\n");
    let bare = DRAW.replace("m.obj", "bare.obj");
    desk.refused(
        &format!("{bare} --texture t.png"),
        "bare.obj: the model has no texture places (vt)",
    );
}

#[test]
fn materials_whose_pictures_cannot_be_read_are_refused() {
    let desk = Desk::new();
    let with = |map: &str| {
        desk.write("m.mtl", format!("newmtl a\nKd 1 1 1\nmap_Kd {map}\n"));
        desk.write("m.obj", format!("mtllib m.mtl\n{SQUARE}usemtl a\n{FACE}"));
    };
    with("none.png");
    desk.refused(DRAW, "none.png");
    desk.write("text.png", "this is no picture");
    with("text.png");
    desk.refused(DRAW, "text.png");
    with("folder/none.png");
    desk.refused(DRAW, "none.png");
    with("t.gif");
    desk.refused(DRAW, "t.gif");
    // A material that names a picture which is there is drawn by it, without a word.
    with("t.png");
    let (frame, text) = desk.drawn(DRAW);
    assert_eq!(text, "");
    let whole = desk.drawn(&format!("{DRAW} --texture t.png")).0;
    assert_eq!(frame, whole);
    assert_ne!(frame.pixel(8, 8), frame.pixel(56, 8));
    with("t.png\nnewmtl b\nmap_Kd t.png");
    desk.write(
        "m.obj",
        "mtllib m.mtl\nv -1 -1 0\nv 1 -1 0\nv 0 1 0\nusemtl a\nf 1 2 3\n",
    );
    let placeless = "m.obj: the model has no texture places (vt)";
    desk.refused("bake m.obj -o m.list", placeless);
    desk.refused("bake m.obj -o m.list --texture t.png", placeless);
    desk.refused(DRAW, placeless);
    desk.refused("view m.obj --frames 1", placeless);
}

/// Kills: numbers of textures that begin anew after the last of 16 bits.
#[test]
fn more_pictures_than_there_are_numbers_are_refused() {
    let desk = Desk::new();
    let material = |n: usize| format!("newmtl m{n}\nmap_Kd t.png\n");
    desk.write("m.mtl", (0..65_536).map(material).collect::<String>());
    desk.write(
        "m.obj",
        format!("mtllib m.mtl\n{SQUARE}usemtl m65535\n{FACE}"),
    );
    desk.refused(
        DRAW,
        "m.obj: 65536 materials have pictures (map_Kd), of at most 65535",
    );
    // One picture for all is one texture.
    desk.drawn(&format!("{DRAW} --texture t.png"));
}

#[test]
fn other_sizes_are_resized_with_a_note() {
    let desk = Desk::new();
    let straight = desk.drawn(&format!("{DRAW} --texture t.png"));
    assert_eq!(straight.1, "");
    for (width, height, to) in [
        (15, 16, "16x16"),
        (17, 3, "32x4"),
        (1, 1, ""),
        (100, 60, "128x64"),
        (1025, 2, "1024x2"),
        (3, 2000, "4x1024"),
    ] {
        write_image(&desk.path("odd.png"), &picture(width, height)).unwrap();
        let (frame, text) = desk.drawn(&format!("{DRAW} --texture odd.png"));
        if to.is_empty() {
            assert_eq!(text, "");
        } else {
            let from = format!("{width}x{height}");
            assert_eq!(text.lines().count(), 1, "{text}");
            for part in ["note", "odd.png", &from, to] {
                assert!(text.contains(part), "{part}: {text}");
            }
        }
        // The square fills the picture: red is a ramp to the right, green one down.
        for at in [5, 31, 58] {
            let [red, green, blue] = frame.pixel(at, at).unwrap();
            let ramp = |side: u32, level: u8| {
                // A texel and a pixel of another size may stand half of each beside.
                let step = 200.0 * (1.0 / f64::from(side) + 1.0 / 64.0);
                let want = 40.0 + 200.0 * (f64::from(at) + 0.5) / 64.0;
                let low = 40.0 + 200.0 * f64::from(side - 1) / f64::from(side);
                (f64::from(level) - want.min(low)).abs() <= step + 1.0
            };
            assert!(
                ramp(width, red) && ramp(height, green),
                "{width}x{height} {at}: {red} {green}"
            );
            assert_eq!(blue, 90);
        }
    }
}

/// A triangle that stretches over more texels than there are places for is white, and it is said.
#[test]
fn wide_triangles_are_told() {
    let desk = Desk::new();
    write_image(&desk.path("t.png"), &picture(64, 64)).unwrap();
    for (repeats, wide) in [
        (47.0, false),
        (64.0, false),
        (64.0 + 0.5 / 64.0, true),
        (90.0, true),
    ] {
        for (from, slots) in [(0.0, 96), (0.0, 0), (0.25, 96), (-7.5, 1)] {
            let line =
                format!("render m.obj -o o.png --texture t.png --size 24x24 --cache {slots}");
            let to = from + repeats;
            let square = "v -1 -1 0\nv 1 -1 0\nv 1 1 0\nv -1 1 0\n";
            let places = format!("vt {from} 0\nvt {to} 0\nvt {to} 1\nvt {from} 1\n");
            desk.write("m.obj", format!("{square}{places}{FACE}"));
            let (frame, text) = desk.drawn(&line);
            assert_eq!(
                text.contains("drawn without their texture: 2"),
                wide,
                "{text}"
            );
            assert_eq!(text.lines().count(), usize::from(wide), "{text}");
            let white = frame.pixel(12, 12) == Some([255; 3]);
            assert_eq!(white, wide, "{repeats} from {from}");
        }
    }
}

/// One command prints what blocks save.
#[test]
fn the_cache_command_prints_blocks_beside_rows() {
    let output = Command::new(env!("CARGO_BIN_EXE_scanbeam"))
        .arg("cache")
        .output();
    let printed = String::from_utf8(output.unwrap().stdout).unwrap();
    for name in [
        "sphere",
        "ground plane",
        "quad, 30 degrees",
        "page changes",
        "texels re-read",
    ] {
        assert!(printed.contains(name), "{name}:\n{printed}");
    }
}
