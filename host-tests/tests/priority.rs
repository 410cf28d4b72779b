//! P1, P2, P6: surfaces by priority without any depth, clipped without a trace.
//!
//! Who must be seen at a pixel is told by the bit-serial contest of the hardware model among the faces
//! that cover it; what is covered is told by the model's vertex sort.

use crate::common::{LineRooms, Rng, SceneRooms};
use scanbeam::list::Window;
use scanbeam::mesh::ScreenVertex;
use scanbeam::pipeline::blend::Finish;
use scanbeam::pipeline::parallel::Interleave;
use scanbeam::pipeline::{
    CellOf, Clip, Composited, FlatDepth, Forward, GouraudDepth, Instance, Interpolated, Pipeline,
    Prioritised, Priority, Scene, Shading, SkinOf, Windowed, WordOf,
};
use scanbeam::pixel::{Rgb565Be, Rgb888};
use scanbeam::{Affine, Camera, Cull, Screen};
use scanbeam_model::{CuspPolygon, ModelSpan, Wins, priority_contest};
use scenes::CUBE;
use std::ops::Range;

const SIZE: (u16, u16) = (61, 44);

fn screen() -> Screen {
    Screen::new(SIZE.0, SIZE.1).unwrap()
}

/// Any camera: what is on the screen already needs none.
fn camera() -> Camera {
    Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 50.0, 0.5, 60.0).unwrap()
}

/// A triangle on the screen, its colour and its priority.
#[derive(Clone, Copy, Debug)]
struct Face {
    corners: [ScreenVertex; 3],
    priority: u8,
}

impl Face {
    fn new(rng: &mut Rng, reach: i32) -> Self {
        let corners = [(); 3].map(|()| ScreenVertex {
            x: rng.within(-reach, 8 * i32::from(SIZE.0) + reach) as i16,
            y: rng.within(-reach, 8 * i32::from(SIZE.1) + reach) as i16,
            depth: 1 << 30,
            colour: [(); 3].map(|()| rng.below(256) as u8),
        });
        Self {
            corners,
            priority: 0,
        }
    }

    /// In 13.3 of guard space, as a picture of this size has it.
    fn places(&self) -> [(u16, u16); 3] {
        let middle = [SIZE.0, SIZE.1].map(|side| 4096 - i32::from(side) / 2);
        self.corners.map(|c| {
            let at = |v: i16, middle: i32| (i32::from(v) + 8 * middle) as u16;
            (at(c.x, middle[0]), at(c.y, middle[1]))
        })
    }

    /// The pixels that it covers on a line.
    fn columns(&self, y: u16) -> Range<i32> {
        let [left, top] = [SIZE.0, SIZE.1].map(|side| 4096 - i32::from(side) / 2);
        let [a, b, c] = self.places();
        let centre = 8 * (top + i32::from(y)) + 4;
        let span = ModelSpan::new([(0, a), (1, b), (2, c)], centre as u16);
        let (from, to) = span.map_or((0, 0), |span| span.columns());
        (from - left).max(0)..(to - left).min(SIZE.0.into())
    }

    fn draw<P: Pipeline>(&self, scene: &mut Scene<'_, P>, finish: Finish) {
        let skin = P::Shading::finished(SkinOf::<P>::default(), finish);
        scene
            .draw_screen(&self.corners, &[[0, 1, 2]], skin, Cull::None)
            .unwrap();
    }
}

fn rooms<P: Pipeline>() -> SceneRooms<P> {
    SceneRooms::new(3000, 6000, SIZE.1.into())
}

/// All lines, by so many renderers with so many slots.
fn frame<P: Pipeline>(scene: &Scene<'_, P>, slots: usize, count: u16) -> Vec<WordOf<P>> {
    let mut rooms: Vec<_> = (0..count)
        .map(|_| LineRooms::<P>::fitting(slots, scene))
        .collect();
    let mut renderers: Vec<_> = rooms.iter_mut().map(LineRooms::renderer).collect();
    for (offset, renderer) in (0..).zip(&mut renderers) {
        renderer.set_interleave(Interleave::lines(count, offset).unwrap());
    }
    let lines = scene.lines().flat_map(|y| {
        let own = renderers.iter_mut().find(|r| r.interleave().owns(y));
        crate::common::line(own.unwrap(), scene, y)
    });
    lines.collect()
}

