//! Triangles on chosen places of the screen, and any pipeline to draw them.

use scanbeam::pipeline::{
    CellOf, DepthUse, DrawError, Instance, LineDepth, LineMemory, LineRenderer, ObjectOf, Pipeline,
    Scene, SceneMemory, SlotOf, VertexOf, WordOf,
};
use scanbeam::{Camera, Cull, Faces, Link, Mesh, Screen};
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

/// Where eyes are: a focal length that makes a unit of the screen a power of two of a coordinate.
pub(super) struct Setting {
    pub(super) screen: Screen,
    camera: Camera,
    instance: Instance,
}

impl Setting {
    /// All corners at distance 1: 2^-15 of a coordinate is 1/8 pixel.
    pub(super) fn flat(width: u16, height: u16) -> Result<Self, Box<dyn Error>> {
        Self::new(width, height, (4096.0, 0.5, 2.0), 1.0)
    }

    /// With this focal length in pixels and this range; coordinates of a mesh are `scale` large.
    pub(super) fn new(
        width: u16,
        height: u16,
        (focal, near, far): (f32, f32, f32),
        scale: f32,
    ) -> Result<Self, Box<dyn Error>> {
        let ahead = [0.0, 0.0, -1.0];
        let camera = Camera::look_at([0.0; 3], ahead, [0.0, 1.0, 0.0], focal, near, far)?;
        let model = scanbeam::Affine::placed(scale, [0.0; 3]).ok_or("the scale is finite")?;
        Ok(Self {
            screen: Screen::new(width, height)?,
            camera,
            instance: Instance {
                cull: Cull::None,
                model,
                ..Instance::default()
            },
        })
    }

    /// A vertex of a flat setting.
    pub(super) fn vertex(&self, at: Place) -> [i32; 3] {
        let x = at.0 - 4 * i32::from(self.screen.width());
        let y = at.1 - 4 * i32::from(self.screen.height());
        [x << 15, -(y << 15), -1 << 30]
    }
}

/// Memory for scenes of a few triangles.
pub(super) struct Stage<P: Pipeline> {
    vertices: Vec<VertexOf<P>>,
    objects: Vec<ObjectOf<P>>,
    buckets: Vec<Link>,
    slots: Vec<SlotOf<P>>,
    links: Vec<Link>,
    /// The depth of the line that was drawn last.
    pub(super) depth: Vec<CellOf<P>>,
}

impl<P: Pipeline> Stage<P> {
    pub(super) fn new(screen: Screen) -> Self {
        Self {
            vertices: vec![VertexOf::<P>::empty(); 16],
            objects: vec![ObjectOf::<P>::default(); 8],
            buckets: vec![Link::NONE; usize::from(screen.height())],
            slots: vec![LineRenderer::<P>::empty_slot(); 8],
            links: vec![Link::NONE; 8],
            depth: vec![P::Depth::FARTHEST; usize::from(screen.width())],
        }
    }

    /// A scene of triangles, three positions each, with the colours of their corners.
    pub(super) fn scene(
        &mut self,
        setting: &Setting,
        positions: &[[i32; 3]],
        colours: &[[u8; 3]],
    ) -> Result<(Scene<'_, P>, Lines<'_, P>), Box<dyn Error>> {
        let mut scene = Scene::new(
            setting.screen,
            SceneMemory {
                vertices: &mut self.vertices,
                objects: &mut self.objects,
                buckets: &mut self.buckets,
            },
        );
        scene.begin(&setting.camera)?;
        let faces: Vec<[u16; 3]> = (0..positions.len() as u16 / 3)
            .map(|i| [3 * i, 3 * i + 1, 3 * i + 2])
            .collect();
        let mesh = Mesh {
            positions,
            normals: &[],
            colours,
            faces: Faces::Triangles(&faces),
        };
        let drawn: Result<_, DrawError> = scene.draw(&mesh, &setting.instance);
        drawn?;
        let lines = Lines {
            slots: &mut self.slots,
            links: &mut self.links,
            depth: &mut self.depth,
        };
        Ok((scene, lines))
    }
}

/// What a line renderer is lent.
pub(super) struct Lines<'s, P: Pipeline> {
    slots: &'s mut [SlotOf<P>],
    links: &'s mut [Link],
    pub(super) depth: &'s mut [CellOf<P>],
}

impl<P: Pipeline> Lines<'_, P> {
    /// A renderer which tests and keeps all depth.
    pub(super) fn renderer(&mut self) -> LineRenderer<'_, P> {
        let mut renderer = LineRenderer::new(LineMemory {
            slots: self.slots,
            links: self.links,
            depth: self.depth,
        });
        renderer.set_depth_use(DepthUse::Always);
        renderer
    }

    /// Draws a line alone.
    pub(super) fn draw(
        &mut self,
        scene: &Scene<'_, P>,
        line: u16,
        pixels: &mut [WordOf<P>],
    ) -> Result<(), Box<dyn Error>> {
        self.renderer().draw_line(scene, line, pixels)?;
        Ok(())
    }
}
