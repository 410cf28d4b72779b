//! What light and materials do beside one matt light: highlights, transparency, shadows, light at
//! each pixel.
//!
//! First comes what is opaque; with shadows, then its shadow volume and the same surfaces again as they are
//! without the light (K9); last what is transparent, which throws no shadow and gets none.

use super::formats::{Picture, draw_in};
use super::parts::{Job, MOST_OBJECTS, MOST_VERTICES, Tile, draw_parts, room_for, tiles};
use super::prepared::{Chunk, Prepared, ShadowMesh, colour8};
use super::setting::{level, unit};
use super::textured::Texels16;
use super::{CrewSettings, DrawFailure, Drawn, Setting, Skins};
use crate::choice::PixelFormatArg;
use host_support::model::{Material, Model};
use host_support::reference::{Shade, View};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::look::{Gouraud, Look, Phong, Textured, TexturedPhong};
use scanbeam::mesh::U1F15;
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::{Blend, DepthTest, DrawError, Lights, Shadow, ShadowLight, Skin, Texture};
use scanbeam::{Draw, Mesh, Scene};
use std::collections::HashMap;

/// What is asked for beside what materials say.
#[derive(Debug, Clone, Copy, PartialEq, Default)]
pub struct Effects {
    /// The level and the power of highlights on all surfaces, in place of what materials say.
    pub specular: Option<(f64, u16)>,
    /// Whether the model throws shadows onto itself.
    pub shadows: bool,
    /// Whether light is reckoned at each pixel.
    pub phong: bool,
}

impl Effects {
    /// Whether a picture of `model` has any of it.
    #[must_use]
    pub fn are_seen(&self, model: &Model, view: &View) -> bool {
        let lit = view.shade != Shade::None;
        let by_material = model
            .materials
            .iter()
            .map(|m| Looks::new(m, self.specular))
            .any(|looks| looks.alpha < 255 || lit && looks.is_shiny());
        self.shadows || self.phong || self.specular.is_some() || by_material
    }
}

/// What a material does beside its colour.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
struct Looks {
    specular: [U1F15; 3],
    shininess: u16,
    alpha: u8,
    /// Where light falls on pixels; else corners have colours.
    colour: [u8; 3],
}

impl Looks {
    fn new(material: &Material, specular: Option<(f64, u16)>) -> Self {
        let (ks, ns) = match specular {
            Some((level, power)) => ([level; 3], power),
            None => {
                let power = material.ns.clamp(0.0, f64::from(u16::MAX));
                (material.ks, power.round() as u16)
            }
        };
        Self {
            specular: ks.map(level),
            shininess: ns,
            alpha: (material.d * 255.0).round() as u8,
            colour: [255; 3],
        }
    }

    /// Where no material is in force.
    fn plain(specular: Option<(f64, u16)>) -> Self {
        let (ks, shininess) = specular.unwrap_or((0.0, 1));
        Self {
            specular: [level(ks); 3],
            shininess,
            alpha: 255,
            colour: [255; 3],
        }
    }

    fn is_shiny(&self) -> bool {
        self.specular != [U1F15::ZERO; 3]
    }

    fn is_opaque(&self) -> bool {
        self.alpha == 255
    }
}

/// The colour of a triangle whose corners have one, 8 bits a channel.
pub(crate) fn colour_of(model: &Model, triangle: usize) -> Option<[u8; 3]> {
    let colours = model.triangles[triangle].map(|i| colour8(model.vertices[i as usize].colour));
    let [a, b, c] = colours;
    (a == b && b == c).then_some(a)
}

/// A model's looks by number, and which of them its triangles have. Where light falls on pixels, a look has one colour.
fn looks(model: &Model, effects: Effects) -> Result<(Vec<Looks>, Vec<u16>), DrawFailure> {
    let mut all: Vec<Looks> = Vec::new();
    let mut numbers = HashMap::new();
    let mut of_triangle = Vec::new();
    for (triangle, material) in model.triangle_materials.iter().enumerate() {
        let looks = match material {
            Some(material) => Looks::new(&model.materials[*material as usize], effects.specular),
            None => Looks::plain(effects.specular),
        };
        let colour = match effects.phong {
            true => colour_of(model, triangle).ok_or_else(|| {
                DrawFailure::View(format!(
                    "--shade phong lights one colour a triangle: triangle {triangle} has several"
                ))
            })?,
            false => [255; 3],
        };
        let looks = Looks { colour, ..looks };
        let number = *numbers.entry(looks).or_insert_with(|| {
            all.push(looks);
            all.len() - 1
        });
        let number = u16::try_from(number).map_err(|_| {
            DrawFailure::View("--shade phong has at most 65536 colours and materials".into())
        })?;
        of_triangle.push(number);
    }
    Ok((all, of_triangle))
}

