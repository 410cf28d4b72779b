//! Textures in pictures that are known without drawing them.

use super::*;

/// A picture-filling square, its lower edge at w = `low` and its upper one at w = `high`, with a texture once over it.
fn textured_square(low: f64, high: f64) -> Model {
    let corner = |x: f64, y: f64, w: f64| ([x * w, y * w, 1.0 - w], WHITE);
    let [a, b, c, d] = [
        corner(-1.0, -1.0, low),
        corner(1.0, -1.0, low),
        corner(1.0, 1.0, high),
        corner(-1.0, 1.0, high),
    ];
    let mut made = model(&[[a, b, c], [a, c, d]]);
    let places = [
        [0.0, 0.0],
        [1.0, 0.0],
        [1.0, 1.0],
        [0.0, 0.0],
        [1.0, 1.0],
        [0.0, 1.0],
    ];
    for (vertex, uv) in made.vertices.iter_mut().zip(places) {
        vertex.uv = uv;
    }
    made
}

fn with_map(model: &Model, map: TextureMap, view: &View) -> Reference {
    let of_triangle = vec![Some(0); model.triangles.len()];
    let textures = Textures {
        maps: &[map],
        of_triangle: &of_triangle,
    };
    render_textured(model, textures, view, Options::default()).unwrap()
}

#[test]
fn a_square_on_seen_straight_shows_its_texels_as_they_are() {
    let map = TextureMap::made(16, 16, |x, y| [f64::from(x), f64::from(y), 200.0]);
    let picture = with_map(&textured_square(1.0, 1.0), map, &square_view(16));
    for y in 0..16 {
        for x in 0..16 {
            let at = y * 16 + x;
            let place = [x as f64 + 0.5, y as f64 + 0.5];
            assert!((picture.place[at][0] - place[0]).abs() < 1e-9);
            assert!((picture.place[at][1] - place[1]).abs() < 1e-9);
            let want = [x as f64, y as f64, 200.0];
            assert!((0..3).all(|i| (picture.colour[at][i] - want[i]).abs() < 1e-9));
        }
    }
}

#[test]
fn places_are_those_of_the_ray_through_the_pixel() {
    // From the eye at (0, 0, 1) the ray through y of the screen, -1 to 1, meets the square's plane at
    // y w = -low + t (high + low), w = low + t (high - low), t from the lower edge.
    let (low, high) = (1.0, 10.0);
    let side = 128.0;
    let map = TextureMap::made(128, 128, |_, _| [255.0; 3]);
    let picture = with_map(&textured_square(low, high), map, &square_view(64));
    for row in 0..64 {
        for column in 0..64 {
            let y = 1.0 - (row as f64 + 0.5) / 32.0;
            let t = low * (1.0 + y) / (low + high - y * (high - low));
            let w = low + t * (high - low);
            let place = picture.place[row * 64 + column];
            assert!((picture.inverse_w[row * 64 + column] * w - 1.0).abs() < 1e-9);
            assert!((place[1] - (1.0 - t) * side).abs() < 1e-6, "{place:?} {t}");
        }
    }
}

#[test]
fn sides_repeat_turn_and_end() {
    let row = |sides| TextureMap {
        sides,
        ..TextureMap::made(4, 1, |x, _| [f64::from(x); 3])
    };
    let read = |sides| -> Vec<f64> {
        let map = row(sides);
        (-5..9)
            .map(|x| map.at([f64::from(x) + 0.25, 7.5])[0])
            .collect()
    };
    let of = |text: &str| -> Vec<f64> { text.bytes().map(|b| f64::from(b - b'0')).collect() };
    assert_eq!(read(Sides::Wrap), of("30123012301230"));
    assert_eq!(read(Sides::Mirror), of("33210012332100"));
    assert_eq!(read(Sides::Clamp), of("00000012333333"));
}

#[test]
fn bilinear_is_a_texel_in_its_middle_and_the_mean_on_its_corner() {
    let map = TextureMap {
        filter: Filter::Bilinear,
        ..TextureMap::made(4, 4, |x, y| [f64::from(10 * x + y), f64::from(x * x), 0.0])
    };
    assert_eq!(map.at([2.5, 1.5]), [21.0, 4.0, 0.0]);
    assert_eq!(
        map.at([2.0, 2.0]),
        [(11.0 + 12.0 + 21.0 + 22.0) / 4.0, 2.5, 0.0]
    );
    assert_eq!(
        map.at([1.75, 1.5]),
        [0.75 * 11.0 + 0.25 * 21.0, 0.75 + 0.25 * 4.0, 0.0]
    );
    // Beyond the left side the texture is there again.
    assert_eq!(map.at([0.0, 0.5]), [15.0, 4.5, 0.0]);
}

#[test]
fn light_multiplies_texels_and_untextured_triangles_stay() {
    let mut lit = textured_square(1.0, 1.0);
    for vertex in &mut lit.vertices {
        vertex.colour = [0.5, 1.0, 0.0];
    }
    let map = TextureMap::made(1, 1, |_, _| [100.0; 3]);
    let textures = Textures {
        maps: &[map],
        of_triangle: &[Some(0), None],
    };
    let picture = render_textured(&lit, textures, &square_view(8), Options::default()).unwrap();
    for (i, colour) in picture.colour.iter().enumerate() {
        let want = if picture.object[i] == 0 {
            [50.0, 100.0, 0.0]
        } else {
            [127.5, 255.0, 0.0]
        };
        assert!(
            (0..3).all(|c| (colour[c] - want[c]).abs() < 1e-9),
            "{colour:?}"
        );
    }
}

#[test]
fn a_cut_edge_has_the_place_of_its_place_in_space() {
    // A floor from behind the eye to far away, v along it: v at distance w is known whatever is cut.
    let corner = |x: f64, z: f64| ([x, -1.0, z], WHITE);
    let mut floor = model(&[
        [corner(-50.0, 3.0), corner(50.0, 3.0), corner(50.0, -29.0)],
        [
            corner(-50.0, 3.0),
            corner(50.0, -29.0),
            corner(-50.0, -29.0),
        ],
    ]);
    for vertex in &mut floor.vertices {
        let [x, _, z] = vertex.position;
        vertex.uv = [(x + 50.0) / 100.0, (3.0 - z) / 32.0];
    }
    let map = TextureMap::made(256, 256, |_, _| [255.0; 3]);
    let view = square_view(99);
    let picture = with_map(&floor, map, &view);
    let mut seen = 0;
    for row in 55..99 {
        for column in 0..99 {
            let at = row * 99 + column;
            if picture.object[at] == NO_OBJECT {
                continue;
            }
            seen += 1;
            let w = 49.5 / (row as f64 + 0.5 - 49.5);
            let v = (3.0 - (1.0 - w)) / 32.0;
            let x = (column as f64 + 0.5 - 49.5) / 49.5 * w;
            assert!((picture.place[at][1] - (1.0 - v) * 256.0).abs() < 1e-6);
            assert!((picture.place[at][0] - (x + 50.0) / 100.0 * 256.0).abs() < 1e-6);
        }
    }
    assert!(seen > 4000, "{seen}");
}
