//! The scenes of the suite are those that other renderers were measured on: as many pixels are
//! covered and as many triangles face the eye as there, but for what each of them rounds otherwise.

use scanbeam::frame::{FastMemory, Memory as LineMemory};
use scanbeam::look::Textured;
use scanbeam::pixel::Rgb565Be;
use scanbeam::scene::{DrawState, Memory, Object, TexturePlace, Vertex};
use scanbeam::{Link, Renderer, Scene};
use scenes::{HEIGHT, SUITE, SUITE_DRAWS, SUITE_OBJECTS, SUITE_VERTICES, Shot, Suite, WIDTH};
use std::collections::BTreeSet;

type Look = Textured<Rgb565Be>;

/// What a scene has in its picture.
#[derive(Debug)]
struct Seen {
    triangles: u32,
    front: u32,
    covered: usize,
    spans: u32,
}

fn seen(suite: Suite) -> Seen {
    const NOTHING: u16 = 0x0841;
    let mut vertices = vec![Vertex::EMPTY; SUITE_VERTICES];
    let mut places = vec![TexturePlace::EMPTY; SUITE_VERTICES];
    let mut objects = vec![Object::EMPTY; SUITE_OBJECTS];
    let memory = Memory {
        vertices: &mut vertices,
        places: &mut places,
        objects: &mut objects,
        bins: &mut [0; HEIGHT as usize],
        draws: &mut [const { DrawState::EMPTY }; SUITE_DRAWS],
    };
    let mut scene = Scene::<Look>::new(Shot::screen(), memory);
    suite.build(&mut scene).expect("the memory suffices");
    let mut cache = Box::new(FastMemory::<Look>::new());
    let mut depth = [0; WIDTH as usize];
    let mut links = vec![Link::EMPTY; SUITE_OBJECTS];
    let mut renderer = Renderer::new(LineMemory {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    })
    .counting();
    let mut covered = 0;
    let mut pixels = vec![0; usize::from(WIDTH)];
    for line in 0..HEIGHT {
        renderer
            .draw_line(&scene, line, &mut pixels, NOTHING)
            .unwrap();
        covered += pixels.iter().filter(|&&pixel| pixel != NOTHING).count();
    }
    let counts = scene.assembled();
    assert_eq!(counts.dropped, 0, "{}", suite.name());
    Seen {
        triangles: counts.triangles,
        front: counts.triangles - counts.culled,
        covered,
        spans: renderer.spans().spans,
    }
}

/// Published: triangles, those that face the eye, pixels, spans that show something.
const PUBLISHED: [(Suite, [u32; 4]); 4] = [
    (Suite::A, [2_048, 727, 22_075, 4_551]),
    (Suite::FarToNear, [32, 32, 76_800, 7_680]),
    (Suite::F, [324, 162, 35_959, 4_000]),
    (Suite::G, [8_192, 2_991, 22_147, 8_131]),
];

#[test]
fn the_suite_is_what_others_were_measured_on() {
    for (suite, [triangles, front, covered, spans]) in PUBLISHED {
        let seen = seen(suite);
        assert_eq!(seen.triangles, triangles, "{} {seen:?}", suite.name());
        let near = |of: u32, published: u32, part: f64| {
            f64::from(of.abs_diff(published)) <= part * f64::from(published)
        };
        let name = suite.name();
        // Triangles that are thinner than a line are not filed here, and are counted there.
        assert!(near(seen.front, front, 0.07), "{name} {seen:?}");
        assert!(near(seen.covered as u32, covered, 0.001), "{name} {seen:?}");
        assert!(near(seen.spans, spans, 0.01), "{name} {seen:?}");
    }
}

#[test]
fn every_scene_of_the_suite_fits_its_arenas_and_has_a_name() {
    let names: BTreeSet<&str> = SUITE.iter().map(|suite| suite.name()).collect();
    assert_eq!(names.len(), SUITE.len());
    for suite in SUITE {
        assert!(seen(suite).covered > 10_000, "{}", suite.name());
        let side = suite.texel_side() as usize;
        let texels = suite.texels().map_or(side * side, <[u16]>::len);
        assert_eq!(texels, side * side, "{}", suite.name());
        for index in 0..suite.parts() {
            let part = suite.part(index);
            let vertices = part.mesh.positions.len();
            let places = if suite.texels().is_some() {
                vertices
            } else {
                0
            };
            assert_eq!(part.places.len(), places, "{}", suite.name());
        }
    }
}
