//! Texturing: what a mesh, a vertex, a face and an active object carry so that a span knows its
//! place on a texture (H1, H3, X2).
//!
//! [`Textured`] is a shading around another one, so what is not textured has no bytes and no code
//! for it. A triangle is set up in one of two ways, decided once: where the error budget allows u
//! and v to be linear on the screen, as two planes, with no division ever; else as planes of 1/w,
//! u/w and v/w with one exponent. Texture places are linear on the surface, so clipping cuts them
//! there, while colour stays linear on the screen.
//!
//! | file | there |
//! |---|---|
//! | `place` | texture places, their homogeneous form, the budget |
//! | `corners` | a triangle's 1/w, u/w, v/w with one exponent; straight or not |
//! | `detail` | which level of detail is right where |

mod corners;
mod detail;
mod place;

pub use corners::{Corner, Corners, Period};
pub use detail::{Detail, LEVELS, LevelEnds};
pub use place::{Budget, FRACTION, Homogeneous, Quality, Uv};

use super::colour::{Colour, Scale};
use super::shading::{Empty, Shading};
use crate::num::{InverseArea, Plane, SmallArea};
use core::marker::PhantomData;

/// What a mesh brings so that it can be textured. Without places it is drawn untextured.
#[derive(Clone, Copy, Debug, Default)]
pub struct Skin<'a> {
    /// The place of each vertex on the texture: to the right and down from its upper left corner,
    /// in texels with 8 fraction bits; any number of repeats. Empty, or as long as the positions.
    ///
    /// A triangle may stretch over 4096 texels, wherever it begins. One that is wider is drawn
    /// untextured, and counted in [`PassOne::untextured`](crate::stats::PassOne::untextured); so is one on
    /// a texture whose rim goes on ([`Clamp`](crate::pipeline::texture::Clamp)) that lies across it and has
    /// a corner below -4096 texels or from 4096 on.
    pub places: &'a [[i32; 2]],
    /// Which of the textures lent to the scene, below [`Skin::TEXTURES`].
    pub texture: u16,
    /// How far places may be off.
    pub quality: Quality,
}

impl Skin<'_> {
    /// How many textures there can be.
    pub const TEXTURES: u16 = 0xFFF;
}

/// Shadings without textures ignore it.
impl From<Skin<'_>> for () {
    fn from(_: Skin<'_>) {}
}

/// The texture of a face: its number in the lower 12 bits, its period in the next 2, and the
/// quality above.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FaceTexture(u16);

impl FaceTexture {
    /// No texture.
    const NONE: Self = Self(Skin::TEXTURES);

    /// Of a skin that is [`known`].
    fn new(skin: &Skin<'_>) -> Self {
        if skin.places.is_empty() || skin.texture & Skin::TEXTURES == Skin::TEXTURES {
            return Self::NONE;
        }
        let quality = match skin.quality {
            Quality::Fast => 0,
            Quality::Balanced => 1,
            Quality::Exact => 2,
        };
        Self(skin.texture | quality << 14)
    }

    /// The number of the texture, if there is one.
    fn texture(self) -> Option<u16> {
        let number = self.0 & Skin::TEXTURES;
        (number != Skin::TEXTURES).then_some(number)
    }

    /// How the texture repeats.
    fn period(self) -> Period {
        Period::of_code(self.0 >> PERIOD)
    }

    fn budget(self) -> Budget {
        match self.0 >> 14 {
            0 => Quality::Fast,
            1 => Quality::Balanced,
            _ => Quality::Exact,
        }
        .budget()
    }
}

/// Where the period lies in the name of a texture.
const PERIOD: u32 = 12;

/// The skin with the period of its texture beside its number.
fn known<'a>(skin: Skin<'a>, period: impl FnOnce(u16) -> Period) -> Skin<'a> {
    let texture = match skin.texture {
        number if number < Skin::TEXTURES => number | period(number).code() << PERIOD,
        _ => Skin::TEXTURES,
    };
    Skin { texture, ..skin }
}

impl Default for FaceTexture {
    fn default() -> Self {
        Self::NONE
    }
}

/// The shading `S`, multiplied by a texture: the whole texture everywhere, or with
/// [`LevelEnds`] for `D` in levels of detail.
#[derive(Clone, Copy, Debug)]
pub struct Textured<S, D = ()>(PhantomData<(S, D)>);

