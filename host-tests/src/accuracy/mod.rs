//! `accuracy`: how far every method is off an `f64` reference, and what a pixel of it costs.
//!
//! | file | there |
//! |---|---|
//! | `stage.rs` | triangles whose corners lie on chosen places of the screen, and who draws them |
//! | `methods.rs` | the renderer and the laboratory's interpolation methods by name |
//! | `spans.rs` | family `interpolation`: colour along spans, by all of them |
//! | `kept.rs` | family `lines`: the same of colours that are taken anew on some lines alone |
//! | `coverage.rs` | family `coverage`: which pixels a triangle has |
//! | `depth.rs` | family `depth`: which surface is in front |
//! | `texture.rs` | family `texture`: places by the laboratory's divisions and the renderer's budgets |
//! | `frames.rs` | whole scenes: family `interpolation` by every method, family `frame` beside the model |
//! | `texels.rs` | family `texels`: words, palettes and compressed blocks beside the picture that they are made of |
//! | `rooms.rs` | frames of the rooms: doubled on their way out, places from normals |
//! | `cost.rs` | instructions a pixel, measured on a Cortex-M4 in QEMU |
//! | `scatter.rs` | the plots, one for each family, or for each case of a large one |
//!
//! Every random choice comes from a generator with a fixed seed, so the figures are the same in
//! every run. A row is there only if its figures were measured by code of this crate that runs.

pub mod cost;
mod coverage;
mod depth;
mod frames;
mod kept;
pub mod methods;
mod rooms;
pub mod scatter;
mod spans;
mod stage;
mod texels;
mod texture;

use crate::args::AccuracyArgs;
use crate::image_out::{make_folder, write_atomically, write_image};
use crate::plot::Scatter;
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use cost::Costs;
pub use cost::solve;
use serde_json::{Value, json};
use std::error::Error;

/// A method within a family, under one case of it.
#[derive(Debug, Clone, PartialEq)]
pub struct Row {
    /// What is compared; only rows of one family, case and unit can be.
    pub family: &'static str,
    /// Under which conditions; part of the name where the family has several.
    pub case: &'static str,
    /// How it is done.
    pub method: &'static str,
    /// The unit of all three errors.
    pub unit: &'static str,
    /// Largest error.
    pub max: f64,
    /// Mean error.
    pub mean: f64,
    /// What 99.9 of 100 errors do not exceed; none where errors are rates.
    pub p999: Option<f64>,
    /// How many errors were taken.
    pub samples: u64,
    /// The firmware's kernel, or frame, that says what a pixel costs.
    pub kernel: Option<&'static str>,
    /// Instructions a pixel.
    pub per_pixel: Option<f64>,
    /// Instructions a span beside its pixels; of the renderer with what finds it.
    pub per_span: Option<f64>,
    /// What costs are compared by: a pixel's instructions, with its part of a span where all of its likes know that.
    pub cost: Option<f64>,
    /// Whether nothing in its family, case and unit is better in one and not worse in the other
    /// of cost and largest error. Only of what has a cost.
    pub on_frontier: bool,
}

/// What a row is called: family, case, method, unit, kernel.
pub type Name = (
    &'static str,
    &'static str,
    &'static str,
    &'static str,
    Option<&'static str>,
);

/// Errors of a method as they come in.
#[derive(Debug, Default, Clone)]
pub struct Errors(Vec<f32>);

impl Errors {
    /// Adds one.
    pub fn push(&mut self, error: f64) {
        self.0.push(error as f32);
    }

    /// The row of these errors.
    pub fn row(mut self, name: Name) -> Row {
        let count = self.0.len();
        self.0.sort_unstable_by(f32::total_cmp);
        let sum: f64 = self.0.iter().map(|e| f64::from(*e)).sum();
        let at = |index: usize| self.0.get(index).map_or(0.0, |e| f64::from(*e));
        let mut row = Row::rate(name, at(count.wrapping_sub(1)), sum / count.max(1) as f64);
        row.p999 = Some(at((count * 999 / 1000).min(count.saturating_sub(1))));
        row.samples = count as u64;
        row
    }
}

impl Row {
    /// A row of rates: the highest of a batch, and that of all.
    pub fn rate((family, case, method, unit, kernel): Name, max: f64, mean: f64) -> Self {
        Self {
            family,
            case,
            method,
            unit,
            max,
            mean,
            p999: None,
            samples: 0,
            kernel,
            per_pixel: None,
            per_span: None,
            cost: None,
            on_frontier: false,
        }
    }

    /// As `accuracy --json` prints it.
    pub fn to_json(&self) -> Value {
        json!({
            "family": self.family,
            "case": self.case,
            "method": self.method,
            "unit": self.unit,
            "max_error": self.max,
            "mean_error": self.mean,
            "p999_error": self.p999,
            "samples": self.samples,
            "instructions_per_pixel": self.per_pixel,
            "instructions_per_span": self.per_span,
            "on_frontier": self.on_frontier,
        })
    }
}

