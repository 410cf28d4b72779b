//! glTF 2.0, text and binary, into a model: triangles of all scenes' nodes in place, with their
//! normals, vertex colours, base colours and their pictures.
//!
//! Buffers and pictures are read from the file itself, from `data:` URIs, and from files beside it.
//! Pictures are PNG or JPEG. Their texture places are those of the set that the material names.

mod check;
mod files;
mod left_out;

use super::texels::Picture;
use crate::image_out::decode_cutout;
use crate::model::{Material, Model, ModelError, ModelVertex};
use crate::stdio;
use files::Files;
use gltf::buffer::Source;
use gltf::material::AlphaMode;
use gltf::mesh::Mode;
use gltf::texture::WrappingMode;
use left_out::LeftOut;
use std::collections::HashSet;
use std::path::Path;

/// Most nodes that are placed, each as often as it stands in the tree.
const MAX_NODES: usize = 1 << 16;
/// Most vertices of all meshes, each as often as it is placed.
const MAX_VERTICES: usize = 1 << 23;
/// Most corners of triangles, strips and fans, likewise.
const MAX_CORNERS: usize = 3 << 23;

/// A model, and for each of its materials the picture on it.
#[derive(Debug, Clone, PartialEq)]
pub struct Loaded {
    /// The model.
    pub model: Model,
    /// As many as materials.
    pub pictures: Vec<Option<Picture>>,
}

/// Reads a model.
///
/// # Errors
/// When a file cannot be read or contradicts itself, or a number is not finite.
pub fn load(path: &Path) -> Result<Loaded, ModelError> {
    let wrong = |reason: String| ModelError {
        file: path.to_path_buf(),
        line: None,
        reason,
    };
    let bytes =
        std::fs::read(path).map_err(|e| wrong(format!("cannot be read: {}", stdio::reason(&e))))?;
    let gltf = check::document(&bytes).map_err(wrong)?;
    let mut files = Files::new(path);
    let buffers = buffers_of(&gltf, &mut files).map_err(wrong)?;
    let mut reader = Reader {
        buffers: &buffers,
        model: Model::default(),
        without_area: 0,
        left_out: LeftOut::of_materials(&gltf, &bytes),
    };
    let mut pictures = Vec::new();
    for material in gltf.materials() {
        let picture = reader.material(&material, &mut files);
        pictures.push(picture.map_err(wrong)?);
    }
    let scenes: Vec<_> = match gltf.default_scene() {
        Some(scene) => vec![scene],
        None => gltf.scenes().take(1).collect(),
    };
    let mut placed = Placed::default();
    for node in scenes.iter().flat_map(|scene| scene.nodes()) {
        placed.node(&node, IDENTITY).map_err(wrong)?;
    }
    placed.check().map_err(wrong)?;
    for (mesh, matrix) in &placed.meshes {
        reader.mesh(mesh, matrix).map_err(wrong)?;
    }
    let mut warn = |reason: String| reader.model.warnings.push(wrong(reason));
    if scenes.is_empty() {
        warn("it has no scene, so nothing is drawn".into());
    } else if reader.model.triangles.is_empty() {
        warn("its scene has no triangles".into());
    }
    if reader.without_area > 0 {
        let n = reader.without_area;
        warn(format!("primitives of points and lines are left out: {n}"));
    }
    let left_out = (reader.left_out.lines()).chain(placed.left_out.lines());
    left_out.for_each(warn);
    reader.model.sources = files.read;
    Ok(Loaded {
        model: reader.model,
        pictures,
    })
}

/// All buffers of a file.
fn buffers_of(gltf: &gltf::Gltf, files: &mut Files<'_>) -> Result<Vec<Vec<u8>>, String> {
    let mut buffers = Vec::new();
    for buffer in gltf.buffers() {
        let number = buffer.index();
        let data = match buffer.source() {
            Source::Bin => gltf.blob.clone().ok_or("the binary part is missing".into()),
            Source::Uri(uri) => files.bytes(uri),
        };
        let data = data.map_err(|e: String| format!("buffer {number}: {e}"))?;
        if data.len() < buffer.length() {
            return Err(format!("buffer {number} is too short"));
        }
        buffers.push(data);
    }
    Ok(buffers)
}

