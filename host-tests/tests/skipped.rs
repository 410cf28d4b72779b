//! What is not done because nobody would see it, and that nobody does (M4, X3).

use crate::common::{Rng, SceneRooms, frame};
use scanbeam::mesh::Sphere;
use scanbeam::pipeline::{GouraudDepth, Instance, Scene, WordOf};
use scanbeam::pixel::Rgb888;
use scanbeam::stats::PassOne;
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, Screen};

type Look = GouraudDepth<Rgb888>;

/// The room of any scene here.
const VERTICES: usize = 4096;
const OBJECTS: usize = 4096;

/// Builds a scene and draws it; what pass one did, and the picture.
fn drawn(
    screen: Screen,
    build: impl FnOnce(&mut Scene<'_, Look>),
) -> (PassOne, Vec<Vec<WordOf<Look>>>) {
    let mut rooms = SceneRooms::<Look>::new(VERTICES, OBJECTS, usize::from(screen.height()));
    let mut scene = rooms.scene(screen);
    build(&mut scene);
    (scene.pass_one(), frame(&scene, 16))
}

/// Random clouds of triangles around, beside and across every plane of random cameras, those with
/// extreme sizes, focal lengths and narrow bands among them: skipping changes no pixel and no
/// count of what is kept.
#[test]
fn a_mesh_that_its_sphere_gives_up_would_not_have_been_seen() {
    let mut rng = Rng::new(0x5EED_50FE);
    let (mut skipped, mut kept, mut bare) = (0, 0, 0);
    for case in 0..20_000 {
        let side = |rng: &mut Rng| rng.pick(&[1u16, 2, 7, 24, 33, 64]);
        let screen = Screen::new(side(&mut rng), side(&mut rng)).unwrap();
        let unit = rng.pick(&[1e-3f32, 1.0, 1.0, 4e4]);
        let near = unit * rng.pick(&[1e-5f32, 0.1, 1.0]);
        let far = near * rng.pick(&[2.0f32, 50.0, 6e4]);
        let focal = rng.pick(&[0.01f32, 3.0, 20.0, 60.0, 5e4]);
        let mut place = |reach: f64| [0, 1, 2].map(|_| (rng.signed() * reach) as f32 * unit);
        let (eye, at, up) = (place(6.0), place(1.0), place(1.0));
        let Ok(camera) = Camera::look_at(eye, at, up, focal, near, far) else {
            continue;
        };
        let size = unit * rng.pick(&[0.01f32, 0.3, 1.0, 3.0]);
        let away = rng.pick(&[0.0, 3.0, 10.0]);
        let offset = [0, 1, 2].map(|_| (rng.signed() * away) as f32 * unit);
        // Scaled and sheared differently along each axis.
        let rows = [0, 1, 2].map(|i| {
            [0, 1, 2].map(|k| size * (f32::from(u8::from(i == k)) + rng.signed() as f32 / 2.0))
        });
        let instance = Instance {
            model: Affine::from_rows(rows, offset).unwrap(),
            cull: Cull::None,
            ..Instance::default()
        };
        let spread = rng.pick(&[100, 4_000, 32_767]);
        let mut point = || [0, 1, 2].map(|_| rng.within(-spread, spread) as i16);
        let positions: [[i16; 3]; 24] = core::array::from_fn(|_| point());
        let faces: [[u16; 3]; 8] = core::array::from_fn(|i| [0, 1, 2].map(|k| 3 * i as u16 + k));
        let colours = [[200, 100, 50]; 24];
        let mesh = Mesh {
            positions: &positions,
            normals: &[],
            colours: &colours,
            faces: Faces::Triangles(&faces),
        };
        let sphere = Sphere::around(&positions);
        let height = screen.height();
        let band = if case % 3 == 0 {
            let start = rng.below(height.into()) as u16;
            start..start + 1
        } else {
            0..height
        };
        let (whole, want) = drawn(screen, |scene| {
            scene.begin_band(&camera, band.clone()).unwrap();
            scene.draw(&mesh, &instance).unwrap();
        });
        let (within, got) = drawn(screen, |scene| {
            scene.begin_band(&camera, band.clone()).unwrap();
            scene.draw_within(&mesh, &instance, &sphere).unwrap();
        });
        assert!(want == got, "case {case}");
        assert_eq!(whole.objects, within.objects, "case {case}");
        assert_eq!(whole.culled, within.culled, "case {case}");
        assert_eq!(within.triangles, 8);
        if within.meshes_skipped == 1 {
            assert_eq!((within.triangles_skipped, within.vertices_skipped), (8, 24));
            assert_eq!((within.vertices, within.clipped), (0, 0));
            skipped += 1;
        } else if whole.objects > 0 {
            kept += 1;
        } else {
            bare += 1;
        }
    }
    println!("skipped {skipped}, drawn {kept}, drawn in vain {bare}");
    // The test is worth something only when all of these are common.
    assert!(skipped > 5_000 && kept > 1_000);
    // A sphere is rounder than a cloud, so some are looked at in vain; most are not.
    assert!(bare < skipped);
}

/// A ring of meshes around the eye: those behind and beside it are counted, all of them.
#[test]
fn a_ring_around_the_eye_counts_what_is_not_looked_at() {
    let screen = Screen::new(64, 48).unwrap();
    let camera = Camera::look_at(
        [0.0; 3],
        [0.0, 0.0, -1.0],
        [0.0, 1.0, 0.0],
        32.0,
        0.1,
        100.0,
    )
    .unwrap();
    let sphere = Sphere::around(scenes::CUBE.positions);
    let triangles = 12;
    let (done, _) = drawn(screen, |scene| {
        scene.begin(&camera).unwrap();
        // 45 degrees to each side are seen: of 16 cubes, those at 0, 1 and 2 steps to either side.
        for step in 0..16 {
            let angle = core::f32::consts::TAU * step as f32 / 16.0;
            let instance = Instance {
                model: Affine::placed(0.1, [8.0 * angle.sin(), 0.0, -8.0 * angle.cos()]).unwrap(),
                ..Instance::default()
            };
            scene
                .draw_within(&scenes::CUBE, &instance, &sphere)
                .unwrap();
        }
    });
    assert_eq!(done.triangles, 16 * triangles);
    assert_eq!(done.meshes_skipped, 11);
    assert_eq!(done.triangles_skipped, 11 * triangles);
    let vertices = scenes::CUBE.positions.len() as u32;
    assert_eq!(done.vertices_skipped, 11 * vertices);
}

/// Specks a few units of clip space before or behind the near and the far plane: a vertex may be
/// rounded that far, and what would be drawn is not given up.
#[test]
fn specks_at_the_rim_of_the_view_are_drawn() {
    let mut rng = Rng::new(94);
    let screen = Screen::new(24, 24).unwrap();
    // Of coordinates of 2^-30, the planes at 2^14 and 2^15 of them.
    let unit = 2f32.powi(-30);
    let (near, far) = (2f32.powi(-16), 2f32.powi(-15));
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at([0.0; 3], ahead, up, 12_000.0, near, far).unwrap();
    let (mut seen, mut unseen) = (0, 0);
    for case in 0..4000 {
        // 16 of them are a unit of clip space.
        let plane = rng.pick(&[near, far]) / unit;
        let depth = plane as i32 + rng.within(-480, 480);
        let positions = [0, 1, 2].map(|_| {
            let mut aside = || rng.within(-24, 24);
            [aside(), aside(), -depth]
        });
        let mesh = Mesh {
            positions: &positions,
            normals: &[],
            colours: &[[200, 100, 50]; 3],
            faces: Faces::Triangles(&[[0, 1, 2]]),
        };
        let instance = Instance {
            cull: Cull::None,
            ..Instance::default()
        };
        let sphere = Sphere::around(&positions);
        let (whole, want) = drawn(screen, |scene| {
            scene.begin(&camera).unwrap();
            scene.draw(&mesh, &instance).unwrap();
        });
        let (within, got) = drawn(screen, |scene| {
            scene.begin(&camera).unwrap();
            scene.draw_within(&mesh, &instance, &sphere).unwrap();
        });
        assert!(want == got, "case {case}: {positions:?}");
        assert_eq!(whole.objects, within.objects, "case {case}");
        seen += u32::from(whole.objects > 0);
        unseen += within.meshes_skipped;
    }
    assert!(seen > 500 && unseen > 200, "{seen} seen, {unseen} given up");
}
