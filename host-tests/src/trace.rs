//! `trace`: the tokens that the hardware model makes of one line, a line of text each (K13).
//!
//! The text is made from the bits as they travel and from the charts' tables, so it shows what
//! is on the wires, not what the program meant.

use crate::args::TraceArgs;
use crate::draw::{Overfull, Prepared, trace_model_line};
use crate::model::Model;
use crate::reference::View;
use crate::stdio;
use scanbeam_model::{Chart, PipeCounts, Token, TokenBits};
use std::error::Error;
use std::io::{self, Write};

/// Prints the tokens of a line.
///
/// # Errors
/// When the model cannot be read or drawn. A closed pipe is none.
pub fn run(args: &TraceArgs) -> Result<(), Box<dyn Error>> {
    let model = Model::load(&args.model)?;
    let traced = trace(&model, &args.picture.view(), args.line)
        .map_err(|error| format!("{}: {error}", args.model.display()))?;
    model.print_warnings();
    if let Some(overfull) = &traced.overfull {
        tell!("warning: {}: {overfull}", args.model.display());
    }
    stdio::note(traced.write(&mut io::stdout().lock()));
    Ok(())
}

/// What a line was drawn with.
#[derive(Debug, Clone, PartialEq)]
pub struct Traced {
    /// The line.
    pub line: u16,
    /// Pixels a line.
    pub width: u16,
    /// All tokens, as they travel.
    pub tokens: Vec<TokenBits>,
    /// What the pipeline did with them.
    pub counts: PipeCounts,
    /// What is left out of the line.
    pub overfull: Option<Overfull>,
}

/// Draws one line of a view with the hardware model and keeps its tokens.
///
/// # Errors
/// When the view cannot be had in the crate's ranges.
pub fn trace(model: &Model, view: &View, line: u16) -> Result<Traced, Box<dyn Error>> {
    let mut tokens = Vec::new();
    let keep = |token: &Token| tokens.push(token.encode());
    let (counts, overfull) = trace_model_line(&Prepared::new(model), view, line, keep)?;
    Ok(Traced {
        line,
        width: view.width as u16,
        tokens,
        counts,
        overfull,
    })
}

impl Traced {
    /// Writes a head, a line for each token, and what the pipeline did.
    ///
    /// # Errors
    /// What the writer says.
    pub fn write(&self, out: &mut impl Write) -> io::Result<()> {
        writeln!(
            out,
            "line {}, {} pixels, {} tokens; fields that are 0 are left out",
            self.line,
            self.width,
            self.tokens.len()
        )?;
        for (i, bits) in self.tokens.iter().enumerate() {
            writeln!(out, "{i:6}  {}", describe(*bits))?;
        }
        let PipeCounts {
            clocks,
            stalls,
            pixels,
            hidden,
        } = self.counts;
        writeln!(
            out,
            "{pixels} pixels, {hidden} of them hidden; {clocks} clocks, {stalls} of them waiting"
        )
    }
}

/// A token as text: its 77 bits in hexadecimal, its chart, and its fields that are not 0.
#[must_use]
pub fn describe(bits: TokenBits) -> String {
    let head = format!("{bits:020x}");
    let Some(chart) = Chart::of(bits) else {
        return if bits.is_setup() {
            format!("{head}  - set-up of parameter {}", bits.id())
        } else if bits.id() == 0 {
            format!("{head}  - null")
        } else {
            format!("{head}  - unknown, id {}", bits.id())
        };
    };
    let mut text = format!("{head}  {} {}", chart.letter, chart.title);
    for (field, value) in chart.values(bits).filter(|(_, value)| *value != 0) {
        text.push_str("  ");
        text.push_str(field.name);
        match field.width {
            1 => {}
            32.. => text.push_str(&format!("={value:#x}")),
            // The components of a normal have a sign.
            12 if field.name.starts_with('N') => {
                let signed = (value << 52) as i64 >> 52;
                text.push_str(&format!("={signed}"));
            }
            _ => text.push_str(&format!("={value}")),
        }
    }
    text
}
