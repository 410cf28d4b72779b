//! K9: volumes of several lights, and surfaces that are drawn again, as values of draw calls of any triangles.
//!
//! The reference goes from pixel to pixel: coverage from whole numbers, 1/w in f64, and counts of what lies in front. Where
//! two depths are nearer to each other than depth may err, a pixel is left out, and counted.

use crate::common::Rng;
use crate::hot::exact::{doubled_area, within};
use crate::hot::layers::compare_face;
use crate::hot::values::{
    Cut, FUNCTIONS, Function, HOLED, PLACES, WHITE, blended, draw_each, passes, some_corners,
};
use crate::hot::{
    Corner, LineRooms, SceneRooms, Smooth, WordOf, camera, draw_with, line, position, scale,
};
use crate::hot_path_depth::{bound, exact};
use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{Blend, BlendMode, Budget, DepthTest, Draw, Scene, Shadow, Skin};
use scanbeam::{Affine, Cull, Faces, Mesh, Screen};
use std::cmp::Ordering;

const BACKGROUND: [u8; 3] = [40, 0, 120];

/// A draw call of one triangle of one colour.
#[derive(Clone, Debug)]
struct Call {
    corners: [Corner; 3],
    shadow: Option<Shadow>,
    cut: Option<Cut>,
    /// In place of what the shadow says.
    test: Option<Function>,
    blend: Option<BlendMode>,
}

impl Call {
    fn new(rng: &mut Rng, screen: Screen) -> Self {
        let corners = some_corners(rng, screen);
        Self {
            corners,
            shadow: None,
            cut: None,
            test: None,
            blend: None,
        }
    }

    /// What is seen, volumes of lights and what is seen again, in any order.
    fn some(rng: &mut Rng, screen: Screen, many: u32) -> Vec<Self> {
        let lights = [0, 3, 7];
        let mut seen: Vec<Self> = (0..2 + rng.below(many))
            .map(|_| Self::new(rng, screen))
            .collect();
        let mut again: Vec<Self> = Vec::new();
        for call in &mut seen {
            for light in lights {
                // More than once now and then: a light is added once.
                for _ in 0..rng.pick(&[0, 0, 1, 1, 2]) {
                    let mut call = call.clone();
                    for corner in &mut call.corners {
                        corner.colour = [(); 3].map(|()| rng.below(256) as u8);
                    }
                    let colour = call.corners[0].colour;
                    call.corners.iter_mut().for_each(|c| c.colour = colour);
                    let kinds = [Shadow::Lit(light), Shadow::Shadowed(light)];
                    call.shadow = Some(rng.pick(&kinds));
                    call.blend = rng.pick(&[
                        None,
                        Some(BlendMode::Add(200)),
                        Some(BlendMode::Filter(120)),
                        Some(BlendMode::Subtract(90)),
                    ]);
                    again.push(call);
                }
            }
            if rng.below(6) == 0 {
                call.blend = Some(BlendMode::Filter(100));
            }
        }
        for _ in 0..rng.below(2 * many) {
            let mut call = Self::new(rng, screen);
            call.shadow = Some(Shadow::Volume(rng.pick(&lights)));
            call.test = (rng.below(6) == 0).then(|| rng.pick(&FUNCTIONS[1..]));
            if rng.below(3) == 0 {
                call.blend = Some(BlendMode::Half);
            }
            again.push(call);
        }
        seen.append(&mut again);
        rng.shuffle(&mut seen);
        for call in &mut seen {
            call.cut = (rng.below(5) == 0).then(|| Cut::new(rng, screen));
        }
        seen
    }

    fn dress(&self, call: &mut Draw<'_, '_, i32>, is_textured: bool) {
        let is_volume = matches!(self.shadow, Some(Shadow::Volume(_)));
        // Nothing of a volume is seen, whatever it looks like.
        let texture = if is_volume { &HOLED } else { &WHITE };
        let skin = Skin {
            texture,
            places: &PLACES,
            budget: Budget::BALANCED,
        };
        call.texture = is_textured.then_some(skin);
        call.cull = Cull::None;
        call.shadow = self.shadow;
        call.scissor = self.cut.as_ref().map(Cut::scissor);
        if let Some((function, _)) = self.test {
            call.depth = DepthTest::new(function);
        }
        call.blend = self.blend.map(Blend::new);
    }

