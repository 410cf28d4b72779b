//! What the proofs share: a generator whose failures can be repeated, vectors and solids in f64, and displays that are
//! sent what changed.

pub mod changes;
pub mod solid;

/// A value that is never given back.
pub fn leaked<T>(value: T) -> &'static T {
    Box::leak(Box::new(value))
}

/// xorshift64*: small, and the same everywhere.
#[derive(Clone, Debug)]
pub struct Rng(u64);

impl Rng {
    /// A generator that gives the same numbers for the same seed.
    pub fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    fn next(&mut self) -> u64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 16
    }

    /// A number from 0, below `n`.
    pub fn below(&mut self, n: u32) -> u32 {
        (((self.next() & 0xFFFF_FFFF) * u64::from(n)) >> 32) as u32
    }

    /// A number from `low` to `high`, both inclusive.
    pub fn within(&mut self, low: i32, high: i32) -> i32 {
        low + self.below((high - low + 1) as u32) as i32
    }

    /// A number in `-1.0 .. 1.0`.
    pub fn signed(&mut self) -> f64 {
        f64::from(self.below(1 << 30)) / f64::from(1 << 29) - 1.0
    }

    /// A number from 0, below 1.
    pub fn unit(&mut self) -> f64 {
        f64::from(self.below(1 << 30)) / f64::from(1 << 30)
    }

    /// A number from `low`, below `high`.
    pub fn between(&mut self, low: f64, high: f64) -> f64 {
        low + (high - low) * self.unit()
    }

    /// One of the values.
    pub fn pick<T: Copy>(&mut self, values: &[T]) -> T {
        values[self.below(values.len() as u32) as usize]
    }

    /// Mixes up the order.
    pub fn shuffle<T>(&mut self, values: &mut [T]) {
        for i in (1..values.len()).rev() {
            values.swap(i, self.below(i as u32 + 1) as usize);
        }
    }
}
