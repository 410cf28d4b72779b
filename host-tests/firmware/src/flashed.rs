//! A scene that the host has laid into flash: one frame, its lines, and what memory it is lent.

use crate::CRC;
use crate::bench::Listed;
use crate::console::Console;
use crate::count::{Counter, INSTRUCTIONS_PER_TICK};
use crate::frames::{Emit, Receives};
use crate::profile;
use crate::rest::Regions;
use crate::rooms::{LineRooms, Rooms, SceneRooms};
use core::hint::black_box;
use scanbeam::frame::{FastMemory, FrameError, Memory, Renderer, draw_frame, draw_frame_indexed};
use scanbeam::input::{LightRoom, Player, PlayerMemory, TextureRoom};
use scanbeam::list::{ListCommand, TextureSlot};
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be, expand_indices};
use scanbeam::scan_out::{Pump, Window, send_doubled};
use scanbeam::scene::{CacheWord, DrawState, Object, ShadowEdge, Texture, TexturePlace, Vertex};
use scanbeam::{Camera, Link, Scene, Screen};
use scene_flash::{
    CACHED, CallMemory, Calls, Counts, FLASH_AT, FLASH_BYTES, Head, Kind, Level, LightMemory,
    Lights, List, ListRoom, Reader, Sheet, TextureMemory, VolumeMemory,
};

const GOOD: &str = "the host has drawn it";

/// Costs of a row that is printed.
const ROW: usize = 16;

/// Draws the scene, and prints its checksum and what it costs.
pub(crate) fn run(counter: &Counter, console: &mut Console) {
    // SAFETY: it is flash behind the code, where the host has put words; nothing writes there.
    let words: &'static [u32] =
        unsafe { core::slice::from_raw_parts(FLASH_AT as *const u32, FLASH_BYTES / 4) };
    let (head, reader) = Head::read(words).expect(GOOD);
    let mut regions = Regions::take();
    let rooms = Rooms::take();
    let caches = rooms.caches;
    let stage = Stage::new(&head, &mut regions);
    match head.kind {
        Kind::Smooth => by_calls(stage, reader, regions, caches.smooth, (counter, console)),
        Kind::Textured => by_calls(stage, reader, regions, caches.textured, (counter, console)),
        Kind::Phong => by_calls(stage, reader, regions, caches.lit, (counter, console)),
        Kind::TexturedPhong => by_calls(
            stage,
            reader,
            regions,
            caches.lit_texels,
            (counter, console),
        ),
        Kind::Indexed => by_indices(stage, reader, regions, caches.indexed, (counter, console)),
        Kind::ListSmooth => by_list(stage, reader, regions, caches.smooth, (counter, console)),
        Kind::ListTextured => by_list(stage, reader, regions, caches.textured, (counter, console)),
    }
}

/// Where it is counted and printed.
type Tell<'c> = (&'c Counter, &'c mut Console);

