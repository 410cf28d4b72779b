//! Draws a shot of the test scenes by scanbeam: `ours SCENE FRAMES [PICTURE]`.
//!
//! Lines go to a display, not into a picture; only [`Measured::picture`] keeps them.

#![cfg_attr(target_os = "none", no_std, no_main)]

extern crate alloc;

use alloc::{boxed::Box, format, string::String, vec, vec::Vec};
use core::convert::Infallible;
use core::hint::black_box;
use core::task::Poll;
use measured::{Failure, Renderer as Measured};
use scanbeam::frame::{FastMemory, Memory as LineMemory};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scan_out::{LineBuf, Pump, ScanoutDma, Window};
use scanbeam::scene::{DrawState, Memory, Object, Vertex};
use scanbeam::{Link, Renderer, Scene, draw_frame};
use scenes::{DRAWS, HEIGHT, OBJECTS, SHOTS, STACKS, Shot, VERTICES, WIDTH};

type Look = Gouraud<Rgb565>;

struct Ours {
    shot: Shot,
    vertices: Vec<Vertex>,
    objects: Vec<Object>,
    bins: Vec<u16>,
    draws: Vec<DrawState<'static>>,
    links: Vec<Link>,
    cache: Box<FastMemory<Look>>,
    depth: Vec<u32>,
    pump: Pump<Display>,
}

measured::program!(ready);

fn ready(words: &mut dyn Iterator<Item = String>) -> Result<Box<dyn Measured>, Failure> {
    let scene = words.next().ok_or("which scene?")?;
    let mut shots = SHOTS.into_iter().chain(STACKS);
    let shot = shots.find(|shot| shot.name() == scene);
    let shot = shot.ok_or(format!("there is no scene {scene}"))?;
    Ok(Box::new(Ours::new(shot)))
}

impl Ours {
    fn new(shot: Shot) -> Self {
        let line = || Line(vec![0; usize::from(WIDTH)]);
        Self {
            shot,
            vertices: vec![Vertex::EMPTY; VERTICES],
            objects: vec![Object::EMPTY; OBJECTS],
            bins: vec![0; usize::from(HEIGHT)],
            draws: vec![DrawState::EMPTY; DRAWS],
            links: vec![Link::EMPTY; OBJECTS],
            cache: Box::new(FastMemory::new()),
            depth: vec![0; usize::from(WIDTH)],
            pump: Pump::new(Display::default(), [line(), line()]),
        }
    }
}

impl Measured for Ours {
    fn frame(&mut self) {
        let memory = Memory {
            vertices: &mut self.vertices,
            places: &mut [],
            objects: &mut self.objects,
            bins: &mut self.bins,
            draws: &mut self.draws,
        };
        let mut scene = Scene::<Look>::new(Shot::screen(), memory);
        let shot = self.shot;
        shot.build(&mut scene).expect("the arenas suffice");
        let mut renderer = Renderer::new(LineMemory {
            cache: &mut self.cache,
            links: &mut self.links,
            depth: &mut self.depth,
        });
        let background = Rgb565::from_rgb8(shot.background());
        draw_frame(&scene, &mut renderer, &mut self.pump, background, 1)
            .expect("the memory suffices");
    }

    fn picture(&mut self) -> Vec<u16> {
        self.pump.sink_mut().kept = Some(Vec::new());
        self.frame();
        self.pump.sink_mut().kept.take().unwrap_or_default()
    }
}

struct Line(Vec<u16>);

impl LineBuf for Line {
    type Word = u16;

    fn pixels(&mut self) -> &mut [u16] {
        &mut self.0
    }
}

#[derive(Default)]
struct Display {
    kept: Option<Vec<u16>>,
    sent: Option<Line>,
}

impl ScanoutDma for Display {
    type Error = Infallible;
    type Buf = Line;

    fn begin(&mut self, _: Window) -> Result<(), Infallible> {
        Ok(())
    }

    fn start(&mut self, line: Line, len: usize) -> Result<(), (Infallible, Line)> {
        if let Some(kept) = &mut self.kept {
            kept.extend_from_slice(&line.0[..len]);
        }
        black_box(&line.0[..len]);
        self.sent = Some(line);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Line>, Infallible>> {
        Poll::Ready(Ok(self.sent.take()))
    }

    fn end(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