/// Measures all families, without costs.
///
/// # Errors
/// When something cannot be drawn, which means that this module lends too little memory.
pub fn measure() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut rows = spans::rows()?;
    rows.extend(kept::rows());
    rows.extend(coverage::rows()?);
    rows.extend(depth::rows()?);
    rows.extend(frames::rows()?);
    rows.extend(texture::rows()?);
    rows.extend(texels::rows()?);
    rows.extend(rooms::rows()?);
    rows.extend(rooms::mirror_rows()?);
    Ok(rows)
}

/// Instructions a pixel that are not told apart: ticks of the counter, and where code lies.
pub const EQUAL_COST: f64 = 0.1;

/// Pixels of a span, by which what it takes counts for each: spans of the teapot have 2.8 in the mean, those of the sphere
/// 5.4.
const SPAN: f64 = 4.0;

/// Fills in what costs are compared by, and marks the rows that are on the frontier of it and largest error among their
/// likes.
pub fn mark_frontier(rows: &mut [Row]) {
    let alike = |a: &Row, b: &Row| (a.family, a.case, a.unit) == (b.family, b.case, b.unit);
    let costs: Vec<Option<f64>> = rows
        .iter()
        .map(|row| {
            let mut likes = rows
                .iter()
                .filter(|r| alike(r, row) && r.per_pixel.is_some());
            let spans = likes.all(|r| r.per_span.is_some());
            let part = row.per_span.filter(|_| spans).unwrap_or(0.0) / SPAN;
            row.per_pixel.map(|pixel| pixel + part)
        })
        .collect();
    for (row, cost) in rows.iter_mut().zip(costs) {
        row.cost = cost;
    }
    let on: Vec<bool> = rows
        .iter()
        .map(|row| {
            row.cost.is_some_and(|this| {
                !rows.iter().any(|other| {
                    alike(row, other)
                        && other.cost.is_some_and(|c| {
                            c <= this + EQUAL_COST
                                && other.max <= row.max
                                && (c < this - EQUAL_COST || other.max < row.max)
                        })
                })
            })
        })
        .collect();
    for (row, on) in rows.iter_mut().zip(on) {
        row.on_frontier = on;
    }
}

/// Measures, prints and writes.
///
/// # Errors
/// When a file cannot be written or the firmware fails; that there is no QEMU, or no compiler for
/// it, is only noted.
pub fn run(args: &AccuracyArgs) -> Result<(), Box<dyn Error>> {
    let mut rows = measure()?;
    let (costs, note) = Costs::measured()?;
    costs.fill(&mut rows)?;
    mark_frontier(&mut rows);
    if args.json {
        let list: Vec<Value> = rows.iter().map(Row::to_json).collect();
        say!("{}", serde_json::to_string_pretty(&Value::from(list))?);
        // The list is the contract's; what could not be measured is said beside it.
        if let Some(note) = &note {
            tell!("{note}");
        }
    } else {
        say!("{}", table(&rows));
        say!(
            "error: distance from f64, beyond the rounding of the output where it is in levels; \
             * on the frontier of cost and largest error among its likes"
        );
        let cost = "cost: instructions on a Cortex-M4, a pixel and, apart, a span with its line's entry; \
                    whole frames with everything, a pixel that is seen";
        say!("{}", note.as_deref().unwrap_or(cost));
    }
    if let Some(folder) = &args.output {
        make_folder(folder)?;
        for (name, plot) in scatter::plots(&rows) {
            let file = |extension: &str| folder.join(format!("{name}.{extension}"));
            write_atomically(&file("svg"), plot.to_svg().as_bytes())?;
            write_image(&file("png"), &plot.to_frame())?;
        }
        crate::texture_report::write_plots(folder)?;
    }
    Ok(())
}

/// The plots of all families, and why there are no costs where there are none.
///
/// # Errors
/// As [`run`].
pub fn plots() -> Result<(Vec<Scatter>, Option<String>), Box<dyn Error>> {
    let mut rows = measure()?;
    let (costs, note) = Costs::measured()?;
    costs.fill(&mut rows)?;
    mark_frontier(&mut rows);
    let plots = scatter::plots(&rows).into_iter();
    Ok((plots.map(|(_, plot)| plot).collect(), note))
}

/// The rows for people.
pub fn table(rows: &[Row]) -> Table {
    let mut table = Table::new();
    table.load_preset(UTF8_FULL_CONDENSED);
    table.set_header([
        "family", "case", "method", "unit", "max", "mean", "99.9 %", "instr/px", "a span", "",
    ]);
    let number = |value: f64| match value {
        0.0 => "0".to_owned(),
        v if v >= 100.0 => format!("{v:.0}"),
        v if v >= 0.1 => format!("{v:.2}"),
        v => format!("{v:.5}"),
    };
    for row in rows {
        let some = |value: Option<f64>| value.map_or_else(|| "-".to_owned(), number);
        let rounded = |value: Option<f64>| value.map_or("-".to_owned(), |v| format!("{v:.1}"));
        table.add_row([
            row.family.to_owned(),
            row.case.to_owned(),
            row.method.to_owned(),
            row.unit.to_owned(),
            number(row.max),
            number(row.mean),
            some(row.p999),
            rounded(row.per_pixel),
            rounded(row.per_span),
            if row.on_frontier { "*" } else { "" }.to_owned(),
        ]);
    }
    for column in table.column_iter_mut().skip(4).take(5) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
