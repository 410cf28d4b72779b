//! A picture by draw calls in as many scenes as it takes: tiles where it is larger than a scene can be, and bands of
//! lines where more is seen than the memory of a scene holds.

use crate::choice::DepthArg;
use crate::counted::{count_triangles, lines_of_faces};
use crate::prepared::Chunk;
use crate::{CrewSettings, DrawFailure, Drawn, Figures, MOST_SLOTS, Overfull, crew, display, pace};
use host_support::image_out::Frame;
use host_support::mock::MockFrameBuffer;
use host_support::reference::View;
use host_support::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::frame::{FastMemory, FrameUse, Paid};
use scanbeam::look::Look;
use scanbeam::pixel::PixelFormat;
use scanbeam::scan_out::Pump;
use scanbeam::scene::{DrawError, DrawState, LARGEST, Object, TexturePlace, Vertex};
use scanbeam::stats::SpanCounts;
use scanbeam::{Camera, Link, Renderer, Scene, Screen};
use std::ops::Range;

/// Words of 32 slots that the cache of a renderer has.
const WORDS: usize = MOST_SLOTS as usize / 32;

/// What is to be drawn, and by how many.
#[derive(Clone, Copy)]
pub(crate) struct Job {
    /// Columns and lines of the picture.
    pub(crate) size: [u32; 2],
    /// Most columns and lines of a tile, at most [`LARGEST`](scanbeam::scene::LARGEST).
    pub(crate) most: u16,
    pub(crate) camera: Camera,
    pub(crate) background: [u8; 3],
    pub(crate) crew: CrewSettings,
    /// Whether there are shadow volumes, and triangles are drawn more than once.
    pub(crate) shadows: bool,
    /// Whether all is so far ahead that a tile which no camera sees shows none of it.
    pub(crate) is_ahead: bool,
    /// Memory of a scene.
    pub(crate) room: Room,
}

impl Job {
    /// One without shadows.
    pub(crate) fn new(view: &View, camera: Camera, crew: CrewSettings, room: Room) -> Self {
        Self {
            size: [view.width, view.height],
            most: LARGEST,
            camera,
            background: view.background,
            crew,
            shadows: false,
            is_ahead: false,
            room,
        }
    }
}

/// Room for a scene of these parts of models, with textures or without, and with faces of one colour each where it is
/// `flat`; what needs more is drawn in several bands of lines.
pub(crate) fn room_for<'c>(
    chunks: impl Iterator<Item = &'c Chunk> + Clone,
    textured: bool,
    flat: bool,
) -> Room {
    let faces: usize = chunks.clone().map(|chunk| chunk.faces.len()).sum();
    let vertices: usize = chunks.clone().map(|chunk| chunk.positions.len()).sum();
    // Those of clipped triangles, and where faces are flat three more for each.
    let more = if flat { 20 } else { 8 };
    let vertices = (vertices + more * faces + 64).min(MOST_VERTICES);
    Room {
        vertices,
        places: if textured { vertices } else { 0 },
        objects: (4 * faces + 64).min(MOST_OBJECTS),
        draws: chunks.count(),
    }
}

/// Most vertices and triangles of a scene.
pub(crate) const MOST_VERTICES: usize = 1 << 16;
pub(crate) const MOST_OBJECTS: usize = Link::CACHED as usize;

/// A rectangle of the picture.
#[derive(Clone, Copy, Debug)]
pub(crate) struct Tile {
    /// How many come before it.
    pub(crate) number: usize,
    /// First column and line.
    pub(crate) first: [u32; 2],
    /// Columns and lines.
    pub(crate) size: [u16; 2],
}

impl Tile {
    /// The camera that sees it in the middle of its picture.
    pub(crate) fn camera(&self, job: &Job) -> Result<Camera, DrawFailure> {
        let shift = |i: usize| {
            let middle = f64::from(self.first[i]) + f64::from(self.size[i]) / 2.0;
            (middle - f64::from(job.size[i]) / 2.0) as f32
        };
        let shifted = job.camera.shifted([shift(0), shift(1)]);
        shifted.map_err(|error| DrawFailure::View(error.to_string()))
    }

    /// What it is drawn on.
    pub(crate) fn screen(&self) -> Result<Screen, DrawFailure> {
        let screen = Screen::new(self.size[0], self.size[1]);
        screen.map_err(|error| DrawFailure::View(error.to_string()))
    }
}

/// Parts of `length` pixels of which none has more than `most`, a multiple of 4: the first of each, and how many. They
/// begin at multiples of 4, so that a dither goes on from one to the next.
fn split(length: u32, most: u16) -> impl Iterator<Item = (u32, u16)> + Clone {
    let count = length.div_ceil(u32::from(most)).max(1);
    let begin = move |i: u32| match i == count {
        true => length,
        false => (length * i).div_ceil(count).next_multiple_of(4).min(length),
    };
    (0..count).map(move |i| (begin(i), (begin(i + 1) - begin(i)) as u16))
}

