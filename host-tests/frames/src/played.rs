//! Lists, as this machine draws them.

use crate::{Drawn, drawn};
use scanbeam::input::{Player, PlayerMemory, TextureRoom};
use scanbeam::list::{ListCommand, TextureSlot};
use scanbeam::look::Look;
use scanbeam::pixel::Rgb565Be;
use scenes::{PLAYED_NAMES, PLAYED_TEXELS, PLAYED_TEXTURES, Played, SmoothLook, TexturedLook};
use std::error::Error;

/// A list that is played.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn played_frame(played: Played) -> Result<Drawn, Box<dyn Error>> {
    match played {
        Played::Teapot | Played::TeapotMeshlets => played_as::<SmoothLook>(played),
        Played::Crate | Played::CrateOwn => played_as::<TexturedLook>(played),
    }
}

/// The same with a look.
fn played_as<L: Look<Pixel = Rgb565Be>>(played: Played) -> Result<Drawn, Box<dyn Error>> {
    let [table, indices] = played.sizes();
    let mut lent = (vec![[0; 3]; table], vec![[0; 3]; table], vec![0; indices]);
    let mut places = vec![[0; 2]; table];
    let names = [const { TextureSlot::new() }; PLAYED_NAMES];
    let mut textures = [const { TextureRoom::EMPTY }; PLAYED_TEXTURES];
    let mut texels = [0; PLAYED_TEXELS];
    let memory = PlayerMemory {
        positions: &mut lent.0,
        normals: &mut lent.1,
        indices: &mut lent.2,
        places: &mut places,
        names: &names,
        textures: &mut textures,
        texels: &mut texels,
        ..PlayerMemory::default()
    };
    let mut player = Player::new(memory, played.settings());
    drawn::<L>(played.background(), |scene| {
        match played.play(&mut player, ListCommand::Start(0), scene) {
            Ok(_) => Ok(()),
            Err(error) => Err(format!("{played:?}: {error:?}")),
        }
    })
}
