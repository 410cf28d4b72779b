//! Triangles that pass one has filed, by what their size and texture make them cost: where they begin, and their spans.

use scanbeam::Scene;
use scanbeam::scene::FiledTriangle;

/// How triangles are told apart: see [`NAMES`].
pub const KINDS: usize = NAMES.len();
/// The kinds: without a texture by size and by whether all corners have the same colour, with one by how places on it are
/// found and by whether its texels are multiplied with colours.
pub const NAMES: [&str; 16] = [
    "tiny",
    "small",
    "large",
    "even small",
    "even large",
    "thin",
    "texels tiny",
    "texels small",
    "texels affine",
    "texels curved",
    "texels steep",
    "lit texels tiny",
    "lit texels small",
    "lit texels affine",
    "lit texels curved",
    "lit texels steep",
];
/// The kind of one colour that is not large.
const EVEN: usize = 3;
/// The kind without a texture that is too thin for its size.
const THIN: usize = 5;
/// The first kind with a texture.
pub const TEXTURED: usize = 6;
/// The first of these in colours.
const LIT: usize = 5;
/// The kinds of large triangles.
pub const LARGE: [usize; 8] = [2, 4, 8, 9, 10, 13, 14, 15];
/// Full light.
const WHITE: [u8; 3] = [255; 3];
/// By how many texels a place may be off that is linear along the screen: a quarter, less what fixed point takes.
const BUDGET: f64 = 3.0 / 16.0;

/// Pixels between two divisions from which on a triangle is steep.
const STEEP: f64 = 12.0;

/// What triangles of a kind have on a line.
#[derive(Debug, Clone, Copy, Default, PartialEq, Eq)]
pub struct Share {
    /// Triangles that begin.
    pub starts: u32,
    /// Of those on one line alone, which have no pixel there: they are no `starts`.
    pub empty: u32,
    /// Spans of at least a pixel.
    pub spans: u32,
    /// Of these, spans between sides of which one is tall and leans: its columns take a division.
    pub tall: u32,
    /// Pixels of all spans.
    pub pixels: u32,
}

/// What each kind has on a line.
pub type Shares = [Share; KINDS];

/// The kind of a triangle.
///
/// Sizes are those that planes are made by: tiny within 28 pixels of the topmost corner, small within 64 with an area of
/// 8, and all others. Corners are in units of 1/8 pixel.
fn kind(triangle: &FiledTriangle, is_textured: bool) -> usize {
    let colours = triangle.corners.map(|corner| corner.colour);
    let [a, b, c] = triangle
        .corners
        .map(|corner| [corner.x, corner.y].map(i32::from));
    let from = |p: [i32; 2], q: [i32; 2]| [q[0] - p[0], q[1] - p[1]];
    let (one, two, three) = (from(a, b), from(a, c), from(b, c));
    let area = (one[0] * two[1] - two[0] * one[1]).abs();
    let reach = [one, two, three].into_iter().flatten().map(i32::abs).max();
    let length = |side: [i32; 2]| side[0].abs() + side[1].abs();
    let far = length(one).max(length(two));
    let is_small = reach < Some(512) && area >= 128;
    if is_textured {
        let lit = if colours == [WHITE; 3] { 0 } else { LIT };
        let size = match is_small {
            true if far < 400 && area >= 256 => 0,
            true => 1,
            false => 2,
        };
        let reach = f64::from(reach.unwrap_or_default()) / 8.0;
        return TEXTURED + lit + way(triangle, size, reach);
    }
    let is_even = colours[1] == colours[0] && colours[2] == colours[0];
    let is_tiny = far < 224 && area >= 256 || far < 200 && area >= 32;
    let is_thin = reach < Some(512) && area < 1024;
    match is_even {
        true if is_tiny || is_small || is_thin => EVEN,
        true => EVEN + 1,
        false if is_tiny => 0,
        false if is_thin => THIN,
        false if is_small => 1,
        false => 2,
    }
}

/// How places on a texture are found, of a triangle of a size, 0 to 2, and of so many pixels: linearly, where
/// that is within what they may be off; by a division for many pixels, or for few.
///
/// Linearly over a stretch of texels they are off by a quarter of it, times by how much its ends are apart in depth, of the
/// farther; over a part of it by the square of that.
fn way(triangle: &FiledTriangle, size: usize, reach: f64) -> usize {
    const UNITS: f64 = (1 << 14) as f64;
    let corners = &triangle.corners;
    let stretch = |axis: usize| {
        let [a, b, c] = corners.map(|corner| f64::from(corner.texel[axis]) / UNITS);
        (a - b).abs().max((a - c).abs()).max((b - c).abs())
    };
    let [a, b, c] = corners.map(|corner| f64::from(corner.depth));
    let (near, far) = (a.max(b).max(c), a.min(b).min(c));
    let off = stretch(0).max(stretch(1)) * (near - far) / far / 4.0;
    if off <= BUDGET {
        return size;
    }
    let pixels = reach / (off / BUDGET).sqrt();
    if pixels >= STEEP { 3 } else { 4 }
}

/// Whether a side leans and has more than 254 lines, which is 2,032 units.
fn is_tall(triangle: &FiledTriangle) -> bool {
    let [a, b, c] = triangle.corners;
    let sides = [(a, b), (a, c), (b, c)];
    sides
        .into_iter()
        .any(|(p, q)| p.x != q.x && i32::from(q.y).abs_diff(p.y.into()) > 2032)
}

/// Columns of a triangle on a line: those whose middles lie between its sides.
fn columns(triangle: &FiledTriangle, line: i32, width: i32) -> i32 {
    let at = f64::from(8 * line + 4);
    let corner = |i: usize| {
        let corner = &triangle.corners[i % 3];
        [f64::from(corner.x), f64::from(corner.y)]
    };
    let crossings = (0..3).filter_map(|i| {
        let ([x, y], [to_x, to_y]) = (corner(i), corner(i + 1));
        ((y <= at) != (to_y <= at)).then(|| x + (to_x - x) * (at - y) / (to_y - y))
    });
    let columns = crossings.map(|x| ((x - 4.0) / 8.0).ceil() as i32);
    let (first, end) = columns.fold((i32::MAX, i32::MIN), |(first, end), column| {
        (first.min(column), end.max(column))
    });
    (end.clamp(0, width) - first.clamp(0, width)).max(0)
}

/// What each kind of a scene has on each line.
pub fn shares<L>(scene: &Scene<'_, '_, L>) -> Vec<Shares> {
    let width = i32::from(scene.screen().width());
    let mut all = vec![Shares::default(); scene.lines().len()];
    for triangle in scene.triangles() {
        let state = scene.draw_state(triangle.call);
        let kind = kind(
            &triangle,
            state.is_some_and(|state| !state.is_colours_alone()),
        );
        let (mut begins, is_tall) = (1, is_tall(&triangle));
        for line in triangle.lines() {
            let Some(shares) = usize::try_from(line).ok().and_then(|y| all.get_mut(y)) else {
                continue;
            };
            let (share, pixels) = (&mut shares[kind], columns(&triangle, line, width));
            if begins > 0 && pixels == 0 && triangle.lines().len() == 1 {
                share.empty += std::mem::take(&mut begins);
            }
            share.starts += std::mem::take(&mut begins);
            share.spans += u32::from(pixels > 0);
            share.tall += u32::from(pixels > 0 && is_tall);
            share.pixels += pixels as u32;
        }
    }
    all
}
