//! What there is no picture of, as pictures of squares: the colour of each is an answer. The first shows what becomes of
//! damaged lists (X7); the second which events the first had (H14), where a list halts (H12), which lines renderers have
//! (B3), how often a queue was full, and what `kept.rs` has. Squares come through two queues (K17).

use super::kept::KEPT;
use super::listed::{Rooms, with_player};
use super::{DRAWS, Rest, VALUES_HEIGHT, ValuesError, background, values_screen};
use crate::{Played, ShotError, TexturedLook};
use core::ops::Range;
use core::task::Poll;
use scanbeam::event::{Event, EventFlags, EventSet, Notice};
use scanbeam::frame::{FastMemory, Interleave, Memory as LineMemory, Renderer, draw_frame};
use scanbeam::input::{Command, Input, InputQueue, Refused};
use scanbeam::list::{Budget, Flow, Halt, Header, Id, ListCommand};
use scanbeam::mesh::QuadSplit;
use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma};
use scanbeam::scene::{Draw, DrawState, Memory, Scene};
use scanbeam::{Camera, CameraError, Cull, Faces, Mesh};

/// Squares a row.
const COLUMNS: usize = 8;
/// Rows.
const ROWS: usize = 6;
/// Words of the list that is damaged, at most.
const WORDS: usize = 640;
/// Commands that a queue holds, and one more.
const HELD: usize = 3;

/// Answers of the last row that are not of `kept.rs`.
const TOLD: usize = COLUMNS - KEPT;

/// The answers that a picture shows.
type Answers = [u32; COLUMNS * ROWS];

/// Values one after the other, as one.
#[derive(Default)]
pub(super) struct Answer(pub(super) u32);

impl Answer {
    pub(super) fn add(&mut self, value: u32) {
        let mixed = (self.0 ^ value).wrapping_mul(0x9E37_79B1);
        self.0 = mixed ^ mixed >> 15;
    }

    fn add_events(&mut self, events: EventSet) {
        events.iter().for_each(|event| self.add(event as u32));
    }
}

