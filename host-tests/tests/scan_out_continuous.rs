//! Panels that read by their own clock, simulated to the tick: late lines are counted, and the picture
//! recovers at the next line (X5).

use crate::common::Rng;
use crate::hot::{LineRooms, SceneRooms};
use scanbeam::frame::draw_continuous;
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scan_out::{ContinuousPanel, Fed, FeedStats, feed_line};
use scanbeam::{Affine, Camera, Draw, Screen};

const WIDTH: usize = 4;

/// A panel of `height` lines that reads one every `period` ticks out of a ring of buffers. Time passes when
/// a line is drawn, by what `costs` says, and when a buffer is waited for.
struct Panel {
    time: u32,
    /// When line 0 is read.
    start: u32,
    period: u32,
    height: u16,
    ring: Vec<Vec<u16>>,
    /// The next line that the panel reads.
    next: u16,
    /// What the panel has read.
    seen: Vec<Vec<u16>>,
}

impl Panel {
    fn new(start: u32, lead: u32, period: u32, height: u16, ring: usize, width: usize) -> Self {
        Self {
            time: start.wrapping_sub(lead),
            start,
            period,
            height,
            ring: vec![vec![0xDEAD; width]; ring],
            next: 0,
            seen: Vec::new(),
        }
    }

    fn read_at(&self, line: u16) -> u32 {
        let after = self.period.wrapping_mul(line.into());
        self.start.wrapping_add(after)
    }

    /// Lets time pass; the panel reads each line whose time comes. A line takes no time to read.
    fn pass(&mut self, ticks: u32) {
        let end = self.time.wrapping_add(ticks);
        while self.next < self.height {
            let at = self.read_at(self.next);
            if end.wrapping_sub(at) > 1 << 31 || end == at {
                break; // not before its time is over
            }
            let slot = usize::from(self.next) % self.ring.len();
            self.seen.push(self.ring[slot].clone());
            self.next += 1;
        }
        self.time = end;
    }

    fn finish(&mut self) {
        let left = self.read_at(self.height).wrapping_sub(self.time);
        if left < 1 << 31 {
            self.pass(left + 1);
        }
    }
}

impl ContinuousPanel for Panel {
    type Word = u16;

    fn now(&mut self) -> u32 {
        self.time
    }

    fn deadline(&mut self, line: u16) -> u32 {
        self.read_at(line)
    }

    fn buffer(&mut self, line: u16) -> &mut [u16] {
        let slot = usize::from(line) % self.ring.len();
        // The line that was in this buffer before must have been read.
        if let Some(before) = usize::from(line).checked_sub(self.ring.len()) {
            while usize::from(self.next) <= before {
                self.pass(1);
            }
        }
        &mut self.ring[slot]
    }
}

/// Random costs and rings, times that wrap: every line said to be in time was read as drawn, every other was not
/// read whole, and whoever has time again is in time again with the very next line.
#[test]
fn late_lines_are_counted_and_the_next_is_right() {
    let mut rng = Rng::new(0x0C10_C4ED);
    let mut seen = FeedStats::default();
    for round in 0..2_000 {
        let height = 1 + rng.below(60) as u16;
        let ring = 1 + rng.below(4) as usize;
        let start = rng.pick(&[1_000, 0, 1 << 31, u32::MAX - 100]);
        let mut panel = Panel::new(start, 50, 20, height, ring, WIDTH);
        let slow = rng.below(4);
        let mut stats = FeedStats::default();
        let mut fates = Vec::new();
        for line in 0..height {
            // Mostly fast; some lines take several periods.
            let cost = if rng.below(10) < slow {
                20 + rng.below(150)
            } else {
                5
            };
            let mut drawn = false;
            let panel_time = panel.time;
            let fed = feed_line(&mut panel, line, |line, pixels| {
                assert_eq!(pixels.len(), WIDTH);
                pixels.fill(line);
                drawn = true;
                Ok::<_, ()>(())
            })
            .unwrap();
            assert_eq!(drawn, !matches!(fed, Fed::LeftOut(_)), "round {round}");
            if let Fed::LeftOut(ticks) = fed {
                assert_eq!(ticks, panel_time.wrapping_sub(panel.read_at(line)));
            }
            stats.count(fed);
            fates.push((fed, cost));
            if drawn {
                panel.pass(cost);
            }
        }
        panel.finish();
        assert_eq!(panel.seen.len(), usize::from(height));
        for (line, (fed, _)) in (0u16..).zip(&fates) {
            if let Fed::InTime(_) = fed {
                assert_eq!(
                    panel.seen[usize::from(line)],
                    [line; WIDTH],
                    "round {round}"
                );
            }
        }
        let sum = stats.lines_in_time + stats.lines_late + stats.lines_left_out;
        assert_eq!(sum, u32::from(height));
        seen.lines_in_time += stats.lines_in_time;
        seen.lines_left_out += stats.lines_left_out;
    }
    println!("{seen:?}");
    assert!(seen.lines_in_time > 20_000 && seen.lines_left_out > 3_000);
}

