//! What becomes of finished colours: dither on whole frames (H10), and overlays (K14).

use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::Rgb888 as Colour;
use embedded_graphics::prelude::*;
use embedded_graphics::text::Text;
use host_tests::lent::{LineRooms, SceneRooms};
use scanbeam::overlay::{Canvas, DrawnLines, Ink, LineOverlay, Overlay, Sprite};
use scanbeam::pipeline::{Forward, GouraudDepth, Interpolated, Pipeline, WordOf};
use scanbeam::pixel::{Dithered, PixelFormat, Pixels, Rgb565, Rgb888};
use scenes::{METHOD_HEIGHT, METHOD_WIDTH, build_method, method_screen};

const WIDTH: usize = METHOD_WIDTH as usize;
const HEIGHT: usize = METHOD_HEIGHT as usize;

fn rooms<P: Pipeline>() -> SceneRooms<P> {
    SceneRooms::new(256, 256, HEIGHT)
}

/// The picture of a room of large triangles and a ribbon of small ones, its lines drawn in the
/// order given.
fn picture<P: Pipeline>(slots: usize, lines: impl Iterator<Item = usize>) -> Vec<Vec<WordOf<P>>> {
    let mut rooms = rooms::<P>();
    let mut scene = rooms.scene(method_screen());
    build_method(&mut scene).unwrap();
    let mut line_rooms = LineRooms::<P>::fitting(slots, &scene);
    let mut renderer = line_rooms.renderer();
    let mut picture = vec![vec![P::Pixel::from_rgb8([0; 3]); WIDTH]; HEIGHT];
    for line in lines {
        renderer
            .draw_line(&scene, line as u16, &mut picture[line])
            .unwrap();
    }
    picture
}

#[test]
fn dithered_frames_are_less_than_a_step_off_and_always_the_same() {
    type Fine = Interpolated<GouraudDepth<Rgb888>, Forward>;
    type Look = GouraudDepth<Dithered<Rgb565>>;
    let exact = picture::<Fine>(64, 0..HEIGHT);
    let dithered = picture::<Look>(64, 0..HEIGHT);
    let plain = picture::<GouraudDepth<Rgb565>>(64, 0..HEIGHT);
    let (mut sum, mut other) = ([0.0; 3], 0);
    for y in 0..HEIGHT {
        for x in 0..WIDTH {
            let word = dithered[y][x];
            let got = [word >> 11, word >> 5 & 63, word & 31];
            for i in 0..3 {
                let steps = f64::from(Rgb565::STEPS[i]);
                let want = f64::from(exact[y][x][i]) * steps / 255.0;
                let off = f64::from(got[i]) - want;
                // One step, half a level of what is compared with, and vertices' rounding.
                let bound = 1.0 + 1.1 * steps / 255.0;
                assert!(off.abs() <= bound, "{x} {y} {i}: {off}");
                sum[i] += off;
            }
            other += usize::from(word != plain[y][x]);
        }
    }
    for (i, sum) in sum.into_iter().enumerate() {
        let mean = sum / (WIDTH * HEIGHT) as f64;
        assert!(mean.abs() < 0.03, "{i}: {mean}");
    }
    assert!(other > WIDTH * HEIGHT / 4, "{other}");
    // Any cache, and lines alone from the last to the first.
    assert_eq!(picture::<Look>(0, 0..HEIGHT), dithered);
    assert_eq!(picture::<Look>(3, (0..HEIGHT).rev()), dithered);
}

#[test]
fn text_is_the_same_as_a_sprite_by_lines_and_on_a_whole_picture() {
    let style = MonoTextStyle::new(&FONT_6X10, Colour::new(255, 255, 255));
    let at = Point::new(7, 20);
    let text = Text::new("Speed 42", at, style);
    let mut whole = vec![0x1234u16; WIDTH * HEIGHT];
    text.draw(&mut Canvas::<Rgb565>::new(
        &mut whole,
        Point::zero(),
        METHOD_WIDTH,
    ))
    .unwrap();
    let white = whole.iter().filter(|word| **word == 0xFFFF).count();
    assert!(white > 60, "{white}");
    // Line by line.
    let mut lines = vec![0x1234u16; WIDTH * HEIGHT];
    let mut drawn = DrawnLines::new(|canvas: &mut Canvas<'_, Rgb565>| {
        text.draw(canvas).unwrap();
    });
    for (line, pixels) in (0..).zip(lines.chunks_mut(WIDTH)) {
        drawn.paint(line, pixels);
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
