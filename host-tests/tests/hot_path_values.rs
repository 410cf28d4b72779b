//! H9, H15: what a draw call does to its pixels, as values of the call.
//!
//! The reference goes from pixel to pixel and from call to call: coverage from whole numbers, 1/w in f64, and no
//! spans. Where two depths are nearer to each other than depth may err, a pixel is left out, and counted.

use crate::common::Rng;
use crate::hot::exact::within;
use crate::hot::{Corner, LineRooms, SceneRooms, Smooth, WordOf, camera, draw_with, frame, line};
use crate::hot_path_depth::{bound, exact};
use scanbeam::look::{Gouraud, Look};
use scanbeam::scene::{Draw, Scene, Scissor};
use scanbeam::{Cull, PixelFormat, Rgb565Be, Rgb888, Screen};
use std::cmp::Ordering;
use std::ops::Range;

const BACKGROUND: [u8; 3] = [40, 0, 120];

/// A rectangle, and whether what is outside of it is kept.
#[derive(Clone, Debug)]
struct Cut {
    columns: Range<u16>,
    lines: Range<u16>,
    outside: bool,
}

impl Cut {
    fn new(rng: &mut Rng, screen: Screen) -> Self {
        let mut range = |end: u16| {
            let [a, b] = [(); 2].map(|()| rng.below(u32::from(end) + 20) as u16);
            a.min(b)..a.max(b)
        };
        Self {
            columns: range(screen.width()),
            lines: range(screen.height()),
            outside: rng.below(2) == 0,
        }
    }

    fn keeps(&self, x: u16, y: u16) -> bool {
        (self.columns.contains(&x) && self.lines.contains(&y)) != self.outside
    }

    fn scissor(&self) -> Scissor {
        let (columns, lines) = (self.columns.clone(), self.lines.clone());
        if self.outside {
            Scissor::outside(columns, lines)
        } else {
            Scissor::inside(columns, lines)
        }
    }
}

/// A draw call of one triangle of one colour, and its values.
#[derive(Clone, Debug)]
struct Call {
    corners: [Corner; 3],
    cut: Option<Cut>,
}

impl Call {
    /// Any triangle, and no values.
    fn new(rng: &mut Rng, screen: Screen) -> Self {
        let size = rng.pick(&[40, 200, 600, 3_000]);
        let middle =
            [screen.width(), screen.height()].map(|side| rng.within(0, 8 * i32::from(side)));
        let w = 1.0 + 7.0 * rng.unit();
        let slant = rng.pick(&[1.0, 1.0, 1.0, 3.0]);
        let colour = [(); 3].map(|()| rng.below(256) as u8);
        let corners = [(); 3].map(|()| Corner {
            at: (
                middle[0] + rng.within(-size, size),
                middle[1] + rng.within(-size, size),
            ),
            w: w * rng.between(1.0, slant),
            colour,
        });
        Self { corners, cut: None }
    }

    fn dress(&self, call: &mut Draw<'_, '_, i32>) {
        call.cull = Cull::None;
        call.scissor = self.cut.as_ref().map(Cut::scissor);
    }

    /// Whether it has this pixel.
    fn covers(&self, x: u16, y: u16, screen: Screen) -> bool {
        let columns = within(self.corners.map(|c| c.at), y.into(), screen.width());
        columns.contains(&usize::from(x)) && self.cut.as_ref().is_none_or(|cut| cut.keeps(x, y))
    }

    /// Its depth at a pixel, and by how much that may be off.
    fn depth(&self, x: u16, y: u16) -> [f64; 2] {
        [exact(&self.corners, x.into(), y), bound(&self.corners)]
    }
}

/// How depths compare; `None` where that is not known.
fn compare(one: [f64; 2], other: [f64; 2]) -> Option<Ordering> {
    let apart = one[0] - other[0];
    (apart.abs() > one[1] + other[1]).then(|| apart.total_cmp(&0.0))
}

/// The colour of a pixel; `None` where it hangs on what depth may err.
fn pixel(calls: &[Call], x: u16, y: u16, screen: Screen, by_depth: bool) -> Option<[f64; 3]> {
    let (mut colour, mut depth) = (BACKGROUND.map(f64::from), [0.0; 2]);
    for call in calls.iter().filter(|call| call.covers(x, y, screen)) {
        let here = call.depth(x, y);
        if !by_depth || compare(here, depth)? != Ordering::Less {
            colour = call.corners[0].colour.map(f64::from);
            depth = here;
        }
    }
    Some(colour)
}

