//! A model rounded to the crate's number formats, in parts that fit a mesh.

use super::TextureSet;
use host_support::model::Model;
use scanbeam::mesh::Sphere;
use scanbeam::scene::{ShadowEdge, ShadowLight, ShadowMemory};
use scanbeam::{Affine, Faces, Mesh};
use std::collections::HashMap;
use std::ops::Range;

/// A model in the crate's number formats.
pub struct Prepared {
    pub(super) chunks: Vec<Chunk>,
    /// Where the middle of the model is, and what one unit of its coordinates means.
    pub(super) centre: [f64; 3],
    pub(super) scale: f64,
}

/// What throws a shadow.
#[derive(Default)]
pub(super) struct ShadowMesh {
    pub(super) positions: Vec<[i32; 3]>,
    pub(super) faces: Vec<[u16; 3]>,
}

impl ShadowMesh {
    /// Draws its shadow volume.
    pub(super) fn draw<L>(
        &self,
        scene: &mut scanbeam::Scene<'_, '_, L>,
        model: &Affine,
        light: &ShadowLight,
    ) -> Result<(), scanbeam::scene::DrawError> {
        let edges = 3 * self.faces.len();
        let memory = ShadowMemory {
            edges: &mut vec![ShadowEdge::default(); edges],
            positions: &mut vec![[0; 3]; 2 * edges],
            faces: &mut vec![[0; 3]; 2 * edges],
        };
        let mesh = Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&self.faces),
        };
        scene.draw_shadow(&mesh, model, light, memory)
    }
}

/// A colour in 8 bits a channel.
pub(super) fn colour8(colour: [f64; 3]) -> [u8; 3] {
    colour.map(|c| (c * 255.0).round() as u8)
}

/// At most 65,536 vertices and the triangles among them.
pub(super) struct Chunk {
    pub(super) positions: Vec<[i32; 3]>,
    normals: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    pub(super) faces: Vec<[u16; 3]>,
    /// Around all positions.
    pub(super) sphere: Sphere,
    /// Texture places, where there is a texture.
    pub(super) places: Vec<[i32; 2]>,
    pub(super) texture: Option<u16>,
    /// Which of the model's looks.
    pub(super) look: u16,
}

impl Prepared {
    /// Rounds a model to Q1.30 coordinates about its middle, Q1.14 normals and 8-bit colours.
    #[must_use]
    pub fn new(model: &Model) -> Self {
        Self::textured(model, &TextureSet::default())
    }

    /// The same with textures: a part has one, or none.
    #[must_use]
    pub fn textured(model: &Model, set: &TextureSet) -> Self {
        Self::split(model, set, |_| 0)
    }

    /// The same, and the triangles of a part have one look.
    pub(super) fn split(model: &Model, set: &TextureSet, look: impl Fn(usize) -> u16) -> Self {
        let (low, high) = model.bounds().unwrap_or(([-1.0; 3], [1.0; 3]));
        let centre = [0, 1, 2].map(|i| low[i] / 2.0 + high[i] / 2.0);
        let reach = (0..3).fold(0.0f64, |r, i| r.max(high[i] - centre[i]));
        // A power of two, so that the matrix holds it exactly.
        let scale = if reach > 0.0 {
            reach.log2().ceil().exp2()
        } else {
            1.0
        };
        let mut prepared = Self {
            chunks: Vec::new(),
            centre,
            scale,
        };
        // Few enough vertices a mesh that a part outside the picture can be given up as a whole.
        const CHUNK: usize = 4096;
        let mut new_index = vec![u16::MAX; model.vertices.len()];
        let mut used = Vec::new();
        let first = if model.triangles.is_empty() {
            0
        } else {
            look(0)
        };
        let mut chunk = Chunk::new(set.of(0).map(|(number, _)| number), first);
        for (number, triangle) in model.triangles.iter().enumerate() {
            let (texture, image) = set.of(number).unzip();
            let look = look(number);
            let is_other = (chunk.texture, chunk.look) != (texture, look);
            if chunk.positions.len() + 3 > CHUNK || is_other {
                let next = Chunk::new(texture, look);
                prepared.chunks.push(std::mem::replace(&mut chunk, next));
                for index in used.drain(..) {
                    new_index[index] = u16::MAX;
                }
            }
            let face = triangle.map(|index| {
                let index = index as usize;
                if new_index[index] == u16::MAX {
                    new_index[index] = chunk.positions.len() as u16;
                    used.push(index);
                    let vertex = &model.vertices[index];
                    let q14 = |v: f64| (v * f64::from(1 << 14)).round() as i16;
                    chunk.positions.push(prepared.q30(vertex.position));
                    if let Some(image) = image {
                        let (u, v) = image.texels(vertex.uv);
                        chunk.places.push([u, v]);
                    }
                    chunk.normals.push(vertex.normal.map(q14));
                    chunk.colours.push(colour8(vertex.colour));
                }
                new_index[index]
            });
            chunk.faces.push(face);
        }
        prepared.chunks.push(chunk);
        for chunk in &mut prepared.chunks {
            chunk.sphere = Sphere::around(&chunk.positions);
        }
        prepared
    }

