//! Rust's words, as far as counting needs them: without comments, and without what is there for
//! tests alone.

/// What a word is.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Kind {
    /// A name or a keyword.
    Name,
    /// A lifetime, a number, a character or a string.
    Literal,
    /// A single sign.
    Sign,
}

/// A word.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) struct Word<'s> {
    pub(super) kind: Kind,
    pub(super) text: &'s str,
    /// Its first line, from 1.
    pub(super) line: usize,
    /// Its last line.
    pub(super) end: usize,
}

impl Word<'_> {
    /// Whether it is this name or sign.
    pub(super) fn is(&self, text: &str) -> bool {
        self.kind != Kind::Literal && self.text == text
    }
}

/// The words of a source.
pub(super) fn words(source: &str) -> Vec<Word<'_>> {
    let mut words = Vec::new();
    let (mut at, mut line) = (0, 1);
    while let Some(first) = source[at..].chars().next() {
        let rest = &source[at..];
        let (kind, length) = if first.is_whitespace() {
            (None, first.len_utf8())
        } else if rest.starts_with("//") {
            (None, rest.find('\n').unwrap_or(rest.len()))
        } else if rest.starts_with("/*") {
            (None, block_comment(rest))
        } else if let Some(length) = text_of(rest) {
            (Some(Kind::Literal), length)
        } else if first == '\'' {
            (Some(Kind::Literal), tick(rest))
        } else if first.is_alphanumeric() || first == '_' {
            let kind = if first.is_ascii_digit() {
                Kind::Literal
            } else {
                Kind::Name
            };
            (Some(kind), name(rest))
        } else {
            (Some(Kind::Sign), first.len_utf8())
        };
        let text = &rest[..length];
        let end = line + text.matches('\n').count();
        if let Some(kind) = kind {
            words.push(Word {
                kind,
                text,
                line,
                end,
            });
        }
        (at, line) = (at + length, end);
    }
    words
}

/// How long the name at the start is.
fn name(rest: &str) -> usize {
    let part = |c: char| c.is_alphanumeric() || c == '_';
    rest.find(|c| !part(c)).unwrap_or(rest.len())
}

/// How long the comment at the start is; they nest.
fn block_comment(rest: &str) -> usize {
    let mut depth = 0;
    let mut at = 0;
    while at < rest.len() {
        if rest[at..].starts_with("/*") {
            (depth, at) = (depth + 1, at + 2);
        } else if rest[at..].starts_with("*/") {
            (depth, at) = (depth - 1, at + 2);
            if depth == 0 {
                break;
            }
        } else {
            at += rest[at..].chars().next().map_or(1, char::len_utf8);
        }
    }
    at
}

/// How long the string at the start is, where there is one: plain, of bytes, or raw.
fn text_of(rest: &str) -> Option<usize> {
    let prefix = ["", "b", "c", "r", "br", "cr"].into_iter().find(|prefix| {
        let behind = rest.strip_prefix(prefix);
        let signs = |b: &str| b.trim_start_matches('#').starts_with('"');
        behind.is_some_and(|b| b.starts_with('"') || prefix.ends_with('r') && signs(b))
    })?;
    let body = &rest[prefix.len()..];
    if prefix.ends_with('r') {
        let signs = body.len() - body.trim_start_matches('#').len();
        let close = format!("\"{}", "#".repeat(signs));
        let inside = &body[signs + 1..];
        let end = inside
            .find(&close)
            .map_or(inside.len(), |end| end + close.len());
        return Some(prefix.len() + signs + 1 + end);
    }
    let mut escaped = false;
    for (at, c) in body.char_indices().skip(1) {
        match c {
            _ if escaped => escaped = false,
            '\\' => escaped = true,
            '"' => return Some(prefix.len() + at + 1),
            _ => {}
        }
    }
    Some(rest.len())
}

/// How long the character or lifetime at the start is.
fn tick(rest: &str) -> usize {
    let mut chars = rest.char_indices().skip(1);
    match (chars.next(), chars.next()) {
        (Some((_, '\\')), Some((at, c))) => {
            let behind = at + c.len_utf8();
            behind + rest[behind..].find('\'').map_or(0, |end| end + 1)
        }
        (Some(_), Some((at, '\''))) => at + 1,
        _ => 1 + name(&rest[1..]),
    }
}

/// Where the bracket at `open` is closed, or the end.
pub(super) fn closed(words: &[Word<'_>], open: usize) -> usize {
    let mut depth = 0;
    for (at, word) in words.iter().enumerate().skip(open) {
        if ["(", "[", "{"].iter().any(|sign| word.is(sign)) {
            depth += 1;
        } else if [")", "]", "}"].iter().any(|sign| word.is(sign)) {
            depth -= 1;
            if depth == 0 {
                return at;
            }
        }
    }
    words.len().saturating_sub(1)
}

/// A source without its tests, and the modules that are tests and lie in files of their own.
#[derive(Debug, Default)]
pub(super) struct Untested<'s> {
    pub(super) words: Vec<Word<'s>>,
    pub(super) test_modules: Vec<&'s str>,
}

/// Leaves out every item that `#[cfg(test)]` or `#[cfg(doctest)]` stands before.
pub(super) fn untested<'s>(words: &[Word<'s>]) -> Untested<'s> {
    let mut kept = Untested::default();
    let mut at = 0;
    while at < words.len() {
        let is_attribute = words[at].is("#") && words.get(at + 1).is_some_and(|w| w.is("["));
        let end = if is_attribute {
            closed(words, at + 1)
        } else {
            at
        };
        let attribute = &words[at..=end];
        let is_test = attribute.get(2).is_some_and(|w| w.is("cfg"))
            && attribute.iter().any(|w| w.is("test") || w.is("doctest"))
            && !attribute.iter().any(|w| w.is("not"));
        if !is_test {
            kept.words.extend_from_slice(attribute);
            at = end + 1;
            continue;
        }
        // Over further attributes, up to the item's `;` or the end of its braces.
        let mut item = end + 1;
        while item < words.len() {
            if words[item].is("#") && words.get(item + 1).is_some_and(|w| w.is("[")) {
                item = closed(words, item + 1);
            } else if words[item].is(";") {
                break;
            } else if words[item].is("{") {
                item = closed(words, item);
                break;
            } else if words[item].is("mod") && words.get(item + 2).is_some_and(|w| w.is(";")) {
                kept.test_modules.push(words[item + 1].text);
            }
            item += 1;
        }
        at = item + 1;
    }
    kept
}
