//! Whole scenes, away from edges, against the `f64` renderer.

use super::spans::beyond;
use super::{Errors, Row};
use crate::args::PixelFormatArg;
use crate::draw::{CrewSettings, draw, draw_model};
use crate::model::{Model, ModelVertex};
use crate::reference::{Cull, Shade, View, render};
use scanbeam::{Faces, Mesh, PixelFormat, Rgb565, Rgb888};
use scenes::{CUBE, SPHERE, TEAPOT};
use std::error::Error;

const CASE: &str = "teapot, sphere, cube";

/// A mesh of the test scenes as the host tool has models.
fn model_of(mesh: &Mesh<'_>) -> Model {
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

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let mut errors = [(); 4].map(|()| Errors::default());
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
            let crew = CrewSettings::default();
            let drawn = [
                draw(&model, &view, PixelFormatArg::Rgb565, crew)?,
                draw_model(&model, &view, PixelFormatArg::Rgb565)?,
                draw(&model, &view, PixelFormatArg::Rgb888, crew)?,
                draw_model(&model, &view, PixelFormatArg::Rgb888)?,
            ];
            let steps = [Rgb565::STEPS, Rgb565::STEPS, Rgb888::STEPS, Rgb888::STEPS];
            for ((errors, drawn), steps) in errors.iter_mut().zip(drawn).zip(steps) {
                let pixels = drawn.frame.rgb().chunks_exact(3);
                for (i, pixel) in pixels.enumerate() {
                    if reference.near_edge[i] || reference.object[i] == crate::reference::NO_OBJECT
                    {
                        continue;
                    }
                    let shown = [pixel[0], pixel[1], pixel[2]];
                    for channel in 0..3 {
                        errors.push(beyond(shown, channel, steps, reference.colour[i][channel]));
                    }
                }
            }
        }
    }
    let names = [
        ("planes, RGB565", Some("teapot")),
        ("hardware model, RGB565", Some("teapot_model")),
        ("planes, RGB888", None),
        ("hardware model, RGB888", None),
    ];
    let rows = names.into_iter().zip(errors);
    Ok(rows
        .map(|((method, kernel), errors)| errors.row(("frame", CASE, method, "levels", kernel)))
        .collect())
}