/// The tiles of a picture, row by row.
pub(crate) fn tiles(job: &Job) -> impl Iterator<Item = Tile> {
    let columns = split(job.size[0], job.most);
    let places = split(job.size[1], job.most)
        .flat_map(move |(y, height)| columns.clone().map(move |(x, width)| (x, y, width, height)));
    (0..)
        .zip(places)
        .map(|(number, (x, y, width, height))| Tile {
            number,
            first: [x, y],
            size: [width, height],
        })
}

/// What a band of a picture took.
pub(crate) struct Took {
    pub(crate) used: FrameUse,
    /// Where they were counted.
    pub(crate) spans: Option<SpanCounts>,
    /// Bytes of fast memory.
    pub(crate) fast_bytes: usize,
    /// What was paid for lines not to cost too much.
    pub(crate) paid: Option<Paid>,
}

impl Took {
    /// What a band took that was not drawn by a [`Renderer`].
    pub(crate) fn by_other<'t, L: Look<Pixel = F>, F: PixelFormat>(
        scene: &Scene<'_, 't, L>,
        pump: &Display<F>,
        spans: SpanCounts,
        fast_bytes: usize,
    ) -> Self {
        Self {
            used: FrameUse {
                assembled: scene.assembled(),
                scan_out: pump.stats(),
                ..FrameUse::default()
            },
            spans: Some(spans),
            fast_bytes,
            paid: None,
        }
    }
}

/// The pump to the mocked display of a part.
pub(crate) type Display<F> = Pump<MockFrameBuffer<<F as PixelFormat>::Word>>;

/// What draws one part of a tile: into a scene, by its number. It is called and not compiled in, so that all that draw by a
/// look share what draws their pictures.
pub(crate) type Step<'s, 't, L> =
    dyn FnMut(&mut Scene<'_, 't, L>, &Tile, usize, Option<&Chunk>) -> Result<(), DrawError> + 's;

/// Who draws a scene to a display, so many lines a transfer.
type Drawer<'d, 't, L, F> =
    dyn FnMut(&Scene<'_, 't, L>, &mut Display<F>, u16) -> Result<Took, DrawFailure> + 'd;

/// Draws a picture by line renderers, of what `step` draws, for each number from 0 to below those of `counted` once a
/// scene. These are the parts of the model that steps draw; `None` where triangles do not count, since they are none of
/// it or are drawn again. A step that is given another part draws that instead. A line that has more than a scene's
/// memory holds shows what does.
///
/// # Errors
/// See [`DrawFailure`].
pub(crate) fn draw_parts<'t, L, F>(
    job: &Job,
    counted: &[Option<&Chunk>],
    step: &mut Step<'_, 't, L>,
) -> Result<Drawn, DrawFailure>
where
    L: Look<Pixel = F, Planes: Send> + Sync,
    F: PixelFormat + Sync,
{
    draw_parts_by::<L, F>(job, counted, step, &mut |scene, pump, lines| {
        draw_by_crew(job, scene, pump, lines)
    })
}

/// The same by whoever draws: a scene to a display, so many lines a transfer.
///
/// # Errors
/// See [`DrawFailure`].
pub(crate) fn draw_parts_by<'t, L, F>(
    job: &Job,
    counted: &[Option<&Chunk>],
    step: &mut Step<'_, 't, L>,
    by: &mut Drawer<'_, 't, L, F>,
) -> Result<Drawn, DrawFailure>
where
    L: Look<Pixel = F>,
    F: PixelFormat,
{
    let [width, height] = job.size;
    let mut parts = Parts {
        rgb: vec![0; 3 * width as usize * height as usize],
        used: FrameUse::default(),
        spans: None,
        figures: Figures::default(),
        overfull: None,
        paid: None,
        counted,
        step,
        by,
    };
    for tile in tiles(job) {
        parts.tile(job, tile)?;
    }
    if parts.figures.parts != 1 || job.shadows {
        let all = count_triangles(job, counted, parts.step)?;
        let done = &mut parts.used.assembled;
        (done.triangles, done.culled, done.clipped) = (all.triangles, all.culled, all.clipped);
        (parts.figures.objects, parts.figures.vertices) = (all.objects, all.vertices);
    }
    Ok(Drawn {
        frame: Frame::new(width, height, parts.rgb)
            .ok_or_else(|| DrawFailure::View("the picture has another size".into()))?,
        used: parts.used,
        spans: parts.spans,
        figures: parts.figures,
        overfull: parts.overfull,
        texels: None,
        paid: parts.paid,
    })
}

