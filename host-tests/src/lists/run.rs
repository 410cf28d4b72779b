//! `run-list`: a list into a picture, as firmware would execute it.

use super::args::RunListArgs;
use super::heard::{self, Heard};
use super::{print, read_list};
use crate::image_out::{Frame, write_image};
use crate::mock::{HostLine, MockFrameBuffer};
use crate::reference::{Cull, Shade, View};
use crate::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::event::Notice;
use scanbeam::frame::draw_frame_overlaid;
use scanbeam::input::{LightRoom, Player, PlayerMemory, PlayerSettings, RunCounts, TextureRoom};
use scanbeam::list::{
    Budget, Halt, Head, Instruction, ListCommand, OverlaySlot, State, TextureSlot, TextureSlots,
    VertexFormat, read_block,
};
use scanbeam::look::Textured;
use scanbeam::overlay::ListOverlays;
use scanbeam::pixel::{PixelFormat, Rgb888};
use scanbeam::scan_out::Pump;
use scanbeam::scene::{Draw, Scene, Shading, Texture};
use scanbeam::{Camera, Faces, Light, Link, Mesh, Screen};
use std::error::Error;

/// Vertices that a table can have.
const TABLE: usize = 65_535;
/// Indices that are drawn together: a whole table's at twice as many triangles.
const INDICES: usize = 6 * TABLE;
/// Textures, palettes and pairs of both.
const TEXTURES: usize = 1024;
/// Overlays of a picture.
const OVERLAYS: usize = 256;
/// Draw calls of a picture.
const DRAWS: usize = 1 << 16;

/// The pixels, and what they look like.
type Look = Textured<Rgb888>;

/// Executes or prints a list.
///
/// # Errors
/// When the list cannot be read or is malformed, or the picture cannot be written.
pub fn run(args: &RunListArgs) -> Result<(), Box<dyn Error>> {
    let list = read_list(&args.list)?;
    let Some(output) = &args.output else {
        return print::print_file(&args.list, &list);
    };
    let ran = execute(&list, &args.picture.view(), Budget::of(args.budget))
        .map_err(|error| format!("{}: {error}", args.list.display()))?;
    write_image(output, &ran.frame)?;
    let file = args.list.display();
    if ran.halt != Halt::End {
        let (halt, at) = (ran.halt, 4 * ran.position);
        tell!("warning: {file}: halted at offset {at:#x}: {halt:?}");
    }
    heard::tell_all(file, &ran.events);
    if ran.is_textured {
        tell!("note: texels of textures are rounded to 5, 6 and 5 bits");
    }
    Ok(())
}

/// A picture of a list, and what it took.
#[derive(Debug, Clone)]
pub struct Ran {
    /// The picture.
    pub frame: Frame,
    /// Why it ended.
    pub halt: Halt,
    /// Word of the block that would come next.
    pub position: u32,
    /// Kinds of events but for the list's end and cut triangles.
    pub events: Heard,
    /// What the list did.
    pub counts: RunCounts,
    /// Whether it has textures.
    pub is_textured: bool,
}

/// What HEAD says, where a list begins with one.
#[must_use]
pub fn head(list: &[u32]) -> Option<Head> {
    match read_block(list, 0, &VertexFormat::default()).map(|p| p.instruction) {
        Ok(Instruction::State(State::Head(head))) => Some(head),
        _ => None,
    }
}

