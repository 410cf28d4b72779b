//! Pass two: the objects of a line into its pixels (K1, K5, K8).

use super::scene::Scene;
use super::spans::draw_span;
use crate::active::{ActiveList, CacheCounts, Member};
use crate::geometry::Drawable;
use crate::link::Link;
use crate::pipeline::{CellOf, DrawableOf, Pipeline, SlotOf, WordOf};
use crate::span::Span;
use crate::stats::{SpanCounter, SpanCounts};
use crate::visible::LineDepth;

/// The memory of one line renderer, lent by the application.
pub struct LineMemory<'m, P: Pipeline> {
    /// The object cache, best in the fastest RAM there is. Any length: what finds no slot is
    /// served from slow memory, and the picture is the same.
    pub slots: &'m mut [SlotOf<P>],
    /// This renderer's column of links, one for each object of the scene; in slow memory.
    pub links: &'m mut [Link],
    /// The depth of one line, a cell a pixel; in fast RAM. Without depth a cell has no size, and
    /// `[(); 8192]` will do.
    pub depth: &'m mut [CellOf<P>],
}

/// A line renderer has less memory than the scene needs. Nothing was drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum RendererError {
    /// Fewer links than the scene has objects.
    Links {
        /// Objects of the scene.
        needed: usize,
        /// Links of the renderer.
        have: usize,
    },
    /// Fewer depth cells than a line has pixels.
    Depth {
        /// Pixels a line.
        needed: usize,
        /// Depth cells of the renderer.
        have: usize,
    },
    /// The pixels lent for a line are not as many as a line has.
    Pixels {
        /// Pixels a line.
        needed: usize,
        /// Pixels lent.
        have: usize,
    },
    /// The line is not among those the scene was begun with.
    Line {
        /// The line.
        line: u16,
    },
}

impl core::fmt::Display for RendererError {
    fn fmt(&self, f: &mut core::fmt::Formatter<'_>) -> core::fmt::Result {
        match self {
            Self::Links { needed, have } => {
                write!(
                    f,
                    "renderer: {needed} objects need as many links, there are {have}"
                )
            }
            Self::Depth { needed, have } => {
                write!(
                    f,
                    "renderer: a line of {needed} pixels has {have} depth cells"
                )
            }
            Self::Pixels { needed, have } => {
                write!(f, "renderer: a line of {needed} pixels was lent {have}")
            }
            Self::Line { line } => write!(f, "renderer: line {line} is not part of the scene"),
        }
    }
}

impl core::error::Error for RendererError {}

/// Draws lines of a scene: owns a cache, a link column and the depth of a line, and shares the
/// scene with any number of others.
pub struct LineRenderer<'m, P: Pipeline> {
    list: ActiveList<'m, DrawableOf<P>>,
    depth: &'m mut [CellOf<P>],
    /// What was drawn last.
    last: Option<Last>,
    /// Lines from one drawn line to the next.
    step: u16,
    counter: P::Counter,
}

/// The line that was drawn last.
#[derive(Clone, Copy)]
struct Last {
    /// The line, in guard space.
    line: i32,
    /// The first line for which the list still holds all that is active.
    next: i32,
    /// Which content of which scene it was.
    content: (usize, u32),
}

impl<L> Member for Drawable<L> {
    #[inline(always)]
    fn end(&self) -> i32 {
        i32::from(Drawable::end(self))
    }

    #[inline(always)]
    fn stale(&self, last: i32, line: i32) -> bool {
        Drawable::stale(self, last, line)
    }
}

impl<'m, P: Pipeline> LineRenderer<'m, P> {
    /// A renderer that draws every line.
    #[must_use]
    pub fn new(memory: LineMemory<'m, P>) -> Self {
        Self {
            list: ActiveList::new(memory.slots, memory.links),
            depth: memory.depth,
            last: None,
            step: 1,
            counter: P::Counter::default(),
        }
    }

    /// An empty slot, to fill a cache with.
    #[must_use]
    pub const fn empty_slot() -> SlotOf<P> {
        SlotOf::<P>::new(Drawable::EMPTY)
    }

    /// How many lines apart those are that this renderer draws, at least 1: objects that end
    /// before its next line leave the cache at once. Any value gives the same picture.
    pub fn set_step(&mut self, step: u16) {
        self.step = step.max(1);
    }

    /// Whether the memory suffices for `scene`.
    ///
    /// # Errors
    /// What is too short.
    pub fn check(&self, scene: &Scene<'_, P>) -> Result<(), RendererError> {
        let needed = scene.pass_one().objects as usize;
        let have = self.list.room();
        if have < needed {
            return Err(RendererError::Links { needed, have });
        }
        let needed = usize::from(scene.screen().width());
        let have = self.depth.len();
        if have < needed {
            return Err(RendererError::Depth { needed, have });
        }
        Ok(())
    }

    /// Forgets the lines drawn so far and starts counting anew.
    ///
    /// Needed before the first line of a `Scene` that was made anew in the memory of the last
    /// one; a change of scene, camera or content is noticed without.
    pub fn restart(&mut self) {
        self.last = None;
        self.counter = P::Counter::default();
    }

    /// Draws a line of the picture into `pixels`, over what is there; `false` when nothing is
    /// active on it.
    ///
    /// Any line can be drawn alone, in any order, with the same bits (K5); going down is fast,
    /// going back starts anew from the top.
    ///
    /// # Errors
    /// When the memory does not suffice for the scene, or the line is not of the scene.
    pub fn draw_line(
        &mut self,
        scene: &Scene<'_, P>,
        line: u16,
        pixels: &mut [WordOf<P>],
    ) -> Result<bool, RendererError> {
        let screen = scene.screen();
        let width = usize::from(screen.width());
        self.check(scene)?;
        if pixels.len() != width {
            return Err(RendererError::Pixels {
                needed: width,
                have: pixels.len(),
            });
        }
        if !scene.lines().contains(&line) {
            return Err(RendererError::Line { line });
        }
        let (left, top) = (screen.left(), screen.top());
        let now = top + i32::from(line);
        let content = scene.content();
        let next = now + i32::from(self.step);
        let last = match self.last {
            Some(last) if last.next <= now && last.content == content => last.line,
            _ => {
                self.list.clear();
                top + i32::from(scene.lines().start) - 1
            }
        };
        for bucket in last + 1..=now {
            self.list.admit(scene.bucket(bucket));
        }
        self.last = Some(Last {
            line: now,
            next,
            content,
        });
        if self.list.is_empty() {
            return Ok(false);
        }
        let depth = &mut *self.depth;
        if P::Depth::TESTS {
            depth[..width].fill(P::Depth::FARTHEST);
        }
        let counter = &mut self.counter;
        self.list.walk(
            (last, now, next),
            |object| scene.set_up(object, now),
            |object, drawable| {
                let Some(span) = Span::clipped(now, drawable.columns(now), left, width) else {
                    return;
                };
                let pixels = &mut pixels[span.start..span.end];
                let depth = &mut depth[span.start..span.end];
                draw_span::<P>(scene, object, drawable, span, (pixels, depth), counter);
            },
        );
        Ok(true)
    }

    /// How the cache has done in the current frame (C8).
    #[must_use]
    pub fn cache_counts(&self) -> CacheCounts {
        self.list.counts
    }

    /// What has been counted along spans since [`take_span_counts`](Self::take_span_counts).
    pub fn take_span_counts(&mut self) -> SpanCounts {
        core::mem::take(&mut self.counter).counts()
    }
}
