//! The weighted mean of the four nearest texels (H6), and levels of detail made of means.
//!
//! Four texels are read once for all pixels of a run that lie between them. Instructions a pixel (rustc 1.95, opt-level
//! 3, counted in QEMU) of words that repeat, on a Cortex-M4 and in Cortex-M0+ code: 34 and 49, and 47 and 65 for each
//! four texels (`firmware --profile examples/scene-files/court.json`). In runs of 5 pixels with other texels each it is
//! 94 and 135, all in (`--profile values_sampled`).

use super::fetch::{FRACTION, Way, folded};
use super::tint::Texel;
use crate::scene::{Form, Texture, TextureError, Words, Wrap, half};

/// The fields of a pixel, with five bits between them, and half of 32 parts of each: in the order of numbers, and of a
/// pixel whose bytes are swapped, doubled and turned right by three bits, where green is whole as well.
const fn fields(swapped: bool) -> [u32; 2] {
    if swapped {
        [0x03E0_FC1F, 0x0200_4010]
    } else {
        [0x07E0_F81F, 0x0200_8010]
    }
}

/// The fields of a pixel, apart from each other.
#[inline(always)]
fn apart<const SWAPPED: bool>(word: u16) -> u32 {
    let two = u32::from(word) | u32::from(word) << 16;
    let [fields, _] = const { fields(SWAPPED) };
    two.rotate_right(if SWAPPED { 3 } else { 0 }) & fields
}

/// Sums of fields in 32 parts as a pixel, rounded.
#[inline(always)]
fn joined<const SWAPPED: bool>(sum: u32) -> u16 {
    let [fields, half] = const { fields(SWAPPED) };
    let fields = (sum.wrapping_add(half) >> 5) & fields;
    let two = fields.rotate_left(if SWAPPED { 3 } else { 0 });
    (two | two >> 16) as u16
}

/// The square between the middles of four texels, as sums of fields in 32 parts.
///
/// The product of both weights is rounded to one of these: a 64th of what both diagonals differ by.
struct Square<const SWAPPED: bool> {
    first: u32,
    across: u32,
    below: u32,
    turn: u32,
}

impl<const SWAPPED: bool> Square<SWAPPED> {
    #[inline(always)]
    fn of(four: [u16; 4]) -> Self {
        // Modulo 2^32 no field of the sum is lost, whatever the differences borrow from each other.
        let [a, b, c, d] = four.map(apart::<SWAPPED>);
        let (across, below) = (b.wrapping_sub(a), c.wrapping_sub(a));
        Self {
            first: a << 5,
            across: across << 1,
            below: below << 1,
            turn: d.wrapping_sub(b).wrapping_sub(below),
        }
    }

    /// The right ones with `right` parts of 16, the lower ones with `down`.
    #[inline(always)]
    fn at(&self, right: u32, down: u32) -> u16 {
        let both = self.turn.wrapping_mul((right * down + 4) >> 3);
        let one = self.across.wrapping_mul(right).wrapping_add(self.first);
        let two = self.below.wrapping_mul(down).wrapping_add(one);
        joined::<SWAPPED>(two.wrapping_add(both))
    }
}

/// Four texels, the right ones with `right` parts of 16, the lower ones with `down`.
#[inline(always)]
fn mixed<const SWAPPED: bool>(four: [u16; 4], right: u32, down: u32) -> u16 {
    Square::<SWAPPED>::of(four).at(right, down)
}

/// Columns or rows of a texture.
#[derive(Clone, Copy)]
struct Side {
    base: i32,
    log: u32,
    wrap: Wrap,
}

impl Side {
    /// The first of the two texels about a place, and how many of 16 parts the second one has.
    #[inline(always)]
    fn first(self, at: i32) -> (i32, u32) {
        // Texels lie in the middle of their squares.
        let low = at.wrapping_sub(1 << (FRACTION - 1));
        let part = (low >> (FRACTION - 4)) as u32 & 15;
        ((low >> FRACTION).wrapping_add(self.base), part)
    }

