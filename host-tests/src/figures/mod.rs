//! What a board was measured to cost, as named figures: for reports, and for the gate.
//!
//! | file | there |
//! |---|---|
//! | `gate.rs` | the record of figures, and what is slower than it |
//! | `growth.rs` | cost against triangles, as a plot |
//! | `goals.rs` | figures beside what was wanted |
//! | `suite.rs` | the suite beside the best of others, as a table |

pub mod gate;
pub mod goals;
pub mod growth;
pub mod suite;

use crate::accuracy::solve;
use crate::firmware::{KernelRun, LinesRun, Output, Sections};
use serde_json::{Value, json};
use std::collections::BTreeMap;

/// A cost: less is better.
#[derive(Clone, Debug, PartialEq)]
pub struct Figure {
    /// What costs: `frame sphere`, `kernel flat_565 pixel`, `text small` ...
    pub name: String,
    /// Instructions, or bytes.
    pub value: f64,
    /// How far it may be off by the way it is measured: beside the tolerance, which is a part of it.
    pub grain: f64,
}

/// What a pixel and a span of a kernel cost.
#[derive(Clone, Debug, PartialEq)]
pub struct Kernel {
    /// Which.
    pub name: String,
    /// Instructions a pixel.
    pub pixel: f64,
    /// Instructions a span, with its line's entry.
    pub span: f64,
}

/// What the lines of a scene cost (X8).
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Lines {
    /// Which scene.
    pub scene: String,
    /// Instructions before the first line.
    pub pass_one: u64,
    /// Half of the lines cost no more.
    pub median: u64,
    /// 99 of 100 lines cost no more.
    pub p99: u64,
    /// The dearest line.
    pub worst: u64,
    /// Which line that is.
    pub worst_line: usize,
}

impl Lines {
    /// Of a scene's lines; `None` where it has none.
    #[must_use]
    pub fn new(run: &LinesRun) -> Option<Self> {
        let mut sorted = run.costs.clone();
        sorted.sort_unstable();
        let worst = *sorted.last()?;
        Some(Self {
            scene: run.scene.clone(),
            pass_one: run.pass_one,
            median: sorted[sorted.len() / 2],
            p99: sorted[(sorted.len() * 99).div_ceil(100) - 1],
            worst,
            worst_line: run.costs.iter().position(|cost| *cost == worst)?,
        })
    }

    fn to_json(&self) -> Value {
        json!({
            "scene": self.scene,
            "pass_one": self.pass_one,
            "median": self.median,
            "p99": self.p99,
            "worst": self.worst,
            "worst_line": self.worst_line,
        })
    }
}

/// A small program that was built to be measured.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Size {
    /// Its name.
    pub program: &'static str,
    /// What it takes.
    pub sections: Sections,
}

/// Instructions of single things; of a vertex out of a list what it takes more than one of a call.
fn units(output: &Output) -> Vec<(String, f64)> {
    let each = |instructions: u64, count: u64| instructions as f64 / count.max(1) as f64;
    let measured = output.units.iter();
    let mut units: Vec<_> = measured
        .map(|unit| (unit.name.clone(), each(unit.instructions, unit.count)))
        .collect();
    let figure = |name: &str| output.figures.get(name).copied();
    if let (Some(listed), Some(called), Some(vertices)) = (
        figure("list_pass_one"),
        figure("calls_pass_one"),
        figure("list_vertices"),
    ) {
        let more = each(listed.saturating_sub(called), vertices);
        units.push(("listed_vertex".into(), more));
    }
    units
}

/// Everything that `--bench` measures on a board.
#[derive(Clone, Debug, PartialEq)]
pub struct Bench {
    /// Kernels, in the order in which they ran.
    pub kernels: Vec<Kernel>,
    /// Single things and their instructions.
    pub units: Vec<(String, f64)>,
    /// Scenes line by line.
    pub lines: Vec<Lines>,
    /// Spheres, for each number of slots.
    pub growth: Vec<growth::Curve>,
    /// Small programs.
    pub sizes: Vec<Size>,
}

impl Bench {
    /// From what the firmware printed; `spans` are those of [`growth::spans`].
    ///
    /// # Errors
    /// When a kernel did not run twice, or a scene has no lines.
    pub fn new(
        output: &Output,
        spans: &BTreeMap<u64, u64>,
        sizes: Vec<Size>,
    ) -> Result<Self, String> {
        let mut kernels: Vec<Kernel> = Vec::new();
        for run in &output.kernels {
            if kernels.iter().any(|kernel| kernel.name == run.name) {
                continue;
            }
            let of_name = output.kernels.iter().filter(|k| k.name == run.name);
            let same: Vec<&KernelRun> = of_name.collect();
            let [long, short] = same[..] else {
                return Err(format!("kernel {}: {} runs, not 2", run.name, same.len()));
            };
            let (pixel, span) =
                solve(long, short).ok_or(format!("kernel {}: no two equations", run.name))?;
            kernels.push(Kernel {
                name: run.name.clone(),
                pixel,
                span,
            });
        }
        let lines: Option<Vec<Lines>> = output.lines.iter().map(Lines::new).collect();
        Ok(Self {
            kernels,
            units: units(output),
            lines: lines.ok_or("a scene has no lines")?,
            growth: growth::curves(&output.growth, spans)?,
            sizes,
        })
    }

