//! K11, H7, H8, H10: alpha that differs from vertex to vertex and from texel to texel, texels that are added or not
//! dithered, against f64 and against formulas of whole numbers, pixel by pixel.

mod masks;
mod modes;
mod sampled;

use crate::common::Rng;
use crate::hot::exact::{weights, within};
use crate::hot::shine::even_light;
use crate::hot::{Corner, NO_MESH, SceneRooms, Smooth, WordOf, camera, draw_with, frame};
use scanbeam::look::{Gouraud, Phong, Textured};
use scanbeam::mesh::ScreenVertex;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888, Xrgb8888};
use scanbeam::scene::{
    Blend, Draw, DrawError, Full, Sampling, ScreenCorner, Shading, Texture, TextureError,
};
use scanbeam::{Affine, Camera, Cull, Faces, Mesh, MeshError, Screen};

const BLACK: [u8; 3] = [0; 3];

fn leak<T>(all: Vec<T>) -> &'static [T] {
    all.leak()
}

/// A triangle of any size and slant, of these colours.
fn triangle(rng: &mut Rng, colour: [u8; 3]) -> [Corner; 3] {
    let size = rng.pick(&[12, 60, 200, 700, 3_000]);
    let middle = (rng.within(0, 380), rng.within(0, 190));
    let w = 1.0 + 3.0 * rng.unit();
    let slant = rng.pick(&[1.0, 1.0, 3.0]);
    [(); 3].map(|()| Corner {
        at: (
            middle.0 + rng.within(-size, size),
            middle.1 + rng.within(-size, size),
        ),
        w: w * rng.between(1.0, slant),
        colour,
    })
}

const WIDTH: u16 = 48;

/// The picture of one triangle as a call that `dress` changes: the same by any number of slots, with depth or without.
fn picture<L: Smooth>(
    corners: [Corner; 3],
    background: [u8; 3],
    dress: impl Fn(&mut Draw<'_, '_, i32>),
) -> Vec<Vec<WordOf<L>>>
where
    WordOf<L>: PartialEq,
{
    let screen = Screen::new(WIDTH, 24).expect("a screen");
    let mut rooms = SceneRooms::new(12, 4, 24, 1);
    let mut scene = rooms.scene::<L>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    draw_with(&mut scene, &[corners], |draw| {
        draw.cull = Cull::None;
        dress(draw);
    })
    .expect("there is room");
    let background = L::Format::from_rgb8(background);
    let lines = frame(&scene, 4, true, background);
    assert!(frame(&scene, 0, true, background) == lines, "without slots");
    assert!(
        frame(&scene, 4, false, background) == lines,
        "without depth"
    );
    lines
}

/// Calls `see` with each place that a triangle covers.
fn each_place(corners: &[Corner; 3], mut see: impl FnMut(usize, usize)) {
    for y in 0..24 {
        for x in within(corners.map(|c| c.at), y, WIDTH) {
            see(x, y as usize);
        }
    }
}

/// Holds white triangles over black, whose level is then their alpha, against f64.
fn vertices_have_alpha<L: Smooth>(seed: u64, off: f64)
where
    WordOf<L>: PartialEq,
{
    let mut rng = Rng::new(seed);
    let (mut pixels, mut worst) = (0, 0.0f64);
    for i in 0..300 {
        let corners = triangle(&mut rng, [255; 3]);
        let alphas = [(); 3].map(|()| rng.pick(&[0, 255, rng.clone().below(256) as u8]));
        let alphas = leak(alphas.to_vec());
        let own = rng.pick(&[255, 255, 200, 90]);
        let lines = picture::<L>(corners, BLACK, |draw| {
            draw.shading = [Shading::Smooth, Shading::Flat][i % 2];
            (draw.alphas, draw.blend) = (alphas, Some(Blend::filter(own)));
        });
        each_place(&corners, |x, y| {
            let (part, _) = weights(corners.map(|c| c.at), x as i32, y as i32);
            let alpha = (0..3).map(|k| part[k] * f64::from(alphas[k])).sum::<f64>();
            let want = alpha * f64::from(own) / 255.0;
            let got = L::Format::to_rgb8(lines[y][x]);
            for level in got {
                worst = worst.max((f64::from(level) - want).abs());
                assert!(
                    (f64::from(level) - want).abs() <= off,
                    "{got:?} for {want} at {x}, {y}: {alphas:?}, {corners:?}"
                );
            }
            pixels += 1;
        });
    }
    println!("{worst}");
    assert!(pixels > 20_000, "{pixels}");
}