/// A source that takes its time while it draws: the deadline passes meanwhile.
#[test]
fn one_slow_line_costs_the_lines_that_it_takes_and_no_other() {
    use std::cell::Cell;

    /// A clock that the drawing advances.
    struct Shared<'c> {
        time: &'c Cell<u32>,
        ring: Vec<[u16; WIDTH]>,
    }
    impl ContinuousPanel for Shared<'_> {
        type Word = u16;
        fn now(&mut self) -> u32 {
            self.time.get()
        }
        fn deadline(&mut self, line: u16) -> u32 {
            100 + 20 * u32::from(line)
        }
        fn buffer(&mut self, line: u16) -> &mut [u16] {
            // Free when the line two before has been read.
            let free = (100 + 20 * u32::from(line)).saturating_sub(40);
            self.time.set(self.time.get().max(free));
            let at = usize::from(line) % self.ring.len();
            &mut self.ring[at]
        }
    }
    for slow in 0..30u16 {
        for extra in [0, 1, 10, 50, 85] {
            let time = Cell::new(0);
            let mut panel = Shared {
                time: &time,
                ring: vec![[0; WIDTH]; 2],
            };
            let mut drawn = Vec::new();
            let mut draw = |line, pixels: &mut [u16]| {
                let cost = if line == slow { 40 + extra } else { 10 };
                time.set(time.get() + cost);
                pixels.fill(line);
                drawn.push(line);
                Ok::<_, ()>(())
            };
            let mut stats = FeedStats::default();
            for line in 0..30 {
                stats.count(feed_line(&mut panel, line, &mut draw).unwrap());
            }
            // The line starts 40 ticks before its deadline and ends `extra` after it.
            let late = u32::from(extra > 0);
            // Those whose deadline has passed by then: at 20, 40, 60, 80 after it.
            let behind = extra.saturating_sub(1) / 20;
            let left_out = behind.min(u32::from(29 - slow));
            let want = FeedStats {
                lines_in_time: 30 - late - left_out,
                lines_late: late,
                lines_left_out: left_out,
                worst_ticks: extra,
            };
            assert_eq!(stats, want, "slow {slow}, extra {extra}");
            let missing = slow + 1..slow + 1 + left_out as u16;
            let want: Vec<u16> = (0..30).filter(|line| !missing.contains(line)).collect();
            assert_eq!(drawn, want);
        }
    }
}

/// A real scene with a panel that runs away at times: each line that is in time has the same bits as in the
/// whole picture, although lines before it were left out.
#[test]
fn a_scene_recovers_at_the_next_line() {
    type Look = Gouraud<Rgb565>;
    let (width, height) = (64u16, 48u16);
    let mut rooms = SceneRooms::new(64, 64, height.into(), 1);
    let mut scene = rooms.scene::<Look>(Screen::new(width, height).unwrap());
    let camera = Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 60.0, 0.1, 100.0);
    scene.begin(&camera.unwrap()).unwrap();
    let cube = Draw {
        model: Affine::rotation_y(0.4),
        ..Draw::new(scenes::CUBE)
    };
    scene.draw(&cube).unwrap();
    let mut lines = LineRooms::fitting(&scene, 8, true);
    let mut renderer = lines.renderer();
    let background = Rgb565::from_rgb8([9, 9, 9]);

    /// The panel, whose time runs away each time so many buffers were asked for.
    struct Runaway {
        panel: Panel,
        asked: u32,
        every: u32,
        in_time: Vec<u16>,
    }
    impl ContinuousPanel for Runaway {
        type Word = u16;
        fn now(&mut self) -> u32 {
            self.panel.now()
        }
        fn deadline(&mut self, line: u16) -> u32 {
            self.panel.deadline(line)
        }
        fn buffer(&mut self, line: u16) -> &mut [u16] {
            self.asked += 1;
            if self.asked.is_multiple_of(self.every) {
                self.panel.pass(130);
            } else {
                self.in_time.push(line);
            }
            self.panel.buffer(line)
        }
    }

    let mut whole = Vec::new();
    for line in 0..height {
        let mut pixels = vec![background; width.into()];
        renderer
            .draw_line(&scene, line, &mut pixels, background)
            .unwrap();
        whole.push(pixels);
    }
    for every in [2, 3, 7, 1_000] {
        let mut panel = Runaway {
            panel: Panel::new(u32::MAX - 300, 50, 20, height, 3, width.into()),
            asked: 0,
            every,
            in_time: Vec::new(),
        };
        let (fed, _) = draw_continuous(&scene, &mut renderer, &mut panel, background).unwrap();
        panel.panel.finish();
        assert_eq!(fed.lines_in_time as usize, panel.in_time.len());
        assert_eq!(fed.lines_left_out == 0, every == 1_000, "{fed:?}");
        assert!(fed.lines_in_time > 5);
        for line in panel.in_time {
            let line = usize::from(line);
            assert_eq!(
                panel.panel.seen[line], whole[line],
                "every {every}, line {line}"
            );
        }
    }
}
