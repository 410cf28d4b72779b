//! Surfaces with a finish against a naive frame: each object is drawn alone by the plain
//! pipeline, and its pixels are composited one by one in f64 (K11, H8, H9, P5).

use crate::common::{LineRooms, Rng, SceneRooms, frame, line};
use scanbeam::pipeline::blend::{Blend, DepthFunction, Factor, Finish, Surface};
use scanbeam::pipeline::{
    Composited, DepthUse, FlatPainter, GouraudDepth, GouraudPainter, Instance, Pipeline, Scene,
    WordOf,
};
use scanbeam::pixel::{Rgb565Be, Rgb888};
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};

const WIDTH: u16 = 70;
const HEIGHT: u16 = 40;

type Plain = GouraudDepth<Rgb888>;
type Mixed = Composited<Plain>;

/// A triangle with a finish, in a slab of depth of its own, so that no two cross.
#[derive(Clone, Copy, Debug)]
struct Pane {
    positions: [[i16; 3]; 3],
    colours: [[u8; 3]; 3],
    alphas: [u8; 3],
    /// Whether `alphas` count.
    varies: bool,
    finish: Finish,
}

fn panes(rng: &mut Rng, count: i32, finish: impl Fn(&mut Rng) -> Finish) -> Vec<Pane> {
    let mut slabs: Vec<i32> = (0..count).collect();
    rng.shuffle(&mut slabs);
    slabs
        .into_iter()
        .map(|slab| {
            let size = rng.pick(&[2_000, 16_000, 30_000, 30_000]);
            let at = [0; 2].map(|_| rng.within(-14_000, 14_000));
            let positions = [(); 3].map(|()| {
                let z = -16_000 + (slab * 32_000 + rng.below(30_000) as i32) / count;
                let p = at.map(|c| (c + rng.within(-size, size)).clamp(-32_000, 32_000) as i16);
                [p[0], p[1], z as i16]
            });
            Pane {
                positions,
                colours: [(); 3].map(|()| [(); 3].map(|()| rng.below(256) as u8)),
                alphas: [(); 3].map(|()| rng.below(256) as u8),
                varies: rng.below(3) == 0,
                finish: finish(rng),
            }
        })
        .collect()
}

fn camera() -> Camera {
    Camera::look_at([0.0, 0.0, 3.0], [0.0; 3], [0.0, 1.0, 0.0], 40.0, 0.5, 50.0).unwrap()
}

fn instance() -> Instance {
    Instance {
        cull: Cull::None,
        ..Instance::default()
    }
}

fn mesh(pane: &Pane) -> Mesh<'_> {
    Mesh {
        positions: &pane.positions,
        normals: &[],
        colours: &pane.colours,
        faces: Faces::Triangles(&[[0, 1, 2]]),
    }
}

/// Colour and depth of the pixels that are covered, by lines.
type Pixels = Vec<Vec<Option<([u8; 3], u32)>>>;

/// What a pane looks like alone: colour and depth where it covers a pixel.
fn alone(pane: &Pane) -> Pixels {
    let mut rooms = SceneRooms::<Plain>::new(16, 8, usize::from(HEIGHT));
    let mut scene = rooms.scene(Screen::new(WIDTH, HEIGHT).unwrap());
    scene.begin(&camera()).unwrap();
    scene.draw(&mesh(pane), &instance()).unwrap();
    let mut out = Vec::new();
    for y in scene.lines() {
        let mut memory = LineRooms::fitting(4, &scene);
        let mut renderer = memory.renderer();
        renderer.set_depth_use(DepthUse::Always);
        let words = line(&mut renderer, &scene, y);
        let depths = memory.depth();
        let pixel = |(word, depth): (&[u8; 3], &u32)| (*depth > 0).then_some((*word, *depth));
        out.push(words.iter().zip(depths).map(pixel).collect());
    }
    out
}

/// A pane's alpha at a pixel of its own, from what a white one with its alphas as colours shows.
fn alphas(pane: &Pane) -> Pixels {
    alone(&Pane {
        colours: pane.alphas.map(|a| [a; 3]),
        ..*pane
    })
}

