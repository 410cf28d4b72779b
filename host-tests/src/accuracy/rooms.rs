//! Frames of the rooms `scene`, `look` and `frame`, as the firmware draws them: one that is doubled on its way out beside
//! the same drawn whole, and places on a texture that come from normals.

use super::frames::model_of;
use super::spans::beyond;
use super::{Errors, Row};
use crate::frames::{suite_frame, values_pictures};
use crate::image_out::Frame;
use crate::model::Model;
use crate::reference::{Cull, NO_OBJECT, Reference, Shade, View, render};
use crate::rooms::{Room, picture};
use scanbeam::look::Textured;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be};
use scanbeam::scene::{Budget, Draw, Skin, TexGen, Texture};
use scanbeam::{Affine, Camera, Screen};
use scenes::Suite;
use std::error::Error;

const FAMILY: &str = "frame";
/// Edges and background too: what a picture loses where it has fewer pixels is there.
const WHOLE: &str = "teapot, 320 x 240, every pixel";
const INSIDE: &str = "teapot, 320 x 240, away from edges";

/// The teapot of the suite as the reference has it.
fn teapot() -> (Model, View) {
    let part = scenes::teapot_part();
    let mut model = model_of(&part.mesh);
    // As the part stands.
    let (sin, cos) = 0.6f64.sin_cos();
    let turned = |[x, y, z]: [f64; 3]| [cos * x + sin * z, y, cos * z - sin * x];
    for vertex in &mut model.vertices {
        vertex.position = turned(vertex.position);
        vertex.normal = turned(vertex.normal);
        vertex.colour = part.colour.map(|level| f64::from(level) / 255.0);
    }
    let looking = Suite::Teapot.view();
    let view = View {
        eye: looking.eye.map(f64::from),
        at: looking.at.map(f64::from),
        fov: 2.0 * (120.0 / f64::from(looking.focal)).atan().to_degrees(),
        near: looking.near.into(),
        far: looking.far.into(),
        light: [0.3, 0.8, 0.6],
        ambient: 0.2,
        shade: Shade::Gouraud,
        cull: Cull::Back,
        background: Suite::Teapot.background(),
        ..View::default()
    };
    (model, view)
}

pub(super) fn rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let (model, view) = teapot();
    let reference = render(&model, &view)?;
    let doubled = values_pictures()?
        .into_iter()
        .find(|(name, _)| *name == "values_doubled");
    let (_, doubled) = doubled.ok_or("there is no doubled frame")?;
    let mut rows = Vec::new();
    for (case, edges) in [(WHOLE, true), (INSIDE, false)] {
        for (frame, method, kernel) in [
            (
                &suite_frame(Suite::Teapot)?.picture()?,
                "drawn whole",
                "teapot",
            ),
            (&doubled, "160 x 120 drawn, doubled", "values_doubled"),
        ] {
            let errors = off(frame, &reference, edges);
            rows.push(errors.row((FAMILY, case, method, "levels", Some(kernel))));
        }
    }
    Ok(rows)
}

/// The errors of a picture, with those beside edges or without.
fn off(frame: &Frame, reference: &Reference, edges: bool) -> Errors {
    let mut errors = Errors::default();
    for (i, pixel) in frame.rgb().chunks_exact(3).enumerate() {
        if reference.near_edge[i] && !edges {
            continue;
        }
        let shown = [pixel[0], pixel[1], pixel[2]];
        for channel in 0..3 {
            let exact = reference.colour[i][channel];
            errors.push(beyond(shown, channel, Rgb565Be::STEPS, exact));
        }
    }
    errors
}

/// Texels a side of a map whose texel is its place.
const MAP: u32 = 64;
const MIRROR: &str = "teapot that reflects, 160 x 120, map of 64 x 64";