    /// A texel and the one behind it.
    #[inline(always)]
    fn pair(self, first: i32) -> [usize; 2] {
        [first, first.wrapping_add(1)].map(|texel| folded(texel, self.log, self.wrap))
    }
}

/// What a mask says between four texels: their mean alpha, and all else that the nearest one says.
fn mixed_masks(four: [u16; 4], nearest: u16, right: u32, down: u32) -> u16 {
    let [a, b, c, d] = four.map(|word| u32::from(word & 0xFF));
    let (upper, lower) = (a * (16 - right) + b * right, c * (16 - right) + d * right);
    let mean = (upper * (16 - down) + lower * down + 128) >> 8;
    nearest & 0xFF00 | mean as u16
}

/// Copies the weighted means of texels into `run` along `way`, with the texture's wrap.
#[inline(never)]
pub(super) fn copy_linear(run: &mut [u16], texture: &Texture<'_>, way: Way, of: Words) {
    let sides = [texture.log_width(), texture.log_height()];
    let is_plain = texture.wrap() == Wrap::Repeat && texture.key().is_none() && of != Words::Masks;
    let _end = match texture.form {
        // A side of one texel has no bits: nothing is shifted by 32.
        Form::Words(words) if is_plain && !sides.contains(&0) => match of {
            Words::Swapped => copy_repeated::<true>(run, words, sides, way),
            _ => copy_repeated::<false>(run, words, sides, way),
        },
        _ => copy_any(run, texture, way, of),
    };
}

/// From words that repeat, with places as 32-bit fractions of the period; `None` at the end of the run.
#[inline(never)]
fn copy_repeated<const SWAPPED: bool>(
    run: &mut [u16],
    words: &[u16],
    [log_width, log_height]: [u32; 2],
    way: Way,
) -> Option<()> {
    let turn = |texels: i32, log: u32| (texels << (13 - log)) as u32;
    // Texels lie in the middle of their squares.
    let first = |at: i32, base: i32, log: u32| {
        let low = at.wrapping_sub(1 << (FRACTION - 1));
        turn(low.wrapping_add(base << FRACTION), log)
    };
    let mut u = first(way.at.u, way.base[0], log_width);
    let mut v = first(way.at.v, way.base[1], log_height);
    let (du, dv) = (turn(way.step.u, log_width), turn(way.step.v, log_height));
    // With four bits below the texel.
    let (right, down) = (28 - log_width, 28 - log_height);
    let (last, all) = ((1u32 << log_width) - 1, words.len() as u32 - 1);
    let mut pixels = run.iter_mut();
    let (mut across, mut along) = (u >> right, v >> down);
    let mut pixel = pixels.next()?;
    loop {
        let place = [across >> 4, along >> 4];
        let (column, row) = (place[0], place[1] << log_width);
        let (next, below) = ((column + 1) & last, (row + last + 1) & all);
        let texel = |at: u32| words.get(at as usize).copied();
        // One after the other: of four the compiler would keep some in memory.
        let (a, b) = (texel(row | column)?, texel(row | next)?);
        let (c, d) = (texel(below | column)?, texel(below | next)?);
        let square = Square::<SWAPPED>::of([a, b, c, d]);
        // Pixels between the same four texels.
        loop {
            *pixel = square.at(across & 15, along & 15);
            pixel = pixels.next()?;
            u = u.wrapping_add(du);
            v = v.wrapping_add(dv);
            (across, along) = (u >> right, v >> down);
            if [across >> 4, along >> 4] != place {
                break;
            }
        }
    }
}

