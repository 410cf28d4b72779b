//! Which pixels of a span are seen: a coverage mask, depth tests, counts of shadow volumes (K8, K9, H9, X3).
//!
//! | file | there |
//! |---|---|
//! | `mask` | the columns of a line that are covered, a bit each |
//! | `test` | depths of up to 32 pixels against those that are there, by any function |
//! | `volume` | shadow polygons in front of each pixel, counted |

#[cfg(test)]
mod functions;
mod mask;
mod test;
mod volume;

pub(crate) use mask::{Mask, Part};
pub(crate) use test::{MOST as MOST_TESTED, keep, test};
pub(crate) use volume::{Receives, count, receive, settle};
