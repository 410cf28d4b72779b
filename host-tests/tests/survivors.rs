//! What documents say and no other proof holds: texels' alpha and D bit on the way through the
//! renderer, the place of the dither's tile, shadows of meshes with edges of several faces, budgets
//! and figures.

use crate::common::{LineRooms, SceneRooms, frame};
use host_tests::rooms::{self, Room};
use scanbeam::event::Event;
use scanbeam::look;
use scanbeam::mesh::{I2F14, ScreenVertex};
use scanbeam::pipeline::blend::{Blend, Factor, Finish, Surface};
use scanbeam::pipeline::parallel::{Crew, Interleave, LineSource};
use scanbeam::pipeline::texture::{Quality, Size, Skin, Texel, Texture, Textures, Words};
use scanbeam::pipeline::{Composited, FlatDepth, FrameStats, TexturedDepth};
use scanbeam::pixel::{Dithered, Ordered, PixelFormat, Ranks, Rgb565, Rgb888};
use scanbeam::scene::{Draw, Shadow, ShadowEdge, ShadowLight, ShadowMemory};
use scanbeam::stats::SpanCounts;
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, Screen};

type Store<'t> = Texture<Words<'t, Texel>>;

fn camera() -> Camera {
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    Camera::look_at([0.0; 3], ahead, up, 20.0, 0.1, 99.0).unwrap()
}

/// A square over a picture 16 x 16, in one colour.
fn square(depth: u32, colour: [u8; 3]) -> [ScreenVertex; 4] {
    [(0, 0), (0, 128), (128, 128), (128, 0)].map(|(x, y)| ScreenVertex {
        x,
        y,
        depth,
        colour,
    })
}

const FACES: [[u16; 3]; 2] = [[0, 1, 2], [0, 2, 3]];
/// u of four texels from left to right, v of four down.
const PLACES: [[i32; 2]; 4] = [[0, 0], [0, 1024], [1024, 1024], [1024, 0]];

/// Four texels a side: columns of alpha 0, 64, 127, and 127 with the D bit.
fn texels() -> Vec<Texel> {
    let of = |i: usize| Texel {
        rgb: [[10, 200, 90], [240, 30, 60], [70, 80, 250], [120, 130, 20]][i % 4],
        alpha: [0, 64, 127, 127][i % 4],
        undithered: i % 4 == 3,
    };
    (0..16).map(of).collect()
}

/// Each texel's column over a background, by a finish.
fn blended(background: [u8; 3], finish: Finish) -> [[u8; 3]; 4] {
    type Look<'t> = Composited<TexturedDepth<'t, Rgb888, Store<'t>>>;
    let texels = texels();
    let textures = [Texture::new(Words(&texels), Size::new(4, 4).unwrap()).unwrap()];
    let mut rooms = SceneRooms::<Look<'_>>::new(8, 4, 16);
    rooms.textures = Textures(&textures);
    let mut scene = rooms.scene(Screen::new(16, 16).unwrap());
    scene.begin(&camera()).unwrap();
    let none = Surface::from(Finish::OPAQUE);
    let back = square(1 << 20, background);
    scene.draw_screen(&back, &FACES, none, Cull::None).unwrap();
    let surface = Surface {
        skin: Skin {
            places: &PLACES,
            texture: 0,
            quality: Quality::Exact,
        },
        finish,
        alphas: &[],
    };
    let front = square(1 << 30, [255; 3]);
    scene
        .draw_screen(&front, &FACES, surface, Cull::None)
        .unwrap();
    let picture = frame(&scene, 4);
    let columns = [0, 1, 2, 3].map(|i| picture[7][4 * i + 1]);
    for line in &picture {
        for (x, pixel) in line.iter().enumerate() {
            assert_eq!(*pixel, columns[x / 4], "all texels of a column are alike");
        }
    }
    columns
}

/// K11, H8: the alpha of texels counts where a finish says so, and only there; 127 of A is 1, and
/// texels with the D bit are added where a finish forces it.
#[test]
fn texels_have_their_say_in_blending() {
    let old = [100u8, 60, 180];
    let alphas = [0.0, 64.0 / 127.0, 1.0, 1.0];
    let filtered = Finish::filtered(200);
    let factors = |source, destination| {
        Finish::blended(
            Blend::Factors {
                source,
                destination,
            },
            200,
        )
    };
    let by_texel = factors(Factor::TextureAlpha, Factor::InverseTextureAlpha);
    let with = |finish: Finish| Finish {
        texel_alpha: true,
        ..finish
    };
    let forced = |finish: Finish| Finish {
        force_additive: true,
        ..finish
    };
    // A finish; then what becomes of a new and an old level at a texel's alpha, D or not.
    type Rule = fn(f64, f64, f64, bool) -> f64;
    const PART: f64 = 200.0 / 255.0;
    let cases: [(&str, Finish, Rule); 8] = [
        ("opaque", Finish::OPAQUE, |n, _, _, _| n),
        (
            "cut out",
            Finish::CUT_OUT,
            |n, o, a, _| if a == 0.0 { o } else { n },
        ),
        ("filter", filtered, |n, o, _, _| o + (n - o) * PART),
        ("by alpha", with(filtered), |n, o, a, _| {
            o + (n - o) * PART * a
        }),
        ("forced", forced(filtered), |n, o, _, d| {
            if d { o + n * PART } else { o + (n - o) * PART }
        }),
        ("both", with(forced(filtered)), |n, o, a, d| {
            if d {
                o + n * PART
            } else {
                o + (n - o) * PART * a
            }
        }),
        ("factors", by_texel, |n, o, a, _| n * a + o * (1.0 - a)),
        ("added", with(Finish::additive(200)), |n, o, a, _| {
            o + n * PART * a
        }),
    ];
    for (name, finish, rule) in cases {
        for (i, got) in blended(old, finish).into_iter().enumerate() {
            let texel = texels()[i];
            for k in 0..3 {
                let new = f64::from(texel.rgb[k]);
                let want = rule(new, f64::from(old[k]), alphas[i], texel.undithered).min(255.0);
                let off = (f64::from(got[k]) - want).abs();
                assert!(off <= 2.5, "{name}, texel {i}: {got:?}, {want}");
            }
        }
    }
}

