//! The interpolation methods of the laboratory, and how each is costed.

use scanbeam_lab::Method as Way;

/// A method by name.
pub(super) struct Method {
    pub(super) name: &'static str,
    /// How the laboratory draws it; what it has not is the renderer's own.
    pub(super) way: Option<Way>,
    /// Kernels of the firmware: RGB565 and RGB888, short spans and long ones, and RGB565 with depth.
    kernels: [&'static str; 5],
}

macro_rules! method {
    ($name:literal, $way:expr, $kernel:literal) => {
        Method {
            name: $name,
            way: $way,
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

/// What the renderer does.
pub const RENDERER: &str = "renderer";

/// All of them.
pub(super) const METHODS: [Method; 13] = [
    Method {
        name: RENDERER,
        way: None,
        kernels: [
            "renderer_565",
            "renderer_565_large",
            "renderer_888",
            "renderer_888_large",
            "renderer_565_depth",
        ],
    },
    method!("plane, forward steps", Some(Way::Plane), "forward"),
    method!("packed8", Some(Way::Packed8), "packed8"),
    method!("packed16", Some(Way::Packed16), "packed16"),
    method!("half rate", Some(Way::Half), "half"),
    method!("quarter rate", Some(Way::Quarter), "quarter"),
    method!("LIRP, 10 bits", Some(Way::Lirp(10)), "lirp10"),
    method!("LIRP, 12 bits", Some(Way::Lirp(12)), "lirp12"),
    method!("LIRP, 16 bits", Some(Way::Lirp(16)), "lirp16"),
    method!("LIRP, packed", Some(Way::LirpPacked), "lirp_packed"),
    method!("auto, fast", Some(Way::FAST), "auto_fast"),
    method!("auto, balanced", Some(Way::BALANCED), "auto_balanced"),
    method!("auto, exact", Some(Way::EXACT), "auto_exact"),
];

impl Method {
    /// The kernel of spans.
    pub(super) const fn kernel(&self, bits_565: bool, large: bool) -> &'static str {
        self.kernels[2 * !bits_565 as usize + large as usize]
    }

    /// The kernel with depth, RGB565.
    pub(super) const fn with_depth(&self) -> &'static str {
        self.kernels[4]
    }
}
