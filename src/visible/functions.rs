//! All depth functions beside what their names say, for tests (H9).

use crate::scene::DepthFunction;

/// A function, and what it is of two depths, the new one first.
pub(super) type Named = (DepthFunction, fn(u32, u32) -> bool);

/// All functions.
pub(super) const FUNCTIONS: [Named; 8] = [
    (DepthFunction::NEVER, |_, _| false),
    (DepthFunction::ALWAYS, |_, _| true),
    (DepthFunction::NEARER, |new, old| new > old),
    (DepthFunction::NEARER_OR_EQUAL, |new, old| new >= old),
    (DepthFunction::EQUAL, |new, old| new == old),
    (DepthFunction::FARTHER_OR_EQUAL, |new, old| new <= old),
    (DepthFunction::FARTHER, |new, old| new < old),
    (DepthFunction::DIFFERENT, |new, old| new != old),
];
