//! `render --depth`: every method that keeps whole depths shows the same picture of a soup of
//! triangles, and what each skips is in the figures (X3, M4).

use crate::common::Rng;
use host_tests::image_out::{Frame, read_image};
use std::fmt::Write;
use std::process::{Command, Output};
use tempfile::TempDir;

/// Triangles at random through each other, coloured at their corners.
fn soup(count: u32) -> String {
    let mut rng = Rng::new(5);
    let mut text = String::new();
    for face in 0..count {
        let middle = [rng.signed(), rng.signed(), 0.8 * rng.signed()];
        for _ in 0..3 {
            let at = middle.map(|m| m + 0.5 * rng.signed());
            let colour = [(); 3].map(|()| f64::from(rng.below(1000)) / 1000.0);
            let [x, y, z] = at;
            let [r, g, b] = colour;
            writeln!(text, "v {x} {y} {z} {r} {g} {b}").unwrap();
        }
        let first = 3 * face + 1;
        writeln!(text, "f {first} {} {}", first + 1, first + 2).unwrap();
    }
    text
}

fn run(folder: &TempDir, flags: &str) -> Output {
    let line = format!("render m.obj -o o.png --stats s.json --size 200x150 {flags}");
    Command::new(env!("CARGO_BIN_EXE_scanbeam"))
        .args(line.split_whitespace())
        .current_dir(folder.path())
        .output()
        .unwrap()
}

/// The picture, and a figure of it.
fn drawn(folder: &TempDir, flags: &str) -> (Frame, impl Fn(&str) -> u64 + use<>) {
    let output = run(folder, flags);
    let said = String::from_utf8_lossy(&output.stderr).into_owned();
    assert_eq!(output.status.code(), Some(0), "{flags}: {said}");
    let text = std::fs::read_to_string(folder.path().join("s.json")).unwrap();
    let figures: serde_json::Value = serde_json::from_str(&text).unwrap();
    let picture = read_image(&folder.path().join("o.png")).unwrap();
    (picture, move |key: &str| figures[key].as_u64().unwrap())
}

#[test]
fn whole_depths_show_the_same_however_they_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.obj"), soup(60)).unwrap();
    for flags in [
        "",
        "--shade flat --format rgb565",
        "--cache 7 --renderers 3",
    ] {
        let (z32, always) = drawn(&folder, &format!("{flags} --depth z32"));
        let (auto, chosen) = drawn(&folder, flags);
        let (id, once) = drawn(&folder, &format!("{flags} --depth id"));
        assert!(auto == z32 && id == z32, "{flags}");
        assert!(chosen("depth_tests") <= always("depth_tests"), "{flags}");
        let all = always("pixels_shaded") + always("pixels_hidden");
        assert_eq!(always("depth_tests"), all, "{flags}");
        assert_eq!(
            once("pixels_shaded") + once("pixels_hidden"),
            all,
            "{flags}"
        );
        let fewer = once("pixels_shaded") < always("pixels_shaded");
        // Objects without a slot are drawn as by z32.
        assert!(fewer || flags.contains("--cache 7"), "{flags}");
        // Without depth what comes last is seen, and nothing is tested.
        let (last, none) = drawn(&folder, &format!("{flags} --depth priority"));
        assert!(last != z32, "{flags}");
        assert_eq!(
            (none("depth_tests"), none("pixels_hidden")),
            (0, 0),
            "{flags}"
        );
        // 16 bits tell nearly all of them apart.
        let (fixed, _) = drawn(&folder, &format!("{flags} --depth block-fix"));
        let differ = (0..150)
            .flat_map(|y| (0..200).map(move |x| (x, y)))
            .filter(|&(x, y)| fixed.pixel(x, y) != z32.pixel(x, y))
            .count();
        println!("{flags}: {differ} of 30000 pixels differ with block-fix depth");
        assert!(differ < 300, "{flags}: {differ}");
    }
}

#[test]
fn what_does_not_go_together_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.obj"), soup(1)).unwrap();
    for flags in [
        "--depth z16",
        "--depth id --interp half",
        "--depth block-fix --quality fast",
        "--depth priority --texture t.png",
        "--depth z32 --interp model",
    ] {
        let output = run(&folder, flags);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{flags}: {said}");
        assert!(said.contains("--depth"), "{flags}: {said}");
        assert!(!folder.path().join("o.png").exists(), "{flags}");
    }
}
