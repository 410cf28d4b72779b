//! How the frames of the test scenes are drawn here.

use crate::rooms::{LINES_PER_TRANSFER, Rooms, SceneRooms};
use core::convert::Infallible;
use core::task::Poll;
use scanbeam::frame::{Interleave, Pace, draw_frame};
use scanbeam::list::ListCommand;
use scanbeam::look::Look;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{Pump, ScanoutDma, Window};
use scanbeam::scene::DrawState;
use scanbeam::{Renderer, Scene};
use scanbeam_model::{ModelRenderer, PipeMemory, draw_model_frame};
use scenes::{
    Frame, InFormat, Paced, Played, SUITE_LINES, Shot, ShotError, SmoothLook, Suite, TexturedLook,
    Values, ValuesMemory, Variant, WIDTH, build_in_format, build_lit, build_smooth, teapot_lamps,
};

/// Slots of the caches that are not wide.
const SLOTS: u16 = 64;

const LARGE: &str = "the sink cannot fail and the rooms are large enough";

/// What a display would be.
pub(crate) trait Receives {
    /// A frame begins: pass one is done.
    fn begin(&mut self) {}
    /// The bytes of a transfer.
    fn transfer(&mut self, bytes: &[u8]);
}

impl<F: FnMut(&[u8])> Receives for F {
    fn transfer(&mut self, bytes: &[u8]) {
        self(bytes);
    }
}

/// Lines that a transfer of a frame takes.
pub(crate) const fn lines_of(frame: Frame) -> u16 {
    match frame {
        Frame::Suite(_)
        | Frame::InParts(_)
        | Frame::Paced(_)
        | Frame::Played(_)
        | Frame::Format(_) => SUITE_LINES,
        _ => LINES_PER_TRANSFER,
    }
}

/// Draws a frame, so many lines a transfer where it does not say that itself, and hands what is sent, in order, to `to`.
/// Drawing twice gives the same bytes.
pub(crate) fn draw(frame: Frame, lines: u16, rooms: &mut Rooms, to: &mut dyn Receives) {
    draw_at_pace(frame, lines, None, rooms, to);
}

/// The same of a frame that may be paced, one line a transfer, whose lines may cost what they like, but pay.
pub(crate) fn draw_unhurried(frame: Frame, rooms: &mut Rooms, to: &mut dyn Receives) {
    draw_at_pace(frame, 1, Some(Pace::GOURAUD_M4), rooms, to);
}

#[inline(never)]
fn draw_at_pace(
    frame: Frame,
    lines: u16,
    pace: Option<Pace>,
    rooms: &mut Rooms,
    to: &mut dyn Receives,
) {
    let buffers = rooms.buffers.take().expect("the last frame gave them back");
    let mut pump = Pump::new(Emit::new(to), buffers);
    let mut sent = Sent {
        lines,
        pace,
        pump: &mut pump,
    };
    match frame {
        Frame::Suite(suite) if suite.texture().is_some() => {
            sent.textured(rooms, suite.background(), &|scene| suite.build(scene));
        }
        Frame::Suite(suite) => {
            sent.smooth(rooms, suite.background(), &|scene| suite.build(scene));
        }
        Frame::InParts(suite) => {
            let cut = rooms.in_parts(suite);
            sent.smooth(rooms, suite.background(), &|scene| cut.build(scene));
        }
        Frame::Paced(paced) => sent.paced(paced, rooms),
        Frame::B(how) => {
            let background = Shot::Sphere.background();
            sent.textured(rooms, background, &|scene| how.build(scene));
        }
        Frame::Shot(how) => sent.shot(how, rooms),
        Frame::Values(values) => sent.values(values, rooms),
        Frame::Played(played) => sent.played(played, rooms),
        Frame::Format(format) => sent.in_format(format, rooms),
        Frame::Model(shot) => sent.model(shot, rooms),
    }
    if let (_, [Some(a), Some(b)]) = pump.release() {
        rooms.buffers = Some([a, b]);
    }
}

