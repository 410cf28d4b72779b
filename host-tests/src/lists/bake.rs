//! `bake`: a model into a list that firmware keeps in flash (H11, H16).
//!
//! Vertices are rounded to the smallest form that keeps the error asked for, and merged where
//! they become the same; triangles of one colour share a material instead of a column; strips
//! and fans index tables of 255 vertices in bytes, or one large table in half words, whichever is
//! smaller. Pictures become textures of the smallest form that keeps the error asked for, and
//! texture places are moved by whole sides to where 2x16U holds them. Materials keep opacity and
//! highlights. HEAD says what memory the list needs, BOUNDS where it is.

use super::args::{BakeArgs, Normals, Pictures};
use super::fields::{Grid, Packed, Places, degrees_between, normal_fields};
use super::gltf::{self, Loaded};
use super::sizes;
use super::strips::strips_of;
use super::tables::{Table, tables};
use super::texels::{Picture, Texels};
use crate::image_out::{read_image, write_atomically};
use crate::lists::writer::{FieldPacker, Form, ListWriter, WriteError};
use crate::model::Model;
use crate::texture_file;
use scanbeam::Affine;
use scanbeam::list::{
    Bounds, Field, FieldForm, Flow, Head, Header, Id, Material, Matrix, State, VertexFormat,
    parameter,
};
use std::collections::{BTreeMap, BTreeSet, HashMap};
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
    /// How far texels may be off: root of the mean square, in levels of 255.
    pub texel_error: f64,
}

