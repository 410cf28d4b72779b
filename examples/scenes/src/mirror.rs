//! Surroundings as a ball shows them: a sky with a sun above ground in squares.

use scanbeam::scene::Texture;

const SIDE: usize = 64;

/// The texels of [`SURROUNDINGS`], as an SPI panel takes them.
static TEXELS: [u16; SIDE * SIDE] = {
    let mut texels = [0; SIDE * SIDE];
    let mut i = 0;
    while i < texels.len() {
        texels[i] = texel((i % SIDE) as i32, (i / SIDE) as i32).to_be();
        i += 1;
    }
    texels
};

const fn word(red: i32, green: i32, blue: i32) -> u16 {
    (red << 11 | green << 5 | blue) as u16
}

const fn texel(column: i32, row: i32) -> u16 {
    // From the middle to the right and up, in half texels.
    let (x, y) = (2 * column - 63, 63 - 2 * row);
    let (sun_x, sun_y) = (x - 20, y - 32);
    if sun_x * sun_x + sun_y * sun_y < 70 {
        return word(31, 63, 28);
    }
    if y >= 0 {
        return word(22 - y / 3, 54 - y / 2, 31);
    }
    // Squares that are smaller towards the horizon.
    let far = 64 + y;
    let (a, b) = ((x + 64) * 4 / (4 - y / 4), far * far / 500);
    if (a + b) % 2 == 0 {
        word(18, 26, 8)
    } else {
        word(9, 12 + far / 8, 5)
    }
}

/// A sphere map.
pub static SURROUNDINGS: Texture<'static> = match Texture::words(&TEXELS, SIDE as u32, SIDE as u32)
{
    Ok(texture) => texture,
    Err(_) => panic!("as many texels as the sides need"),
};
