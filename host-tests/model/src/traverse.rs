//! A triangle block by block: strips, clusters and interleave (B1-B3, B6).
//!
//! The picture's memory lies in blocks, so a triangle is scanned in vertical strips as wide as a
//! block: inside a strip cluster line by cluster line, in each from the leading edge on, cluster by
//! cluster. One vertex of a triangle is always at a corner of its bounding box. The scan starts
//! there and goes away from it both ways: four scan directions. The triangle is convex and has its
//! least x and its least y (as seen from there) at the start. So the first cluster of a line never
//! lies before that of the line above, and the first line of a strip never before that of the
//! strip before. Both are noted while scanning, and nothing is searched for twice.
//!
//! Clusters may belong to several renderers. Start values are corrected to the cluster grid and to
//! the renderer's own clusters by the formulae of B6.
//!
//! Whether a cluster is looked at is decided by the edge functions over its whole area: those met
//! in a line then have no gap. Which of its pixels are covered is decided at their centres, as
//! everywhere; so slivers that cover a pixel here and there are found whole.

use super::edge_function::EdgeFunctions;
use core::ops::RangeInclusive;

/// How the picture is divided among clusters, renderers and blocks.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Grid {
    /// Pixels of a cluster, to the right and down.
    cluster: [i32; 2],
    /// Every so many clusters belong to one renderer.
    factor: [i32; 2],
    /// Which of them.
    offset: [i32; 2],
    /// Pixels of a strip to the right.
    strip: i32,
}

impl Grid {
    /// Clusters of 1 to 8 by 1 to 4 pixels, in strips of `strip` pixels, all of one renderer;
    /// `None` unless strips have whole clusters.
    #[must_use]
    pub const fn new(cluster: (u8, u8), strip: u16) -> Option<Self> {
        let (width, height) = cluster;
        if width == 0 || width > 8 || height == 0 || height > 4 {
            return None;
        }
        if strip == 0 || !strip.is_multiple_of(width as u16) {
            return None;
        }
        Some(Self {
            cluster: [width as i32, height as i32],
            factor: [1; 2],
            offset: [0; 2],
            strip: strip as i32,
        })
    }

    /// Only every `factor`th cluster to the right and down, from cluster `offset` on; `None`
    /// unless each offset is below its factor.
    #[must_use]
    pub const fn interleaved(self, factor: (u8, u8), offset: (u8, u8)) -> Option<Self> {
        if offset.0 < factor.0 && offset.1 < factor.1 {
            Some(Self {
                factor: [factor.0 as i32, factor.1 as i32],
                offset: [offset.0 as i32, offset.1 as i32],
                ..self
            })
        } else {
            None
        }
    }

    /// Pixels of a cluster, to the right and down.
    #[must_use]
    pub const fn cluster(&self) -> (u32, u32) {
        (self.cluster[0] as u32, self.cluster[1] as u32)
    }

    /// What is added to a start value (subtracted when going back) so that it is the first pixel
    /// of an own cluster: `scf` of B6, from `ccf` and `icf`.
    const fn correction(&self, axis: usize, at: i32, back: bool) -> i32 {
        let (cluster, factor) = (self.cluster[axis], self.factor[axis]);
        let part = at.rem_euclid(cluster);
        let number = at.div_euclid(cluster).rem_euclid(factor);
        let (ccf, icf) = if back {
            (part - (cluster - 1), number - self.offset[axis])
        } else {
            (-part, self.offset[axis] - number)
        };
        ccf + cluster * icf.rem_euclid(factor)
    }

    /// The upper or left pixel of the first own cluster that is not before the pixel `at`.
    const fn first(&self, axis: usize, at: i32, back: bool) -> i32 {
        let correction = self.correction(axis, at, back);
        if back {
            // The first pixel of a cluster is its last one then.
            at - correction - (self.cluster[axis] - 1)
        } else {
            at + correction
        }
    }

    /// Pixels from an own cluster to the next.
    const fn step(&self, axis: usize, back: bool) -> i32 {
        let step = self.cluster[axis] * self.factor[axis];
        if back { -step } else { step }
    }
}

/// A cluster in which a triangle covers pixels.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Cluster {
    /// Column of its left pixels.
    pub column: i32,
    /// Line of its upper pixels.
    pub line: i32,
    /// A bit for each covered pixel, row by row from the lowest bit on; not 0.
    pub covered: u32,
    width: u8,
}

impl Cluster {
    /// Column and line of each covered pixel.
    pub fn pixels(self) -> impl Iterator<Item = (i32, i32)> {
        let width = i32::from(self.width);
        (0..32)
            .filter(move |bit| self.covered >> bit & 1 != 0)
            .map(move |bit| (self.column + bit % width, self.line + bit / width))
    }
}

/// The clusters of a triangle, in the order of the scan.
#[derive(Clone, Copy, Debug)]
pub struct Traversal {
    grid: Grid,
    /// At pixel (0, 0).
    edges: EdgeFunctions,
    /// Bounding box of the corners, 13.3.
    low: [i32; 2],
    high: [i32; 2],
    /// Whether the scan goes left, and up.
    back: [bool; 2],
    /// Left pixel of the strip; `None` when all is done.
    strip: Option<i32>,
    /// The cluster line of the strip that is scanned.
    line: i32,
    /// The next cluster of the line; `None` when it is done.
    column: Option<i32>,
    /// Whether a cluster of the line has been met.
    met: bool,
    /// Where the next line of the strip begins.
    line_entry: i32,
    /// The first line of the strip.
    first_line: i32,
    /// The first line of the next strip, when it is known.
    strip_entry: Option<i32>,
    looked_at: u32,
}

