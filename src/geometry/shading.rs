//! What a shading keeps at vertices, at faces and on the way along a line (H16).
//!
//! A shading that needs nothing somewhere has `()` there: no bytes in the records, no code.

use super::colour::{Colour, Scale};
use super::finish::Finish;
use crate::num::{InverseArea, Plane, SmallArea};

/// A record that fresh memory can be filled with at compile time, so that arenas can be statics.
///
/// Nothing is drawn of it. Where it can be it is all zeros, so that such a static takes no flash.
pub trait Empty {
    /// The record.
    const EMPTY: Self;
}

impl Empty for () {
    const EMPTY: Self = ();
}

/// Which colours an object carries, from vertex to plane.
pub trait Shading {
    /// Kept at each vertex of the slow arena.
    type Vertex: Copy + Send + Sync + Default + Empty + 'static;
    /// Kept at each object of the slow arena.
    type Face: Copy + Send + Sync + Default + Empty + 'static;
    /// Set up when an object becomes active.
    type Levels: Copy + Send + Sync + 'static;
    /// What a slot holds before anything is set up.
    const NO_LEVELS: Self::Levels;
    /// Whether a face is lit as a whole, by its own normal, with its first corner's colour.
    const PER_FACE: bool;

    /// What to keep of a vertex's lit colour.
    fn vertex(colour: Colour) -> Self::Vertex;

    /// What to keep of a face's lit colour.
    fn face(colour: Colour) -> Self::Face;

    /// The vertex's value on the way from `a` to `b`, at `t` (0 to 2^30) for what is linear on the
    /// screen, and at `space` for what is linear on the surface.
    fn lerp(a: Self::Vertex, b: Self::Vertex, t: i64, space: i64) -> Self::Vertex;

    /// What a mesh brings beside its colours: `()`, or a [`Skin`](super::texturing::Skin).
    type Skin<'a>: Copy + Default + From<super::texturing::Skin<'a>>;
    /// Whether it brings anything.
    const SKINNED: bool = false;
    /// Whether that can be a texture.
    const TEXTURED: bool = Self::SKINNED;

    /// Whether the skin fits a mesh of so many vertices.
    fn fits(_: &Self::Skin<'_>, _vertices: usize) -> bool {
        true
    }

