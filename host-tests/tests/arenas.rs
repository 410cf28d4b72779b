//! S3, C5: an arena that is too small is a located error, what fits is drawn, and no length of
//! any slice makes a panic. What fits, mesh by mesh, is held by `hot_path_errors.rs`.

use crate::common::Rng;
use crate::hot::cover::L;
use crate::hot::{LineRooms, SceneRooms, frame};
use scanbeam::frame::{FastMemory, LineError, Memory as LineMemory, Renderer};
use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::{Rgb565, Rgb888};
use scanbeam::scene::{
    BeginError, Budget, Draw, DrawError, DrawState, Full, Memory, Object, Scene, Shading, Skin,
    Texture, TexturePlace, Vertex,
};
use scanbeam::{Affine, Camera, Cull, Faces, Link, Mesh, Screen};
use scenes::{CUBE, TEAPOT};
use std::sync::Mutex;

fn screen() -> Screen {
    Screen::new(64, 32).unwrap()
}

fn camera() -> Camera {
    Camera::look_at([0.0, 0.0, 2.0], [0.0; 3], [0.0, 1.0, 0.0], 30.0, 0.1, 10.0).unwrap()
}

fn open<C>(mesh: Mesh<'_, C>) -> Draw<'_, 'static, C> {
    Draw {
        cull: Cull::None,
        ..Draw::new(mesh)
    }
}

/// After a mesh that did not fit, a smaller one may still fit, and the next frame is whole.
#[test]
fn a_full_arena_is_empty_again_for_the_next_frame() {
    let picture = |scene: &mut Scene<'_, 'static, L>| {
        scene.begin(&camera()).unwrap();
        assert_eq!(scene.assembled().dropped, 0);
        scene.draw(&open(CUBE)).unwrap();
        frame(scene, 2, true, [0; 3])
    };
    let mut enough = SceneRooms::new(1_000, 1_000, 32, 4);
    let want = picture(&mut enough.scene(screen()));
    assert!(want.concat().iter().any(|p| *p != [0; 3]));
    let mut rooms = SceneRooms::new(24, 12, 32, 4);
    let mut scene = rooms.scene::<L>(screen());
    for _ in 0..3 {
        scene.begin(&camera()).unwrap();
        assert!(scene.draw(&open(TEAPOT)).is_err());
        assert!(scene.assembled().dropped > 500);
        assert!(scene.vertices() <= 24 && scene.objects() <= 12);
        frame(&scene, 2, true, [0; 3]);
        assert_eq!(picture(&mut scene), want);
    }
}

#[test]
fn no_memory_at_all() {
    let mut rooms = SceneRooms::new(0, 0, 0, 0);
    let mut scene = rooms.scene::<L>(screen());
    let bins = Err(BeginError::Bins {
        needed: 32,
        have: 0,
    });
    assert_eq!(scene.begin(&camera()), bins);
    assert_eq!(scene.lines(), 0..0);
    let mut lines = LineRooms::fitting(&scene, 0, false);
    let drawn = lines.renderer().draw_line(&scene, 0, &mut [], [0; 3]);
    assert!(drawn.is_err());
    // Bins alone, and one thing more at a time, as one would have for an empty picture.
    for (vertices, objects, draws, full) in [
        (0, 0, 0, Full::Draws),
        (0, 24, 1, Full::Vertices),
        (99, 0, 1, Full::Objects),
    ] {
        let mut rooms = SceneRooms::new(vertices, objects, 32, draws);
        let mut scene = rooms.scene::<L>(screen());
        scene.begin(&camera()).unwrap();
        let Err(DrawError::Full {
            memory,
            triangles,
            first_face,
        }) = scene.draw(&open(CUBE))
        else {
            panic!("{vertices} vertices, {objects} objects, {draws} draws");
        };
        assert_eq!((memory, triangles, first_face), (full, 12, 0));
        assert_eq!(scene.assembled().dropped, 12);
        let empty = frame(&scene, 0, true, [7; 3]);
        assert!(empty.iter().flatten().all(|p| *p == [7; 3]));
    }
}

/// Kills: vertices that are said to be full where their places on a texture are.
#[test]
fn places_that_are_full_are_named() {
    static TEXTURE: Texture = match Texture::words(&[9; 64], 8, 8) {
        Ok(texture) => texture,
        Err(_) => panic!("8 x 8 texels"),
    };
    let triangle = Mesh {
        positions: &[[-2048i16, -2048, 0], [2048, -2048, 0], [0, 2048, 0]],
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[[0, 1, 2]]),
    };
    for shading in [Shading::Smooth, Shading::Flat] {
        for (places, full) in [(0, true), (2, true), (6, false)] {
            let mut rooms = SceneRooms::new(99, 9, 32, 1);
            rooms.places.truncate(places);
            let mut scene = rooms.scene::<Textured<Rgb565>>(screen());
            scene.begin(&camera()).unwrap();
            let drawn = scene.draw(&Draw {
                texture: Some(Skin {
                    texture: &TEXTURE,
                    places: &[[0; 2]; 3],
                    budget: Budget::BALANCED,
                }),
                shading,
                ..open(triangle)
            });
            let error = DrawError::Full {
                memory: Full::Places,
                triangles: 1,
                first_face: 0,
            };
            assert_eq!(drawn, if full { Err(error) } else { Ok(()) }, "{places}");
            let start = "scene: the memory of places is full: ";
            assert!(error.to_string().starts_with(start), "{error}");
        }
    }
}