impl Rest<'_> {
    /// Memory of a scene, and of a renderer.
    pub(super) fn stage<'a, 't>(
        &'a mut self,
        draws: &'a mut [DrawState<'t>],
        cache: &'a mut FastMemory<TexturedLook>,
    ) -> (Memory<'a, 't>, LineMemory<'a, TexturedLook>) {
        let memory = Memory {
            vertices: self.vertices,
            places: self.places,
            objects: self.objects,
            bins: self.bins,
            draws,
        };
        let lines = LineMemory {
            cache,
            links: self.links,
            depth: self.depth,
        };
        (memory, lines)
    }

    /// What becomes of a list that begins at a word: where it halts each time, what it told, and what the scene has of it.
    fn answer(&mut self, list: &[u32], from: u32) -> Result<u32, ShotError> {
        let flags = EventFlags::new(EventSet::ALL);
        let mut rooms = Rooms::EMPTY;
        let mut draws = [const { DrawState::EMPTY }; DRAWS];
        let memory = Memory {
            vertices: self.vertices,
            places: self.places,
            objects: self.objects,
            bins: self.bins,
            draws: &mut draws,
        };
        let mut scene = Scene::<TexturedLook>::new(values_screen(), memory);
        let camera = Played::Crate.camera().map_err(ShotError::Camera)?;
        scene.begin(&camera).map_err(ShotError::Begin)?;
        let (mut answer, mut budget) = (Answer::default(), Budget::of(4096));
        let mut hear = |notice: Notice| flags.raise(notice.event);
        let counts = with_player(Played::Crate.settings(), &mut rooms, |player| {
            player.command(ListCommand::Start(from));
            loop {
                let run = player.run(list, &mut scene, &mut budget, &mut hear);
                answer.add_events(flags.take());
                match run {
                    Ok(halt) => answer.add(halt as u32),
                    Err(error) => {
                        answer.add(error.offset);
                        answer.add(error.block.map_or(99, |block| block as u32));
                    }
                }
                if !matches!(run, Ok(Halt::Paused | Halt::Sync)) {
                    break player.counts();
                }
                player.command(ListCommand::Resume);
            }
        });
        for count in [counts.triangles, counts.dropped, scene.objects() as u32] {
            answer.add(count);
        }
        Ok(answer.0)
    }

    /// What becomes of the crate with a word of its beginning or its end changed, or cut short, or begun within.
    fn damaged(&mut self) -> Result<Answers, ShotError> {
        // It is aligned, so it is there.
        let list = Played::Crate.list().unwrap_or_default();
        let length = list.len().min(WORDS);
        let mut random = Answer(1);
        let mut answers = [0; COLUMNS * ROWS];
        for (number, answer) in answers.iter_mut().enumerate() {
            let mut words = [0; WORDS];
            words[..length].copy_from_slice(&list[..length]);
            random.add(number as u32);
            let at = match number % 2 {
                0 => number / 2,
                _ => length - 1 - number,
            };
            *answer = match number % 8 {
                0 => self.answer(&words[..at], 0)?,
                7 => self.answer(&words[..length], at as u32)?,
                _ => {
                    words[at] ^= random.0;
                    self.answer(&words[..length], 0)?
                }
            };
        }
        Ok(answers)
    }

    /// Where a list halts that interrupts, pauses, asks for what stands before, and jumps.
    fn halting(&mut self) -> Result<u32, ShotError> {
        let words = [
            flow(Flow::Interrupt(42)),
            flow(Flow::Pause),
            flow(Flow::Jump(5)),
            5_u32.to_le(),
            flow(Flow::Pause),
            flow(Flow::Sync),
            flow(Flow::End),
        ];
        self.answer(&words, 0)
    }

    /// Draws answers as squares that come through queues, and sends them.
    fn show<D>(
        &mut self,
        cache: &mut FastMemory<TexturedLook>,
        pump: &mut Pump<D>,
        answers: &Answers,
    ) -> Result<Shown, ValuesError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let rows = Rows::new(answers);
        let mut draws = [const { DrawState::EMPTY }; DRAWS];
        let (memory, lines) = self.stage(&mut draws, cache);
        let mut scene = Scene::<TexturedLook>::new(values_screen(), memory);
        let stalls = rows.feed(&mut scene)?;
        let mut renderer = Renderer::new(lines).counting();
        let used = draw_frame(&scene, &mut renderer, pump, background(), 3)?;
        Ok(Shown {
            events: used.assembled.events().union(renderer.spans().events()),
            stalls,
        })
    }

    /// Sends both pictures.
    #[inline(never)]
    pub(super) fn send_told<D>(
        mut self,
        cache: &mut FastMemory<TexturedLook>,
        pump: &mut Pump<D>,
    ) -> Result<(), ValuesError<D::Error>>
    where
        D: ScanoutDma<Buf: LineBuf<Word = u16>>,
    {
        let damaged = self.damaged()?;
        let shown = self.show(cache, pump, &damaged)?;
        let mut answers = [0; COLUMNS * ROWS];
        for (answer, event) in answers.iter_mut().zip(Event::ALL) {
            *answer = 0xFF_FFFF * u32::from(shown.events.has(event));
        }
        let mut lines = Answer::default();
        for turn in 0..3 {
            let of = Interleave::bands(3, turn, 2).unwrap_or(Interleave::ALL);
            of.of(0..VALUES_HEIGHT)
                .for_each(|line| lines.add(u32::from(line)));
        }
        let last = &mut answers[COLUMNS * (ROWS - 1)..];
        last[..TOLD].copy_from_slice(&[shown.stalls << 20, self.halting()?, lines.0]);
        last[TOLD..].copy_from_slice(&self.kept(cache, &Rows::new(&damaged))?);
        self.show(cache, pump, &answers)?;
        Ok(())
    }
}

/// What a picture told while it was drawn.
struct Shown {
    events: EventSet,
    /// How often a queue was full.
    stalls: u32,
}

/// What sees all squares, with a focal length in pixels.
fn camera(focal: f32) -> Result<Camera, CameraError> {
    let eye = [0.0, 0.0, 1.0];
    Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], focal, 0.1, 9.0)
}

/// Corners of a row.
const CORNERS: usize = 4 * COLUMNS;

/// The header of a block, as it lies in memory.
pub(super) const fn header(id: Id, count: u16) -> u32 {
    Header::of(id, count).to_word().to_le()
}

