//! What draws lines of a scene, and what it has to be lent.

use super::ahead::Fetcher;
use super::paced::Pacer;
use super::ruled::colour_dithered;
use super::slot::{Active, begun_of};
use super::spans::{Drawn, Line};
use super::tally::Counter;
use crate::active::{Cache, CacheSlot, CacheUse};
use crate::link::Link;
use crate::look::{Look, Place, WordOf};
use crate::scene::{Content, DrawState, Draws, Master, Object, Scene, TexturePlace, Vertex};
use crate::span::{Edge, Frame, Sides, Triangle};
use crate::stats::SpanCounts;
use crate::visible::Mask;
use core::fmt;

/// The object cache of a renderer: `32 WORDS` slots, best in the fastest memory there is, as a static.
///
/// About the most triangles that are on one line is what a scene wants: 64 for a model of some 2,000. With fewer
/// the picture is the same, and each triangle without a slot is read and set up again on each of its lines.
#[derive(Debug)]
pub struct FastMemory<L: Look, const WORDS: usize = 2>(pub(super) Cache<Active<L::Planes>, WORDS>);

impl<L: Look, const WORDS: usize> FastMemory<L, WORDS> {
    /// Bytes of a slot.
    pub const SLOT_BYTES: usize = size_of::<CacheSlot<Active<L::Planes>>>();

    /// Empty slots.
    #[must_use]
    pub const fn new() -> Self {
        Self(Cache::with(Active {
            sides: Sides {
                left: Edge::NONE,
                right: Edge::NONE,
            },
            planes: L::EMPTY,
            depth: [0; 3],
        }))
    }

    /// Uses no more than so many slots. The picture is the same.
    pub fn set_limit(&mut self, slots: u16) {
        self.0.set_limit(slots);
    }
}

impl<L: Look, const WORDS: usize> Default for FastMemory<L, WORDS> {
    fn default() -> Self {
        Self::new()
    }
}

/// The memory of a renderer, lent by the application.
#[derive(Debug)]
pub struct Memory<'m, L: Look, const WORDS: usize = 2> {
    /// The object cache.
    pub cache: &'m mut FastMemory<L, WORDS>,
    /// This renderer's column of links, one for each triangle of the scene; in slow memory.
    pub links: &'m mut [Link],
    /// Cells for the depth of one line, one a pixel, in fast memory. Empty: no depth is compared, and of triangles over
    /// each other the one drawn last is seen.
    pub depth: &'m mut [u32],
}

