//! The draw call that blocks of state change.

use super::gather::{Gathered, Out};
use super::lights;
use super::shadows::Casts;
use super::textures::Listed;
use super::{LightRoom, PlayerSettings, RunCounts};
use crate::event::{Event, Notice};
use crate::geometry::{Affine, Coordinate, Cull, Eye, Light};
use crate::list::{Header, Lent, Material, Missing, Place, Reason, Walker, Window, Words};
use crate::look::{Look, check_blend};
use crate::scene::{
    Assembled, Blend, Budget, Draw, DrawError, Lights, Scene, Scissor, ScreenCorner, Skin,
};

/// What is drawn with next.
#[derive(Clone, Copy, Debug)]
pub(super) struct State<'m, 't> {
    /// All but the mesh and the texture.
    pub(super) draw: Draw<'m, 't>,
    /// The list's, once it has one.
    pub(super) matrix: Option<Affine>,
    /// What falls on what is lit.
    pub(super) light: Option<Light>,
    /// Several lights of the settings.
    pub(super) lights: Option<&'m dyn Lights>,
    /// The blend of what is opaque.
    blend: Option<Blend>,
    pub(super) material: Material,
    /// Pixels each way that a point has.
    pub(super) point_size: u8,
    /// The texture that the material names, once something is drawn with it.
    pub(super) texture: Option<Listed<'t>>,
    /// The texture is to be found anew.
    pub(super) is_stale: bool,
    /// From where vertices are seen, once that was asked for; none where normals do not tell.
    pub(super) eye: Option<Option<Eye>>,
}

impl<'m, 't> State<'m, 't> {
    /// What the settings begin with.
    pub(super) fn new(settings: &PlayerSettings<'m, 't>) -> Self {
        let draw = settings.draw;
        let material = Material {
            diffuse: draw.colour,
            two_sided: draw.cull == Cull::None,
            ..Material::default()
        };
        let mut state = Self {
            draw,
            matrix: None,
            light: draw.light,
            lights: draw.lights,
            blend: draw.blend,
            material,
            point_size: 1,
            texture: None,
            is_stale: false,
            eye: None,
        };
        state.cut(settings, None);
        state
    }

    /// The list's matrix, in the world of the settings.
    pub(super) fn place(&mut self, matrix: Option<Affine>, settings: &PlayerSettings<'_, '_>) {
        let world = &settings.draw.model;
        self.draw.model = matrix.map_or(*world, |matrix| matrix.then(world));
        (self.matrix, self.eye) = (matrix, None);
    }

    /// The light from now on.
    pub(super) fn light(&mut self, light: Option<Light>) {
        (self.light, self.lights) = (light, None);
        self.shine();
    }

    /// The surface from now on.
    pub(super) fn material(&mut self, material: Material) {
        self.material = material;
        self.is_stale = true;
        self.draw.colour = material.diffuse;
        self.draw.cull = match material.two_sided {
            true => Cull::None,
            false => Cull::Back,
        };
        self.draw.blend = match material.opacity {
            255 => self.blend,
            opacity => Some(Blend::filter(opacity)),
        };
        self.shine();
    }

    fn shine(&mut self) {
        self.draw.light = self.light.filter(|_| !self.material.unlit);
        self.draw.lights = self.lights.filter(|_| !self.material.unlit);
    }

    /// The scissor from now on: the window that was asked for, or else what is granted.
    pub(super) fn cut(&mut self, settings: &PlayerSettings<'_, '_>, asked: Option<Window>) {
        let window = asked.or(settings.window);
        let scissor = window.map(|w| Scissor::inside(w.left..w.right, w.top..w.bottom));
        self.draw.scissor = scissor.or(settings.draw.scissor);
    }
}

/// Alphas, if one of them is not 255.
fn seen(alphas: &[u8]) -> &[u8] {
    match alphas.iter().all(|alpha| *alpha == 255) {
        true => &[],
        false => alphas,
    }
}

/// Why a list stops at a call that its scene refuses.
#[cold]
fn refused(error: DrawError) -> Reason {
    match error {
        DrawError::Shadow(_) => Reason::Lent(Lent::Shadows),
        DrawError::ShadowLight | DrawError::ShadowRanked | DrawError::ShadowFlat => {
            Reason::Missing(Missing::Shadows)
        }
        DrawError::Indices => Reason::Missing(Missing::Blends),
        DrawError::Light => Reason::Missing(Missing::Lamps),
        // Meshes and textures were looked at when they were gathered.
        _ => Reason::NotBegun,
    }
}

/// Who draws what is gathered, and counts it.
pub(super) struct Drawer<'d, 's, 'm, 't, L, C> {
    /// None where the list is only looked at.
    pub(super) scene: Option<&'d mut Scene<'s, 't, L>>,
    pub(super) state: &'d State<'m, 't>,
    pub(super) settings: &'d PlayerSettings<'m, 't>,
    pub(super) walker: &'d Walker,
    pub(super) counts: &'d mut RunCounts,
    pub(super) events: &'d mut dyn FnMut(Notice),
    /// Several lights of the list.
    pub(super) lights: Option<&'d LightRoom>,
    pub(super) casts: Option<&'d mut Casts<'m, 't, L, C>>,
    pub(super) lack: Option<Reason>,
}

