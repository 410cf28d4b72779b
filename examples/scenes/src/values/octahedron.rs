//! An octahedron of a list: it casts the shadows of the scene's lights (K9), or is a number of a palette (H18).

use super::listed::play_whole;
use super::told::{flow, header};
use crate::ShotError;
use scanbeam::input::{Player, PlayerMemory, PlayerSettings};
use scanbeam::list::{Budget, Flow, Header, Id};
use scanbeam::look::Look;
use scanbeam::pixel::Index8;
use scanbeam::scene::{Draw, Scene, Shading, ShadowEdge, ShadowLight, ShadowMemory};

const CORNERS: u16 = 6;
const FACES: u16 = 8;

/// 1 and -1 of a coordinate, in the lower and in the upper half of a word.
const LOW: [u32; 2] = [0x4000, 0xC000];
const HIGH: [u32; 2] = [0x4000 << 16, 0xC000 << 16];

const INDEXED: Header = Header {
    new: true,
    low: Header::SEPARATE,
    ..Header::of(Id::Indexed, 3 * FACES)
};

/// A table of corners on the axes, each way, and triangles of it.
static OCTAHEDRON: [u32; 18] = [
    header(Id::Table, CORNERS),
    LOW[0].to_le(),
    HIGH[1].to_le(),
    0,
    HIGH[0].to_le(),
    0,
    LOW[1].to_le(),
    0,
    LOW[0].to_le(),
    HIGH[1].to_le(),
    INDEXED.to_word().to_le(),
    u32::from_le_bytes([0, 2, 4, 2]).to_le(),
    u32::from_le_bytes([1, 4, 1, 3]).to_le(),
    u32::from_le_bytes([4, 3, 0, 4]).to_le(),
    u32::from_le_bytes([2, 0, 5, 1]).to_le(),
    u32::from_le_bytes([2, 5, 3, 1]).to_le(),
    u32::from_le_bytes([5, 0, 3, 5]).to_le(),
    flow(Flow::End),
];

/// Words of a material.
const MATERIAL: usize = 4;
/// What the octahedron is in a list that says it itself.
const NUMBER: u8 = 160;

/// The same list behind a material: not lit, in the colour of [`NUMBER`].
static NUMBERED: [u32; MATERIAL + OCTAHEDRON.len()] = {
    let [r, g, b] = Index8::colour(NUMBER);
    let mut words = [0; MATERIAL + OCTAHEDRON.len()];
    words[0] = header(Id::State, 5 << 8);
    words[1] = u32::from_le_bytes([r, g, b, 255]).to_le();
    words[3] = 2_u32.to_le();
    let mut at = 0;
    while at < OCTAHEDRON.len() {
        words[MATERIAL + at] = OCTAHEDRON[at];
        at += 1;
    }
    words
};

/// Draws it as the scene draws what else is in it; it casts the shadows of these lights.
pub(super) fn octahedron<L: Look>(
    scene: &mut Scene<'_, 'static, L>,
    dressed: &Draw<'_, 'static>,
    casts: &[ShadowLight],
) -> Result<(), ShotError> {
    play(&OCTAHEDRON, scene, dressed, casts)
}

/// Draws it in the colour of its number.
pub(super) fn numbered<L: Look>(
    scene: &mut Scene<'_, 'static, L>,
    dressed: &Draw<'_, 'static>,
) -> Result<(), ShotError> {
    play(&NUMBERED, scene, dressed, &[])
}

fn play<L: Look>(
    list: &'static [u32],
    scene: &mut Scene<'_, 'static, L>,
    dressed: &Draw<'_, 'static>,
    casts: &[ShadowLight],
) -> Result<(), ShotError> {
    let memory = PlayerMemory {
        positions: &mut [[0; 3]; CORNERS as usize],
        indices: &mut [0; 3 * FACES as usize],
        ..PlayerMemory::default()
    };
    let settings = PlayerSettings {
        draw: Draw {
            shading: Shading::Flat,
            ..*dressed
        },
        casts,
        ..PlayerSettings::default()
    };
    let volume = ShadowMemory {
        edges: &mut [ShadowEdge::default(); 3 * FACES as usize],
        positions: &mut [[0; 3]; 3 * FACES as usize],
        faces: &mut [[0; 3]; 3 * FACES as usize],
    };
    let mut player = Player::new(memory, settings).with_shadows(volume);
    play_whole(&mut player, list, scene, Budget::of(64))
}
