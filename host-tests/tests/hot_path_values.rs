//! H9, H15: what a draw call does to its pixels, as values of the call.
//!
//! The reference goes from pixel to pixel and from call to call: coverage from whole numbers, 1/w in f64, and no
//! spans. Where two depths are nearer to each other than depth may err, a pixel is left out, and counted.

use crate::common::Rng;
use crate::hot::exact::within;
use crate::hot::{Corner, LineRooms, SceneRooms, Smooth, WordOf, camera, draw_with, frame, line};
use crate::hot_path_depth::{bound, exact};
use scanbeam::look::{Gouraud, Look};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{DepthFunction, DepthTest, Draw, Scene, Scissor};
use scanbeam::{Cull, Screen};
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

/// A function, and whether it lets nearer, equal and farther depths pass.
type Function = (DepthFunction, [bool; 3]);

const NEARER_OR_EQUAL: Function = (DepthFunction::NEARER_OR_EQUAL, [true, true, false]);

const FUNCTIONS: [Function; 8] = [
    NEARER_OR_EQUAL,
    (DepthFunction::NEVER, [false; 3]),
    (DepthFunction::ALWAYS, [true; 3]),
    (DepthFunction::NEARER, [true, false, false]),
    (DepthFunction::EQUAL, [false, true, false]),
    (DepthFunction::FARTHER_OR_EQUAL, [false, true, true]),
    (DepthFunction::FARTHER, [false, false, true]),
    (DepthFunction::DIFFERENT, [true, false, true]),
];

/// Whether a depth that compares so passes.
fn passes((_, passing): Function, order: Ordering) -> bool {
    match order {
        Ordering::Greater => passing[0],
        Ordering::Equal => passing[1],
        Ordering::Less => passing[2],
    }
}

/// A draw call of one triangle of one colour, and its values.
#[derive(Clone, Debug)]
struct Call {
    corners: [Corner; 3],
    cut: Option<Cut>,
    /// Where it is seen, and where its depth is kept.
    test: [Function; 2],
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
        Self {
            corners,
            cut: None,
            test: [NEARER_OR_EQUAL; 2],
        }
    }

    fn dress(&self, call: &mut Draw<'_, '_, i32>) {
        call.cull = Cull::None;
        call.scissor = self.cut.as_ref().map(Cut::scissor);
        let [colour_if, depth_if] = self.test.map(|(function, _)| function);
        call.depth = DepthTest {
            colour_if,
            depth_if,
        };
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

/// A depth that is there: nothing, or that of a triangle.
#[derive(Clone, Copy)]
struct There<'a> {
    of: Option<&'a [Corner; 3]>,
    depth: [f64; 2],
}

/// How a depth compares with that which is there; `None` where that is not known. A triangle is as far as itself.
fn compare(here: There<'_>, there: There<'_>) -> Option<Ordering> {
    let same =
        |a: &[Corner; 3], b: &[Corner; 3]| (0..3).all(|i| a[i].at == b[i].at && a[i].w == b[i].w);
    match (here.of, there.of) {
        (Some(a), Some(b)) if same(a, b) => return Some(Ordering::Equal),
        _ => {}
    }
    let apart = here.depth[0] - there.depth[0];
    (apart.abs() > here.depth[1] + there.depth[1]).then(|| apart.total_cmp(&0.0))
}

/// The colour of a pixel; `None` where it hangs on what depth may err.
fn pixel(calls: &[Call], x: u16, y: u16, screen: Screen, by_depth: bool) -> Option<[f64; 3]> {
    let mut colour = BACKGROUND.map(f64::from);
    let mut there = There {
        of: None,
        depth: [0.0; 2],
    };
    for call in calls.iter().filter(|call| call.covers(x, y, screen)) {
        let here = There {
            of: Some(&call.corners),
            depth: call.depth(x, y),
        };
        let mut passing = [true; 2];
        if by_depth {
            let order = compare(here, there)?;
            passing = call.test.map(|function| passes(function, order));
        }
        if passing[0] {
            colour = call.corners[0].colour.map(f64::from);
        }
        if passing[1] {
            there = here;
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

/// H9: all functions for colour and for depth, of calls in any order; some are drawn again, so that depths are equal.
#[test]
fn depth_functions_decide_on_colour_and_on_depth() {
    let mut rng = Rng::new(1_602);
    let mut counts = [0; 2];
    for round in 0..250 {
        let screen = Screen::new(rng.pick(&[33, 70, 128]), 40).unwrap();
        let mut calls: Vec<Call> = Vec::new();
        for _ in 0..2 + rng.below(9) {
            let mut call = Call::new(&mut rng, screen);
            if rng.below(3) == 0 && !calls.is_empty() {
                let again = &calls[rng.below(calls.len() as u32) as usize];
                for (corner, &old) in call.corners.iter_mut().zip(&again.corners) {
                    (corner.at, corner.w) = (old.at, old.w);
                }
            }
            if rng.below(3) > 0 {
                call.test = [(); 2].map(|()| rng.pick(&FUNCTIONS));
            }
            call.cut = (rng.below(4) == 0).then(|| Cut::new(&mut rng, screen));
            calls.push(call);
        }
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
