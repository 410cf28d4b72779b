//! Drawables of `embedded-graphics` as overlays: text, lines, pictures (K14).
//!
//! A [`Canvas`] is a rectangle of words that they can be drawn into. Of the size of a sprite it is
//! drawn once and then costs what its pixels cost; [of a line](Canvas::of_line) that is drawn, it
//! needs no memory, but every drawable goes through all its pixels on every line.

use crate::pixel::PixelFormat;
use core::convert::Infallible;
use core::marker::PhantomData;
use embedded_graphics_core::Pixel;
use embedded_graphics_core::draw_target::DrawTarget;
use embedded_graphics_core::geometry::{Dimensions, Point, Size};
use embedded_graphics_core::pixelcolor::{PixelColor, Rgb888, RgbColor};
use embedded_graphics_core::primitives::Rectangle;

/// Words of the format `F` that drawables with colours `C` are drawn into, clipped at all sides.
#[derive(Debug)]
pub struct Canvas<'c, F: PixelFormat, C = Rgb888> {
    pixels: &'c mut [F::Word],
    area: Rectangle,
    colours: PhantomData<C>,
}

impl<'c, F: PixelFormat, C> Canvas<'c, F, C> {
    /// A canvas whose upper left pixel is at `origin`, `width` pixels wide and as high as there
    /// are pixels for; those left over are not used.
    pub fn new(pixels: &'c mut [F::Word], origin: Point, width: u16) -> Self {
        // No picture has more lines.
        let height = (pixels.len() / usize::from(width.max(1))).min(1 << 15);
        let height = if width == 0 { 0 } else { height as u32 };
        Self {
            pixels,
            area: Rectangle::new(origin, Size::new(width.into(), height)),
            colours: PhantomData,
        }
    }

    /// A line of the picture, in coordinates of the picture.
    pub fn of_line(line: u16, pixels: &'c mut [F::Word]) -> Self {
        let width = pixels.len().min(usize::from(u16::MAX)) as u16;
        Self::new(pixels, Point::new(0, line.into()), width)
    }

    /// The pixels of a line from `from` on, at most so many; all inside the area.
    fn run(&mut self, from: Point, count: u32) -> Option<&mut [F::Word]> {
        let (x, y) = (from.x - self.area.top_left.x, from.y - self.area.top_left.y);
        let at = y as usize * self.area.size.width as usize + x as usize;
        self.pixels.get_mut(at..at + count as usize)
    }
}

fn word<F: PixelFormat>(colour: impl Into<Rgb888>) -> F::Word {
    let colour = colour.into();
    F::from_rgb8([colour.r(), colour.g(), colour.b()])
}

impl<F: PixelFormat, C> Dimensions for Canvas<'_, F, C> {
    fn bounding_box(&self) -> Rectangle {
        self.area
    }
}

impl<F: PixelFormat, C: PixelColor + Into<Rgb888>> DrawTarget for Canvas<'_, F, C> {
    type Color = C;
    type Error = Infallible;

    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<C>>,
    {
        for Pixel(at, colour) in pixels {
            if self.area.contains(at) {
                if let Some([pixel]) = self.run(at, 1) {
                    *pixel = word::<F>(colour);
                }
            }
        }
        Ok(())
    }

    fn fill_solid(&mut self, area: &Rectangle, colour: C) -> Result<(), Infallible> {
        let seen = area.intersection(&self.area);
        let word = word::<F>(colour);
        for line in seen.rows() {
            if let Some(run) = self.run(Point::new(seen.top_left.x, line), seen.size.width) {
                F::fill(run, word);
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pixel::Rgb565;

    /// Kills: a canvas that fills nothing; what lies beside it, or above.
    #[test]
    fn rectangles_are_filled_where_the_canvas_is() {
        for x in -7..9 {
            for y in -6..8 {
                for (width, height) in [(0, 3), (1, 1), (3, 2), (12, 9)] {
                    let area = Rectangle::new(Point::new(x, y), Size::new(width, height));
                    let (mut filled, mut dotted) = ([7u16; 23], [7u16; 23]);
                    let colour = Rgb888::new(255, 0, 255);
                    let origin = Point::new(-2, 1);
                    let mut canvas = Canvas::<Rgb565>::new(&mut filled, origin, 5);
                    assert_eq!(canvas.fill_solid(&area, colour), Ok(()));
                    // Four lines of five pixels from (-2, 1) on; the three that are left over stay.
                    for (i, pixel) in dotted.iter_mut().enumerate().take(20) {
                        let at = [i as i32 % 5 - 2 - x, i as i32 / 5 + 1 - y];
                        if (0..width as i32).contains(&at[0]) && (0..height as i32).contains(&at[1])
                        {
                            *pixel = 0xF81F;
                        }
                    }
                    assert_eq!(filled, dotted, "{area:?}");
                }
            }
        }
        let mut pixels = [7; 4];
        let none = Canvas::<Rgb565>::new(&mut pixels, Point::zero(), 0);
        assert_eq!(none.area.size, Size::zero());
    }
}
