//! retrofire-core: shaders, floats, a heap, one depth buffer.

use crate::scene::{Data, FOCAL, NEAR_FAR, SIZE};
use alloc::vec::Vec;
use measured::Renderer;
use retrofire_core::geom::{Tri, Vertex, vertex};
use retrofire_core::mat;
use retrofire_core::math::{Color3f, Mat4, ProjMat3, perspective, pt2, pt3, rgb, viewport};
use retrofire_core::render::{
    Colorbuf, Context, Frag, Framebuf, Model, View, ctx::FaceCull, render, shader,
};
use retrofire_core::util::Buf2;
use retrofire_core::util::Dims;
use retrofire_core::util::pixfmt::Rgb565;

pub(crate) struct Retrofire {
    data: Data,
    faces: Vec<Tri<usize>>,
    vertices: Vec<(retrofire_core::math::Point3<Model>, usize)>,
    target: Framebuf<Colorbuf<Buf2<u16>, Rgb565>, Buf2<f32>>,
}

impl Retrofire {
    pub(crate) fn new(data: Data) -> Self {
        let dims = Dims(SIZE[0] as u32, SIZE[1] as u32);
        let faces = data.faces.iter().map(|&face| Tri(face)).collect();
        let positions = data.positions.iter().enumerate();
        let vertices = positions.map(|(i, p)| (pt3(p[0], p[1], p[2]), i)).collect();
        Self {
            data,
            faces,
            vertices,
            target: Framebuf {
                color_buf: Colorbuf::new(Buf2::new(dims)),
                depth_buf: Buf2::new(dims),
            },
        }
    }
}

impl Renderer for Retrofire {
    fn frame(&mut self) {
        self.target.color_buf.buf.fill(self.data.background);
        // Its depth is a reciprocal.
        self.target.depth_buf.fill(0.0);
        let [x, y, z] = self.data.offset;
        // Its view space looks along +z with y down: half a turn about x.
        let to_view: Mat4<Model, View> = mat![
            1.0, 0.0, 0.0, x;
            0.0, -1.0, 0.0, -y;
            0.0, 0.0, -1.0, -z;
            0.0, 0.0, 0.0, 1.0;
        ];
        let [near, far] = NEAR_FAR;
        let project = perspective(FOCAL, SIZE[0] as f32 / SIZE[1] as f32, near..far);
        let (data, to_clip) = (&self.data, to_view.then(&project));
        let shader = shader::new(
            |(place, index): (retrofire_core::math::Point3<Model>, usize),
             to_clip: &ProjMat3<Model>| {
                let [r, g, b] = data.colour(index);
                let colour: Color3f = rgb(r, g, b);
                let out: Vertex<_, Color3f> = vertex(to_clip.apply(&place), colour);
                out
            },
            |frag: Frag<Color3f>, _: &ProjMat3<Model>| frag.var.to_color4(),
        );
        let context = Context {
            // In its view space our faces go the other way round.
            face_cull: Some(FaceCull::Front),
            ..Context::default()
        };
        render(
            &self.faces,
            &self.vertices,
            &shader,
            &to_clip,
            viewport(pt2(0, 0)..pt2(SIZE[0] as u32, SIZE[1] as u32)),
            &mut self.target,
            &context,
        );
    }

    fn picture(&mut self) -> Vec<u16> {
        self.target.color_buf.buf.data().to_vec()
    }
}
