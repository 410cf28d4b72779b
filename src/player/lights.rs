//! Several lights of a list, in colour and with highlights (K10). Their code is in a program only where it lends them.

use super::state::State;
use crate::geometry::{DirectionalLight, Light, Lighting, Material as Surface};
use crate::list::{LightWords, Material, Missing, Reason};
use crate::num::{I2F14, U1F15};
use crate::scene::Lights;

/// Memory for lights 0 to 7 of a list, in any colour, and for highlights; it is lent to a
/// [`Player`](crate::input::Player) by [`PlayerMemory::lights`](crate::input::PlayerMemory::lights).
///
/// A program that makes none does not have the code of several lights.
#[derive(Clone, Copy, Debug)]
pub struct LightRoom {
    words: Words,
    /// [`shine`], by a pointer that only [`new`](LightRoom::new) makes: what no program makes, no program has.
    shine: fn(&Words, &Material, &mut dyn FnMut(Option<&dyn Lights>)),
}

type Words = [Option<LightWords>; Lighting::MAX_LIGHTS];

const OFF: DirectionalLight = DirectionalLight {
    direction: [I2F14::ZERO; 3],
    colour: [U1F15::ZERO; 3],
};

impl Default for LightRoom {
    fn default() -> Self {
        Self::new()
    }
}

impl LightRoom {
    /// All lights are off.
    #[must_use]
    pub const fn new() -> Self {
        let words = [None; Lighting::MAX_LIGHTS];
        Self { words, shine }
    }

    /// Whether light 0 alone, in white and without a highlight, says what falls on this surface, or no light is on.
    fn is_plain(&self, surface: &Material) -> bool {
        let [first, others @ ..] = &self.words;
        let is_white = first.is_none_or(|l| l.colour == [255; 3]);
        let is_matt = surface.specular == [0; 3] || first.is_none();
        is_white && is_matt && others.iter().all(Option::is_none)
    }
}

/// As a list begins: at most light 0 is on. Once for all looks, as what follows.
#[inline(never)]
pub(super) fn begin(room: Option<&mut LightRoom>, first: Option<Light>) {
    if let Some(room) = room {
        room.words = [None; Lighting::MAX_LIGHTS];
        room.words[0] = first.map(LightWords::from);
    }
}

/// Sets the light of a number, or puts it out.
///
/// # Errors
/// When there is no room for it, and it is another than light 0 in white.
#[inline(never)]
pub(super) fn set(
    room: Option<&mut LightRoom>,
    state: &mut State<'_, '_>,
    number: u8,
    light: Option<LightWords>,
) -> Result<(), Reason> {
    let is_plain = light.is_none_or(|l| number == 0 && l.colour == [255; 3]);
    match room.and_then(|room| room.words.get_mut(usize::from(number))) {
        Some(slot) => *slot = light,
        None if !is_plain => return Err(Reason::Missing(Missing::Lights)),
        None => {}
    }
    match (number, light) {
        (0, light) => state.light(light.map(Light::from)),
        (_, Some(_)) => state.light(state.light),
        // One that is not there is off.
        (_, None) => {}
    }
    Ok(())
}

/// Hands over the lights of a list that fall on a surface, where one white light does not say it; else `None`.
#[inline(never)]
pub(super) fn fall(
    room: Option<&LightRoom>,
    surface: &Material,
    then: &mut dyn FnMut(Option<&dyn Lights>),
) {
    match room.filter(|room| !surface.unlit && !room.is_plain(surface)) {
        Some(room) => (room.shine)(&room.words, surface, then),
        None => then(None),
    }
}

fn shine(words: &Words, surface: &Material, then: &mut dyn FnMut(Option<&dyn Lights>)) {
    let lights = words.map(|l| l.map_or(OFF, DirectionalLight::from));
    let ambient: u32 = words.iter().flatten().map(|l| u32::from(l.ambient)).sum();
    let ambient = (1 << 15).min(ambient) as u16;
    let share = |c: u8| U1F15::from_bits(((u32::from(c) * (1 << 15) + 127) / 255) as u16);
    let surface = Surface {
        specular: surface.specular.map(share),
        shininess: u16::from(surface.exponent),
        ..Surface::default()
    };
    // Those after the last that is on cost nothing.
    let last = words.iter().rposition(Option::is_some);
    let lights = lights.get(..last.map_or(0, |n| n + 1)).unwrap_or_default();
    let ambient = [U1F15::from_bits(ambient); 3];
    if let Some(lighting) = Lighting::new(lights, ambient, surface) {
        then(Some(&lighting));
    }
}
