//! The frames of the firmware as this machine draws them: their checksums, what they have, and pictures of them.

mod paced;
mod played;
mod values;

pub use paced::{PacedFrame, paced_frame, reckoned_lines};
pub use played::played_frame;
pub use values::{Sent, values_pictures, values_sent};

use host_draw::ModelLines;
use host_support::image_out::Frame as Picture;
use host_support::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::Scene;
use scanbeam::look::Look;
use scanbeam::mesh::Meshlet;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{Assembled, Shading};
use scanbeam::stats::SpanCounts;
use scenes::{
    CutMemory, DRAWS, Frame, GreyLook, HEIGHT, InFormat, InParts, LitBytesLook, LitWordsLook,
    NumbersLook, OBJECTS, PhongLook, SceneB, Shot, ShotError, SmoothLook, Suite, TexturedLook,
    TexturedPhongLook, TrueColourLook, TrueColourTexturedLook, VERTICES, WIDTH, build_in_format,
    build_lit, build_smooth, frames, lamplit_teapot, teapot_lamps,
};
use std::collections::BTreeMap;
use std::error::Error;

/// Memory for each frame that has the size of a shot.
const ROOM: Room = Room {
    vertices: VERTICES,
    places: VERTICES,
    objects: OBJECTS,
    draws: DRAWS,
};

/// What a frame has.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct FrameCounts {
    /// Pass one.
    pub pass_one: Assembled,
    /// Triangles that were filed.
    pub objects: usize,
    /// Along spans.
    pub spans: SpanCounts,
}

/// A frame: its words in scan-out order, as an SPI panel takes them when nothing else is said, and what it has.
#[derive(Clone, Debug, PartialEq, Eq)]
pub struct Drawn<W = u16> {
    /// From left to right, and down.
    pub words: Vec<W>,
    /// Of triangles and spans.
    pub counts: FrameCounts,
}

impl Drawn {
    /// The checksum that the firmware has of the same bytes.
    #[must_use]
    pub fn crc(&self) -> u32 {
        crc(&self.words)
    }

    /// A picture of it.
    ///
    /// # Errors
    /// When it has another size than a shot.
    pub fn picture(&self) -> Result<Picture, Box<dyn Error>> {
        picture_of(&self.words)
    }
}

/// The checksums of all frames as this machine draws them, by name. However the firmware draws a shot, it is what one
/// renderer draws here.
///
/// # Errors
/// When a frame does not fit the memory that it asks for.
pub fn host_frames() -> Result<BTreeMap<&'static str, u32>, Box<dyn Error>> {
    let mut known: Vec<(Shot, Shading, u32)> = Vec::new();
    let mut all = BTreeMap::new();
    for (name, frame) in frames() {
        let crc = match frame {
            Frame::Suite(suite) => suite_frame(suite)?.crc(),
            Frame::InParts(suite) => in_parts_frame(suite)?.crc(),
            Frame::Paced(paced) => paced_frame(paced)?.crc(),
            Frame::Values(values) => crc(&values_sent(values, 64)?.words),
            Frame::Played(played) => played_frame(played)?.crc(),
            Frame::B(scene) => scene_b_frame(scene)?.crc(),
            Frame::Model(shot) => crc(&model_words(shot)?),
            Frame::Format(format) => crc32fast::hash(&bytes_in_format(format)?),
            Frame::Shot(how) => {
                let (shot, shading) = (how.shot, how.shading);
                let before = known.iter().find(|one| (one.0, one.1) == (shot, shading));
                match before {
                    Some((_, _, crc)) => *crc,
                    None => {
                        let crc = shot_frame(shot, shading)?.crc();
                        known.push((shot, shading, crc));
                        crc
                    }
                }
            }
        };
        all.insert(name, crc);
    }
    Ok(all)
}

/// A picture of the words of a shot.
fn picture_of(words: &[u16]) -> Result<Picture, Box<dyn Error>> {
    let rgb = words.iter().copied().flat_map(Rgb565Be::to_rgb8);
    let picture = Picture::new(WIDTH.into(), HEIGHT.into(), rgb.collect());
    Ok(picture.ok_or("a frame of another size")?)
}

/// The CRC-32 of words in scan-out order.
fn crc(words: &[u16]) -> u32 {
    let bytes: Vec<u8> = words.iter().flat_map(|word| word.to_ne_bytes()).collect();
    crc32fast::hash(&bytes)
}

