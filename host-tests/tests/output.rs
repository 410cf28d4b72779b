//! What lies over finished lines: overlays (K14).

use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::Rgb888 as Colour;
use embedded_graphics::prelude::*;
use embedded_graphics::text::Text;
use scanbeam::overlay::{Canvas, Ink, Overlay, Pixels, Sprite};
use scanbeam::pixel::Rgb565;

const WIDTH: usize = 64;
const HEIGHT: usize = 48;

#[test]
fn text_is_the_same_as_a_sprite_by_lines_and_on_a_whole_picture() {
    let style = MonoTextStyle::new(&FONT_6X10, Colour::new(255, 255, 255));
    let at = Point::new(7, 20);
    let text = Text::new("Speed 42", at, style);
    let mut whole = vec![0x1234u16; WIDTH * HEIGHT];
    text.draw(&mut Canvas::<Rgb565>::new(
        &mut whole,
        Point::zero(),
        WIDTH as u16,
    ))
    .unwrap();
    let white = whole.iter().filter(|word| **word == 0xFFFF).count();
    assert!(white > 60, "{white}");
    // Line by line.
    let mut lines = vec![0x1234u16; WIDTH * HEIGHT];
    for (line, pixels) in (0..).zip(lines.chunks_mut(WIDTH)) {
        text.draw(&mut Canvas::<Rgb565>::of_line(line, pixels))
            .unwrap();
    }
    assert_eq!(lines, whole);
    // Once, into a sprite.
    let area = text.bounding_box();
    let size = (area.size.width as u16, area.size.height as u16);
    let mut image = vec![0u16; usize::from(size.0) * usize::from(size.1)];
    text.draw(&mut Canvas::<Rgb565>::new(
        &mut image,
        area.top_left,
        size.0,
    ))
    .unwrap();
    let sprites = [Sprite {
        x: area.top_left.x as i16,
        y: area.top_left.y as i16,
        width: size.0,
        height: size.1,
        pixels: Pixels::Image(&image),
        ink: Ink::Keyed(0),
    }];
    let mut overlay = Overlay::<Rgb565>::new(&sprites).unwrap();
    let mut painted = vec![0x1234u16; WIDTH * HEIGHT];
    for (line, pixels) in (0..).zip(painted.chunks_mut(WIDTH)) {
        overlay.paint(line, pixels);
    }
    assert_eq!(painted, whole);
}
