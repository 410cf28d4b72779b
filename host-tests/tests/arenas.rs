//! S3, C5: an arena that is too small is a located error, what fits is drawn, and no length of
//! any slice makes a panic.

use crate::common::{LineRooms, Rng, SceneRooms, frame};
use scanbeam::mesh::Room;
use scanbeam::pipeline::{
    DrawError, FlatPainter, GouraudDepth, Instance, Pipeline, RendererError, Scene, SceneError,
    WordOf,
};
use scanbeam::pixel::Rgb888;
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, MeshError, Screen};
use scenes::{CUBE, TEAPOT};

type P = FlatPainter<Rgb888>;

const WIDTH: u16 = 64;
const HEIGHT: u16 = 32;

fn screen() -> Screen {
    Screen::new(WIDTH, HEIGHT).unwrap()
}

fn camera() -> Camera {
    Camera::look_at([0.0, 0.0, 2.0], [0.0; 3], [0.0, 1.0, 0.0], 30.0, 0.1, 10.0).unwrap()
}

fn open() -> Instance {
    Instance {
        cull: Cull::None,
        ..Instance::default()
    }
}

/// Triangles side by side, `count` of them, the first on the left, each with vertices of its own.
struct Row {
    positions: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    faces: Vec<[u16; 3]>,
}

impl Row {
    fn new(count: u16) -> Self {
        let mut row = Self {
            positions: Vec::new(),
            colours: Vec::new(),
            faces: Vec::new(),
        };
        let step = 32_000 / i32::from(count);
        for i in 0..count {
            let left = (i32::from(i) * step - 16_000) as i16;
            let right = left + (step - step / 8) as i16;
            row.positions
                .extend([[left, -9000, 0], [right, -9000, 0], [left, 9000, 0]]);
            row.colours.extend([[i as u8 + 1, 200, 9]; 3]);
            row.faces.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        row
    }

    /// The first `count` triangles.
    fn first(&self, count: usize) -> Mesh<'_> {
        Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &self.colours,
            faces: Faces::Triangles(&self.faces[..count]),
        }
    }
}

/// The frame of the first `count` triangles in memory that suffices.
fn want(row: &Row, count: usize) -> Vec<Vec<[u8; 3]>> {
    let mut rooms = SceneRooms::<P>::new(1000, 1000, 100);
    let mut scene = rooms.scene(screen());
    scene.begin(&camera()).unwrap();
    scene.draw(&row.first(count), &open()).unwrap();
    assert_eq!(scene.pass_one().objects as usize, count);
    frame(&scene, 4)
}

#[test]
fn too_few_objects_keep_the_first_faces() {
    let row = Row::new(8);
    for have in 0..10 {
        let mut rooms = SceneRooms::<P>::new(100, have, 32);
        let mut scene = rooms.scene(screen());
        scene.begin(&camera()).unwrap();
        let drawn = scene.draw(&row.first(8), &open());
        if have >= 8 {
            assert_eq!(drawn.unwrap().kept, 8);
        } else {
            let Err(DrawError::Full(dropped)) = drawn else {
                panic!("{have}: {drawn:?}");
            };
            assert_eq!(dropped.room, Room::Objects);
            assert_eq!(dropped.first_face as usize, have);
            assert_eq!(dropped.triangles as usize, 8 - have);
            let text = drawn.unwrap_err().to_string();
            assert!(
                text.contains("object") && text.contains(&format!("face {have}")),
                "{text}"
            );
        }
        let kept = have.min(8);
        let done = scene.pass_one();
        assert_eq!((done.triangles, done.culled), (8, 0));
        assert_eq!((done.objects, done.dropped), (kept as u32, 8 - kept as u32));
        assert_eq!(frame(&scene, 2), want(&row, kept), "{have} objects");
    }
}

#[test]
fn too_few_vertices_keep_the_first_faces() {
    let row = Row::new(8);
    for have in 0..30 {
        let mut rooms = SceneRooms::<P>::new(have, 100, 32);
        let mut scene = rooms.scene(screen());
        scene.begin(&camera()).unwrap();
        let drawn = scene.draw(&row.first(8), &open());
        let kept = (have / 3).min(8);
        if kept == 8 {
            assert_eq!(drawn.unwrap().kept, 8);
        } else {
            let Err(DrawError::Full(dropped)) = drawn else {
                panic!("{have}: {drawn:?}");
            };
            assert_eq!(dropped.room, Room::Vertices);
            assert_eq!(dropped.first_face as usize, kept);
            assert_eq!(dropped.triangles as usize, 8 - kept);
        }
        assert_eq!(frame(&scene, 2), want(&row, kept), "{have} vertices");
    }
}

