//! The frames that this firmware draws, by name.

use crate::rooms::{Rooms, RoomsOf};
use core::convert::Infallible;
use core::task::Poll;
use scanbeam::model::{ModelRenderer, PipeMemory, draw_model_frame};
use scanbeam::scan_out::{ErrorType, Pump, ScanoutDma, Window};
use scanbeam::{
    FlatDepth, GouraudDepth, LineMemory, LineRenderer, Pipeline, PixelFormat, Rgb565Be, Scene,
    SceneMemory, draw_frame,
};
use scenes::{SHOTS, Shot};

/// Most frames' pipeline: Gouraud, 32-bit depth, as an SPI panel takes it.
pub(crate) type Smooth = GouraudDepth<Rgb565Be>;
/// One colour a face.
pub(crate) type Faceted = FlatDepth<Rgb565Be>;

/// Lines that one transfer takes.
pub(crate) const LINES_PER_TRANSFER: u16 = 4;

/// What a frame is drawn with.
#[derive(Clone, Copy)]
enum Way {
    Smooth,
    Faceted,
    /// The hardware model, from a smooth scene.
    Model,
}

/// One frame: a shot, and how it is drawn.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) name: &'static str,
    shot: Shot,
    way: Way,
}

/// Every frame, in the order in which they are drawn: all shots, then one of flat faces and one
/// by the hardware model.
pub(crate) fn frames() -> impl Iterator<Item = Frame> {
    let smooth = SHOTS.into_iter().map(|shot| Frame {
        name: shot.name(),
        shot,
        way: Way::Smooth,
    });
    let others = [("teapot_flat", Way::Faceted), ("teapot_model", Way::Model)];
    smooth.chain(others.map(|(name, way)| Frame {
        name,
        shot: Shot::Teapot,
        way,
    }))
}

impl Frame {
    /// Draws the frame and hands the bytes of each transfer, in order, to `emit`. Drawing twice
    /// gives the same bytes.
    pub(crate) fn draw(&self, rooms: &mut Rooms, emit: &mut dyn FnMut(&[u8])) {
        let buffers = rooms.lines.take().expect("the last frame gave them back");
        let mut pump = Pump::new(Emit { emit, sent: None }, buffers);
        match self.way {
            Way::Smooth => draw_as::<Smooth>(self.shot, &mut rooms.smooth, &mut pump),
            Way::Faceted => draw_as::<Faceted>(self.shot, &mut rooms.faceted, &mut pump),
            Way::Model => draw_by_model(self.shot, rooms, &mut pump),
        }
        if let (_, [Some(a), Some(b)]) = pump.release() {
            rooms.lines = Some([a, b]);
        }
    }
}

fn draw_as<P: Pipeline<Pixel = Rgb565Be>>(
    shot: Shot,
    rooms: &mut RoomsOf<P>,
    pump: &mut Pump<Emit<'_>>,
) {
    let mut scene = Scene::<P>::new(
        Shot::screen(),
        SceneMemory {
            vertices: rooms.vertices,
            objects: rooms.objects,
            buckets: rooms.buckets,
        },
    );
    shot.build(&mut scene).expect("the rooms are large enough");
    let mut renderer = LineRenderer::new(LineMemory {
        slots: rooms.slots,
        links: rooms.links,
        depth: rooms.depth,
        spans: rooms.spans,
    });
    let background = Rgb565Be::from_rgb8(shot.background());
    draw_frame(&scene, &mut renderer, pump, background, LINES_PER_TRANSFER)
        .expect("the sink cannot fail and the rooms are large enough");
}

fn draw_by_model(shot: Shot, rooms: &mut Rooms, pump: &mut Pump<Emit<'_>>) {
    let mut scene = Scene::<Smooth>::new(
        Shot::screen(),
        SceneMemory {
            vertices: rooms.smooth.vertices,
            objects: rooms.smooth.objects,
            buckets: rooms.smooth.buckets,
        },
    );
    shot.build(&mut scene).expect("the rooms are large enough");
    let [z0, z1, c0, c1] = &mut rooms.model;
    let mut renderer = ModelRenderer::new(PipeMemory {
        z: [z0, z1],
        rgb: [c0, c1],
    });
    let background = Rgb565Be::from_rgb8(shot.background());
    draw_model_frame(&scene, &mut renderer, pump, background, LINES_PER_TRANSFER)
        .expect("the sink cannot fail and the rooms are large enough");
}

/// A sink that is done as soon as it starts.
struct Emit<'e> {
    emit: &'e mut dyn FnMut(&[u8]),
    sent: Option<&'static mut [u16]>,
}

impl ErrorType for Emit<'_> {
    type Error = Infallible;
}

impl ScanoutDma for Emit<'_> {
    type Buf = &'static mut [u16];

    fn begin(&mut self, _: Window) -> Result<(), Infallible> {
        Ok(())
    }

    fn start(&mut self, line: Self::Buf, len: usize) -> Result<(), (Infallible, Self::Buf)> {
        (self.emit)(bytemuck::cast_slice(&line[..len]));
        self.sent = Some(line);
        Ok(())
    }

    fn poll(&mut self) -> Poll<Result<Option<Self::Buf>, Infallible>> {
        Poll::Ready(Ok(self.sent.take()))
    }

    fn end(&mut self) -> Result<(), Infallible> {
        Ok(())
    }
}
