//! What a surface has beside its colours: the window that it is cut to (H15), and its priority (P1).
//!
//! [`Marked`] is a shading around another one: a pipeline without marks has no bytes and no code for
//! them. A scene sets them for what is drawn next.
//!
//! What is cut to the outside of a window is filed as up to four objects, one for each rectangle that
//! is left of the picture. So every object has one rectangle, and one span a line, whatever draws it;
//! what has nothing in a rectangle is not filed there, and lines above or below cost nothing.

use super::colour::{Colour, Scale};
use super::finish::Finish;
use super::object::SceneVertex;
use super::shading::{Empty, Shading};
use super::texturing;
use super::transform::Affine;
use crate::list::Window;
use crate::num::{InverseArea, SmallArea, first_at};
use core::marker::PhantomData;

/// Which pixels of the picture a surface keeps (H15).
///
/// A window may reach beyond the picture, or be empty.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub enum Clip {
    /// All.
    #[default]
    Picture,
    /// Those inside of a window.
    Inside(Window),
    /// Those outside of it.
    Outside(Window),
}

/// A rectangle of guard space, its ends not inside; empty where an end is not above a start.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Part {
    pub(crate) left: i32,
    pub(crate) top: i32,
    pub(crate) right: i32,
    pub(crate) bottom: i32,
}

impl Part {
    /// The first line of a triangle in this rectangle, if its box has pixels there.
    pub(crate) fn first_line<A>(&self, [a, b, c]: [&SceneVertex<A>; 3]) -> Option<i32> {
        let range = |[a, b, c]: [u16; 3], start: i32, end: i32| {
            let from = first_at(a.min(b).min(c)).max(start);
            let to = first_at(a.max(b).max(c)).min(end);
            (from < to).then_some(from)
        };
        range([a.x, b.x, c.x], self.left, self.right)?;
        range([a.y, b.y, c.y], self.top, self.bottom)
    }

    /// Where both are.
    fn and(self, other: Self) -> Self {
        Self {
            left: self.left.max(other.left),
            top: self.top.max(other.top),
            right: self.right.min(other.right),
            bottom: self.bottom.min(other.bottom),
        }
    }

    fn is_empty(&self) -> bool {
        self.left >= self.right || self.top >= self.bottom
    }
}

impl Clip {
    /// What is kept of `picture`, in rectangles that do not overlap; some may be empty. Windows are
    /// counted from `origin`.
    pub(crate) fn parts(self, picture: Part, origin: (i32, i32)) -> [Part; 4] {
        let placed = |w: Window| Part {
            left: origin.0 + i32::from(w.left),
            top: origin.1 + i32::from(w.top),
            right: origin.0 + i32::from(w.right),
            bottom: origin.1 + i32::from(w.bottom),
        };
        let none = Part::default();
        match self {
            Self::Picture => [picture, none, none, none],
            Self::Inside(w) => [picture.and(placed(w)), none, none, none],
            Self::Outside(w) => {
                let hole = picture.and(placed(w));
                if hole.is_empty() {
                    return [picture, none, none, none];
                }
                let row = Part {
                    top: hole.top,
                    bottom: hole.bottom,
                    ..picture
                };
                [
                    Part {
                        bottom: hole.top,
                        ..picture
                    },
                    Part {
                        right: hole.left,
                        ..row
                    },
                    Part {
                        left: hole.right,
                        ..row
                    },
                    Part {
                        top: hole.bottom,
                        ..picture
                    },
                ]
            }
        }
    }
}

/// What an object carries of its surface's marks: `()`, [`Kept`], [`Priority`], or several.
pub trait Mark: Copy + Default + Send + Sync + 'static {
    /// None.
    const NONE: Self;
    /// Whether objects are cut to a part of the picture.
    const CUTS: bool = false;
    /// Whether objects have priorities.
    const RANKS: bool = false;

    /// The rectangles that are kept, where objects are cut.
    type Parts: Copy;

    /// Those of a clip.
    fn parts(clip: Clip, picture: Part, origin: (i32, i32)) -> Self::Parts;

    /// One of them, 0 to 3.
    #[inline(always)]
    fn part(_: &Self::Parts, _index: usize) -> Option<&Part> {
        None
    }

    /// The mark of an object in a rectangle, with a priority.
    fn new(part: Option<&Part>, priority: u8) -> Self;

    /// What is kept.
    #[inline(always)]
    fn kept(&self) -> Kept {
        Kept::NONE
    }

    /// The priority.
    #[inline(always)]
    fn priority(&self) -> u8 {
        0
    }
}

impl Mark for () {
    const NONE: Self = ();
    type Parts = ();

    #[inline(always)]
    fn parts(_: Clip, _: Part, _: (i32, i32)) {}