/// After a mesh that did not fit, a smaller one may still fit, and the next frame is whole.
#[test]
fn a_full_arena_is_empty_again_for_the_next_frame() {
    let row = Row::new(8);
    let mut rooms = SceneRooms::<P>::new(24, 8, 32);
    let mut scene = rooms.scene(screen());
    for _ in 0..3 {
        scene.begin(&camera()).unwrap();
        assert!(scene.draw(&TEAPOT, &open()).is_err());
        assert!(scene.pass_one().dropped > 500);
        assert!(scene.pass_one().vertices <= 24 && scene.pass_one().objects <= 8);
        frame(&scene, 2);
        scene.begin(&camera()).unwrap();
        assert_eq!(scene.pass_one().dropped, 0);
        scene.draw(&row.first(8), &open()).unwrap();
        assert_eq!(frame(&scene, 2), want(&row, 8));
    }
}

#[test]
fn too_few_buckets_refuse_the_frame() {
    let row = Row::new(8);
    for have in 0..32 {
        let mut rooms = SceneRooms::<P>::new(100, 100, have);
        let mut scene = rooms.scene(screen());
        let error = scene.begin(&camera()).unwrap_err();
        assert_eq!(error, SceneError::Buckets { needed: 32, have });
        assert!(error.to_string().contains(&have.to_string()), "{error}");
        // Nothing was begun: nothing is kept.
        assert_eq!(scene.draw(&row.first(8), &open()).unwrap().kept, 0);
        // A band of as many lines as there are buckets fits.
        if have > 0 {
            let lines = 32 - have as u16..32;
            scene.begin_band(&camera(), lines.clone()).unwrap();
            scene.draw(&row.first(8), &open()).unwrap();
            assert_eq!(
                frame(&scene, 2),
                want(&row, 8)[usize::from(lines.start)..],
                "{have}"
            );
        }
    }
}

#[test]
fn bands_outside_the_picture_are_refused() {
    let mut rooms = SceneRooms::<P>::new(100, 100, 100);
    let mut scene = rooms.scene(screen());
    #[expect(clippy::reversed_empty_ranges, reason = "what is refused")]
    for lines in [0..33, 5..5, 9..3, 32..33, 65_535..0, 0..65_535] {
        let error = scene.begin_band(&camera(), lines).unwrap_err();
        assert!(matches!(error, SceneError::Lines { height: 32, .. }));
        assert!(!error.to_string().is_empty());
    }
}

#[test]
fn a_renderer_with_too_little_memory_says_so() {
    type Q = GouraudDepth<Rgb888>;
    let row = Row::new(8);
    let mut rooms = SceneRooms::<Q>::new(100, 100, 32);
    let mut scene = rooms.scene(screen());
    scene.begin(&camera()).unwrap();
    scene.draw(&row.first(8), &open()).unwrap();
    let draw = |links: usize, depth: usize, pixels: usize, line: u16| {
        let mut rooms = LineRooms::<Q>::new(3, links, depth);
        let mut pixels = vec![[7; 3]; pixels];
        let done = rooms.renderer().draw_line(&scene, line, &mut pixels);
        assert!(
            done.is_ok() || pixels.iter().all(|p| *p == [7; 3]),
            "half drawn"
        );
        if let Err(error) = done {
            assert!(error.to_string().starts_with("renderer: "), "{error}");
        }
        done
    };
    let links = |have| Err(RendererError::Links { needed: 8, have });
    let depth = |have| Err(RendererError::Depth { needed: 64, have });
    let pixels = |have| Err(RendererError::Pixels { needed: 64, have });
    assert_eq!(draw(8, 64, 64, 16), Ok(true));
    assert_eq!(draw(8, 64, 64, 0), Ok(false));
    assert_eq!(draw(7, 64, 64, 16), links(7));
    assert_eq!(draw(0, 64, 64, 16), links(0));
    assert_eq!(draw(8, 63, 64, 16), depth(63));
    assert_eq!(draw(8, 0, 64, 16), depth(0));
    assert_eq!(draw(8, 64, 63, 16), pixels(63));
    assert_eq!(draw(8, 64, 65, 16), pixels(65));
    assert_eq!(draw(8, 64, 0, 16), pixels(0));
    for line in [32, 33, 8191, u16::MAX] {
        assert_eq!(draw(8, 64, 64, line), Err(RendererError::Line { line }));
    }
    let fresh = LineRooms::<Q>::new(3, 7, 64).renderer().check(&scene);
    assert_eq!(fresh, Err(RendererError::Links { needed: 8, have: 7 }));
}

#[test]
fn no_memory_at_all() {
    type Q = GouraudDepth<Rgb888>;
    let mut rooms = SceneRooms::<Q>::new(0, 0, 0);
    let mut scene = rooms.scene(screen());
    let have = 0;
    assert_eq!(
        scene.begin(&camera()),
        Err(SceneError::Buckets { needed: 32, have })
    );
    assert_eq!(scene.lines(), 0..0);
    assert_eq!(scene.bytes(), 0);
    let mut rooms = LineRooms::<Q>::new(0, 0, 0);
    let mut renderer = rooms.renderer();
    assert!(renderer.check(&scene).is_err());
    assert!(renderer.draw_line(&scene, 0, &mut []).is_err());
    // Buckets alone, as one would have for an empty picture.
    let mut rooms = SceneRooms::<Q>::new(0, 0, 32);
    let mut scene = rooms.scene(screen());
    scene.begin(&camera()).unwrap();
    assert!(matches!(
        scene.draw(&CUBE, &open()),
        Err(DrawError::Full(dropped)) if dropped.room == Room::Vertices && dropped.first_face == 0
    ));
    let empty = frame(&scene, 0);
    assert!(empty.iter().flatten().all(|p| *p == [0; 3]));
}

