//! Lines by priority: no depth is kept anywhere, not even of one line (P1).
//!
//! Surfaces that do not cross and are seen from one side alone can have a fixed priority each: with
//! faces from behind culled, it says who is in front. A line is drawn from the lowest priority to the
//! highest, and among equal ones in order of submission. No memory is lent for it: the list is walked,
//! and the lowest [`PILE`] objects beyond those drawn are taken at a time, on the stack.

use super::lines::LinePass;
use super::transparent::{Leave, role};
use crate::active::{ActiveList, Visitor};
use crate::composite::Compositing;
use crate::geometry::{Mark, Role};
use crate::pipeline::{DrawableOf, Pipeline};
use crate::visible::ShadowCount;

/// Most objects that are put in order in one walk.
const PILE: usize = 32;
/// No slot.
const SPILLED: u16 = u16::MAX;

/// An object in its order: priority above its number, and its slot.
type Entry = (u32, u16);

/// The lowest entries above a key, in order.
struct Pile {
    entries: [Entry; PILE],
    count: usize,
    /// Those up to here have been drawn.
    after: Option<u32>,
    /// There are higher ones.
    more: bool,
}

impl Pile {
    #[inline]
    fn add(&mut self, entry: Entry) {
        if self.after.is_some_and(|after| entry.0 <= after) {
            return;
        }
        let mut at = self.count;
        if at == PILE {
            self.more = true;
            at -= 1;
            if self.entries[at].0 < entry.0 {
                return;
            }
        } else {
            self.count += 1;
        }
        while at > 0 && self.entries[at - 1].0 > entry.0 {
            self.entries[at] = self.entries[at - 1];
            at -= 1;
        }
        self.entries[at] = entry;
    }
}

/// A walk of the list that collects.
struct Walk<'w, 'a, 's, P: Pipeline> {
    pass: &'w mut LinePass<'a, 's, P>,
    pile: &'w mut Pile,
}

impl<P: Pipeline> Visitor<DrawableOf<P>> for Walk<'_, '_, '_, P> {
    #[inline]
    fn set_up(&mut self, object: u16, body: &mut DrawableOf<P>) -> bool {
        self.pass.set_up(object, body)
    }

    fn visit(&mut self, object: u16, body: &DrawableOf<P>) {
        self.visit_slot(usize::from(SPILLED), object, body);
    }

    #[inline]
    fn visit_slot(&mut self, slot: usize, object: u16, body: &DrawableOf<P>) {
        let key = u32::from(body.mark.priority()) << 16 | u32::from(object);
        self.pile.add((key, slot.min(usize::from(SPILLED)) as u16));
    }
}

impl<P: Pipeline> LinePass<'_, '_, P> {
    /// Draws all that is active by priority. `next` is the line that will come after, `spare` takes
    /// what has no slot.
    #[inline(never)]
    pub(super) fn draw_ranked(
        &mut self,
        list: &mut ActiveList<'_, DrawableOf<P>>,
        next: i32,
        spare: &mut DrawableOf<P>,
    ) {
        self.begin_together();
        let line = self.line;
        let mut pile = Pile {
            entries: [(0, 0); PILE],
            count: 0,
            after: None,
            more: true,
        };
        while pile.more {
            (pile.count, pile.more) = (0, false);
            let mut walk = Walk {
                pass: self,
                pile: &mut pile,
            };
            list.visit_all(line, spare, &mut walk);
            for &(key, slot) in &pile.entries[..pile.count] {
                let object = key as u16;
                if let Some(slot) = list.slots().get(usize::from(slot)) {
                    self.draw_next(object, slot.body());
                } else if self.brush.scene.set_up(object, (line, false), spare) {
                    list.counts.misses += 1;
                    self.draw_next(object, spare);
                }
            }
            pile.after = pile.count.checked_sub(1).map(|last| pile.entries[last].0);
        }
        if list.has_spilled() {
            list.visit_all(next, spare, &mut Leave(self));
        }
    }

    /// Draws an object over all that is there, as its finish says.
    fn draw_next(&mut self, object: u16, body: &DrawableOf<P>) {
        if P::Compositing::BLENDS {
            match role(self.brush.scene, object, body) {
                Role::Plain => {}
                // There is no depth that shadows could be counted against.
                Role::Shadowed(_) | Role::Volume(_) => return,
                _ => {
                    if let Some(span) = self.columns(body) {
                        self.draw_ruled(object, body, span, ShadowCount::Any);
                    }
                    return;
                }
            }
        }
        self.visit(object, body);
    }
}
