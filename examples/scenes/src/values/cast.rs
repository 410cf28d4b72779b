//! An octahedron of a list, which casts the shadows of the scene's lights.

use super::scenes::at;
use super::told::{flow, header};
use crate::ShotError;
use crate::looks::SmoothLook;
use scanbeam::Affine;
use scanbeam::event::Notice;
use scanbeam::input::{Player, PlayerMemory, PlayerSettings};
use scanbeam::list::{Budget, Flow, Halt, Header, Id, ListCommand};
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

/// Draws it as the scene draws what else is in it; it casts the shadows of these lights.
pub(super) fn octahedron(
    scene: &mut Scene<'_, 'static, SmoothLook>,
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
            model: Affine::rotation_x(0.4).then(&at(0.3, [-0.7, 0.35, -0.4])),
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
    player.command(ListCommand::Start(0));
    let run = player.run(
        &OCTAHEDRON[..],
        scene,
        &mut Budget::of(64),
        &mut |_: Notice| {},
    );
    match run {
        Ok(Halt::End) if player.counts().dropped == 0 => Ok(()),
        other => Err(ShotError::List(other)),
    }
}
