//! How the cost of a frame grows with its triangles: in neither pass may the share of a triangle
//! rise, so that a line of the picture, too, costs at most in proportion to what is on it.
//!
//! The frames are counted on the target; how many lines of triangles they have, spans that is, is
//! counted here, where the same triangles lie on the same pixels. The share of such a line does
//! rise as triangles become smaller than a few pixels: each is set up for fewer of them.

use crate::firmware::GrowthRun;
use crate::plot::{Dot, Scatter};
use crate::rooms::{LineRooms, Room, SceneRooms};
use scenes::{HEIGHT, OCTASPHERES, Octasphere, Shot, SmoothLook, WIDTH};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;

/// Spheres of more and more triangles, drawn with the same memory.
#[derive(Clone, Debug, PartialEq)]
pub struct Curve {
    /// Slots of the object cache.
    pub slots: u64,
    /// By triangles, fewest first.
    pub points: Vec<Point>,
}

/// A sphere on the target.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Point {
    /// What was counted there.
    pub run: GrowthRun,
    /// Lines of triangles that have pixels.
    pub spans: u64,
}

/// Spans of each sphere, by its triangles.
///
/// # Errors
/// When a sphere cannot be drawn, which means that this module lends too little memory.
pub fn spans() -> Result<BTreeMap<u64, u64>, Box<dyn Error>> {
    let mut positions = vec![[0; 3]; Octasphere::MOST_VERTICES];
    let mut faces = vec![[0; 3]; Octasphere::MOST_FACES];
    let room = Room {
        vertices: Octasphere::MOST_VERTICES,
        places: 0,
        objects: Octasphere::MOST_FACES,
        draws: 1,
    };
    let mut lent = SceneRooms::new(room, HEIGHT);
    let mut rooms: LineRooms<SmoothLook> = LineRooms::new(room.objects, WIDTH);
    let mut spans = BTreeMap::new();
    for parts in OCTASPHERES {
        let sphere = Octasphere::new(parts, &mut positions, &mut faces).ok_or("no room")?;
        let mut scene = lent.scene(Shot::screen());
        let drawn = sphere.draw(&mut scene);
        drawn.map_err(|error| format!("a sphere of {parts} parts: {error:?}"))?;
        let mut renderer = rooms.renderer().counting();
        for line in 0..HEIGHT {
            renderer.draw_line(&scene, line, &mut [0; WIDTH as usize], 0)?;
        }
        let counted = renderer.spans().spans;
        spans.insert(sphere.triangles() as u64, counted.into());
    }
    Ok(spans)
}

/// Curves by slots, in the order in which they came.
///
/// # Errors
/// When a run is not one of the spheres.
pub fn curves(runs: &[GrowthRun], spans: &BTreeMap<u64, u64>) -> Result<Vec<Curve>, String> {
    let mut curves: Vec<Curve> = Vec::new();
    for run in runs {
        let spans = spans.get(&run.triangles);
        let point = Point {
            run: run.clone(),
            spans: *spans.ok_or(format!("no sphere has {} triangles", run.triangles))?,
        };
        match curves.iter_mut().find(|curve| curve.slots == run.slots) {
            Some(curve) => curve.points.push(point),
            None => curves.push(Curve {
                slots: run.slots,
                points: vec![point],
            }),
        }
    }
    for curve in &mut curves {
        curve.points.sort_by_key(|point| point.run.triangles);
    }
    Ok(curves)
}

impl Point {
    /// Instructions of the frame.
    #[must_use]
    pub fn instructions(&self) -> u64 {
        self.run.pass_one + self.run.pass_two
    }

    /// Instructions of the frame, shared out among the triangles submitted.
    #[must_use]
    pub fn per_triangle(&self) -> f64 {
        self.instructions() as f64 / self.run.triangles.max(1) as f64
    }

    /// Instructions of the second pass, shared out among the triangles that were filed.
    #[must_use]
    pub fn per_object(&self) -> f64 {
        self.run.pass_two as f64 / self.run.objects.max(1) as f64
    }

    /// The same, shared out among the lines of triangles.
    #[must_use]
    pub fn per_span(&self) -> f64 {
        self.run.pass_two as f64 / self.spans.max(1) as f64
    }

    /// Instructions of the first pass, shared out among the triangles submitted.
    #[must_use]
    pub fn per_submitted(&self) -> f64 {
        self.run.pass_one as f64 / self.run.triangles.max(1) as f64
    }
}

impl Curve {
    /// Whether no share of a triangle rises from a sphere to the next.
    #[must_use]
    pub fn falls(&self) -> bool {
        let shares: [fn(&Point) -> f64; 3] =
            [Point::per_triangle, Point::per_object, Point::per_submitted];
        let pairs = || self.points.windows(2);
        shares
            .iter()
            .all(|of| pairs().all(|pair| of(&pair[1]) <= of(&pair[0])))
    }

    pub(super) fn to_json(&self) -> Vec<Value> {
        let points = self.points.iter();
        points
            .map(|point| {
                json!({
                    "slots": self.slots,
                    "triangles": point.run.triangles,
                    "objects": point.run.objects,
                    "spans": point.spans,
                    "pass_one": point.run.pass_one,
                    "pass_two": point.run.pass_two,
                    "per_triangle": super::round(point.per_triangle()),
                    "per_object": super::round(point.per_object()),
                    "per_span": super::round(point.per_span()),
                })
            })
            .collect()
    }
}

/// Cost a triangle, and a span, against triangles.
#[must_use]
pub fn plot(curves: &[Curve]) -> Scatter {
    let mut groups = Vec::new();
    let mut dots = Vec::new();
    for curve in curves {
        for (name, span) in [("a triangle", false), ("a span", true)] {
            groups.push(format!("{name}, {} slots", curve.slots));
            for point in &curve.points {
                let last = curve.points.last() == Some(point);
                let y = if span {
                    point.per_span()
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
                    x: point.run.triangles as f64,
                    y,
                    marked: true,
                });
            }
        }
    }
    Scatter {
        title: "A sphere of one size: cost of a triangle, and of a span, against triangles".into(),
        x_name: "triangles".into(),
        y_name: "instructions, Cortex-M4".into(),
        groups,
        dots,
    }
}