    /// The cost of a single thing.
    #[must_use]
    pub fn unit(&self, name: &str) -> Option<f64> {
        let found = self.units.iter().find(|(unit, _)| unit == name);
        found.map(|(_, instructions)| *instructions)
    }

    /// All that is held against a record.
    #[must_use]
    pub fn figures(&self) -> Vec<Figure> {
        let mut figures = Vec::new();
        let mut figure = |name: String, value: f64, grain: f64| {
            figures.push(Figure { name, value, grain });
        };
        for kernel in &self.kernels {
            // Two runs that are exact to 40, over some 1,700 pixels or 60 spans.
            figure(format!("kernel {} pixel", kernel.name), kernel.pixel, 0.03);
            figure(format!("kernel {} span", kernel.name), kernel.span, 1.5);
        }
        for (name, instructions) in &self.units {
            // Differences of differences, each exact to 4.
            figure(format!("unit {name}"), *instructions, 2.0);
        }
        for lines in &self.lines {
            let Lines { scene, .. } = lines;
            let parts = [
                ("pass one", lines.pass_one),
                ("median", lines.median),
                ("99th percentile", lines.p99),
                ("worst", lines.worst),
            ];
            for (part, instructions) in parts {
                figure(format!("lines {scene} {part}"), instructions as f64, 8.0);
            }
        }
        for Size { program, sections } in &self.sizes {
            figure(format!("text {program}"), sections.text_bytes() as f64, 0.0);
            figure(format!("fast {program}"), fast_bytes(sections) as f64, 0.0);
        }
        figures
    }

    /// Adds the keys of `--bench` to a board's report.
    pub fn add_to(&self, report: &mut Value) {
        let list = |values: Vec<Value>| Value::from(values);
        report["kernels"] = list(
            self.kernels
                .iter()
                .map(|kernel| {
                    json!({
                        "kernel": kernel.name,
                        "instructions_per_pixel": round(kernel.pixel),
                        "setup_per_span": round(kernel.span),
                    })
                })
                .collect(),
        );
        report["per_active_line"] = json!(self.unit("active_line").map(round));
        report["per_span_entry"] = json!(self.unit("span").map(round));
        report["per_triangle_setup"] = json!(self.unit("triangle_setup_small").map(round));
        let units = self.units.iter();
        report["units"] = units
            .map(|(name, each)| (name.clone(), json!(round(*each))))
            .collect();
        report["lines"] = list(self.lines.iter().map(Lines::to_json).collect());
        report["growth"] = list(
            self.growth
                .iter()
                .flat_map(growth::Curve::to_json)
                .collect(),
        );
        report["sizes"] = list(
            self.sizes
                .iter()
                .map(|Size { program, sections }| {
                    json!({
                        "program": program,
                        "text_bytes": sections.text_bytes(),
                        "rodata_bytes": sections.rodata.bytes,
                        "ram_bytes": sections.ram_bytes(),
                        "fast_bytes": fast_bytes(sections),
                        "slow_bytes": sections.slow_bytes(),
                    })
                })
                .collect(),
        );
    }

    /// For people.
    pub fn print(&self) {
        say!("  kernel                    instr/px  a span with its line");
        for Kernel { name, pixel, span } in &self.kernels {
            say!("    {name:22} {pixel:>9.2} {span:>9.1}");
        }
        say!("  one more                     instr");
        for (name, each) in &self.units {
            say!("    {name:22} {each:>9.1}");
        }
        say!("  lines of     pass one    median  99th pct     worst  (line)");
        for l in &self.lines {
            say!(
                "    {:9} {:>9} {:>9} {:>9} {:>9}  ({})",
                l.scene,
                l.pass_one,
                l.median,
                l.p99,
                l.worst,
                l.worst_line
            );
        }
        say!("  sphere     triangles     instr   a triangle  a span");
        for curve in &self.growth {
            for point in &curve.points {
                say!(
                    "    {:4} slots {:>7} {:>9} {:>10.1} {:>10.1}",
                    curve.slots,
                    point.run.triangles,
                    point.instructions(),
                    point.per_triangle(),
                    point.per_span()
                );
            }
        }
        say!("  program       code  constants  fast RAM with line buffers");
        for Size { program, sections } in &self.sizes {
            say!(
                "    {program:8} {:>7} {:>9} {:>9}",
                sections.text_bytes(),
                sections.rodata.bytes,
                fast_bytes(sections)
            );
        }
    }
}

/// Bytes of fast RAM: the cache, the line's depth and spans, and the line buffers.
fn fast_bytes(sections: &Sections) -> u64 {
    sections.fast.bytes + sections.dma.bytes
}

/// To three digits after the point, so that a report does not change by how a quotient is written.
fn round(value: f64) -> f64 {
    (value * 1000.0).round() / 1000.0
}
