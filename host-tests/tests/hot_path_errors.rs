//! What goes wrong is said, and leaves what was there as it was: meshes that contradict themselves, memory that is
//! full, lines and memory that do not fit, scenes that change between lines, and floats of any bits.

use crate::common::Rng;
use crate::hot::{Corner, LineRooms, SceneRooms, camera, draw, frame, line};
use scanbeam::frame::{FrameError, LineError, draw_frame};
use scanbeam::look::Gouraud;
use scanbeam::mesh::QuadSplit;
use scanbeam::pixel::Rgb888;
use scanbeam::scan_out::{Blocking, LineWriter, Pump, Window};
use scanbeam::scene::{BeginError, Draw, DrawError, Full, Scene};
use scanbeam::{Affine, Camera, Cull, Faces, Light, Mesh, MeshError, Screen};

type L = Gouraud<Rgb888>;
type Picture = Vec<Vec<[u8; 3]>>;
const BACKGROUND: [u8; 3] = [7, 8, 9];

fn screen() -> Screen {
    Screen::new(40, 30).unwrap()
}

/// Random triangles over the picture, some beyond its borders.
fn triangles(rng: &mut Rng, count: usize) -> Vec<[Corner; 3]> {
    let mut corner = || Corner {
        at: (rng.within(-60, 380), rng.within(-60, 300)),
        w: rng.between(1.01, 2.0),
        colour: [(); 3].map(|()| rng.below(256) as u8),
    };
    (0..count).map(|_| [corner(), corner(), corner()]).collect()
}

/// A mesh of random vertices.
struct Random {
    positions: Vec<[i32; 3]>,
    colours: Vec<[u8; 3]>,
    faces: Vec<[u16; 3]>,
}

impl Random {
    fn new(rng: &mut Rng, vertices: usize, faces: usize) -> Self {
        let mut along = || (rng.signed() * f64::from(1 << 24)) as i32;
        let positions = (0..vertices)
            .map(|_| [along(), along(), -(1 << 30) - (along() & 0xFFFF)])
            .collect();
        let colours = (0..vertices)
            .map(|_| [(); 3].map(|()| rng.below(256) as u8))
            .collect();
        let mut index = || rng.below(vertices as u32) as u16;
        let faces = (0..faces).map(|_| [index(), index(), index()]).collect();
        Self {
            positions,
            colours,
            faces,
        }
    }

    fn mesh(&self) -> Mesh<'_, i32> {
        Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &self.colours,
            faces: Faces::Triangles(&self.faces),
        }
    }
}

fn either_side<C>(mesh: Mesh<'_, C>) -> Draw<'_, 'static, C> {
    let mut call = Draw::new(mesh);
    call.cull = Cull::None;
    call
}

fn picture(scene: &Scene<'_, '_, L>) -> Picture {
    frame(scene, 16, true, BACKGROUND)
}

#[test]
fn a_mesh_that_contradicts_itself_leaves_the_scene_as_it_was() {
    let mut rng = Rng::new(361);
    for round in 0..600 {
        // Sometimes so few vertices fit that each face brings its own.
        let room = rng.pick(&[4_000, 150]);
        let mut rooms = SceneRooms::new(room, 600, 30, 8);
        let mut scene = rooms.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        draw(&mut scene, &triangles(&mut rng, 30), Cull::None).unwrap();
        let (want, objects, vertices) = (picture(&scene), scene.objects(), scene.vertices());
        let mut mesh = Random::new(&mut rng, 80, 40);
        let face = rng.below(40) as usize;
        let bad = rng.pick(&[80, 81, 4_000, u16::MAX]);
        mesh.faces[face][rng.below(3) as usize] = bad;
        let quads: Vec<[u16; 4]> = mesh.faces.iter().map(|&[a, b, c]| [a, b, c, a]).collect();
        let strip: Vec<u16> = mesh.faces.as_flattened().to_vec();
        let short = [[1, 2, 3]; 3];
        let index = MeshError::Index { face: face as u32 };
        let (call, why) = match round % 6 {
            0 | 1 => (mesh.mesh(), Some(index)),
            2 => {
                let faces = Faces::Quads(&quads, QuadSplit::Corner0To2);
                (
                    Mesh {
                        faces,
                        ..mesh.mesh()
                    },
                    Some(index),
                )
            }
            3 => {
                let faces = Faces::QuadStrip(&strip, QuadSplit::Corner0To2);
                (
                    Mesh {
                        faces,
                        ..mesh.mesh()
                    },
                    None,
                )
            }
            4 => {
                let colours = &short;
                (
                    Mesh {
                        colours,
                        ..mesh.mesh()
                    },
                    Some(MeshError::AttributeLength),
                )
            }
            _ => {
                let normals = &[[0, 0, 1 << 14]; 79];
                (
                    Mesh {
                        normals,
                        ..mesh.mesh()
                    },
                    Some(MeshError::AttributeLength),
                )
            }
        };
        let error = scene.draw(&either_side(call)).unwrap_err();
        match why {
            Some(why) => assert_eq!(error, DrawError::Mesh(why), "round {round}"),
            None => assert!(matches!(error, DrawError::Mesh(MeshError::Index { .. }))),
        }
        assert_eq!((scene.objects(), scene.vertices()), (objects, vertices));
        assert_eq!(picture(&scene), want, "round {round}");
        assert_eq!(
            scene.assembled().triangles,
            30,
            "what is refused is not submitted"
        );
        // Its draw call is free again: there are 8, and one is taken.
        for _ in 0..7 {
            let one = triangles(&mut rng, 1);
            draw(&mut scene, &one, Cull::None).unwrap();
        }
        let one = triangles(&mut rng, 1);
        assert!(matches!(
            draw(&mut scene, &one, Cull::None),
            Err(DrawError::Full {
                memory: Full::Draws,
                triangles: 1,
                first_face: 0
            })
        ));
    }
}

