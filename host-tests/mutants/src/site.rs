//! Mutants, and where they are woven into a file.

use std::ops::Range;

/// One small change of the source.
#[derive(Debug, Clone)]
pub struct Mutant {
    /// From the root, as in `src/num/bits.rs`.
    pub file: String,
    /// Of the first character that is replaced; from 1.
    pub line: usize,
    /// In characters, from 1.
    pub column: usize,
    /// What is changed into what; unlike that of any other mutant on the line.
    pub what: String,
    /// The line of the source, without the spaces at its ends.
    pub text: String,
    /// The `const fn` that it is in.
    pub const_fn: Option<String>,
}

impl Mutant {
    /// The folder in `src` that it is in, or the file where it is in none.
    #[must_use]
    pub fn room(&self) -> &str {
        let inside = self.file.strip_prefix("src/").unwrap_or(&self.file);
        inside.split('/').next().unwrap_or(inside)
    }

    /// Where it is, and what.
    #[must_use]
    pub fn place(&self) -> String {
        format!("{}:{}:{}: {}", self.file, self.line, self.column, self.what)
    }

    /// What it is called where lines may move.
    #[must_use]
    pub fn name(&self) -> String {
        format!("{}: {}: {}", self.file, self.what, self.text)
    }
}

/// How the mutants of a site are woven in.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub enum Kind {
    /// An expression, instead of which another one is evaluated.
    Instead,
    /// A statement that is left out.
    LeftOut,
    /// The start of a function, which is left at once.
    Left,
}

/// A mutant of a site: its number, and the source that takes the place of the site's.
#[derive(Debug, Clone)]
pub struct Choice {
    /// Its place in the list of all mutants, which is its number.
    pub id: usize,
    /// What is evaluated instead, or returned.
    pub text: String,
}

/// A piece of source with its mutants.
#[derive(Debug, Clone)]
pub struct Site {
    /// Of bytes in the file; empty for [`Kind::Left`].
    pub at: Range<usize>,
    /// How its mutants are woven in.
    pub kind: Kind,
    /// Its mutants.
    pub choices: Vec<Choice>,
}

/// A `const fn`, which calls nothing that is decided at run time.
#[derive(Debug, Clone)]
pub struct ConstFn {
    /// Its name, without its type.
    pub name: String,
    /// Where `const` stands.
    pub keyword: Range<usize>,
}

/// What is known of one file.
#[derive(Debug, Clone)]
pub struct Source {
    /// From the root.
    pub file: String,
    /// As it stands.
    pub text: String,
    /// Outer ones before those within them.
    pub sites: Vec<Site>,
    /// All of them.
    pub const_fns: Vec<ConstFn>,
}
