//! Light at each pixel: the choice of a pipeline (K10).

use super::{Levels, Stretch};
use crate::geometry::PixelLamps;

/// What lights pixels: lent to a scene like its textures, or `()` where all light falls on vertices
/// and faces.
pub trait PixelLights: Copy + Default + Send + Sync {
    /// Whether there may be any.
    const SHINE: bool;

    /// The colour of one pixel of guard space in the light of its lamps, of formats with so many
    /// bits and steps a channel.
    fn lit<L: Levels>(&self, levels: &L, at: (i32, i32), format: ([u32; 3], [u16; 3])) -> Stretch;
}

impl PixelLights for () {
    const SHINE: bool = false;

    #[inline(always)]
    fn lit<L: Levels>(&self, levels: &L, (x, y): (i32, i32), _: ([u32; 3], [u16; 3])) -> Stretch {
        levels.stretch(x, y)
    }
}

/// Lamps by number; the shading is [`Phong`](crate::light::Phong). What names none is drawn unlit.
#[derive(Clone, Copy, Debug, Default)]
pub struct Lamplight<'l>(
    /// The lamps.
    pub &'l [PixelLamps],
);

impl PixelLights for Lamplight<'_> {
    const SHINE: bool = true;

    #[inline]
    fn lit<L: Levels>(
        &self,
        levels: &L,
        (column, line): (i32, i32),
        (bits, steps): ([u32; 3], [u16; 3]),
    ) -> Stretch {
        let stretch = levels.stretch(column, line);
        let Some((lamps, normal)) = levels.normal(column, line) else {
            return stretch;
        };
        let Some(lamps) = self.0.get(usize::from(lamps)) else {
            return stretch;
        };
        let wide = stretch.first(bits);
        Stretch::Channels(lamps.lit(normal, (column, line), wide, steps), [0; 3])
    }
}

impl Stretch {
    /// The first colour, in 16.16 steps plus one half.
    #[inline]
    fn first(&self, bits: [u32; 3]) -> [i32; 3] {
        match *self {
            Self::Constant(steps) => steps.map(|s| (i32::from(s) << 16) + (1 << 15)),
            Self::Packed {
                red_blue, green, ..
            } => {
                // 16 bits a channel, the upper ones whole steps.
                let (pair, green) = (red_blue as u32, green as u32);
                let channels = [pair >> 16, green >> 16, pair & 0xFFFF];
                [0, 1, 2].map(|i| (channels[i] << bits[i]) as i32)
            }
            Self::Channels(channels, _) => channels,
        }
    }
}
