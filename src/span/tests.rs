//! How large triangles are, and the sides of what has four corners.

use super::{Frame, Sides, Size, Tables, Triangle, across, down};
use crate::num::random::Rng;
use crate::scene::{NONE, ORIGIN, Object, Vertex, first_line};

/// The size of a triangle with its first corner at the picture's first pixel, and the others so far from there.
fn size(to: [[u32; 2]; 2]) -> Size {
    let first = 8 * ORIGIN as u32;
    let vertices = [[0; 2], to[0], to[1]].map(|[x, y]| Vertex {
        place: (first + y) << 16 | (first + x),
        depth: 0,
        colour: 0,
    });
    let triangle = Triangle {
        vertex: [&vertices[0], &vertices[1], &vertices[2]],
        object: &Object {
            corner: [0, 1, 2],
            next: NONE,
        },
        second: None,
        tables: &Tables {
            vertices: &[],
            places: &[],
        },
        frame: Frame {
            width: 320,
            height: 240,
        },
    };
    triangle.size(triangle.area())
}

/// Kills: other limits of an area, of the way to a corner, and of sides.
#[test]
fn sizes_end_where_they_say() {
    for (to, want) in [
        ([[223, 0], [0, 2]], Size::Tiny),
        ([[224, 0], [0, 2]], Size::Thin),
        ([[220, 1], [184, 2]], Size::Tiny),
        ([[220, 1], [185, 2]], Size::Thin),
        ([[199, 0], [0, 1]], Size::Tiny),
        ([[200, 0], [0, 1]], Size::Thin),
        ([[128, 0], [0, 1]], Size::Tiny),
        ([[127, 0], [0, 1]], Size::Sharp),
        ([[32, 0], [0, 1]], Size::Sharp),
        ([[31, 0], [0, 1]], Size::Thin),
        ([[256, 0], [0, 4]], Size::Small),
        ([[341, 0], [0, 3]], Size::Thin),
        ([[511, 0], [0, 8]], Size::Small),
        ([[512, 0], [0, 8]], Size::Large),
        ([[0, 512], [8, 512]], Size::Large),
    ] {
        assert_eq!(size(to), want, "{to:?}");
    }
}

/// A triangle of places, the topmost first, clockwise; `None` where it has no area.
fn clockwise(mut place: [u32; 3]) -> Option<[u32; 3]> {
    place.sort_unstable();
    let [a, b, c] = place;
    let way = |p: u32| [across(p.wrapping_sub(a)), down(p.wrapping_sub(a))];
    let [[x1, y1], [x2, y2]] = [way(b), way(c)];
    match x1 * y2 - x2 * y1 {
        0 => None,
        area if area < 0 => Some([a, c, b]),
        _ => Some(place),
    }
}

/// The columns of a parallelogram on a line are those of its two triangles, by sides that are walked from line to line and
/// that are found for it alone.
///
/// Kills: a side that is taken for the next or the one before, a turn that comes a line late, and an end that is that of a
/// triangle.
#[test]
fn sides_of_a_parallelogram_are_those_of_both_triangles() {
    let frame = Frame {
        width: 320,
        height: 240,
    };
    let mut rng = Rng(5);
    let (mut lines, mut turns, mut ways) = (0, 0, [0; 8]);
    for case in 0..20_000 {
        let size = [200, 500, 1_000, 6_000][case % 4];
        let mut at = || [(); 2].map(|()| rng.below(size) as i32 + 8 * ORIGIN - 400);
        let (a, b, c) = (at(), at(), at());
        let d = [0, 1].map(|k| a[k] + c[k] - b[k]);
        let place = |[x, y]: [i32; 2]| (y as u32) << 16 | x as u32;
        let vertices = [a, b, c, d].map(|at| Vertex {
            place: place(at),
            ..Vertex::EMPTY
        });
        let halves = [[0, 1, 2], [0, 2, 3]].map(|half: [usize; 3]| {
            let sorted = clockwise(half.map(|i| vertices[i].place))?;
            Some(sorted.map(|p| vertices.iter().position(|v| v.place == p).unwrap_or(0)))
        });
        let [Some(one), Some(other)] = halves else {
            continue;
        };
        let top = |half: [usize; 3]| vertices[half[0]].place;
        let (kept, left, tip) = match top(other) < top(one) {
            true => (other, one, 1),
            false => (one, other, 3),
        };
        let object = |half: [usize; 3]| Object {
            corner: half.map(|i| i as u16),
            next: NONE,
        };
        let objects = [kept, left].map(object);
        let tables = Tables {
            vertices: &vertices,
            places: &[],
        };
        let corners = |object: &Object| object.corner.map(|i| &vertices[usize::from(i)]);
        let triangle = |i: usize, second| Triangle {
            vertex: corners(&objects[i]),
            object: &objects[i],
            second,
            tables: &tables,
            frame,
        };
        // The fourth comes behind the corner from which the common side leads to the other one.
        let own = 4 - tip;
        let behind = (0..3).find(|&i| kept[i] != own && kept[(i + 1) % 3] != own);
        let behind = kept[behind.unwrap_or(0)] as u16;
        let second = Object::second(1, tip as u16, 0, behind);
        let quad = triangle(0, Some(&second));
        let fourth = quad.fourth().unwrap();
        let halves = [0, 1].map(|i| triangle(i, None));
        let way = quad.way_of_quad(fourth);
        ways[usize::from(way.0)] += 1;
        let first = (first_line(top(kept)) - ORIGIN).max(0);
        let mut walked = quad.sides_of_quad(fourth, way, first);
        assert_eq!(walked.change > first, quad.end(true) > first);
        for line in first..quad.end(true).min(240) {
            if line == walked.change {
                assert!(walked.turns);
                (walked, turns) = (quad.sides_of_quad(fourth, way, line), turns + 1);
            }
            let columns = |sides: &Sides, way| sides.columns(way, line as u32, frame);
            let of = |half: &Triangle<'_>| {
                let (way, lines) = (half.way(), half.lines());
                let is_on = line >= first_line(half.place(0)) - ORIGIN && line < lines.end;
                let (start, end) = columns(&half.sides(way, line, lines.turn), way);
                (is_on && start < end).then_some((start, end))
            };
            let want = match halves.each_ref().map(of) {
                [Some((a, b)), Some((c, d))] => {
                    assert!(b == c || d == a, "{case} {line}");
                    Some((a.min(c), b.max(d)))
                }
                [one, other] => one.or(other),
            };
            for (start, end) in [
                columns(&walked.sides, way),
                quad.columns_of_quad(fourth, line as u32),
            ] {
                let got = (start < end).then_some((start, end));
                assert_eq!(got, want, "{case} {line} {vertices:?} {kept:?} {fourth:?}");
            }
            lines += 1;
        }
    }
    assert!(lines > 200_000 && turns > 5_000, "{lines} {turns}");
    assert!(
        [0, 1, 2, 4, 5, 6].iter().all(|&way| ways[way] > 100),
        "{ways:?}"
    );
}
