//! Stage one: a triangle into the tokens of one scanline (K4-K6, K15).
//!
//! Vertex sort finds the two active edges, the dividers give a weight for each, LIRP gives every
//! parameter at both ends, and a counter goes along the span with the circuit of K6. x alone is
//! not interpolated by the 12-bit weight, which would be off by pixels on long edges: the ends
//! are the exact crossings, rounded down to 1/8 pixel. A pixel's centre is never less than a
//! whole unit off them on the wrong side, so coverage is that of K4 exactly.

use super::format::Word36;
use super::lirp::EDGE_BITS;
use super::token::{PixelToken, Token};
use super::vertex::{PLACE, ParameterRam, VertexFormat};
use super::weight::{SpanWeight, vertical_weight};
use core::ops::Range;

/// An edge that a scanline meets.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ActiveEdge {
    /// The upper vertex, 0 to 3.
    pub top: u8,
    /// The lower vertex.
    pub bottom: u8,
    /// How far down the scanline is, 12 bits; all ones at the bottom.
    pub weight: u16,
    /// Where the scanline's centre meets it: 13.3, rounded down.
    pub x: u16,
}

impl ActiveEdge {
    /// The edge between vertices `a` and `b`, when `Ytop < y <= Ybottom`. Coordinates are 13.3.
    #[must_use]
    pub fn new(a: (u8, (u16, u16)), b: (u8, (u16, u16)), y: u16) -> Option<Self> {
        let (top, bottom) = if a.1.1 <= b.1.1 { (a, b) } else { (b, a) };
        let ((top, (x0, y0)), (bottom, (x1, y1))) = (top, bottom);
        if !(y0 < y && y <= y1) {
            return None;
        }
        let (down, height) = (y - y0, y1 - y0);
        let wide = (i64::from(x1) - i64::from(x0)) * i64::from(down);
        Some(Self {
            top,
            bottom,
            weight: vertical_weight(down, height),
            x: (i64::from(x0) + wide.div_euclid(height.into())) as u16,
        })
    }
}

/// A triangle's pixels on a scanline, and the edges that end them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ModelSpan {
    /// The left edge.
    pub left: ActiveEdge,
    /// The right edge.
    pub right: ActiveEdge,
}

impl ModelSpan {
    /// Vertex sort: the two edges between `places` that are active at `y`, left one first.
    ///
    /// `places` are vertices by number and their places; all coordinates are 13.3, `y` is the
    /// scanline's centre.
    #[must_use]
    pub fn new(places: [(u8, (u16, u16)); 3], y: u16) -> Option<Self> {
        let [a, b, c] = places;
        let edges = [(a, b), (b, c), (c, a)];
        let mut active = edges
            .into_iter()
            .filter_map(|(a, b)| ActiveEdge::new(a, b, y));
        let (left, right) = (active.next()?, active.next()?);
        Some(if left.x <= right.x {
            Self { left, right }
        } else {
            Self {
                left: right,
                right: left,
            }
        })
    }

    /// First covered column, and the first column after the last: `min < x <= max` on centres.
    #[inline]
    #[must_use]
    pub fn columns(&self) -> (i32, i32) {
        let first = |x: u16| (i32::from(x) + 4) >> 3;
        (first(self.left.x), first(self.right.x))
    }

    /// The pixels of `columns`, each with its weight.
    pub fn pixels(&self, columns: Range<i32>) -> impl Iterator<Item = (i32, u16)> + use<> {
        let left = i32::from(self.left.x);
        let weight = SpanWeight::new(self.right.x - self.left.x);
        columns.map(move |column| (column, weight.at((8 * column + 4 - left) as u16)))
    }
}

/// The part of a scanline that is rendered: columns of 13.3 space and the scanline's centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Segment {
    /// The column of pixel 0.
    pub column: i32,
    /// Pixels, at most 2,047.
    pub width: u16,
    /// Centre of the scanline, 13.3.
    pub y: u16,
}

/// Draws triangle `vertices` of `stream`: set-up tokens of its parameters, then a pixel token for
/// each pixel of the segment that it covers. Nothing when it covers none.
///
/// `flags` go to the lowest four bits of the left depth: what chart C has beside it.
pub fn draw(
    ram: &ParameterRam,
    format: &VertexFormat,
    (stream, vertices): (u8, [u8; 3]),
    segment: Segment,
    flags: ZFlags,
    emit: &mut impl FnMut(Token),
) {
    let places = vertices.map(|v| (v, ram.place(stream, v)));
    let Some(span) = ModelSpan::new(places, segment.y) else {
        return;
    };
    let (from, to) = span.columns();
    let from = from.max(segment.column);
    let to = to.min(segment.column + i32::from(segment.width));
    if from >= to {
        return;
    }
    for entry in format.entries().filter(|entry| entry.number != PLACE) {
        let at = |edge: ActiveEdge| -> Word36 {
            let get = |vertex| ram.get(stream, vertex, entry.number);
            let (top, bottom) = (get(edge.top), get(edge.bottom));
            let processing = entry.format.processing();
            processing.lirp(top, bottom, edge.weight.into(), EDGE_BITS)
        };
        let mut token = Token::set_up(entry.number, at(span.left), at(span.right));
        if let Token::ZSetup(z) = &mut token {
            (z.diffuse, z.front) = (flags.diffuse, flags.front);
        }
        emit(token);
    }
    for (column, w) in span.pixels(from..to) {
        emit(Token::Pixel(PixelToken {
            x: (column - segment.column) as u16,
            w,
            force_additive: flags.force_additive,
            ..PixelToken::default()
        }));
    }
}

