//! Pictures that are known without drawing them.

use host_support::image_out::Frame;
use host_support::model::{Model, ModelVertex};
use host_support::reference::*;

mod texels;

/// A model of triangles with one colour per corner.
fn model(triangles: &[[([f64; 3], [f64; 3]); 3]]) -> Model {
    let mut model = Model::default();
    for triangle in triangles {
        let first = model.vertices.len() as u32;
        for &(position, colour) in triangle {
            model.vertices.push(ModelVertex {
                position,
                normal: [0.0, 0.0, 1.0],
                colour,
                uv: [0.0; 2],
            });
        }
        model.triangles.push([first, first + 1, first + 2]);
        model.triangle_materials.push(None);
    }
    model
}

const WHITE: [f64; 3] = [1.0; 3];
const RED: [f64; 3] = [1.0, 0.0, 0.0];

fn plain(corners: [[f64; 3]; 3], colour: [f64; 3]) -> [([f64; 3], [f64; 3]); 3] {
    corners.map(|corner| (corner, colour))
}

/// At distance 1 the plane z = 0 fills the picture with one unit of the world per pixel half: x and y from -1 to 1.
fn square_view(side: u32) -> View {
    View {
        width: side,
        height: side,
        eye: [0.0, 0.0, 1.0],
        fov: 90.0,
        ..View::default()
    }
}

fn covered(reference: &Reference) -> usize {
    reference
        .object
        .iter()
        .filter(|&&object| object != NO_OBJECT)
        .count()
}

fn rounded(reference: &Reference) -> Frame {
    let rgb = reference
        .colour
        .iter()
        .flatten()
        .map(|level| level.round() as u8);
    Frame::new(reference.width, reference.height, rgb.collect()).unwrap()
}

#[test]
fn an_empty_model_draws_the_background() {
    let view = View {
        background: [1, 2, 3],
        ..square_view(5)
    };
    let picture = render(&Model::default(), &view).unwrap();
    assert!(
        picture
            .colour
            .iter()
            .all(|&colour| colour == [1.0, 2.0, 3.0])
    );
    assert!(!picture.near_edge.contains(&true));
    assert_eq!(covered(&picture), 0);
}

#[test]
fn a_triangle_covers_the_known_pixels() {
    // The lower left half of the picture: the diagonal goes through pixel centres and is neither top nor left.
    let triangle = plain(
        [[-1.0, 1.0, 0.0], [-1.0, -1.0, 0.0], [1.0, -1.0, 0.0]],
        WHITE,
    );
    let picture = render(&model(&[triangle]), &square_view(8)).unwrap();
    for y in 0..8 {
        for x in 0..8 {
            let index = y * 8 + x;
            // Rounding of the projection may put the corners to either side, so the diagonal itself is not asked.
            if x != y {
                assert_eq!(picture.object[index] == 0, x < y, "{x} {y}");
            }
            if x.abs_diff(y) <= 1 {
                assert!(picture.near_edge[index]);
            }
        }
    }
    // Inside, away from the picture's sides, where the triangle's other edges lie, nothing is marked.
    assert!(!picture.near_edge[5 * 8 + 2]);
    assert!((picture.inverse_w[6 * 8 + 2] - 1.0).abs() < 1e-12);
}

#[test]
fn y_is_up_and_x_is_right() {
    let high = plain([[-0.5, 0.2, 0.0], [0.5, 0.2, 0.0], [0.0, 0.8, 0.0]], WHITE);
    let right = plain([[0.6, -0.5, 0.0], [0.9, -0.5, 0.0], [0.9, 0.1, 0.0]], RED);
    let picture = render(&model(&[high, right]), &square_view(64)).unwrap();
    assert_eq!(picture.object[20 * 64 + 32], 0);
    assert_eq!(picture.object[44 * 64 + 32], NO_OBJECT);
    assert_eq!(picture.object[42 * 64 + 58], 1);
    // A wide picture shows more at the sides, the same at the top.
    let wide = View {
        width: 128,
        ..square_view(64)
    };
    let picture = render(&model(&[high]), &wide).unwrap();
    assert_eq!(picture.object[20 * 128 + 64], 0);
}