/// Draws a model with all that its materials and `effects` say; its textures are as `skins` says.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_effects(
    model: &Model,
    skins: Skins<'_>,
    (view, format): (&View, PixelFormatArg),
    crew: CrewSettings,
    effects: Effects,
) -> Result<Drawn, DrawFailure> {
    let (looks, of_triangle) = looks(model, effects)?;
    let look = |triangle: usize| of_triangle[triangle];
    let prepared = Prepared::split(model, skins.set, look);
    let shadows = if effects.shadows {
        let is_opaque = |triangle: usize| looks[usize::from(of_triangle[triangle])].is_opaque();
        prepared.shadow_meshes(model, is_opaque)
    } else {
        Vec::new()
    };
    let task = Task {
        prepared: &prepared,
        looks: &looks,
        shadows: &shadows,
        view,
        setting: Setting::new(&prepared, view)?,
        crew,
        skins,
        phong: effects.phong,
        dither: format == PixelFormatArg::Dithered565,
    };
    draw_in(&task, format)
}

/// The light of a picture.
struct Lamps {
    light: [DirectionalLight; 1],
    ambient: [U1F15; 3],
    diffuse: [U1F15; 3],
}

impl Lamps {
    /// On what looks so; in the dark the ambient light alone.
    fn on(&self, looks: Option<&Looks>) -> Lighting<'_> {
        let material = scanbeam::mesh::Material::default();
        let (lights, material) = match looks {
            Some(looks) => {
                let material = scanbeam::mesh::Material {
                    diffuse: self.diffuse,
                    specular: looks.specular,
                    shininess: looks.shininess,
                    ..material
                };
                (self.light.as_slice(), material)
            }
            None => (&[][..], material),
        };
        // One light is not too many.
        Lighting::new(lights, self.ambient, material)
            .unwrap_or_else(|| unreachable!("there is one light"))
    }
}

/// What a picture is drawn of, and by how many.
struct Task<'a> {
    prepared: &'a Prepared,
    looks: &'a [Looks],
    shadows: &'a [ShadowMesh],
    view: &'a View,
    setting: Setting,
    crew: CrewSettings,
    skins: Skins<'a>,
    phong: bool,
    dither: bool,
}

/// What is drawn in one step.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
enum Step {
    /// A part of the model in its light.
    Part(usize),
    /// A part again, as it is in the shadow.
    InShadow(usize),
    /// A shadow volume.
    Volume(usize),
}

/// The number of the light that throws shadows.
const LIGHT: u8 = 0;

impl Picture for Task<'_> {
    fn is_textured(&self) -> bool {
        !self.skins.set.is_empty()
    }

    fn plain<F: PixelFormat + Sync>(&self) -> Result<Drawn, DrawFailure> {
        match self.phong {
            false => self.draw::<F, Gouraud<F>, Rgb565>(),
            true => self.draw::<F, Phong<F>, Rgb565>(),
        }
    }

    fn textured<F, T>(&self) -> Result<Drawn, DrawFailure>
    where
        F: PixelFormat + Sync,
        T: PixelFormat<Word = u16>,
        Textured<F>: Look<Pixel = F, Planes: Send>,
        TexturedPhong<F>: Look<Pixel = F, Planes: Send>,
    {
        match self.phong {
            false => self.draw::<F, Textured<F>, T>(),
            true => self.draw::<F, TexturedPhong<F>, T>(),
        }
    }
}

