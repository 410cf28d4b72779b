//! A frame's scene: what pass one leaves for pass two (K1, S3).
//!
//! | file | there |
//! |---|---|
//! | `record` | vertices and triangles as they lie in slow memory |
//! | `draw` | what a draw call says, and what of it is kept: once a call, never once a triangle |
//! | `project` | vertices to the screen |
//! | `assemble` | meshes into triangles under their first lines |
//! | `meshlets` | meshes in parts, of which what is turned away is left out |
//! | `own` | triangles with vertices of their own |
//! | `check` | what is wrong with a draw call |
//! | `pass` | a draw call while its faces are filed: its view and its lights |
//! | `master` | what a supervisor has switched off |
//! | `lights` | several lights, whose code only a call that has them brings in |
//! | `flat` | faces of one colour each |
//! | `cut` | triangles that cross a plane |
//! | `screen` | triangles and points that are made on the screen |
//! | `texgen` | texture places from normals |
//! | `texture`, `sampling`, `budget` | textures as values, how their texels are taken, and how exact they are drawn |
//! | `compressed` | texels of 4 bits, in blocks that are decoded |
//! | `form`, `computed` | texels that lie in memory, and those that somebody is asked for |
//! | `block`, `block_cache` | texels in blocks of slow memory, and a small cache of them |
//! | `scissor`, `depth`, `blend` | what else a draw call does to its pixels, as values |
//! | `shadow` | shadow volumes, and surfaces that are drawn again |
//! | `alpha` | alpha of vertices and of texels, which a blend may ask for |
//! | `late` | what is not drawn among what is opaque |
//! | `read` | what was filed, for other readers than pass two |
//! | `error` | what can go wrong |
//!
//! Triangles of a draw call lie one behind the other, so a triangle's draw state is found by its number.

mod alpha;
mod assemble;
mod blend;
mod block;
mod block_cache;
mod budget;
mod check;
mod compressed;
mod computed;
mod cut;
mod depth;
mod draw;
mod error;
mod flat;
mod form;
mod late;
mod lights;
mod master;
mod meshlets;
mod own;
mod pass;
mod project;
mod read;
mod record;
mod sampling;
mod scissor;
mod screen;
mod shadow;
#[cfg(test)]
mod tests;
mod texgen;
mod texture;

pub use crate::geometry::{ShadowEdge, ShadowLight, ShadowMemory, ShadowRoom};
pub use alpha::MaskTexel;
pub(crate) use alpha::{Alphas, PixelAlpha};
pub(crate) use assemble::Moved;
pub use blend::{Blend, BlendMode, Factor};
pub use block::Blocked;
pub use block_cache::{BlockCache, CacheError, CacheReads, CacheWord};
pub use budget::Budget;
pub use compressed::Compressed;
pub use computed::{Checker, Gradient, TexelWay, Texels};
pub use depth::{DepthFunction, DepthTest};
pub use draw::{Application, Draw, DrawState, Shading, Skin};
pub(crate) use draw::{Draws, Holes};
pub use error::{BeginError, DrawError, Full};
pub(crate) use form::{Bent, Form, Square};
pub(crate) use late::Role;
pub use lights::Lights;
pub use master::Master;
pub(crate) use pass::WordOfNormal;
pub use read::{FiledCorner, FiledTriangle};
pub(crate) use record::{NONE, ORIGIN, Stretch, first_line};
pub use record::{Object, TexturePlace, Vertex};
pub use sampling::Sampling;
pub(crate) use sampling::{Method, Place, SampledSpan, Words};
pub use scissor::Scissor;
pub use screen::{ScreenCorner, ScreenVertex};
pub use shadow::Shadow;
pub use texgen::TexGen;
pub(crate) use texture::half;
pub use texture::{Texture, TextureError, Wrap};

use crate::arena::Arena;
use crate::event::{Event, EventSet};
use crate::geometry::{Camera, Scale, Screen};
use crate::link::Link;
use core::marker::PhantomData;
use core::ops::Range;
use core::sync::atomic::{AtomicU32, Ordering::Relaxed};

