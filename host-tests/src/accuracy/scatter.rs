//! Cost against error as a picture.

use super::Row;
use crate::plot::{Dot, Scatter};

/// The family that is plotted: the one whose methods are alternatives to each other.
const FAMILY: &str = "interpolation";

/// The plot of all interpolation methods that have a cost.
pub(super) fn plot(rows: &[Row]) -> Scatter {
    let mut groups: Vec<String> = Vec::new();
    let mut dots = Vec::new();
    for row in rows.iter().filter(|row| row.family == FAMILY) {
        let Some(cost) = row.per_pixel else { continue };
        let known = groups.iter().position(|group| group == row.case);
        let group = known.unwrap_or_else(|| {
            groups.push(row.case.to_owned());
            groups.len() - 1
        });
        dots.push(Dot {
            name: row.method.to_owned(),
            group,
            x: cost,
            y: row.max,
            marked: row.on_frontier,
        });
    }
    Scatter {
        title: "Colour along spans: cost against largest error; rings and lines: the frontier"
            .into(),
        x_name: "instructions a pixel, Cortex-M4".into(),
        y_name: "largest error beyond rounding, 8-bit levels".into(),
        groups,
        dots,
    }
}
