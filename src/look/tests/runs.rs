//! Runs of a span, each coloured alone, have the bits of the whole span.

use super::super::fetch::packed;
use super::super::fields::fields;
use super::super::mapping::Mapping;
use super::super::{Fill, Gouraud, Look, Parts, Place, Textured, ThinSpan, WordOf};
use super::triangles::{FRAME, OBJECT, inside, set_up, some_triangle, state_of};
use super::{FRACTION, Texels, Uv, WRAPS, draw_mapped, some_texture};
use crate::num::random::Rng;
use crate::pixel::{Rgb565, Rgb565Be, Rgb888};
use crate::scene::{Budget, Draws, ORIGIN, Texture, TexturePlace, Vertex};
use crate::span::Triangle;
use std::vec::Vec;

const BUDGETS: [Budget; 4] = [
    Budget::FAST,
    Budget::new(32),
    Budget::BALANCED,
    Budget::EXACT,
];

/// Draws a span of some pixels as a whole, and in runs; the first pixel in which they differ.
fn difference<W: Copy + Default + PartialEq>(
    rng: &mut Rng,
    place: Place,
    mut draw: impl FnMut(Place, &mut [W]),
) -> Option<usize> {
    let mut whole = std::vec![W::default(); place.pixels() as usize];
    let mut cut = whole.clone();
    draw(place, &mut whole);
    let most = [3, 12, 70][rng.below(3) as usize];
    let (mut at, mut rest) = (place, &mut cut[..]);
    while !rest.is_empty() {
        let pixels = (1 + rng.below(most) as usize).min(rest.len());
        let (run, more) = rest.split_at_mut(pixels);
        draw(at, run);
        at.column += pixels as u32;
        rest = more;
    }
    whole.iter().zip(&cut).position(|(a, b)| a != b)
}

#[test]
fn texels_do_not_depend_on_runs() {
    let (texels, mut rng) = (Texels::new(), Rng(21));
    let (mut methods, mut quick, mut spans) = ([0; 3], [0; 2], 0);
    for i in 0..12_000 {
        let size = [12.0, 24.0, 60.0, 300.0][i % 4];
        let width = 600.0 * rng.unit().powi(3) + 1.0;
        let Some(corners) = some_triangle(&mut rng, size, width) else {
            continue;
        };
        let (mut form, mut sides) = some_texture(&mut rng, 8);
        if i % 3 != 0 {
            (form, sides) = (0, [32 << (i / 3 % 4); 2]);
        }
        let wrap = WRAPS[if i % 5 == 0 { i / 5 % 3 } else { 0 }];
        let budget = BUDGETS[i % 7 % 4];
        let texture = texels.texture(form, sides).wrapping(wrap);
        let Some(mapping) = Mapping::new(&corners, &texture, budget) else {
            continue;
        };
        methods[mapping.method as usize] += 1;
        quick[usize::from(mapping.quick > 1)] += 1;
        for line in (0..240).step_by(size as usize / 6) {
            let columns = (0..320).filter(|&x| inside(&corners, x, line).is_some());
            let columns: Vec<_> = columns.collect();
            let (Some(&first), Some(&last)) = (columns.first(), columns.last()) else {
                continue;
            };
            let place = Place {
                span: first as u32,
                end: last as u32 + 1,
                column: first as u32,
                line: line as u32,
            };
            let first = difference(&mut rng, place, |at, run: &mut [u16]| {
                draw_mapped(&mapping, run, at, &texture, budget);
            });
            assert_eq!(first, None, "{place:?} {budget:?} {form} {mapping:?}");
            spans += 1;
        }
    }
    assert!(methods.iter().all(|&n| n > 600), "{methods:?}");
    assert!(quick.iter().all(|&n| n > 600), "{quick:?}");
    assert!(spans > 10_000, "{spans}");
}

/// The corners of a triangle of some size, the topmost first, clockwise.
fn some_corners(rng: &mut Rng, size: u32) -> Option<[u32; 3]> {
    let mut axis = |from: u32| 8 * (ORIGIN as u32 + from) + rng.below(8 * size);
    let mut corners = [(); 3].map(|()| axis(40) << 16 | axis(40));
    corners.sort_unstable();
    let [a, b, c] = corners;
    let x = |p: u32| (p & 0xFFFF) as i32 - (a & 0xFFFF) as i32;
    let y = |p: u32| (p >> 16) as i32 - (a >> 16) as i32;
    let area = x(b) * y(c) - x(c) * y(b);
    match area {
        0 => None,
        1.. => Some([a, b, c]),
        _ => Some([a, c, b]),
    }
}

/// A colour of a vertex, half a step or more from the dark.
fn some_colour<L: Look>(rng: &mut Rng) -> u32 {
    let [red, green, blue] = fields(L::SCALE.full_word()).map(|full| {
        let half = 32;
        half + rng.below(full as u32 + 1 - half)
    });
    red << 21 | blue << 11 | green
}

