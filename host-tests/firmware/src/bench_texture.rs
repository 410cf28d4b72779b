//! The kernels of texture mapping, each alone, over long and over short spans (H4-H7).
//!
//! A texture of 128 x 128 into a line of 16-bit words, every pixel seen. What a span costs is the
//! call, the first and last division, and what is left over of the runs.

use crate::console::Console;
use crate::count::Counter;
use core::hint::black_box;
use scanbeam::pipeline::texture::{
    AllSeen, Bilinear, Homogeneous, Indexed, PerspectiveSpan, Quality, Rgb565Texel, Size, Stride,
    TexelFormat, Texels, Texture, Words, Wrap,
};
use scenes::{TEXEL_SIDE, TEXELS_8, TEXELS_565, WIDTH};

const LONG: usize = WIDTH as usize;
const SHORT: usize = 8;
const SPANS: u32 = 60;
const LOG: u32 = 7;
const COUNT: usize = 1 << (2 * LOG);

/// Times all kernels and prints them.
pub(crate) fn run(counter: &Counter, console: &mut Console) {
    let size = Size::new(TEXEL_SIDE, TEXEL_SIDE).expect("the side is legal");
    let texture = Texture::<_, Wrap>::new(Words(&TEXELS_565[..]), size).expect("it has its texels");
    let table: [u16; 256] = core::array::from_fn(|i| (i as u16).wrapping_mul(0x0821));
    let indexed = Indexed::<8, 256, _>::new(&TEXELS_8, &table, COUNT).expect("it has its bytes");
    let palettised = Texture::<_, Wrap>::new(indexed, size).expect("it has its texels");
    let square = texture.square::<LOG, COUNT>().expect("it is one");
    let palettised = palettised.square::<LOG, COUNT>().expect("it is one");
    let bilinear = Bilinear::<_, Rgb565Texel>::new(texture);
    let mut time = |name, kernel: &mut dyn FnMut(PerspectiveSpan, &mut [u16])| {
        for width in [LONG, SHORT] {
            let mut line = [0u16; LONG];
            let instructions = counter.finely(|| {
                for i in 0..SPANS {
                    kernel(span(i), black_box(&mut line[..width]));
                }
            });
            let pixels = SPANS * width as u32;
            console.line(format_args!(
                "kernel name={name} pixels={pixels} spans={SPANS} instructions={instructions}"
            ));
        }
    };
    time("affine_565", &mut |s, p| affine(&square, s, p));
    time("affine_palettised", &mut |s, p| affine(&palettised, s, p));
    time("perspective_16", &mut |s, p| runs::<16>(&square, s, p));
    time("perspective_8", &mut |s, p| runs::<8>(&square, s, p));
    time("perspective_4", &mut |s, p| runs::<4>(&square, s, p));
    time("perspective_2", &mut |s, p| runs::<2>(&square, s, p));
    time("perspective_1", &mut |s, p| exact(&square, s, p));
    time("perspective_1_palettised", &mut |s, p| {
        exact(&palettised, s, p)
    });
    time("perspective_any_size_16", &mut |s, p| {
        runs::<16>(&texture, s, p)
    });
    time("perspective_any_size_1", &mut |s, p| exact(&texture, s, p));
    time("bilinear_16", &mut |s, p| {
        s.draw(Stride::Sixteen, &bilinear, p, |pixel, texel| {
            *pixel = Rgb565Texel::pack(texel);
        });
    });
    time("select", &mut |s, p| {
        // What the choice costs, and no pixel.
        let stride = Quality::Balanced.budget().stride(&s, p.len());
        if black_box(stride) == Stride::One {
            p[0] = 1;
        }
    });
    by_quality(&square, counter, console);
}

/// What a quality's choice costs where 1/w falls evenly to anything from all of it to a tenth.
///
/// Both widths have the stride that the whole span gets, so what differs is pixels alone.
fn by_quality(texels: &impl Texels<Texel = u16>, counter: &Counter, console: &mut Console) {
    let spans: [PerspectiveSpan; SPANS as usize] = core::array::from_fn(|i| tilted(i as i32));
    for (name, quality) in [
        ("texture_fast", Quality::Fast),
        ("texture_balanced", Quality::Balanced),
    ] {
        for width in [LONG, LONG / 2] {
            let mut line = [0u16; LONG];
            let instructions = counter.finely(|| {
                for span in black_box(&spans) {
                    chosen(texels, *span, quality, black_box(&mut line[..width]));
                }
            });
            let pixels = SPANS * width as u32;
            console.line(format_args!(
                "kernel name={name} pixels={pixels} spans={SPANS} instructions={instructions}"
            ));
        }
    }
}

#[inline(never)]
fn chosen(
    texels: &impl Texels<Texel = u16>,
    span: PerspectiveSpan,
    quality: Quality,
    pixels: &mut [u16],
) {
    let stride = quality.budget().stride(&span, LONG);
    span.draw(stride, texels, pixels, |pixel, texel| *pixel = texel);
}

/// A span from texel 10 to some 70; 1/w falls by up to nine tenths.
fn tilted(i: i32) -> PerspectiveSpan {
    let (near, last) = (1 << 30, LONG as i32 - 1);
    let far = near / 60 * (60 - i * 9 / 10);
    // u over w at both ends, in units of 2^10 texels.
    let over = |texel: i32, q: i32| texel * (q >> 10);
    PerspectiveSpan {
        at: Homogeneous {
            q: near,
            s: over(10, near),
            t: over(30, near),
        },
        step: Homogeneous {
            q: (far - near) / last,
            s: (over(50 + i / 3, far) - over(10, near)) / last,
            t: (over(20, far) - over(30, near)) / last,
        },
    }
}

/// A span whose 1/w falls by half; no two are alike.
fn span(i: u32) -> PerspectiveSpan {
    let i = i as i32;
    black_box(PerspectiveSpan {
        at: Homogeneous {
            q: (1 << 30) - (i << 12),
            s: (10 << 20) + (i << 14),
            t: 30 << 20,
        },
        step: Homogeneous {
            q: -((1 << 29) / LONG as i32),
            s: 60_000 + i,
            t: 21_000 - i,
        },
    })
}

#[inline(never)]
fn affine<T: Texels<Texel = u16>>(texels: &T, span: PerspectiveSpan, pixels: &mut [u16]) {
    span.affine(
        pixels,
        &mut AllSeen {
            texels,
            each: |pixel: &mut u16, texel| *pixel = texel,
        },
    );
}

#[inline(never)]
fn runs<const N: usize>(
    texels: &impl Texels<Texel = u16>,
    span: PerspectiveSpan,
    pixels: &mut [u16],
) {
    span.runs::<N, _>(
        pixels,
        &mut AllSeen {
            texels,
            each: |pixel: &mut u16, texel| *pixel = texel,
        },
    );
}

#[inline(never)]
fn exact<T: Texels<Texel = u16>>(texels: &T, span: PerspectiveSpan, pixels: &mut [u16]) {
    span.exact(
        pixels,
        &mut AllSeen {
            texels,
            each: |pixel: &mut u16, texel| *pixel = texel,
        },
    );
}
