//! The screen and the camera: what stays the same for a whole frame.

use super::transform::{Affine, add, cross, unit_q30, wide_cross};
use crate::num::{Block, GUARD_CENTRE, divide_signed};

/// The size of the picture, 1 to 8192 pixels each way (K3).
///
/// A scene is begun with at most [`LARGEST`](crate::scene::LARGEST) of them each way, and a larger picture is drawn in
/// parts.
///
/// Guard space is the 8192 x 8192 pixel plane of 13.3 coordinates with the picture in its
/// middle; everything between geometry and spans is measured in it.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Screen {
    width: u16,
    height: u16,
}

/// The picture's size is not within 1 to 8192.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct ScreenError {
    /// The width that was asked for.
    pub width: u16,
    /// The height that was asked for.
    pub height: u16,
}

impl core::fmt::Display for ScreenError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        write!(
            f,
            "screen of {} x {} pixels: each side must be 1 to 8192",
            self.width, self.height
        )
    }
}

impl core::error::Error for ScreenError {}

impl Screen {
    /// A screen of `width` x `height` pixels. One scene takes at most [`LARGEST`](crate::scene::LARGEST) each way.
    ///
    /// # Errors
    /// When a side is 0 or above 8192.
    pub const fn new(width: u16, height: u16) -> Result<Self, ScreenError> {
        if width == 0 || height == 0 || width > 8192 || height > 8192 {
            return Err(ScreenError { width, height });
        }
        Ok(Self { width, height })
    }

    /// Pixels a line.
    #[must_use]
    pub const fn width(self) -> u16 {
        self.width
    }

    /// Lines.
    #[must_use]
    pub const fn height(self) -> u16 {
        self.height
    }

    /// The column of guard space at which the picture starts.
    #[inline]
    #[must_use]
    pub const fn left(self) -> i32 {
        GUARD_CENTRE - (self.width / 2) as i32
    }

    /// The line of guard space at which the picture starts.
    #[inline]
    #[must_use]
    pub const fn top(self) -> i32 {
        GUARD_CENTRE - (self.height / 2) as i32
    }

    /// The principal point in units of 1/8 pixel of guard space: 4 more on an odd side, so that
    /// pixels lie on the grid.
    #[cfg(test)]
    pub(super) fn centre(self) -> [i32; 2] {
        [self.width, self.height].map(|side| 8 * GUARD_CENTRE + 4 * i32::from(side & 1))
    }
}

/// Where the eye is and how it sees.
#[derive(Clone, Copy, Debug)]
pub struct Camera {
    /// World to camera: x right, y down, z ahead.
    pub(crate) view: Affine,
    /// The same, sheared by `shift`: what is in the middle of the picture is on the axis.
    pub(super) seen: Affine,
    /// Where the middle of the picture is, from where the camera looks: right and down, in 1/8 pixel.
    pub(super) shift: [i32; 2],
    /// Focal length in units of 1/8 pixel.
    pub(super) focal: Block<1>,
    pub(super) near: Block<1>,
    pub(super) far: Block<1>,
}

/// Why a camera cannot be made.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum CameraError {
    /// A number is not finite, or beyond 2^90.
    NotFinite,
    /// The eye is at the point it looks at.
    NoDirection,
    /// The up vector is zero or along the view.
    NoUp,
    /// The focal length is not within 2^-10 to 2^20 pixels.
    Focal,
    /// Not near < far, or near below 2^-60, or far not below 2^90.
    Range,
    /// The far plane is more than [`Camera::MOST_FAR`] times as far as the near plane.
    Ratio,
    /// The middle of the picture is more than 8,192 pixels or 64 focal lengths from where the camera looks.
    Shift,
}

impl core::fmt::Display for CameraError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        f.write_str(match self {
            Self::NotFinite => "camera: a number is not finite or too large",
            Self::NoDirection => "camera: the eye is at the point it looks at",
            Self::NoUp => "camera: the up vector is zero or along the view",
            Self::Focal => "camera: the focal length is not within 2^-10 to 2^20 pixels",
            Self::Range => "camera: near and far must satisfy 2^-60 <= near < far < 2^90",
            Self::Ratio => "camera: far is more than 65536 times near: depth has no bits for that",
            Self::Shift => {
                "camera: the picture is more than 8192 pixels or 64 focal lengths from where it looks"
            }
        })
    }
}

