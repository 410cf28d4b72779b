//! The presets whose sizes are measured, once for firmware and host.

/// Calls a macro with the presets: a feature of the firmware, the name, the type.
///
/// Each draws the teapot, with a pixel as an SPI panel takes it.
#[macro_export]
macro_rules! sized {
    ($with:ident) => {
        $with! {
            "gouraud-depth", "GouraudDepth", scanbeam::pipeline::GouraudDepth<scanbeam::pixel::Rgb565Be>;
            "flat-depth", "FlatDepth", scanbeam::pipeline::FlatDepth<scanbeam::pixel::Rgb565Be>;
            "gouraud-painter", "GouraudPainter", scanbeam::pipeline::GouraudPainter<scanbeam::pixel::Rgb565Be>;
            "flat-painter", "FlatPainter", scanbeam::pipeline::FlatPainter<scanbeam::pixel::Rgb565Be>;
            "block-fixed", "BlockFixed<GouraudDepth>",
                scanbeam::pipeline::BlockFixed<scanbeam::pipeline::GouraudDepth<scanbeam::pixel::Rgb565Be>>;
            "deferred", "Deferred<GouraudDepth>",
                scanbeam::pipeline::Deferred<scanbeam::pipeline::GouraudDepth<scanbeam::pixel::Rgb565Be>>;
            "textured-depth", "TexturedDepth", $crate::LookB;
            "composited", "Composited<GouraudDepth>",
                scanbeam::pipeline::Composited<scanbeam::pipeline::GouraudDepth<scanbeam::pixel::Rgb565Be>>;
        }
    };
}
