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

/// Dies where a depth of the command line is drawn as another, and where a triangle's block-fix range is that of its
/// farthest corner.
#[test]
fn whole_depths_show_the_same_however_they_are_kept() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.obj"), soup(400)).unwrap();
    for flags in ["", "--shade flat --format rgb565"] {
        let (auto, chosen) = drawn(&folder, flags);
        for more in ["", "--cache 7 --renderers 3"] {
            for depth in ["z32", "id"] {
                let (same, _) = drawn(&folder, &format!("{flags} {more} --depth {depth}"));
                assert!(auto == same, "{flags} {more} --depth {depth}");
            }
        }
        // Without depth what comes last is seen.
        let (last, _) = drawn(&folder, &format!("{flags} --depth priority"));
        assert!(last != auto, "{flags}");
        // 16 bits tell nearly all of them apart.
        for depth in ["block-fix", "word"] {
            let (kept, all) = drawn(&folder, &format!("{flags} --depth {depth}"));
            let places = (0..150).flat_map(|y| (0..200).map(move |x| (x, y)));
            let differ = places.filter(|&(x, y)| differ(kept.pixel(x, y), auto.pixel(x, y)));
            let differ = differ.count();
            println!("{flags}: {differ} of 30000 pixels differ with {depth} depth");
            assert!(differ > 0 && differ < 300, "{flags} {depth}: {differ}");
            // Every pixel is compared, and many more than are seen.
            let compared = all("pixels_shaded") + all("pixels_hidden");
            assert_eq!(all("depth_tests"), compared, "{flags}");
            assert!(chosen("pixels_shaded") < compared, "{flags}");
        }
    }
}

/// Whether another triangle is seen: colours of the laboratory's lines are another rounding.
fn differ(one: Option<[u8; 3]>, other: Option<[u8; 3]>) -> bool {
    match (one, other) {
        (Some(one), Some(other)) => (0..3).any(|i| one[i].abs_diff(other[i]) > 12),
        _ => true,
    }
}

#[test]
fn what_does_not_go_together_is_refused() {
    let folder = tempfile::tempdir().unwrap();
    std::fs::write(folder.path().join("m.obj"), soup(1)).unwrap();
    for flags in [
        "--depth z16",
        "--depth block-fix --interp half",
        "--depth word --cache 3",
        "--depth block-fix --texture t.png",
        "--depth word --format grey8",
        "--depth z32 --interp model",
    ] {
        let output = run(&folder, flags);
        let said = String::from_utf8_lossy(&output.stderr);
        assert_eq!(output.status.code(), Some(2), "{flags}: {said}");
        assert!(said.contains("--depth"), "{flags}: {said}");
        assert!(!folder.path().join("o.png").exists(), "{flags}");
    }
}
