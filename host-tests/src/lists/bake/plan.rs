//! Vertices in their forms into a list: groups by material, tables, strips and fans.

use super::Baked;
use crate::lists::fields::{Grid, Packed, Places};
use crate::lists::parts::{parts_of, whole};
use crate::lists::tables::{Table, TablePart, tables};
use crate::lists::writer::{FieldPacker, Form, ListWriter, WriteError};
use crate::model::Model;
use scanbeam::Affine;
use scanbeam::list::{
    Bounds, Cone, Field, FieldForm, Flow, Head, Header, Id, Material, Matrix, Place, State,
    VertexFormat,
};
use std::collections::{BTreeMap, HashMap};
use std::error::Error;

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

/// What is to be written.
pub(super) struct Plan<'a> {
    pub(super) grid: Grid,
    pub(super) normal: Option<FieldForm>,
    pub(super) packed: &'a [Packed],
    pub(super) model: &'a Model,
    /// Numbers of the materials' textures.
    pub(super) textures: &'a [Option<u8>],
    /// Whether it is cut into parts.
    pub(super) meshlets: bool,
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

    /// Writes the list and notes what is in it.
    pub(super) fn write(
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
            parameter: Field::PLACE,
            form: self.grid.form,
        }];
        fields.extend(self.normal.map(|form| Field {
            parameter: Field::NORMAL,
            form,
        }));
        fields.extend(group.coloured.then_some(Field {
            parameter: Field::DIFFUSE,
            form: FieldForm::U8x3,
        }));
        fields.extend(group.material.texture.map(|_| Field {
            parameter: Field::TEXTURE,
            form: FieldForm::U16x2,
        }));
        // A place, and each parameter once.
        VertexFormat::new(&fields).unwrap_or_default()
    }

    /// The triangles of a group, and their vertices: those that became the same are one.
    fn merged(&self, baked: &mut Baked, group: &Group) -> (Vec<Packed>, Vec<[u32; 3]>) {
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
        (vertices, triangles)
    }

    fn group(
        &self,
        out: &mut ListWriter<'_>,
        baked: &mut Baked,
        group: &Group,
        format: &VertexFormat,
    ) -> Result<(), Box<dyn Error>> {
        let (vertices, triangles) = self.merged(baked, group);
        let form = self.grid.form;
        // As players have them.
        let place = |v: &Packed| <i32 as Place>::of(form, v.place).unwrap_or_default();
        let parts = match self.meshlets {
            true => parts_of(&triangles, &vertices.iter().map(place).collect::<Vec<_>>())?,
            false => whole(&triangles),
        };
        baked.triangles += triangles.len();
        baked.parts += parts.iter().filter(|part| part.cone.is_some()).count();
        let narrow = tables(&parts, 255);
        let wide = tables(&parts, 65_535);
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
            self.table(out, (group, table), &vertices, format)?;
            for part in &table.parts {
                let counts = [part.strips.len(), part.fans.len(), part.separate.len()];
                for (sum, n) in baked.runs.iter_mut().zip(counts) {
                    *sum += n;
                }
                write_part(out, part, is_wide)?;
            }
        }
        Ok(())
    }

    fn table(
        &self,
        out: &mut ListWriter<'_>,
        (group, table): (&Group, &Table),
        vertices: &[Packed],
        format: &VertexFormat,
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
                    Field::PLACE => place,
                    Field::NORMAL => normal,
                    Field::TEXTURE => [i32::from(uv[0]), i32::from(uv[1]), 0],
                    _ => colour.map(i32::from),
                };
                packer.field(field.form, [x, y, z, 255]);
            }
            packer.align();
        }
        out.vertices(header, &words)?;
        Ok(())
    }
}

/// Writes the faces of a part, behind its cone.
fn write_part(out: &mut ListWriter<'_>, part: &TablePart, wide: bool) -> Result<(), WriteError> {
    let Some(cone) = part.cone else {
        return write_runs(out, part, wide);
    };
    let at = out.position();
    out.state(&State::Cone(cone))?;
    let behind = out.position();
    write_runs(out, part, wide)?;
    let words = out.position() - behind;
    out.rewrite(at, &State::Cone(Cone { words, ..cone }))
}

fn write_runs(out: &mut ListWriter<'_>, part: &TablePart, wide: bool) -> Result<(), WriteError> {
    for (runs, form) in [(&part.strips, Form::Strip), (&part.fans, Form::Fan)] {
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
    for some in part.separate.chunks(65_535 / 3) {
        let indices: Vec<_> = some.iter().flatten().map(|i| Some(*i)).collect();
        out.indexed(None, wide, indices.into_iter())?;
    }
    Ok(())
}
