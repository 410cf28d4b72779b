//! The picture never changes: any cache size, any number of renderers, any interleave, anything
//! fetched ahead or not, on one thread or on several (C4, C5, K16, X6).

use crate::common::{self, LineRooms, Rng, SceneRooms};
use host_tests::crew;
use host_tests::mock::{HostLine, MockFrameBuffer};
use scanbeam::pipeline::parallel::{Crew, Interleave, LineSource};
use scanbeam::pipeline::{
    Counted, FlatPainter, FrameStats, GouraudDepth, Instance, LineRenderer, Pipeline,
    RendererError, Scene, WordOf, draw_frame,
};
use scanbeam::pixel::{Rgb565Be, Rgb888};
use scanbeam::scan_out::Pump;
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};

type Depth = Counted<GouraudDepth<Rgb888>>;
type Painter = FlatPainter<Rgb565Be>;

const CACHES: [usize; 7] = [0, 1, 2, 3, 7, 16, 64];
const BUDGETS: [u32; 4] = [0, 60, 300, u32::MAX];

/// Triangles of a mesh, by what lines they are on.
#[derive(Clone, Copy, Debug)]
enum Kind {
    /// Any.
    Mixed,
    /// About the size of a pixel.
    Small,
    /// From top to bottom and beyond.
    Tall,
    /// Flat, all at one height.
    OneLine,
}

struct Soup {
    positions: Vec<[i16; 3]>,
    colours: Vec<[u8; 3]>,
    faces: Vec<[u16; 3]>,
}

impl Soup {
    fn new(rng: &mut Rng, kind: Kind, triangles: usize) -> Self {
        let mut soup = Self {
            positions: Vec::new(),
            colours: Vec::new(),
            faces: Vec::new(),
        };
        let size = rng.pick(&[300, 3000, 30_000]);
        let band = rng.within(-9000, 9000);
        for _ in 0..triangles {
            let at = [0; 3].map(|_| rng.within(-16_384, 16_384));
            let corner = |rng: &mut Rng| {
                let p = match kind {
                    Kind::Mixed => at.map(|c| c + rng.within(-size, size)),
                    Kind::Small => at.map(|c| c + rng.within(-120, 120)),
                    Kind::Tall => [at[0] + rng.within(-900, 900), 0, at[2]],
                    Kind::OneLine => [at[0] + rng.within(-900, 900), band, at[2]],
                };
                p.map(|c| c.clamp(-32_768, 32_767) as i16)
            };
            let mut corners = [0; 3].map(|_| corner(rng));
            match kind {
                Kind::Tall => (corners[0][1], corners[1][1]) = (32_767, -32_768),
                Kind::OneLine => corners[2][1] += 100,
                _ => {}
            }
            let first = soup.positions.len() as u16;
            soup.positions.extend(corners);
            soup.colours
                .extend([0; 3].map(|_| [0; 3].map(|_| rng.below(256) as u8)));
            soup.faces.push([first, first + 1, first + 2]);
        }
        soup
    }

    fn build<P: Pipeline>(&self, scene: &mut Scene<'_, P>) {
        let camera = Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 40.0, 0.5, 50.0);
        scene.begin(&camera.unwrap()).unwrap();
        let mesh = Mesh {
            positions: &self.positions,
            normals: &[],
            colours: &self.colours,
            faces: Faces::Triangles(&self.faces),
        };
        let instance = Instance {
            cull: Cull::None,
            ..Instance::default()
        };
        scene.draw(&mesh, &instance).unwrap();
    }

    fn rooms<P: Pipeline>(&self, screen: Screen) -> SceneRooms<P> {
        let count = self.faces.len();
        SceneRooms::new(9 * count + 9, 4 * count + 4, usize::from(screen.height()))
    }
}

/// The frame as one renderer draws it that never misses a slot.
fn reference<P: Pipeline>(scene: &Scene<'_, P>) -> Vec<Vec<WordOf<P>>> {
    common::frame(scene, 4095)
}

