//! Finishes in company: many transparent surfaces over each other, and with every kind of depth.

use crate::common::{Rng, SceneRooms, frame};
use scanbeam::mesh::QuadSplit;
use scanbeam::pipeline::blend::{DepthFunction, Finish};
use scanbeam::pipeline::{
    BlockFixed, Composited, FlatDepth, FlatPainter, Instance, Pipeline, Scene, Worded,
};
use scanbeam::pixel::Rgb888;
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};

const WIDTH: u16 = 64;
const HEIGHT: u16 = 12;

fn camera() -> Camera {
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    Camera::look_at([0.0; 3], ahead, up, 40.0, 0.2, 9.0).unwrap()
}

/// A quad of a plane that leans by a slope, all of them parallel; and what it does.
#[derive(Clone, Debug)]
struct Pane {
    away: f64,
    corners: [[f64; 2]; 4],
    colour: [u8; 3],
    finish: Finish,
}

impl Pane {
    /// Places on the picture's plane at distance 1, put on the pane's own.
    fn positions(&self, slope: [f64; 2]) -> [[i32; 3]; 4] {
        self.corners.map(|[x, y]| {
            let z = self.away / (1.0 - slope[0] * x - slope[1] * y);
            [x * z, y * z, -z].map(|c| (c * f64::from(1 << 28)).round() as i32)
        })
    }

    fn random(rng: &mut Rng, away: f64) -> Self {
        // Some across the picture, most a few pixels wide.
        let wide = rng.pick(&[1.6, 1.6, 0.3, 0.1]);
        let (x, y) = (
            rng.between(-0.8, 0.8 - f64::min(wide, 1.5)),
            rng.between(-0.2, 0.1),
        );
        let (right, top) = (x + wide, y + rng.pick(&[0.05, 0.3]));
        Self {
            away,
            corners: [[x, y], [right, y], [right, top], [x, top]],
            colour: [(); 3].map(|()| rng.below(256) as u8),
            finish: match rng.below(4) {
                0 => Finish::additive(rng.within(5, 90) as u8),
                _ => Finish::filtered(rng.within(5, 200) as u8),
            },
        }
    }
}

