//! What becomes of finished colours: dither on whole frames (H10), and overlays (K14).

use crate::common::Rng;
use embedded_graphics::mono_font::MonoTextStyle;
use embedded_graphics::mono_font::ascii::FONT_6X10;
use embedded_graphics::pixelcolor::Rgb888 as Colour;
use embedded_graphics::prelude::*;
use embedded_graphics::text::Text;
use host_tests::lent::{LineRooms, SceneRooms};
use host_tests::mock::{HostLine, MockFrameBuffer};
use scanbeam::overlay::{
    Canvas, DrawnLines, Ink, LineOverlay, Overlay, Sprite, draw_frame_overlaid,
    draw_frame_overlaid_changed,
};
use scanbeam::pipeline::{Forward, GouraudDepth, Interpolated, Pipeline, WordOf, draw_frame};
use scanbeam::pixel::{Dithered, PixelFormat, Pixels, Rgb565, Rgb888};
use scanbeam::scan_out::{Pump, ShownLines};
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

type Smooth = GouraudDepth<Rgb565>;

/// A display of the picture's size, 5 lines a transfer.
fn display() -> Pump<MockFrameBuffer<u16>> {
    let sink = MockFrameBuffer::new(METHOD_WIDTH, METHOD_HEIGHT).late_by(2);
    Pump::new(sink, [HostLine::new(5 * WIDTH), HostLine::new(5 * WIDTH)])
}

fn bar(x: i16, y: i16) -> Sprite<'static, u16> {
    Sprite {
        x,
        y,
        width: 9,
        height: 6,
        pixels: Pixels::Colour(0xF81F),
        ink: Ink::Opaque,
    }
}

#[test]
fn a_bar_that_moves_sends_its_lines_alone() {
    let mut rooms = rooms::<Smooth>();
    let mut scene = rooms.scene(method_screen());
    build_method(&mut scene).unwrap();
    let mut line_rooms = LineRooms::fitting(64, &scene);
    let mut renderer = line_rooms.renderer();
    let mut all = display();
    draw_frame(&scene, &mut renderer, &mut all, 0, 5).unwrap();
    let bare = all.sink().frame().unwrap();
    let mut pump = display();
    let mut hashes = [0; HEIGHT];
    let mut shown = ShownLines::new(&mut hashes);
    let mut last: Option<(i16, i16)> = None;
    let mut rng = Rng::new(0x0E51);
    for _ in 0..20 {
        let at = (rng.within(-12, 70) as i16, rng.within(-8, 50) as i16);
        let sprites = [bar(at.0, at.1)];
        let mut want = bare.clone();
        let mut touched = [false; HEIGHT];
        for (from, paints) in [(Some(at), true), (last, false)] {
            let Some((left, top)) = from else { continue };
            for y in top.max(0)..(top + 6).min(HEIGHT as i16) {
                for x in left.max(0)..(left + 9).min(WIDTH as i16) {
                    touched[y as usize] = true;
                    if paints {
                        want[y as usize * WIDTH + x as usize] = 0xF81F;
                    }
                }
            }
        }
        pump.sink_mut().next_frame();
        let overlay = Overlay::new(&sprites).unwrap();
        let how = (0, 5);
        let stats =
            draw_frame_overlaid_changed(&scene, &mut renderer, &mut pump, how, &mut shown, overlay)
                .unwrap();
        let on_display: Option<Vec<u16>> = pump.sink().shown().iter().copied().collect();
        assert!(on_display.is_some_and(|pixels| pixels == want));
        if last.is_some() {
            let sent = HEIGHT - stats.scan_out.lines_unsent as usize;
            assert!(sent <= touched.iter().filter(|t| **t).count());
        }
        let mut whole = display();
        let overlay = Overlay::new(&sprites).unwrap();
        draw_frame_overlaid(&scene, &mut renderer, &mut whole, 0, 5, overlay).unwrap();
        assert_eq!(whole.sink().frame().unwrap(), want);
        last = Some(at);
    }
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