    #[inline(always)]
    fn new(_: Option<&Part>, _: u8) {}
}

/// The part of the picture that an object keeps: columns of guard space, and the line below; what is
/// above it is not filed.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Kept {
    pub(crate) left: u16,
    pub(crate) right: u16,
    pub(crate) bottom: u16,
}

impl Mark for Kept {
    const NONE: Self = Self {
        left: 0,
        right: 0,
        bottom: 0,
    };
    const CUTS: bool = true;
    type Parts = [Part; 4];

    fn parts(clip: Clip, picture: Part, origin: (i32, i32)) -> [Part; 4] {
        clip.parts(picture, origin)
    }

    #[inline]
    fn part(parts: &[Part; 4], index: usize) -> Option<&Part> {
        parts.get(index)
    }

    #[inline]
    fn new(part: Option<&Part>, _: u8) -> Self {
        // Guard space has 8192 columns and lines.
        part.map_or(Self::NONE, |p| Self {
            left: p.left as u16,
            right: p.right as u16,
            bottom: p.bottom as u16,
        })
    }

    #[inline(always)]
    fn kept(&self) -> Self {
        *self
    }
}

/// The priority of a surface: the higher one is seen, and of equal ones what was drawn last (P1).
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct Priority(pub u8);

impl Mark for Priority {
    const NONE: Self = Self(0);
    const RANKS: bool = true;
    type Parts = ();

    #[inline(always)]
    fn parts(_: Clip, _: Part, _: (i32, i32)) {}

    #[inline(always)]
    fn new(_: Option<&Part>, priority: u8) -> Self {
        Self(priority)
    }

    #[inline(always)]
    fn priority(&self) -> u8 {
        self.0
    }
}

impl<A: Mark, B: Mark> Mark for (A, B) {
    const NONE: Self = (A::NONE, B::NONE);
    const CUTS: bool = A::CUTS || B::CUTS;
    const RANKS: bool = A::RANKS || B::RANKS;
    type Parts = (A::Parts, B::Parts);

    #[inline(always)]
    fn parts(clip: Clip, picture: Part, origin: (i32, i32)) -> Self::Parts {
        (
            A::parts(clip, picture, origin),
            B::parts(clip, picture, origin),
        )
    }

    #[inline(always)]
    fn part(parts: &Self::Parts, index: usize) -> Option<&Part> {
        if A::CUTS {
            A::part(&parts.0, index)
        } else {
            B::part(&parts.1, index)
        }
    }

    #[inline(always)]
    fn new(part: Option<&Part>, priority: u8) -> Self {
        (A::new(part, priority), B::new(part, priority))
    }

    #[inline(always)]
    fn kept(&self) -> Kept {
        if A::CUTS {
            self.0.kept()
        } else {
            self.1.kept()
        }
    }

    #[inline(always)]
    fn priority(&self) -> u8 {
        if A::RANKS {
            self.0.priority()
        } else {
            self.1.priority()
        }
    }
}

/// The shading `S`, of surfaces with the mark `M`.
#[derive(Clone, Copy, Debug)]
pub struct Marked<S, M>(PhantomData<(S, M)>);

/// A face of such a surface.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct MarkedFace<F, M> {
    inner: F,
    mark: M,
}

impl<F: Empty, M: Mark> Empty for MarkedFace<F, M> {
    const EMPTY: Self = Self {
        inner: F::EMPTY,
        mark: M::NONE,
    };
}

impl<S: Shading, M: Mark> Shading for Marked<S, M> {
    type Vertex = S::Vertex;
    type Face = MarkedFace<S::Face, M>;
    type Levels = S::Levels;
    const NO_LEVELS: S::Levels = S::NO_LEVELS;
    const PER_FACE: bool = S::PER_FACE;

    #[inline]
    fn vertex(colour: Colour) -> S::Vertex {
        S::vertex(colour)
    }

    fn face(colour: Colour) -> Self::Face {
        MarkedFace {
            inner: S::face(colour),
            mark: M::NONE,
        }
    }

    fn lerp(a: S::Vertex, b: S::Vertex, t: i64, space: i64) -> S::Vertex {
        S::lerp(a, b, t, space)
    }

    type Skin<'a> = S::Skin<'a>;
    const SKINNED: bool = S::SKINNED;
    const TEXTURED: bool = S::TEXTURED;

    fn fits(skin: &S::Skin<'_>, vertices: usize) -> bool {
        S::fits(skin, vertices)
    }

