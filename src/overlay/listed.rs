//! Overlays of an instruction list, painted from where they lie (K14).

use crate::list::{OverlaySlot, OverlaySlots};
use crate::pixel::PixelFormat;

/// The overlays of a list, for [`draw_frame_overlaid`](crate::frame::draw_frame_overlaid). Each pixel is
/// expanded where it is painted.
///
/// A list that is not in one piece, such as a ring, has none.
#[derive(Clone, Copy, Debug, Default)]
pub struct ListOverlays<'t> {
    /// The words of the list.
    pub words: &'t [u32],
    /// The slots that its [`PlayerMemory`](crate::input::PlayerMemory) has too.
    pub slots: &'t [OverlaySlot],
}

impl ListOverlays<'_> {
    /// Paints over `line` of the picture, all of whose pixels are there, before it is sent.
    pub fn paint<F: PixelFormat>(&self, line: u16, pixels: &mut [F::Word]) {
        for row in OverlaySlots(self.slots).on(line, self.words) {
            let below = pixels.get_mut(usize::from(row.left)..).unwrap_or_default();
            for (texel, pixel) in (row.first..).zip(below).take(row.width.into()) {
                let [r, g, b, alpha] = row.texels.rgba(texel);
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