/// What frames have, by name: those of the suite, of shots that are not there for their slots, and of scene B.
///
/// # Errors
/// As [`host_frames`].
pub fn host_counts() -> Result<BTreeMap<&'static str, FrameCounts>, Box<dyn Error>> {
    let mut counts = BTreeMap::new();
    for (name, frame) in frames() {
        let drawn = match frame {
            Frame::Suite(suite) => suite_frame(suite)?,
            Frame::InParts(suite) => in_parts_frame(suite)?,
            Frame::Shot(how) if how.shot.name() == name => shot_frame(how.shot, how.shading)?,
            Frame::B(scene) => scene_b_frame(scene)?,
            _ => continue,
        };
        counts.insert(name, drawn.counts);
    }
    Ok(counts)
}

/// A scene of the suite.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn suite_frame(suite: Suite) -> Result<Drawn, Box<dyn Error>> {
    let background = suite.background();
    if suite.texture().is_some() {
        drawn::<TexturedLook>(background, |scene| said(suite.name(), suite.build(scene)))
    } else {
        drawn::<SmoothLook>(background, |scene| said(suite.name(), suite.build(scene)))
    }
}

/// A scene of the suite whose mesh is drawn in parts.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn in_parts_frame(suite: Suite) -> Result<Drawn, Box<dyn Error>> {
    let (mut faces, mut parts) = (
        vec![[0; 3]; CutMemory::FACES],
        vec![Meshlet::EMPTY; CutMemory::PARTS],
    );
    let mut vertices = vec![0; CutMemory::VERTICES];
    let mut memory = CutMemory {
        faces: &mut faces,
        parts: &mut parts,
        vertices: &mut vertices,
    };
    let cut = InParts::new(suite, &mut memory)?;
    let name = suite.name();
    drawn::<SmoothLook>(suite.background(), |scene| said(name, cut.build(scene)))
}

/// A shot, with colours of faces from there.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn shot_frame(shot: Shot, shading: Shading) -> Result<Drawn, Box<dyn Error>> {
    drawn::<SmoothLook>(shot.background(), |scene| {
        said(shot.name(), shot.build_shaded(shading, scene))
    })
}

/// Scene B on the upright sphere.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn scene_b_frame(how: SceneB) -> Result<Drawn, Box<dyn Error>> {
    drawn::<TexturedLook>(Shot::Sphere.background(), |scene| {
        said(how.name, how.build(scene))
    })
}

/// The words of a shot as the hardware model draws it.
fn model_words(shot: Shot) -> Result<Vec<u16>, Box<dyn Error>> {
    let mut memory = SceneRooms::new(ROOM, HEIGHT);
    let mut scene: Scene<'_, '_, SmoothLook> = memory.scene(Shot::screen());
    said(shot.name(), shot.build(&mut scene))?;
    let mut lines = ModelLines::new(WIDTH);
    let mut renderer = lines.renderer();
    let background = Rgb565Be::from_rgb8(shot.background());
    let (mut words, mut line) = (Vec::new(), vec![background; WIDTH.into()]);
    for y in scene.lines() {
        renderer.draw_line(&scene, y, background, &mut line)?;
        words.extend_from_slice(&line);
    }
    Ok(words)
}

/// The bytes of a scene in other pixels than an SPI panel's, as this machine has them in memory.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn bytes_in_format(format: InFormat) -> Result<Vec<u8>, Box<dyn Error>> {
    match format {
        InFormat::Suite(suite) if suite.texture().is_some() => {
            suite_bytes::<TrueColourTexturedLook>(suite)
        }
        InFormat::Suite(suite) => suite_bytes::<TrueColourLook>(suite),
        InFormat::SuiteNumbers(suite) => suite_bytes::<NumbersLook>(suite),
        InFormat::Slivers => {
            let shot = Shot::Slivers;
            bytes_by::<TrueColourLook>(shot.background(), |scene| {
                said(shot.name(), shot.build(scene))
            })
        }
        InFormat::LitBytes => lit_bytes::<LitBytesLook>(),
        InFormat::LitWords => lit_bytes::<LitWordsLook>(),
        InFormat::Grey => smooth_bytes::<GreyLook>(),
        InFormat::Numbers => smooth_bytes::<NumbersLook>(),
    }
}

