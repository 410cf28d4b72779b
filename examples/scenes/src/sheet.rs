//! A random sheet of triangles over the whole picture, for the proof that no pixel is missed and
//! none is hit twice (K4).

use crate::{HEIGHT, Shot, WIDTH};
use scanbeam::pipeline::{Counted, FlatPainter, Instance, LineRenderer, Scene};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::{Camera, Cull, Faces, Mesh};

/// Cells across and down.
const CELLS: [usize; 2] = [24, 18];
/// Vertices of a sheet.
const VERTICES: usize = (CELLS[0] + 1) * (CELLS[1] + 1);
/// Triangles of a sheet.
pub const SHEET_TRIANGLES: usize = 2 * CELLS[0] * CELLS[1];
/// Sheets that are tried, by seed from 1 on.
pub const SHEETS: u32 = 16;

/// What a sheet is drawn with: no depth, so that every hit is drawn, and hits are counted.
pub type SheetPipeline = Counted<FlatPainter<Rgb565Be>>;

/// A grid that reaches beyond the picture, its inner vertices moved at random by up to a fifth of
/// a cell (below a quarter every cell stays convex), split along random diagonals.
pub struct Sheet {
    positions: [[i16; 3]; VERTICES],
    faces: [[u16; 3]; SHEET_TRIANGLES],
}

impl Sheet {
    /// The sheet of a seed.
    #[must_use]
    pub fn new(seed: u32) -> Self {
        let mut state = seed;
        let mut below = |n: i32| {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            ((i64::from(state >> 8) * i64::from(n)) >> 24) as i32
        };
        let mut sheet = Self {
            positions: [[0, 0, -16_384]; VERTICES],
            faces: [[0; 3]; SHEET_TRIANGLES],
        };
        let [across, down] = CELLS;
        // 1.25 and 1.0 each way: 200 and 160 pixels at the camera's focal length.
        let (cell_x, cell_y) = (40_960 / across as i32, 32_768 / down as i32);
        for (i, p) in sheet.positions.iter_mut().enumerate() {
            let (x, y) = (i % (across + 1), i / (across + 1));
            let inner = x > 0 && x < across && y > 0 && y < down;
            let mut moved = |cell: i32| {
                if inner {
                    below(2 * cell / 5) - cell / 5
                } else {
                    0
                }
            };
            p[0] = (x as i32 * cell_x - 20_480 + moved(cell_x)) as i16;
            p[1] = (y as i32 * cell_y - 16_384 + moved(cell_y)) as i16;
        }
        for (i, pair) in sheet.faces.chunks_exact_mut(2).enumerate() {
            let a = (i / across * (across + 1) + i % across) as u16;
            let (b, c, d) = (a + 1, a + across as u16 + 2, a + across as u16 + 1);
            if below(2) == 0 {
                pair.copy_from_slice(&[[a, b, c], [a, c, d]]);
            } else {
                pair.copy_from_slice(&[[a, b, d], [b, c, d]]);
            }
        }
        sheet
    }

    /// Draws the sheet: how many pixels were drawn, hits counted, and how many were left out.
    ///
    /// `None` when the memory of scene or renderer is too small.
    pub fn hits(
        &self,
        scene: &mut Scene<'_, SheetPipeline>,
        renderer: &mut LineRenderer<'_, SheetPipeline>,
    ) -> Option<(u32, u32)> {
        let camera = Camera::look_at([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 160.0, 0.1, 9.0);
        scene.begin(&camera.ok()?).ok()?;
        let mesh = Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&self.faces),
        };
        let instance = Instance {
            cull: Cull::None,
            ..Instance::default()
        };
        scene.draw(&mesh, &instance).ok()?;
        renderer.restart();
        let empty = Rgb565Be::from_rgb8([0; 3]);
        let mut missed = 0;
        for line in 0..HEIGHT {
            let mut pixels = [empty; WIDTH as usize];
            renderer.draw_line(scene, line, &mut pixels).ok()?;
            missed += pixels.iter().filter(|p| **p == empty).count() as u32;
        }
        Some((renderer.take_span_counts().pixels_shaded, missed))
    }

    /// How many pixels there are to hit.
    #[must_use]
    pub fn pixels() -> u32 {
        u32::from(Shot::screen().width()) * u32::from(Shot::screen().height())
    }
}
