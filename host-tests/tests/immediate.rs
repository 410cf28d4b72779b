//! Immediate calls from plain slices are meshes (K2).

use crate::common::{Rng, SceneRooms, frame};
use crate::listing::{Cloud, HEIGHT, WIDTH};
use scanbeam::list::{FieldForm, VertexFormat};
use scanbeam::mesh::{QuadSplit, Vertices};
use scanbeam::pipeline::{FlatDepth, GouraudDepth, Instance, Pipeline, Scene, WordOf};
use scanbeam::pixel::Rgb888;
use scanbeam::{Affine, Camera, Faces, Light, Mesh, Screen};

type Smooth = GouraudDepth<Rgb888>;
type Faceted = FlatDepth<Rgb888>;

/// What a call draws.
fn drawn<P: Pipeline>(draw: impl FnOnce(&mut Scene<'_, P>)) -> Vec<Vec<WordOf<P>>> {
    let mut rooms = SceneRooms::<P>::new(60_000, 60_000, usize::from(HEIGHT));
    let mut scene = rooms.scene(Screen::new(WIDTH, HEIGHT).unwrap());
    let camera = Camera::look_at([0.3, 0.5, 4.0], [0.0; 3], [0.0, 1.0, 0.0], 90.0, 0.1, 99.0);
    scene.begin(&camera.unwrap()).unwrap();
    draw(&mut scene);
    frame(&scene, 16)
}

#[test]
fn immediate_calls_are_meshes() {
    let mut rng = Rng::new(3);
    let cloud = Cloud::random(&mut rng, 840, FieldForm::S16x3, FieldForm::S16x3);
    let vertices = cloud.plain(true, &VertexFormat::default());
    let instance = Instance {
        model: Affine::rotation_y(0.7),
        light: Light::new([0.3, 0.9, 0.5], 0.2),
        colour: [200, 90, 40],
        ..Instance::default()
    };
    let threes: Vec<[u16; 3]> = (0..280).map(|i| [3 * i, 3 * i + 1, 3 * i + 2]).collect();
    let fours: Vec<[u16; 4]> = (0..210).map(|i| [0, 1, 2, 3].map(|k| 4 * i + k)).collect();
    let triangles = drawn::<Smooth>(|scene| {
        let done = scene.draw_triangles(vertices, &instance).unwrap();
        assert_eq!(done.triangles, 280);
    });
    let indexed = drawn::<Smooth>(|scene| {
        scene.draw_indexed(vertices, &threes, &instance).unwrap();
    });
    assert!(triangles == indexed);
    for split in [QuadSplit::Corner0To2, QuadSplit::Corner1To3] {
        let quads = drawn::<Faceted>(|scene| {
            let done = scene.draw_quads(vertices, split, &instance).unwrap();
            assert_eq!(done.triangles, 420);
        });
        let mesh = Mesh {
            positions: vertices.positions,
            normals: vertices.normals,
            colours: vertices.colours,
            faces: Faces::Quads(&fours, split),
        };
        let want = drawn::<Faceted>(|scene| {
            scene.draw(&mesh, &instance).unwrap();
        });
        assert!(quads == want);
    }
    let bad = Vertices {
        normals: &cloud.normals[1..],
        ..vertices
    };
    drawn::<Smooth>(|scene| assert!(scene.draw_triangles(bad, &instance).is_err()));
}