/// From any form and size, with any wrap, with holes or without; `None` at the end of the run.
#[inline(never)]
fn copy_any(run: &mut [u16], texture: &Texture<'_>, way: Way, of: Words) -> Option<()> {
    let wrap = texture.wrap();
    let side = |base: i32, log: u32| Side { base, log, wrap };
    let columns = side(way.base[0], texture.log_width());
    let rows = side(way.base[1], texture.log_height());
    let order = |word: u16| match of {
        Words::Swapped => word.swap_bytes(),
        _ => word,
    };
    let mut at = way.at;
    let mut pixels = run.iter_mut();
    let (mut column, mut across) = columns.first(at.u);
    let (mut row, mut down) = rows.first(at.v);
    let mut pixel = pixels.next()?;
    loop {
        let place = [column, row];
        let ([left, right], [upper, lower]) = (columns.pair(column), rows.pair(row));
        let texel = |column, row: usize| texture.form.get(row << texture.log_width() | column);
        let (a, b) = (texel(left, upper)?, texel(right, upper)?);
        let four = [a, b, texel(left, lower)?, texel(right, lower)?];
        // Pixels between the same four texels.
        loop {
            let mean = |four: [u16; 4]| order(mixed::<false>(four.map(order), across, down));
            let nearest = four[usize::from(across >= 8) + 2 * usize::from(down >= 8)];
            *pixel = match texture.key() {
                _ if of == Words::Masks => mixed_masks(four, nearest, across, down),
                None => mean(four),
                Some(key) => opaque(four, nearest, key, mean),
            };
            pixel = pixels.next()?;
            at = at.plus(way.step);
            (column, across) = columns.first(at.u);
            (row, down) = rows.first(at.v);
            if [column, row] != place {
                break;
            }
        }
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
            let texel = texture.form.get(place[1] << texture.log_width() | place[0]);
            texel.unwrap_or_default()
        };
        *word = mean::<F>([at(0, 0), at(1, 0), at(0, 1), at(1, 1)], texture.key());
    }
    let level = Texture::words(words, width, height)?.wrapping(texture.wrap());
    Ok(texture.key().map_or(level, |key| level.keyed(key)))
}

/// The mean of four texels.
fn mean<F: Texel>(four: [u16; 4], key: Option<u16>) -> u16 {
    let mean = |four: [u16; 4]| F::ordered(mixed::<false>(four.map(F::ordered), 8, 8));
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

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    /// Steps of red, green and blue.
    fn steps(word: u16) -> [f64; 3] {
        [word >> 11, word >> 5 & 63, word & 31].map(f64::from)
    }

    /// Kills: weights that are rounded more than the product of both is, and fields that reach into each other.
    #[test]
    fn means_are_as_near_to_exact_as_is_said() {
        let mut rng = Rng(7);
        let mut worst = 0.0f64;
        for round in 0..3_000 {
            // Of the first, each field is none or all.
            let mut texel = || match round {
                0..1_000 => [0, 0xFFFF, 0xF81F, 0x07E0][rng.below(4) as usize],
                _ => rng.below(1 << 16) as u16,
            };
            let four = [texel(), texel(), texel(), texel()];
            for place in 0..256 {
                let (right, down) = (place % 16, place / 16);
                let swapped = mixed::<true>(four.map(u16::swap_bytes), right, down);
                let got = mixed::<false>(four, right, down);
                assert_eq!(swapped.swap_bytes(), got, "{four:x?} {right} {down}");
                let [r, d] = [right, down].map(|part| f64::from(part) / 16.0);
                let weights = [(1.0 - r) * (1.0 - d), r * (1.0 - d), (1.0 - r) * d, r * d];
                for channel in 0..3 {
                    let texels = four.map(|texel| steps(texel)[channel]);
                    let mean: f64 = texels.iter().zip(weights).map(|(t, w)| t * w).sum();
                    let [a, b, c, d] = texels;
                    let off = (steps(got)[channel] - mean).abs();
                    let bound = 0.5 + (a + d - b - c).abs() / 64.0;
                    assert!(off <= bound, "{off} of {bound}: {texels:?} {right} {down}");
                    worst = worst.max(off);
                }
            }
        }
        assert!(worst > 2.0, "{worst}");
    }
}
