//! The list beside a model of plain vectors, compared whole after every step (C2, C3, C5).
//!
//! The model knows nothing of links: it holds the active objects in a sorted vector, says of each
//! whether it is cached, and counts free slots. After every admission, fetch and walk the chains
//! of the real list are read back and have to be the same, and every slot has to be in one chain.

use super::{ActiveList, Member, Slot, Visitor};
use crate::link::Link;
use crate::num::random::Rng;
use std::collections::BTreeMap;
use std::vec::Vec;
use std::{format, vec};

/// An object of the model and the lines it is on.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
struct Thing {
    object: u16,
    first: i32,
    end: i32,
}

impl Member for Thing {
    fn end(&self) -> i32 {
        self.end
    }
}

const EMPTY: Thing = Thing {
    object: u16::MAX,
    first: 0,
    end: 0,
};

/// Makes things and tells of those that are visited.
struct Tell<M, V> {
    line: i32,
    make: M,
    visit: V,
}

impl<M: FnMut(u16) -> Option<Thing>, V: FnMut(u16, &Thing)> Visitor<Thing> for Tell<M, V> {
    fn set_up(&mut self, object: u16, body: &mut Thing) -> bool {
        match (self.make)(object) {
            Some(thing) => {
                *body = thing;
                thing.end > self.line
            }
            None => false,
        }
    }

    fn visit(&mut self, object: u16, body: &Thing) {
        (self.visit)(object, body);
    }
}

/// Draws a line of the real list, the short way where nothing has spilled; whether it says that
/// it may have changed, and whether all of it is in slots.
fn walk(
    list: &mut ActiveList<'_, Thing>,
    (line, next): (i32, i32),
    make: impl FnMut(u16) -> Option<Thing>,
    visit: impl FnMut(u16, &Thing),
) -> (bool, bool) {
    let mut tell = Tell { line, make, visit };
    let changed = list.update(line, &mut tell);
    let whole = !list.has_spilled();
    if list.has_spilled() || line % 3 == 0 {
        list.visit_all(next, &mut EMPTY.clone(), &mut tell);
    } else {
        for (index, slot) in list.members() {
            assert_eq!(slot.object(), list.slots()[index].object());
            tell.visit(slot.object(), slot.body());
        }
    }
    (changed, whole)
}

/// The list as plain vectors of (object, cached).
#[derive(Default)]
struct Model {
    active: Vec<(u16, bool)>,
    incoming: Vec<(u16, bool)>,
    pending: Vec<(u16, bool)>,
    used: u32,
}

impl Model {
    fn end_bucket(&mut self) {
        self.incoming.append(&mut self.pending);
        self.incoming.sort_unstable();
    }

    /// Draws a line: what is drawn, in order.
    fn walk(&mut self, things: &[Thing], slots: u32, (line, next): (i32, i32)) -> Vec<u16> {
        let slow = |nodes: &[(u16, bool)]| nodes.iter().filter(|n| !n.1).count() as u32;
        if self.used + slow(&self.active) + slow(&self.incoming) > slots {
            // Where slots are scarce, those of what has ended are free first.
            let before = self.active.len();
            self.active
                .retain(|(o, cached)| !cached || things[usize::from(*o)].end > line);
            self.used -= (before - self.active.len()) as u32;
        }
        let mut waiting: Vec<(u16, bool, bool)> = Vec::new();
        waiting.extend(self.active.drain(..).map(|(o, cached)| (o, cached, false)));
        waiting.extend(self.incoming.drain(..).map(|(o, cached)| (o, cached, true)));
        waiting.sort_unstable();
        for (object, cached, _) in waiting {
            let here = things[usize::from(object)].end > line;
            if cached && !here {
                self.used -= 1;
            } else if cached || self.used == slots {
                self.active.push((object, cached));
            } else if here {
                self.used += 1;
                self.active.push((object, true));
            }
        }
        let end = |object: u16| things[usize::from(object)].end;
        let drawn = self.active.iter().map(|n| n.0).filter(|o| end(*o) > line);
        let drawn = drawn.collect();
        self.active.retain(|(o, cached)| *cached || end(*o) > next);
        drawn
    }
}

/// A chain of the real list, as the model has it.
fn chain(list: &ActiveList<'_, Thing>, mut link: Link, seen: &mut [bool]) -> Vec<(u16, bool)> {
    let mut nodes = Vec::new();
    while link.is_some() {
        assert!(nodes.len() < 1 << 16, "a ring");
        if link.is_cached() {
            let slot = &list.slots[link.slot()];
            assert!(!core::mem::replace(&mut seen[link.slot()], true), "twice");
            assert_eq!(slot.body.object, slot.object);
            nodes.push((slot.object, true));
            link = slot.next;
        } else {
            nodes.push((link.object(), false));
            link = list.links[usize::from(link.object())];
        }
    }
    nodes
}

