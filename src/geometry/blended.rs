//! Surfaces with a finish: what a mesh, a vertex, a face and an active object carry so that
//! their pixels can be composited (K11, H8, H9).
//!
//! [`Blended`] is a shading around another one, as [`Textured`](super::texturing::Textured) is: what
//! is not blended has no bytes and no code for it. Alpha is linear on the screen, as colour is.

use super::colour::{Colour, Scale};
use super::finish::{Finish, Role};
use super::shading::{Empty, Shading};
use super::texturing;
use crate::num::{InverseArea, Plane, SmallArea};
use core::marker::PhantomData;

/// What a mesh brings so that it can be composited; `I` is what the shading inside wants.
#[derive(Clone, Copy, Debug, Default)]
pub struct Surface<'a, I = ()> {
    /// For the shading inside.
    pub skin: I,
    /// What its pixels do to those that are there.
    pub finish: Finish,
    /// The alpha of each vertex, which multiplies that of the finish, 255 for 1. Empty, or as
    /// long as the positions.
    pub alphas: &'a [u8],
}

impl<I: Default> From<Finish> for Surface<'_, I> {
    fn from(finish: Finish) -> Self {
        Self {
            finish,
            ..Self::default()
        }
    }
}

impl<'a, I: From<texturing::Skin<'a>>> From<texturing::Skin<'a>> for Surface<'a, I> {
    /// Opaque.
    fn from(skin: texturing::Skin<'a>) -> Self {
        Self {
            skin: skin.into(),
            finish: Finish::OPAQUE,
            alphas: &[],
        }
    }
}

/// The shading `S`, of surfaces with a finish.
#[derive(Clone, Copy, Debug)]
pub struct Blended<S>(PhantomData<S>);

/// A vertex of such a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlendedVertex<V> {
    inner: V,
    alpha: u8,
}

/// A face of such a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct BlendedFace<F> {
    inner: F,
    finish: Finish,
    /// Whether vertices have alphas.
    varies: bool,
}

impl<V: Empty> Empty for BlendedVertex<V> {
    const EMPTY: Self = Self {
        inner: V::EMPTY,
        alpha: 0,
    };
}

impl<F: Empty> Empty for BlendedFace<F> {
    const EMPTY: Self = Self {
        inner: F::EMPTY,
        finish: Finish::OPAQUE,
        varies: false,
    };
}

/// What an object is coloured by, and how it is composited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlendedLevels<L> {
    /// The levels of its shading.
    pub inner: L,
    /// How it is composited.
    pub finish: ObjectFinish,
}

/// How an object is composited.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct ObjectFinish {
    /// What its pixels do to those that are there.
    pub rules: Finish,
    /// When it is drawn.
    pub role: Role,
    /// Alpha of the vertices, where they have any; half a step more than levels in units of
    /// 2^-22 of a level.
    alpha: Option<Plane>,
}

/// Fraction bits of alpha in planes.
const FRACTION: u32 = 22;

impl ObjectFinish {
    const OPAQUE: Self = Self {
        rules: Finish::OPAQUE,
        role: Role::Plain,
        alpha: None,
    };

    /// The alpha of the surface at a pixel of guard space, 255 for 1.
    #[inline]
    #[must_use]
    pub fn alpha(&self, column: i32, line: i32) -> u8 {
        let whole = self.rules.alpha;
        let Some(plane) = &self.alpha else {
            return whole;
        };
        // Planes err by less than half a level.
        let vertex = plane.at(column, line) as u32 >> FRACTION;
        ((vertex * u32::from(whole) + 127) / 255).min(255) as u8
    }

    /// Whether alpha is not the same everywhere.
    #[inline]
    #[must_use]
    pub const fn varies(&self) -> bool {
        self.alpha.is_some()
    }

    fn new<F>(face: &BlendedFace<F>, alpha: Option<Plane>) -> Self {
        Self {
            rules: face.finish,
            role: face.finish.role(),
            alpha,
        }
    }
}

