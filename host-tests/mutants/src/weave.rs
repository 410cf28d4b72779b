//! Weaves mutants into the source of a file, each behind a question that is asked at run time.

use crate::site::{Kind, Site, Source};
use std::collections::HashSet;
use std::ops::Range;

/// Source with its mutants.
#[derive(Debug)]
pub struct Woven {
    /// What is compiled.
    pub text: String,
    /// What was woven in.
    pub pieces: Vec<Piece>,
}

/// A part of the woven text, and the mutants that it is there for.
#[derive(Debug)]
pub struct Piece {
    /// Bytes of the woven text.
    pub at: Range<usize>,
    /// Mutants.
    pub ids: Vec<usize>,
}

/// Which mutants are woven in, and which functions stay constant.
#[derive(Debug, Default)]
pub struct Choices {
    /// Those that are not.
    pub dropped: HashSet<usize>,
    /// Names of functions.
    pub constant: HashSet<String>,
}

/// What is put in at a place. At one place sites end, inner ones first, before others begin, outer
/// ones first.
struct Insert {
    at: usize,
    rank: (u8, isize),
    text: String,
    /// Ranges within `text`.
    pieces: Vec<(Range<usize>, usize)>,
    site: usize,
}

const ENDS: u8 = 0;
const LEAVES: u8 = 1;
const BEGINS: u8 = 2;

/// The source with those mutants that are alive, and those functions constant that are named.
#[must_use]
pub fn weave(
    source: &Source,
    is_live: impl Fn(usize) -> bool,
    constant: &HashSet<String>,
) -> Woven {
    let mut inserts = Vec::new();
    for (number, site) in source.sites.iter().enumerate() {
        if site.choices.iter().any(|choice| is_live(choice.id)) {
            insert(site, number, &is_live, &mut inserts);
        }
    }
    inserts.sort_by_key(|insert| (insert.at, insert.rank));
    let mut text = source.text.clone().into_bytes();
    for function in &source.const_fns {
        if !constant.contains(&function.name) {
            text[function.keyword.clone()].fill(b' ');
        }
    }
    let text = String::from_utf8(text).expect("spaces are put over words");
    join(source, &text, &inserts)
}

/// The question whether a mutant is on.
#[must_use]
pub fn question(id: usize) -> String {
    format!("crate::mutant::on({id})")
}

fn insert(site: &Site, number: usize, live: &dyn Fn(usize) -> bool, to: &mut Vec<Insert>) {
    let mut head = String::new();
    let mut pieces = Vec::new();
    if site.kind == Kind::Instead {
        head.push('(');
    }
    for choice in site.choices.iter().filter(|choice| live(choice.id)) {
        let start = head.len();
        let (id, text) = (choice.id, &choice.text);
        let asked = question(id);
        head += &match site.kind {
            Kind::Instead => format!("if {asked} {{ {text} }} else "),
            Kind::LeftOut => format!("if !{asked} "),
            Kind::Left => format!(" if {asked} {{ return {text}; }} "),
        };
        pieces.push((start..head.len(), id));
    }
    let order = number.cast_signed();
    let mut put = |at, rank, text: String, pieces| {
        to.push(Insert {
            at,
            rank,
            text,
            pieces,
            site: number,
        });
    };
    match site.kind {
        Kind::Left => put(site.at.start, (LEAVES, order), head, pieces),
        Kind::Instead | Kind::LeftOut => {
            let tail = if site.kind == Kind::Instead {
                "})"
            } else {
                "}"
            };
            put(site.at.start, (BEGINS, order), head + "{ ", pieces);
            put(site.at.end, (ENDS, -order), format!(" {tail}"), Vec::new());
        }
    }
}

fn join(source: &Source, text: &str, inserts: &[Insert]) -> Woven {
    let mut woven = Woven {
        text: String::with_capacity(text.len() * 3),
        pieces: Vec::new(),
    };
    let mut begun = vec![0; source.sites.len()];
    let mut from = 0;
    for insert in inserts {
        woven.text += &text[from..insert.at];
        from = insert.at;
        let start = woven.text.len();
        woven.text += &insert.text;
        for (range, id) in &insert.pieces {
            woven.pieces.push(Piece {
                at: start + range.start..start + range.end,
                ids: vec![*id],
            });
        }
        if insert.rank.0 == BEGINS {
            begun[insert.site] = start;
        }
        if insert.rank.0 == ENDS {
            let ids = source.sites[insert.site].choices.iter();
            woven.pieces.push(Piece {
                at: begun[insert.site]..woven.text.len(),
                ids: ids.map(|choice| choice.id).collect(),
            });
        }
    }
    woven.text += &text[from..];
    woven
}

