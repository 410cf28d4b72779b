//! Meshes in parts (X3, M4): the same picture, and nothing is left out that is not seen from behind.

use crate::common::Rng;
use crate::hot::{SceneRooms, WordOf, frame};
use scanbeam::look::Gouraud;
use scanbeam::mesh::{CutError, Meshlet, Meshlets};
use scanbeam::pixel::Rgb888;
use scanbeam::scene::{Assembled, Budget, DrawError, Scene, Shading, Skin};
use scanbeam::{Affine, Camera, Cull, Draw, Faces, Light, Mesh, MeshError, Screen};

type Look = Gouraud<Rgb888>;

const VERTICES: usize = 16_384;
const OBJECTS: usize = 8192;

/// A mesh whose faces are sorted by parts.
struct Cut {
    mesh: Mesh<'static>,
    faces: Vec<[u16; 3]>,
    parts: Vec<Meshlet>,
    vertices: Vec<u16>,
}

impl Cut {
    fn new(mesh: Mesh<'static>) -> Self {
        let Faces::Triangles(from) = mesh.faces else {
            panic!("triangles");
        };
        let mut faces = from.to_vec();
        let (mut parts, mut vertices) = (vec![Meshlet::EMPTY; 800], vec![0; 3 * from.len()]);
        let cut = Meshlets::cut(mesh.positions, &mut faces, &mut parts, &mut vertices).unwrap();
        let (made, listed) = (cut.parts().len(), cut.vertices().len());
        parts.truncate(made);
        vertices.truncate(listed);
        Self {
            mesh,
            faces,
            parts,
            vertices,
        }
    }

    fn meshlets(&self) -> Meshlets<'_> {
        Meshlets::of(&self.faces, &self.parts, &self.vertices).unwrap()
    }

    /// The mesh with its faces in the order of the parts.
    fn whole(&self) -> Mesh<'_> {
        Mesh {
            faces: Faces::Triangles(&self.faces),
            ..self.mesh
        }
    }

    fn point(&self, vertex: u16) -> [f64; 3] {
        self.mesh.positions[usize::from(vertex)].map(|c| f64::from(c) / 16_384.0)
    }

    /// Whether a point sees a face from behind, or sees only its edge.
    fn is_behind(&self, face: [u16; 3], eye: [f64; 3]) -> bool {
        let [a, b, c] = face.map(|i| self.point(i));
        let minus = |p: [f64; 3], q: [f64; 3]| [0, 1, 2].map(|i| p[i] - q[i]);
        let (u, v, w) = (minus(b, a), minus(c, a), minus(a, eye));
        let normal = [0, 1, 2].map(|i| {
            let (j, k) = ((i + 1) % 3, (i + 2) % 3);
            u[j] * v[k] - u[k] * v[j]
        });
        (0..3).map(|i| normal[i] * w[i]).sum::<f64>() >= 0.0
    }
}

/// Builds a scene and draws it; what pass one did, how many objects are kept, and the picture.
fn drawn(
    vertices: usize,
    build: impl FnOnce(&mut Scene<'_, 'static, Look>),
) -> (Assembled, usize, Vec<Vec<WordOf<Look>>>) {
    let screen = Screen::new(160, 120).unwrap();
    let mut rooms = SceneRooms::new(vertices, OBJECTS, screen.height().into(), 4);
    let mut scene = rooms.scene::<Look>(screen);
    build(&mut scene);
    let picture = frame(&scene, 64, true, [9, 8, 7]);
    (scene.assembled(), scene.objects(), picture)
}