#[test]
fn the_contest_of_the_model_says_who_is_seen() {
    type P = Prioritised<FlatDepth<Rgb888>>;
    assert_eq!(size_of::<CellOf<P>>(), 0, "no depth at all");
    let (mut rooms, mut most) = (rooms::<P>(), 0);
    for seed in 0..40 {
        let mut rng = Rng::new(seed);
        let count = rng.pick(&[1, 5, 30, 90]);
        // Few priorities, so that some are the same; or all.
        let levels = rng.pick(&[1, 3, 40, 255]);
        let faces: Vec<_> = (0..count)
            .map(|_| Face {
                // The bus begins with 0, which nobody beats who has it too.
                priority: 1 + rng.below(levels) as u8,
                ..Face::new(&mut rng, 100)
            })
            .collect();
        let mut scene = rooms.scene(screen());
        scene.begin(&camera()).unwrap();
        for face in &faces {
            scene.set_priority(Priority(face.priority));
            face.draw(&mut scene, Finish::OPAQUE);
        }
        let mut expected = Vec::new();
        for y in 0..SIZE.1 {
            let columns: Vec<_> = faces.iter().map(|face| face.columns(y)).collect();
            most = most.max(columns.iter().filter(|c| !c.is_empty()).count());
            for x in 0..i32::from(SIZE.0) {
                let (mut bus, mut colour) = (0, [0; 3]);
                // What is drawn last stands first in the row.
                for (face, columns) in faces.iter().zip(&columns).rev() {
                    let (own, active) = (face.priority.into(), columns.contains(&x));
                    let inserts;
                    (bus, inserts) = priority_contest(Wins::Most, 8, bus, own, active);
                    if inserts {
                        colour = face.corners[0].colour;
                    }
                }
                expected.push(colour);
            }
        }
        for slots in [0, 1, 7, 31, 200] {
            let count = 1 + rng.below(3) as u16;
            let seen = frame(&scene, slots, count);
            assert!(seen == expected, "seed {seed}, {slots} slots");
        }
    }
    assert!(most > 64, "{most}: several walks of the list");
}

