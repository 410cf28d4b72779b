//! Pictures by each way to find what is seen.

use crate::choice::{DepthArg, PixelFormatArg};
use crate::{CrewSettings, DrawFailure, Drawn, draw, draw_by_methods};
use host_support::model::Model;
use host_support::reference::View;
use scanbeam_lab::{DepthMethod, Method};

/// Draws a model as [`draw`] does, and finds what is seen by a method.
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
    let kept = match depth {
        DepthArg::BlockFix => DepthMethod::BlockFix,
        DepthArg::Word => DepthMethod::Word,
        _ => return draw(model, view, format, crew),
    };
    draw_by_methods(model, view, format, (Method::Packed16, kept))
}
