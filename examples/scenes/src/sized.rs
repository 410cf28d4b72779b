//! The presets whose sizes are measured, once for firmware and host.

/// Calls a macro with the presets: a feature of the firmware, the name, the type.
///
/// Each draws the teapot, with a pixel as an SPI panel takes it.
#[macro_export]
macro_rules! sized {
    ($with:ident) => {
        $with! {
            "gouraud-depth", "GouraudDepth", scanbeam::GouraudDepth<scanbeam::Rgb565Be>;
            "flat-depth", "FlatDepth", scanbeam::FlatDepth<scanbeam::Rgb565Be>;
            "gouraud-painter", "GouraudPainter", scanbeam::GouraudPainter<scanbeam::Rgb565Be>;
            "flat-painter", "FlatPainter", scanbeam::FlatPainter<scanbeam::Rgb565Be>;
            "block-fixed", "BlockFixed<GouraudDepth>",
                scanbeam::BlockFixed<scanbeam::GouraudDepth<scanbeam::Rgb565Be>>;
            "deferred", "Deferred<GouraudDepth>",
                scanbeam::Deferred<scanbeam::GouraudDepth<scanbeam::Rgb565Be>>;
            "textured-depth", "TexturedDepth", $crate::LookB;
            "listed-depth", "ListedDepth",
                scanbeam::ListedDepth<'static, scanbeam::Rgb565Be>;
            "phong-depth", "PhongDepth",
                scanbeam::PhongDepth<'static, scanbeam::Rgb565Be>;
            "windowed", "Windowed<GouraudDepth>",
                scanbeam::Windowed<scanbeam::GouraudDepth<scanbeam::Rgb565Be>>;
            "prioritised", "Prioritised<GouraudDepth>",
                scanbeam::Prioritised<scanbeam::GouraudDepth<scanbeam::Rgb565Be>>;
            "composited", "Composited<GouraudDepth>",
                scanbeam::Composited<scanbeam::GouraudDepth<scanbeam::Rgb565Be>>;
            "shadowed", "Shadowed<GouraudDepth>",
                scanbeam::Shadowed<scanbeam::GouraudDepth<scanbeam::Rgb565Be>>;
        }
    };
}
