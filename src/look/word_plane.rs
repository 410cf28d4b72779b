//! The plane of [`Method::Word`](super::mapping::Method::Word): both texture coordinates of a small affine triangle in
//! one word.
//!
//! Products have 16 bits a factor, and corners are taken as differences from the first one's.

#[cfg(test)]
use super::mapping::Corner;
use super::mapping::is_affine;
use super::sampling::level_of;
use crate::num::{leading_zeros_here, mul_16, recip_16};
use crate::scene::{Budget, ORIGIN, Texture, TexturePlace, Vertex, Wrap};
use crate::span::{across, down};

/// What [`Method::Word`](super::mapping::Method::Word) asks of a triangle: corners as differences from the first one's, which is kept whole.
#[derive(Clone, Copy, Debug)]
pub struct Near<'a> {
    /// The first corner, as in [`Corner`](super::mapping::Corner).
    pub x: i32,
    pub y: i32,
    /// From there to the second and to the third.
    pub dx: [i32; 2],
    pub dy: [i32; 2],
    pub depth: [u32; 3],
    /// Of the corners.
    pub texture: &'a [TexturePlace; 3],
}

impl<'a> Near<'a> {
    /// Of corners and their places.
    #[inline(always)]
    #[must_use]
    pub fn new([a, b, c]: [&Vertex; 3], texture: &'a [TexturePlace; 3]) -> Self {
        let fine = texture.map(TexturePlace::fine);
        let way = |vertex: &Vertex| vertex.place.wrapping_sub(a.place);
        let (d1, d2) = (way(b), way(c));
        let side = |way: i32, i: usize, axis: usize| 8 * way + (fine[i][axis] - fine[0][axis]);
        const FIRST: i32 = 64 * ORIGIN + 32;
        Self {
            x: 8 * (a.place & 0xFFFF) as i32 + fine[0][0] - FIRST,
            y: 8 * (a.place >> 16) as i32 + fine[0][1] - FIRST,
            dx: [side(across(d1), 1, 0), side(across(d2), 2, 0)],
            dy: [side(down(d1), 1, 1), side(down(d2), 2, 1)],
            depth: [a.depth, b.depth, c.depth],
            texture,
        }
    }

    #[cfg(test)]
    #[must_use]
    pub fn of(corners: &[Corner; 3], texture: &'a [TexturePlace; 3]) -> Self {
        let [a, b, c] = corners;
        Self {
            x: a.x,
            y: a.y,
            dx: [b, c].map(|p| p.x.wrapping_sub(a.x)),
            dy: [b, c].map(|p| p.y.wrapping_sub(a.y)),
            depth: corners.map(|c| c.depth),
            texture,
        }
    }

    /// [`Method::Word`](super::mapping::Method::Word)'s plane, where a triangle may have it: the places of both axes at the picture's first pixel,
    /// and their steps. Of the texture's places so many bits are [spare](Texture::spare).
    #[inline(always)]
    #[must_use]
    pub fn word_plane(&self, texture: &Texture<'_>, spare: u8, budget: Budget) -> Option<[u32; 3]> {
        let Self { x, y, dx, dy, .. } = *self;
        let way = |i: usize| {
            let magnitude = |d: i32| d ^ (d >> 31);
            magnitude(dx[i]).saturating_add(magnitude(dy[i]))
        };
        // Rounded steps stay within 1/20 texel of the place.
        let pixels = if spare > 1 { 50 } else { 25 };
        if way(0).max(way(1)) >= pixels << 6 || spare == 0 || !budget.is_coarse() {
            return None;
        }
        let area = dx[0] * dy[1] - dx[1] * dy[0];
        let texel = self.texture.map(coarse);
        let first = texel[0];
        let rise = |i: usize, axis: usize| texel[i][axis].wrapping_sub(first[axis]);
        let rises = [0, 1].map(|axis| [rise(1, axis), rise(2, axis)]);
        let width = |[e1, e2]: [i32; 2]| (e1.max(e2).max(0)).wrapping_sub(e1.min(e2).min(0)) as u32;
        let width = width(rises[0]).max(width(rises[1]));
        // Two pixels; on thinner ones steps grow.
        if area < 4 << 12
            || width >= 128 << 8
            || !is_affine(width << TexturePlace::FINER, self.depth, budget)
            || texture.wrap() != Wrap::Repeat && !lies_inside(self.texture, texture)
        {
            return None;
        }
        let up = leading_zeros_here(area as u32);
        let r = recip_16((area as u32) << up >> 16) as i32;
        // Sides times 64 / area are these times 2^(up - 44).
        let share = |d: i32| (d * r) << 3;
        let shares = [share(dy[1]), share(-dy[0]), share(dx[0]), share(-dx[1])];
        let at = [x & 63, y & 63];
        let u = one_axis(first[0], rises[0], texture.log_width(), up, shares, at);
        let v = one_axis(first[1], rises[1], texture.log_height(), up, shares, at);
        let both = |i: usize| (v[i] << 16).wrapping_add(u[i]) as u32;
        let (right, below) = (both(1), both(2));
        let at = both(0)
            .wrapping_sub(right.wrapping_mul((x >> 6) as u32))
            .wrapping_sub(below.wrapping_mul((y >> 6) as u32));
        Some([at, right, below])
    }