/// Where frames go.
struct Sent<'p, 'e> {
    /// Lines of a transfer.
    lines: u16,
    /// What its lines may cost.
    pace: Option<Pace>,
    pump: &'p mut Pump<Emit<'e>>,
}

/// Makes a scene.
type Build<'b, L> = &'b dyn Fn(&mut Scene<'_, 'static, L>) -> Result<(), ShotError>;

impl Sent<'_, '_> {
    /// A scene of smooth colours.
    #[inline(never)]
    fn smooth(&mut self, rooms: &mut Rooms, background: [u8; 3], build: Build<'_, SmoothLook>) {
        let mut scene = rooms.scene.scene();
        build(&mut scene).expect(LARGE);
        let renderer = rooms.lines.renderer(rooms.caches.smooth);
        self.send_paced(&scene, renderer, background);
    }

    /// A scene with textures.
    #[inline(never)]
    fn textured(&mut self, rooms: &mut Rooms, background: [u8; 3], build: Build<'_, TexturedLook>) {
        let mut scene = rooms.scene.scene();
        build(&mut scene).expect(LARGE);
        let renderer = rooms.lines.renderer(rooms.caches.textured);
        self.send_paced(&scene, renderer, background);
    }

    /// A scene whose lines cost no more than they may.
    fn paced(&mut self, paced: Paced, rooms: &mut Rooms) {
        let background = paced.suite.background();
        self.pace = self.pace.or(Some(paced.pace));
        if paced.suite.texture().is_some() {
            self.textured(rooms, background, &|scene| paced.build(scene));
        } else {
            self.smooth(rooms, background, &|scene| paced.build(scene));
        }
    }

    /// A shot as it says.
    fn shot(&mut self, how: Variant, rooms: &mut Rooms) {
        let background = how.shot.background();
        let build: Build<'_, SmoothLook> = &|scene| how.shot.build_shaded(how.shading, scene);
        if how.renderers > 1 {
            return self.by_two(how, rooms, build);
        }
        if how.slots > SLOTS {
            let mut scene = rooms.scene.scene();
            build(&mut scene).expect(LARGE);
            let mut renderer = rooms.lines.renderer(rooms.caches.wide);
            return self.send(&scene, &mut renderer, background);
        }
        if how.ahead > 0 {
            let mut scene = rooms.scene.scene();
            build(&mut scene).expect(LARGE);
            let renderer = rooms.lines.renderer(rooms.caches.smooth);
            return self.send(&scene, &mut renderer.fetching(how.ahead), background);
        }
        rooms.caches.smooth.set_limit(how.slots);
        self.smooth(rooms, background, build);
        rooms.caches.smooth.set_limit(SLOTS);
    }

    /// Two renderers of one scene take turns, as they would on two cores.
    #[inline(never)]
    fn by_two(&mut self, how: Variant, rooms: &mut Rooms, build: Build<'_, SmoothLook>) {
        let (first, second) = (&mut *rooms.caches.smooth, &mut *rooms.caches.second);
        first.set_limit(how.slots);
        second.set_limit(how.slots);
        let mut scene = rooms.scene.scene();
        build(&mut scene).expect(LARGE);
        let mut renderers = [rooms.lines.renderer(first), rooms.second.renderer(second)];
        let turns = Interleave::lines(2, 0).expect("the first of two");
        let background = Rgb565Be::from_rgb8(how.shot.background());
        let mut pixels = [background; WIDTH as usize];
        self.pump.sink_mut().to.begin();
        for line in scene.lines() {
            let renderer = &mut renderers[usize::from(turns.owner(line))];
            let drawn = renderer.draw_line(&scene, line, &mut pixels, background);
            drawn.expect(LARGE);
            let bytes = bytemuck::cast_slice(&pixels);
            self.pump.sink_mut().to.transfer(bytes);
        }
        rooms.caches.smooth.set_limit(SLOTS);
    }

