//! A run of a board, judged.

use super::chips::Limits;
use super::expected::Expected;
use super::panel::Panel;
use super::wire::{self, Event, FRAMES, Figures, Use};
use comfy_table::{CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use serde::Serialize;

/// What a board has done.
#[derive(Debug, Clone, Default, PartialEq, Serialize)]
pub struct Outcome {
    /// Its name.
    pub board: &'static str,
    /// Whether it was run.
    pub ran: bool,
    /// Whole frames that came.
    pub frames: usize,
    /// All frames that were asked for came, each with the host's bits.
    pub crc_match: bool,
    /// The panel got the commands that it wants, and no others.
    pub commands_match: bool,
    /// What chip and panel complained of.
    pub complaints: Vec<String>,
    /// Of the processor's clock, from a frame's first pixel to the next frame's; `None` where the
    /// emulator has no time.
    pub cycles_per_frame: Option<u64>,
    /// Of these, the bus to the panel was busy.
    pub bus_cycles: Option<u64>,
    /// Cycles that cores waited in a frame, theirs added up.
    pub wait_cycles: Option<u64>,
    /// Misses of the flash's cache in a frame.
    pub xip_misses: Option<u64>,
    /// Frames a second.
    pub fps: Option<f64>,
    /// The clock of the bus to the panel, in Hz.
    pub bus_hz: Option<u64>,
    /// The most bytes that core 0's stack had.
    pub stack_bytes: Option<u64>,
    /// Divisions of all cores in a frame, by the chip's divider.
    pub divisions: Option<u64>,
    /// Why it was not run.
    #[serde(skip)]
    pub missing: Option<String>,
    /// What was read since the first frame began, where that was asked for.
    #[serde(skip)]
    pub uses: Vec<Use>,
    /// For the reader.
    #[serde(skip)]
    pub notes: Vec<String>,
}

impl Outcome {
    /// A board that cannot be run here.
    pub fn skipped(board: &'static str, missing: String) -> Self {
        Self {
            board,
            missing: Some(missing),
            ..Self::default()
        }
    }

    /// What an emulator printed, judged.
    pub fn of(board: &'static str, printed: &str, expected: &Expected) -> Self {
        let mut run = Run::default();
        let mut outcome = Self {
            board,
            ran: true,
            ..Self::default()
        };
        for line in printed.lines() {
            match wire::parse(line) {
                Ok(Event::Note(text)) => outcome.notes.push(text),
                Ok(Event::Use(used)) => outcome.uses.push(used),
                Ok(event) => run.take(event),
                Err(reason) => run.panel.complain(format!("the emulator says {reason}")),
            }
        }
        run.panel.finish();
        match run.end.as_deref() {
            Some(FRAMES) => {}
            Some(why) => run.panel.complain(why),
            None => run.panel.complain("the emulator was cut short"),
        }
        outcome.frames = run.panel.frames().len();
        outcome.crc_match = run.panel.frames() == expected.frames;
        outcome.commands_match = run.panel.commands() == expected.commands;
        outcome.complaints = run.panel.complaints().to_vec();
        outcome.spend(&run);
        outcome
    }

    /// What a frame takes on average, from the first frame's opening to the last's.
    fn spend(&mut self, run: &Run) {
        (self.bus_hz, self.stack_bytes) = (run.bus, run.stack);
        let shown = self.frames.max(1) as u64;
        self.divisions = run.divisions.map(|all| all / shown);
        let ([first, .., last], Some(clock)) = (&run.figures[..], run.clock) else {
            return;
        };
        let frames = run.figures.len() as u64 - 1;
        let each = |of: fn(&Figures) -> u64| of(last).saturating_sub(of(first)) / frames;
        let cycles = each(|figures| figures.cycles);
        self.cycles_per_frame = Some(cycles);
        self.bus_cycles = Some(each(|figures| figures.bus));
        self.wait_cycles = Some(each(|figures| figures.wait));
        self.xip_misses = Some(each(|figures| figures.misses));
        // To a hundredth: the model is no better.
        self.fps = Some((100.0 * clock as f64 / cycles.max(1) as f64).round() / 100.0);
    }

    /// Complains where a run keeps to a limit of its chip not, or says nothing of it.
    pub fn hold(&mut self, limits: Limits) {
        if !self.ran {
            return;
        }
        let kept = [
            (
                "misses of the flash's cache a frame",
                self.xip_misses,
                limits.misses,
            ),
            ("bytes of core 0's stack", self.stack_bytes, limits.stack),
            ("divisions a frame", self.divisions, limits.divisions),
        ];
        for (what, is, most) in kept {
            let Some(most) = most else { continue };
            match is {
                Some(is) if is <= most => {}
                Some(is) => self
                    .complaints
                    .push(format!("{is} {what}, and not {most} at most")),
                None => self.complaints.push(format!("nothing is said of {what}")),
            }
        }
        if let Some(hertz) = limits.bus_hz.filter(|hertz| self.bus_hz != Some(*hertz)) {
            let is = self
                .bus_hz
                .map_or("an unknown rate".into(), |is| format!("{is} Hz"));
            self.complaints
                .push(format!("the bus runs at {is}, and not at {hertz} Hz"));
        }
    }

    /// Whether nothing is wrong: it did what it should, or could not be run.
    pub fn is_good(&self) -> bool {
        !self.ran || self.crc_match && self.commands_match && self.complaints.is_empty()
    }

    /// Says on stderr what the table has no room for.
    pub fn explain(&self) {
        if let Some(missing) = &self.missing {
            tell!("SKIPPED: {}: {missing}", self.board);
        }
        for complaint in &self.complaints {
            tell!("{}: {complaint}", self.board);
        }
        if !self.is_good() {
            for note in &self.notes {
                tell!("{}: note: {note}", self.board);
            }
        }
    }
}

/// A run, as far as it has come.
#[derive(Default)]
struct Run {
    panel: Panel,
    figures: Vec<Figures>,
    clock: Option<u64>,
    bus: Option<u64>,
    stack: Option<u64>,
    divisions: Option<u64>,
    end: Option<String>,
}

impl Run {
    fn take(&mut self, event: Event) {
        match event {
            Event::Time(micros) => self.panel.at(micros),
            Event::Data { is_data, bytes } if is_data => self.panel.data(&bytes),
            Event::Data { bytes, .. } => self.panel.codes(&bytes),
            Event::Picture { size, bytes } => self.panel.show(size, &bytes),
            Event::Figures(figures) => self.figures.push(figures),
            Event::Clock(hertz) => self.clock = Some(hertz),
            Event::Bus(hertz) => self.bus = Some(hertz),
            Event::Stack(bytes) => self.stack = Some(bytes),
            Event::Divisions(all) => self.divisions = Some(all),
            Event::Fault(text) => self.panel.complain(text),
            Event::End(why) => self.end = Some(why),
            Event::Note(_) | Event::Use(_) => {}
        }
    }
}

/// The boards for people.
pub fn table(outcomes: &[Outcome]) -> Table {
    let mut table = Table::new();
    table.load_preset(UTF8_FULL_CONDENSED).set_header([
        "board",
        "frames",
        "bits",
        "commands",
        "complaints",
        "cycles/frame",
        "bus",
        "wait",
        "misses",
        "fps",
    ]);
    for outcome in outcomes {
        let verdict = |holds: bool| match (outcome.ran, holds) {
            (false, _) => "-",
            (true, true) => "host's",
            (true, false) => "OTHER",
        };
        let number = |figure: Option<u64>| figure.map_or("-".into(), |n| n.to_string());
        let frames = if outcome.ran {
            outcome.frames.to_string()
        } else {
            "SKIPPED".into()
        };
        table.add_row([
            outcome.board.to_owned(),
            frames,
            verdict(outcome.crc_match).into(),
            verdict(outcome.commands_match).replace("host's", "all"),
            outcome.complaints.len().to_string(),
            number(outcome.cycles_per_frame),
            number(outcome.bus_cycles),
            number(outcome.wait_cycles),
            number(outcome.xip_misses),
            outcome.fps.map_or("-".into(), |fps| format!("{fps:.2}")),
        ]);
    }
    for column in table.column_iter_mut().skip(4) {
        column.set_cell_alignment(CellAlignment::Right);
    }
    table
}
