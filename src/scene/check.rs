//! What is wrong with a draw call, before anything of it is drawn.

use super::{Draw, DrawError, Shading};
use crate::geometry::{Coordinate, Faces, MeshError, check};

/// Whether there are as many alphas as vertices, or none.
pub(super) fn check_alphas(alphas: &[u8], vertices: usize) -> Result<(), DrawError> {
    match alphas.len() {
        0 => Ok(()),
        count => as_many(count, vertices),
    }
}

/// Whether there are as many values as vertices.
fn as_many(values: usize, vertices: usize) -> Result<(), DrawError> {
    let error = DrawError::Mesh(MeshError::AttributeLength);
    (values == vertices).then_some(()).ok_or(error)
}

/// Whether a mesh is one, and whether the look has what a draw call asks for: textures, light at corners or at pixels.
pub(super) fn check_draw<C: Coordinate>(
    draw: &Draw<'_, '_, C>,
    textured: bool,
    lit_at_pixels: bool,
) -> Result<(), DrawError> {
    let mesh = &draw.mesh;
    let is_filed_at_once = draw.shading == Shading::Smooth && draw.shadow.is_none();
    // Indices of triangles are looked at on the way.
    let are_late = is_filed_at_once && matches!(mesh.faces, Faces::Triangles(_));
    check(mesh, are_late).map_err(DrawError::Mesh)?;
    let at_corners = draw.light.is_some() || draw.lights.is_some() || !mesh.colours.is_empty();
    if draw.lamps.is_some() && (at_corners || !lit_at_pixels) {
        return Err(DrawError::Light);
    }
    let places = match (draw.texture, draw.texgen) {
        (Some(_), _) if !textured => return Err(DrawError::Untextured),
        (Some(_), Some(_)) => mesh.normals.len(),
        (Some(skin), None) => skin.places.len(),
        (None, _) => return Ok(()),
    };
    as_many(places, mesh.positions.len())
}