impl Woven {
    /// The mutants that an error at `at` may be due to: of the smallest part around it, or else of
    /// all parts within it.
    #[must_use]
    pub fn guilty(&self, at: &Range<usize>) -> Vec<usize> {
        let around = self
            .pieces
            .iter()
            .filter(|piece| piece.at.start <= at.start && at.end <= piece.at.end);
        if let Some(piece) = around.min_by_key(|piece| piece.at.len()) {
            return piece.ids.clone();
        }
        let within = self
            .pieces
            .iter()
            .filter(|piece| at.start <= piece.at.start && piece.at.end <= at.end);
        within.flat_map(|piece| piece.ids.clone()).collect()
    }
}

/// The module that answers whether a mutant is on. All states are in one table, so that the question
/// is one load, and is answered by `false` for all mutants but one; the environment is looked at when
/// the first question is asked.
#[must_use]
pub fn module(count: usize) -> String {
    MODULE.replace("COUNT", &count.to_string())
}

const MODULE: &str = r#"//! Which mutant is on.
#![allow(dead_code)]
extern crate std;

use core::sync::atomic::{AtomicU8, Ordering::Relaxed};
use std::io::Write;
use std::sync::OnceLock;
use std::{env, format, fs};

const OFF: u8 = 0;
const ON: u8 = 1;
/// Whether it is reached is recorded, once.
const WATCHED: u8 = 2;
const UNKNOWN: u8 = 3;

static STATES: [AtomicU8; COUNT] = [const { AtomicU8::new(UNKNOWN) }; COUNT];
static KNOWN: OnceLock<()> = OnceLock::new();

#[inline(always)]
pub(crate) fn on(id: usize) -> bool {
    STATES[id].load(Relaxed) != OFF && is_on(id)
}

#[cold]
#[inline(never)]
fn is_on(id: usize) -> bool {
    KNOWN.get_or_init(begin);
    match STATES[id].load(Relaxed) {
        ON => true,
        WATCHED => {
            STATES[id].store(OFF, Relaxed);
            let path = env::var_os("SCANBEAM_REACHED").expect("a file for what is reached");
            let file = fs::OpenOptions::new().create(true).append(true).open(path);
            let line = format!("{id}\n");
            file.and_then(|mut file| file.write_all(line.as_bytes())).expect("the file is written");
            false
        }
        _ => false,
    }
}

fn begin() {
    let mode = env::var("SCANBEAM_MUTANT").unwrap_or_default();
    let all = if mode == "reached" { WATCHED } else { OFF };
    for state in &STATES {
        state.store(all, Relaxed);
    }
    if let Some(state) = mode.parse().ok().and_then(|id: usize| STATES.get(id)) {
        state.store(ON, Relaxed);
    }
}
"#;

#[cfg(test)]
mod tests {
    use super::*;
    use crate::scan;

    fn woven(text: &str, dead: &[usize]) -> Woven {
        let mut mutants = Vec::new();
        let source = scan::file("src/a.rs", text.to_owned(), &mut mutants).unwrap();
        weave(&source, |id| !dead.contains(&id), &HashSet::new())
    }

    /// Kills: sites that begin or end in one place and are not within each other, and `const` that
    /// stays.
    #[test]
    fn inner_mutants_are_within_outer_ones() {
        let text = "const fn f(a: u8) -> B { a - 1 }";
        let [minus, one] = ["crate::mutant::on(0)", "crate::mutant::on(1)"];
        assert_eq!(
            woven(text, &[]).text,
            format!(
                "      fn f(a: u8) -> B {{ (if {minus} {{ (a) + (1) }} else {{ a - \
                 (if {one} {{ 2 }} else {{ 1 }}) }}) }}"
            )
        );
        assert_eq!(woven(text, &[0, 1]).text, text.replace("const", "     "));
        let left = woven("fn f() { g(); }", &[]).text;
        assert_eq!(
            left,
            format!("fn f() {{ if {minus} {{ return (); }}  if !{one} {{ g(); }} }}")
        );
    }

    /// Kills: an error in one mutant that is put down to the one around it.
    #[test]
    fn errors_are_put_down_to_the_mutant_that_they_are_in() {
        let woven = woven("fn f(a: u8) -> B { a - 1 }", &[]);
        let at = |part: &str| {
            let start = woven.text.find(part).unwrap();
            woven.guilty(&(start..start + part.len()))
        };
        assert_eq!(at("(a) + (1)"), [0]);
        assert_eq!(at("{ 2 }"), [1]);
        assert_eq!(at("a - (if"), [0]);
        assert_eq!(at("else { 1 }"), [1]);
        assert_eq!(at("fn f"), [0; 0]);
        let all = at(&woven.text);
        assert!(all.contains(&0) && all.contains(&1), "{all:?}");
    }
}