/// The frame as several renderers on one thread draw it.
fn by<P: Pipeline>(
    scene: &Scene<'_, P>,
    renderers: &mut [LineRenderer<'_, P>],
    budget: u32,
    rng: &mut Rng,
) -> Vec<Vec<WordOf<P>>> {
    for renderer in renderers.iter_mut() {
        renderer.restart();
    }
    let mut frame = Vec::new();
    for y in scene.lines() {
        for renderer in renderers.iter_mut() {
            // Anyone may fetch at any time, in steps.
            let next = renderer.interleave().at_or_after(u32::from(y));
            if budget > 0 && next < u32::from(scene.lines().end) && rng.below(3) > 0 {
                for _ in 0..=rng.below(2) {
                    let step = renderer.prefetch(scene, next as u16, budget).unwrap();
                    assert!(step.bytes <= budget);
                    if step.done {
                        break;
                    }
                }
            }
        }
        let own = renderers.iter_mut().find(|r| r.interleave().owns(y));
        frame.push(common::line(own.unwrap(), scene, y));
    }
    frame
}

fn all_ways<P: Pipeline>(soup: &Soup, screen: Screen, rng: &mut Rng)
where
    WordOf<P>: PartialEq + core::fmt::Debug,
{
    let mut rooms = soup.rooms::<P>(screen);
    let mut scene = rooms.scene(screen);
    soup.build(&mut scene);
    let expected = reference(&scene);
    for slots in CACHES {
        for count in 1..=4u16 {
            let mut line_rooms: Vec<_> = (0..count)
                .map(|_| LineRooms::<P>::fitting(slots, &scene))
                .collect();
            let mut renderers: Vec<_> = line_rooms.iter_mut().map(LineRooms::renderer).collect();
            for (budget, band) in BUDGETS.into_iter().zip([1, 1, 3, 5]) {
                for (offset, renderer) in renderers.iter_mut().enumerate() {
                    let lines = Interleave::bands(count, offset as u16, band);
                    renderer.set_interleave(lines.unwrap());
                }
                let frame = by(&scene, &mut renderers, budget, rng);
                assert!(
                    frame == expected,
                    "{slots} slots, {count} renderers, {budget} bytes ahead, bands of {band}"
                );
                for renderer in &renderers {
                    let counts = renderer.cache_counts();
                    assert!(counts.peak_slots as usize <= slots);
                    assert!(slots > 0 || counts.hits + counts.fetched == 0);
                    assert!(budget > 0 || counts.fetched == 0);
                }
            }
        }
    }
}

#[test]
fn any_cache_any_renderers_any_prefetch_give_the_same_picture() {
    let screen = Screen::new(61, 47).unwrap();
    for seed in 0..24 {
        let mut rng = Rng::new(seed);
        let kind = rng.pick(&[Kind::Mixed, Kind::Small, Kind::Tall, Kind::OneLine]);
        let count = rng.pick(&[0, 1, 9, 60, 150]);
        let soup = Soup::new(&mut rng, kind, count);
        all_ways::<Depth>(&soup, screen, &mut rng);
        all_ways::<Painter>(&soup, screen, &mut rng);
    }
}

#[test]
fn lines_in_any_order_with_fetches_between() {
    let screen = Screen::new(40, 32).unwrap();
    for seed in 0..40 {
        let mut rng = Rng::new(500 + seed);
        let soup = Soup::new(&mut rng, Kind::Mixed, 50);
        let mut rooms = soup.rooms::<Depth>(screen);
        let mut scene = rooms.scene(screen);
        soup.build(&mut scene);
        let expected = reference(&scene);
        let mut line_rooms = LineRooms::<Depth>::fitting(rng.pick(&CACHES), &scene);
        let mut renderer = line_rooms.renderer();
        for _ in 0..200 {
            let y = rng.below(32) as u16;
            match rng.below(4) {
                0 => {
                    let lines = Interleave::bands(3, rng.below(3) as u16, 1 + rng.below(3) as u16);
                    renderer.set_interleave(lines.unwrap());
                }
                1 => {
                    let budget = rng.below(400);
                    let step = renderer.prefetch(&scene, y, budget).unwrap();
                    assert!(step.bytes <= budget);
                }
                _ => {
                    let drawn = common::line(&mut renderer, &scene, y);
                    assert!(drawn == expected[usize::from(y)], "seed {seed}, line {y}");
                }
            }
        }
    }
}

#[test]
fn hosts_of_objects() {
    let screen = Screen::new(64, 40).unwrap();
    for kind in [Kind::OneLine, Kind::Tall, Kind::Small] {
        let mut rng = Rng::new(77);
        let soup = Soup::new(&mut rng, kind, 10_000);
        let mut rooms = soup.rooms::<Depth>(screen);
        let mut scene = rooms.scene(screen);
        soup.build(&mut scene);
        let expected = reference(&scene);
        for (slots, count, budget) in [(4, 1, 0), (4, 1, 5_000), (4, 3, 500), (0, 2, 0)] {
            let mut line_rooms: Vec<_> = (0..count)
                .map(|_| LineRooms::fitting(slots, &scene))
                .collect();
            let mut renderers: Vec<_> = line_rooms.iter_mut().map(LineRooms::renderer).collect();
            for (offset, renderer) in renderers.iter_mut().enumerate() {
                renderer.set_interleave(Interleave::lines(count, offset as u16).unwrap());
            }
            let frame = by(&scene, &mut renderers, budget, &mut rng);
            assert!(frame == expected, "{kind:?}, {slots} slots, {count}");
        }
    }
}

#[test]
fn prefetch_is_bounded_goes_on_and_is_counted() {
    let screen = Screen::new(64, 40).unwrap();
    let soup = Soup::new(&mut Rng::new(5), Kind::Tall, 20);
    let mut rooms = soup.rooms::<Depth>(screen);
    let mut scene = rooms.scene(screen);
    soup.build(&mut scene);
    let record = LineRenderer::<Depth>::RECORD_BYTES as u32;
    let mut line_rooms = LineRooms::<Depth>::fitting(64, &scene);
    let mut renderer = line_rooms.renderer();
    // The head of the bucket is 2 bytes; what is left is not a record.
    let step = renderer.prefetch(&scene, 0, record + 1).unwrap();
    assert_eq!((step.bytes, step.done), (2, false));
    let mut steps = 0;
    while !renderer.prefetch(&scene, 0, 2 * record).unwrap().done {
        steps += 1;
        assert!(steps < 100);
    }
    let objects = scene.pass_one().objects;
    assert_eq!(renderer.cache_counts().fetched, objects);
    let drawn = common::line(&mut renderer, &scene, 0);
    assert!(drawn == reference(&scene)[0]);
    let counts = renderer.cache_counts();
    assert_eq!(counts.fetched_hits, objects);
    assert_eq!((counts.misses, counts.hits), (0, objects));
    // A line above what was drawn or fetched: nothing is done, and nothing breaks.
    let step = renderer.prefetch(&scene, 0, u32::MAX).unwrap();
    assert_eq!((step.bytes, step.done), (0, true));
    assert_eq!(
        renderer.prefetch(&scene, 40, 9),
        Err(RendererError::Line { line: 40 })
    );
    let mut short = LineRooms::<Depth>::new(4, 1, 64);
    let error = short.renderer().prefetch(&scene, 0, 9);
    assert!(
        matches!(error, Err(RendererError::Links { .. })),
        "{error:?}"
    );
}

fn pump<W: Copy + Default + 'static>(screen: Screen, lines: u16) -> Pump<MockFrameBuffer<W>> {
    let (width, height) = (screen.width(), screen.height());
    let line = || HostLine::new(usize::from(width) * usize::from(lines));
    Pump::new(
        MockFrameBuffer::new(width, height).late_by(2),
        [line(), line()],
    )
}

