//! One vertex from model space to the screen (K1).
//!
//! Only ratios of clip coordinates count, so each draw call scales its own: the rows are chosen
//! such that no vertex of the mesh can leave 31 bits, whatever the matrices are. The screen's
//! focal length enters as a mantissa in the x and y rows and a power of two at the very end.

use super::camera::Camera;
use super::mesh::Coordinate;
use super::transform::Affine;
use crate::num::{few_leading_zeros, mul_wide, shift_round};

/// Model space to screen, for one draw call.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Projection {
    /// What coordinates are multiplied by.
    pub(crate) rows: [[i32; 3]; 3],
    /// What is added to the products.
    pub(crate) offset: [i32; 3],
    /// `X = x 2^power / z` in units of 1/8 pixel from the principal point.
    pub(crate) power: i32,
    /// Near plane in clip coordinates, at least 1.
    pub(crate) near: i32,
    /// Far plane in clip coordinates.
    pub(crate) far: i32,
    /// The near plane is a mantissa in 2^30 ..< 2^31 times 2^-near_down.
    pub(crate) near_down: i32,
}

impl Projection {
    #[inline(never)]
    pub(crate) fn new(camera: &Camera, model: &Affine) -> Self {
        let map = model.then(&camera.seen);
        // A vertex is within 2 each way, so a row reaches at most twice the sum of its entries.
        let mut row_bits = -200;
        for i in 0..3 {
            let m = &map.linear.mantissa[3 * i..3 * i + 3];
            let sum: u32 = m.iter().map(|m| m.unsigned_abs()).sum();
            // A power of two is reached, not gone beyond: there is a bit for that.
            row_bits = row_bits.max(32 - few_leading_zeros(sum.saturating_sub(1)) as i32);
        }
        let reach = (row_bits + 1 + map.linear.exponent - 30).max(map.offset.magnitude_bits()) + 1;
        let scale = 29 - reach.max(-100);
        let focal = camera.focal.mantissa[0];
        let mut rows = [[0; 3]; 3];
        let mut offset = [0; 3];
        for i in 0..3 {
            // x and y take the focal length's mantissa, 2^29 ..< 2^30 for 1/2 ..< 1.
            let factor = if i < 2 { focal } else { 1 << 30 };
            for (k, entry) in rows[i].iter_mut().enumerate() {
                let m = map.linear.mantissa[3 * i + k];
                *entry = scaled(m, factor, map.linear.exponent - 60 + scale + 2);
            }
            let m = map.offset.mantissa[i];
            offset[i] = scaled(m, factor, map.offset.exponent - 60 + scale);
        }
        let clamp = |v: i64| v.clamp(1, i64::from(i32::MAX)) as i32;
        Self {
            rows,
            offset,
            power: camera.focal.exponent,
            near: clamp(camera.near.scaled(0, scale)),
            far: clamp(camera.far.scaled(0, scale)),
            near_down: 31 - camera.near.exponent - scale,
        }
    }
}

/// A row times a position, and what is added.
#[inline(always)]
pub(crate) fn along<C: Coordinate>(row: [i32; 3], p: [C; 3], offset: i32) -> i32 {
    let sum = p[0].times(row[0]).wrapping_add(p[1].times(row[1]));
    sum.wrapping_add(p[2].times(row[2])).wrapping_add(offset)
}

/// A number times a factor, shifted to the left; out of line, since a draw call has twelve.
#[inline(never)]
fn scaled(m: i32, factor: i32, shift: i32) -> i32 {
    shift_round(mul_wide(m, factor), shift) as i32
}
