//! A drawn frame against the reference.

use super::Reference;
use super::raster::neighbours;
use crate::image_out::Frame;
use serde::Serialize;
use std::fmt;

/// A pixel differs when a channel is further from the reference than this, in levels.
pub const TOLERANCE_LEVELS: f64 = 2.0;

/// How far a frame is from the reference. Pixels "away from edges" are those that [`Reference::near_edge`] does not
/// mark; for the others `max_error_near_edges` measures against all colours in reach, so that they are held too.
#[derive(Debug, Clone, Copy, PartialEq, Default, Serialize)]
pub struct Comparison {
    /// Largest difference of a channel away from edges, in levels.
    pub max_error_levels: f64,
    /// Mean difference over all channels of pixels away from edges, in levels.
    pub mean_error_levels: f64,
    /// Pixels away from edges with a channel beyond [`TOLERANCE_LEVELS`].
    pub differing_pixels: usize,
    /// First of these from the top left, as (x, y) in pixels.
    pub first_differing: Option<(u32, u32)>,
    /// Pixels away from edges.
    pub compared_pixels: usize,
    /// Pixels that were left out of the four above.
    pub excluded_pixels: usize,
    /// Largest distance of a channel, at the excluded pixels, from the range that the reference has there and at the
    /// eight pixels around, in levels.
    pub max_error_near_edges: f64,
    /// Pixels of the reference that, rounded, are not of the background's colour.
    pub covered_reference: usize,
    /// Pixels of the frame that are not of the background's colour.
    pub covered_frame: usize,
    /// Pixels that are of the background's colour in one of the two only, anywhere.
    pub covered_differently: usize,
    /// As before, away from edges only.
    pub covered_differently_away: usize,
}

/// The frame has not the size of the reference.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct SizeMismatch;

impl fmt::Display for SizeMismatch {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        f.write_str("the frame has not the size of the reference")
    }
}

impl std::error::Error for SizeMismatch {}

/// Compares a frame with the reference, whose background had the given colour.
///
/// # Errors
/// The sizes differ.
pub fn compare(
    reference: &Reference,
    background: [u8; 3],
    frame: &Frame,
) -> Result<Comparison, SizeMismatch> {
    if (frame.width(), frame.height()) != (reference.width, reference.height) {
        return Err(SizeMismatch);
    }
    let (width, height) = (reference.width as usize, reference.height as usize);
    let mut result = Comparison::default();
    let mut sum = 0.0;
    for (index, (levels, drawn)) in reference
        .colour
        .iter()
        .zip(frame.rgb().chunks_exact(3))
        .enumerate()
    {
        let (x, y) = (index % width, index / width);
        let away = !reference.near_edge[index];
        let in_reference = levels.map(|level| level.round() as u8) != background;
        let in_frame = *drawn != background;
        result.covered_reference += usize::from(in_reference);
        result.covered_frame += usize::from(in_frame);
        result.covered_differently += usize::from(in_reference != in_frame);
        result.covered_differently_away += usize::from(away && in_reference != in_frame);
        if !away {
            result.excluded_pixels += 1;
            for (channel, &level) in drawn.iter().enumerate() {
                let around = neighbours(x, y, width, height).map(|i| reference.colour[i][channel]);
                let (low, high) = around.fold((255.0_f64, 0.0_f64), |(low, high), level| {
                    (low.min(level), high.max(level))
                });
                let level = f64::from(level);
                let error = (low - level).max(level - high);
                result.max_error_near_edges = result.max_error_near_edges.max(error);
            }
            continue;
        }
        result.compared_pixels += 1;
        let mut worst = 0.0_f64;
        for (level, &drawn) in levels.iter().zip(drawn) {
            let error = (level - f64::from(drawn)).abs();
            worst = worst.max(error);
            sum += error;
        }
        result.max_error_levels = result.max_error_levels.max(worst);
        if worst > TOLERANCE_LEVELS {
            result.differing_pixels += 1;
            result.first_differing.get_or_insert((x as u32, y as u32));
        }
    }
    if result.compared_pixels > 0 {
        result.mean_error_levels = sum / (3 * result.compared_pixels) as f64;
    }
    Ok(result)
}
