//! Pictures made of texture arithmetic alone: the same bits on the host and on every target.
//!
//! Each is drawn line by line from stated spans, without scene and renderer: every way of taking
//! the perspective, every texel format, what lies beyond the sides, both filters, blocks and their
//! cache, levels of detail, and block-fix depth. The last ones are a scene through the whole
//! pipeline, at each quality (`textured.rs`).

use crate::textured::textured;
use crate::{HEIGHT, WIDTH};
use scanbeam::pipeline::BlockFix16;
use scanbeam::pipeline::texture::{
    Bilinear, BlockCache, Blocked, CacheReads, Checker, Clamp, Corner, Corners, Gradient,
    Homogeneous, Indexed, LevelEnds, Levels, Mirror, PaintRun, Period, PerspectiveSpan, Quality,
    Rgb565Texel, Rgb888Texel, Rgba5551, Rgba8871, Rgbd5551, Size, Stride, Texel, TexelFormat,
    Texels, Texture, Uv, Words, Wrap, build_level,
};

/// Texels a side of [`TEXELS_565`] and [`TEXELS_8`].
pub const TEXEL_SIDE: u32 = 128;
const COUNT: usize = (TEXEL_SIDE * TEXEL_SIDE) as usize;
/// A texture of rings and squares, 5, 6 and 5 bits.
pub static TEXELS_565: [u16; COUNT] = texels_565();
/// A texture of 8-bit indices.
pub static TEXELS_8: [u8; COUNT] = texels_8();

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

const fn texels_8() -> [u8; COUNT] {
    let mut texels = [0; COUNT];
    let mut i = 0;
    while i < COUNT {
        let (x, y) = (i as u32 % TEXEL_SIDE, i as u32 / TEXEL_SIDE);
        texels[i] = ((x * 3) ^ (y * 5)) as u8;
        i += 1;
    }
    texels
}

/// A picture of texture arithmetic.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Swatch {
    /// A ground plane, drawn in one way.
    Ground(Stride),
    /// The same, each line in the way that keeps 1/2 texel.
    Selected,
    /// Lookup tables of 1, 2, 4, 6 and 8 bits, in bands.
    Tables,
    /// Direct formats, expanded, nearest and bilinear, with all that can lie beyond the sides.
    Formats,
    /// Levels of detail, built where they are drawn and chosen by 1/w.
    Details,
    /// A blocked layout, through a cache of its blocks.
    Blocks,
    /// Textures that are computed, and block-fix depth of what they lie on.
    Computed,
    /// A scene: set-up, clipping, depth and light as well.
    Scene(Quality),
}

/// All of them, and their names.
pub const SWATCHES: [(&str, Swatch); 15] = [
    ("texels_exact", Swatch::Ground(Stride::One)),
    ("texels_2", Swatch::Ground(Stride::Two)),
    ("texels_4", Swatch::Ground(Stride::Four)),
    ("texels_8", Swatch::Ground(Stride::Eight)),
    ("texels_16", Swatch::Ground(Stride::Sixteen)),
    ("texels_affine", Swatch::Ground(Stride::Affine)),
    ("texels_selected", Swatch::Selected),
    ("texels_tables", Swatch::Tables),
    ("texels_formats", Swatch::Formats),
    ("texels_details", Swatch::Details),
    ("texels_blocks", Swatch::Blocks),
    ("texels_computed", Swatch::Computed),
    ("textured_fast", Swatch::Scene(Quality::Fast)),
    ("textured_balanced", Swatch::Scene(Quality::Balanced)),
    ("textured_exact", Swatch::Scene(Quality::Exact)),
];

/// A line of a tilted plane that goes far away.
fn span(line: u16) -> PerspectiveSpan {
    let line = i32::from(line);
    PerspectiveSpan {
        at: Homogeneous {
            q: (1 << 24) + line * 4_000_000,
            s: line * 40_000 + (3 << 20),
            t: (9 << 20) - line * 17_000,
        },
        step: Homogeneous {
            q: 150_000 + line * 1_500,
            s: 31_000 - line * 70,
            t: 9_000 + line * 200,
        },
    }
}

/// What a display of 5, 6 and 5 bits shows of a texel.
fn word(texel: Texel) -> u16 {
    // A and D leave their marks.
    let [r, g, b] = texel.rgb;
    let rgb = [r, g ^ texel.alpha >> 1, b ^ u8::from(texel.undithered) << 7];
    Rgb565Texel::pack(Texel { rgb, ..texel })
}

type Line<'a> = &'a mut [u16];