/// Draws calls, and hands the scene to `see`.
fn with_calls<L: Look, R>(
    screen: Screen,
    calls: &[Call],
    see: impl FnOnce(&Scene<'_, '_, L>) -> R,
) -> R {
    let mut rooms = SceneRooms::of_triangles(calls.len(), screen);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    for call in calls {
        draw_with(&mut scene, &[call.corners], |draw| call.dress(draw)).expect("there is room");
    }
    see(&scene)
}

/// All lines with so many slots, drawn in any order.
fn shuffled<L: Smooth>(
    scene: &Scene<'_, '_, L>,
    rng: &mut Rng,
    slots: u16,
    depth: bool,
) -> Vec<Vec<WordOf<L>>> {
    let mut rooms = LineRooms::fitting(scene, slots, depth);
    let mut renderer = rooms.renderer();
    let background = L::Format::from_rgb8(BACKGROUND);
    let height = scene.screen().height();
    let mut lines = vec![Vec::new(); height.into()];
    let step = rng.pick(&[1, 7, 11, 17]);
    for i in 0..height {
        let y = i * step % height;
        lines[usize::from(y)] = line(&mut renderer, scene, y, background);
    }
    lines
}

/// Holds pictures of calls against the reference: with and without depth, any number of slots, any order of lines. How
/// many pixels were compared, and how many were left out.
fn hold<L: Smooth>(
    rng: &mut Rng,
    screen: Screen,
    calls: &[Call],
    may_be_off: impl Fn(usize) -> f64,
) -> [usize; 2]
where
    WordOf<L>: PartialEq + std::fmt::Debug,
{
    let mut counts = [0; 2];
    with_calls::<L, _>(screen, calls, |scene| {
        for by_depth in [true, false] {
            let background = L::Format::from_rgb8(BACKGROUND);
            let lines = frame(scene, 128, by_depth, background);
            let slots = rng.pick(&[0, 1, 2, 5, 128]);
            let others = shuffled(scene, rng, slots, by_depth);
            for (y, (line, other)) in (0..).zip(lines.iter().zip(&others)) {
                assert_eq!(line, other, "line {y}, {slots} slots, depth: {by_depth}");
                for (x, &word) in (0..).zip(line) {
                    let Some(want) = pixel(calls, x, y, screen, by_depth) else {
                        counts[1] += 1;
                        continue;
                    };
                    counts[0] += 1;
                    let got = L::Format::to_rgb8(word);
                    let off = (0..3).map(|i| (f64::from(got[i]) - want[i]).abs());
                    let off = off.fold(0.0, f64::max);
                    let layers = calls.iter().filter(|c| c.covers(x, y, screen)).count();
                    assert!(
                        off <= may_be_off(layers),
                        "{got:?} for {want:?} at {x}, {y}, depth: {by_depth}: {calls:#?}"
                    );
                }
            }
        }
    });
    counts
}

/// Half a step of 5 bits, and what rounding may add.
fn step_565(_: usize) -> f64 {
    255.0 / 31.0 / 2.0 + 0.5
}

/// H15: inside and outside of rectangles, within calls of which some have none.
#[test]
fn scissors_keep_what_is_inside_or_outside() {
    let mut rng = Rng::new(1_601);
    let mut counts = [0; 2];
    for round in 0..250 {
        let screen = Screen::new(rng.pick(&[33, 70, 128]), 40).unwrap();
        let calls: Vec<_> = (0..1 + rng.below(9))
            .map(|_| {
                let mut call = Call::new(&mut rng, screen);
                call.cut = (rng.below(3) > 0).then(|| Cut::new(&mut rng, screen));
                call
            })
            .collect();
        let here = if round % 2 == 0 {
            hold::<Gouraud<Rgb888>>(&mut rng, screen, &calls, |_| 0.51)
        } else {
            hold::<Gouraud<Rgb565Be>>(&mut rng, screen, &calls, step_565)
        };
        counts = [0, 1].map(|i| counts[i] + here[i]);
    }
    assert!(
        counts[0] > 1_000_000 && counts[1] < counts[0] / 100,
        "{counts:?}"
    );
}
