//! What light and materials do beside one matt light: highlights, transparency, shadows, light at
//! each pixel.
//!
//! A picture that has any of it is drawn by a pipeline whose surfaces have a finish. First comes
//! what is opaque; with shadows, then its shadow volume and the same surfaces again as they are
//! without the light (K9); last what is transparent, which throws no shadow and gets none.

use super::prepared::{Dress, Prepared, ShadowMesh};
use super::textured::{HostTexture, textures};
use super::{
    CrewSettings, DrawFailure, Drawn, FilterArg, Setting, TextureSet, draw_scenes, rooms_for,
};
use crate::choice::PixelFormatArg;
use host_support::model::{Material, Model};
use host_support::reference::{Shade, View};
use scanbeam::Link;
use scanbeam::light::{DirectionalLight, Lamplight, Lighting, LitSkin, Phong, PixelLamps};
use scanbeam::mesh::U1F15;
use scanbeam::pipeline::blend::{Blended, Finish, ShadowError, ShadowLight, Surface};
use scanbeam::pipeline::texture::{DetailedTextures, LevelEnds, Levels, Quality, Skin, Textured};
use scanbeam::pipeline::{
    Auto, Counted, Depth32, DrawError, Flat, Gouraud, Parts, Pipeline, Scene, Shading, Shadowed,
    SkinOf,
};
use scanbeam::pixel::{Dithered, PixelFormat, Rgb565Be, Rgb888};

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
#[derive(Debug, Clone, Copy, PartialEq)]
struct Looks {
    specular: [U1F15; 3],
    shininess: u16,
    alpha: u8,
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
        }
    }

    /// Where no material is in force.
    fn plain(specular: Option<(f64, u16)>) -> Self {
        let (level, shininess) = specular.unwrap_or((0.0, 1));
        Self {
            specular: [self::level(level); 3],
            shininess,
            alpha: 255,
        }
    }

    fn is_shiny(&self) -> bool {
        self.specular != [U1F15::ZERO; 3]
    }

    fn finish(&self) -> Finish {
        match self.alpha {
            255 => Finish::OPAQUE,
            alpha => Finish::filtered(alpha),
        }
    }
}

fn level(value: f64) -> U1F15 {
    U1F15::from_bits((value.clamp(0.0, 1.99) * 32_768.0).round() as u16)
}

impl<P, S> Dress<P> for Finish
where
    S: Shading,
    P: Pipeline<Shading = Blended<S>>,
{
    fn dress<'a>(&self, skin: Skin<'a>) -> SkinOf<'a, P> {
        Surface {
            skin: skin.into(),
            finish: *self,
            alphas: &[],
        }
    }
}

/// A finish, and which lamps shine on it.
#[derive(Clone, Copy, Debug)]
struct LitFinish(Finish, u16);

impl<P, S> Dress<P> for LitFinish
where
    S: Shading,
    P: Pipeline<Shading = Blended<Phong<S>>>,
{
    fn dress<'a>(&self, skin: Skin<'a>) -> SkinOf<'a, P> {
        let skin = LitSkin {
            skin: skin.into(),
            lamps: self.1,
        };
        Surface {
            skin,
            finish: self.0,
            alphas: &[],
        }
    }
}

/// A model's materials by number, and which of them its triangles have.
fn looks(model: &Model, specular: Option<(f64, u16)>) -> (Vec<Looks>, Vec<u16>) {
    let mut all: Vec<Looks> = Vec::new();
    let mut number = |looks: Looks| match all.iter().position(|l| *l == looks) {
        Some(number) => number as u16,
        None => {
            all.push(looks);
            all.len() as u16 - 1
        }
    };
    let plain = number(Looks::plain(specular));
    let of_material: Vec<u16> = model
        .materials
        .iter()
        .map(|material| number(Looks::new(material, specular)))
        .collect();
    let of_triangle = model
        .triangle_materials
        .iter()
        .map(|material| material.map_or(plain, |m| of_material[m as usize]))
        .collect();
    (all, of_triangle)
}

