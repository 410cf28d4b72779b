//! embedded-3dgfx: each face's corners through the engine, then a triangle with depth, as its
//! Gouraud example does; back faces are dropped on the screen before that.
//!
//! The engine gives up on corners outside the picture: those of scene C are projected here.

use crate::scene::{Data, NEAR_FAR, SIZE};
use alloc::{vec, vec::Vec};
use core::convert::Infallible;
use embedded_3dgfx::Z_MAX_VALUE;
use embedded_3dgfx::engine::K3dengine;
use embedded_3dgfx::pipeline::assemble::primitive::DrawPrimitive;
use embedded_3dgfx::pipeline::rasterize::draw::draw_zbuffered;
use embedded_graphics_core::pixelcolor::Rgb565;
use embedded_graphics_core::pixelcolor::raw::RawU16;
use embedded_graphics_core::prelude::*;
use measured::Renderer;
use nalgebra::{ComplexField, Matrix4, Point3, Vector3, Vector4};

pub(crate) struct Embedded {
    data: Data,
    engine: K3dengine,
    colours: Vec<Rgb565>,
    background: Rgb565,
    frame: Picture,
    depth: Vec<embedded_3dgfx::ZDepth>,
}

impl Embedded {
    pub(crate) fn new(data: Data) -> Self {
        let mut engine = K3dengine::new(SIZE[0] as u16, SIZE[1] as u16);
        let [x, y, z] = data.offset.map(|c| -c);
        engine.camera.set_position(Point3::new(x, y, z));
        engine.camera.set_target(Point3::new(x, y, z - 1.0));
        // 240 lines at a focal length of 320 pixels.
        let half = ComplexField::atan(120.0f32 / 320.0);
        engine.camera.set_fovy(2.0 * half);
        engine.camera.set_near_far(NEAR_FAR[0], NEAR_FAR[1]);
        let raw = RawU16::new(data.background);
        Self {
            colours: vec![Rgb565::BLACK; data.positions.len()],
            data,
            engine,
            background: raw.into(),
            frame: Picture(vec![Rgb565::BLACK; SIZE[0] * SIZE[1]]),
            depth: vec![Z_MAX_VALUE; SIZE[0] * SIZE[1]],
        }
    }
}

impl Renderer for Embedded {
    fn frame(&mut self) {
        self.frame.0.fill(self.background);
        self.depth.fill(Z_MAX_VALUE);
        for (vertex, colour) in self.colours.iter_mut().enumerate() {
            let [r, g, b] = self.data.colour(vertex);
            let steps = |level: f32, most: f32| (level * most + 0.5) as u8;
            *colour = Rgb565::new(steps(r, 31.0), steps(g, 63.0), steps(b, 31.0));
        }
        let to_clip = self.engine.camera.vp_matrix * Matrix4::new_translation(&Vector3::zeros());
        for face in &self.data.faces {
            let inside = self
                .engine
                .transform_points(face, &self.data.positions, to_clip);
            let [a, b, c] = inside.unwrap_or_else(|| {
                face.map(|vertex| projected(self.data.positions[vertex], to_clip))
            });
            if (b.x - a.x) * (c.y - a.y) - (b.y - a.y) * (c.x - a.x) >= 0 {
                continue;
            }
            let triangle = DrawPrimitive::GouraudTriangleWithDepth {
                points: [a.xy(), b.xy(), c.xy()],
                depths: [a.z as f32, b.z as f32, c.z as f32],
                colors: face.map(|vertex| self.colours[vertex]),
            };
            draw_zbuffered(triangle, &mut self.frame, &mut self.depth, SIZE[0]);
        }
    }

    fn picture(&mut self) -> Vec<u16> {
        self.frame
            .0
            .iter()
            .map(|p| RawU16::from(*p).into_inner())
            .collect()
    }
}

/// A place on the screen as the engine has it, also outside the picture.
fn projected([x, y, z]: [f32; 3], to_clip: Matrix4<f32>) -> Point3<i32> {
    let clip = to_clip * Vector4::new(x, y, z, 1.0);
    let [x, y, z] = [clip.x, clip.y, clip.z].map(|c| c / clip.w);
    let [width, height] = SIZE.map(|side| side as f32);
    let [near, far] = NEAR_FAR;
    Point3::new(
        ((1.0 + x) * 0.5 * width) as i32,
        ((1.0 - y) * 0.5 * height) as i32,
        (z * (far - near) + near) as i32,
    )
}

/// The whole picture in memory.
struct Picture(Vec<Rgb565>);

impl OriginDimensions for Picture {
    fn size(&self) -> Size {
        Size::new(SIZE[0] as u32, SIZE[1] as u32)
    }
}

impl DrawTarget for Picture {
    type Color = Rgb565;
    type Error = Infallible;

    #[inline]
    fn draw_iter<I>(&mut self, pixels: I) -> Result<(), Infallible>
    where
        I: IntoIterator<Item = Pixel<Rgb565>>,
    {
        for Pixel(at, colour) in pixels {
            let (x, y) = (at.x as usize, at.y as usize);
            if x < SIZE[0] && y < SIZE[1] {
                self.0[y * SIZE[0] + x] = colour;
            }
        }
        Ok(())
    }
}
