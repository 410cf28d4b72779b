//! `trace`: the tokens that the hardware model makes of one line, a line of text each (K13).
//!
//! The text is made from the bits as they travel and from the charts' tables, so it shows what
//! is on the wires, not what the program meant.

use crate::args::TraceArgs;
use crate::draw::{ModelLines, Overfull, Prepared, Setting, rooms_for};
use crate::model::Model;
use crate::reference::{Shade, View};
use crate::stdio;
use scanbeam::pipeline::{FlatDepth, GouraudDepth, Pipeline};
use scanbeam::pixel::{PixelFormat, Rgb888};
use scanbeam_model::{Chart, CornerColours, PipeCounts, Token, TokenBits};
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
    let prepared = Prepared::new(model);
    match view.shade {
        Shade::Flat => trace_as::<FlatDepth<Rgb888>>(&prepared, view, line),
        _ => trace_as::<GouraudDepth<Rgb888>>(&prepared, view, line),
    }
}

fn trace_as<P>(prepared: &Prepared, view: &View, line: u16) -> Result<Traced, Box<dyn Error>>
where
    P: Pipeline<Shading: CornerColours>,
{
    let width = view.width as u16;
    let setting = Setting::new(prepared, view)?;
    let mut rooms = rooms_for::<P>(prepared, 1);
    let mut lines = ModelLines::new(width);
    let mut renderer = lines.renderer();
    let background = P::Pixel::from_rgb8(view.background);
    let mut pixels = vec![background; usize::from(width)];
    let mut tokens = Vec::new();
    let mut failure = None;
    let bands = setting.bands(prepared, &mut rooms, line..line + 1, |scene| {
        let mut keep = |token: &Token| tokens.push(token.encode());
        failure = renderer
            .trace_line(scene, line, background, &mut pixels, &mut keep)
            .err();
        Ok(())
    })?;
    match failure {
        Some(error) => Err(error.into()),
        None => Ok(Traced {
            line,
            width,
            tokens,
            counts: renderer.counts(),
            overfull: bands.overfull,
        }),
    }
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
