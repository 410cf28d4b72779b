//! Lists in small frames: how they are played, and what a player of the crate's is lent.

use crate::looks::TexturedLook;
use crate::{
    CRATE_INDICES, CRATE_TABLE, PLAYED_NAMES, PLAYED_TEXELS, PLAYED_TEXTURES, Played, ShotError,
};
use scanbeam::event::Notice;
use scanbeam::input::{Player, PlayerMemory, PlayerSettings, TextureRoom};
use scanbeam::list::{Budget, Halt, ListCommand, TextureSlot};
use scanbeam::look::Look;
use scanbeam::scene::Scene;

/// Room for the textures of the crate.
pub(super) struct Rooms<'t> {
    textures: [TextureRoom<'t>; PLAYED_TEXTURES],
    texels: [u16; PLAYED_TEXELS],
}

impl Rooms<'_> {
    pub(super) const EMPTY: Self = Self {
        textures: [const { TextureRoom::EMPTY }; PLAYED_TEXTURES],
        texels: [0; PLAYED_TEXELS],
    };
}

/// Gives `play` a player with these settings, whose memory is that which the crate needs.
pub(super) fn with_player<'t, R>(
    settings: PlayerSettings<'_, 't>,
    rooms: &'t mut Rooms<'t>,
    play: impl FnOnce(&mut Player<'_, 't, TexturedLook>) -> R,
) -> R {
    let names = [const { TextureSlot::new() }; PLAYED_NAMES];
    let memory = PlayerMemory {
        positions: &mut [[0; 3]; CRATE_TABLE],
        normals: &mut [[0; 3]; CRATE_TABLE],
        indices: &mut [0; CRATE_INDICES],
        places: &mut [[0; 2]; CRATE_TABLE],
        names: &names,
        textures: &mut rooms.textures,
        texels: &mut rooms.texels,
        ..PlayerMemory::default()
    };
    play(&mut Player::new(memory, settings))
}

/// Adds the crate to a scene.
pub(super) fn wooden_crate<'t>(
    scene: &mut Scene<'_, 't, TexturedLook>,
    settings: PlayerSettings<'_, 't>,
    rooms: &'t mut Rooms<'t>,
) -> Result<(), ShotError> {
    // It is aligned, so it is there.
    let list = Played::Crate.list().unwrap_or_default();
    with_player(settings, rooms, |player| {
        play_whole(player, list, scene, Budget::of(4096))
    })
}

/// Plays a list to its end.
pub(super) fn play_whole<'t, L: Look>(
    player: &mut Player<'_, 't, L>,
    list: &'t [u32],
    scene: &mut Scene<'_, 't, L>,
    mut budget: Budget,
) -> Result<(), ShotError> {
    player.command(ListCommand::Start(0));
    let run = player.run(list, scene, &mut budget, &mut |_: Notice| {});
    match run {
        Ok(Halt::End) if player.counts().dropped == 0 => Ok(()),
        other => Err(ShotError::List(other)),
    }
}
