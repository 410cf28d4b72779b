//! The shade of a textured triangle: its planes, and what they are along a span.

use super::course::Course;
use super::fields::fields;
use super::gouraud::{Planes as Shades, at, course};
use super::tint::Shade;
use super::{Fill, Place};
use crate::span::{Rise, Shares};

/// The shade of a triangle within 64 pixels half a pixel beyond a place, and its step.
#[inline(always)]
pub(super) fn small_shade(planes: &Shades, place: Place) -> [Shade; 2] {
    let step = Shade {
        red_blue: planes[1],
        green: planes[4],
    };
    let at = Shade {
        red_blue: at(planes, 0, place),
        green: at(planes, 3, place),
    };
    [at, step]
}

/// The shade along a span from a place's own pixel on.
#[inline(always)]
pub(super) fn shade_course(fill: Fill, planes: &Shades, place: Place) -> Course {
    let mut course = course(fill, planes, place);
    if fill == Fill::Small {
        // Half a pixel beyond, where it may have left its 16 bits.
        for (value, step) in course.value.iter_mut().zip(course.step) {
            *value = value.wrapping_sub((step >> 1) as u32) & 0x7FFF_FFFF;
        }
    }
    course
}

/// Half of full light: where a shade rises by as much in a pixel, half of a step is not told from another, and spans
/// have one pixel or two.
const STEEP: i32 = 1 << 14;

/// Planes of a shade half a pixel beyond each pixel, of a triangle within 64 pixels: red and blue, then green. Whether
/// it is not too steep for them.
#[inline(always)]
pub(super) fn shade_planes(shares: &Shares, colour: [u32; 3], planes: &mut Shades) -> bool {
    let shares = shares.cut::<6>();
    let [a, b, c] = colour.map(fields);
    let red = shares.rise::<6, 5>(b[0] - a[0], c[0] - a[0]);
    let green = shares.rise::<6, 5>(b[1] - a[1], c[1] - a[1]);
    let blue = shares.rise::<6, 6>(b[2] - a[2], c[2] - a[2]);
    let join = |high: i32, low: i32| ((high << 16) as u32).wrapping_add(low as u32);
    let first = |rise: &Rise, value: i32| rise.at.wrapping_add(value).wrapping_add(rise.dx >> 1);
    planes[0] = join(first(&red, a[0] << 5), first(&blue, a[2] << 6));
    planes[1] = join(red.dx, blue.dx);
    planes[2] = join(red.dy, blue.dy);
    planes[3] = (first(&green, a[1] << 5) << 16) as u32;
    planes[4] = (green.dx << 16) as u32;
    planes[5] = (green.dy << 16) as u32;
    let raised = |rise: &Rise| rise.dx.wrapping_add(STEEP) as u32;
    raised(&red) | raised(&green) | raised(&blue) < 2 * STEEP as u32
}

/// The shade half a pixel beyond a place, and its step, for a part of a span with so many pixels. A pixel alone in a
/// steep shade has that of its own place.
#[inline(always)]
pub(super) fn shade_at(course: &Course, pixels: u32) -> [Shade; 2] {
    let is_alone = pixels == 1
        && course
            .step
            .iter()
            .any(|step| (step ^ step >> 31) >> 15 >= STEEP);
    let step = if is_alone { [0; 3] } else { course.step };
    let half = |i: usize| course.value[i].wrapping_add((step[i] >> 1) as u32);
    let rounded = |i: usize| step[i].wrapping_add(1 << 14) >> 15;
    let shade = Shade {
        red_blue: half(0) << 1 & 0xFFFF_0000 | half(2) >> 15 & 0xFFFF,
        green: half(1) << 1 & 0xFFFF_0000,
    };
    let step = Shade {
        red_blue: ((rounded(0) << 16) as u32).wrapping_add(rounded(2) as u32),
        green: (rounded(1) << 16) as u32,
    };
    [shade, step]
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
