//! `bake`: a model into a list that firmware keeps in flash (H11, H16).
//!
//! Vertices are rounded to the smallest form that keeps the error asked for, and merged where
//! they become the same; triangles of one colour share a material instead of a column; strips
//! and fans index tables of 255 vertices in bytes, or one large table in half words, whichever is
//! smaller. HEAD says what memory the list needs, BOUNDS where it is.

use super::args::{BakeArgs, Normals};
use super::gltf;
use super::strips::strips_of;
use super::tables::{Table, tables};
use crate::image_out::write_atomically;
use crate::model::Model;
use scanbeam::Affine;
use scanbeam::list::{
    Bounds, Field, FieldForm, FieldPacker, Flow, Form, Head, Header, Id, ListWriter, Material,
    Matrix, State, VertexFormat, WriteError, parameter,
};
use serde_json::json;
use std::collections::{BTreeMap, HashMap};
use std::error::Error;

/// What is to be kept.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct BakeSettings {
    /// How far a vertex may be moved, in units of the model; `None`: a thousandth of half the
    /// longest side.
    pub error: Option<f64>,
    /// How far a normal may be turned, in degrees.
    pub normal_error: f64,
    /// Whether normals are kept.
    pub normals: bool,
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self {
            error: None,
            normal_error: 1.0,
            normals: true,
        }
    }
}

/// A list and what became of the model.
#[derive(Debug, Clone, PartialEq)]
pub struct Baked {
    /// The list, as it lies in memory.
    pub words: Vec<u32>,
    /// Triangles that are drawn.
    pub triangles: usize,
    /// Triangles of the model that have two corners in one place after rounding.
    pub dropped: usize,
    /// Vertices in tables, copies in several tables included.
    pub vertices: usize,
    /// Strips, fans and separate triangles.
    pub runs: [usize; 3],
    /// Form of the places.
    pub place: FieldForm,
    /// Form of the normals, where there are any.
    pub normal: Option<FieldForm>,
    /// Farthest that a vertex was moved, in units of the model.
    pub error: f64,
    /// Farthest that a normal was turned, in degrees.
    pub normal_error: f64,
    /// Vertices of the largest table.
    pub table: usize,
}

impl Baked {
    /// Bytes of the list for each triangle that it draws.
    #[must_use]
    pub fn bytes_per_triangle(&self) -> f64 {
        4.0 * self.words.len() as f64 / self.triangles.max(1) as f64
    }
}

/// Bakes a model file.
///
/// # Errors
/// When the model cannot be read or baked, or the list cannot be written.
pub fn run(args: &BakeArgs) -> Result<(), Box<dyn Error>> {
    let obj = args
        .model
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("obj"));
    let model = if obj {
        Model::load(&args.model)?
    } else {
        gltf::load(&args.model)?
    };
    let settings = BakeSettings {
        error: args.error,
        normal_error: args.normal_error,
        normals: args.normals == Normals::Keep,
    };
    let baked = bake(&model, &settings).map_err(|e| format!("{}: {e}", args.model.display()))?;
    let bytes: Vec<u8> = baked.words.iter().flat_map(|w| w.to_ne_bytes()).collect();
    write_atomically(&args.output, &bytes)?;
    report(&baked, args.json)?;
    model.print_warnings();
    Ok(())
}

fn report(b: &Baked, json: bool) -> Result<(), Box<dyn Error>> {
    let [strips, fans, separate] = b.runs;
    let bytes = 4 * b.words.len();
    if json {
        let report = json!({
            "bytes": bytes,
            "triangles": b.triangles,
            "triangles_dropped": b.dropped,
            "bytes_per_triangle": b.bytes_per_triangle(),
            "vertices": b.vertices,
            "strips": strips,
            "fans": fans,
            "separate": separate,
            "place": format!("{:?}", b.place),
            "normal": b.normal.map(|n| format!("{n:?}")),
            "error": b.error,
            "normal_error_degrees": b.normal_error,
            "largest_table": b.table,
        });
        println!("{}", serde_json::to_string_pretty(&report)?);
        return Ok(());
    }
    println!(
        "{bytes} bytes, {} triangles: {:.2} bytes a triangle",
        b.triangles,
        b.bytes_per_triangle()
    );
    println!(
        "{} vertices in tables of at most {}; {strips} strips, {fans} fans, {separate} triangles alone",
        b.vertices, b.table
    );
    println!("places {:?}, moved by {:.3e} at most", b.place, b.error);
    if let Some(normal) = b.normal {
        println!(
            "normals {normal:?}, turned by {:.3} degrees at most",
            b.normal_error
        );
    }
    if b.dropped > 0 {
        println!("{} triangles fell together and are left out", b.dropped);
    }
    Ok(())
}

