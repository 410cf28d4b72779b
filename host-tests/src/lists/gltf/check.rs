//! What the reader of glTF takes for granted, checked before it is asked: it panics where an
//! accessor or a picture is missing, and where an attribute is of another type or its bytes
//! overlap.

use gltf::accessor::{DataType, Dimensions};
use gltf::json::{Root, validation::Checked};
use gltf::{Accessor, Gltf, Primitive, Semantic};
use serde_json::Value;

/// Reads a document, text or binary, whose references all lead to something.
pub(super) fn document(bytes: &[u8]) -> Result<Gltf, String> {
    let unread = |error: gltf::Error| match version_of_text(bytes) {
        Some(version) if !is_read(&version) => other_version(&version),
        _ => error.to_string(),
    };
    let unchecked = Gltf::from_slice_without_validation(bytes).map_err(unread)?;
    let root = unchecked.document.as_json();
    if !is_read(&root.asset.version) {
        return Err(other_version(&root.asset.version));
    }
    positions(root)?;
    pictures(root)?;
    Gltf::from_slice(bytes).map_err(|error| error.to_string())
}

fn is_read(version: &str) -> bool {
    version.split('.').next() == Some("2")
}

fn other_version(version: &str) -> String {
    format!("it is glTF {version:?}, and 2.0 is what is read")
}

/// The version that a text states, whatever else it is: files of glTF 1.0 have another shape.
fn version_of_text(bytes: &[u8]) -> Option<String> {
    let value: Value = serde_json::from_slice(bytes).ok()?;
    let version = value.get("asset")?.get("version")?;
    Some(version.as_str()?.to_owned())
}

/// All positions are in accessors that are there: the reader's own check takes that for granted.
fn positions(root: &Root) -> Result<(), String> {
    let positions = Checked::Valid(Semantic::Positions);
    for (number, mesh) in root.meshes.iter().enumerate() {
        let named = mesh
            .primitives
            .iter()
            .flat_map(|p| p.attributes.get(&positions));
        for accessor in named {
            let accessor = accessor.value();
            if accessor >= root.accessors.len() {
                return Err(format!(
                    "mesh {number}: accessor {accessor} of its positions is not there"
                ));
            }
        }
    }
    Ok(())
}

/// Each picture lies in a view and says what it is, or has a name.
fn pictures(root: &Root) -> Result<(), String> {
    for (number, image) in root.images.iter().enumerate() {
        if image.buffer_view.is_none() && image.uri.is_none() {
            return Err(format!("picture {number} has neither a view nor a name"));
        }
        if image.buffer_view.is_some() && image.mime_type.is_none() {
            return Err(format!("picture {number} lies in a view and has no type"));
        }
    }
    Ok(())
}

/// Whether what is read of a primitive is of a type that it may have, and there.
pub(super) fn primitive(primitive: &Primitive<'_>, buffers: &[Vec<u8>]) -> Result<(), String> {
    for (semantic, accessor) in primitive.attributes() {
        let (kind, shape) = (accessor.data_type(), accessor.dimensions());
        let is_level = matches!(kind, DataType::U8 | DataType::U16 | DataType::F32);
        let fits = match semantic {
            Semantic::Positions | Semantic::Normals => {
                kind == DataType::F32 && shape == Dimensions::Vec3
            }
            Semantic::TexCoords(_) => is_level && shape == Dimensions::Vec2,
            Semantic::Colors(_) => is_level && matches!(shape, Dimensions::Vec3 | Dimensions::Vec4),
            // Not read.
            _ => true,
        };
        if !fits {
            return Err(of_other_type(&accessor));
        }
        lies_within(&accessor, buffers)?;
    }
    agrees(primitive)?;
    let Some(accessor) = primitive.indices() else {
        return Ok(());
    };
    let kind = accessor.data_type();
    let is_index = matches!(kind, DataType::U8 | DataType::U16 | DataType::U32);
    if !is_index || accessor.dimensions() != Dimensions::Scalar {
        return Err(of_other_type(&accessor));
    }
    lies_within(&accessor, buffers)
}

/// Whether there are as many of each attribute as positions, and the places that its picture needs.
fn agrees(primitive: &Primitive<'_>) -> Result<(), String> {
    let positions = primitive.get(&Semantic::Positions).map(|a| a.count());
    let material = primitive.material().pbr_metallic_roughness();
    let set = material.base_color_texture().map(|info| info.tex_coord());
    let places = set.map(Semantic::TexCoords);
    if let Some(set) = set.filter(|set| primitive.get(&Semantic::TexCoords(*set)).is_none()) {
        return Err(format!(
            "its picture needs TEXCOORD_{set}, which it has not"
        ));
    }
    for semantic in [Semantic::Normals, Semantic::Colors(0)]
        .into_iter()
        .chain(places)
    {
        let count = primitive.get(&semantic).map(|a| a.count());
        if let (Some(count), Some(of)) = (count, positions.filter(|of| count != Some(*of))) {
            let name = semantic.to_string();
            return Err(format!("it has {count} of {name} for {of} positions"));
        }
    }
    Ok(())
}

fn of_other_type(accessor: &Accessor<'_>) -> String {
    format!(
        "accessor {} has another type than its use asks for",
        accessor.index()
    )
}

/// Whether an accessor's bytes are there; the reader checks neither that a view is within its
/// buffer, nor that elements do not overlap.
fn lies_within(accessor: &Accessor<'_>, buffers: &[Vec<u8>]) -> Result<(), String> {
    let number = accessor.index();
    let outside = || format!("accessor {number} is not within its buffer");
    if accessor.sparse().is_some() {
        return Err(format!("accessor {number} is sparse, which is not read"));
    }
    if accessor.count() == 0 {
        return Err(format!("accessor {number} has no elements"));
    }
    let view = accessor.view().ok_or_else(outside)?;
    let have = buffers.get(view.buffer().index()).map_or(0, Vec::len);
    let end = view.offset().checked_add(view.length());
    if end.is_none_or(|end| end > have) {
        return Err(outside());
    }
    let stride = view.stride().unwrap_or(accessor.size());
    if stride < accessor.size() {
        return Err(format!(
            "accessor {number}: {stride} bytes from one element to the next, which have {}",
            accessor.size()
        ));
    }
    let last = (accessor.count() - 1).checked_mul(stride);
    let need = last
        .and_then(|n| n.checked_add(accessor.size()))
        .and_then(|n| n.checked_add(accessor.offset()));
    if need.is_none_or(|need| need > view.length()) {
        return Err(outside());
    }
    Ok(())
}