    /// A shot by the hardware model.
    #[inline(never)]
    fn model(&mut self, shot: Shot, rooms: &mut Rooms) {
        let mut scene: Scene<'_, '_, SmoothLook> = rooms.scene.scene();
        shot.build(&mut scene).expect(LARGE);
        let [z0, z1, c0, c1] = &mut rooms.model;
        let mut renderer = ModelRenderer::new(PipeMemory {
            z: [z0, z1],
            rgb: [c0, c1],
        });
        let background = Rgb565Be::from_rgb8(shot.background());
        let sent = draw_model_frame(&scene, &mut renderer, self.pump, background, self.lines);
        assert!(sent.is_ok(), "{LARGE}");
    }

    /// A scene in other pixels than those of the pump.
    #[inline(never)]
    fn in_format(&mut self, format: InFormat, rooms: &mut Rooms) {
        let (scene, lines, caches) = (&mut rooms.scene, &mut rooms.lines, &mut rooms.caches);
        match format {
            InFormat::Suite(suite) if suite.texture().is_some() => {
                self.suite_in_format(suite, scene, lines.renderer(caches.true_texels));
            }
            InFormat::Suite(suite) => {
                self.suite_in_format(suite, scene, lines.renderer(caches.true_colour));
            }
            InFormat::SuiteNumbers(suite) => {
                self.suite_in_format(suite, scene, lines.renderer(caches.numbers));
            }
            InFormat::Slivers => {
                let (renderer, shot) = (lines.renderer(caches.true_colour), Shot::Slivers);
                self.built(scene, renderer, shot.background(), &|scene| {
                    shot.build(scene)
                });
            }
            InFormat::LitBytes => self.lit(scene, lines.renderer(caches.lit_bytes)),
            InFormat::LitWords => self.lit(scene, lines.renderer(caches.lit_words)),
            InFormat::Grey => self.smooth_in_format(scene, lines.renderer(caches.grey)),
            InFormat::Numbers => self.smooth_in_format(scene, lines.renderer(caches.numbers)),
        }
    }

    fn suite_in_format<L: Look>(
        &mut self,
        suite: Suite,
        rooms: &mut SceneRooms,
        renderer: Renderer<'_, L>,
    ) {
        let build: Build<'_, L> = &|scene| build_in_format(suite, scene);
        self.built(rooms, renderer, suite.background(), build);
    }

    fn smooth_in_format<L: Look>(&mut self, rooms: &mut SceneRooms, renderer: Renderer<'_, L>) {
        let background = Suite::Teapot.background();
        self.built(rooms, renderer, background, &|scene| build_smooth(scene));
    }

    /// A scene, and all lines of it as they are drawn.
    #[inline(never)]
    fn built<L: Look>(
        &mut self,
        rooms: &mut SceneRooms,
        renderer: Renderer<'_, L>,
        background: [u8; 3],
        build: Build<'_, L>,
    ) {
        let mut scene = rooms.scene();
        build(&mut scene).expect(LARGE);
        self.pixels(&scene, renderer, background);
    }

    /// With light at each pixel, which lives as long as the draw states.
    #[inline(never)]
    fn lit<L: Look>(&mut self, rooms: &mut SceneRooms, renderer: Renderer<'_, L>) {
        let lamps = teapot_lamps().expect(LARGE);
        let mut draws = [const { DrawState::EMPTY }; 4];
        let mut scene = rooms.lent(&mut draws);
        build_lit(&lamps, &mut scene).expect(LARGE);
        self.pixels(&scene, renderer, Suite::Teapot.background());
    }