/// Closed meshes from everywhere, near and far, beside the picture and around the eye, turned, scaled, mirrored and
/// stretched, with both sides and without, and without room for shared vertices. Kills: the eye of a stretched or mirrored
/// model; a spread of a quarter.
#[test]
fn a_mesh_in_parts_is_the_mesh() {
    let mut rng = Rng::new(0x3E5_4E75);
    let cuts = [
        Cut::new(scenes::TEAPOT),
        Cut::new(scenes::SPHERE),
        Cut::new(scenes::CUBE),
    ];
    let (mut skipped, mut beside, mut lost) = (0, 0, 0);
    for case in 0..900 {
        let cut = &cuts[case % 3];
        let away = rng.pick(&[1.3, 2.0, 4.0, 30.0]);
        let direction = [0, 1, 2].map(|_| rng.signed());
        let length = direction.map(|c| c * c).iter().sum::<f64>().sqrt().max(0.1);
        let eye = direction.map(|c| (c / length * away) as f32);
        let at = [0, 1, 2].map(|_| (rng.signed() * rng.pick(&[0.1, 1.5])) as f32);
        let focal = rng.pick(&[60.0, 200.0]);
        let up = [0.1, 1.0, 0.2];
        let Ok(camera) = Camera::look_at(eye, at, up, focal, 0.2, 100.0) else {
            continue;
        };
        let turned = Affine::rotation_y(rng.signed() as f32 * 3.0)
            .then(&Affine::rotation_x(rng.signed() as f32 * 3.0));
        let rows = match case / 3 % 6 {
            0 => [[1.0, 0.0, 0.0], [0.0, 1.0, 0.0], [0.0, 0.0, -1.0]],
            1 => [[1.0, 0.3, 0.0], [0.0, 0.5, 0.0], [0.2, 0.0, 1.0]],
            _ => [[0.9, 0.0, 0.0], [0.0, 0.9, 0.0], [0.0, 0.0, 0.9]],
        };
        let stretched = Affine::from_rows(rows, [0.0; 3]).unwrap();
        let call = Draw {
            model: stretched.then(&turned),
            cull: [Cull::Back, Cull::Back, Cull::None][case / 18 % 3],
            light: Light::new([0.3, 0.8, 0.6], 0.2),
            ..Draw::new(cut.whole())
        };
        let room = if case % 7 == 6 {
            cut.mesh.positions.len() - 1
        } else {
            VERTICES
        };
        let (whole, objects, want) = drawn(room, |scene| {
            scene.begin(&camera).unwrap();
            let _ = scene.draw(&call);
        });
        let (parts, kept, got) = drawn(room, |scene| {
            scene.begin(&camera).unwrap();
            let _ = scene.draw_meshlets(&call, &cut.meshlets());
        });
        assert_eq!(parts.triangles, whole.triangles);
        assert_eq!(
            parts.culled + parts.dropped,
            whole.culled + whole.dropped + (objects - kept) as u32
        );
        let is_whole = case / 3 % 6 < 2 || call.cull == Cull::None;
        let off = want
            .iter()
            .flatten()
            .zip(got.iter().flatten())
            .filter(|(a, b)| a != b)
            .count();
        // Faces that are turned round by rounding their corners may be left out.
        assert!(
            off == 0 && objects - kept <= 8,
            "case {case}: {off} pixels, {objects} {kept}"
        );
        lost += objects - kept;
        skipped += parts.triangles_skipped;
        beside += u32::from(is_whole && parts.triangles_skipped > 0);
    }
    println!("{skipped} faces skipped, {beside} meshes by spheres, {lost} faces of edges");
    assert!(skipped > 100_000 && beside > 15 && lost < 100);
}

/// Some faces of a table, from near and far, with room for the table and without, and one that is wrong.
///
/// Kills: vertices of the first half of the faces alone are moved.
#[test]
fn some_faces_of_a_large_table_are_a_mesh() {
    let mut rng = Rng::new(0x7AB_1E5);
    let mut drawn_faces = 0;
    for case in 0..120 {
        let mesh = [scenes::TEAPOT, scenes::SPHERE][case % 2];
        let Faces::Triangles(all) = mesh.faces else {
            panic!("triangles");
        };
        let from = rng.below(all.len() as u32 - 1) as usize;
        let many = 1 + rng.below((all.len() - from) as u32) as usize;
        let mut faces = all[from..(from + many).min(all.len())].to_vec();
        if case % 11 == 10 {
            faces.push([0, 1, mesh.positions.len() as u16]);
        }
        let eye = [0, 1, 2].map(|_| (rng.signed() * rng.pick(&[1.5, 4.0])) as f32);
        let Ok(camera) = Camera::look_at(eye, [0.0; 3], [0.1, 1.0, 0.2], 90.0, 0.2, 100.0) else {
            continue;
        };
        let call = Draw {
            shading: [Shading::Smooth, Shading::Flat][case / 2 % 2],
            cull: [Cull::Back, Cull::None][case / 4 % 2],
            light: Light::new([0.3, 0.8, 0.6], 0.2),
            ..Draw::new(Mesh {
                faces: Faces::Triangles(&faces),
                ..mesh
            })
        };
        let room = if case % 7 == 6 {
            mesh.positions.len() - 1
        } else {
            VERTICES
        };
        let mut told = [Ok(()); 2];
        let whole = drawn(room, |scene| {
            scene.begin(&camera).unwrap();
            told[0] = scene.draw(&call);
        });
        let partly = drawn(room, |scene| {
            scene.begin(&camera).unwrap();
            told[1] = scene.draw_partly(&call);
        });
        assert_eq!(told[0], told[1], "case {case}");
        assert!(whole == partly, "case {case}");
        drawn_faces += whole.1;
    }
    assert!(drawn_faces > 10_000, "{drawn_faces}");
}