/// Draws a scene by a crew of renderers.
fn draw_by_crew<L, F>(
    job: &Job,
    scene: &Scene<'_, '_, L>,
    pump: &mut Display<F>,
    lines: u16,
) -> Result<Took, DrawFailure>
where
    L: Look<Pixel = F, Planes: Send> + Sync,
    F: PixelFormat + Sync,
{
    let width = scene.screen().width();
    let slots = job.crew.slots.min(MOST_SLOTS);
    let count = job.crew.renderers.max(1);
    let has_depth = job.crew.depth != DepthArg::Priority;
    let mut rooms: Vec<LineRooms<L, WORDS>> = (0..count)
        .map(|_| LineRooms::new(scene.objects(), width).with_limit(slots))
        .map(|rooms| match (job.shadows, has_depth) {
            (true, _) => rooms.with_counts(),
            (false, true) => rooms,
            (false, false) => rooms.without_depth(),
        })
        .collect();
    let mut renderers: Vec<_> = rooms
        .iter_mut()
        .map(|rooms| {
            let renderer = match job.crew.counts {
                true => rooms.renderer().counting(),
                false => rooms.renderer(),
            };
            let renderer = match job.crew.prefetch {
                0 => renderer,
                bytes => renderer.fetching(bytes),
            };
            pace::paced(renderer, job.crew.pace)
        })
        .collect();
    let background = F::from_rgb8(job.background);
    let used = crew::draw_frame(scene, &mut renderers, pump, background, lines);
    let cell = if has_depth { size_of::<u32>() } else { 0 };
    let cells = usize::from(width) * (cell + usize::from(job.shadows));
    let fast = usize::from(slots) * FastMemory::<L, WORDS>::SLOT_BYTES + cells;
    let spans = job.crew.counts.then(|| {
        let mut all = SpanCounts::default();
        renderers
            .iter()
            .for_each(|renderer| all += renderer.spans());
        all
    });
    // One renderer alone has a pace.
    let paid = job.crew.pace.and(renderers.first());
    Ok(Took {
        used: used.map_err(DrawFailure::Display)?,
        spans,
        fast_bytes: usize::from(count) * fast,
        paid: paid.map(Renderer::paid),
    })
}

/// A picture as its parts become ready.
struct Parts<'c, 't, L, F: PixelFormat> {
    rgb: Vec<u8>,
    used: FrameUse,
    spans: Option<SpanCounts>,
    figures: Figures,
    overfull: Option<Overfull>,
    paid: Option<Paid>,
    counted: &'c [Option<&'c Chunk>],
    step: &'c mut Step<'c, 't, L>,
    by: &'c mut Drawer<'c, 't, L, F>,
}