/// Convex bodies that do not touch, from the nearest to the farthest: culled from behind and given
/// priorities by distance they look as by depth.
#[test]
fn bodies_with_backs_culled_need_no_depth() {
    for seed in 0..20 {
        let mut rng = Rng::new(50 + seed);
        let mut bodies: Vec<_> = (0..12u8)
            .map(|i| {
                let at = [rng.signed(), rng.signed(), -1.5 * f64::from(i)];
                let turn = Affine::rotation_y(rng.signed() as f32 * 3.0)
                    .then(&Affine::rotation_x(rng.signed() as f32 * 3.0));
                let place = Affine::placed(0.4, at.map(|c| c as f32)).unwrap();
                (turn.then(&place), 200 - i)
            })
            .collect();
        rng.shuffle(&mut bodies);
        fn draw<P: Pipeline>(
            bodies: &[(Affine, u8)],
            cull: Cull,
            rank: fn(&mut Scene<'_, P>, Priority),
        ) -> Vec<WordOf<P>> {
            let mut rooms = rooms::<P>();
            let mut scene = rooms.scene(screen());
            scene.begin(&camera()).unwrap();
            for &(model, priority) in bodies {
                rank(&mut scene, Priority(priority));
                let instance = Instance {
                    model,
                    cull,
                    ..Instance::default()
                };
                scene.draw(&CUBE, &instance).unwrap();
            }
            frame(&scene, 40, 1)
        }
        type Faces = FlatDepth<Rgb565Be>;
        type Smooth = GouraudDepth<Rgb888>;
        let ranked = |cull| {
            draw::<Prioritised<Faces>>(&bodies, cull, |scene, rank| scene.set_priority(rank))
        };
        let by_depth = draw::<Faces>(&bodies, Cull::Back, |_, _| ());
        assert!(ranked(Cull::Back) == by_depth);
        let smooth = draw::<Smooth>(&bodies, Cull::Back, |_, _| ());
        let by_rank = draw::<Prioritised<Smooth>>(&bodies, Cull::Back, |scene, rank| {
            scene.set_priority(rank)
        });
        assert!(by_rank == smooth);
        // Backs have the same priority: without culling they would be seen.
        assert!(ranked(Cull::None) != by_depth);
    }
}

/// Glass blends with what has a lower priority (P5), whenever it was drawn.
#[test]
fn glass_is_blended_in_order_of_priority() {
    type P = Prioritised<Composited<FlatDepth<Rgb888>>>;
    for seed in 0..20 {
        let mut rng = Rng::new(90 + seed);
        let mut faces: Vec<_> = (0..50u8)
            .map(|priority| {
                let finish = match rng.below(4) {
                    0 => Finish::subtractive(100),
                    1 => Finish::filtered(130),
                    _ => Finish::OPAQUE,
                };
                let face = Face {
                    priority,
                    ..Face::new(&mut rng, 100)
                };
                (face, finish)
            })
            .collect();
        let mut pictures = Vec::new();
        for _ in 0..3 {
            let mut rooms = rooms::<P>();
            let mut scene = rooms.scene(screen());
            scene.begin(&camera()).unwrap();
            for (face, finish) in &faces {
                scene.set_priority(Priority(face.priority));
                face.draw(&mut scene, *finish);
            }
            pictures.push(frame(&scene, rng.pick(&[0, 9, 200]), 1));
            rng.shuffle(&mut faces);
        }
        assert!(pictures.iter().all(|picture| *picture == pictures[0]));
        // In order, as without priorities.
        faces.sort_by_key(|(face, _)| face.priority);
        let mut rooms = rooms::<Composited<scanbeam::pipeline::FlatPainter<Rgb888>>>();
        let mut scene = rooms.scene(screen());
        scene.begin(&camera()).unwrap();
        for (face, finish) in &faces {
            face.draw(&mut scene, *finish);
        }
        assert!(frame(&scene, 200, 1) == pictures[0], "seed {seed}");
    }
}

/// Random triangles in random rectangles: inside as if nothing had been clipped, bit for bit, outside
/// nothing; and the spans are those of the two chains of cusps.
fn clips_without_a_trace<P: Pipeline>(seeds: Range<u64>)
where
    WordOf<P>: std::fmt::Debug,
{
    type Cut<P> = Prioritised<Windowed<P>>;
    let mut pixels = 0;
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let reach = rng.pick(&[0, 200, 3_000, 15_000]);
        let face = Face::new(&mut rng, reach);
        let mut side = |most: u16| {
            let ends = [0; 2].map(|_| rng.below(u32::from(most) + 1) as u16);
            (ends[0].min(ends[1]), ends[0].max(ends[1]))
        };
        let ((left, right), (top, bottom)) = (side(SIZE.0), side(SIZE.1));
        let window = Window {
            left,
            top,
            right,
            bottom,
        };
        fn draw<P: Pipeline>(face: &Face, cut: impl Fn(&mut Scene<'_, P>)) -> Vec<WordOf<P>> {
            let mut rooms = rooms::<P>();
            let mut scene = rooms.scene(screen());
            scene.begin(&camera()).unwrap();
            cut(&mut scene);
            face.draw(&mut scene, Finish::OPAQUE);
            assert_eq!(scene.pass_one().clipped, 0, "within the guard band");
            frame(&scene, 9, 1)
        }
        let whole = draw::<P>(&face, |_| ());
        let cut = draw::<Cut<P>>(&face, |scene| scene.set_clip(Clip::Inside(window)));
        let [x0, y0] = [SIZE.0, SIZE.1].map(|side| 4096 - i32::from(side) / 2);
        let from = |low: u16, high: u16, at: i32| i32::from(low) + at..i32::from(high) + at;
        let polygon = CuspPolygon::clipped(
            face.places(),
            &from(left, right, x0),
            &from(top, bottom, y0),
        );
        for (at, (pixel, open)) in cut.iter().zip(&whole).enumerate() {
            let (x, y) = (at as u16 % SIZE.0, at as u16 / SIZE.0);
            let span = polygon.as_ref().and_then(|p| p.span(y0 + i32::from(y)));
            let inside = span.is_some_and(|(a, b)| (a..b).contains(&(x0 + i32::from(x))));
            let covered = face.columns(y).contains(&i32::from(x))
                && (left..right).contains(&x)
                && (top..bottom).contains(&y);
            assert_eq!(inside, covered, "seed {seed}");
            let expected = if inside {
                *open
            } else {
                WordOf::<P>::default()
            };
            assert_eq!(*pixel, expected, "seed {seed} {x} {y}");
            pixels += u32::from(inside);
        }
    }
    assert!(pixels > 20_000, "{pixels}");
}

#[test]
fn clipping_leaves_shading_as_it_was() {
    clips_without_a_trace::<GouraudDepth<Rgb888>>(1000..2200);
    clips_without_a_trace::<FlatDepth<Rgb565Be>>(3000..3600);
    clips_without_a_trace::<Interpolated<GouraudDepth<Rgb565Be>, Forward>>(4000..4900);
}

/// Corners beyond the screen, in the guard band, are not clipped: a large picture has the same bits where
/// the small one is. Spans of more than 64 pixels would be packed by default, and anchored where they begin.
#[test]
fn corners_in_the_guard_band_change_nothing() {
    type P = Prioritised<Interpolated<GouraudDepth<Rgb888>, Forward>>;
    // Both have the same middle.
    let large = Screen::new(SIZE.0 + 600, SIZE.1 + 400).unwrap();
    for seed in 0..300 {
        let mut rng = Rng::new(7000 + seed);
        let reach = rng.pick(&[100, 1_500, 8_000]);
        let faces: Vec<_> = (0..4).map(|_| Face::new(&mut rng, reach)).collect();
        let mut small_rooms = rooms::<P>();
        let mut small = small_rooms.scene(screen());
        small.begin(&camera()).unwrap();
        let mut large_rooms = SceneRooms::<P>::new(100, 100, 1000);
        let mut wide = large_rooms.scene(large);
        wide.begin(&camera()).unwrap();
        for face in &faces {
            let priority = Priority(rng.below(4) as u8);
            small.set_priority(priority);
            wide.set_priority(priority);
            face.draw(&mut small, Finish::OPAQUE);
            let mut moved = *face;
            for corner in &mut moved.corners {
                corner.x += 8 * 300;
                corner.y += 8 * 200;
            }
            moved.draw(&mut wide, Finish::OPAQUE);
        }
        assert_eq!((small.pass_one().clipped, wide.pass_one().clipped), (0, 0));
        let seen = frame(&small, 9, 1);
        let mut rooms = LineRooms::fitting(9, &wide);
        let mut renderer = rooms.renderer();
        for (y, row) in (200..).zip(seen.chunks(SIZE.0.into())) {
            let line = crate::common::line(&mut renderer, &wide, y);
            assert!(line[300..300 + row.len()] == *row, "seed {seed}, line {y}");
        }
    }
}
