//! Random numbers for tests, the same everywhere: a linear congruence, of which the upper half is
//! used.

/// A generator, by its seed.
pub(crate) struct Rng(pub(crate) u64);

impl Rng {
    /// 0 to `n - 1`.
    pub(crate) fn below(&mut self, n: u32) -> u32 {
        self.0 = self
            .0
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1_442_695_040_888_963_407);
        (((self.0 >> 32) * u64::from(n)) >> 32) as u32
    }
}
