//! Where objects go in pass one: into the arena, under the line on which they are first seen (K1).

use crate::active::Buckets;
use crate::arena::Arena;
use crate::link::Link;
use crate::pipeline::{ObjectOf, Pipeline};

/// Where objects go.
pub(super) struct Filing<'a, 'm, P: Pipeline> {
    pub(super) objects: &'a mut Arena<'m, ObjectOf<P>>,
    pub(super) buckets: &'a mut Buckets<'m>,
}

impl<P: Pipeline> Filing<'_, '_, P> {
    /// Keeps an object under the line of guard space on which it is first seen; `None`: there is no room.
    #[inline(always)]
    pub(super) fn file(&mut self, mut object: ObjectOf<P>, first: i32) -> Option<()> {
        if self.objects.free_below(usize::from(Link::CACHED)) == 0 {
            return None;
        }
        let chain = self.buckets.file(self.objects.len() as u16, first)?;
        object.chain(chain);
        self.objects.push(object).map(|_| ())
    }
}