/// What planes of alpha go through.
fn wide<V>(vertex: &BlendedVertex<V>) -> i32 {
    ((i32::from(vertex.alpha) << 1) + 1) << (FRACTION - 1)
}

impl<S: Shading> Shading for Blended<S> {
    type Vertex = BlendedVertex<S::Vertex>;
    type Face = BlendedFace<S::Face>;
    type Levels = BlendedLevels<S::Levels>;
    const NO_LEVELS: Self::Levels = BlendedLevels {
        inner: S::NO_LEVELS,
        finish: ObjectFinish::OPAQUE,
    };
    const PER_FACE: bool = S::PER_FACE;

    fn vertex(colour: Colour) -> Self::Vertex {
        BlendedVertex {
            inner: S::vertex(colour),
            alpha: 255,
        }
    }

    fn face(colour: Colour) -> Self::Face {
        BlendedFace {
            inner: S::face(colour),
            ..BlendedFace::default()
        }
    }

    fn lerp(a: Self::Vertex, b: Self::Vertex, t: i64, space: i64) -> Self::Vertex {
        let (from, to) = (i64::from(a.alpha), i64::from(b.alpha));
        BlendedVertex {
            inner: S::lerp(a.inner, b.inner, t, space),
            alpha: (from + (((to - from) * t + (1 << 29)) >> 30)) as u8,
        }
    }

    type Skin<'a> = Surface<'a, S::Skin<'a>>;
    const SKINNED: bool = true;
    const TEXTURED: bool = S::TEXTURED;

    fn fits(surface: &Self::Skin<'_>, vertices: usize) -> bool {
        S::fits(&surface.skin, vertices)
            && (surface.alphas.is_empty() || surface.alphas.len() == vertices)
    }

    fn known<'a>(
        skin: Self::Skin<'a>,
        period: impl FnOnce(u16) -> texturing::Period,
    ) -> Self::Skin<'a> {
        Surface {
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
    fn dress(vertex: &mut Self::Vertex, surface: &Self::Skin<'_>, index: usize) {
        S::dress(&mut vertex.inner, &surface.skin, index);
        vertex.alpha = surface.alphas.get(index).copied().unwrap_or(255);
    }

    #[inline]
    fn dress_face(face: &mut Self::Face, surface: &Self::Skin<'_>) {
        S::dress_face(&mut face.inner, &surface.skin);
        face.finish = surface.finish;
        face.varies = !surface.alphas.is_empty();
    }

    #[inline]
    fn finish(face: &Self::Face) -> Option<&Finish> {
        Some(&face.finish)
    }

    #[inline]
    fn set_up_small(
        area: &SmallArea,
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<Self::Levels> {
        let alpha = if face.varies {
            Some(area.wide_plane(corners.each_ref().map(wide))?)
        } else {
            None
        };
        Some(BlendedLevels {
            inner: S::set_up_small(area, corners.map(|c| c.inner), depths, face.inner, scale)?,
            finish: ObjectFinish::new(&face, alpha),
        })
    }

    fn set_up(
        area: &InverseArea,
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<Self::Levels> {
        let alpha = if face.varies {
            Some(area.plane(corners.each_ref().map(wide))?)
        } else {
            None
        };
        Some(BlendedLevels {
            inner: S::set_up(area, corners.map(|c| c.inner), depths, face.inner, scale)?,
            finish: ObjectFinish::new(&face, alpha),
        })
    }

    fn weighted(
        w: [i64; 2],
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Self::Levels {
        let alpha = face.varies.then(|| {
            let v = corners.each_ref().map(|c| i64::from(wide(c)));
            let at = v[0] + (((v[1] - v[0]) * w[0] + (v[2] - v[0]) * w[1]) >> 30);
            Plane {
                at: at as i32,
                ..Plane::ZERO
            }
        });
        BlendedLevels {
            inner: S::weighted(w, corners.map(|c| c.inner), depths, face.inner, scale),
            finish: ObjectFinish::new(&face, alpha),
        }
    }
}