/// What frames are drawn in.
struct Stage {
    head: Head,
    camera: Camera,
    screen: Screen,
    scene: SceneRooms,
    lines: LineRooms,
    /// Counts of shadows on a line, where there are any.
    counts: &'static mut [u8],
    /// Two lines that are drawn, where others are sent.
    drawn: [&'static mut [u16]; 2],
    buffers: Option<[&'static mut [u16]; 2]>,
    background: u16,
}

impl Stage {
    fn new(head: &Head, regions: &mut Regions) -> Self {
        let [width, height] = head.size;
        let [vertices, objects, draws] =
            [head.room.vertices, head.room.objects, head.room.draws].map(|count| count as usize);
        let places = if head.kind.is_textured() { vertices } else { 0 };
        let drawn = if head.doubled { width } else { 0 };
        let sent = head.sent()[0];
        let (slow, fast, dma) = (&mut regions.slow, &mut regions.fast, &mut regions.dma);
        let scene = SceneRooms {
            vertices: slow.lend(vertices, || Vertex::EMPTY),
            places: slow.lend(places, || TexturePlace::EMPTY),
            objects: slow.lend(objects, || Object::EMPTY),
            bins: slow.lend(height.into(), || 0),
            draws: slow.lend(draws, || DrawState::EMPTY),
        };
        let lines = LineRooms {
            links: slow.lend(objects, || Link::EMPTY),
            depth: fast.lend(width.into(), || 0),
        };
        Self {
            head: *head,
            camera: head.camera().expect(GOOD),
            screen: Screen::new(width, height).expect(GOOD),
            scene,
            lines,
            counts: &mut [],
            drawn: [0; 2].map(|_| fast.lend(drawn.into(), || 0)),
            buffers: Some([0; 2].map(|_| dma.lend(sent.into(), || 0))),
            background: Rgb565Be::from_rgb8(head.background),
        }
    }

    /// Draws a frame of what `build` makes, a line a transfer; lines and columns doubled if the scene says so.
    fn frame<L: Look<Pixel = Rgb565Be>>(
        &mut self,
        cache: &mut FastMemory<L>,
        to: &mut dyn Receives,
        build: &mut dyn FnMut(&Camera, &mut Scene<'_, 'static, L>),
    ) {
        let mut scene = self.scene.sized(self.screen);
        build(&self.camera, &mut scene);
        let memory = Memory {
            cache,
            links: self.lines.links,
            depth: self.lines.depth,
        };
        let mut renderer = match self.counts.is_empty() {
            true => Renderer::new(memory),
            false => Renderer::with_shadows(memory, self.counts),
        };
        let mut pump = Pump::new(Emit::new(to), self.buffers.take().expect("they came back"));
        if self.head.doubled {
            let [width, height] = self.head.size;
            let window = Window {
                x: 0,
                y: 0,
                width,
                height,
            };
            let drawn = self.drawn.each_mut().map(|line| &mut line[..]);
            let draw = |line, pixels: &mut [u16]| {
                let drawn = renderer.draw_line(&scene, line, pixels, self.background);
                drawn.map(|_| ()).map_err(FrameError::Line)
            };
            send_doubled(&mut pump, window, 1, drawn, Rgb565Be::mix_lines, draw).expect(GOOD);
        } else {
            draw_frame(&scene, &mut renderer, &mut pump, self.background, 1).expect(GOOD);
        }
        if let (_, [Some(a), Some(b)]) = pump.release() {
            self.buffers = Some([a, b]);
        }
    }
}

/// Calls, and what shadow volumes are made in.
struct Called {
    calls: Calls<'static>,
    memory: VolumeMemory<'static>,
}

impl Called {
    /// Makes a scene of them.
    fn build<L: Look>(&mut self, camera: &Camera, scene: &mut Scene<'_, 'static, L>) {
        let drawn = self.calls.draw(camera, scene, &mut self.memory);
        drawn.expect(GOOD);
    }
}

/// Reads the calls. Their values take no memory of the scene: a firmware makes them as it goes.
fn read_calls(stage: &mut Stage, mut reader: Reader<'static>, regions: &mut Regions) -> Called {
    let counts = Counts::read(&mut reader).expect(GOOD);
    let (lights, textures) = (counts.lights, counts.textures);
    let caches = CACHED * textures.caches as usize;
    let slow = &mut regions.slow;
    let before = slow.lent;
    let lent = CallMemory {
        lights: LightMemory {
            lights: slow.lend(lights.lights as usize, || Lights::DARK),
            lightings: slow.lend(lights.lightings as usize, || None),
            lamps: slow.lend(lights.lamps as usize, || None),
        },
        textures: TextureMemory {
            sheets: slow.lend(textures.textures as usize, || Sheet::EMPTY),
            levels: slow.lend(textures.levels as usize, || Level::EMPTY),
            textures: slow.lend(textures.textures as usize, || Texture::EMPTY),
            others: slow.lend(textures.others as usize, || Texture::EMPTY),
            cached: regions.fast.lend(caches, CacheWord::new),
        },
        palettes: slow.lend(counts.palettes as usize, || (0, &[][..])),
        calls: slow.lend(counts.calls as usize, || Calls::EMPTY),
    };
    slow.lent = before;
    let thrown = counts.thrown as usize;
    let memory = VolumeMemory {
        edges: slow.lend(3 * thrown, ShadowEdge::default),
        positions: slow.lend(6 * thrown, || [0; 3]),
        faces: slow.lend(6 * thrown, || [0; 3]),
    };
    if counts.volumes > 0 {
        stage.counts = regions.fast.lend(stage.head.size[0].into(), || 0);
    }
    let calls = Calls::read::<Rgb565Be>(&mut reader, lent, &stage.camera, stage.screen);
    Called {
        calls: calls.expect(GOOD),
        memory,
    }
}

#[inline(never)]
fn by_calls<L: Look<Pixel = Rgb565Be>>(
    mut stage: Stage,
    reader: Reader<'static>,
    mut regions: Regions,
    cache: &mut FastMemory<L>,
    tell: Tell<'_>,
) {
    let mut called = read_calls(&mut stage, reader, &mut regions);
    let head = stage.head;
    measure(&head, (tell.0, &mut *tell.1), &mut |to| {
        stage.frame(cache, to, &mut |camera, scene| called.build(camera, scene));
    });
    figures(&regions, cache, tell.1);
}

#[inline(never)]
fn by_indices(
    mut stage: Stage,
    reader: Reader<'static>,
    mut regions: Regions,
    cache: &mut FastMemory<scenes::IndexedLook>,
    tell: Tell<'_>,
) {
    let mut called = read_calls(&mut stage, reader, &mut regions);
    let indices = regions.fast.lend(stage.head.size[0].into(), || 0);
    let head = stage.head;
    measure(&head, (tell.0, &mut *tell.1), &mut |to| {
        let mut scene = stage.scene.sized(stage.screen);
        called.build(&stage.camera, &mut scene);
        let mut renderer = stage.lines.renderer(cache);
        let buffers = stage.buffers.take().expect("they came back");
        let mut pump = Pump::new(Emit::new(to), buffers);
        let expand = |line, indices: &[u8], pixels: &mut [u16]| {
            if let Ok(palette) = called.calls.palette(line).try_into() {
                expand_indices::<u16, 256>(indices, palette, pixels);
            }
        };
        draw_frame_indexed(&scene, &mut renderer, &mut pump, 0, 1, indices, expand).expect(GOOD);
        if let (_, [Some(a), Some(b)]) = pump.release() {
            stage.buffers = Some([a, b]);
        }
    });
    figures(&regions, cache, tell.1);
}

#[inline(never)]
fn by_list<L: Look<Pixel = Rgb565Be>>(
    mut stage: Stage,
    mut reader: Reader<'static>,
    mut regions: Regions,
    cache: &mut FastMemory<L>,
    tell: Tell<'_>,
) {
    let list = List::read(&mut reader).expect(GOOD);
    let memory = player_memory(&list.room, &mut regions);
    let mut player = Player::<L>::new(memory, list.settings());
    // The first frame looks at the list, and makes its textures.
    let mut begin = ListCommand::Start(0);
    let head = stage.head;
    measure(&head, (tell.0, &mut *tell.1), &mut |to| {
        stage.frame(cache, to, &mut |camera, scene| {
            let played = list.play(&mut player, begin, camera, scene);
            played.expect(GOOD);
            begin = ListCommand::Restart;
        });
    });
    figures(&regions, cache, tell.1);
}

fn player_memory(room: &ListRoom, regions: &mut Regions) -> PlayerMemory<'static, 'static> {
    let slow = &mut regions.slow;
    let [table, indices, names, textures, texels, levels] = [
        room.table,
        room.indices,
        room.names,
        room.textures,
        room.texels,
        room.levels,
    ]
    .map(|count| count as usize);
    let places = if textures > 0 { table } else { 0 };
    PlayerMemory {
        positions: slow.lend(table, || [0; 3]),
        normals: slow.lend(table, || [0; 3]),
        colours: slow.lend(table, || [0; 3]),
        indices: slow.lend(indices, || 0),
        places: slow.lend(places, || [0; 2]),
        alphas: slow.lend(table, || 0),
        names: slow.lend(names, TextureSlot::new),
        textures: slow.lend(textures, || TextureRoom::EMPTY),
        texels: slow.lend(texels, || 0),
        levels: slow.lend(levels, || Texture::EMPTY),
        overlays: &[],
        lights: Some(slow.one(LightRoom::new)),
    }
}

/// Draws frames by `frame`, for their checksum, their instructions, and those of each line, and prints these.
fn measure(head: &Head, tell: Tell<'_>, frame: &mut dyn FnMut(&mut dyn Receives)) {
    let (counter, console) = tell;
    let mut digest = CRC.digest();
    frame(&mut |line: &[u8]| digest.update(line));
    let crc = digest.finalize();
    if profile::asks_steps() {
        return profile::marked(frame);
    }
    let instructions = counter.instructions(|| {
        frame(&mut |line: &[u8]| {
            black_box(line);
        });
    });
    console.line(format_args!(
        "frame scene=scene crc={crc:08x} instructions={instructions}"
    ));
    let mut clock = Clock {
        counter,
        last: counter.ticks(),
        pass_one: 0,
        ticks: [0; LINES],
        at: 0,
    };
    frame(&mut clock);
    let lines = clock.ticks.get(..head.sent()[1].into()).unwrap_or_default();
    let instructions = |ticks: u32| u64::from(ticks) * INSTRUCTIONS_PER_TICK;
    for (row, costs) in lines.chunks(ROW).enumerate() {
        console.line(format_args!(
            "lines scene=scene pass_one={} first={} costs={}",
            instructions(clock.pass_one),
            row * ROW,
            Listed(costs, instructions)
        ));
    }
}

/// Prints what was lent.
fn figures<L: Look>(regions: &Regions, cache: &FastMemory<L>, console: &mut Console) {
    for (name, value) in [
        ("slow_bytes", regions.slow.lent),
        ("fast_bytes", regions.fast.lent + size_of_val(cache)),
        ("line_bytes", regions.dma.lent),
    ] {
        console.line(format_args!("figure name={name} value={value}"));
    }
    console.line(format_args!("done frames=1"));
}

/// Lines that a picture may have.
const LINES: usize = scanbeam::scene::LARGEST as usize;

/// A sink that notes when lines arrive.
struct Clock<'c> {
    counter: &'c Counter,
    /// When the work began that is measured next.
    last: u64,
    pass_one: u32,
    /// Of each line.
    ticks: [u32; LINES],
    at: usize,
}

impl Clock<'_> {
    /// Ticks since the last call returned.
    fn lap(&mut self) -> u32 {
        let ticks = self.counter.ticks() - self.last;
        ticks.saturating_sub(self.counter.overhead()) as u32
    }
}

impl Receives for Clock<'_> {
    fn begin(&mut self) {
        self.pass_one = self.lap();
        self.last = self.counter.ticks();
    }

    fn transfer(&mut self, bytes: &[u8]) {
        let lap = self.lap();
        black_box(bytes);
        if let Some(slot) = self.ticks.get_mut(self.at) {
            *slot = lap;
        }
        self.at += 1;
        self.last = self.counter.ticks();
    }
}
