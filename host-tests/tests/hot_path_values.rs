//! H8, H9, H15, K11, P1, P5: what a draw call does to its pixels, as values of the call.
//!
//! The reference goes from pixel to pixel and from call to call: coverage from whole numbers, 1/w in f64, and no
//! spans. Where two depths are nearer to each other than depth may err, a pixel is left out, and counted.

use crate::common::Rng;
use crate::hot::exact::within;
use crate::hot::layers::{Layer, lay_all};
use crate::hot::values::{
    Cut, FUNCTIONS, Function, NEARER_OR_EQUAL, PLACES, WHITE, blended, depth_test, draw_each,
    some_corners, some_mode,
};
use crate::hot::{Corner, LineRooms, SceneRooms, Smooth, WordOf, frame, line};
use scanbeam::frame::LineError;
use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{
    Blend, BlendMode, Budget, DepthFunction, DepthTest, Draw, Scene, Skin, TexturePlace,
};
use scanbeam::{Cull, Screen};

const BACKGROUND: [u8; 3] = [40, 0, 120];

/// A draw call of one triangle of one colour, and its values.
#[derive(Clone, Debug)]
struct Call {
    corners: [Corner; 3],
    cut: Option<Cut>,
    /// Where it is seen, and where its depth is kept.
    test: [Function; 2],
    /// What becomes of colours that are there, and the channels that are written.
    blend: Option<(BlendMode, [bool; 3])>,
    priority: u8,
}

impl Call {
    /// Any triangle, and no values.
    fn new(rng: &mut Rng, screen: Screen) -> Self {
        let corners = some_corners(rng, screen);
        Self {
            corners,
            cut: None,
            test: [NEARER_OR_EQUAL; 2],
            blend: None,
            priority: 0,
        }
    }

    fn dress(&self, call: &mut Draw<'_, '_, i32>, is_textured: bool) {
        let skin = Skin {
            texture: &WHITE,
            places: &PLACES,
            budget: Budget::BALANCED,
        };
        call.texture = is_textured.then_some(skin);
        call.cull = Cull::None;
        call.scissor = self.cut.as_ref().map(Cut::scissor);
        call.depth = depth_test(self.test);
        call.priority = self.priority;
        call.blend = self.blend.map(|(mode, rgb)| Blend::new(mode).writing(rgb));
    }

    /// Whether it has this pixel.
    fn covers(&self, x: u16, y: u16, screen: Screen) -> bool {
        let columns = within(self.corners.map(|c| c.at), y.into(), screen.width());
        columns.contains(&usize::from(x)) && self.cut.as_ref().is_none_or(|cut| cut.keeps(x, y))
    }

    fn layer(&self) -> Layer<'_> {
        let is_translucent = |(mode, _)| mode != BlendMode::Replace;
        Layer {
            corners: &self.corners,
            test: self.test,
            is_translucent: self.blend.is_some_and(is_translucent),
        }
    }
}

/// The levels of a pixel, and by how much each may be off.
#[derive(Clone, Copy, Debug)]
struct Levels {
    level: [f64; 3],
    off: [f64; 3],
}

/// What rounding may add to a level: where a colour is written, and where it is blended.
#[derive(Clone, Copy)]
struct Rounding {
    written: f64,
    blended: f64,
}

const OF_888: Rounding = Rounding {
    written: 0.51,
    blended: 1.01,
};
/// Half a step of 5 bits and what rounding may add; that, and alpha of 5 bits.
const OF_565: Rounding = Rounding {
    written: 4.7,
    blended: 8.8,
};

/// The shade that a texel is multiplied by has 5 and 6 bits, too.
const OF_TEXELS: Rounding = Rounding {
    written: 9.0,
    blended: 8.8,
};

impl Levels {
    fn lay(&mut self, call: &Call, rounding: Rounding) {
        let (mode, rgb) = call.blend.unwrap_or((BlendMode::Replace, [true; 3]));
        for i in (0..3).filter(|&i| rgb[i]) {
            let new = f64::from(call.corners[0].colour[i]);
            let [level, of_old] = blended(mode, self.level[i], new);
            let more = match mode {
                BlendMode::Replace => rounding.written,
                // The new colour was rounded too.
                _ => rounding.blended + rounding.written,
            };
            (self.level[i], self.off[i]) = (level, self.off[i] * of_old + more);
        }
    }
}