/// The picture of a texture, whether something in it is transparent, and what is left out of it.
fn picture_of(
    texture: &gltf::Texture<'_>,
    buffers: &[Vec<u8>],
    files: &mut Files<'_>,
) -> Result<(Picture, bool, Option<&'static str>), String> {
    let read = match texture.source().source() {
        gltf::image::Source::Uri { uri, .. } => decode_cutout(&files.bytes(uri)?)?,
        gltf::image::Source::View { view, .. } => {
            let buffer = buffers.get(view.buffer().index()).map(Vec::as_slice);
            let end = view.offset().checked_add(view.length());
            let bytes = end.and_then(|end| buffer?.get(view.offset()..end));
            decode_cutout(bytes.ok_or("it is not within its buffer")?)?
        }
    };
    let mut picture = Picture::new(&read.frame).map_err(|e| e.to_string())?;
    let sampler = texture.sampler();
    let wraps = [sampler.wrap_s(), sampler.wrap_t()];
    picture.clamped = wraps == [WrappingMode::ClampToEdge; 2];
    let is_other = !picture.clamped && wraps != [WrappingMode::Repeat; 2];
    let told = "it repeats both ways, which is not what its sampler says";
    Ok((picture, read.alpha.is_some(), is_other.then_some(told)))
}

/// Linear light as a level of the display.
fn level(linear: f32) -> f64 {
    let v = f64::from(linear).clamp(0.0, 1.0);
    if v <= 0.003_130_8 {
        12.92 * v
    } else {
        // Exactly 1 at 1, which the rounded constants miss by one unit in the last place.
        1.0 - 1.055 * (1.0 - v.powf(1.0 / 2.4))
    }
}

/// Columns of a 4 x 4 matrix, as glTF has them.
type Matrix = [[f64; 4]; 4];

const IDENTITY: Matrix = [
    [1.0, 0.0, 0.0, 0.0],
    [0.0, 1.0, 0.0, 0.0],
    [0.0, 0.0, 1.0, 0.0],
    [0.0, 0.0, 0.0, 1.0],
];

fn product(a: &Matrix, b: &Matrix) -> Matrix {
    std::array::from_fn(|c| std::array::from_fn(|r| (0..4).map(|k| a[k][r] * b[c][k]).sum()))
}

fn cross(a: [f64; 3], b: [f64; 3]) -> [f64; 3] {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

fn unit(v: [f64; 3]) -> [f64; 3] {
    let length = dot(v, v).sqrt();
    if length > 0.0 {
        v.map(|c| c / length)
    } else {
        [0.0; 3]
    }
}

struct Reader<'b> {
    buffers: &'b [Vec<u8>],
    model: Model,
    /// Primitives of points and lines.
    without_area: usize,
    left_out: LeftOut,
}

/// The meshes of a scene, each as often as it stands in the tree, and where.
#[derive(Default)]
struct Placed<'d> {
    meshes: Vec<(gltf::Mesh<'d>, Matrix)>,
    nodes: usize,
    left_out: LeftOut,
    /// The nodes above the one at work, so that a circle is noticed.
    above: HashSet<usize>,
}

impl<'d> Placed<'d> {
    fn node(&mut self, node: &gltf::Node<'d>, parent: Matrix) -> Result<(), String> {
        self.nodes += 1;
        if self.nodes > MAX_NODES || self.above.len() > 256 || !self.above.insert(node.index()) {
            return Err("its nodes are too many, or stand in a circle".into());
        }
        let own = node.transform().matrix().map(|c| c.map(f64::from));
        let matrix = product(&parent, &own);
        self.left_out.node(node);
        self.meshes.extend(node.mesh().map(|mesh| (mesh, matrix)));
        for child in node.children() {
            self.node(&child, matrix)?;
        }
        self.above.remove(&node.index());
        Ok(())
    }