/// Compares the whole of the list with the model.
fn compare(list: &ActiveList<'_, Thing>, model: &Model, what: &str) {
    let mut seen = vec![false; list.slots.len()];
    assert_eq!(chain(list, list.head, &mut seen), model.active, "{what}");
    let incoming = chain(list, list.incoming, &mut seen);
    assert_eq!(incoming, model.incoming, "{what}");
    assert_eq!(
        chain(list, list.pending, &mut seen),
        model.pending,
        "{what}"
    );
    let used = seen.iter().filter(|seen| **seen).count();
    assert_eq!((used as u32, list.used), (model.used, model.used), "{what}");
    let mut free = 0;
    let mut link = list.free;
    while link.is_some() {
        assert!(!core::mem::replace(&mut seen[link.slot()], true), "{what}");
        link = list.slots[link.slot()].next;
        free += 1;
    }
    assert_eq!(used + free, list.slots.len(), "{what}: a slot is lost");
}

/// Things on `lines` lines, filed under their first lines.
fn things(rng: &mut Rng, count: u16, lines: i32) -> (Vec<Thing>, BTreeMap<i32, Vec<u16>>) {
    let longest = [1, 3, lines as u32][rng.below(3) as usize];
    let mut buckets: BTreeMap<i32, Vec<u16>> = BTreeMap::new();
    let mut all = Vec::new();
    for object in 0..count {
        let first = rng.below(lines as u32) as i32;
        let end = first + 1 + rng.below(longest) as i32;
        all.push(Thing { object, first, end });
        // Latest first, as chains run.
        buckets.entry(first).or_default().insert(0, object);
    }
    (all, buckets)
}

#[test]
fn every_step_is_the_models() {
    const LINES: i32 = 40;
    let mut unchanged = 0;
    for seed in 1..300u64 {
        let mut rng = Rng(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1);
        let count = [0, 1, 5, 40, 200][rng.below(5) as usize];
        let (all, buckets) = things(&mut rng, count, LINES);
        let slots = [0, 1, 2, 3, 7, 16, 64, 300][rng.below(8) as usize];
        let step = 1 + rng.below(4) as i32;
        let mut memory = vec![Slot::new(EMPTY); slots];
        let mut links = vec![Link::NONE; usize::from(count)];
        let mut list = ActiveList::new(&mut memory, &mut links);
        let mut model = Model::default();
        let (mut line, mut last, mut admitted) = (rng.below(step as u32) as i32, -1, -1);
        let mut taken = 0;
        let mut known = None;
        let mut drawn_before: BTreeMap<u16, i32> = BTreeMap::new();
        while line < LINES {
            let what = format!("seed {seed}, {count} things, {slots} slots, line {line}");
            if rng.below(2) == 0 {
                list.release(line);
                let before = model.active.len();
                let stays = |n: &(u16, bool)| !n.1 || all[usize::from(n.0)].end > line;
                model.active.retain(stays);
                model.used -= (before - model.active.len()) as u32;
                compare(&list, &model, &what);
            }
            // Fetch ahead, with a pause anywhere.
            let mut budget = [0, 0, 2, 1000][rng.below(4) as usize];
            'fetch: while admitted < line {
                let bucket = buckets.get(&(admitted + 1)).map_or(&[][..], |b| b);
                for object in &bucket[taken..] {
                    if budget == 0 || !list.has_free() {
                        break 'fetch;
                    }
                    budget -= 1;
                    taken += 1;
                    let thing = all[usize::from(*object)];
                    if thing.end > line {
                        assert!(list.admit_fetched(*object, |body| {
                            *body = thing;
                            true
                        }));
                        model.pending.insert(0, (*object, true));
                        model.used += 1;
                        compare(&list, &model, &what);
                    }
                }
                list.end_bucket();
                model.end_bucket();
                compare(&list, &model, &what);
                (admitted, taken) = (admitted + 1, 0);
            }
            // The rest of the buckets, by links.
            while admitted < line {
                let bucket = buckets.get(&(admitted + 1)).map_or(&[][..], |b| b);
                list.admit(bucket[taken..].iter().copied());
                for object in &bucket[taken..] {
                    model.pending.insert(0, (*object, false));
                }
                model.end_bucket();
                compare(&list, &model, &what);
                (admitted, taken) = (admitted + 1, 0);
            }
            let mut drawn = Vec::new();
            let make = |object: u16| Some(all[usize::from(object)]);
            let (changed, whole) = walk(&mut list, (line, line + step), make, |object, body| {
                assert_eq!((body.object, body.first <= line), (object, true), "{what}");
                drawn.push(object);
            });
            // An order of what was in slots may be kept from one line to the next.
            if let (false, Some(known)) = (changed, known) {
                assert_eq!(drawn, known, "{what}");
                unchanged += usize::from(!drawn.is_empty());
            }
            known = whole.then(|| drawn.clone());
            let expected = model.walk(&all, slots as u32, (line, line + step));
            assert_eq!(drawn, expected, "{what}");
            // And both are what is on the line, whatever a list is.
            let on_line = all.iter().filter(|t| t.first <= line && t.end > line);
            assert!(
                on_line.map(|t| t.object).eq(drawn.iter().copied()),
                "{what}"
            );
            compare(&list, &model, &what);
            for object in drawn {
                drawn_before.insert(object, line);
            }
            (last, line) = (line, line + step);
        }
        let counts = list.counts;
        let object_lines: usize = all
            .iter()
            .map(|t| {
                (last % step..LINES)
                    .step_by(step as usize)
                    .filter(|l| t.first <= *l && t.end > *l)
                    .count()
            })
            .sum();
        // Misses also count objects looked at that end above the line.
        assert!((counts.hits + counts.misses) as usize >= object_lines);
        assert!(counts.hits as usize <= object_lines);
        assert!(counts.peak_slots as usize <= slots);
        assert!(counts.fetched_hits <= counts.fetched);
        assert_eq!(drawn_before.is_empty(), object_lines == 0);
    }
    assert!(unchanged > 200, "{unchanged}");
}

