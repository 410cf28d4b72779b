//! Lights in words: the light from everywhere, 1; lights, 3 each; and what falls of them on surfaces, 3 each.

use crate::reader::{FlashError, Reader};
use scanbeam::light::{DirectionalLight, Lighting, PixelLamps};
use scanbeam::mesh::{I2F14, Material, U1F15};
use scanbeam::{Camera, Screen};

/// How many there are of what.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct LightCounts {
    /// Lights.
    pub lights: u32,
    /// What falls of them on surfaces.
    pub lightings: u32,
    /// The same at each pixel: as many, or none.
    pub lamps: u32,
}

/// What lights are read into: as many of each as [`LightCounts`] says.
pub struct LightMemory<'t> {
    /// Lights.
    pub lights: &'t mut [DirectionalLight],
    /// What falls of them on surfaces.
    pub lightings: &'t mut [Option<Lighting<'t>>],
    /// The same at each pixel.
    pub lamps: &'t mut [Option<PixelLamps>],
}

/// Lights that were read.
#[derive(Clone, Copy, Debug)]
pub struct Lights<'t> {
    lightings: &'t [Option<Lighting<'t>>],
    lamps: &'t [Option<PixelLamps>],
}

/// What falls on a surface: one of both.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Falls<'t> {
    pub(crate) at_corners: Option<&'t Lighting<'t>>,
    pub(crate) at_pixels: Option<&'t PixelLamps>,
}

impl<'t> Lights<'t> {
    /// A light for memory that is to be lent.
    pub const DARK: DirectionalLight = DirectionalLight {
        direction: [I2F14::ZERO; 3],
        colour: [U1F15::ZERO; 3],
    };

    /// Lights as this camera sees them on a screen.
    ///
    /// # Errors
    /// When words cannot be, or less is lent than they need.
    pub fn read(
        reader: &mut Reader<'t>,
        lent: LightMemory<'t>,
        camera: &Camera,
        screen: Screen,
    ) -> Result<Self, FlashError> {
        let ambient = [U1F15::from_bits(reader.word()? as u16); 3];
        for slot in lent.lights.iter_mut() {
            *slot = light(reader)?;
        }
        let lights: &'t [DirectionalLight] = lent.lights;
        for slot in lent.lightings.iter_mut() {
            let [first, count] = reader.halves()?.map(usize::from);
            let ([r, g], [b, shininess]) = (reader.halves()?, reader.halves()?);
            let material = Material {
                specular: [r, g, b].map(U1F15::from_bits),
                shininess,
                ..Material::default()
            };
            let own = lights.get(first..first + count).ok_or(reader.bad())?;
            *slot = Lighting::new(own, ambient, material);
        }
        let lightings: &'t [Option<Lighting<'t>>] = lent.lightings;
        for (slot, lighting) in lent.lamps.iter_mut().zip(lightings) {
            *slot = lighting
                .as_ref()
                .map(|lighting| PixelLamps::new(lighting, camera, screen));
        }
        Ok(Self {
            lightings,
            lamps: lent.lamps,
        })
    }

    /// What falls on a surface, by its number plus 1; nothing of 0. `None` where there is no such number.
    pub(crate) fn on(&self, number: u16) -> Option<Falls<'t>> {
        let Some(at) = usize::from(number).checked_sub(1) else {
            return Some(Falls {
                at_corners: None,
                at_pixels: None,
            });
        };
        let at_pixels = self.lamps.get(at).and_then(Option::as_ref);
        let lighting = self.lightings.get(at)?.as_ref()?;
        Some(Falls {
            at_corners: self.lamps.is_empty().then_some(lighting),
            at_pixels,
        })
    }
}

fn light(reader: &mut Reader<'_>) -> Result<DirectionalLight, FlashError> {
    let ([x, y], [z, r], [g, b]) = (reader.halves()?, reader.halves()?, reader.halves()?);
    Ok(DirectionalLight {
        direction: [x, y, z].map(|bits| I2F14::from_bits(bits as i16)),
        colour: [r, g, b].map(U1F15::from_bits),
    })
}
