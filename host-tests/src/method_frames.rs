//! The small frame of each interpolation method, as this machine draws it.

use crate::lent::{LineRooms, SceneRooms};
use crate::mock::{HostLine, MockFrameBuffer};
use scanbeam::pipeline::{GouraudDepth, Interpolated, Interpolation};
use scanbeam::pixel::Rgb565Be;
use scanbeam::scan_out::Pump;
use scanbeam::{Quality, draw_frame};
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

#[cfg(test)]
mod tests {
    use super::*;
    use std::collections::BTreeSet;

    /// A frame that does not tell methods apart compares nothing.
    #[test]
    fn the_frame_tells_methods_apart() {
        let frames = method_frames().unwrap();
        for (name, words) in &frames {
            let colours: BTreeSet<u16> = words.iter().copied().collect();
            assert!(colours.len() > 200, "{name}: {}", colours.len());
        }
        let different: BTreeSet<&Vec<u16>> = frames.iter().map(|(_, words)| words).collect();
        // Wide LIRP, and exact planes however they are chosen, may agree.
        assert!(different.len() >= 8, "{}", different.len());
    }

    /// QEMU draws the same bits, so what holds here holds there (X1, X2).
    #[test]
    fn what_auto_chooses_keeps_its_budget_beside_planes() {
        let frames = method_frames().unwrap();
        let of = |name: &str| &frames.iter().find(|frame| frame.0 == name).unwrap().1;
        let planes = of("method_plane");
        assert_eq!(of("method_auto_exact"), planes);
        for (name, quality) in [
            ("method_auto_fast", Quality::fast()),
            ("method_auto_balanced", Quality::balanced()),
        ] {
            let (mut worst, mut differ) = (0.0f64, 0);
            for (shown, plane) in of(name).iter().zip(planes) {
                differ += u32::from(shown != plane);
                let [shown, plane] = [shown, plane].map(|word| {
                    let word = u16::from_be(*word);
                    [word >> 11, word >> 5 & 63, word & 31]
                });
                for (channel, steps) in [31.0, 63.0, 31.0].into_iter().enumerate() {
                    let steps_off = f64::from(shown[channel].abs_diff(plane[channel]));
                    // Either is rounded by half a step.
                    worst = worst.max((steps_off - 1.0) * 255.0 / steps);
                }
            }
            say!("{name}: {differ} pixels differ, by {worst:.2} levels beyond rounding");
            let budget: f64 = quality.levels.to_num();
            assert!(differ > 0 && worst <= budget, "{name}: {worst}");
        }
    }
}