fn suite_bytes<L: Look>(suite: Suite) -> Result<Vec<u8>, Box<dyn Error>> {
    bytes_by::<L>(suite.background(), |scene| {
        said(suite.name(), build_in_format(suite, scene))
    })
}

fn smooth_bytes<L: Look>() -> Result<Vec<u8>, Box<dyn Error>> {
    bytes_by::<L>(Suite::Teapot.background(), |scene| {
        said("smooth", build_smooth(scene))
    })
}

fn lit_bytes<L: Look>() -> Result<Vec<u8>, Box<dyn Error>> {
    let lamps = teapot_lamps().map_err(|error| format!("{error:?}"))?;
    bytes_by::<L>(Suite::Teapot.background(), |scene| {
        said("lit", build_lit(&lamps, scene))
    })
}

fn bytes_by<'t, L: Look>(
    background: [u8; 3],
    build: impl FnOnce(&mut Scene<'_, 't, L>) -> Result<(), String>,
) -> Result<Vec<u8>, Box<dyn Error>> {
    let drawn = drawn(background, build)?;
    Ok(bytemuck::cast_slice(&drawn.words).to_vec())
}

/// The teapot with light at each pixel.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn lamplit_frame() -> Result<Drawn, Box<dyn Error>> {
    let lamps = teapot_lamps().map_err(|error| format!("{error:?}"))?;
    drawn::<PhongLook>(Shot::Teapot.background(), |scene| {
        said("teapot_lamplit", lamplit_teapot(&lamps, scene))
    })
}

/// The teapot in smooth colours, by the look that has every other way too.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn untextured_frame() -> Result<Drawn, Box<dyn Error>> {
    let teapot = Suite::Teapot;
    drawn::<TexturedPhongLook>(teapot.background(), |scene| {
        said("teapot_untextured", teapot.build(scene))
    })
}

/// A shot as a picture, and what its frame had.
///
/// # Errors
/// When it does not fit the memory that it asks for.
pub fn picture(shot: Shot) -> Result<(Picture, FrameCounts), Box<dyn Error>> {
    let drawn = shot_frame(shot, Shading::Smooth)?;
    Ok((drawn.picture()?, drawn.counts))
}

/// A scene B as a picture, and what its frame had.
///
/// # Errors
/// As [`picture`].
pub fn picture_b(scene: SceneB) -> Result<(Picture, FrameCounts), Box<dyn Error>> {
    let drawn = scene_b_frame(scene)?;
    Ok((drawn.picture()?, drawn.counts))
}

/// A scene of the suite as a picture, and what its frame had.
///
/// # Errors
/// As [`picture`].
pub fn picture_suite(suite: Suite) -> Result<(Picture, FrameCounts), Box<dyn Error>> {
    let drawn = suite_frame(suite)?;
    Ok((drawn.picture()?, drawn.counts))
}

/// An error with the name of what it is of.
fn said(name: &str, built: Result<(), ShotError>) -> Result<(), String> {
    built.map_err(|error| format!("{name}: {error:?}"))
}

type WordOf<L> = <<L as Look>::Pixel as PixelFormat>::Word;

/// A scene that `build` makes.
fn drawn<'t, L: Look>(
    background: [u8; 3],
    build: impl FnOnce(&mut Scene<'_, 't, L>) -> Result<(), String>,
) -> Result<Drawn<WordOf<L>>, Box<dyn Error>> {
    let screen = Shot::screen();
    let mut memory = SceneRooms::new(ROOM, screen.height());
    let mut scene = memory.scene(screen);
    build(&mut scene)?;
    let mut lines: LineRooms<L> = LineRooms::new(OBJECTS, screen.width());
    let mut renderer = lines.renderer().counting();
    let background = L::Pixel::from_rgb8(background);
    let (mut words, mut line) = (Vec::new(), vec![background; screen.width().into()]);
    for y in scene.lines() {
        renderer.draw_line(&scene, y, &mut line, background)?;
        words.extend_from_slice(&line);
    }
    let counts = FrameCounts {
        pass_one: scene.assembled(),
        objects: scene.objects(),
        spans: renderer.spans(),
    };
    Ok(Drawn { words, counts })
}
