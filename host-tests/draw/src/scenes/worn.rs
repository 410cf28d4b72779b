//! The draw calls of a scene, and their order.
//!
//! Without shadows they come as the file has them, one source after the other. With shadows first comes what is opaque, then the shadow volumes of
//! what throws one and the same surfaces again as they are without that light (K9); last what is blended, which throws no
//! shadow and gets none.

use super::light::{AtPixels, SceneLights, Side, directional};
use super::{Placed, SceneParts};
use crate::parts::{Job, Tile, draw_parts};
use crate::prepared::Chunk;
use crate::scene_file::{Item, ShadeKind};
use crate::{DrawFailure, Drawn};
use scanbeam::look::Look;
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::{
    Application, DrawError, Lights, Scissor, Shading, Shadow, ShadowLight, Skin, TexGen, Texture,
};
use scanbeam::{Draw, Mesh, Scene};

/// The number of the light that throws shadows.
const LIGHT: u8 = 0;

/// What is drawn in one step: something of an object, by its number.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) struct Step {
    pub(crate) object: usize,
    pub(crate) what: What,
}

/// What of an object is drawn.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum What {
    /// A part of it, in the light.
    Part(usize),
    /// A part again, as it is in the shadow.
    InShadow(usize),
    /// A shadow volume.
    Volume(usize),
}

impl Step {
    /// Where it is, for the light that throws shadows.
    pub(crate) fn side(&self) -> Side {
        match self.what {
            What::InShadow(_) => Side::Dark,
            What::Part(_) | What::Volume(_) => Side::Lit,
        }
    }
}