#[test]
fn meshes_that_contradict_themselves_leave_the_scene_as_it_was() {
    let row = Row::new(8);
    let mut rooms = SceneRooms::<P>::new(100, 100, 32);
    let mut scene = rooms.scene(screen());
    scene.begin(&camera()).unwrap();
    scene.draw(&row.first(8), &open()).unwrap();
    let before = (scene.pass_one(), frame(&scene, 2));
    let mesh = row.first(8);
    let bad = [
        Mesh {
            normals: &[[0, 0, 16_384]],
            ..mesh
        },
        Mesh {
            colours: &row.colours[1..],
            ..mesh
        },
        Mesh {
            faces: Faces::Triangles(&[[0, 1, 2], [0, 1, 24]]),
            ..mesh
        },
        Mesh {
            faces: Faces::Quads(&[[0, 1, 2, u16::MAX]], Default::default()),
            ..mesh
        },
        Mesh {
            faces: Faces::QuadStrip(&[0, 1, 2], Default::default()),
            ..mesh
        },
        Mesh {
            faces: Faces::QuadStrip(&[0, 1], Default::default()),
            ..mesh
        },
        Mesh {
            positions: &[],
            colours: &[],
            ..mesh
        },
    ];
    for mesh in bad {
        let error = scene.draw(&mesh, &open()).unwrap_err();
        assert!(matches!(error, DrawError::Mesh(_)), "{error}");
        assert!(error.to_string().starts_with("mesh: "), "{error}");
    }
    let error = scene.draw(&bad[2], &open()).unwrap_err();
    assert_eq!(error, DrawError::Mesh(MeshError::Index { face: 1 }));
    assert_eq!((scene.pass_one(), frame(&scene, 2)), before);
    // Nothing at all is a mesh.
    let nothing = Mesh::<i16> {
        positions: &[],
        normals: &[],
        colours: &[],
        faces: Faces::QuadStrip(&[], Default::default()),
    };
    assert_eq!(scene.draw(&nothing, &open()).unwrap().kept, 0);
    assert_eq!((scene.pass_one(), frame(&scene, 2)), before);
}

/// What is kept of clipped meshes, at any length of the arenas, is part of the whole picture's
/// triangles, and nothing panics.
#[test]
fn any_length_of_any_arena_draws_something_or_says_no() {
    type Q = GouraudDepth<Rgb888>;
    let mut rng = Rng::new(31);
    let mut enough = SceneRooms::<Q>::new(30_000, 30_000, 32);
    for _ in 0..400 {
        let (vertices, objects) = (rng.below(1500) as usize, rng.below(2500) as usize);
        let mut rooms = SceneRooms::<Q>::new(vertices, objects, rng.below(40) as usize);
        let mut scene: Scene<'_, Q> = rooms.scene(screen());
        // The eye inside, so that many triangles are cut.
        let eye = [(); 3].map(|()| 0.4 * rng.signed() as f32);
        let camera =
            Camera::look_at(eye, [1.0, 0.1, 0.3], [0.0, 1.0, 0.0], 20.0, 0.01, 3.0).unwrap();
        let first = rng.below(32) as u16;
        if scene.begin_band(&camera, first..32).is_err() {
            continue;
        }
        let mut enough = enough.scene(screen());
        enough.begin_band(&camera, first..32).unwrap();
        for _ in 0..3 {
            let model = Affine::rotation_y(rng.signed() as f32);
            let instance = Instance { model, ..open() };
            enough.draw(&TEAPOT, &instance).unwrap();
            match scene.draw(&TEAPOT, &instance) {
                Ok(done) => assert_eq!(done.dropped, None),
                Err(DrawError::Full(dropped)) => assert!(dropped.triangles > 0),
                Err(error) => panic!("{error}"),
            }
        }
        let done = scene.pass_one();
        // What cannot be seen does not depend on what there is room for.
        assert_eq!(done.culled, enough.pass_one().culled);
        assert!(done.dropped <= done.triangles - done.culled);
        assert!(done.vertices as usize <= vertices && done.objects as usize <= objects);
        assert_eq!(done.triangles, 3 * 2256);
        assert!(lines_are_whole(&scene));
    }
}

fn lines_are_whole<P: Pipeline>(scene: &Scene<'_, P>) -> bool
where
    WordOf<P>: PartialEq,
{
    frame(scene, 1) == frame(scene, 33)
}
