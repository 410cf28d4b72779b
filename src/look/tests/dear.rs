//! Which spans are reckoned to cost twice as much as others (X9).

use super::triangles::{FRAME, OBJECT, set_up, state_of};
use crate::look::{Fill, Look, Textured};
use crate::pixel::Rgb565;
use crate::scene::{Budget, Draws, ORIGIN, Texture, TexturePlace, Vertex};
use crate::span::Triangle;
use std::vec::Vec;

type Lit = Textured<Rgb565>;

/// A triangle of so many pixels each way, nearer by so much a pixel, with these colours of corners, set up.
fn lit(
    size: u32,
    slope: u32,
    colours: [u32; 3],
    texture: &Texture<'_>,
) -> (Fill, <Lit as Look>::Planes) {
    let corner = |x: u32, y: u32, colour: u32| Vertex {
        place: (8 * (ORIGIN as u32 + y)) << 16 | (8 * (ORIGIN as u32 + x)),
        depth: (1 << 27) + x * slope,
        colour,
    };
    let [a, b, c] = colours;
    let vertices = [
        corner(8, 8, a),
        corner(8 + size, 8, b),
        corner(8, 8 + size, c),
    ];
    let places = [[0, 0], [size, 0], [0, size]]
        .map(|texel| TexturePlace::new(texel.map(|t| (t as i32) << 14), [0; 2]));
    let triangle = Triangle {
        vertex: [&vertices[0], &vertices[1], &vertices[2]],
        object: &OBJECT,
        places: &places,
        frame: FRAME,
    };
    let states = [state_of(Some(texture), Budget::FAST)];
    set_up::<Lit>(&triangle, &Draws::new(&states))
}

/// The pixels up to which spans of a triangle in perspective are not dear.
fn most_of(size: u32, colours: [u32; 3], texture: &Texture<'_>) -> u32 {
    let (fill, planes) = lit(size, 1 << 19, colours, texture);
    assert_eq!(fill, Fill::Wide);
    let dear = (1..200).position(|pixels| Lit::halves(fill, &planes, pixels) > 2);
    dear.unwrap_or(200) as u32
}

/// Kills: texels of a small triangle that cost as much without a shade as with one, or no more with one.
#[test]
fn what_is_small_costs_half_without_a_shade() {
    let words: Vec<u16> = (0..=u16::MAX).collect();
    let texture = Texture::words(&words, 64, 64).unwrap();
    let full = Lit::SCALE.full_word();
    let halves = [full, full / 2].map(|colour| {
        let (fill, planes) = lit(20, 0, [colour; 3], &texture);
        assert_eq!(fill, Fill::Plain);
        Lit::halves(fill, &planes, 10)
    });
    assert_eq!(halves, [1, 2]);
}

/// Kills: parabolas with a shade, or shades of large triangles, that are not dear; and such without a shade that are.
#[test]
fn spans_in_perspective_are_dear_where_they_are_long_or_shaded() {
    let words: Vec<u16> = (0..=u16::MAX).collect();
    let texture = Texture::words(&words, 64, 64).unwrap();
    let full = Lit::SCALE.full_word();
    let (even, uneven) = ([full / 2; 3], [full, full / 2, full / 3]);
    let small = [[full; 3], even, uneven].map(|colours| most_of(50, colours, &texture));
    let large = [[full; 3], even, uneven].map(|colours| most_of(150, colours, &texture));
    for [bright, even, uneven] in [small, large] {
        assert!(bright > even && even > 1, "{small:?} {large:?}");
        assert!(uneven <= even, "{small:?} {large:?}");
    }
    assert_eq!((small[2], large[2]), (small[1], 0), "{small:?} {large:?}");
}
