//! Pictures as textures: PNG and PPM of any size, and those that a model's materials name.
//!
//! Sides must be powers of two up to 1024 (H4), so another picture is resized to the next power
//! of two, and a note says so. Growing is linear between pixels, shrinking averages what falls on
//! a pixel; both in `f64`, once, on the host. Rows are those of the picture, from its top: the
//! place (0, 0) of OBJ, the lower left corner, is the last row.

use crate::image_out::{Cutout, Frame, ImageError, read_cutout};
use crate::model::Model;
use scanbeam::scene::{Texture, TextureError};
use std::collections::BTreeMap;
use std::path::{Path, PathBuf};

/// Why a picture cannot be a texture.
#[derive(Debug, Clone, PartialEq, Eq, thiserror::Error)]
pub enum TextureFileError {
    /// The file cannot be read, or is no picture.
    #[error("texture {0}")]
    Image(#[from] ImageError),
    /// The core refuses it.
    #[error("{}: {error}", file.display())]
    Texture {
        /// The picture.
        file: PathBuf,
        /// What the core said.
        error: TextureError,
    },
    /// A picture that a material names, which is one of the others.
    #[error("{}:{line}: {error}", file.display())]
    Material {
        /// The material file.
        file: PathBuf,
        /// Its line, from 1.
        line: usize,
        /// What is wrong with the picture.
        error: Box<Self>,
    },
}

/// Levels of detail that a picture is given, itself the first.
pub const LEVELS: usize = 4;

/// A texture in host memory, with its levels of detail.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureImage {
    /// Texels a line of the picture: a power of two.
    pub width: u32,
    /// Lines of the picture: a power of two.
    pub height: u32,
    /// Texels of each level, 8 bits a channel, rows from the top: the picture, then three averages.
    pub levels: [Vec<[u8; 3]>; LEVELS],
    /// Alphas of the picture's texels, where not all are opaque.
    pub alpha: Option<Vec<u8>>,
    /// What was done to the picture, for the user.
    pub note: Option<String>,
}

impl TextureImage {
    /// Reads a picture and makes a texture of it.
    ///
    /// # Errors
    /// When the file cannot be read or is no PNG or PPM.
    pub fn load(path: &Path) -> Result<Self, TextureFileError> {
        let picture = read_cutout(path)?;
        let mut made = Self::of(&picture).map_err(|error| TextureFileError::Texture {
            file: path.to_path_buf(),
            error,
        })?;
        if let Some(note) = &mut made.note {
            *note = format!("{}: {note}", path.display());
        }
        Ok(made)
    }

    /// Makes a texture of a picture of any size.
    ///
    /// # Errors
    /// A picture without pixels.
    pub fn new(frame: &Frame) -> Result<Self, TextureError> {
        Self::of(&frame.clone().into())
    }

    /// The same, with its alphas.
    ///
    /// # Errors
    /// A picture without pixels.
    pub fn of(picture: &Cutout) -> Result<Self, TextureError> {
        let frame = &picture.frame;
        let side = |n: u32| n.next_power_of_two().min(Texture::MAX_SIDE);
        let (width, height) = (side(frame.width()), side(frame.height()));
        if frame.width() == 0 || frame.height() == 0 {
            let (width, height) = (frame.width(), frame.height());
            return Err(TextureError::Side { width, height });
        }
        let note = ((width, height) != (frame.width(), frame.height())).then(|| {
            format!(
                "resized from {}x{} to {width}x{height}: sides of textures are powers of two up to {}",
                frame.width(),
                frame.height(),
                Texture::MAX_SIDE
            )
        });
        let (from, to) = ([frame.width(), frame.height()], [width, height]);
        let full = resized(from, to, |x, y| {
            frame.pixel(x as u32, y as u32).unwrap_or_default()
        });
        let alpha = picture.alpha.as_ref().map(|alpha| {
            let at = |x: usize, y: usize| alpha.get(y * from[0] as usize + x).copied();
            let texels = resized(from, to, |x, y| [at(x, y).unwrap_or(255)]);
            texels.into_iter().flatten().collect()
        });
        let mut made = Self {
            width,
            height,
            levels: [full, Vec::new(), Vec::new(), Vec::new()],
            alpha,
            note,
        };
        for level in 1..LEVELS {
            made.levels[level] = halved(&made.levels[level - 1], made.sides(level - 1));
        }
        Ok(made)
    }

    /// One of these sides, which are powers of two, that stands for texels without a picture.
    #[must_use]
    pub fn blank([width, height]: [u32; 2]) -> Self {
        Self {
            width,
            height,
            levels: std::array::from_fn(|_| Vec::new()),
            alpha: None,
            note: None,
        }
    }