impl Traversal {
    /// The triangle of three corners, 13.3, in either order; one without area has no clusters.
    #[must_use]
    pub fn new(corners: [(u16, u16); 3], grid: Grid) -> Self {
        let x = corners.map(|c| i32::from(c.0));
        let y = corners.map(|c| i32::from(c.1));
        let box_of = |v: [i32; 3]| (v[0].min(v[1]).min(v[2]), v[0].max(v[1]).max(v[2]));
        let ((left, right), (top, bottom)) = (box_of(x), box_of(y));
        // A vertex at a corner of the box; there is one, as 3 vertices touch 4 sides.
        let start = (0..3)
            .find(|&i| (x[i] == left || x[i] == right) && (y[i] == top || y[i] == bottom))
            .unwrap_or(0);
        let back = [x[start] != left, y[start] != top];
        let edges = EdgeFunctions::new(corners, (0, 0));
        let mut this = Self {
            grid,
            edges: edges.unwrap_or(EdgeFunctions::NOTHING),
            low: [left, top],
            high: [right, bottom],
            back,
            strip: None,
            line: 0,
            column: None,
            met: false,
            line_entry: 0,
            first_line: grid.first(1, y[start] >> 3, back[1]),
            strip_entry: None,
            looked_at: 0,
        };
        if edges.is_some() {
            let strip = (x[start] >> 3).div_euclid(grid.strip) * grid.strip;
            this.enter(strip);
        }
        this
    }

    /// Clusters of which the edge functions were taken, so far.
    #[must_use]
    pub fn looked_at(&self) -> u32 {
        self.looked_at
    }

    /// Whether the triangle reaches the area of so many pixels from a pixel on.
    fn reaches(&self, (column, line): (i32, i32), (columns, lines): (i32, i32)) -> bool {
        let inside = |axis: usize, at: i32, pixels: i32| {
            8 * (at + pixels) >= self.low[axis] && 8 * at <= self.high[axis]
        };
        inside(0, column, columns)
            && inside(1, line, lines)
            && self.edges.moved(column, line).reach(columns, lines)
    }

    /// Whether it reaches the cluster line of a strip.
    fn reaches_line(&self, strip: i32, line: i32) -> bool {
        self.reaches((strip, line), (self.grid.strip, self.grid.cluster[1]))
    }

    /// Whether a cluster line lies within the bounding box or before it.
    fn is_before_end(&self, line: i32) -> bool {
        if self.back[1] {
            8 * (line + self.grid.cluster[1]) >= self.low[1]
        } else {
            8 * line <= self.high[1]
        }
    }

    /// Goes to the first strip from `strip` on of which a line is reached.
    fn enter(&mut self, mut strip: i32) {
        let step = if self.back[0] {
            -self.grid.strip
        } else {
            self.grid.strip
        };
        self.strip = None;
        while 8 * (strip + self.grid.strip) >= self.low[0] && 8 * strip <= self.high[0] {
            let mut line = self.strip_entry.unwrap_or(self.first_line);
            while self.is_before_end(line) {
                if self.reaches_line(strip, line) {
                    self.first_line = line;
                    self.strip = Some(strip);
                    self.strip_entry = None;
                    let side = if self.back[0] {
                        strip + self.grid.strip - 1
                    } else {
                        strip
                    };
                    self.line_entry = self.grid.first(0, side, self.back[0]);
                    self.begin_line(strip, line);
                    return;
                }
                line += self.grid.step(1, self.back[1]);
            }
            // No own line reaches it; the next one's may all the same.
            strip += step;
        }
    }

    /// Begins a line of the strip, and notes whether the next strip can be entered there.
    fn begin_line(&mut self, strip: i32, line: i32) {
        (self.line, self.column, self.met) = (line, Some(self.line_entry), false);
        if self.strip_entry.is_none() {
            let step = if self.back[0] {
                -self.grid.strip
            } else {
                self.grid.strip
            };
            if self.reaches_line(strip + step, line) {
                self.strip_entry = Some(line);
            }
        }
    }

    /// The covered pixels of a cluster, a bit each.
    fn covered(&self, column: i32, line: i32) -> u32 {
        let [width, height] = self.grid.cluster;
        let mut bits = 0;
        let mut row = self.edges.moved(column, line);
        for y in 0..height {
            let mut at = row;
            for x in 0..width {
                bits |= u32::from(at.covers()) << (y * width + x);
                at.step_right();
            }
            row.step_down();
        }
        bits
    }

    /// The columns of a strip.
    fn columns(&self, strip: i32) -> RangeInclusive<i32> {
        strip..=strip + self.grid.strip - 1
    }
}

impl Iterator for Traversal {
    type Item = Cluster;

    fn next(&mut self) -> Option<Cluster> {
        loop {
            let strip = self.strip?;
            let Some(column) = self.column else {
                let line = self.line + self.grid.step(1, self.back[1]);
                if self.is_before_end(line) && self.reaches_line(strip, line) {
                    self.begin_line(strip, line);
                } else if self.back[0] {
                    self.enter(strip - self.grid.strip);
                } else {
                    self.enter(strip + self.grid.strip);
                }
                continue;
            };
            if !self.columns(strip).contains(&column) {
                self.column = None;
                continue;
            }
            let [width, height] = self.grid.cluster;
            self.looked_at += 1;
            if !self.reaches((column, self.line), (width, height)) {
                // Before the leading edge, or behind the triangle.
                self.column = (!self.met).then_some(column + self.grid.step(0, self.back[0]));
                continue;
            }
            if !self.met {
                (self.met, self.line_entry) = (true, column);
            }
            self.column = Some(column + self.grid.step(0, self.back[0]));
            let covered = self.covered(column, self.line);
            if covered != 0 {
                return Some(Cluster {
                    column,
                    line: self.line,
                    covered,
                    width: width as u8,
                });
            }
        }
    }
}

#[cfg(test)]
mod tests;
