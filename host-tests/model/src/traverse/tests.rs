//! Traversals against triangles in whole numbers.

use super::*;
use crate::exact::{column_exact, first_at};
use crate::random::Rng;
use std::vec::Vec;

fn triangle(rng: &mut Rng, size: u32) -> [(u16, u16); 3] {
    // Not at the picture's rim alone, and slivers among them.
    let base = (rng.below(200), rng.below(200));
    let (wide, high) = match rng.below(4) {
        0 => (size, 9),
        1 => (9, size),
        _ => (size, size),
    };
    [(); 3].map(|()| {
        let x = base.0 + rng.below(wide);
        let y = base.1 + rng.below(high);
        (x as u16, y as u16)
    })
}

/// The pixels that the scanline path covers: exact columns between the edges of each line.
fn scanlines(corners: [(u16, u16); 3]) -> Vec<(i32, i32)> {
    let mut c = corners;
    c.sort_by_key(|p| p.1);
    let [top, middle, bottom] = c;
    let mut pixels = Vec::new();
    for line in first_at(top.1)..first_at(bottom.1) {
        let long = column_exact(top, bottom, line);
        let short = if line < first_at(middle.1) {
            column_exact(top, middle, line)
        } else {
            column_exact(middle, bottom, line)
        };
        for column in long.min(short)..long.max(short) {
            pixels.push((column, line));
        }
    }
    pixels.sort_unstable();
    pixels
}

/// The pixels of a traversal, each as often as it was visited.
fn visited(corners: [(u16, u16); 3], grid: Grid) -> Vec<(i32, i32)> {
    let clusters = Traversal::new(corners, grid);
    let mut pixels: Vec<_> = clusters.flat_map(Cluster::pixels).collect();
    pixels.sort_unstable();
    pixels
}

/// All renderers of an interleave together.
fn by_all(corners: [(u16, u16); 3], grid: Grid, factor: (u8, u8)) -> Vec<(i32, i32)> {
    let mut pixels = Vec::new();
    for x in 0..factor.0 {
        for y in 0..factor.1 {
            let own = grid.interleaved(factor, (x, y)).unwrap();
            let (width, height) = grid.cluster();
            for (column, line) in visited(corners, own) {
                let of = |at: i32, size: u32, factor: u8| at / size as i32 % i32::from(factor);
                assert_eq!(of(column, width, factor.0), i32::from(x));
                assert_eq!(of(line, height, factor.1), i32::from(y));
                pixels.push((column, line));
            }
        }
    }
    pixels.sort_unstable();
    pixels
}

#[test]
fn every_cluster_and_interleave_visits_the_scanline_pixels() {
    let mut rng = Rng(1);
    let mut pixels = 0;
    for i in 0..24 {
        let corners = triangle(&mut rng, [60, 320, 640][i % 3]);
        let expected = scanlines(corners);
        pixels += expected.len();
        for width in 1..=8 {
            for height in 1..=4 {
                let strip = u16::from(width) * [1, 2, 4, 16][i % 4];
                let grid = Grid::new((width, height), strip).unwrap();
                for x in 1..=4 {
                    for y in 1..=4 {
                        let got = by_all(corners, grid, (x, y));
                        assert_eq!(
                            got, expected,
                            "{corners:?} {width}x{height}, {x}x{y} renderers"
                        );
                    }
                }
            }
        }
    }
    assert!(pixels > 1_000, "{pixels}");
}

#[test]
fn random_triangles_of_any_size() {
    let mut rng = Rng(2);
    let mut directions = [0; 4];
    for i in 0..6_000 {
        let corners = triangle(&mut rng, [16, 100, 700, 1500][i % 4]);
        let cluster = (1 + rng.below(8) as u8, 1 + rng.below(4) as u8);
        let strip = u16::from(cluster.0) * (1 + rng.below(8) as u16);
        let grid = Grid::new(cluster, strip).unwrap();
        let factor = (1 + rng.below(4) as u8, 1 + rng.below(4) as u8);
        assert_eq!(
            by_all(corners, grid, factor),
            scanlines(corners),
            "{corners:?} {grid:?} {factor:?}"
        );
        let [x, y] = Traversal::new(corners, grid).back;
        directions[usize::from(x) + 2 * usize::from(y)] += 1;
    }
    assert!(directions.iter().all(|n| *n > 300), "{directions:?}");
}

#[test]
fn triangles_without_area_have_no_pixels() {
    let grid = Grid::new((4, 2), 16).unwrap();
    for corners in [
        [(80, 80); 3],
        [(0, 0), (80, 80), (160, 160)],
        [(8, 8), (8, 80), (8, 160)],
    ] {
        assert_eq!(Traversal::new(corners, grid).count(), 0);
    }
    for (cluster, strip) in [
        ((0, 1), 8),
        ((9, 1), 9),
        ((2, 5), 8),
        ((3, 1), 8),
        ((1, 1), 0),
    ] {
        assert_eq!(Grid::new(cluster, strip), None);
    }
    assert_eq!(grid.interleaved((2, 1), (2, 0)), None);
    assert_eq!(grid.interleaved((0, 1), (0, 0)), None);
}

/// The printed formulae, spelled out in both directions.
#[test]
fn corrections_are_those_of_the_text() {
    for x in 0..64i32 {
        for (clx, ilfx) in [(1, 1), (4, 1), (4, 3), (2, 4), (8, 2)] {
            for ilox in 0..ilfx {
                let grid = Grid::new((clx, 1), u16::from(clx)).unwrap();
                let grid = grid.interleaved((ilfx, 1), (ilox, 0)).unwrap();
                let (clx, ilfx, ilox) = (i32::from(clx), i32::from(ilfx), i32::from(ilox));
                let right = -(x % clx) + clx * (ilox - x / clx % ilfx).rem_euclid(ilfx);
                assert_eq!(grid.correction(0, x, false), right);
                let left = x % clx - (clx - 1) + clx * (x / clx % ilfx - ilox).rem_euclid(ilfx);
                assert_eq!(grid.correction(0, x, true), left);
                // The first own cluster that does not lie before x.
                let own =
                    |p: i32| p.rem_euclid(clx) == 0 && p.div_euclid(clx).rem_euclid(ilfx) == ilox;
                let first = (x - clx + 1..).find(|&p| own(p)).unwrap();
                assert_eq!(grid.first(0, x, false), first);
                let first = (-100..=x).rev().find(|&p| own(p)).unwrap();
                assert_eq!(grid.first(0, x, true), first);
            }
        }
    }
}

/// Clusters looked at in vain are few: nothing is searched for twice.
#[test]
fn little_is_looked_at_in_vain() {
    let mut rng = Rng(3);
    let (mut looked, mut found) = (0, 0);
    for _ in 0..2_000 {
        let grid = Grid::new((4, 2), 16).unwrap();
        let mut traversal = Traversal::new(triangle(&mut rng, 900), grid);
        found += traversal.by_ref().count() as u32;
        looked += traversal.looked_at();
    }
    assert!(5 * looked < 8 * found, "{looked} for {found}");
}
