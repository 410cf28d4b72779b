//! The frames of the firmware as this machine draws them: their checksums, what they have, and pictures of them.

mod effects;
mod lean;
mod methods;
mod values;

pub use effects::{effect_frames, effect_pictures};
pub use methods::{MethodFrame, method_frames};
pub use values::{Sent, values_pictures, values_sent};

use host_draw::ModelLines;
use host_support::image_out::Frame;
use host_support::lent::{LineRooms, SceneRooms};
use host_support::mock::{HostLine, MockFrameBuffer};
use lean::lean_frame;
pub use lean::played_frame;
use scanbeam::pipeline::texture::{
    Quality, Size as TextureSize, Texture, Textured, Textures, Words, Wrap,
};
use scanbeam::pipeline::{
    BlockFixed, Counted, Deferred, DepthUse, FlatDepth, FrameStats, Gouraud, GouraudDepth,
    Pipeline, Scene, TexturedDepth, Worded, draw_frame,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::Pump;
use scanbeam_model::draw_model_frame;
use scenes::{
    DEPTHS, HEIGHT, KeepsDepth, LEAN, LookB, LookF, OBJECTS, PLAYED, SCENE_B_BLOCKS, SCENES_B,
    SHOTS, STACKS, STRESS, SUITE, SWATCHES, SceneB, Shot, Suite, TEXEL_SIDE, TEXELS_PANEL,
    TEXTURES_B, TEXTURES_F, VALUES, VARIANTS, VERTICES, WIDTH,
};
use std::collections::BTreeMap;
use std::error::Error;

/// The checksums of all frames as this machine draws them, by name.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn host_frames() -> Result<BTreeMap<&'static str, u32>, Box<dyn Error>> {
    let mut frames = BTreeMap::new();
    for suite in SUITE {
        let bytes = drawn_suite::<GouraudDepth<Rgb565Be>, LookB, LookF>(suite)?.0;
        frames.insert(suite.name(), crc32fast::hash(&bytes));
    }
    for (name, suite) in LEAN {
        frames.insert(name, crc32fast::hash(&lean_frame(suite)?));
    }
    for (name, values) in VALUES {
        let words = values_sent(values, 64)?.words;
        let bytes: Vec<u8> = words.into_iter().flat_map(u16::to_ne_bytes).collect();
        frames.insert(name, crc32fast::hash(&bytes));
    }
    for (name, played) in PLAYED {
        frames.insert(name, crc32fast::hash(&played_frame(played)?));
    }
    for shot in SHOTS.into_iter().chain(STACKS).chain(STRESS) {
        frames.insert(
            shot.name(),
            crc32fast::hash(&draw::<GouraudDepth<Rgb565Be>>(shot)?),
        );
    }
    let flat = draw::<FlatDepth<Rgb565Be>>(Shot::Teapot)?;
    frames.insert("teapot_flat", crc32fast::hash(&flat));
    let flat = draw::<FlatDepth<Rgb565Be>>(Shot::Crossings)?;
    frames.insert("crossings_flat", crc32fast::hash(&flat));
    let model = draw_by_model(Shot::Teapot)?;
    frames.insert("teapot_model", crc32fast::hash(&model));
    for (name, shot, keeps) in DEPTHS {
        frames.insert(name, crc32fast::hash(&draw_keeping(shot, keeps)?));
    }
    for scene in SCENES_B {
        frames.insert(scene.name, crc32fast::hash(&drawn_b::<LookB>(scene)?.0));
    }
    frames.insert(
        SCENE_B_BLOCKS.name,
        crc32fast::hash(&draw_rows_b(SCENE_B_BLOCKS)?),
    );
    for variant in VARIANTS {
        // However it is drawn there, it is the shot that one renderer draws here.
        let plain = draw::<GouraudDepth<Rgb565Be>>(variant.shot)?;
        frames.insert(variant.name, crc32fast::hash(&plain));
    }
    for (name, swatch) in SWATCHES {
        let mut bytes = Vec::new();
        swatch.draw(&mut |line| bytes.extend(line.iter().flat_map(|word| word.to_ne_bytes())));
        frames.insert(name, crc32fast::hash(&bytes));
    }
    for (name, words) in method_frames()?.into_iter().chain(effect_frames(64)?) {
        let bytes: Vec<u8> = words.into_iter().flat_map(u16::to_ne_bytes).collect();
        frames.insert(name, crc32fast::hash(&bytes));
    }
    Ok(frames)
}

/// Lines that one transfer takes.
const LINES: u16 = 3;

/// What the frames of the shots have: pixels, spans and triangles, by name.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn host_counts() -> Result<BTreeMap<&'static str, FrameStats>, Box<dyn Error>> {
    let mut counts = BTreeMap::new();
    for shot in SHOTS.into_iter().chain(STACKS) {
        let drawn = drawn::<Counted<GouraudDepth<Rgb565Be>>>(shot)?;
        counts.insert(shot.name(), drawn.1);
    }
    for scene in SCENES_B {
        counts.insert(scene.name, drawn_b::<Counted<LookB>>(scene)?.1);
    }
    for suite in SUITE {
        let (_, stats) = counted_suite(suite)?;
        counts.insert(suite.name(), stats);
    }
    Ok(counts)
}