/// Kills: alphas of a triangle with vertices of its own in another order, a flat face that takes its first one, a mode
/// whose own alpha is dropped, an alpha one column off.
#[test]
fn alpha_is_linear_between_vertices() {
    // Half a level of alpha, one of 256 in place of 255, and half of one of the pixel.
    vertices_have_alpha::<Gouraud<Rgb888>>(1, 2.0);
    vertices_have_alpha::<Gouraud<Xrgb8888>>(2, 2.0);
    vertices_have_alpha::<Textured<Rgb888>>(3, 2.0);
    // Half of one of 32, half a step, and the same half a level.
    vertices_have_alpha::<Gouraud<Rgb565Be>>(4, 8.9);
    vertices_have_alpha::<Textured<Rgb565Le>>(5, 8.9);
}

/// Meshes whose colours are their alphas, and white ones with these alphas over black, are the same pictures, where
/// triangles cross the near plane and the guard band too, whether vertices are shared or find no room.
///
/// Kills: alphas of the corners for pieces, a piece's in another order, records that are looked for elsewhere.
#[test]
fn what_is_cut_keeps_its_alphas() {
    let screen = Screen::new(64, 48).expect("a screen");
    let eye = Camera::look_at([0.0; 3], [0.0, 0.0, -1.0], [0.0, 1.0, 0.0], 40.0, 0.5, 30.0);
    let camera = eye.expect("a camera");
    let (mut pixels, mut clipped) = (0, 0);
    for seed in 0..60 {
        let mut rng = Rng::new(700 + seed);
        let positions: Vec<[i16; 3]> = (0..9)
            .map(|_| {
                let [x, y] = [(); 2].map(|()| rng.within(-16_000, 16_000) as i16);
                [x, y, rng.within(-16_000, 3_000) as i16]
            })
            .collect();
        let alphas: Vec<u8> = (0..9).map(|_| rng.below(256) as u8).collect();
        let grey: Vec<[u8; 3]> = alphas.iter().map(|a| [*a; 3]).collect();
        let faces = [[0, 1, 2], [3, 4, 5], [6, 7, 8]];
        // Opaque ones hide each other, so each is drawn alone.
        for face in faces {
            let mesh = Mesh {
                positions: &positions,
                normals: &[],
                colours: &grey,
                faces: Faces::Triangles(std::slice::from_ref(&face)),
            };
            let opaque = Draw {
                model: Affine::placed(4.0, [0.0, 0.0, -1.0]).expect("a model"),
                cull: Cull::None,
                ..Draw::new(mesh)
            };
            let translucent = Draw {
                mesh: Mesh {
                    colours: &[],
                    ..mesh
                },
                alphas: &alphas,
                blend: Some(Blend::ALPHA),
                ..opaque
            };
            // Room for the mesh and its records, for the mesh alone, for pieces alone.
            let room = [60, 10, 8][seed as usize % 3] + 24;
            let pictures = [opaque, translucent].map(|call| {
                let mut rooms = SceneRooms::new(room, 12, 48, 1);
                let mut scene = rooms.scene::<Gouraud<Rgb888>>(screen);
                scene.begin(&camera).expect("the rooms are large enough");
                scene.draw(&call).expect("there is room");
                clipped += scene.assembled().clipped;
                frame(&scene, 8, true, BLACK)
            });
            for (one, other) in pictures[0]
                .iter()
                .flatten()
                .zip(pictures[1].iter().flatten())
            {
                for (a, b) in one.iter().zip(other) {
                    assert!(a.abs_diff(*b) <= 2, "{one:?}, {other:?}: seed {seed}");
                }
                pixels += usize::from(*other != BLACK);
            }
        }
    }
    assert!(pixels > 20_000 && clipped > 50, "{pixels}, {clipped}");
}

