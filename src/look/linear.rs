//! The weighted mean of the four nearest texels (H6), and levels of detail made of means.

use super::fetch::{FRACTION, Way};
use super::tint::Texel;
use crate::scene::{Form, Texture, TextureError, Wrap, half};

/// The fields of a pixel, with five bits between them.
const FIELDS: u32 = 0x07E0_F81F;
/// Half of 32 parts of each field.
const HALF: u32 = 0x0200_8010;

/// The fields of a pixel in the order of numbers, apart from each other.
#[inline(always)]
fn apart(word: u16) -> u32 {
    (u32::from(word) | u32::from(word) << 16) & FIELDS
}

/// Sums of fields in 32 parts as a pixel, rounded.
#[inline(always)]
fn joined(sum: u32) -> u16 {
    let fields = (sum.wrapping_add(HALF) >> 5) & FIELDS;
    (fields | fields >> 16) as u16
}

/// Four texels, the right ones with `right` parts of 16, the lower ones with `down`.
#[inline(always)]
fn mixed(four: [u16; 4], right: u32, down: u32) -> u16 {
    let both = (right * down + 4) >> 3;
    let weights = [
        32 + both - 2 * right - 2 * down,
        2 * right - both,
        2 * down - both,
        both,
    ];
    let parts = four.into_iter().zip(weights);
    joined(parts.fold(0, |sum, (texel, weight)| sum + apart(texel) * weight))
}

/// Columns or rows of a texture.
#[derive(Clone, Copy)]
struct Side {
    base: i32,
    log: u32,
    wrap: Wrap,
}

impl Side {
    /// The two texels about a place, and how many of 16 parts the second one has.
    #[inline(always)]
    fn pair(self, at: i32) -> ([usize; 2], u32) {
        // Texels lie in the middle of their squares.
        let low = at.wrapping_sub(1 << (FRACTION - 1));
        let first = (low >> FRACTION).wrapping_add(self.base);
        let part = (low >> (FRACTION - 4)) as u32 & 15;
        (
            [first, first.wrapping_add(1)].map(|texel| self.folded(texel)),
            part,
        )
    }

    /// What the wrap shows for any texel.
    #[inline(always)]
    fn folded(self, texel: i32) -> usize {
        let last = (1 << self.log) - 1;
        let texel = match self.wrap {
            Wrap::Repeat => texel,
            Wrap::Clamp => texel.clamp(0, last),
            Wrap::Mirror if texel >> self.log & 1 != 0 => !texel,
            Wrap::Mirror => texel,
        };
        (texel & last) as usize
    }
}

/// Copies the weighted means of texels into `run` along `way`, with the texture's wrap; `is_swapped` where texels have
/// their bytes in the other order than numbers.
#[inline(never)]
pub(super) fn copy_linear(run: &mut [u16], texture: &Texture<'_>, way: Way, is_swapped: bool) {
    let form = texture.form;
    match form {
        Form::Words(words) => each(run, texture, way, is_swapped, |i| words.get(i).copied()),
        _ => each(run, texture, way, is_swapped, |i| form.get(i)),
    }
}

#[inline(always)]
fn each(
    run: &mut [u16],
    texture: &Texture<'_>,
    way: Way,
    is_swapped: bool,
    texel: impl Fn(usize) -> Option<u16>,
) {
    let wrap = texture.wrap();
    let side = |base: i32, log: u32| Side { base, log, wrap };
    let columns = side(way.base[0], texture.log_width());
    let rows = side(way.base[1], texture.log_height());
    let order = |word: u16| if is_swapped { word.swap_bytes() } else { word };
    let mut at = way.at;
    for pixel in run {
        let ([left, right], across) = columns.pair(at.u);
        let ([upper, lower], down) = rows.pair(at.v);
        let texel = |column: usize, row: usize| texel(row << texture.log_width() | column);
        let (Some(a), Some(b), Some(c), Some(d)) = (
            texel(left, upper),
            texel(right, upper),
            texel(left, lower),
            texel(right, lower),
        ) else {
            return;
        };
        let four = [a, b, c, d];
        *pixel = match texture.key() {
            None => order(mixed(four.map(order), across, down)),
            Some(key) => {
                let nearest = four[usize::from(across >= 8) + 2 * usize::from(down >= 8)];
                opaque(four, nearest, key, |four| {
                    order(mixed(four.map(order), across, down))
                })
            }
        };
        at = at.plus(way.step);
    }
}

/// The mean of those that are opaque, the nearest in place of the others; the key where that is the nearest, and
/// nowhere else.
#[inline(never)]
fn opaque(four: [u16; 4], nearest: u16, key: u16, mean: impl Fn([u16; 4]) -> u16) -> u16 {
    if nearest == key {
        return key;
    }
    let mean = mean(four.map(|texel| if texel == key { nearest } else { texel }));
    if mean == key { nearest } else { mean }
}

/// The level of detail below a texture, for panels of the format `F`: means of two by two texels, rounded, in the words
/// lent, of which as many are used as it has texels. It has the texture's wrap and key; a texel is transparent where two
/// of four are.
///
/// # Errors
/// Fewer words than it has texels, or a texture of one texel.
pub fn halved<'w, F: Texel>(
    texture: &Texture<'_>,
    words: &'w mut [u16],
) -> Result<Texture<'w>, TextureError> {
    let (width, height) = (half(texture.width()), half(texture.height()));
    let (needed, have) = ((width * height) as usize, words.len());
    if texture.width() * texture.height() == 1 {
        return Err(TextureError::Level {
            level: 1,
            width,
            height,
        });
    }
    let words = words
        .get_mut(..needed)
        .ok_or(TextureError::Words { needed, have })?;
    let right = usize::from(texture.width() > 1);
    let down = usize::from(texture.height() > 1);
    for (i, word) in words.iter_mut().enumerate() {
        let (column, row) = (i % width as usize, i / width as usize);
        let at = |dx: usize, dy: usize| {
            let place = [column << right | dx & right, row << down | dy & down];
            texture
                .form
                .get(place[1] << texture.log_width() | place[0])
                .unwrap_or_default()
        };
        *word = mean::<F>([at(0, 0), at(1, 0), at(0, 1), at(1, 1)], texture.key());
    }
    let level = Texture::words(words, width, height)?.wrapping(texture.wrap());
    Ok(match texture.key() {
        Some(key) => level.keyed(key),
        None => level,
    })
}

/// The mean of four texels.
fn mean<F: Texel>(four: [u16; 4], key: Option<u16>) -> u16 {
    let mean = |four: [u16; 4]| F::ordered(mixed(four.map(F::ordered), 8, 8));
    let Some(key) = key else {
        return mean(four);
    };
    let shown = four.iter().find(|&&texel| texel != key);
    match shown {
        Some(&first) if four.iter().filter(|&&texel| texel == key).count() < 2 => {
            opaque(four, first, key, mean)
        }
        _ => key,
    }
}
