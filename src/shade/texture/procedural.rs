//! Textures that are computed (H17): no memory at all.

use super::{FRACTION, Period, Texels, Uv};

/// Squares of two colours in turn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Checker<C> {
    /// Both colours; the first lies at (0, 0).
    pub colours: [C; 2],
    /// A square's side is 2 to the power of this texels, 0 to 12.
    pub log_side: u32,
}

impl<C: Copy> Texels for Checker<C> {
    type Texel = C;

    /// Squares of up to 512 texels repeat with their neighbours.
    fn period(&self) -> Period {
        if self.log_side < 10 {
            Period::Short
        } else {
            Period::Long
        }
    }

    #[inline(always)]
    fn at(&self, place: Uv) -> C {
        let bit = FRACTION + self.log_side.min(12);
        self.colours[((place.u ^ place.v) >> bit & 1) as usize]
    }
}

/// A colour that goes evenly from one to another along u, and back again.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Gradient {
    /// Red, green and blue at u = 0.
    pub from: [u8; 3],
    /// Red, green and blue at u = 2^`log_length`.
    pub to: [u8; 3],
    /// 2 to the power of this texels from one to the other, 0 to 11.
    pub log_length: u32,
}

impl Texels for Gradient {
    type Texel = [u8; 3];

    /// It repeats after the way back.
    fn period(&self) -> Period {
        if self.log_length < 10 {
            Period::Short
        } else {
            Period::Long
        }
    }

    fn at(&self, place: Uv) -> [u8; 3] {
        // 8 bits of the way, and the bit above them, which turns it round.
        let way = place.u >> (FRACTION + self.log_length.min(11) - 8);
        let part = if way & 256 == 0 { way } else { !way } & 255;
        // 255 is all of it.
        let part = part + (part >> 7);
        let mut colour = [0; 3];
        for (i, level) in colour.iter_mut().enumerate() {
            let (a, b) = (i32::from(self.from[i]), i32::from(self.to[i]));
            *level = (a + (((b - a) * part + 128) >> 8)) as u8;
        }
        colour
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    fn uv(u: f64, v: f64) -> Uv {
        let fix = |x: f64| (x * f64::from(1 << FRACTION)) as i32;
        Uv {
            u: fix(u),
            v: fix(v),
        }
    }

    #[test]
    fn squares_alternate_both_ways() {
        let checker = Checker {
            colours: ['.', '#'],
            log_side: 2,
        };
        let row = |v: f64| -> std::string::String {
            (0..12).map(|u| checker.at(uv(f64::from(u), v))).collect()
        };
        assert_eq!(row(3.9), "....####....");
        assert_eq!(row(4.0), "####....####");
        assert_eq!(checker.at(uv(-0.5, 0.5)), '#');
    }

    #[test]
    fn gradients_go_there_and_back() {
        let gradient = Gradient {
            from: [0, 255, 10],
            to: [255, 0, 10],
            log_length: 4,
        };
        assert_eq!(gradient.at(uv(0.0, 9.0)), [0, 255, 10]);
        assert_eq!(gradient.at(uv(15.99, 0.0)), [255, 0, 10]);
        assert_eq!(gradient.at(uv(16.01, 0.0)), [255, 0, 10]);
        assert_eq!(gradient.at(uv(31.99, 0.0)), [0, 255, 10]);
        let mut last = 0;
        for i in 0..256 {
            let red = gradient.at(uv(f64::from(i) / 16.0, 0.0))[0];
            assert!((0..=1).contains(&(i32::from(red) - last)), "{i}: {red}");
            last = red.into();
        }
    }
}
