//! Block-fix depth in a renderer (H2): what one code tells apart is told apart, what lies within
//! it is not, in every range, against codes by `f64`.

use crate::common::{self, LineRooms, SceneRooms};
use scanbeam::mesh::QuadSplit;
use scanbeam::pipeline::{BlockFixed, DepthUse, FlatDepth, Instance, Pipeline};
use scanbeam::pixel::Rgb888;
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, Screen};

const NEAR: f64 = 1.0;
/// Units that coordinates are fractions of.
const UNITS: f64 = 1024.0;

/// The colour in the middle of a picture of two level quads, the nearer submitted first.
fn middle<P: Pipeline<Pixel = Rgb888>>(distances: [f64; 2], depth_use: DepthUse) -> [u8; 3] {
    let mut rooms = SceneRooms::<P>::new(16, 8, 8);
    let mut scene = rooms.scene(Screen::new(8, 8).unwrap());
    let (eye, to, up) = ([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(eye, to, up, 8.0, NEAR as f32, 900.0).unwrap();
    scene.begin(&camera).unwrap();
    for (z, colour) in distances.into_iter().zip([[200, 0, 0], [0, 200, 0]]) {
        let side = z * 0.4;
        let corner = |x: f64, y: f64| {
            [x * side, y * side, -z].map(|c| (c / UNITS * f64::from(1 << 30)).round() as i32)
        };
        let mesh = Mesh {
            positions: &[
                corner(-1.0, -1.0),
                corner(1.0, -1.0),
                corner(1.0, 1.0),
                corner(-1.0, 1.0),
            ],
            normals: &[],
            colours: &[colour; 4],
            faces: Faces::Quads(&[[0, 1, 2, 3]], QuadSplit::Corner0To2),
        };
        let instance = Instance {
            model: Affine::placed(UNITS as f32, [0.0; 3]).unwrap(),
            cull: Cull::None,
            ..Instance::default()
        };
        scene.draw(&mesh, &instance).unwrap();
    }
    let mut rooms = LineRooms::<P>::new(8, 8, 8);
    let mut renderer = rooms.renderer();
    renderer.set_depth_use(depth_use);
    common::line(&mut renderer, &scene, 4)[4]
}

/// The code of a distance in units of its last place, with its fraction, and its range.
fn code(distance: f64) -> (f64, i32) {
    let depth = NEAR / distance;
    // Range e is for 2^(-3 e - 3) up to 2^(-3 e).
    let range = ((-depth.log2() / 3.0).ceil() as i32 - 1).clamp(0, 3);
    (depth * f64::from(1 << (14 + 3 * range)), range)
}

#[test]
fn what_is_within_a_code_is_not_told_apart() {
    let mut told = [[0; 2]; 4];
    for step in 0..3000 {
        let near = 1.01 * 1.00224f64.powi(step);
        let far = near * (1.0 + 2f64.powi(-16 + step % 9));
        let (a, range) = code(near);
        let (b, other) = code(far);
        // Projection has 17 bits of 1/w: what is near the border of a code may be on either side.
        let clear = |x: f64| (0.2..0.8).contains(&x.fract());
        if range != other || !clear(a) || !clear(b) {
            continue;
        }
        let apart = a.floor() > b.floor();
        let expected = if apart { [200, 0, 0] } else { [0, 200, 0] };
        for depth_use in [DepthUse::Always, DepthUse::WhereNeeded] {
            let seen = middle::<BlockFixed<FlatDepth<Rgb888>>>([near, far], depth_use);
            assert_eq!(
                seen, expected,
                "{near} and {far}: {a} and {b}, {depth_use:?}"
            );
        }
        told[range as usize][usize::from(apart)] += 1;
        if far > near * 1.0001 {
            let seen = middle::<FlatDepth<Rgb888>>([near, far], DepthUse::Always);
            assert_eq!(seen, [200, 0, 0], "32 bits: {near} and {far}");
        }
    }
    println!("not told apart and told apart, by range: {told:?}");
    assert!(told.iter().flatten().all(|count| *count > 5), "{told:?}");
}

#[test]
fn the_nearer_range_wins_by_value() {
    // Distances on either side of each border of ranges: 8, 64, 512.
    for border in [8.0, 64.0, 512.0] {
        for gap in [1.02, 1.2, 1.5] {
            for order in [[border / gap, border * gap], [border * gap, border / gap]] {
                let seen = middle::<BlockFixed<FlatDepth<Rgb888>>>(order, DepthUse::Always);
                let first = order[0] < order[1];
                let expected = if first { [200, 0, 0] } else { [0, 200, 0] };
                assert_eq!(seen, expected, "{order:?}");
            }
        }
    }
}
