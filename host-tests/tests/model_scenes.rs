//! Whole scenes through the model: the pixels of the fast path exactly, its colours nearly
//! (K4, K5, M1).

mod common;

use common::{LineRooms, SceneRooms};
use scanbeam::model::{CornerColours, ModelRenderer, PipeCounts, PipeMemory};
use scanbeam::{
    Counted, FlatPainter, GouraudDepth, GouraudPainter, Pipeline, Rgb888, Scene, SpanCounts,
};
use scenes::{HEIGHT, OBJECTS, SHOTS, Shot, VERTICES, WIDTH};

type Picture = Vec<Vec<[u8; 3]>>;

fn built<P: Pipeline>(shot: Shot, rooms: &mut SceneRooms<P>) -> Scene<'_, P> {
    let mut scene = rooms.scene(Shot::screen());
    shot.build(&mut scene).unwrap();
    scene
}

fn rooms<P: Pipeline>() -> SceneRooms<P> {
    SceneRooms::new(VERTICES, OBJECTS, usize::from(HEIGHT))
}

/// The lines in the order given, by the model in buffers of so many pixels.
fn by_model<P>(
    scene: &Scene<'_, P>,
    background: [u8; 3],
    segment: usize,
    lines: impl Iterator<Item = u16>,
) -> (Picture, PipeCounts)
where
    P: Pipeline<Pixel = Rgb888, Shading: CornerColours>,
{
    let mut memory = [(); 4].map(|()| vec![0x55; segment]);
    let [z0, z1, c0, c1] = &mut memory;
    let mut renderer = ModelRenderer::new(PipeMemory {
        z: [z0, z1],
        rgb: [c0, c1],
    });
    let picture = lines
        .map(|line| {
            let mut pixels = vec![[9; 3]; usize::from(WIDTH)];
            renderer
                .draw_line(scene, line, background, &mut pixels)
                .unwrap();
            pixels
        })
        .collect();
    (picture, renderer.counts())
}

