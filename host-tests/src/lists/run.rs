//! `run-list`: a list into a picture, as firmware would execute it.

use super::args::RunListArgs;
use super::{print, read_list};
use crate::image_out::{Frame, write_image};
use crate::lent::{LineRooms, SceneRooms};
use crate::mock::{HostLine, MockFrameBuffer};
use crate::reference::{Cull, Shade, View};
use scanbeam::event::{Event, Notice};
use scanbeam::input::{EightLights, ListMemory, ListRunner, ListSettings, RunCounts};
use scanbeam::list::{
    Budget, Halt, Head, Instruction, OverlaySlot, State, TextureSlot, VertexFormat, read_block,
};
use scanbeam::overlay::{ListOverlays, draw_frame_overlaid};
use scanbeam::pipeline::texture::{ListTextures, Textured};
use scanbeam::pipeline::{Composited, Depth32, Flat, Gouraud, Instance, Packed8, Parts, Pipeline};
use scanbeam::pixel::{PixelFormat, Rgb888};
use scanbeam::scan_out::Pump;
use scanbeam::stats::SpanCounts;
use scanbeam::{Affine, Camera, Light, Link, Screen};
use std::error::Error;

/// Vertices that a table can have.
const TABLE: usize = 65_535;
/// Indices that are drawn together: a whole table's at twice as many triangles.
const INDICES: usize = 6 * TABLE;
/// Textures, palettes and pairs of both.
const TEXTURES: usize = 1024;
/// Overlays of a picture.
const OVERLAYS: usize = 256;
/// Slots of the object cache.
const SLOTS: usize = 64;

/// Executes or prints a list.
///
/// # Errors
/// When the list cannot be read or is malformed, or the picture cannot be written.
pub fn run(args: &RunListArgs) -> Result<(), Box<dyn Error>> {
    let list = read_list(&args.list)?;
    let Some(output) = &args.output else {
        return print::print(&list);
    };
    let ran = execute(&list, &args.picture.view(), Budget::of(args.budget))
        .map_err(|error| format!("{}: {error}", args.list.display()))?;
    write_image(output, &ran.frame)?;
    let file = args.list.display();
    if ran.halt != Halt::End {
        let (halt, at) = (ran.halt, 4 * ran.position);
        tell!("warning: {file}: halted at offset {at:#x}: {halt:?}");
    }
    for (event, offset, times) in &ran.events {
        tell!("warning: {file}: {event:?}, first at offset {offset:#x}, {times} times");
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
    /// Kinds of events but for the list's end, offset of the first, how many.
    pub events: Vec<(Event, u32, u32)>,
    /// What the list did.
    pub counts: RunCounts,
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
/// When the view cannot be had, or the list is malformed.
pub fn execute(list: &[u32], view: &View, budget: Budget) -> Result<Ran, Box<dyn Error>> {
    let slots: Vec<TextureSlot> = (0..TEXTURES).map(|_| TextureSlot::new()).collect();
    let textures = ListTextures {
        words: list,
        slots: &slots,
    };
    let slots: Vec<OverlaySlot> = (0..OVERLAYS).map(|_| OverlaySlot::new()).collect();
    let overlays = ListOverlays {
        words: list,
        slots: &slots,
    };
    match view.shade {
        Shade::Flat => execute_as::<Look<'_, Flat>>((textures, overlays), view, budget),
        _ => execute_as::<Look<'_, Gouraud>>((textures, overlays), view, budget),
    }
}

/// A shading times the list's textures, of surfaces that may be transparent.
type Look<'t, S> =
    Composited<Parts<Textured<S>, Depth32, Rgb888, SpanCounts, Packed8, ListTextures<'t>>>;

fn execute_as<'t, P>(
    (textures, overlays): (ListTextures<'t>, ListOverlays<'t>),
    view: &View,
    mut budget: Budget,
) -> Result<Ran, Box<dyn Error>>
where
    P: Pipeline<Pixel = Rgb888, Textures = ListTextures<'t>>,
{
    let list = textures.words;
    let (width, height) = (view.width as u16, view.height as u16);
    let single = |v: [f64; 3]| v.map(|c| c as f32);
    let focal = f64::from(view.height) / 2.0 / (view.fov.to_radians() / 2.0).tan();
    let camera = Camera::look_at(
        single(view.eye),
        single(view.at),
        single(view.up),
        focal as f32,
        view.near as f32,
        view.far as f32,
    )?;
    let mut lent = SceneRooms::<P>::new(1 << 16, usize::from(Link::CACHED), height.into());
    let mut scene = lent.scene(Screen::new(width, height)?);
    scene.begin(&camera)?;
    scene.set_textures(textures);

    let mut positions = vec![[0i32; 3]; TABLE];
    let mut normals = vec![[0; 3]; TABLE];
    let mut colours = vec![[0; 3]; TABLE];
    let mut indices = vec![0; INDICES];
    let mut places = vec![[0; 2]; TABLE];
    let light = Light::new(single(view.light), view.ambient as f32);
    let mut runner = ListRunner::<'_, '_, _, EightLights>::with_lights(
        ListMemory {
            positions: &mut positions,
            normals: &mut normals,
            colours: &mut colours,
            indices: &mut indices,
            places: &mut places,
            textures: textures.slots,
            overlays: overlays.slots,
        },
        ListSettings {
            instance: Instance {
                model: Affine::IDENTITY,
                cull: match view.cull {
                    Cull::Back => scanbeam::Cull::Back,
                    Cull::None => scanbeam::Cull::None,
                },
                light: light.filter(|_| view.shade != Shade::None),
                colour: [255; 3],
            },
            camera: true,
            ..ListSettings::default()
        },
    );
    runner.start(0);
    let mut events: Vec<(Event, u32, u32)> = Vec::new();
    let mut note = |n: Notice| match events.iter_mut().find(|e| e.0 == n.event) {
        Some(known) => known.2 += 1,
        None => events.push((n.event, n.offset, 1)),
    };
    // A picture has no later frame to wait for: pauses and syncs are passed over.
    let halt = loop {
        let halt = runner.run(list, &mut scene, &mut budget, &mut note)?;
        match halt {
            Halt::Sync => {}
            Halt::Paused => runner.command(scanbeam::list::ListCommand::Resume),
            halt => break halt,
        }
    };
    events.retain(|e| !matches!(e.0, Event::ListEnd | Event::Clipped));

    let mut rooms = LineRooms::<P>::new(SLOTS, usize::from(Link::CACHED), width.into());
    let mut renderer = rooms.renderer();
    let words = usize::from(width);
    let sink = MockFrameBuffer::new(width, height);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let background = Rgb888::from_rgb8(view.background);
    draw_frame_overlaid(&scene, &mut renderer, &mut pump, background, 1, overlays)
        .map_err(|error| format!("display: {error}"))?;
    let pixels = pump.sink().frame().map_err(|e| format!("display: {e:?}"))?;
    let rgb = pixels.into_iter().flat_map(Rgb888::to_rgb8).collect();
    Ok(Ran {
        frame: Frame::new(view.width, view.height, rgb).ok_or("the picture has another size")?,
        halt,
        position: runner.position(),
        events,
        counts: runner.counts(),
    })
}
