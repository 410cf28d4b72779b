//! Depth: which of two surfaces is found in front, and how exact its planes are.

use super::coverage::rates;
use super::stage::{Place, Rng, Setting, Stage, at_place, covers, doubled_area, plane};
use super::{Errors, Row};
use scanbeam::pipeline::{BlockFix16, GouraudDepth, Worded};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam_model::{ModelRenderer, PipeMemory};
use std::error::Error;

type P = GouraudDepth<Rgb888>;
/// Depth and colour in one word.
type W = Worded<GouraudDepth<Rgb565>>;

/// Wrong pixels and all pixels of each batch.
type Batches = Vec<(u32, u32)>;

/// Pixels of the picture's sides, and of the focal length.
const SIDE: u16 = 128;
/// World units of a whole coordinate of a mesh.
const SCALE: f64 = 64.0;
const NEAR: f64 = 0.5;
const BATCHES: usize = 20;
const TRIANGLES: usize = 60;
/// Pixels of the boxes of triangles, smallest and largest, that are set up as small and as large.
const SMALL: (i32, i32) = (8, 62);
const LARGE: (i32, i32) = (66, 120);
const APART: [(&str, f64); 3] = [
    ("order, 1 % apart, range 1:100", 0.01),
    ("order, 0.1 % apart, range 1:100", 0.001),
    ("order, 0.01 % apart, range 1:100", 0.0001),
];

/// Depth formats that are compared without planes: what a value loses when it is kept.
/// By name, with the firmware's kernel.
const FORMATS: [(&str, &str); 5] = [
    ("16-bit 1/w", "depth_16"),
    ("22-bit 1/w", "depth_22"),
    ("block-fix 16", "depth_block_fix"),
    ("32-bit 1/w", "depth_32"),
    ("32-bit linear", "depth_linear"),
];
const FORMATS_APART: [(&str, f64); 3] = [
    ("format alone, 1 % apart, range 1:100", 0.01),
    ("format alone, 0.1 % apart, range 1:100", 0.001),
    ("format alone, 0.01 % apart, range 1:100", 0.0001),
];

/// Pixels where a format cannot tell that the nearer of two triangles is nearer, and all pixels;
/// the near plane is at 1, and what is drawn later wins where depth is the same.
fn formats(apart: f64) -> [Batches; 5] {
    let mut counts = [(); 5].map(|()| vec![(0, 0); BATCHES]);
    let mut rng = Rng::new(8);
    for batch in 0..BATCHES {
        for _ in 0..2 * TRIANGLES {
            let (places, near) = triangle(&mut rng, LARGE);
            let Some((others, far)) = behind(&mut rng, (places, near), apart, LARGE) else {
                continue;
            };
            let nearest = |w: [f64; 3]| w.into_iter().fold(f64::INFINITY, f64::min);
            if nearest(far) < 1.0 {
                continue;
            }
            let keys = |q: f64, w: [f64; 3]| -> [u64; 5] {
                let fixed = |bits: i32| (q * 2f64.powi(bits)) as u64;
                // A triangle has one range, that of its nearest corner.
                let range = BlockFix16::range_of((2f64.powi(31) / nearest(w)) as u32);
                let linear = (1.0 / q - 1.0) / 104.0;
                [
                    fixed(16),
                    fixed(22),
                    BlockFix16::new(fixed(31) as u32, range).key().into(),
                    fixed(31),
                    ((1.0 - linear) * 2f64.powi(32)) as u64,
                ]
            };
            for line in 0..i32::from(SIDE) {
                for column in 0..i32::from(SIDE) {
                    if !(covers(places, column, line) && covers(others, column, line)) {
                        continue;
                    }
                    let q = plane(places, near.map(|w| 1.0 / w), column, line);
                    let (front, back) = (keys(q, near), keys(q / (1.0 + apart), far));
                    for (i, counts) in counts.iter_mut().enumerate() {
                        counts[batch].0 += u32::from(back[i] >= front[i]);
                        counts[batch].1 += 1;
                    }
                }
            }
        }
    }
    counts
}

fn setting() -> Result<Setting, Box<dyn Error>> {
    Setting::new(SIDE, SIDE, (128.0, NEAR as f32, 110.0), SCALE as f32)
}

/// A position that is seen at a place of the 1/8 grid, at distance `w`.
fn position((x, y): Place, w: f64) -> [i32; 3] {
    let q30 = |v: f64| (v / SCALE * f64::from(1 << 30)).round() as i32;
    let across = |v: i32| (f64::from(v) / 8.0 - f64::from(SIDE) / 2.0) / f64::from(SIDE) * w;
    [q30(across(x)), q30(-across(y)), q30(-w)]
}

