//! `demo`: one full turn of the Utah teapot, drawn as firmware would draw it, and what it took.
//!
//! Every frame goes through both passes and the pump into the mocked display, which refuses
//! missing, repeated and disordered lines; the pictures are what arrived there. The memory lent is
//! as small as a microcontroller's, and the tables say how much of it was used (M4, S5, K12).

use crate::args::{ChangedArg, DemoArgs};
use crate::image_out::{Frame, ImageError, make_folder, write_animation, write_image, write_strip};
use crate::mock::{HostLine, MockFrameBuffer};
use crate::rooms::{LineRooms, Room, SceneRooms};
use comfy_table::{Cell, CellAlignment, Table, presets::UTF8_FULL_CONDENSED};
use indicatif::{ProgressBar, ProgressStyle};
use scanbeam::frame::{FastMemory, FrameUse, draw_frame_changed, draw_frame_changed_runs};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{Pump, ShownLines, ShownRuns};
use scanbeam::scene::{DrawState, Object, Vertex};
use scanbeam::{Affine, Camera, Draw, Light, Link, Renderer, Scene, Screen, draw_frame};
use scenes::TEAPOT;
use std::error::Error;
use std::f32::consts::TAU;
use std::fmt::Display;
use std::path::{Path, PathBuf};

/// Pixels a line.
pub const WIDTH: u16 = 320;
/// Lines.
pub const HEIGHT: u16 = 240;
/// The colour where nothing is, 8-bit levels.
pub const BACKGROUND: [u8; 3] = [34, 42, 56];

/// Smooth colours, 16-bit pixels as an SPI panel takes them.
type Look = Gouraud<Rgb565Be>;
/// What holds a pixel on its way to the panel.
type Word = <Rgb565Be as PixelFormat>::Word;

/// Slots of the object cache.
const SLOTS: usize = 64;
/// What the scene has room for: a teapot that is never clipped has 1,178 vertices, and about half of its 2,256
/// triangles look away.
const ROOM: Room = Room {
    vertices: 1_184,
    places: 0,
    objects: 1_280,
    draws: 1,
};
/// Lines of one transfer, and of each of the two line buffers.
const LINES: u16 = 8;
/// Polls that the mocked display is late by, so that the pump has to wait.
const LATE: u32 = 2;

/// Frames of the strip, at most.
const STRIP_FRAMES: usize = 6;
/// Milliseconds of the animated turn, and the bounds of one frame.
const TURN_MS: u32 = 4_000;
const FRAME_MS: (u32, u32) = (20, 500);

/// Where the eye is, what it looks at, the focal length in pixels.
const EYE: [f32; 3] = [0.0, 1.45, 3.7];
const AT: [f32; 3] = [0.0, -0.03, 0.0];
const FOCAL: f32 = 570.0;
/// Towards the light: from the upper left, and a little behind the viewer.
const LIGHT: [f32; 3] = [-0.9, 0.8, 0.55];
const AMBIENT: f32 = 0.14;
/// Columns and lines of a cell, of which runs are sent.
const CELL: (u16, u16) = (16, LINES);
/// What is kept of what is shown, by cells.
const CELLS: usize = ShownRuns::words(WIDTH, HEIGHT, CELL.0, CELL.1);
/// Brass.
const COLOUR: [u8; 3] = [255, 176, 84];
/// The turn of the first frame in radians: the spout to the right, towards the viewer.
const FIRST_TURN: f32 = -0.4;

/// Draws the turn, writes the pictures and prints what it took.
///
/// # Errors
/// When the folder or a picture cannot be written. Drawing fails only when this file lends too
/// little memory.
pub fn run(args: &DemoArgs) -> Result<(), Box<dyn Error>> {
    let folder = &args.output;
    make_folder(folder)?;
    // Draws nothing when stderr is not a terminal.
    let style = ProgressStyle::with_template("{msg} {wide_bar} {pos}/{len} frames")?;
    let bar = ProgressBar::new(u64::from(args.frames))
        .with_style(style)
        .with_message("drawing");
    let turn = Turn::draw(args.frames, args.changed, &|| bar.inc(1))?;
    bar.finish_and_clear();
    let pictures = turn.write(folder)?;

    say!("The Utah teapot, one turn of {} frames.", args.frames);
    say!("{WIDTH}x{HEIGHT} pixels of 16 bits, {LINES} lines a transfer.\n");
    say!("{}\n", turn.figures());
    say!("{}\n", turn.memory());
    say!("Pictures:");
    for picture in pictures {
        say!("  {}", picture.display());
    }
    Ok(())
}

/// All frames of a turn.
pub struct Turn {
    /// What the display shows.
    pub frames: Vec<Frame>,
    /// What each frame took.
    pub took: Vec<Took>,
}

/// What the display shows, by what can be sent alone.
struct Shown<'m> {
    lines: ShownLines<'m>,
    cells: ShownRuns<'m>,
}

