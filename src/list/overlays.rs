//! Overlays of a list: rectangles of pixels over the picture, read where they lie (K14).
//!
//! A list leaves them in slots that the application lends; who draws the lines reads them there,
//! on another core too.

use super::block::Overlay;
use super::texels::{Texels, form_of_code};
use core::sync::atomic::{AtomicU32, Ordering};

/// Room for one overlay.
#[derive(Debug, Default)]
pub struct OverlaySlot {
    /// Bit 31: in use; 3..0 the form, 4 added, 15..8 colours less one.
    name: AtomicU32,
    /// Left and top, lower half first; width and height; position of the pixels, and of the colours.
    words: [AtomicU32; 4],
}

impl OverlaySlot {
    /// Empty.
    #[must_use]
    pub const fn new() -> Self {
        Self {
            name: AtomicU32::new(0),
            words: [const { AtomicU32::new(0) }; 4],
        }
    }
}

const IN_USE: u32 = 1 << 31;

/// The overlays of a list, the later ones on top.
#[derive(Clone, Copy, Debug, Default)]
pub struct OverlaySlots<'m>(
    /// The slots.
    pub &'m [OverlaySlot],
);

impl<'m> OverlaySlots<'m> {
    /// Forgets all.
    pub fn clear(self) {
        for slot in self.0 {
            slot.name.store(0, Ordering::Relaxed);
        }
    }

    /// Keeps one, with the position and the number of its colours, 1 to 256, where it needs some;
    /// `false`: no slot is free.
    #[must_use]
    pub fn push(self, overlay: &Overlay, colours: u32, count: u32) -> bool {
        let free = |s: &&OverlaySlot| s.name.load(Ordering::Relaxed) == 0;
        let Some(slot) = self.0.iter().find(free) else {
            return false;
        };
        let pair = |low: u16, high: u16| u32::from(low) | u32::from(high) << 16;
        let place = pair(overlay.left, overlay.top);
        let size = pair(overlay.width, overlay.height);
        for (to, word) in slot.words.iter().zip([place, size, overlay.at, colours]) {
            to.store(word, Ordering::Relaxed);
        }
        let name = overlay.form as u32
            | u32::from(overlay.additive) << 4
            | (count.saturating_sub(1) & 0xFF) << 8;
        slot.name.store(IN_USE | name, Ordering::Relaxed);
        true
    }

    /// What lies on a line of the picture, from the lowest to the topmost, out of the words of the
    /// list.
    pub fn on<'w>(self, line: u16, words: &'w [u32]) -> impl Iterator<Item = OverlayRow<'w>> + 'm
    where
        'w: 'm,
    {
        let row = move |slot: &OverlaySlot| {
            let name = slot.name.load(Ordering::Relaxed);
            let words_of = slot.words.each_ref().map(|w| w.load(Ordering::Relaxed));
            let [place, size, at, colours_at] = words_of;
            let row = line.checked_sub((place >> 16) as u16)?;
            if name & IN_USE == 0 || u32::from(row) >= size >> 16 {
                return None;
            }
            let form = form_of_code(name & 15);
            let mut colours: &[u32] = &[];
            if form.is_indexed() {
                let from = words.get(colours_at as usize..)?;
                colours = from.get(..=(name >> 8 & 0xFF) as usize)?;
            }
            let width = size as u16;
            Some(OverlayRow {
                left: place as u16,
                width,
                additive: name >> 4 & 1 != 0,
                first: u32::from(row) * u32::from(width),
                texels: Texels::new(words.get(at as usize..)?, form, colours),
            })
        };
        self.0.iter().filter_map(row)
    }
}

/// A row of an overlay.
#[derive(Clone, Copy, Debug)]
pub struct OverlayRow<'w> {
    /// Column of the first pixel.
    pub left: u16,
    /// Pixels.
    pub width: u16,
    /// They are added.
    pub additive: bool,
    /// The texel of the pixel at the left.
    pub first: u32,
    /// Those of the whole overlay.
    pub texels: Texels<'w>,
}