/// A triangle in a box of so many pixels at most, and the distances of its corners.
fn triangle(rng: &mut Rng, (smallest, largest): (i32, i32)) -> ([Place; 3], [f64; 3]) {
    loop {
        let size = 8 * rng.within(smallest, largest);
        let last = 8 * i32::from(SIDE) - 8 - size;
        let base = (rng.within(8, last), rng.within(8, last));
        let places = [(); 3].map(|()| (base.0 + rng.within(0, size), base.1 + rng.within(0, size)));
        let distances = [(); 3].map(|()| rng.log(1.0, 100.0));
        // A quarter of the box, so that neither thin ones nor the rounding of corners decide.
        if doubled_area(places).abs() >= i64::from(size) * i64::from(size) / 2 {
            return (places, distances);
        }
    }
}

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = Vec::new();
    for (case, apart) in APART {
        let [small, mut model, mut word] = orders(apart, SMALL)?;
        let [large, model_large, word_large] = orders(apart, LARGE)?;
        model.extend(model_large);
        word.extend(word_large);
        for (method, kernel, batches) in [
            ("32-bit 1/w, small planes", "packed_565_depth", small),
            ("32-bit 1/w, large planes", "packed_565_large_depth", large),
            ("16-bit 1/w and colour, one word", "word_565", word),
            ("hardware model, 32-bit z, 10-bit W", "model_565", model),
        ] {
            let name = ("depth", case, method, "% wrong order", Some(kernel));
            rows.push(rates(name, 100.0, &batches));
        }
    }
    for (case, apart) in FORMATS_APART {
        for ((method, kernel), batches) in FORMATS.into_iter().zip(formats(apart)) {
            let name = ("depth", case, method, "% wrong order", Some(kernel));
            rows.push(rates(name, 100.0, &batches));
        }
    }
    for (case, method, kernel, sizes) in [
        (
            "planes, triangles of 8 to 62 pixels",
            "planes, small, 15-bit reciprocal",
            "packed_565_depth",
            SMALL,
        ),
        (
            "planes, triangles of 66 to 120 pixels",
            "planes, large, 32-bit reciprocal",
            "packed_565_large_depth",
            LARGE,
        ),
    ] {
        let name = ("depth", case, method, "2^-15 of full depth", Some(kernel));
        rows.push(planes(sizes)?.row(name));
    }
    Ok(rows)
}

/// Another triangle over a part of the first, in the plane that is farther by this part; none if
/// chance made it thin, or it would leave the range.
fn behind(
    rng: &mut Rng,
    (places, near): ([Place; 3], [f64; 3]),
    apart: f64,
    sizes: (i32, i32),
) -> Option<([Place; 3], [f64; 3])> {
    let (others, _) = triangle(rng, sizes);
    let far = others.map(|(x, y)| {
        // Where the corner lies on the grid, not where its pixel's centre does.
        let exact = at_place(places, near.map(|w| 1.0 / w), (x, y));
        (1.0 + apart) / exact
    });
    far.iter()
        .all(|w| (0.9..=105.0).contains(w))
        .then_some((others, far))
}

/// Pixels where the farther of two triangles is seen, which is drawn last, and all pixels.
fn orders(apart: f64, sizes: (i32, i32)) -> Result<[Batches; 3], Box<dyn Error>> {
    const FRONT: [u8; 3] = [255, 0, 0];
    const BEHIND: [u8; 3] = [0, 0, 255];
    let mut counts = [(); 3].map(|()| vec![(0, 0); BATCHES]);
    let mut rng = Rng::new(4);
    let setting = setting()?;
    let mut stage = Stage::<P>::new(setting.screen);
    let mut words = Stage::<W>::new(setting.screen);
    let mut pixels = [[0; 3]; SIDE as usize];
    let mut halves = [0; SIDE as usize];
    let mut memory = [[0; SIDE as usize]; 4];
    for batch in 0..BATCHES {
        for _ in 0..TRIANGLES {
            let (places, near) = triangle(&mut rng, sizes);
            let Some((others, far)) = behind(&mut rng, (places, near), apart, sizes) else {
                continue;
            };
            let positions: Vec<_> = (0..3)
                .map(|i| position(places[i], near[i]))
                .chain((0..3).map(|i| position(others[i], far[i])))
                .collect();
            let colours = [FRONT, FRONT, FRONT, BEHIND, BEHIND, BEHIND];
            let (scene, mut lines) = stage.scene(&setting, &positions, &colours)?;
            let (word_scene, mut word_lines) = words.scene(&setting, &positions, &colours)?;
            let mut worded = word_lines.renderer();
            let [z0, z1, c0, c1] = &mut memory;
            let mut model = ModelRenderer::new(PipeMemory {
                z: [z0, z1],
                rgb: [c0, c1],
            });
            let mut renderer = lines.renderer();
            for line in 0..SIDE {
                for (method, counts) in counts.iter_mut().enumerate() {
                    if method == 0 {
                        pixels.fill([0; 3]);
                        renderer.draw_line(&scene, line, &mut pixels)?;
                    } else if method == 1 {
                        model.draw_line(&scene, line, [0; 3], &mut pixels)?;
                    } else {
                        halves.fill(0);
                        worded.draw_line(&word_scene, line, &mut halves)?;
                        pixels = halves.map(Rgb565::to_rgb8);
                    }
                    for (column, pixel) in (0..).zip(&pixels) {
                        let covers = |places| covers(places, column, line.into());
                        if covers(places) && covers(others) {
                            counts[batch].0 += u32::from(*pixel != FRONT);
                            counts[batch].1 += 1;
                        }
                    }
                }
            }
        }
    }
    Ok(counts)
}

/// The depth that is kept at every pixel, against 1/w between the corners.
fn planes(sizes: (i32, i32)) -> Result<Errors, Box<dyn Error>> {
    let mut errors = Errors::default();
    let mut rng = Rng::new(5);
    let setting = setting()?;
    let mut stage = Stage::<GouraudDepth<Rgb565>>::new(setting.screen);
    let mut pixels = [0; SIDE as usize];
    for _ in 0..600 {
        let (places, distances) = triangle(&mut rng, sizes);
        let positions = [0, 1, 2].map(|i| position(places[i], distances[i]));
        let (scene, mut lines) = stage.scene(&setting, &positions, &[[255; 3]; 3])?;
        for line in 0..SIDE {
            lines.draw(&scene, line, &mut pixels)?;
            for (column, cell) in (0..).zip(&*lines.depth) {
                if covers(places, column, line.into()) {
                    let exact = plane(places, distances.map(|w| NEAR / w), column, line.into());
                    let kept = f64::from(*cell) / f64::from(1u32 << 31);
                    errors.push((kept - exact).abs() * 32_768.0);
                }
            }
        }
    }
    Ok(errors)
}
