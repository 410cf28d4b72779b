//! A model through the hardware model.

use crate::choice::PixelFormatArg;
use crate::parts::{Display, Job, Took, draw_parts_by, room_for};
use crate::{CrewSettings, DrawFailure, Drawn, Prepared, Setting, formats};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use scanbeam::Draw;
use scanbeam::frame::FrameUse;
use scanbeam::look::Gouraud;
use scanbeam::pixel::{Pixel, Rgb565Be, Rgb888};
use scanbeam::stats::SpanCounts;
use scanbeam_model::{ModelRenderer, PipeMemory, SEGMENT, draw_model_frame};

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

fn draw_in<F: Pixel>(prepared: &Prepared, view: &View) -> Result<Drawn, DrawFailure> {
    let (chunks, setting) = (&prepared.chunks, Setting::new(prepared, view)?);
    let room = room_for(chunks.iter(), false, view.shade == Shade::Flat);
    let job = Job::new(view, setting.camera, CrewSettings::default(), room);
    let counted: Vec<_> = chunks.iter().map(Some).collect();
    let background = F::from_rgb8(view.background);
    draw_parts_by::<Gouraud<F>, F>(
        &job,
        &counted,
        |scene, _, number, instead| {
            let chunk = instead.unwrap_or(&chunks[number]);
            scene.draw(&Draw {
                model: setting.model,
                cull: setting.cull,
                light: setting.light,
                shading: setting.shading,
                ..Draw::new(chunk.mesh())
            })
        },
        |scene, pump: &mut Display<F>, lines| {
            let mut memory = ModelLines::new(scene.screen().width());
            let mut renderer = memory.renderer();
            draw_model_frame(scene, &mut renderer, pump, background, lines)
                .map_err(|error| DrawFailure::Method(format!("{error:?}")))?;
            let counts = renderer.counts();
            let spans = SpanCounts {
                pixels_shaded: (counts.pixels - counts.hidden) as u32,
                pixels_hidden: counts.hidden as u32,
                depth_tests: counts.pixels as u32,
                ..SpanCounts::default()
            };
            Ok(Took {
                used: FrameUse {
                    assembled: scene.assembled(),
                    scan_out: pump.stats(),
                    ..FrameUse::default()
                },
                spans: Some(spans),
                fast_bytes: memory.bytes(),
            })
        },
    )
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
