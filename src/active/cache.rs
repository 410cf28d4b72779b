//! The object cache: slots in fast memory, found by sets, and when each changes (C1, C2, C3, C7).
//!
//! What is active is a bit of a set, so nothing is walked to be found; what changes on a line (a side turns, or
//! the triangle ends) is a set in a ring of 32 lines, so nothing is asked on the lines between, and all that ends
//! on a line leaves in one operation a word. What changes farther down waits in a ring of 8 blocks of 32 lines, and
//! is put among the lines of its block as that begins. What found no slot is a chain in slow memory by number,
//! through the renderer's own column of links; a link that leads to a slot lies in a range of its own, so one comparison tells a hit.

use crate::link::Link;
use crate::num::{bit, take_first};

/// A slot: what is kept of an object.
#[derive(Clone, Copy, Debug)]
#[repr(C)]
pub struct Slot<T> {
    /// The object's number.
    pub(crate) object: u16,
    /// What the owner of the slots wants to know of an object.
    pub(crate) known: u16,
    /// Not at the beginning: what lies there is loaded from an address of its own.
    pub(crate) item: T,
}

/// When an object in a slot changes next, and how.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Change {
    pub(crate) line: u16,
    /// Whether a side turns; it ends otherwise.
    pub(crate) turns: bool,
}

/// Lines of the ring, and of a block.
const RING: u16 = 32;

/// Blocks of lines. What changes farther down goes around.
const BLOCKS: u16 = 8;

/// `32 WORDS` slots and what finds them, to be placed in the fastest memory there is. Sets come first, where a
/// processor reaches them without reckoning an address.
#[derive(Debug)]
#[repr(C)]
pub struct Cache<T, const WORDS: usize> {
    /// Slots that hold an object.
    pub(crate) used: [u32; WORDS],
    /// Of these, those that are drawn in the commonest way.
    pub(crate) plain: [u32; WORDS],
    /// Of these, those whose next change is the turn of a side.
    turning: [u32; WORDS],
    /// Slots of spans that meet others, as a set.
    pub(crate) listed: [u32; WORDS],
    /// The first object that found no slot.
    pub(crate) spilled: Link,
    /// How many found none.
    pub(crate) spilled_count: u16,
    /// Slots that are never used.
    unused: u16,
    /// The line whose changes were taken last.
    line: u16,
    /// What changes on each line of the ring.
    ring: [[u32; WORDS]; RING as usize],
    /// What changes in each block of lines, farther away than the ring is long, and perhaps a turn of blocks later.
    blocks: [[u32; WORDS]; BLOCKS as usize],
    /// The columns of each slot on this line: the first in the upper half, the one after the last below.
    pub(crate) spans: [[u32; 32]; WORDS],
    /// Slots of spans that meet others, and all slots, from the nearest on or by number of object.
    pub(crate) order: [[u32; 32]; WORDS],
    /// The farthest depth of each slot's span on this line; on one with values, columns and draw calls of what found no
    /// slot.
    pub(crate) far: [[u32; 32]; WORDS],
    /// The last, so that all else lies within the reach of one instruction.
    pub(crate) slots: [[Slot<T>; 32]; WORDS],
}

/// Slots of a word that a line changes.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Changes {
    /// They have ended, and are free.
    pub(crate) ended: u32,
    /// A side turns.
    pub(crate) turning: u32,
}

/// What the cache has done since it was cleared (C8).
///
/// What several renderers of a frame have done is the sum, but for `peak`, of which the largest counts.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct CacheUse {
    /// Objects for which there was a slot when they began, fetched ahead or not; those without a pixel too.
    pub hits: u32,
    /// Objects that found none.
    pub spilled: u32,
    /// Of these, those that found one later.
    pub moved_in: u32,
    /// Lines of objects that were drawn from slow memory: each line on which one without a slot has pixels.
    pub misses: u32,
    /// Set-ups: of slots, and of objects without one, once a line, twice where two meet that were thought to be alone, on
    /// lines with values once for each time one is drawn.
    pub set_ups: u32,
    /// Set-ups of slots of which a side turns on a line farther down: there the record is read again.
    pub turning: u32,
    /// The most slots in use at a time.
    pub peak: u32,
    /// Objects that were fetched ahead (C4); they are among the set-ups, and among the hits when their line comes.
    pub fetched: u32,
    /// Bytes of slow memory that were read ahead.
    pub fetched_bytes: u32,
}

impl CacheUse {
    /// Records read from slow memory: an object and its corners, for a set-up, for a side that turns, and once to find
    /// the columns of what has no slot. What is read of corners to compare depths is not counted.
    #[must_use]
    pub const fn records_read(&self) -> u64 {
        self.set_ups as u64 + self.turning as u64 + self.misses as u64
    }