impl Swatch {
    /// Draws all lines in turn, and hands each to `emit`.
    ///
    /// Code of its own: where it is built into its caller, what it takes depends on the rest
    /// of that.
    #[inline(never)]
    pub fn draw(self, emit: &mut dyn FnMut(&[u16])) {
        let mut pixels = [0u16; WIDTH as usize];
        match self {
            Self::Details => return details(emit),
            Self::Blocks => return blocks(emit),
            Self::Scene(quality) => {
                textured(quality, emit).expect("its memory suffices");
                return;
            }
            _ => {}
        }
        for line in 0..HEIGHT {
            self.line(line, &mut pixels);
            emit(&pixels);
        }
    }

    fn line(self, line: u16, pixels: Line) {
        match self {
            Self::Ground(stride) => ground(stride, line, pixels),
            Self::Selected => {
                let stride = Quality::Fast.budget().stride(&span(line), pixels.len());
                ground(stride, line, pixels);
            }
            Self::Tables => tables(line, pixels),
            Self::Formats => formats(line, pixels),
            Self::Computed => computed(line, pixels),
            Self::Details | Self::Blocks | Self::Scene(_) => {}
        }
    }
}

/// A size of which the sides are known to be right.
pub(crate) const fn size(width: u32, height: u32) -> Size {
    match Size::new(width, height) {
        Ok(size) => size,
        Err(_) => unreachable!(),
    }
}

fn ground(stride: Stride, line: u16, pixels: Line) {
    let Ok(texture) = Texture::<_, Wrap>::new(Words(&TEXELS_565[..]), size(TEXEL_SIDE, TEXEL_SIDE))
    else {
        return;
    };
    // The left half by the loop for any size, the right one by that for this size.
    let (left, right) = pixels.split_at_mut(pixels.len() / 2);
    let start = span(line);
    let later = PerspectiveSpan {
        at: start.at.plus(start.step.times(left.len() as i32)),
        ..start
    };
    start.draw(stride, &texture, left, |pixel, texel| *pixel = texel);
    if let Some(square) = texture.square::<7, COUNT>() {
        later.draw(stride, &square, right, |pixel, texel| *pixel = texel);
    }
}

fn table<const BITS: u32, const COLOURS: usize>(line: u16, pixels: Line) {
    let table: [u16; COLOURS] = core::array::from_fn(|i| {
        let level = (i * 255 / (COLOURS - 1)) as u8;
        let rgb = [level, 255 - level, (i * 37) as u8];
        Rgb565Texel::pack(Texel {
            rgb,
            ..Texel::default()
        })
    });
    let Ok(store) = Indexed::<BITS, COLOURS, _>::new(&TEXELS_8, &table, 64 * 32) else {
        return;
    };
    if let Ok(texture) = Texture::<_, Wrap>::new(store, size(64, 32)) {
        span(line).draw(Stride::Eight, &texture, pixels, |pixel, texel| {
            *pixel = texel
        });
    }
}

fn tables(line: u16, pixels: Line) {
    match line / 48 {
        0 => table::<1, 2>(line, pixels),
        1 => table::<2, 4>(line, pixels),
        2 => table::<4, 16>(line, pixels),
        3 => table::<6, 64>(line, pixels),
        _ => table::<8, 256>(line, pixels),
    }
}

/// Random words of a format, nearest on even lines and bilinear on odd ones.
fn format<F: TexelFormat>(line: u16, pixels: Line, of: impl Fn(u32) -> F::Word) {
    let words: [F::Word; 64 * 16] =
        core::array::from_fn(|i| of((i as u32).wrapping_mul(0x9E37_79B9).rotate_left(7)));
    let (size, words) = (size(64, 16), Words(&words[..]));
    let span = span(line);
    if line.is_multiple_of(2) {
        if let Ok(texture) = Texture::<_, Mirror>::new(words, size) {
            span.draw(Stride::Four, &texture, pixels, |pixel, texel| {
                *pixel = word(F::expand(texel));
            });
        }
    } else if let Ok(texture) = Texture::<_, Clamp>::new(words, size) {
        let filtered = Bilinear::<_, F>::new(texture);
        span.draw(Stride::Two, &filtered, pixels, |pixel, texel| {
            *pixel = word(texel);
        });
    }
}

fn formats(line: u16, pixels: Line) {
    match line / 48 {
        0 => format::<Rgba8871>(line, pixels, |i| i),
        1 => format::<Rgba5551>(line, pixels, |i| i as u16),
        2 => format::<Rgbd5551>(line, pixels, |i| (i >> 8) as u16),
        3 => format::<Rgb565Texel>(line, pixels, |i| (i >> 4) as u16),
        _ => format::<Rgb888Texel>(line, pixels, |i| [i as u8, (i >> 8) as u8, (i >> 16) as u8]),
    }
}