/// The memory of a scene, lent by the application; best in large, slow RAM.
///
/// All records have a `const EMPTY`, so that statics in a linker section can be lent.
#[derive(Debug)]
pub struct Memory<'m, 't> {
    /// Vertices on the screen, 12 bytes each; at most 65,536 are used.
    pub vertices: &'m mut [Vertex],
    /// Texture places of vertices, as many as there are vertices; empty for looks without textures.
    pub places: &'m mut [TexturePlace],
    /// Triangles, 8 bytes each; at most 61,440 are used.
    pub objects: &'m mut [Object],
    /// One for each line of the picture.
    pub bins: &'m mut [u16],
    /// One for each draw call.
    pub draws: &'m mut [DrawState<'t>],
}

/// What pass one has done since the scene was begun (M4).
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
#[cfg_attr(feature = "defmt", derive(defmt::Format))]
pub struct Assembled {
    /// Triangles submitted.
    pub triangles: u32,
    /// Triangles that cannot be seen, and never cost anything again.
    pub culled: u32,
    /// Triangles that crossed a near, far or guard plane.
    pub clipped: u32,
    /// Triangles that found no room.
    pub dropped: u32,
    /// Pieces of triangles that stretch over more than 4,096 texels, and are drawn without their texture.
    pub untextured: u32,
    /// Meshes that [`draw_within`](Scene::draw_within) has not looked at. Their triangles are among the culled.
    pub meshes_skipped: u32,
    /// Triangles of these meshes.
    pub triangles_skipped: u32,
    /// Vertices of these meshes: neither transformed nor lit.
    pub vertices_skipped: u32,
}

impl Assembled {
    /// The events of pass one (H14).
    #[must_use]
    pub fn events(&self) -> EventSet {
        EventSet::of([
            (Event::Clipped, self.clipped > 0),
            (Event::Full, self.dropped > 0),
            (Event::Untextured, self.untextured > 0),
        ])
    }
}

/// What a renderer's cache has to agree with: where triangles lie, and how often they have changed.
pub(crate) type Content = (usize, u32);

/// The widest and the highest picture, in pixels; larger ones are parts, each a scene by a [shifted](Camera::shifted)
/// camera.
pub const LARGEST: u16 = 1016;

/// A scene in memory: shared by any number of renderers, read-only while they draw.
///
/// `L` is the look of all that is in it.
#[derive(Debug)]
pub struct Scene<'m, 't, L> {
    pub(crate) screen: Screen,
    pub(crate) camera: Option<Camera>,
    pub(crate) vertices: Arena<'m, Vertex>,
    pub(crate) places: &'m mut [TexturePlace],
    pub(crate) objects: Arena<'m, Object>,
    pub(crate) bins: &'m mut [u16],
    pub(crate) draws: Arena<'m, DrawState<'t>>,
    pub(crate) lines: Range<u16>,
    pub(crate) scale: Scale,
    /// Whether a draw call has values that few have.
    pub(crate) has_values: bool,
    /// Whether one has values by which its lines are drawn.
    pub(crate) is_ruled: bool,
    /// Whether a draw call has a priority.
    pub(crate) is_ranked: bool,
    /// Whether a draw call has to do with shadows.
    pub(crate) has_shadows: bool,
    /// What draw calls have to do without.
    pub(crate) master: Master,
    pub(crate) assembled: Assembled,
    /// Counts changes, so that a renderer notices them.
    pub(crate) generation: u32,
    look: PhantomData<L>,
}

/// The number of a change among those of all scenes, so that none is taken for another that had the same memory before.
fn next_change() -> u32 {
    static CHANGES: AtomicU32 = AtomicU32::new(0);
    let number = CHANGES.load(Relaxed).wrapping_add(1);
    CHANGES.store(number, Relaxed);
    number
}

impl<'m, 't, L> Scene<'m, 't, L> {
    /// [`new`](Scene::new), for pixels of these steps.
    pub(crate) fn with_scale(screen: Screen, memory: Memory<'m, 't>, scale: Scale) -> Self {
        // As many as links can lead to.
        let most = memory.objects.len().min(usize::from(Link::CACHED));
        Self {
            screen,
            camera: None,
            vertices: Arena::new(memory.vertices),
            places: memory.places,
            objects: Arena::new(memory.objects.get_mut(..most).unwrap_or_default()),
            bins: memory.bins,
            draws: Arena::new(memory.draws),
            lines: 0..0,
            scale,
            has_values: false,
            is_ruled: false,
            is_ranked: false,
            has_shadows: false,
            master: Master::ALL,
            assembled: Assembled::default(),
            generation: 0,
            look: PhantomData,
        }
    }