    /// Bytes read from slow memory, where a record has
    /// [`RECORD_BYTES`](crate::Renderer::RECORD_BYTES), with a link for each object without a slot on each line.
    #[must_use]
    pub const fn slow_read_bytes(&self, record_bytes: u32) -> u64 {
        self.records_read() * record_bytes as u64 + self.misses as u64 * size_of::<Link>() as u64
    }

    /// Bytes written to slow memory while lines were drawn, links alone (C7): one when an object gets a slot, and two when
    /// it finds none.
    #[must_use]
    pub const fn slow_write_bytes(&self) -> u64 {
        let links = self.hits as u64 + self.moved_in as u64 + 2 * self.spilled as u64;
        links * size_of::<Link>() as u64
    }
}

impl core::ops::AddAssign for CacheUse {
    fn add_assign(&mut self, other: Self) {
        self.hits += other.hits;
        self.spilled += other.spilled;
        self.moved_in += other.moved_in;
        self.misses += other.misses;
        self.set_ups += other.set_ups;
        self.turning += other.turning;
        self.peak = self.peak.max(other.peak);
        self.fetched += other.fetched;
        self.fetched_bytes += other.fetched_bytes;
    }
}

impl<T: Copy, const WORDS: usize> Cache<T, WORDS> {
    /// A cache of empty slots, zeros if the item is, as those of all looks are, so that a static takes no flash. It has to
    /// be [cleared](Cache::clear) before it is used.
    #[must_use]
    pub(crate) const fn with(item: T) -> Self {
        let slot = Slot {
            item,
            object: 0,
            known: 0,
        };
        const { assert!(32 * WORDS < 0xFF, "at most 224 slots") };
        Self {
            slots: [[slot; 32]; WORDS],
            used: [0; WORDS],
            plain: [0; WORDS],
            turning: [0; WORDS],
            spans: [[0; 32]; WORDS],
            listed: [0; WORDS],
            order: [[0; 32]; WORDS],
            far: [[0; 32]; WORDS],
            line: 0,
            ring: [[0; WORDS]; RING as usize],
            blocks: [[0; WORDS]; BLOCKS as usize],
            spilled: Link::EMPTY,
            spilled_count: 0,
            unused: 0,
        }
    }

    /// Uses no more than so many slots. The picture is the same.
    pub fn set_limit(&mut self, slots: u16) {
        self.unused = (32 * WORDS as u16).saturating_sub(slots);
        self.clear();
    }

    /// Forgets all objects.
    pub(crate) fn clear(&mut self) {
        self.used = [0; WORDS];
        self.plain = [0; WORDS];
        self.turning = [0; WORDS];
        self.ring = [[0; WORDS]; RING as usize];
        self.blocks = [[0; WORDS]; BLOCKS as usize];
        self.spilled = Link::NONE;
        self.spilled_count = 0;
    }

    /// Whether no object is active.
    #[inline(always)]
    pub(crate) fn is_empty(&self) -> bool {
        self.used.iter().all(|&word| word == 0) && !self.spilled.is_some()
    }

    /// How many slots are in use.
    pub(crate) fn in_use(&self) -> u32 {
        self.used.iter().map(|word| word.count_ones()).sum()
    }

    /// A slot by its number, and its columns on this line.
    #[inline(always)]
    pub(crate) fn at(&self, number: usize) -> Option<(&Slot<T>, u32)> {
        let slot = self.slots.as_flattened().get(number)?;
        Some((slot, *self.spans.as_flattened().get(number)?))
    }

    /// A slot that is free.
    #[inline(always)]
    pub(crate) fn free(&self) -> Option<usize> {
        self.free_beside(&[0; WORDS])
    }

    /// The same of slots that are not withheld.
    #[inline(always)]
    pub(crate) fn free_beside(&self, withheld: &[u32; WORDS]) -> Option<usize> {
        for (word, (&used, &withheld)) in self.used.iter().zip(withheld).enumerate() {
            let mut free = !(used | withheld);
            if let Some(i) = take_first(&mut free) {
                let slot = word * 32 + i as usize;
                return (slot + usize::from(self.unused) < 32 * WORDS).then_some(slot);
            }
        }
        None
    }

    /// The slot of a number; there is one for each number below `32 WORDS`.
    #[inline(always)]
    pub(crate) fn slot(&mut self, slot: usize) -> Option<&mut Slot<T>> {
        self.slots.as_flattened_mut().get_mut(slot)
    }

