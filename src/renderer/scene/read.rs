//! What is read of a scene once it is assembled: by the lines, and by who looks at it.

use super::super::spans::scale;
use super::Scene;
use crate::geometry::{Filed, Screen};
use crate::link::Link;
use crate::pipeline::{DrawableOf, FiledOf, ObjectOf, Pipeline, VertexOf};
use crate::stats::PassOne;
use core::ops::Range;

impl<P: Pipeline> Scene<'_, P> {
    /// What pass one has done since the scene was begun.
    #[must_use]
    pub fn pass_one(&self) -> PassOne {
        self.pass_one
    }

    /// The size of the picture.
    #[must_use]
    pub fn screen(&self) -> Screen {
        self.screen
    }

    /// The lines of the picture that were begun.
    #[must_use]
    pub fn lines(&self) -> Range<u16> {
        self.lines.clone()
    }

    /// The triangle that was filed as number `index`, from 0 on in order of submission; `None`
    /// beyond the last.
    #[must_use]
    pub fn filed(&self, index: u16) -> Option<FiledOf<P>> {
        let object = self.object(index)?;
        let corners = object.corners(self.vertices())?;
        Some(Filed {
            places: corners.map(|corner| (corner.x, corner.y)),
            depths: corners.map(|corner| corner.depth),
            attributes: corners.map(|corner| corner.attribute),
            face: object.face,
        })
    }

    /// Bytes of the slow arena in use: vertices, objects and buckets.
    #[must_use]
    pub fn bytes(&self) -> usize {
        self.store.vertices.len() * size_of::<VertexOf<P>>()
            + self.objects.len() * size_of::<ObjectOf<P>>()
            + self.buckets.lines().len() * size_of::<Link>()
    }

    /// What the lines of a renderer's list must agree on: where the objects lie and how often
    /// they have changed.
    pub(crate) fn content(&self) -> (usize, u32) {
        (self.objects.as_slice().as_ptr().addr(), self.generation)
    }

    /// The first line that was begun, in guard space.
    #[inline]
    pub(crate) fn first_line(&self) -> i32 {
        self.screen.top() + i32::from(self.lines.start)
    }

    /// The object first seen on `line` of guard space that was filed last.
    #[inline]
    pub(crate) fn bucket(&self, line: i32) -> Link {
        self.buckets.head(line)
    }

    /// The objects of a bucket from `link` on, latest first.
    #[inline]
    pub(crate) fn chain(&self, mut link: Link) -> impl Iterator<Item = u16> + '_ {
        core::iter::from_fn(move || {
            let index = link.is_some().then(|| link.object())?;
            link = self.object(index)?.next();
            Some(index)
        })
    }

    /// The object at `index`, if there is one.
    #[inline]
    pub(crate) fn object(&self, index: u16) -> Option<&ObjectOf<P>> {
        self.objects.as_slice().get(usize::from(index))
    }

    #[inline]
    pub(crate) fn vertices(&self) -> &[VertexOf<P>] {
        self.store.vertices.as_slice()
    }

    /// Sets up the object at `index` in `out` for `line` of guard space and all below; without
    /// its depth where it may be `shallow`.
    #[inline(always)]
    pub(crate) fn set_up(
        &self,
        index: u16,
        (line, shallow): (i32, bool),
        out: &mut DrawableOf<P>,
    ) -> bool {
        let left = self.screen.left();
        let picture = left..left + i32::from(self.screen.width());
        let how = (line, &picture, shallow);
        self.object(index)
            .is_some_and(|o| o.set_up::<P::Shading>(self.vertices(), scale::<P>(), how, out))
    }

    /// Makes the depth of what was set up without it; whether it was.
    pub(crate) fn deepen(&self, index: u16, out: &mut DrawableOf<P>) -> bool {
        let shallow = out.is_shallow();
        if let Some(object) = self.object(index).filter(|_| shallow) {
            object.deepen(self.vertices(), out);
        }
        shallow
    }
}