/// The colour of a pixel; `None` where it hangs on what depth may err.
fn pixel(
    calls: &[&Call],
    [x, y]: [u16; 2],
    screen: Screen,
    by_depth: bool,
    rounding: Rounding,
) -> Option<Levels> {
    let mut levels = Levels {
        level: BACKGROUND.map(f64::from),
        off: [rounding.written; 3],
    };
    let covering = calls.iter().filter(|call| call.covers(x, y, screen));
    let layers = covering.map(|&call| (call.layer(), call));
    lay_all(layers, [x, y], by_depth, |call| {
        levels.lay(call, rounding);
        Some(())
    })?;
    Some(levels)
}

/// Draws calls, and hands the scene to `see`.
fn with_calls<L: Smooth, R>(
    screen: Screen,
    calls: &[Call],
    see: impl FnOnce(&Scene<'_, '_, L>) -> R,
) -> R {
    let mut rooms = SceneRooms::of_triangles(calls.len(), screen);
    rooms.places = vec![TexturePlace::EMPTY; rooms.vertices.len()];
    let mut scene = rooms.scene::<L>(screen);
    let dress = |call: &Call, draw: &mut Draw<'_, '_, i32>| call.dress(draw, L::TEXTURED);
    draw_each(&mut scene, calls, |call| call.corners, dress);
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

/// [`hold`], of even rounds in one format and of odd ones in another.
fn hold_by_turns(rng: &mut Rng, screen: Screen, calls: &[Call], round: u32) -> [usize; 2] {
    match round % 2 {
        0 => hold::<Gouraud<Rgb888>>(rng, screen, calls, OF_888),
        _ => hold::<Gouraud<Rgb565Be>>(rng, screen, calls, OF_565),
    }
}

/// Holds pictures of calls against the reference: with and without depth, any number of slots, any order of lines. How
/// many pixels were compared, and how many were left out.
fn hold<L: Smooth>(rng: &mut Rng, screen: Screen, calls: &[Call], rounding: Rounding) -> [usize; 2]
where
    WordOf<L>: PartialEq + std::fmt::Debug,
{
    let mut counts = [0; 2];
    with_calls::<L, _>(screen, calls, |scene| {
        let mut order: Vec<_> = calls.iter().collect();
        order.sort_by_key(|call| call.priority);
        let is_ranked = calls.iter().any(|call| call.priority > 0);
        for has_depth in [true, false] {
            let by_depth = has_depth && !is_ranked;
            let background = L::Format::from_rgb8(BACKGROUND);
            let lines = frame(scene, 128, has_depth, background);
            let slots = rng.pick(&[0, 1, 2, 5, 128]);
            let others = shuffled(scene, rng, slots, has_depth);
            for (y, (line, other)) in (0..).zip(lines.iter().zip(&others)) {
                assert_eq!(line, other, "line {y}, {slots} slots, depth: {by_depth}");
                for (x, &word) in (0..).zip(line) {
                    let Some(want) = pixel(&order, [x, y], screen, by_depth, rounding) else {
                        counts[1] += 1;
                        continue;
                    };
                    counts[0] += 1;
                    let got = L::Format::to_rgb8(word);
                    let is_near =
                        |i: usize| (f64::from(got[i]) - want.level[i]).abs() <= want.off[i];
                    assert!(
                        (0..3).all(is_near),
                        "{got:?} for {want:?} at {x}, {y}, depth: {by_depth}: {calls:#?}"
                    );
                }
            }
        }
    });
    counts
}

/// H15: inside and outside of rectangles, within calls of which some have none; more calls than a slot can tell apart.
/// Kills: a slot that knows its call modulo 256, or that of the triangle that it held before.
#[test]
fn scissors_keep_what_is_inside_or_outside() {
    let mut rng = Rng::new(1_601);
    let mut counts = [0; 2];
    for round in 0..250 {
        let screen = Screen::new(rng.pick(&[33, 70, 128]), 40).unwrap();
        let calls: Vec<_> = (0..if round % 50 == 7 {
            400
        } else {
            1 + rng.below(9)
        })
            .map(|_| {
                let mut call = Call::new(&mut rng, screen);
                call.cut = (rng.below(3) > 0).then(|| Cut::new(&mut rng, screen));
                call
            })
            .collect();
        let here = hold_by_turns(&mut rng, screen, &calls, round);
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
        let here = hold_by_turns(&mut rng, screen, &calls, round);
        counts = [0, 1].map(|i| counts[i] + here[i]);
    }
    assert!(
        counts[0] > 1_000_000 && counts[1] < counts[0] / 100,
        "{counts:?}"
    );
}

/// K11, H8, P5: all modes, among what is opaque, with scissors and functions; more of them over each other than a pile
/// holds, many of which cross.
#[test]
fn translucent_calls_are_blended_from_far_to_near() {
    let mut rng = Rng::new(1_603);
    let mut counts = [0; 2];
    for round in 0..250 {
        let screen = Screen::new(rng.pick(&[33, 70, 128]), 24).unwrap();
        let many = if round % 16 == 0 { 60 } else { 10 };
        let calls: Vec<_> = (0..2 + rng.below(many))
            .map(|_| {
                let mut call = Call::new(&mut rng, screen);
                if rng.below(4) > 0 {
                    let rgb = [(); 3].map(|()| rng.below(8) > 0);
                    call.blend = Some((some_mode(&mut rng), rgb));
                }
                if rng.below(4) == 0 {
                    call.test[0] = rng.pick(&FUNCTIONS);
                }
                call.cut = (rng.below(4) == 0).then(|| Cut::new(&mut rng, screen));
                call
            })
            .collect();
        let here = match round % 4 {
            0 | 1 => hold::<Gouraud<Rgb888>>(&mut rng, screen, &calls, OF_888),
            2 => hold::<Gouraud<Rgb565Be>>(&mut rng, screen, &calls, OF_565),
            _ => hold::<Textured<Rgb565Be>>(&mut rng, screen, &calls, OF_TEXELS),
        };
        counts = [0, 1].map(|i| counts[i] + here[i]);
    }
    assert!(
        counts[0] > 500_000 && counts[1] < counts[0] / 20,
        "{counts:?}"
    );
}

/// More panes over each other than a pile or a cache holds, in any order of submission.
#[test]
fn many_panes_over_each_other_are_blended_from_far_to_near() {
    let mut rng = Rng::new(1_604);
    let screen = Screen::new(37, 6).unwrap();
    let mut counts = [0; 2];
    for panes in [15, 16, 17, 33, 100, 150] {
        let mut order: Vec<_> = (0..panes).collect();
        rng.shuffle(&mut order);
        let calls: Vec<_> = order
            .into_iter()
            .map(|i| {
                let mut call = Call::new(&mut rng, screen);
                let w = 1.0 + f64::from(i) / 20.0;
                for (corner, at) in call.corners.iter_mut().zip([(-80, -8), (600, 3), (5, 400)]) {
                    (corner.at, corner.w) = (at, w);
                }
                call.blend = Some((BlendMode::Filter(100), [true; 3]));
                call
            })
            .collect();
        let here = hold::<Gouraud<Rgb888>>(&mut rng, screen, &calls, OF_888);
        counts = [0, 1].map(|i| counts[i] + here[i]);
    }
    assert!(counts[0] > 2_000 && counts[1] == 0, "{counts:?}");
}

/// P1: priorities, some of them equal, in any order of submission, with everything else that a call may have.
#[test]
fn calls_are_drawn_by_priority_where_any_has_one() {
    let mut rng = Rng::new(1_605);
    let mut counts = [0; 2];
    for round in 0..250 {
        let screen = Screen::new(rng.pick(&[33, 70, 128]), 24).unwrap();
        let (many, levels) = (rng.pick(&[3, 10, 40]), rng.pick(&[2, 4, 256]));
        let mut calls: Vec<_> = (0..2 + rng.below(many))
            .map(|_| {
                let mut call = Call::new(&mut rng, screen);
                call.priority = rng.below(levels) as u8;
                if round % 2 == 0 && rng.below(3) == 0 {
                    call.blend = Some((some_mode(&mut rng), [true; 3]));
                }
                if round % 2 == 0 && rng.below(3) == 0 {
                    call.test[0] = rng.pick(&FUNCTIONS);
                }
                call.cut =
                    (round % 2 == 0 && rng.below(4) == 0).then(|| Cut::new(&mut rng, screen));
                call
            })
            .collect();
        calls[0].priority = 1;
        let here = match round % 6 {
            0..4 => hold::<Gouraud<Rgb888>>(&mut rng, screen, &calls, OF_888),
            4 => hold::<Gouraud<Rgb565Be>>(&mut rng, screen, &calls, OF_565),
            _ => hold::<Textured<Rgb565Be>>(&mut rng, screen, &calls, OF_TEXELS),
        };
        counts = [0, 1].map(|i| counts[i] + here[i]);
    }
    assert!(counts[0] > 500_000 && counts[1] == 0, "{counts:?}");
}

/// Draws calls with a plain renderer: the same lines as any other draws, or none, and nothing written, where a call has
/// values. Whether it was refused.
fn is_refused<L: Smooth>(rng: &mut Rng, screen: Screen, calls: &[Call]) -> bool
where
    WordOf<L>: PartialEq + std::fmt::Debug,
{
    let has_values = calls.iter().any(|call| {
        let test = call.test.map(|(function, _)| function);
        let compares = DepthTest::HIDES
            != DepthTest {
                colour_if: test[0],
                depth_if: test[1],
            };
        call.cut.is_some() || compares || call.blend.is_some()
    });
    let background = L::Format::from_rgb8(BACKGROUND);
    let other = L::Format::from_rgb8([90, 200, 10]);
    with_calls::<L, _>(screen, calls, |scene| {
        let has_depth = rng.below(2) == 0;
        let slots = rng.pick(&[0, 2, 128]);
        let want = frame(scene, slots, has_depth, background);
        let mut rooms = LineRooms::fitting(scene, slots, has_depth);
        let mut renderer = rooms.plain();
        let refused = has_values.then_some(LineError::Values);
        assert_eq!(renderer.check(scene).err(), refused);
        for (y, want) in (0..).zip(want) {
            let mut pixels = vec![other; screen.width().into()];
            let drawn = L::draw_line(&mut renderer, scene, y, &mut pixels, background);
            assert_eq!(drawn.err(), refused);
            let want = match refused {
                Some(_) => vec![other; pixels.len()],
                None => want,
            };
            assert_eq!(pixels, want, "line {y}, {slots} slots, depth: {has_depth}");
        }
        has_values
    })
}

/// Each value alone is refused by a renderer without their code, before anything is written; priorities need none.
#[test]
fn plain_renderers_refuse_values_and_draw_the_rest_alike() {
    let mut rng = Rng::new(1_607);
    let screen = Screen::new(70, 40).unwrap();
    for round in 0..80 {
        let mut calls: Vec<_> = (0..1 + rng.below(9))
            .map(|_| Call::new(&mut rng, screen))
            .collect();
        let at = rng.below(calls.len() as u32) as usize;
        let call = &mut calls[at];
        let kind = round % 6;
        match kind {
            0 => call.cut = Some(Cut::new(&mut rng, screen)),
            1 => call.test[(rng.below(2)) as usize].0 = DepthFunction::NEVER,
            2 => call.blend = Some((BlendMode::Replace, [true, true, false])),
            3 => call.blend = Some((BlendMode::Filter(100), [true; 3])),
            4 => call.priority = 1 + rng.below(255) as u8,
            _ => {}
        }
        let refused = match round / 6 % 3 {
            0 => is_refused::<Gouraud<Rgb888>>(&mut rng, screen, &calls),
            1 => is_refused::<Gouraud<Rgb565Be>>(&mut rng, screen, &calls),
            _ => is_refused::<Textured<Rgb565Be>>(&mut rng, screen, &calls),
        };
        assert_eq!(refused, kind < 4);
    }
}
