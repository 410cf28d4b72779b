//! The lights of a scene, on what its objects are made of: at corners or at pixels, with the light that throws shadows and
//! without it.

use super::Placed;
use crate::DrawFailure;
use crate::parts::{Job, tiles};
use crate::scene_file::{Item, Lamp, SceneFile, ShadeKind};
use crate::setting::{level, unit};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::mesh::{Material, U1F15};
use scanbeam::scene::DepthTest;

/// Where a surface is, for the light that throws shadows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(crate) enum Side {
    /// In its light, or nothing throws shadows.
    Lit,
    /// In its shadow.
    Dark,
}

impl Side {
    /// Where an object is drawn that is there: what is in the shadow is drawn again, over itself.
    pub(crate) fn depth(self, item: &Item) -> DepthTest {
        match self {
            Self::Lit => item.depth(),
            Self::Dark => DepthTest::HIDES,
        }
    }
}

/// A light of a scene in the crate's number formats.
///
/// # Errors
/// When it has no direction.
pub(crate) fn directional(lamp: &Lamp) -> Result<DirectionalLight, DrawFailure> {
    let light = DirectionalLight::new(unit(lamp.towards), lamp.colour.map(|c| c as f32));
    light.ok_or_else(|| DrawFailure::View("a light has no direction".into()))
}

/// The light from everywhere in a scene.
pub(crate) fn ambient(scene: &SceneFile) -> U1F15 {
    level(scene.ambient.unwrap_or(0.2))
}

/// What an object is made of.
pub(crate) fn material(item: &Item) -> Material {
    Material {
        specular: item.specular.map_or([0.0; 3], Into::into).map(level),
        shininess: item.shininess.unwrap_or(Item::SHININESS),
        ..Material::default()
    }
}

/// The lights of a scene.
pub(super) struct SceneLights {
    all: Vec<DirectionalLight>,
    /// Those that shine in the shadow.
    in_shadow: Vec<DirectionalLight>,
    ambient: [U1F15; 3],
}

impl SceneLights {
    /// In the crate's number formats; `None` of a scene without lights.
    pub(super) fn of(scene: &SceneFile) -> Result<Option<Self>, DrawFailure> {
        if scene.lights.is_empty() {
            return Ok(None);
        }
        let (mut all, mut in_shadow) = (Vec::new(), Vec::new());
        for lamp in &scene.lights {
            let light = directional(lamp)?;
            all.push(light);
            if !lamp.shadows {
                in_shadow.push(light);
            }
        }
        Ok(Some(Self {
            all,
            in_shadow,
            ambient: [ambient(scene); 3],
        }))
    }

    /// On an object, unless it is not lit.
    pub(super) fn on(&self, item: &Item, side: Side) -> Option<Lighting<'_>> {
        let lights = match side {
            Side::Lit => &self.all,
            Side::Dark => &self.in_shadow,
        };
        let lighting = Lighting::new(lights, self.ambient, material(item));
        lighting.filter(|_| item.shade != Some(ShadeKind::None))
    }

    /// On each object at each pixel of each tile.
    pub(super) fn at_pixels(
        &self,
        parts: &[Placed<'_>],
        job: &Job,
    ) -> Result<AtPixels, DrawFailure> {
        let mut lamps = Vec::new();
        for tile in tiles(job) {
            let (camera, screen) = (tile.camera(job)?, tile.screen()?);
            let on = |item: &Item, side| {
                let lighting = self.on(item, side)?;
                Some(PixelLamps::new(&lighting, &camera, screen))
            };
            let objects = parts.iter().map(|part| part.item);
            let both = objects.map(|item| [on(item, Side::Lit), on(item, Side::Dark)]);
            lamps.push(both.collect());
        }
        Ok(AtPixels(lamps))
    }
}

/// What shines on pixels, by the number of a tile and of an object: in the light, and in its shadow.
#[derive(Default)]
pub(super) struct AtPixels(Vec<Vec<[Option<PixelLamps>; 2]>>);

impl AtPixels {
    /// What shines on an object on a tile.
    pub(super) fn on(&self, tile: usize, object: usize, side: Side) -> Option<&PixelLamps> {
        let [lit, dark] = self.0.get(tile)?.get(object)?;
        match side {
            Side::Lit => lit.as_ref(),
            Side::Dark => dark.as_ref(),
        }
    }
}