impl Shown<'_> {
    /// Sends a frame, or what changes of it.
    fn send(
        &mut self,
        changed: ChangedArg,
        scene: &Scene<'_, '_, Look>,
        renderer: &mut Renderer<'_, Look>,
        pump: &mut Pump<MockFrameBuffer<Word>>,
    ) -> Result<FrameUse, Box<dyn Error>> {
        let (background, nothing) = (Rgb565Be::from_rgb8(BACKGROUND), |_, _: &mut [Word]| {});
        let (lines, cells) = (&mut self.lines, &mut self.cells);
        Ok(match changed {
            ChangedArg::All => draw_frame(scene, renderer, pump, background, LINES)?,
            ChangedArg::Lines => {
                draw_frame_changed(scene, renderer, pump, background, LINES, lines, nothing)?
            }
            ChangedArg::Runs => {
                let high = CELL.1;
                draw_frame_changed_runs(scene, renderer, pump, background, high, cells, nothing)?
            }
        })
    }
}

/// What a frame took.
pub struct Took {
    /// By pass one and two, and on the wire.
    pub frame: FrameUse,
    /// Triangles of the scene.
    pub objects: usize,
    /// Vertices of the scene.
    pub vertices: usize,
}

impl Turn {
    /// Draws `count` frames, each one the same angle on, sends what changes, and calls `done` after each.
    ///
    /// # Errors
    /// When a frame cannot be drawn or sent.
    pub fn draw(count: u32, changed: ChangedArg, done: &dyn Fn()) -> Result<Self, Box<dyn Error>> {
        let mut memory = SceneRooms::new(ROOM, HEIGHT);
        let mut scene = memory.scene::<Look>(Screen::new(WIDTH, HEIGHT)?);
        let mut lines: LineRooms<Look> = LineRooms::new(ROOM.objects, WIDTH);
        let mut renderer = lines.renderer();
        let words = usize::from(WIDTH * LINES);
        let sink = MockFrameBuffer::new(WIDTH, HEIGHT).late_by(LATE);
        let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);