    /// Whether all of it is no more than what is read, before any of it is.
    fn check(&self) -> Result<(), String> {
        let primitives = self.meshes.iter().flat_map(|(mesh, _)| mesh.primitives());
        let sizes = primitives.map(|primitive| {
            let vertices = primitive
                .get(&gltf::Semantic::Positions)
                .map_or(0, |a| a.count());
            [
                vertices,
                primitive.indices().map_or(vertices, |a| a.count()),
            ]
        });
        let sums = sizes.fold([0; 2], |sums: [usize; 2], size| {
            [0, 1].map(|i| sums[i].saturating_add(size[i]))
        });
        match sums {
            [vertices, corners] if vertices > MAX_VERTICES || corners > MAX_CORNERS => {
                Err(format!(
                    "as often as its meshes are placed they have {vertices} vertices and {corners} corners, \
                 of at most {MAX_VERTICES} and {MAX_CORNERS}"
                ))
            }
            _ => Ok(()),
        }
    }
}

impl Reader<'_> {
    /// Takes in a material; its picture.
    fn material(
        &mut self,
        material: &gltf::Material<'_>,
        files: &mut Files<'_>,
    ) -> Result<Option<Picture>, String> {
        let [r, g, b, a] = material.pbr_metallic_roughness().base_color_factor();
        let mode = material.alpha_mode();
        self.model.materials.push(Material {
            name: material.name().unwrap_or("").to_owned(),
            kd: [r, g, b].map(level),
            d: match mode {
                AlphaMode::Blend => f64::from(a),
                _ => 1.0,
            },
            ..Material::default()
        });
        let Some(info) = material.pbr_metallic_roughness().base_color_texture() else {
            return Ok(None);
        };
        let number = info.texture().source().index();
        let named = |reason: &str| format!("picture {number}: {reason}");
        let (picture, is_cut, told) =
            picture_of(&info.texture(), self.buffers, files).map_err(|e| named(&e))?;
        self.model.warnings.extend(told.map(|told| ModelError {
            file: files.read[0].clone(),
            line: None,
            reason: named(told),
        }));
        // Of an opaque material they mean nothing.
        if is_cut && mode != AlphaMode::Opaque {
            self.left_out.pictures.extend(material.index());
        }
        Ok(Some(picture))
    }

    fn mesh(&mut self, mesh: &gltf::Mesh<'_>, matrix: &Matrix) -> Result<(), String> {
        for primitive in mesh.primitives() {
            let (of, number) = (mesh.index(), primitive.index());
            self.primitive(&primitive, of, matrix)
                .map_err(|reason| format!("mesh {of}, primitive {number}: {reason}"))?;
        }
        Ok(())
    }

    fn primitive(
        &mut self,
        primitive: &gltf::Primitive<'_>,
        mesh: usize,
        matrix: &Matrix,
    ) -> Result<(), String> {
        let buffers = self.buffers;
        check::primitive(primitive, buffers)?;
        if matches!(
            primitive.mode(),
            Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip
        ) {
            self.without_area += 1;
            return Ok(());
        }
        let reader = primitive.reader(|b| buffers.get(b.index()).map(Vec::as_slice));
        let Some(positions) = reader.read_positions() else {
            return Err("it has no positions".into());
        };
        let positions: Vec<[f64; 3]> = positions.map(|p| placed(matrix, p)).collect();
        if positions
            .iter()
            .flatten()
            .any(|c| !c.is_finite() || c.abs() > f64::from(f32::MAX))
        {
            return Err("a position is not finite, or too large".into());
        }
        let indices: Vec<u32> = match reader.read_indices() {
            Some(indices) => indices.into_u32().collect(),
            None => (0..positions.len() as u32).collect(),
        };
        if indices.iter().any(|i| *i as usize >= positions.len()) {
            return Err("an index names a vertex that does not exist".into());
        }
        let columns = [0, 1, 2].map(|c: usize| [matrix[c][0], matrix[c][1], matrix[c][2]]);
        let mirrored = dot(columns[0], cross(columns[1], columns[2])) < 0.0;
        let mut triangles = triangles_of(primitive.mode(), &indices)?;
        if mirrored {
            for t in &mut triangles {
                t.swap(1, 2);
            }
        }
        let normals: Vec<[f64; 3]> = match reader.read_normals() {
            Some(normals) => {
                // By the inverse's transpose, but for its length: the cofactors.
                let [x, y, z] = columns;
                let rows = [cross(y, z), cross(z, x), cross(x, y)];
                let side = if mirrored { -1.0 } else { 1.0 };
                normals
                    .map(|n| {
                        let n = n.map(f64::from);
                        unit(
                            [0, 1, 2]
                                .map(|i| side * (0..3).map(|k| rows[k][i] * n[k]).sum::<f64>()),
                        )
                    })
                    .collect()
            }
            None => area_normals(&positions, &triangles),
        };
        let material = primitive.material();
        let kd = material.pbr_metallic_roughness().base_color_factor();
        let colours: Option<Vec<[f32; 4]>> =
            reader.read_colors(0).map(|c| c.into_rgba_f32().collect());
        let is_clear = colours.iter().flatten().any(|c| c[3] < 1.0);
        if is_clear && material.alpha_mode() != AlphaMode::Opaque {
            self.left_out.colours.insert(mesh);
        }
        if colours.iter().flatten().flatten().any(|c| !c.is_finite()) {
            return Err("a colour is not finite".into());
        }
        let info = material.pbr_metallic_roughness().base_color_texture();
        let places: Option<Vec<[f32; 2]>> = info
            .and_then(|info| reader.read_tex_coords(info.tex_coord()))
            .map(|places| places.into_f32().collect());
        if places.iter().flatten().flatten().any(|c| !c.is_finite()) {
            return Err("a texture place is not finite".into());
        }
        let base = self.model.vertices.len() as u32;
        for (i, position) in positions.into_iter().enumerate() {
            let own = colours.as_ref().and_then(|c| c.get(i)).copied();
            let own = own.unwrap_or([1.0; 4]);
            let normal = normals.get(i).copied().unwrap_or([0.0; 3]);
            if normal.iter().any(|c| !c.is_finite()) {
                return Err("a normal is not finite".into());
            }
            self.model.vertices.push(ModelVertex {
                position,
                normal,
                colour: [0, 1, 2].map(|k| level(own[k] * kd[k])),
                uv: places
                    .as_ref()
                    .and_then(|p| p.get(i))
                    .map_or([0.0; 2], |[u, v]| [f64::from(*u), 1.0 - f64::from(*v)]),
            });
        }
        for t in triangles {
            self.model.triangles.push(t.map(|i| base + i));
            let index = material.index().map(|i| i as u32);
            self.model.triangle_materials.push(index);
        }
        Ok(())
    }
}

