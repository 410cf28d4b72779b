//! Triangles that stretch far over their texture (A4): 4,096 texels are drawn wherever they begin, in every pixel's texel;
//! what stretches farther is white, counted once, and told.

use crate::common::Rng;
use crate::hot::shine::even_light;
use crate::hot::{LineRooms, NO_MESH, SceneRooms, Smooth, camera, line};
use scanbeam::event::Event;
use scanbeam::light::PixelLamps;
use scanbeam::look::{Textured, TexturedPhong};
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::{Rgb565, Rgb888};
use scanbeam::scene::{Assembled, Budget, Draw, ScreenCorner, Skin, Texture};
use scanbeam::{Camera, Cull, Faces, Mesh, Screen};

/// Pixels of the picture's side, and of the triangle's.
const SIDE: u16 = 64;
const TEXELS: usize = 1024;

/// A texel for each column, which names it and is not white.
fn columns() -> &'static [u16] {
    (0..TEXELS as u16).collect::<Vec<_>>().leak()
}

fn texture() -> &'static Texture<'static> {
    Box::leak(Box::new(Texture::words(columns(), 1024, 1).unwrap()))
}

/// A call of the texture, of either side.
fn textured<'a>(mesh: Mesh<'a>, places: &'a [[i32; 2]], budget: Budget) -> Draw<'a, 'static> {
    Draw {
        texture: Some(Skin {
            texture: texture(),
            places,
            budget,
        }),
        cull: Cull::None,
        ..Draw::new(mesh)
    }
}

/// The upper left half of the picture, u from one place to another from left to right, in texels with 8 fraction bits.
fn corners(from: i32, to: i32, depths: [u32; 3]) -> [ScreenCorner; 3] {
    let places = [(0, 0, from), (SIDE, 0, to), (0, SIDE, from)];
    [0, 1, 2].map(|i| {
        let (x, y, u) = places[i];
        ScreenCorner {
            vertex: ScreenVertex {
                x: 8 * x as i16,
                y: 8 * y as i16,
                depth: depths[i],
                colour: [255; 3],
            },
            texel: [u, 128],
        }
    })
}

/// The picture by so many slots, and what was counted.
fn picture(triangles: &[[ScreenCorner; 3]], budget: Budget, slots: u16) -> (Vec<u16>, Assembled) {
    let screen = Screen::new(SIDE, SIDE).unwrap();
    let mut rooms = SceneRooms::of_triangles(triangles.len(), screen);
    let mut scene = rooms.scene::<Textured<Rgb565>>(screen);
    scene.begin(&camera()).unwrap();
    let call = textured(NO_MESH, &[], budget);
    scene.draw_screen(&call, triangles).unwrap();
    let mut rooms = LineRooms::fitting(&scene, slots, true);
    let mut renderer = rooms.renderer();
    let pixels = (0..SIDE).flat_map(|y| line(&mut renderer, &scene, y, 0xF81F));
    (pixels.collect(), scene.assembled())
}

/// Where places may begin, in texels with 8 fraction bits, half a texel in: all within 2^17 texels.
fn starts(rng: &mut Rng) -> Vec<i32> {
    let mut starts = vec![0, 1, 1000, 1023, 1024, -1, -4000, -131_072, 131_071 - 4096];
    starts.extend((0..40).map(|_| rng.within(-131_072, 131_071 - 4096)));
    starts.into_iter().map(|start| 256 * start + 128).collect()
}

/// Kills: a limit below 4,096 texels, and a rise that is not brought nearer there, which 32 bits do not hold.
#[test]
fn a_triangle_may_stretch_over_4096_texels() {
    let mut rng = Rng::new(1101);
    let leaning = [1 << 30, 1 << 28, 1 << 29];
    let level = [1 << 30; 3];
    for start in starts(&mut rng) {
        for (way, wide) in [
            (3073 * 256, false),
            (4096 * 256 - 1, false),
            (4096 * 256, false),
            (4096 * 256 + 1, true),
            (100_000 * 256, true),
        ] {
            let ends = [(start, start + way), (start + way, start)];
            let (from, to) = ends[rng.below(2) as usize];
            for depths in [level, leaning] {
                let mut three = corners(from, to, depths);
                three.rotate_left(rng.below(3) as usize);
                let (shown, counts) = picture(&[three], Budget::EXACT, 64);
                let context = format!("{from} to {to}, {depths:?}");
                assert_eq!(counts.untextured, u32::from(wide), "{context}");
                assert_eq!(counts.events().has(Event::Untextured), wide, "{context}");
                let (alone, again) = picture(&[three], Budget::EXACT, 0);
                assert!(alone == shown && again == counts, "{context}");
                let inside = |i: usize| i % 64 + i / 64 < 63;
                let all = shown.iter().enumerate().filter(|(i, _)| inside(*i));
                if wide {
                    assert!(all.clone().all(|(_, p)| *p == 0xFFFF), "{context}");
                    continue;
                }
                assert!(all.clone().all(|(_, p)| *p < 1024), "{context}");
                if depths == level {
                    for (i, texel) in all {
                        let along = i64::from(to - from) * (2 * (i as i64 % 64) + 1);
                        // Away from a texel's edge, which the budget may cross.
                        let at = i64::from(from) * 128 + along;
                        if (3..253).contains(&((at >> 7) & 255)) {
                            let want = (at >> 15).rem_euclid(1024) as u16;
                            assert_eq!(*texel, want, "{context}, pixel {i}");
                        }
                    }
                }
            }
        }
    }
}