/// Kills: a spread of a quarter.
#[test]
fn a_textured_mesh_in_parts_is_the_mesh() {
    let part = scenes::Suite::B.part(0);
    let cut = Cut::new(part.mesh);
    let call = Draw {
        texture: scenes::Suite::B.texture().map(|texture| Skin {
            texture,
            places: part.places,
            budget: Budget::BALANCED,
        }),
        ..part.draw()
    };
    let screen = scenes::Shot::screen();
    let drawn = |in_parts: bool| {
        let mut rooms = SceneRooms::new(VERTICES, OBJECTS, screen.height().into(), 4);
        let mut scene = rooms.scene::<scenes::TexturedLook>(screen);
        let camera = scenes::Suite::B.view().camera().unwrap();
        scene.begin(&camera).unwrap();
        let draw = Draw {
            mesh: cut.whole(),
            ..call
        };
        if in_parts {
            scene.draw_meshlets(&draw, &cut.meshlets()).unwrap();
            assert!(scene.assembled().triangles_skipped > 300);
        } else {
            scene.draw(&draw).unwrap();
        }
        frame(&scene, 64, true, 0)
    };
    assert!(drawn(true) == drawn(false));
}

/// Of parts by themselves, seen from everywhere: none is left out of which a face is seen, in f64, and of those of which
/// none is seen three quarters are. Kills: a cone that does not begin behind all faces; a spread of a quarter.
#[test]
fn a_part_is_left_out_only_where_all_of_its_faces_are_seen_from_behind() {
    let mut rng = Rng::new(0xC04E);
    let (mut out, mut could, mut looks) = (0, 0, 0);
    for cut in [Cut::new(scenes::TEAPOT), Cut::new(scenes::SPHERE)] {
        let (mut from, mut listed) = (0, 0);
        for part in &cut.parts {
            let faces = &cut.faces[from..from + usize::from(part.faces)];
            let list = &cut.vertices[listed..listed + usize::from(part.vertices)];
            (from, listed) = (from + faces.len(), listed + list.len());
            let alone = Meshlets::of(faces, core::slice::from_ref(part), list).unwrap();
            for _ in 0..60 {
                let away = rng.pick(&[1.5, 3.0, 40.0]);
                let eye = [0, 1, 2].map(|_| (rng.signed() * away) as f32);
                let up = [0.3, 1.0, 0.2];
                let Ok(camera) = Camera::look_at(eye, [0.0; 3], up, 60.0, 0.01, 100.0) else {
                    continue;
                };
                let (done, _, _) = drawn(VERTICES, |scene| {
                    scene.begin(&camera).unwrap();
                    scene.draw_meshlets(&Draw::new(cut.mesh), &alone).unwrap();
                });
                let point = eye.map(f64::from);
                let is_behind = faces.iter().all(|&face| cut.is_behind(face, point));
                let is_out = done.triangles_skipped > 0;
                assert!(is_behind || !is_out, "{part:?} from {eye:?}");
                looks += 1;
                could += u32::from(is_behind);
                out += u32::from(is_out);
            }
        }
    }
    println!("{out} of {could} parts left out, of {looks}");
    assert!(looks > 3000 && could > 800 && 4 * out > 3 * could);
}

