//! A model rounded to the crate's number formats, in parts that fit a mesh.

use super::TextureSet;
use crate::model::Model;
use scanbeam::texture::{Quality, Skin};
use scanbeam::{Affine, DrawError, Faces, Instance, Mesh, Pipeline, Scene, Sphere};

/// A model in the crate's number formats.
pub struct Prepared {
    pub(super) chunks: Vec<Chunk>,
    /// Where the middle of the model is, and what one unit of its coordinates means.
    pub(super) centre: [f64; 3],
    scale: f64,
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
    places: Vec<[i32; 2]>,
    texture: Option<u16>,
    quality: Quality,
}

impl Prepared {
    /// Rounds a model to Q1.30 coordinates about its middle, Q1.14 normals and 8-bit colours.
    #[must_use]
    pub fn new(model: &Model) -> Self {
        Self::textured(model, &TextureSet::default(), Quality::default())
    }

    /// The same with textures: a part has one, or none.
    #[must_use]
    pub fn textured(model: &Model, set: &TextureSet, quality: Quality) -> Self {
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
        let mut chunk = Chunk::new(set.of(0).map(|(number, _)| number), quality);
        for (number, triangle) in model.triangles.iter().enumerate() {
            let (texture, image) = set.of(number).unzip();
            if chunk.positions.len() + 3 > CHUNK || chunk.texture != texture {
                prepared
                    .chunks
                    .push(std::mem::replace(&mut chunk, Chunk::new(texture, quality)));
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
                    let q30 = |v: f64| (v * f64::from(1 << 30)).round() as i32;
                    let q14 = |v: f64| (v * f64::from(1 << 14)).round() as i16;
                    let p = [0, 1, 2].map(|i| q30((vertex.position[i] - centre[i]) / scale));
                    chunk.positions.push(p);
                    if let Some(image) = image {
                        let (u, v) = image.texels(vertex.uv);
                        chunk.places.push([u, v]);
                    }
                    chunk.normals.push(vertex.normal.map(q14));
                    chunk
                        .colours
                        .push(vertex.colour.map(|c| (c * 255.0).round() as u8));
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

    pub(super) fn model_matrix(&self) -> Option<Affine> {
        Affine::placed(self.scale as f32, [0.0; 3])
    }
}

impl Chunk {
    fn new(texture: Option<u16>, quality: Quality) -> Self {
        Self {
            positions: Vec::new(),
            normals: Vec::new(),
            colours: Vec::new(),
            faces: Vec::new(),
            sphere: Sphere::around::<i32>(&[]),
            places: Vec::new(),
            texture,
            quality,
        }
    }

    fn skin<'a>(&self, places: &'a [[i32; 2]]) -> Skin<'a> {
        Skin {
            places,
            texture: self.texture.unwrap_or(Skin::TEXTURES),
            quality: self.quality,
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

    /// Draws the chunk with shared vertices or, `alone`, triangle by triangle: then only the
    /// vertices of triangles that can be seen take room. The pixels are the same.
    pub(super) fn draw<P: Pipeline>(
        &self,
        scene: &mut Scene<'_, P>,
        instance: &Instance,
        alone: bool,
    ) -> Result<(), DrawError> {
        if !alone {
            if scene
                .skip_outside(&self.mesh(), instance, &self.sphere)
                .is_some()
            {
                return Ok(());
            }
            let skin = self.skin(&self.places);
            return scene
                .draw_skinned(&self.mesh(), skin.into(), instance)
                .map(drop);
        }
        for face in &self.faces {
            let corners = face.map(usize::from);
            let mesh = Mesh {
                positions: &corners.map(|i| self.positions[i]),
                normals: &corners.map(|i| self.normals[i]),
                colours: &corners.map(|i| self.colours[i]),
                faces: Faces::Triangles(&[[0, 1, 2]]),
            };
            let places = corners.map(|i| self.places.get(i).copied().unwrap_or_default());
            let skin = match self.texture {
                Some(_) => self.skin(&places),
                None => Skin::default(),
            };
            scene.draw_skinned(&mesh, skin.into(), instance)?;
        }
        Ok(())
    }
}
