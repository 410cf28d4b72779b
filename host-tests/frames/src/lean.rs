//! Scenes of the suite, and lists, as this machine draws them in the rooms `scene`, `look` and `frame`.

use host_support::rooms::{Room, picture};
use scanbeam::input::{Player, PlayerMemory, TextureRoom};
use scanbeam::list::{ListCommand, TextureSlot};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::Scene;
use scenes::{
    LeanLook, LeanTextured, PLAYED_NAMES, PLAYED_TEXELS, PLAYED_TEXTURES, Played, SUITE_DRAWS,
    SUITE_OBJECTS, SUITE_VERTICES, Shot, Suite,
};
use std::error::Error;

/// The bytes of a scene of the suite, in scan-out order.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn lean_frame(suite: Suite) -> Result<Vec<u8>, Box<dyn Error>> {
    if suite.texels().is_some() {
        lean_frame_as::<LeanTextured>(suite)
    } else {
        lean_frame_as::<LeanLook>(suite)
    }
}

/// The bytes of a list that is played, in scan-out order.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn played_frame(played: Played) -> Result<Vec<u8>, Box<dyn Error>> {
    match played {
        Played::Teapot => played_frame_as::<LeanLook>(played),
        Played::Crate => played_frame_as::<LeanTextured>(played),
    }
}

/// The same with a look.
fn played_frame_as<L: Look<Pixel = Rgb565Be>>(played: Played) -> Result<Vec<u8>, Box<dyn Error>> {
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
    let mut player = Player::new(memory, Played::settings());
    drawn::<L>(
        |scene| match played.play(&mut player, ListCommand::Start(0), scene) {
            Ok(_) => Ok(()),
            Err(error) => Err(format!("{played:?}: {error:?}")),
        },
        played.background(),
    )
}

/// The same with a look.
fn lean_frame_as<L: Look<Pixel = Rgb565Be>>(suite: Suite) -> Result<Vec<u8>, Box<dyn Error>> {
    let build = |scene: &mut Scene<'_, '_, L>| {
        suite
            .build(scene)
            .map_err(|error| format!("{}: {error:?}", suite.name()))
    };
    drawn::<L>(build, suite.background())
}

/// The bytes of a scene that `build` makes.
fn drawn<'t, L: Look<Pixel = Rgb565Be>>(
    build: impl FnOnce(&mut Scene<'_, 't, L>) -> Result<(), String>,
    background: [u8; 3],
) -> Result<Vec<u8>, Box<dyn Error>> {
    let room = Room {
        vertices: SUITE_VERTICES,
        places: SUITE_VERTICES,
        objects: SUITE_OBJECTS,
        draws: SUITE_DRAWS,
    };
    let background = Rgb565Be::from_rgb8(background);
    let words = picture(Shot::screen(), room, background, |scene| Ok(build(scene)?))?;
    Ok(words.into_iter().flat_map(u16::to_ne_bytes).collect())
}