/// What a picture is drawn of.
struct Task<'a> {
    prepared: &'a Prepared,
    looks: &'a [Looks],
    shadows: &'a [ShadowMesh],
    view: &'a View,
    crew: CrewSettings,
    textures: &'a [Levels<HostTexture<'a>>],
}

/// Draws a model with all that its materials and `effects` say; textures have levels of detail.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_effects(
    model: &Model,
    set: &TextureSet,
    (filter, quality): (FilterArg, Quality),
    (view, format): (&View, PixelFormatArg),
    crew: CrewSettings,
    effects: Effects,
) -> Result<Drawn, DrawFailure> {
    let (looks, of_triangle) = looks(model, effects.specular);
    let prepared = Prepared::split(model, set, quality, |triangle| of_triangle[triangle]);
    let shadows = if effects.shadows {
        let is_opaque = |triangle: usize| looks[usize::from(of_triangle[triangle])].alpha == 255;
        prepared.shadow_meshes(model, is_opaque)
    } else {
        Vec::new()
    };
    let task = Task {
        prepared: &prepared,
        looks: &looks,
        shadows: &shadows,
        view,
        crew,
        textures: &textures(set, filter)?,
    };
    match (effects.phong, view.shade, format) {
        (true, _, PixelFormatArg::Rgb888) => task.by_pixels::<Rgb888>(),
        (_, Shade::Flat, PixelFormatArg::Rgb888) => task.by::<Flat, Rgb888>(),
        (_, _, PixelFormatArg::Rgb888) => task.by::<Gouraud, Rgb888>(),
        (true, _, PixelFormatArg::Rgb565) => task.by_pixels::<Rgb565Be>(),
        (_, Shade::Flat, PixelFormatArg::Rgb565) => task.by::<Flat, Rgb565Be>(),
        (_, _, PixelFormatArg::Rgb565) => task.by::<Gouraud, Rgb565Be>(),
        (true, _, PixelFormatArg::Dithered888) => task.by_pixels::<Dithered<Rgb888>>(),
        (_, Shade::Flat, PixelFormatArg::Dithered888) => task.by::<Flat, Dithered<Rgb888>>(),
        (_, _, PixelFormatArg::Dithered888) => task.by::<Gouraud, Dithered<Rgb888>>(),
        (true, _, PixelFormatArg::Dithered565) => task.by_pixels::<Dithered<Rgb565Be>>(),
        (_, Shade::Flat, PixelFormatArg::Dithered565) => task.by::<Flat, Dithered<Rgb565Be>>(),
        (_, _, PixelFormatArg::Dithered565) => task.by::<Gouraud, Dithered<Rgb565Be>>(),
        _ => Err(super::formats::refused(
            "transparency, highlights and shadows are drawn",
        )),
    }
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

impl Task<'_> {
    fn steps(&self) -> Vec<Step> {
        let (mut opaque, mut clear) = (Vec::new(), Vec::new());
        for (number, chunk) in self.prepared.chunks.iter().enumerate() {
            if self.looks[usize::from(chunk.look)].alpha == 255 {
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

    fn by<S, F>(&self) -> Result<Drawn, DrawFailure>
    where
        S: Shading<Levels: scanbeam::pipeline::Levels>,
        F: PixelFormat,
        for<'t> DetailedTextures<'t, HostTexture<'t>>:
            scanbeam::pipeline::texture::TextureSource<F>,
    {
        type Plain<'t, S, F> = Counted<
            Parts<
                Textured<S, LevelEnds>,
                Depth32,
                F,
                (),
                Auto,
                DetailedTextures<'t, HostTexture<'t>>,
            >,
        >;
        let lamps = self.lamps()?;
        let is_lit = self.view.shade != Shade::None;
        let on = |looks| is_lit.then(|| lamps.on(Some(looks)));
        let by_look: Vec<_> = self.looks.iter().map(on).collect();
        self.draw::<Shadowed<Plain<'_, S, F>>, _, _>(
            (DetailedTextures(self.textures), ()),
            &lamps,
            (&by_look, Some(lamps.on(None))),
            |_, finish| finish,
        )
    }

    /// The same, lit at each pixel.
    fn by_pixels<F>(&self) -> Result<Drawn, DrawFailure>
    where
        F: PixelFormat,
        for<'t> DetailedTextures<'t, HostTexture<'t>>:
            scanbeam::pipeline::texture::TextureSource<F>,
    {
        type Plain<'t, F> = Counted<
            Parts<
                Phong<Textured<Gouraud, LevelEnds>>,
                Depth32,
                F,
                (),
                Auto,
                DetailedTextures<'t, HostTexture<'t>>,
                (),
                Lamplight<'t>,
            >,
        >;
        let lamps = self.lamps()?;
        let setting = Setting::new(self.prepared, self.view)?;
        // The last is the dark.
        let shines: Vec<PixelLamps> = self
            .looks
            .iter()
            .map(Some)
            .chain([None])
            .map(|looks| PixelLamps::new(&lamps.on(looks), &setting.camera, setting.screen))
            .collect();
        let dark = self.looks.len();
        self.draw::<Shadowed<Plain<'_, F>>, _, _>(
            (DetailedTextures(self.textures), Lamplight(&shines)),
            &lamps,
            (&vec![None; dark], None),
            |look, finish| LitFinish(finish, look.unwrap_or(dark) as u16),
        )
    }

    /// The light of the view.
    fn lamps(&self) -> Result<Lamps, DrawFailure> {
        let v = self.view.light;
        let largest = v.iter().fold(0.0f64, |m, c| m.max(c.abs()));
        let light = DirectionalLight::new(v.map(|c| (c / largest) as f32), [1.0; 3])
            .ok_or_else(|| DrawFailure::View("the light has no direction".into()))?;
        Ok(Lamps {
            light: [light],
            ambient: [level(self.view.ambient); 3],
            diffuse: [level(1.0 - self.view.ambient); 3],
        })
    }

    fn draw<P, S, D>(
        &self,
        (textures, lights): (P::Textures, P::Lights),
        lamps: &Lamps,
        (by_look, in_dark): (&[Option<Lighting<'_>>], Option<Lighting<'_>>),
        dress: impl Fn(Option<usize>, Finish) -> D,
    ) -> Result<Drawn, DrawFailure>
    where
        S: Shading,
        P: Pipeline<Shading = Blended<S>, Textures: Sync>,
        D: Dress<P>,
    {
        let setting = Setting::new(self.prepared, self.view)?;
        let by_look: Vec<_> = by_look
            .iter()
            .map(|light| setting.instance.lit_by(*light))
            .collect();
        let in_dark = setting.instance.lit_by(in_dark);
        let shadow = ShadowLight {
            light: 0,
            direction: lamps.light[0].direction,
            // The model is within 2 of its middle, so no shadow on it is longer.
            reach: 2,
        };
        let steps = self.steps();
        let build = |scene: &mut Scene<'_, P>, step: usize, alone: bool| {
            let full = |done: Result<(), DrawError>| done.map_err(ShadowError::Draw);
            match steps[step] {
                Step::Part(i) => {
                    let chunk = &self.prepared.chunks[i];
                    let look = usize::from(chunk.look);
                    let finish = dress(Some(look), self.looks[look].finish());
                    full(chunk.draw(scene, (&by_look[look], &finish), alone))
                }
                Step::InShadow(i) => {
                    let finish = dress(None, Finish::in_shadow(shadow.light));
                    let chunk = &self.prepared.chunks[i];
                    full(chunk.draw(scene, (&in_dark, &finish), alone))
                }
                Step::Volume(i) => self.shadows[i].draw(scene, &setting.instance.model, &shadow),
            }
        };
        let height = self.view.height as u16;
        let mut rooms = rooms_for::<P>(self.prepared, height);
        if !self.shadows.is_empty() {
            // Each opaque part twice, and volumes of unknown size.
            rooms = host_support::lent::SceneRooms::new(
                1 << 16,
                usize::from(Link::CACHED),
                height.into(),
            );
        }
        rooms.textures = textures;
        rooms.lights = lights;
        draw_scenes::<P>(
            (Some(self.prepared), &setting, rooms),
            (self.view, self.crew),
            (steps.len(), build),
        )
    }
}