/// Whatever memory is full, the triangles before the first that was dropped are drawn, and all are counted.
#[test]
fn what_fits_is_drawn_and_the_rest_is_counted() {
    let mut rng = Rng::new(362);
    let (mut full, mut vertices_full, mut objects_full) = (0, 0, 0);
    for round in 0..800 {
        let mesh = Random::new(&mut rng, 60, 100);
        let vertices = rng.pick(&[0, 2, 3, 59, 60, 61, 100, 200, 400]);
        let objects = rng.pick(&[0, 1, 20, 60, 99, 400]);
        let mut rooms = SceneRooms::new(vertices, objects, 30, 1);
        let mut scene = rooms.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        let drawn = scene.draw(&either_side(mesh.mesh()));
        let counts = scene.assembled();
        assert_eq!(counts.triangles, 100);
        let filed = scene.objects() as u32;
        assert_eq!(filed + counts.culled + counts.dropped, 100, "round {round}");
        let got = picture(&scene);
        let kept = match drawn {
            Ok(()) => {
                assert_eq!(counts.dropped, 0);
                100
            }
            Err(DrawError::Full {
                memory,
                triangles,
                first_face,
            }) => {
                assert_eq!(triangles, counts.dropped);
                full += 1;
                vertices_full += u32::from(memory == Full::Vertices);
                objects_full += u32::from(memory == Full::Objects);
                first_face
            }
            Err(other) => panic!("{other}"),
        };
        let first = Mesh {
            faces: Faces::Triangles(&mesh.faces[..kept as usize]),
            ..mesh.mesh()
        };
        let mut rooms = SceneRooms::new(60, 100, 30, 1);
        let mut scene = rooms.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        scene.draw(&either_side(first)).unwrap();
        assert_eq!(picture(&scene), got, "{kept} faces of round {round}");
    }
    assert!(full > 300 && vertices_full > 50 && objects_full > 50);
}

#[test]
fn scenes_that_are_not_begun_or_do_not_fit_say_so() {
    let mut rng = Rng::new(363);
    let mut rooms = SceneRooms::new(300, 100, 30, 4);
    let mut scene = rooms.scene::<L>(screen());
    let some = triangles(&mut rng, 20);
    assert_eq!(
        draw(&mut scene, &some, Cull::None),
        Err(DrawError::NotBegun)
    );
    let mut lines = LineRooms::fitting(&scene, 4, true);
    let mut pixels = [[1; 3]; 40];
    assert_eq!(
        lines
            .renderer()
            .draw_line(&scene, 0, &mut pixels, BACKGROUND),
        Err(LineError::NotBegun)
    );
    assert_eq!(frame_error(&scene), Some(LineError::NotBegun));
    scene.begin(&camera()).unwrap();
    assert_eq!(frame_error(&scene), None);
    draw(&mut scene, &some, Cull::None).unwrap();
    let want = picture(&scene);
    for (start, end) in [(0, 31), (30, 31), (5, 5), (9, 3), (0, u16::MAX)] {
        let error = BeginError::Lines {
            start,
            end,
            height: 30,
        };
        assert_eq!(scene.begin_lines(&camera(), start..end), Err(error));
        assert_eq!((picture(&scene), scene.lines()), (want.clone(), 0..30));
    }
    // A picture of more lines than bins.
    let high = Screen::new(8, 31).unwrap();
    let mut scene = rooms.scene::<L>(high);
    let error = BeginError::Bins {
        needed: 31,
        have: 30,
    };
    assert_eq!(scene.begin(&camera()), Err(error));
    let said = frame_error(&scene).expect("it has no lines");
    assert_eq!(said.to_string(), "renderer: the scene was not begun");
    scene.begin_lines(&camera(), 1..31).unwrap();
    for (width, height) in [(1_017, 8), (8, 1_017), (8_192, 8_192)] {
        let large = Screen::new(width, height).unwrap();
        let mut scene = rooms.scene::<L>(large);
        let error = BeginError::Size { width, height };
        assert_eq!(scene.begin_lines(&camera(), 0..1), Err(error));
    }
}

