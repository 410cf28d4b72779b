//! A page that needs no other file: pictures are data in it, plots are SVG in it.

use crate::image_out::{Frame, ImageError, encode_image};
use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use std::fmt::Write as _;
use std::path::Path;

const STYLE: &str = "body{font:16px/1.5 system-ui,sans-serif;max-width:1100px;margin:2em auto;\
padding:0 1em;color:#222;background:#fff}h1,h2{line-height:1.2}h2{margin-top:2em;border-bottom:1px \
solid #ccc}figure{display:inline-block;margin:0 1em 1.5em 0;vertical-align:top;max-width:320px}\
figure.plot{width:800px;max-width:100%}figure.pair{max-width:660px}img{max-width:100%;image-rendering:pixelated;\
background:#000}svg{width:100%;height:auto}figcaption{font-size:14px;color:#555}table{border-\
collapse:collapse;font-variant-numeric:tabular-nums}td,th{border-bottom:1px solid #ddd;padding:.2em \
.8em;text-align:right}td:first-child,th:first-child{text-align:left}nav a{margin-right:1em}";

/// A page under construction.
pub struct Page {
    title: String,
    contents: String,
    body: String,
}

/// Text with what HTML would take for its own replaced.
pub fn escaped(text: &str) -> String {
    let mut out = String::with_capacity(text.len());
    for c in text.chars() {
        match c {
            '&' => out.push_str("&amp;"),
            '<' => out.push_str("&lt;"),
            '>' => out.push_str("&gt;"),
            '"' => out.push_str("&quot;"),
            c => out.push(c),
        }
    }
    out
}

/// The same, and what stands between two backticks as code.
pub fn marked_up(text: &str) -> String {
    let mut parts = text.split('`').map(escaped).peekable();
    let mut out = parts.next().unwrap_or_default();
    while let Some(part) = parts.next() {
        if parts.peek().is_some() {
            let _ = write!(out, "<code>{part}</code>");
            out.push_str(&parts.next().unwrap_or_default());
        } else {
            out.push('`');
            out.push_str(&part);
        }
    }
    out
}

/// How often the pixels of a picture are repeated each way, so that small ones can be looked at.
fn times(frame: &Frame) -> u32 {
    (200 / frame.width()).max(1)
}

/// A picture as an element.
fn image(frame: &Frame, name: &str) -> Result<String, ImageError> {
    let png = encode_image(Path::new("picture.png"), frame)?;
    Ok(format!(
        "<img width=\"{}\" height=\"{}\" alt=\"{}\" src=\"data:image/png;base64,{}\">",
        frame.width() * times(frame),
        frame.height() * times(frame),
        escaped(name),
        STANDARD.encode(png)
    ))
}

impl Page {
    /// One without sections.
    pub fn new(title: &str) -> Self {
        Self {
            title: escaped(title),
            contents: String::new(),
            body: String::new(),
        }
    }

    /// Begins a section; `id` is its anchor.
    pub fn section(&mut self, id: &str, title: &str) {
        let title = escaped(title);
        let _ = write!(self.contents, "<a href=\"#{id}\">{title}</a> ");
        let _ = writeln!(self.body, "<h2 id=\"{id}\">{title}</h2>");
    }

    /// Adds text.
    pub fn paragraph(&mut self, text: &str) {
        let _ = writeln!(self.body, "<p>{}</p>", marked_up(text));
    }

    /// Pictures side by side over one caption.
    pub fn pictures(&mut self, frames: &[&Frame], caption: &str) -> Result<(), ImageError> {
        let class = if frames.len() > 1 {
            " class=\"pair\""
        } else {
            ""
        };
        let _ = write!(self.body, "<figure{class}>");
        for frame in frames {
            self.body.push_str(&image(frame, caption)?);
        }
        let caption = marked_up(caption);
        let _ = writeln!(self.body, "<figcaption>{caption}</figcaption></figure>");
        Ok(())
    }

    /// A plot, as SVG text.
    pub fn plot(&mut self, svg: &str) {
        // What stands before the element belongs to a file of its own.
        let start = svg.find("<svg").unwrap_or(0);
        let _ = writeln!(
            self.body,
            "<figure class=\"plot\">{}</figure>",
            &svg[start..]
        );
    }

    /// A table whose first row is its head.
    pub fn table(&mut self, rows: &[Vec<String>]) {
        self.body.push_str("<table>\n");
        for (i, row) in rows.iter().enumerate() {
            let tag = if i == 0 { "th" } else { "td" };
            let cells = row
                .iter()
                .map(|cell| format!("<{tag}>{}</{tag}>", escaped(cell)));
            let _ = writeln!(self.body, "<tr>{}</tr>", cells.collect::<String>());
        }
        self.body.push_str("</table>\n");
    }

    /// The page as text.
    pub fn finish(self) -> String {
        let Self {
            title,
            contents,
            body,
        } = self;
        format!(
            "<!DOCTYPE html>\n<html lang=\"en\"><head><meta charset=\"utf-8\"><title>{title}</title>\
             <meta name=\"viewport\" content=\"width=device-width\"><style>{STYLE}</style></head>\n\
             <body><h1>{title}</h1>\n<nav>{contents}</nav>\n{body}</body></html>\n"
        )
    }
}
