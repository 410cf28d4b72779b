//! A model as the host tool sees it: triangles over vertices with position, normal, colour and texture place, in `f64`.
//!
//! Read from OBJ and MTL by a reader of its own, because the nearest crate was found wanting: `tobj` 4.0 gives no line
//! numbers, accepts NaN, panics on `Kd 1 2`, and shifts colours and normals when only some vertices have them. On
//! well-formed files the two agree, and a test holds that. Every file either gives a [`Model`] in which all indices are
//! in range and all numbers are finite, or one [`ModelError`] that names the file and the line.
//!
//! Strict where a wrong picture would come of it: malformed or infinite numbers, indices out of range, words that OBJ
//! does not have. Tolerant where files of everyday fall short and the shape is still right: a material that cannot
//! be found is white and gives a line in [`Model::warnings`]; bytes that are not UTF-8 may stand in comments and names.
//!
//! | file | there |
//! |---|---|
//! | `line.rs` | logical lines, words, numbers |
//! | `obj.rs` | statements of OBJ, corners to vertices, normals that the file left out |
//! | `mtl.rs` | statements of MTL |

mod line;
mod mtl;
mod obj;
mod text;

pub use text::obj_text;

use crate::stdio;
use std::fmt;
use std::io::Read;
use std::path::{Path, PathBuf};

/// Files above this many bytes are refused, so that an endless device cannot fill the memory.
pub const MAX_FILE_BYTES: u64 = 1 << 30;

/// One corner that triangles share: a distinct (position, texture place, normal, material) tuple of the file.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ModelVertex {
    /// Place in the world, right-handed; each coordinate is finite and within the range of an `f32`.
    pub position: [f64; 3],
    /// Unit length; all zero only where the file says so or where all faces around have no area.
    pub normal: [f64; 3],
    /// Red, green, blue, each `0.0..=1.0`, linear in display levels; already multiplied by the material's `kd`.
    pub colour: [f64; 3],
    /// Texture place, (0, 0) at the bottom left of the picture, repeating; zero where the file gives none.
    pub uv: [f64; 2],
}

/// What an MTL file says about a surface.
#[derive(Debug, Clone, PartialEq)]
pub struct Material {
    /// The name that `usemtl` calls it by.
    pub name: String,
    /// Diffuse colour, finite, as written (1, 1, 1 when absent).
    pub kd: [f64; 3],
    /// Specular colour, finite, as written (0, 0, 0 when absent).
    pub ks: [f64; 3],
    /// Specular exponent, finite, as written (0 when absent).
    pub ns: f64,
    /// Opacity, clamped to `0.0..=1.0` (1 when absent).
    pub d: f64,
    /// Picture that multiplies the diffuse colour, its path already joined to the folder of the MTL file.
    pub map_kd: Option<PathBuf>,
    /// The material file that names the picture, and its line there, from 1.
    pub map_kd_at: Option<(PathBuf, usize)>,
}

impl Default for Material {
    /// What a file means that says nothing: white, opaque, matt.
    fn default() -> Self {
        Self {
            name: String::new(),
            kd: [1.0; 3],
            ks: [0.0; 3],
            ns: 0.0,
            d: 1.0,
            map_kd: None,
            map_kd_at: None,
        }
    }
}

/// Triangles over shared vertices. Zero triangles are valid and draw only the background.
#[derive(Debug, Clone, PartialEq, Default)]
pub struct Model {
    /// All vertices that triangles use, in the order of first use.
    pub vertices: Vec<ModelVertex>,
    /// Corners as indices into `vertices`, in range, counter-clockwise seen from the front, in the file's order.
    pub triangles: Vec<[u32; 3]>,
    /// One entry per triangle: index into `materials`, in range, or `None` where no material is in force.
    pub triangle_materials: Vec<Option<u32>>,
    /// All materials of all MTL files, in the order of the files.
    pub materials: Vec<Material>,
    /// What the files ask for and is left out, in the order of its discovery; the rest is drawn.
    pub warnings: Vec<ModelError>,
    /// The files that it was read from, without the pictures that `materials` name.
    pub sources: Vec<PathBuf>,
}

impl Model {
    /// Reads an OBJ file and the MTL files that it names.
    ///
    /// # Errors
    /// See [`ModelError`]: unreadable file, malformed line, index out of range, number that is not finite.
    pub fn load(path: &Path) -> Result<Self, ModelError> {
        let text = read_text(path)?;
        let mut model = Self::from_obj_text(&text, path)?;
        model.sources.push(path.to_path_buf());
        Ok(model)
    }

