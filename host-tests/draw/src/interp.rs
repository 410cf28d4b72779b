//! Pictures by methods of the laboratory: how colours are taken from pixel to pixel, and what is kept of depth.

use crate::choice::{InterpArg, PixelFormatArg};
use crate::parts::{Display, Job, Took, draw_parts_by, room_for};
use crate::{CrewSettings, DrawFailure, Drawn, Prepared, Setting, draw, draw_model, formats};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb888};
use scanbeam::scan_out::Window;
use scanbeam::stats::SpanCounts;
use scanbeam::{Draw, Scene};
use scanbeam_lab::{DepthMethod, Format, Method, Triangle, draw_line};

/// Draws a model as [`draw`] does, with colours by a method.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_by(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
    interp: InterpArg,
) -> Result<Drawn, DrawFailure> {
    let method = match interp {
        InterpArg::Model => return draw_model(model, view, format),
        InterpArg::Auto => return draw(model, view, format, crew),
        InterpArg::Plane => Method::Plane,
        InterpArg::Packed8 => Method::Packed8,
        InterpArg::Packed16 => Method::Packed16,
        InterpArg::Half => Method::Half,
        InterpArg::Quarter => Method::Quarter,
        InterpArg::Lirp10 => Method::Lirp(10),
        InterpArg::Lirp12 => Method::Lirp(12),
        InterpArg::Lirp16 => Method::Lirp(16),
        InterpArg::LirpPacked => Method::LirpPacked,
    };
    draw_by_methods(model, view, format, (method, DepthMethod::Bits32))
}

/// Draws a model by methods of the laboratory, smooth or flat and without textures, on this thread and without a cache.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_by_methods(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
    how: (Method, DepthMethod),
) -> Result<Drawn, DrawFailure> {
    let prepared = Prepared::new(model);
    match format {
        PixelFormatArg::Rgb888 => draw_in::<Rgb888>(&prepared, view, how),
        PixelFormatArg::Rgb565 => draw_in::<Rgb565>(&prepared, view, how),
        _ => Err(formats::refused("methods can be chosen")),
    }
}

fn draw_in<F: PixelFormat + Format>(
    prepared: &Prepared,
    view: &View,
    how: (Method, DepthMethod),
) -> Result<Drawn, DrawFailure> {
    let (chunks, setting) = (&prepared.chunks, Setting::new(prepared, view)?);
    let room = room_for(chunks.iter(), false, view.shade == Shade::Flat);
    let job = Job::new(view, setting.camera, CrewSettings::default(), room);
    let counted: Vec<_> = chunks.iter().map(Some).collect();
    let background = F::from_rgb8(view.background);
    draw_parts_by::<Gouraud<F>, F>(
        &job,
        &counted,
        &mut |scene, _, number, instead| {
            let chunk = instead.unwrap_or(&chunks[number]);
            scene.draw(&Draw {
                model: setting.model,
                cull: setting.cull,
                light: setting.light,
                shading: setting.shading,
                ..Draw::new(chunk.mesh())
            })
        },
        &mut |scene, pump, lines| draw_lines(scene, pump, (background, lines), how),
    )
}

/// Draws all lines of a scene over a background, so many a transfer.
fn draw_lines<F: PixelFormat + Format>(
    scene: &Scene<'_, '_, Gouraud<F>>,
    pump: &mut Display<F>,
    (background, lines_per_transfer): (F::Word, u16),
    how: (Method, DepthMethod),
) -> Result<Took, DrawFailure> {
    let failed = |error| DrawFailure::Method(format!("{error:?}"));
    let (width, lines) = (scene.screen().width(), scene.lines());
    let triangles: Vec<Triangle> = scene.triangles().map(Triangle::from).collect();
    let mut cells = vec![0; width.into()];
    let window = Window {
        x: 0,
        y: lines.start,
        width,
        height: lines.len() as u16,
    };
    let mut spans = SpanCounts::default();
    pump.begin(window, lines_per_transfer).map_err(failed)?;
    for line in lines {
        let pixels = pump.line().map_err(failed)?;
        F::fill(pixels, background);
        let counts = draw_line::<F>(how, triangles.iter().copied(), line, pixels, &mut cells);
        spans.pixels_shaded += counts.shaded;
        spans.pixels_hidden += counts.hidden;
        spans.depth_tests += counts.shaded + counts.hidden;
        pump.line_done().map_err(failed)?;
    }
    pump.finish().map_err(failed)?;
    let fast_bytes = size_of_val(cells.as_slice());
    Ok(Took::by_other(scene, pump, spans, fast_bytes))
}
