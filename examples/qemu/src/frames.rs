//! The frames that this firmware draws, by name.

use crate::rooms::{Rooms, RoomsOf};
use core::convert::Infallible;
use core::task::Poll;
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

/// One frame: a shot, and whether its faces are flat.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) name: &'static str,
    shot: Shot,
    flat: bool,
}

/// Every frame, in the order in which they are drawn: all shots, then one of flat faces.
pub(crate) fn frames() -> impl Iterator<Item = Frame> {
    let smooth = SHOTS.into_iter().map(|shot| Frame {
        name: shot.name(),
        shot,
        flat: false,
    });
    smooth.chain([Frame {
        name: "teapot_flat",
        shot: Shot::Teapot,
        flat: true,
    }])
}

impl Frame {
    /// Draws the frame and hands the bytes of each transfer, in order, to `emit`. Drawing twice
    /// gives the same bytes.
    pub(crate) fn draw(&self, rooms: &mut Rooms, emit: &mut dyn FnMut(&[u8])) {
        let buffers = rooms.lines.take().expect("the last frame gave them back");
        let mut pump = Pump::new(Emit { emit, sent: None }, buffers);
        if self.flat {
            draw_as::<Faceted>(self.shot, &mut rooms.faceted, &mut pump);
        } else {
            draw_as::<Smooth>(self.shot, &mut rooms.smooth, &mut pump);
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
