//! The shade of a textured triangle: its planes, and what they are along a span.

use super::course::Course;
use super::gouraud::{Planes as Shades, keep_pairs, rises};
use super::ramp::{Pair, go_on};
use crate::span::Shares;

/// Half of full light: where a shade rises by as much in a pixel, half of a step is not told from another, and spans
/// have one pixel or two.
const STEEP: i32 = 1 << 14;

/// Planes of a shade half a pixel beyond each pixel, of a triangle within 64 pixels: red and blue, then green. Whether
/// it is not too steep for them.
#[inline(always)]
pub(super) fn shade_planes(shares: &Shares, colour: [u32; 3], planes: &mut Shades) -> bool {
    let mut rises = rises(shares, colour);
    for rise in &mut rises {
        rise.at = rise.at.wrapping_add(rise.dx >> 1);
    }
    keep_pairs(rises, planes);
    let [red, green, blue] = rises.map(|rise| rise.dx.wrapping_add(STEEP) as u32);
    red | green | blue < 2 * STEEP as u32
}

/// The shade half a pixel beyond a place, and its step, for a part of a span with so many pixels. A pixel alone in a
/// steep shade has that of its own place.
#[inline(always)]
pub(super) fn shade_at(course: &Course, pixels: u32) -> [Pair; 2] {
    let mut course = *course;
    let is_steep = |step: &i32| (step ^ step >> 31) >> 15 >= STEEP;
    if pixels == 1 && course.step.iter().any(is_steep) {
        course.step = [0; 3];
    }
    go_on(&mut course.value, course.step.map(|s| (s >> 1) as u32), 1);
    [course.pair(), course.pair_step(0)]
}

#[cfg(test)]
mod tests {
    use super::{Course, STEEP, shade_at};

    /// Kills: a shade that is just steep counts as one that is not.
    #[test]
    fn a_pixel_alone_in_a_steep_shade_has_that_of_its_place() {
        let alone = |step: i32, pixels: u32| {
            let course = Course {
                value: [1 << 28; 3],
                step: [step, 0, 0],
                packed: 0,
            };
            shade_at(&course, pixels)[0].red_blue
        };
        let steep = STEEP << 15;
        for step in [steep, steep + 1, i32::MAX, -steep - 1, i32::MIN] {
            assert_eq!(alone(step, 1), alone(0, 1), "{step}");
            assert_ne!(alone(step, 2), alone(0, 1), "{step}");
        }
        for step in [steep - 1, -steep] {
            assert_ne!(alone(step, 1), alone(0, 1), "{step}");
        }
    }
}