/// A frame, or an error after which nothing was written.
fn drawn_or_not(
    scene: &Scene<'_, 'static, L>,
    renderer: &mut Renderer<'_, L, 4>,
) -> Result<Vec<Vec<[u8; 3]>>, LineError> {
    let mut lines = Vec::new();
    for y in scene.lines() {
        let mut pixels = vec![[99; 3]; 64];
        match renderer.draw_line(scene, y, &mut pixels, [0; 3]) {
            Ok(_) => lines.push(pixels),
            Err(error) => {
                assert!(pixels.iter().all(|p| *p == [99; 3]), "half drawn");
                assert!(lines.is_empty(), "{error}");
                assert!(error.to_string().starts_with("renderer: "), "{error}");
                return Err(error);
            }
        }
    }
    Ok(lines)
}

/// What is kept of clipped meshes, at any length of the arenas, is part of the whole picture's
/// triangles, and nothing panics.
#[test]
fn any_length_of_any_arena_draws_something_or_says_no() {
    let mut rng = Rng::new(31);
    let mut enough = SceneRooms::new(30_000, 30_000, 32, 3);
    let (mut full, mut refused, mut whole) = (0, 0, 0);
    for _ in 0..400 {
        let (vertices, objects) = (rng.below(1500) as usize, rng.below(2500) as usize);
        let (bins, draws) = (rng.below(40) as usize, rng.below(5) as usize);
        let mut rooms = SceneRooms::new(vertices, objects, bins, draws);
        let mut scene = rooms.scene::<L>(screen());
        // The eye inside, so that many triangles are cut.
        let eye = [(); 3].map(|()| 0.4 * rng.signed() as f32);
        let camera =
            Camera::look_at(eye, [1.0, 0.1, 0.3], [0.0, 1.0, 0.0], 20.0, 0.01, 3.0).unwrap();
        let first = rng.below(32) as u16;
        let needed = 32 - first;
        if let Err(error) = scene.begin_lines(&camera, first..32) {
            assert_eq!(error, BeginError::Bins { needed, have: bins });
            continue;
        }
        assert!(bins >= usize::from(needed));
        let mut enough = enough.scene::<L>(screen());
        enough.begin_lines(&camera, first..32).unwrap();
        for _ in 0..3 {
            let call = Draw {
                model: Affine::rotation_y(rng.signed() as f32),
                ..open(TEAPOT)
            };
            enough.draw(&call).unwrap();
            let before = scene.assembled().dropped;
            match scene.draw(&call) {
                Ok(()) => assert_eq!(scene.assembled().dropped, before),
                Err(DrawError::Full { triangles, .. }) => {
                    assert!(triangles > 0);
                    assert_eq!(scene.assembled().dropped, before + triangles);
                    full += 1;
                }
                Err(error) => panic!("{error}"),
            }
        }
        let done = scene.assembled();
        assert!(done.dropped <= done.triangles - done.culled);
        assert!(scene.vertices() <= vertices && scene.objects() <= objects);
        assert_eq!(done.triangles, 3 * 2256);
        if done.dropped == 0 {
            assert_eq!(done, enough.assembled());
        }
        // Lines of a renderer that may have too little, too.
        let mut lines = LineRooms::fitting(&scene, 33, true);
        lines.links.truncate(rng.below(3_000) as usize);
        lines.depth.truncate(rng.below(100) as usize);
        let want = frame(&scene, 1, !lines.depth.is_empty(), [0; 3]);
        match drawn_or_not(&scene, &mut lines.renderer()) {
            Ok(got) => {
                assert!(got == want);
                whole += 1;
            }
            Err(LineError::Links { needed, have }) => assert!(have < needed),
            Err(LineError::Depth { needed, have }) => assert!(have > 0 && have < needed),
            Err(error) => panic!("{error}"),
        }
        refused += 1;
    }
    refused -= whole;
    assert!(
        full > 300 && refused > 50 && whole > 50,
        "{full} {refused} {whole}"
    );
}

/// Arenas, cache and line memory of a look as statics, as firmware puts them into sections.
struct Arenas {
    vertices: [Vertex; 8],
    places: [TexturePlace; 8],
    objects: [Object; 8],
    bins: [u16; 8],
    draws: [DrawState<'static>; 2],
    cache: FastMemory<L, 1>,
    links: [Link; 8],
    depth: [u32; 8],
}

/// Records are made at compile time.
#[test]
fn arenas_can_be_statics() {
    static ARENAS: Mutex<Arenas> = Mutex::new(Arenas {
        vertices: [Vertex::EMPTY; 8],
        places: [TexturePlace::EMPTY; 8],
        objects: [Object::EMPTY; 8],
        bins: [0; 8],
        draws: [DrawState::EMPTY; 2],
        cache: FastMemory::<Gouraud<Rgb888>, 1>::new(),
        links: [Link::EMPTY; 8],
        depth: [0; 8],
    });
    let mut arenas = ARENAS.lock().unwrap();
    let arenas = &mut *arenas;
    let mut scene = Scene::<L>::new(
        Screen::new(8, 8).unwrap(),
        Memory {
            vertices: &mut arenas.vertices,
            places: &mut arenas.places,
            objects: &mut arenas.objects,
            bins: &mut arenas.bins,
            draws: &mut arenas.draws,
        },
    );
    scene.begin(&camera()).unwrap();
    let triangle = Mesh {
        positions: &[[-2048i16, -2048, 0], [2048, -2048, 0], [0, 2048, 0]],
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[[0, 1, 2]]),
    };
    scene.draw(&Draw::new(triangle)).unwrap();
    let mut renderer = Renderer::new(LineMemory {
        cache: &mut arenas.cache,
        links: &mut arenas.links,
        depth: &mut arenas.depth,
    });
    let mut line = [[0; 3]; 8];
    renderer.draw_line(&scene, 4, &mut line, [1; 3]).unwrap();
    assert_eq!((line[4], line[0]), ([255; 3], [1; 3]));
}