impl<'t, L: Look, C: Coordinate + Place> Drawer<'_, '_, '_, 't, L, C> {
    /// Draws what `gather` hands over, and what shadow it casts; what that says.
    ///
    /// # Errors
    /// What could not be drawn.
    pub(super) fn gather<R, W: Words<'t>>(
        mut self,
        words: W,
        gather: impl FnOnce(&mut Out<'_, C, W>) -> R,
    ) -> Result<R, Reason> {
        let done = gather(&mut Out {
            words,
            format: self.walker.format(),
            textured: L::TEXTURED,
            sides: self.sides(),
            point_size: self.state.point_size,
            block: self.walker.offset(),
            draw: &mut |mesh| self.draw(mesh),
        });
        self.done().map(|()| done)
    }

    /// Draws a mesh, and what shadow it casts.
    fn draw(&mut self, gathered: &Gathered<'_, C>) {
        self.lack = gathered.places.err().or(self.lack);
        let places = gathered.places.ok().flatten();
        let texture = places.and_then(|places| self.skin(places, gathered.prsp));
        let alphas = seen(gathered.alphas);
        let blend = self.blend(texture.is_some(), !alphas.is_empty());
        let Some(scene) = &mut self.scene else {
            return;
        };
        let before = scene.assembled();
        let mut done = Ok(());
        lights::fall(self.lights, &self.state.material, &mut |lights| {
            let begin = &self.state.draw;
            let draw = Draw {
                texture,
                alphas,
                blend,
                lights: lights.or(begin.lights),
                ..begin.with_mesh(gathered.mesh)
            };
            done = match gathered.points {
                Some(size) => scene.draw_points(&draw, size),
                None if gathered.partly => scene.draw_partly(&draw),
                None => scene.draw(&draw),
            };
        });
        let vertices = gathered.mesh.positions.len();
        self.count(vertices, before, done, gathered.block);
        let is_solid = blend.is_none() && !self.state.material.unlit && gathered.points.is_none();
        if let Some(casts) = self.casts.take_if(|_| is_solid) {
            (casts.cast)(self, gathered, &mut casts.memory);
            self.casts = Some(casts);
        }
    }

    /// Draws triangles that were set up beforehand, of vertices that are exact on their texture or not; so many vertices
    /// are new.
    pub(super) fn draw_long(
        &mut self,
        triangles: &[[ScreenCorner; 3]],
        alphas: &[u8],
        header: Header,
    ) {
        let texture = self.skin(&[], header.prsp).filter(|_| header.text);
        let alphas = seen(alphas);
        let blend = self.blend(header.text, !alphas.is_empty());
        let Some(scene) = &mut self.scene else {
            return;
        };
        let draw = Draw {
            alphas,
            blend,
            texture,
            ..self.state.draw
        };
        let before = scene.assembled();
        let done = scene.draw_screen(&draw, triangles);
        self.count(0, before, done, self.walker.offset());
    }

    /// The texture with these places, which are to be exact or not.
    fn skin<'p>(&self, places: &'p [[i32; 2]], prsp: bool) -> Option<Skin<'p, 't>> {
        let texture = self.state.texture?.texture;
        let budget = if prsp {
            self.settings.budget
        } else {
            Budget::FAST
        };
        Some(Skin {
            texture,
            places,
            budget,
        })
    }

    /// The blend of what has the texture or has none, and has alphas or none: numbers of a palette can have none.
    fn blend(&mut self, textured: bool, has_alphas: bool) -> Option<Blend> {
        let texture = self.state.texture.filter(|_| textured);
        let blend = self.state.draw.blend;
        let blend = match has_alphas || texture.is_some_and(|listed| listed.is_translucent) {
            true => Some(blend.map_or(Blend::ALPHA, Blend::by_alpha)),
            false => blend,
        };
        if let Err(error) = check_blend::<L>(blend) {
            self.lack = Some(refused(error));
        }
        blend
    }

    /// What could not be drawn.
    ///
    /// # Errors
    /// If there was anything.
    pub(super) fn done(&self) -> Result<(), Reason> {
        self.lack.map_or(Ok(()), Err)
    }

    /// Counts what a call has done with some vertices of the block at an offset, and tells what was lost.
    pub(super) fn count(
        &mut self,
        vertices: usize,
        before: Assembled,
        done: Result<(), DrawError>,
        block: u32,
    ) {
        let Some(scene) = &self.scene else {
            return;
        };
        let after = scene.assembled();
        let counts = &mut *self.counts;
        let triangles = after.triangles - before.triangles;
        counts.draws = counts.draws.saturating_add(1);
        counts.vertices = counts.vertices.saturating_add(vertices as u32);
        counts.triangles = counts.triangles.saturating_add(triangles);
        match done {
            Ok(()) => {}
            Err(DrawError::Full { triangles, .. }) => {
                counts.dropped = counts.dropped.saturating_add(triangles);
                self.tell(Event::Full, block, triangles);
            }
            Err(error) => self.lack = Some(refused(error)),
        }
        for (event, count) in [
            (Event::Clipped, after.clipped - before.clipped),
            (Event::Untextured, after.untextured - before.untextured),
        ] {
            if count > 0 {
                self.tell(event, block, count);
            }
        }
    }

    /// The sides of the texture, as logarithms.
    pub(super) fn sides(&self) -> Option<[u8; 2]> {
        let texture = self.state.texture?.texture;
        Some([texture.log_width() as u8, texture.log_height() as u8])
    }

    #[cold]
    fn tell(&mut self, event: Event, offset: u32, value: u32) {
        (self.events)(Notice {
            event,
            offset,
            value,
        });
    }
}