/// Draws triangles of all sizes by a look, whole and in runs; how many spans of each kind were drawn.
fn spans_of<L: Look>(texture: Option<&Texture<'_>>, seed: u64) -> [u32; 4] {
    let mut rng = Rng(seed);
    let mut fills = [0; 4];
    for i in 0..24_000 {
        let Some(corner) = some_corners(&mut rng, [12, 40, 90, 270][i % 4]) else {
            continue;
        };
        let (even, far) = (some_colour::<L>(&mut rng), i % 3 == 0);
        let vertices = corner.map(|place| Vertex {
            place,
            depth: if far {
                1 << 29
            } else {
                (1 << 28) + rng.below(1 << 29)
            },
            colour: if i % 5 == 0 {
                even
            } else {
                some_colour::<L>(&mut rng)
            },
        });
        let places = vertices.map(|v| {
            let texel = [v.place & 0xFFFF, v.place >> 16];
            TexturePlace::new(
                texel.map(|p| ((20 * p + rng.below(800)) as i32) << 6),
                [0; 2],
            )
        });
        let triangle = Triangle {
            vertex: [&vertices[0], &vertices[1], &vertices[2]],
            object: &OBJECT,
            places: &places,
            frame: FRAME,
        };
        let states = [state_of(texture, BUDGETS[i % 7 % 4])];
        let draws = Draws::new(&states);
        let (lines, way) = (triangle.lines(), triangle.way());
        let (fill, planes) = set_up::<L>(&triangle, &draws);
        let first = (corner[0] >> 19) as i32 + 1 - ORIGIN;
        for line in (first..lines.end).step_by(if i % 4 < 2 { 1 } else { 13 }) {
            let sides = triangle.sides(way, line, lines.turn);
            let (start, end) = sides.columns(way, line as u32, FRAME);
            if start >= end {
                continue;
            }
            let (mut fill, mut planes) = (fill, planes);
            fills[fill as usize] += 1;
            if fill == Fill::Thin {
                let part = |second: u32, third: u32| Parts { second, third };
                let of = |rng: &mut Rng| part(rng.below(1 << 29), rng.below(1 << 29));
                let ends = ThinSpan {
                    triangle: &triangle,
                    parts: [of(&mut rng), of(&mut rng)],
                    start,
                    pixels: end - start,
                };
                planes = L::EMPTY;
                L::set_up_thin(&ends, 0, &draws, &mut planes);
                fill = Fill::Wide;
            }
            let place = Place {
                span: start,
                end,
                column: start,
                line: line as u32,
            };
            let first = difference(&mut rng, place, |at, run: &mut [WordOf<L>]| {
                L::fill(fill, &planes, at, &states, run);
            });
            assert_eq!(first, None, "{place:?} {fill:?} {planes:?} {corner:x?}");
        }
    }
    fills
}

#[test]
fn pixels_of_every_look_do_not_depend_on_runs() {
    let words: Vec<u16> = (0..=u16::MAX).collect();
    let square = Texture::words(&words, 64, 64).unwrap();
    let other = Texture::words(&words, 64, 32).unwrap();
    let all = [
        spans_of::<Textured<Rgb565>>(Some(&square), 31),
        spans_of::<Textured<Rgb565Be>>(Some(&square), 32),
        spans_of::<Textured<Rgb565>>(Some(&other), 33),
        spans_of::<Textured<Rgb565Be>>(None, 34),
        spans_of::<Gouraud<Rgb565>>(None, 35),
        spans_of::<Gouraud<Rgb888>>(None, 36),
    ];
    for (i, fills) in all.iter().enumerate() {
        // Without a texture of its own loops, nothing is plain; without fields in one word all that is small is.
        for (fill, &spans) in [Fill::Plain, Fill::Small, Fill::Wide, Fill::Thin]
            .iter()
            .zip(fills)
        {
            let is_rare = match fill {
                Fill::Plain => i == 2 || i == 3,
                Fill::Small => i < 4 || i == 5,
                Fill::Wide | Fill::Thin => false,
            };
            assert!(is_rare || spans > 300, "{i} {fill:?}: {fills:?}");
        }
    }
}

/// Kills: a bit of one coordinate that gets into the other, and sides of another length.
#[test]
fn packed_places_have_sixteen_bits_of_the_period_each() {
    let mut rng = Rng(7);
    for _ in 0..20_000 {
        let log = rng.below(9);
        let at = Uv {
            u: rng.bits() as i32,
            v: rng.bits() as i32,
        };
        let period = 1i64 << (FRACTION + log);
        let part = |c: i32| (i64::from(c).rem_euclid(period) * 65_536 / period) as u32;
        assert_eq!(
            packed(at, log),
            part(at.v) << 16 | part(at.u),
            "{at:?} {log}"
        );
    }
}