impl Task<'_> {
    fn steps(&self) -> Vec<Step> {
        let (mut opaque, mut clear) = (Vec::new(), Vec::new());
        for (number, chunk) in self.prepared.chunks.iter().enumerate() {
            if self.looks[usize::from(chunk.look)].is_opaque() {
                opaque.push(number);
            } else {
                clear.push(number);
            }
        }
        let mut steps: Vec<Step> = opaque.iter().map(|i| Step::Part(*i)).collect();
        if !self.shadows.is_empty() {
            steps.extend((0..self.shadows.len()).map(Step::Volume));
            steps.extend(opaque.iter().map(|i| Step::InShadow(*i)));
        }
        steps.extend(clear.iter().map(|i| Step::Part(*i)));
        steps
    }

    /// Draws with the look `L`, and texels that are pixels of the format `T`.
    fn draw<F, L, T>(&self) -> Result<Drawn, DrawFailure>
    where
        F: PixelFormat + Sync,
        L: Look<Pixel = F, Planes: Send> + Sync,
        T: PixelFormat<Word = u16>,
    {
        let texels = Texels16::of::<T>(self.skins.set);
        let coarser = texels.coarser()?;
        let textures = texels.textures(&coarser, self.skins)?;
        let lamps = self.lamps()?;
        let steps = self.steps();
        let job = self.job(steps.len());
        let at_pixels = match self.phong {
            true => self.pixel_lamps(&lamps, &job)?,
            false => Vec::new(),
        };
        let is_lit = self.view.shade != Shade::None;
        let on = |looks| is_lit.then(|| lamps.on(Some(looks)));
        let lit = Lit {
            by_look: self.looks.iter().map(on).collect(),
            in_dark: lamps.on(None),
            at_pixels: &at_pixels,
        };
        let shadow = ShadowLight {
            light: LIGHT,
            direction: lamps.light[0].direction,
            // The model is within 2 of its middle, so no shadow on it is longer.
            reach: 2,
        };
        let counted: Vec<_> = steps.iter().map(|step| self.counted(*step)).collect();
        draw_parts::<L, F>(&job, &counted, &mut |scene, tile, step, instead| {
            let (part, in_shadow) = match steps[step] {
                Step::Part(part) => (part, false),
                Step::InShadow(part) => (part, true),
                Step::Volume(i) => {
                    return self.shadows[i].draw(scene, &self.setting.model, &shadow);
                }
            };
            let chunk = instead.unwrap_or(&self.prepared.chunks[part]);
            self.part(scene, &lit, &textures, (tile, chunk, in_shadow))
        })
    }

    /// What counts of a step: volumes, and what is drawn twice, are none of the model's triangles.
    fn counted(&self, step: Step) -> Option<&Chunk> {
        match step {
            Step::Part(part) => Some(&self.prepared.chunks[part]),
            Step::InShadow(_) | Step::Volume(_) => None,
        }
    }

    /// Draws a part of the model on a tile, in its light or as it is in the shadow.
    fn part<'t, L: Look>(
        &self,
        scene: &mut Scene<'_, 't, L>,
        lit: &Lit<'_, 't>,
        textures: &'t [Texture<'t>],
        (tile, chunk, in_shadow): (&Tile, &Chunk, bool),
    ) -> Result<(), DrawError> {
        let look = usize::from(chunk.look);
        let looks = &self.looks[look];
        let texture = chunk
            .texture
            .and_then(|texture| textures.get(usize::from(texture)));
        let lights = match in_shadow {
            true => Some(&lit.in_dark),
            false => lit.by_look[look].as_ref(),
        };
        let mesh = Mesh {
            colours: if self.phong {
                &[]
            } else {
                chunk.mesh().colours
            },
            ..chunk.mesh()
        };
        let dark = self.looks.len();
        let draw = Draw {
            model: self.setting.model,
            cull: self.setting.cull,
            colour: looks.colour,
            lights: lights
                .filter(|_| !self.phong)
                .map(|lights| lights as &dyn Lights),
            lamps: lit
                .at_pixels
                .get(tile.number)
                .map(|lamps| &lamps[if in_shadow { dark } else { look }]),
            shading: self.setting.shading,
            texture: texture.map(|texture| Skin {
                texture,
                places: &chunk.places,
                budget: self.skins.budget,
            }),
            blend: (!looks.is_opaque()).then(|| Blend::filter(looks.alpha)),
            depth: if in_shadow {
                DepthTest::HIDES
            } else {
                self.crew.depth.test()
            },
            shadow: in_shadow.then_some(Shadow::Shadowed(LIGHT)),
            dither: self.dither,
            ..Draw::new(mesh)
        };
        scene.draw_within(&draw, &chunk.sphere).map(drop)
    }

    fn job(&self, steps: usize) -> Job {
        let textured = !self.skins.set.is_empty();
        let is_flat = self.view.shade == Shade::Flat;
        let mut room = room_for(self.prepared.chunks.iter(), textured, is_flat);
        let casts = !self.shadows.is_empty();
        if casts {
            // Each opaque part twice, and volumes of unknown size.
            (room.vertices, room.objects) = (MOST_VERTICES, MOST_OBJECTS);
            room.places = if textured { MOST_VERTICES } else { 0 };
        }
        // A volume has two states, and two more where the near plane cuts it.
        room.draws = steps + 3 * self.shadows.len();
        Job {
            shadows: casts,
            // What throws a shadow throws it anywhere.
            is_ahead: !casts && self.setting.is_ahead,
            ..Job::new(self.view, self.setting.camera, self.crew, room)
        }
    }

    /// What shines on pixels, by the number of a tile and of a look; the last is the dark.
    fn pixel_lamps(&self, lamps: &Lamps, job: &Job) -> Result<Vec<Vec<PixelLamps>>, DrawFailure> {
        let on_tile = |tile: Tile| {
            let (camera, screen) = (tile.camera(job)?, tile.screen()?);
            let shines = self.looks.iter().map(Some).chain([None]);
            Ok(shines
                .map(|looks| PixelLamps::new(&lamps.on(looks), &camera, screen))
                .collect())
        };
        tiles(job).map(on_tile).collect()
    }

    /// The light of the view.
    fn lamps(&self) -> Result<Lamps, DrawFailure> {
        let light = DirectionalLight::new(unit(self.view.light), [1.0; 3])
            .ok_or_else(|| DrawFailure::View("the light has no direction".into()))?;
        Ok(Lamps {
            light: [light],
            ambient: [level(self.view.ambient); 3],
            diffuse: [level(1.0 - self.view.ambient); 3],
        })
    }
}

/// The light of a picture on its looks.
struct Lit<'l, 't> {
    /// On corners, by the number of a look; `None` where colours are seen as they are.
    by_look: Vec<Option<Lighting<'l>>>,
    in_dark: Lighting<'l>,
    /// On pixels, by the number of a tile and of a look; the last is the dark.
    at_pixels: &'t [Vec<PixelLamps>],
}