/// Where a form puts places: `centre + scale field / unit`.
#[derive(Clone, Copy)]
struct Grid {
    form: FieldForm,
    centre: [f32; 3],
    /// Size of 1.0 of the mesh in the model.
    scale: f32,
}

impl Grid {
    /// The finest grid of a form that holds `reach` each way.
    fn new(form: FieldForm, centre: [f64; 3], reach: f64) -> Self {
        let [most, unit, _] = Self::limits(form)[0];
        let reach = if reach > 0.0 { reach } else { 1.0 };
        // A little more, so that rounding to single precision cannot leave the range.
        let scale = (reach * unit / most * (1.0 + 1e-6)) as f32;
        Self {
            form,
            centre: centre.map(|c| c as f32),
            scale,
        }
    }

    /// For each axis the largest field, the field of 1.0, and the field's least.
    fn limits(form: FieldForm) -> [[f64; 3]; 3] {
        match form {
            FieldForm::S8x3 => [[127.0, 128.0, -128.0]; 3],
            FieldForm::S10x3 => [
                // By the coarsest axis, so that one scale suits all.
                [1022.0, 1024.0, -1024.0],
                [1022.0, 1024.0, -1024.0],
                [511.0, 512.0, -512.0],
            ],
            FieldForm::S16x3 => [[32_767.0, 16_384.0, -32_768.0]; 3],
            _ => [[2_147_483_647.0, 1_073_741_824.0, -2_147_483_648.0]; 3],
        }
    }

    fn fields(&self, p: [f64; 3]) -> [i32; 3] {
        let limits = Self::limits(self.form);
        [0, 1, 2].map(|i| {
            let [most, unit, least] = limits[i];
            let v = (p[i] - f64::from(self.centre[i])) / f64::from(self.scale) * unit;
            v.round().clamp(least, most) as i32
        })
    }

    fn place(&self, fields: [i32; 3]) -> [f64; 3] {
        let limits = Self::limits(self.form);
        [0, 1, 2].map(|i| {
            f64::from(self.centre[i]) + f64::from(fields[i]) / limits[i][1] * f64::from(self.scale)
        })
    }
}

/// The fields of a normal, and what they mean, not yet of length 1.
fn normal_fields(form: FieldForm, n: [f64; 3]) -> ([i32; 3], [f64; 3]) {
    let most = match form {
        FieldForm::S8x3 => [127.0; 3],
        FieldForm::S10x3 => [1023.0, 1023.0, 511.0],
        _ => [16_384.0; 3],
    };
    let fields = [0, 1, 2].map(|i| (n[i] * most[i]).round() as i32);
    (fields, [0, 1, 2].map(|i| f64::from(fields[i]) / most[i]))
}

fn degrees_between(a: [f64; 3], b: [f64; 3]) -> f64 {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let lengths = (dot(a, a) * dot(b, b)).sqrt();
    if lengths == 0.0 {
        return 0.0;
    }
    (dot(a, b) / lengths).clamp(-1.0, 1.0).acos().to_degrees()
}

/// A vertex in fields.
type Packed = ([i32; 3], [i32; 3], [u8; 3]);

/// Triangles that share a material.
struct Group {
    material: Material,
    /// Their colours differ from vertex to vertex.
    coloured: bool,
    triangles: Vec<usize>,
}