    fn known<'a>(skin: S::Skin<'a>, period: impl FnOnce(u16) -> texturing::Period) -> S::Skin<'a> {
        S::known(skin, period)
    }

    fn may_be_plain(skin: &S::Skin<'_>) -> bool {
        S::may_be_plain(skin)
    }

    fn is_plain(skin: &S::Skin<'_>, corners: [&Self::Vertex; 3]) -> bool {
        S::is_plain(skin, corners)
    }

    #[inline]
    fn dress(vertex: &mut S::Vertex, skin: &S::Skin<'_>, index: usize) {
        S::dress(vertex, skin, index);
    }

    #[inline]
    fn dress_face(face: &mut Self::Face, skin: &S::Skin<'_>) {
        S::dress_face(&mut face.inner, skin);
    }

    type Turn = S::Turn;
    const NORMALS: bool = S::NORMALS;

    fn turn(model: &Affine, view: &Affine) -> S::Turn {
        S::turn(model, view)
    }

    #[inline]
    fn set_normal(vertex: &mut S::Vertex, turn: &S::Turn, normal: [i16; 3]) {
        S::set_normal(vertex, turn, normal);
    }

    const COMPOSITED: bool = S::COMPOSITED;

    fn finished<'a>(skin: S::Skin<'a>, finish: Finish) -> S::Skin<'a> {
        S::finished(skin, finish)
    }

    #[inline]
    fn finish(face: &Self::Face) -> Option<&Finish> {
        S::finish(&face.inner)
    }

    type Mark = (S::Mark, M);

    #[inline]
    fn mark(face: &Self::Face) -> Self::Mark {
        (S::mark(&face.inner), face.mark)
    }

    #[inline]
    fn set_mark(face: &mut Self::Face, (inner, mark): Self::Mark) {
        S::set_mark(&mut face.inner, inner);
        face.mark = mark;
    }

    #[inline(always)]
    fn set_up_small(
        area: &SmallArea,
        corners: [S::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<S::Levels> {
        S::set_up_small(area, corners, depths, face.inner, scale)
    }

    #[inline]
    fn set_up(
        area: &InverseArea,
        corners: [S::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> Option<S::Levels> {
        S::set_up(area, corners, depths, face.inner, scale)
    }

    fn weighted(
        w: [i64; 2],
        corners: [S::Vertex; 3],
        depths: [u32; 3],
        face: Self::Face,
        scale: &Scale,
    ) -> S::Levels {
        S::weighted(w, corners, depths, face.inner, scale)
    }
}

// A flat triangle with both marks is 20 bytes in the slow arena, one with vertex colours 16.
const _: () = assert!(size_of::<MarkedFace<(), Kept>>() == 6);
const _: () = assert!(size_of::<MarkedFace<MarkedFace<(), Kept>, Priority>>() == 8);

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;

    #[test]
    fn parts_hold_each_pixel_that_is_kept_once() {
        let mut rng = Rng(3);
        for _ in 0..2_000 {
            let mut side = || rng.below(14) as u16;
            let (width, height) = (1 + side(), 1 + side());
            let window = Window {
                left: side(),
                top: side(),
                right: side(),
                bottom: side(),
            };
            let origin = (4090, 4087);
            // Lines of a band.
            let (top, bottom) = (side().min(height), side().min(height));
            let picture = Part {
                left: origin.0,
                top: origin.1 + i32::from(top),
                right: origin.0 + i32::from(width),
                bottom: origin.1 + i32::from(bottom),
            };
            for clip in [Clip::Picture, Clip::Inside(window), Clip::Outside(window)] {
                let parts = clip.parts(picture, origin);
                for y in 0..height {
                    for x in 0..width {
                        let inside = (window.left..window.right).contains(&x)
                            && (window.top..window.bottom).contains(&y);
                        let kept = match clip {
                            Clip::Picture => true,
                            Clip::Inside(_) => inside,
                            Clip::Outside(_) => !inside,
                        } && (top..bottom).contains(&y);
                        let (x, y) = (origin.0 + i32::from(x), origin.1 + i32::from(y));
                        let holds = |p: &&Part| {
                            (p.left..p.right).contains(&x) && (p.top..p.bottom).contains(&y)
                        };
                        let count = parts.iter().filter(holds).count();
                        assert_eq!(count, usize::from(kept), "{clip:?}");
                    }
                }
            }
        }
    }

    #[test]
    fn marks_are_kept_together() {
        let part = Part {
            left: 1,
            top: 2,
            right: 3,
            bottom: 4,
        };
        type Both = ((), (Kept, Priority));
        let mark = Both::new(Some(&part), 9);
        let kept = Kept {
            left: 1,
            right: 3,
            bottom: 4,
        };
        assert_eq!((mark.kept(), mark.priority()), (kept, 9));
        const { assert!(Both::CUTS && Both::RANKS) };
        let parts = <(Priority, Kept)>::parts(Clip::Picture, part, (0, 0));
        assert_eq!(<(Priority, Kept)>::part(&parts, 0), Some(&part));
        assert_eq!(Priority::part(&(), 0), None);
    }
}
