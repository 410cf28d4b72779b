//! Pictures into textures of a list: the form of texel that takes the fewest bytes and keeps the
//! error asked for, and its palette (H7).
//!
//! A palette begins as boxes of colours: the box with the largest squared error is split at its
//! mean, across its widest channel, until there are enough, and then each colour moves to the mean
//! of the texels that are nearest to it, a few times. With enough colours for all it is exact.

use crate::image_out::Frame;
use crate::lists::writer::{ListWriter, WriteError};
use crate::texture_file::TextureImage;
use scanbeam::list::{Palette, State, TexelForm, Texture};
use scanbeam::scene::TextureError;
use std::collections::BTreeMap;

/// Forms that a palette goes with, and how many colours it can have.
const INDEXED: [(TexelForm, usize); 4] = [
    (TexelForm::Index1, 2),
    (TexelForm::Index2, 4),
    (TexelForm::Index4, 16),
    (TexelForm::Index8, 256),
];
/// Times that the colours of a palette move.
const ROUNDS: usize = 6;

/// A picture for surfaces, as it was read.
#[derive(Debug, Clone, PartialEq)]
pub struct Picture {
    /// Its texels.
    pub image: TextureImage,
    /// Its edges go on outside; else it repeats.
    pub clamped: bool,
}

impl Picture {
    /// A picture that repeats.
    ///
    /// # Errors
    /// When it cannot be a texture.
    pub fn new(frame: &Frame) -> Result<Self, TextureError> {
        Ok(Self {
            image: TextureImage::new(frame)?,
            clamped: false,
        })
    }
}

/// A texture as a list has it.
#[derive(Debug, Clone, PartialEq)]
pub struct Texels {
    /// Binary logarithms of width and height.
    pub log_sides: [u8; 2],
    /// Form of a texel.
    pub form: TexelForm,
    /// Texels, row by row from the top, lowest bits first.
    pub words: Vec<u32>,
    /// Colours, for the forms that need some.
    pub palette: Vec<u32>,
    /// The edges go on outside.
    pub clamped: bool,
    /// Root of the mean square that a channel is off, in levels of 255.
    pub error: f64,
}

impl Texels {
    /// The picture in the form of the fewest bytes whose error is at most `allowed`.
    #[must_use]
    pub fn new(picture: &Picture, allowed: f64) -> Self {
        let image = &picture.image;
        let log_sides = [image.width, image.height].map(|side| side.ilog2() as u8);
        let texels = &image.levels[0];
        let counts = counted(texels);
        let made = |form, colours: &[[u8; 3]]| {
            let (codes, error) = coded(&counts, form, colours);
            let code = |texel: &[u8; 3]| {
                let at = counts.binary_search_by_key(texel, |entry| entry.0);
                at.map_or(0, |at| codes[at])
            };
            Self {
                log_sides,
                form,
                words: packed(form, texels.iter().map(code)),
                palette: colours
                    .iter()
                    .map(|[r, g, b]| u32::from_le_bytes([*r, *g, *b, 255]))
                    .collect(),
                clamped: picture.clamped,
                error,
            }
        };
        // By bytes: a palette can take more than its texels save.
        let mut tried: Vec<(usize, TexelForm, Vec<[u8; 3]>)> = Vec::new();
        for (form, most) in INDEXED {
            let colours = palette(&counts, most);
            let exact = colours.len() == counts.len();
            tried.push((bytes(form, texels.len(), colours.len()), form, colours));
            if exact {
                break;
            }
        }
        for form in [TexelForm::Rgb565, TexelForm::Rgb888] {
            tried.push((bytes(form, texels.len(), 0), form, Vec::new()));
        }
        tried.sort_by_key(|t| t.0);
        tried
            .iter()
            .map(|(_, form, colours)| made(*form, colours))
            .find(|texels| texels.error <= allowed)
            .unwrap_or_else(|| made(TexelForm::Rgb888, &[]))
    }

