//! Whole scenes through the model: the pixels of the fast path exactly, its colours nearly
//! (K4, K5, M1).

use crate::hot::exact::within;
use crate::hot::{SceneRooms, frame};
use scanbeam::look::Gouraud;
use scanbeam::pixel::{Index8, PixelFormat, Rgb565, Rgb888};
use scanbeam::scene::{Blend, Draw, Scene, Shading};
use scanbeam_model::{ModelError, ModelRenderer, PipeCounts, PipeMemory, ProcessingFormat, Token};
use scenes::{DRAWS, HEIGHT, OBJECTS, SHOTS, SPHERE, Shot, VERTICES, WIDTH};

type L = Gouraud<Rgb888>;
type Picture = Vec<Vec<[u8; 3]>>;

fn built<F: PixelFormat>(shot: Shot, rooms: &mut SceneRooms) -> Scene<'_, 'static, Gouraud<F>> {
    let mut scene = rooms.scene(Shot::screen());
    shot.build(&mut scene).unwrap();
    scene
}

fn rooms() -> SceneRooms {
    SceneRooms::new(VERTICES, OBJECTS, HEIGHT.into(), DRAWS)
}

/// The lines in the order given, by the model in buffers of so many pixels.
fn by_model<F: PixelFormat>(
    scene: &Scene<'_, '_, Gouraud<F>>,
    (background, depth): ([u8; 3], bool),
    segment: usize,
    lines: impl Iterator<Item = u16>,
) -> (Picture, PipeCounts) {
    let mut memory = [(); 4].map(|()| vec![0x55; segment]);
    let [z0, z1, c0, c1] = &mut memory;
    let mut renderer = ModelRenderer::new(PipeMemory {
        z: [z0, z1],
        rgb: [c0, c1],
    });
    renderer.set_depth(depth);
    let background = F::from_rgb8(background);
    let picture = lines
        .map(|line| {
            let mut pixels = vec![F::Word::default(); usize::from(WIDTH)];
            renderer
                .draw_line(scene, line, background, &mut pixels)
                .unwrap();
            pixels.into_iter().map(F::to_rgb8).collect()
        })
        .collect();
    (picture, renderer.counts())
}

/// All lines by the fast path.
fn by_fast_path(scene: &Scene<'_, '_, L>, background: [u8; 3], depth: bool) -> Picture {
    frame(scene, 64, depth, background)
}