#[test]
fn the_conductor_fetches_between_lines() {
    let screen = Screen::new(61, 47).unwrap();
    let soup = Soup::new(&mut Rng::new(9), Kind::Mixed, 60);
    let mut rooms = soup.rooms::<Depth>(screen);
    let mut scene = rooms.scene(screen);
    soup.build(&mut scene);
    let expected: Vec<_> = reference(&scene).concat();
    let mut last: Option<FrameStats> = None;
    for budget in BUDGETS {
        let mut line_rooms = LineRooms::<Depth>::fitting(32, &scene);
        let mut renderer = line_rooms.renderer();
        renderer.set_prefetch(budget);
        let mut pump = pump(screen, 4);
        let stats = draw_frame(&scene, &mut renderer, &mut pump, [0; 3], 4).unwrap();
        assert!(pump.sink().frame().unwrap() == expected, "{budget}");
        assert_eq!(stats.cache.fetched > 0, budget > 0);
        assert_eq!(stats.prefetch_bytes > 0, budget > 0);
        if let Some(last) = last {
            // The more is fetched ahead, the less is missed.
            assert!(stats.cache.misses <= last.cache.misses, "{budget}");
            let all = |s: &FrameStats| s.cache.hits + s.cache.misses;
            assert_eq!(all(&stats), all(&last));
            assert!(budget < 300 || stats.cache.misses < last.cache.hits / 2);
        }
        last = Some(stats);
    }
}

