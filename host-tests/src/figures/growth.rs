//! How the cost of a frame grows with its triangles: the cost of one more must not rise.

use crate::firmware::GrowthRun;
use crate::plot::{Dot, Scatter};
use serde_json::{Value, json};

/// Spheres of more and more triangles, drawn with the same memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Slots of the object cache.
    pub slots: u64,
    /// By triangles, fewest first.
    pub points: Vec<GrowthRun>,
}

/// Curves by slots, in the order in which they came.
#[must_use]
pub fn curves(runs: &[GrowthRun]) -> Vec<Curve> {
    let mut curves: Vec<Curve> = Vec::new();
    for run in runs {
        match curves.iter_mut().find(|curve| curve.slots == run.slots) {
            Some(curve) => curve.points.push(run.clone()),
            None => curves.push(Curve {
                slots: run.slots,
                points: vec![run.clone()],
            }),
        }
    }
    for curve in &mut curves {
        curve.points.sort_by_key(|point| point.triangles);
    }
    curves
}

impl GrowthRun {
    /// Instructions of the frame.
    #[must_use]
    pub fn instructions(&self) -> u64 {
        self.pass_one + self.pass_two
    }

    /// Instructions of the frame, shared out among the triangles submitted.
    #[must_use]
    pub fn per_triangle(&self) -> f64 {
        self.instructions() as f64 / self.triangles.max(1) as f64
    }

    /// Instructions a line of the second pass.
    #[must_use]
    pub fn per_line(&self) -> f64 {
        self.pass_two as f64 / f64::from(scenes::HEIGHT)
    }
}

impl Curve {
    /// What one more triangle costs between each size and the next.
    #[must_use]
    pub fn marginal(&self) -> Vec<f64> {
        let cost = |pair: &[GrowthRun]| {
            let more = pair[1].instructions() as f64 - pair[0].instructions() as f64;
            more / (pair[1].triangles - pair[0].triangles).max(1) as f64
        };
        self.points.windows(2).map(cost).collect()
    }

    pub(super) fn to_json(&self) -> Vec<Value> {
        let points = self.points.iter();
        points
            .map(|point| {
                json!({
                    "slots": self.slots,
                    "triangles": point.triangles,
                    "objects": point.objects,
                    "pass_one": point.pass_one,
                    "pass_two": point.pass_two,
                    "per_triangle": super::round(point.per_triangle()),
                    "per_line": super::round(point.per_line()),
                })
            })
            .collect()
    }
}

/// Cost a triangle and a line against triangles.
#[must_use]
pub fn plot(curves: &[Curve]) -> Scatter {
    let mut groups = Vec::new();
    let mut dots = Vec::new();
    for curve in curves {
        for (name, per_line) in [("a triangle", false), ("a line", true)] {
            groups.push(format!("{name}, {} slots", curve.slots));
            for point in &curve.points {
                let last = curve.points.last() == Some(point);
                let y = if per_line {
                    point.per_line()
                } else {
                    point.per_triangle()
                };
                dots.push(Dot {
                    name: if last {
                        format!("{y:.0}")
                    } else {
                        String::new()
                    },
                    group: groups.len() - 1,
                    x: point.triangles as f64,
                    y,
                    marked: true,
                });
            }
        }
    }
    Scatter {
        title: "A sphere of one size: cost of a triangle and of a line against triangles".into(),
        x_name: "triangles".into(),
        y_name: "instructions, Cortex-M4".into(),
        groups,
        dots,
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::firmware::{FirmwareError, M4, Profile, Toolchain, measure};

    fn run(slots: u64, triangles: u64, pass_two: u64) -> GrowthRun {
        GrowthRun {
            slots,
            triangles,
            objects: triangles / 2,
            pass_one: 10 * triangles,
            pass_two,
        }
    }

    #[test]
    fn runs_become_curves() {
        let curves = curves(&[run(64, 200, 4000), run(9, 100, 1), run(64, 100, 3000)]);
        assert_eq!(curves.len(), 2);
        assert_eq!(curves[0].points[0].triangles, 100);
        assert_eq!(curves[0].marginal(), [20.0]);
        assert_eq!(curves[0].points[0].per_triangle(), 40.0);
        assert_eq!(plot(&curves).groups.len(), 4);
    }

    /// On a Cortex-M4, by counted instructions: the share of a triangle falls from size to size.
    #[test]
    fn firmware_cost_a_triangle_does_not_rise() -> Result<(), FirmwareError> {
        let toolchain = Toolchain::find()?;
        let measured = measure(&toolchain, &M4, Profile::Release, &["bench"])?;
        let curves = curves(&measured.output.growth);
        assert_eq!(curves.len(), 2);
        for curve in &curves {
            let (first, last) = (&curve.points[0], &curve.points[curve.points.len() - 1]);
            assert!(first.triangles <= 100 && last.triangles >= 20_000);
            for pair in curve.points.windows(2) {
                let (few, many) = (pair[0].per_triangle(), pair[1].per_triangle());
                assert!(
                    many <= few,
                    "{} slots: {few} then {many}: {pair:?}",
                    curve.slots
                );
            }
        }
        Ok(())
    }
}