fn placed(m: &Matrix, p: [f32; 3]) -> [f64; 3] {
    let p = p.map(f64::from);
    [0, 1, 2].map(|r| m[0][r] * p[0] + m[1][r] * p[1] + m[2][r] * p[2] + m[3][r])
}

fn triangles_of(mode: Mode, i: &[u32]) -> Result<Vec<[u32; 3]>, String> {
    let three = |w: &[u32]| [w[0], w[1], w[2]];
    if i.len() < 3 || mode == Mode::Triangles && !i.len().is_multiple_of(3) {
        return Err(format!("{} corners are no whole triangles", i.len()));
    }
    Ok(match mode {
        Mode::Triangles => i.chunks_exact(3).map(three).collect(),
        Mode::TriangleStrip => i
            .windows(3)
            .enumerate()
            .map(|(n, w)| {
                if n % 2 == 0 {
                    three(w)
                } else {
                    [w[1], w[0], w[2]]
                }
            })
            .collect(),
        Mode::TriangleFan => i.windows(2).skip(1).map(|w| [i[0], w[0], w[1]]).collect(),
        // Points and lines have no area.
        Mode::Points | Mode::Lines | Mode::LineLoop | Mode::LineStrip => Vec::new(),
    })
}

/// Area-weighted normals.
fn area_normals(positions: &[[f64; 3]], triangles: &[[u32; 3]]) -> Vec<[f64; 3]> {
    let mut sums = vec![[0.0; 3]; positions.len()];
    for t in triangles {
        let [a, b, c] = t.map(|i| positions[i as usize]);
        let side = |p: [f64; 3]| [0, 1, 2].map(|i| p[i] - a[i]);
        let n = cross(side(b), side(c));
        for i in t {
            let sum = &mut sums[*i as usize];
            *sum = [0, 1, 2].map(|k| sum[k] + n[k]);
        }
    }
    sums.into_iter().map(unit).collect()
}