#[test]
fn renderers_and_scenes_may_cross_threads() {
    fn send<T: Send>() {}
    fn sync<T: Sync>() {}
    send::<LineRenderer<'static, Depth>>();
    send::<Scene<'static, Depth>>();
    sync::<Scene<'static, Depth>>();
    send::<scanbeam::input::Source<'static, 'static>>();
    send::<scanbeam::input::Stream<'static, 'static>>();
}

/// A frame by `count` renderers, each on a thread of its own.
fn threaded<P: Pipeline<Textures: Sync>>(
    scene: &Scene<'_, P>,
    count: u16,
    (slots, budget, band): (usize, u32, u16),
) -> Vec<WordOf<P>>
where
    WordOf<P>: Send,
{
    let mut line_rooms: Vec<_> = (0..count)
        .map(|_| LineRooms::<P>::fitting(slots, scene))
        .collect();
    let mut renderers: Vec<_> = line_rooms.iter_mut().map(LineRooms::renderer).collect();
    for (offset, renderer) in renderers.iter_mut().enumerate() {
        renderer.set_interleave(Interleave::bands(count, offset as u16, band).unwrap());
        renderer.set_prefetch(budget);
    }
    let mut pump = pump(scene.screen(), 3);
    let background = Default::default();
    crew::draw_frame(scene, &mut renderers, &mut pump, background, 3).unwrap();
    pump.sink().frame().unwrap()
}

#[test]
fn threads_draw_one_scene() {
    let screen = Screen::new(61, 47).unwrap();
    for seed in 0..6 {
        let mut rng = Rng::new(900 + seed);
        let soup = Soup::new(&mut rng, Kind::Mixed, 80);
        let mut rooms = soup.rooms::<Depth>(screen);
        let mut scene = rooms.scene(screen);
        soup.build(&mut scene);
        let expected = reference(&scene).concat();
        for count in 1..=4 {
            let band = 1 + rng.below(4) as u16;
            let settings = (rng.pick(&CACHES), rng.pick(&BUDGETS), band);
            let frame = threaded(&scene, count, settings);
            assert!(frame == expected, "seed {seed}, {count}, {settings:?}");
        }
    }
}

#[test]
fn a_crew_says_who_is_missing() {
    let screen = Screen::new(8, 8).unwrap();
    let soup = Soup::new(&mut Rng::new(1), Kind::Mixed, 5);
    let mut rooms = soup.rooms::<Depth>(screen);
    let mut scene = rooms.scene(screen);
    soup.build(&mut scene);
    let mut line_rooms = LineRooms::<Depth>::fitting(4, &scene);
    let mut renderer = line_rooms.renderer();
    renderer.set_interleave(Interleave::lines(4, 1).unwrap());
    let mut crew = Crew {
        scene: &scene,
        here: &mut [renderer],
        background: [0; 3],
        skipped: 0,
    };
    let mut pixels = [[0; 3]; 8];
    let unowned = |line| Err(RendererError::Unowned { line });
    assert_eq!(crew.line(0, &mut pixels), unowned(0));
    assert_eq!(crew.line(1, &mut pixels), Ok(()));
    assert_eq!(crew.line(2, &mut pixels), unowned(2));
    let short = RendererError::Pixels { needed: 8, have: 7 };
    assert_eq!(crew.line(5, &mut pixels[..7]), Err(short));
}
