//! What lists draw on the screen itself: vertices that were set up beforehand, points, overlays (H11, K14); against the
//! rules that define them, and against the same calls.

use crate::common::Rng;
use crate::hot::NO_MESH;
use crate::hot::shine::even_light;
use crate::listing::{Cloud, PLENTY, in_blocks, some_format, unrolled};
use crate::played::lists::after_a_triangle;
use crate::played::{HEIGHT, Kept, WIDTH, drawn, played};
use host_tests::lists::writer::ListWriter;
use scanbeam::input::PlayerSettings;
use scanbeam::list::{
    Flow, Halt, Header, Id, Material, Matrix, Overlay, Palette, Reason, State, TexelForm,
};
use scanbeam::list::{Lent, OverlaySlot};
use scanbeam::look::{Gouraud, Phong};
use scanbeam::mesh::ScreenVertex;
use scanbeam::overlay::ListOverlays;
use scanbeam::pixel::{PixelFormat, Rgb565Be};
use scanbeam::scene::{Draw, DrawError, ScreenCorner, Shading};
use scanbeam::{Affine, Cull, Faces, Light, Mesh};

type Smooth = Gouraud<Rgb565Be>;

/// Vertices on and around the picture.
fn on_screen(rng: &mut Rng, count: usize) -> Vec<ScreenVertex> {
    (0..count)
        .map(|_| {
            let far = rng.pick(&[0, 0, 200, 15_000]);
            ScreenVertex {
                x: rng.within(-far, i32::from(WIDTH) * 8 + far) as i16,
                y: rng.within(-far, i32::from(HEIGHT) * 8 + far) as i16,
                depth: rng.below(1 << 16) << 15 | rng.below(1 << 15),
                colour: [0; 3].map(|_: u8| rng.below(256) as u8),
            }
        })
        .collect()
}

/// A list that is played, with the shading of the settings.
fn listed(list: &[u32], shading: Shading, vertices: usize) -> Vec<u16> {
    let list: &'static [u32] = Vec::leak(list.to_vec());
    let kept = Box::leak(Box::new(Kept::new(vertices, vertices)));
    let settings = PlayerSettings {
        draw: Draw {
            shading,
            ..Draw::new(NO_MESH)
        },
        ..PlayerSettings::default()
    };
    let mut player = kept.player::<Smooth>(settings);
    drawn::<Smooth>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
    })
}

/// What a strip keeps at its vertices, and what its header says of that.
fn long_words(v: &ScreenVertex, header: Header) -> Vec<u32> {
    let [r, g, b] = v.colour;
    let mut words = vec![u32::from(v.x as u16) | u32::from(v.y as u16) << 16];
    words.extend(header.prsp.then_some(v.depth));
    words.extend(header.shade.then_some(u32::from_le_bytes([r, g, b, 9])));
    words.extend(header.text.then_some(0x1234_5678));
    words
}

#[test]
fn long_vertices_are_triangles_of_calls() {
    for seed in 0..80 {
        let mut rng = Rng::new(seed);
        let vertices = on_screen(&mut rng, 50);
        let colour = [10, 200, 90];
        let two_sided = rng.below(2) == 1;
        let shading = rng.pick(&[Shading::Smooth, Shading::Flat]);
        let (shade, prsp, text) = (rng.below(3) > 0, rng.below(3) > 0, rng.below(3) == 0);
        let mut memory = vec![0; 8192];
        let mut writer = ListWriter::new(&mut memory);
        let material = Material {
            diffuse: colour,
            two_sided,
            ..Material::default()
        };
        writer.state(&State::Material(material)).unwrap();
        let mut faces = Vec::new();
        for _ in 0..1 + rng.below(4) {
            let fan = rng.below(2) == 1;
            let order: Vec<u16> = (0..rng.below(90)).map(|_| rng.below(50) as u16).collect();
            faces.extend(unrolled(&order, fan));
            in_blocks(&mut rng, &order, |part, new| {
                let header = Header {
                    shade,
                    prsp,
                    text,
                    new,
                    rm: fan,
                    ..Header::of(Id::Long, part.len() as u16)
                };
                let words: Vec<u32> = part
                    .iter()
                    .flat_map(|i| long_words(&vertices[usize::from(*i)], header))
                    .collect();
                writer.vertices(header, &words).unwrap();
            });
        }
        writer.flow(Flow::End).unwrap();
        let corner = |i: u16| {
            let v = vertices[usize::from(i)];
            ScreenCorner {
                vertex: ScreenVertex {
                    depth: if prsp { v.depth } else { 1 << 31 },
                    colour: if shade { v.colour } else { colour },
                    ..v
                },
                texel: [0; 2],
            }
        };
        let triangles: Vec<_> = faces.iter().map(|face| face.map(corner)).collect();
        let call = Draw {
            cull: if two_sided { Cull::None } else { Cull::Back },
            shading,
            ..Draw::new(NO_MESH)
        };
        let want = drawn::<Smooth>(|scene| scene.draw_screen(&call, &triangles).unwrap());
        assert!(listed(writer.words(), shading, 8) == want, "seed {seed}");
    }
}

