//! The fuzz targets' own functions on random bytes, so that each test run tries them a little,
//! and on everything that fuzzing has found (X7, M3).

#[path = "../fuzz/src/files.rs"]
mod files;
#[path = "../fuzz/src/formats.rs"]
mod formats;
#[path = "../fuzz/src/frames/mod.rs"]
mod frames;
#[path = "../fuzz/src/list.rs"]
pub mod list;

use crate::common::Rng;
// `files` finds it here, and in the fuzz package where that has it.
use host_tests::model;

/// Random bytes; half of them mostly zero, which choose the plain things.
fn bytes(rng: &mut Rng, most: u32) -> Vec<u8> {
    let sparse = rng.below(2) == 0;
    (0..rng.below(most))
        .map(|_| {
            if sparse && rng.below(3) != 0 {
                0
            } else {
                rng.below(256) as u8
            }
        })
        .collect()
}

#[test]
fn random_bytes_are_frames() {
    let mut rng = Rng::new(71);
    let covered: usize = (0..10_000)
        .map(|_| frames::run(&bytes(&mut rng, 1200)))
        .sum();
    assert!(covered > 100_000, "{covered}");
}

#[test]
fn random_bytes_are_tokens_and_vertices() {
    let mut rng = Rng::new(72);
    let pixels: usize = (0..100_000)
        .map(|_| formats::run(&bytes(&mut rng, 400)))
        .sum();
    assert!(pixels > 1_000, "{pixels}");
}

#[test]
fn random_bytes_are_lists() {
    let mut rng = Rng::new(74);
    // Few random bytes make a block: three in a thousand tries.
    let words: usize = (0..100_000).map(|_| list::run(&bytes(&mut rng, 240))).sum();
    assert!(words > 200, "{words}");
}

#[test]
fn random_words_are_model_files() {
    const WORDS: [&str; 32] = [
        "v", "vt", "vn", "f", "fo", "usemtl", "newmtl", "Kd", "Ks", "Ns", "d", "Tr", "map_Kd", "g",
        "\n", "\n", "\n", "\n", " ", " ", "1", "2", "3", "-1", "0.5", "1e39", "nan", "1/2/3",
        "1//1", "\\\n", "#", "a",
    ];
    let folder = tempfile::tempdir().unwrap();
    let mut rng = Rng::new(73);
    let mut triangles = 0;
    for i in 0..20_000 {
        let mut text = Vec::new();
        if i % 2 == 0 {
            text.extend(b"v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 3\n");
        }
        for _ in 0..rng.below(24) {
            text.extend(rng.pick(&WORDS).bytes());
            text.push(rng.pick(b"  \n"));
        }
        if i % 16 == 0 {
            text.push(0xFF);
            text.extend(bytes(&mut rng, 40));
        }
        triangles += files::run(&text, folder.path());
        triangles += files::run(&bytes(&mut rng, 60), folder.path());
    }
    assert!(triangles > 500, "{triangles}");
}