#[test]
fn shared_edges_are_drawn_once_whatever_the_order_of_corners() {
    // A fan of slivers around a point, with snapped corners so that many lie on pixel centres.
    let mut state = 7_u64;
    for _ in 0..200 {
        let mut random = || {
            state = state
                .wrapping_mul(6_364_136_223_846_793_005)
                .wrapping_add(1);
            ((state >> 40) % 65) as f64 / 32.0 - 1.0
        };
        let centre = [random() / 2.0, random() / 2.0, 0.0];
        let corners = [
            [-1.0, -1.0, 0.0],
            [1.0, -1.0, 0.0],
            [1.0, 1.0, 0.0],
            [-1.0, 1.0, 0.0],
        ];
        let options = Options {
            steps_per_pixel: Some(2.0),
        };
        let mut hits = vec![0; 256];
        for k in 0..4 {
            let mut triangle = [centre, corners[k], corners[(k + 1) % 4]];
            triangle.rotate_left(k % 3);
            if k % 2 == 1 {
                triangle.swap(0, 1);
            }
            let one = render_with(&model(&[plain(triangle, WHITE)]), &square_view(16), options);
            for (hits, object) in hits.iter_mut().zip(one.unwrap().object) {
                *hits += usize::from(object != NO_OBJECT);
            }
        }
        assert!(hits.iter().all(|&hits| hits == 1), "{centre:?}: {hits:?}");
    }
}

#[test]
fn colour_is_linear_on_the_screen_and_depth_is_perspective() {
    // A strip that runs away from the eye: halfway on the screen is not halfway in the world.
    let (near, far) = (2.0, 10.0);
    let at = |x: f64, w: f64| [x * w, -0.9 * w, 1.0 - w];
    let strip = [
        (at(-0.5, near), [0.0; 3]),
        (at(0.5, near), [0.0; 3]),
        ([0.0, 0.9 * far, 1.0 - far], WHITE),
    ];
    let picture = render(&model(&[strip]), &square_view(101)).unwrap();
    let middle = 50 * 101 + 50;
    assert_eq!(picture.object[middle], 0);
    for level in picture.colour[middle] {
        assert!((level - 127.5).abs() < 1e-9, "{level}");
    }
    let expected = (1.0 / near + 1.0 / far) / 2.0;
    assert!((picture.inverse_w[middle] - expected).abs() < 1e-12);
}

#[test]
fn what_is_nearer_or_later_at_the_same_depth_wins() {
    let at = |z: f64| [[-1.0, -1.0, z], [1.0, -1.0, z], [0.0, 1.0, z]];
    let (back, front) = (plain(at(-0.5), WHITE), plain(at(0.0), RED));
    let middle = 8 * 16 + 8;
    for order in [[back, front], [front, back]] {
        let picture = render(&model(&order), &square_view(16)).unwrap();
        assert_eq!(picture.colour[middle], [255.0, 0.0, 0.0]);
        assert!(!picture.near_edge[middle]);
    }
    let picture = render(&model(&[front, plain(at(0.0), WHITE)]), &square_view(16)).unwrap();
    assert_eq!(picture.object[middle], 1);
    assert!(
        picture.near_edge[middle],
        "a tie of depths is not to be compared"
    );
}

#[test]
fn near_and_far_cut_what_is_outside() {
    // A floor from behind the eye to beyond far, one unit below.
    let wide = 1000.0;
    let floor = [
        plain(
            [[-wide, -1.0, 50.0], [wide, -1.0, 50.0], [wide, -1.0, -50.0]],
            WHITE,
        ),
        plain(
            [
                [-wide, -1.0, 50.0],
                [wide, -1.0, -50.0],
                [-wide, -1.0, -50.0],
            ],
            WHITE,
        ),
    ];
    let view = View {
        near: 2.0,
        far: 11.0,
        ..square_view(100)
    };
    let picture = render(&model(&floor), &view).unwrap();
    // Distance w is seen at row 50 + 50 / w, so rows from 50 + 50 / 11 to 75.
    for y in 0..100 {
        let seen = (54.6..75.0).contains(&(f64::from(y) + 0.5));
        for x in [0, 37, 50, 99] {
            let index = (y * 100 + x) as usize;
            assert_eq!(picture.object[index] != NO_OBJECT, seen, "{x} {y}");
        }
    }
    let far_away = View {
        far: 0.2,
        ..square_view(9)
    };
    let triangle = plain(
        [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]],
        WHITE,
    );
    assert_eq!(covered(&render(&model(&[triangle]), &far_away).unwrap()), 0);
}