/// Pixels of all triangles, by whole numbers.
fn exact_pixels<F: PixelFormat>(scene: &Scene<'_, '_, Gouraud<F>>) -> u64 {
    let of = |corners: [scanbeam::scene::FiledCorner; 3], line| {
        let places = corners.map(|corner| (corner.x.into(), corner.y.into()));
        within(places, line, WIDTH).len() as u64
    };
    let lines = || scene.lines().map(i32::from);
    let triangles = scene.triangles();
    triangles
        .map(|t| lines().map(|line| of(t.corners, line)).sum::<u64>())
        .sum()
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

/// Without depth the same triangle wins everywhere, so colours can be compared pixel by pixel.
#[test]
fn the_painters_pictures_are_those_of_the_fast_path() {
    for shot in SHOTS {
        let mut rooms = rooms();
        let scene = built(shot, &mut rooms);
        let fast = by_fast_path(&scene, BLACK, false);
        let (model, pipe) = by_model(&scene, (BLACK, false), usize::from(WIDTH), scene.lines());
        assert_eq!(pipe.pixels, exact_pixels(&scene));
        assert_eq!(pipe.hidden, 0);
        let mask = covered(&fast, &by_fast_path(&scene, WHITE, false));
        let white = by_model(&scene, (WHITE, false), usize::from(WIDTH), scene.lines()).0;
        assert!(covered(&model, &white) == mask, "{}: coverage", shot.name());

        let mut memory = [(); 4].map(|()| vec![0; usize::from(WIDTH)]);
        let [z0, z1, c0, c1] = &mut memory;
        let mut renderer = ModelRenderer::new(PipeMemory {
            z: [z0, z1],
            rgb: [c0, c1],
        });
        renderer.set_depth(false);
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

/// A sphere of faces of one colour each, which neither way of drawing has anything to interpolate on.
#[test]
fn flat_faces_are_exact() {
    let background = [7, 70, 200];
    let vertices = 3 * OBJECTS + SPHERE.positions.len();
    let mut rooms = SceneRooms::new(vertices, OBJECTS, HEIGHT.into(), 1);
    let mut scene = rooms.scene::<L>(Shot::screen());
    let light = scanbeam::Light::new([-0.9, 0.8, 0.5], 0.2);
    let camera = scanbeam::Camera::look_at(
        [0.0, 1.0, 3.0],
        [0.0; 3],
        [0.0, 1.0, 0.0],
        320.0,
        0.1,
        100.0,
    );
    scene.begin(&camera.unwrap()).unwrap();
    scene
        .draw(&Draw {
            shading: Shading::Flat,
            light,
            ..Draw::new(SPHERE)
        })
        .unwrap();
    for depth in [false, true] {
        let fast = by_fast_path(&scene, background, depth);
        let model = by_model(&scene, (background, depth), 320, scene.lines()).0;
        let mask = vec![true; fast.len() * usize::from(WIDTH)];
        let (max, mean, some) = differences(&fast, &model, &mask, 0);
        println!("flat: max {max}, mean {mean:.4}, {some} pixels");
        assert!(max <= 1, "{max}");
    }
}

/// With depth a 10-bit weight may decide otherwise where surfaces are close; coverage may not.
#[test]
fn pictures_with_depth_cover_the_same_and_rarely_differ() {
    for shot in SHOTS {
        let mut rooms = rooms();
        let scene = built(shot, &mut rooms);
        let fast = by_fast_path(&scene, BLACK, true);
        let (model, pipe) = by_model(&scene, (BLACK, true), usize::from(WIDTH), scene.lines());
        assert_eq!(pipe.pixels, exact_pixels(&scene));
        let mask = covered(&fast, &by_fast_path(&scene, WHITE, true));
        let white = by_model(&scene, (WHITE, true), usize::from(WIDTH), scene.lines()).0;
        assert!(covered(&model, &white) == mask, "{}: coverage", shot.name());
        let (max, mean, other) = differences(&fast, &model, &mask, 3);
        let pixels = mask.iter().filter(|c| **c).count();
        println!(
            "{:8} depth: {pixels:6} pixels, max {max} levels, mean {mean:.3}, {other} by more than 3; {} hidden",
            shot.name(),
            pipe.hidden,
        );
        assert!(other * 100 < pixels, "{}: {other}", shot.name());
        // What is hidden is no more than what is covered more than once.
        assert!(pipe.pixels - pipe.hidden >= pixels as u64);
    }
}

/// Neither the order of lines, nor the width of the buffers, nor what was in them shows.
#[test]
fn lines_alone_and_in_segments_are_the_same() {
    let mut rooms = rooms();
    let scene = built::<Rgb888>(Shot::Quads, &mut rooms);
    let by = |segment, lines: &mut dyn Iterator<Item = u16>| {
        by_model(&scene, (WHITE, true), segment, lines).0
    };
    let whole = by(usize::from(WIDTH), &mut scene.lines());
    let mut upwards = by(usize::from(WIDTH), &mut scene.lines().rev());
    upwards.reverse();
    assert!(upwards == whole);
    for segment in [1, 7, 64, 319, 5000] {
        assert!(by(segment, &mut scene.lines()) == whole, "{segment}");
    }
    for line in [0, 90, 120, 239] {
        let alone = by(320, &mut std::iter::once(line));
        assert_eq!(alone[0], whole[usize::from(line)], "{line}");
    }
}

/// In pixels of 16 bits levels are those of 24 bits, but for the step that they are rounded to: vertices keep fewer bits
/// of a level where pixels have fewer steps.
#[test]
fn pixels_of_16_bits_are_those_of_24_within_a_step() {
    let mut wide = rooms();
    let mut narrow = rooms();
    let wide = built::<Rgb888>(Shot::Teapot, &mut wide);
    let narrow = built::<Rgb565>(Shot::Teapot, &mut narrow);
    let all = by_model(&wide, (BLACK, true), 320, wide.lines()).0;
    let few = by_model(&narrow, (BLACK, true), 320, narrow.lines()).0;
    // Half a step of 8.2 levels, one for what vertices keep, and one for the model's own bits.
    let mask = vec![true; 320 * 240];
    let (max, _, some) = differences(&all, &few, &mask, 0);
    println!("16 bits: {some} pixels differ, max {max}");
    assert!(some > 1000 && max <= 6, "{some}, {max}");
}

#[test]
fn what_cannot_be_drawn_is_refused() {
    let mut rooms = rooms();
    let mut scene = built::<Rgb888>(Shot::Cube, &mut rooms);
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
        Err(ModelError::Pixels {
            needed: 320,
            have: 319
        })
    );
    let below = renderer.draw_line(&scene, HEIGHT, BLACK, &mut pixels);
    assert_eq!(below, Err(ModelError::Line { line: HEIGHT }));
    let none = renderer.draw_line(&scene, 0, BLACK, &mut pixels);
    assert_eq!(none, Err(ModelError::Memory));
    let mut more = [[0; 8]; 4];
    let [a, b, c, d] = &mut more;
    let mut renderer = ModelRenderer::new(PipeMemory {
        z: [a, b],
        rgb: [c, d],
    });
    assert_eq!(renderer.draw_line(&scene, 0, BLACK, &mut pixels), Ok(()));
    scene
        .draw(&Draw {
            blend: Some(Blend::filter(100)),
            ..Draw::new(SPHERE)
        })
        .unwrap();
    let glass = renderer.draw_line(&scene, 0, BLACK, &mut pixels);
    assert_eq!(glass, Err(ModelError::Call { call: 1 }));
    let mut rooms = self::rooms();
    let numbers = built::<Index8>(Shot::Cube, &mut rooms);
    let palette = renderer.draw_line(&numbers, 0, 0, &mut [0; WIDTH as usize]);
    assert_eq!(palette, Err(ModelError::Indices));
}
