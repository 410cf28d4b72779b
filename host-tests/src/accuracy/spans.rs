//! Colour along spans, between corners of full 8-bit colours, against the line between them.

use super::methods::{METHODS, Method, Painter};
use super::stage::{Place, Rng, Setting, Stage, covers, doubled_area, plane};
use super::{Errors, Row};
use crate::args::InterpArg;
use scanbeam::pipeline::{
    Auto, Forward, HalfRate, Interpolation, Lirp10, Lirp12, Lirp16, LirpPacked, Packed8, Packed16,
    Quality, QuarterRate,
};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam_model::{SpanWeight, divided_weight, lirp, round_to_8, widen};
use std::error::Error;

const FAMILY: &str = "interpolation";
const UNIT: &str = "levels";
/// Cases by format, spans of small triangles first.
const CASES: [[&str; 2]; 2] = [
    [
        "RGB565, spans of 1 to 63 pixels",
        "RGB565, spans of 1 to 8192 pixels",
    ],
    [
        "RGB888, spans of 1 to 63 pixels",
        "RGB888, spans of 1 to 8192 pixels",
    ],
];

/// How far a pixel is off, beyond the half step that rounding to the format's steps costs.
pub(super) fn beyond(word: [u8; 3], channel: usize, steps: [u16; 3], exact: f64) -> f64 {
    let steps = f64::from(steps[channel]);
    // The step itself, not its 8-bit rounding.
    let shown = (f64::from(word[channel]) * steps / 255.0).round() * 255.0 / steps;
    ((shown - exact).abs() - 127.5 / steps).max(0.0)
}

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = Vec::new();
    for long in [false, true] {
        for method in &METHODS {
            let [five, eight] = CASES.map(|cases| cases[usize::from(long)]);
            let name = |case, kernel| (FAMILY, case, method.name, UNIT, Some(kernel));
            let errors = by::<Rgb565>(method, long)?;
            rows.push(errors.row(name(five, method.kernel(true, long))));
            let errors = by::<Rgb888>(method, long)?;
            rows.push(errors.row(name(eight, method.kernel(false, long))));
        }
        for (bits, method, kernel) in [
            (10, "circuit: LIRP, 10-bit W(X)", "model_lirp_10"),
            (12, "circuit: LIRP, 12-bit W", "model_lirp_12"),
            (16, "circuit: LIRP, 16-bit W", "model_lirp_16"),
        ] {
            let name = (
                FAMILY,
                CASES[1][usize::from(long)],
                method,
                UNIT,
                Some(kernel),
            );
            rows.push(blends(bits, long).row(name));
        }
    }
    Ok(rows)
}

/// Spans by a method.
fn by<F: PixelFormat>(method: &Method, long: bool) -> Result<Errors, Box<dyn Error>> {
    let spans = match method.interp {
        InterpArg::Plane => spans::<F, Forward>,
        InterpArg::Packed8 => spans::<F, Packed8>,
        InterpArg::Packed16 => spans::<F, Packed16>,
        InterpArg::Half => spans::<F, HalfRate>,
        InterpArg::Quarter => spans::<F, QuarterRate>,
        InterpArg::Lirp10 => spans::<F, Lirp10>,
        InterpArg::Lirp12 => spans::<F, Lirp12>,
        InterpArg::Lirp16 => spans::<F, Lirp16>,
        InterpArg::LirpPacked => spans::<F, LirpPacked>,
        InterpArg::Auto => spans::<F, Auto>,
        InterpArg::Model => return Err("the model draws no spans of its own".into()),
    };
    spans(method.quality, long)
}

