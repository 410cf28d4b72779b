//! Triangles of lists in strips and fans.

use host_tests::lists::strips::*;

#[test]
fn every_triangle_comes_once_and_keeps_its_side() {
    let mut seed = 7u32;
    let mut next = |n: u32| {
        seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
        (seed >> 8) % n
    };
    for size in [1, 2, 5, 30, 400] {
        // A torn grid with some triangles turned over, doubled, or anywhere.
        let mut triangles = Vec::new();
        for _ in 0..size {
            let (x, y) = (next(20), next(20));
            let v = |x: u32, y: u32| 21 * y + x;
            triangles.push([v(x, y), v(x + 1, y), v(x, y + 1)]);
            triangles.push([v(x + 1, y), v(x + 1, y + 1), v(x, y + 1)]);
            if next(9) == 0 {
                triangles.push([next(400), 400 + next(20), 420 + next(20)]);
            }
        }
        let runs = strips_of(&triangles);
        let mut got: Vec<[u32; 3]> = runs.separate.iter().map(|t| turned(*t)).collect();
        got.extend(runs.strips.iter().flat_map(|r| unrolled(r, false)));
        got.extend(runs.fans.iter().flat_map(|r| unrolled(r, true)));
        let mut want: Vec<[u32; 3]> = triangles.iter().map(|t| turned(*t)).collect();
        got.sort_unstable();
        want.sort_unstable();
        assert_eq!(got, want, "{size}");
        assert_eq!(runs.triangles(), triangles.len());
    }
    assert_eq!(strips_of(&[]), Runs::default());
}

#[test]
fn a_band_is_one_strip_and_a_disc_one_fan() {
    let band: Vec<[u32; 3]> = (0..20u32)
        .map(|k| match k % 2 {
            0 => [k, k + 1, k + 2],
            _ => [k + 1, k, k + 2],
        })
        .collect();
    let runs = strips_of(&band);
    assert_eq!((runs.strips.len(), runs.triangles()), (1, 20));
    let disc: Vec<[u32; 3]> = (1..20).map(|k| [0, k, k + 1]).collect();
    let runs = strips_of(&disc);
    assert_eq!((runs.fans.len(), runs.triangles()), (1, 19));
}