    fn covers(&self, x: u16, y: u16, screen: Screen) -> bool {
        let columns = within(self.corners.map(|c| c.at), y.into(), screen.width());
        columns.contains(&usize::from(x)) && self.cut.as_ref().is_none_or(|cut| cut.keeps(x, y))
    }

    /// How it compares with what is there, if that is known.
    fn compare(&self, there: Option<&Self>, [x, y]: [u16; 2]) -> Option<Ordering> {
        let here = (exact(&self.corners, x.into(), y), bound(&self.corners));
        let Some(there) = there else {
            return (here.0 > here.1).then_some(Ordering::Greater);
        };
        let same = |i: usize| {
            let (a, b) = (self.corners[i], there.corners[i]);
            a.at == b.at && a.w == b.w
        };
        if (0..3).all(same) {
            return Some(Ordering::Equal);
        }
        let apart = here.0 - exact(&there.corners, x.into(), y);
        let is_known = apart.abs() > here.1 + bound(&there.corners);
        is_known.then(|| apart.total_cmp(&0.0))
    }

    fn passes(&self, usual: [bool; 3], order: Ordering) -> bool {
        let (function, _) = FUNCTIONS[0];
        passes(self.test.unwrap_or((function, usual)), order)
    }
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
const OF_565: Rounding = Rounding {
    written: 4.7,
    blended: 8.8,
};
const OF_TEXELS: Rounding = Rounding {
    written: 9.0,
    blended: 8.8,
};

/// The levels of a pixel, and by how much each may be off.
#[derive(Clone, Copy, Debug)]
struct Levels {
    level: [f64; 3],
    off: [f64; 3],
}

impl Levels {
    fn lay(&mut self, call: &Call, rounding: Rounding) {
        let mode = call.blend.unwrap_or(BlendMode::Replace);
        for i in 0..3 {
            let new = f64::from(call.corners[0].colour[i]);
            let [level, of_old] = blended(mode, self.level[i], new);
            let more = match mode {
                BlendMode::Replace => rounding.written,
                _ => rounding.blended + rounding.written,
            };
            (self.level[i], self.off[i]) = (level, self.off[i] * of_old + more);
        }
    }
}

/// How often a kind of surface was drawn again.
#[derive(Default, Debug)]
struct Tally {
    compared: usize,
    left_out: usize,
    lit: usize,
    shadowed: usize,
    balanced: usize,
}

const NEARER: [bool; 3] = [true, false, false];
const NEARER_OR_EQUAL: [bool; 3] = [true, true, false];
const EQUAL: [bool; 3] = [false, true, false];

/// The colour of a pixel; `None` where it hangs on what depth may err.
fn pixel(
    calls: &[Call],
    at: [u16; 2],
    screen: Screen,
    rounding: Rounding,
    tally: &mut Tally,
) -> Option<Levels> {
    let mut levels = Levels {
        level: BACKGROUND.map(f64::from),
        off: [rounding.written; 3],
    };
    let here: Vec<&Call> = calls
        .iter()
        .filter(|call| call.covers(at[0], at[1], screen))
        .collect();
    let mut there = None;
    let plain = |call: &&&Call| call.shadow.is_none();
    for call in here.iter().filter(plain).filter(|c| c.blend.is_none()) {
        if call.passes(NEARER_OR_EQUAL, call.compare(there, at)?) {
            levels.lay(call, rounding);
            there = Some(call);
        }
    }
    for light in 0..Shadow::LIGHTS {
        let (mut count, mut faces) = (0, 0);
        let volume = Some(Shadow::Volume(light));
        for call in here.iter().filter(|call| call.shadow == volume) {
            let order = compare_face(&call.corners, there.map(|there| &there.corners), at)?;
            if call.passes(NEARER, order) {
                // Clockwise is from behind.
                let is_back = doubled_area(call.corners.map(|c| c.at)) > 0;
                count += if is_back { 1 } else { -1 };
                faces += 1;
            }
        }
        let mut done = [false; 2];
        for call in &here {
            let is_shadowed = match call.shadow {
                Some(Shadow::Lit(its)) if its == light => false,
                Some(Shadow::Shadowed(its)) if its == light => true,
                _ => continue,
            };
            let has_part = call.blend.is_some() && done[usize::from(is_shadowed)];
            let seen = call.passes(EQUAL, call.compare(there, at)?);
            if !seen || has_part || is_shadowed != (count != 0) {
                continue;
            }
            done[usize::from(is_shadowed)] |= call.blend.is_some();
            levels.lay(call, rounding);
            tally.shadowed += usize::from(is_shadowed);
            tally.lit += usize::from(!is_shadowed);
            tally.balanced += usize::from(!is_shadowed && faces > 0);
        }
    }
    let mut panes: Vec<&Call> = Vec::new();
    for call in here.iter().filter(plain).filter(|c| c.blend.is_some()) {
        // From far to near; what is as far as another comes after it.
        let mut place = panes.len();
        for (i, other) in panes.iter().enumerate().rev() {
            if call.compare(Some(other), at)? == Ordering::Less {
                place = i;
            }
        }
        panes.insert(place, call);
    }
    for call in panes {
        if call.passes(NEARER_OR_EQUAL, call.compare(there, at)?) {
            levels.lay(call, rounding);
        }
    }
    Some(levels)
}

/// Lines with so many slots, the first few of each `step` last.
fn lines<L: Smooth>(scene: &Scene<'_, '_, L>, slots: u16, step: usize) -> Vec<Vec<WordOf<L>>> {
    let mut rooms = LineRooms::fitting(scene, slots, true);
    let mut renderer = rooms.with_shadows();
    let mut picture = vec![Vec::new(); scene.lines().len()];
    for offset in (0..step).rev() {
        for y in scene.lines().skip(offset).step_by(step) {
            let background = L::Format::from_rgb8(BACKGROUND);
            picture[usize::from(y)] = line(&mut renderer, scene, y, background);
        }
    }
    picture
}

/// Holds a picture of calls against the reference, and against others of other slots and orders of lines.
fn hold<L: Smooth>(
    rng: &mut Rng,
    screen: Screen,
    calls: &[Call],
    rounding: Rounding,
    tally: &mut Tally,
) where
    WordOf<L>: PartialEq + std::fmt::Debug,
{
    // A volume has two states.
    let height = screen.height().into();
    let mut rooms = SceneRooms::new(3 * calls.len(), calls.len(), height, 2 * calls.len());
    let mut scene = rooms.scene::<L>(screen);
    let dress = |call: &Call, draw: &mut Draw<'_, '_, i32>| call.dress(draw, L::TEXTURED);
    draw_each(&mut scene, calls, |call| call.corners, dress);
    let assembled = scene.assembled();
    assert_eq!(assembled.triangles as usize, calls.len());
    assert_eq!(assembled.culled as usize + scene.objects(), calls.len());
    let picture = lines(&scene, 128, 1);
    let slots = rng.pick(&[0, 1, 2, 5, 33]);
    assert!(lines(&scene, slots, 1) == picture, "{slots} slots");
    assert!(
        lines(&scene, slots, 7) == picture,
        "{slots} slots, lines apart"
    );
    for (y, line) in (0..).zip(&picture) {
        for (x, &word) in (0..).zip(line) {
            let Some(want) = pixel(calls, [x, y], screen, rounding, tally) else {
                tally.left_out += 1;
                continue;
            };
            tally.compared += 1;
            let got = L::Format::to_rgb8(word);
            let is_near = |i: usize| (f64::from(got[i]) - want.level[i]).abs() <= want.off[i];
            assert!(
                (0..3).all(is_near),
                "{got:?} for {want:?} at {x}, {y}: {calls:#?}"
            );
        }
    }
}

/// Some tens of calls, and now and then more on a line than there are slots.
#[test]
fn what_is_seen_again_is_where_volumes_say() {
    let mut rng = Rng::new(1_901);
    let mut tally = Tally::default();
    for round in 0..200 {
        let width = rng.pick(&[33, 70, 128]);
        let many = [3, 6, 12, 40][round % 4];
        let screen = Screen::new(width, if many > 20 { 8 } else { 30 }).unwrap();
        let calls = Call::some(&mut rng, screen, many);
        let rng = &mut rng;
        match round / 4 % 4 {
            0 | 1 => hold::<Gouraud<Rgb888>>(rng, screen, &calls, OF_888, &mut tally),
            2 => hold::<Gouraud<Rgb565Be>>(rng, screen, &calls, OF_565, &mut tally),
            _ => hold::<Textured<Rgb565Be>>(rng, screen, &calls, OF_TEXELS, &mut tally),
        }
    }
    println!("{tally:?}");
    assert!(tally.compared > 200_000, "{tally:?}");
    assert!(tally.left_out < tally.compared / 20, "{tally:?}");
    assert!(tally.lit > 50_000 && tally.shadowed > 10_000, "{tally:?}");
    assert!(tally.balanced > 400, "{tally:?}");
}

/// Counts of up to 255 volumes over each other are not taken for none, and neither side of them is dropped.
#[test]
fn many_volumes_over_each_other_are_counted() {
    let mut rng = Rng::new(1_902);
    let screen = Screen::new(40, 6).unwrap();
    let mut tally = Tally::default();
    for volumes in [1, 2, 127, 128, 129, 255] {
        for turned in [0, 1, volumes / 2, volumes] {
            let mut surface = Call::new(&mut rng, screen);
            let far = [(-80, -80), (900, 3), (5, 900)];
            for (corner, at) in surface.corners.iter_mut().zip(far) {
                (corner.at, corner.w) = (at, 8.0);
            }
            let mut again = surface.clone();
            for corner in &mut again.corners {
                corner.colour = corner.colour.map(|c| c ^ 0x80);
            }
            again.shadow = Some(Shadow::Shadowed(1));
            let mut calls = vec![again, surface];
            for i in 0..volumes {
                let mut call = calls[1].clone();
                call.shadow = Some(Shadow::Volume(1));
                for corner in &mut call.corners {
                    corner.w = 1.0 + f64::from(i) / 60.0;
                }
                if i < turned {
                    call.corners.swap(0, 1);
                }
                calls.push(call);
            }
            hold::<Gouraud<Rgb888>>(&mut rng, screen, &calls, OF_888, &mut tally);
        }
    }
    assert!(tally.left_out == 0 && tally.shadowed > 2_000, "{tally:?}");
}

/// The first lines of calls behind so many objects that lie below them.
fn first_lines(calls: &[Call], below: usize) -> Vec<Vec<[u8; 3]>> {
    let screen = Screen::new(70, 60).unwrap();
    let objects = below + calls.len();
    let mut rooms = SceneRooms::new(3 * calls.len() + 3, objects, 60, 2 * calls.len() + 1);
    let mut scene = rooms.scene::<Gouraud<Rgb888>>(screen);
    scene.begin(&camera()).unwrap();
    let corner = |at| Corner {
        at,
        w: 2.0,
        colour: [9; 3],
    };
    let low = [(80, 400), (120, 400), (80, 440)].map(corner);
    let scale = scale(screen, &low);
    let positions = low.map(|c| position(screen, c.at, c.w, scale));
    let faces = vec![[0, 1, 2]; below];
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&faces),
    };
    let call = Draw {
        model: Affine::placed(scale as f32, [0.0; 3]).unwrap(),
        cull: Cull::None,
        ..Draw::new(mesh)
    };
    scene.draw(&call).unwrap();
    assert_eq!(scene.objects(), below);
    for call in calls {
        draw_with(&mut scene, &[call.corners], |draw| call.dress(draw, false)).unwrap();
    }
    let mut rooms = LineRooms::fitting(&scene, 128, true);
    let mut renderer = rooms.with_shadows();
    (0..30)
        .map(|y| line(&mut renderer, &scene, y, BACKGROUND))
        .collect()
}

/// Kills: numbers of objects that run into what comes before them where it is sorted what is seen again.
#[test]
fn what_comes_late_in_a_scene_is_seen_again_as_well() {
    let mut rng = Rng::new(1_903);
    for _ in 0..12 {
        let calls = Call::some(&mut rng, Screen::new(70, 30).unwrap(), 12);
        assert!(first_lines(&calls, 40_000) == first_lines(&calls, 1));
    }
}
