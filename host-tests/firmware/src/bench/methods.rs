//! The interpolation methods, each a pipeline of its own, on the triangles of the other kernels.
//!
//! Names: method, pixel format, `_large` for what is taller than 64 lines, `_depth` where depth is
//! tested. Both widths are large, one twice the other: what differs is pixels alone, and what a
//! method takes to begin and to end counts for the span.

use super::presets::drawn;
use super::{LINES, WIDEST};
use crate::console::Console;
use crate::count::Counter;
use scanbeam::pipeline::{
    Auto, Counted, Forward, GouraudDepth, GouraudPainter, HalfRate, Interpolated, Interpolation,
    Lirp10, Lirp12, Lirp16, LirpPacked, Method, Packed8, Packed16, Precision, Quality, QuarterRate,
};
use scanbeam::pixel::{Rgb565, Rgb888};

/// Times all methods and prints them.
pub(super) fn run(counter: &Counter, console: &mut Console) {
    method::<Forward>("forward", counter, console);
    method::<Packed8>("packed8", counter, console);
    method::<Packed16>("packed16", counter, console);
    method::<HalfRate>("half", counter, console);
    method::<QuarterRate>("quarter", counter, console);
    method::<Lirp10>("lirp10", counter, console);
    method::<Lirp12>("lirp12", counter, console);
    method::<Lirp16>("lirp16", counter, console);
    method::<LirpPacked>("lirp_packed", counter, console);
    method::<Fast>("auto_fast", counter, console);
    method::<Balanced>("auto_balanced", counter, console);
    method::<Exact>("auto_exact", counter, console);
}

fn method<I: Interpolation>(method: &str, counter: &Counter, console: &mut Console) {
    for (size, tall, wide) in [("", LINES, WIDEST[0]), ("_large", LINES + 1, WIDEST[1])] {
        for width in [wide, wide / 2] {
            let at = (width, tall);
            // Coverage does not depend on the method.
            let counts = drawn::<Counted<GouraudPainter<Rgb565>>>(at, counter).1;
            for (format, instructions) in [
                (
                    "565",
                    drawn::<Interpolated<GouraudPainter<Rgb565>, I>>(at, counter).0,
                ),
                (
                    "888",
                    drawn::<Interpolated<GouraudPainter<Rgb888>, I>>(at, counter).0,
                ),
                (
                    "565_depth",
                    drawn::<Interpolated<GouraudDepth<Rgb565>, I>>(at, counter).0,
                ),
            ] {
                let (format, depth) = match format.strip_suffix("_depth") {
                    Some(format) => (format, "_depth"),
                    None => (format, ""),
                };
                console.line(format_args!(
                    "kernel name={method}_{format}{size}{depth} pixels={} spans={} instructions={instructions}",
                    counts.pixels_shaded, counts.spans
                ));
            }
        }
    }
}

/// [`Auto`] with a quality from the start.
macro_rules! auto {
    ($($name:ident $quality:ident;)*) => {$(
        #[derive(Clone, Copy)]
        struct $name(Auto);

        impl Default for $name {
            fn default() -> Self {
                Self(Auto::new(Quality::$quality()))
            }
        }

        impl Interpolation for $name {
            const CHOOSES: bool = true;

            #[inline(always)]
            fn method(&self, pixels: u32, slope: impl FnOnce() -> u32, of: Precision) -> Method {
                self.0.method(pixels, slope, of)
            }
        }
    )*};
}

auto! {
    Fast fast;
    Balanced balanced;
    Exact exact;
}
