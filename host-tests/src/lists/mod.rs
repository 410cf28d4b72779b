//! Lists on the host: made from models, drawn, and printed (H11, X7).
//!
//! | file | there |
//! |---|---|
//! | `args.rs` | the flags of `bake`, `run-list` and `disassemble` |
//! | `bake.rs` | a model into a list: forms, groups, tables |
//! | `fields.rs` | vertices as fields of a list |
//! | `strips.rs` | triangles into strips and fans |
//! | `texels.rs` | pictures into textures and palettes |
//! | `sizes.rs` | what of a list takes how many bytes |
//! | `tables.rs` | strips and fans into tables of vertices |
//! | `gltf.rs` | glTF 2.0 into a model |
//! | `parts.rs` | triangles into parts that are passed over where they are turned away |
//! | `heard.rs` | what players tell of lists |
//! | `print.rs` | a list as text |
//! | `run.rs` | a list into a picture |
//! | `writer.rs` | blocks into words |

pub mod args;
pub mod bake;
mod fields;
pub mod gltf;
pub mod heard;
mod parts;
pub mod print;
pub mod run;
pub mod sizes;
pub mod strips;
mod tables;
pub mod texels;
pub mod writer;

use crate::stdio;
use scanbeam::list::{Header, Reason};
use std::error::Error;
use std::fs::File;
use std::io::Read;
use std::path::Path;

/// Lists above this many bytes are refused.
pub const MAX_LIST_BYTES: u64 = 1 << 28;

/// The words of a list file, as they lie in memory.
///
/// # Errors
/// When it cannot be read, is too large, is a model or a scene file, or is not whole words.
pub fn read_list(path: &Path) -> Result<Vec<u32>, Box<dyn Error>> {
    let wrong = |reason: String| format!("{}: {reason}", path.display());
    let mut bytes = Vec::new();
    File::open(path)
        .and_then(|f| f.take(MAX_LIST_BYTES + 1).read_to_end(&mut bytes))
        .map_err(|e| wrong(format!("cannot be read: {}", stdio::reason(&e))))?;
    if bytes.len() as u64 > MAX_LIST_BYTES {
        return Err(wrong(format!("is larger than {MAX_LIST_BYTES} bytes")).into());
    }
    if is_other(path, &bytes) {
        let what = "is not a list: `render` draws models and scene files";
        return Err(wrong(what.into()).into());
    }
    if bytes.len() % 4 != 0 {
        return Err(wrong(format!("has {} bytes, not whole words", bytes.len())).into());
    }
    let word = |b: &[u8]| u32::from_ne_bytes([b[0], b[1], b[2], b[3]]);
    Ok(bytes.chunks_exact(4).map(word).collect())
}

/// Whether a file is none of lists, by its name or by its first word: a text may begin as a list does.
fn is_other(path: &Path, bytes: &[u8]) -> bool {
    let extension = path.extension().unwrap_or_default();
    let is = |name: &&str| extension.eq_ignore_ascii_case(name);
    let is_text = |word: &&[u8; 4]| {
        word.iter()
            .all(|b| b.is_ascii_graphic() || b.is_ascii_whitespace())
    };
    let first = bytes
        .first_chunk()
        .filter(is_text)
        .map(|word| u32::from_ne_bytes(*word));
    let is_unknown = |word| matches!(Header::read(word), Err(Reason::Version(_)));
    ["obj", "gltf", "glb", "json"].iter().any(is) || first.is_some_and(is_unknown)
}