    /// Bytes of texels and palette.
    #[must_use]
    pub fn bytes(&self) -> usize {
        4 * (self.words.len() + self.palette.len())
    }

    /// Writes it under a number, with its palette under the same one.
    pub(super) fn write(&self, out: &mut ListWriter<'_>, number: u8) -> Result<(), WriteError> {
        if !self.palette.is_empty() {
            let palette = Palette {
                number,
                count: self.palette.len() as u16,
                at: 0,
            };
            out.bulk(&State::Palette(palette), &self.palette)?;
        }
        let texture = Texture {
            number,
            log_width: self.log_sides[0],
            log_height: self.log_sides[1],
            form: self.form,
            levels: 1,
            palette: if self.palette.is_empty() { 0 } else { number },
            clamped: self.clamped,
            at: 0,
        };
        out.bulk(&State::Texture(texture), &self.words)
    }
}

/// Bytes that so many texels of a form take, with so many colours of a palette.
#[must_use]
pub fn bytes(form: TexelForm, texels: usize, colours: usize) -> usize {
    4 * ((form.bits() as usize * texels).div_ceil(32) + colours)
}

/// Fields of a form into words, lowest bits first.
fn packed(form: TexelForm, codes: impl Iterator<Item = u32>) -> Vec<u32> {
    let mut words = Vec::new();
    let (mut word, mut used) = (0u64, 0);
    for code in codes {
        word |= u64::from(code) << used;
        used += form.bits();
        if used >= 32 {
            words.push(word as u32);
            word >>= 32;
            used -= 32;
        }
    }
    if used > 0 {
        words.push(word as u32);
    }
    words
}

/// How far two colours are from each other, squared.
#[must_use]
pub fn squared(a: [u8; 3], b: [u8; 3]) -> u32 {
    (0..3)
        .map(|i| {
            let d = u32::from(a[i].abs_diff(b[i]));
            d * d
        })
        .sum()
}

/// What each colour becomes in a form, and the error over all texels.
fn coded(counts: &[([u8; 3], u64)], form: TexelForm, colours: &[[u8; 3]]) -> (Vec<u32>, f64) {
    let (mut sum, mut all) = (0.0, 0);
    let codes = counts
        .iter()
        .map(|(rgb, count)| {
            let (code, shown) = match form {
                TexelForm::Rgb565 => {
                    let field = |v: u8, most: u32| (u32::from(v) * most + 127) / 255;
                    let [r, g, b] = [field(rgb[0], 31), field(rgb[1], 63), field(rgb[2], 31)];
                    let shown = [r << 3 | r >> 2, g << 2 | g >> 4, b << 3 | b >> 2];
                    (r << 11 | g << 5 | b, shown.map(|v| v as u8))
                }
                TexelForm::Rgb888 => {
                    let [r, g, b] = *rgb;
                    (u32::from_le_bytes([r, g, b, 0]), *rgb)
                }
                _ => {
                    let near = nearest(colours, *rgb);
                    (near as u32, colours[near])
                }
            };
            sum += f64::from(squared(shown, *rgb)) * *count as f64;
            all += count;
            code
        })
        .collect();
    (codes, (sum / (3 * all.max(1)) as f64).sqrt())
}

fn nearest(colours: &[[u8; 3]], rgb: [u8; 3]) -> usize {
    let distance = |(_, colour): &(usize, &[u8; 3])| squared(**colour, rgb);
    let best = colours.iter().enumerate().min_by_key(distance);
    best.map_or(0, |(at, _)| at)
}

/// Each texel by the nearest of at most so many colours, as a palette of a list has them.
#[must_use]
pub fn in_colours(texels: &[[u8; 3]], most: usize) -> Vec<[u8; 3]> {
    let colours = palette(&counted(texels), most);
    let shown = texels.iter().map(|texel| nearest(&colours, *texel));
    shown.filter_map(|at| colours.get(at).copied()).collect()
}