fn draw<P: Pipeline>(scene: &mut Scene<'_, P>, panes: &[&Pane], slope: [f64; 2])
where
    for<'a> scanbeam::pipeline::SkinOf<'a, P>: From<Finish>,
{
    scene.begin(&camera()).unwrap();
    for pane in panes {
        let positions = pane.positions(slope);
        let mesh = Mesh {
            positions: &positions,
            normals: &[],
            colours: &[],
            faces: Faces::Quads(&[[0, 1, 2, 3]], QuadSplit::Corner0To2),
        };
        let instance = Instance {
            model: scanbeam::Affine::placed(4.0, [0.0; 3]).unwrap(),
            cull: Cull::None,
            colour: pane.colour,
            ..Instance::default()
        };
        scene
            .draw_skinned(&mesh, pane.finish.into(), &instance)
            .unwrap();
    }
}

/// Parallel surfaces never cross, so whatever their number and their order, the picture is that
/// of a painter who begins with the farthest: the same bits, as each has one colour.
#[test]
fn any_number_of_leaning_panes_is_blended_from_back_to_front() {
    let mut rng = Rng::new(401);
    let screen = Screen::new(WIDTH, HEIGHT).unwrap();
    let mut most = 0;
    for round in 0..240 {
        let count = rng.pick(&[12, 17, 20, 40, 90]);
        let slope = [rng.between(-0.5, 0.5), rng.between(-0.5, 0.5)];
        let mut panes: Vec<Pane> = (0..count)
            .map(|i| Pane::random(&mut rng, 0.9 + 0.6 * f64::from(i) / f64::from(count)))
            .collect();
        if round % 3 == 0 {
            // All of them over each other.
            let corners = [[-0.7, -0.1], [0.7, -0.1], [0.7, 0.1], [-0.7, 0.1]];
            panes.iter_mut().for_each(|pane| pane.corners = corners);
        }
        let mut painted = SceneRooms::<Composited<FlatPainter<Rgb888>>>::new(800, 400, 12);
        let mut scene = painted.scene(screen);
        let order: Vec<&Pane> = panes.iter().rev().collect();
        draw(&mut scene, &order, slope);
        let want = frame(&scene, 8);
        let mut mixed = order;
        rng.shuffle(&mut mixed);
        let mut sorted = SceneRooms::<Composited<FlatDepth<Rgb888>>>::new(800, 400, 12);
        let mut scene = sorted.scene(screen);
        draw(&mut scene, &mixed, slope);
        for slots in [0, 5, 400] {
            let got = frame(&scene, slots);
            for (y, (got, want)) in got.iter().zip(&want).enumerate() {
                assert_eq!(
                    got, want,
                    "{round}: line {y} of {count} panes, {slots} slots"
                );
            }
        }
        most = most.max(count);
    }
    assert_eq!(most, 90);
}

/// The picture of surfaces in order, each of two triangles.
fn picture<P: Pipeline<Pixel = Rgb888>>(panes: &[&Pane], slope: [f64; 2]) -> Vec<Vec<[u8; 3]>>
where
    for<'a> scanbeam::pipeline::SkinOf<'a, P>: From<Finish>,
{
    let mut rooms = SceneRooms::<P>::new(99, 99, usize::from(HEIGHT));
    let mut scene = rooms.scene(Screen::new(WIDTH, HEIGHT).unwrap());
    draw(&mut scene, panes, slope);
    frame(&scene, 8)
}

/// What is drawn twice is at its own depth the second time, whatever depth is kept as: functions
/// see equal depths, and a surface without a rule covers one with a rule.
fn sees_its_own_depth<P: Pipeline<Pixel = Rgb888>>(seed: u64)
where
    for<'a> scanbeam::pipeline::SkinOf<'a, P>: From<Finish>,
{
    let mut rng = Rng::new(seed);
    let mut seen = 0;
    for _ in 0..60 {
        let slope = [rng.between(-0.5, 0.5), rng.between(-0.5, 0.5)];
        let away = rng.between(0.3, 0.9);
        let plain = Pane {
            colour: [10, 20, 30],
            finish: Finish::OPAQUE,
            ..Pane::random(&mut rng, away)
        };
        let ruled = |colour_if| Pane {
            colour: [200, 100, 50],
            finish: Finish {
                colour_if,
                ..Finish::OPAQUE
            },
            ..plain.clone()
        };
        let alone = picture::<P>(&[&plain], slope);
        let [full, kept] = [[200, 100, 50], [10, 20, 30]].map(|colour: [u8; 3]| {
            let of = |p: &[u8; 3]| if *p == [0; 3] { [0; 3] } else { colour };
            let lines = alone.iter().map(|line| line.iter().map(of).collect());
            lines.collect::<Vec<Vec<_>>>()
        });
        seen += alone.iter().flatten().filter(|p| **p != [0; 3]).count();
        for (function, passes) in [
            (DepthFunction::EQUAL, true),
            (DepthFunction::NEARER_OR_EQUAL, true),
            (DepthFunction::FARTHER_OR_EQUAL, true),
            (DepthFunction::NEARER, false),
            (DepthFunction::FARTHER, false),
            (DepthFunction::DIFFERENT, false),
        ] {
            let again = ruled(function);
            let want = if passes { &full } else { &kept };
            assert!(
                picture::<P>(&[&plain, &again], slope) == *want,
                "{function:?}"
            );
        }
        let second = Pane {
            colour: [200, 100, 50],
            ..plain.clone()
        };
        assert!(picture::<P>(&[&plain, &second], slope) == full);
        // And the other way round: the last of equals is seen.
        let first = ruled(DepthFunction::DIFFERENT);
        assert!(picture::<P>(&[&first, &plain], slope) == kept);
    }
    assert!(seen > 1_500, "{seen}");
}

#[test]
fn finishes_see_depth_as_it_is_kept() {
    type Flat = FlatDepth<Rgb888>;
    sees_its_own_depth::<Composited<Flat>>(411);
    sees_its_own_depth::<Composited<BlockFixed<Flat>>>(412);
    sees_its_own_depth::<BlockFixed<Composited<Flat>>>(413);
    sees_its_own_depth::<Composited<Worded<Flat>>>(414);
}
