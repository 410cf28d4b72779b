//! OBJ: `v x y z [w | r g b [a]]`, `vt`, `vn`, `f` of 3 or more corners (a fan from the first), `mtllib`, `usemtl`.
//!
//! Indices count from 1 or, negative, back from the last element so far; a positive one may point ahead in the file.
//! Colours are clamped to 0..=1. A fourth number of `v` is the weight of a curve's point and means nothing to a face.
//! A corner without `vn` gets the mean of the normals of all triangles at the same `v` index, weighted by their areas.
//!
//! | in the file | what becomes of it |
//! |---|---|
//! | groups, smoothing, lines, points, curves, surfaces | passed over |
//! | a keyword that OBJ does not have | an error, so that a file of another kind is refused |
//! | `mtllib` of a file that is not there | a warning; its materials are white |
//! | `usemtl` of a name in no material file | white, with a warning, but where an `mtllib` is not there: that is told already |
//! | no faces at all | a model without triangles, with a warning |
//! | `usemtl` without a name | back to no material |

use super::line::{Statement, error_at, quoted, statements};
use super::{Material, Model, ModelError, ModelVertex, mtl, read_text, unit};
use std::collections::{HashMap, HashSet};
use std::path::{Path, PathBuf};

/// Stands for an absent texture place or normal; no list may be long enough to have it as an index.
const ABSENT: u32 = u32::MAX;

/// Keywords of OBJ that draw nothing here.
const PASSED_OVER: &str = "o g s l p mg vp cstype deg bmat step curv curv2 surf parm trim hole scrv sp end \
     con bevel c_interp d_interp lod maplib usemap shadow_obj trace_obj ctech stech call csh bzp cdc res";

/// Indices from 0 into the lists of the file; range-checked only at the end, since they may point ahead.
#[derive(Clone, Copy, PartialEq, Eq, Hash)]
struct Corner {
    position: u32,
    uv: u32,
    normal: u32,
}

struct Triangle {
    corners: [Corner; 3],
    /// Index into `material_names`.
    material_name: Option<usize>,
    line: usize,
}

#[derive(Default)]
struct Lists {
    positions: Vec<[f64; 3]>,
    colours: Vec<[f64; 3]>,
    uvs: Vec<[f64; 2]>,
    normals: Vec<[f64; 3]>,
    triangles: Vec<Triangle>,
    /// Names given to `usemtl`, each once, with the line of its first use.
    material_names: Vec<(String, usize)>,
    materials: Vec<Material>,
    /// MTL files already read or found missing: naming one again adds nothing.
    libraries: HashSet<PathBuf>,
    /// A library was missing, so names without a material are no surprise.
    incomplete: bool,
    warnings: Vec<ModelError>,
    /// Material files that were read.
    sources: Vec<PathBuf>,
}

/// Reads OBJ text and the MTL files that it names.
pub(super) fn read(text: &str, file: &Path) -> Result<Model, ModelError> {
    let mut lists = Lists::default();
    let mut name_index: HashMap<String, usize> = HashMap::new();
    let mut current_name = None;
    for statement in statements(text, file) {
        match statement.keyword() {
            "v" => lists.position(&statement)?,
            "vt" => match statement.numbers()?[..] {
                [u] => lists.uvs.push([u, 0.0]),
                [u, v] | [u, v, _] => lists.uvs.push([u, v]),
                ref other => return Err(wrong_count(&statement, "1 to 3", other.len())),
            },
            "vn" => match statement.numbers()?[..] {
                [x, y, z] => lists.normals.push(unit([x, y, z])),
                ref other => return Err(wrong_count(&statement, "3", other.len())),
            },
            "f" | "fo" => lists.face(&statement, current_name)?,
            "usemtl" => {
                let Ok(name) = statement.name() else {
                    current_name = None;
                    continue;
                };
                let index = *name_index.entry(name.to_owned()).or_insert_with(|| {
                    lists
                        .material_names
                        .push((name.to_owned(), statement.line()));
                    lists.material_names.len() - 1
                });
                current_name = Some(index);
            }
            "mtllib" => lists.library(&statement, file)?,
            other if PASSED_OVER.split(' ').any(|known| known == other) => {}
            other => {
                return Err(statement.error(format!("{} is not an OBJ keyword", quoted(other))));
            }
        }
    }
    lists.check_indices(file)?;
    lists.into_model(file)
}

fn wrong_count(statement: &Statement<'_>, wanted: &str, found: usize) -> ModelError {
    statement.error(format!(
        "`{}` needs {wanted} numbers, found {found}",
        statement.keyword()
    ))
}

