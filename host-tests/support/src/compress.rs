//! Texels into blocks of 4 x 4 in 8 bytes, as BC1 has them and [`Compressed`] draws them (H7).
//!
//! The ends of a block begin as the outermost of its colours along the axis on which they differ most. Then each channel
//! of both is moved by a step as long as the sum of squares falls. What a block shows is asked of the crate that draws it.

use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::{Compressed, Texels, TextureError};

/// A texel to be compressed; none for one that is transparent.
pub type Texel = Option<[u8; 3]>;

/// Texels a side of a block.
const SIDE: usize = 4;

/// A picture in blocks.
#[derive(Debug, Clone, PartialEq)]
pub struct Blocks {
    /// Columns and rows.
    pub sides: [u32; 2],
    /// Blocks in rows from the top, 8 bytes each.
    pub bytes: Vec<u8>,
    /// Root of the mean square that a channel is off, in levels of 255; transparent texels left out.
    pub error: f64,
}

impl Blocks {
    /// Compresses texels, in rows from the top.
    ///
    /// # Errors
    /// As [`Compressed::new`], and when there are fewer texels than the sides need.
    pub fn new(sides: [u32; 2], texels: &[Texel]) -> Result<Self, TextureError> {
        let [width, height] = sides.map(|side| side as usize);
        let (needed, have) = (width.saturating_mul(height), texels.len());
        if have < needed {
            return Err(TextureError::Words { needed, have });
        }
        let (mut bytes, mut error, mut opaque) = (Vec::new(), 0.0, 0);
        for row in (0..height).step_by(SIDE) {
            for column in (0..width).step_by(SIDE) {
                // Beyond a texture that is no block wide or high nothing is asked for.
                let block: Vec<(usize, Texel)> = (0..SIDE * SIDE)
                    .map(|i| (i, column + i % SIDE, row + i / SIDE))
                    .filter(|&(_, x, y)| x < width && y < height)
                    .map(|(i, x, y)| (i, texels[y * width + x]))
                    .collect();
                let found = Block { texels: &block }.best();
                bytes.extend(found.bytes);
                error += found.error;
                opaque += block.iter().filter(|(_, texel)| texel.is_some()).count();
            }
        }
        Compressed::new(&bytes, sides[0], sides[1], |number| number)?;
        Ok(Self {
            sides,
            bytes,
            error: (error / (3 * opaque.max(1)) as f64).sqrt(),
        })
    }
}

/// Texels of a block, by their places in it.
struct Block<'t> {
    texels: &'t [(usize, Texel)],
}

/// A block in 8 bytes, and the sum of squares that its channels are off.
#[derive(Clone, Copy)]
struct Found {
    bytes: [u8; 8],
    error: f64,
}

/// Levels of 5, 6 and 5 bits.
type Levels = [i32; 3];

/// The highest of them.
const MOST: Levels = [31, 63, 31];

