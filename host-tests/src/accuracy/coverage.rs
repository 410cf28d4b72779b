//! Which pixels a triangle has, against whole numbers and against corners that were not snapped.

use super::stage::{Place, Rng, Setting, Stage, covers};
use super::{Name, Row};
use scanbeam::pipeline::{FlatPainter, Scene};
use scanbeam::pixel::Rgb888;
use scanbeam_model::{ModelRenderer, PipeMemory};
use std::error::Error;

const SIDE: u16 = 128;
const BATCHES: usize = 20;
const TRIANGLES: usize = 50;
const UNIT: &str = "wrong per 10,000";
const SNAPPED: &str = "corners on the 1/8 grid, against exact rationals";
const FREE: &str = "corners anywhere, against f64";

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    // Wrong pixels and pixels of each batch: fast and model, against both.
    let mut batches = [[(0u32, 0u32); BATCHES]; 4];
    let mut rng = Rng::new(3);
    let setting = Setting::flat(SIDE, SIDE)?;
    let mut stage = Stage::<FlatPainter<Rgb888>>::new(setting.screen);
    for batch in 0..BATCHES {
        for _ in 0..TRIANGLES {
            let (free, positions) = corners(&mut rng, &setting);
            let snapped = free.map(|(x, y)| ((x + 0.5).floor() as i32, (y + 0.5).floor() as i32));
            let (scene, mut lines) = stage.scene(&setting, &positions, &[[255; 3]; 3])?;
            let mut renderer = lines.renderer();
            let mut row = [[0; 3]; SIDE as usize];
            let fast = picture(|line, out| {
                row.fill([0; 3]);
                renderer.draw_line(&scene, line, &mut row)?;
                out.extend(row.iter().map(|p| *p != [0; 3]));
                Ok(())
            })?;
            let model = by_model(&scene)?;
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
        ("coverage", SNAPPED, "exact edges", UNIT, Some("flat_565")),
        (
            "coverage",
            SNAPPED,
            "hardware model",
            UNIT,
            Some("model_565"),
        ),
        ("coverage", FREE, "exact edges", UNIT, Some("flat_565")),
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
fn corners(rng: &mut Rng, setting: &Setting) -> ([(f64, f64); 3], [[i32; 3]; 3]) {
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
        let [x, y, z] = setting.vertex(at);
        positions[i] = [x + part[0], y - part[1], z];
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

fn picture(
    mut draw: impl FnMut(u16, &mut Vec<bool>) -> Result<(), Box<dyn Error>>,
) -> Result<Vec<bool>, Box<dyn Error>> {
    let mut out = Vec::new();
    for line in 0..SIDE {
        draw(line, &mut out)?;
    }
    Ok(out)
}

fn by_model(scene: &Scene<'_, FlatPainter<Rgb888>>) -> Result<Vec<bool>, Box<dyn Error>> {
    let mut memory = [[0; SIDE as usize]; 4];
    let [z0, z1, c0, c1] = &mut memory;
    let mut renderer = ModelRenderer::new(PipeMemory {
        z: [z0, z1],
        rgb: [c0, c1],
    });
    let mut row = [[0; 3]; SIDE as usize];
    picture(|line, out| {
        renderer.draw_line(scene, line, [0; 3], &mut row)?;
        out.extend(row.iter().map(|p| *p != [0; 3]));
        Ok(())
    })
}