impl<'t, L: Look<Pixel = F>, F: PixelFormat> Parts<'_, 't, L, F> {
    /// Draws a tile, in as many bands of lines as it takes.
    fn tile(&mut self, job: &Job, tile: Tile) -> Result<(), DrawFailure> {
        let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
        let [width, height] = tile.size;
        // Where nothing is seen, from anywhere.
        let camera = match tile.camera(job) {
            Err(_) if job.is_ahead => None,
            camera => Some(camera?),
        };
        let mut own_lines = None;
        let mut memory = SceneRooms::new(job.room, height);
        let mut scene = memory.scene::<L>(tile.screen()?);
        let (mut pump, lines) = display::<F::Word>(width, height);
        let (mut start, mut count) = (0, height);
        while start < height {
            count = count.min(height - start);
            let lines_of_band = start..start + count;
            let begun = scene.begin_lines(camera.as_ref().unwrap_or(&job.camera), lines_of_band);
            begun.map_err(|e| bad(&e))?;
            let full = match &camera {
                Some(_) => self.build(&mut scene, &tile, count > 1, own_lines.as_deref())?,
                None => None,
            };
            match (full, &camera) {
                // Without vertices of triangles elsewhere.
                (Some(_), Some(camera)) if own_lines.is_none() => {
                    let lines = lines_of_faces(camera, &tile, self.counted, self.step)?;
                    own_lines = Some(lines);
                    continue;
                }
                // Fewer lines have fewer triangles.
                (Some(_), _) if count > 1 => {
                    count = count.div_ceil(2);
                    continue;
                }
                (Some(first), _) => {
                    let line = tile.first[1] as u16 + start;
                    self.is_overfull(line, first, scene.assembled().dropped);
                }
                (None, _) => {}
            }
            let took = (self.by)(&scene, &mut pump, lines)?;
            add(&mut self.used, &took.used);
            if let Some(spans) = took.spans {
                *self.spans.get_or_insert_default() += spans;
            }
            if let Some(paid) = took.paid {
                pace::add(self.paid.get_or_insert_default(), &paid);
            }
            self.figures.add(job, &scene, lines, took.fast_bytes);
            start += count;
        }
        let words = pump.sink().frame().map_err(DrawFailure::Incomplete)?;
        self.take(job, tile, words.into_iter().map(F::to_rgb8));
        Ok(())
    }

    /// Draws all that a scene has room for, of parts of the model what may be on its lines, where that is known; what
    /// found none first. Where that is asked for, it stops there.
    fn build(
        &mut self,
        scene: &mut Scene<'_, 't, L>,
        tile: &Tile,
        stops: bool,
        own_lines: Option<&[Vec<Range<i32>>]>,
    ) -> Result<Option<DrawError>, DrawFailure> {
        let mut full = None;
        let band = scene.lines();
        let band = i32::from(band.start)..i32::from(band.end);
        for (step, chunk) in self.counted.iter().enumerate() {
            let part = chunk.zip(own_lines).map(|(chunk, lines)| {
                let on_band = |lines: &Range<i32>| lines.start < band.end && band.start < lines.end;
                chunk.only(&|face| on_band(&lines[step][face]))
            });
            match (self.step)(scene, tile, step, part.as_ref()) {
                Ok(()) => {}
                Err(error @ DrawError::Full { .. }) => {
                    full.get_or_insert(error);
                    if stops {
                        break;
                    }
                }
                Err(error) => return Err(DrawFailure::View(error.to_string())),
            }
        }
        Ok(full)
    }

    /// A line shows less than there is.
    fn is_overfull(&mut self, line: u16, first: DrawError, dropped: u32) {
        let overfull = self.overfull.get_or_insert_with(|| Overfull {
            line,
            lines: 0,
            triangles: 0,
            first: first.to_string(),
        });
        overfull.lines += 1;
        overfull.triangles += dropped;
    }

    /// Puts a tile's pixels into the picture.
    fn take(&mut self, job: &Job, tile: Tile, pixels: impl Iterator<Item = [u8; 3]>) {
        let [x, y] = tile.first.map(|first| first as usize);
        let [columns, lines] = tile.size.map(usize::from);
        let stride = 3 * job.size[0] as usize;
        let rows = self.rgb.chunks_exact_mut(stride).skip(y).take(lines);
        let places = rows.flat_map(|row| row[3 * x..3 * (x + columns)].chunks_exact_mut(3));
        for (place, pixel) in places.zip(pixels) {
            place.copy_from_slice(&pixel);
        }
    }
}

/// Adds what another part of a picture took. Of pass one, each part is given all triangles.
fn add(all: &mut FrameUse, one: &FrameUse) {
    all.assembled.triangles = one.assembled.triangles;
    all.assembled.culled += one.assembled.culled;
    all.assembled.clipped += one.assembled.clipped;
    all.assembled.dropped += one.assembled.dropped;
    all.assembled.untextured += one.assembled.untextured;
    all.assembled.meshes_skipped += one.assembled.meshes_skipped;
    all.assembled.triangles_skipped += one.assembled.triangles_skipped;
    all.assembled.vertices_skipped += one.assembled.vertices_skipped;
    all.cache += one.cache;
    all.lines_skipped += one.lines_skipped;
    all.scan_out.bytes_sent += one.scan_out.bytes_sent;
    all.scan_out.transfers += one.scan_out.transfers;
    all.scan_out.stall_polls += one.scan_out.stall_polls;
    all.scan_out.lines_unsent += one.scan_out.lines_unsent;
    all.scan_out.bytes_unsent += one.scan_out.bytes_unsent;
}

impl Figures {
    /// Adds another part, that has sent so many lines a transfer.
    fn add<L: Look>(&mut self, job: &Job, scene: &Scene<'_, '_, L>, lines: u16, fast: usize) {
        let place = match L::TEXTURED {
            true => size_of::<TexturePlace>(),
            false => 0,
        };
        let links = usize::from(job.crew.renderers.max(1)) * size_of::<Link>();
        let slow = scene.vertices() * (size_of::<Vertex>() + place)
            + scene.objects() * (size_of::<Object>() + links)
            + scene.lines().len() * size_of::<u16>()
            + job.room.draws * size_of::<DrawState<'_>>();
        let word = size_of::<<L::Pixel as PixelFormat>::Word>();
        let line = usize::from(scene.screen().width()) * usize::from(lines);
        self.parts += 1;
        self.record_bytes = Renderer::<L, WORDS>::RECORD_BYTES;
        self.objects = self.objects.max(scene.objects());
        self.vertices = self.vertices.max(scene.vertices());
        self.slow_bytes = self.slow_bytes.max(slow);
        self.fast_bytes = self.fast_bytes.max(fast);
        self.line_bytes = self.line_bytes.max(2 * line * word);
    }
}
