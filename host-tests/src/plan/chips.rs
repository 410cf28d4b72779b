//! Chips that the examples are for, whose cores are measured: their clocks, and those of the bus to the panel.

/// A chip.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Chip {
    /// What people call it.
    pub name: &'static str,
    /// Its core, as the board of that core is called.
    pub core: &'static str,
    /// Cycles of the core a second, as the example sets it up.
    pub clock: u32,
    /// Bits that the example sends to the panel a second.
    pub bus: u32,
}

/// All of them.
pub const CHIPS: [Chip; 2] = [
    Chip {
        name: "STM32F4",
        core: "m4",
        clock: 100_000_000,
        bus: 50_000_000,
    },
    Chip {
        name: "RP2040, one core",
        core: "m0plus",
        clock: 125_000_000,
        bus: 62_500_000,
    },
];

impl Chip {
    /// Frames a second of so many instructions, where each takes a cycle: an upper bound, since memories wait, and some
    /// instructions take more.
    #[must_use]
    pub fn by_clock(&self, instructions: f64) -> f64 {
        f64::from(self.clock) / instructions.max(1.0)
    }

    /// Frames a second that the bus can carry, of so many columns and lines with 16 bits a pixel.
    #[must_use]
    pub fn by_bus(&self, [width, height]: [u16; 2]) -> f64 {
        f64::from(self.bus) / (16.0 * f64::from(width) * f64::from(height)).max(1.0)
    }
}