/// Colours in order, and how often each is there.
fn counted(texels: &[[u8; 3]]) -> Vec<([u8; 3], u64)> {
    let mut counts: BTreeMap<[u8; 3], u64> = BTreeMap::new();
    for texel in texels {
        *counts.entry(*texel).or_default() += 1;
    }
    counts.into_iter().collect()
}

/// Colours, each as often as it is there, and their moments.
struct Cluster<'a> {
    colours: &'a mut [([u8; 3], u64)],
    mean: [f64; 3],
    /// The sum of squares around the mean, by channel.
    spread: [f64; 3],
}

impl<'a> Cluster<'a> {
    fn new(colours: &'a mut [([u8; 3], u64)]) -> Self {
        let (mut count, mut sum, mut squares) = (0.0, [0.0; 3], [0.0; 3]);
        for (rgb, n) in colours.iter() {
            count += *n as f64;
            for i in 0..3 {
                let level = f64::from(rgb[i]);
                sum[i] += level * *n as f64;
                squares[i] += level * level * *n as f64;
            }
        }
        let mean = sum.map(|s| s / f64::max(count, 1.0));
        Self {
            spread: [0, 1, 2].map(|i| squares[i] - mean[i] * sum[i]),
            colours,
            mean,
        }
    }

    fn error(&self) -> f64 {
        self.spread.iter().sum()
    }

    fn split(self) -> (Self, Self) {
        let widest = |a: &usize, b: &usize| self.spread[*a].total_cmp(&self.spread[*b]);
        let channel = (0..3).max_by(widest).unwrap_or(0);
        self.colours
            .sort_unstable_by_key(|(rgb, _)| (rgb[channel], *rgb));
        let below = |(rgb, _): &([u8; 3], u64)| f64::from(rgb[channel]) <= self.mean[channel];
        // Neither side is empty, rounding or not.
        let at = self.colours.partition_point(below);
        let (low, high) = self
            .colours
            .split_at_mut(at.clamp(1, self.colours.len() - 1));
        (Cluster::new(low), Cluster::new(high))
    }
}

/// At most so many colours that stand for all; all of them where that is enough.
fn palette(counts: &[([u8; 3], u64)], most: usize) -> Vec<[u8; 3]> {
    if counts.len() <= most {
        return counts.iter().map(|entry| entry.0).collect();
    }
    let mut sorted = counts.to_vec();
    let mut boxes = vec![Cluster::new(&mut sorted)];
    while boxes.len() < most {
        let by_error = |a: &(usize, &Cluster<'_>), b: &(usize, &Cluster<'_>)| {
            a.1.error().total_cmp(&b.1.error())
        };
        let parted = |(_, b): &(usize, &Cluster<'_>)| b.colours.len() > 1;
        let worst = boxes.iter().enumerate().filter(parted).max_by(by_error);
        let Some((worst, _)) = worst else { break };
        let (low, high) = boxes.swap_remove(worst).split();
        boxes.extend([low, high]);
    }
    let level = |mean: [f64; 3]| mean.map(|v| v.round() as u8);
    let mut colours: Vec<[u8; 3]> = boxes.iter().map(|b| level(b.mean)).collect();
    for _ in 0..ROUNDS {
        let mut sums = vec![([0.0; 3], 0.0); colours.len()];
        for (rgb, count) in counts {
            let (sum, all) = &mut sums[nearest(&colours, *rgb)];
            for (sum, level) in sum.iter_mut().zip(rgb) {
                *sum += f64::from(*level) * *count as f64;
            }
            *all += *count as f64;
        }
        let mut moved = false;
        for (colour, (sum, all)) in colours.iter_mut().zip(sums) {
            // A colour that nothing is nearest to stays.
            let new = if all > 0.0 {
                level(sum.map(|s| s / all))
            } else {
                *colour
            };
            moved |= new != *colour;
            *colour = new;
        }
        if !moved {
            break;
        }
    }
    colours.sort_unstable();
    colours.dedup();
    colours
}
