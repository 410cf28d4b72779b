//! Draw calls in pixels of a byte: numbers of palettes, a palette for each line (H18), and grey (K12).
//!
//! What number a pixel must have is told by another picture of the same scene, in which each face has a colour of 24
//! bits of its own.

use crate::common::Rng;
use crate::hot::{Corner, LineRooms, SceneRooms, Smooth, camera, draw_with, frame};
use host_tests::mock::{HostLine, MockFrameBuffer};
use scanbeam::frame::{FrameError, LineError, draw_frame_indexed};
use scanbeam::look::{Gouraud, Look};
use scanbeam::pixel::{
    Grey8, Index4, Index8, Indexed, PixelFormat, Rgb888, expand_indices, mono_row,
};
use scanbeam::scan_out::Pump;
use scanbeam::scene::{Blend, BlendMode, DrawError, Scene};
use scanbeam::{Cull, Screen};

const SIZE: (u16, u16) = (53, 41);

fn screen() -> Screen {
    Screen::new(SIZE.0, SIZE.1).expect("a screen")
}

/// Triangles of all sizes and slants, one of a few thin.
fn some_triangles(rng: &mut Rng, count: usize) -> Vec<[Corner; 3]> {
    let one = |rng: &mut Rng| {
        let size = rng.pick(&[6, 40, 200, 900]);
        let middle = [SIZE.0, SIZE.1].map(|side| rng.within(0, 8 * i32::from(side)));
        let w = 1.0 + 6.0 * rng.unit();
        [(); 3].map(|()| Corner {
            at: (
                middle[0] + rng.within(-size, size),
                middle[1] + rng.within(-size, size),
            ),
            w: w * rng.between(1.0, 1.3),
            colour: [0; 3],
        })
    };
    (0..count).map(|_| one(rng)).collect()
}

/// A scene of triangles, each of one colour.
fn with_scene<L: Smooth, R>(
    triangles: &[[Corner; 3]],
    colour: impl Fn(usize) -> [u8; 3],
    see: impl FnOnce(&Scene<'_, '_, L>) -> R,
) -> R {
    let mut rooms = SceneRooms::of_triangles(triangles.len(), screen());
    let mut scene = rooms.scene::<L>(screen());
    scene.begin(&camera()).expect("the rooms are large enough");
    for (number, corners) in triangles.iter().enumerate() {
        let corners = corners.map(|corner| Corner {
            colour: colour(number),
            ..corner
        });
        let dress = |draw: &mut scanbeam::Draw<'_, '_, i32>| draw.cull = Cull::None;
        draw_with(&mut scene, &[corners], dress).expect("there is room");
    }
    see(&scene)
}

/// The number of the triangle at each pixel.
fn seen(triangles: &[[Corner; 3]]) -> Vec<Option<usize>> {
    let number = |number: usize| [1 + number as u8, 0, 0];
    let lines =
        with_scene::<Gouraud<Rgb888>, _>(triangles, number, |scene| frame(scene, 64, true, [0; 3]));
    let face = |[red, _, _]: [u8; 3]| usize::from(red).checked_sub(1);
    lines.into_iter().flatten().map(face).collect()
}

/// Kills: an index that is a step off, a palette of another line, a background that is no index, a skipped line that
/// is not expanded.
fn palettes_are_those_of_lines<const N: usize>(rng: &mut Rng)
where
    Gouraud<Indexed<N>>: Smooth + Look<Pixel = Indexed<N>>,
{
    let mut shown = 0;
    for _ in 0..40 {
        let count = 1 + rng.below(40) as usize;
        let triangles = some_triangles(rng, count);
        let indices: Vec<u8> = (0..count).map(|_| rng.below(N as u32) as u8).collect();
        let mut palettes = [[0u16; N]; 3];
        palettes
            .as_flattened_mut()
            .fill_with(|| rng.below(1 << 16) as u16);
        let of_line: Vec<u8> = (0..SIZE.1).map(|_| rng.below(3) as u8).collect();
        let expand = |line: u16, indices: &[u8], pixels: &mut [u16]| {
            let number = of_line[usize::from(line)];
            expand_indices(indices, &palettes[usize::from(number)], pixels);
        };
        let background = rng.below(N as u32) as u8;
        let transfer = 1 + rng.below(5) as u16;
        let words = usize::from(SIZE.0) * usize::from(transfer);
        let sink = MockFrameBuffer::<u16>::new(SIZE.0, SIZE.1).late_by(rng.below(3));
        let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
        let colour = |number: usize| Indexed::<N>::colour(indices[number]);
        with_scene::<Gouraud<Indexed<N>>, _>(&triangles, colour, |scene| {
            let mut rooms = LineRooms::fitting(scene, rng.pick(&[0, 3, 64]), true);
            let mut renderer = rooms.renderer();
            let mut line = vec![77; usize::from(SIZE.0) + rng.below(2) as usize];
            draw_frame_indexed(
                scene,
                &mut renderer,
                &mut pump,
                background,
                transfer,
                &mut line,
                expand,
            )
            .expect("a frame");
        });
        let got = pump.sink().frame().expect("a whole frame");
        for (i, (got, face)) in got.into_iter().zip(seen(&triangles)).enumerate() {
            let index = face.map_or(background, |face| indices[face]);
            let number = of_line[i / usize::from(SIZE.0)];
            assert_eq!(got, palettes[usize::from(number)][usize::from(index)]);
            shown += usize::from(face.is_some());
        }
    }
    assert!(shown > 20_000, "{shown}");
}

