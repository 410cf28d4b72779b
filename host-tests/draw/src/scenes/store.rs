//! What is in memory of the pictures of a scene's objects.

use crate::FilterArg;
use crate::scene_file::{Computed, FormKind, Item, TexelsKind};
use host_support::compress::{Blocks, Texel};
use host_support::texture_file::{LEVELS, TextureImage};
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::{Checker, Gradient, MaskTexel};
use std::collections::BTreeSet;

/// Colours of a palette.
const COLOURS: usize = 16;
/// Below this alpha a texel is a hole.
const OPAQUE: u8 = 128;

/// A colour and its alpha.
type Rgba = [u8; 4];

/// What is in memory of a picture.
pub(super) struct Held {
    /// The picture, and its levels of detail.
    pub(super) levels: Vec<Level>,
    /// Words of indices, and what their mask says.
    pub(super) palette: Vec<u16>,
    pub(super) mask_palette: Vec<u16>,
    /// Whether a mask says how opaque texels are.
    pub(super) has_mask: bool,
    /// The word of holes.
    pub(super) key: Option<u16>,
    /// How texels are taken, if not the nearest of this size.
    pub(super) filter: Option<FilterArg>,
    /// Whether blocks are read through a cache.
    pub(super) is_cached: bool,
}

/// What is in memory of a level.
pub(super) struct Level {
    pub(super) sides: [u32; 2],
    pub(super) store: Store,
    /// What a mask of words says.
    pub(super) mask: Vec<u16>,
}

/// Texels, or what they are computed by.
pub(super) enum Store {
    Words(Vec<u16>),
    Indices(Vec<u8>),
    Blocks(Vec<u8>),
    Checker(Checker),
    Gradient(Gradient),
}

/// Whether a picture can be had as an object says.
///
/// # Errors
/// Why not.
pub(crate) fn check(item: &Item, image: &TextureImage) -> Result<(), String> {
    match item.texel_form {
        Some(FormKind::Palette) => palette(item, &texels(item, image)[0]).map(drop),
        _ => Ok(()),
    }
}

/// The levels of a picture with the alphas that an object takes of them: 0 for holes, and what the picture says only
/// where it says so.
fn texels(item: &Item, image: &TextureImage) -> Vec<Vec<Rgba>> {
    let count = if item.levels.unwrap_or(true) {
        LEVELS
    } else {
        1
    };
    let mut levels = match item.texels {
        Some(_) => image.levels_with_alpha(count),
        None => {
            let opaque = |[r, g, b]: &[u8; 3]| [*r, *g, *b, 255];
            let levels = image.levels.iter().take(count);
            let levels = levels.map(|level| level.iter().map(opaque).collect());
            levels.collect()
        }
    };
    // One texel has no level below it.
    let least = (1..levels.len()).find(|&level| image.sides(level) == image.sides(level - 1));
    levels.truncate(least.unwrap_or(levels.len()));
    if item.texels == Some(TexelsKind::Cutout) {
        for texel in levels.iter_mut().flatten() {
            let [r, g, b, alpha] = *texel;
            *texel = if alpha < OPAQUE {
                [0; 4]
            } else {
                [r, g, b, 255]
            };
        }
    }
    levels
}

/// The colours of a picture, each with its alpha, and no more than a palette has.
fn palette(item: &Item, texels: &[Rgba]) -> Result<Vec<Rgba>, String> {
    let all: BTreeSet<Rgba> = texels.iter().copied().collect();
    if all.len() > COLOURS {
        let (what, have) = (of(item), all.len());
        return Err(format!(
            "its picture has {have} {what}, and `texel_form` palette {COLOURS} at most"
        ));
    }
    Ok(all.into_iter().collect())
}

/// What palettes are of.
fn of(item: &Item) -> &'static str {
    match item.texels {
        Some(_) => "colours with their alphas",
        None => "colours",
    }
}

/// The word of holes, where there may be any: one that stands for none of the texels that are seen.
fn key<'t, T: PixelFormat<Word = u16>>(
    texels: impl Iterator<Item = &'t Rgba>,
    has_holes: bool,
) -> Result<Option<u16>, String> {
    if !has_holes {
        return Ok(None);
    }
    let mut taken = vec![false; 1 << 16];
    for texel in texels.filter(|texel| !is_hole(**texel)) {
        taken[usize::from(word::<T>(*texel, None))] = true;
    }
    let free = (0..=u16::MAX).find(|&word| !taken[usize::from(word)]);
    let free = free.ok_or("its picture has all colours, and none is left for holes")?;
    Ok(Some(free))
}

/// The word of a texel's colour, or of holes.
fn word<T: PixelFormat<Word = u16>>(texel: Rgba, key: Option<u16>) -> u16 {
    let [r, g, b, _] = texel;
    match key.filter(|_| is_hole(texel)) {
        Some(key) => key,
        None => T::from_rgb8([r, g, b]),
    }
}

/// What a mask says of a texel.
fn mask_word(texel: Rgba) -> u16 {
    MaskTexel::alpha(texel[3]).word()
}

fn is_hole(texel: Rgba) -> bool {
    texel[3] == 0
}