impl Lists {
    fn position(&mut self, statement: &Statement<'_>) -> Result<(), ModelError> {
        let (position, colour) = match statement.numbers()?[..] {
            [x, y, z] | [x, y, z, _] => ([x, y, z], [1.0; 3]),
            [x, y, z, r, g, b] | [x, y, z, r, g, b, _] => ([x, y, z], [r, g, b]),
            ref other => return Err(wrong_count(statement, "3 (or 4, 6, 7)", other.len())),
        };
        self.positions.push(position);
        self.colours.push(colour.map(|c| c.clamp(0.0, 1.0)));
        Ok(())
    }

    fn face(
        &mut self,
        statement: &Statement<'_>,
        material_name: Option<usize>,
    ) -> Result<(), ModelError> {
        let corners = statement
            .words()
            .map(|word| self.corner(statement, word))
            .collect::<Result<Vec<_>, _>>()?;
        if corners.len() < 3 {
            return Err(statement.error(format!(
                "a face needs at least 3 corners, found {}",
                corners.len()
            )));
        }
        for pair in corners[1..].windows(2) {
            self.triangles.push(Triangle {
                corners: [corners[0], pair[0], pair[1]],
                material_name,
                line: statement.line(),
            });
        }
        Ok(())
    }

    /// `v`, `v/vt`, `v//vn` or `v/vt/vn`; an empty part counts as absent, except the first.
    fn corner(&self, statement: &Statement<'_>, word: &str) -> Result<Corner, ModelError> {
        let mut parts = word.split('/');
        let mut part = |count: usize| match parts.next() {
            None | Some("") => Ok(ABSENT),
            Some(part) => index(part, count).map_err(|why| {
                statement.error(format!("index {} in {} {why}", quoted(part), quoted(word)))
            }),
        };
        let corner = Corner {
            position: part(self.positions.len())?,
            uv: part(self.uvs.len())?,
            normal: part(self.normals.len())?,
        };
        if corner.position == ABSENT {
            return Err(statement.error(format!("corner {} has no vertex", quoted(word))));
        }
        if parts.next().is_some() {
            return Err(statement.error(format!("corner {} has too many parts", quoted(word))));
        }
        Ok(corner)
    }

    /// The whole rest of the line is one file's name if there is such a file or none of its words is one, else its
    /// words are. A backslash between folders is read as a slash where the name as written is no file.
    fn library(&mut self, statement: &Statement<'_>, obj_file: &Path) -> Result<(), ModelError> {
        let folder = obj_file.parent().unwrap_or(Path::new(""));
        let found = |name: &str| {
            [folder.join(name), folder.join(name.replace('\\', "/"))]
                .into_iter()
                .find(|path| path.exists())
        };
        let name = match statement.name() {
            Ok(name) => name,
            Err(error) => {
                self.warnings.push(error);
                return Ok(());
            }
        };
        let mut names = vec![name];
        let words = || name.split_whitespace();
        if found(name).is_none() && words().any(|word| found(word).is_some()) {
            names = words().collect();
        }
        for name in names {
            let path = found(name);
            let is_new = self
                .libraries
                .insert(path.clone().unwrap_or_else(|| folder.join(name)));
            match path {
                _ if !is_new => {}
                Some(path) => {
                    let materials = mtl::read(&read_text(&path)?, &path, &mut self.warnings)?;
                    self.materials.extend(materials);
                    self.sources.push(path);
                }
                None => {
                    self.incomplete = true;
                    let reason = format!("material file {} is not there", quoted(name));
                    self.warnings.push(statement.error(reason));
                }
            }
        }
        Ok(())
    }

    fn check_indices(&self, file: &Path) -> Result<(), ModelError> {
        for triangle in &self.triangles {
            for corner in triangle.corners {
                for (what, index, count) in [
                    ("vertices", corner.position, self.positions.len()),
                    ("texture places", corner.uv, self.uvs.len()),
                    ("normals", corner.normal, self.normals.len()),
                ] {
                    if index != ABSENT && index as usize >= count {
                        let reason = format!(
                            "index {} is out of range: the file has {count} {what}",
                            u64::from(index) + 1
                        );
                        return Err(error_at(file, triangle.line, reason));
                    }
                }
            }
        }
        Ok(())
    }

