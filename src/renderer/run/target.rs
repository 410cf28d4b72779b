//! Meshes of a list into a scene: with the texture and the finish that its state asks for.

use crate::event::{Event, EventSink, Notice};
use crate::geometry::texturing::{Quality, Skin};
use crate::geometry::{Assembled, Finish, LightingModel, Shading};
use crate::list::{Bound, OverlaySlot, TextureSlot};
use crate::pipeline::{Pipeline, SkinOf};
use crate::player::{Gathered, ListCoordinate, Places};
use crate::renderer::error::DrawError;
use crate::renderer::instance::Instance;
use crate::renderer::scene::Scene;

/// Memory in which a list's vertices are unpacked, lent by the application.
///
/// The first three go together: as many vertices can be unpacked as the shortest of those that a
/// block needs has. 4 are the least; what a list's largest table needs is in its HEAD.
#[derive(Default)]
pub struct ListMemory<'m, C = i16> {
    /// Places, 6 bytes each, or 12.
    pub positions: &'m mut [[C; 3]],
    /// Normals, 6 bytes each.
    pub normals: &'m mut [[i16; 3]],
    /// Colours, 3 bytes each.
    pub colours: &'m mut [[u8; 3]],
    /// Indices of faces that are drawn together, at least 4; 3 a triangle. Each time they are
    /// full, the vertices of a table are transformed once more.
    pub indices: &'m mut [u16],
    /// Texture places, 8 bytes each, as many as positions; none where nothing is textured.
    pub places: &'m mut [[i32; 2]],
    /// Names of textures: one for each number of a texture and of a palette, and one for each
    /// pair of both that is drawn with; none where nothing is textured. The scene's
    /// [`ListTextures`](crate::pipeline::texture::ListTextures) have the same ones.
    pub textures: &'m [TextureSlot],
    /// One for each overlay of a frame; none where there are none. The
    /// [`ListOverlays`](crate::overlay::ListOverlays) that paint them have the same ones.
    pub overlays: &'m [OverlaySlot],
}

/// What was drawn of a list, since it was started.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub(super) struct DrawCounts {
    pub(super) draws: u32,
    pub(super) vertices: u32,
    pub(super) triangles: u32,
    pub(super) dropped: u32,
}

/// Where meshes go and who is told.
pub(super) struct Target<'t, 'm, P: Pipeline, E, M> {
    pub(super) scene: &'t mut Scene<'m, P>,
    pub(super) instance: Instance<M>,
    /// The surface's, 255 for 1.
    pub(super) opacity: u8,
    /// The texture, where there is one.
    pub(super) texture: Option<(Bound, Quality)>,
    pub(super) events: &'t mut E,
    pub(super) counts: &'t mut DrawCounts,
    pub(super) offset: u32,
}

impl<P: Pipeline, E: EventSink, M: LightingModel> Target<'_, '_, P, E, M> {
    /// The sides of the texture.
    pub(super) fn sides(&self) -> Option<[u8; 2]> {
        self.texture.map(|(bound, _)| bound.log_sides)
    }

    /// Draws a mesh that was gathered.
    pub(super) fn draw<C: ListCoordinate>(&mut self, gathered: &Gathered<'_, C>) {
        let places = match gathered.places {
            Places::Texels(places) => places,
            Places::None => &[],
            Places::Lacking => {
                self.notice(Event::Full, 0);
                &[]
            }
        };
        let skin = self.skin(places, gathered.prsp);
        let mesh = &gathered.mesh;
        let before = self.scene.pass_one().untextured;
        let done = match gathered.points {
            Some(size) => self.scene.draw_points(mesh, size, skin, &self.instance),
            None => (self.scene).draw_known((mesh, gathered.below), skin, &self.instance),
        };
        self.count(mesh.positions.len() as u32, done);
        self.tell_untextured(before);
    }

    /// Counts what a call has done with some vertices, and tells what was lost.
    pub(super) fn count(&mut self, vertices: u32, done: Result<Assembled, DrawError>) {
        self.counts.draws += 1;
        self.counts.vertices += vertices;
        match done {
            Ok(done) => {
                self.counts.triangles += done.triangles;
                if done.clipped > 0 {
                    self.notice(Event::Clipped, done.clipped);
                }
            }
            Err(DrawError::Full(dropped)) => {
                self.counts.dropped += dropped.triangles;
                self.notice(Event::Full, dropped.triangles);
            }
            // Lengths and indices were checked when they were gathered.
            Err(DrawError::Mesh(_)) => self.notice(Event::Malformed, 0),
        }
    }

    /// The texture with these places on it, that are to be exact or not, and how it is composited.
    pub(super) fn skin<'p>(&self, places: &'p [[i32; 2]], prsp: bool) -> SkinOf<'p, P> {
        let skin = match self.texture {
            Some((bound, quality)) if P::Shading::TEXTURED => Skin {
                places,
                texture: bound.index,
                quality: if prsp { quality } else { Quality::Fast },
            }
            .into(),
            _ => SkinOf::<P>::default(),
        };
        if P::Shading::COMPOSITED && self.opacity != 255 {
            return P::Shading::finished(skin, Finish::filtered(self.opacity));
        }
        skin
    }

    /// Tells of triangles that have no texture since there were so many.
    pub(super) fn tell_untextured(&mut self, before: u32) {
        let more = self.scene.pass_one().untextured - before;
        if more > 0 {
            self.notice(Event::Untextured, more);
        }
    }

    #[cold]
    pub(super) fn notice(&mut self, event: Event, value: u32) {
        self.events.notice(Notice {
            event,
            offset: self.offset,
            value,
        });
    }
}
