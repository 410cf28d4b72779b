//! P1, P2, P6: surfaces by priority without any depth, cut without a trace.
//!
//! Who must be seen at a pixel is told by the bit-serial contest of the hardware model among the faces
//! that cover it; what is covered is told by the model's vertex sort.

use crate::common::Rng;
use crate::hot::NO_MESH;
use host_tests::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::look::{Gouraud, Look};
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{Draw, Scissor, ScreenCorner};
use scanbeam::{Camera, Cull, Scene, Screen};
use scanbeam_model::{CuspPolygon, ModelSpan, Wins, priority_contest};
use std::ops::Range;

const SIZE: (u16, u16) = (61, 44);

/// A triangle on the screen, its colours and its priority.
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

    /// Of one colour.
    fn flat(self) -> Self {
        let colour = self.corners[0].colour;
        Self {
            corners: self.corners.map(|corner| ScreenVertex { colour, ..corner }),
            ..self
        }
    }

    /// In 13.3 of the model's space, as a picture of this size has it.
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

    fn draw<L: Look>(&self, scene: &mut Scene<'_, '_, L>, scissor: Option<Scissor>) {
        let call = Draw {
            cull: Cull::None,
            priority: self.priority,
            scissor,
            ..Draw::new(NO_MESH)
        };
        let corners = self.corners.map(|vertex| ScreenCorner {
            vertex,
            texel: [0; 2],
        });
        scene.draw_screen(&call, &[corners]).unwrap();
    }
}

/// All lines of faces and their scissors, with so many slots and no depth, over black.
fn drawn<F, L>(faces: &[Face], scissor: Option<&Scissor>, slots: u16) -> Vec<F::Word>
where
    F: PixelFormat,
    L: Look<Pixel = F>,
{
    let room = Room {
        vertices: 3 * faces.len(),
        places: 0,
        objects: faces.len(),
        draws: faces.len(),
    };
    let (mut rooms, screen) = (SceneRooms::new(room, SIZE.1), Screen::new(SIZE.0, SIZE.1));
    let mut scene = rooms.scene::<L>(screen.unwrap());
    // Any camera: what is on the screen already needs none.
    let up = [0.0, 1.0, 0.0];
    let camera = Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], up, 50.0, 0.5, 60.0);
    scene.begin(&camera.unwrap()).unwrap();
    for face in faces {
        face.draw(&mut scene, scissor.cloned());
    }
    assert_eq!(scene.assembled().clipped, 0, "within the guard band");
    // No pixel has a depth.
    let mut lines: LineRooms<L, 7> = LineRooms::new(room.objects, 0).with_limit(slots);
    let mut renderer = lines.renderer();
    let line = |y| {
        let mut line = vec![F::from_rgb8([9, 8, 7]); SIZE.0.into()];
        let black = F::from_rgb8([0; 3]);
        renderer.draw_line(&scene, y, &mut line, black).unwrap();
        line
    };
    scene.lines().flat_map(line).collect()
}

/// Kills: spans that are sorted from the highest priority on, equal ones from the latest on.
#[test]
fn the_contest_of_the_model_says_who_is_seen() {
    let mut most = 0;
    for seed in 0..40 {
        let mut rng = Rng::new(seed);
        let count = rng.pick(&[1, 5, 30, 90]);
        // Few priorities, so that some are the same; or all.
        let levels = rng.pick(&[1, 3, 40, 255]);
        let faces: Vec<_> = (0..count)
            .map(|_| Face {
                // The bus begins with 0, which nobody beats who has it too.
                priority: 1 + rng.below(levels) as u8,
                ..Face::new(&mut rng, 100).flat()
            })
            .collect();
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
        // Lines of calls that have a scissor are drawn in another way.
        let scissor = Scissor::inside(0..SIZE.0, 0..SIZE.1);
        let scissor = Some(&scissor).filter(|_| seed % 2 == 1);
        for slots in [0, 1, 7, 31, 200] {
            let seen = drawn::<Rgb888, Gouraud<Rgb888>>(&faces, scissor, slots);
            assert!(seen == expected, "seed {seed}, {slots} slots");
        }
    }
    assert!(most > 64, "{most}: more than a word of bits");
}

/// Random triangles in random rectangles: inside as if nothing had been cut, bit for bit, outside
/// nothing; and the spans are those of the two chains of cusps.
fn cut_without_a_trace<F: PixelFormat, L: Look<Pixel = F>>(seeds: Range<u64>) {
    let mut pixels = 0;
    for seed in seeds {
        let mut rng = Rng::new(seed);
        let reach = rng.pick(&[0, 200, 3_000, 15_000]);
        let mut face = Face::new(&mut rng, reach);
        face.priority = rng.below(3) as u8;
        let mut side = |most: u16| {
            let ends = [0; 2].map(|_| rng.below(u32::from(most) + 1) as u16);
            (ends[0].min(ends[1]), ends[0].max(ends[1]))
        };
        let ((left, right), (top, bottom)) = (side(SIZE.0), side(SIZE.1));
        let scissor = Scissor::inside(left..right, top..bottom);
        // Without priorities there is depth.
        face.priority += 1;
        let whole = drawn::<F, L>(&[face], None, 9);
        let cut = drawn::<F, L>(&[face], Some(&scissor), 9);
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
            let expected = if inside { *open } else { F::from_rgb8([0; 3]) };
            assert!(*pixel == expected, "seed {seed} {x} {y}");
            pixels += u32::from(inside);
        }
    }
    assert!(pixels > 20_000, "{pixels}");
}

#[test]
fn clipping_leaves_shading_as_it_was() {
    cut_without_a_trace::<Rgb888, Gouraud<Rgb888>>(1000..2200);
    cut_without_a_trace::<Rgb565Be, Gouraud<Rgb565Be>>(3000..4200);
}