fn by_fast_path<P>(scene: &Scene<'_, P>, background: [u8; 3]) -> (Picture, SpanCounts)
where
    P: Pipeline<Pixel = Rgb888>,
{
    let mut rooms = LineRooms::fitting(64, scene);
    let mut renderer = rooms.renderer();
    let picture = scene
        .lines()
        .map(|line| {
            let mut pixels = vec![background; usize::from(WIDTH)];
            renderer.draw_line(scene, line, &mut pixels).unwrap();
            pixels
        })
        .collect();
    (picture, renderer.take_span_counts())
}

/// Where a picture does not show the background, whatever colour that has.
fn covered(over_black: &Picture, over_white: &Picture) -> Vec<bool> {
    let pairs = over_black.iter().flatten().zip(over_white.iter().flatten());
    pairs.map(|(black, white)| black == white).collect()
}

fn difference(a: [u8; 3], b: [u8; 3]) -> u8 {
    (0..3).map(|i| a[i].abs_diff(b[i])).max().unwrap_or(0)
}

/// Largest and mean difference over covered pixels, and how many differ by more than `limit`.
fn differences(a: &Picture, b: &Picture, mask: &[bool], limit: u8) -> (u8, f64, usize) {
    let pairs = a.iter().flatten().zip(b.iter().flatten());
    let all: Vec<u8> = pairs
        .zip(mask)
        .filter(|(_, covered)| **covered)
        .map(|((a, b), _)| difference(*a, *b))
        .collect();
    let sum: f64 = all.iter().map(|d| f64::from(*d)).sum();
    (
        all.iter().copied().max().unwrap_or(0),
        sum / all.len() as f64,
        all.iter().filter(|d| **d > limit).count(),
    )
}

const BLACK: [u8; 3] = [0; 3];
const WHITE: [u8; 3] = [255; 3];

/// Without depth the same object wins everywhere, so colours can be compared pixel by pixel.
#[test]
fn the_painters_pictures_are_those_of_the_fast_path() {
    for shot in SHOTS {
        type P = Counted<GouraudPainter<Rgb888>>;
        let mut rooms = rooms::<P>();
        let scene = built(shot, &mut rooms);
        let (fast, counts) = by_fast_path(&scene, BLACK);
        let (model, pipe) = by_model(&scene, BLACK, usize::from(WIDTH), scene.lines());
        // Span by span the same number of pixels.
        assert_eq!(pipe.pixels, u64::from(counts.pixels_shaded));
        assert_eq!(pipe.hidden, 0);
        let mask = covered(&fast, &by_fast_path(&scene, WHITE).0);
        let white = by_model(&scene, WHITE, usize::from(WIDTH), scene.lines()).0;
        assert!(covered(&model, &white) == mask, "{}: coverage", shot.name());
        let (max, mean, _) = differences(&fast, &model, &mask, 0);
        println!(
            "{:8} painter: {:6} pixels, model against planes: max {max} levels, mean {mean:.3}",
            shot.name(),
            mask.iter().filter(|c| **c).count(),
        );
        assert!(max <= 3, "{}: {max}", shot.name());
        assert!(mean < 0.6, "{}: {mean}", shot.name());
    }
}

#[test]
fn flat_faces_are_exact() {
    for shot in SHOTS {
        type P = FlatPainter<Rgb888>;
        let mut rooms = rooms::<P>();
        let scene = built(shot, &mut rooms);
        let fast = by_fast_path(&scene, [7, 70, 200]).0;
        let model = by_model(&scene, [7, 70, 200], usize::from(WIDTH), scene.lines()).0;
        let mask = vec![true; fast.len() * usize::from(WIDTH)];
        let (max, mean, some) = differences(&fast, &model, &mask, 0);
        println!(
            "{:8} flat: max {max}, mean {mean:.4}, {some} pixels",
            shot.name()
        );
        assert!(max <= 1, "{}: {max}", shot.name());
    }
}

/// With depth a 10-bit weight may decide otherwise where surfaces are close; coverage may not.
#[test]
fn pictures_with_depth_cover_the_same_and_rarely_differ() {
    for shot in SHOTS {
        type P = Counted<GouraudDepth<Rgb888>>;
        let mut rooms = rooms::<P>();
        let scene = built(shot, &mut rooms);
        let (fast, counts) = by_fast_path(&scene, BLACK);
        let (model, pipe) = by_model(&scene, BLACK, usize::from(WIDTH), scene.lines());
        assert_eq!(pipe.pixels, u64::from(counts.depth_tests));
        let mask = covered(&fast, &by_fast_path(&scene, WHITE).0);
        let white = by_model(&scene, WHITE, usize::from(WIDTH), scene.lines()).0;
        assert!(covered(&model, &white) == mask, "{}: coverage", shot.name());
        let (max, mean, other) = differences(&fast, &model, &mask, 3);
        let pixels = mask.iter().filter(|c| **c).count();
        println!(
            "{:8} depth: {pixels:6} pixels, max {max} levels, mean {mean:.3}, {other} other surfaces; hidden {} and {}",
            shot.name(),
            pipe.hidden,
            counts.pixels_hidden,
        );
        assert!(other * 200 < pixels, "{}: {other}", shot.name());
    }
}

/// Neither the order of lines, nor the width of the buffers, nor what was in them shows.
#[test]
fn lines_alone_and_in_segments_are_the_same() {
    type P = GouraudDepth<Rgb888>;
    let mut rooms = rooms::<P>();
    let scene = built(Shot::Quads, &mut rooms);
    let whole = by_model(&scene, WHITE, usize::from(WIDTH), scene.lines()).0;
    let mut upwards = by_model(&scene, WHITE, usize::from(WIDTH), scene.lines().rev()).0;
    upwards.reverse();
    assert!(upwards == whole);
    for segment in [1, 7, 64, 319, 5000] {
        assert!(
            by_model(&scene, WHITE, segment, scene.lines()).0 == whole,
            "{segment}"
        );
    }
    for line in [0, 90, 120, 239] {
        let alone = by_model(&scene, WHITE, 320, std::iter::once(line)).0;
        assert_eq!(alone[0], whole[usize::from(line)], "{line}");
    }
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    use scanbeam::RendererError;
    type P = GouraudDepth<Rgb888>;
    let mut rooms = rooms::<P>();
    let scene = built(Shot::Cube, &mut rooms);
    let mut memory = [[0; 8]; 3];
    let [a, b, c] = &mut memory;
    let mut renderer = ModelRenderer::new(PipeMemory {
        z: [a, b],
        rgb: [c, &mut []],
    });
    let mut pixels = [[0; 3]; WIDTH as usize];
    let short = renderer.draw_line(&scene, 0, BLACK, &mut pixels[1..]);
    assert_eq!(
        short,
        Err(RendererError::Pixels {
            needed: 320,
            have: 319
        })
    );
    let below = renderer.draw_line(&scene, HEIGHT, BLACK, &mut pixels);
    assert_eq!(below, Err(RendererError::Line { line: HEIGHT }));
    let none = renderer.draw_line(&scene, 0, BLACK, &mut pixels);
    assert_eq!(none, Err(RendererError::Depth { needed: 1, have: 0 }));
}