    /// Area-weighted normals, one per `v` index; zero where all triangles around have no area.
    fn computed_normals(&self) -> Vec<[f64; 3]> {
        let mut sums = vec![[0.0; 3]; self.positions.len()];
        for triangle in &self.triangles {
            let [a, b, c] = triangle
                .corners
                .map(|corner| self.positions[corner.position as usize]);
            let u: [f64; 3] = std::array::from_fn(|i| b[i] - a[i]);
            let v: [f64; 3] = std::array::from_fn(|i| c[i] - a[i]);
            // Twice the area times the unit normal.
            let cross = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            for corner in triangle.corners {
                let sum = &mut sums[corner.position as usize];
                *sum = std::array::from_fn(|i| sum[i] + cross[i]);
            }
        }
        sums.into_iter().map(unit).collect()
    }

    /// One index per entry of `material_names`; a name that several materials share means the last.
    fn resolve_materials(&mut self, file: &Path) -> Vec<Option<u32>> {
        let by_name: HashMap<&str, u32> = (0..)
            .zip(&self.materials)
            .map(|(index, material)| (material.name.as_str(), index))
            .collect();
        let mut indices = Vec::with_capacity(self.material_names.len());
        for (name, line) in &self.material_names {
            let index = by_name.get(name.as_str()).copied();
            // Without any material file the first name is told, for all.
            let is_told = self.libraries.is_empty() && !indices.is_empty();
            if index.is_none() && !is_told && !self.incomplete {
                let mut reason = format!("material {} is in no material file", quoted(name));
                if self.libraries.is_empty() {
                    reason.push_str(", and the model names none: all is white");
                }
                self.warnings.push(error_at(file, *line, reason));
            }
            indices.push(index);
        }
        indices
    }

    fn into_model(mut self, file: &Path) -> Result<Model, ModelError> {
        let material_of_name = self.resolve_materials(file);
        if self.triangles.is_empty() {
            self.warnings.push(ModelError {
                file: file.to_path_buf(),
                line: None,
                reason: "it has no faces, so nothing is drawn".into(),
            });
        }
        let lacks_normal =
            |triangle: &Triangle| triangle.corners.iter().any(|c| c.normal == ABSENT);
        let computed = if self.triangles.iter().any(lacks_normal) {
            self.computed_normals()
        } else {
            Vec::new()
        };
        let mut model = Model::default();
        let mut known: HashMap<(Corner, Option<u32>), u32> = HashMap::new();
        for triangle in &self.triangles {
            let material = triangle
                .material_name
                .and_then(|name| material_of_name[name]);
            let kd = material.map_or([1.0; 3], |index| self.materials[index as usize].kd);
            let mut indices = [0; 3];
            for (index, corner) in indices.iter_mut().zip(triangle.corners) {
                let next = model.vertices.len();
                *index = *known.entry((corner, material)).or_insert(next as u32);
                if *index as usize != next {
                    continue;
                }
                if next >= ABSENT as usize {
                    return Err(error_at(file, triangle.line, "too many vertices".into()));
                }
                let position = corner.position as usize;
                let colour = self.colours[position];
                model.vertices.push(ModelVertex {
                    position: self.positions[position],
                    normal: match corner.normal {
                        ABSENT => computed[position],
                        normal => self.normals[normal as usize],
                    },
                    colour: std::array::from_fn(|i| (colour[i] * kd[i]).clamp(0.0, 1.0)),
                    uv: match corner.uv {
                        ABSENT => [0.0; 2],
                        uv => self.uvs[uv as usize],
                    },
                });
            }
            model.triangles.push(indices);
            model.triangle_materials.push(material);
        }
        model.materials = self.materials;
        model.warnings = self.warnings;
        model.sources = self.sources;
        Ok(model)
    }
}

/// An index of the file (from 1, or negative and back from `count`) as one from 0, below [`ABSENT`].
fn index(text: &str, count: usize) -> Result<u32, &'static str> {
    let number = text.strip_prefix(['-', '+']).unwrap_or(text);
    if number.is_empty() || !number.bytes().all(|byte| byte.is_ascii_digit()) {
        return Err("is not a whole number");
    }
    // All digits: what does not parse is too long for an i64.
    let value: i64 = text.parse().map_err(|_| "is out of range")?;
    let from_zero = match value {
        0 => return Err("is 0, but OBJ counts from 1"),
        1.. => value - 1,
        _ => i64::try_from(count).unwrap_or(i64::MAX) + value,
    };
    match u32::try_from(from_zero) {
        Ok(index) if index != ABSENT => Ok(index),
        _ => Err("is out of range"),
    }
}
