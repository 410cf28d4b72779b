//! The frames that this firmware draws, by name.

use crate::choices::{draw_b, draw_b_cached, draw_seen, draw_suite};
use crate::lean::{draw_lean, draw_played, draw_values};
use crate::rooms::{EffectRooms, Rooms, RoomsOf, SLOTS};
use core::convert::Infallible;
use core::task::Poll;
use scanbeam::pipeline::parallel::{Crew, Interleave};
use scanbeam::pipeline::send::send_frame;
use scanbeam::pipeline::texture::Textures;
use scanbeam::pipeline::{
    BlockFixed, Deferred, FlatDepth, GouraudDepth, Interpolated, Interpolation, LineMemory,
    LineRenderer, Pipeline, Quality, Scene, SceneMemory, Worded, draw_frame,
};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scan_out::{ErrorType, Pump, ScanoutDma, Window};
use scanbeam_model::{ModelRenderer, PipeMemory, draw_model_frame};
use scenes::{
    DEPTHS, DrawsEffect, DrawsMethod, EFFECTS, Grainy, KeepsDepth, LEAN, LookB, METHODS, PLAYED,
    Played, SCENE_B_BLOCKS, SCENES_B, SHOTS, STRESS, SUITE, SceneB, Shot, ShotError, Suite,
    TEXTURES_B, Transparent, VALUES, VARIANTS, Values, Variant, build_method, by_effect, by_method,
    method_screen,
};

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
    /// A small frame by this interpolation method of the scenes' table.
    Method(usize),
    /// A small frame of this effect of the scenes' table.
    Effect(usize),
    /// With depth kept in another way.
    Depth(KeepsDepth),
    /// A way to draw scene B.
    B(SceneB),
    /// Scene B from blocks through a cache.
    BlocksB,
    /// A scene of the suite, as it is measured.
    Suite(Suite),
    /// The same in the new rooms.
    Lean(Suite),
    /// A small frame of what few draw calls have in them.
    Values(Values),
    /// A list that is played in the new rooms.
    Played(Played),
}

/// One frame: how a shot is drawn.
#[derive(Clone, Copy)]
pub(crate) struct Frame {
    pub(crate) name: &'static str,
    how: Variant,
    way: Way,
}

/// Every frame, in the order in which they are drawn: the suite, the same, lists and
/// what few draw calls have in the new rooms, all other shots, those of stress
/// too, then flat faces and one by the hardware model, then what the cache and its
/// renderers must not change, then the interpolation methods and effects, other depths, and scene B.
pub(crate) fn frames() -> impl Iterator<Item = Frame> {
    let plain = |name, shot, way| Frame {
        name,
        how: Variant {
            name,
            shot,
            slots: SLOTS,
            renderers: 1,
            prefetch: 0,
        },
        way,
    };
    let suite = SUITE.map(|suite| plain(suite.name(), Shot::Sphere, Way::Suite(suite)));
    let lean = LEAN.map(|(name, suite)| plain(name, Shot::Sphere, Way::Lean(suite)));
    let values = VALUES.map(|(name, values)| plain(name, Shot::Sphere, Way::Values(values)));
    let played = PLAYED.map(|(name, list)| plain(name, Shot::Teapot, Way::Played(list)));
    let measured = |shot: &Shot| SUITE.iter().any(|suite| suite.name() == shot.name());
    let shots = SHOTS.into_iter().filter(move |shot| !measured(shot));
    let shots = shots.chain(STRESS);
    let variants = VARIANTS.into_iter().map(|how| Frame {
        name: how.name,
        how,
        way: Way::Smooth,
    });
    suite
        .into_iter()
        .chain(lean)
        .chain(values)
        .chain(played)
        .chain(shots.map(move |shot| plain(shot.name(), shot, Way::Smooth)))
        .chain([
            plain("teapot_flat", Shot::Teapot, Way::Faceted),
            plain("teapot_model", Shot::Teapot, Way::Model),
            plain("crossings_flat", Shot::Crossings, Way::Faceted),
        ])
        .chain(variants)
        .chain(
            (0..)
                .zip(METHODS)
                .map(move |(index, name)| plain(name, Shot::Quads, Way::Method(index))),
        )
        .chain(
            (0..)
                .zip(EFFECTS)
                .map(move |(index, name)| plain(name, Shot::Quads, Way::Effect(index))),
        )
        .chain(DEPTHS.map(|(name, shot, keeps)| plain(name, shot, Way::Depth(keeps))))
        .chain(SCENES_B.map(|scene| plain(scene.name, Shot::Sphere, Way::B(scene))))
        .chain([plain(SCENE_B_BLOCKS.name, Shot::Sphere, Way::BlocksB)])
}

