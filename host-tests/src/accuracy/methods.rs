//! The interpolation methods of the crate, and how each is drawn and costed.

use crate::args::InterpArg;
use scanbeam::pipeline::{GouraudPainter, Interpolated, Quality};

/// A method by name.
pub(super) struct Method {
    pub(super) name: &'static str,
    pub(super) interp: InterpArg,
    pub(super) quality: Quality,
    /// Kernels of the firmware: RGB565 and RGB888, small triangles and large ones, and RGB565
    /// with depth.
    kernels: [&'static str; 5],
}

/// The pipeline of a method without depth.
pub(super) type Painter<F, I> = Interpolated<GouraudPainter<F>, I>;

macro_rules! method {
    ($name:literal, $interp:ident, $quality:ident, $kernel:literal) => {
        Method {
            name: $name,
            interp: InterpArg::$interp,
            quality: Quality::$quality(),
            kernels: [
                concat!($kernel, "_565"),
                concat!($kernel, "_565_large"),
                concat!($kernel, "_888"),
                concat!($kernel, "_888_large"),
                concat!($kernel, "_565_depth"),
            ],
        }
    };
}

/// The one that presets have.
pub(super) const DEFAULT: &str = "packed8";

/// All of them.
pub(super) const METHODS: [Method; 12] = [
    method!("plane, forward steps", Plane, exact, "forward"),
    method!("packed8", Packed8, exact, "packed8"),
    method!("packed16", Packed16, exact, "packed16"),
    method!("half rate", Half, exact, "half"),
    method!("quarter rate", Quarter, exact, "quarter"),
    method!("LIRP, 10 bits", Lirp10, exact, "lirp10"),
    method!("LIRP, 12 bits", Lirp12, exact, "lirp12"),
    method!("LIRP, 16 bits", Lirp16, exact, "lirp16"),
    method!("LIRP, packed", LirpPacked, exact, "lirp_packed"),
    method!("auto, fast", Auto, fast, "auto_fast"),
    method!("auto, balanced", Auto, balanced, "auto_balanced"),
    method!("auto, exact", Auto, exact, "auto_exact"),
];

impl Method {
    /// The kernel of spans.
    pub(super) const fn kernel(&self, bits_565: bool, large: bool) -> &'static str {
        self.kernels[2 * !bits_565 as usize + large as usize]
    }

    /// The kernel of small triangles with depth, RGB565.
    pub(super) const fn with_depth(&self) -> &'static str {
        self.kernels[4]
    }
}
