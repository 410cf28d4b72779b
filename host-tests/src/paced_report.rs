//! `firmware --paced`: what each line of a paced frame takes, of what it is reckoned to cost (X9).
//!
//! The firmware draws the frames of [`unhurried`] with a renderer that is paced and has time enough; the host draws them
//! too, and says what was paid for each line. Costs hold if no line takes more than was paid.
//!
//! Beside each cost stands the least that it could be, all others as they are: how tight it is, on these lines.

use crate::args::FirmwareArgs;
use crate::firmware::{Board, FirmwareError, LinesRun, M0_PLUS, Profile, Toolchain, measure};
use crate::frames::reckoned_lines;
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use scanbeam::frame::Pace;
use scenes::{Frame, unhurried};
use serde_json::{Value, json};
use std::collections::BTreeMap;
use std::error::Error;

/// Measures on each board that is asked for, and prints; `false` where a line takes more than was paid for it.
///
/// # Errors
/// When the firmware cannot be built or run, or did not say what it should.
pub fn run(args: &FirmwareArgs) -> Result<bool, Box<dyn Error>> {
    let toolchain = Toolchain::find()?;
    let mut reports = Vec::new();
    for board in args.boards() {
        let measured = unhurried_lines(&toolchain, &board)?;
        for is_textured in [false, true] {
            let costs = Costs::new(&board, is_textured, &measured)?;
            let least = costs.least()?;
            if !args.json {
                costs.print(&least);
            }
            reports.push((costs, least));
        }
    }
    if args.json {
        let all = reports.iter().map(|(costs, least)| costs.to_json(least));
        say!(
            "{}",
            serde_json::to_string_pretty(&all.collect::<Vec<Value>>())?
        );
    }
    Ok(reports.iter().all(|(costs, _)| costs.hold()))
}

/// What the lines of those frames take on a board, by frame.
///
/// # Errors
/// When the firmware cannot be built or run, or did not say what it should.
pub fn unhurried_lines(
    toolchain: &Toolchain,
    board: &Board,
) -> Result<BTreeMap<String, Vec<u64>>, FirmwareError> {
    let measured = measure(toolchain, board, Profile::Release, &["paced"])?;
    let lines = measured.output.lines.into_iter();
    Ok(lines
        .map(|LinesRun { scene, costs, .. }| (scene, costs))
        .collect())
}

/// A step of a line that has a cost.
#[derive(Clone, Copy)]
struct Step {
    name: &'static str,
    cost: fn(&mut Pace) -> &mut u16,
}

/// All of them, but for `column`, since all lines have as many.
const STEPS: [Step; 10] = [
    Step::new("line", |pace| &mut pace.line),
    Step::new("begin", |pace| &mut pace.begin),
    Step::new("large", |pace| &mut pace.large),
    Step::new("turn", |pace| &mut pace.turn),
    Step::new("span", |pace| &mut pace.span),
    Step::new("word", |pace| &mut pace.word),
    Step::new("step", |pace| &mut pace.step),
    Step::new("pair", |pace| &mut pace.pair),
    Step::new("run", |pace| &mut pace.run),
    Step::new("pixel", |pace| &mut pace.pixel),
];

impl Step {
    const fn new(name: &'static str, cost: fn(&mut Pace) -> &mut u16) -> Self {
        Self { name, cost }
    }

    /// Costs where this step costs 1, and nothing else does.
    fn alone(self) -> Pace {
        let mut pace = Pace {
            most: u32::MAX,
            line: 0,
            column: 0,
            begin: 0,
            large: 0,
            turn: 0,
            span: 0,
            word: 0,
            step: 0,
            pair: 0,
            run: 0,
            pixel: 0,
        };
        *(self.cost)(&mut pace) = 1;
        pace
    }
}

/// A line that was measured.
#[derive(Clone, Copy, Debug)]
pub struct Line {
    /// Its frame.
    pub frame: &'static str,
    /// Its number.
    pub number: usize,
    /// Instructions that it took.
    pub took: u64,
    /// What was paid for it.
    pub paid: u32,
}

impl Line {
    /// Whether it took no more than was paid.
    #[must_use]
    pub fn is_paid(&self) -> bool {
        self.took <= u64::from(self.paid)
    }

    /// The part of what was paid that it took.
    fn part(&self) -> f64 {
        self.took as f64 / f64::from(self.paid.max(1))
    }
}

/// The costs of a look on a board, and what lines take that pay them.
#[derive(Debug)]
pub struct Costs {
    board: &'static str,
    is_textured: bool,
    pace: Pace,
    /// The lines of frames with that look.
    pub lines: Vec<Line>,
}

