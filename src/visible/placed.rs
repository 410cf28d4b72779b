//! Where the pixels of a span are, for formats that dither (H10).

use super::Visible;

/// What `V` says, and the place of each pixel.
#[derive(Debug)]
pub struct Placed<'v, V> {
    visible: &'v mut V,
    column: i32,
    line: i32,
}

impl<'v, V: Visible> Placed<'v, V> {
    /// From this column and line on.
    #[inline(always)]
    pub fn new(visible: &'v mut V, column: i32, line: i32) -> Self {
        Self {
            visible,
            column,
            line,
        }
    }
}

impl<V: Visible> Visible for Placed<'_, V> {
    const ALL: bool = V::ALL;

    #[inline(always)]
    fn tile(&self) -> (u8, u8) {
        ((self.column & 3) as u8, (self.line & 3) as u8)
    }

    #[inline(always)]
    fn each<W>(&mut self, pixels: &mut [W], each: impl FnMut(&mut W, bool)) {
        self.column += pixels.len() as i32;
        self.visible.each(pixels, each);
    }

    #[inline(always)]
    fn block<W, const N: usize>(&mut self, pixels: &mut [W; N], each: impl FnMut(&mut W, bool)) {
        self.column += N as i32;
        self.visible.block(pixels, each);
    }
}
