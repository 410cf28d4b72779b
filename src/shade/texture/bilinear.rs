//! Bilinear filtering (H6).

use super::block::Layout;
use super::format::{Texel, TexelFormat};
use super::sample::{Address, Texture};
use super::tlut::Store;
use super::{FRACTION, Period, Texels, Uv};
use core::marker::PhantomData;

/// The weighted mean of the four nearest texels, 4 bits of weight each way, rounded once.
///
/// The D bit is that of the nearest of the four.
#[derive(Clone, Copy, Debug)]
pub struct Bilinear<T, F> {
    texture: T,
    format: PhantomData<F>,
}

impl<T, F> Bilinear<T, F> {
    /// The texture, filtered; its texels are in the format `F`.
    pub const fn new(texture: T) -> Self {
        Self {
            texture,
            format: PhantomData,
        }
    }
}

impl<S, A, L, F> Texels for Bilinear<Texture<S, A, L>, F>
where
    F: TexelFormat,
    S: Store<Texel = F::Word>,
    A: Address,
    L: Layout,
{
    type Texel = Texel;

    fn period(&self) -> Period {
        self.texture.period()
    }

    #[inline(always)]
    fn fetches(&self) -> u32 {
        4
    }

    #[inline(always)]
    fn at(&self, place: Uv) -> Texel {
        // Texels lie at the middle of their squares.
        const HALF: i32 = 1 << (FRACTION - 1);
        let low = Uv {
            u: place.u.wrapping_sub(HALF),
            v: place.v.wrapping_sub(HALF),
        };
        let (x, y) = low.texel();
        let part = |a: i32| (a >> (FRACTION - 4)) as u32 & 15;
        let (right, down) = (part(low.u), part(low.v));
        let fetch = |dx: i32, dy: i32| F::expand(self.texture.texel((x + dx, y + dy)));
        let four = [fetch(0, 0), fetch(1, 0), fetch(0, 1), fetch(1, 1)];
        let weights = [
            (16 - right) * (16 - down),
            right * (16 - down),
            (16 - right) * down,
            right * down,
        ];
        mix(
            four,
            weights,
            usize::from(right >= 8) + 2 * usize::from(down >= 8),
        )
    }
}

/// Four texels with weights whose sum is 256.
#[inline(always)]
fn mix(four: [Texel; 4], weights: [u32; 4], nearest: usize) -> Texel {
    // Two channels in a word: 255 times 256 fits 16 bits.
    let pair = |get: fn(&Texel) -> u32| {
        let mut sum = 0x0080_0080u32;
        for (texel, weight) in four.iter().zip(weights) {
            sum += get(texel) * weight;
        }
        sum >> 8
    };
    let rb = pair(|t| u32::from(t.rgb[0]) << 16 | u32::from(t.rgb[2]));
    let ga = pair(|t| u32::from(t.rgb[1]) << 16 | u32::from(t.alpha));
    Texel {
        rgb: [(rb >> 16) as u8, (ga >> 16) as u8, rb as u8],
        alpha: ga as u8,
        undithered: four[nearest & 3].undithered,
    }
}