#[test]
fn faces_have_the_colour_of_their_index_on_each_line() {
    let mut rng = Rng::new(1_801);
    palettes_are_those_of_lines::<256>(&mut rng);
    palettes_are_those_of_lines::<16>(&mut rng);
}

/// Kills: a line of bytes that is cut silently.
#[test]
fn a_line_that_is_too_short_is_refused() {
    with_scene::<Gouraud<Index8>, _>(
        &[],
        |_| [0; 3],
        |scene| {
            let mut rooms = LineRooms::fitting(scene, 4, true);
            let mut renderer = rooms.renderer();
            let sink = MockFrameBuffer::<u16>::new(SIZE.0, SIZE.1);
            let mut pump = Pump::new(sink, [HostLine::new(53), HostLine::new(53)]);
            let mut line = [0; 52];
            let drawn = draw_frame_indexed(
                scene,
                &mut renderer,
                &mut pump,
                0,
                1,
                &mut line,
                |_, _, _| {},
            );
            let (needed, have) = (53, 52);
            assert_eq!(
                drawn.expect_err("a byte is missing"),
                FrameError::Line(LineError::Pixels { needed, have })
            );
        },
    );
}

/// Kills: a blend that is drawn in numbers.
#[test]
fn numbers_are_not_blended() {
    let triangles = [[(0, 0), (400, 0), (0, 300)].map(|at| Corner {
        at,
        w: 1.0,
        colour: [9; 3],
    })];
    let mut rooms = SceneRooms::of_triangles(2, screen());
    let mut scene = rooms.scene::<Gouraud<Index4>>(screen());
    scene.begin(&camera()).expect("the rooms are large enough");
    for blend in [
        Blend::filter(255),
        Blend::add(9),
        Blend::new(BlendMode::Replace).writing([true, false, true]),
    ] {
        let dress = |draw: &mut scanbeam::Draw<'_, '_, i32>| draw.blend = Some(blend);
        let drawn = draw_with(&mut scene, &triangles, dress);
        assert_eq!(drawn, Err(DrawError::Indices));
        assert_eq!((scene.objects(), scene.vertices()), (0, 0));
    }
    let text = DrawError::Indices.to_string();
    assert!(text.contains("palette"), "{text}");
    let drawn = draw_with(&mut scene, &triangles, |draw| draw.cull = Cull::None);
    assert_eq!(drawn, Ok(()));
    assert_eq!(scene.objects(), 1);
}

/// The grey of a colour: the weights of the eye.
fn grey([r, g, b]: [u8; 3]) -> f64 {
    (77.0 * f64::from(r) + 150.0 * f64::from(g) + 29.0 * f64::from(b)) / 256.0
}

/// Pixels of grey are the greys of pixels of 24 bits, blended ones too. Kills: channels in another order, a mean of
/// halves, bits that are cut.
#[test]
fn grey_is_what_colours_weigh() {
    let mut rng = Rng::new(1_803);
    for _ in 0..60 {
        let count = 1 + rng.below(30) as usize;
        let mut triangles = some_triangles(&mut rng, count);
        for corner in triangles.as_flattened_mut() {
            corner.colour = [(); 3].map(|()| rng.below(256) as u8);
        }
        let blends: Vec<_> = (0..count)
            .map(|_| match rng.below(6) {
                0 => Some(Blend::filter(rng.below(256) as u8)),
                1 => Some(Blend::new(BlendMode::Half)),
                _ => None,
            })
            .collect();
        fn picture<L: Smooth>(
            triangles: &[[Corner; 3]],
            blends: &[Option<Blend>],
            background: [u8; 3],
        ) -> Vec<crate::hot::WordOf<L>> {
            let mut rooms = SceneRooms::of_triangles(triangles.len(), screen());
            let mut scene = rooms.scene::<L>(screen());
            scene.begin(&camera()).expect("the rooms are large enough");
            for (corners, blend) in triangles.iter().zip(blends) {
                let dress = |draw: &mut scanbeam::Draw<'_, '_, i32>| {
                    (draw.cull, draw.blend) = (Cull::None, *blend);
                };
                draw_with(&mut scene, &[*corners], dress).expect("there is room");
            }
            frame(&scene, 8, true, L::Format::from_rgb8(background)).concat()
        }
        let background = [90, 20, 200];
        let colours = picture::<Gouraud<Rgb888>>(&triangles, &blends, background);
        let greys = picture::<Gouraud<Grey8>>(&triangles, &blends, background);
        let panes = blends.iter().filter(|blend| blend.is_some()).count();
        for (colour, got) in colours.into_iter().zip(greys) {
            let off = f64::from(got) - grey(colour);
            // Half a step, and as much for each pane.
            assert!(
                off.abs() <= 0.51 + panes.min(6) as f64,
                "{got} for {colour:?}"
            );
        }
    }
}

/// A picture of one bit is packed from grey lines. Kills: a white that is not 255, a last pixel that is left out.
#[test]
fn a_grey_line_becomes_bits() {
    let triangles = [[(0, 0), (848, 0), (0, 848)].map(|at| Corner {
        at,
        w: 1.0,
        colour: [255; 3],
    })];
    let lines =
        with_scene::<Gouraud<Grey8>, _>(&triangles, |_| [255; 3], |scene| frame(scene, 8, true, 0));
    let mut bits = [0; 7];
    mono_row(&lines[3], 3, &mut bits);
    assert_eq!(bits, [255, 255, 255, 255, 255, 255, 0b1111_1000]);
}
