//! The picture never changes: any cache size, any number of renderers, any interleave, on one thread or on several
//! (C5, C6, K16, X6).

use crate::common::Rng;
use crate::hot::cover::L;
use crate::hot::ways::{Lines, SLOTS};
use crate::hot::{LineRooms, SceneRooms, Smooth, WordOf, frame, line};
use scanbeam::look::{Gouraud, Look};
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{Draw, Scene};
use scanbeam::{Camera, Cull, Faces, Mesh, Renderer, Screen};

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

    fn scene<'m, L: Look>(
        &self,
        rooms: &'m mut SceneRooms,
        screen: Screen,
    ) -> Scene<'m, 'static, L> {
        let mut scene = rooms.scene(screen);
        let camera = Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 40.0, 0.5, 50.0);
        scene.begin(&camera.unwrap()).unwrap();
        let call = Draw {
            cull: Cull::None,
            ..Draw::new(Mesh {
                positions: &self.positions,
                normals: &[],
                colours: &self.colours,
                faces: Faces::Triangles(&self.faces),
            })
        };
        scene.draw(&call).unwrap();
        scene
    }

    fn rooms(&self, screen: Screen) -> SceneRooms {
        let count = self.faces.len();
        SceneRooms::new(9 * count + 9, 4 * count + 4, screen.height().into(), 1)
    }
}

fn all_ways<L: Smooth>(soup: &Soup, screen: Screen, rng: &mut Rng)
where
    WordOf<L>: std::fmt::Debug,
{
    let mut rooms = soup.rooms(screen);
    let scene = soup.scene::<L>(&mut rooms, screen);
    for depth in [true, false] {
        let lines = Lines {
            scene: &scene,
            depth,
            background: L::Format::from_rgb8([1, 2, 3]),
        };
        let want = lines.whole("whole");
        for count in 1..=4 {
            for band in [1, 3, 5] {
                lines.by_several(&want, count, band, rng, "soup");
            }
        }
        lines.every_way(&want, rng, "soup");
    }
}

#[test]
fn any_cache_any_renderers_give_the_same_picture() {
    let screen = Screen::new(61, 47).unwrap();
    for seed in 0..24 {
        let mut rng = Rng::new(seed);
        let kind = rng.pick(&[Kind::Mixed, Kind::Small, Kind::Tall, Kind::OneLine]);
        let count = rng.pick(&[0, 1, 9, 60, 150]);
        let soup = Soup::new(&mut rng, kind, count);
        all_ways::<L>(&soup, screen, &mut rng);
        all_ways::<Gouraud<Rgb565Be>>(&soup, screen, &mut rng);
    }
}

/// Far more triangles on one line than any cache has slots.
#[test]
fn hosts_of_objects() {
    let screen = Screen::new(64, 40).unwrap();
    for kind in [Kind::OneLine, Kind::Tall, Kind::Small] {
        let mut rng = Rng::new(77);
        let soup = Soup::new(&mut rng, kind, 10_000);
        let mut rooms = soup.rooms(screen);
        let scene = soup.scene::<L>(&mut rooms, screen);
        let want = frame(&scene, 128, true, [0; 3]);
        for slots in [0, 4] {
            assert!(frame(&scene, slots, true, [0; 3]) == want, "{kind:?}");
        }
        let lines = Lines {
            scene: &scene,
            depth: true,
            background: [0; 3],
        };
        lines.by_several(&want, 3, 1, &mut rng, "host");
    }
}

/// The lines that one of several threads has, in bands that go around.
fn share(
    scene: &Scene<'_, 'static, L>,
    slots: u16,
    is_own: impl Fn(u16) -> bool,
) -> Vec<(u16, Vec<[u8; 3]>)> {
    let mut rooms = LineRooms::fitting(scene, slots, true);
    let mut renderer = rooms.renderer();
    let own = scene.lines().filter(|&y| is_own(y));
    own.map(|y| (y, line(&mut renderer, scene, y, [0; 3])))
        .collect()
}

#[test]
fn threads_draw_one_scene() {
    let screen = Screen::new(61, 47).unwrap();
    for seed in 0..6 {
        let mut rng = Rng::new(900 + seed);
        let soup = Soup::new(&mut rng, Kind::Mixed, 80);
        let mut rooms = soup.rooms(screen);
        let scene = &soup.scene::<L>(&mut rooms, screen);
        let want = frame(scene, 128, true, [0; 3]);
        for count in 1..=4 {
            let (slots, band) = (rng.pick(&SLOTS), 1 + rng.below(4) as u16);
            let mut shares: Vec<_> = std::thread::scope(|threads| {
                let started: Vec<_> = (0..count)
                    .map(|who| {
                        threads.spawn(move || share(scene, slots, |y| y / band % count == who))
                    })
                    .collect();
                let joined = started.into_iter().map(|thread| thread.join().unwrap());
                joined.flatten().collect()
            });
            shares.sort_by_key(|(y, _)| *y);
            let got: Vec<_> = shares.into_iter().map(|(_, line)| line).collect();
            assert!(got == want, "seed {seed}, {count} threads, {slots} slots");
        }
    }
}

#[test]
fn renderers_and_scenes_may_cross_threads() {
    fn send<T: Send>() {}
    fn sync<T: Sync>() {}
    send::<Renderer<'static, L, 4>>();
    send::<Scene<'static, 'static, L>>();
    sync::<Scene<'static, 'static, L>>();
    send::<scanbeam::input::Source<'static, 'static>>();
    send::<scanbeam::input::Stream<'static, 'static>>();
}
