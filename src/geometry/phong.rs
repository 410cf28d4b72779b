//! Normals at vertices, linear between them on the screen, to be lit at each pixel (K10, K15).
//!
//! [`Phong`] is a shading around another one, which gives the colours that are lit. A vertex has
//! its normal in the camera's space, 3 x 12 bits; planes take it along the line with 16 bits more,
//! and at a pixel it is made unit length again. What falls on it there is [`PixelLamps`]' formula, the
//! same as at vertices. The way to the eye is the ray through the pixel, so no depth is needed.

use super::colour::{Colour, Scale};
use super::finish::Finish;
use super::pixel_lamps::unit_normal;
use super::shading::{Empty, Shading};
use super::texturing;
use super::transform::Affine;
use crate::num::{InverseArea, Plane, SmallArea};
use core::marker::PhantomData;

/// What a mesh brings so that it can be lit at each pixel; `I` is what the shading inside wants.
#[derive(Clone, Copy, Debug, Default)]
pub struct LitSkin<I = ()> {
    /// For the shading inside.
    pub skin: I,
    /// Which of the lamps lent to the scene shine on it.
    pub lamps: u16,
}

impl<'a, I: From<texturing::Skin<'a>>> From<texturing::Skin<'a>> for LitSkin<I> {
    /// In the light of the first lamps.
    fn from(skin: texturing::Skin<'a>) -> Self {
        Self {
            skin: skin.into(),
            lamps: 0,
        }
    }
}

/// The shading `S`, lit at each pixel.
///
/// Meshes without normals are lit as if they all looked at the eye. Right for models that are
/// turned and scaled the same in all directions.
#[derive(Clone, Copy, Debug)]
pub struct Phong<S>(PhantomData<S>);

/// A vertex of such a surface.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhongVertex<V> {
    inner: V,
    /// 12 bits each, 11 of them fraction.
    normal: [i16; 3],
}

impl<V: Default> Default for PhongVertex<V> {
    fn default() -> Self {
        Self {
            inner: V::default(),
            normal: TO_EYE,
        }
    }
}

/// The normal of what looks at the eye.
const TO_EYE: [i16; 3] = [0, 0, -MOST];
/// The largest part of a normal.
const MOST: i16 = 2047;
/// Fraction bits of normals in planes: 16 more than they have.
const FRACTION: u32 = 27;

/// A face of such a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct PhongFace<F> {
    inner: F,
    lamps: u16,
}

impl<V: Empty> Empty for PhongVertex<V> {
    const EMPTY: Self = Self {
        inner: V::EMPTY,
        normal: [0; 3],
    };
}

impl<F: Empty> Empty for PhongFace<F> {
    const EMPTY: Self = Self {
        inner: F::EMPTY,
        lamps: 0,
    };
}

/// What an object is coloured by, and its normals.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct PhongLevels<L> {
    /// The levels of its shading.
    pub inner: L,
    /// The normals as planes with 27 fraction bits, space of the camera.
    normal: [Plane; 3],
    /// Which lamps shine on it.
    pub lamps: u16,
}

impl<L> PhongLevels<L> {
    /// The normal at a pixel of guard space: about unit length in Q1.14.
    #[inline]
    #[must_use]
    pub fn normal(&self, column: i32, line: i32) -> [i16; 3] {
        unit_normal(self.normal.map(|plane| plane.at(column, line)))
    }
}

/// A normal's parts as planes take them.
fn wide<V>(vertex: &PhongVertex<V>) -> [i32; 3] {
    vertex.normal.map(|c| i32::from(c) << (FRACTION - 11))
}

/// Three planes through the normals of the corners.
fn planes<V>(
    corners: &[PhongVertex<V>; 3],
    plane: impl Fn([i32; 3]) -> Option<Plane>,
) -> Option<[Plane; 3]> {
    let at = corners.each_ref().map(wide);
    let along = |i: usize| plane([at[0][i], at[1][i], at[2][i]]);
    Some([along(0)?, along(1)?, along(2)?])
}

impl<S: Shading> Shading for Phong<S> {
    type Vertex = PhongVertex<S::Vertex>;
    type Face = PhongFace<S::Face>;
    type Levels = PhongLevels<S::Levels>;
    const NO_LEVELS: Self::Levels = PhongLevels {
        inner: S::NO_LEVELS,
        normal: [Plane::ZERO; 3],
        lamps: 0,
    };
    const PER_FACE: bool = S::PER_FACE;