    /// The same of a texture with levels of detail, and the triangle's level.
    #[must_use]
    pub fn leveled(&self, texture: &Texture<'_>, budget: Budget) -> Option<[u32; 4]> {
        let [at, right, below] = self.word_plane(texture, texture.spare_of_sides(), budget)?;
        Some([at, right, below, self.level(texture.levels())])
    }

    /// The level, of so many below the texture.
    fn level(&self, levels: usize) -> u32 {
        let Self { dx, dy, .. } = *self;
        let [a, b, c] = self.texture.map(coarse);
        let rise = |texel: [i32; 2], axis: usize| texel[axis].wrapping_sub(a[axis]);
        let product = |one: usize, other: usize| rise(b, one).wrapping_mul(rise(c, other));
        let texels = product(0, 1).abs_diff(product(1, 0));
        let pixels = (dx[0] * dy[1] - dx[1] * dy[0]) as u32;
        let [up, pixels_up] = [texels, pixels].map(u32::leading_zeros);
        let (Some(most), Some(pixels)) = (texels.checked_shl(up), pixels.checked_shl(pixels_up))
        else {
            return 0;
        };
        // The one has 16 fraction bits, the other 12.
        let log = pixels_up as i32 - up as i32 - i32::from(most < pixels) - 4;
        level_of(log, levels) as u32
    }
}

/// Texels with 8 fraction bits.
#[inline(always)]
fn coarse(place: TexturePlace) -> [i32; 2] {
    place.texel().map(|texel| texel >> TexturePlace::FINER)
}

/// The place of one axis at the first corner's pixel, and its steps, with `16 - log` fraction bits.
#[inline(always)]
fn one_axis(
    first: i32,
    rise: [i32; 2],
    log: u32,
    up: u32,
    [y2, y1, x1, x2]: [i32; 4],
    [x, y]: [i32; 2],
) -> [i32; 3] {
    let [e1, e2] = rise.map(|e| e as i16);
    // Of 8 fraction bits in a rise; rounded.
    let down = (20 + log).wrapping_sub(up) & 31;
    let half = 1 << down >> 1;
    let right = (half + mul_16(y2, e1) + mul_16(y1, e2)) >> down;
    let below = (half + mul_16(x2, e1) + mul_16(x1, e2)) >> down;
    // Whole pixels apart from the rest: nothing is shifted right after a product has wrapped.
    let rest = 32 - right.wrapping_mul(x) - below.wrapping_mul(y);
    let at = ((first << (8 - log)) & 0xFFFF) + (rest >> 6);
    [at, right, below]
}

/// Whether no place of a triangle comes within 1/8 texel of the texture's rim.
#[inline(never)]
fn lies_inside(places: &[TexturePlace; 3], texture: &Texture<'_>) -> bool {
    let within = |at: i32, side: u32| at >= 32 && at <= (side << 8) as i32 - 32;
    let sides = [texture.width(), texture.height()];
    let mut places = places.iter().map(|&place| coarse(place));
    places.all(|[u, v]| within(u, sides[0]) && within(v, sides[1]))
}
