//! Which pixels triangles cover, from the words of the fill rule alone: whole numbers, pixel by pixel.

use super::Place;
use super::exact::doubled_area;
use scanbeam::{Cull, Screen};

/// Whether a triangle covers the pixel: an edge counts on the lines `Ytop < Y <= Ybottom`, and
/// of the two that count one must be left of the centre and the other not (`min < x <= max`).
fn covers(triangle: [Place; 3], column: i32, line: i32) -> bool {
    let (x, y) = (i64::from(8 * column + 4), i64::from(8 * line + 4));
    let mut left = false;
    for k in 0..3 {
        let (a, b) = (triangle[k], triangle[(k + 1) % 3]);
        let (a, b) = if a.1 <= b.1 { (a, b) } else { (b, a) };
        let (a, b) = (
            (i64::from(a.0), i64::from(a.1)),
            (i64::from(b.0), i64::from(b.1)),
        );
        if a.1 < y && y <= b.1 {
            left ^= (x - a.0) * (b.1 - a.1) > (y - a.1) * (b.0 - a.0);
        }
    }
    left
}

/// How often each pixel of the picture is hit, and the triangle that hits it last (from 1).
pub struct Count {
    width: i32,
    pub hits: Vec<u32>,
    pub last: Vec<u32>,
}

impl Count {
    pub fn new(screen: Screen, triangles: &[[Place; 3]], cull: Cull) -> Self {
        let (width, height) = (i32::from(screen.width()), i32::from(screen.height()));
        let pixels = (width * height) as usize;
        let mut count = Self {
            width,
            hits: vec![0; pixels],
            last: vec![0; pixels],
        };
        for (id, &triangle) in (1..).zip(triangles) {
            if cull == Cull::Back && doubled_area(triangle) > 0 {
                continue;
            }
            let range = |c: [i32; 3], size: i32| {
                let low = c.iter().min().unwrap().div_euclid(8).clamp(0, size);
                let high = c.iter().max().unwrap().div_euclid(8).clamp(-1, size - 1);
                low..=high
            };
            for line in range(triangle.map(|p| p.1), height) {
                for column in range(triangle.map(|p| p.0), width) {
                    if covers(triangle, column, line) {
                        let at = (line * width + column) as usize;
                        count.hits[at] += 1;
                        count.last[at] = id;
                    }
                }
            }
        }
        count
    }

    pub fn line(&self, line: u16) -> std::ops::Range<usize> {
        let start = usize::from(line) * self.width as usize;
        start..start + self.width as usize
    }
}