impl Block<'_> {
    fn colours(&self) -> impl Iterator<Item = [f64; 3]> {
        let opaque = self.texels.iter().filter_map(|(_, texel)| *texel);
        opaque.map(|rgb| rgb.map(f64::from))
    }

    /// The best that is found.
    fn best(&self) -> Found {
        let mut ends = self.outermost();
        let mut best = self.between(ends);
        loop {
            let tried = neighbours(ends).map(|ends| (self.between(ends), ends));
            let least = tried.min_by(|a, b| a.0.error.total_cmp(&b.0.error));
            match least {
                Some((found, at)) if found.error < best.error => (best, ends) = (found, at),
                _ => return best,
            }
        }
    }

    /// The outermost colours along the axis on which they differ most.
    fn outermost(&self) -> [Levels; 2] {
        let count = self.colours().count().max(1) as f64;
        let mean = [0, 1, 2].map(|i| self.colours().map(|rgb| rgb[i]).sum::<f64>() / count);
        let axis = self.axis(mean);
        let along = |rgb: [f64; 3]| (0..3).map(|i| (rgb[i] - mean[i]) * axis[i]).sum::<f64>();
        let ways = self.colours().map(along);
        let (least, most) = ways.fold((0.0f64, 0.0f64), |(a, b), w| (a.min(w), b.max(w)));
        [most, least].map(|way| {
            [0, 1, 2].map(|i| {
                let level = (mean[i] + way * axis[i]) * f64::from(MOST[i]) / 255.0;
                (level.round() as i32).clamp(0, MOST[i])
            })
        })
    }

    /// The axis of the largest variance, by powers of the covariances.
    fn axis(&self, mean: [f64; 3]) -> [f64; 3] {
        let off = |rgb: [f64; 3]| [0, 1, 2].map(|i| rgb[i] - mean[i]);
        let covariance = |i: usize, k: usize| {
            let products = self.colours().map(off).map(|off| off[i] * off[k]);
            products.sum::<f64>()
        };
        let matrix = [0, 1, 2].map(|i| [0, 1, 2].map(|k| covariance(i, k)));
        let mut axis = [1.0, 1.1, 0.9];
        for _ in 0..16 {
            let next = matrix.map(|row| (0..3).map(|k| row[k] * axis[k]).sum::<f64>());
            let length = next.iter().map(|c| c * c).sum::<f64>().sqrt();
            if length < 1e-9 {
                break;
            }
            axis = next.map(|c| c / length);
        }
        axis
    }

    /// The block with these ends, each texel what is nearest to it.
    fn between(&self, ends: [Levels; 2]) -> Found {
        let [mut first, mut second] = ends.map(|[r, g, b]| (r << 11 | g << 5 | b) as u16);
        let is_holed = self.texels.iter().any(|(_, texel)| texel.is_none());
        // The order says whether there is a transparent index.
        if (first > second) == is_holed {
            (first, second) = (second, first);
        }
        let shown = shown(first, second);
        let opaque = if first > second { 4 } else { 3 };
        let (mut indices, mut error) = (0u32, 0.0);
        for (at, texel) in self.texels {
            let index = match texel {
                None => 3,
                Some(rgb) => {
                    let all = (0..opaque).map(|index| (index, squared(shown[index], *rgb)));
                    let least = all.min_by(|a, b| a.1.total_cmp(&b.1));
                    let (index, off) = least.unwrap_or_default();
                    error += off;
                    index
                }
            };
            indices |= (index as u32) << (2 * at);
        }
        Found {
            bytes: bytes(first, second, indices),
            error,
        }
    }
}

/// Ends of which one, or both, are a step off in one channel.
fn neighbours(ends: [Levels; 2]) -> impl Iterator<Item = [Levels; 2]> {
    let steps = (0..9).filter(|step| *step != 4);
    let all = (0..3).flat_map(move |channel| steps.clone().map(move |step| (channel, step)));
    all.filter_map(move |(channel, step)| {
        let mut moved = ends;
        for (end, by) in moved.iter_mut().zip([step / 3 - 1, step % 3 - 1]) {
            end[channel] += by;
            if !(0..=MOST[channel]).contains(&end[channel]) {
                return None;
            }
        }
        Some(moved)
    })
}

/// A block as it lies in memory.
fn bytes(first: u16, second: u16, indices: u32) -> [u8; 8] {
    let word = u64::from(first) | u64::from(second) << 16 | u64::from(indices) << 32;
    word.to_le_bytes()
}

/// The colours of the four indices between two ends.
fn shown(first: u16, second: u16) -> [[u8; 3]; 4] {
    // The first four texels have an index each.
    let bytes = bytes(first, second, 0b1110_0100);
    [0, 1, 2, 3].map(|column| {
        let block = Compressed::new(&bytes, 4, 4, |number| number);
        Rgb565::to_rgb8(block.map_or(0, |block| block.texel(column, 0)))
    })
}

fn squared(shown: [u8; 3], rgb: [u8; 3]) -> f64 {
    let off = (0..3).map(|i| f64::from(shown[i]) - f64::from(rgb[i]));
    off.map(|off| off * off).sum()
}
