//! Texture places from normals: surroundings that a surface reflects.
//!
//! A sphere map is a picture of the surroundings as a ball shows them from afar. Where a vertex looks to the side by
//! the components x and y of its normal, as the camera sees it, it shows the texel that lies so far to the side and up
//! from the middle of the map: two scalar products of 16-bit numbers, 40 instructions a vertex on a Cortex-M4.
//!
//! A place is within 1/8,000 of the map's side of that of the exact normal, 1/256 texel by rounding besides, where the
//! model is turned, moved and scaled as a whole. As any, places are linear between vertices. What the eye's nearness
//! does to a reflection is left out, so a flat side with one normal has one texel.

use super::project::{View, project_textured};
use super::{Texture, TexturePlace, Vertex};
use crate::geometry::{Affine, Coordinate};

/// How a draw call makes texture places of its vertices.
#[derive(Clone, Copy, Debug)]
pub struct TexGen(pub(super) Rule);

/// What makes places of the normals of a mesh that is turned like this to the camera.
type Rule = for<'a> fn(&'a [[i16; 3]], &Affine, &Texture<'_>) -> Generated<'a>;

impl TexGen {
    /// By their normals, which the mesh must have: its texture is a sphere map, whose rim is never passed.
    pub const SPHERE: Self = Self(sphere);
}

/// Normals of a mesh, and how places are made of them.
pub struct Generated<'a> {
    normals: &'a [[i16; 3]],
    /// Rows of the turn from the model to the camera, to the right and down, in Q1.14.
    rows: [[i32; 3]; 2],
    /// Half of each side less a texel, in texels with 7 fraction bits.
    reach: [i32; 2],
    /// The middle, in texels with 8 fraction bits.
    middle: [i32; 2],
    /// Makes places of vertices from one on, as many as there are or fit.
    fill: fn(&Self, usize, &mut [[i32; 2]]),
}

/// The rule of a sphere map.
fn sphere<'a>(normals: &'a [[i16; 3]], turn: &Affine, texture: &Texture<'_>) -> Generated<'a> {
    let sides = [texture.width(), texture.height()].map(|side| side as i32);
    Generated {
        normals,
        rows: turn.rows_q14(),
        reach: sides.map(|side| (side - 1) << 6),
        middle: sides.map(|side| side << 7),
        fill: sphere_places,
    }
}

fn sphere_places(by: &Generated<'_>, from: usize, places: &mut [[i32; 2]]) {
    let normals = by.normals.get(from..).unwrap_or_default();
    for (place, &normal) in places.iter_mut().zip(normals) {
        *place = sphere_place(by, normal);
    }
}

fn sphere_place(by: &Generated<'_>, normal: [i16; 3]) -> [i32; 2] {
    let [x, y, z] = normal.map(i32::from);
    let across = |i: usize| {
        let [a, b, c] = by.rows[i];
        // Below 2^29 for unit normals, and below 2^31 for any.
        let sum = (a * x).wrapping_add(b * y).wrapping_add(c * z);
        let side = sum.wrapping_add(1 << 13) >> 14;
        let way = side.wrapping_mul(by.reach[i]);
        by.middle[i] + (way.wrapping_add(1 << 12) >> 13)
    };
    [across(0), across(1)]
}

impl Generated<'_> {
    /// The place of a vertex.
    pub(super) fn texel(&self, i: usize) -> [i32; 2] {
        let mut place = [[0; 2]];
        (self.fill)(self, i, &mut place);
        place[0]
    }
}