    /// Says that a slot is in use from now on, and when it changes.
    #[inline(always)]
    pub(crate) fn keep(&mut self, slot: usize, plain: bool, change: Change) {
        let word = slot >> 5;
        if word >= WORDS {
            return;
        }
        let one = bit(slot as u32);
        self.used[word] |= one;
        if plain {
            self.plain[word] |= one;
        }
        self.await_change(word, one, change);
    }

    /// Puts a slot among those that change on a line farther down.
    #[inline(always)]
    pub(crate) fn await_change(&mut self, word: usize, one: u32, change: Change) {
        if change.turns {
            self.turning[word] |= one;
        }
        if change.line.wrapping_sub(self.line) > RING {
            return self.await_block(word, one, change.line);
        }
        self.ring[usize::from(change.line % RING)][word] |= one;
    }

    /// The same of a line beyond the ring.
    #[inline(never)]
    fn await_block(&mut self, word: usize, one: u32, line: u16) {
        if let Some(slots) = self.blocks[usize::from(line / RING % BLOCKS)].get_mut(word) {
            *slots |= one;
        }
    }

    /// Frees slots of a word.
    #[inline(always)]
    pub(crate) fn free_slots(&mut self, word: usize, slots: u32) {
        self.used[word] &= !slots;
        self.plain[word] &= !slots;
    }

    /// Frees slots of a word that wait for a change.
    pub(crate) fn give_up(&mut self, word: usize, slots: u32) {
        self.free_slots(word, slots);
        self.turning[word] &= !slots;
    }

    /// Goes on to a line; whether something changes there, or a block of lines begins.
    #[inline(always)]
    pub(crate) fn enter_line(&mut self, line: u16) -> bool {
        self.line = line;
        let due = self.ring[usize::from(line % RING)];
        line.is_multiple_of(RING) || due.iter().fold(0, |any, word| any | word) != 0
    }

    /// Whether a block of lines begins on this one.
    #[inline(always)]
    pub(crate) fn begins_block(&self) -> bool {
        self.line.is_multiple_of(RING)
    }

    /// What waits for the block that [begins](Cache::begins_block) on this line: what turns, and what ends. Each has to
    /// be told again when it changes.
    #[inline(always)]
    pub(crate) fn take_block(&mut self, word: usize) -> [u32; 2] {
        let block = &mut self.blocks[usize::from(self.line / RING % BLOCKS)][word];
        let waiting = core::mem::take(block);
        let turning = waiting & self.turning[word];
        [turning, waiting & !turning]
    }

    /// Frees what ends on this line among the slots of a word, and says what else changes.
    #[inline(always)]
    pub(crate) fn take_changes(&mut self, word: usize) -> Changes {
        let due = core::mem::take(&mut self.ring[usize::from(self.line % RING)][word]);
        if due == 0 {
            return Changes::default();
        }
        let turning = due & self.turning[word];
        self.turning[word] &= !turning;
        let ended = due & !turning;
        self.free_slots(word, ended);
        Changes { ended, turning }
    }

    /// Puts an object that found no slot into its place among the others.
    #[inline(never)]
    pub(crate) fn spill(&mut self, object: u16, links: &mut [Link]) {
        let new = Link::slow(object);
        let (mut before, mut at) = (Link::NONE, self.spilled);
        while at.is_some() && at.object() < object {
            before = at;
            at = next(links, at);
        }
        if let Some(link) = links.get_mut(usize::from(object)) {
            *link = at;
        }
        self.relink(before, new, links);
        self.spilled_count += 1;
    }

    /// Takes out what found no slot and comes after `before`, or first; `after` comes after it.
    #[inline(always)]
    pub(crate) fn take_spilled(&mut self, before: Link, after: Link, links: &mut [Link]) {
        self.relink(before, after, links);
        self.spilled_count -= 1;
    }

    /// Lets what comes after `before`, or first, be `to`.
    #[inline(always)]
    fn relink(&mut self, before: Link, to: Link, links: &mut [Link]) {
        if !before.is_some() {
            self.spilled = to;
        } else if let Some(link) = links.get_mut(usize::from(before.object())) {
            *link = to;
        }
    }
}

