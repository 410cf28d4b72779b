//! Answers that lines of a small picture give: picture memory in blocks (B1), a panel that does not wait (X5), a scene in
//! bands (H18), a window that a list is granted and asks to leave (H13), and overlays of a list (K14).

use super::told::{Answer, Rows, flow, header};
use super::{DRAWS, Rest, ValuesError, background};
use crate::{Played, ShotError, TexturedLook};
use core::ops::Range;
use scanbeam::Screen;
use scanbeam::event::Notice;
use scanbeam::frame::{FastMemory, FrameError, Renderer};
use scanbeam::input::{Player, PlayerMemory, PlayerSettings};
use scanbeam::list::{Budget, Flow, Header, Id, ListCommand, OverlaySlot, Window as Cut};
use scanbeam::overlay::ListOverlays;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scan_out::{BlockFrame, ContinuousPanel, Fed, LineWriter, Window, feed_line};
use scanbeam::scene::{Blocked, DrawState, Scene};

/// Columns and lines.
const WIDTH: u16 = 64;
const HEIGHT: u16 = 48;
/// Words of a line.
const LINE: usize = WIDTH as usize;

/// How many answers there are.
pub(super) const KEPT: usize = 5;

/// Vertices and indices that a list has together, at most.
const HELD: usize = 9;

/// STATE blocks.
const WINDOW: u16 = 7 << 8;
const OVERLAY: u16 = 10 << 8;

/// What draws a line.
type Draws<'d, E> = &'d mut dyn FnMut(u16, &mut [u16]) -> Result<(), ValuesError<E>>;

fn screen() -> Screen {
    // Both are sides of a screen.
    Screen::new(WIDTH, HEIGHT).unwrap_or(super::values_screen())
}

/// A panel that begins to read a line every 10 ticks, of which a line takes one to draw, but some more.
struct Panel {
    ring: [[u16; LINE]; 2],
    /// The line that is drawn, and how often the time was looked at.
    at: (u16, u32),
    time: u32,
}

impl ContinuousPanel for Panel {
    type Word = u16;

    fn now(&mut self) -> u32 {
        self.at.1 += 1;
        if self.at.1 > 1 {
            self.time += 7 + u32::from(self.at.0 % 5);
        }
        self.time
    }

    fn deadline(&mut self, line: u16) -> u32 {
        self.at = (line, 0);
        8 + 8 * u32::from(line)
    }

    fn buffer(&mut self, line: u16) -> &mut [u16] {
        &mut self.ring[usize::from(line % 2)]
    }
}

impl Answer {
    fn add_words(&mut self, words: &[u16]) {
        words.iter().for_each(|word| self.add((*word).into()));
    }

    /// What all lines show.
    fn add_lines<E>(&mut self, draw: Draws<'_, E>) -> Result<(), ValuesError<E>> {
        let mut words = [0; LINE];
        for line in 0..HEIGHT {
            draw(line, &mut words)?;
            self.add_words(&words);
        }
        Ok(())
    }

    /// What is in picture memory in blocks of 4 x 4 words, and how often another block was written.
    fn add_blocks<E>(&mut self, draw: Draws<'_, E>) -> Result<(), ValuesError<E>> {
        let block = Blocked::new(2, 2).ok_or(ShotError::Sprites)?;
        let mut memory = [0; LINE * HEIGHT as usize];
        let frame = BlockFrame::new(&mut memory, WIDTH, HEIGHT, block);
        let mut frame = frame.map_err(|_| ShotError::Sprites)?;
        for lines in 0..HEIGHT / 2 {
            let mut words = [[0; LINE]; 2];
            for (line, words) in (2 * lines..).zip(&mut words) {
                draw(line, words)?;
            }
            let window = Window {
                x: 0,
                y: 2 * lines,
                width: WIDTH,
                height: 2,
            };
            let written = frame.write(window, words.as_flattened());
            written.map_err(|_| ShotError::Sprites)?;
        }
        self.add(frame.page_changes());
        self.add_words(frame.words());
        Ok(())
    }

    /// What a panel reads that does not wait, and how late lines were.
    fn add_read<E>(&mut self, draw: Draws<'_, E>) -> Result<(), ValuesError<E>> {
        let mut panel = Panel {
            ring: [[0; LINE]; 2],
            at: (0, 0),
            time: 0,
        };
        for line in 0..HEIGHT {
            let fed = feed_line(&mut panel, line, &mut *draw)?;
            self.add(match fed {
                Fed::InTime(ticks) => ticks,
                Fed::Late(ticks) => 1 << 16 | ticks,
                Fed::LeftOut(ticks) => 2 << 16 | ticks,
            });
            self.add_words(&panel.ring[usize::from(line % 2)]);
            // It waits until the panel has read what was there.
            panel.time = panel.time.max(8 * u32::from(line));
        }
        Ok(())
    }
}

