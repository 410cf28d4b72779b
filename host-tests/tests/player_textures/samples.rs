//! Textures of every form, at random: as a list has them, and as words of the panel.

use super::draw_quad;
use crate::common::Rng;
use host_tests::lists::writer::ListWriter;
use scanbeam::list::{Flow, Palette, State, TexelForm, Texture as TextureBlock};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{MaskTexel, Texture, Wrap};

/// A texture's block, its words, its palette, and its texels as colours with alpha.
pub(super) struct Sample {
    pub(super) block: TextureBlock,
    pub(super) words: Vec<u32>,
    pub(super) colours: Vec<u32>,
    pub(super) texels: Vec<[u8; 4]>,
}

pub(super) fn sample(rng: &mut Rng, form: TexelForm, has_holes: bool) -> Sample {
    let sides = [3 + rng.below(3) as u8, 3 + rng.below(2) as u8];
    sample_of(rng, form, has_holes, sides)
}

/// Whether a form says which texels are seen.
pub(super) fn has_alpha(form: TexelForm) -> bool {
    use TexelForm::{Rgb565, Rgb888, Rgbd5551};
    !matches!(form, Rgb565 | Rgb888 | Rgbd5551)
}

/// One with sides of these logarithms.
pub(super) fn sample_of(rng: &mut Rng, form: TexelForm, has_holes: bool, sides: [u8; 2]) -> Sample {
    let [log_width, log_height] = sides;
    let block = TextureBlock {
        number: 1,
        log_width,
        log_height,
        form,
        levels: 1,
        palette: 2,
        clamped: rng.below(2) == 0,
        at: 0,
    };
    let mut colour = |i: u32| {
        let alpha = if has_holes && i % 3 == 1 { 0 } else { 255 };
        [
            rng.below(256) as u8,
            rng.below(256) as u8,
            rng.below(256) as u8,
            alpha,
        ]
    };
    let codes = match form {
        TexelForm::Index1 => 2,
        TexelForm::Index2 => 4,
        TexelForm::Index4 => 16,
        TexelForm::Index6 => 64,
        TexelForm::Index8 => 256,
        _ => 0,
    };
    let palette: Vec<[u8; 4]> = (0..codes).map(&mut colour).collect();
    let count = 1u32 << block.log_width << block.log_height;
    let mut bits: Vec<u8> = vec![0; 4 * block.words() as usize];
    let mut texels = Vec::new();
    for n in 0..count {
        let direct = colour(n);
        let code = if codes > 0 { n * 7 % codes } else { 0 };
        let (value, texel) = match form {
            TexelForm::Rgb565 => {
                let [r, g, b, _] = direct;
                let value = u32::from(r >> 3) << 11 | u32::from(g >> 2) << 5 | u32::from(b >> 3);
                (
                    value,
                    [
                        r >> 3 << 3 | r >> 5,
                        g >> 2 << 2 | g >> 6,
                        b >> 3 << 3 | b >> 5,
                        255,
                    ],
                )
            }
            TexelForm::Rgb888 => {
                let [r, g, b, _] = direct;
                (u32::from_le_bytes([r, g, b, 0]), [r, g, b, 255])
            }
            TexelForm::Rgba => {
                let [r, g, b, a] = direct;
                // 7 bits of alpha, and D, which counts where texels are dithered.
                (
                    u32::from_le_bytes([r, g, b, a >> 1 | (n as u8 & 1) << 7]),
                    direct,
                )
            }
            TexelForm::Rgba5551 | TexelForm::Rgbd5551 => {
                let [r, g, b, a] = direct;
                let five = |v: u8| u32::from(v >> 3);
                let value = five(r) << 11 | five(g) << 6 | five(b) << 1;
                let grown = |v: u8| v >> 3 << 3 | v >> 5;
                // One bit of alpha, or D.
                let (last, a) = match form {
                    TexelForm::Rgba5551 => (u32::from(a >> 7), a),
                    _ => (n & 1, 255),
                };
                (value | last, [grown(r), grown(g), grown(b), a])
            }
            // Two bits of a byte mean nothing.
            TexelForm::Index6 => (code | (n & 3) << 6, palette[code as usize]),
            _ => (code, palette[code as usize]),
        };
        texels.push(texel);
        for bit in 0..form.bits() {
            let at = (n * form.bits() + bit) as usize;
            bits[at / 8] |= ((value >> bit & 1) as u8) << (at % 8);
        }
    }
    let word = |b: &[u8]| u32::from_le_bytes([b[0], b[1], b[2], b[3]]);
    Sample {
        block,
        words: bits.chunks_exact(4).map(word).collect(),
        colours: palette.into_iter().map(u32::from_le_bytes).collect(),
        texels,
    }
}

/// A texel's word, whatever its alpha is.
pub(super) fn word_of([r, g, b, _]: [u8; 4]) -> u16 {
    Rgb565Be::from_rgb8([r, g, b])
}

