//! A sphere of as many triangles as are asked for, made where it is drawn.

use crate::{Shot, ShotError};
use scanbeam::look::Look;
use scanbeam::{Affine, Camera, Draw, Faces, Light, Mesh, Scene};

/// Parts of an edge of the spheres that growth is measured on: 72 to 20,000 triangles.
pub const OCTASPHERES: [u16; 10] = [3, 4, 5, 7, 10, 14, 20, 28, 37, 50];

/// One in Q1.14.
const ONE: i32 = 1 << 14;

/// An octahedron whose edges are cut into `parts`, so that each side becomes `parts`² triangles, and
/// whose vertices lie on a sphere of radius 1.0: triangles of much the same size, none without an
/// area. By whole numbers alone, so it is the same everywhere.
pub struct Octasphere<'m> {
    positions: &'m [[i16; 3]],
    faces: &'m [[u16; 3]],
}

impl<'m> Octasphere<'m> {
    /// Vertices of the largest of [`OCTASPHERES`].
    pub const MOST_VERTICES: usize = Self::vertices_of(50);
    /// Triangles of the largest of [`OCTASPHERES`].
    pub const MOST_FACES: usize = Self::faces_of(50);

    /// Vertices, each of the eight sides with its own.
    const fn vertices_of(parts: usize) -> usize {
        8 * ((parts + 1) * (parts + 2) / 2)
    }

    const fn faces_of(parts: usize) -> usize {
        8 * parts * parts
    }

    /// Makes the sphere in the memory lent; `None` when that is too small for it.
    pub fn new(
        parts: u16,
        positions: &'m mut [[i16; 3]],
        faces: &'m mut [[u16; 3]],
    ) -> Option<Self> {
        let n = usize::from(parts);
        let positions = positions.get_mut(..Self::vertices_of(n))?;
        let faces = faces.get_mut(..Self::faces_of(n))?;
        let (mut vertex, mut face) = (0, 0);
        for side in 0..8 {
            let sign = |bit: u16| if side >> bit & 1 == 1 { -1 } else { 1 };
            let signs = [sign(0), sign(1), sign(2)];
            // An odd number of mirrors turns the corners round.
            let mirrored = signs.iter().product::<i32>() < 0;
            for row in 0..=parts {
                for column in 0..=row {
                    let at = [parts - row, row - column, column].map(i32::from);
                    positions[vertex] = on_sphere(at, signs);
                    if row < parts {
                        // Below it are `down` and `down + 1`.
                        let (here, down) = (vertex as u16, vertex as u16 + row + 1);
                        for corners in [[here, down, down + 1], [here, down + 1, here + 1]] {
                            if corners[2] == here + 1 && column == row {
                                continue;
                            }
                            let [a, b, c] = corners;
                            faces[face] = if mirrored { [a, c, b] } else { [a, b, c] };
                            face += 1;
                        }
                    }
                    vertex += 1;
                }
            }
        }
        Some(Self { positions, faces })
    }

    /// How many triangles it has.
    #[must_use]
    pub fn triangles(&self) -> usize {
        self.faces.len()
    }

    /// The mesh; the normals of a unit sphere are its positions.
    #[must_use]
    pub fn mesh(&self) -> Mesh<'_> {
        Mesh {
            positions: self.positions,
            normals: self.positions,
            colours: &[],
            faces: Faces::Triangles(self.faces),
        }
    }

    /// Draws it into `scene`, where scene A has its sphere, and turned so that no edge is level.
    ///
    /// # Errors
    /// When the scene's arenas are too small.
    pub fn draw<L: Look>(&self, scene: &mut Scene<'_, '_, L>) -> Result<(), ShotError> {
        let (eye, up) = ([0.0, 0.0, 3.94], [0.0, 1.0, 0.0]);
        scene.begin(&Camera::look_at(eye, [0.0; 3], up, 320.0, 0.1, 100.0)?)?;
        scene.draw(&Draw {
            model: Affine::rotation_y(0.4).then(&Affine::rotation_x(0.3)),
            light: Light::new([0.5, 0.7, 0.8], 0.15),
            ..Draw::new(self.mesh())
        })?;
        Ok(())
    }

    /// The size of the picture.
    #[must_use]
    pub fn screen() -> scanbeam::Screen {
        Shot::screen()
    }
}

/// The place of radius 1.0 in the direction of `at`, rounded towards zero.
fn on_sphere(at: [i32; 3], signs: [i32; 3]) -> [i16; 3] {
    let square: i32 = at.iter().map(|c| c * c).sum();
    // With 16 bits of fraction.
    let length = (u64::from(square.unsigned_abs()) << 32).isqrt() as i64;
    [0, 1, 2].map(|i| (i64::from(signs[i] * at[i] * ONE) * (1 << 16) / length) as i16)
}
