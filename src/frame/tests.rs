//! A picture does not depend on the cache, nor a pixel on who else is on its line.

use super::{FastMemory, Memory as Lent, Renderer};
use crate::geometry::{Affine, Camera, Cull, Faces, Mesh, Screen};
use crate::link::Link;
use crate::look::{Gouraud, Look, Textured, WordOf};
use crate::num::random::Rng;
use crate::pixel::{PixelFormat, Rgb565, Rgb888};
use crate::scene::{
    Budget, Draw, DrawState, Memory, Object, Scene, Shadow, Skin, Texture, TexturePlace, Vertex,
};
use std::boxed::Box;
use std::vec::Vec;

mod kept;
mod paced;
mod shadowed;

const WIDTH: u16 = 96;

/// How scenes are seen: lines of the picture, the eye's distance from the middle, its focal length, and the near
/// distance.
#[derive(Clone, Copy)]
struct Seen {
    height: u16,
    distance: f32,
    focal: f32,
    near: f32,
}

/// From so near that triangles are large.
const WIDE: Seen = Seen {
    height: 40,
    distance: 2.2,
    focal: 60.0,
    near: 0.2,
};
/// From so far that some are small.
const NARROW: Seen = Seen {
    height: 96,
    distance: 2.5,
    focal: 200.0,
    near: 0.1,
};

/// Triangles of all sizes that cross each other.
struct Crowd {
    positions: Vec<[i16; 3]>,
    places: Vec<[i32; 2]>,
    colours: Vec<[u8; 3]>,
    faces: Vec<[u16; 3]>,
    priority: u8,
    shadow: Option<Shadow>,
}

