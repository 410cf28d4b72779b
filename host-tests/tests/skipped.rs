//! What is not done because nobody would see it, and that nobody does (M4, X3).

use crate::common::Rng;
use crate::hot::{SceneRooms, WordOf, frame};
use scanbeam::look::Gouraud;
use scanbeam::mesh::Sphere;
use scanbeam::pixel::Rgb888;
use scanbeam::scene::{Assembled, Scene, Shadow};
use scanbeam::{Affine, Camera, Cull, Draw, Faces, Mesh, Screen};

type Look = Gouraud<Rgb888>;

/// The room of any scene here.
const VERTICES: usize = 4096;
const OBJECTS: usize = 4096;

/// Builds a scene and draws it; what pass one did, how many objects and vertices are kept, and the picture.
fn drawn(
    screen: Screen,
    build: impl FnOnce(&mut Scene<'_, 'static, Look>),
) -> (Assembled, [usize; 2], Vec<Vec<WordOf<Look>>>) {
    let mut rooms = SceneRooms::new(VERTICES, OBJECTS, screen.height().into(), 16);
    let mut scene = rooms.scene::<Look>(screen);
    build(&mut scene);
    let kept = [scene.objects(), scene.vertices()];
    (scene.assembled(), kept, frame(&scene, 32, true, [9, 8, 7]))
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
        let model = Affine::from_rows(rows, offset).unwrap();
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
        let call = Draw {
            model,
            cull: Cull::None,
            ..Draw::new(mesh)
        };
        let sphere = Sphere::around(&positions);
        let height = screen.height();
        let band = if case % 3 == 0 {
            let start = rng.below(height.into()) as u16;
            start..start + 1
        } else {
            0..height
        };
        let (whole, all, want) = drawn(screen, |scene| {
            scene.begin_lines(&camera, band.clone()).unwrap();
            scene.draw(&call).unwrap();
        });
        let mut looked = true;
        let (within, kept_here, got) = drawn(screen, |scene| {
            scene.begin_lines(&camera, band.clone()).unwrap();
            looked = scene.draw_within(&call, &sphere).unwrap();
        });
        assert!(want == got, "case {case}");
        assert_eq!(all[0], kept_here[0], "case {case}");
        assert_eq!(whole.culled, within.culled, "case {case}");
        assert_eq!((within.triangles, looked), (8, within.meshes_skipped == 0));
        if within.meshes_skipped == 1 {
            assert_eq!((within.triangles_skipped, within.vertices_skipped), (8, 24));
            assert_eq!((kept_here[1], within.clipped), (0, 0));
            skipped += 1;
        } else if all[0] > 0 {
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
    let (done, _, _) = drawn(screen, |scene| {
        scene.begin(&camera).unwrap();
        // 45 degrees to each side are seen: of 16 cubes, those at 0, 1 and 2 steps to either side.
        for step in 0..16 {
            let angle = core::f32::consts::TAU * step as f32 / 16.0;
            let call = Draw {
                model: Affine::placed(0.1, [8.0 * angle.sin(), 0.0, -8.0 * angle.cos()]).unwrap(),
                ..Draw::new(scenes::CUBE)
            };
            scene.draw_within(&call, &sphere).unwrap();
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
        let call = Draw {
            cull: Cull::None,
            ..Draw::new(mesh)
        };
        let sphere = Sphere::around(&positions);
        let (whole, all, want) = drawn(screen, |scene| {
            scene.begin(&camera).unwrap();
            scene.draw(&call).unwrap();
        });
        let mut looked = true;
        let (within, kept_here, got) = drawn(screen, |scene| {
            scene.begin(&camera).unwrap();
            looked = scene.draw_within(&call, &sphere).unwrap();
        });
        assert!(want == got, "case {case}: {positions:?}");
        assert_eq!(all[0], kept_here[0], "case {case}");
        assert_eq!((whole.triangles, looked), (1, within.meshes_skipped == 0));
        seen += u32::from(all[0] > 0);
        unseen += within.meshes_skipped;
    }
    assert!(seen > 500 && unseen > 200, "{seen} seen, {unseen} given up");
}

/// What bounds a shadow is not left out: what it falls on may be seen where it is not. Before a scene is begun nothing is
/// drawn.
#[test]
fn volumes_are_always_drawn_and_scenes_have_to_be_begun() {
    let screen = Screen::new(8, 8).unwrap();
    let mut rooms = SceneRooms::new(VERTICES, OBJECTS, 8, 2);
    let mut scene = rooms.scene::<Look>(screen);
    let sphere = Sphere::around(scenes::CUBE.positions);
    let behind = Draw {
        model: Affine::placed(1.0, [0.0, 0.0, 50.0]).unwrap(),
        ..Draw::new(scenes::CUBE)
    };
    let early = scene.draw_within(&behind, &sphere);
    assert_eq!(early, Err(scanbeam::scene::DrawError::NotBegun));
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at([0.0; 3], ahead, up, 8.0, 0.1, 100.0).unwrap();
    scene.begin(&camera).unwrap();
    assert_eq!(scene.draw_within(&behind, &sphere), Ok(false));
    let volume = Draw {
        shadow: Some(Shadow::Volume(0)),
        ..behind
    };
    assert_eq!(scene.draw_within(&volume, &sphere), Ok(true));
}