/// LIRP from end to end of random spans, as the RGB unit has it: 10 bits a channel, 8 shown.
fn blends(bits: u32, long: bool) -> Errors {
    let mut rng = Rng::new(1);
    let mut errors = Errors::default();
    for _ in 0..4_000 {
        let length = rng.log(8.0, if long { 65_535.0 } else { 511.0 }) as u16;
        let reach = if rng.unit() < 0.5 { 16 } else { 255 };
        let a = rng.within(0, 255);
        let b = rng.within((a - reach).max(0), (a + reach).min(255));
        let [wide_a, wide_b] = [a, b].map(|level| i64::from(widen(level as u32, 8, 10)));
        let circuit = SpanWeight::new(length);
        let first = rng.within(0, 7) as u16;
        let stride = 8 * (1 + length / 2048);
        for distance in (first..=length).step_by(usize::from(stride)) {
            let w = if bits == 10 {
                circuit.at(distance).into()
            } else {
                divided_weight(distance, length, bits)
            };
            let shown = round_to_8(lirp(wide_a, wide_b, w, bits) as u16);
            let t = f64::from(distance) / f64::from(length);
            let exact = f64::from(a) + f64::from(b - a) * t;
            errors.push(beyond([shown; 3], 0, Rgb888::STEPS, exact));
        }
    }
    errors
}

/// Spans of random triangles through the line renderer. Those of at most 63 x 63 pixels are set up
/// as small if they are not thin; those that are taller than 64 as large.
fn spans<F: PixelFormat, I: Interpolation>(
    quality: Quality,
    long: bool,
) -> Result<Errors, Box<dyn Error>> {
    let mut rng = Rng::new(2);
    let mut errors = Errors::default();
    let (width, height) = if long { (8192, 256) } else { (64, 64) };
    let setting = Setting::flat(width, height)?;
    let mut stage = Stage::<Painter<F, I>>::new(setting.screen);
    let mut pixels = vec![F::Word::default(); usize::from(width)];
    for _ in 0..if long { 500 } else { 2_000 } {
        let Some(triangle) = triangle(&mut rng, long) else {
            continue;
        };
        let reach = if rng.unit() < 0.5 { 16 } else { 255 };
        let colour = [(); 3].map(|()| rng.within(0, 255));
        let colours = [(); 3]
            .map(|()| colour.map(|c| rng.within((c - reach).max(0), (c + reach).min(255)) as u8));
        let positions = triangle.map(|p| setting.vertex(p));
        let (scene, mut lines) = stage.scene(&setting, &positions, &colours)?;
        let bounds = |c: [i32; 3], size: u16| {
            let low = c.into_iter().min().unwrap_or(0) / 8;
            let high = c.into_iter().max().unwrap_or(0) / 8;
            (low, high.min(i32::from(size) - 1))
        };
        let (left, right) = bounds(triangle.map(|p| p.0), width);
        let (top, bottom) = bounds(triangle.map(|p| p.1), height);
        let mut drawn: Vec<i32> = if long {
            (0..4).map(|_| rng.within(top, bottom)).collect()
        } else {
            (top..=bottom).collect()
        };
        drawn.sort_unstable();
        let mut renderer = lines.renderer();
        renderer.set_quality(quality);
        for line in drawn {
            renderer.draw_line(&scene, line as u16, &mut pixels)?;
            for column in (left..=right).filter(|c| covers(triangle, *c, line)) {
                let shown = F::to_rgb8(pixels[column as usize]);
                for channel in 0..3 {
                    let values = colours.map(|c| f64::from(c[channel]));
                    let exact = plane(triangle, values, column, line);
                    errors.push(beyond(shown, channel, F::STEPS, exact));
                }
            }
        }
    }
    Ok(errors)
}

/// A triangle that is drawn by the method asked for; none if chance made it thin.
fn triangle(rng: &mut Rng, long: bool) -> Option<[Place; 3]> {
    let (wide, tall) = if long {
        let wide = rng.log(8.0, 65_528.0) as i32;
        (wide, rng.within(640, 2040))
    } else {
        (rng.within(40, 504), rng.within(40, 504))
    };
    let x0 = rng.within(0, if long { 65_528 } else { 504 } - wide);
    let place = |rng: &mut Rng| (x0 + rng.within(0, wide), rng.within(0, tall));
    let triangle = if long {
        [
            (x0, 0),
            (x0 + wide, rng.within(0, tall)),
            (x0 + rng.within(0, wide), tall),
        ]
    } else {
        [place(rng), place(rng), place(rng)]
    };
    // An eighth of the box at least: then no colour rises by more than 8 times its range.
    let enough = i64::from(wide) * i64::from(tall) / 2;
    (doubled_area(triangle).abs() >= if long { 64 } else { enough }).then_some(triangle)
}
