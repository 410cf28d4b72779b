//! A scene as plain numbers, as `scanbeam bench` writes it.

use alloc::vec::Vec;
use serde::Deserialize;

/// Pixels of a line, and lines.
pub(crate) const SIZE: [usize; 2] = [320, 240];
/// Focal length over half the width: 320 pixels of 160.
pub(crate) const FOCAL: f32 = 2.0;
/// Nearest and farthest distance.
pub(crate) const NEAR_FAR: [f32; 2] = [0.1, 100.0];

/// A scene seen from the origin of view space: x right, y up, looking along -z.
#[derive(Deserialize)]
pub(crate) struct Data {
    /// Added to a position to come to view space.
    pub(crate) offset: [f32; 3],
    pub(crate) positions: Vec<[f32; 3]>,
    /// Unit normals; none where `colours` are to be taken as they are.
    pub(crate) normals: Vec<[f32; 3]>,
    /// From 0 to 1.
    pub(crate) colours: Vec<[f32; 3]>,
    /// Counter-clockwise.
    pub(crate) faces: Vec<[usize; 3]>,
    /// To the light, of length 1.
    pub(crate) light: [f32; 3],
    /// Light that comes from everywhere.
    pub(crate) ambient: f32,
    /// Where nothing is, RGB565.
    pub(crate) background: u16,
}

impl Data {
    /// A vertex' colour, lit where it has a normal.
    #[inline]
    pub(crate) fn colour(&self, vertex: usize) -> [f32; 3] {
        let Some(n) = self.normals.get(vertex) else {
            return self.colours[vertex];
        };
        let facing = (0..3).map(|i| n[i] * self.light[i]).sum::<f32>().max(0.0);
        let level = self.ambient + (1.0 - self.ambient) * facing;
        self.colours[vertex].map(|c| c * level)
    }
}