/// A vertex of a textured mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexturedVertex<V> {
    colour: V,
    place: [i32; 2],
}

/// A face of a textured mesh.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct TexturedFace<F> {
    colour: F,
    texture: FaceTexture,
}

impl<V: Empty> Empty for TexturedVertex<V> {
    const EMPTY: Self = Self {
        colour: V::EMPTY,
        place: [0; 2],
    };
}

impl<F: Empty> Empty for TexturedFace<F> {
    const EMPTY: Self = Self {
        colour: F::EMPTY,
        texture: FaceTexture(0),
    };
}

/// What an object is coloured by, and its places on a texture.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexturedLevels<L, D = ()> {
    /// The levels of its shading.
    pub colour: L,
    /// Where on which texture.
    pub planes: TexturePlanes,
    /// In which detail.
    pub detail: D,
}

/// Texture places of an object, as planes.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct TexturePlanes {
    texture: FaceTexture,
    /// u and v are linear on the screen: then they are the first two planes.
    straight: bool,
    planes: [Plane; 3],
}

/// Where a span is on a texture, at its first pixel and its step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SpanPlace {
    /// Linear, modulo 8192 texels.
    Straight(Uv, Uv),
    /// In perspective.
    Perspective(Homogeneous, Homogeneous, Budget),
}

impl TexturePlanes {
    /// No texture.
    pub const NONE: Self = Self {
        texture: FaceTexture::NONE,
        straight: true,
        planes: [Plane::ZERO; 3],
    };

    /// Which texture, and where on it the centre of pixel (`column`, `line`) of guard space lies
    /// and the way to the next column.
    #[inline]
    #[must_use]
    pub fn at(&self, column: i32, line: i32) -> Option<(u16, SpanPlace)> {
        let texture = self.texture.texture()?;
        let [a, b, c] = self.planes.map(|p| p.at(column, line));
        let [da, db, dc] = self.planes.map(|p| p.dx);
        let place = if self.straight {
            SpanPlace::Straight(Uv { u: a, v: b }, Uv { u: da, v: db })
        } else {
            let of = |q, s, t| Homogeneous { q, s, t };
            SpanPlace::Perspective(of(a, b, c), of(da, db, dc), self.texture.budget())
        };
        Some((texture, place))
    }

    /// From a triangle's corners and its doubled area in units of 1/64 pixel; `None` where `plane` cannot have it, or it is not straight and
    /// has to be.
    #[inline]
    fn new<V: Copy, D: Detail>(
        texture: FaceTexture,
        corners: [TexturedVertex<V>; 3],
        depths: [u32; 3],
        (only_straight, area): (bool, u64),
        plane: impl Fn([i32; 3]) -> Option<Plane>,
    ) -> Option<(Self, D)> {
        let Some(places) = common(texture, corners, depths) else {
            return Some((Self::NONE, D::FULL));
        };
        let straight = places.straight(texture.budget());
        let planes = if straight {
            // -4096 to 4095 texels, as triangles are that are straight: 32 bits.
            let uv = places.places().map(|(u, v)| (wide(u), wide(v)));
            [
                plane(uv.map(|p| p.0))?,
                plane(uv.map(|p| p.1))?,
                Plane::ZERO,
            ]
        } else if only_straight {
            return None;
        } else {
            [
                plane(places.at.map(|at| at.q))?,
                plane(places.at.map(|at| at.s))?,
                plane(places.at.map(|at| at.t))?,
            ]
        };
        let planes = Self {
            texture,
            straight,
            planes,
        };
        Some((planes, D::new(&places, straight, area)))
    }
}

/// A place with 8 fraction bits within 4096 texels with [`FRACTION`] of them.
const fn wide(place: i32) -> i32 {
    place << (FRACTION - 8)
}

/// The corners of a textured triangle with one exponent.
fn common<V: Copy>(
    texture: FaceTexture,
    corners: [TexturedVertex<V>; 3],
    depths: [u32; 3],
) -> Option<Corners> {
    texture.texture()?;
    let corner = |i: usize| Corner {
        depth: depths[i],
        u: corners[i].place[0],
        v: corners[i].place[1],
    };
    Corners::new([corner(0), corner(1), corner(2)], texture.period())
}