/// H10: texels with the D bit are rounded, in full light and in less; others are dithered.
#[test]
fn texels_with_the_d_bit_are_not_dithered() {
    type Look<'t> = TexturedDepth<'t, Dithered<Rgb565>, Store<'t>>;
    for light in [255, 140] {
        for undithered in [false, true] {
            let texels = [Texel {
                rgb: [101, 103, 107],
                alpha: 127,
                undithered,
            }; 16];
            let textures = [Texture::new(Words(&texels[..]), Size::new(4, 4).unwrap()).unwrap()];
            let mut rooms = SceneRooms::<Look<'_>>::new(4, 2, 16);
            rooms.textures = Textures(&textures);
            let mut scene = rooms.scene(Screen::new(16, 16).unwrap());
            scene.begin(&camera()).unwrap();
            let skin = Skin {
                places: &PLACES,
                texture: 0,
                quality: Quality::Exact,
            };
            let vertices = square(1 << 30, [light; 3]);
            scene
                .draw_screen(&vertices, &FACES, skin, Cull::None)
                .unwrap();
            let picture = frame(&scene, 4);
            let first = picture[0][0];
            let alike = picture.iter().flatten().all(|pixel| *pixel == first);
            assert_eq!(alike, undithered, "{light}");
            if undithered && light == 255 {
                assert_eq!(first, Rgb565::from_rgb8([101, 103, 107]));
            }
        }
    }
}

/// H10: the tile is fixed to the picture's middle, and pixels of a higher rank step up first.
#[test]
fn the_dither_lies_where_it_is_said_to() {
    type Look = FlatDepth<Dithered<Rgb565>>;
    for (width, height) in [(16u16, 16u16), (18, 12), (17, 21)] {
        let mut stepped = 0;
        for level in 90..100 {
            let mut rooms = SceneRooms::<Look>::new(4, 2, usize::from(height));
            let mut scene = rooms.scene(Screen::new(width, height).unwrap());
            scene.begin(&camera()).unwrap();
            let vertices = square(1 << 30, [level; 3]).map(|v| ScreenVertex {
                x: v.x * 2,
                y: v.y * 2,
                ..v
            });
            scene
                .draw_screen(&vertices, &FACES, (), Cull::None)
                .unwrap();
            // The most that a rank got, and the least.
            let mut ends = [(u16::MAX, 0); 16];
            for (y, line) in frame(&scene, 2).into_iter().enumerate() {
                for (x, word) in line.into_iter().enumerate() {
                    let from_middle = |at: usize, side: u16| {
                        (at as i32 - i32::from(side / 2)).rem_euclid(4) as usize
                    };
                    let (row, column) = (from_middle(y, height), from_middle(x, width));
                    let end = &mut ends[usize::from(Ordered::RANKS[row][column])];
                    *end = (end.0.min(word >> 11), end.1.max(word >> 11));
                }
            }
            for pair in ends.windows(2) {
                assert!(pair[0].1 <= pair[1].0, "level {level}: {ends:?}");
            }
            stepped += u32::from(ends[0].0 < ends[15].1);
        }
        assert!(stepped >= 5, "{stepped}");
    }
}