/// The pixels of a triangle by K4: the edges whose lines hold the pixel's centre, in whole numbers.
fn covers(p: [(i64, i64); 3], (x, y): (i64, i64)) -> bool {
    let (cx, cy) = (8 * x + 4, 8 * y + 4);
    let mut sides = Vec::new();
    for k in 0..3 {
        let (a, b) = (p[k], p[(k + 1) % 3]);
        let (top, bottom) = if a.1 < b.1 { (a, b) } else { (b, a) };
        if top.1 < cy && cy <= bottom.1 {
            // Where the edge is, less the centre, over the edge's height.
            let at = (top.0 - cx) * (bottom.1 - top.1) + (bottom.0 - top.0) * (cy - top.1);
            sides.push(at);
        }
    }
    // One side is left of the centre, the other at or right of it.
    sides.len() == 2 && sides.iter().any(|s| *s < 0) && sides.iter().any(|s| *s >= 0)
}

#[test]
fn triangles_on_the_screen_cover_what_the_rule_says_and_the_nearest_is_seen() {
    let white = Rgb565Be::from_rgb8([255; 3]);
    let mut pixels = 0;
    for seed in 0..200 {
        let mut rng = Rng::new(seed);
        let vertices: Vec<ScreenVertex> = on_screen(&mut rng, 3)
            .into_iter()
            .map(|v| ScreenVertex {
                colour: [255; 3],
                ..v
            })
            .collect();
        let corner = |depth: u32, colour: [u8; 3]| {
            [0, 1, 2].map(|i: usize| ScreenCorner {
                vertex: ScreenVertex {
                    depth,
                    colour,
                    ..vertices[i]
                },
                texel: [0; 2],
            })
        };
        // The farther one is drawn last.
        let both = [corner(1 << 30, [255; 3]), corner(1 << 29, [255, 0, 0])];
        let call = Draw {
            cull: Cull::None,
            ..Draw::new(NO_MESH)
        };
        let got = drawn::<Smooth>(|scene| scene.draw_screen(&call, &both).unwrap());
        let p = [0, 1, 2].map(|k: usize| (i64::from(vertices[k].x), i64::from(vertices[k].y)));
        for (n, pixel) in (0..).zip(&got) {
            let (x, y) = (n % i64::from(WIDTH), n / i64::from(WIDTH));
            let is = *pixel == white;
            assert_eq!(is, covers(p, (x, y)), "seed {seed}, pixel {x}, {y}");
            assert!(is || *pixel == 0, "seed {seed}, pixel {x}, {y}");
            pixels += u32::from(is);
        }
    }
    assert!(pixels > 50_000, "{pixels}");
    // A mesh at 1.05 times the near plane's distance hides what is a hundredth farther on the screen, and the other way.
    let three = [(0, 0), (0, 576), (768, 0)];
    let part = |of: f64| ((1u64 << 31) as f64 / 1.05 * of) as u32;
    let mut seen = Vec::new();
    for depth in [part(0.99), part(1.01)] {
        let got = drawn::<Smooth>(|scene| {
            let ahead = [-0.3f32, -0.5, -4.0].map(|c| c / 16.343_195_f32.sqrt());
            let at = [0, 1, 2].map(|i| [0.3, 0.5, 4.0][i] + 0.105 * ahead[i]);
            let call = Draw {
                model: Affine::placed(0.05, at).unwrap(),
                cull: Cull::None,
                colour: [255; 3],
                ..Draw::new(Mesh {
                    positions: &[[-16_384, -16_384, 0], [16_384, -16_384, 0], [0, 16_384, 0]],
                    faces: Faces::Triangles(&[[0, 1, 2]]),
                    ..NO_MESH
                })
            };
            scene.draw(&call).unwrap();
            let red = three.map(|(x, y)| ScreenCorner {
                vertex: ScreenVertex {
                    x,
                    y,
                    depth,
                    colour: [255, 0, 0],
                },
                texel: [0; 2],
            });
            scene
                .draw_screen(
                    &Draw {
                        mesh: NO_MESH,
                        ..Draw::new(NO_MESH)
                    },
                    &[red],
                )
                .unwrap();
        });
        seen.push(got.iter().filter(|&&word| word == white).count());
    }
    assert!(seen[0] > seen[1] + 150, "{seen:?}");
}