/// Draws a list.
///
/// # Errors
/// When the view cannot be had, or the list is malformed or asks for what players do not have.
pub fn execute(list: &[u32], view: &View, budget: Budget) -> Result<Ran, Box<dyn Error>> {
    let names: Vec<TextureSlot> = (0..TEXTURES).map(|_| TextureSlot::new()).collect();
    let overlays: Vec<OverlaySlot> = (0..OVERLAYS).map(|_| OverlaySlot::new()).collect();
    // Each may have a mask.
    let rooms = (0..2 * TEXTURES).map(|_| TextureRoom::EMPTY);
    let mut textures: Vec<TextureRoom<'_>> = rooms.collect();
    // Two texels a word of the list at most, in several forms; and palettes.
    let mut texels = vec![0; 2 * (4 * list.len() + 256 * TEXTURES)];
    let mut levels = vec![Texture::EMPTY; 2 * 3 * TEXTURES];
    let (mut positions, mut normals) = (vec![[0i32; 3]; TABLE], vec![[0; 3]; TABLE]);
    let (mut colours, mut places) = (vec![[0; 3]; TABLE], vec![[0; 2]; TABLE]);
    let (mut indices, mut lights) = (vec![0; INDICES], LightRoom::new());
    let mut alphas = vec![0; TABLE];
    let memory = PlayerMemory {
        positions: &mut positions,
        normals: &mut normals,
        colours: &mut colours,
        indices: &mut indices,
        places: &mut places,
        alphas: &mut alphas,
        names: &names,
        textures: &mut textures,
        texels: &mut texels,
        levels: &mut levels,
        overlays: &overlays,
        lights: Some(&mut lights),
    };
    let mut player = Player::<Look, i32>::new(memory, settings(view));
    let room = Room {
        vertices: 1 << 16,
        places: 1 << 16,
        objects: Link::CACHED.into(),
        draws: DRAWS,
    };
    let mut memory = SceneRooms::new(room, view.height as u16);
    let mut scene = memory.scene::<Look>(Screen::new(view.width as u16, view.height as u16)?);
    scene.begin(&camera(view)?)?;
    player.start(0);
    let mut events = Vec::new();
    let halt = play(list, &mut player, &mut scene, budget, &mut events)?;
    heard::keep_unusual(&mut events);
    let painted = ListOverlays {
        words: list,
        slots: &overlays,
    };
    // Any number may be one.
    Ok(Ran {
        frame: shown(&scene, view, painted)?,
        halt,
        position: player.position(),
        events,
        counts: player.counts(),
        is_textured: (0..=u8::MAX).any(|number| TextureSlots(&names).has(number)),
    })
}

/// What a list begins with.
fn settings(view: &View) -> PlayerSettings<'static, 'static> {
    let light = Light::new(view.light.map(|c| c as f32), view.ambient as f32);
    PlayerSettings {
        draw: Draw {
            cull: match view.cull {
                Cull::Back => scanbeam::Cull::Back,
                Cull::None => scanbeam::Cull::None,
            },
            light: light.filter(|_| view.shade != Shade::None),
            shading: match view.shade {
                Shade::Flat => Shading::Flat,
                Shade::None | Shade::Gouraud => Shading::Smooth,
            },
            ..Draw::new(Mesh {
                positions: &[],
                normals: &[],
                colours: &[],
                faces: Faces::Triangles(&[]),
            })
        },
        camera: true,
        ..PlayerSettings::default()
    }
}

fn camera(view: &View) -> Result<Camera, Box<dyn Error>> {
    let [eye, at, up] = [view.eye, view.at, view.up].map(|v| v.map(|c| c as f32));
    let focal = f64::from(view.height) / 2.0 / (view.fov.to_radians() / 2.0).tan();
    let (near, far) = (view.near as f32, view.far as f32);
    Ok(Camera::look_at(eye, at, up, focal as f32, near, far)?)
}

/// Plays it to its end: a picture has no later frame to wait for, so pauses and syncs are passed over. Why it ended;
/// events are counted as [`Ran`] has them.
fn play<'t>(
    list: &'t [u32],
    player: &mut Player<'_, 't, Look, i32>,
    scene: &mut Scene<'_, 't, Look>,
    mut budget: Budget,
    events: &mut Heard,
) -> Result<Halt, Box<dyn Error>> {
    let mut note = |notice: Notice| heard::hear(events, notice);
    loop {
        match player.run(list, scene, &mut budget, &mut note)? {
            Halt::Sync => {}
            Halt::Paused => player.command(ListCommand::Resume),
            halt => return Ok(halt),
        }
    }
}

/// The picture of a scene, with overlays over it.
fn shown(
    scene: &Scene<'_, '_, Look>,
    view: &View,
    overlays: ListOverlays<'_>,
) -> Result<Frame, Box<dyn Error>> {
    let (width, height) = (view.width as u16, view.height as u16);
    let mut rooms = LineRooms::<Look>::new(scene.objects(), width);
    let mut renderer = rooms.renderer();
    let words = usize::from(width);
    let sink = MockFrameBuffer::new(width, height);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let background = Rgb888::from_rgb8(view.background);
    let paint = |line, pixels: &mut [[u8; 3]]| overlays.paint::<Rgb888>(line, pixels);
    draw_frame_overlaid(scene, &mut renderer, &mut pump, background, 1, paint)
        .map_err(|error| format!("display: {error}"))?;
    let pixels = pump.sink().frame().map_err(|e| format!("display: {e:?}"))?;
    let rgb = pixels.into_iter().flat_map(Rgb888::to_rgb8).collect();
    Frame::new(view.width, view.height, rgb).ok_or("the picture has another size".into())
}