    fn vertex(colour: Colour) -> Self::Vertex {
        PhongVertex {
            inner: S::vertex(colour),
            normal: TO_EYE,
        }
    }

    fn face(colour: Colour) -> Self::Face {
        PhongFace {
            inner: S::face(colour),
            lamps: 0,
        }
    }

    fn lerp(a: Self::Vertex, b: Self::Vertex, t: i64, space: i64) -> Self::Vertex {
        let mix = |i: usize| {
            let (from, to) = (i64::from(a.normal[i]), i64::from(b.normal[i]));
            (from + (((to - from) * t + (1 << 29)) >> 30)) as i16
        };
        PhongVertex {
            inner: S::lerp(a.inner, b.inner, t, space),
            normal: [mix(0), mix(1), mix(2)],
        }
    }

    type Skin<'a> = LitSkin<S::Skin<'a>>;
    const SKINNED: bool = true;
    const TEXTURED: bool = S::TEXTURED;

    fn fits(skin: &Self::Skin<'_>, vertices: usize) -> bool {
        S::fits(&skin.skin, vertices)
    }

    fn known<'a>(
        skin: Self::Skin<'a>,
        period: impl FnOnce(u16) -> texturing::Period,
    ) -> Self::Skin<'a> {
        LitSkin {
            skin: S::known(skin.skin, period),
            ..skin
        }
    }

    fn may_be_plain(skin: &Self::Skin<'_>) -> bool {
        S::may_be_plain(&skin.skin)
    }

    fn is_plain(skin: &Self::Skin<'_>, corners: [&Self::Vertex; 3]) -> bool {
        S::is_plain(&skin.skin, corners.map(|c| &c.inner))
    }

    #[inline]
    fn dress(vertex: &mut Self::Vertex, skin: &Self::Skin<'_>, index: usize) {
        S::dress(&mut vertex.inner, &skin.skin, index);
    }

    #[inline]
    fn dress_face(face: &mut Self::Face, skin: &Self::Skin<'_>) {
        S::dress_face(&mut face.inner, &skin.skin);
        face.lamps = skin.lamps;
    }

    type Turn = Affine;
    const NORMALS: bool = true;

    fn turn(model: &Affine, view: &Affine) -> Affine {
        model.then(view)
    }

    #[inline]
    fn set_normal(vertex: &mut Self::Vertex, turn: &Affine, normal: [i16; 3]) {
        vertex.normal = (turn.unit_normal(normal)).map(|c| ((c + 4) >> 3).clamp(-MOST, MOST));
    }

    type Mark = S::Mark;

    #[inline(always)]
    fn mark(face: &Self::Face) -> S::Mark {
        S::mark(&face.inner)
    }

    #[inline(always)]
    fn set_mark(face: &mut Self::Face, mark: S::Mark) {
        S::set_mark(&mut face.inner, mark);
    }

    const COMPOSITED: bool = S::COMPOSITED;

    #[inline]
    fn finish(face: &Self::Face) -> Option<&Finish> {
        S::finish(&face.inner)
    }

    #[inline]
    fn set_up_small(
        area: &SmallArea,
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<Self::Levels> {
        Some(PhongLevels {
            normal: planes(&corners, |values| area.wide_plane(values))?,
            inner: S::set_up_small(area, corners.map(|c| c.inner), depths, face.inner, scale)?,
            lamps: face.lamps,
        })
    }

    fn set_up(
        area: &InverseArea,
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<Self::Levels> {
        Some(PhongLevels {
            normal: planes(&corners, |values| area.plane(values))?,
            inner: S::set_up(area, corners.map(|c| c.inner), depths, face.inner, scale)?,
            lamps: face.lamps,
        })
    }

    fn weighted(
        w: [i64; 2],
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Self::Levels {
        let at = corners.each_ref().map(wide);
        let mean = |i: usize| {
            let to = |k: usize| i64::from(at[k][i] - at[0][i]) * w[k - 1];
            Plane {
                at: at[0][i] + ((to(1) + to(2)) >> 30) as i32,
                ..Plane::ZERO
            }
        };
        PhongLevels {
            normal: [mean(0), mean(1), mean(2)],
            inner: S::weighted(w, corners.map(|c| c.inner), depths, face.inner, scale),
            lamps: face.lamps,
        }
    }
}

const _: () = assert!(size_of::<PhongVertex<Colour>>() == 12);
