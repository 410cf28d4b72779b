//! euc: a vertex shader for each corner of each face, floats, one depth buffer.
//!
//! Its own interpolation of colours asks for fused multiply-adds. Where no instruction is known for
//! them, as on a Cortex-M by `libm`, each takes hundreds of others, so colours bring their own here;
//! that of depth is left, and cannot be chosen.

use crate::scene::{Data, FOCAL, NEAR_FAR, SIZE};
use alloc::vec::Vec;
use euc::{Interpolate, Pipeline, Target, buffer::Buffer2d, rasterizer};
use measured::Renderer;
use vek::{Mat4, Rgb, Vec3, Vec4};

pub(crate) struct Euc {
    data: Data,
    corners: Vec<usize>,
    colour: Buffer2d<u16>,
    depth: Buffer2d<f32>,
}

impl Euc {
    pub(crate) fn new(data: Data) -> Self {
        Self {
            corners: data.faces.as_flattened().to_vec(),
            data,
            colour: Buffer2d::new(SIZE, 0),
            depth: Buffer2d::new(SIZE, 1.0),
        }
    }
}

impl Renderer for Euc {
    fn frame(&mut self) {
        self.colour.clear(self.data.background);
        self.depth.clear(1.0);
        let [near, far] = NEAR_FAR;
        let aspect = SIZE[0] as f32 / SIZE[1] as f32;
        let project = Mat4::new(
            FOCAL,
            0.0,
            0.0,
            0.0, //
            0.0,
            FOCAL * aspect,
            0.0,
            0.0, //
            0.0,
            0.0,
            -(far + near) / (far - near),
            -2.0 * far * near / (far - near), //
            0.0,
            0.0,
            -1.0,
            0.0,
        );
        let shader = Shader {
            data: &self.data,
            project: project * Mat4::translation_3d(Vec3::from(self.data.offset)),
        };
        shader.draw::<rasterizer::Triangles<_>, _>(
            &self.corners,
            &mut self.colour,
            Some(&mut self.depth),
        );
    }

    fn picture(&mut self) -> Vec<u16> {
        self.colour.as_ref().to_vec()
    }
}

#[derive(Clone)]
struct Colour(Rgb<f32>);

impl Interpolate for Colour {
    #[inline(always)]
    fn lerp2(a: Self, b: Self, x: f32, y: f32) -> Self {
        Self(a.0 * x + b.0 * y)
    }

    #[inline(always)]
    fn lerp3(a: Self, b: Self, c: Self, x: f32, y: f32, z: f32) -> Self {
        Self(a.0 * x + b.0 * y + c.0 * z)
    }
}

struct Shader<'a> {
    data: &'a Data,
    project: Mat4<f32>,
}

impl Pipeline for Shader<'_> {
    type Vertex = usize;
    type VsOut = Colour;
    type Pixel = u16;

    #[inline(always)]
    fn vert(&self, vertex: &usize) -> ([f32; 4], Colour) {
        let position = Vec4::from_point(Vec3::from(self.data.positions[*vertex]));
        (
            (self.project * position).into_array(),
            Colour(Rgb::from(self.data.colour(*vertex))),
        )
    }

    #[inline(always)]
    fn frag(&self, Colour(colour): &Colour) -> u16 {
        let steps = |level: f32, most: f32| (level * most + 0.5) as u16;
        steps(colour.r, 31.0) << 11 | steps(colour.g, 63.0) << 5 | steps(colour.b, 31.0)
    }
}
