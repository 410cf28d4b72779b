//! Colours of pixels of 24 bits against those of exact planes.

use super::triangles::{FRAME, OBJECT, set_up, state_of};
use crate::geometry::Colour;
use crate::look::{Fill, Gouraud, Look, Place, Textured};
use crate::num::random::Rng;
use crate::pixel::{PixelFormat, Rgb888, Xrgb8888};
use crate::scene::{Budget, Draws, ORIGIN, Vertex};
use crate::span::{Size, Triangle};

fn triangle_of(vertices: &[Vertex; 3]) -> Triangle<'_> {
    Triangle {
        vertex: vertices.each_ref(),
        object: &OBJECT,
        places: &[],
        frame: FRAME,
    }
}

/// How far one pixel of a random thin triangle is from the plane through its corners, in levels; `None` where it has no
/// pixel in its middle, or is not thin.
fn off<F: PixelFormat>(rng: &mut Rng) -> Option<f64> {
    let places = [(); 3].map(|()| [(); 2].map(|()| 80 + rng.below(200) as i32));
    let base = [(); 3].map(|()| rng.below(1_000));
    let colours = [(); 3].map(|()| base.map(|field| field + rng.below(24)));
    let vertices = [0, 1, 2].map(|i| {
        let ([x, y], [red, green, blue]) = (places[i], colours[i]);
        Vertex {
            place: ((8 * ORIGIN + y) as u32) << 16 | (8 * ORIGIN + x) as u32,
            depth: 1 << 27,
            colour: red << 21 | blue << 11 | green,
        }
    });
    let triangle = triangle_of(&vertices);
    let across = |to: [i32; 2], from: [i32; 2], at: [i32; 2]| {
        (to[0] - from[0]) * (at[1] - from[1]) - (to[1] - from[1]) * (at[0] - from[0])
    };
    let [a, b, c] = places;
    let area = across(b, a, c);
    let is_top = (a[1], a[0]) < (b[1], b[0]) && (a[1], a[0]) < (c[1], c[0]);
    if area <= 0 || !is_top || triangle.size(triangle.area()) != Size::Sharp {
        return None;
    }
    let pixel = [0, 1].map(|i| (a[i] + b[i] + c[i]) / 24);
    let at = pixel.map(|p| 8 * p + 4);
    let parts = [across(c, b, at), across(a, c, at), across(b, a, at)];
    let draws = [state_of(None, Budget::FAST)];
    let draws = Draws::new(&draws);
    let (fill, planes) = set_up::<Gouraud<F>>(&triangle, &draws);
    if parts.iter().any(|&part| part < 0) || fill == Fill::Thin {
        return None;
    }
    let [column, line] = pixel.map(|p| p as u32);
    let place = Place {
        span: column,
        end: column + 1,
        column,
        line,
    };
    let mut run = [F::Word::default()];
    Gouraud::<F>::fill(fill, &planes, place, draws.states, &mut run);
    let got = F::to_rgb8(run[0]);
    let offs = [0, 1, 2].map(|k| {
        let sum: i32 = (0..3).map(|i| parts[i] * colours[i][k] as i32).sum();
        let levels = f64::from(sum) / f64::from(area) / [8.0, 8.0, 4.0][k];
        (f64::from(got[k]) - levels).abs()
    });
    Some(offs.into_iter().fold(0.0, f64::max))
}

/// Kills: one colour for all of a thin triangle whose corners differ by a step of 5 bits, where pixels have 8.
#[test]
fn thin_triangles_of_24_bits_have_their_colours_to_a_level() {
    let mut rng = Rng(41);
    let (mut count, mut worst) = (0, 0f64);
    while count < 2_000 {
        for off in [off::<Rgb888>(&mut rng), off::<Xrgb8888>(&mut rng)] {
            (count, worst) = off.map_or((count, worst), |off| (count + 1, worst.max(off)));
        }
    }
    std::println!("{worst} levels");
    assert!(worst < 1.05, "{worst}");
}

/// Kills: the margin of a shade taken for light, or one of another size.
#[test]
fn what_has_one_colour_and_no_texture_has_that_colour_in_24_bits() {
    fn drawn<F: PixelFormat>(colour: [u8; 3]) -> [u8; 3]
    where
        Textured<F>: Look<Pixel = F>,
    {
        let colour = Colour::from_rgb8(colour, &Textured::<F>::SCALE).word();
        let vertices = [[80, 80], [240, 80], [80, 240]].map(|[x, y]| Vertex {
            place: ((8 * ORIGIN + y) as u32) << 16 | (8 * ORIGIN + x) as u32,
            depth: 1 << 27,
            colour,
        });
        let triangle = triangle_of(&vertices);
        let draws = [state_of(None, Budget::FAST)];
        let draws = Draws::new(&draws);
        let (fill, planes) = set_up::<Textured<F>>(&triangle, &draws);
        let mut run = [F::Word::default(); 3];
        let place = Place {
            span: 12,
            end: 15,
            column: 12,
            line: 12,
        };
        Textured::<F>::fill(fill, &planes, place, draws.states, &mut run);
        assert!(
            run.iter()
                .all(|word| F::to_rgb8(*word) == F::to_rgb8(run[0]))
        );
        F::to_rgb8(run[0])
    }
    for level in 0..=255 {
        let colour = [level, 255 - level, level ^ 0x55];
        assert_eq!(drawn::<Rgb888>(colour), colour);
        assert_eq!(drawn::<Xrgb8888>(colour), colour);
    }
}

/// Kills: a channel that steps taken for one that does not, or in the place of another.
#[test]
fn a_channel_that_alone_changes_does_so_in_24_bits() {
    for channel in 0..3 {
        let vertices = [[80, 80], [240, 80], [80, 240]].map(|[x, y]| {
            let mut rgb = [90; 3];
            rgb[channel] = if x == 240 { 240 } else { 20 };
            Vertex {
                place: ((8 * ORIGIN + y) as u32) << 16 | (8 * ORIGIN + x) as u32,
                depth: 1 << 27,
                colour: Colour::from_rgb8(rgb, &Gouraud::<Rgb888>::SCALE).word(),
            }
        });
        let draws = [state_of(None, Budget::FAST)];
        let draws = Draws::new(&draws);
        let (fill, planes) = set_up::<Gouraud<Rgb888>>(&triangle_of(&vertices), &draws);
        let place = Place {
            span: 10,
            end: 26,
            column: 10,
            line: 12,
        };
        let mut run = [[0; 3]; 16];
        Gouraud::<Rgb888>::fill(fill, &planes, place, draws.states, &mut run);
        for (column, got) in (10..).zip(run) {
            let mut want = [90.0; 3];
            want[channel] = 20.0 + 220.0 * (f64::from(column) - 9.5) / 20.0;
            for i in 0..3 {
                assert!(
                    (f64::from(got[i]) - want[i]).abs() < 1.5,
                    "{column}: {got:?}"
                );
            }
        }
    }
}