impl core::error::Error for CameraError {}

impl Camera {
    /// How many times the near plane's distance the far plane's may be.
    ///
    /// Depth is 1/w in 31 bits with the near plane at 2^30 or more. At this ratio the far plane is at 2^14, so
    /// of surfaces that face the eye, a thousandth of their distance apart, the nearer one is still 16
    /// units ahead. Those that lean are planes, which err by up to half a unit a pixel: a thousandth apart they are told
    /// apart in each pixel within 4,096 times near.
    pub const MOST_FAR: f32 = (1u32 << Self::FAR_BITS) as f32;
    /// As a power of two.
    const FAR_BITS: i32 = 16;

    /// A camera at `eye` that looks at `at` with `up` upwards, right-handed, world units.
    ///
    /// `focal` is the focal length in pixels: half the picture's height divided by the tangent
    /// of half the vertical field of view. What is nearer than `near` or farther than `far`,
    /// measured along the view, is not seen; `far` may be up to [`MOST_FAR`](Camera::MOST_FAR) times
    /// `near`. Coordinates count to 2^-30 of the largest one of their place.
    ///
    /// # Errors
    /// [`CameraError`] says which argument is wrong.
    pub fn look_at(
        eye: [f32; 3],
        at: [f32; 3],
        up: [f32; 3],
        focal: f32,
        near: f32,
        far: f32,
    ) -> Result<Self, CameraError> {
        let (eye, at, up) = (block(eye.map(|c| -c))?, block(at)?, block(up)?);
        // Floats without a sign are in the order of their bits, and what is no number comes last.
        let power = |exponent: i32| ((127 + exponent) as u32) << 23;
        if !(power(-10)..=power(20)).contains(&focal.to_bits()) {
            return Err(CameraError::Focal);
        }
        let (least, most) = (near.to_bits(), far.to_bits());
        if !(power(-60)..most).contains(&least) || most >= power(LIMIT) {
            return Err(CameraError::Range);
        }
        let (mut focal, near, far) = (block([focal])?, block([near])?, block([far])?);
        // To 1/8 pixel.
        focal.exponent += 3;
        // Times a power of two, as far is kept.
        if (far.exponent, far.mantissa) > (near.exponent + Self::FAR_BITS, near.mantissa) {
            return Err(CameraError::Ratio);
        }
        let way = add(at, eye).mantissa.map(i64::from);
        let ahead = unit_q30(way).ok_or(CameraError::NoDirection)?;
        let right = wide_cross(ahead, up.mantissa);
        // The sine of the angle between them is below 2^-16.
        if right.iter().all(|c| (c >> 32).abs() < 1 << 11) {
            return Err(CameraError::NoUp);
        }
        let right = unit_q30(right).ok_or(CameraError::NoUp)?;
        let down = cross(ahead, right);
        let turn = Affine::of_units([right, down, ahead]);
        let view = Affine {
            offset: turn.linear_times(eye),
            ..turn
        };
        Ok(Self {
            view,
            seen: view,
            shift: [0; 2],
            focal,
            near,
            far,
        })
    }