#[inline(never)]
fn details(emit: &mut dyn FnMut(&[u16])) {
    let full = size(32, 32);
    let texels = &TEXELS_565[..1024];
    let (mut half, mut quarter, mut eighth) = ([0; 256], [0; 64], [0; 16]);
    let expand = |words: &[u16], i: usize| Rgb565Texel::expand(words[i]);
    let built = build_level::<Rgb565Texel>(full, |i| expand(texels, i), &mut half)
        .and_then(|_| build_level::<Rgb565Texel>(full.level(1), |i| expand(&half, i), &mut quarter))
        .and_then(|_| {
            build_level::<Rgb565Texel>(full.level(2), |i| expand(&quarter, i), &mut eighth)
        });
    let level = |n, words| Texture::<_, Wrap>::new(Words(words), full.level(n));
    let (Ok(_), Ok(a), Ok(b), Ok(c), Ok(d)) = (
        built,
        level(0, texels),
        level(1, &half[..]),
        level(2, &quarter[..]),
        level(3, &eighth[..]),
    ) else {
        return;
    };
    let levels = Levels {
        levels: [a, b, c, d],
    };
    let corner = |line: i32, u, v| Corner {
        depth: (span(line as u16).at.q << 1) as u32,
        u,
        v,
    };
    // Texels of a part of the plane, from its own corners.
    let ends = Corners::new(
        [
            corner(0, 0, 0),
            corner(239, 9_000, 400),
            corner(120, 2_000, 90_000),
        ],
        Period::Short,
    )
    .map_or(LevelEnds::FULL, |corners| corners.levels(64 * 320 * 240));
    let mut pixels = [0u16; WIDTH as usize];
    for line in 0..HEIGHT {
        let span = span(line);
        let level = levels.level(ends.level(span.at.q as u32));
        span.draw(Stride::Sixteen, &level, &mut pixels, |pixel, texel| {
            *pixel = texel
        });
        emit(&pixels);
    }
}

#[inline(never)]
fn blocks(emit: &mut dyn FnMut(&[u16])) {
    let size = size(64, 32);
    let layout = Blocked::of_page(32, 16);
    let mut arranged = [0u16; 64 * 32];
    let (mut tags, mut texels) = ([0; 8], [0u16; 8 * 16]);
    let mut reads = CacheReads::default();
    if layout
        .arrange(size, &TEXELS_565[..2048], &mut arranged)
        .is_err()
    {
        return;
    }
    let words = Words(&arranged[..]);
    let Ok(cache) = BlockCache::new(
        words,
        layout.texels(size),
        &mut tags,
        &mut texels,
        &mut reads,
    ) else {
        return;
    };
    let Ok(texture) = Texture::<_, Wrap, _>::arranged(cache, size, layout) else {
        return;
    };
    let mut pixels = [0u16; WIDTH as usize];
    for line in 0..HEIGHT {
        let mut painter = Counted {
            texture: &texture,
            layout,
            runs: 0,
        };
        span(line).walk(Stride::Sixteen, &mut pixels, &mut painter);
        let runs = painter.runs;
        // What the cache and the runs counted is part of the picture.
        pixels[0] = runs as u16;
        pixels[1] = cache.reads().misses as u16;
        emit(&pixels);
    }
}

/// Draws runs, and counts the blocks that they go through.
struct Counted<'t, T> {
    texture: &'t T,
    layout: Blocked,
    runs: usize,
}

impl<T: Texels<Texel = u16>> PaintRun<u16> for Counted<'_, T> {
    fn run(&mut self, pixels: &mut [u16], from: Uv, step: Uv) {
        self.runs += self.layout.runs(from, step, pixels.len() as u32).count();
        self.texture
            .run(pixels, from, step, |pixel, texel| *pixel = texel);
    }
}

fn computed(line: u16, pixels: Line) {
    let span = span(line);
    let checker = Checker {
        colours: [0xFFFFu16, 0x18E3],
        log_side: 3,
    };
    let gradient = Gradient {
        from: [250, 120, 0],
        to: [0, 40, 220],
        log_length: 6,
    };
    let (left, right) = pixels.split_at_mut(pixels.len() / 2);
    span.draw(Stride::One, &checker, left, |pixel, texel| *pixel = texel);
    span.draw(Stride::Sixteen, &gradient, right, |pixel, rgb| {
        *pixel = Rgb565Texel::pack(Texel {
            rgb,
            ..Texel::default()
        });
    });
    let range = BlockFix16::range_of((span.at.q as u32) << 1 >> (line % 13));
    for (i, pixel) in (0..).zip(right.iter_mut()) {
        let depth = (span.at.plus(span.step.times(i)).q as u32) << 1 >> (line % 13);
        *pixel ^= BlockFix16::new(depth, range).to_bits();
    }
}
