//! Pixels of screen triangles, the depth test, and the mask of pixels that rounding may change.
//!
//! Three passes: draw everything; go over all triangles again for objects that are too close in depth to tell; mark
//! along the edges. The later passes need what the first has found to be in front.

use super::{NO_OBJECT, Reference, TextureMap, View};

/// Pixels whose centre is nearer than this to a visible edge are left out of comparisons.
const EDGE_DISTANCE: f64 = 0.75;
/// How far rounding may move a corner on each axis, in pixels: twice what 13.3 does.
const CORNER_MOVE: f64 = 0.125;
/// Differences of 1/w below this part of it cannot be told by 32-bit depth.
const DEPTH_PRECISION: f64 = 1e-6;

/// A corner on the screen.
#[derive(Clone, Copy)]
pub(super) struct ScreenVertex {
    /// In pixels from the left side.
    pub(super) x: f64,
    /// In pixels from the top.
    pub(super) y: f64,
    /// 1/w.
    pub(super) q: f64,
    /// In levels.
    pub(super) colour: [f64; 3],
    /// In texels.
    pub(super) place: [f64; 2],
}

/// Twice the signed area; positive when clockwise to the eye (y goes down).
pub(super) fn doubled_area(polygon: &[ScreenVertex]) -> f64 {
    let (a, rest) = (polygon[0], &polygon[1..]);
    rest.windows(2)
        .map(|pair| (pair[0].x - a.x) * (pair[1].y - a.y) - (pair[1].x - a.x) * (pair[0].y - a.y))
        .sum()
}

/// A line of the screen, with a side: the value is positive inside, on it the tie rule decides.
struct Edge {
    /// Ends in an order that does not depend on which triangle asks, so that both get the same number.
    low: [f64; 2],
    high: [f64; 2],
    sign: f64,
    /// Whether points on the edge belong to the triangle.
    inclusive: bool,
}

impl Edge {
    /// For triangles that are clockwise to the eye.
    fn new(a: &ScreenVertex, b: &ScreenVertex) -> Self {
        let (from, to) = ([a.x, a.y], [b.x, b.y]);
        let ordered = from <= to;
        let (low, high) = if ordered { (from, to) } else { (to, from) };
        Self {
            low,
            high,
            sign: if ordered { 1.0 } else { -1.0 },
            // K4, `min < x <= max`. Clockwise: right edges go down, bottom edges go left.
            inclusive: b.y > a.y || (b.y == a.y && b.x < a.x),
        }
    }

    fn value(&self, x: f64, y: f64) -> f64 {
        let [lx, ly] = self.low;
        self.sign * ((self.high[0] - lx) * (y - ly) - (self.high[1] - ly) * (x - lx))
    }

    fn covers(&self, value: f64) -> bool {
        value > 0.0 || (value == 0.0 && self.inclusive)
    }
}

/// A triangle, clockwise to the eye, with what both passes over it need.
struct Triangle {
    object: u32,
    corners: [ScreenVertex; 3],
    /// How much 1/w at a pixel changes when the corners move by [`CORNER_MOVE`].
    slack: f64,
}

/// One pixel of a triangle.
struct Fragment {
    index: usize,
    q: f64,
    /// Weights of the corners, sum 1.
    weights: [f64; 3],
}

impl Fragment {
    /// Where the pixel lies on the texture: places over w are linear on the screen, and so is 1/w.
    fn place(&self, corners: &[ScreenVertex; 3]) -> [f64; 2] {
        let over = |i: usize| -> f64 {
            let parts = self.weights.iter().zip(corners);
            parts.map(|(weight, c)| weight * c.place[i] * c.q).sum()
        };
        [over(0) / self.q, over(1) / self.q]
    }
}

impl Triangle {
    /// `None` when it has no area.
    fn new(object: u32, mut corners: [ScreenVertex; 3]) -> Option<Self> {
        let mut area = doubled_area(&corners);
        if area < 0.0 {
            corners.swap(1, 2);
            area = -area;
        }
        let [a, b, c] = &corners;
        let (qb, qc) = (b.q - a.q, c.q - a.q);
        let dx = (qb * (c.y - a.y) - qc * (b.y - a.y)) / area;
        let dy = (qc * (b.x - a.x) - qb * (c.x - a.x)) / area;
        let slack = (dx.abs() + dy.abs()) * CORNER_MOVE;
        (area > 0.0).then_some(Self {
            object,
            corners,
            slack,
        })
    }

