//! What a pixel costs: the firmware's kernels, and two of its frames.

use super::Row;
use super::rooms::mirror_pixels;
use crate::firmware::{FirmwareError, KernelRun, M4, Output, Profile, Toolchain, measure};
use crate::rooms::{Room, picture};
use scenes::{SUITE_DRAWS, SUITE_OBJECTS, SUITE_VERTICES, Shot, SmoothLook, Suite};
use std::collections::BTreeMap;
use std::error::Error;

/// Frames of the teapot at 320 x 240.
const TEAPOTS: [&str; 3] = ["teapot_model", "teapot", "values_doubled"];

/// Kernels that draw whole lines, whose spans are not told from their lines.
const LINES: [&str; 7] = [
    "smooth_",
    "over_",
    "filter_",
    "flat_",
    "texel_",
    "leaning_",
    "model_565",
];

/// What a span of a kernel takes, where by its two equations it is `span`: of the renderer's that are timed beside the
/// laboratory's methods it is what one more span of a line takes, found and cut.
fn of_span(name: &str, span: f64, one_more: Option<f64>) -> Option<f64> {
    match name {
        name if name.starts_with("renderer_") => one_more.filter(|_| !name.ends_with("_depth")),
        name if LINES.iter().any(|lines| name.starts_with(lines)) => None,
        _ => Some(span),
    }
}

/// Instructions a pixel and a span, by kernel; a frame has no spans of its own.
#[derive(Debug, Default, PartialEq)]
pub struct Costs(BTreeMap<String, (f64, Option<f64>)>);

impl Costs {
    /// Builds and runs the firmware; if there is nothing to do that with, no costs and why.
    pub fn measured() -> Result<(Self, Option<String>), Box<dyn Error>> {
        let measured = Toolchain::find()
            .and_then(|toolchain| measure(&toolchain, &M4, Profile::Release, &["bench"]));
        match measured {
            Ok(measured) => Ok((
                Self::from_output(&measured.output, [teapot_pixels()?, mirror_pixels()?])?,
                None,
            )),
            Err(error @ (FirmwareError::NoQemu | FirmwareError::NoToolchain { .. })) => {
                let note = format!("note: no instructions were measured: {error}");
                Ok((Self::default(), Some(note)))
            }
            Err(error) => Err(error.into()),
        }
    }

    /// From what the firmware printed, and the pixels that the teapot's frames show, and that of a reflecting one.
    pub fn from_output(output: &Output, [teapot, mirror]: [u32; 2]) -> Result<Self, String> {
        let mut costs = BTreeMap::new();
        let one_more = output.units.iter().find(|unit| unit.name == "span");
        let one_more = one_more.map(|unit| unit.instructions as f64 / unit.count.max(1) as f64);
        for run in &output.kernels {
            let same: Vec<&KernelRun> = output
                .kernels
                .iter()
                .filter(|k| k.name == run.name)
                .collect();
            let [long, short] = same[..] else {
                return Err(format!("kernel {}: {} runs, not 2", run.name, same.len()));
            };
            let (pixel, span) =
                solve(long, short).ok_or(format!("kernel {}: no two equations", run.name))?;
            let span = of_span(&run.name, span, one_more);
            costs.insert(run.name.clone(), (pixel, span));
        }
        for frame in &output.frames {
            let pixels = match frame.scene.as_str() {
                scene if TEAPOTS.contains(&scene) => teapot,
                "values_mirror" => mirror,
                _ => continue,
            };
            let each = frame.instructions as f64 / f64::from(pixels.max(1));
            costs.insert(frame.scene.clone(), (each, None));
        }
        Ok(Self(costs))
    }

    /// Fills in the costs.
    pub fn fill(&self, rows: &mut [Row]) -> Result<(), String> {
        for row in rows {
            let Some(kernel) = row.kernel else { continue };
            if let Some((pixel, span)) = self.0.get(kernel) {
                (row.per_pixel, row.per_span) = (Some(*pixel), *span);
            } else if !self.0.is_empty() {
                return Err(format!("the firmware has no kernel `{kernel}`"));
            }
        }
        Ok(())
    }
}

/// `pixels a + spans b = instructions`, twice.
pub fn solve(long: &KernelRun, short: &KernelRun) -> Option<(f64, f64)> {
    let row = |k: &KernelRun| (k.pixels as f64, k.spans as f64, k.instructions as f64);
    let ((p0, s0, i0), (p1, s1, i1)) = (row(long), row(short));
    let determinant = p0 * s1 - p1 * s0;
    (determinant != 0.0).then(|| {
        (
            (i0 * s1 - i1 * s0) / determinant,
            (p0 * i1 - p1 * i0) / determinant,
        )
    })
}

/// Pixels that show the teapot: those that are the same over any background.
fn teapot_pixels() -> Result<u32, Box<dyn Error>> {
    let over = |background| {
        let room = Room {
            vertices: SUITE_VERTICES,
            places: 0,
            objects: SUITE_OBJECTS,
            draws: SUITE_DRAWS,
        };
        picture::<_, SmoothLook>(Shot::screen(), room, background, |scene| {
            let built = Suite::Teapot.build(scene);
            Ok(built.map_err(|error| format!("teapot: {error:?}"))?)
        })
    };
    let (black, white) = (over(0)?, over(0xFFFF)?);
    Ok(black.iter().zip(&white).filter(|(a, b)| a == b).count() as u32)
}