    /// The same camera, the middle of whose picture is so many pixels to the right of where it looks and below that,
    /// rounded to 1/8 pixel: each part of a picture that is larger than a scene can be is a scene of its own.
    ///
    /// The part that begins at a column `x` of a picture of `whole` columns and has `part` of them is seen by
    /// `x + part / 2 - whole / 2` to the right. Vertices are rounded in each part for itself, so edges of neighbours may
    /// be 1/8 pixel apart; from a shift of a focal length on, and for a model that is far larger than its distance, by
    /// more: what reaches far to the side leaves depth fewer bits.
    ///
    /// # Errors
    /// [`CameraError::Shift`] when that is not within 8,192 pixels and 64 focal lengths each way.
    pub fn shifted(&self, pixels: [f32; 2]) -> Result<Self, CameraError> {
        if !pixels.iter().all(|p| p.abs() <= 8192.0) {
            return Err(CameraError::Shift);
        }
        let shift = pixels.map(|p| (p * 8.0 + if p < 0.0 { -0.5 } else { 0.5 }) as i32);
        // In focal lengths, of which `one` is one: below 2^32.
        let [focal] = self.focal.mantissa;
        let [x, y] = shift.map(|s| divide_signed(i64::from(s) << 44, focal as u32));
        let one = 1i64 << (14 + self.focal.exponent);
        if x.abs().max(y.abs()) > one << 6 {
            return Err(CameraError::Shift);
        }
        let rows = [one, 0, -x, 0, one, -y, 0, 0, one];
        let shear = Affine {
            linear: Block::new(rows, 16 - self.focal.exponent),
            offset: Block::ZERO,
        };
        Ok(Self {
            seen: self.view.then(&shear),
            shift,
            ..*self
        })
    }
}

/// Places and lengths are below this power of two.
const LIMIT: i32 = 90;

