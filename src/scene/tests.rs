//! What pass one leaves of vertices, and what it refuses.

use super::{Assembled, Draw, DrawError, DrawState, Memory, Moved, NONE, Object, Scene, Vertex};
use crate::geometry::{Affine, Camera, Cull, Faces, Light, Mesh, MeshError, Scale, Screen};

/// Two triangles side by side, one that reaches far beyond the guard band, and one seen from behind.
const POSITIONS: [[i16; 3]; 7] = [
    [-8_000, -8_000, 0],
    [8_000, -8_000, 0],
    [0, 8_000, 0],
    [16_000, 8_000, 0],
    [-32_768, 0, 32_767],
    [-8_000, 9_000, 0],
    [-9_000, 9_000, 0],
];
const NORMALS: [[i16; 3]; 7] = [[0, 0, 16_384]; 7];

/// What is left of a draw call of these faces.
fn drawn(faces: &[[u16; 3]]) -> (Result<(), DrawError>, [Vertex; 24], Assembled) {
    let (mut vertices, mut objects) = ([Vertex::EMPTY; 24], [Object::EMPTY; 24]);
    let (mut bins, mut draws) = ([NONE; 240], [DrawState::EMPTY; 1]);
    let screen = Screen::new(320, 240).unwrap();
    let memory = Memory {
        vertices: &mut vertices,
        places: &mut [],
        objects: &mut objects,
        bins: &mut bins,
        draws: &mut draws,
    };
    let mut scene = Scene::<()>::with_scale(screen, memory, Scale::new([31, 63, 31]));
    let (eye, up) = ([0.0, 0.0, 2.5], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(eye, [0.0; 3], up, 900.0, 0.1, 100.0).unwrap();
    scene.begin(&camera).unwrap();
    let done = scene.assemble(
        &Draw {
            model: Affine::IDENTITY,
            cull: Cull::Back,
            light: Light::new([0.0, 0.0, 1.0], 0.25),
            ..Draw::new(Mesh {
                positions: &POSITIONS,
                normals: &NORMALS,
                colours: &[],
                faces: Faces::Triangles(faces),
            })
        },
        Moved::All,
        false,
        None,
    );
    let assembled = scene.assembled();
    let is_kept = done.is_ok() && assembled.culled < faces.len() as u32;
    assert_eq!(scene.objects() > 0, is_kept);
    assert_eq!(scene.vertices() > 0, is_kept);
    (done, vertices, assembled)
}

#[test]
fn vertices_are_lit_where_a_triangle_is_kept_that_has_them() {
    // The second is seen from behind.
    let (done, vertices, assembled) = drawn(&[[0, 1, 2], [2, 6, 5]]);
    assert_eq!((done, assembled.culled), (Ok(()), 1));
    let lit = vertices[0].colour;
    assert!(lit > 1, "{lit:#x}");
    for (i, vertex) in vertices.iter().enumerate().take(7) {
        let want = if i < 3 { lit } else { 0 };
        assert_eq!(vertex.colour, want, "{i}");
    }
}

#[test]
fn an_index_beyond_the_mesh_is_an_error_also_behind_a_face_that_was_cut() {
    let (done, _, assembled) = drawn(&[[0, 1, 2], [0, 2, 4]]);
    assert_eq!((done, assembled.clipped), (Ok(()), 1));
    let (done, _, _) = drawn(&[[0, 1, 2], [0, 2, 4], [0, 1, 7]]);
    let index = MeshError::Index { face: 2 };
    assert_eq!(done, Err(DrawError::Mesh(index)));
}

/// Kills: vertices of a mesh that stay where none of its faces is seen.
#[test]
fn a_mesh_that_is_not_seen_leaves_no_vertices() {
    let (done, _, assembled) = drawn(&[[2, 6, 5]]);
    assert_eq!((done, assembled.culled), (Ok(()), 1));
}