/// What is wrong with parts is said, and nothing of them is drawn.
#[test]
fn parts_of_another_mesh_are_refused() {
    let cut = Cut::new(scenes::TEAPOT);
    let of = |faces, parts, vertices| Meshlets::of(faces, parts, vertices).err();
    let (faces, parts, vertices) = (&cut.faces[..], &cut.parts[..], &cut.vertices[..]);
    let wrong = Some(MeshError::Meshlets);
    assert_eq!(of(faces, parts, vertices), None);
    assert_eq!(of(&faces[..faces.len() - 1], parts, vertices), wrong);
    assert_eq!(of(faces, &parts[..parts.len() - 1], vertices), wrong);
    assert_eq!(of(faces, parts, &vertices[..vertices.len() - 1]), wrong);
    let more: Vec<u16> = vertices.iter().copied().chain([0]).collect();
    assert_eq!(of(faces, parts, &more), wrong);
    let mut other = vertices.to_vec();
    other[7] = vertices[8];
    assert_eq!(of(faces, parts, &other), wrong);
    let few = cut.mesh.positions.len() - 1;
    let mesh = Mesh {
        positions: &cut.mesh.positions[..few],
        normals: &cut.mesh.normals[..few],
        ..cut.mesh
    };
    let (o, z, y) = ([0.0; 3], [0.0, 0.0, 3.0], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(z, o, y, 60.0, 0.1, 10.0).unwrap();
    let (done, objects, _) = drawn(VERTICES, |scene| {
        let whole = Draw::new(cut.mesh);
        let not_begun = scene.draw_meshlets(&whole, &cut.meshlets());
        assert_eq!(not_begun, Err(DrawError::NotBegun));
        scene.begin(&camera).unwrap();
        let refused = scene.draw_meshlets(&Draw::new(mesh), &cut.meshlets());
        let wrong = DrawError::Mesh(MeshError::Meshlets);
        assert_eq!(refused, Err(wrong));
        assert_eq!(
            wrong.to_string(),
            "mesh: the parts are not those of its triangles and vertices"
        );
    });
    assert_eq!((done, objects), (Assembled::default(), 0));
}

/// Parts of any numbers are drawn, or left out, without a panic.
#[test]
fn parts_of_any_numbers_are_drawn() {
    let mut rng = Rng::new(0xA11);
    let mut cut = Cut::new(scenes::CUBE);
    let mut any = |values: &mut [i32]| {
        for value in values {
            let some = rng.within(-1_000_000_000, 1_000_000_000);
            *value = rng.pick(&[0, 1, -1, i32::MIN, i32::MAX, some]);
        }
    };
    for case in 0..2000 {
        for part in &mut cut.parts {
            let (mut axis, mut of) = ([0; 3], [0; 2]);
            any(&mut part.apex);
            any(&mut part.sphere.centre);
            any(&mut axis);
            any(&mut of);
            part.axis = axis.map(|c| (c >> 16) as i16);
            (part.spread, part.sphere.radius) = (of[0] as u16, of[1] as u32);
        }
        let eye = [[0.0, 0.0, 3.0], [0.2, 0.1, 1.1], [200.0, 90.0, 30.0]][case % 3];
        let camera = Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 60.0, 0.1, 1000.0).unwrap();
        let (done, _, _) = drawn(VERTICES, |scene| {
            scene.begin(&camera).unwrap();
            let call = Draw::new(cut.mesh);
            scene.draw_meshlets(&call, &cut.meshlets()).unwrap();
        });
        assert_eq!(done.triangles, 12);
    }
}

/// Memory may be as little as a mesh needs, and no less; parts are small, and errors say where.
#[test]
fn a_mesh_is_cut_where_memory_suffices() {
    let cut = Cut::new(scenes::SPHERE);
    let Faces::Triangles(faces) = scenes::SPHERE.faces else {
        panic!("triangles");
    };
    let positions = scenes::SPHERE.positions;
    let with = |faces: &[[u16; 3]], parts: usize, vertices: usize| {
        let mut faces = faces.to_vec();
        let (mut parts, mut vertices) = (vec![Meshlet::EMPTY; parts], vec![0; vertices]);
        let cut = Meshlets::cut(positions, &mut faces, &mut parts, &mut vertices);
        cut.map(|cut| cut.parts().len())
    };
    let (parts, listed) = (cut.parts.len(), cut.vertices.len());
    let is_small = |part: &Meshlet| part.vertices <= 64 && part.faces <= 126;
    assert!(cut.parts.iter().all(is_small));
    assert_eq!(with(faces, parts, listed), Ok(parts));
    let have = parts - 1;
    assert_eq!(with(faces, have, listed), Err(CutError::Parts { have }));
    let have = listed - 1;
    assert_eq!(with(faces, parts, have), Err(CutError::Vertices { have }));
    let mut wrong = faces.to_vec();
    wrong[9][1] = positions.len() as u16;
    let refused = with(&wrong, parts, listed);
    assert_eq!(refused, Err(CutError::Index { face: 9 }));
    assert_eq!(with(&[], 0, 0), Ok(0));
    let said = [
        CutError::Index { face: 9 },
        CutError::Parts { have: 3 },
        CutError::Vertices { have: 5 },
    ]
    .map(|error| error.to_string());
    assert_eq!(
        said,
        [
            "mesh: face 9 names a vertex that is not there",
            "mesh: more parts than the 3 there is room for",
            "mesh: more vertices of parts than the 5 there is room for",
        ]
    );
}