#[test]
fn lines_without_the_memory_they_need_are_not_written() {
    let mut rng = Rng::new(364);
    let mut rooms = SceneRooms::new(300, 100, 30, 4);
    let mut scene = rooms.scene::<L>(screen());
    scene.begin_lines(&camera(), 10..20).unwrap();
    draw(&mut scene, &triangles(&mut rng, 60), Cull::None).unwrap();
    let want = picture(&scene);
    let needed = scene.objects();
    let mut lines = LineRooms::fitting(&scene, 16, true);
    let mut other = [[77; 3]; 41];
    // Short of each thing in turn; then drawn all the same.
    lines.links.pop();
    let links = LineError::Links {
        needed,
        have: needed - 1,
    };
    let got = lines
        .renderer()
        .draw_line(&scene, 10, &mut other[..40], BACKGROUND);
    assert_eq!(got, Err(links));
    lines.links.push(scanbeam::Link::NONE);
    lines.depth.pop();
    let depth = LineError::Depth {
        needed: 40,
        have: 39,
    };
    let got = lines
        .renderer()
        .draw_line(&scene, 10, &mut other[..40], BACKGROUND);
    assert_eq!(got, Err(depth));
    assert_eq!(lines.renderer().check(&scene), Err(depth));
    lines.depth.push(0);
    let mut renderer = lines.renderer();
    for y in 10..20 {
        for have in [0, 39, 41] {
            let error = LineError::Pixels { needed: 40, have };
            let got = renderer.draw_line(&scene, y, &mut other[..have], BACKGROUND);
            assert_eq!(got, Err(error));
        }
        for beyond in [0, 9, 20, 29, 30, u16::MAX] {
            let error = LineError::Line { line: beyond };
            let got = renderer.draw_line(&scene, beyond, &mut other[..40], BACKGROUND);
            assert_eq!(got, Err(error));
        }
        let got = line(&mut renderer, &scene, y, BACKGROUND);
        assert_eq!(got, want[usize::from(y) - 10]);
    }
    assert!(other.iter().all(|p| *p == [77; 3]), "something was written");
}

/// Keeps what it is sent.
struct Sink(Vec<[u8; 3]>);

impl LineWriter for Sink {
    type Error = std::convert::Infallible;
    type Word = [u8; 3];

    fn open(&mut self, _: Window) -> Result<(), Self::Error> {
        Ok(())
    }

    fn write(&mut self, _: Window, words: &[[u8; 3]]) -> Result<(), Self::Error> {
        self.0.extend(words);
        Ok(())
    }
}

/// Why a frame of an empty scene is not drawn.
fn frame_error(scene: &Scene<'_, '_, L>) -> Option<LineError> {
    let words = [(); 2].map(|()| vec![[0; 3]; 40].leak());
    let mut pump = Pump::new(Blocking::over(Sink(Vec::new())), words);
    let mut lines = LineRooms::fitting(scene, 4, true);
    match draw_frame(scene, &mut lines.renderer(), &mut pump, BACKGROUND, 1) {
        Ok(_) => None,
        Err(FrameError::Line(error)) => Some(error),
        Err(other) => panic!("{other}"),
    }
}

#[test]
fn frames_are_their_lines_or_are_not_begun() {
    let mut rng = Rng::new(365);
    let mut rooms = SceneRooms::new(300, 100, 30, 4);
    let mut scene = rooms.scene::<L>(screen());
    scene.begin(&camera()).unwrap();
    draw(&mut scene, &triangles(&mut rng, 9), Cull::Back).unwrap();
    let want = picture(&scene);
    for per_transfer in [1, 4, 30] {
        let words = [(); 2].map(|()| vec![[0; 3]; 40 * usize::from(per_transfer)].leak());
        let mut sink = Sink(Vec::new());
        let mut pump = Pump::new(Blocking::over(&mut sink), words);
        let mut lines = LineRooms::fitting(&scene, 16, true);
        lines.links.pop();
        let error = draw_frame(
            &scene,
            &mut lines.renderer(),
            &mut pump,
            BACKGROUND,
            per_transfer,
        );
        assert!(matches!(
            error,
            Err(FrameError::Line(LineError::Links { .. }))
        ));
        lines.links.push(scanbeam::Link::NONE);
        let done = draw_frame(
            &scene,
            &mut lines.renderer(),
            &mut pump,
            BACKGROUND,
            per_transfer,
        );
        let done = done.unwrap();
        assert_eq!(sink.0, want.concat());
        let empty = want.iter().filter(|l| l.iter().all(|p| *p == BACKGROUND));
        assert!(done.lines_skipped as usize <= empty.count());
        assert_eq!(done.assembled, scene.assembled());
        assert_eq!(done.cache.hits, scene.objects() as u32);
    }
}