/// A FLOW block without words of its own.
pub(super) const fn flow(flow: Flow) -> u32 {
    let (what, argument) = flow.code();
    header(Id::Flow, u16::from_be_bytes([what, argument]))
}

/// The squares of a picture.
pub(super) struct Rows {
    positions: [[[i16; 3]; CORNERS]; ROWS],
    colours: [[[u8; 3]; CORNERS]; ROWS],
    faces: [[u16; 4]; COLUMNS],
}

impl Rows {
    fn new(answers: &Answers) -> Self {
        let mut rows = Self {
            positions: [[[0; 3]; CORNERS]; ROWS],
            colours: [[[0; 3]; CORNERS]; ROWS],
            faces: [[0; 4]; COLUMNS],
        };
        for (number, answer) in answers.iter().enumerate() {
            let (row, column) = (number / COLUMNS, number % COLUMNS);
            let [_, red, green, blue] = answer.to_be_bytes();
            // Squares of 2,000 units, 1,600 of them seen.
            let (left, top) = (2_000 * column as i16 - 8_000, 6_000 - 2_000 * row as i16);
            for (corner, [x, y]) in [[0, 0], [0, -1], [1, -1], [1, 0]].into_iter().enumerate() {
                let corner = 4 * column + corner;
                rows.positions[row][corner] = [left + 1_600 * x, top + 1_600 * y, 0];
                rows.colours[row][corner] = [red, green, blue];
            }
            rows.faces[column] = [0, 1, 2, 3].map(|corner| (4 * column) as u16 + corner);
        }
        rows
    }

    /// What a source says at its `n`th turn: the first one where all is seen from, then its rows, then that it is done.
    fn command(&self, source: usize, n: usize, camera: Camera) -> Option<Command<'_>> {
        let begins = 1 - source;
        if n < begins {
            return Some(Command::Begin(camera));
        }
        let row = n - begins;
        if row >= ROWS / 2 {
            return (row == ROWS / 2).then_some(Command::EndOfFrame);
        }
        let row = source * (ROWS / 2) + row;
        Some(Command::Draw(Draw {
            cull: Cull::None,
            ..Draw::new(Mesh {
                positions: &self.positions[row],
                normals: &[],
                colours: &self.colours[row],
                faces: Faces::Quads(&self.faces, QuadSplit::Corner0To2),
            })
        }))
    }

    /// Submits all rows for some lines of a picture of 64 x 48.
    pub(super) fn submit<'t>(
        &'t self,
        scene: &mut Scene<'_, 't, TexturedLook>,
        lines: Range<u16>,
    ) -> Result<(), ShotError> {
        let camera = camera(56.0)?;
        scene.begin_lines(&camera, lines)?;
        for row in 0..ROWS {
            let (source, n) = (row / (ROWS / 2), row % (ROWS / 2));
            if let Some(Command::Draw(draw)) = self.command(source, n + 1 - source, camera) {
                scene.draw(&draw)?;
            }
        }
        Ok(())
    }

    /// Submits all rows through two queues, the upper half by the first; how often one was full.
    fn feed<'t>(&'t self, scene: &mut Scene<'_, 't, TexturedLook>) -> Result<u32, ShotError> {
        let camera = camera(140.0)?;
        let mut queues = [const { InputQueue::<i16, HELD>::new() }; 2];
        let [upper, lower] = &mut queues;
        let ((mut first, one), (mut second, other)) = (upper.split(0), lower.split(1));
        let mut input = Input::new([one, other]);
        let mut stalls = 0;
        // Both sources say as much as fits, then the scene takes one command.
        let (mut said, mut is_over) = ([0; 2], false);
        while !is_over {
            for (number, source) in [&mut first, &mut second].into_iter().enumerate() {
                while let Some(command) = self.command(number, said[number], camera) {
                    if source.send(command).is_err() {
                        stalls += 1;
                        break;
                    }
                    said[number] += 1;
                }
            }
            is_over = match input.drain(scene, 1) {
                Poll::Pending => false,
                Poll::Ready(Ok(())) => true,
                Poll::Ready(Err(error)) => match error.error {
                    Refused::Begin(error) => return Err(ShotError::Begin(error)),
                    Refused::Draw(error) => return Err(ShotError::Draw(error)),
                },
            };
        }
        Ok(stalls)
    }
}
