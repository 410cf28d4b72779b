//! Which pixels a triangle has, against whole numbers and against corners that were not snapped.

use super::stage::{Done, Place, Rng, Stage, ahead, call, covers, with_model};
use super::{Name, Row};
use scanbeam::look::Gouraud;
use scanbeam::pixel::Rgb888;
use scanbeam::{Draw, Faces, Mesh, Renderer, Scene};
use std::error::Error;

type L = Gouraud<Rgb888>;

const SIDE: u16 = 128;
const BATCHES: usize = 20;
const TRIANGLES: usize = 50;
const UNIT: &str = "wrong per 10,000";
const SNAPPED: &str = "corners on the 1/8 grid, against exact rationals";
const FREE: &str = "corners anywhere, against f64";

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    // Wrong pixels and pixels of each batch: the renderer and the model, against both.
    let mut batches = [[(0u32, 0u32); BATCHES]; 4];
    let mut rng = Rng::new(3);
    // At distance 1 a unit of the screen, 1/8 pixel, is 2^-15 of a coordinate.
    let mut stage = Stage::<L>::new((SIDE, SIDE), ahead(4096.0, 0.5, 2.0)?)?;
    for batch in 0..BATCHES {
        for _ in 0..TRIANGLES {
            let (free, positions) = corners(&mut rng);
            let snapped = free.map(|(x, y)| ((x + 0.5).floor() as i32, (y + 0.5).floor() as i32));
            let [fast, model] = stage.show(|scene| build(scene, &positions), pictures)?;
            for line in 0..i32::from(SIDE) {
                for column in 0..i32::from(SIDE) {
                    let at = (line * i32::from(SIDE) + column) as usize;
                    let exact = covers(snapped, column, line);
                    let real = covers_free(free, column, line);
                    let compared = [
                        (fast[at], exact),
                        (model[at], exact),
                        (fast[at], real),
                        (model[at], real),
                    ];
                    for (counts, (drawn, true_one)) in batches.iter_mut().zip(compared) {
                        counts[batch].0 += u32::from(drawn != true_one);
                        counts[batch].1 += u32::from(true_one);
                    }
                }
            }
        }
    }
    let names: [Name; 4] = [
        (
            "coverage",
            SNAPPED,
            "exact edges",
            UNIT,
            Some("flat_565_large"),
        ),
        (
            "coverage",
            SNAPPED,
            "hardware model",
            UNIT,
            Some("model_565"),
        ),
        (
            "coverage",
            FREE,
            "exact edges",
            UNIT,
            Some("flat_565_large"),
        ),
        ("coverage", FREE, "hardware model", UNIT, Some("model_565")),
    ];
    Ok(names
        .into_iter()
        .zip(batches)
        .map(|(name, b)| rates(name, 1e4, &b))
        .collect())
}

/// The row of rates: wrong ones and all of each batch.
pub(super) fn rates(name: Name, scale: f64, batches: &[(u32, u32)]) -> Row {
    let rate = |wrong: u32, all: u32| scale * f64::from(wrong) / f64::from(all.max(1));
    let max = batches.iter().fold(0.0f64, |m, b| m.max(rate(b.0, b.1)));
    let (wrong, all) = batches.iter().fold((0, 0), |s, b| (s.0 + b.0, s.1 + b.1));
    let mut row = Row::rate(name, max, rate(wrong, all));
    row.samples = all.into();
    row
}

/// Corners in units of 1/8 pixel, and as positions; none so near the middle between two places of
/// the grid that the product with the camera could decide.
fn corners(rng: &mut Rng) -> ([(f64, f64); 3], [[i32; 3]; 3]) {
    let size = rng.within(16, 8 * i32::from(SIDE) - 16);
    let base: Place = (
        rng.within(8, 8 * i32::from(SIDE) - 8 - size),
        rng.within(8, 8 * i32::from(SIDE) - 8 - size),
    );
    let mut positions = [[0; 3]; 3];
    let free = [0, 1, 2].map(|i| {
        let at = (base.0 + rng.within(0, size), base.1 + rng.within(0, size));
        // y goes up in positions, so it is taken off.
        let part = [(); 2].map(|()| rng.within(-16_000, 16_000));
        let middle = 4 * i32::from(SIDE);
        let [x, y] = [(at.0 - middle) << 15, (middle - at.1) << 15];
        positions[i] = [x + part[0], y - part[1], -1 << 30];
        let place = |whole: i32, part: i32| f64::from(whole) + f64::from(part) / 32_768.0;
        (place(at.0, part[0]), place(at.1, part[1]))
    });
    (free, positions)
}

fn covers_free(triangle: [(f64, f64); 3], column: i32, line: i32) -> bool {
    let (x, y) = (f64::from(8 * column + 4), f64::from(8 * line + 4));
    let mut left = false;
    for k in 0..3 {
        let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
        let (a, b) = if a.1 <= b.1 { (a, b) } else { (b, a) };
        if a.1 < y && y <= b.1 {
            left ^= (x - a.0) * (b.1 - a.1) > (y - a.1) * (b.0 - a.0);
        }
    }
    left
}

/// A white triangle.
fn build(scene: &mut Scene<'_, '_, L>, positions: &[[i32; 3]; 3]) -> Done {
    let mesh = Mesh {
        positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[[0, 1, 2]]),
    };
    let cull = call().cull;
    Ok(scene.draw(&Draw {
        cull,
        ..Draw::new(mesh)
    })?)
}

/// The pixels that a scene has by the renderer and by the model.
fn pictures(scene: &Scene<'_, '_, L>, renderer: &mut Renderer<'_, L>) -> Done<[Vec<bool>; 2]> {
    let mut pictures = [Vec::new(), Vec::new()];
    let mut row = [[0; 3]; SIDE as usize];
    with_model(SIDE, |model| {
        for line in 0..SIDE {
            for (i, picture) in pictures.iter_mut().enumerate() {
                if i == 0 {
                    renderer.draw_line(scene, line, &mut row, [0; 3])?;
                } else {
                    model.draw_line(scene, line, [0; 3], &mut row)?;
                }
                picture.extend(row.iter().map(|pixel| *pixel != [0; 3]));
            }
        }
        Ok(pictures)
    })
}
