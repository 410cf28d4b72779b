//! Depth: which of two surfaces is found in front.

use super::Row;
use super::coverage::rates;
use super::stage::{
    Done, Place, Rng, Stage, ahead, at_place, by_method, call, corner, covers, depth_of,
    doubled_area, plane, with_model,
};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::{Renderer, Scene};
use scanbeam_lab::{DepthMethod, Method};
use scanbeam_model::ModelRenderer;
use std::error::Error;

/// Wrong pixels and all pixels of each batch.
type Batches = Vec<(u32, u32)>;

/// Pixels of the picture's sides.
const SIDE: u16 = 128;
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
const FORMATS: [(&str, DepthMethod, &str); 5] = [
    ("16-bit 1/w", DepthMethod::Bits16, "depth_16"),
    ("22-bit 1/w", DepthMethod::Bits22, "depth_22"),
    ("block-fix 16", DepthMethod::BlockFix, "depth_block_fix"),
    ("32-bit 1/w", DepthMethod::Bits32, "depth_32"),
    ("32-bit linear", DepthMethod::Linear, "depth_linear"),
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
            // A triangle has one range, that of its nearest corner.
            let key = |by: DepthMethod, q: f64, w: [f64; 3]| {
                let range = by.range(depth_of(nearest(w), 1.0));
                by.key(depth_of(1.0 / q, 1.0), range)
            };
            for line in 0..i32::from(SIDE) {
                for column in 0..i32::from(SIDE) {
                    if !(covers(places, column, line) && covers(others, column, line)) {
                        continue;
                    }
                    let q = plane(places, near.map(|w| 1.0 / w), column, line);
                    for (counts, (_, by, _)) in counts.iter_mut().zip(FORMATS) {
                        let is_wrong = key(by, q / (1.0 + apart), far) >= key(by, q, near);
                        counts[batch].0 += u32::from(is_wrong);
                        counts[batch].1 += 1;
                    }
                }
            }
        }
    }
    counts
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
        let [small, mut model, mut word, mut fix] = orders(apart, SMALL)?;
        let [large, model_large, word_large, fix_large] = orders(apart, LARGE)?;
        model.extend(model_large);
        word.extend(word_large);
        fix.extend(fix_large);
        for (method, kernel, batches) in [
            ("32-bit 1/w, small planes", "renderer_565_depth", small),
            (
                "32-bit 1/w, large planes",
                "renderer_565_large_depth",
                large,
            ),
            ("16-bit 1/w and colour, one word", "word_565", word),
            ("16-bit block-fix 1/w", "block_fix_565", fix),
            ("hardware model, 32-bit z, 10-bit W", "model_565", model),
        ] {
            let name = ("depth", case, method, "% wrong order", Some(kernel));
            rows.push(rates(name, 100.0, &batches));
        }
    }
    for (case, apart) in FORMATS_APART {
        for ((method, _, kernel), batches) in FORMATS.into_iter().zip(formats(apart)) {
            let name = ("depth", case, method, "% wrong order", Some(kernel));
            rows.push(rates(name, 100.0, &batches));
        }
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

const FRONT: [u8; 3] = [255, 0, 0];
const BEHIND: [u8; 3] = [0, 0, 255];

/// Pixels where the farther of two triangles is seen, which is drawn last, and all pixels: by the renderer, the model, and
/// the laboratory's words and block-fix depths.
fn orders(apart: f64, sizes: (i32, i32)) -> Result<[Batches; 4], Box<dyn Error>> {
    let mut counts = [(); 4].map(|()| vec![(0, 0); BATCHES]);
    let mut rng = Rng::new(4);
    let camera = ahead(128.0, NEAR as f32, 110.0)?;
    let mut stage = Stage::<Gouraud<Rgb888>>::new((SIDE, SIDE), camera)?;
    let mut halves = Stage::<Gouraud<Rgb565>>::new((SIDE, SIDE), camera)?;
    with_model(SIDE, |model| {
        for batch in 0..BATCHES {
            for _ in 0..TRIANGLES {
                let (places, near) = triangle(&mut rng, sizes);
                let Some((others, far)) = behind(&mut rng, (places, near), apart, sizes) else {
                    continue;
                };
                let filed =
                    [(places, near, FRONT), (others, far, BEHIND)].map(|(at, w, colour)| {
                        [0, 1, 2].map(|i| corner(at[i], depth_of(w[i], NEAR), colour))
                    });
                let [fast, by_model, fix] = stage.show(
                    |scene| Ok(scene.draw_screen(&call(), &filed)?),
                    |scene, renderer| drawn(scene, renderer, model),
                )?;
                let word = halves.show(|scene| Ok(scene.draw_screen(&call(), &filed)?), words)?;
                for (counts, picture) in counts.iter_mut().zip([fast, by_model, word, fix]) {
                    for (i, pixel) in (0..).zip(picture) {
                        let (column, line) = (i % i32::from(SIDE), i / i32::from(SIDE));
                        let covers = |places| covers(places, column, line);
                        if covers(places) && covers(others) {
                            counts[batch].0 += u32::from(pixel != FRONT);
                            counts[batch].1 += 1;
                        }
                    }
                }
            }
        }
        Ok(counts)
    })
}

/// A scene by the renderer, by the model and with block-fix depths.
fn drawn(
    scene: &Scene<'_, '_, Gouraud<Rgb888>>,
    renderer: &mut Renderer<'_, Gouraud<Rgb888>>,
    model: &mut ModelRenderer<'_>,
) -> Done<[Vec<[u8; 3]>; 3]> {
    let mut pictures = [(); 3].map(|()| Vec::new());
    let (mut row, mut cells) = ([[0; 3]; SIDE as usize], [0; SIDE as usize]);
    for line in 0..SIDE {
        renderer.draw_line(scene, line, &mut row, [0; 3])?;
        pictures[0].extend(row);
        model.draw_line(scene, line, [0; 3], &mut row)?;
        pictures[1].extend(row);
        row.fill([0; 3]);
        let how = (Method::Packed8, DepthMethod::BlockFix);
        by_method(how, scene, line, &mut row, &mut cells);
        pictures[2].extend(row);
    }
    Ok(pictures)
}

/// A scene by words of depth and colour.
fn words(
    scene: &Scene<'_, '_, Gouraud<Rgb565>>,
    _: &mut Renderer<'_, Gouraud<Rgb565>>,
) -> Done<Vec<[u8; 3]>> {
    let mut picture = Vec::new();
    let (mut row, mut cells) = ([0; SIDE as usize], [0; SIDE as usize]);
    for line in 0..SIDE {
        row.fill(0);
        let how = (Method::Packed8, DepthMethod::Word);
        by_method(how, scene, line, &mut row, &mut cells);
        picture.extend(row.map(Rgb565::to_rgb8));
    }
    Ok(picture)
}
