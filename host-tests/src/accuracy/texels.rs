//! Texels of 4 bits: how far those of palettes and of blocks are off the picture that they are made of, and what a pixel
//! of each takes (H7). What they gain is memory, a quarter of that of words, so no row of theirs is on the frontier.

use super::stage::Done;
use super::{Errors, Row};
use crate::compress::{Blocks, Texel, samples};
use crate::image_out::decode_image;
use crate::lists::texels::in_colours;
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::{Compressed, Texels};

const FAMILY: &str = "texels";
const UNIT: &str = "levels";

/// How texels are kept, with the firmware's kernel.
#[derive(Clone, Copy)]
enum Way {
    Words,
    Palette,
    Blocks,
}

const WAYS: [(&str, Way, &str); 4] = [
    ("words of 16 bits", Way::Words, "texel_565_large"),
    ("16 colours, 4 bits", Way::Palette, "texel_index4_565_large"),
    (
        "compressed, 4 bits",
        Way::Blocks,
        "texel_compressed_565_large",
    ),
    (
        "compressed, 4 bits, through a cache",
        Way::Blocks,
        "texel_cached_565_large",
    ),
];

pub(super) fn rows() -> Done<Vec<Row>> {
    let mut rows = Vec::new();
    for (case, texels) in [
        ("stone", samples::stone()),
        ("all hues", samples::hues()),
        ("teapot", teapot()?),
    ] {
        let opaque: Vec<[u8; 3]> = texels.iter().copied().flatten().collect();
        for (method, way, kernel) in WAYS {
            let mut errors = Errors::default();
            for (texel, shown) in opaque.iter().zip(way.shown(&opaque)?) {
                for (level, shown) in texel.iter().zip(shown) {
                    errors.push(f64::from(level.abs_diff(shown)));
                }
            }
            rows.push(errors.row((FAMILY, case, method, UNIT, Some(kernel))));
        }
    }
    Ok(rows)
}

/// Texels a side.
const SIDE: usize = 64;

/// The middle of the picture of the teapot: smooth shades and a few edges.
fn teapot() -> Done<Vec<Texel>> {
    let picture = decode_image(include_bytes!("../../pictures/teapot.png"))?;
    let texels = (0..(SIDE * SIDE) as u32).map(|i| picture.pixel(128 + i % 64, 80 + i / 64));
    Ok(texels.collect())
}

impl Way {
    /// The texels as they are shown, 5, 6 and 5 bits as 8.
    fn shown(self, texels: &[[u8; 3]]) -> Done<Vec<[u8; 3]>> {
        let word = |rgb: [u8; 3]| Rgb565::to_rgb8(Rgb565::from_rgb8(rgb));
        Ok(match self {
            Self::Words => texels.iter().copied().map(word).collect(),
            Self::Palette => {
                let near = in_colours(texels, 16);
                near.into_iter().map(word).collect()
            }
            Self::Blocks => {
                let side = SIDE as u32;
                let all: Vec<Texel> = texels.iter().copied().map(Some).collect();
                let blocks = Blocks::new([side; 2], &all)?;
                let texture = Compressed::new(&blocks.bytes, side, side, |number| number)?;
                let texel = |i: usize| texture.texel((i % SIDE) as u16, (i / SIDE) as u16);
                (0..texels.len()).map(texel).map(Rgb565::to_rgb8).collect()
            }
        })
    }
}
