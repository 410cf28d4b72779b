//! The pipeline of each interpolation method.

use super::{CrewSettings, DrawFailure, Drawn, Prepared, draw, draw_as, draw_model};
use crate::choice::{InterpArg, PixelFormatArg};
use host_support::model::Model;
use host_support::reference::{Shade, View};
use scanbeam::pipeline::{
    Auto, Counted, Forward, GouraudDepth, HalfRate, Interpolated, Interpolation, Lirp10, Lirp12,
    Lirp16, LirpPacked, Packed16, QuarterRate,
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
        InterpArg::Packed8 => return draw(model, view, format, crew),
        _ if view.shade == Shade::Flat => return draw(model, view, format, crew),
        InterpArg::Plane => smooth::<Forward>,
        InterpArg::Packed16 => smooth::<Packed16>,
        InterpArg::Half => smooth::<HalfRate>,
        InterpArg::Quarter => smooth::<QuarterRate>,
        InterpArg::Lirp10 => smooth::<Lirp10>,
        InterpArg::Lirp12 => smooth::<Lirp12>,
        InterpArg::Lirp16 => smooth::<Lirp16>,
        InterpArg::LirpPacked => smooth::<LirpPacked>,
        InterpArg::Auto => smooth::<Auto>,
    };
    by(&Prepared::new(model), view, format, crew)
}

/// Draws what [`Prepared::new`] has made, for each span by the cheapest method within the budget:
/// for many frames of one model.
///
/// # Errors
/// See [`DrawFailure`].
pub fn draw_prepared(
    prepared: &Prepared,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
) -> Result<Drawn, DrawFailure> {
    match (view.shade, format) {
        (Shade::None | Shade::Gouraud, PixelFormatArg::Rgb888 | PixelFormatArg::Rgb565) => {
            smooth::<Auto>(prepared, view, format, crew)
        }
        _ => super::formats::draw_in(prepared, view, format, crew),
    }
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