impl Costs {
    /// The costs that the library has, and what was measured.
    ///
    /// # Errors
    /// When a frame was not measured, or does not fit its memory.
    pub fn new(
        board: &Board,
        is_textured: bool,
        measured: &BTreeMap<String, Vec<u64>>,
    ) -> Result<Self, Box<dyn Error>> {
        let pace = match (*board == M0_PLUS, is_textured) {
            (false, false) => Pace::GOURAUD_M4,
            (false, true) => Pace::TEXTURED_M4,
            (true, false) => Pace::GOURAUD_M0,
            (true, true) => Pace::TEXTURED_M0,
        };
        let mut lines = Vec::new();
        for (name, frame) in frames_of(is_textured) {
            let took = measured.get(name);
            let took = took.ok_or_else(|| format!("{name} was not measured"))?;
            let paid = reckoned_lines(frame, pace)?;
            if took.len() != paid.len() {
                return Err(format!("{name} has {} lines", took.len()).into());
            }
            let both = took.iter().zip(&paid).enumerate();
            lines.extend(both.map(|(number, (&took, &paid))| Line {
                frame: name,
                number,
                took,
                paid,
            }));
        }
        Ok(Self {
            board: board.name,
            is_textured,
            pace,
            lines,
        })
    }

    /// Whether no line takes more than was paid for it.
    #[must_use]
    pub fn hold(&self) -> bool {
        self.lines.iter().all(Line::is_paid)
    }

    /// The line that takes most of what was paid for it.
    fn tightest(&self) -> Option<&Line> {
        let part = |a: &&Line, b: &&Line| a.part().total_cmp(&b.part());
        self.lines.iter().max_by(part)
    }

    /// The part that a line takes of what was paid, in the median.
    fn median(&self) -> f64 {
        let mut parts: Vec<f64> = self.lines.iter().map(Line::part).collect();
        parts.sort_by(f64::total_cmp);
        parts.get(parts.len() / 2).copied().unwrap_or_default()
    }

    /// The least that each step could cost, all others as they are, in the order of [`STEPS`]; 0 where any would do.
    ///
    /// How often a step was paid for is what a line costs where that step costs 1, and all others nothing.
    fn least(&self) -> Result<[u32; STEPS.len()], Box<dyn Error>> {
        let mut least = [0; STEPS.len()];
        let mut pace = self.pace;
        for (least, step) in least.iter_mut().zip(STEPS) {
            let cost = u64::from(*(step.cost)(&mut pace));
            let mut times = Vec::new();
            for (_, frame) in frames_of(self.is_textured) {
                times.extend(reckoned_lines(frame, step.alone())?);
            }
            for (line, times) in self.lines.iter().zip(times) {
                let others = u64::from(line.paid) - cost * u64::from(times);
                let lacks = line.took.saturating_sub(others);
                if times != 0 {
                    *least = lacks.div_ceil(times.into()).max(*least);
                }
            }
        }
        Ok(least.map(|least| least as u32))
    }

    /// What the costs are of.
    fn name(&self) -> String {
        let look = if self.is_textured {
            "textured"
        } else {
            "smooth"
        };
        format!("{look} on {}", self.board)
    }

    fn print(&self, least: &[u32; STEPS.len()]) {
        let (lines, median) = (self.lines.len(), 100.0 * self.median());
        say!(
            "{}: {lines} lines take {median:.0} % of what was paid, in the median",
            self.name()
        );
        if let Some(line) = self.tightest() {
            let Line {
                frame,
                number,
                took,
                paid,
            } = line;
            let part = 100.0 * line.part();
            say!("line {number} of {frame} takes most of it: {took} of {paid}, {part:.1} %");
        }
        let mut table = Table::new();
        let header = ["step", "cost", "least, the others as they are"];
        table.load_preset(UTF8_FULL_CONDENSED).set_header(header);
        let mut pace = self.pace;
        for (step, least) in STEPS.iter().zip(least) {
            let cost = *(step.cost)(&mut pace);
            table.add_row([step.name.to_owned(), cost.to_string(), least.to_string()]);
        }
        for column in table.column_iter_mut().skip(1) {
            column.set_cell_alignment(CellAlignment::Right);
        }
        say!("{table}");
    }

    fn to_json(&self, least: &[u32; STEPS.len()]) -> Value {
        let mut pace = self.pace;
        let steps = STEPS.iter().zip(least).map(|(step, least)| {
            let cost = *(step.cost)(&mut pace);
            (
                step.name.to_owned(),
                json!({ "cost": cost, "least": least }),
            )
        });
        let steps: serde_json::Map<String, Value> = steps.collect();
        json!({
            "costs": self.name(),
            "lines": self.lines.len(),
            "median": self.median(),
            "most": self.tightest().map(Line::part),
            "steps": steps,
        })
    }
}

/// The frames that have textures, or those that have none.
fn frames_of(is_textured: bool) -> impl Iterator<Item = (&'static str, Frame)> {
    unhurried().filter(move |(_, frame)| frame.is_textured() == is_textured)
}