impl Default for BakeSettings {
    fn default() -> Self {
        Self {
            error: None,
            normal_error: 1.0,
            normals: true,
            texel_error: 4.0,
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
    /// The textures, by number.
    pub textures: Vec<Texels>,
    /// Texture places that no number of sides brings to where 2x16U holds them: moved to its rim.
    pub places_cut: usize,
}

impl Baked {
    /// Bytes of the list for each triangle that it draws, texels and palettes left out.
    #[must_use]
    pub fn bytes_per_triangle(&self) -> f64 {
        let texels: usize = self.textures.iter().map(Texels::bytes).sum();
        (4 * self.words.len() - texels) as f64 / self.triangles.max(1) as f64
    }
}

/// Bakes a model file.
///
/// # Errors
/// When the model cannot be read or baked, or the list cannot be written.
pub fn run(args: &BakeArgs) -> Result<(), Box<dyn Error>> {
    let Loaded { model, pictures } = load(args)?;
    let settings = BakeSettings {
        error: args.error,
        normal_error: args.normal_error,
        normals: args.normals == Normals::Keep,
        texel_error: args.texel_error,
    };
    let baked = bake_textured(&model, &pictures, &settings)
        .map_err(|e| format!("{}: {e}", args.model.display()))?;
    let bytes: Vec<u8> = baked.words.iter().flat_map(|w| w.to_ne_bytes()).collect();
    write_atomically(&args.output, &bytes)?;
    sizes::report(&baked, args.json)?;
    model.print_warnings();
    Ok(())
}

/// The model with its pictures, as the flags ask for them.
fn load(args: &BakeArgs) -> Result<Loaded, Box<dyn Error>> {
    let obj = args
        .model
        .extension()
        .is_some_and(|e| e.eq_ignore_ascii_case("obj"));
    let mut loaded = if obj {
        let model = Model::load(&args.model)?;
        let pictures = match (args.textures, &args.texture) {
            (Pictures::Keep, None) => of_materials(&model)?,
            _ => Vec::new(),
        };
        Loaded { model, pictures }
    } else {
        gltf::load(&args.model)?
    };
    if let Some(file) = &args.texture {
        // The last material, which no triangle has had, is for those without.
        let one = Picture::new(&read_image(file)?)?;
        let model = &mut loaded.model;
        model.materials.push(crate::model::Material {
            name: String::new(),
            kd: [1.0; 3],
            ks: [0.0; 3],
            ns: 0.0,
            d: 1.0,
            map_kd: None,
        });
        let last = model.materials.len() as u32 - 1;
        for material in &mut model.triangle_materials {
            material.get_or_insert(last);
        }
        loaded.pictures = vec![Some(one); model.materials.len()];
    } else if args.textures == Pictures::Drop {
        loaded.pictures.clear();
    }
    // A picture on several materials is told once.
    let mut told = BTreeSet::new();
    let notes = loaded.pictures.iter().flatten();
    for note in notes.filter_map(|picture| picture.image.note.as_deref()) {
        if told.insert(note) {
            tell!("note: {note}");
        }
    }
    Ok(loaded)
}

/// The pictures of an OBJ file's materials, which repeat.
fn of_materials(model: &Model) -> Result<Vec<Option<Picture>>, Box<dyn Error>> {
    let images = texture_file::of_materials(model)?.into_iter();
    let picture = |image| Picture {
        image,
        clamped: false,
    };
    Ok(images.map(|image| image.map(picture)).collect())
}

/// Triangles that share a material.
struct Group {
    material: Material,
    /// Their colours differ from vertex to vertex.
    coloured: bool,
    triangles: Vec<usize>,
}

impl Group {
    fn header(&self, id: Id, count: usize) -> Header {
        let textured = self.material.texture.is_some();
        Header {
            shade: true,
            prsp: textured,
            text: textured,
            ..Header::of(id, count as u16)
        }
    }
}

/// Makes a list of a model without textures.
///
/// # Errors
/// When no form keeps the error, or the model is beyond what a matrix can say.
pub fn bake(model: &Model, settings: &BakeSettings) -> Result<Baked, Box<dyn Error>> {
    bake_textured(model, &[], settings)
}

/// Makes a list of a model with the pictures of its materials, of which the last may be missing.
///
/// # Errors
/// As [`bake`]; when there are more than 256 pictures.
pub fn bake_textured(
    model: &Model,
    pictures: &[Option<Picture>],
    settings: &BakeSettings,
) -> Result<Baked, Box<dyn Error>> {
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
            Packed {
                place: grid.fields(v.position),
                normal: n,
                colour,
                uv: [0; 2],
            }
        })
        .collect();
    // Materials that share a picture share its texture.
    let mut distinct: Vec<&Picture> = Vec::new();
    let numbers: Vec<Option<u8>> = pictures
        .iter()
        .map(|picture| {
            let picture = picture.as_ref()?;
            let at = distinct.iter().position(|d| *d == picture);
            let at = at.unwrap_or_else(|| {
                distinct.push(picture);
                distinct.len() - 1
            });
            Some(at as u8)
        })
        .collect();
    if distinct.len() > 256 {
        return Err("more than 256 textures".into());
    }
    let reduced = |p: &&Picture| Texels::new(p, settings.texel_error);
    let textures: Vec<Texels> = distinct.iter().map(reduced).collect();
    let texel_words: usize = textures.iter().map(|t| t.bytes() / 4 + 8).sum();
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
        textures,
        places_cut: 0,
    };
    let writer = Plan {
        grid,
        normal,
        packed: &packed,
        model,
        textures: &numbers,
    };
    // 16 words a triangle and what comes once: more than any of the forms takes.
    let mut memory = vec![0; 32 * model.triangles.len() + 1024 + texel_words];
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
    /// Numbers of the materials' textures.
    textures: &'a [Option<u8>],
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
            let mut colours = corners.map(|v| self.packed[v as usize].colour);
            let first = colours.next().unwrap_or([255; 3]);
            let coloured = colours.any(|c| c != first);
            let texture = material.and_then(|m| *self.textures.get(m as usize)?);
            let of = material.map(|m| &model.materials[m as usize]);
            let d = of.map_or(1.0, |m| m.d);
            // Highlights need normals.
            let shiny = of.filter(|_| self.normal.is_some());
            let specular = shiny.map_or([0.0; 3], |m| m.ks);
            let material = Material {
                diffuse: if coloured { [255; 3] } else { first },
                opacity: (d * 255.0).round() as u8,
                specular: specular.map(|k| (k.clamp(0.0, 1.0) * 255.0).round() as u8),
                exponent: shiny.map_or(0.0, |m| m.ns.clamp(0.0, 255.0).round()) as u8,
                texture,
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
        // Before BOUNDS, so that what it lets pass over sets none of them.
        for (number, texels) in baked.textures.iter().enumerate() {
            texels.write(out, number as u8)?;
        }
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
            let format = self.format(&group);
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
            let p = self.grid.place(v.place);
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

    fn format(&self, group: &Group) -> VertexFormat {
        let mut fields = vec![Field {
            parameter: parameter::PLACE,
            form: self.grid.form,
        }];
        fields.extend(self.normal.map(|form| Field {
            parameter: parameter::NORMAL,
            form,
        }));
        fields.extend(group.coloured.then_some(Field {
            parameter: parameter::DIFFUSE,
            form: FieldForm::U8x3,
        }));
        fields.extend(group.material.texture.map(|_| Field {
            parameter: parameter::TEXTURE,
            form: FieldForm::U16x2,
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
        let textured = group.material.texture.is_some();
        let clamped = group
            .material
            .texture
            .is_some_and(|t| baked.textures[usize::from(t)].clamped);
        let places = Places::of(self.model, &group.triangles, clamped);
        for &n in &group.triangles {
            let corners = self.model.triangles[n];
            let moved = places.moved(corners.map(|v| self.model.vertices[v as usize].uv));
            let mut at = 0..3;
            let triangle = corners.map(|v| {
                let mut packed = self.packed[v as usize];
                if !group.coloured {
                    packed.colour = [0; 3];
                }
                let corner = at.next().unwrap_or_default();
                if textured {
                    let (uv, cut) = moved[corner];
                    packed.uv = uv;
                    baked.places_cut += usize::from(cut);
                }
                *known.entry(packed).or_insert_with(|| {
                    vertices.push(packed);
                    vertices.len() as u32 - 1
                })
            });
            let [a, b, c] = triangle.map(|v| vertices[v as usize].place);
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
            self.table(out, (group, table), &vertices, format, is_wide)?;
        }
        Ok(())
    }

    fn table(
        &self,
        out: &mut ListWriter<'_>,
        (group, table): (&Group, &Table),
        vertices: &[Packed],
        format: &VertexFormat,
        wide: bool,
    ) -> Result<(), WriteError> {
        let header = group.header(Id::Table, table.vertices.len());
        let mut words = Vec::new();
        let mut packer = FieldPacker::new(|w| words.push(w));
        for field in format.fields() {
            for &v in &table.vertices {
                let Packed {
                    place,
                    normal,
                    colour,
                    uv,
                } = vertices[v as usize];
                let [x, y, z] = match field.parameter {
                    parameter::PLACE => place,
                    parameter::NORMAL => normal,
                    parameter::TEXTURE => [i32::from(uv[0]), i32::from(uv[1]), 0],
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