    /// What draw calls have to do without from now on; depth, while lines are drawn, by the last that was set (H13).
    pub fn set_master(&mut self, master: Master) {
        self.master = master;
        self.generation = next_change();
    }

    /// Forgets what was drawn, and draws all lines from now on as `camera` sees them.
    ///
    /// # Errors
    /// When the picture has more than [`LARGEST`] columns or lines, or more lines than there are bins.
    pub fn begin(&mut self, camera: &Camera) -> Result<(), BeginError> {
        self.begin_lines(camera, 0..self.screen.height())
    }

    /// The same for a band of lines alone (H18).
    ///
    /// # Errors
    /// As [`begin`](Scene::begin), and when the lines are not of the picture.
    pub fn begin_lines(&mut self, camera: &Camera, lines: Range<u16>) -> Result<(), BeginError> {
        let (width, height) = (self.screen.width(), self.screen.height());
        if width > LARGEST || height > LARGEST {
            return Err(BeginError::Size { width, height });
        }
        let Range { start, end } = lines;
        if start >= end || end > height {
            return Err(BeginError::Lines { start, end, height });
        }
        let (needed, have) = (end - start, self.bins.len());
        if have < usize::from(needed) {
            return Err(BeginError::Bins { needed, have });
        }
        // Behind the last line too: who looks ahead finds nothing there.
        self.bins.fill(NONE);
        self.vertices.clear();
        self.objects.clear();
        self.draws.clear();
        self.camera = Some(*camera);
        self.lines = start..end;
        self.has_values = false;
        self.is_ruled = false;
        self.is_ranked = false;
        self.has_shadows = false;
        self.assembled = Assembled::default();
        self.generation = next_change();
        Ok(())
    }

    /// The picture's size.
    #[must_use]
    pub fn screen(&self) -> Screen {
        self.screen
    }

    /// The lines that are drawn.
    #[must_use]
    pub fn lines(&self) -> Range<u16> {
        self.lines.clone()
    }

    /// What pass one has done.
    #[must_use]
    pub fn assembled(&self) -> Assembled {
        self.assembled
    }

    /// What a renderer that goes on from line to line has to find again.
    pub(crate) fn content(&self) -> Content {
        let place = self.objects.as_slice().as_ptr().addr();
        (place, self.generation)
    }

    /// The first line from `line` on that a triangle begins on; the line after the last where none does.
    pub(crate) fn begins_from(&self, line: u16) -> u16 {
        let Range { start, end } = self.lines;
        let first = line.max(start);
        let heads = self.bins.iter().skip(usize::from(first - start));
        let mut lines = (first..end).zip(heads);
        let begins = lines.find(|(_, head)| **head != NONE);
        begins.map_or(end, |(line, _)| line)
    }

    /// A line from which on no triangle is active, by the lowest vertex.
    pub(crate) fn ends_by(&self) -> u16 {
        let places = self.vertices.as_slice().iter().map(|v| v.place);
        let lowest = places
            .filter(|&place| place != Vertex::OUTSIDE)
            .max()
            .map_or(0, first_line);
        let end = (lowest - ORIGIN).min(self.lines.end.into());
        end.max(self.lines.start.into()) as u16
    }

    /// Counts the triangles from an object on that stretch too far over their texture.
    #[inline(never)]
    fn count_untextured(&mut self, first: usize) {
        let places = &*self.places;
        let place = |i: u16| places.get(usize::from(i)).copied().unwrap_or_default();
        let stretches =
            |object: &&Object| Stretch::of(&object.corner.map(|i| place(i).texel())).is_none();
        let objects = self.objects.as_slice().get(first..).unwrap_or_default();
        self.assembled.untextured += objects.iter().filter(stretches).count() as u32;
    }

    /// How many triangles are in memory.
    #[must_use]
    pub fn objects(&self) -> usize {
        self.objects.len()
    }

    /// How many vertices are in memory.
    #[must_use]
    pub fn vertices(&self) -> usize {
        self.vertices.len()
    }
}
