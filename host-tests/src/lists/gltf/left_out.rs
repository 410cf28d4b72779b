//! What a list cannot keep of a glTF file: a line for each kind.

use gltf::material::AlphaMode;
use serde_json::Value;
use std::collections::BTreeSet;

/// The extension that turns, moves and scales texture places.
const TRANSFORM: &str = "KHR_texture_transform";

/// Which materials and meshes have what is left out, by their numbers.
#[derive(Default)]
pub(super) struct LeftOut {
    both_sides: BTreeSet<usize>,
    masks: BTreeSet<usize>,
    transforms: BTreeSet<usize>,
    /// Materials with a picture in which something is transparent.
    pub(super) pictures: BTreeSet<usize>,
    /// Meshes with colours of which some are transparent.
    pub(super) colours: BTreeSet<usize>,
    skins: BTreeSet<usize>,
    weights: BTreeSet<usize>,
}

impl LeftOut {
    /// That of a document's materials, but for their pictures.
    pub(super) fn of_materials(document: &gltf::Document, bytes: &[u8]) -> Self {
        let mut left_out = Self {
            transforms: transforms(bytes),
            ..Self::default()
        };
        for (number, material) in document.materials().enumerate() {
            if material.double_sided() {
                left_out.both_sides.insert(number);
            }
            if material.alpha_mode() == AlphaMode::Mask {
                left_out.masks.insert(number);
            }
        }
        left_out
    }

    /// Takes in a node that is placed.
    pub(super) fn node(&mut self, node: &gltf::Node<'_>) {
        let Some(mesh) = node.mesh() else {
            return;
        };
        if node.skin().is_some() {
            self.skins.insert(mesh.index());
        }
        let weights = node.weights().or(mesh.weights()).unwrap_or_default();
        if weights.iter().any(|weight| *weight != 0.0) {
            self.weights.insert(mesh.index());
        }
    }

    /// A line for each kind, with how many have it.
    pub(super) fn lines(&self) -> impl Iterator<Item = String> {
        let kinds = [
            ("doubleSided of materials is", &self.both_sides),
            ("alphaMode MASK of materials is", &self.masks),
            ("alphas of materials' pictures are", &self.pictures),
            ("KHR_texture_transform of materials is", &self.transforms),
            ("alphas of meshes' COLOR_0 are", &self.colours),
            ("skins of meshes are", &self.skins),
            ("morph weights of meshes are", &self.weights),
        ];
        let told = kinds.into_iter().filter(|(_, all)| !all.is_empty());
        told.map(|(what, all)| format!("{what} left out: {}", all.len()))
    }
}

/// Materials of which the picture's places are transformed, which the reader does not tell.
fn transforms(bytes: &[u8]) -> BTreeSet<usize> {
    let binary = gltf::binary::Glb::from_slice(bytes).ok();
    let text = binary.as_ref().map_or(bytes, |binary| &binary.json);
    let value: Value = serde_json::from_slice(text).unwrap_or_default();
    let materials = value["materials"].as_array().into_iter().flatten();
    let is_transformed = |material: &Value| {
        let picture = &material["pbrMetallicRoughness"]["baseColorTexture"];
        picture["extensions"].get(TRANSFORM).is_some()
    };
    let of = materials.enumerate().filter(|(_, m)| is_transformed(m));
    of.map(|(number, _)| number).collect()
}