impl Crowd {
    fn new(rng: &mut Rng, triangles: u16, priority: u8) -> Self {
        let mut crowd = Self {
            positions: Vec::new(),
            places: Vec::new(),
            colours: Vec::new(),
            faces: Vec::new(),
            priority,
            shadow: None,
        };
        for i in 0..triangles {
            let middle = [(); 3].map(|()| rng.below(40_000) as i32 - 20_000);
            let size = [2_000, 9_000, 30_000][rng.below(3) as usize];
            for _ in 0..3 {
                let at = middle.map(|m| m + rng.below(size) as i32 - size as i32 / 2);
                let at = at.map(|c| c.clamp(-32_768, 32_767) as i16);
                crowd.positions.push(at);
                crowd
                    .places
                    .push([(); 2].map(|()| rng.below(60 << 8) as i32));
                crowd.colours.push([(); 3].map(|()| rng.below(256) as u8));
            }
            crowd.faces.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        crowd
    }

    /// A few, of all sizes at all distances, of which some meet others and none is seen at an angle.
    fn sparse(rng: &mut Rng, triangles: u16) -> Self {
        let mut crowd = Self::new(rng, 0, 0);
        for i in 0..triangles {
            let mut at = |size: u32| rng.below(size) as i16 - (size / 2) as i16;
            let size = [600, 3000, 9000][usize::from(i) % 3];
            let middle = [at(24_000), at(24_000), at(20_000)];
            for _ in 0..3 {
                let place = [middle[0] + at(size), middle[1] + at(size), middle[2]];
                crowd.positions.push(place);
                crowd.colours.push([0; 3].map(|_| at(256) as u8));
            }
            crowd.faces.push([3 * i, 3 * i + 1, 3 * i + 2]);
        }
        crowd
    }
}

/// Calls `see` with a scene of these.
fn with_scene<L: Look>(
    seen: Seen,
    crowds: &[Crowd],
    texture: Option<&Texture<'_>>,
    see: impl FnOnce(&Scene<'_, '_, L>),
) {
    let mut vertices = std::vec![Vertex::EMPTY; 4_000];
    let mut places = std::vec![TexturePlace::EMPTY; 4_000];
    let mut objects = std::vec![Object::EMPTY; 2_000];
    // Behind the last line they have what another scene left.
    let mut bins = std::vec![0; usize::from(seen.height) + 10];
    let mut draws = [DrawState::EMPTY; 6];
    let screen = Screen::new(WIDTH, seen.height).unwrap();
    let memory = Memory {
        vertices: &mut vertices,
        places: &mut places,
        objects: &mut objects,
        bins: &mut bins,
        draws: &mut draws,
    };
    let mut scene = Scene::<L>::new(screen, memory);
    let (eye, up) = ([0.0, 0.0, seen.distance], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at(eye, [0.0; 3], up, seen.focal, seen.near, 100.0).unwrap();
    scene.begin(&camera).unwrap();
    for crowd in crowds {
        let call = Draw {
            model: Affine::IDENTITY,
            cull: Cull::None,
            texture: texture.map(|texture| Skin {
                texture,
                places: &crowd.places,
                budget: Budget::BALANCED,
            }),
            priority: crowd.priority,
            shadow: crowd.shadow,
            ..Draw::new(Mesh {
                positions: &crowd.positions,
                normals: &[],
                colours: &crowd.colours,
                faces: Faces::Triangles(&crowd.faces),
            })
        };
        scene.draw(&call).unwrap();
    }
    see(&scene);
}

/// The lines of a picture, in this order, with so many slots, and how often a triangle had none on a line.
fn lines<L: Look>(
    scene: &Scene<'_, '_, L>,
    slots: u16,
    depth: bool,
    order: &[u16],
) -> (Vec<Vec<WordOf<L>>>, u32) {
    let mut cache = Box::new(FastMemory::<L, 7>::new());
    cache.set_limit(slots);
    let mut links = std::vec![Link::NONE; scene.objects()];
    let mut depth = std::vec![0; if depth { WIDTH.into() } else { 0 }];
    let mut counts = [99; WIDTH as usize];
    let memory = Lent {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    };
    let mut renderer = Renderer::with_shadows(memory, &mut counts);
    let background = L::Pixel::from_rgb8([9, 9, 9]);
    let line = |&line: &u16| {
        let mut pixels = std::vec![WordOf::<L>::default(); WIDTH.into()];
        renderer
            .draw_line(scene, line, &mut pixels, background)
            .unwrap();
        pixels
    };
    let lines = order.iter().map(line).collect();
    (lines, renderer.counts().misses)
}

fn does_not_depend_on_the_cache<L: Look>(texture: Option<&Texture<'_>>, seed: u64)
where
    WordOf<L>: PartialEq,
{
    let mut rng = Rng(seed);
    let all: Vec<u16> = (0..WIDE.height).collect();
    for round in 0..18 {
        let count = [5, 40, 200][round % 3];
        let ranked = round % 9 > 5;
        let crowds = [2, 1].map(|p| Crowd::new(&mut rng, count, if ranked { p } else { 0 }));
        with_scene::<L>(WIDE, &crowds, texture, |scene| {
            for depth in [true, false] {
                let (want, _) = lines(scene, 224, depth, &all);
                for slots in [0, 3, 32, 90] {
                    let (got, _) = lines(scene, slots, depth, &all);
                    assert!(got == want, "{slots} slots, depth {depth}, round {round}");
                    let some: Vec<u16> = (0..20)
                        .map(|_| rng.below(WIDE.height.into()) as u16)
                        .collect();
                    let (got, _) = lines(scene, slots, depth, &some);
                    let same = some
                        .iter()
                        .zip(&got)
                        .all(|(&y, l)| *l == want[usize::from(y)]);
                    assert!(same, "alone, {slots} slots, depth {depth}, round {round}");
                }
            }
        });
    }
}

#[test]
fn pictures_do_not_depend_on_the_cache() {
    let words: Vec<u16> = (0..64 * 64).map(|i: u16| i.wrapping_mul(37)).collect();
    let texture = Texture::words(&words, 64, 64).unwrap();
    does_not_depend_on_the_cache::<Textured<Rgb565>>(Some(&texture), 51);
    does_not_depend_on_the_cache::<Gouraud<Rgb888>>(None, 52);
}

#[test]
fn what_has_no_slot_is_drawn_as_what_has_one() {
    let mut rng = Rng(31);
    let mut missed = 0;
    let all: Vec<u16> = (0..NARROW.height).collect();
    for round in 0..60 {
        let crowd = Crowd::sparse(&mut rng, 2 + round % 20);
        with_scene::<Gouraud<Rgb565>>(NARROW, &[crowd], None, |scene| {
            for depth in [false, true] {
                let (want, misses) = lines(scene, 64, depth, &all);
                assert_eq!(misses, 0);
                for slots in [0, 1, 2, 3, 5, 9] {
                    let (got, misses) = lines(scene, slots, depth, &all);
                    assert!(got == want, "{slots} slots in round {round}");
                    missed += misses;
                }
            }
        });
    }
    assert!(missed > 5000, "{missed}");
}

/// A crowd, and the same again in the light and in the shadow of another, which is counted.
#[test]
fn shadows_do_not_depend_on_the_cache() {
    let mut rng = Rng(53);
    let all: Vec<u16> = (0..WIDE.height).collect();
    let mut differing = 0;
    for round in 0..12 {
        let count = [3, 20, 60][round % 3];
        let again = |rng: &mut Rng, shadow: Shadow, of: &Crowd| Crowd {
            positions: of.positions.clone(),
            places: of.places.clone(),
            colours: of
                .colours
                .iter()
                .map(|_| [(); 3].map(|()| rng.below(256) as u8))
                .collect(),
            faces: of.faces.clone(),
            priority: 0,
            shadow: Some(shadow),
        };
        let crowd = Crowd::new(&mut rng, count, 0);
        let lit = again(&mut rng, Shadow::Lit(5), &crowd);
        let dark = again(&mut rng, Shadow::Shadowed(5), &crowd);
        let other = Crowd::new(&mut rng, count, 0);
        let volume = again(&mut rng, Shadow::Volume(5), &other);
        let mut crowds = [lit, volume, crowd, dark];
        let mut picture = Vec::new();
        with_scene::<Gouraud<Rgb888>>(WIDE, &crowds, None, |scene| {
            let (want, _) = lines(scene, 224, true, &all);
            for slots in [0, 3, 32, 90] {
                let (got, _) = lines(scene, slots, true, &all);
                assert!(got == want, "{slots} slots, round {round}");
                let some: Vec<u16> = (0..20)
                    .map(|_| rng.below(WIDE.height.into()) as u16)
                    .collect();
                let (got, _) = lines(scene, slots, true, &some);
                let same = some
                    .iter()
                    .zip(&got)
                    .all(|(&y, line)| *line == want[usize::from(y)]);
                assert!(same, "alone, {slots} slots, round {round}");
            }
            picture = want;
        });
        crowds[1].shadow = Some(Shadow::Volume(4));
        with_scene::<Gouraud<Rgb888>>(WIDE, &crowds, None, |scene| {
            differing += u32::from(lines(scene, 224, true, &all).0 != picture);
        });
    }
    assert!(differing > 7, "{differing}");
}

/// Kills: what bins have behind the last line is read.
#[test]
fn nothing_is_fetched_behind_the_last_line() {
    let crowd = [Crowd::new(&mut Rng(158), 3, 0)];
    with_scene::<Gouraud<Rgb888>>(WIDE, &crowd, None, |scene| {
        let mut cache = FastMemory::<Gouraud<Rgb888>, 1>::new();
        let mut links = std::vec![Link::NONE; scene.objects()];
        let memory = Lent {
            cache: &mut cache,
            links: &mut links,
            depth: &mut [],
        };
        let mut renderer = Renderer::new(memory).fetching(100);
        let mut pixels = [Default::default(); WIDTH as usize];
        for (line, bytes) in [(WIDE.height - 2, 2), (WIDE.height - 1, 0)] {
            renderer
                .draw_line(scene, line, &mut pixels, Default::default())
                .unwrap();
            assert_eq!(renderer.fetch_ahead(scene), Ok(bytes), "{line}");
        }
    });
}
