//! Loops that are there once.

use core::hint::black_box;

/// Keeps the loop around it short: most compilers write out four rounds of one that has no call, which on the cores this
/// is for takes flash, and time where there are one or two.
#[inline(always)]
pub fn rolled() {
    black_box(());
}
