//! A model through the hardware model.

use crate::choice::PixelFormatArg;
use crate::parts::{Display, Job, Took, draw_parts_by, room_for, tiles};
use crate::prepared::Chunk;
use crate::{CrewSettings, DrawFailure, Drawn, Overfull, Prepared, Setting, formats};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use host_support::rooms::SceneRooms;
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::DrawError;
use scanbeam::stats::SpanCounts;
use scanbeam::{Draw, Scene};
use scanbeam_model::{ModelRenderer, PipeCounts, PipeMemory, SEGMENT, Token, draw_model_frame};

/// Draws a model as [`draw`](crate::draw) does, through the hardware model.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_model(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
) -> Result<Drawn, DrawFailure> {
    let prepared = Prepared::new(model);
    match format {
        PixelFormatArg::Rgb888 => draw_in::<Rgb888>(&prepared, view),
        PixelFormatArg::Rgb565 => draw_in::<Rgb565Be>(&prepared, view),
        _ => Err(formats::refused("the hardware model draws")),
    }
}

/// A job without a crew, and what is the same for all of its parts.
fn job(prepared: &Prepared, view: &View) -> Result<(Job, Setting), DrawFailure> {
    let setting = Setting::new(prepared, view)?;
    let room = room_for(prepared.chunks.iter(), false, view.shade == Shade::Flat);
    let job = Job::new(view, setting.camera, CrewSettings::default(), room);
    Ok((job, setting))
}

/// Draws a part of a model into a scene.
fn draw_chunk<F: PixelFormat>(
    scene: &mut Scene<'_, '_, Gouraud<F>>,
    setting: &Setting,
    chunk: &Chunk,
) -> Result<(), DrawError> {
    scene.draw(&Draw {
        model: setting.model,
        cull: setting.cull,
        light: setting.light,
        shading: setting.shading,
        ..Draw::new(chunk.mesh())
    })
}

fn draw_in<F: PixelFormat>(prepared: &Prepared, view: &View) -> Result<Drawn, DrawFailure> {
    let (job, setting) = job(prepared, view)?;
    let chunks = &prepared.chunks;
    let counted: Vec<_> = chunks.iter().map(Some).collect();
    let background = F::from_rgb8(view.background);
    draw_parts_by::<Gouraud<F>, F>(
        &job,
        &counted,
        &mut |scene, _, number, instead| {
            draw_chunk(scene, &setting, instead.unwrap_or(&chunks[number]))
        },
        &mut |scene, pump: &mut Display<F>, lines| {
            let mut memory = ModelLines::new(scene.screen().width());
            let mut renderer = memory.renderer();
            draw_model_frame(scene, &mut renderer, pump, background, lines)
                .map_err(|error| DrawFailure::Method(error.to_string()))?;
            let counts = renderer.counts();
            let spans = SpanCounts {
                pixels_shaded: (counts.pixels - counts.hidden) as u32,
                pixels_hidden: counts.hidden as u32,
                depth_tests: counts.pixels as u32,
                ..SpanCounts::default()
            };
            Ok(Took::by_other(scene, pump, spans, memory.bytes()))
        },
    )
}

/// Draws one line of a model through the hardware model, and shows each token to `trace` before it goes down the pipeline;
/// what the pipeline did, and what is left out of the line. A line that is wider than a scene can be is drawn in parts,
/// from left to right.
///
/// # Errors
/// See [`DrawFailure`].
pub fn trace_model_line(
    prepared: &Prepared,
    view: &View,
    line: u16,
    mut trace: impl FnMut(&Token),
) -> Result<(PipeCounts, Option<Overfull>), DrawFailure> {
    let bad = |error: &dyn std::fmt::Display| DrawFailure::View(error.to_string());
    let (job, setting) = job(prepared, view)?;
    let mut lines = ModelLines::new(job.size[0].min(job.most.into()) as u16);
    let mut renderer = lines.renderer();
    let mut overfull: Option<Overfull> = None;
    for tile in tiles(&job) {
        let own = line.wrapping_sub(tile.first[1] as u16);
        if own >= tile.size[1] {
            continue;
        }
        let mut memory = SceneRooms::new(job.room, 1);
        let mut scene = memory.scene::<Gouraud<Rgb888>>(tile.screen()?);
        let begun = scene.begin_lines(&tile.camera(&job)?, own..own + 1);
        begun.map_err(|error| bad(&error))?;
        let mut first = None;
        for chunk in &prepared.chunks {
            match draw_chunk(&mut scene, &setting, chunk) {
                Err(error @ DrawError::Full { .. }) => _ = first.get_or_insert(error),
                done => done.map_err(|error| bad(&error))?,
            }
        }
        if let Some(first) = first {
            let overfull = overfull.get_or_insert_with(|| Overfull {
                line,
                lines: 1,
                triangles: 0,
                first: first.to_string(),
            });
            overfull.triangles += scene.assembled().dropped;
        }
        let mut pixels = vec![[0; 3]; tile.size[0].into()];
        renderer
            .trace_line(&scene, own, job.background, &mut pixels, &mut trace)
            .map_err(|error| DrawFailure::Method(error.to_string()))?;
    }
    Ok((renderer.counts(), overfull))
}

/// The scanlines that the hardware model works in.
pub struct ModelLines([Vec<u64>; 4]);

impl ModelLines {
    /// As wide as a picture, or as the widest segment.
    #[must_use]
    pub fn new(width: u16) -> Self {
        let line = vec![0; usize::from(width).min(SEGMENT)];
        Self([line.clone(), line.clone(), line.clone(), line])
    }

    /// A renderer over them.
    pub fn renderer(&mut self) -> ModelRenderer<'_> {
        let [z0, z1, c0, c1] = &mut self.0;
        ModelRenderer::new(PipeMemory {
            z: [z0, z1],
            rgb: [c0, c1],
        })
    }

    /// Bytes of all of them.
    fn bytes(&self) -> usize {
        self.0.iter().map(|line| size_of_val(line.as_slice())).sum()
    }
}