fn build<P: Pipeline>(scene: &mut Scene<'_, P>, panes: &[Pane])
where
    for<'a> scanbeam::pipeline::SkinOf<'a, P>: From<Surface<'a>>,
{
    scene.begin(&camera()).unwrap();
    for pane in panes {
        let surface = Surface {
            finish: pane.finish,
            alphas: if pane.varies { &pane.alphas } else { &[] },
            ..Surface::default()
        };
        scene
            .draw_skinned(&mesh(pane), surface.into(), &instance())
            .unwrap();
    }
}

fn rooms<P: Pipeline>(panes: &[Pane]) -> SceneRooms<P> {
    SceneRooms::new(
        9 * panes.len() + 9,
        4 * panes.len() + 4,
        usize::from(HEIGHT),
    )
}

fn passes(function: DepthFunction, new: u32, old: u32) -> bool {
    match function {
        DepthFunction::NEVER => false,
        DepthFunction::FARTHER => new < old,
        DepthFunction::EQUAL => new == old,
        DepthFunction::FARTHER_OR_EQUAL => new <= old,
        DepthFunction::NEARER => new > old,
        DepthFunction::DIFFERENT => new != old,
        DepthFunction::NEARER_OR_EQUAL => new >= old,
        _ => true,
    }
}

/// What a pixel becomes, in f64.
fn over(old: [f64; 3], new: [f64; 3], finish: &Finish, alpha: f64) -> [f64; 3] {
    let factor = |f: Factor, old: f64| match f {
        Factor::Constant(c) => f64::from(c) / 255.0,
        Factor::SourceAlpha => alpha,
        Factor::InverseSourceAlpha => 1.0 - alpha,
        Factor::TextureAlpha => 1.0,
        Factor::InverseTextureAlpha => 0.0,
        Factor::Destination => old / 255.0,
        Factor::InverseDestination => 1.0 - old / 255.0,
    };
    [0, 1, 2].map(|i| {
        let (o, n) = (old[i], new[i]);
        if finish.channels >> i & 1 == 0 {
            return o;
        }
        match finish.blend {
            Blend::Replace => n,
            Blend::Filter => o + (n - o) * alpha,
            Blend::Half => (o + n) / 2.0,
            Blend::Add => (o + n * alpha).min(255.0),
            Blend::Subtract => (o - n * alpha).max(0.0),
            Blend::Factors {
                source,
                destination,
            } => (n * factor(source, o) + o * factor(destination, o)).min(255.0),
        }
    })
}

/// Draws panes in both ways; the largest difference in levels, and how many pixels have so many
/// layers.
fn compare(panes: &[Pane], layers: &mut [u32; 8]) -> f64 {
    let apart: Vec<_> = panes.iter().map(|p| (alone(p), alphas(p))).collect();
    let mut memory = rooms::<Mixed>(panes);
    let mut scene = memory.scene(Screen::new(WIDTH, HEIGHT).unwrap());
    build(&mut scene, panes);
    let drawn = frame(&scene, 64);
    let mut worst = 0f64;
    for (y, words) in drawn.iter().enumerate() {
        for (x, word) in words.iter().enumerate() {
            let (mut colour, mut depth, mut bound) = ([0.0; 3], 0, 0.0);
            let mut later = Vec::new();
            let mut put = |i: usize, depth: &mut u32, bound: &mut f64| {
                let (Some((rgb, at)), Some((alpha, _))) = (apart[i].0[y][x], apart[i].1[y][x])
                else {
                    return false;
                };
                let finish = &panes[i].finish;
                let vertex = if panes[i].varies { alpha[0] } else { 255 };
                let alpha = f64::from(finish.alpha) * f64::from(vertex) / 65_025.0;
                let seen = passes(finish.colour_if, at, *depth);
                if seen {
                    colour = over(colour, rgb.map(f64::from), finish, alpha);
                    // Ideal rounding and one level, and half a level for each alpha rounded.
                    // Colours of what is not plain are anchored anew every 32 pixels, and those of
                    // thin triangles with alphas have another precision: a level.
                    let replaces = finish.blend == Blend::Replace;
                    *bound += if replaces { 0.0 } else { 2.5 };
                    *bound += f64::from(u8::from(panes[i].varies || *finish != Finish::OPAQUE));
                }
                if passes(finish.depth_if, at, *depth) {
                    *depth = at;
                }
                seen
            };
            let mut count = 0;
            for (i, pane) in panes.iter().enumerate() {
                if pane.finish.blend == Blend::Replace {
                    put(i, &mut depth, &mut bound);
                } else if let Some((_, at)) = apart[i].0[y][x] {
                    later.push((at, i));
                }
            }
            later.sort_unstable();
            for (_, i) in later {
                count += usize::from(put(i, &mut depth, &mut bound));
            }
            layers[count.min(7)] += 1;
            for i in 0..3 {
                let off = (f64::from(word[i]) - colour[i]).abs();
                assert!(
                    off <= bound,
                    "({x}, {y}): {word:?} instead of {colour:?}, {off} above {bound}"
                );
                worst = worst.max(off);
            }
        }
    }
    worst
}

fn any_blend(rng: &mut Rng) -> Finish {
    let alpha = rng.below(256) as u8;
    let blend = rng.pick(&[
        Blend::Filter,
        Blend::Filter,
        Blend::Half,
        Blend::Add,
        Blend::Subtract,
        Blend::Factors {
            source: Factor::Destination,
            destination: Factor::InverseSourceAlpha,
        },
    ]);
    Finish {
        channels: rng.pick(&[7, 7, 7, 3, 4]),
        ..Finish::blended(blend, alpha)
    }
}

#[test]
fn transparent_surfaces_are_blended_from_back_to_front() {
    let mut rng = Rng::new(71);
    let mut layers = [0; 8];
    let mut worst = 0f64;
    for round in 0..40 {
        let panes = panes(&mut rng, 4 + round % 9, |rng| {
            if rng.below(3) == 0 {
                Finish::OPAQUE
            } else {
                any_blend(rng)
            }
        });
        worst = worst.max(compare(&panes, &mut layers));
    }
    println!("worst {worst:.2} levels; pixels by layers {layers:?}");
    assert!(layers[2] > 1000 && layers[3] > 100, "{layers:?}");
}

#[test]
fn additive_surfaces_need_no_order() {
    let mut rng = Rng::new(12);
    let mut layers = [0; 8];
    for _ in 0..10 {
        let mut all = panes(&mut rng, 10, |rng| {
            if rng.below(3) == 0 {
                Finish::OPAQUE
            } else {
                Finish::additive(rng.below(256) as u8)
            }
        });
        compare(&all, &mut layers);
        let mut first = rooms::<Mixed>(&all);
        let mut scene = first.scene(Screen::new(WIDTH, HEIGHT).unwrap());
        build(&mut scene, &all);
        let before = frame(&scene, 64);
        rng.shuffle(&mut all);
        let mut second = rooms::<Mixed>(&all);
        let mut scene = second.scene(Screen::new(WIDTH, HEIGHT).unwrap());
        build(&mut scene, &all);
        assert!(frame(&scene, 64) == before);
    }
    assert!(layers[3] > 50, "{layers:?}");
}

#[test]
fn depth_functions_choose_colour_and_depth_apart() {
    let mut rng = Rng::new(5);
    let functions = [
        DepthFunction::NEVER,
        DepthFunction::ALWAYS,
        DepthFunction::NEARER,
        DepthFunction::NEARER_OR_EQUAL,
        DepthFunction::EQUAL,
        DepthFunction::FARTHER_OR_EQUAL,
        DepthFunction::FARTHER,
        DepthFunction::DIFFERENT,
    ];
    let mut layers = [0; 8];
    for _ in 0..30 {
        let mut panes = panes(&mut rng, 9, |rng| Finish {
            colour_if: rng.pick(&functions),
            depth_if: rng.pick(&functions),
            ..Finish::OPAQUE
        });
        // The same surface again, for what is equal; where it is alone it is no such surface, and
        // its depth may be another with other colours.
        for i in 0..4 {
            let mut again = panes[i];
            for colour in again.colours.as_flattened_mut() {
                *colour = 255 - *colour;
            }
            again.finish.colour_if = rng.pick(&functions);
            panes.push(again);
        }
        compare(&panes, &mut layers);
    }
}

/// More panes on a line than are sorted in one go.
#[test]
fn a_hundred_panes() {
    let mut rng = Rng::new(8);
    let panes: Vec<Pane> = (0..100i16)
        .map(|i| {
            let z = -16_000 + 320 * ((i * 37) % 100);
            Pane {
                positions: [[-30_000, -30_000, z], [30_000, -30_000, z], [0, 30_000, z]],
                colours: [[(); 3].map(|()| rng.below(256) as u8); 3],
                alphas: [255; 3],
                varies: false,
                finish: Finish::filtered(rng.within(5, 60) as u8),
            }
        })
        .collect();
    let mut layers = [0; 8];
    let worst = compare(&panes, &mut layers);
    println!("worst {worst:.2}");
    assert!(layers[7] > 400 && worst < 20.0, "{worst} {layers:?}");
}

/// Whatever the cache and the renderers are, and line by line, the picture is the same.
fn same_picture<P: Pipeline>(seed: u64)
where
    for<'a> scanbeam::pipeline::SkinOf<'a, P>: From<Surface<'a>>,
{
    let mut rng = Rng::new(seed);
    for _ in 0..8 {
        let panes = panes(&mut rng, 14, |rng| match rng.below(4) {
            0 => Finish::OPAQUE,
            1 => Finish {
                colour_if: DepthFunction::DIFFERENT,
                ..Finish::OPAQUE
            },
            _ => any_blend(rng),
        });
        let mut memory = rooms::<P>(&panes);
        let mut scene = memory.scene(Screen::new(WIDTH, HEIGHT).unwrap());
        build(&mut scene, &panes);
        let reference: Vec<Vec<WordOf<P>>> = frame(&scene, 64);
        for slots in [0, 1, 2, 5, 9] {
            assert!(frame(&scene, slots) == reference, "{slots} slots");
            for step in [2, 3] {
                let mut lines = LineRooms::fitting(slots, &scene);
                let mut renderer = lines.renderer();
                for y in scene.lines().step_by(step) {
                    renderer.prefetch(&scene, y, rng.below(400)).unwrap();
                    let got = line(&mut renderer, &scene, y);
                    assert!(got == reference[usize::from(y)], "{slots} slots, line {y}");
                }
            }
        }
        let mut order: Vec<u16> = scene.lines().collect();
        rng.shuffle(&mut order);
        let mut lines = LineRooms::fitting(4, &scene);
        let mut renderer = lines.renderer();
        for y in order {
            assert!(line(&mut renderer, &scene, y) == reference[usize::from(y)]);
        }
    }
}

#[test]
fn any_cache_gives_the_same_picture() {
    same_picture::<Mixed>(3);
    same_picture::<Composited<GouraudDepth<Rgb565Be>>>(4);
    same_picture::<Composited<GouraudPainter<Rgb565Be>>>(5);
    same_picture::<Composited<FlatPainter<Rgb888>>>(6);
}

#[test]
fn opaque_finishes_change_nothing() {
    let mut rng = Rng::new(33);
    for _ in 0..20 {
        let mut panes = panes(&mut rng, 12, |_| Finish::OPAQUE);
        for pane in &mut panes {
            pane.varies = false;
        }
        let mut memory = rooms::<Plain>(&panes);
        let mut scene = memory.scene(Screen::new(WIDTH, HEIGHT).unwrap());
        scene.begin(&camera()).unwrap();
        for pane in &panes {
            scene.draw(&mesh(pane), &instance()).unwrap();
        }
        let plain = frame(&scene, 16);
        let mut memory = rooms::<Mixed>(&panes);
        let mut scene = memory.scene(Screen::new(WIDTH, HEIGHT).unwrap());
        build(&mut scene, &panes);
        assert!(frame(&scene, 16) == plain);
    }
}