/// What a draw command says beside the triangle.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ZFlags {
    /// Lighting is to be done.
    pub diffuse: bool,
    /// A shadow polygon that faces the viewer (K9).
    pub front: bool,
    /// Its pixels are added, whatever the mode (K11).
    pub force_additive: bool,
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::{InputFormat, ProcessingFormat};
    use crate::lirp::lirp;
    use crate::vertex::FormatWord;
    use std::vec::Vec;

    const A: (u8, (u16, u16)) = (0, (60, 20));
    const B: (u8, (u16, u16)) = (1, (40, 150));
    const C: (u8, (u16, u16)) = (2, (80, 180));

    #[test]
    fn the_printed_triangle_has_the_printed_edges() {
        // Whole units here, as the example has whole pixels.
        assert_eq!(ActiveEdge::new(B, C, 100), None);
        let span = ModelSpan::new([A, B, C], 100).unwrap();
        let (d, e) = (span.left, span.right);
        assert_eq!((d.top, d.bottom), (0, 1));
        assert_eq!((e.top, e.bottom), (0, 2));
        // 8/13 and 1/2 in 12 bits.
        assert_eq!(d.weight, (4096 * 8 / 13) as u16);
        assert_eq!(e.weight, 2048);
        // 620/13 is 47 9/13, and 70.
        assert_eq!((d.x, e.x), (620 / 13, 70));
        // LIRP alone gives the same whole numbers here.
        assert_eq!(lirp(60, 40, d.weight.into(), EDGE_BITS), 47);
        assert_eq!(lirp(60, 80, e.weight.into(), EDGE_BITS), 70);
        // In eighths the left end is 620/13 to three bits.
        let eighths = [A, B, C].map(|(v, (x, y))| (v, (8 * x, 8 * y)));
        let span = ModelSpan::new(eighths, 800).unwrap();
        assert_eq!((span.left.x, span.right.x), ((8 * 620 / 13) as u16, 560));
        // At the edge of validity: nothing above A, BC from B's line on, all of it at C.
        assert_eq!(ModelSpan::new([A, B, C], 20), None);
        assert_eq!(ModelSpan::new([A, B, C], 150).unwrap().left.x, 40);
        assert_eq!(ActiveEdge::new(B, C, 151).map(|e| e.x), Some(41));
        assert_eq!(ModelSpan::new([A, B, C], 181), None);
    }

    #[test]
    fn the_printed_span_has_the_printed_weights() {
        // The example rounds D up to 53 (it had x wrong) and weighs whole columns: 3, 8 and 14
        // of 17 at the pixels 56, 61 and 67 of 53 ..= 70.
        let weight = SpanWeight::new(8 * (70 - 53));
        for (pixel, part) in [(56, 3u32), (61, 8), (67, 14)] {
            let w = u32::from(weight.at(8 * (pixel - 53)));
            let nearest = (1024 * part + 8) / 17;
            assert!(w.abs_diff(nearest) <= 1, "{pixel}: {w}, not {nearest}");
        }
        assert_eq!([3, 8, 14].map(|i| weight.at(8 * i)), [181, 482, 843]);
    }

    #[test]
    fn tokens_of_a_small_triangle() {
        let table = [
            FormatWord::count(3),
            FormatWord::parameter(PLACE, InputFormat::U16x2),
            FormatWord::parameter(1, InputFormat::U32x1),
            FormatWord::parameter(2, InputFormat::U8x4),
        ];
        let format = VertexFormat::read(&table, 0).unwrap();
        let mut ram = ParameterRam::new();
        let vertex = |x: u32, y: u32, z: u32, argb: u32| [x << 16 | y, z, argb];
        let words = [
            vertex(80, 0, 1000, 0xFF00_0000),
            vertex(80, 80, 1000, 0xFFFF_0000),
            vertex(160, 80, 2000, 0xFFFF_FF00),
        ];
        for (v, words) in (0..).zip(&words) {
            ram.load(1, v, &format, words).unwrap();
        }
        let mut tokens = Vec::new();
        let segment = Segment {
            column: 8,
            width: 5,
            y: 44,
        };
        let flags = ZFlags::default();
        draw(&ram, &format, (1, [0, 1, 2]), segment, flags, &mut |t| {
            tokens.push(t)
        });
        // Line 5: x from 80 to 124 in eighths, columns 10 ..= 14, of which 10 ..= 12 are inside.
        let Token::ZSetup(z) = tokens[0] else {
            panic!("{:?}", tokens[0]);
        };
        let w = u32::from(vertical_weight(44, 80));
        assert_eq!((z.z0, i64::from(z.z1)), (1000, lirp(1000, 2000, w, 12)));
        let Token::DiffuseSetup(colour) = tokens[1] else {
            panic!("{:?}", tokens[1]);
        };
        let level = lirp(0, 511, w, 12);
        let fields = |word| ProcessingFormat::U9x4.unpack(word);
        assert_eq!(fields(colour.left), [511, level, 0, 0]);
        assert_eq!(fields(colour.right), [511, level, level, 0]);
        let weight = SpanWeight::new(44);
        let pixel = |x: u16, distance: u16| {
            Token::Pixel(PixelToken {
                x,
                w: weight.at(distance),
                ..PixelToken::default()
            })
        };
        assert_eq!(tokens[2..], [pixel(2, 4), pixel(3, 12), pixel(4, 20)]);
        // Left of it there is nothing at all.
        let segment = Segment {
            column: 0,
            ..segment
        };
        draw(&ram, &format, (1, [0, 1, 2]), segment, flags, &mut |t| {
            panic!("{t:?}")
        });
    }
}