#[test]
fn a_cut_edge_has_the_colour_of_its_place_in_space() {
    // From w = 0.5 (black) to w = 1.5 (white), straight below the eye's axis; cut at w = 1: half white there.
    let triangle = [
        ([-5.0, -0.5, 0.5], [0.0; 3]),
        ([5.0, -0.5, 0.5], [0.0; 3]),
        ([0.0, -0.5, -0.5], WHITE),
    ];
    let view = View {
        near: 1.0,
        ..square_view(1001)
    };
    let picture = render(&model(&[triangle]), &view).unwrap();
    // w = 1 is at half of the lower half: y = 750.75.
    let just_inside = 750 * 1001 + 500;
    assert_eq!(picture.object[just_inside], 0);
    assert!((picture.colour[just_inside][0] - 127.5).abs() < 1.0);
    assert_eq!(picture.object[751 * 1001 + 500], NO_OBJECT);
}

#[test]
fn culling_drops_the_clockwise() {
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let turned = [corners[0], corners[2], corners[1]];
    let view = View {
        cull: Cull::Back,
        ..square_view(16)
    };
    let front = covered(&render(&model(&[plain(corners, WHITE)]), &view).unwrap());
    assert!(front > 100);
    assert_eq!(
        covered(&render(&model(&[plain(turned, WHITE)]), &view).unwrap()),
        0
    );
    let both = View {
        cull: Cull::None,
        ..view
    };
    assert_eq!(
        covered(&render(&model(&[plain(turned, WHITE)]), &both).unwrap()),
        front
    );
}

#[test]
fn light_is_ambient_and_lambert() {
    let corners = [[-1.0, -1.0, 0.0], [1.0, -1.0, 0.0], [0.0, 1.0, 0.0]];
    let mut front = model(&[plain(corners, [1.0, 0.5, 0.0])]);
    let level = |model: &Model, shade: Shade, light: [f64; 3]| {
        let view = View {
            shade,
            light,
            ambient: 0.2,
            ..square_view(16)
        };
        render(model, &view).unwrap().colour[8 * 16 + 8]
    };
    let close = |a: [f64; 3], b: [f64; 3]| (0..3).all(|i| (a[i] - b[i]).abs() < 1e-9);
    let slanted = [3.0, 0.0, 4.0];
    let factor = 0.2 + 0.8 * 0.8;
    let lit = [255.0 * factor, 127.5 * factor, 0.0];
    assert!(close(
        level(&front, Shade::None, slanted),
        [255.0, 127.5, 0.0]
    ));
    assert!(close(level(&front, Shade::Flat, slanted), lit));
    assert!(close(level(&front, Shade::Gouraud, slanted), lit));
    let dark = [51.0, 25.5, 0.0];
    assert!(
        close(level(&front, Shade::Flat, [0.0, 0.0, -1.0]), dark),
        "not turned to the eye"
    );
    assert!(close(level(&front, Shade::Gouraud, [0.0, 0.0, -9.0]), dark));
    // Gouraud uses the given normals, flat does not; a normal that is zero gets ambient light.
    for vertex in &mut front.vertices {
        vertex.normal = [0.0; 3];
    }
    assert!(close(level(&front, Shade::Gouraud, slanted), dark));
    assert!(close(level(&front, Shade::Flat, slanted), lit));
    // Flat has the colour of the first corner everywhere.
    front.vertices[1].colour = WHITE;
    assert!(close(level(&front, Shade::Flat, slanted), lit));
}

#[test]
fn a_thin_object_that_hits_no_centre_still_marks_its_edges() {
    let floor = plain(
        [[-9.0, -9.0, -1.0], [9.0, -9.0, -1.0], [0.0, 9.0, -1.0]],
        WHITE,
    );
    // Between two columns of centres of a 16-pixel picture.
    let sliver = plain(
        [[0.01, -0.5, 0.0], [0.02, -0.5, 0.0], [0.02, 0.5, 0.0]],
        RED,
    );
    let picture = render(&model(&[floor, sliver]), &square_view(16)).unwrap();
    assert!(!picture.object.contains(&1));
    assert!(picture.near_edge[8 * 16 + 7] && picture.near_edge[8 * 16 + 8]);
    assert!(!picture.near_edge[8 * 16 + 5] && !picture.near_edge[8 * 16 + 10]);
    // Behind the floor it marks nothing.
    let hidden = plain(
        [[0.02, -1.0, -2.0], [0.04, -1.0, -2.0], [0.04, 1.0, -2.0]],
        RED,
    );
    let picture = render(&model(&[floor, hidden]), &square_view(16)).unwrap();
    assert!(!picture.near_edge.contains(&true));
}

