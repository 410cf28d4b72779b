//! Scenes of the suite as this machine draws them in the rooms `scene`, `look` and `frame`.

use scanbeam::Link;
use scanbeam::frame::{FastMemory, Memory as LineMemory, Renderer};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{DrawState, Memory, Object, Scene, TexturePlace, Vertex};
use scenes::{
    HEIGHT, LEAN_DRAWS, LeanLook, LeanTextured, SUITE_OBJECTS, SUITE_VERTICES, Shot, Suite, WIDTH,
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

/// The same with a look.
fn lean_frame_as<L: Look<Pixel = Rgb565Be>>(suite: Suite) -> Result<Vec<u8>, Box<dyn Error>> {
    let mut vertices = vec![Vertex::EMPTY; SUITE_VERTICES];
    let mut places = vec![TexturePlace::EMPTY; SUITE_VERTICES];
    let mut objects = vec![Object::EMPTY; SUITE_OBJECTS];
    let mut bins = [0; HEIGHT as usize];
    let mut draws = [DrawState::EMPTY; LEAN_DRAWS];
    let memory = Memory {
        vertices: &mut vertices,
        places: &mut places,
        objects: &mut objects,
        bins: &mut bins,
        draws: &mut draws,
    };
    let mut scene = Scene::<L>::new(Shot::screen(), memory);
    suite
        .build_lean(&mut scene)
        .map_err(|error| format!("{}: {error:?}", suite.name()))?;
    let mut cache = Box::new(FastMemory::<L>::new());
    let (mut links, mut depth) = (vec![Link::NONE; SUITE_OBJECTS], [0; WIDTH as usize]);
    let mut renderer = Renderer::new(LineMemory {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    });
    let background = Rgb565Be::from_rgb8(suite.background());
    let mut bytes = Vec::new();
    let mut pixels = [0; WIDTH as usize];
    for line in scene.lines() {
        renderer.draw_line(&scene, line, &mut pixels, background)?;
        bytes.extend(pixels.iter().flat_map(|word| word.to_ne_bytes()));
    }
    Ok(bytes)
}