    /// Reads OBJ text. `file` names it in errors, and its folder is where MTL files are looked for.
    ///
    /// # Errors
    /// As [`Model::load`].
    pub fn from_obj_text(text: &str, file: &Path) -> Result<Self, ModelError> {
        obj::read(text, file)
    }

    /// Whether textures have places on it: one of its vertices has, or it has none.
    #[must_use]
    pub fn has_places(&self) -> bool {
        self.vertices.is_empty() || self.vertices.iter().any(|v| v.uv != [0.0; 2])
    }

    /// All files that are read with it: its own, and the pictures of its materials.
    pub fn files(&self) -> impl Iterator<Item = &Path> {
        let pictures = self.materials.iter().filter_map(|m| m.map_kd.as_ref());
        self.sources.iter().chain(pictures).map(PathBuf::as_path)
    }

    /// Prints the warnings on stderr, a line each.
    pub fn print_warnings(&self) {
        for warning in &self.warnings {
            tell!("warning: {warning}");
        }
    }

    /// Smallest and largest coordinate on each axis, both inclusive; `None` for a model without vertices.
    #[must_use]
    pub fn bounds(&self) -> Option<([f64; 3], [f64; 3])> {
        let first = self.vertices.first()?.position;
        Some(
            self.vertices
                .iter()
                .fold((first, first), |(low, high), vertex| {
                    let p = vertex.position;
                    (
                        std::array::from_fn(|axis| low[axis].min(p[axis])),
                        std::array::from_fn(|axis| high[axis].max(p[axis])),
                    )
                }),
        )
    }
}

/// Why a model could not be read, or what of it is left out: one line, `FILE:LINE: reason`.
#[derive(Debug, Clone, PartialEq, Eq)]
pub struct ModelError {
    /// The file that is wrong: the OBJ, or an MTL that it names.
    pub file: PathBuf,
    /// Line in that file, from 1; `None` when the whole file is at fault.
    pub line: Option<usize>,
    /// What is wrong, without file and line.
    pub reason: String,
}

impl fmt::Display for ModelError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        let mut text = self.file.display().to_string();
        if let Some(line) = self.line {
            text.push_str(&format!(":{line}"));
        }
        text.push_str(&format!(": {}", self.reason));
        // Names come from outside: a control character must not break the one line into two.
        let text: String = text
            .chars()
            .map(|c| if c.is_control() { '?' } else { c })
            .collect();
        f.write_str(&text)
    }
}

impl std::error::Error for ModelError {}

/// Reads a whole file of at most [`MAX_FILE_BYTES`].
fn read_text(path: &Path) -> Result<String, ModelError> {
    let whole_file = |reason: String| ModelError {
        file: path.to_path_buf(),
        line: None,
        reason,
    };
    let cannot_read =
        |error: std::io::Error| whole_file(format!("cannot be read: {}", stdio::reason(&error)));
    let file = std::fs::File::open(path).map_err(cannot_read)?;
    let mut bytes = Vec::new();
    file.take(MAX_FILE_BYTES + 1)
        .read_to_end(&mut bytes)
        .map_err(cannot_read)?;
    if bytes.len() as u64 > MAX_FILE_BYTES {
        return Err(whole_file(format!("is larger than {MAX_FILE_BYTES} bytes")));
    }
    Ok(text_of(bytes))
}

/// Bytes as text. What is not UTF-8 becomes U+FFFD: harmless in comments and names, which older tools write in
/// Latin-1, and refused with its line in a keyword or a number.
fn text_of(bytes: Vec<u8>) -> String {
    String::from_utf8(bytes)
        .unwrap_or_else(|error| String::from_utf8_lossy(error.as_bytes()).into_owned())
}

/// The vector at unit length, or zero where it has none. Scales first, so that neither huge nor tiny ones overflow.
fn unit(v: [f64; 3]) -> [f64; 3] {
    let largest = v.iter().fold(0.0_f64, |largest, x| largest.max(x.abs()));
    if largest == 0.0 {
        return v;
    }
    let scaled = v.map(|x| x / largest);
    let length = scaled.iter().map(|x| x * x).sum::<f64>().sqrt();
    scaled.map(|x| x / length)
}
