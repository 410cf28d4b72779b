//! Linear edge functions: inside or outside by three signs (B4).
//!
//! `E(x, y) = dx (y - y0) - dy (x - x0)` is 0 on the edge and positive inside. It is linear, so
//! it can be stepped from pixel to pixel by additions, and all is in whole units of 1/64 pixel
//! area, so stepping and starting anew give the same bits. Pixels whose centre lies on an edge
//! belong to the triangle on their left or above, as K4 has it for spans: `min < x <= max` and
//! `Ytop < Y <= Ybottom`. Hence the same pixels as the scanline path, exactly.

/// One edge function, evaluated at a pixel's centre.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeFunction {
    /// The value at the pixel, less 1 where the edge itself is outside: inside is not negative.
    value: i64,
    /// Step to the pixel on the right.
    right: i64,
    /// Step to the pixel below.
    down: i64,
}

impl EdgeFunction {
    /// The function of the edge from `a` to `b` at pixel (`column`, `line`); coordinates are
    /// 13.3, and inside is right of the way on a screen whose y goes down.
    #[must_use]
    pub fn new(a: (u16, u16), b: (u16, u16), (column, line): (i32, i32)) -> Self {
        let dx = i64::from(b.0) - i64::from(a.0);
        let dy = i64::from(b.1) - i64::from(a.1);
        let x = 8 * i64::from(column) + 4 - i64::from(a.0);
        let y = 8 * i64::from(line) + 4 - i64::from(a.1);
        // A right edge goes down, a lower one to the left: they are part of the triangle.
        let owned = dy > 0 || (dy == 0 && dx < 0);
        Self {
            value: dx * y - dy * x - i64::from(!owned),
            right: -8 * dy,
            down: 8 * dx,
        }
    }

    /// Whether the pixel is on the inner side.
    #[inline]
    #[must_use]
    pub const fn is_inside(self) -> bool {
        self.value >= 0
    }

    /// Whether the inner side, the edge itself always among it, reaches the area of `columns` by
    /// `lines` pixels of which this is the upper left one.
    #[inline]
    #[must_use]
    pub const fn reaches(self, columns: i32, lines: i32) -> bool {
        // The largest value is at a corner, half a pixel off the outer centres; steps are even.
        const fn most(step: i64, pixels: i32) -> i64 {
            if step > 0 {
                step / 2 * (2 * pixels as i64 - 1)
            } else {
                -step / 2
            }
        }
        self.value + most(self.right, columns) + most(self.down, lines) >= -1
    }

    /// The function `columns` to the right and `lines` below.
    #[inline]
    #[must_use]
    pub const fn moved(self, columns: i32, lines: i32) -> Self {
        Self {
            value: self.value + columns as i64 * self.right + lines as i64 * self.down,
            ..self
        }
    }

    /// Goes one pixel to the right.
    #[inline]
    pub fn step_right(&mut self) {
        self.value += self.right;
    }

    /// Goes one pixel down.
    #[inline]
    pub fn step_down(&mut self) {
        self.value += self.down;
    }
}

/// The three edge functions of a triangle at a pixel.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EdgeFunctions([EdgeFunction; 3]);

impl EdgeFunctions {
    /// Those of a triangle that covers nothing and reaches nowhere.
    pub(super) const NOTHING: Self = Self(
        [EdgeFunction {
            value: -2,
            right: 0,
            down: 0,
        }; 3],
    );

    /// The triangle of three corners, 13.3, in either order; `None` when it has no area.
    #[must_use]
    pub fn new([a, b, c]: [(u16, u16); 3], at: (i32, i32)) -> Option<Self> {
        let d = |from: u16, to: u16| i64::from(to) - i64::from(from);
        let area = d(a.0, b.0) * d(a.1, c.1) - d(a.1, b.1) * d(a.0, c.0);
        let (b, c) = if area < 0 { (c, b) } else { (b, c) };
        (area != 0)
            .then(|| Self([(a, b), (b, c), (c, a)].map(|(p, q)| EdgeFunction::new(p, q, at))))
    }

    /// Whether the pixel is covered.
    #[inline]
    #[must_use]
    pub fn covers(&self) -> bool {
        self.0.iter().all(|edge| edge.is_inside())
    }

    /// Whether each inner side reaches the area of `columns` by `lines` pixels of which this is the
    /// upper left one.
    #[must_use]
    pub fn reach(&self, columns: i32, lines: i32) -> bool {
        self.0.iter().all(|edge| edge.reaches(columns, lines))
    }

    /// The functions `columns` to the right and `lines` below.
    #[must_use]
    pub fn moved(self, columns: i32, lines: i32) -> Self {
        Self(self.0.map(|edge| edge.moved(columns, lines)))
    }

    /// Goes one pixel to the right.
    pub fn step_right(&mut self) {
        self.0.iter_mut().for_each(EdgeFunction::step_right);
    }

    /// Goes one pixel down.
    pub fn step_down(&mut self) {
        self.0.iter_mut().for_each(EdgeFunction::step_down);
    }
}