impl Frame {
    /// Draws the frame and hands the bytes of each transfer, in order, to `emit`. Drawing twice
    /// gives the same bytes.
    pub(crate) fn draw(&self, rooms: &mut Rooms, emit: &mut dyn FnMut(&[u8])) {
        let buffers = rooms.lines.take().expect("the last frame gave them back");
        let mut pump = Pump::new(Emit { emit, sent: None }, buffers);
        match self.way {
            Way::Faceted => {
                let rooms = &mut rooms.faceted;
                draw_as::<Faceted, _>(&self.how, rooms, &mut pump, LINES_PER_TRANSFER);
            }
            Way::Model => draw_by_model(self.how.shot, rooms, &mut pump),
            Way::Method(index) => by_method(
                index,
                &mut SmallFrame {
                    rooms: &mut rooms.smooth,
                    pump: &mut pump,
                },
            ),
            Way::Effect(index) => {
                let mut small = SmallEffect {
                    rooms: &mut rooms.effects,
                    pump: &mut pump,
                };
                by_effect(index, &mut small);
            }
            Way::Depth(KeepsDepth::BlockFix) => {
                let (rooms, cells) = (&mut rooms.smooth, &mut *rooms.block_fix);
                draw_seen::<BlockFixed<Smooth>, _>(self.how.shot, rooms, cells, &mut pump);
            }
            Way::Depth(KeepsDepth::Word) => {
                // Names are words too.
                let (rooms, cells) = (&mut rooms.smooth, &mut *rooms.named);
                draw_seen::<Worded<Smooth>, _>(self.how.shot, rooms, cells, &mut pump);
            }
            Way::Depth(KeepsDepth::Deferred) => {
                let (rooms, cells) = (&mut rooms.smooth, &mut *rooms.named);
                draw_seen::<Deferred<Smooth>, _>(self.how.shot, rooms, cells, &mut pump);
            }
            Way::B(scene) => {
                let (textures, rooms) = (Textures(&TEXTURES_B), &mut rooms.textured);
                draw_b::<LookB, _>(scene, textures, rooms, &mut pump, LINES_PER_TRANSFER);
            }
            Way::BlocksB => draw_b_cached(rooms, &mut pump),
            Way::Suite(suite) => draw_suite(suite, rooms, &mut pump),
            Way::Lean(suite) => draw_lean(suite, rooms, &mut pump),
            Way::Values(values) => draw_values(values, rooms, &mut pump),
            Way::Played(list) => draw_played(list, rooms, &mut pump),
            Way::Smooth if self.how.renderers == 1 && self.how.slots <= SLOTS => {
                let rooms = &mut rooms.smooth;
                draw_as::<Smooth, _>(&self.how, rooms, &mut pump, LINES_PER_TRANSFER);
            }
            Way::Smooth => {
                // The larger cache, and the second link column and line of depth.
                let [small, large] = [&mut rooms.smooth, &mut rooms.second];
                core::mem::swap(&mut small.slots, &mut large.slots);
                if self.how.renderers == 1 {
                    draw_as::<Smooth, _>(&self.how, small, &mut pump, LINES_PER_TRANSFER);
                } else {
                    draw_by_two(&self.how, small, large, &mut pump);
                }
                core::mem::swap(&mut small.slots, &mut large.slots);
            }
        }
        if let (_, [Some(a), Some(b)]) = pump.release() {
            rooms.lines = Some([a, b]);
        }
    }
}

