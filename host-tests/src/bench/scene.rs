//! Scenes A and C as plain numbers, for renderers that take any mesh.

use scanbeam::Faces;
use scanbeam::pixel::{PixelFormat, Rgb565};
use scenes::{LAYER, LAYERS, NEAREST_LAYER, SPHERE, Shot, layer_colours};
use serde::Serialize;

/// The scenes that others draw too: A, and C in both orders.
pub const SHARED: [Shot; 3] = [Shot::Sphere, Shot::FarToNear, Shot::NearToFar];

/// A scene seen from the origin of view space: x right, y up, looking along -z, at a focal length
/// of 320 pixels.
#[derive(Debug, Serialize)]
pub struct Data {
    /// Added to a position to come to view space.
    offset: [f32; 3],
    positions: Vec<[f32; 3]>,
    /// Unit normals; none where `colours` are to be taken as they are.
    normals: Vec<[f32; 3]>,
    /// From 0 to 1.
    colours: Vec<[f32; 3]>,
    /// Counter-clockwise.
    faces: Vec<[u16; 3]>,
    /// To the light, of length 1.
    light: [f32; 3],
    /// Light that comes from everywhere.
    ambient: f32,
    /// Where nothing is.
    background: u16,
}

/// What shows where nothing is, in RGB565.
pub(super) fn background(shot: Shot) -> u16 {
    Rgb565::from_rgb8(shot.background())
}

impl Data {
    /// One of [`SHARED`]; `None` for other shots.
    pub fn new(shot: Shot) -> Option<Self> {
        match shot {
            Shot::Sphere => Self::sphere(),
            Shot::FarToNear => Some(Self::stack(shot, (0..LAYERS).rev())),
            Shot::NearToFar => Some(Self::stack(shot, 0..LAYERS)),
            _ => None,
        }
    }

    fn sphere() -> Option<Self> {
        let Faces::Triangles(faces) = SPHERE.faces else {
            return None;
        };
        let positions: Vec<[f32; 3]> = SPHERE.positions.iter().map(|p| q14(*p)).collect();
        let light = [0.5f32, 0.7, 0.8];
        let length = light.iter().map(|c| c * c).sum::<f32>().sqrt();
        Some(Self {
            offset: [0.0, 0.0, -3.94],
            normals: positions.clone(),
            colours: vec![[1.0; 3]; positions.len()],
            positions,
            faces: faces.to_vec(),
            light: light.map(|c| c / length),
            ambient: 0.15,
            background: background(Shot::Sphere),
        })
    }

    fn stack(shot: Shot, orders: impl Iterator<Item = u8>) -> Self {
        let mut data = Self {
            offset: [0.0; 3],
            positions: Vec::new(),
            normals: Vec::new(),
            colours: Vec::new(),
            faces: Vec::new(),
            light: [0.0, 0.0, 1.0],
            ambient: 1.0,
            background: background(shot),
        };
        for order in orders {
            let depth = f32::from(NEAREST_LAYER + order);
            let first = data.positions.len() as u16;
            let corners = LAYER.map(|p| q14(p).map(|c| c * depth));
            data.positions.extend(corners);
            let colours = layer_colours(order).map(|c| c.map(|c| f32::from(c) / 255.0));
            data.colours.extend(colours);
            let faces = [[0, 1, 2], [0, 2, 3]].map(|face| face.map(|v| v + first));
            data.faces.extend(faces);
        }
        data
    }
}

fn q14(p: [i16; 3]) -> [f32; 3] {
    p.map(|c| f32::from(c) / 16_384.0)
}
