//! The spheres that growth is measured on are closed, look outwards and have the triangles that
//! they say.

use scenes::{OCTASPHERES, Octasphere};
use std::collections::BTreeMap;

#[test]
fn octaspheres_are_closed_and_look_outwards() {
    let mut positions = vec![[0; 3]; Octasphere::MOST_VERTICES];
    let mut faces = vec![[0; 3]; Octasphere::MOST_FACES];
    for parts in OCTASPHERES {
        let sphere = Octasphere::new(parts, &mut positions, &mut faces).unwrap();
        assert_eq!(sphere.triangles(), 8 * usize::from(parts).pow(2));
        let mesh = sphere.mesh();
        for p in mesh.positions {
            let length = p.iter().map(|c| f64::from(*c).powi(2)).sum::<f64>().sqrt();
            assert!((length - 16_384.0).abs() < 2.0, "{parts}: {p:?}");
        }
        let scanbeam::Faces::Triangles(faces) = mesh.faces else {
            panic!("triangles");
        };
        let mut edges: BTreeMap<[[i16; 3]; 2], i32> = BTreeMap::new();
        for face in faces {
            let [a, b, c] = face.map(|v| mesh.positions[usize::from(v)]);
            for (from, to) in [(a, b), (b, c), (c, a)] {
                assert_ne!(from, to);
                // Each way once, so the two ways cancel.
                *edges.entry([from.min(to), from.max(to)]).or_default() +=
                    if from < to { 1 } else { -1 };
            }
            let [a, b, c] = [a, b, c].map(|p| p.map(f64::from));
            let (u, v) = (
                [0, 1, 2].map(|i| b[i] - a[i]),
                [0, 1, 2].map(|i| c[i] - a[i]),
            );
            let cross = [
                u[1] * v[2] - u[2] * v[1],
                u[2] * v[0] - u[0] * v[2],
                u[0] * v[1] - u[1] * v[0],
            ];
            let outwards: f64 = (0..3).map(|i| cross[i] * a[i]).sum();
            assert!(outwards > 0.0, "{parts}: {face:?}");
        }
        assert!(edges.values().all(|sum| *sum == 0), "{parts}");
    }
}

#[test]
fn too_little_memory_is_refused() {
    let (mut positions, mut faces) = ([[0; 3]; 80], [[0; 3]; 71]);
    assert!(Octasphere::new(3, &mut positions, &mut faces).is_none());
    let mut faces = [[0; 3]; 72];
    assert!(Octasphere::new(3, &mut positions, &mut faces).is_some());
    assert!(Octasphere::new(4, &mut positions, &mut faces).is_none());
}
