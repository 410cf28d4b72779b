//! Triangles on chosen places of the screen, and a scene and a renderer for them.

use crate::rooms::{LineRooms, Room, SceneRooms};
use scanbeam::look::{Gouraud, Look};
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::PixelFormat;
use scanbeam::scene::ScreenCorner;
use scanbeam::{Camera, Cull, Draw, Faces, Mesh, Renderer, Scene, Screen};
use scanbeam_lab::{DepthMethod, Format, Method, Triangle, draw_line};
use scanbeam_model::{ModelRenderer, PipeMemory};
use std::error::Error;

/// xorshift64*: small, and the same everywhere.
#[derive(Debug)]
pub(super) struct Rng(u64);

impl Rng {
    pub(super) fn new(seed: u64) -> Self {
        Self(seed.wrapping_mul(0x9E37_79B9_7F4A_7C15) | 1)
    }

    /// A number from 0, below 1.
    pub(super) fn unit(&mut self) -> f64 {
        self.0 ^= self.0 >> 12;
        self.0 ^= self.0 << 25;
        self.0 ^= self.0 >> 27;
        let bits = self.0.wrapping_mul(0x2545_F491_4F6C_DD1D) >> 32;
        bits as f64 / f64::from(1u32 << 16) / f64::from(1u32 << 16)
    }

    /// A whole number from `low` to `high`, both inclusive.
    pub(super) fn within(&mut self, low: i32, high: i32) -> i32 {
        low + (self.unit() * f64::from(high - low + 1)) as i32
    }

    /// From `low` to `high`, as often between 1 and 2 as between 2 and 4.
    pub(super) fn log(&mut self, low: f64, high: f64) -> f64 {
        low * (high / low).powf(self.unit())
    }
}

/// Units of 1/8 pixel from the left and the top of the picture.
pub(super) type Place = (i32, i32);

/// Whether a triangle covers the pixel, by the fill rule's words in whole numbers: an edge counts
/// on the lines `Ytop < Y <= Ybottom`, and of the two that count one must be left of the centre
/// and the other not (`min < x <= max`).
pub(super) fn covers(triangle: [Place; 3], column: i32, line: i32) -> bool {
    let (x, y) = (i64::from(8 * column + 4), i64::from(8 * line + 4));
    let mut left = false;
    for k in 0..3 {
        let wide = |p: Place| (i64::from(p.0), i64::from(p.1));
        let (a, b) = (wide(triangle[k]), wide(triangle[(k + 1) % 3]));
        let (a, b) = if a.1 <= b.1 { (a, b) } else { (b, a) };
        if a.1 < y && y <= b.1 {
            left ^= (x - a.0) * (b.1 - a.1) > (y - a.1) * (b.0 - a.0);
        }
    }
    left
}

/// The value at a pixel's centre of what is linear between the corners.
pub(super) fn plane(triangle: [Place; 3], values: [f64; 3], column: i32, line: i32) -> f64 {
    at_place(triangle, values, (8 * column + 4, 8 * line + 4))
}

/// The value at a place of what is linear between the corners.
pub(super) fn at_place(triangle: [Place; 3], values: [f64; 3], at: Place) -> f64 {
    let [(x0, y0), (x1, y1), (x2, y2)] = triangle.map(|p| (f64::from(p.0), f64::from(p.1)));
    let (x, y) = (f64::from(at.0), f64::from(at.1));
    let area = (x1 - x0) * (y2 - y0) - (x2 - x0) * (y1 - y0);
    let w1 = ((x - x0) * (y2 - y0) - (x2 - x0) * (y - y0)) / area;
    let w2 = ((x1 - x0) * (y - y0) - (x - x0) * (y1 - y0)) / area;
    values[0] + (values[1] - values[0]) * w1 + (values[2] - values[0]) * w2
}

/// Twice the area, in units of 1/64 of a pixel.
pub(super) fn doubled_area([a, b, c]: [Place; 3]) -> i64 {
    let d = |p: i32, q: i32| i64::from(q) - i64::from(p);
    d(a.0, b.0) * d(a.1, c.1) - d(a.0, c.0) * d(a.1, b.1)
}

/// 1/w of a distance where the near plane is at `near`, in units of 2^-31.
pub(super) fn depth_of(distance: f64, near: f64) -> u32 {
    (near / distance * f64::from(1u32 << 31)) as u32
}

/// A corner without a texture.
pub(super) fn corner((x, y): Place, depth: u32, colour: [u8; 3]) -> ScreenCorner {
    ScreenCorner {
        vertex: ScreenVertex {
            x: x as i16,
            y: y as i16,
            depth,
            colour,
        },
        ..ScreenCorner::default()
    }
}

/// A draw call of no mesh, whose faces are seen from both sides.
pub(super) fn call<'t>() -> Draw<'static, 't> {
    Draw {
        cull: Cull::None,
        ..Draw::new(Mesh {
            positions: &[],
            normals: &[],
            colours: &[],
            faces: Faces::Triangles(&[]),
        })
    }
}

/// Looks along -z from the origin.
pub(super) fn ahead(focal: f32, near: f32, far: f32) -> Result<Camera, Box<dyn Error>> {
    let (to, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    Ok(Camera::look_at([0.0; 3], to, up, focal, near, far)?)
}

/// What has been drawn, or why it was not.
pub(super) type Done<R = ()> = Result<R, Box<dyn Error>>;

/// Memory for scenes of a few triangles.
pub(super) struct Stage<'t, L: Look> {
    screen: Screen,
    camera: Camera,
    scene: SceneRooms<'t>,
    lines: LineRooms<L>,
}

impl<'t, L: Look> Stage<'t, L> {
    /// Of a picture of this size, seen by a camera.
    pub(super) fn new((width, height): (u16, u16), camera: Camera) -> Done<Self> {
        let room = Room {
            vertices: 16,
            places: 16,
            objects: 8,
            draws: 2,
        };
        Ok(Self {
            screen: Screen::new(width, height)?,
            camera,
            scene: SceneRooms::new(room, height),
            lines: LineRooms::new(room.objects, width),
        })
    }

    /// Hands a scene that `build` makes, and who draws it, to `with`.
    pub(super) fn show<R>(
        &mut self,
        build: impl FnOnce(&mut Scene<'_, 't, L>) -> Done,
        with: impl FnOnce(&Scene<'_, 't, L>, &mut Renderer<'_, L>) -> Done<R>,
    ) -> Done<R> {
        let mut scene = self.scene.scene(self.screen);
        scene.begin(&self.camera)?;
        build(&mut scene)?;
        with(&scene, &mut self.lines.renderer())
    }
}

/// Draws a line by a method, over what is there.
pub(super) fn by_method<F: PixelFormat + Format>(
    how: (Method, DepthMethod),
    scene: &Scene<'_, '_, Gouraud<F>>,
    line: u16,
    pixels: &mut [F::Word],
    cells: &mut [u32],
) {
    let triangles = scene.triangles().map(Triangle::from);
    draw_line::<F>(how, triangles, line, pixels, cells);
}

/// Hands a hardware model, with lines of so many pixels, to `with`.
pub(super) fn with_model<R>(width: u16, with: impl FnOnce(&mut ModelRenderer<'_>) -> R) -> R {
    let mut memory = [(); 4].map(|()| vec![0; width.into()]);
    let [z0, z1, c0, c1] = &mut memory;
    with(&mut ModelRenderer::new(PipeMemory {
        z: [z0, z1],
        rgb: [c0, c1],
    }))
}