    /// The same levels with alphas, as many as are asked for: of four texels the mean of the alphas, and of the colours by
    /// their alphas, so that what is not seen of a picture is not seen in its levels.
    #[must_use]
    pub fn levels_with_alpha(&self, count: usize) -> Vec<Vec<[u8; 4]>> {
        let with = |(texel, [r, g, b]): (usize, &[u8; 3])| {
            let alpha = self.alpha.as_ref().and_then(|alpha| alpha.get(texel));
            [*r, *g, *b, alpha.copied().unwrap_or(255)]
        };
        let full = self.levels[0].iter().enumerate().map(with);
        let mut levels: Vec<Vec<[u8; 4]>> = vec![full.collect()];
        for level in 1..count.min(LEVELS) {
            let above = fours(self.sides(level - 1)).map(|four| {
                let four = four.map(|at| levels[level - 1][at].map(u32::from));
                let alpha: u32 = four.iter().map(|texel| texel[3]).sum();
                let weight = |texel: &[u32; 4]| if alpha == 0 { 1 } else { texel[3] };
                let all: u32 = four.iter().map(weight).sum();
                let mean = |i: usize| {
                    let sum: u32 = four.iter().map(|texel| texel[i] * weight(texel)).sum();
                    ((2 * sum + all) / (2 * all)) as u8
                };
                [mean(0), mean(1), mean(2), ((alpha + 2) >> 2) as u8]
            });
            let below = above.collect();
            levels.push(below);
        }
        levels
    }

    /// Columns and lines of a level.
    #[must_use]
    pub fn sides(&self, level: usize) -> [u32; 2] {
        [self.width, self.height].map(|side| (side >> level).max(1))
    }

    /// Texels with 8 fraction bits from a place of OBJ: (0, 0) at the lower left, 1 a side.
    #[must_use]
    pub fn texels(&self, [u, v]: [f64; 2]) -> (i32, i32) {
        let fix = |part: f64, side: u32| (part * f64::from(side) * 256.0).round() as i32;
        (fix(u, self.width), fix(1.0 - v, self.height))
    }
}

/// The pixels of a picture of another size: of each channel what falls on them, rounded.
fn resized<const N: usize>(
    from: [u32; 2],
    to: [u32; 2],
    pixel: impl Fn(usize, usize) -> [u8; N],
) -> Vec<[u8; N]> {
    let [across, down] = [0, 1].map(|axis| resampling(from[axis], to[axis]));
    let mut all = Vec::with_capacity(across.len() * down.len());
    for rows in &down {
        for columns in &across {
            let mut sum = [0.0; N];
            for (y, dy) in rows {
                for (x, dx) in columns {
                    for (sum, level) in sum.iter_mut().zip(pixel(*x, *y)) {
                        *sum += f64::from(level) * dx * dy;
                    }
                }
            }
            all.push(sum.map(|level| (level + 0.5) as u8));
        }
    }
    all
}

/// For each texel of the level below one with these sides, the four of that: of one column or line, two, each twice.
fn fours(sides: [u32; 2]) -> impl Iterator<Item = [usize; 4]> {
    let [width, height] = sides.map(|side| side as usize);
    let [columns, lines] = [width, height].map(|side| (side / 2).max(1));
    // Twice the place where the side is halved, and the texel beside it.
    let at = |place: usize, step: usize, side: usize| match side {
        1 => place,
        _ => 2 * place + step,
    };
    (0..columns * lines).map(move |i| {
        let (x, y) = (i % columns, i / columns);
        [(0, 0), (1, 0), (0, 1), (1, 1)]
            .map(|(dx, dy)| at(y, dy, height) * width + at(x, dx, width))
    })
}

/// The level below one with these sides: of four texels the mean, halves up.
fn halved(above: &[[u8; 3]], sides: [u32; 2]) -> Vec<[u8; 3]> {
    let mean = |four: [usize; 4]| {
        [0, 1, 2].map(|c| {
            let sum: u16 = four.iter().map(|at| u16::from(above[*at][c])).sum();
            ((sum + 2) >> 2) as u8
        })
    };
    fours(sides).map(mean).collect()
}

/// For each of `to` places, which of `from` places count, and by how much; the parts add up to 1.
fn resampling(from: u32, to: u32) -> Vec<Vec<(usize, f64)>> {
    let scale = f64::from(from) / f64::from(to);
    let last = from as usize - 1;
    (0..to)
        .map(|place| {
            let place = f64::from(place);
            if scale > 1.0 {
                // What falls on the place.
                let (low, high) = (place * scale, (place + 1.0) * scale);
                (low as usize..=(high.ceil() as usize - 1).min(last))
                    .map(|i| {
                        let part = (high.min(i as f64 + 1.0) - low.max(i as f64)) / scale;
                        (i, part)
                    })
                    .collect()
            } else {
                let at = ((place + 0.5) * scale - 0.5).max(0.0);
                let low = (at as usize).min(last);
                let part = at - low as f64;
                vec![(low, 1.0 - part), ((low + 1).min(last), part)]
            }
        })
        .collect()
}

/// The textures that a model's materials name: one for each material, each file read once.
///
/// # Errors
/// The first picture that cannot be read.
pub fn of_materials(model: &Model) -> Result<Vec<Option<TextureImage>>, TextureFileError> {
    let mut read: BTreeMap<&Path, TextureImage> = BTreeMap::new();
    let mut textures = Vec::new();
    for material in &model.materials {
        let Some(path) = &material.map_kd else {
            textures.push(None);
            continue;
        };
        if !read.contains_key(path.as_path()) {
            let image = TextureImage::load(path).map_err(|error| match &material.map_kd_at {
                Some((file, line)) => TextureFileError::Material {
                    file: file.clone(),
                    line: *line,
                    error: error.into(),
                },
                None => error,
            })?;
            read.insert(path, image);
        }
        textures.push(read.get(path.as_path()).cloned());
    }
    Ok(textures)
}
