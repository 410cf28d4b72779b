//! What is made on the screen itself: triangles of vertices that were set up beforehand, and points (H11).
//!
//! Each triangle has vertices of its own. A point of one pixel is one triangle: corners 12 units of 1/8 pixel apart hold
//! the centre of that pixel and no other.

use super::check::check_alphas;
use super::pass::{Own, Pass};
use super::project::{OnScreen, Point};
use super::{Draw, DrawError, ORIGIN, Scene, Shading, TexturePlace, Vertex, WordOfNormal};
use crate::geometry::{Colour, Coordinate, Cull, Faces, Mesh};
use crate::num::mul_high_unsigned;

/// How far places may lie from the picture's middle, in 13.3: what the guard band has.
const REACH: i32 = 8 * 2047;

/// A vertex that was set up beforehand.
#[derive(Clone, Copy, Debug, PartialEq, Eq, Default)]
pub struct ScreenVertex {
    /// Column in 13.3 from the picture's left rim. What lies farther out than guard space, 4,080
    /// pixels from the picture's middle, is moved to its rim.
    pub x: i16,
    /// Line in 13.3 from the picture's top, likewise.
    pub y: i16,
    /// 1/w, the near plane at 2^31; 2^15 at least and 2^31 - 2^15 at most are kept.
    pub depth: u32,
    /// Colour, 0 to 255 a channel, red first.
    pub colour: [u8; 3],
}

/// A corner of a triangle that was set up beforehand, for [`Scene::draw_screen`].
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct ScreenCorner {
    /// Where it is on the screen. What lies farther out than 2,047 pixels from the picture's middle is moved to there.
    pub vertex: ScreenVertex,
    /// The place on the texture, in texels with 8 fraction bits.
    pub texel: [i32; 2],
}

/// Refuses what would bound a shadow volume, and alphas that are not as many as vertices.
fn check_flat<C>(draw: &Draw<'_, '_, C>, vertices: usize) -> Result<(), DrawError> {
    if draw.is_volume() {
        return Err(DrawError::ShadowFlat);
    }
    check_alphas(draw.alphas, vertices)
}

impl<'t, L> Scene<'_, 't, L> {
    /// Draws triangles by their corners on the screen, with the texture of a call, if its look has any, and without its
    /// mesh, light and texture places.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw).
    pub(crate) fn assemble_screen(
        &mut self,
        draw: &Draw<'_, 't>,
        faces: &[[ScreenCorner; 3]],
        textured: bool,
    ) -> Result<(), DrawError> {
        check_flat(draw, 3 * faces.len())?;
        let is_flat = draw.shading == Shading::Flat;
        let mut draw = *draw;
        (draw.light, draw.lights, draw.texgen) = (None, None, None);
        draw.mesh = Mesh::EMPTY;
        if let Some(skin) = &mut draw.texture {
            skin.places = &[];
        }
        let is_plain = self.is_plain(&draw);
        let middle = [self.screen.width(), self.screen.height()].map(|s| 4 * i32::from(s));
        self.assemble_by(&draw, textured, None, faces.len() as u32, |scene, pass| {
            let (x, y, z) = (0, 0, pass.view.near);
            let near = pass.view.project_finer(Point { x, y, z }, 0).depth;
            let plain = pass.one.filter(|_| is_plain);
            for (number, corners) in (0..).zip(faces) {
                let mut number_of_corner = 3 * number as usize..;
                let own = corners.map(|ScreenCorner { vertex, texel }| {
                    let from = if is_flat { corners[0].vertex } else { vertex };
                    let at = |v: i16, axis: usize| {
                        let v = i32::from(v).clamp(middle[axis] - REACH, middle[axis] + REACH);
                        (v + 8 * ORIGIN) as u32
                    };
                    let (x, y) = (at(vertex.x, 0), at(vertex.y, 1));
                    // 1/w of a list is 2^31 at the near plane.
                    let depth = mul_high_unsigned(vertex.depth, near) << 1;
                    let texel = texel.map(|t| t << TexturePlace::FINER);
                    let own = || Colour::from_rgb8(from.colour, &pass.scale).word();
                    let colour = plain.unwrap_or_else(own);
                    Own {
                        vertex: Vertex::new(y << 16 | x, depth.clamp(1, (1 << 31) - 1), colour),
                        place: TexturePlace::new(texel, [0; 2]),
                        alpha: pass.alpha(number_of_corner.next().unwrap_or_default()),
                    }
                });
                scene.file_whole(number, &own, pass);
            }
            Ok(())
        })
    }

    /// Draws the vertices of a mesh as squares of so many pixels each way; its faces do not count.
    ///
    /// # Errors
    /// As [`draw`](Scene::draw).
    pub(crate) fn assemble_points<C: Coordinate>(
        &mut self,
        draw: &Draw<'_, 't, C>,
        size: u8,
        textured: bool,
        word_of: Option<WordOfNormal>,
    ) -> Result<(), DrawError> {
        check_flat(draw, draw.mesh.positions.len())?;
        let (mut draw, mesh) = (*draw, &draw.mesh);
        draw.mesh.faces = Faces::Triangles(&[]);
        draw.cull = Cull::None;
        let faces: &[[usize; 3]] = match size {
            0 => &[],
            1 => &[[0, 1, 2]],
            _ => &[[0, 1, 3], [1, 2, 3]],
        };
        let submitted = (mesh.positions.len() * faces.len()) as u32;
        self.assemble_by(&draw, textured, word_of, submitted, |scene, pass| {
            for (i, &position) in mesh.positions.iter().enumerate() {
                let point = pass.view.point(position);
                if pass.view.beyond(point) != 0 {
                    pass.culled += faces.len() as u32;
                    continue;
                }
                let on = pass.view.project(point);
                let lit = || pass.colour_of(mesh, i);
                let colour = pass.one.unwrap_or_else(lit);
                let texel = TexturePlace::new(pass.texel(i), [0; 2]);
                for face in faces {
                    let own = face.map(|corner| Own {
                        vertex: Vertex::new(corner_of(&on, size, corner), on.depth, colour),
                        place: texel,
                        alpha: pass.alpha(i),
                    });
                    scene.file_whole(i as u32, &own, pass);
                }
            }
            Ok(())
        })
    }

    /// Files a triangle of a face, and counts it.
    #[inline(always)]
    pub(super) fn file_whole(&mut self, face: u32, own: &[Own; 3], pass: &mut Pass<'_>) {
        let before = self.objects.len();
        let filed = self.file_own(own, pass);
        pass.count_face(face, filed, self.objects.len() == before);
    }
}

/// The place of a corner of a point, from the upper left one against the clock: of the square of whole pixels whose middle
/// is nearest, or of a triangle around the centre of one pixel.
fn corner_of(on: &OnScreen, size: u8, corner: usize) -> u32 {
    let side = 8 * i32::from(size);
    let far = if size == 1 { 12 } else { side };
    let [x, y] = [on.place & 0xFFFF, on.place >> 16].map(|at| {
        let first = (at as i32 - (side >> 1) + 4) & !7;
        // Points lie within the guard band, and so do their corners, moved to its rim.
        [first, first + far].map(|at| at.clamp(0, 0xFFF8) as u32)
    });
    let down = matches!((size, corner), (1, 1) | (2.., 1 | 2));
    let right = matches!((size, corner), (1, 2) | (2.., 2 | 3));
    y[usize::from(down)] << 16 | x[usize::from(right)]
}