    /// All lines of a scene as they are drawn, a line a transfer.
    fn pixels<L: Look>(
        &mut self,
        scene: &Scene<'_, '_, L>,
        mut renderer: Renderer<'_, L>,
        background: [u8; 3],
    ) {
        let background = L::Pixel::from_rgb8(background);
        let mut pixels = [background; WIDTH as usize];
        self.pump.sink_mut().to.begin();
        for line in scene.lines() {
            let drawn = renderer.draw_line(scene, line, &mut pixels, background);
            drawn.expect(LARGE);
            let bytes = bytemuck::cast_slice(&pixels);
            self.pump.sink_mut().to.transfer(bytes);
        }
    }

    /// Draws all lines of a scene, which cost what they may, where that is said.
    #[inline(never)]
    fn send_paced<L: Look<Pixel = Rgb565Be>, const WORDS: usize>(
        &mut self,
        scene: &Scene<'_, '_, L>,
        mut renderer: Renderer<'_, L, WORDS>,
        background: [u8; 3],
    ) {
        match self.pace {
            Some(pace) => self.send(scene, &mut renderer.paced(pace), background),
            None => self.send(scene, &mut renderer, background),
        }
    }

    /// Draws all lines of a scene.
    #[inline(never)]
    fn send<L: Look<Pixel = Rgb565Be>, const WORDS: usize>(
        &mut self,
        scene: &Scene<'_, '_, L>,
        renderer: &mut Renderer<'_, L, WORDS>,
        background: [u8; 3],
    ) {
        let background = Rgb565Be::from_rgb8(background);
        draw_frame(scene, renderer, self.pump, background, self.lines).expect(LARGE);
    }

    /// A list; it is looked at before.
    #[inline(never)]
    fn played(&mut self, played: Played, rooms: &mut Rooms) {
        let (begin, background) = (ListCommand::Start(0), played.background());
        match played {
            Played::Crate | Played::CrateOwn => {
                let mut scene = rooms.scene.scene();
                rooms.wood.set(played.settings());
                played
                    .play(&mut rooms.wood, begin, &mut scene)
                    .expect(LARGE);
                let mut renderer = rooms.lines.renderer(rooms.caches.textured);
                self.send(&scene, &mut renderer, background);
            }
            Played::Teapot | Played::TeapotMeshlets => {
                let mut scene = rooms.scene.scene();
                played
                    .play(&mut rooms.teapot, begin, &mut scene)
                    .expect(LARGE);
                let mut renderer = rooms.lines.renderer(rooms.caches.smooth);
                self.send(&scene, &mut renderer, background);
            }
        }
    }

    /// A small frame of what few draw calls have.
    #[inline(never)]
    fn values(&mut self, values: Values, rooms: &mut Rooms) {
        let (scene, lines, caches) = (&mut rooms.scene, &mut rooms.lines, &mut rooms.caches);
        let lent = ValuesMemory {
            vertices: scene.vertices,
            places: scene.places,
            objects: scene.objects,
            links: lines.links,
            bins: scene.bins,
            depth: lines.depth,
            shown: rooms.shown,
            smooth: caches.smooth,
            textured: caches.textured,
            lit: caches.lit,
            lit_texels: caches.lit_texels,
            indexed: caches.indexed,
            banded: caches.banded,
        };
        let drawn = values.draw(lent, self.pump);
        assert!(drawn.is_ok(), "{LARGE}");
    }
}

/// A sink that is done as soon as it starts.
pub(crate) struct Emit<'e> {
    to: &'e mut dyn Receives,
    sent: Option<&'static mut [u16]>,
}

impl<'e> Emit<'e> {
    /// It hands on what it is sent.
    pub(crate) fn new(to: &'e mut dyn Receives) -> Self {
        Self { to, sent: None }
    }
}

impl ScanoutDma for Emit<'_> {
    type Error = Infallible;
    type Buf = &'static mut [u16];

    fn begin(&mut self, _: Window) -> Result<(), Infallible> {
        self.to.begin();
        Ok(())
    }

    fn start(&mut self, line: Self::Buf, len: usize) -> Result<(), (Infallible, Self::Buf)> {
        self.to.transfer(bytemuck::cast_slice(&line[..len]));
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
