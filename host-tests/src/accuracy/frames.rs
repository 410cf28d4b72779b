//! Whole scenes, away from edges, against the `f64` renderer.

use super::methods::{DEFAULT, METHODS};
use super::spans::beyond;
use super::{Errors, Row};
use crate::args::{InterpArg, PixelFormatArg};
use crate::draw::{CrewSettings, draw_by};
use crate::image_out::Frame;
use crate::model::{Model, ModelVertex};
use crate::reference::{Cull, NO_OBJECT, Reference, Shade, View, render};
use scanbeam::pipeline::Quality;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::{Faces, Mesh};
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
    }
}

/// A method's pictures in both formats, or the model's.
struct Drawer {
    interp: InterpArg,
    crew: CrewSettings,
    errors: [Errors; 2],
}

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let drawer = |interp, quality| Drawer {
        interp,
        crew: CrewSettings {
            quality,
            ..CrewSettings::default()
        },
        errors: Default::default(),
    };
    let mut drawers: Vec<Drawer> = METHODS
        .iter()
        .map(|m| drawer(m.interp, m.quality))
        .collect();
    drawers.push(drawer(InterpArg::Model, Quality::exact()));
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
                for (errors, (format, steps)) in drawer.errors.iter_mut().zip(FORMATS) {
                    let drawn = draw_by(&model, &view, format, drawer.crew, drawer.interp)?;
                    compare(&drawn.frame, &reference, steps, errors);
                }
            }
        }
    }
    let mut rows = Vec::new();
    for (drawer, method) in drawers
        .into_iter()
        .zip(METHODS.iter().map(Some).chain([None]))
    {
        for (i, errors) in drawer.errors.into_iter().enumerate() {
            let name = match method {
                // What a pixel costs with depth, measured on a kernel.
                Some(m) => (
                    "interpolation",
                    SCENES[i],
                    m.name,
                    "levels",
                    (i == 0).then(|| m.with_depth()),
                ),
                None => (
                    "frame",
                    CASE,
                    MODEL[i],
                    "levels",
                    (i == 0).then_some("teapot_model"),
                ),
            };
            if method.is_some_and(|m| m.name == DEFAULT) {
                let kernel = (i == 0).then_some("teapot");
                rows.push(
                    errors
                        .clone()
                        .row(("frame", CASE, PLANES[i], "levels", kernel)),
                );
            }
            rows.push(errors.row(name));
        }
    }
    Ok(rows)
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