/// Makes a list of a model.
///
/// # Errors
/// When no form keeps the error, or the model is beyond what a matrix can say.
pub fn bake(model: &Model, settings: &BakeSettings) -> Result<Baked, Box<dyn Error>> {
    let (low, high) = model.bounds().unwrap_or(([0.0; 3], [0.0; 3]));
    let centre = [0, 1, 2].map(|i| low[i] / 2.0 + high[i] / 2.0);
    let reach = (0..3).fold(0.0f64, |r, i| r.max(high[i] - centre[i]));
    let allowed = settings.error.unwrap_or(reach / 1000.0);
    let moved = |grid: &Grid| {
        model.vertices.iter().fold(0.0f64, |worst, v| {
            let at = grid.place(grid.fields(v.position));
            let d = [0, 1, 2].map(|i| at[i] - v.position[i]);
            worst.max((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt())
        })
    };
    // By bytes in a column: 3, 4, 6, 12.
    let forms = [
        FieldForm::S8x3,
        FieldForm::S10x3,
        FieldForm::S16x3,
        FieldForm::S32x3,
    ];
    let (grid, error) = forms
        .into_iter()
        .map(|form| Grid::new(form, centre, reach))
        .map(|grid| (grid, moved(&grid)))
        .find(|(_, error)| *error <= allowed)
        .ok_or_else(|| format!("no form keeps an error of {allowed:e}"))?;
    let turned = |form| {
        model.vertices.iter().fold(0.0f64, |worst, v| {
            worst.max(degrees_between(normal_fields(form, v.normal).1, v.normal))
        })
    };
    let (normal, normal_error) = [FieldForm::S8x3, FieldForm::S10x3, FieldForm::S16x3]
        .into_iter()
        .map(|form| (form, turned(form)))
        .find(|(form, error)| *error <= settings.normal_error || *form == FieldForm::S16x3)
        .filter(|_| settings.normals)
        .map_or((None, 0.0), |(form, error)| (Some(form), error));

    let packed: Vec<Packed> = model
        .vertices
        .iter()
        .map(|v| {
            let n = normal.map_or([0; 3], |form| normal_fields(form, v.normal).0);
            let colour = v.colour.map(|c| (c * 255.0).round() as u8);
            (grid.fields(v.position), n, colour)
        })
        .collect();
    let mut baked = Baked {
        words: Vec::new(),
        triangles: 0,
        dropped: 0,
        vertices: 0,
        runs: [0; 3],
        place: grid.form,
        normal,
        error,
        normal_error,
        table: 0,
    };
    let writer = Plan {
        grid,
        normal,
        packed: &packed,
        model,
    };
    // 16 words a triangle and what comes once: more than any of the forms takes.
    let mut memory = vec![0; 32 * model.triangles.len() + 1024];
    let mut out = ListWriter::new(&mut memory);
    writer.write(&mut out, &mut baked, reach)?;
    baked.words = out.words().to_vec();
    Ok(baked)
}

/// What is to be written.
struct Plan<'a> {
    grid: Grid,
    normal: Option<FieldForm>,
    packed: &'a [Packed],
    model: &'a Model,
}

