//! Whole scenes through the model: the pixels of the fast path exactly, its colours nearly
//! (K4, K5, M1).

use crate::common::{LineRooms, SceneRooms};
use scanbeam::pipeline::{Counted, FlatPainter, GouraudDepth, GouraudPainter, Pipeline, Scene};
use scanbeam::pixel::Rgb888;
use scanbeam::stats::SpanCounts;
use scanbeam_model::{
    CornerColours, ModelRenderer, PipeCounts, PipeMemory, ProcessingFormat, Token,
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

/// What covers a pixel last: the colours at its span's ends in levels, and the span's pixels.
#[derive(Clone, Copy)]
struct Owner {
    ends: [[f64; 3]; 2],
    pixels: usize,
}

/// The owner of each pixel of a line, from the tokens it is drawn with.
fn owners(tokens: &[Token]) -> Vec<Option<Owner>> {
    let levels = |word| {
        let [_, rgb @ ..] = ProcessingFormat::U9x4.unpack(word);
        rgb.map(|level| level as f64 * 255.0 / 511.0)
    };
    let mut owners = vec![None; usize::from(WIDTH)];
    let is_pixel = |token: &&Token| matches!(token, Token::Pixel(_));
    for (i, token) in tokens.iter().enumerate() {
        let Token::DiffuseSetup(set_up) = token else {
            continue;
        };
        let span = &tokens[i + 1..];
        let pixels = span.iter().take_while(is_pixel).count();
        let ends = [levels(set_up.left), levels(set_up.right)];
        for token in &span[..pixels] {
            if let Token::Pixel(pixel) = token {
                owners[usize::from(pixel.x)] = Some(Owner { ends, pixels });
            }
        }
    }
    owners
}

/// How far the model may be off where a span of so many pixels goes from one colour to another.
///
/// Two levels for 8, 9 and 10 bits and their roundings. Beside them the place along the span:
/// its ends are cut to 1/8 pixel, so a span that is wider than n - 1 pixels is off by at most
/// 1/4 of that, and one that has a single pixel, and may be 1/8 wide, by anything.
fn bound(owner: Owner) -> f64 {
    let [a, b] = owner.ends;
    let change = (0..3).fold(0.0f64, |m, i| m.max((a[i] - b[i]).abs()));
    2.0 + match owner.pixels {
        1 => change,
        n => change / (4.0 * (n - 1) as f64),
    }
}

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

        let mut memory = [(); 4].map(|()| vec![0; usize::from(WIDTH)]);
        let [z0, z1, c0, c1] = &mut memory;
        let mut renderer = ModelRenderer::new(PipeMemory {
            z: [z0, z1],
            rgb: [c0, c1],
        });
        // By the pixels of a span: 1, 2 to 3, 4 to 7, 8 and more. Pixels, sum, largest.
        let mut classes = [(0u32, 0u32, 0u8); 4];
        for (line, (fast, model)) in scene.lines().zip(fast.iter().zip(&model)) {
            let mut tokens = Vec::new();
            let mut pixels = vec![BLACK; usize::from(WIDTH)];
            let mut keep = |token: &Token| tokens.push(*token);
            renderer
                .trace_line(&scene, line, BLACK, &mut pixels, &mut keep)
                .unwrap();
            assert_eq!(&pixels, model, "{} line {line}", shot.name());
            for (x, owner) in owners(&tokens).into_iter().enumerate() {
                let difference = difference(fast[x], model[x]);
                let Some(owner) = owner else {
                    assert_eq!(difference, 0);
                    continue;
                };
                assert!(
                    f64::from(difference) <= bound(owner),
                    "{} line {line} pixel {x}: {:?} and {:?}",
                    shot.name(),
                    fast[x],
                    model[x]
                );
                let (pixels, sum, largest) = &mut classes[owner.pixels.ilog2().min(3) as usize];
                *pixels += 1;
                *sum += u32::from(difference);
                *largest = (*largest).max(difference);
            }
        }
        print!("{:8} model against planes, levels:", shot.name());
        for (name, (pixels, sum, largest)) in
            ["1 pixel", "2-3", "4-7", "8 and more"].iter().zip(classes)
        {
            let mean = f64::from(sum) / f64::from(pixels.max(1));
            print!(" | {name}: {pixels} pixels, max {largest}, mean {mean:.3}");
        }
        println!();
        assert!(classes[3].2 <= 2, "{}: {classes:?}", shot.name());
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
        // The fast path tests no depth on lines without overlap, but covers as many pixels.
        let pixels = counts.pixels_shaded + counts.pixels_hidden;
        assert_eq!(pipe.pixels, u64::from(pixels));
        let mask = covered(&fast, &by_fast_path(&scene, WHITE).0);
        let white = by_model(&scene, WHITE, usize::from(WIDTH), scene.lines()).0;
        assert!(covered(&model, &white) == mask, "{}: coverage", shot.name());
        let (max, mean, other) = differences(&fast, &model, &mask, 3);
        let pixels = mask.iter().filter(|c| **c).count();
        println!(
            "{:8} depth: {pixels:6} pixels, max {max} levels, mean {mean:.3}, {other} by more than 3; hidden {} and {}",
            shot.name(),
            pipe.hidden,
            counts.pixels_hidden,
        );
        assert!(other * 100 < pixels, "{}: {other}", shot.name());
        let hidden = pipe.hidden.abs_diff(counts.pixels_hidden.into());
        assert!(hidden * 100 < pipe.pixels, "{}: {hidden}", shot.name());
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
    use scanbeam::pipeline::RendererError;
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
