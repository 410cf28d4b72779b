//! The one home of fixed point (S4, K3, K4, K5).
//!
//! Numbers are integers with a binary point that their place in a program fixes; hot loops add them
//! wrapping and multiply them widening only, so the same input gives the same bits on every target.
//! Where a processor has no widening product, the same bits come in pieces. Nothing in here knows
//! what a number means.
//!
//! What an application hands over as a number of its own is a type of the `fixed` crate, which
//! brings its conversions; whole arrays, and all that is reckoned with, are the integers alone.
//!
//! | format | type | range | used for |
//! |---|---|---|---|
//! | 2.14 signed | [`I2F14`] | -2 ..< 2 | directions of lights |
//! | 1.15 unsigned | [`U1F15`] | 0 ..< 2 | levels of light and materials |
//! | 8.8 unsigned | `U8F8` | 0 ..< 256 | how far colours and texels may be off |
//! | 2.14 signed | `i16` | -2 ..< 2 | model coordinates, normals |
//! | 2.30 signed | `i32` | -2 ..< 2 | exact model coordinates, matrix mantissas |
//! | 13.3 unsigned | `i32` | 0 ..= 8191.875 | screen coordinates in guard space |
//! | 16.16 signed | `i32` | modulo 2^32 | planes of colour |
//! | 1.31 unsigned | `u32` | 0 ..= 1 | depth, 1/w with the near plane at 1 |
//! | 13.19 signed | `i32` | modulo 8192 | texels along a span |

mod bits;
mod block;
mod inverse_root;
mod log;
mod plane;
mod product;
mod quotient;
#[cfg(test)]
pub(crate) mod random;
mod recip;
mod recip16;
mod rolled;
mod short;
mod sine;

pub use bits::{bit, take_first};
pub use block::{Block, rounded, shift_round};
pub use fixed::types::{I2F14, U1F15};
pub use inverse_root::inverse_root;
pub use log::{exp2, log2};
pub use plane::InverseArea;
pub use product::{
    few_leading_zeros, leading_zeros, leading_zeros_here, mul_16, mul_high, mul_high_unsigned,
    mul_wide, of_255,
};
pub use quotient::{divide, divide_signed, quotient_16, slope_and_rest};
pub use recip::recip;
pub use recip16::{mul_17, mul_recip_16, of_height, recip_16, slope_of};
pub use rolled::rolled;
pub use short::SHORT;
pub use sine::sin_cos;

/// The pixel column and line that lies at the middle of guard space.
pub const GUARD_CENTRE: i32 = 4096;
