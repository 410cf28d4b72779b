//! What is wrong with a draw call, before anything of it is drawn.

use super::{Draw, DrawError, Shading};
use crate::geometry::{Coordinate, Faces, MeshError, check_mesh};

/// Whether there are as many alphas as vertices, or none.
pub(super) fn check_alphas(alphas: &[u8], vertices: usize) -> Result<(), DrawError> {
    match alphas.len() {
        0 => Ok(()),
        count if count == vertices => Ok(()),
        _ => Err(DrawError::Mesh(MeshError::AttributeLength)),
    }
}

/// Whether a mesh is one, and whether the look has what a draw call asks for: textures, light at corners or at pixels.
pub(super) fn check_draw<C: Coordinate>(
    draw: &Draw<'_, '_, C>,
    textured: bool,
    lit_at_pixels: bool,
) -> Result<(), DrawError> {
    let mesh = &draw.mesh;
    // Indices of triangles are looked at on the way.
    let is_looked_at = matches!(mesh.faces, Faces::Triangles(_));
    let is_filed_at_once = is_looked_at && draw.shading == Shading::Smooth;
    let below = if is_filed_at_once && draw.shadow.is_none() {
        0
    } else {
        usize::MAX
    };
    check_mesh(mesh, below).map_err(DrawError::Mesh)?;
    let at_corners = draw.light.is_some() || draw.lights.is_some() || !mesh.colours.is_empty();
    if draw.lamps.is_some() && (at_corners || !lit_at_pixels) {
        return Err(DrawError::Light);
    }
    match draw.texture {
        Some(_) if !textured => Err(DrawError::Untextured),
        Some(skin) => {
            let places = match draw.texgen {
                Some(_) => mesh.normals.len(),
                None => skin.places.len(),
            };
            let fits = places == mesh.positions.len();
            let error = DrawError::Mesh(MeshError::AttributeLength);
            fits.then_some(()).ok_or(error)
        }
        None => Ok(()),
    }
}