/// Points, and triangles on the screen, have alphas too. Kills: one alpha for all points, corners of a face in another
/// order, a face that takes those of the first.
#[test]
fn what_is_made_on_the_screen_has_alphas() {
    let screen = Screen::new(WIDTH, 24).expect("a screen");
    let mut rng = Rng::new(20);
    let mut rooms = SceneRooms::new(400, 100, 24, 1);
    let mut scene = rooms.scene::<Gouraud<Rgb888>>(screen);
    scene.begin(&camera()).expect("the rooms are large enough");
    // One point a column, 2 wide, on other lines.
    let positions: Vec<[i32; 3]> = (0..8)
        .map(|i| [(6 * i - 21) << 18, (3 * i - 10) << 18, -(1 << 30)])
        .collect();
    let alphas: Vec<u8> = (0..8).map(|i| 20 + 30 * i as u8).collect();
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[]),
    };
    let points = Draw {
        alphas: &alphas,
        blend: Some(Blend::ALPHA),
        ..Draw::new(mesh)
    };
    scene.draw_points(&points, 2).expect("there is room");
    let lines = frame(&scene, 8, true, BLACK);
    let mut seen: Vec<(usize, u8)> = Vec::new();
    for line in &lines {
        for (x, pixel) in line
            .iter()
            .enumerate()
            .filter(|(_, pixel)| **pixel != BLACK)
        {
            seen.push((x / 6, pixel[0]));
        }
    }
    assert_eq!(seen.len(), 32, "{seen:?}");
    seen.sort_unstable();
    for (point, four) in seen.chunks(4).enumerate() {
        let alpha = alphas[point];
        for (_, level) in four {
            assert!(level.abs_diff(alpha) <= 1, "{level} for {alpha}");
        }
    }
    let mut pixels = 0;
    for _ in 0..60 {
        scene.begin(&camera()).expect("the rooms are large enough");
        let (a, b) = (triangle(&mut rng, [255; 3]), triangle(&mut rng, [255; 3]));
        let alphas: Vec<u8> = (0..6).map(|_| rng.below(256) as u8).collect();
        let faces = [a, b].map(|corners| {
            corners.map(|c| ScreenCorner {
                vertex: ScreenVertex {
                    x: c.at.0 as i16,
                    y: c.at.1 as i16,
                    depth: 1 << 30,
                    colour: c.colour,
                },
                ..ScreenCorner::default()
            })
        });
        let call = Draw {
            cull: Cull::None,
            alphas: &alphas,
            blend: Some(Blend::add(255)),
            ..Draw::new(NO_MESH)
        };
        scene.draw_screen(&call, &faces).expect("there is room");
        let lines = frame(&scene, 8, true, BLACK);
        let mut want = vec![[0.0f64; WIDTH as usize]; 24];
        for (corners, alphas) in [a, b].iter().zip(alphas.chunks(3)) {
            each_place(corners, |x, y| {
                let (part, _) = weights(corners.map(|c| c.at), x as i32, y as i32);
                want[y][x] += (0..3).map(|k| part[k] * f64::from(alphas[k])).sum::<f64>();
                pixels += 1;
            });
        }
        for (got, want) in lines.iter().flatten().zip(want.iter().flatten()) {
            let want = want.min(255.0);
            assert!(
                (f64::from(got[0]) - want).abs() <= 3.0,
                "{got:?} for {want}"
            );
        }
    }
    assert!(pixels > 5_000, "{pixels}");
}