#[test]
fn what_cannot_be_drawn_on_the_screen_is_said() {
    let corners = [[ScreenCorner::default(); 3]];
    drawn::<Phong<Rgb565Be>>(|scene| {
        assert_eq!(
            scene.draw_screen(
                &Draw {
                    lamps: even_light(),
                    ..Draw::new(NO_MESH)
                },
                &corners
            ),
            Err(DrawError::Light)
        );
    });
    drawn::<Smooth>(|scene| {
        let large = [(0, 0), (0, 400), (400, 0)].map(|(x, y)| ScreenCorner {
            vertex: ScreenVertex {
                x,
                y,
                ..ScreenVertex::default()
            },
            texel: [0; 2],
        });
        let many = vec![large; 20_000];
        let done = scene.draw_screen(&Draw::new(NO_MESH), &many);
        assert!(matches!(done, Err(DrawError::Full { triangles, .. }) if triangles > 10_000));
        assert!(scene.objects() > 6_000);
    });
}

/// Kills: triangles on the screen that are counted as culled where they are filed, and not where they have no line.
#[test]
fn triangles_of_the_screen_without_lines_are_counted() {
    let corner = |(x, y)| ScreenCorner {
        vertex: ScreenVertex {
            x,
            y,
            ..ScreenVertex::default()
        },
        texel: [0; 2],
    };
    let seen = [(0, 0), (0, 400), (400, 0)].map(corner);
    // Between the middles of two lines.
    let thin = [(0, 5), (0, 6), (400, 5)].map(corner);
    for (triangles, culled) in [
        (&[seen, seen][..], 0),
        (&[thin, seen, thin], 2),
        (&[thin], 1),
    ] {
        drawn::<Smooth>(|scene| {
            scene.draw_screen(&Draw::new(NO_MESH), triangles).unwrap();
            assert_eq!(scene.assembled().culled, culled);
            assert_eq!(scene.objects() + culled as usize, triangles.len());
        });
    }
}

