//! Pictures to compress, made by rules that give the same bytes on every machine.

use super::Texel;

/// Texels a side of [`stone`].
pub const STONE: u32 = 64;
/// Texels a side of [`leaves`].
pub const LEAVES: u32 = 32;

/// Any number from a place.
fn hashed(x: u32, y: u32, seed: u32) -> f64 {
    let mut h = x.wrapping_mul(0x9E37_79B9) ^ y.wrapping_mul(0x85EB_CA6B) ^ seed;
    h = (h ^ h >> 15).wrapping_mul(0x2C1B_3C6D);
    h = (h ^ h >> 12).wrapping_mul(0x297A_2D39);
    f64::from(h >> 16) / 65536.0
}

/// Smooth noise, 0 to 1, of `cells` cells a side of a picture that repeats.
fn noise(at: [u32; 2], side: u32, cells: u32, seed: u32) -> f64 {
    let place = at.map(|at| f64::from(at * cells) / f64::from(side));
    let [x, y] = place.map(|place| place as u32);
    let [u, v] = place.map(|place| place - place.floor());
    let [u, v] = [u, v].map(|t| t * t * (3.0 - 2.0 * t));
    let corner = |i: u32, k: u32| hashed((x + i) % cells, (y + k) % cells, seed);
    let [top, bottom] = [0, 1].map(|k| corner(0, k) + (corner(1, k) - corner(0, k)) * u);
    top + (bottom - top) * v
}

fn mixed(a: [f64; 3], b: [f64; 3], part: f64) -> [f64; 3] {
    [0, 1, 2].map(|i| a[i] + (b[i] - a[i]) * part)
}

fn texel(rgb: [f64; 3]) -> Texel {
    Some(rgb.map(|level| level.round().clamp(0.0, 255.0) as u8))
}

/// Rows of a square from the top.
fn square(side: u32, texel: impl Fn(u32, u32) -> Texel) -> Vec<Texel> {
    (0..side * side)
        .map(|i| texel(i % side, i / side))
        .collect()
}

/// Slabs of stone with joints of moss between them, 64 x 64: grain, shades of several hues, and sharp lines.
#[must_use]
pub fn stone() -> Vec<Texel> {
    square(STONE, |x, y| {
        let of = |cells, seed| noise([x, y], STONE, cells, seed);
        let cloud = 0.6 * of(4, 1) + 0.3 * of(8, 2) + 0.1 * of(32, 3);
        let row = y / 16;
        let across = (x + 16 * (row % 2)) % STONE;
        let slab = hashed(across / 32, row, 4);
        let stone = mixed([96.0, 88.0, 84.0], [214.0, 184.0, 140.0], cloud);
        let stone = mixed(stone, [120.0, 140.0, 180.0], 0.4 * slab);
        let is_joint = y % 16 < 2 || across % 32 < 2;
        let moss = mixed([28.0, 40.0, 20.0], [90.0, 120.0, 40.0], of(16, 5));
        texel(if is_joint { moss } else { stone })
    })
}

/// Leaves with nothing between them, 32 x 32.
#[must_use]
pub fn leaves() -> Vec<Texel> {
    square(LEAVES, |x, y| {
        let of = |cells, seed| noise([x, y], LEAVES, cells, seed);
        let is_leaf = 0.7 * of(4, 6) + 0.3 * of(8, 7) > 0.45;
        let green = mixed([20.0, 70.0, 24.0], [170.0, 200.0, 60.0], of(8, 8));
        if is_leaf { texel(green) } else { None }
    })
}

/// All hues at all brightnesses, 64 x 64: colours that change along no one line.
#[must_use]
pub fn hues() -> Vec<Texel> {
    square(64, |x, y| {
        let (hue, light) = (f64::from(x) / 64.0 * 6.0, f64::from(y) / 63.0);
        let channel = |shift: f64| {
            let away = ((hue + shift) % 6.0 - 3.0).abs() - 1.0;
            let full = 255.0 * away.clamp(0.0, 1.0);
            full * light
        };
        texel([channel(0.0), channel(4.0), channel(2.0)])
    })
}
