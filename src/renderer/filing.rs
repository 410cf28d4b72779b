//! Where objects go in pass one: into the arena, under the line on which they are first seen (K1).
//!
//! What is cut to a window is filed once for each part of the picture that is kept (H15).

use crate::active::Buckets;
use crate::arena::Arena;
use crate::geometry::{Mark, Shading};
use crate::link::Link;
use crate::pipeline::{MarkOf, ObjectOf, Pipeline, VertexOf};

/// Where objects go.
pub(super) struct Filing<'a, 'm, P: Pipeline> {
    pub(super) objects: &'a mut Arena<'m, ObjectOf<P>>,
    pub(super) buckets: &'a mut Buckets<'m>,
    /// What is kept of the picture.
    pub(super) parts: <MarkOf<P> as Mark>::Parts,
    pub(super) priority: u8,
    /// Triangles of which nothing was.
    pub(super) outside: &'a mut u32,
}

impl<P: Pipeline> Filing<'_, '_, P> {
    /// Keeps an object under the line of guard space on which it is first seen, in each part that is
    /// kept of the picture: how many objects that makes; `None`: there is no room.
    #[inline(always)]
    pub(super) fn file(
        &mut self,
        mut object: ObjectOf<P>,
        first: i32,
        vertices: &[VertexOf<P>],
    ) -> Option<u32> {
        if MarkOf::<P>::CUTS {
            return self.file_parts(object, vertices);
        }
        if MarkOf::<P>::RANKS {
            P::Shading::set_mark(&mut object.face, Mark::new(None, self.priority));
        }
        self.keep(object, first)
    }

    /// The same for each part.
    fn file_parts(&mut self, object: ObjectOf<P>, vertices: &[VertexOf<P>]) -> Option<u32> {
        let corners = object.corners(vertices)?;
        let mut count = 0;
        for index in 0..4 {
            let Some(part) = MarkOf::<P>::part(&self.parts, index) else {
                break;
            };
            if let Some(first) = part.first_line(corners) {
                let mut object = object;
                P::Shading::set_mark(&mut object.face, Mark::new(Some(part), self.priority));
                count += self.keep(object, first)?;
            }
        }
        *self.outside += u32::from(count == 0);
        Some(count)
    }

    /// Keeps one.
    #[inline(always)]
    fn keep(&mut self, mut object: ObjectOf<P>, first: i32) -> Option<u32> {
        if self.objects.free_below(usize::from(Link::CACHED)) == 0 {
            return None;
        }
        let chain = self.buckets.file(self.objects.len() as u16, first)?;
        object.chain(chain);
        self.objects.push(object).map(|_| 1)
    }
}
