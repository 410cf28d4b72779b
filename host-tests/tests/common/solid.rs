//! Vectors in f64, and the ball that light and shadows fall on.

use std::collections::HashMap;

pub type V = [f64; 3];

pub fn sub(a: V, b: V) -> V {
    [a[0] - b[0], a[1] - b[1], a[2] - b[2]]
}

/// `a` and `t` times `d`.
pub fn along(a: V, d: V, t: f64) -> V {
    [0, 1, 2].map(|i| a[i] + d[i] * t)
}

pub fn dot(a: V, b: V) -> f64 {
    a[0] * b[0] + a[1] * b[1] + a[2] * b[2]
}

pub fn cross(a: V, b: V) -> V {
    [
        a[1] * b[2] - a[2] * b[1],
        a[2] * b[0] - a[0] * b[2],
        a[0] * b[1] - a[1] * b[0],
    ]
}

/// The same way, of length 1.
pub fn unit(a: V) -> V {
    a.map(|c| c / dot(a, a).sqrt())
}

/// An octahedron whose faces are divided into four, `n` times: a closed mesh of corners on the unit
/// sphere, each there once.
pub fn octahedron(n: u32) -> (Vec<V>, Vec<[u16; 3]>) {
    let mut points: Vec<V> = vec![
        [1., 0., 0.],
        [-1., 0., 0.],
        [0., 1., 0.],
        [0., -1., 0.],
        [0., 0., 1.],
        [0., 0., -1.],
    ];
    let mut faces: Vec<[u16; 3]> = vec![
        [0, 2, 4],
        [2, 1, 4],
        [1, 3, 4],
        [3, 0, 4],
        [2, 0, 5],
        [1, 2, 5],
        [3, 1, 5],
        [0, 3, 5],
    ];
    for _ in 0..n {
        let mut middle = HashMap::new();
        let mut finer = Vec::new();
        for [a, b, c] in faces {
            let mut half = |a: u16, b: u16| {
                *middle.entry((a.min(b), a.max(b))).or_insert_with(|| {
                    let (p, q) = (points[usize::from(a)], points[usize::from(b)]);
                    points.push(unit(along(p, q, 1.0)));
                    points.len() as u16 - 1
                })
            };
            let [ab, bc, ca] = [half(a, b), half(b, c), half(c, a)];
            finer.extend([[a, ab, ca], [ab, b, bc], [ca, bc, c], [ab, bc, ca]]);
        }
        faces = finer;
    }
    (points, faces)
}
