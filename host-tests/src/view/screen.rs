//! What stands on the terminal: where picture and text go, and which lines are sent again.
//!
//! The picture has the rows that the text leaves. Text breaks between its parts where the terminal
//! is narrow, so that the key that ends it all is seen there too. A line that stands there already is not sent again: a
//! model that stands still sends nothing. Knows no terminal; its bytes go to one.

use crossterm::terminal::{BeginSynchronizedUpdate, Clear, ClearType, EndSynchronizedUpdate};
use crossterm::{cursor, queue};
use std::io::{self, Write};

/// Lines of a terminal.
#[derive(Debug, Default)]
pub struct Screen {
    columns: u16,
    rows: u16,
    /// Most lines that the text took since the size changed: the picture's size must not follow
    /// every digit.
    text_rows: usize,
    /// What was sent, from the top; empty after a change of size.
    shown: Vec<String>,
}

impl Screen {
    /// The terminal has this size now. What stands there is no longer known when it changed.
    pub fn set_size(&mut self, columns: u16, rows: u16) {
        if (self.columns, self.rows) != (columns, rows) {
            *self = Self {
                columns,
                rows,
                ..Self::default()
            };
        }
    }

    /// Breaks paragraphs into lines, the last paragraph first when there is room for half of the
    /// terminal's rows only. Each is text and what separates its parts.
    pub fn text(&mut self, paragraphs: &[(&str, &str)]) -> Vec<String> {
        let most = usize::from(self.rows / 2);
        let mut lines: Vec<String> = Vec::new();
        for &(text, separator) in paragraphs.iter().rev() {
            let broken = broken(text, separator, self.columns.into());
            if lines.len() + broken.len() <= most {
                lines.splice(0..0, broken);
            } else if lines.is_empty() {
                lines.extend(broken.into_iter().take(most));
            }
        }
        self.text_rows = self.text_rows.max(lines.len());
        lines
    }

    /// Columns and rows that the text of the last call of [`text`](Self::text) leaves, at least one
    /// each.
    #[must_use]
    pub fn left(&self) -> (u16, u16) {
        let text = u16::try_from(self.text_rows).unwrap_or(u16::MAX);
        (self.columns.max(1), self.rows.saturating_sub(text).max(1))
    }

    /// Writes what brings the terminal to show these lines of a picture, each whole and below one
    /// another, and the text at the bottom.
    ///
    /// # Errors
    /// Those of `out`.
    pub fn show(
        &mut self,
        out: &mut impl Write,
        picture: Vec<String>,
        text: Vec<String>,
    ) -> io::Result<()> {
        let mut lines = picture;
        let text_from = usize::from(self.rows).saturating_sub(text.len());
        lines.truncate(text_from);
        lines.resize(text_from, String::new());
        lines.extend(text);
        queue!(out, BeginSynchronizedUpdate)?;
        if self.shown.len() != lines.len() {
            self.shown = vec![String::new(); lines.len()];
            queue!(out, Clear(ClearType::All))?;
        }
        for (row, (line, shown)) in lines.iter().zip(&self.shown).enumerate() {
            if line != shown {
                queue!(out, cursor::MoveTo(0, row as u16))?;
                // Before the line: after one that ends in the last column it would take its end.
                if is_text(line) || is_text(shown) {
                    queue!(out, Clear(ClearType::CurrentLine))?;
                }
                out.write_all(line.as_bytes())?;
            }
        }
        self.shown = lines;
        queue!(out, EndSynchronizedUpdate)
    }
}

/// Whether a line may be shorter than the one before: lines of a picture all have its width.
fn is_text(line: &str) -> bool {
    !line.starts_with('\x1b')
}

/// Lines of at most so many columns, broken between parts; a part that is longer is cut.
pub fn broken(text: &str, separator: &str, columns: usize) -> Vec<String> {
    let mut lines: Vec<String> = Vec::new();
    for part in text.split_inclusive(separator) {
        let length = |text: &str| text.trim_end().chars().count();
        match lines.last_mut() {
            Some(line) if line.chars().count() + length(part) <= columns => line.push_str(part),
            _ => lines.push(part.chars().take(columns.max(1)).collect()),
        }
    }
    for line in &mut lines {
        line.truncate(line.trim_end().len());
    }
    lines
}
