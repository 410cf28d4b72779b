//! Textures and overlays of an instruction list, drawn from where they lie (H7, H12, K14).
//!
//! One sampler for all forms: what a texel is made of is asked at each texel, and in exchange the
//! code is there once. Firmware with one form of its own lends [`Textures`] instead.

use super::texels::{TexelOf, TextureSource, Textures};
use super::{LineOverlay, PixelFormat};
use crate::geometry::texturing::{LevelEnds, SpanPlace};
use crate::list::{OverlaySlot, OverlaySlots, Picture, TextureSlot, TextureSlots};
use crate::shade::Stretch;
use crate::shade::texture::{Texels, Uv};
use crate::visible::Visible;

/// The textures of a list, for [`Scene::set_textures`](crate::Scene::set_textures).
///
/// A list that is not in one piece, such as a ring, has none.
#[derive(Clone, Copy, Debug, Default)]
pub struct ListTextures<'t> {
    /// The words of the list.
    pub words: &'t [u32],
    /// The slots that its [`ListMemory`](crate::ListMemory) has too.
    pub slots: &'t [TextureSlot],
}

/// A texel of a list: red, green, blue and alpha.
#[derive(Clone, Copy, Debug)]
pub struct ListTexel([u8; 4]);

impl ListTexel {
    #[inline(always)]
    const fn rgb(self) -> [u8; 3] {
        let [r, g, b, _] = self.0;
        [r, g, b]
    }
}

impl<F: PixelFormat> TexelOf<F> for ListTexel {
    #[inline(always)]
    fn word(self) -> F::Word {
        F::from_rgb8(self.rgb())
    }

    #[inline(always)]
    fn levels(self) -> [u8; 3] {
        self.rgb()
    }
}

/// A picture of a list as a texture.
struct Listed<'t>(Picture<'t>);

impl Texels for Listed<'_> {
    type Texel = ListTexel;

    #[inline(always)]
    fn at(&self, place: Uv) -> ListTexel {
        ListTexel(self.0.at(place.texel()))
    }
}

impl<F: PixelFormat> TextureSource<F> for ListTextures<'_> {
    #[inline]
    fn fetches(&self, index: u16) -> u32 {
        let picture = TextureSlots(self.slots).picture(index, self.words);
        u32::from(picture.is_some())
    }

    fn paint(
        &self,
        index: u16,
        pixels: &mut [F::Word],
        course: (SpanPlace, &LevelEnds),
        stretch: Stretch,
        visible: &mut impl Visible,
    ) -> bool {
        let Some(picture) = TextureSlots(self.slots).picture(index, self.words) else {
            return false;
        };
        let one = [Listed(picture)];
        TextureSource::<F>::paint(&Textures(&one), 0, pixels, course, stretch, visible)
    }
}

/// The overlays of a list, for [`draw_frame_overlaid`](crate::draw_frame_overlaid). Each pixel is
/// expanded where it is painted.
///
/// A list that is not in one piece, such as a ring, has none.
#[derive(Clone, Copy, Debug, Default)]
pub struct ListOverlays<'t> {
    /// The words of the list.
    pub words: &'t [u32],
    /// The slots that its [`ListMemory`](crate::ListMemory) has too.
    pub slots: &'t [OverlaySlot],
}

impl<F: PixelFormat> LineOverlay<F> for ListOverlays<'_> {
    fn paint(&mut self, line: u16, pixels: &mut [F::Word]) {
        for row in OverlaySlots(self.slots).on(line, self.words) {
            let below = pixels.get_mut(usize::from(row.left)..).unwrap_or_default();
            for (column, pixel) in (0..row.width).zip(below) {
                let [r, g, b, alpha] = row.rgba(column);
                if alpha == 0 {
                    continue;
                }
                let word = F::from_rgb8([r, g, b]);
                *pixel = if row.additive {
                    F::add(*pixel, word)
                } else {
                    word
                };
            }
        }
    }
}
