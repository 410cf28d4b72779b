//! Where a line renderer is in a scene, and fetching ahead of it (C4).

use super::error::RendererError;
use super::lines::LineRenderer;
use super::scene::Scene;
use super::transparent::is_special;
use crate::composite::Compositing;
use crate::link::Link;
use crate::pipeline::Pipeline;

/// How far a renderer has come down a scene. Lines are those of guard space.
#[derive(Clone, Copy, Debug)]
pub(super) struct Place {
    /// What the scene's was.
    content: (usize, u32),
    /// The line drawn last, or the one above the first.
    pub(super) last: i32,
    /// The first line that the list can still serve, above `last`: what ends before it has left
    /// the list, or was not taken into it.
    pub(super) next: i32,
    /// The last line whose bucket is wholly in the list, not above `last`.
    pub(super) admitted: i32,
    /// Of the bucket after `admitted`, what is not yet in the list; `None`: it was not begun.
    pub(super) rest: Option<Link>,
}

impl Place {
    /// Before the first line of `scene`.
    pub(super) fn above<P: Pipeline>(scene: &Scene<'_, P>) -> Self {
        let first = scene.first_line();
        Self {
            content: scene.content(),
            last: first - 1,
            next: first,
            admitted: first - 1,
            rest: None,
        }
    }

    /// Whether `line` of the scene can be drawn without starting anew.
    #[inline]
    pub(super) fn serves(&self, content: (usize, u32), line: i32) -> bool {
        self.content == content && line >= self.next
    }
}

/// What a step of [`LineRenderer::prefetch`] has done.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Prefetched {
    /// Bytes read from slow memory, at most the budget.
    pub bytes: u32,
    /// Nothing more can be fetched before the line is drawn: all is there, or no slot is free.
    /// Otherwise the budget is used up, and another step will go on.
    pub done: bool,
}

impl<P: Pipeline> LineRenderer<'_, P> {
    /// How many bytes a line [`draw_frame`](crate::pipeline::draw_frame) fetches ahead, while a transfer
    /// runs; 0, which is how it starts: none. Any value gives the same picture.
    pub fn set_prefetch(&mut self, bytes_per_line: u32) {
        self.prefetch = bytes_per_line;
    }

    /// How many bytes a line are fetched ahead.
    #[must_use]
    pub fn prefetch_budget(&self) -> u32 {
        self.prefetch
    }

    /// Fetches objects that become active on or above `line`, the line that is drawn next, into
    /// free slots of the cache and sets them up there (C4); stops before it has read more than
    /// `budget` bytes from slow memory.
    ///
    /// One step of work for an idle moment: as long as it is not done, another call goes on
    /// where this one stopped. What has not been fetched when the line is drawn is served from
    /// slow memory, so that the picture is the same whatever is called when. A line above `line`
    /// can no longer be drawn without starting anew.
    ///
    /// # Errors
    /// When the memory does not suffice for the scene, or the line is not of the scene.
    pub fn prefetch(
        &mut self,
        scene: &Scene<'_, P>,
        line: u16,
        budget: u32,
    ) -> Result<Prefetched, RendererError> {
        self.check(scene)?;
        if !scene.lines().contains(&line) {
            return Err(RendererError::Line { line });
        }
        let line = scene.screen().top() + i32::from(line);
        let mut place = match self.place {
            Some(place) if place.serves(scene.content(), line) => place,
            // A line that was drawn, or is above one that was: it would have to start anew.
            Some(place) if place.serves(scene.content(), place.next) => {
                return Ok(Prefetched {
                    bytes: 0,
                    done: true,
                });
            }
            _ => {
                self.list.clear();
                self.special_end = 0;
                Place::above(scene)
            }
        };
        place.next = line;
        // What has ended makes room.
        self.list.release(line);
        let mut left = budget;
        let done = self.fetch(scene, &mut place, line, &mut left);
        self.place = Some(place);
        Ok(Prefetched {
            bytes: budget - left,
            done,
        })
    }

    /// Fetches until `line` is reached or the cache is full (`true`), or `left` is used up.
    fn fetch(
        &mut self,
        scene: &Scene<'_, P>,
        place: &mut Place,
        line: i32,
        left: &mut u32,
    ) -> bool {
        let record = Self::RECORD_BYTES as u32;
        let shallow = self.leaves_depth();
        while place.admitted < line {
            let mut rest = match place.rest {
                Some(rest) => rest,
                None => {
                    let Some(after) = left.checked_sub(size_of::<Link>() as u32) else {
                        return false;
                    };
                    *left = after;
                    self.list.counts.buckets += 1;
                    scene.bucket(place.admitted + 1)
                }
            };
            place.rest = Some(rest);
            while let Some(object) = rest.is_some().then(|| rest.object()) {
                if !self.list.has_free() {
                    return true;
                }
                let Some(after) = left.checked_sub(record) else {
                    return false;
                };
                *left = after;
                // It may end before this renderer's next line, and then is none of its own.
                let special_end = &mut self.special_end;
                self.list.admit_fetched(object, |body| {
                    let there = scene.set_up(object, (line, shallow), body);
                    if P::Compositing::BLENDS && there && is_special(scene, object, body) {
                        *special_end = (*special_end).max(i32::from(body.end()));
                    }
                    there
                });
                rest = scene.object(object).map_or(Link::NONE, |o| o.next());
                place.rest = Some(rest);
            }
            self.list.end_bucket();
            place.admitted += 1;
            place.rest = None;
        }
        true
    }

    /// Fetches for this renderer's first line from `line` on, as
    /// [`set_prefetch`](LineRenderer::set_prefetch) allows.
    #[inline]
    pub(super) fn prefetch_for(&mut self, scene: &Scene<'_, P>, line: u16) {
        if self.prefetch == 0 {
            return;
        }
        let next = self.interleave.at_or_after(u32::from(line));
        if next < u32::from(scene.lines().end) {
            // What cannot be fetched will be drawn from slow memory, or refused there.
            let _ = self.prefetch(scene, next as u16, self.prefetch);
        }
    }
}