/// Masks that do not fit, alphas that are too few, and memory that is full. Kills: a mask of other sides, bits or levels that
/// is taken; a call with too many alphas, or whose alphas take room though nobody asks; a mesh whose alphas find no room.
#[test]
fn what_does_not_fit_is_refused() {
    const WORDS: [u16; 64] = [0; 64];
    static LEVEL: [Texture<'static>; 1] = [match Texture::words(&WORDS, 4, 4) {
        Ok(texture) => texture,
        Err(_) => panic!("4 x 4"),
    }];
    let texture = Texture::words(&WORDS, 8, 8).expect("sides");
    let others = [
        Texture::words(&WORDS, 8, 4),
        Texture::words(&WORDS, 4, 8),
        Texture::index8(&[0; 64], &[0; 256], 8, 8),
        texture.sampled(Sampling::NEAREST, &LEVEL),
    ];
    for other in others {
        let other = other.expect("a texture");
        assert_eq!(texture.masked(&other).err(), Some(TextureError::Mask));
        assert_eq!(other.masked(&texture).err(), Some(TextureError::Mask));
    }
    let masked = texture.masked(&texture).expect("itself");
    let again = masked.sampled(Sampling::NEAREST, &LEVEL).err();
    assert_eq!(again, Some(TextureError::Mask));
    assert!(masked.sampled(Sampling::LINEAR, &[]).is_ok());
    let told = TextureError::Mask.to_string();
    assert_eq!(told, "texture: its mask is not of the same form");

    let screen = Screen::new(16, 16).expect("a screen");
    let length = Err(DrawError::Mesh(MeshError::AttributeLength));
    let positions: [[i16; 3]; 3] = [
        [-900, -900, -16_384],
        [900, -900, -16_384],
        [0, 900, -16_384],
    ];
    let mesh = Mesh {
        positions: &positions,
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[[0, 1, 2]]),
    };
    let call = Draw {
        blend: Some(Blend::ALPHA),
        cull: Cull::None,
        ..Draw::new(mesh)
    };
    for alphas in [&[1u8, 2][..], &[1, 2, 3, 4]] {
        let call = Draw { alphas, ..call };
        let mut rooms = SceneRooms::new(9, 9, 16, 9);
        let mut scene = rooms.scene::<Gouraud<Rgb565>>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        assert_eq!(scene.draw(&call), length);
        assert_eq!(scene.draw_points(&call, 3), length);
        let faces = [[ScreenCorner::default(); 3]; 2];
        assert_eq!(scene.draw_screen(&call, &faces), length);
        assert_eq!((scene.objects(), scene.vertices()), (0, 0));
    }
    // Three vertices and a record; one less has no room.
    for (room, want) in [(4, true), (3, false)] {
        let mut rooms = SceneRooms::new(room, 9, 16, 9);
        let mut scene = rooms.scene::<Gouraud<Rgb565>>(screen);
        scene.begin(&camera()).expect("the rooms are large enough");
        let full = DrawError::Full {
            memory: Full::Vertices,
            triangles: 1,
            first_face: 0,
        };
        let drawn = scene.draw(&Draw {
            alphas: &[9; 3],
            ..call
        });
        assert_eq!(drawn, if want { Ok(()) } else { Err(full) });
        assert_eq!(scene.objects(), usize::from(want));
        // What nobody asks for takes no room.
        scene.begin(&camera()).expect("the rooms are large enough");
        let opaque = Draw {
            alphas: &[9; 3],
            blend: None,
            ..call
        };
        scene.draw(&opaque).expect("there is room");
        assert_eq!(scene.vertices(), 3);
    }
}

/// A look lit at pixels has alphas of vertices too. Kills: an alpha one column off.
#[test]
fn light_at_pixels_has_alpha_at_vertices() {
    let mut rng = Rng::new(90);
    let light = even_light();
    let mut pixels = 0;
    for _ in 0..60 {
        let corners = triangle(&mut rng, [255; 3]);
        let alphas = leak((0..3).map(|_| rng.below(256) as u8).collect());
        let lines = picture::<Phong<Rgb888>>(corners, BLACK, |draw| {
            (draw.mesh.colours, draw.alphas, draw.lamps) = (&[], alphas, light);
            draw.blend = Some(Blend::ALPHA);
        });
        each_place(&corners, |x, y| {
            let (part, _) = weights(corners.map(|c| c.at), x as i32, y as i32);
            let want = (0..3).map(|k| part[k] * f64::from(alphas[k])).sum::<f64>();
            let got = f64::from(lines[y][x][0]);
            assert!((got - want).abs() <= 2.0, "{got} for {want} at {x}, {y}");
            pixels += 1;
        });
    }
    assert!(pixels > 4_000, "{pixels}");
}