impl Rest<'_> {
    /// Lines of the squares, made for `lines` of the picture.
    fn squares<E>(
        &mut self,
        cache: &mut FastMemory<TexturedLook>,
        (rows, lines): (&Rows, Range<u16>),
        show: impl FnOnce(Draws<'_, E>) -> Result<(), ValuesError<E>>,
    ) -> Result<(), ValuesError<E>> {
        let mut draws = [const { DrawState::EMPTY }; DRAWS];
        let (memory, held) = self.stage(&mut draws, cache);
        let mut scene = Scene::<TexturedLook>::new(screen(), memory);
        rows.submit(&mut scene, lines)?;
        let mut renderer = Renderer::new(held);
        show(&mut |line, pixels| {
            let drawn = renderer.draw_line(&scene, line, pixels, background());
            drawn
                .map(|_| ())
                .map_err(|error| FrameError::Line(error).into())
        })
    }

    /// Both bands of the squares.
    fn bands<E>(
        &mut self,
        cache: &mut FastMemory<TexturedLook>,
        rows: &Rows,
    ) -> Result<Answer, ValuesError<E>> {
        let mut answer = Answer::default();
        for lines in [0..19, 19..HEIGHT] {
            self.squares(cache, (rows, lines.clone()), |draw| {
                let mut words = [0; LINE];
                for line in lines {
                    draw(line, &mut words)?;
                    answer.add_words(&words);
                }
                Ok(())
            })?;
        }
        Ok(answer)
    }

    /// A list played by who grants a window, and what it lays over the picture.
    fn listed<E>(
        &mut self,
        cache: &mut FastMemory<TexturedLook>,
        list: &[u32],
        window: Option<Cut>,
    ) -> Result<Answer, ValuesError<E>> {
        let slots = [const { OverlaySlot::new() }; 1];
        let mut answer = Answer::default();
        let mut draws = [const { DrawState::EMPTY }; DRAWS];
        let (memory, held) = self.stage(&mut draws, cache);
        let mut scene = Scene::<TexturedLook>::new(screen(), memory);
        let (mut positions, mut normals) = ([[0; 3]; HELD], [[0; 3]; HELD]);
        let (mut colours, mut indices) = ([[0; 3]; HELD], [0; HELD]);
        let lent: PlayerMemory<'_, '_> = PlayerMemory {
            positions: &mut positions,
            normals: &mut normals,
            colours: &mut colours,
            indices: &mut indices,
            overlays: &slots,
            ..PlayerMemory::default()
        };
        let settings = PlayerSettings {
            window,
            ..Played::Crate.settings()
        };
        let mut player = Player::new(lent, settings);
        let camera = Played::Crate.camera().map_err(ShotError::Camera)?;
        scene.begin(&camera).map_err(ShotError::Begin)?;
        player.command(ListCommand::Start(0));
        let mut budget = Budget::of(64);
        let mut hear = |notice: Notice| answer.add(notice.event as u32);
        let run = player.run(list, &mut scene, &mut budget, &mut hear);
        answer.add(run.map_or(99, |halt| halt as u32));
        answer.add(player.counts().violations);
        answer.add(scene.objects() as u32);
        let over = ListOverlays {
            words: list,
            slots: &slots,
        };
        let mut renderer = Renderer::new(held);
        answer.add_lines::<E>(&mut |line, pixels| {
            let drawn = renderer.draw_line(&scene, line, pixels, background());
            drawn.map_err(FrameError::Line)?;
            over.paint::<Rgb565Be>(line, pixels);
            Ok(())
        })?;
        Ok(answer)
    }

    /// The answers of squares, and of lists.
    pub(super) fn kept<E>(
        &mut self,
        cache: &mut FastMemory<TexturedLook>,
        rows: &Rows,
    ) -> Result<[u32; KEPT], ValuesError<E>> {
        let whole = (rows, 0..HEIGHT);
        let (mut blocks, mut read) = (Answer::default(), Answer::default());
        self.squares(cache, whole.clone(), |draw| blocks.add_blocks(draw))?;
        self.squares(cache, whole, |draw| read.add_read(draw))?;
        let bands = self.bands(cache, rows)?;
        let cut = Cut {
            left: 8,
            top: 8,
            right: 40,
            bottom: 30,
        };
        let corner = |x: u32, y: u32| (x | y << 16).to_le();
        let asks = |from: u32, to: u32| [header(Id::State, WINDOW), from, to];
        let all = Header {
            new: true,
            ..Header::of(Id::Short, 3)
        };
        let corner_at = |x: i16, y: i16| (u32::from(x as u16) | u32::from(y as u16) << 16).to_le();
        let triangle = [
            all.to_word().to_le(),
            corner_at(-32_000, -32_000),
            0,
            corner_at(32_000, -32_000),
            0,
            corner_at(0, 32_000),
            0,
        ];
        let mut words = [0; 32];
        let mut length = 0;
        let mut say = |more: &[u32]| {
            for (slot, word) in words[length..].iter_mut().zip(more) {
                *slot = *word;
            }
            length += more.len();
        };
        // Within what is granted, and beyond it.
        say(&asks(corner(10, 10), corner(38, 28)));
        say(&asks(corner(0, 10), corner(38, 28)));
        say(&triangle);
        say(&[flow(Flow::End)]);
        let granted = self.listed(cache, &words[..length], Some(cut))?;
        let overlay = [
            header(Id::State, OVERLAY),
            corner(30, 20),
            corner(2, 2),
            5_u32.to_le(),
            0x1234_F800_u32.to_le(),
            0xFFFF_07E0_u32.to_le(),
            flow(Flow::End),
        ];
        let overlaid = self.listed(cache, &overlay, None)?;
        Ok([blocks, read, bands, granted, overlaid].map(|answer| answer.0))
    }
}