#[inline(never)]
fn block<const N: usize>(v: [f32; N]) -> Result<Block<N>, CameraError> {
    match Block::from_f32(v) {
        Some(block) if block.exponent <= LIMIT => Ok(block),
        _ => Err(CameraError::NotFinite),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn bad_cameras_are_refused() {
        let make =
            |eye, at, up, focal, near, far| Camera::look_at(eye, at, up, focal, near, far).err();
        let (o, z, y) = ([0.0; 3], [0.0, 0.0, 1.0], [0.0, 1.0, 0.0]);
        assert_eq!(make(z, o, y, 100.0, 0.1, 10.0), None);
        assert_eq!(
            make(o, o, y, 100.0, 0.1, 10.0),
            Some(CameraError::NoDirection)
        );
        assert_eq!(make(z, o, z, 100.0, 0.1, 10.0), Some(CameraError::NoUp));
        assert_eq!(make(z, o, o, 100.0, 0.1, 10.0), Some(CameraError::NoUp));
        assert_eq!(
            make([f32::NAN, 0.0, 0.0], o, y, 100.0, 0.1, 10.0),
            Some(CameraError::NotFinite)
        );
        assert_eq!(make(z, o, y, 0.0, 0.1, 10.0), Some(CameraError::Focal));
        assert_eq!(make(z, o, y, f32::NAN, 0.1, 10.0), Some(CameraError::Focal));
        assert_eq!(make(z, o, y, 100.0, 0.0, 10.0), Some(CameraError::Range));
        assert_eq!(make(z, o, y, 100.0, 2.0, 1.0), Some(CameraError::Range));
        assert_eq!(make(z, o, y, 100.0, 1e-30, 10.0), Some(CameraError::Range));
        assert_eq!(make(z, o, y, 100.0, 1.0, 1e30), Some(CameraError::Range));
        assert_eq!(make(z, o, y, 100.0, 0.5, 32_768.0), None);
        let beyond = 32_768.0f32.next_up();
        assert_eq!(make(z, o, y, 100.0, 0.5, beyond), Some(CameraError::Ratio));
        let text = std::format!("{}", CameraError::Range);
        assert!(text.contains("2^-60") && text.contains("2^90"), "{text}");
        let text = std::format!("{}", CameraError::Ratio);
        assert!(text.contains("65536"), "{text}");
    }

    /// Kills: limits that are refused themselves, and such as let more in.
    #[test]
    fn limits_of_cameras_are_let_in_and_nothing_beyond() {
        let make = |far_off: f32, focal, near, far| {
            let (o, y) = ([0.0; 3], [0.0, 1.0, 0.0]);
            Camera::look_at([0.0, 0.0, far_off], o, y, focal, near, far).err()
        };
        let power = |exponent: i32| 2.0f32.powi(exponent);
        for focal in [power(-10), power(20)] {
            assert_eq!(make(1.0, focal, 1.0, 2.0), None);
        }
        for focal in [power(-10).next_down(), power(20).next_up()] {
            assert_eq!(make(1.0, focal, 1.0, 2.0), Some(CameraError::Focal));
        }
        assert_eq!(make(1.0, 100.0, power(-60), power(-59)), None);
        assert_eq!(make(1.0, 100.0, power(80), power(90).next_down()), None);
        let refused = [
            (power(-60).next_down(), power(-59)),
            (power(80), power(90)),
            (1.0, 1.0),
        ];
        for (near, far) in refused {
            assert_eq!(make(1.0, 100.0, near, far), Some(CameraError::Range));
        }
        assert_eq!(
            make(power(90), 100.0, 1.0, 2.0),
            Some(CameraError::NotFinite)
        );
        assert_eq!(
            make(-power(90), 100.0, 1.0, 2.0),
            Some(CameraError::NotFinite)
        );
    }

    #[test]
    fn screens_lie_in_the_middle() {
        let s = Screen::new(320, 241).unwrap();
        assert_eq!((s.left(), s.top()), (3936, 3976));
        assert_eq!(s.centre(), [32_768, 32_772]);
        assert!(Screen::new(0, 1).is_err() && Screen::new(1, 8193).is_err());
        assert_eq!(Screen::new(8192, 1).unwrap().left(), 0);
    }

    /// M3: a camera is made from its places each time, so nothing adds up however long it turns.
    ///
    /// Bound on the view's rows times their transpose, away from the identity, for rows that are 2^-28 off: 2^-26, also
    /// where it looks almost along up.
    #[test]
    fn views_keep_right_angles_however_often_they_turn() {
        let mut worst = [0f64; 2];
        for i in 0..1_000_000u32 {
            let angle = f64::from(i) * 0.001;
            let eye = [
                7.0 * angle.sin(),
                3.0 * (0.37 * angle).cos(),
                7.0 * angle.cos(),
            ];
            let eye = eye.map(|c| c as f32);
            // Every other one looks almost along up.
            let lean = if i % 2 == 0 { 1.0 } else { 1e-3 };
            let up = [0, 1, 2].map(|k| eye[k] + lean * [0.3, 5.0, 0.1][k]);
            let Ok(camera) = Camera::look_at(eye, [0.0; 3], up, 100.0, 0.1, 10.0) else {
                continue;
            };
            let (view, up, ahead) = (
                camera.view.linear,
                up.map(f64::from),
                eye.map(|c| -f64::from(c)),
            );
            let scale = f64::from(view.exponent - 30).exp2();
            let row = |k: usize| [0, 1, 2].map(|j| f64::from(view.mantissa[3 * k + j]) * scale);
            let dot = |a: [f64; 3], b: [f64; 3]| a[0] * b[0] + a[1] * b[1] + a[2] * b[2];
            let cosine = dot(up, ahead) / (dot(up, up) * dot(ahead, ahead)).sqrt();
            let sine = (1.0 - cosine * cosine).max(0.0).sqrt();
            if sine < 1e-4 {
                continue;
            }
            let bound = 2f64.powi(-26);
            // It looks where it should, and its picture's columns are upright.
            let along = |a: [f64; 3], b: [f64; 3]| dot(a, b) / dot(b, b).sqrt();
            assert!((along(row(2), ahead) - 1.0).abs() <= bound, "{angle}");
            assert!(
                along(row(0), up).abs() <= bound && along(row(1), up) < 0.0,
                "{angle}"
            );
            for (a, b) in [(0, 0), (1, 1), (2, 2), (0, 1), (0, 2), (1, 2)] {
                let want = f64::from(u8::from(a == b));
                let off = (dot(row(a), row(b)) - want).abs();
                assert!(off <= bound, "{a} {b}: {off}, {bound}, sine {sine}");
                let kind = usize::from(lean < 1.0);
                worst[kind] = worst[kind].max(off);
            }
        }
        std::println!(
            "skew {:.2e}, up almost along the view {:.2e}",
            worst[0],
            worst[1]
        );
        assert!(worst[1] > 0.0);
    }
}
