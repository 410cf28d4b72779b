//! Frames by presets, for what still compares them.

use host_support::lent::{LineRooms, SceneRooms};
use host_support::mock::{HostLine, MockFrameBuffer};
use scanbeam::pipeline::texture::{Textured, Textures};
use scanbeam::pipeline::{
    BlockFixed, Deferred, DepthUse, FrameStats, Gouraud, GouraudDepth, Pipeline, Scene, Worded,
    draw_frame,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::Pump;
use scenes::{HEIGHT, KeepsDepth, LookB, OBJECTS, SceneB, Shot, TEXTURES_B, VERTICES, WIDTH};
use std::error::Error;

/// Lines that one transfer takes.
const LINES: u16 = 3;

type Display = Pump<MockFrameBuffer<u16>>;

/// The bytes of a shot in scan-out order.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn draw<P: Pipeline<Pixel = Rgb565Be>>(shot: Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    drawn::<P>(shot).map(|(bytes, _)| bytes)
}

/// The bytes of a shot in scan-out order, and what the frame had.
fn drawn<P: Pipeline<Pixel = Rgb565Be>>(
    shot: Shot,
) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>> {
    shown::<P, _>(shot, |scene| build(shot, scene), by_lines)
}

/// The bytes of a shot in scan-out order, with depth kept in another way on every line.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn draw_keeping(shot: Shot, keeps: KeepsDepth) -> Result<Vec<u8>, Box<dyn Error>> {
    match keeps {
        KeepsDepth::BlockFix => draw_tested::<BlockFixed<GouraudDepth<Rgb565Be>>>(shot),
        KeepsDepth::Word => draw_tested::<Worded<GouraudDepth<Rgb565Be>>>(shot),
        KeepsDepth::Deferred => draw_tested::<Deferred<GouraudDepth<Rgb565Be>>>(shot),
    }
}

/// The bytes of a shot in scan-out order, with depth tested on every line.
fn draw_tested<P: Pipeline<Pixel = Rgb565Be>>(shot: Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    let by_depth = |scene: &Scene<'_, P>, pump: &mut Display, background| {
        let mut rooms = LineRooms::<P>::new(64, OBJECTS, WIDTH.into());
        let mut renderer = rooms.renderer();
        renderer.set_depth_use(DepthUse::Always);
        draw_frame(scene, &mut renderer, pump, background, LINES)?;
        Ok(())
    };
    Ok(shown::<P, _>(shot, |scene| build(shot, scene), by_depth)?.0)
}

/// The bytes of scene B in scan-out order, and what the frame had.
///
/// # Errors
/// When it does not fit the arenas that it asks for.
pub fn drawn_b<P>(how: SceneB) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>>
where
    P: Pipeline<
            Pixel = Rgb565Be,
            Shading = Textured<Gouraud>,
            Textures = <LookB as Pipeline>::Textures,
        >,
{
    textured_b::<P>(how, Textures(&TEXTURES_B))
}

/// Scene B with these textures, as [`drawn_b`] has it.
///
/// # Errors
/// When it does not fit the arenas that it asks for.
pub fn textured_b<P>(
    how: SceneB,
    textures: P::Textures,
) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>>
where
    P: Pipeline<Pixel = Rgb565Be, Shading = Textured<Gouraud>>,
{
    let build = |scene: &mut Scene<'_, P>| {
        scene.set_textures(textures);
        how.build_preset(scene)
            .map_err(|error| format!("{}: {error:?}", how.name))?;
        Ok(())
    };
    shown::<P, _>(Shot::Sphere, build, by_lines)
}

/// Draws all lines with one renderer.
fn by_lines<P: Pipeline<Pixel = Rgb565Be>>(
    scene: &Scene<'_, P>,
    pump: &mut Display,
    background: u16,
) -> Result<FrameStats, Box<dyn Error>> {
    let mut rooms = LineRooms::<P>::new(64, OBJECTS, WIDTH.into());
    Ok(draw_frame(
        scene,
        &mut rooms.renderer(),
        pump,
        background,
        LINES,
    )?)
}

/// Draws a shot into a scene.
fn build<P: Pipeline>(shot: Shot, scene: &mut Scene<'_, P>) -> Result<(), Box<dyn Error>> {
    shot.build(scene)
        .map_err(|error| format!("{}: {error:?}", shot.name()))?;
    Ok(())
}

/// What arrives at the display when `draw` draws what `build` has built, over a shot's background, and
/// what `draw` gave.
fn shown<P: Pipeline<Pixel = Rgb565Be>, T>(
    shot: Shot,
    build: impl FnOnce(&mut Scene<'_, P>) -> Result<(), Box<dyn Error>>,
    draw: impl FnOnce(&Scene<'_, P>, &mut Display, u16) -> Result<T, Box<dyn Error>>,
) -> Result<(Vec<u8>, T), Box<dyn Error>> {
    shown_over(shot.background(), build, draw)
}

/// As [`shown`], over a background of 8-bit levels.
fn shown_over<P: Pipeline<Pixel = Rgb565Be>, T>(
    background: [u8; 3],
    build: impl FnOnce(&mut Scene<'_, P>) -> Result<(), Box<dyn Error>>,
    draw: impl FnOnce(&Scene<'_, P>, &mut Display, u16) -> Result<T, Box<dyn Error>>,
) -> Result<(Vec<u8>, T), Box<dyn Error>> {
    let mut lent = SceneRooms::<P>::new(VERTICES, OBJECTS, HEIGHT.into());
    let mut scene = lent.scene(Shot::screen());
    build(&mut scene)?;
    let words = usize::from(WIDTH) * usize::from(LINES);
    let sink = MockFrameBuffer::new(WIDTH, HEIGHT).late_by(1);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let background = Rgb565Be::from_rgb8(background);
    let drawn = draw(&scene, &mut pump, background)?;
    let words = pump.sink().frame()?;
    let bytes = words.into_iter().flat_map(u16::to_ne_bytes).collect();
    Ok((bytes, drawn))
}