/// The frame of a teapot that is a mirror, with a map that says where it is, against normals at each pixel in f64.
pub(super) fn mirror_rows() -> Result<Vec<Row>, Box<dyn Error>> {
    let (model, view) = looking_glass();
    // Components of normals in place of colours, 255 for 1 and 0 for -1.
    let reference = render(&model, &view)?;
    let (across, down) = axes(&view);
    let shown = mirrored()?;
    let mut errors = Errors::default();
    for (i, &texel) in shown.iter().enumerate() {
        // Beside an edge of a triangle too: most pixels are, and normals go on there.
        if texel == NOTHING || !is_smooth(&reference, i) {
            continue;
        }
        let normal = reference.colour[i].map(|level| level / 127.5 - 1.0);
        let length = dot(normal, normal).sqrt();
        let off = [(across, texel % 64), (down, texel / 64)].map(|(axis, at)| {
            let want = f64::from(MAP) / 2.0 + dot(normal, axis) / length * f64::from(MAP - 1) / 2.0;
            // Anywhere on the texel.
            ((f64::from(at) + 0.5 - want).abs() - 0.5).max(0.0)
        });
        errors.push(off[0].max(off[1]));
    }
    let name = (
        "texture",
        MIRROR,
        "places from normals",
        "texels",
        Some("values_mirror"),
    );
    Ok(vec![errors.row(name)])
}

/// Whether a pixel of 160 x 120 is not beside another surface, or none: a pixel there may show either.
fn is_smooth(reference: &Reference, i: usize) -> bool {
    let near = |to: isize| {
        let at = i.checked_add_signed(to).unwrap_or(i);
        let colours = [
            reference.colour[i],
            reference.colour.get(at).copied().unwrap_or_default(),
        ];
        let seen = reference
            .object
            .get(at)
            .is_some_and(|&object| object != NO_OBJECT);
        seen && (0..3).all(|k| (colours[0][k] - colours[1][k]).abs() < 40.0)
    };
    [0, -1, 1, -160, 160].into_iter().all(near)
}

fn dot(a: [f64; 3], b: [f64; 3]) -> f64 {
    a.iter().zip(b).map(|(a, b)| a * b).sum()
}

/// To the right and down, as the camera sees it.
fn axes(view: &View) -> ([f64; 3], [f64; 3]) {
    let cross =
        |a: [f64; 3], b: [f64; 3]| [(1, 2), (2, 0), (0, 1)].map(|(i, k)| a[i] * b[k] - a[k] * b[i]);
    let unit = |v: [f64; 3]| v.map(|c| c / dot(v, v).sqrt());
    let ahead = unit([0, 1, 2].map(|i| view.at[i] - view.eye[i]));
    let right = unit(cross(ahead, view.up));
    (right, cross(ahead, right))
}

/// What the reference draws: the teapot of the mirror, with normals as colours.
fn looking_glass() -> (Model, View) {
    let (mut model, view) = teapot();
    for vertex in &mut model.vertices {
        vertex.colour = vertex.normal.map(|c| (c + 1.0) / 2.0);
    }
    let view = View {
        width: 160,
        height: 120,
        eye: [0.6, 1.0, 2.8],
        at: [0.0; 3],
        fov: 2.0 * (60.0f64 / 140.0).atan().to_degrees(),
        shade: Shade::None,
        ..view
    };
    (model, view)
}

/// A texel that the map has not.
const NOTHING: u16 = 0xFFFF;

/// The texels of the mirror, as a renderer shows them.
fn mirrored() -> Result<Vec<u16>, Box<dyn Error>> {
    let texels: Vec<u16> = (0..(MAP * MAP) as u16).collect();
    let map = Texture::words(&texels, MAP, MAP)?;
    let room = Room {
        vertices: 1_200,
        places: 1_200,
        objects: 2_300,
        draws: 1,
    };
    let screen = Screen::new(160, 120)?;
    picture::<_, Textured<Rgb565>>(screen, room, NOTHING, |scene| {
        let (eye, up) = ([0.6, 1.0, 2.8], [0.0, 1.0, 0.0]);
        scene.begin(&Camera::look_at(eye, [0.0; 3], up, 140.0, 0.1, 100.0)?)?;
        scene.draw(&Draw {
            model: Affine::rotation_y(0.6),
            texture: Some(Skin {
                texture: &map,
                places: &[],
                budget: Budget::BALANCED,
            }),
            texgen: Some(TexGen::SPHERE),
            ..Draw::new(scenes::TEAPOT)
        })?;
        Ok(())
    })
}

/// How many pixels of the mirror are seen.
pub(super) fn mirror_pixels() -> Result<u32, Box<dyn Error>> {
    Ok(mirrored()?
        .iter()
        .filter(|&&texel| texel != NOTHING)
        .count() as u32)
}
