//! Counts executed instructions with SysTick.
//!
//! Under `-icount shift=0` QEMU advances its clock by exactly 1 ns an instruction, so SysTick at the
//! machine's 25 MHz falls by one every 40 instructions, the same in every run. (The DWT cycle
//! counter reads 0 in QEMU.) SysTick has 24 bits, 0.67 s; its exception counts the wraps. Figures
//! are exact to one tick; [`check`] proves it against loops of known length.

use core::{
    arch::asm,
    sync::atomic::{AtomicU32, Ordering},
};

use cortex_m::{
    interrupt,
    peripheral::{SCB, SYST, syst::SystClkSource},
};
use cortex_m_rt::exception;

/// Instructions a tick: 25 MHz against 1 ns an instruction.
pub(crate) const INSTRUCTIONS_PER_TICK: u64 = 40;

/// Places of a tick at which runs start that are counted finely.
pub(crate) const PHASES: u32 = 10;

/// Ticks from one wrap to the next at the counter's full width.
const FULL_PERIOD: u32 = 1 << 24;

/// Wraps since the counter was started, but for one that is pending.
static WRAPS: AtomicU32 = AtomicU32::new(0);

#[exception]
fn SysTick() {
    // Not fetch_add: ARMv6-M has none, and nothing interrupts this handler.
    WRAPS.store(WRAPS.load(Ordering::Relaxed) + 1, Ordering::Relaxed);
}

/// SysTick, extended to 64 bits.
pub(crate) struct Counter {
    systick: SYST,
    period: u32,
    /// What measuring nothing costs, in ticks.
    overhead: u64,
}

impl Counter {
    /// Starts counting.
    pub(crate) fn start(systick: SYST) -> Self {
        let mut counter = Self {
            systick,
            period: FULL_PERIOD,
            overhead: 0,
        };
        counter.restart(FULL_PERIOD);
        counter
    }

    /// Counts the instructions that `work` executes, to within one tick of 40.
    pub(crate) fn instructions(&self, work: impl FnOnce()) -> u64 {
        let start = self.ticks();
        work();
        let ticks = self.ticks() - start;
        ticks.saturating_sub(self.overhead) * INSTRUCTIONS_PER_TICK
    }

    /// Counts the instructions of `work`, which does the same each time, to within about 5: the
    /// mean of runs that start at [`PHASES`] places of a tick.
    pub(crate) fn finely(&self, mut work: impl FnMut()) -> u64 {
        let mut sum = 0;
        for phase in 0..PHASES {
            self.wait(phase);
            sum += self.instructions(&mut work);
        }
        sum / u64::from(PHASES)
    }

    /// The same of lines that are drawn one after the other, without the first, which is drawn before.
    pub(crate) fn lines_finely(
        &self,
        lines: core::ops::Range<u16>,
        mut draw: impl FnMut(u16),
    ) -> u64 {
        let mut sum = 0;
        for phase in 0..PHASES {
            draw(lines.start);
            self.wait(phase);
            sum += self.instructions(|| (lines.start + 1..lines.end).for_each(&mut draw));
        }
        sum / u64::from(PHASES)
    }

    /// Waits for the start of a tick, and then for `phase` of [`PHASES`] parts of it.
    #[inline(never)]
    pub(crate) fn wait(&self, phase: u32) {
        let now = current();
        while current() == now {}
        spin(1 + phase * (INSTRUCTIONS_PER_TICK as u32 / 2 / PHASES));
    }

    /// Starts anew, with `period` ticks from one wrap to the next.
    fn restart(&mut self, period: u32) {
        self.systick.disable_counter();
        self.systick.set_clock_source(SystClkSource::Core);
        self.systick.set_reload(period - 1);
        self.systick.clear_current();
        SCB::clear_pendst();
        WRAPS.store(0, Ordering::Relaxed);
        self.systick.enable_interrupt();
        self.systick.enable_counter();
        self.period = period;
        self.overhead = 0;
        self.overhead = self.instructions(|| ()) / INSTRUCTIONS_PER_TICK;
    }

    /// What measuring nothing costs, in ticks.
    pub(crate) fn overhead(&self) -> u64 {
        self.overhead
    }

    /// Ticks since the start.
    #[inline(never)]
    pub(crate) fn ticks(&self) -> u64 {
        interrupt::free(|_| {
            let mut down = current();
            let mut wraps = WRAPS.load(Ordering::Relaxed);
            if SCB::is_pendst_pending() {
                // It wrapped just before or just after the first read: read again, after the wrap.
                down = current();
                wraps += 1;
            }
            u64::from(wraps) * u64::from(self.period) + u64::from(self.period - 1 - down)
        })
    }
}

/// The ticks left before the counter reaches 0, never 0 itself: it rests there for one tick at the
/// start and at each wrap, and whether that wrap is pending yet differs from case to case.
fn current() -> u32 {
    loop {
        let down = SYST::get_current();
        if down != 0 {
            return down;
        }
    }
}

/// A counted loop beside what it must count to.
pub(crate) struct Check {
    /// What was run.
    pub(crate) name: &'static str,
    /// Instructions that the loop has.
    pub(crate) expected: u64,
    /// Instructions that were counted.
    pub(crate) counted: u64,
    /// The largest difference that is right.
    pub(crate) tolerance: u64,
}

impl Check {
    /// Whether the count is right.
    pub(crate) fn holds(&self) -> bool {
        self.counted.abs_diff(self.expected) <= self.tolerance
    }
}

/// Holds the counter against loops of known length: one within a period, and one over many short
/// periods, where each wrap may add up to 64 instructions of exception entry, handler and return.
pub(crate) fn check(counter: &mut Counter) -> [Check; 2] {
    const ROUNDS: u32 = 1_000_000;
    const SHORT: u32 = 4_096;
    let expected = 2 * u64::from(ROUNDS);
    let plain = Check {
        name: "loop",
        expected,
        counted: counter.instructions(|| spin(ROUNDS)),
        tolerance: 2 * INSTRUCTIONS_PER_TICK,
    };
    counter.restart(SHORT);
    let counted = counter.instructions(|| spin(ROUNDS));
    counter.restart(FULL_PERIOD);
    let wraps = expected / (u64::from(SHORT) * INSTRUCTIONS_PER_TICK) + 1;
    let wrapped = Check {
        name: "wraps",
        expected,
        counted,
        tolerance: 2 * INSTRUCTIONS_PER_TICK + 64 * wraps,
    };
    [plain, wrapped]
}

/// Executes `2 * rounds` instructions, and a few to get there and back. `rounds` is at least 1.
#[inline(never)]
fn spin(rounds: u32) {
    // SAFETY: touches one register of its own and the flags, which are declared clobbered.
    unsafe {
        asm!(
            "2: subs {left}, {left}, #1",
            "bne 2b",
            left = inout(reg) rounds => _,
            options(nomem, nostack),
        );
    }
}
