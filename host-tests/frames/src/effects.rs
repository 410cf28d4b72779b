//! The small frame of each effect, as this machine draws it.

use crate::MethodFrame;
use host_support::image_out::Frame;
use host_support::lent::{LineRooms, SceneRooms};
use host_support::mock::{HostLine, MockFrameBuffer};
use scanbeam::pipeline::{Pipeline, Scene, WordOf, draw_frame};
use scanbeam::pixel::PixelFormat;
use scanbeam::scan_out::Pump;
use scenes::{
    DrawsEffect, EFFECT_HEIGHT, EFFECT_ROOM, EFFECT_WIDTH, EFFECTS, Grainy, ShotError, Transparent,
    by_effect, method_screen,
};
use std::error::Error;

/// The words of a frame, and its colours in rows, 3 bytes a pixel.
type Picture = (Vec<u16>, Vec<u8>);

/// A frame, once it is drawn with so many slots.
struct Words {
    slots: usize,
    drawn: Option<Result<Picture, Box<dyn Error>>>,
}

impl Words {
    fn draw<P: Pipeline>(&mut self, build: impl Fn(&mut Scene<'_, P>) -> Result<(), ShotError>)
    where
        WordOf<P>: Into<u16>,
    {
        self.drawn = Some(words::<P>(self.slots, build));
    }
}

impl DrawsEffect for Words {
    fn transparent(
        &mut self,
        build: impl Fn(&mut Scene<'_, Transparent>) -> Result<(), ShotError>,
    ) {
        self.draw(build);
    }

    fn grainy(&mut self, build: impl Fn(&mut Scene<'_, Grainy>) -> Result<(), ShotError>) {
        self.draw(build);
    }
}

fn words<P: Pipeline>(
    slots: usize,
    build: impl Fn(&mut Scene<'_, P>) -> Result<(), ShotError>,
) -> Result<Picture, Box<dyn Error>>
where
    WordOf<P>: Into<u16>,
{
    let mut lent = SceneRooms::<P>::new(EFFECT_ROOM, EFFECT_ROOM, EFFECT_HEIGHT.into());
    let mut scene = lent.scene(method_screen());
    build(&mut scene).map_err(|error| format!("{error:?}"))?;
    let mut rooms = LineRooms::<P>::fitting(slots, &scene);
    let mut renderer = rooms.renderer();
    let words = usize::from(EFFECT_WIDTH);
    let sink = MockFrameBuffer::new(EFFECT_WIDTH, EFFECT_HEIGHT);
    let mut pump = Pump::new(sink, [HostLine::new(words), HostLine::new(words)]);
    let background = WordOf::<P>::default();
    draw_frame(&scene, &mut renderer, &mut pump, background, 1)?;
    let words = pump.sink().frame()?;
    let rgb = words.iter().flat_map(|&word| P::Pixel::to_rgb8(word));
    Ok((
        words.iter().map(|&word| word.into()).collect(),
        rgb.collect(),
    ))
}

/// All of them, by name.
fn all(slots: usize) -> Result<Vec<(&'static str, Picture)>, Box<dyn Error>> {
    let drawn = EFFECTS.into_iter().enumerate().map(|(index, name)| {
        let mut words = Words { slots, drawn: None };
        by_effect(index, &mut words);
        Ok((name, words.drawn.ok_or("nothing was drawn")??))
    });
    drawn.collect()
}

/// The words of all frames, by name, drawn with so many slots.
///
/// # Errors
/// When a frame does not fit the memory that it is lent.
pub fn effect_frames(slots: usize) -> Result<Vec<MethodFrame>, Box<dyn Error>> {
    let words = |(name, (words, _)): (_, Picture)| (name, words);
    Ok(all(slots)?.into_iter().map(words).collect())
}

/// The same as pictures.
///
/// # Errors
/// As [`effect_frames`].
pub fn effect_pictures() -> Result<Vec<(&'static str, Frame)>, Box<dyn Error>> {
    let frames = all(64)?.into_iter().map(|(name, (_, rgb))| {
        let frame = Frame::new(EFFECT_WIDTH.into(), EFFECT_HEIGHT.into(), rgb);
        Ok((name, frame.ok_or("a frame of another size")?))
    });
    frames.collect()
}
