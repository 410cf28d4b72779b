//! The texture of scene B.

/// Texels a side of [`TEXELS_565`].
pub const TEXEL_SIDE: u32 = 128;
const COUNT: usize = (TEXEL_SIDE * TEXEL_SIDE) as usize;
/// A texture of rings and squares, 5, 6 and 5 bits.
pub static TEXELS_565: [u16; COUNT] = texels_565();

const fn texels_565() -> [u16; COUNT] {
    let mut texels = [0; COUNT];
    let mut i = 0;
    while i < COUNT {
        let (x, y) = (i as u32 % TEXEL_SIDE, i as u32 / TEXEL_SIDE);
        let (dx, dy) = (x.abs_diff(64), y.abs_diff(64));
        let ring = (dx * dx + dy * dy) >> 7 & 31;
        let square = if (x ^ y) & 16 == 0 { 40 } else { 9 };
        texels[i] = (ring << 11 | square << 5 | (x >> 2)) as u16;
        i += 1;
    }
    texels
}