impl<S: Shading, D: Detail> Shading for Textured<S, D> {
    type Vertex = TexturedVertex<S::Vertex>;
    type Face = TexturedFace<S::Face>;
    type Levels = TexturedLevels<S::Levels, D>;
    const NO_LEVELS: Self::Levels = TexturedLevels {
        colour: S::NO_LEVELS,
        planes: TexturePlanes::NONE,
        detail: D::FULL,
    };
    const PER_FACE: bool = S::PER_FACE;

    fn vertex(colour: Colour) -> Self::Vertex {
        TexturedVertex {
            colour: S::vertex(colour),
            place: [0; 2],
        }
    }

    fn face(colour: Colour) -> Self::Face {
        TexturedFace {
            colour: S::face(colour),
            texture: FaceTexture::NONE,
        }
    }

    fn lerp(a: Self::Vertex, b: Self::Vertex, t: i64, space: i64) -> Self::Vertex {
        let mix = |i: usize| {
            let (a, b) = (i64::from(a.place[i]), i64::from(b.place[i]));
            // 33 bits and 31 of t.
            (a + (((b - a) * space + (1 << 29)) >> 30)) as i32
        };
        TexturedVertex {
            colour: S::lerp(a.colour, b.colour, t, space),
            place: [mix(0), mix(1)],
        }
    }

    type Skin<'a> = Skin<'a>;
    const SKINNED: bool = true;

    fn fits(skin: &Skin<'_>, vertices: usize) -> bool {
        skin.places.is_empty() || skin.places.len() == vertices
    }

    fn known<'a>(skin: Self::Skin<'a>, period: impl FnOnce(u16) -> Period) -> Self::Skin<'a> {
        known(skin, period)
    }

    fn may_be_plain(skin: &Skin<'_>) -> bool {
        let face = FaceTexture::new(skin);
        face.texture().is_some() && corners::may_be_refused(skin.places, face.period())
    }

    fn is_plain(skin: &Skin<'_>, corners: [&Self::Vertex; 3]) -> bool {
        let face = FaceTexture::new(skin);
        let places = corners.map(|c| c.place);
        face.texture().is_some() && corners::reduced(places, face.period()).is_none()
    }

    #[inline]
    fn dress(vertex: &mut Self::Vertex, skin: &Skin<'_>, index: usize) {
        vertex.place = skin.places.get(index).copied().unwrap_or_default();
    }

    #[inline]
    fn dress_face(face: &mut Self::Face, skin: &Skin<'_>) {
        face.texture = FaceTexture::new(skin);
    }

    #[inline]
    fn set_up_small(
        area: &SmallArea,
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<Self::Levels> {
        let colours = corners.map(|c| c.colour);
        let plane = |values| area.wide_plane(values);
        let how = (true, area.doubled());
        let (planes, detail) = TexturePlanes::new(face.texture, corners, depths, how, plane)?;
        Some(TexturedLevels {
            planes,
            detail,
            colour: S::set_up_small(area, colours, depths, face.colour, scale)?,
        })
    }

    fn set_up(
        area: &InverseArea,
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<Self::Levels> {
        let colours = corners.map(|c| c.colour);
        let plane = |values| area.plane(values);
        let how = (false, area.doubled());
        let (planes, detail) = TexturePlanes::new(face.texture, corners, depths, how, plane)?;
        Some(TexturedLevels {
            planes,
            detail,
            colour: S::set_up(area, colours, depths, face.colour, scale)?,
        })
    }

    fn weighted(
        w: [i64; 2],
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Self::Levels {
        let colours = corners.map(|c| c.colour);
        let planes = common(face.texture, corners, depths).map_or(TexturePlanes::NONE, |places| {
            let mean = |get: fn(&Homogeneous) -> i32| {
                let v = places.at.each_ref().map(|at| i64::from(get(at)));
                let at = v[0] + (((v[1] - v[0]) * w[0] + (v[2] - v[0]) * w[1]) >> 30);
                Plane {
                    at: at as i32,
                    ..Plane::ZERO
                }
            };
            TexturePlanes {
                texture: face.texture,
                straight: false,
                planes: [mean(|at| at.q), mean(|at| at.s), mean(|at| at.t)],
            }
        });
        TexturedLevels {
            colour: S::weighted(w, colours, depths, face.colour, scale),
            planes,
            detail: D::FULL,
        }
    }
}
