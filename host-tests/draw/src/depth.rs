//! The pipeline of each way to find what is seen.

use super::presets::draw_as;
use super::{CrewSettings, DrawFailure, Drawn, Prepared, formats};
use crate::choice::{DepthArg, PixelFormatArg};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use scanbeam::pipeline::{
    BlockFixDepth, Counted, DepthAndColour, FlatDepth, GouraudDepth, LineDepth, WithDepth,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};

/// Draws a model as [`draw`](super::draw) does, and finds what is seen by a method.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_by_depth(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
    depth: DepthArg,
) -> Result<Drawn, DrawFailure> {
    match depth {
        DepthArg::Auto | DepthArg::Z32 | DepthArg::Id | DepthArg::Priority => {
            super::draw(model, view, format, crew)
        }
        DepthArg::BlockFix => seen_by::<BlockFixDepth>(model, view, format, crew),
        DepthArg::Word => seen_by::<DepthAndColour>(model, view, format, crew),
    }
}

fn seen_by<D: LineDepth>(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    let prepared = &Prepared::new(model);
    match format {
        PixelFormatArg::Rgb888 => shaded::<Rgb888, D>(prepared, view, crew),
        PixelFormatArg::Rgb565 => shaded::<Rgb565Be, D>(prepared, view, crew),
        _ => Err(formats::refused("a chosen depth draws")),
    }
}

fn shaded<F: PixelFormat, D: LineDepth>(
    prepared: &Prepared,
    view: &View,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    match view.shade {
        Shade::Flat => draw_as::<Counted<WithDepth<FlatDepth<F>, D>>>(prepared, view, crew),
        _ => draw_as::<Counted<WithDepth<GouraudDepth<F>, D>>>(prepared, view, crew),
    }
}
