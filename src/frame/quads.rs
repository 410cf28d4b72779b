//! Parallelograms from line to line: an object with four corners (K1).
//!
//! The fourth lies in the object's second record; what holds one finds it there, and what has no textures never looks.

use super::renderer::{Renderer, View};
use super::slot::Flags;
use crate::active::Change;
use crate::look::Look;
use crate::num::bit;
use crate::scene::Object;
use crate::span::{Entry, Triangle, Walked};

impl<'a> View<'a> {
    /// The corners of an object: three, or four, if it has a second record.
    #[inline(always)]
    pub(super) fn corners(
        &'a self,
        object: &'a Object,
        second: Option<&'a Object>,
    ) -> Option<Triangle<'a>> {
        let [a, b, c] = object.corner;
        let at = |i: u16| self.tables.vertices.get(usize::from(i));
        Some(Triangle {
            vertex: [at(a)?, at(b)?, at(c)?],
            object,
            second,
            tables: &self.tables,
            frame: self.frame,
        })
    }

    /// Whether an object may have four corners.
    #[inline(always)]
    pub(super) fn may_be_quad(&self, number: u16) -> bool {
        // Of most scenes none is: that is asked first.
        self.quads.end != 0 && self.quads.contains(&number)
    }

    /// Three corners of an object by its number.
    #[inline(always)]
    pub(super) fn triangle_of(&'a self, number: u16) -> Option<Triangle<'a>> {
        self.corners(self.objects.get(usize::from(number))?, None)
    }

    /// All corners of an object, which are four only of a look that is `textured`.
    #[inline(always)]
    pub(super) fn figure(
        &'a self,
        number: u16,
        object: &'a Object,
        textured: bool,
    ) -> Option<Triangle<'a>> {
        let second = match textured && self.may_be_quad(number) {
            true => self.second_of(number),
            false => None,
        };
        self.corners(object, second)
    }

    /// All corners of an object by its number.
    #[inline(always)]
    pub(super) fn figure_of(&'a self, number: u16, textured: bool) -> Option<Triangle<'a>> {
        self.figure(number, self.objects.get(usize::from(number))?, textured)
    }

    /// All corners of an object that has four.
    #[inline(never)]
    pub(super) fn quad(&'a self, number: u16, object: &'a Object) -> Option<Triangle<'a>> {
        self.corners(object, Some(self.second_of(number)?))
    }

    /// The second record of an object, if it has one.
    #[inline(never)]
    fn second_of(&self, number: u16) -> Option<&'a Object> {
        for at in [number.wrapping_add(1), number.wrapping_sub(1)] {
            let record = self.objects.get(usize::from(at));
            if let Some(record) = record.filter(|record| record.owner(at) == Some(number)) {
                return Some(record);
            }
        }
        None
    }
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// [`take_in`](Renderer::take_in) of a parallelogram.
    #[inline(never)]
    pub(super) fn take_in_quad(
        &mut self,
        view: &View<'_>,
        slot: usize,
        number: u16,
        quad: Option<Triangle<'_>>,
        line: u16,
    ) -> u32 {
        self.take_in_by(view, slot, number, quad, |quad, sides| {
            let fourth = quad.fourth();
            fourth.map_or(Entry::NONE, |fourth| quad.enter_quad(fourth, line, sides))
        })
    }

    /// A side of a parallelogram in a slot gives way to the next one; whether it is one.
    #[inline(never)]
    pub(super) fn turn_quad(&mut self, view: &View<'_>, word: usize, i: u32) -> bool {
        let line = i32::from(self.next) - 1;
        let Some(walked) = self.walked(view, word, i, line) else {
            return false;
        };
        self.cache.slots[word][i as usize & 31].item.sides = walked.sides;
        self.cache.await_change(word, bit(i), change_of(&walked));
        true
    }

    /// A parallelogram in a slot is asked when it changes, on the line that begins or farther down; whether it is one.
    #[inline(never)]
    pub(super) fn ask_quad(&mut self, view: &View<'_>, word: usize, i: u32) -> bool {
        let before = i32::from(self.next) - 2;
        let Some(walked) = self.walked(view, word, i, before) else {
            return false;
        };
        self.cache.await_change(word, bit(i), change_of(&walked));
        true
    }

    /// The sides of a parallelogram in a slot on a line.
    fn walked(&self, view: &View<'_>, word: usize, i: u32, line: i32) -> Option<Walked> {
        let slot = &self.cache.slots[word][i as usize & 31];
        let triangle = view.figure_of(slot.object, true)?;
        let fourth = triangle.fourth()?;
        Some(triangle.sides_of_quad(fourth, Flags(slot.flags).way(), line))
    }
}

fn change_of(walked: &Walked) -> Change {
    Change {
        line: walked.change as u16,
        turns: walked.turns,
    }
}
