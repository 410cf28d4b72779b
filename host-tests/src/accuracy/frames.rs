//! Whole scenes, away from edges, against the `f64` renderer.

use super::methods::{METHODS, Method, RENDERER};
use super::spans::beyond;
use super::{Errors, Row};
use crate::args::PixelFormatArg;
use crate::draw::{CrewSettings, DrawFailure, Drawn, draw, draw_by_methods, draw_model};
use crate::image_out::Frame;
use crate::model::{Model, ModelVertex};
use crate::reference::{Cull, NO_OBJECT, Reference, Shade, View, render};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::{Faces, Mesh};
use scanbeam_lab::DepthMethod;
use scenes::{CUBE, SPHERE, TEAPOT};
use std::error::Error;

const CASE: &str = "teapot, sphere, cube";
/// By format.
const SCENES: [&str; 2] = ["RGB565, scenes with depth", "RGB888, scenes with depth"];
const PLANES: [&str; 2] = ["planes, RGB565", "planes, RGB888"];
const MODEL: [&str; 2] = ["hardware model, RGB565", "hardware model, RGB888"];
const FORMATS: [(PixelFormatArg, [u16; 3]); 2] = [
    (PixelFormatArg::Rgb565, Rgb565::STEPS),
    (PixelFormatArg::Rgb888, Rgb888::STEPS),
];

/// A mesh of the test scenes as the host tool has models.
pub(super) fn model_of(mesh: &Mesh<'_>) -> Model {
    let q14 = |v: i16| f64::from(v) / f64::from(1 << 14);
    let Faces::Triangles(faces) = mesh.faces else {
        return Model::default();
    };
    let vertices = mesh.positions.iter().enumerate().map(|(i, p)| ModelVertex {
        position: p.map(q14),
        normal: mesh.normals.get(i).map_or([0.0; 3], |n| n.map(q14)),
        colour: mesh
            .colours
            .get(i)
            .map_or([1.0; 3], |c| c.map(|c| f64::from(c) / 255.0)),
        uv: [0.0; 2],
    });
    Model {
        vertices: vertices.collect(),
        triangles: faces.iter().map(|f| f.map(u32::from)).collect(),
        triangle_materials: vec![None; faces.len()],
        materials: Vec::new(),
        warnings: Vec::new(),
        sources: Vec::new(),
    }
}

/// The pictures of a method, or of the hardware model, in both formats.
struct Drawer {
    method: Option<&'static Method>,
    errors: [Errors; 2],
}

impl Drawer {
    fn draw(
        &self,
        model: &Model,
        view: &View,
        format: PixelFormatArg,
    ) -> Result<Drawn, DrawFailure> {
        match self.method.map(|method| method.way) {
            None => draw_model(model, view, format),
            Some(None) => draw(model, view, format, CrewSettings::default()),
            Some(Some(way)) => draw_by_methods(model, view, format, (way, DepthMethod::Bits32)),
        }
    }
}

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let methods = METHODS.iter().map(Some).chain([None]);
    let mut drawers: Vec<Drawer> = methods
        .map(|method| Drawer {
            method,
            errors: Default::default(),
        })
        .collect();
    for (mesh, shade) in [
        (&TEAPOT, Shade::Gouraud),
        (&SPHERE, Shade::Gouraud),
        (&CUBE, Shade::None),
        (&CUBE, Shade::Gouraud),
    ] {
        let model = model_of(mesh);
        for eye in [[0.4, 1.0, 2.6], [-1.9, 0.6, 1.7], [1.2, -1.4, 2.0]] {
            let view = View {
                eye,
                light: [0.5, 0.7, 1.0],
                shade,
                cull: Cull::Back,
                ..View::default()
            };
            let reference = render(&model, &view)?;
            for drawer in &mut drawers {
                for (i, (format, steps)) in FORMATS.into_iter().enumerate() {
                    let drawn = drawer.draw(&model, &view, format)?;
                    compare(&drawn.frame, &reference, steps, &mut drawer.errors[i]);
                }
            }
        }
    }
    Ok(drawers.into_iter().flat_map(named).collect())
}

/// The rows of a method: with depth, and of the renderer and the model beside other frames too.
fn named(Drawer { method, errors }: Drawer) -> Vec<Row> {
    let mut rows = Vec::new();
    for (i, errors) in errors.into_iter().enumerate() {
        let of_565 = |kernel| (i == 0).then_some(kernel);
        let frame = |name, kernel| ("frame", CASE, name, "levels", of_565(kernel));
        let Some(method) = method else {
            rows.push(errors.row(frame(MODEL[i], "teapot_model")));
            continue;
        };
        if method.name == RENDERER {
            rows.push(errors.clone().row(frame(PLANES[i], "teapot")));
        }
        let kernel = of_565(method.with_depth());
        rows.push(errors.row(("interpolation", SCENES[i], method.name, "levels", kernel)));
    }
    rows
}

/// The errors of a picture, away from edges.
fn compare(frame: &Frame, reference: &Reference, steps: [u16; 3], errors: &mut Errors) {
    for (i, pixel) in frame.rgb().chunks_exact(3).enumerate() {
        if reference.near_edge[i] || reference.object[i] == NO_OBJECT {
            continue;
        }
        let shown = [pixel[0], pixel[1], pixel[2]];
        for channel in 0..3 {
            errors.push(beyond(shown, channel, steps, reference.colour[i][channel]));
        }
    }
}
