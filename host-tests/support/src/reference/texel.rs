//! Texels in `f64`: where a pixel lies on a texture, and what is found there.
//!
//! A place is in texels from the upper left corner of the first one, to the right and down. What lies beyond the sides
//! is folded before a texel is read. Nearest takes the texel that holds the place; bilinear weights the four whose
//! middles are around it. The texel multiplies the colour that is linear on the screen.

/// What lies beyond a texture's sides.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Sides {
    /// The texture again.
    #[default]
    Wrap,
    /// The texture turned over, then as it is, and so on.
    Mirror,
    /// Its outermost texels.
    Clamp,
}

impl Sides {
    /// The texel that stands at a whole place, `0.0..side`.
    fn fold(self, at: f64, side: f64) -> f64 {
        match self {
            Self::Wrap => at.rem_euclid(side),
            Self::Mirror => {
                let twice = at.rem_euclid(2.0 * side);
                twice.min(2.0 * side - 1.0 - twice)
            }
            Self::Clamp => at.clamp(0.0, side - 1.0),
        }
    }
}

/// How many texels make a pixel.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
pub enum Filter {
    /// One.
    #[default]
    Nearest,
    /// Four, weighted.
    Bilinear,
}

/// A texture of the reference.
#[derive(Debug, Clone, PartialEq)]
pub struct TextureMap {
    /// Texels of a row.
    pub width: u32,
    /// Rows.
    pub height: u32,
    /// Red, green, blue in levels `0.0..=255.0`, rows from the top, `width * height` of them.
    pub texels: Vec<[f64; 3]>,
    /// What lies beyond the sides.
    pub sides: Sides,
    /// How it is read.
    pub filter: Filter,
}

impl TextureMap {
    /// From what stands at a column and row.
    #[must_use]
    pub fn made(width: u32, height: u32, texel: impl Fn(u32, u32) -> [f64; 3]) -> Self {
        let row = |y| (0..width).map(move |x| (x, y));
        Self {
            width,
            height,
            texels: (0..height)
                .flat_map(row)
                .map(|(x, y)| texel(x, y))
                .collect(),
            sides: Sides::default(),
            filter: Filter::default(),
        }
    }

    /// A place of a model, (0, 0) at the lower left and 1 a side, in texels.
    #[must_use]
    pub fn place(&self, [u, v]: [f64; 2]) -> [f64; 2] {
        [
            u * f64::from(self.width),
            (1.0 - v) * f64::from(self.height),
        ]
    }

    /// The texel that holds a place.
    #[must_use]
    pub fn nearest(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        let (width, height) = (f64::from(self.width), f64::from(self.height));
        let column = self.sides.fold(u.floor(), width) as usize;
        let row = self.sides.fold(v.floor(), height) as usize;
        self.texels[row * self.width as usize + column]
    }

    /// Red, green and blue at a place, in levels.
    #[must_use]
    pub fn at(&self, [u, v]: [f64; 2]) -> [f64; 3] {
        if self.filter == Filter::Nearest {
            return self.nearest([u, v]);
        }
        let mut sum = [0.0; 3];
        // The middle of texel n is at n + 0.5.
        let (left, top) = ((u - 0.5).floor(), (v - 0.5).floor());
        for (x, y) in [
            (left, top),
            (left + 1.0, top),
            (left, top + 1.0),
            (left + 1.0, top + 1.0),
        ] {
            let weight = (1.0 - (u - 0.5 - x).abs()) * (1.0 - (v - 0.5 - y).abs());
            let texel = self.nearest([x + 0.5, y + 0.5]);
            sum = std::array::from_fn(|i| sum[i] + weight * texel[i]);
        }
        sum
    }
}

/// The textures of a model.
#[derive(Debug, Clone, Copy, Default)]
pub struct Textures<'t> {
    /// All of them.
    pub maps: &'t [TextureMap],
    /// Which one each triangle has; those beyond its end have none.
    pub of_triangle: &'t [Option<usize>],
}

impl<'t> Textures<'t> {
    /// That of a triangle.
    pub(super) fn of(&self, triangle: usize) -> Option<&'t TextureMap> {
        let number = self.of_triangle.get(triangle).copied().flatten()?;
        self.maps.get(number)
    }
}