/// A shot as a picture, and what its frame had.
///
/// # Errors
/// When a shot does not fit the arenas that it asks for.
pub fn picture(shot: Shot) -> Result<(Frame, FrameStats), Box<dyn Error>> {
    let (bytes, stats) = drawn::<Counted<GouraudDepth<Rgb565Be>>>(shot)?;
    Ok((framed(&bytes)?, stats))
}

/// A scene B as a picture, and what its frame had.
///
/// # Errors
/// As [`picture`].
pub fn picture_b(scene: SceneB) -> Result<(Frame, FrameStats), Box<dyn Error>> {
    let (bytes, stats) = drawn_b::<Counted<LookB>>(scene)?;
    Ok((framed(&bytes)?, stats))
}

/// A picture of the bytes of a shot in scan-out order.
fn framed(bytes: &[u8]) -> Result<Frame, Box<dyn Error>> {
    let words = bytes
        .chunks_exact(2)
        .map(|b| u16::from_ne_bytes([b[0], b[1]]));
    let rgb = words.flat_map(Rgb565Be::to_rgb8).collect();
    Ok(Frame::new(WIDTH.into(), HEIGHT.into(), rgb).ok_or("a frame of another size")?)
}

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

/// A scene of the suite as a picture of the rooms `scene`, `look` and `frame`.
///
/// # Errors
/// As [`picture`].
pub fn lean_picture(suite: Suite) -> Result<Frame, Box<dyn Error>> {
    framed(&lean_frame(suite)?)
}

/// A scene of the suite as a picture, and what its frame had.
///
/// # Errors
/// As [`picture`].
pub fn picture_suite(suite: Suite) -> Result<(Frame, FrameStats), Box<dyn Error>> {
    let (bytes, stats) = counted_suite(suite)?;
    Ok((framed(&bytes)?, stats))
}

fn counted_suite(suite: Suite) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>> {
    drawn_suite::<Counted<GouraudDepth<Rgb565Be>>, Counted<LookB>, Counted<LookF>>(suite)
}

/// The bytes of a scene of the suite in scan-out order, and what the frame had: by `P`, or where it
/// has a texture by `B` or `F`, whichever takes it.
fn drawn_suite<P, B, F>(suite: Suite) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>>
where
    P: Pipeline<Pixel = Rgb565Be>,
    B: Pipeline<
            Pixel = Rgb565Be,
            Shading = Textured<Gouraud>,
            Textures = <LookB as Pipeline>::Textures,
        >,
    F: Pipeline<
            Pixel = Rgb565Be,
            Shading = Textured<Gouraud>,
            Textures = <LookF as Pipeline>::Textures,
        >,
{
    match suite {
        Suite::B | Suite::BUnlit => textured_suite::<B>(suite, Textures(&TEXTURES_B)),
        Suite::F => textured_suite::<F>(suite, Textures(&TEXTURES_F)),
        _ => {
            let build = |scene: &mut Scene<'_, P>| {
                suite
                    .build(scene)
                    .map_err(|error| format!("{}: {error:?}", suite.name()))?;
                Ok(())
            };
            shown_over::<P, _>(suite.background(), build, by_lines)
        }
    }
}

fn textured_suite<P>(
    suite: Suite,
    textures: P::Textures,
) -> Result<(Vec<u8>, FrameStats), Box<dyn Error>>
where
    P: Pipeline<Pixel = Rgb565Be, Shading = Textured<Gouraud>>,
{
    let build = |scene: &mut Scene<'_, P>| {
        scene.set_textures(textures);
        suite
            .build_textured(Quality::Balanced, scene)
            .map_err(|error| format!("{}: {error:?}", suite.name()))?;
        Ok(())
    };
    shown_over::<P, _>(suite.background(), build, by_lines)
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

/// Scene B from a texture in rows, as it has to be from one in blocks, whatever its cache.
fn draw_rows_b(how: SceneB) -> Result<Vec<u8>, Box<dyn Error>> {
    type Rows<'t> = TexturedDepth<'t, Rgb565Be, Texture<Words<'t, u16>, Wrap>>;
    let size = TextureSize::new(TEXEL_SIDE, TEXEL_SIDE)?;
    let rows = [Texture::<_, Wrap>::new(Words(&TEXELS_PANEL[..]), size)?];
    Ok(textured_b::<Rows<'_>>(how, Textures(&rows))?.0)
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

/// The bytes of a shot as the hardware model draws it.
fn draw_by_model(shot: Shot) -> Result<Vec<u8>, Box<dyn Error>> {
    type Smooth = GouraudDepth<Rgb565Be>;
    let mut lines = ModelLines::new(WIDTH);
    let mut renderer = lines.renderer();
    let (bytes, _) = shown::<Smooth, _>(
        shot,
        |scene| build(shot, scene),
        |scene, pump, background| {
            draw_model_frame(scene, &mut renderer, pump, background, LINES)
                .map_err(|error| format!("{error:?}"))?;
            Ok(())
        },
    )?;
    Ok(bytes)
}

/// Draws a shot into a scene.
fn build<P: Pipeline>(shot: Shot, scene: &mut Scene<'_, P>) -> Result<(), Box<dyn Error>> {
    shot.build(scene)
        .map_err(|error| format!("{}: {error:?}", shot.name()))?;
    Ok(())
}

type Display = Pump<MockFrameBuffer<u16>>;

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