#[test]
fn objects_that_cannot_be_made_leave() {
    for slots in [0, 1, 9] {
        let mut memory = vec![Slot::new(EMPTY); slots];
        let mut links = vec![Link::NONE; 4];
        let mut list = ActiveList::new(&mut memory, &mut links);
        list.admit([3, 2, 1, 0].into_iter());
        let thing = |object| Thing {
            object,
            end: 9,
            ..EMPTY
        };
        let make = |object| (object % 2 == 0).then(|| thing(object));
        let mut drawn = Vec::new();
        walk(&mut list, (0, 1), make, |object, _| drawn.push(object));
        assert_eq!(drawn, [0, 2]);
        walk(&mut list, (1, 2), make, |object, _| drawn.push(object));
        assert_eq!(drawn, [0, 2, 0, 2]);
        // Beyond the column: not taken.
        list.admit([900].into_iter());
        walk(&mut list, (2, 9), make, |object, _| drawn.push(object));
        assert_eq!(drawn, [0, 2, 0, 2, 0, 2]);
        list.release(9);
        assert!(list.is_empty());
        assert_eq!(list.used, 0);
    }
}

#[test]
fn everything_ends_at_once_and_the_slots_are_free_at_once() {
    let mut memory = vec![Slot::new(EMPTY); 4];
    let mut links = vec![Link::NONE; 10_000];
    let mut list = ActiveList::new(&mut memory, &mut links);
    let make = |object| {
        Some(Thing {
            object,
            end: 2,
            ..EMPTY
        })
    };
    list.admit((0..10_000).rev());
    let mut drawn = Vec::new();
    walk(&mut list, (0, 1), make, |object, _| drawn.push(object));
    assert!(drawn.iter().copied().eq(0..10_000));
    assert_eq!((list.used, list.counts.spills), (4, 9_996));
    drawn.clear();
    walk(&mut list, (1, 2), make, |object, _| drawn.push(object));
    assert!(drawn.iter().copied().eq(0..10_000));
    list.release(2);
    assert!(list.is_empty() && list.has_free() && list.used == 0);
    assert_eq!((list.counts.hits, list.counts.misses), (4, 19_996));
}

#[test]
fn counts_say_what_they_cost() {
    let mut memory = vec![Slot::new(EMPTY); 1];
    let mut links = vec![Link::NONE; 2];
    let mut list = ActiveList::new(&mut memory, &mut links);
    let make = |object| {
        Some(Thing {
            object,
            end: 9,
            ..EMPTY
        })
    };
    list.admit([1, 0].into_iter());
    walk(&mut list, (0, 1), make, |_, _| ());
    walk(&mut list, (1, 2), make, |_, _| ());
    let c = list.counts;
    assert_eq!((c.hits, c.misses, c.spills, c.admitted), (1, 3, 1, 2));
    // Two into the column; the spilled one's own and no other, as a slot leads to it.
    assert_eq!(c.link_writes, 3);
    assert_eq!(c.records_read(), 3);
    // The spilled one's: when it was taken in, and on the walk of the next line; three with
    // their records, and two of the bucket.
    assert_eq!(c.link_reads, 2);
    assert_eq!(c.slow_read_bytes(44), 3 * 44 + 2 * (2 + 3 + 2));
    assert_eq!(c.slow_write_bytes(), 6);
    assert_eq!(c.hits_per_mille(), 250);
    let mut sum = c;
    sum += c;
    assert_eq!((sum.hits, sum.misses, sum.peak_slots), (2, 6, c.peak_slots));
}
