//! A random sheet of triangles over the whole picture, for the proof that no pixel is missed and
//! none is hit twice (K4).

use crate::{HEIGHT, Shot, ShotError, SmoothLook, WIDTH};
use scanbeam::frame::LineError;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::Blend;
use scanbeam::{Camera, Cull, Draw, Faces, Mesh, Renderer, Scene};

/// Cells across and down.
const CELLS: [usize; 2] = [24, 18];
/// Vertices of a sheet.
const VERTICES: usize = (CELLS[0] + 1) * (CELLS[1] + 1);
/// Triangles of a sheet.
pub const SHEET_TRIANGLES: usize = 2 * CELLS[0] * CELLS[1];
/// Sheets that are tried, by seed from 1 on.
pub const SHEETS: u32 = 16;

/// Levels of 5 bits that a triangle adds to each pixel that it hits.
const LEVEL: u8 = 8;

/// What a sheet did to the picture.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Hits {
    /// How often pixels were hit, in all.
    pub hits: u32,
    /// Pixels that were not hit.
    pub missed: u32,
    /// Pixels that were not drawn where the sheet hides what is behind it.
    pub left_out: u32,
}

/// Why hits were not counted.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum SheetError {
    /// The memory of the scene is too small.
    Scene(ShotError),
    /// That of the renderer is.
    Line(LineError),
}

impl From<ShotError> for SheetError {
    fn from(error: ShotError) -> Self {
        Self::Scene(error)
    }
}

impl From<LineError> for SheetError {
    fn from(error: LineError) -> Self {
        Self::Line(error)
    }
}

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

    /// Draws the sheet twice: as a light that each triangle adds to what it hits, so that a pixel's level says how often
    /// that was, and as a surface that hides what is behind it.
    ///
    /// # Errors
    /// When the memory of scene or renderer is too small.
    pub fn hits(
        &self,
        scene: &mut Scene<'_, '_, SmoothLook>,
        renderer: &mut Renderer<'_, SmoothLook>,
    ) -> Result<Hits, SheetError> {
        let mut hits = Hits::default();
        self.draw(Some(Blend::add(255)), scene, renderer, |pixel| {
            let [red, _, _] = Rgb565Be::to_rgb8(pixel);
            let times = u32::from(red / LEVEL);
            hits.hits += times;
            hits.missed += u32::from(times == 0);
        })?;
        self.draw(None, scene, renderer, |pixel| {
            hits.left_out += u32::from(pixel == 0);
        })?;
        Ok(hits)
    }

    /// Hands all pixels of the sheet, blended so, to `look`.
    fn draw(
        &self,
        blend: Option<Blend>,
        scene: &mut Scene<'_, '_, SmoothLook>,
        renderer: &mut Renderer<'_, SmoothLook>,
        mut look: impl FnMut(u16),
    ) -> Result<(), SheetError> {
        let camera = Camera::look_at([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 160.0, 0.1, 9.0);
        let camera = camera.map_err(ShotError::Camera)?;
        scene.begin(&camera).map_err(ShotError::Begin)?;
        let mesh = Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&self.faces),
        };
        let call = Draw {
            cull: Cull::None,
            colour: [LEVEL; 3],
            blend,
            ..Draw::new(mesh)
        };
        scene.draw(&call).map_err(ShotError::Draw)?;
        renderer.restart();
        let mut pixels = [0; WIDTH as usize];
        for line in 0..HEIGHT {
            renderer.draw_line(scene, line, &mut pixels, 0)?;
            pixels.iter().for_each(|pixel| look(*pixel));
        }
        Ok(())
    }

    /// How many pixels there are to hit.
    #[must_use]
    pub fn pixels() -> u32 {
        u32::from(Shot::screen().width()) * u32::from(Shot::screen().height())
    }
}
