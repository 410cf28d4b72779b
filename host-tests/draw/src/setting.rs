//! What stays the same for all parts of a picture of a model.

use crate::{DrawFailure, Prepared};
use host_support::reference::{Cull, Shade, View};
use scanbeam::mesh::U1F15;
use scanbeam::scene::Shading;
use scanbeam::{Affine, Camera, Light};

/// How a model is seen, in the crate's number formats.
pub struct Setting {
    pub(crate) camera: Camera,
    pub(crate) model: Affine,
    pub(crate) cull: scanbeam::Cull,
    pub(crate) light: Option<Light>,
    pub(crate) shading: Shading,
    /// Whether the whole model lies within 60 focal lengths from where the camera looks, each way.
    pub(crate) is_ahead: bool,
}

impl Setting {
    /// In the crate's number formats.
    ///
    /// # Errors
    /// A camera or a light that is out of the crate's ranges.
    pub fn new(prepared: &Prepared, view: &View) -> Result<Self, DrawFailure> {
        let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
        let far = prepared
            .centre
            .iter()
            .fold(0.0f64, |far, c| far.max(c.abs()));
        if far.max(prepared.scale) > 2f64.powi(90) {
            return Err(bad(
                &"the model is too large, or too far away: its coordinates must be below 2^90",
            ));
        }
        // The model's middle is the origin, so that floats are spent on distances that matter.
        let from_centre = |p: [f64; 3]| [0, 1, 2].map(|i| (p[i] - prepared.centre[i]) as f32);
        let camera = Camera::look_at(
            from_centre(view.eye),
            from_centre(view.at),
            unit(view.up),
            focal(view),
            view.near as f32,
            view.far as f32,
        )
        .map_err(|e| bad(&e))?;
        let light = Light::new(unit(view.light), view.ambient as f32);
        Ok(Self {
            camera,
            model: prepared
                .model_matrix()
                .ok_or_else(|| bad(&"the model is too large"))?,
            cull: match view.cull {
                Cull::Back => scanbeam::Cull::Back,
                Cull::None => scanbeam::Cull::None,
            },
            light: light.filter(|_| view.shade != Shade::None),
            is_ahead: is_ahead(prepared, view),
            shading: match view.shade {
                Shade::Flat => Shading::Flat,
                Shade::None | Shade::Gouraud => Shading::Smooth,
            },
        })
    }
}

/// Whether all corners, and so all triangles, are at most 60 times as far aside of the way that the eye looks as along
/// it.
fn is_ahead(prepared: &Prepared, view: &View) -> bool {
    let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
    let way: [f64; 3] = [0, 1, 2].map(|i| view.at[i] - view.eye[i]);
    let length = dot(way, way).sqrt();
    let mut corners = prepared.chunks.iter().flat_map(|chunk| &chunk.positions);
    corners.all(|corner| {
        let unit = f64::from(1 << 30);
        let at = [0, 1, 2].map(|i| {
            let place = f64::from(corner[i]) / unit * prepared.scale + prepared.centre[i];
            place - view.eye[i]
        });
        let along = dot(at, way) / length;
        let aside = (dot(at, at) - along * along).max(0.0).sqrt();
        along > 0.0 && aside <= 60.0 * along
    })
}

/// The focal length of a view in pixels.
pub(crate) fn focal(view: &View) -> f32 {
    (f64::from(view.height) / 2.0 / (view.fov.to_radians() / 2.0).tan()) as f32
}

/// A direction whose largest part is 1 or -1.
pub(crate) fn unit(v: [f64; 3]) -> [f32; 3] {
    let largest = v.iter().fold(0.0f64, |m, c| m.max(c.abs()));
    v.map(|c| (c / largest) as f32)
}

/// A level of light, 0 to below 2.
pub(crate) fn level(value: f64) -> U1F15 {
    U1F15::from_bits((value.clamp(0.0, 1.99) * 32_768.0).round() as u16)
}
