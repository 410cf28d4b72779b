//! Textures and overlays of an instruction list, drawn from where they lie (H7, H12, K14).
//!
//! What a texel is made of is asked once a span. There are loops for three kinds of forms: indexed
//! ones of all sizes, which differ in a shift and a mask, 16 bits, and the larger direct ones. The
//! crate of `examples/scenes` takes 5.9 million instructions a frame on a Cortex-M4; where each
//! texel asked for its form, and for each a function was called, it took 8.8.
//! Firmware with one form of its own lends [`Textures`] instead.

use super::texel::TexelOf;
use super::texels::{TextureSource, Textures};
use super::{LineOverlay, PixelFormat};
use crate::geometry::texturing::{LevelEnds, Period, SpanPlace};
use crate::list::{
    Codes, Direct, Fields, OverlaySlot, OverlaySlots, Picture, Reading, TexelForm, TextureSlot,
    TextureSlots,
};
use crate::shade::Stretch;
use crate::shade::texture::{Texels, Uv, place_by_place};
use crate::visible::Visible;

/// The textures of a list, for [`Scene::set_textures`](crate::pipeline::Scene::set_textures).
///
/// A list that is not in one piece, such as a ring, has none.
#[derive(Clone, Copy, Debug, Default)]
pub struct ListTextures<'t> {
    /// The words of the list.
    pub words: &'t [u32],
    /// The slots that its [`ListMemory`](crate::input::ListMemory) has too.
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

/// A picture of a list as a texture, and how its texels are read.
#[derive(Clone, Copy)]
struct Listed<'t, R>(Picture<'t>, R);

impl<R: Reading> Texels for Listed<'_, R> {
    type Texel = ListTexel;
    const LONG: bool = true;

    #[inline(always)]
    fn at(&self, place: Uv) -> ListTexel {
        ListTexel(self.0.at(place.texel(), self.1))
    }

    #[inline(always)]
    fn singly<W>(
        &self,
        pixels: &mut [W],
        from: Uv,
        step: Uv,
        visible: &mut impl Visible,
        each: impl FnMut(&mut W, Option<ListTexel>),
    ) {
        // A copy that nothing else can see stays in registers whatever is written meanwhile.
        let texture = *self;
        let at = |place: Uv| texture.at(place);
        place_by_place(pixels, (from, step), visible, at, each);
    }
}

impl<F: PixelFormat> TextureSource<F> for ListTextures<'_> {
    fn period(&self, index: u16) -> Period {
        // Sides are up to 1,024 texels.
        match TextureSlots(self.slots).is_clamped(index) {
            Some(true) => Period::Never,
            Some(false) => Period::Short,
            None => Period::Long,
        }
    }

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
        match (Codes::of(picture.form()), picture.form()) {
            (Some(codes), _) => one::<F, _>((picture, codes), pixels, course, stretch, visible),
            (None, TexelForm::Rgb565) => {
                one::<F, _>((picture, Fields), pixels, course, stretch, visible)
            }
            (None, form) => one::<F, _>((picture, Direct(form)), pixels, course, stretch, visible),
        }
    }
}

/// Draws a span with a picture whose texels are read so.
#[inline(always)]
fn one<F: PixelFormat, R: Reading>(
    (picture, reading): (Picture<'_>, R),
    pixels: &mut [F::Word],
    course: (SpanPlace, &LevelEnds),
    stretch: Stretch,
    visible: &mut impl Visible,
) -> bool {
    let one = [Listed(picture, reading)];
    TextureSource::<F>::paint(&Textures(&one), 0, pixels, course, stretch, visible)
}

/// The overlays of a list, for [`draw_frame_overlaid`](crate::overlay::draw_frame_overlaid). Each pixel is
/// expanded where it is painted.
///
/// A list that is not in one piece, such as a ring, has none.
#[derive(Clone, Copy, Debug, Default)]
pub struct ListOverlays<'t> {
    /// The words of the list.
    pub words: &'t [u32],
    /// The slots that its [`ListMemory`](crate::input::ListMemory) has too.
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