    /// Calls `visit` for each pixel of a `width` by `height` screen whose centre is covered.
    fn fragments(&self, width: usize, height: usize, mut visit: impl FnMut(&Fragment)) {
        let [a, b, c] = &self.corners;
        // Edge k lies opposite to corner k.
        let edges = [Edge::new(b, c), Edge::new(c, a), Edge::new(a, b)];
        let (left, right) = centres([a.x, b.x, c.x], width);
        let (top, bottom) = centres([a.y, b.y, c.y], height);
        for row in top..bottom {
            let y = row as f64 + 0.5;
            for column in left..right {
                let x = column as f64 + 0.5;
                let values = [
                    edges[0].value(x, y),
                    edges[1].value(x, y),
                    edges[2].value(x, y),
                ];
                if !(0..3).all(|k| edges[k].covers(values[k])) {
                    continue;
                }
                let sum: f64 = values.iter().sum();
                if sum <= 0.0 {
                    continue;
                }
                let weights = values.map(|value| value / sum);
                visit(&Fragment {
                    index: row * width + column,
                    q: weights[0] * a.q + weights[1] * b.q + weights[2] * c.q,
                    weights,
                });
            }
        }
    }
}

/// First and one past the last pixel whose centre can lie between the smallest and the largest coordinate.
fn centres(coordinates: [f64; 3], limit: usize) -> (usize, usize) {
    let low = coordinates.into_iter().fold(f64::INFINITY, f64::min);
    let high = coordinates.into_iter().fold(f64::NEG_INFINITY, f64::max);
    let limit = limit as f64;
    // One pixel of room on both sides: the edges decide.
    let first = (low - 1.5).floor().clamp(0.0, limit);
    let last = (high + 1.5).ceil().clamp(0.0, limit);
    (first as usize, last as usize)
}

/// The picture while it is drawn.
pub(super) struct Raster {
    width: usize,
    height: usize,
    picture: Reference,
    /// Per pixel: the slack of the triangle that is seen.
    slack: Vec<f64>,
    triangles: Vec<Triangle>,
    /// Outlines of polygons, without the diagonals of their fans.
    outlines: Vec<(u32, [ScreenVertex; 2])>,
}

impl Raster {
    pub(super) fn new(view: &View) -> Self {
        let (width, height) = (view.width as usize, view.height as usize);
        let pixels = width * height;
        Self {
            width,
            height,
            picture: Reference {
                width: view.width,
                height: view.height,
                colour: vec![view.background.map(f64::from); pixels],
                object: vec![NO_OBJECT; pixels],
                inverse_w: vec![0.0; pixels],
                place: vec![[0.0; 2]; pixels],
                near_edge: vec![false; pixels],
            },
            slack: vec![0.0; pixels],
            triangles: Vec::new(),
            outlines: Vec::new(),
        }
    }

    /// Draws a convex polygon of at least 3 corners as a fan from the first.
    pub(super) fn draw(
        &mut self,
        object: u32,
        polygon: &[ScreenVertex],
        texture: Option<&TextureMap>,
    ) {
        for pair in polygon[1..].windows(2) {
            let corners = [polygon[0], pair[0], pair[1]];
            let Some(triangle) = Triangle::new(object, corners) else {
                continue;
            };
            let picture = &mut self.picture;
            triangle.fragments(self.width, self.height, |fragment| {
                if fragment.q < picture.inverse_w[fragment.index] {
                    return;
                }
                picture.inverse_w[fragment.index] = fragment.q;
                picture.object[fragment.index] = object;
                self.slack[fragment.index] = triangle.slack;
                let channel = |i: usize| {
                    let parts = (0..3).map(|k| fragment.weights[k] * triangle.corners[k].colour[i]);
                    parts.sum::<f64>().clamp(0.0, 255.0)
                };
                let colour: [f64; 3] = std::array::from_fn(channel);
                let place = match texture {
                    Some(_) => fragment.place(&triangle.corners),
                    None => [0.0; 2],
                };
                picture.place[fragment.index] = place;
                picture.colour[fragment.index] = texture.map_or(colour, |texture| {
                    let texel = texture.at(place);
                    std::array::from_fn(|i| colour[i] * texel[i] / 255.0)
                });
            });
            self.triangles.push(triangle);
        }
        for (index, &corner) in polygon.iter().enumerate() {
            let next = polygon[(index + 1) % polygon.len()];
            self.outlines.push((object, [corner, next]));
        }
    }

    /// Marks what rounding may change, and hands out the picture.
    pub(super) fn finish(mut self) -> Reference {
        self.mark_depth_ties();
        self.mark_object_borders();
        for (object, [a, b]) in std::mem::take(&mut self.outlines) {
            self.mark_edge(object, &a, &b);
        }
        self.picture
    }