impl SceneParts<'_> {
    /// All that is drawn, in order.
    pub(crate) fn steps(&self) -> Vec<Step> {
        let of = |is: &dyn Fn(&Placed<'_>) -> bool,
                  count: &dyn Fn(&Placed<'_>) -> usize,
                  what: fn(usize) -> What| {
            let parts = self.parts.iter().enumerate().filter(|(_, part)| is(part));
            let steps = parts.flat_map(|(object, part)| {
                let numbers = 0..count(part);
                numbers.map(move |number| Step {
                    object,
                    what: what(number),
                })
            });
            steps.collect::<Vec<_>>()
        };
        let chunks = |part: &Placed<'_>| part.prepared.chunks.len();
        if !self.scene.has_shadows() {
            let mut steps = of(&|_| true, &chunks, What::Part);
            // One source after the other, each in order.
            steps.sort_by_key(|step| self.parts[step.object].item.source());
            return steps;
        }
        let is_opaque = |part: &Placed<'_>| part.item.blend.is_none();
        // What is not lit is the same in the shadow.
        let darkens =
            |part: &Placed<'_>| is_opaque(part) && part.item.shade != Some(ShadeKind::None);
        [
            of(&is_opaque, &chunks, What::Part),
            of(&|_| true, &|part| part.shadows.len(), What::Volume),
            of(&darkens, &chunks, What::InShadow),
            of(&|part| !is_opaque(part), &chunks, What::Part),
        ]
        .concat()
    }

    /// The light that throws shadows, by the number of an object that does; none of others.
    pub(crate) fn shadow_lights(&self) -> Result<Vec<Option<ShadowLight>>, DrawFailure> {
        let Some(lamp) = self.scene.lights.iter().find(|lamp| lamp.shadows) else {
            return Ok(vec![None; self.parts.len()]);
        };
        let light = directional(lamp)?;
        let opaque = self.parts.iter().filter(|part| part.item.blend.is_none());
        let of = |(number, part): (usize, &Placed<'_>)| {
            if part.shadows.is_empty() {
                return Ok(None);
            }
            let reach = part.reach(opaque.clone().map(|part| &part.ball));
            let reach =
                reach.map_err(|why| DrawFailure::View(format!("object {number}: {why}")))?;
            Ok(Some(ShadowLight {
                light: LIGHT,
                direction: light.direction,
                reach,
            }))
        };
        self.parts.iter().enumerate().map(of).collect()
    }
}

/// The window of an object, in pixels of a tile.
fn scissor(item: &Item, tile: &Tile) -> Option<Scissor> {
    item.window.map(|cut| {
        let within = |axis: usize, at: u32| {
            let at = at.saturating_sub(tile.first[axis]);
            at.min(u16::MAX.into()) as u16
        };
        let range = |axis: usize, first: u16, count: u16| {
            let end = u32::from(first) + u32::from(count);
            within(axis, first.into())..within(axis, end)
        };
        let (columns, lines) = (range(0, cut.left, cut.width), range(1, cut.top, cut.height));
        match cut.outside {
            true => Scissor::outside(columns, lines),
            false => Scissor::inside(columns, lines),
        }
    })
}

/// What the parts of a scene have in common.
pub(super) struct Worn<'s, 't> {
    pub(super) parts: &'s SceneParts<'s>,
    /// The textures of each object.
    pub(super) textures: &'t [&'t [Texture<'t>]],
    /// Those that fall on corners.
    pub(super) lights: Option<&'s SceneLights>,
    pub(super) at_pixels: &'t AtPixels,
    pub(super) dither: bool,
}

impl<'t> Worn<'_, 't> {
    /// Draws all parts of all objects.
    pub(super) fn draw_all<L, F>(&self, job: &Job) -> Result<Drawn, DrawFailure>
    where
        L: Look<Pixel = F, Planes: Send> + Sync,
        F: PixelFormat + Sync,
    {
        let steps = self.parts.steps();
        let shadows = self.parts.shadow_lights()?;
        // Volumes, and what is drawn again, are none of the scene's triangles.
        let is_first = |step: &Step| matches!(step.what, What::Part(_));
        let counted: Vec<_> = (steps.iter())
            .map(|step| self.parts.chunk(step).filter(|_| is_first(step)))
            .collect();
        draw_parts::<L, F>(job, &counted, &mut |scene, tile, number, instead| {
            let step = &steps[number];
            let part = &self.parts.parts[step.object];
            if let (What::Volume(mesh), Some(light)) = (step.what, &shadows[step.object]) {
                return part.shadows[mesh].draw(scene, &part.model, light);
            }
            match instead.or(self.parts.chunk(step)) {
                Some(chunk) => self.draw(scene, tile, (step.object, chunk, step.side())),
                None => Ok(()),
            }
        })
    }

    /// Draws a part of an object, by its number, in the light or as it is in the shadow.
    fn draw<L: Look>(
        &self,
        scene: &mut Scene<'_, 't, L>,
        tile: &Tile,
        (number, chunk, side): (usize, &Chunk, Side),
    ) -> Result<(), DrawError> {
        let part = &self.parts.parts[number];
        let item = part.item;
        let textures = self.textures.get(number);
        let texture = chunk
            .texture
            .and_then(|texture| textures?.get(usize::from(texture)));
        let lights = self.lights.and_then(|lights| lights.on(item, side));
        let mut mesh = chunk.mesh();
        if self.parts.scene.phong {
            mesh = Mesh {
                colours: &[],
                ..mesh
            };
        }
        let is_dark = side == Side::Dark;
        scene.draw(&Draw {
            model: part.model,
            cull: item.cull(),
            colour: part.colour(chunk.look),
            lights: lights.as_ref().map(|lights| lights as &dyn Lights),
            lamps: self.at_pixels.on(tile.number, number, side),
            shading: shading(item),
            texture: texture.map(|texture| Skin {
                texture,
                places: &chunk.places,
                budget: part.budget(),
            }),
            texgen: item.reflection.unwrap_or(false).then_some(TexGen::SPHERE),
            application: (item.application).map_or(Application::Product, Application::from),
            scissor: scissor(item, tile),
            depth: side.depth(item),
            blend: item.blend(),
            shadow: is_dark.then_some(Shadow::Shadowed(LIGHT)),
            dither: self.dither,
            priority: self.parts.scene.rank(item),
            ..Draw::new(mesh)
        })
    }
}

fn shading(item: &Item) -> Shading {
    match item.shade {
        Some(ShadeKind::Flat) => Shading::Flat,
        _ => Shading::Smooth,
    }
}
