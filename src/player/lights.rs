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
    /// By pointers that only [`new`](LightRoom::new) makes: what no program makes, no program has.
    deeds: &'static Deeds,
}

type Words = [Option<LightWords>; Lighting::MAX_LIGHTS];
type Then<'a> = &'a mut dyn FnMut(Option<&dyn Lights>);

/// What is done with several lights.
#[derive(Debug)]
struct Deeds {
    begin: fn(&mut Words, Option<Light>),
    set: fn(&mut Words, u8, Option<LightWords>) -> bool,
    fall: fn(&Words, &Material, Then<'_>),
}

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
        let deeds = &Deeds {
            begin: begin_all,
            set: set_one,
            fall: fall_all,
        };
        Self { words, deeds }
    }
}

/// As a list begins: at most light 0 is on.
pub(super) fn begin(room: Option<&mut LightRoom>, first: Option<Light>) {
    if let Some(room) = room {
        (room.deeds.begin)(&mut room.words, first);
    }
}

/// Sets the light of a number, or puts it out. Once for all looks.
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
    let is_kept = match room {
        Some(room) => (room.deeds.set)(&mut room.words, number, light),
        None => number == 0 && light.is_none_or(|l| l.colour == [255; 3]),
    };
    match (number, light) {
        // One that is not there is off.
        (1.., None) => {}
        _ if !is_kept => return Err(Reason::Missing(Missing::Lights)),
        (0, light) => state.light(light.map(Light::from)),
        (_, Some(_)) => state.light(state.light),
    }
    Ok(())
}

/// Hands over the lights of a list that fall on a surface, where one white light does not say it; else `None`.
pub(super) fn fall(room: Option<&LightRoom>, surface: &Material, then: Then<'_>) {
    match room.filter(|_| !surface.unlit) {
        Some(room) => (room.deeds.fall)(&room.words, surface, then),
        None => then(None),
    }
}

fn begin_all(words: &mut Words, first: Option<Light>) {
    *words = [None; Lighting::MAX_LIGHTS];
    words[0] = first.map(LightWords::from);
}

/// Whether there is a light of that number.
fn set_one(words: &mut Words, number: u8, light: Option<LightWords>) -> bool {
    let slot = words.get_mut(usize::from(number));
    slot.map(|slot| *slot = light).is_some()
}

/// Whether light 0 alone, in white and without a highlight, says what falls on a surface, or no light is on.
fn is_plain([first, others @ ..]: &Words, surface: &Material) -> bool {
    let is_white = first.is_none_or(|l| l.colour == [255; 3]);
    let is_matt = surface.specular == [0; 3] || first.is_none();
    is_white && is_matt && others.iter().all(Option::is_none)
}

fn fall_all(words: &Words, surface: &Material, then: Then<'_>) {
    if is_plain(words, surface) {
        return then(None);
    }
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
