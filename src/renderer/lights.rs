//! The lights of an instruction list: how many of them a runner knows, and what they fall on (K10).
//!
//! A choice, because several lights with highlights have code of their own, which firmware with
//! one light does not need.

use crate::geometry::{
    DirectionalLight, Light, Lighting, LightingModel, ListLighting, Material as Surface,
};
use crate::list::{LightWords, Material};
use crate::num::{I2F14, U1F15};

/// What keeps the lights of a list: [`OneLight`], or [`EightLights`].
pub trait ListLights: Default {
    /// What lights a draw call.
    type Model<'a>: LightingModel
    where
        Self: 'a;

    /// Whether surfaces have highlights.
    const HIGHLIGHTS: bool;

    /// Begins anew with one light, or none.
    fn begin(&mut self, light: Option<Light>);

    /// Sets the light of a number, or puts it out; `false` where it cannot be had as it is.
    fn set(&mut self, number: u8, light: Option<LightWords>) -> bool;

    /// What lights a surface; `None` where no light is on.
    fn on(&self, surface: &Material) -> Option<Self::Model<'_>>;
}

/// Light 0, in white, without highlights.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct OneLight(Option<Light>);

impl ListLights for OneLight {
    type Model<'a> = Light;

    const HIGHLIGHTS: bool = false;

    fn begin(&mut self, light: Option<Light>) {
        self.0 = light;
    }

    fn set(&mut self, number: u8, light: Option<LightWords>) -> bool {
        match (number, light) {
            (0, light) => {
                self.0 = light.map(Light::from);
                light.is_none_or(|l| l.colour == [255; 3])
            }
            // A light that is not there is off.
            (_, light) => light.is_none(),
        }
    }

    #[inline]
    fn on(&self, _: &Material) -> Option<Light> {
        self.0
    }
}

/// Lights 0 to 7, in colour, with highlights where a material has them.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct EightLights {
    /// What falls; of those that are off nothing.
    lights: [DirectionalLight; Lighting::MAX_LIGHTS],
    /// Ambient levels, of those that are off 0.
    ambient: [u16; Lighting::MAX_LIGHTS],
    /// A bit for each that is on.
    lit: u8,
    /// Light 0, where it is white.
    first: Option<Light>,
}

const OFF: DirectionalLight = DirectionalLight {
    direction: [I2F14::ZERO; 3],
    colour: [U1F15::ZERO; 3],
};

impl Default for EightLights {
    fn default() -> Self {
        Self {
            lights: [OFF; Lighting::MAX_LIGHTS],
            ambient: [0; Lighting::MAX_LIGHTS],
            lit: 0,
            first: None,
        }
    }
}

impl ListLights for EightLights {
    type Model<'a> = ListLighting<'a>;

    const HIGHLIGHTS: bool = true;

    fn begin(&mut self, light: Option<Light>) {
        *self = Self::default();
        self.set(0, light.map(LightWords::from));
    }

    fn set(&mut self, number: u8, light: Option<LightWords>) -> bool {
        let n = usize::from(number);
        let (Some(slot), Some(ambient)) = (self.lights.get_mut(n), self.ambient.get_mut(n)) else {
            return light.is_none();
        };
        *slot = light.map_or(OFF, DirectionalLight::from);
        *ambient = light.map_or(0, |l| l.ambient);
        let bit = 1 << number;
        self.lit = self.lit & !bit | if light.is_some() { bit } else { 0 };
        if number == 0 {
            self.first = light.filter(|l| l.colour == [255; 3]).map(Light::from);
        }
        true
    }

    fn on(&self, surface: &Material) -> Option<ListLighting<'_>> {
        if self.lit == 0 {
            return None;
        }
        let matt = surface.specular == [0; 3];
        if let Some(light) = self.first.filter(|_| self.lit == 1 && matt) {
            return Some(ListLighting::One(light));
        }
        let count = 8 - self.lit.leading_zeros() as usize;
        let ambient: u32 = self.ambient.iter().map(|a| u32::from(*a)).sum();
        let share = |c: u8| U1F15::from_bits(((u32::from(c) * (1 << 15) + 127) / 255) as u16);
        let surface = Surface {
            specular: surface.specular.map(share),
            shininess: u16::from(surface.exponent),
            ..Surface::default()
        };
        let ambient = [U1F15::from_bits(ambient.min(1 << 15) as u16); 3];
        Lighting::new(self.lights.get(..count)?, ambient, surface).map(ListLighting::Several)
    }
}