/// The object after another among those that found no slot.
#[inline(always)]
pub(crate) fn next(links: &[Link], at: Link) -> Link {
    links
        .get(usize::from(at.object()))
        .copied()
        .unwrap_or(Link::NONE)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::vec::Vec;

    /// Of a slot that begins on line 0, turns and ends: the lines on which the rings say so, and how often it was
    /// asked when it changes.
    fn changes_of(first: u16, turn: u16, end: u16) -> ([Option<u16>; 2], u32) {
        let mut cache = Cache::<(), 2>::with(());
        cache.clear();
        let (word, one) = (1, bit(9));
        let change = |turns: bool| Change {
            line: if turns { turn } else { end },
            turns,
        };
        cache.enter_line(first);
        cache.keep(word * 32 + 9, true, change(true));
        let (mut seen, mut asked) = ([None; 2], 0);
        for line in first + 1..=end + 300 {
            let due = cache.enter_line(line);
            assert_eq!(cache.take_changes(0), Changes::default());
            let mut waiting = [0; 2];
            if cache.begins_block() {
                assert_eq!(cache.take_block(0), [0; 2]);
                waiting = cache.take_block(word);
            }
            for (waits, turns) in waiting.into_iter().zip([true, false]) {
                if waits & one != 0 {
                    asked += 1;
                    cache.await_change(word, one, change(turns));
                }
            }
            let changes = cache.take_changes(word);
            assert!(due || changes == Changes::default() && waiting == [0; 2]);
            if changes.turning & one != 0 {
                assert_eq!(seen[0].replace(line), None);
                cache.await_change(word, one, change(false));
            }
            if changes.ended & one != 0 {
                assert_eq!(seen[1].replace(line), None);
            }
            assert_eq!(cache.used[word] & one != 0, seen[1].is_none(), "{line}");
        }
        assert!(cache.is_empty());
        (seen, asked)
    }

    #[test]
    fn slots_turn_and_end_on_their_lines_however_far_they_are() {
        for first in [0, 5, 31, 32, 255] {
            for turn in [1, 2, 31, 32, 33, 64, 65, 200, 255, 256, 257, 600] {
                for height in [1, 31, 32, 33, 64, 97, 256, 288, 500] {
                    let (turn, end) = (first + turn, first + turn + height);
                    let (seen, asked) = changes_of(first, turn, end);
                    assert_eq!(seen, [Some(turn), Some(end)]);
                    assert!(asked <= u32::from(end - first) / 256 + 2, "{asked}");
                }
            }
        }
    }

    #[test]
    fn what_ends_is_not_plain_any_more() {
        let mut cache = Cache::<(), 1>::with(());
        cache.clear();
        cache.enter_line(7);
        for (slot, line) in [(0, 9), (3, 9), (4, 10)] {
            cache.keep(slot, slot != 3, Change { line, turns: false });
        }
        assert_eq!((cache.in_use(), cache.free()), (3, Some(1)));
        cache.enter_line(9);
        let changes = cache.take_changes(0);
        assert_eq!(changes.ended, bit(0) | bit(3));
        assert_eq!([cache.used[0], cache.plain[0]], [bit(4); 2]);
    }

    /// Objects without a slot are in the order of their numbers, however they come and go.
    #[test]
    fn spilled_objects_are_a_sorted_list() {
        let mut rng = Rng(12);
        let mut cache = Cache::<(), 1>::with(());
        cache.clear();
        let mut links = [Link::NONE; 50];
        let mut model: Vec<u16> = Vec::new();
        for _ in 0..4000 {
            let object = rng.below(50) as u16;
            match model.binary_search(&object) {
                Err(at) => {
                    cache.spill(object, &mut links);
                    model.insert(at, object);
                }
                Ok(at) => {
                    let link = |at: usize| model.get(at).map_or(Link::NONE, |o| Link::slow(*o));
                    let before = at.checked_sub(1).map_or(Link::NONE, link);
                    cache.take_spilled(before, link(at + 1), &mut links);
                    model.remove(at);
                }
            }
            let mut found = Vec::new();
            let mut at = cache.spilled;
            while at.is_some() {
                found.push(at.object());
                at = next(&links, at);
            }
            assert_eq!(found, model);
            assert_eq!(cache.is_empty(), model.is_empty());
            assert_eq!(usize::from(cache.spilled_count), model.len());
        }
        // A column of links that is too short loses objects, and nothing else.
        let mut cache = Cache::<(), 1>::with(());
        cache.clear();
        cache.spill(7, &mut [Link::NONE; 3]);
        assert_eq!(cache.spilled.object(), 7);
        assert!(!next(&[Link::NONE; 3], cache.spilled).is_some());
    }

    /// Kills: a kind of record that is not counted, or is taken off, and bytes of another size.
    #[test]
    fn what_is_read_and_written_is_counted() {
        let used = CacheUse {
            set_ups: 500,
            turning: 70,
            misses: 3,
            ..CacheUse::default()
        };
        assert_eq!(used.records_read(), 573);
        // A record of 20 bytes, and links of two bytes.
        assert_eq!(used.slow_read_bytes(20), 11_460 + 6);
    }
}