impl Held {
    /// Puts a picture into words of the format `T`, in the form that an object says.
    ///
    /// # Errors
    /// Why that cannot be.
    pub(super) fn new<T: PixelFormat<Word = u16>>(
        item: &Item,
        image: &TextureImage,
    ) -> Result<Self, String> {
        let has_levels = item.levels.unwrap_or(true) && item.computed.is_none();
        let held = Self {
            levels: Vec::new(),
            palette: Vec::new(),
            mask_palette: Vec::new(),
            has_mask: item.texels == Some(TexelsKind::Alpha),
            key: None,
            filter: match item.filter {
                Some(FilterArg::Bilinear) => Some(FilterArg::Bilinear),
                Some(FilterArg::Nearest) | None => has_levels.then_some(FilterArg::Nearest),
            },
            is_cached: item.cached == Some(true),
        };
        if let Some(computed) = &item.computed {
            return Ok(held.computed::<T>(computed));
        }
        let levels = texels(item, image);
        let has_holes = item.texels == Some(TexelsKind::Cutout);
        match item.texel_form {
            None | Some(FormKind::Words) => held.words::<T>(image, &levels, has_holes),
            Some(FormKind::Palette) => {
                let palette = palette(item, &levels[0])?;
                held.indices::<T>(image, &levels, &palette, has_holes)
            }
            Some(FormKind::Compressed) => held.blocks::<T>(image, &levels, has_holes),
        }
    }

    fn computed<T: PixelFormat<Word = u16>>(self, computed: &Computed) -> Self {
        let store = match *computed {
            Computed::Squares { colours, side, .. } => Store::Checker(Checker {
                colours: colours.map(T::from_rgb8),
                log_side: side.ilog2() as u8,
            }),
            Computed::Gradient {
                from, to, length, ..
            } => Store::Gradient(Gradient {
                from,
                to,
                log_length: length.ilog2() as u8,
                word: T::from_rgb8,
            }),
        };
        let level = Level {
            sides: computed.size(),
            store,
            mask: Vec::new(),
        };
        Self {
            levels: vec![level],
            ..self
        }
    }

    fn words<T: PixelFormat<Word = u16>>(
        self,
        image: &TextureImage,
        levels: &[Vec<Rgba>],
        has_holes: bool,
    ) -> Result<Self, String> {
        let key = key::<T>(levels.iter().flatten(), has_holes)?;
        let in_word = |texel: &Rgba| word::<T>(*texel, key);
        let made = (levels.iter().enumerate()).map(|(number, texels)| Level {
            sides: image.sides(number),
            store: Store::Words(texels.iter().map(in_word).collect()),
            mask: match self.has_mask {
                true => texels.iter().copied().map(mask_word).collect(),
                false => Vec::new(),
            },
        });
        Ok(Self {
            levels: made.collect(),
            key,
            ..self
        })
    }

    fn indices<T: PixelFormat<Word = u16>>(
        self,
        image: &TextureImage,
        levels: &[Vec<Rgba>],
        palette: &[Rgba],
        has_holes: bool,
    ) -> Result<Self, String> {
        let key = key::<T>(palette.iter(), has_holes)?;
        let in_word = |texel: &Rgba| word::<T>(*texel, key);
        let mut words: Vec<u16> = palette.iter().map(in_word).collect();
        let mut masks: Vec<u16> = palette.iter().copied().map(mask_word).collect();
        words.resize(COLOURS, 0);
        masks.resize(COLOURS, 0);
        let made = (levels.iter().enumerate()).map(|(number, texels)| {
            let indices: Vec<u8> = texels
                .iter()
                .map(|texel| nearest(palette, *texel))
                .collect();
            let byte = |pair: &[u8]| pair[0] | pair.get(1).copied().unwrap_or(0) << 4;
            Level {
                sides: image.sides(number),
                store: Store::Indices(indices.chunks(2).map(byte).collect()),
                mask: Vec::new(),
            }
        });
        Ok(Self {
            levels: made.collect(),
            palette: words,
            mask_palette: masks,
            key,
            ..self
        })
    }

    fn blocks<T: PixelFormat<Word = u16>>(
        self,
        image: &TextureImage,
        levels: &[Vec<Rgba>],
        has_holes: bool,
    ) -> Result<Self, String> {
        let texel = |texel: &Rgba| -> Texel {
            let [r, g, b, _] = *texel;
            (!(has_holes && is_hole(*texel))).then_some([r, g, b])
        };
        let mut made = Vec::new();
        for (number, texels) in levels.iter().enumerate() {
            let sides = image.sides(number);
            let all: Vec<Texel> = texels.iter().map(texel).collect();
            let blocks = Blocks::new(sides, &all).map_err(|error| error.to_string())?;
            made.push(Level {
                sides,
                store: Store::Blocks(blocks.bytes),
                mask: Vec::new(),
            });
        }
        Ok(Self {
            levels: made,
            // Blocks show it where there is a hole and nowhere else.
            key: has_holes.then(|| T::from_rgb8([255, 0, 255])),
            ..self
        })
    }
}

/// The index of the colour that is nearest. A mean of colours is nearer to one of them than what is seen is to a hole.
fn nearest(palette: &[Rgba], texel: Rgba) -> u8 {
    let distance = |(_, colour): &(u8, &Rgba)| -> u32 {
        let off = (0..4).map(|i| u32::from(colour[i].abs_diff(texel[i])));
        off.map(|off| off * off).sum()
    };
    let best = (0..).zip(palette).min_by_key(distance);
    best.map_or(0, |(index, _)| index)
}
