//! The small frame of each interpolation method, as this machine draws it.

use host_support::lent::{LineRooms, SceneRooms};
use host_support::mock::{HostLine, MockFrameBuffer};
use scanbeam::pipeline::{GouraudDepth, Interpolated, Interpolation, Quality, draw_frame};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scan_out::Pump;
use scenes::{
    DrawsMethod, METHOD_HEIGHT, METHOD_WIDTH, METHODS, build_method, by_method, method_screen,
};
use std::error::Error;

/// Vertices and objects that suffice.
const ROOM: usize = 256;

/// A frame's words, once it is drawn.
#[derive(Default)]
struct Words(Option<Result<Vec<u16>, Box<dyn Error>>>);

impl DrawsMethod for Words {
    fn draw<I: Interpolation>(&mut self, quality: Quality) {
        self.0 = Some(words::<I>(quality));
    }
}

fn words<I: Interpolation>(quality: Quality) -> Result<Vec<u16>, Box<dyn Error>> {
    type By<I> = Interpolated<GouraudDepth<Rgb565Be>, I>;
    let mut lent = SceneRooms::<By<I>>::new(ROOM, ROOM, METHOD_HEIGHT.into());
    let mut scene = lent.scene(method_screen());
    build_method(&mut scene).map_err(|error| format!("{error:?}"))?;
    let mut rooms = LineRooms::<By<I>>::new(64, ROOM, METHOD_WIDTH.into());
    let mut renderer = rooms.renderer();
    renderer.set_quality(quality);
    let words = usize::from(METHOD_WIDTH);
    let sink = MockFrameBuffer::new(METHOD_WIDTH, METHOD_HEIGHT);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    draw_frame(&scene, &mut renderer, &mut pump, 0, 1)?;
    Ok(pump.sink().frame()?)
}

/// The name of a frame and its words.
pub type MethodFrame = (&'static str, Vec<u16>);

/// The words of all frames, by name.
///
/// # Errors
/// When a frame does not fit the memory that it is lent.
pub fn method_frames() -> Result<Vec<MethodFrame>, Box<dyn Error>> {
    let drawn = METHODS.into_iter().enumerate().map(|(index, name)| {
        let mut words = Words::default();
        by_method(index, &mut words);
        let words = words.0.ok_or("nothing was drawn")?;
        Ok((name, words?))
    });
    drawn.collect()
}