impl Sample {
    /// What lies beyond its sides.
    pub(super) fn wrap(&self) -> Wrap {
        match self.block.clamped {
            true => Wrap::Clamp,
            false => Wrap::Repeat,
        }
    }

    /// The words of its texels, whatever their alphas are.
    pub(super) fn words(&self) -> Vec<u16> {
        self.texels.iter().map(|texel| word_of(*texel)).collect()
    }

    /// The texture that calls have for it, of these words.
    pub(super) fn texture<'t>(&self, words: &'t [u16]) -> Texture<'t> {
        let (width, height) = (1 << self.block.log_width, 1 << self.block.log_height);
        Texture::words(words, width, height)
            .unwrap()
            .wrapping(self.wrap())
    }

    /// Its texels as words of the panel, with the word of holes.
    pub(super) fn holed(&self, key: u16) -> Vec<u16> {
        let of = |texel: &[u8; 4]| if texel[3] == 0 { key } else { word_of(*texel) };
        self.texels.iter().map(of).collect()
    }

    /// A list that draws a quad with it, with PRSP or not.
    pub(super) fn list(&self, prsp: bool) -> Vec<u32> {
        let mut memory = vec![0; 16_384];
        let mut writer = ListWriter::new(&mut memory);
        let block = State::Texture(self.block);
        writer.bulk(&block, &self.words).unwrap();
        if !self.colours.is_empty() {
            let (number, count, at) = (2, self.colours.len() as u16, 0);
            let palette = State::Palette(Palette { number, count, at });
            writer.bulk(&palette, &self.colours).unwrap();
        }
        draw_quad(&mut writer, 1, prsp);
        writer.flow(Flow::End).unwrap();
        writer.words().to_vec()
    }
}

/// A word that no opaque texel has, to stand for the holes.
pub(super) fn key_of<'t>(texels: impl Iterator<Item = &'t [u8; 4]>) -> u16 {
    let opaque: Vec<u16> = texels
        .filter(|t| t[3] == 255)
        .map(|t| word_of(*t))
        .collect();
    let mut words = (0..=u16::MAX).rev();
    words.find(|word| !opaque.contains(word)).unwrap()
}

/// A texture of a form with four levels of detail, as a list has it; and each level as words of the panel, with the word of
/// holes.
pub(super) fn levelled(form: TexelForm, seed: u64, sides: [u8; 2]) -> (Sample, Vec<Vec<u16>>, u16) {
    let mut rng = Rng::new(900 + seed);
    let has_holes = seed == 2 && has_alpha(form);
    let log = |level: u8| sides.map(|log: u8| log.saturating_sub(level));
    let mut all: Vec<Sample> = (0..4)
        .map(|level| sample_of(&mut rng, form, has_holes, log(level)))
        .collect();
    let colours = all[0].colours.clone();
    for sample in &mut all {
        for (n, texel) in sample.texels.iter_mut().enumerate() {
            if let Some(colour) = colours.get(n * 7 % colours.len().max(1)) {
                *texel = colour.to_le_bytes();
            }
        }
    }
    let key = key_of(all.iter().flat_map(|sample| &sample.texels));
    let levels = all.iter().map(|sample| sample.holed(key)).collect();
    let whole = Sample {
        block: TextureBlock {
            levels: 4,
            ..all[0].block
        },
        words: all.iter().flat_map(|sample| sample.words.clone()).collect(),
        colours,
        texels: Vec::new(),
    };
    (whole, levels, key)
}

/// Gives texels of a form any alpha, or D bits alone, and returns the words of a mask for them.
pub(super) fn make_translucent(rng: &mut Rng, sample: &mut Sample, has_alpha: bool) -> Vec<u16> {
    let mut alpha = || match has_alpha {
        true => rng.below(256) as u8,
        false => 255,
    };
    if sample.block.form.is_indexed() {
        let alphas: Vec<u8> = sample.colours.iter().map(|_| alpha()).collect();
        for (colour, alpha) in sample.colours.iter_mut().zip(&alphas) {
            *colour = *colour & 0xFF_FFFF | u32::from(*alpha) << 24;
        }
        let codes = sample.colours.len();
        let texels = sample.texels.iter_mut().enumerate();
        let of = texels.map(|(n, texel)| {
            texel[3] = alphas[n * 7 % codes];
            MaskTexel::alpha(texel[3]).word()
        });
        return of.collect();
    }
    let texels = sample.texels.iter_mut().zip(&mut sample.words);
    let of = texels.enumerate().map(|(n, (texel, word))| {
        let (seven, is_undithered) = (u32::from(alpha() >> 1), n % 3 == 0);
        *word = *word & 0xFF_FFFF | seven << 24 | u32::from(is_undithered) << 31;
        texel[3] = (seven << 1 | seven >> 6) as u8;
        let mask = MaskTexel::alpha(texel[3]);
        match is_undithered {
            true => mask.undithered().word(),
            false => mask.word(),
        }
    });
    of.collect()
}