/// Of many triangles each wide one is counted once, down the texture as across it, whatever is cached and whoever draws
/// which lines; without a texture none is.
/// Kills: ways from the first corner alone, one axis alone, all triangles of a scene in place of those of a call, calls
/// without a texture, and none where places come with corners.
#[test]
fn wide_triangles_are_counted_once() {
    let mut rng = Rng::new(1102);
    let level = [1 << 30; 3];
    let mut triangles = Vec::new();
    let mut wide = 0;
    for i in 0..90 {
        let way = [100, 4096 * 256, 4096 * 256 + 1, 9000 * 256][rng.below(4) as usize];
        let mut three = corners(0, way, level);
        if i % 3 == 2 {
            // The first corner lies between the others.
            three[0].texel[0] = way / 2;
        }
        if i % 2 == 1 {
            for corner in &mut three {
                corner.texel.reverse();
            }
        }
        wide += u32::from(way > 4096 * 256);
        triangles.push(three);
    }
    assert!(wide > 20);
    let screen = Screen::new(SIDE, SIDE).unwrap();
    let mut rooms = SceneRooms::of_triangles(2 * triangles.len(), screen);
    let mut scene = rooms.scene::<Textured<Rgb565>>(screen);
    scene.begin(&camera()).unwrap();
    let mut call = textured(NO_MESH, &[], Budget::FAST);
    for half in triangles.chunks(45) {
        scene.draw_screen(&call, half).unwrap();
    }
    call.texture = None;
    scene.draw_screen(&call, &triangles).unwrap();
    assert_eq!(scene.assembled().untextured, wide);
    let mut rooms = [0, 1].map(|_| LineRooms::fitting(&scene, 32, true));
    let [even, odd] = &mut rooms;
    let mut renderers = [even.renderer(), odd.renderer()];
    for y in 0..SIDE {
        line(&mut renderers[usize::from(y % 2)], &scene, y, 0);
    }
    assert_eq!(scene.assembled().untextured, wide);
}

/// The pieces of triangles of a mesh that the near plane cuts, and that are still too wide, count each.
fn cut<L: Smooth>(normals: &[[i16; 3]], lamps: Option<&'static PixelLamps>) -> u32 {
    let screen = Screen::new(SIDE, SIDE).unwrap();
    let mut rooms = SceneRooms::new(99, 99, 64, 9);
    let mut scene = rooms.scene::<L>(screen);
    let (ahead, up) = ([0.0, 0.0, -1.0], [0.0, 1.0, 0.0]);
    let camera = Camera::look_at([0.0; 3], ahead, up, 9.0, 0.1, 9.0).unwrap();
    scene.begin(&camera).unwrap();
    let positions = [
        [-8192i16, -8192, -16_384],
        [8192, -8192, -16_384],
        [0, 16_384, 16_384],
    ];
    let faces = [[0, 1, 2]];
    let places = [[0, 0], [9000 * 256, 0], [0, 0]];
    let mesh = Mesh {
        positions: &positions,
        normals,
        colours: &[],
        faces: Faces::Triangles(&faces),
    };
    let call = Draw {
        lamps,
        ..textured(mesh, &places, Budget::FAST)
    };
    scene.draw(&call).unwrap();
    let counts = scene.assembled();
    assert_eq!(counts.clipped, 1);
    assert!(scene.objects() >= 2, "what is left has four corners");
    assert_eq!(
        counts.events().iter().collect::<Vec<_>>(),
        [Event::Clipped, Event::Untextured]
    );
    counts.untextured
}

/// Kills: counts where a call has no texture in place of where it has one.
#[test]
fn pieces_of_what_is_cut_are_counted() {
    assert_eq!(cut::<Textured<Rgb565>>(&[], None), 2);
    assert_eq!(cut::<Textured<Rgb888>>(&[], None), 2);
    assert_eq!(
        cut::<TexturedPhong<Rgb888>>(&[[0, 0, 127 << 8]; 3], even_light()),
        2
    );
}
