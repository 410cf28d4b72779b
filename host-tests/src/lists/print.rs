//! `disassemble`: a list as text, a line a block with its offset, and what it holds.

use super::args::DisassembleArgs;
use super::read_list;
use crate::stdio;
use scanbeam::list::{Field, Flow, Header, Id, Instruction, Run, State, VertexFormat, read_block};
use std::error::Error;
use std::fmt::Write as _;
use std::path::Path;

/// Vertices and words of a block that are printed; of the rest only how many there are.
const SHOWN: u32 = 4;

/// Prints a list file.
///
/// # Errors
/// When it cannot be read, or is malformed; what stands before is printed.
pub fn run(args: &DisassembleArgs) -> Result<(), Box<dyn Error>> {
    print_file(&args.list, &read_list(&args.list)?)
}

/// Prints the list of a file.
///
/// # Errors
/// When it is malformed, by its name; what stands before is printed. A closed pipe is none.
pub fn print_file(file: &Path, list: &[u32]) -> Result<(), Box<dyn Error>> {
    let (text, error) = listing(list);
    stdio::out(format_args!("{text}"));
    match error {
        Some(error) => Err(format!("{}: {error}", file.display()).into()),
        None => Ok(()),
    }
}

/// The text of a list, and what is wrong where it ends too soon. Blocks come as they lie: jumps
/// are printed, not taken.
#[must_use]
pub fn listing(list: &[u32]) -> (String, Option<String>) {
    let mut text = String::new();
    let mut format = VertexFormat::default();
    let mut at = 0;
    while (at as usize) < list.len() {
        let parsed = match read_block(list, at, &format) {
            Ok(parsed) => parsed,
            Err(error) => return (text, Some(error.to_string())),
        };
        let _ = write!(text, "{:08x}  {:>5} words  ", 4 * at, parsed.words);
        block(&mut text, list, at, &parsed.instruction, &format);
        if let Instruction::State(State::Format(new)) = parsed.instruction {
            format = new;
        }
        at += parsed.words;
    }
    (text, None)
}

fn block(
    text: &mut String,
    list: &[u32],
    at: u32,
    instruction: &Instruction,
    format: &VertexFormat,
) {
    let line = match instruction {
        Instruction::Flow(Flow::JumpRelative(by)) => {
            let to = (i64::from(at) + 2 + i64::from(*by)) * 4;
            // A signed offset: one before the list has no other.
            let sign = if to < 0 { "-" } else { "" };
            format!(
                "FLOW  jump by {by} words to {sign}{:08x}",
                to.unsigned_abs()
            )
        }
        Instruction::Flow(Flow::Jump(to)) => {
            format!("FLOW  jump to {:08x}", 4 * u64::from(*to))
        }
        Instruction::Flow(flow) => format!("FLOW  {flow:?}"),
        Instruction::Short(run) => run_line("SHORT", run),
        Instruction::Long(run) => run_line("LONG", run),
        Instruction::Points(run) => run_line("POINTS", run),
        Instruction::Quads(run) => run_line("QUADS", run),
        Instruction::Table(run) => run_line("TABLE", run),
        Instruction::Indexed(run) => run_line("INDEXED", run),
        Instruction::State(State::Format(format)) => {
            let fields: Vec<String> = format
                .fields()
                .iter()
                .map(|f| format!("{} {:?}", parameter_name(f.parameter), f.form))
                .collect();
            format!("STATE format: {}", fields.join(", "))
        }
        Instruction::State(state) => format!("STATE {state:?}"),
        Instruction::Later => "of a later version".into(),
        Instruction::Master(register) => format!("MASTER register {register:#x}"),
    };
    let _ = writeln!(text, "{line}");
    match instruction {
        Instruction::Short(run) | Instruction::Points(run) | Instruction::Quads(run) => {
            words(text, list, run, format.words(run.header));
        }
        Instruction::Long(run) => words(text, list, run, run.header.long_words()),
        Instruction::Indexed(run) => indices(text, list, run),
        _ => {}
    }
}

fn parameter_name(number: u8) -> String {
    match number {
        Field::PLACE => "place".into(),
        Field::DEPTH => "depth".into(),
        Field::DIFFUSE => "diffuse".into(),
        Field::SPECULAR => "specular".into(),
        Field::NORMAL => "normal".into(),
        Field::TEXTURE => "texture".into(),
        n => format!("own {n}"),
    }
}

fn run_line(name: &str, run: &Run) -> String {
    let Header {
        id,
        count,
        shade,
        prsp,
        text,
        new,
        rm,
        low,
    } = run.header;
    let mut line = format!("{name}  {count}");
    let mut say = |is: bool, what: &str| {
        if is {
            line.push(' ');
            line.push_str(what);
        }
    };
    say(shade, "shade");
    say(prsp, "prsp");
    say(text, "text");
    let separate = id == Id::Indexed && low & Header::SEPARATE != 0;
    let stripped = matches!(id, Id::Short | Id::Long | Id::Quads | Id::Indexed);
    say(stripped && new && !separate, "new");
    say(separate, "separate");
    let form = match (id, rm) {
        (Id::Quads, false) => "quads",
        (Id::Quads, true) => "quad strip",
        (_, false) => "strip",
        (_, true) => "fan",
    };
    say(stripped && !separate, form);
    say(id == Id::Quads && low & Header::SPLIT != 0, "split 1-3");
    say(id == Id::Indexed && low & Header::WIDE != 0, "wide");
    line
}

/// The first vertices, a line each.
fn words(text: &mut String, list: &[u32], run: &Run, each: u32) {
    let count = u32::from(run.header.count);
    for n in 0..count.min(SHOWN) {
        let from = (run.at + n * each) as usize;
        let vertex: Vec<String> = list[from..from + each as usize]
            .iter()
            .map(|w| format!("{:08x}", u32::from_le(*w)))
            .collect();
        let _ = writeln!(text, "          {n:>5}: {}", vertex.join(" "));
    }
    if count > SHOWN {
        let _ = writeln!(text, "          ... {} more", count - SHOWN);
    }
}

/// All indices; a bar ends a strip.
fn indices(text: &mut String, list: &[u32], run: &Run) {
    let wide = run.header.low & Header::WIDE != 0;
    let (each, bits, none) = if wide { (2, 16, 0xFFFF) } else { (4, 8, 0xFF) };
    let mut line = String::new();
    for n in 0..u32::from(run.header.count) {
        let word = u32::from_le(list[(run.at + n / each) as usize]);
        let index = word >> (bits * (n % each)) & none;
        let _ = match index {
            i if i == none => write!(line, " |"),
            i => write!(line, " {i}"),
        };
        if line.len() > 90 {
            let _ = writeln!(text, "         {line}");
            line.clear();
        }
    }
    if !line.is_empty() {
        let _ = writeln!(text, "         {line}");
    }
}