        let (mut hashes, mut cells) = (vec![0; HEIGHT.into()], vec![0; CELLS]);
        let mut shown = Shown {
            lines: ShownLines::new(&mut hashes),
            cells: ShownRuns::new(&mut cells, WIDTH, CELL.0, CELL.1),
        };
        let camera = Camera::look_at(EYE, AT, [0.0, 1.0, 0.0], FOCAL, 0.1, 100.0)?;
        let light = Light::new(LIGHT, AMBIENT);
        let mut turn = Self {
            frames: Vec::new(),
            took: Vec::new(),
        };
        for frame in 0..count {
            let angle = FIRST_TURN + TAU * frame as f32 / count as f32;
            scene.begin(&camera)?;
            scene.draw(&Draw {
                model: Affine::rotation_y(angle),
                light,
                colour: COLOUR,
                ..Draw::new(TEAPOT)
            })?;
            pump.sink_mut().next_frame();
            let frame = shown.send(changed, &scene, &mut renderer, &mut pump)?;
            turn.took.push(Took {
                frame,
                objects: scene.objects(),
                vertices: scene.vertices(),
            });
            // What the display shows, lines of earlier frames among it.
            let pixels: Option<Vec<u16>> = pump.sink().shown().iter().copied().collect();
            let pixels = pixels.ok_or("a line never arrived")?;
            let rgb = pixels.into_iter().flat_map(Rgb565Be::to_rgb8).collect();
            let frame = Frame::new(u32::from(WIDTH), u32::from(HEIGHT), rgb);
            turn.frames
                .push(frame.ok_or("the display has another size")?);
            done();
        }
        Ok(turn)
    }

    /// Writes the pictures into `folder` and returns their paths.
    fn write(&self, folder: &Path) -> Result<[PathBuf; 3], ImageError> {
        let count = self.frames.len();
        let paths = ["teapot.png", "strip.png", "turn.png"].map(|name| folder.join(name));
        let [still, strip, animation] = &paths;
        let first = self.frames.first().ok_or_else(|| ImageError {
            file: still.clone(),
            reason: "no frames".into(),
        })?;
        write_image(still, first)?;
        let shown = count.min(STRIP_FRAMES);
        let some: Vec<Frame> = (0..shown)
            .map(|i| self.frames[i * count / shown].clone())
            .collect();
        write_strip(strip, &some)?;
        let frame_ms = (TURN_MS / count as u32).clamp(FRAME_MS.0, FRAME_MS.1);
        write_animation(animation, &self.frames, frame_ms as u16)?;
        Ok(paths)
    }

    /// What each frame took.
    fn figures(&self) -> Table {
        type Figure = (&'static str, fn(&Took) -> u64);
        const FIGURES: [Figure; 14] = [
            ("triangles in", |t| t.frame.assembled.triangles.into()),
            ("triangles culled", |t| t.frame.assembled.culled.into()),
            ("triangles kept", |t| t.objects as u64),
            ("lines with nothing on", |t| t.frame.lines_skipped.into()),
            ("found a slot", |t| t.frame.cache.hits.into()),
            ("found none", |t| t.frame.cache.spilled.into()),
            ("found one later", |t| t.frame.cache.moved_in.into()),
            ("lines from slow RAM", |t| t.frame.cache.misses.into()),
            ("set-ups", |t| t.frame.cache.set_ups.into()),
            ("peak cache slots", |t| t.frame.cache.peak.into()),
            ("bytes sent", |t| t.frame.scan_out.bytes_sent),
            ("transfers", |t| t.frame.scan_out.transfers.into()),
            ("lines not sent", |t| t.frame.scan_out.lines_unsent.into()),
            ("bytes not sent", |t| t.frame.scan_out.bytes_unsent),
        ];
        let mut table = table(["per frame", "min", "median", "max"]);
        for (name, figure) in FIGURES {
            let mut values: Vec<u64> = self.took.iter().map(figure).collect();
            values.sort_unstable();
            let at = |index: usize| number(values.get(index).copied().unwrap_or(0));
            let last = values.len().saturating_sub(1);
            table.add_row([Cell::new(name), at(0), at(values.len() / 2), at(last)]);
        }
        table
    }

    /// The memory that was lent, fast and slow, and how much of it the largest frame used.
    pub fn lent(&self) -> [Vec<Lent>; 2] {
        let most = |figure: fn(&Took) -> usize| self.took.iter().map(figure).max().unwrap_or(0);
        let objects = most(|t| t.objects);
        let vertices = most(|t| t.vertices);
        let slots = most(|t| t.frame.cache.peak as usize);
        let (width, height) = (usize::from(WIDTH), usize::from(HEIGHT));
        let line_words = 2 * width * usize::from(LINES);
        let slot = FastMemory::<Look>::SLOT_BYTES;
        let sets = size_of::<FastMemory<Look>>() - SLOTS * slot;
        let fast = vec![
            Lent::new("slots of the cache", slot, SLOTS, slots),
            Lent::new("what finds them", sets, 1, 1),
            Lent::of::<u32>("depth of one line", width, width),
            Lent::of::<Word>("two line buffers", line_words, line_words),
        ];
        let slow = vec![
            Lent::of::<Vertex>("vertices", ROOM.vertices, vertices),
            Lent::of::<Object>("triangles", ROOM.objects, objects),
            Lent::of::<Link>("links", ROOM.objects, objects),
            Lent::of::<u16>("bins of lines", height, height),
            Lent::of::<DrawState>("draw calls", ROOM.draws, ROOM.draws),
            Lent::of::<u32>("hashes of lines", height, height),
        ];
        [fast, slow]
    }

    /// What was lent, as a table.
    fn memory(&self) -> Table {
        let mut table = table(["RAM", "what", "count", "bytes each", "bytes", "bytes used"]);
        for (region, rooms) in ["fast", "slow"].into_iter().zip(self.lent()) {
            let mut sums = [0; 2];
            for lent in rooms {
                let bytes = lent.bytes();
                sums = [sums[0] + bytes[0], sums[1] + bytes[1]];
                let [lent_bytes, used_bytes] = bytes.map(number);
                table.add_row([
                    Cell::new(region),
                    Cell::new(lent.what),
                    number(lent.count),
                    number(lent.each),
                    lent_bytes,
                    used_bytes,
                ]);
            }
            let [lent_bytes, used_bytes] = sums.map(number);
            let empty = || Cell::new("");
            table.add_row([
                Cell::new(region),
                Cell::new("together"),
                empty(),
                empty(),
                lent_bytes,
                used_bytes,
            ]);
        }
        table
    }
}

/// Memory of one kind.
pub struct Lent {
    /// What it is of.
    pub what: &'static str,
    /// Bytes of one element.
    pub each: usize,
    /// Elements lent.
    pub count: usize,
    /// Most elements that were in use.
    pub used: usize,
}

impl Lent {
    fn new(what: &'static str, each: usize, count: usize, used: usize) -> Self {
        Self {
            what,
            each,
            count,
            used,
        }
    }

    fn of<T>(what: &'static str, count: usize, used: usize) -> Self {
        Self::new(what, size_of::<T>(), count, used)
    }

    /// Lent, and used.
    pub fn bytes(&self) -> [usize; 2] {
        [self.count, self.used].map(|count| count * self.each)
    }
}

/// An empty table with a header.
fn table<const N: usize>(header: [&str; N]) -> Table {
    let mut table = Table::new();
    table.load_preset(UTF8_FULL_CONDENSED).set_header(header);
    table
}

/// A number on the right of its column, its thousands apart.
fn number(value: impl Display) -> Cell {
    Cell::new(thousands(&value.to_string())).set_alignment(CellAlignment::Right)
}

/// Digits with a comma before every third from the right.
pub fn thousands(digits: &str) -> String {
    let mut text = String::new();
    for (index, digit) in digits.chars().enumerate() {
        if index > 0 && (digits.len() - index).is_multiple_of(3) {
            text.push(',');
        }
        text.push(digit);
    }
    text
}

/// The code that the README shows compiles as it stands there.
#[cfg(doctest)]
#[doc = include_str!("../../README.md")]
struct Readme;
