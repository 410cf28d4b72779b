//! Methods against f64 and whole numbers, which share no code with them.

mod choice;
mod depths;
mod kept;
mod lirp;
mod methods;
mod places;
mod triangles;

/// A linear congruence, of which the upper half is used.
struct Rng(u64);

impl Rng {
    /// 32 random bits.
    fn bits(&mut self) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (self.0 >> 32) as u32
    }

    /// 0 to `n - 1`.
    fn below(&mut self, n: u32) -> u32 {
        ((u64::from(self.bits()) * u64::from(n)) >> 32) as u32
    }

    /// 0 to 1.
    fn unit(&mut self) -> f64 {
        f64::from(self.below(1 << 30)) / f64::from(1 << 30)
    }
}
