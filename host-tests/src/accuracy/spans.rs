//! Colour along spans, between corners of full 8-bit colours, against the plane between them.

use super::methods::METHODS;
use super::stage::{
    Done, Place, Rng, Stage, ahead, by_method, call, corner, covers, doubled_area, plane,
};
use super::{Errors, Row};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::scene::{LARGEST, ScreenCorner};
use scanbeam_lab::{DepthMethod, Format};
use scanbeam_model::{SpanWeight, divided_weight, lirp, round_to_8, widen};
use std::error::Error;
use std::ops::RangeInclusive;

const FAMILY: &str = "interpolation";
pub(super) const UNIT: &str = "levels";
/// Cases by format, short spans first.
pub(super) const CASES: [[&str; 2]; 2] = [
    [
        "RGB565, spans of 1 to 63 pixels",
        "RGB565, spans of 1 to 1016 pixels",
    ],
    [
        "RGB888, spans of 1 to 63 pixels",
        "RGB888, spans of 1 to 1016 pixels",
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
        let [five, eight] = CASES.map(|cases| cases[usize::from(long)]);
        let both = spans::<Rgb565>(long)?
            .into_iter()
            .zip(spans::<Rgb888>(long)?);
        for (method, (of_565, of_888)) in METHODS.iter().zip(both) {
            let name = |case, kernel| (FAMILY, case, method.name, UNIT, Some(kernel));
            rows.push(of_565.row(name(five, method.kernel(true, long))));
            rows.push(of_888.row(name(eight, method.kernel(false, long))));
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

/// LIRP from end to end of random spans, as the RGB unit has it: 10 bits a channel, 8 shown.
fn blends(bits: u32, long: bool) -> Errors {
    let mut rng = Rng::new(1);
    let mut errors = Errors::default();
    for _ in 0..4_000 {
        let length = rng.log(8.0, if long { 8_128.0 } else { 511.0 }) as u16;
        let reach = if rng.unit() < 0.5 { 16 } else { 255 };
        let a = rng.within(0, 255);
        let b = rng.within((a - reach).max(0), (a + reach).min(255));
        let [wide_a, wide_b] = [a, b].map(|level| i64::from(widen(level as u32, 8, 10)));
        let circuit = SpanWeight::new(length);
        let first = rng.within(0, 7) as u16;
        for distance in (first..=length).step_by(8) {
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

/// A triangle that is drawn by all methods, and the colours of its corners.
pub(super) struct Subject {
    pub(super) places: [Place; 3],
    pub(super) colours: [[u8; 3]; 3],
}

impl Subject {
    /// None if chance made it thin.
    pub(super) fn random(rng: &mut Rng, long: bool) -> Option<Self> {
        let places = triangle(rng, long)?;
        let reach = if rng.unit() < 0.5 { 16 } else { 255 };
        let colour = [(); 3].map(|()| rng.within(0, 255));
        let near = |rng: &mut Rng, c: i32| rng.within((c - reach).max(0), (c + reach).min(255));
        let colours = [(); 3].map(|()| colour.map(|c| near(rng, c) as u8));
        Some(Self { places, colours })
    }

    fn corners(&self) -> [ScreenCorner; 3] {
        [0, 1, 2].map(|i| corner(self.places[i], 1 << 30, self.colours[i]))
    }

    /// The columns or lines of a picture that it may have pixels on.
    fn extent(&self, axis: fn(&Place) -> i32, size: u16) -> RangeInclusive<i32> {
        let all = self.places.each_ref().map(axis);
        let (low, high) = all
            .iter()
            .fold((i32::MAX, 0), |(l, h), &c| (l.min(c), h.max(c)));
        low / 8..=(high / 8).min(i32::from(size) - 1)
    }

    /// The errors of a line.
    pub(super) fn compare<F: PixelFormat>(
        &self,
        line: i32,
        pixels: &[F::Word],
        errors: &mut Errors,
    ) {
        let columns = self.extent(|p| p.0, pixels.len() as u16);
        for column in columns.filter(|&column| covers(self.places, column, line)) {
            let shown = F::to_rgb8(pixels[column as usize]);
            for channel in 0..3 {
                let values = self.colours.map(|c| f64::from(c[channel]));
                let exact = plane(self.places, values, column, line);
                errors.push(beyond(shown, channel, F::STEPS, exact));
            }
        }
    }
}

/// The same random triangles by all methods. Those of at most 63 x 63 pixels are set up by the renderer as small if they
/// are not thin; those that are taller than 64 as large.
fn spans<F: PixelFormat + Format>(long: bool) -> Done<Vec<Errors>> {
    let mut rng = Rng::new(2);
    let mut errors = vec![Errors::default(); METHODS.len()];
    let size = if long { (LARGEST, 256) } else { (64, 64) };
    let mut stage = Stage::<Gouraud<F>>::new(size, ahead(100.0, 1.0, 100.0)?)?;
    let mut pixels = vec![F::Word::default(); size.0.into()];
    let mut cells = vec![0; size.0.into()];
    for _ in 0..if long { 400 } else { 12_000 } {
        let Some(subject) = Subject::random(&mut rng, long) else {
            continue;
        };
        let mut lines: Vec<i32> = subject.extent(|p| p.1, size.1).collect();
        if long {
            let last = lines.len() as i32 - 1;
            lines = (0..4)
                .map(|_| lines[rng.within(0, last) as usize])
                .collect();
        }
        stage.show(
            |scene| Ok(scene.draw_screen(&call(), &[subject.corners()])?),
            |scene, renderer| {
                for line in lines {
                    for (method, errors) in METHODS.iter().zip(&mut errors) {
                        if let Some(way) = method.way {
                            let how = (way, DepthMethod::Bits32);
                            by_method(how, scene, line as u16, &mut pixels, &mut cells);
                        } else {
                            let nothing = F::Word::default();
                            renderer.draw_line(scene, line as u16, &mut pixels, nothing)?;
                        }
                        subject.compare::<F>(line, &pixels, errors);
                    }
                }
                Ok(())
            },
        )?;
    }
    Ok(errors)
}

/// A triangle within the picture; none if chance made it thin.
fn triangle(rng: &mut Rng, long: bool) -> Option<[Place; 3]> {
    let most = 8 * i32::from(LARGEST);
    let (wide, tall) = if long {
        (rng.log(8.0, most.into()) as i32, rng.within(640, 2040))
    } else {
        (rng.within(40, 504), rng.within(40, 504))
    };
    let x0 = rng.within(0, if long { most } else { 504 } - wide);
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