/// The picture of a floor in the shadow of meshes.
fn shaded(meshes: &[&[[u16; 3]]], positions: &[[i16; 3]]) -> Vec<Vec<[u8; 3]>> {
    let room = Room {
        vertices: 400,
        places: 0,
        objects: 400,
        draws: 32,
    };
    let screen = Screen::new(64, 48).unwrap();
    let mut rooms = rooms::SceneRooms::new(room, 48);
    let mut scene = rooms.scene::<look::Gouraud<Rgb888>>(screen);
    let eye = [0.4, 2.5, 2.0];
    let camera = Camera::look_at(eye, [0.0; 3], [0.0, 1.0, 0.0], 40.0, 0.1, 99.0).unwrap();
    scene.begin(&camera).unwrap();
    let c = 32_000;
    let floor = [[-c, 0, -c], [c, 0, -c], [c, 0, c], [-c, 0, c]];
    let faces = [[0, 2, 1], [0, 3, 2]];
    let mesh = |positions, faces| Mesh {
        positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(faces),
    };
    let plain = Draw {
        cull: Cull::None,
        ..Draw::new(mesh(&floor[..], &faces[..]))
    };
    scene.draw(&plain).unwrap();
    let light = ShadowLight {
        light: 0,
        direction: [I2F14::ZERO, I2F14::ONE, I2F14::ZERO],
        reach: 3,
    };
    for faces in meshes {
        let memory = ShadowMemory {
            edges: &mut [ShadowEdge::default(); 32],
            positions: &mut [[0; 3]; 64],
            faces: &mut [[0; 3]; 64],
        };
        scene
            .draw_shadow(&mesh(positions, faces), &Affine::IDENTITY, &light, memory)
            .unwrap();
    }
    let dark = Draw {
        colour: [40; 3],
        shadow: Some(Shadow::Shadowed(0)),
        ..plain
    };
    scene.draw(&dark).unwrap();
    let mut lines: rooms::LineRooms<look::Gouraud<Rgb888>> =
        rooms::LineRooms::new(room.objects, 64).with_counts();
    let mut renderer = lines.renderer();
    let line = |y| {
        let mut line = vec![[0; 3]; 64];
        renderer.draw_line(&scene, y, &mut line, [0; 3]).unwrap();
        line
    };
    scene.lines().map(line).collect()
}

/// K9: a volume is closed whatever the mesh is: faces that share an edge the same way cast the
/// shadow that they cast one by one.
#[test]
fn edges_of_several_faces_are_drawn_out_for_each() {
    // One edge, along x, and corners on both sides of it and one above the other.
    let positions = [
        [-9000, 6000, 0],
        [9000, 6000, 0],
        [0, 6000, -9000],
        [3000, 9000, -7000],
        [-2000, 3000, -12_000],
    ];
    let (a, b, c) = ([0, 1, 2], [0, 1, 3], [0, 1, 4]);
    for faces in [&[a, b][..], &[a, b, c], &[b, c, a], &[c, c]] {
        let apart: Vec<&[[u16; 3]]> = faces.chunks(1).collect();
        let (together, one_by_one) = (shaded(&[faces], &positions), shaded(&apart, &positions));
        let dark = |p: &Vec<Vec<[u8; 3]>>| p.iter().flatten().filter(|p| **p == [40; 3]).count();
        assert!(dark(&one_by_one) > 30, "{}", dark(&one_by_one));
        assert!(together == one_by_one, "{faces:?}");
    }
}

/// H14: the events of a frame are those of its figures.
#[test]
fn frames_tell_what_their_figures_say() {
    let with = |set: fn(&mut FrameStats)| {
        let mut stats = FrameStats::default();
        set(&mut stats);
        stats.events().iter().collect::<Vec<_>>()
    };
    assert_eq!(with(|_| {}), []);
    assert_eq!(with(|s| s.spans.pixels_hidden = 1), [Event::DepthFailed]);
    assert_eq!(with(|s| s.spans.pixels_shaded = 1), [Event::PixelRendered]);
    assert_eq!(with(|s| s.pass_one.clipped = 1), [Event::Clipped]);
    assert_eq!(with(|s| s.pass_one.dropped = 1), [Event::Full]);
    assert_eq!(with(|s| s.pass_one.untextured = 1), [Event::Untextured]);
    let tested = SpanCounts {
        pixels_shaded: 2,
        depth_tests: 2,
        ..SpanCounts::default()
    };
    let stats = FrameStats {
        spans: tested,
        ..FrameStats::default()
    };
    let events: Vec<_> = stats.events().iter().collect();
    assert_eq!(events, [Event::PixelRendered, Event::DepthPassed]);
}

/// M4: of a crew, lines on which nothing is active are counted, whoever draws them.
#[test]
fn a_crew_counts_the_lines_that_it_skips() {
    type Look = FlatDepth<Rgb888>;
    let mut rooms = SceneRooms::<Look>::new(4, 2, 32);
    let mut scene = rooms.scene(Screen::new(16, 32).unwrap());
    scene.begin(&camera()).unwrap();
    // Lines 0 to 15 of 32.
    scene
        .draw_screen(&square(1 << 30, [9; 3]), &FACES, (), Cull::None)
        .unwrap();
    let mut lines = [LineRooms::fitting(4, &scene), LineRooms::fitting(4, &scene)];
    let [first, second] = &mut lines;
    let (mut here, mut there) = (first.renderer(), second.renderer());
    here.set_interleave(Interleave::lines(2, 0).unwrap());
    there.set_interleave(Interleave::lines(2, 1).unwrap());
    let mut crew = Crew {
        scene: &scene,
        here: &mut [here, there],
        background: [0; 3],
        skipped: 0,
    };
    let mut pixels = [[0; 3]; 16];
    for y in 0..32 {
        crew.line(y, &mut pixels).unwrap();
        assert_eq!(pixels == [[9; 3]; 16], y < 16, "line {y}");
    }
    assert_eq!(crew.skipped, 16);
}