impl Plan<'_> {
    fn groups(&self) -> Vec<Group> {
        let model = self.model;
        let mut by_material: BTreeMap<Option<u32>, Vec<usize>> = BTreeMap::new();
        for (n, material) in model.triangle_materials.iter().enumerate() {
            by_material.entry(*material).or_default().push(n);
        }
        let mut groups: Vec<Group> = Vec::new();
        for (material, triangles) in by_material {
            let corners = triangles.iter().flat_map(|n| model.triangles[*n]);
            let mut colours = corners.map(|v| self.packed[v as usize].2);
            let first = colours.next().unwrap_or([255; 3]);
            let coloured = colours.any(|c| c != first);
            let d = material.map_or(1.0, |m| model.materials[m as usize].d);
            let material = Material {
                diffuse: if coloured { [255; 3] } else { first },
                opacity: (d * 255.0).round() as u8,
                ..Material::default()
            };
            let same = |g: &&mut Group| g.material == material && g.coloured == coloured;
            match groups.iter_mut().find(same) {
                Some(group) => group.triangles.extend(triangles),
                None => groups.push(Group {
                    material,
                    coloured,
                    triangles,
                }),
            }
        }
        groups
    }

    fn write(
        &self,
        out: &mut ListWriter<'_>,
        baked: &mut Baked,
        reach: f64,
    ) -> Result<(), Box<dyn Error>> {
        out.state(&State::Head(Head::default()))?;
        let matrix = Affine::placed(self.grid.scale, self.grid.centre)
            .and_then(|m| Matrix::try_from(&m).ok())
            .ok_or("it is too large")?;
        let bounds_at = out.position();
        let bounds = self.bounds(&matrix, reach)?;
        out.state(&State::Bounds(bounds))?;
        let behind = out.position();
        out.state(&State::Matrix(matrix))?;
        for group in self.groups() {
            out.state(&State::Material(group.material))?;
            let format = self.format(group.coloured);
            out.state(&State::Format(format))?;
            self.group(out, baked, &group, &format)?;
        }
        let bounds = Bounds {
            words: out.position() - behind,
            ..bounds
        };
        out.rewrite(bounds_at, &State::Bounds(bounds))?;
        out.flow(Flow::End)?;
        // Now that all is known: the head again, in its place.
        let head = Head {
            words: out.position(),
            table: baked.table as u32,
            triangles: baked.triangles as u32,
        };
        out.rewrite(0, &State::Head(head))?;
        Ok(())
    }

    /// A sphere around the middle, a little larger than need be.
    fn bounds(&self, matrix: &Matrix, reach: f64) -> Result<Bounds, Box<dyn Error>> {
        let centre = self.grid.centre.map(f64::from);
        let radius = self.packed.iter().fold(0.0f64, |r, v| {
            let p = self.grid.place(v.0);
            let d = [0, 1, 2].map(|i| p[i] - centre[i]);
            r.max((d[0] * d[0] + d[1] * d[1] + d[2] * d[2]).sqrt())
        });
        let largest = centre.iter().fold(radius.max(reach), |m, c| m.max(c.abs()));
        let exponent = if largest > 0.0 {
            largest.log2().floor() as i32 + 2
        } else {
            i32::from(matrix.offset_exponent)
        };
        let unit = 2f64.powi(30 - exponent);
        Ok(Bounds {
            centre: centre.map(|c| (c * unit).round() as i32),
            radius: (radius * unit).ceil() as i32 + 2,
            exponent: exponent.clamp(-128, 96) as i16,
            words: 0,
        })
    }

    fn format(&self, coloured: bool) -> VertexFormat {
        let mut fields = vec![Field {
            parameter: parameter::PLACE,
            form: self.grid.form,
        }];
        fields.extend(self.normal.map(|form| Field {
            parameter: parameter::NORMAL,
            form,
        }));
        fields.extend(coloured.then_some(Field {
            parameter: parameter::DIFFUSE,
            form: FieldForm::U8x3,
        }));
        // A place, and each parameter once.
        VertexFormat::new(&fields).unwrap_or_default()
    }

    fn group(
        &self,
        out: &mut ListWriter<'_>,
        baked: &mut Baked,
        group: &Group,
        format: &VertexFormat,
    ) -> Result<(), Box<dyn Error>> {
        // Vertices that became the same are one.
        let mut known: HashMap<Packed, u32> = HashMap::new();
        let mut vertices: Vec<Packed> = Vec::new();
        let mut triangles = Vec::new();
        for &n in &group.triangles {
            let triangle = self.model.triangles[n].map(|v| {
                let mut packed = self.packed[v as usize];
                if !group.coloured {
                    packed.2 = [0; 3];
                }
                *known.entry(packed).or_insert_with(|| {
                    vertices.push(packed);
                    vertices.len() as u32 - 1
                })
            });
            let [a, b, c] = triangle.map(|v| vertices[v as usize].0);
            if a == b || b == c || c == a {
                baked.dropped += 1;
            } else {
                triangles.push(triangle);
            }
        }
        let runs = strips_of(&triangles);
        baked.triangles += triangles.len();
        let narrow = tables(&runs, 255);
        let wide = tables(&runs, 65_535);
        let vertex_bytes: u32 = format.fields().iter().map(|f| f.form.column_bytes()).sum();
        let bytes = |tables: &[Table], each: usize| -> usize {
            let table =
                |t: &Table| t.vertices.len() * vertex_bytes as usize + each * t.indices() + 16;
            tables.iter().map(table).sum()
        };
        let (tables, is_wide) = if bytes(&narrow, 1) <= bytes(&wide, 2) {
            (narrow, false)
        } else {
            (wide, true)
        };
        for table in &tables {
            baked.table = baked.table.max(table.vertices.len());
            baked.vertices += table.vertices.len();
            let counts = [table.strips.len(), table.fans.len(), table.separate.len()];
            for (sum, n) in baked.runs.iter_mut().zip(counts) {
                *sum += n;
            }
            self.table(out, table, &vertices, format, is_wide)?;
        }
        Ok(())
    }

    fn table(
        &self,
        out: &mut ListWriter<'_>,
        table: &Table,
        vertices: &[Packed],
        format: &VertexFormat,
        wide: bool,
    ) -> Result<(), WriteError> {
        let header = Header {
            shade: true,
            ..Header::of(Id::Table, table.vertices.len() as u16)
        };
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        for field in format.fields() {
            for &v in &table.vertices {
                let (place, normal, colour) = vertices[v as usize];
                let [x, y, z] = match field.parameter {
                    parameter::PLACE => place,
                    parameter::NORMAL => normal,
                    _ => colour.map(i32::from),
                };
                packer.field(field.form, [x, y, z, 255]);
            }
            packer.align();
        }
        out.vertices(header, &words)?;
        for (runs, form) in [(&table.strips, Form::Strip), (&table.fans, Form::Fan)] {
            // Blocks of at most 65,535 indices, broken between strips.
            let mut block: Vec<Option<u16>> = Vec::new();
            for run in runs {
                if block.len() + run.len() >= 65_535 {
                    out.indexed(Some(form), wide, std::mem::take(&mut block).into_iter())?;
                }
                if !block.is_empty() {
                    block.push(None);
                }
                block.extend(run.iter().map(|i| Some(*i)));
            }
            if !block.is_empty() {
                out.indexed(Some(form), wide, block.into_iter())?;
            }
        }
        for part in table.separate.chunks(65_535 / 3) {
            let indices: Vec<_> = part.iter().flatten().map(|i| Some(*i)).collect();
            out.indexed(None, wide, indices.into_iter())?;
        }
        Ok(())
    }
}
