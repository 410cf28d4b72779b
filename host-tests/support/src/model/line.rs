//! Lines, words and numbers: what OBJ and MTL share.

use super::ModelError;
use std::borrow::Cow;
use std::path::Path;

/// One statement: its keyword and what follows, with comments and continuation lines already resolved.
pub(super) struct Statement<'a> {
    file: &'a Path,
    /// Line of the keyword, from 1.
    number: usize,
    text: Cow<'a, str>,
}

impl<'a> Statement<'a> {
    /// First word; never empty and never a comment.
    pub(super) fn keyword(&self) -> &str {
        self.text.split_whitespace().next().unwrap_or("")
    }

    /// Words after the keyword, up to a comment.
    pub(super) fn words(&self) -> impl Iterator<Item = &str> {
        let words = self.text.split_whitespace().skip(1);
        words.take_while(|word| !word.starts_with('#'))
    }

    /// Everything after the keyword, for names, which may hold spaces and `#`.
    pub(super) fn name(&self) -> Result<&str, ModelError> {
        let name = self.text.trim_start()[self.keyword().len()..].trim();
        if name.is_empty() {
            return Err(self.error(format!("`{}` needs a name", self.keyword())));
        }
        Ok(name)
    }

    /// All words as numbers that are finite and within the range of an `f32`.
    pub(super) fn numbers(&self) -> Result<Vec<f64>, ModelError> {
        self.words().map(|word| self.number(word)).collect()
    }

    /// One word as a number that is finite and within the range of an `f32`.
    pub(super) fn number(&self, word: &str) -> Result<f64, ModelError> {
        let value: f64 = word
            .parse()
            .map_err(|_| self.error(format!("{} is not a number", quoted(word))))?;
        if !value.is_finite() {
            return Err(self.error(format!("{} is not a finite number", quoted(word))));
        }
        if value.abs() > f64::from(f32::MAX) {
            return Err(self.error(format!("{} is too large a number", quoted(word))));
        }
        Ok(value)
    }

    /// An error at this statement's line.
    pub(super) fn error(&self, reason: String) -> ModelError {
        error_at(self.file, self.number, reason)
    }

    /// Line of the keyword, from 1.
    pub(super) fn line(&self) -> usize {
        self.number
    }
}

/// An error at a line of a file.
pub(super) fn error_at(file: &Path, line: usize, reason: String) -> ModelError {
    ModelError {
        file: file.to_path_buf(),
        line: Some(line),
        reason,
    }
}

/// A word for an error message: escaped, in quotes, cut when it is long.
pub(super) fn quoted(word: &str) -> String {
    const SHOWN: usize = 32;
    if word.chars().count() > SHOWN {
        format!("{:?}...", word.chars().take(SHOWN).collect::<String>())
    } else {
        format!("{word:?}")
    }
}

/// The statements of a text, in order. Blank lines and comments are left out; a line that ends in a backslash goes on.
pub(super) fn statements<'a>(text: &'a str, file: &'a Path) -> impl Iterator<Item = Statement<'a>> {
    let text = text.strip_prefix('\u{feff}').unwrap_or(text);
    let mut lines = text.lines().enumerate();
    std::iter::from_fn(move || {
        loop {
            let (index, line) = lines.next()?;
            let mut whole = Cow::Borrowed(line);
            // A comment does not go on: a path that ends in a backslash is common in them.
            if !line.trim_start().starts_with('#') {
                let mut piece = line;
                // Only the new piece is looked at, so that many continuations cost linear time.
                while let Some(start) = piece.trim_end().strip_suffix('\\') {
                    let kept = whole.len() - (piece.len() - start.len());
                    let next = lines.next().map_or("", |(_, next)| next);
                    let joined = whole.to_mut();
                    joined.truncate(kept);
                    joined.push(' ');
                    joined.push_str(next);
                    piece = next;
                }
            }
            let trimmed = whole.trim_start();
            if !trimmed.is_empty() && !trimmed.starts_with('#') {
                return Some(Statement {
                    file,
                    number: index + 1,
                    text: whole,
                });
            }
        }
    })
}
