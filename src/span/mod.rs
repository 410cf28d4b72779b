//! From triangles to spans: sides, planes, columns (K4, K5, B).
//!
//! | file | there |
//! |---|---|
//! | `edge` | the sides of a triangle on a line |
//! | `plane` | planes of small triangles |
//! | `triangle` | how large a triangle is, and what follows from it |

mod edge;
mod plane;
mod triangle;

pub use edge::{Edge, Frame};
pub(crate) use edge::{across, down};
pub use plane::{Rise, Shares};
pub(crate) use triangle::end_line;
pub use triangle::{Sides, Size, Triangle, Way};