    fn mark_depth_ties(&mut self) {
        for triangle in &self.triangles {
            let picture = &mut self.picture;
            triangle.fragments(self.width, self.height, |fragment| {
                let index = fragment.index;
                let seen = picture.inverse_w[index];
                let slack = triangle.slack + self.slack[index] + DEPTH_PRECISION * seen;
                if picture.object[index] != triangle.object && seen - fragment.q <= slack {
                    picture.near_edge[index] = true;
                }
            });
        }
    }

    fn mark_object_borders(&mut self) {
        for y in 0..self.height {
            for x in 0..self.width {
                let index = y * self.width + x;
                let own = self.picture.object[index];
                let mut around = neighbours(x, y, self.width, self.height);
                if around.any(|other| self.picture.object[other] != own) {
                    self.picture.near_edge[index] = true;
                }
            }
        }
    }

    /// Marks pixels whose centre is near to an edge, where the edge is in front or belongs to the pixel's own object.
    fn mark_edge(&mut self, object: u32, a: &ScreenVertex, b: &ScreenVertex) {
        let ends = [[a.x, a.y], [b.x, b.y]];
        let size = [self.width as f64, self.height as f64];
        let Some([t0, t1]) = within_screen(ends, size) else {
            return;
        };
        let delta = [ends[1][0] - ends[0][0], ends[1][1] - ends[0][1]];
        let squared = delta[0] * delta[0] + delta[1] * delta[1];
        // Step along the longer axis; the distance along the other is at most sqrt(2) times the distance to the edge.
        let along = usize::from(delta[1].abs() > delta[0].abs());
        let at = |t: f64, axis: usize| ends[0][axis] + t * delta[axis];
        let (from, to) = (at(t0, along), at(t1, along));
        let steps = (from.min(to) - 2.0).floor() as i64..=(from.max(to) + 2.0).ceil() as i64;
        for step in steps {
            let t = if squared > 0.0 {
                ((step as f64 + 0.5 - ends[0][along]) / delta[along]).clamp(t0, t1)
            } else {
                0.0
            };
            let middle = at(t, 1 - along).floor() as i64;
            for across in middle - 2..=middle + 2 {
                let place = if along == 0 {
                    [step, across]
                } else {
                    [across, step]
                };
                let (Ok(x), Ok(y)) = (usize::try_from(place[0]), usize::try_from(place[1])) else {
                    continue;
                };
                if x >= self.width || y >= self.height {
                    continue;
                }
                let centre = [x as f64 + 0.5, y as f64 + 0.5];
                let offset = [centre[0] - ends[0][0], centre[1] - ends[0][1]];
                let nearest = if squared > 0.0 {
                    ((offset[0] * delta[0] + offset[1] * delta[1]) / squared).clamp(0.0, 1.0)
                } else {
                    0.0
                };
                let distance = (at(nearest, 0) - centre[0]).hypot(at(nearest, 1) - centre[1]);
                if distance < EDGE_DISTANCE {
                    self.mark_if_visible(object, x, y, a.q + nearest * (b.q - a.q));
                }
            }
        }
    }

    fn mark_if_visible(&mut self, object: u32, x: usize, y: usize, q: f64) {
        let index = y * self.width + x;
        let picture = &mut self.picture;
        let visible = picture.object[index] == object
            || neighbours(x, y, self.width, self.height)
                .any(|other| q >= picture.inverse_w[other] * (1.0 - DEPTH_PRECISION));
        picture.near_edge[index] |= visible;
    }
}

/// Indices of the pixel and of those around it, as far as they are on the screen.
pub(super) fn neighbours(
    x: usize,
    y: usize,
    width: usize,
    height: usize,
) -> impl Iterator<Item = usize> {
    let rows = y.saturating_sub(1)..(y + 2).min(height);
    let columns = x.saturating_sub(1)..(x + 2).min(width);
    rows.flat_map(move |row| columns.clone().map(move |column| row * width + column))
}

/// The part of a segment, as parameters in `0.0..=1.0`, that is on the screen or less than two pixels beside it.
fn within_screen(ends: [[f64; 2]; 2], size: [f64; 2]) -> Option<[f64; 2]> {
    const ROOM: f64 = 2.0;
    let [mut t0, mut t1] = [0.0_f64, 1.0_f64];
    for axis in 0..2 {
        let (from, to) = (ends[0][axis], ends[1][axis]);
        let (low, high) = (-ROOM, size[axis] + ROOM);
        if from.max(to) < low || from.min(to) > high {
            return None;
        }
        if from != to {
            let at = |limit: f64| (limit - from) / (to - from);
            let (first, last) = if from < to {
                (at(low), at(high))
            } else {
                (at(high), at(low))
            };
            t0 = t0.max(first);
            t1 = t1.min(last);
        }
    }
    (t0 <= t1).then_some([t0, t1])
}