/// A renderer that goes on from line to line notices that the scene is begun anew, drawn into, or another.
#[test]
fn what_changes_between_lines_is_seen() {
    let mut rng = Rng::new(366);
    for _ in 0..150 {
        let [mut one, mut other] = [(); 2].map(|()| SceneRooms::new(300, 100, 30, 8));
        let mut scenes = [one.scene::<L>(screen()), other.scene::<L>(screen())];
        for scene in &mut scenes {
            scene.begin(&camera()).unwrap();
            draw(scene, &triangles(&mut rng, 20), Cull::None).unwrap();
        }
        let mut lines = LineRooms::fitting(&scenes[0], rng.pick(&[0, 4, 64]), true);
        lines.links.resize(100, scanbeam::Link::NONE);
        let mut renderer = lines.renderer();
        for y in 0..30 {
            let which = rng.below(2) as usize;
            let more = triangles(&mut rng, 3);
            match rng.below(12) {
                0 => {
                    scenes[which].begin(&camera()).unwrap();
                    draw(&mut scenes[which], &more, Cull::None).unwrap();
                }
                1 => {
                    // What is full stays as it is.
                    let _ = draw(&mut scenes[which], &more, Cull::None);
                }
                _ => (),
            }
            let got = line(&mut renderer, &scenes[which], y, BACKGROUND);
            let mut fresh = LineRooms::fitting(&scenes[which], 64, true);
            let want = line(&mut fresh.renderer(), &scenes[which], y, BACKGROUND);
            assert_eq!(got, want, "line {y}");
        }
    }
}

/// A float of any bits, most of them of sizes that make a picture.
fn float(rng: &mut Rng) -> f32 {
    match rng.below(8) {
        0 => f32::from_bits(rng.below(u32::MAX)),
        1 => rng.pick(&[
            0.0,
            -0.0,
            1.0,
            f32::MAX,
            f32::MIN_POSITIVE,
            f32::INFINITY,
            f32::NAN,
        ]),
        2 => (rng.signed() * 1e4) as f32,
        _ => rng.signed() as f32,
    }
}

#[test]
fn floats_of_any_bits_are_refused_or_drawn() {
    let mut rng = Rng::new(367);
    let mut rooms = SceneRooms::new(400, 200, 30, 4);
    let (mut drawn, mut seen) = (0, 0);
    for _ in 0..40_000 {
        let mut three = || [(); 3].map(|()| float(&mut rng));
        let (eye, at, up) = (three(), three(), three());
        let (rows, offset, direction) = ([three(), three(), three()], three(), three());
        let (focal, near) = (float(&mut rng).abs() * 100.0, float(&mut rng).abs());
        let far = near * (1.0 + 1_000.0 * float(&mut rng).abs());
        let Ok(camera) = Camera::look_at(eye, at, up, focal, near, far) else {
            continue;
        };
        let Some(model) = Affine::from_rows(rows, offset) else {
            continue;
        };
        let mut mesh = Random::new(&mut rng, 12, 30);
        for position in mesh.positions.as_flattened_mut() {
            let any = rng.below(u32::MAX) as i32;
            *position = rng.pick(&[i32::MIN, i32::MAX, 0, 1 << 30, any, any]);
        }
        let normals = [(); 12].map(|()| [(); 3].map(|()| rng.within(-16_384, 16_384) as i16));
        let mut scene = rooms.scene::<L>(screen());
        scene.begin(&camera).unwrap();
        let mut call = either_side(Mesh {
            normals: &normals,
            ..mesh.mesh()
        });
        call.model = model;
        call.light = Light::new(direction, float(&mut rng));
        // Cut triangles may fill the memory.
        let _ = scene.draw(&call);
        drawn += 1;
        let one = frame(&scene, 5, true, BACKGROUND);
        assert_eq!(one, frame(&scene, 64, true, BACKGROUND));
        seen += usize::from(one.iter().flatten().any(|p| *p != BACKGROUND));
    }
    println!("{drawn} drawn, {seen} seen");
    assert!(drawn > 2_000 && seen > 400, "{drawn} {seen}");
}
