//! The looks that the scenes are drawn with, and the names of the suite's frames.

use crate::Suite;
use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::Rgb565Be;

/// Smooth colours, as an SPI panel takes them.
pub type LeanLook = Gouraud<Rgb565Be>;

/// What scenes with a texture are drawn with.
pub type LeanTextured = Textured<Rgb565Be>;

/// Names, and which scene each is.
pub const LEAN: [(&str, Suite); 9] = [
    ("lean_a", Suite::A),
    ("lean_b", Suite::B),
    ("lean_b_unlit", Suite::BUnlit),
    ("lean_c_f2n", Suite::FarToNear),
    ("lean_c_n2f", Suite::NearToFar),
    ("lean_f", Suite::F),
    ("lean_g", Suite::G),
    ("lean_teapot", Suite::Teapot),
    ("lean_inside", Suite::Inside),
];