    /// Gives all vertices one colour.
    pub(super) fn paint(&mut self, colour: [u8; 3]) {
        for chunk in &mut self.chunks {
            chunk.colours.fill(colour);
        }
    }

    fn q30(&self, position: [f64; 3]) -> [i32; 3] {
        let q30 = |v: f64| (v * f64::from(1 << 30)).round() as i32;
        [0, 1, 2].map(|i| q30((position[i] - self.centre[i]) / self.scale))
    }

    /// What throws shadows: the triangles of `model` that `casts`, their corners shared wherever
    /// they are at one place, so that a closed model is a closed mesh.
    pub(super) fn shadow_meshes(
        &self,
        model: &Model,
        casts: impl Fn(usize) -> bool,
    ) -> Vec<ShadowMesh> {
        let mut meshes = Vec::new();
        let mut mesh = ShadowMesh::default();
        let mut index = HashMap::new();
        for (number, triangle) in model.triangles.iter().enumerate() {
            if !casts(number) {
                continue;
            }
            if mesh.positions.len() + 3 > 1 << 16 {
                meshes.push(std::mem::take(&mut mesh));
                index.clear();
            }
            let face = triangle.map(|i| {
                let position = self.q30(model.vertices[i as usize].position);
                *index.entry(position).or_insert_with(|| {
                    mesh.positions.push(position);
                    mesh.positions.len() as u16 - 1
                })
            });
            mesh.faces.push(face);
        }
        meshes.push(mesh);
        meshes
    }

    pub(super) fn model_matrix(&self) -> Option<Affine> {
        Affine::placed(self.scale as f32, [0.0; 3])
    }
}

impl Chunk {
    fn new(texture: Option<u16>, look: u16) -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            colours: Vec::new(),
            faces: Vec::new(),
            sphere: Sphere::around::<i32>(&[]),
            places: Vec::new(),
            texture,
            look,
        }
    }

    pub(super) fn mesh(&self) -> Mesh<'_, i32> {
        Mesh {
            positions: &self.positions,
            normals: &self.normals,
            colours: &self.colours,
            faces: Faces::Triangles(&self.faces),
        }
    }

    /// One with some of its faces, and all of its vertices.
    pub(super) fn some(&self, faces: Range<usize>) -> Self {
        Self {
            positions: self.positions.clone(),
            normals: self.normals.clone(),
            colours: self.colours.clone(),
            faces: self.faces[faces].to_vec(),
            places: self.places.clone(),
            ..*self
        }
    }

    /// One with those faces that `has`, and their vertices alone.
    pub(super) fn only(&self, has: &dyn Fn(usize) -> bool) -> Self {
        let mut part = Self::new(self.texture, self.look);
        let mut new_index = vec![u16::MAX; self.positions.len()];
        for (number, face) in self.faces.iter().enumerate() {
            if !has(number) {
                continue;
            }
            let face = face.map(|index| {
                let old = usize::from(index);
                if new_index[old] == u16::MAX {
                    new_index[old] = part.positions.len() as u16;
                    part.positions.push(self.positions[old]);
                    part.normals.push(self.normals[old]);
                    part.colours.push(self.colours[old]);
                    part.places.extend(self.places.get(old));
                }
                new_index[old]
            });
            part.faces.push(face);
        }
        part.sphere = self.sphere;
        part
    }

    /// One with a face alone.
    pub(super) fn alone(&self, face: usize) -> Self {
        let corners = self.faces[face].map(usize::from);
        let places = if self.places.is_empty() {
            Vec::new()
        } else {
            corners.map(|i| self.places[i]).to_vec()
        };
        Self {
            positions: corners.map(|i| self.positions[i]).to_vec(),
            normals: corners.map(|i| self.normals[i]).to_vec(),
            colours: corners.map(|i| self.colours[i]).to_vec(),
            faces: vec![[0, 1, 2]],
            places,
            ..*self
        }
    }
}
