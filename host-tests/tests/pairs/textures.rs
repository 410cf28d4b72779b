//! Textures of every form and wrap, with and without a key, and what they are to the reference.

use super::reference::Texels;
use scanbeam::scene::{Application, Budget, MaskTexel, Sampling, Texture, Wrap};
use std::sync::OnceLock;

/// Sides and bits a texel of the forms; the first choice is none. 16 bits are words of the panel.
pub const FORMS: [(i32, i32, u32); 9] = [
    (32, 32, 16),
    (64, 64, 16),
    (128, 128, 16),
    (256, 256, 16),
    (16, 64, 16),
    (64, 64, 8),
    (8, 32, 4),
    (64, 16, 2),
    (32, 32, 1),
];

/// Steps of 5, 6 and 5 bits.
type Steps = [u16; 3];

/// The texel that is transparent where a call says so.
const KEY: Steps = [31, 0, 31];

/// A texel: red and green tell where it is, blue differs from all around; with islands of the key.
fn steps(form: usize, u: i32, v: i32) -> Steps {
    let (width, height, bits) = FORMS[form];
    if (u / 8 + v / 8) % 3 == 0 {
        return KEY;
    }
    let (r, g) = (u * 31 / (width - 1), v * 63 / (height - 1));
    let blue = (u * 7 + v * 13) % 32;
    match bits {
        16 => [r as u16, g as u16, blue as u16],
        // As many colours as an index can name, or one less.
        8 => [(u / 4 * 2) as u16, (v / 4 * 4) as u16, 9],
        _ => {
            let index = (u / 2 + 3 * v) % ((1 << bits) - 1);
            let level = index as u16 * 31 / ((1 << bits) - 1);
            [level, 63 - 2 * level, level / 2]
        }
    }
}

/// What a mask says of a texel: its alpha, and whether it is added. Of indices it hangs on the colour alone.
fn said(form: usize, u: i32, v: i32) -> (u8, bool) {
    let (width, height, bits) = FORMS[form];
    if bits == 16 {
        let both = u * 255 / (width - 1) + v * 255 / (height - 1);
        return ((both / 2) as u8, (u / 16 + v / 16) % 2 == 1);
    }
    let [r, g, b] = steps(form, u, v);
    ((r * 7 + g * 3 + b * 5) as u8, r & 2 == 2)
}

/// Those of one form and wrap: by mask, order of bytes and key.
type Forms = [[[Texture<'static>; 3]; 2]; 3];

/// All textures by form and wrap, as they are and filtered, each without a mask, with one of alphas, and with one that says
/// also what is added and not dithered; in the byte order of this machine or the other; without a key, and with.
pub struct Textures {
    pub of: [[Vec<Forms>; 2]; 2],
    pub texels: Vec<Texels>,
}

fn word([r, g, b]: Steps, is_swapped: bool) -> u16 {
    let word = r << 11 | g << 5 | b;
    if is_swapped { word.swap_bytes() } else { word }
}

/// A texture of a form, with a word for each place.
fn texture(form: usize, word: impl Fn(i32, i32) -> u16) -> Texture<'static> {
    let (width, height, bits) = FORMS[form];
    let places = || (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
    let (wide, high) = (width as u32, height as u32);
    if bits == 16 {
        let words: Vec<_> = places().map(|(u, v)| word(u, v)).collect();
        return Texture::words(words.leak(), wide, high).expect("sides are powers of two");
    }
    let (mut colours, mut palette): (Vec<Steps>, Vec<u16>) = (Vec::new(), Vec::new());
    let mut bytes = vec![0u8; (width * height) as usize * bits as usize / 8];
    for (i, (u, v)) in places().enumerate() {
        let texel = steps(form, u, v);
        let index = colours.iter().position(|c| *c == texel);
        let index = index.unwrap_or_else(|| {
            colours.push(texel);
            palette.push(word(u, v));
            colours.len() - 1
        });
        let each = (8 / bits) as usize;
        bytes[i / each] |= (index << (bits as usize * (i % each))) as u8;
    }
    assert!(palette.len() <= 1 << bits);
    palette.resize(1 << bits, 0);
    let (bytes, palette) = (bytes.leak(), palette.leak());
    match bits {
        8 => Texture::index8(bytes, palette, wide, high),
        4 => Texture::index4(bytes, palette, wide, high),
        2 => Texture::index2(bytes, palette, wide, high),
        _ => Texture::index1(bytes, palette, wide, high),
    }
    .expect("sides are powers of two")
}

/// How far a texel may be from its place, in texels.
pub const BUDGETS: [(Budget, f64); 3] = [
    (Budget::FAST, 0.5),
    (Budget::BALANCED, 0.25),
    (Budget::EXACT, 0.01),
];

pub const APPLICATIONS: [Application; 3] = [
    Application::Product,
    Application::Replace,
    Application::Decal,
];

pub const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

pub fn textures() -> &'static Textures {
    static ALL: OnceLock<Textures> = OnceLock::new();
    ALL.get_or_init(|| {
        let mask = |form: usize, has_bits: bool| {
            texture(form, |u, v| {
                let (alpha, is_added) = said(form, u, v);
                let mut texel = MaskTexel::alpha(alpha);
                if has_bits && is_added {
                    texel = texel.added();
                }
                if has_bits && alpha & 1 != 0 {
                    texel = texel.undithered();
                }
                texel.word()
            })
        };
        let masks = (0..FORMS.len()).map(|form| [mask(form, false), mask(form, true)]);
        let masks: &'static [_] = masks.collect::<Vec<_>>().leak();
        let of = |is_swapped| {
            let forms: Vec<_> = (0..FORMS.len())
                .map(|form| texture(form, |u, v| word(steps(form, u, v), is_swapped)))
                .collect();
            let key = word(KEY, is_swapped);
            let filtered = |t: Texture<'static>| t.sampled(Sampling::LINEAR, &[]);
            let wrapped = |(form, t): (usize, Texture<'static>)| {
                WRAPS.map(|wrap| {
                    let plain = t.wrapping(wrap);
                    [plain, filtered(plain).expect("no levels")].map(|t| {
                        let masked = |of: usize| t.masked(&masks[form][of]).expect("alike");
                        [t, masked(0), masked(1)]
                    })
                })
            };
            let keyed = forms.iter().map(|t| t.keyed(key)).enumerate();
            [
                forms.iter().copied().enumerate().map(wrapped).collect(),
                keyed.map(wrapped).collect(),
            ]
        };
        let level = |[r, g, b]: Steps| {
            let of = |step: u16, most: f64| f64::from(step) * 255.0 / most;
            [of(r, 31.0), of(g, 63.0), of(b, 31.0)]
        };
        let texels = (0..FORMS.len()).map(|form| {
            let (width, height, _) = FORMS[form];
            let places = (0..height).flat_map(|v| (0..width).map(move |u| (u, v)));
            let said: Vec<_> = places.clone().map(|(u, v)| said(form, u, v)).collect();
            let steps: Vec<_> = places.map(|(u, v)| steps(form, u, v)).collect();
            Texels {
                width,
                height,
                rgb: steps.iter().map(|&texel| level(texel)).collect(),
                is_key: steps.iter().map(|texel| *texel == KEY).collect(),
                alpha: said.iter().map(|(alpha, _)| f64::from(*alpha)).collect(),
                is_added: said.iter().map(|(_, is_added)| *is_added).collect(),
            }
        });
        Textures {
            of: [of(false), of(true)],
            texels: texels.collect(),
        }
    })
}