/// Draws a shot alone, as `how` says, so many lines a transfer.
pub(crate) fn draw_as<P, D>(
    how: &Variant,
    rooms: &mut RoomsOf<P>,
    pump: &mut Pump<D>,
    lines_per_transfer: u16,
) where
    P: Pipeline<Pixel = Rgb565Be>,
    D: ScanoutDma<Buf = &'static mut [u16]>,
{
    let (mut scene, mut renderer) = rooms.lend::<P>(Shot::screen(), how.slots);
    how.shot
        .build(&mut scene)
        .expect("the rooms are large enough");
    renderer.set_prefetch(how.prefetch);
    let background = Rgb565Be::from_rgb8(how.shot.background());
    draw_frame(&scene, &mut renderer, pump, background, lines_per_transfer)
        .expect("the sink cannot fail and the rooms are large enough");
}

/// A small frame in the rooms of large ones.
struct SmallFrame<'a, 'e> {
    rooms: &'a mut RoomsOf<Smooth>,
    pump: &'a mut Pump<Emit<'e>>,
}

impl DrawsMethod for SmallFrame<'_, '_> {
    fn draw<I: Interpolation>(&mut self, quality: Quality) {
        // Records are those of any method.
        type By<I> = Interpolated<Smooth, I>;
        let rooms = &mut *self.rooms;
        let (mut scene, mut renderer) = rooms.lend::<By<I>>(method_screen(), SLOTS);
        build_method(&mut scene).expect("the rooms are large enough");
        renderer.set_quality(quality);
        draw_frame(&scene, &mut renderer, self.pump, 0, LINES_PER_TRANSFER)
            .expect("the sink cannot fail and the rooms are large enough");
    }
}

/// A small frame of an effect.
struct SmallEffect<'a, 'e> {
    rooms: &'a mut EffectRooms,
    pump: &'a mut Pump<Emit<'e>>,
}

impl DrawsEffect for SmallEffect<'_, '_> {
    fn transparent(
        &mut self,
        build: impl Fn(&mut Scene<'_, Transparent>) -> Result<(), ShotError>,
    ) {
        draw_effect::<Transparent>(&mut self.rooms.transparent, self.pump, build);
    }

    fn grainy(&mut self, build: impl Fn(&mut Scene<'_, Grainy>) -> Result<(), ShotError>) {
        draw_effect::<Grainy>(&mut self.rooms.grainy, self.pump, build);
    }
}

fn draw_effect<P: Pipeline<Pixel: PixelFormat<Word = u16>>>(
    rooms: &mut RoomsOf<P>,
    pump: &mut Pump<Emit<'_>>,
    build: impl Fn(&mut Scene<'_, P>) -> Result<(), ShotError>,
) {
    let (mut scene, mut renderer) = rooms.lend::<P>(method_screen(), SLOTS);
    build(&mut scene).expect("the rooms are large enough");
    draw_frame(&scene, &mut renderer, pump, 0, LINES_PER_TRANSFER)
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

/// Two renderers of one scene take turns, as they would on two cores.
#[inline(never)]
fn draw_by_two(
    how: &Variant,
    rooms: &mut RoomsOf<Smooth>,
    other: &mut RoomsOf<Smooth>,
    pump: &mut Pump<Emit<'_>>,
) {
    let mut scene = Scene::<Smooth>::new(
        Shot::screen(),
        SceneMemory {
            vertices: rooms.vertices,
            objects: rooms.objects,
            buckets: rooms.buckets,
        },
    );
    how.shot
        .build(&mut scene)
        .expect("the rooms are large enough");
    let memory = [
        (&mut *rooms.slots, &mut *rooms.links, &mut *rooms.depth),
        (&mut *other.slots, &mut *other.links, &mut *other.depth),
    ];
    let mut offset = 0;
    let mut renderers = memory.map(|(slots, links, depth)| {
        let slots = &mut slots[..how.slots];
        let mut renderer = LineRenderer::new(LineMemory {
            slots,
            links,
            depth,
        });
        renderer.set_interleave(Interleave::lines(2, offset).unwrap_or_default());
        renderer.set_prefetch(how.prefetch);
        offset += 1;
        renderer
    });
    let mut crew = Crew {
        scene: &scene,
        here: &mut renderers,
        background: Rgb565Be::from_rgb8(how.shot.background()),
        skipped: 0,
    };
    send_frame(&scene, &mut crew, pump, LINES_PER_TRANSFER)
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
