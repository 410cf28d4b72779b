//! The pipeline of each interpolation method.

use super::presets::draw_as;
use super::{CrewSettings, DrawFailure, Drawn, Prepared, draw, draw_model};
use crate::choice::{InterpArg, PixelFormatArg};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use scanbeam::pipeline::{
    Counted, Forward, GouraudDepth, HalfRate, Interpolated, Interpolation, Lirp10, Lirp12, Lirp16,
    LirpPacked, Packed8, Packed16, QuarterRate,
};
use scanbeam::pixel::{Rgb565Be, Rgb888};

/// Draws a model as [`draw`] does, with colours by a method. Flat faces need none.
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
    let by = match interp {
        InterpArg::Model => return draw_model(model, view, format),
        InterpArg::Auto => return draw(model, view, format, crew),
        _ if view.shade == Shade::Flat => return draw(model, view, format, crew),
        InterpArg::Plane => smooth::<Forward>,
        InterpArg::Packed16 => smooth::<Packed16>,
        InterpArg::Half => smooth::<HalfRate>,
        InterpArg::Quarter => smooth::<QuarterRate>,
        InterpArg::Lirp10 => smooth::<Lirp10>,
        InterpArg::Lirp12 => smooth::<Lirp12>,
        InterpArg::Lirp16 => smooth::<Lirp16>,
        InterpArg::LirpPacked => smooth::<LirpPacked>,
        InterpArg::Packed8 => smooth::<Packed8>,
    };
    by(&Prepared::new(model), view, format, crew)
}

fn smooth<I: Interpolation>(
    prepared: &Prepared,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    type By<F, I> = Counted<Interpolated<GouraudDepth<F>, I>>;
    match format {
        PixelFormatArg::Rgb888 => draw_as::<By<Rgb888, I>>(prepared, view, crew),
        PixelFormatArg::Rgb565 => draw_as::<By<Rgb565Be, I>>(prepared, view, crew),
        _ => Err(super::formats::refused("methods can be chosen")),
    }
}