/// [`project_textured`] with places that are made, some of them at a time.
pub(super) fn project_generated<C: Coordinate>(
    generated: &Generated<'_>,
    view: &View,
    positions: &[[C; 3]],
    vertices: &mut [Vertex],
    places: &mut [TexturePlace],
) -> bool {
    const SOME: usize = 16;
    let (mut texels, mut all) = ([[0; 2]; SOME], true);
    for (from, vertices) in (0..).step_by(SOME).zip(vertices.chunks_mut(SOME)) {
        (generated.fill)(generated, from, &mut texels);
        let positions = positions.get(from..).unwrap_or_default();
        let places = places.get_mut(from..).unwrap_or_default();
        all &= project_textured(view, positions, &texels, vertices, places);
    }
    all
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::geometry::Camera;
    use crate::num::random::Rng;

    /// A unit vector of the model, and what it stands for.
    fn some_normal(rng: &mut Rng) -> ([i16; 3], [f64; 3]) {
        loop {
            let v = [(); 3].map(|()| f64::from(rng.signed()));
            let length = v.iter().map(|c| c * c).sum::<f64>().sqrt();
            if (0.2..1.0).contains(&length) {
                let unit = v.map(|c| (c / length * 16_384.0).round());
                return (unit.map(|c| c as i16), unit.map(|c| c / 16_384.0));
            }
        }
    }

    #[test]
    fn places_are_those_of_normals_in_f64() {
        static TEXELS: [u16; 1 << 20] = [0; 1 << 20];
        let mut rng = Rng(77);
        let mut worst = [0f64; 2];
        for round in 0..400 {
            let (a, b) = (3.0 * rng.signed(), 3.0 * rng.signed());
            let scale = [0.01, 1.0, 300.0][round % 3];
            let placed = Affine::placed(scale, [1.0, 2.0, 3.0]).unwrap();
            let model = Affine::rotation_x(a)
                .then(&Affine::rotation_y(b))
                .then(&placed);
            let eye = [0.0, 1.0, 5.0];
            let camera = Camera::look_at(eye, [0.3, 0.2, 0.0], [0.0, 1.0, 0.0], 100.0, 0.1, 900.0);
            let turn = model.then(&camera.unwrap().view);
            // Turns of the crate itself are looked at elsewhere.
            let rows = turn
                .rows_q14()
                .map(|row| row.map(|c| f64::from(c) / 16_384.0));
            let side = [8, 64, 128, 1024][round % 4];
            let texture = Texture::words(&TEXELS, side, side).unwrap();
            let by = (TexGen::SPHERE.0)(&[], &turn, &texture);
            for _ in 0..50 {
                let (normal, exact) = some_normal(&mut rng);
                let place = sphere_place(&by, normal).map(|c| f64::from(c) / 256.0);
                for i in 0..2 {
                    let across: f64 = (0..3).map(|k| rows[i][k] * exact[k]).sum();
                    let side = f64::from(side);
                    let want = side / 2.0 + across * (side - 1.0) / 2.0;
                    worst[0] = worst[0].max((place[i] - want).abs() - 1.0 / 256.0);
                    worst[1] = worst[1].max((place[i] - want).abs() / side);
                    assert!((0.4..side - 0.4).contains(&place[i]), "{place:?} of {side}");
                }
            }
            let squares = |row: [f64; 3]| row.iter().map(|c| c * c).sum::<f64>();
            for row in rows {
                assert!((squares(row) - 1.0).abs() < 2e-4, "{row:?}");
            }
        }
        std::println!("{worst:?}");
        assert!(worst[0] < 1024.0 / 60_000.0, "{worst:?}");
    }

    #[test]
    fn what_looks_to_the_right_and_up_is_right_and_above_the_middle() {
        static TEXELS: [u16; 64 * 32] = [0; 64 * 32];
        let (eye, up) = ([0.0, 0.0, 5.0], [0.0, 1.0, 0.0]);
        let camera = Camera::look_at(eye, [0.0; 3], up, 100.0, 0.1, 100.0).unwrap();
        let texture = Texture::words(&TEXELS, 64, 32).unwrap();
        let by = (TexGen::SPHERE.0)(&[], &camera.view, &texture);
        const ONE: i16 = 1 << 14;
        let place = |normal| sphere_place(&by, normal).map(|c| f64::from(c) / 256.0);
        assert_eq!(place([0, 0, ONE]), [32.0, 16.0]);
        assert_eq!(place([ONE, 0, 0]), [63.5, 16.0]);
        assert_eq!(place([0, ONE, 0]), [32.0, 0.5]);
        assert_eq!(place([-ONE, 0, 0]), [0.5, 16.0]);
        // Where there is no turn all is in the middle.
        let flat = Affine::from_rows([[0.0; 3]; 3], [0.0; 3]).unwrap();
        let by = (TexGen::SPHERE.0)(&[], &flat, &texture);
        assert_eq!(sphere_place(&by, [ONE, ONE, 0]), [32 << 8, 16 << 8]);
    }
}