/// Why a line was not drawn. Nothing was written.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
#[non_exhaustive]
pub enum LineError {
    /// Fewer links than the scene has triangles.
    Links {
        /// Triangles of the scene.
        needed: usize,
        /// Links of the renderer.
        have: usize,
    },
    /// Fewer depth cells than a line has pixels, but some; or none for a scene with shadows.
    Depth {
        /// Pixels a line.
        needed: usize,
        /// Depth cells of the renderer.
        have: usize,
    },
    /// The scene has shadows, and there are fewer counts than a line has pixels, or none at all: only a renderer that
    /// was made by [`Renderer::with_shadows`] draws it.
    Counts {
        /// Pixels a line.
        needed: usize,
        /// Counts of the renderer.
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
    /// A draw call has a value that few have: a scissor, a depth test, a blend, holes, a dither or a shadow. Only a renderer that
    /// was made by [`Renderer::new`] draws it.
    Values,
    /// The renderer is [`paced`](Renderer::paced), and a draw call has such a value, or the renderer fetches ahead or
    /// counts too.
    Paced,
    /// The wait for the other core was given up.
    Stopped {
        /// The line that was awaited.
        line: u16,
    },
    /// The other core has given another line than was due.
    Strayed {
        /// The line that was due.
        line: u16,
    },
    /// The scene was not begun, or its begin failed.
    NotBegun,
}

impl fmt::Display for LineError {
    fn fmt(&self, f: &mut fmt::Formatter<'_>) -> fmt::Result {
        match self {
            Self::NotBegun => f.write_str("renderer: the scene was not begun"),
            Self::Links { needed, have } => write!(
                f,
                "renderer: {needed} triangles need as many links, there are {have}"
            ),
            Self::Depth { needed, have } => write!(
                f,
                "renderer: a line of {needed} pixels has {have} depth cells"
            ),
            Self::Counts { needed, have } => write!(
                f,
                "renderer: shadows on a line of {needed} pixels need as many counts, there are {have}: use Renderer::with_shadows"
            ),
            Self::Pixels { needed, have } => {
                write!(f, "renderer: a line of {needed} pixels was lent {have}")
            }
            Self::Line { line } => write!(f, "renderer: line {line} is not part of the scene"),
            Self::Values => f.write_str(
                "renderer: a draw call has a scissor, a depth test, a blend, holes, a dither or a shadow: use Renderer::new",
            ),
            Self::Paced => f.write_str(
                "renderer: a paced one draws no scissor, depth test, blend, holes, dither or shadow, and neither fetches ahead nor counts",
            ),
            Self::Stopped { line } => {
                write!(f, "renderer: the wait for line {line} was given up")
            }
            Self::Strayed { line } => {
                write!(f, "renderer: another line came in the place of line {line}")
            }
        }
    }
}

impl core::error::Error for LineError {}

/// Draws a line with values that few have over a background; `false` where no draw call on it has any.
pub(super) type DrawValues<L, const WORDS: usize> =
    fn(&mut Renderer<'_, L, WORDS>, &mut Line<'_, '_, L>, WordOf<L>) -> bool;

/// Colours a run, dithered.
pub(super) type Dither<L> = fn(Drawn<'_, <L as Look>::Planes>, Place, &View<'_>, &mut [WordOf<L>]);

/// Draws what has to do with shadows on a line whose opaque spans are drawn; of a line that is not drawn by depth, hides
/// what is never seen of it.
pub(super) type DrawShadows<L, const WORDS: usize> =
    fn(&mut Renderer<'_, L, WORDS>, &mut Line<'_, '_, L>);

/// Draws lines of a scene: owns a cache, a link column and the depth of a line, and shares the scene with any
/// number of others (K16, X6).
///
/// Any line can be drawn alone, in any order, with the same bits (K5); going down is fast, going back starts
/// anew from the top.
#[derive(Debug)]
pub struct Renderer<'m, L: Look, const WORDS: usize = 2> {
    pub(super) cache: &'m mut Cache<Active<L::Planes>, WORDS>,
    pub(super) links: &'m mut [Link],
    pub(super) depth: &'m mut [u32],
    /// What the scene had; `None` at first.
    pub(super) content: Option<Content>,
    /// The first line whose triangles have not begun.
    pub(super) next: u16,
    /// Columns that are covered on this line, that spans meet on, and on lines with values whose depth is written. All
    /// are empty between lines.
    pub(super) covered: Mask,
    pub(super) over: Mask,
    pub(super) written: Mask,
    /// Whether spans met on the last line.
    pub(super) met: bool,
    /// How many slots the last line had in order: from the nearest on, or, on one with values, from the one drawn last on.
    pub(super) nearest: u16,
    /// These, a bit each.
    pub(super) ordered: [u32; WORDS],
    /// Whether most spans of the last line met others.
    pub(super) crowded: bool,
    /// Whether the cells may not hold all that has no slot on the line drawn last, so that slots were in order of submission.
    pub(super) dense: bool,
    /// Whether the order of the last line is that of the next, if it has the same triangles.
    pub(super) lasting: bool,
    /// Whether triangles began or ended on this line.
    pub(super) changed: bool,
    pub(super) counts: CacheUse,
    /// What draws lines with values that few have. A program that names it nowhere does not have its code.
    pub(super) values: Option<DrawValues<L, WORDS>>,
    /// Likewise what dithers.
    pub(super) dither: Option<Dither<L>>,
    /// Likewise of shadows.
    pub(super) shadows: Option<DrawShadows<L, WORDS>>,
    /// Counts of shadow volumes on a line, for one light at a time.
    pub(super) volumes: &'m mut [u8],
    /// Likewise of counting spans and pixels.
    pub(super) counter: Option<Counter<L, WORDS>>,
    pub(super) spans: SpanCounts,
    /// Likewise of fetching ahead.
    pub(super) fetcher: Option<Fetcher<L, WORDS>>,
    /// Likewise of lines that cost no more than they may.
    pub(super) pacer: Option<Pacer<L, WORDS>>,
}

impl<'m, L: Look, const WORDS: usize> Renderer<'m, L, WORDS> {
    /// A renderer that has drawn nothing, for any scene without shadows.
    #[must_use]
    pub fn new(memory: Memory<'m, L, WORDS>) -> Self {
        Self {
            values: Some(|renderer, out, background| renderer.draw_values(out, background)),
            dither: Some(colour_dithered::<L>),
            ..Self::plain(memory)
        }
    }

    /// The same, for scenes with shadows too. `counts` are one byte a pixel of a line, in fast memory; all lights
    /// share them, one after the other. The depth must be lent as well.
    ///
    /// A program that names this nowhere does not have the code of shadows, and is lent no counts.
    #[must_use]
    pub fn with_shadows(memory: Memory<'m, L, WORDS>, counts: &'m mut [u8]) -> Self {
        Self {
            shadows: Some(|renderer, out| renderer.draw_shadows(out)),
            volumes: counts,
            ..Self::new(memory)
        }
    }

    /// The same, for scenes whose draw calls have none of the values that few have (a scissor, a depth test, a blend,
    /// texels with holes, a dither): the program is smaller by the code for them, some 10 KB on a Cortex-M4.
    ///
    /// It refuses other scenes with [`LineError::Values`].
    #[must_use]
    pub fn plain(memory: Memory<'m, L, WORDS>) -> Self {
        Self {
            cache: &mut memory.cache.0,
            links: memory.links,
            depth: memory.depth,
            content: None,
            next: 0,
            covered: Mask::EMPTY,
            over: Mask::EMPTY,
            written: Mask::EMPTY,
            met: false,
            nearest: 0,
            ordered: [0; WORDS],
            crowded: false,
            dense: false,
            lasting: false,
            changed: true,
            counts: CacheUse::default(),
            values: None,
            dither: None,
            shadows: None,
            volumes: &mut [],
            counter: None,
            spans: SpanCounts::default(),
            fetcher: None,
            pacer: None,
        }
    }

    /// The same, and what begins on the next line is set up ahead, up to so many bytes of slow memory a line (C4): by the
    /// frame calls after each line that they have handed on, and by [`fetch_ahead`](Renderer::fetch_ahead). That takes
    /// the time in which the display is waited for. Pictures are the same for any number.
    ///
    /// A program that names this nowhere does not have the code.
    #[must_use]
    pub fn fetching(mut self, bytes_a_line: u32) -> Self {
        self.fetcher = Some(Fetcher::new(bytes_a_line));
        self
    }

    /// The same, and spans and pixels are counted (M4): [`spans`](Renderer::spans) says how many. Lines take longer, some
    /// several times as long, and are the same.
    ///
    /// A program that names this nowhere does not have the code.
    #[must_use]
    pub fn counting(mut self) -> Self {
        self.counter = Some(Counter::new());
        self
    }

    /// Forgets the lines drawn so far and starts counting anew.
    pub fn restart(&mut self) {
        self.content = None;
        self.counts = CacheUse::default();
        self.spans = SpanCounts::default();
    }

    /// Begins a frame of a scene.
    ///
    /// # Errors
    /// Those of [`check`](Renderer::check).
    pub(super) fn begin_frame(&mut self, scene: &Scene<'_, '_, L>) -> Result<(), LineError> {
        self.check(scene)?;
        self.restart();
        Ok(())
    }

    /// What the cache has done since the renderer was made or restarted (C8).
    #[must_use]
    pub fn counts(&self) -> CacheUse {
        self.counts
    }

    /// What has happened along spans since the renderer was made or restarted (M4); all 0 unless it is
    /// [`counting`](Renderer::counting). A frame restarts it when it begins.
    #[must_use]
    pub fn spans(&self) -> SpanCounts {
        self.spans
    }

    /// Whether the renderer can draw `scene`.
    ///
    /// # Errors
    /// That the scene was not begun, what is too short, or that a draw call has values and the renderer is
    /// [`plain`](Renderer::plain), or a shadow and the renderer is not made [`with_shadows`](Renderer::with_shadows).
    pub fn check(&self, scene: &Scene<'_, '_, L>) -> Result<(), LineError> {
        if scene.has_values {
            self.values.ok_or(LineError::Values)?;
            if scene.has_shadows {
                self.check_shadows(scene.screen().width())?;
            }
        }
        if let Some(pacer) = &self.pacer {
            (pacer.check)(self, scene)?;
        }
        let (needed, have) = (scene.objects(), self.links.len());
        if have < needed {
            return Err(LineError::Links { needed, have });
        }
        if !self.depth.is_empty() {
            self.check_depth(scene.screen().width())?;
        }
        let is_begun = scene.lines.end > 0;
        is_begun.then_some(()).ok_or(LineError::NotBegun)
    }
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// Sets up what begins on the line after the last that was drawn, before the first of a scene that line, where slots
    /// are free; the bytes of slow memory that were read (C4). A call after it goes on where it stopped. A renderer that
    /// is not [`fetching`](Renderer::fetching) does nothing.
    ///
    /// # Errors
    /// Those of [`check`](Renderer::check).
    pub fn fetch_ahead(&mut self, scene: &Scene<'_, '_, L>) -> Result<u32, LineError> {
        self.check(scene)?;
        Ok(self.fetch_known(scene))
    }

    /// The same of a scene that the renderer can draw.
    #[inline(always)]
    pub(super) fn fetch_known(&mut self, scene: &Scene<'_, '_, L>) -> u32 {
        match &self.fetcher {
            Some(fetcher) => (fetcher.fetch)(self, scene),
            None => 0,
        }
    }

    /// Whether shadows can be counted on a line so wide.
    #[inline(never)]
    fn check_shadows(&self, width: u16) -> Result<(), LineError> {
        let (needed, have) = (usize::from(width), self.volumes.len());
        if have < needed {
            return Err(LineError::Counts { needed, have });
        }
        self.check_depth(width)
    }

    /// Whether there is depth for all pixels of a line so wide.
    pub(super) fn check_depth(&self, width: u16) -> Result<(), LineError> {
        let (needed, have) = (usize::from(width), self.depth.len());
        if have < needed {
            return Err(LineError::Depth { needed, have });
        }
        Ok(())
    }
}

/// A scene as pass two reads it.
#[derive(Clone, Debug)]
pub struct View<'a> {
    pub(super) vertices: &'a [Vertex],
    pub(super) places: &'a [TexturePlace],
    pub(super) objects: &'a [Object],
    pub(super) draws: Draws<'a>,
    pub(super) frame: Frame,
    pub(super) content: Content,
    /// The first line, and what begins on it and each below.
    pub(super) first: u16,
    pub(super) bins: &'a [u16],
    /// Whether a draw call has values that few have.
    pub(super) has_values: bool,
    /// Whether one has values by which its lines are drawn.
    pub(super) ruled: bool,
    /// Whether the scene is drawn by priority.
    pub(super) ranked: bool,
    /// Whether depths are compared, where there is memory for them.
    pub(super) deep: bool,
}

impl<'a> View<'a> {
    #[inline(always)]
    pub(super) fn of<L>(scene: &'a Scene<'_, '_, L>) -> Self {
        let screen = scene.screen();
        Self {
            vertices: scene.vertices.as_slice(),
            places: scene.places,
            objects: scene.objects.as_slice(),
            draws: Draws::new(scene.draws.as_slice()),
            frame: Frame {
                width: i32::from(screen.width()),
                height: i32::from(screen.height()),
            },
            content: scene.content(),
            first: scene.lines().start,
            bins: scene.bins,
            has_values: scene.has_values,
            ruled: scene.is_ruled,
            ranked: scene.is_ranked,
            deep: scene.master.has(Master::DEPTH) && !scene.is_ranked,
        }
    }

    /// The state of the draw call of an object in a slot that knows how many calls have begun up to its own.
    #[inline(never)]
    pub(super) fn state_of<T>(&self, slot: &CacheSlot<T>) -> Option<&'a DrawState<'a>> {
        match begun_of(slot).checked_sub(1) {
            Some(at) => self.draws.states.get(usize::from(at)),
            None => self.draws.state(slot.object),
        }
    }

    /// Whether an object's draw call is dithered.
    #[inline(always)]
    pub(super) fn dithers(&self, object: u16) -> bool {
        self.has_values && self.draws.state(object).is_some_and(|state| state.dithers)
    }

    /// The corners of a triangle.
    #[inline(always)]
    pub(super) fn triangle(&self, object: &'a Object) -> Option<Triangle<'a>> {
        let [a, b, c] = object.corner;
        let at = |i: u16| self.vertices.get(usize::from(i));
        Some(Triangle {
            vertex: [at(a)?, at(b)?, at(c)?],
            object,
            places: self.places,
            frame: self.frame,
        })
    }

    /// The corners of a triangle by its number.
    #[inline(always)]
    pub(super) fn triangle_of(&self, object: u16) -> Option<Triangle<'a>> {
        self.triangle(self.objects.get(usize::from(object))?)
    }
}