#[test]
fn points_of_lists_are_those_of_calls() {
    for seed in 0..60 {
        let mut rng = Rng::new(seed);
        let (format, place, normal) = some_format(&mut rng);
        let cloud = Cloud::random(&mut rng, 60, place, normal);
        let light = Light::new([0.3, 0.5, 0.9], 0.1).filter(|_| seed % 2 == 0);
        let sizes = [rng.pick(&[1, 1, 2, 3, 8, 255]), rng.pick(&[1, 2, 5])];
        let mut memory = vec![0; 4096];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Format(format)).unwrap();
        let turned = Affine::rotation_y(0.4);
        writer
            .state(&State::Matrix(Matrix::try_from(&turned).unwrap()))
            .unwrap();
        if let Some(light) = light {
            let light = light.into();
            writer.state(&State::Light { number: 0, light }).unwrap();
        }
        let order: Vec<u16> = (0..60).collect();
        for (size, half) in sizes.into_iter().zip(order.chunks(30)) {
            writer.state(&State::PointSize(size)).unwrap();
            for part in half.chunks(1 + rng.below(60) as usize) {
                let header = Header {
                    shade: true,
                    ..Header::of(Id::Points, part.len() as u16)
                };
                let words = cloud.vertices(&format, header, part);
                writer.vertices(header, &words).unwrap();
            }
        }
        writer.flow(Flow::End).unwrap();
        let vertices = cloud.plain(true, &format);
        let want = drawn::<Smooth>(|scene| {
            for (size, half) in sizes.into_iter().zip([0..30, 30..60]) {
                let part = |len: usize| if len == 0 { 0..0 } else { half.clone() };
                let mesh = Mesh {
                    positions: &vertices.positions[half.clone()],
                    normals: &vertices.normals[part(vertices.normals.len())],
                    colours: &vertices.colours[part(vertices.colours.len())],
                    faces: Faces::Triangles(&[]),
                };
                let call = Draw {
                    model: turned,
                    light,
                    ..Draw::new(mesh)
                };
                scene.draw_points(&call, size).unwrap();
            }
        });
        assert!(want.iter().any(|&word| word != 0), "seed {seed}");
        for room in [4, 9, 1000] {
            let got = listed(writer.words(), Shading::Smooth, room);
            assert!(got == want, "seed {seed}, room {room}");
        }
    }
}

/// A point is the square of whole pixels around the place that `f64` projects it to.
#[test]
fn points_are_squares_of_pixels_where_they_project_to() {
    let white = Rgb565Be::from_rgb8([255; 3]);
    let (eye, focal) = ([0.3, 0.5, 4.0f64], 90.0);
    let minus = |a: [f64; 3], b: [f64; 3]| [0, 1, 2].map(|i| a[i] - b[i]);
    let dot = |a: [f64; 3], b: [f64; 3]| (0..3).map(|i| a[i] * b[i]).sum::<f64>();
    let unit = |a: [f64; 3]| a.map(|c| c / dot(a, a).sqrt());
    let cross = |a: [f64; 3], b: [f64; 3]| {
        [0, 1, 2].map(|i| a[(i + 1) % 3] * b[(i + 2) % 3] - a[(i + 2) % 3] * b[(i + 1) % 3])
    };
    let ahead = unit(minus([0.0; 3], eye));
    let right = unit(cross(ahead, [0.0, 1.0, 0.0]));
    let up = cross(right, ahead);
    let (mut sure, mut shown) = (0, 0);
    for seed in 0..400 {
        let mut rng = Rng::new(seed);
        let size = 1 + rng.below(9) as u8;
        let point = [0; 3].map(|_: i16| rng.within(-16_384, 16_384) as i16);
        let p = minus(point.map(|c| f64::from(c) / 16_384.0), eye);
        let z = dot(p, ahead);
        let middle = [f64::from(WIDTH) / 2.0, f64::from(HEIGHT) / 2.0];
        let at = [
            middle[0] + focal * dot(p, right) / z,
            middle[1] - focal * dot(p, up) / z,
        ];
        // The first pixel of the square whose middle is nearest; not where it is a close call.
        let first = at.map(|c| c - f64::from(size - 1) / 2.0);
        if first.iter().any(|c| (c - c.round()).abs() < 0.13) {
            continue;
        }
        sure += 1;
        let first = first.map(|c| c.floor() as i64);
        let mesh = Mesh {
            positions: &[point],
            ..NO_MESH
        };
        let got = drawn::<Smooth>(|scene| {
            scene.draw_points(&Draw::new(mesh), size).unwrap();
            // One triangle covers a pixel, two a square.
            let triangles = if size == 1 { 1 } else { 2 };
            assert_eq!(scene.assembled().triangles, triangles);
        });
        for (n, pixel) in (0..).zip(&got) {
            let at = [n % i64::from(WIDTH), n / i64::from(WIDTH)];
            let within = |k: usize| (first[k]..first[k] + i64::from(size)).contains(&at[k]);
            let is = within(0) && within(1);
            assert_eq!(*pixel == white, is, "seed {seed}, size {size}, {at:?}");
            shown += u32::from(is);
        }
    }
    assert!(sure > 150 && shown > 1000, "{sure} points, {shown} pixels");
}

