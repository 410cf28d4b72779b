//! Fetching ahead (C4): while a line is on its way, triangles that begin on the next are set up, and their slots withheld
//! until it comes.
//!
//! Slots that are free take them, up to so many bytes of slow memory at a time; what finds no slot or is too much is set up
//! when its line comes. A triangle gets a slot or none as it would have without: while one waits for a slot none is free.

use super::renderer::{Renderer, View};
use crate::look::Look;
use crate::scene::{NONE, Object, Scene, TexturePlace, Vertex};

/// What fetches, as functions: a program that names none of them does not have their code.
#[derive(Debug)]
pub(super) struct Fetcher<L: Look, const WORDS: usize> {
    /// Sets up what begins on the next line; how many bytes were read.
    pub(super) fetch: fn(&mut Renderer<'_, L, WORDS>, &Scene<'_, '_, L>) -> u32,
    /// Puts what was fetched for the line that begins among what is active; what else begins there.
    pub(super) arrive: fn(&mut Renderer<'_, L, WORDS>, u16) -> u16,
    /// Forgets what was fetched.
    pub(super) forget: fn(&mut Renderer<'_, L, WORDS>),
    /// The most bytes at a time.
    bytes: u32,
    /// The line that is fetched for.
    line: Option<u16>,
    /// What begins there and is not fetched.
    rest: u16,
    /// How many triangles were fetched for it.
    count: u32,
    /// Their slots, and those of them that are drawn in the commonest way.
    used: [u32; WORDS],
    plain: [u32; WORDS],
}

impl<L: Look, const WORDS: usize> Fetcher<L, WORDS> {
    pub(super) fn new(bytes: u32) -> Self {
        Self {
            fetch: |renderer, scene| renderer.fetch_next(&View::of(scene), scene.lines().end),
            arrive: |renderer, head| renderer.arrive(head),
            forget: |renderer| {
                if let Some(ahead) = &mut renderer.fetcher {
                    *ahead = Self::new(ahead.bytes);
                }
            },
            bytes,
            line: None,
            rest: NONE,
            count: 0,
            used: [0; WORDS],
            plain: [0; WORDS],
        }
    }
}

/// Bytes of what leads to the first triangle of a line.
const HEAD_BYTES: u32 = size_of::<u16>() as u32;

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Bytes of slow memory that a triangle is set up from, with its corners and, where looks have textures, their places
    /// there.
    pub const RECORD_BYTES: u32 = {
        let corner = size_of::<Vertex>() + L::TEXTURED as usize * size_of::<TexturePlace>();
        (size_of::<Object>() + 3 * corner) as u32
    };

    /// Sets up what begins on the line after the last that was drawn, as far as the bytes go.
    #[inline(never)]
    fn fetch_next(&mut self, view: &View<'_>, end: u16) -> u32 {
        if self.content != Some(view.content) {
            self.start_anew(view);
            self.cache.enter_line(view.first.wrapping_sub(1));
        }
        let line = self.next;
        let head = view.bins.get(usize::from(line.wrapping_sub(view.first)));
        let (Some(&head), Some(ahead)) = (head.filter(|_| line < end), &mut self.fetcher) else {
            return 0;
        };
        let mut left = ahead.bytes;
        if ahead.line != Some(line) {
            let Some(after_head) = left.checked_sub(HEAD_BYTES) else {
                return 0;
            };
            (ahead.line, ahead.rest, left) = (Some(line), head, after_head);
        }
        let (mut at, mut count, mut made) = (ahead.rest, 0, 0);
        // What is fetched is not active before its line comes.
        let (active, plain) = (self.cache.used, self.cache.plain);
        for (used, withheld) in self.cache.used.iter_mut().zip(ahead.used) {
            *used |= withheld;
        }
        while let Some(object) = view.objects.get(usize::from(at)) {
            let (Some(slot), Some(after)) =
                (self.cache.free(), left.checked_sub(Self::RECORD_BYTES))
            else {
                break;
            };
            made += self.take_in(view, slot, at, object, line);
            (at, left, count) = (object.next, after, count + 1);
        }
        self.count_set_ups(made);
        let Some(ahead) = &mut self.fetcher else {
            return 0;
        };
        ahead.rest = at;
        ahead.count += count;
        for word in 0..WORDS {
            ahead.used[word] |= self.cache.used[word] & !active[word];
            ahead.plain[word] |= self.cache.plain[word] & !plain[word];
        }
        (self.cache.used, self.cache.plain) = (active, plain);
        let bytes = ahead.bytes - left;
        self.counts.fetched += count;
        self.counts.fetched_bytes += bytes;
        bytes
    }

    /// What was fetched for the line that begins is active from now on; what else begins on it.
    #[inline(never)]
    fn arrive(&mut self, head: u16) -> u16 {
        let Some(ahead) = &mut self.fetcher else {
            return head;
        };
        // The line that begins is the one before the next.
        if ahead.line.take().map(|line| line + 1) != Some(self.next) {
            return head;
        }
        for word in 0..WORDS {
            self.cache.used[word] |= core::mem::take(&mut ahead.used[word]);
            self.cache.plain[word] |= core::mem::take(&mut ahead.plain[word]);
        }
        self.counts.hits += core::mem::take(&mut ahead.count);
        ahead.rest
    }
}