    /// The skin with what is known of its texture, of which `period` says how it repeats.
    fn known<'a>(
        skin: Self::Skin<'a>,
        _: impl FnOnce(u16) -> super::texturing::Period,
    ) -> Self::Skin<'a> {
        skin
    }

    /// Whether some triangle of a mesh with this skin, which is known, may have to be drawn without
    /// its texture, as it is too wide for places on it.
    fn may_be_plain(_: &Self::Skin<'_>) -> bool {
        false
    }

    /// Whether a triangle has to be.
    fn is_plain(_: &Self::Skin<'_>, _corners: [&Self::Vertex; 3]) -> bool {
        false
    }

    /// Gives vertex `index` of a mesh its part of the skin.
    fn dress(_: &mut Self::Vertex, _: &Self::Skin<'_>, _index: usize) {}

    /// Gives a face of a mesh its part of the skin.
    fn dress_face(_: &mut Self::Face, _: &Self::Skin<'_>) {}

    /// What a face does to the pixels that are there, in shadings that say so.
    fn finish(_: &Self::Face) -> Option<&Finish> {
        None
    }

    /// Sets up an object of at most 64 x 64 pixels; `None` when it is too thin.
    fn set_up_small(
        area: &SmallArea,
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<Self::Levels>;

    /// Sets up an object of any size; `None` when it is too thin.
    fn set_up(
        area: &InverseArea,
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<Self::Levels>;

    /// The levels of one pixel from its weights at corners 1 and 2 (0 to 2^30 each, their sum
    /// too), for triangles that are too thin for planes.
    fn weighted(
        weights: [i64; 2],
        corners: [Self::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Self::Levels;
}

/// One colour a face.
#[derive(Clone, Copy, Debug)]
pub struct Flat;

/// The levels of a face, in whole steps of the output.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct FlatLevels(pub [u8; 3]);

/// Colours at the vertices, linear between them on the screen.
#[derive(Clone, Copy, Debug)]
pub struct Gouraud;

/// Colour as planes, in steps of the output plus one half.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum GouraudLevels {
    /// Of a triangle of at most 64 x 64 pixels, in two words.
    ///
    /// A field of `n` bits has 5 more fraction bits here (blue 6): 16 a channel.
    Small {
        /// Red in the upper and blue in the lower half.
        red_blue: Plane,
        /// Green in the upper half.
        green: Plane,
        /// The step to the next column in the fields of [`Colour`].
        step: i32,
    },
    /// Red, green and blue in 16.16 steps.
    Large([Plane; 3]),
}

impl Shading for Flat {
    type Vertex = ();
    type Face = Colour;
    type Levels = FlatLevels;
    const NO_LEVELS: FlatLevels = FlatLevels([0; 3]);
    const PER_FACE: bool = true;

    fn vertex(_: Colour) {}

    fn face(colour: Colour) -> Colour {
        colour
    }

    fn lerp((): (), (): (), _: i64, _: i64) {}

    type Skin<'a> = ();

    #[inline(always)]
    fn set_up_small(
        _: &SmallArea,
        _: [(); 3],
        _: [u32; 3],
        face: Colour,
        scale: &Scale,
    ) -> Option<FlatLevels> {
        Some(FlatLevels(face.steps(scale)))
    }

    fn set_up(
        _: &InverseArea,
        _: [(); 3],
        _: [u32; 3],
        face: Colour,
        scale: &Scale,
    ) -> Option<FlatLevels> {
        Some(FlatLevels(face.steps(scale)))
    }

    fn weighted(_: [i64; 2], _: [(); 3], _: [u32; 3], face: Colour, scale: &Scale) -> FlatLevels {
        FlatLevels(face.steps(scale))
    }
}

/// 16.16 steps of a colour's channels.
fn wide_steps(colour: Colour, scale: &Scale) -> [i32; 3] {
    let (fields, fraction) = (colour.fields(), scale.fraction());
    [0, 1, 2].map(|i| (fields[i] << (16 - fraction[i])) as i32)
}

impl Shading for Gouraud {
    type Vertex = Colour;
    type Face = ();
    type Levels = GouraudLevels;
    const NO_LEVELS: GouraudLevels = GouraudLevels::Large([Plane::ZERO; 3]);
    const PER_FACE: bool = false;

    #[inline]
    fn vertex(colour: Colour) -> Colour {
        colour
    }

    fn face(_: Colour) {}

    fn lerp(a: Colour, b: Colour, t: i64, _: i64) -> Colour {
        a.lerp(b, t)
    }

    type Skin<'a> = ();

    #[inline(always)]
    fn set_up_small(
        area: &SmallArea,
        corners: [Colour; 3],
        _: [u32; 3],
        (): (),
        _: &Scale,
    ) -> Option<GouraudLevels> {
        /// From the fields to 16 bits a channel.
        const UP: [u32; 3] = [5, 5, 6];
        /// A rise of 2^18 bounds the error by 2^5 of 2^16, an eighth of a step of 8 bits.
        const RISE: i32 = 18;
        let f = corners.map(Colour::fields);
        let value = |k: usize, i: usize| (f[k][i] << UP[i]) as i32;
        let rise = |i: usize| area.gradient(value(1, i) - value(0, i), value(2, i) - value(0, i));
        let (r, g, b) = (rise(0), rise(1), rise(2));
        if area.rise_bits([r, g, b], 0) > RISE {
            return None;
        }
        let (rs, gs, bs) = (area.step(r), area.step(g), area.step(b));
        let at = |i: usize, g| value(0, i) + area.offset(g);
        let pair = |high: i32, low: i32| (high << 16).wrapping_add(low);
        // Fields of the step, rounded: an error of half a unit of a field a column.
        let field = |step: i32, i: usize| (step + (1 << UP[i] >> 1)) >> UP[i];
        Some(GouraudLevels::Small {
            red_blue: area.plane_of_steps(
                pair(at(0, r), at(2, b)),
                (pair(rs.0, bs.0), pair(rs.1, bs.1)),
            ),
            green: area.plane_of_steps(at(1, g) << 16, (gs.0 << 16, gs.1 << 16)),
            step: (field(rs.0, 0) << 21)
                .wrapping_add(field(bs.0, 2) << 11)
                .wrapping_add(field(gs.0, 1)),
        })
    }

    #[inline(never)]
    fn set_up(
        area: &InverseArea,
        corners: [Colour; 3],
        _: [u32; 3],
        (): (),
        scale: &Scale,
    ) -> Option<GouraudLevels> {
        let c = corners.map(|c| wide_steps(c, scale));
        let plane = |i: usize| area.plane([c[0][i], c[1][i], c[2][i]]);
        Some(GouraudLevels::Large([plane(0)?, plane(1)?, plane(2)?]))
    }

    fn weighted(
        w: [i64; 2],
        corners: [Colour; 3],
        _: [u32; 3],
        (): (),
        scale: &Scale,
    ) -> GouraudLevels {
        let c = corners.map(|c| wide_steps(c, scale));
        GouraudLevels::Large([0, 1, 2].map(|i| {
            let to = |k: usize| i64::from(c[k][i] - c[0][i]) * w[k - 1];
            Plane {
                at: c[0][i] + ((to(1) + to(2)) >> 30) as i32,
                ..Plane::ZERO
            }
        }))
    }
}