/// An overlay's block with its pixels.
fn overlay(writer: &mut ListWriter<'_>, overlay: Overlay, words: &[u32]) {
    writer.bulk(&State::Overlay(overlay), words).unwrap();
}

#[test]
fn overlays_of_lists_are_painted_until_they_were_shown() {
    let patch = |left: u16, form: TexelForm, additive: bool| Overlay {
        left,
        top: 3,
        width: 2,
        height: 1,
        form,
        additive,
        palette: 7,
        at: 0,
    };
    let mut memory = vec![0; 512];
    let mut writer = ListWriter::new(&mut memory);
    let palette = Palette {
        number: 7,
        count: 2,
        at: 0,
    };
    writer
        .bulk(&State::Palette(palette), &[0xFF00_00FF, 0xFF00_FF00])
        .unwrap();
    overlay(&mut writer, patch(5, TexelForm::Index1, false), &[0b10]);
    overlay(
        &mut writer,
        patch(9, TexelForm::Rgb565, true),
        &[0x0000_001F],
    );
    writer.flow(Flow::Sync).unwrap();
    overlay(
        &mut writer,
        patch(20, TexelForm::Rgb565, false),
        &[0xFFFF_FFFF],
    );
    writer.flow(Flow::End).unwrap();
    let list: &'static [u32] = Vec::leak(writer.words().to_vec());
    let slots: &'static [OverlaySlot] = Vec::leak((0..2).map(|_| OverlaySlot::new()).collect());
    let kept = Box::leak(Box::new(Kept::new(8, 8)));
    let mut player = kept.player_over::<Smooth>(PlayerSettings::default(), slots);
    let painted = || {
        let mut row = vec![Rgb565Be::from_rgb8([0, 0, 8]); WIDTH.into()];
        let overlays = ListOverlays { words: list, slots };
        overlays.paint::<Rgb565Be>(3, &mut row);
        let mut other = row.clone();
        overlays.paint::<Rgb565Be>(4, &mut other);
        assert_eq!(row, other, "another line");
        row.into_iter().map(Rgb565Be::to_rgb8).collect::<Vec<_>>()
    };
    drawn::<Smooth>(|scene| {
        player.start(0);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::Sync));
        let row = painted();
        assert_eq!(row[5..7], [[255, 0, 0], [0, 255, 0]]);
        // Blue is full, and one step is there already.
        assert_eq!(row[9..11], [[0, 0, 255], [0, 0, 8]]);
        assert_eq!(row[20], [0, 0, 8]);
        assert_eq!(played(&mut player, list, scene, PLENTY), Ok(Halt::End));
        let row = painted();
        assert_eq!(row[5..11], [[0, 0, 8]; 6]);
        assert_eq!(row[20..22], [[255; 3]; 2]);
    });
}

#[test]
fn overlays_without_room_or_palette_are_refused() {
    let one = |form| Overlay {
        left: 0,
        top: 0,
        width: 1,
        height: 1,
        form,
        additive: false,
        palette: 3,
        at: 0,
    };
    for (form, count, slots, reason) in [
        (TexelForm::Rgb565, 3, 2, Reason::Lent(Lent::Overlays)),
        (TexelForm::Index1, 1, 2, Reason::NoPalette(3)),
    ] {
        let (list, _) = after_a_triangle(|writer| {
            (0..count).for_each(|_| overlay(writer, one(form), &[0]));
            0
        });
        let list: &'static [u32] = Vec::leak(list);
        let slots: &'static [OverlaySlot] =
            Vec::leak((0..slots).map(|_| OverlaySlot::new()).collect());
        let kept = Box::leak(Box::new(Kept::new(8, 8)));
        let mut player = kept.player_over::<Smooth>(PlayerSettings::default(), slots);
        drawn::<Smooth>(|scene| {
            player.start(0);
            let error = played(&mut player, list, scene, PLENTY).unwrap_err();
            assert_eq!(error.reason, reason);
            assert_eq!(scene.objects(), 0);
        });
    }
}