#[test]
fn hostile_sizes_do_not_panic() {
    let big = 3e38;
    let triangles = [
        plain(
            [[-big, -big, 0.0], [big, -big, 0.5], [0.0, big, -big]],
            WHITE,
        ),
        plain([[big; 3], [-big; 3], [0.0; 3]], WHITE),
        plain([[0.0; 3]; 3], WHITE),
    ];
    for view in [
        square_view(9),
        View {
            near: 1e-300,
            far: 1e300,
            ..square_view(9)
        },
        View {
            fov: 1e-300,
            ..square_view(9)
        },
        View {
            fov: 179.999_999,
            ..square_view(1)
        },
        View {
            eye: [big, 0.0, -big],
            ..square_view(9)
        },
        View {
            shade: Shade::Flat,
            ..square_view(9)
        },
    ] {
        let picture = render(&model(&triangles), &view).unwrap();
        assert!(
            picture
                .colour
                .iter()
                .flatten()
                .all(|level| (0.0..=255.0).contains(level))
        );
    }
}

#[test]
fn comparing_finds_what_was_changed() {
    let triangle = [
        ([-1.0, -1.0, 0.0], [1.0, 0.2, 0.2]),
        ([1.0, -1.0, 0.0], [0.2, 1.0, 0.2]),
        ([0.0, 1.0, 0.0], [0.2, 0.2, 1.0]),
    ];
    let view = square_view(32);
    let reference = render(&model(&[triangle]), &view).unwrap();
    let frame = rounded(&reference);
    let same = compare(&reference, view.background, &frame).unwrap();
    assert!(same.max_error_levels <= 0.5 && same.max_error_near_edges <= 0.5);
    assert!(same.mean_error_levels > 0.0);
    assert_eq!((same.differing_pixels, same.covered_differently), (0, 0));
    assert_eq!(same.compared_pixels + same.excluded_pixels, 32 * 32);
    assert_eq!(same.covered_reference, covered(&reference));

    let change = |x: usize, y: usize, by: u8| {
        let mut rgb = frame.rgb().to_vec();
        rgb[(y * 32 + x) * 3 + 1] = rgb[(y * 32 + x) * 3 + 1].wrapping_add(by);
        let frame = Frame::new(32, 32, rgb).unwrap();
        compare(&reference, view.background, &frame).unwrap()
    };
    let inside = change(16, 20, 5);
    assert_eq!(
        (inside.differing_pixels, inside.first_differing),
        (1, Some((16, 20)))
    );
    assert!((4.5..=5.5).contains(&inside.max_error_levels));
    let outside = change(1, 1, 1);
    assert_eq!(
        (outside.differing_pixels, outside.covered_differently_away),
        (0, 1)
    );
    // At the silhouette a change within what is around is no error, one beyond it is.
    let x = (0..32)
        .find(|x| reference.object[20 * 32 + x] == 0)
        .unwrap();
    let beside = change(x, 20, 100);
    assert_eq!(beside.differing_pixels, 0);
    assert!(beside.max_error_near_edges > 50.0);

    let other = Frame::new(1, 1, vec![0; 3]).unwrap();
    assert_eq!(compare(&reference, [0; 3], &other), Err(SizeMismatch));
}

#[test]
fn rounding_of_corners_stays_within_the_mask() {
    // Random large triangles, drawn exactly and with corners rounded to 13.3 as a stand-in for fixed point.
    let mut state = 99_u64;
    let mut random = || {
        state = state
            .wrapping_mul(6_364_136_223_846_793_005)
            .wrapping_add(1);
        ((state >> 33) as f64) / f64::from(1_u32 << 31) * 2.0 - 1.0
    };
    for _ in 0..50 {
        let triangles: Vec<_> = (0..6)
            .map(|_| {
                let colour = [random().abs(), random().abs(), 1.0];
                let mut corner = || [random() * 1.5, random() * 1.5, random() * 1.5 - 0.5];
                plain([corner(), corner(), corner()], colour)
            })
            .collect();
        let (model, view) = (
            model(&triangles),
            View {
                near: 0.3,
                ..square_view(64)
            },
        );
        let reference = render(&model, &view).unwrap();
        let options = Options {
            steps_per_pixel: Some(8.0),
        };
        let snapped = render_with(&model, &view, options).unwrap();
        let result = compare(&reference, view.background, &rounded(&snapped)).unwrap();
        assert_eq!(result.differing_pixels, 0, "{result:?}");
        assert!(result.compared_pixels > 500, "{result:?}");
    }
}
