//! What `render` makes of materials, highlights, shadows and light at pixels, against the formulae
//! in f64; and that neither cache nor renderers change it.

use crate::common::Rng;
use crate::common::solid::{V, dot, unit};
use host_tests::args::PixelFormatArg;
use host_tests::draw::{
    CrewSettings, Drawn, Effects, FilterArg, Skins, TextureSet, draw, draw_effects,
};
use host_tests::model::{Material, Model, ModelVertex};
use host_tests::reference::{Cull, Shade, View};
use scanbeam::scene::Budget;

fn material(ks: f64, ns: f64, d: f64) -> Material {
    Material {
        ks: [ks; 3],
        ns,
        d,
        ..Material::default()
    }
}

/// A sphere by latitude and longitude.
fn sphere(model: &mut Model, centre: V, radius: f64, steps: u32, (colour, number): (V, u32)) {
    let base = model.vertices.len() as u32;
    for i in 0..=steps {
        for j in 0..2 * steps {
            let angle = |n: u32| std::f64::consts::PI * f64::from(n) / f64::from(steps);
            let (s, c) = angle(i).sin_cos();
            let normal = [s * angle(j).cos(), c, s * angle(j).sin()];
            model.vertices.push(ModelVertex {
                position: [0, 1, 2].map(|k| centre[k] + radius * normal[k]),
                normal,
                colour,
                uv: [0.0; 2],
            });
        }
    }
    for i in 0..steps {
        for j in 0..2 * steps {
            let at = |i: u32, j: u32| base + i * 2 * steps + j % (2 * steps);
            let (a, b, c, d) = (at(i, j), at(i, j + 1), at(i + 1, j), at(i + 1, j + 1));
            for face in [[a, b, c], [b, d, c]] {
                model.triangles.push(face);
                model.triangle_materials.push(Some(number));
            }
        }
    }
}

fn quad(model: &mut Model, corners: [V; 4], normal: V, (colour, number): (V, u32)) {
    let base = model.vertices.len() as u32;
    for position in corners {
        model.vertices.push(ModelVertex {
            position,
            normal,
            colour,
            uv: [0.0; 2],
        });
    }
    for face in [[0, 1, 2], [0, 2, 3]] {
        model.triangles.push(face.map(|i| base + i));
        model.triangle_materials.push(Some(number));
    }
}

fn drawn(
    model: &Model,
    view: &View,
    format: PixelFormatArg,
    crew: CrewSettings,
    effects: Effects,
) -> Drawn {
    let set = TextureSet::load(model, None).unwrap().with_levels(true);
    let skins = Skins {
        set: &set,
        filter: FilterArg::Nearest,
        budget: Budget::BALANCED,
    };
    draw_effects(model, skins, (view, format), crew, effects).unwrap()
}

fn usual(model: &Model, view: &View, effects: Effects) -> Drawn {
    let crew = CrewSettings::default();
    drawn(model, view, PixelFormatArg::Rgb888, crew, effects)
}

/// Also across the border of two tiles, each of which has a camera of its own.
///
/// Kills: lamps of the first tile on all.
#[test]
fn highlights_at_each_pixel_are_those_of_the_formula() {
    for (width, height, least) in [(320, 240, 30_000), (1_100, 160, 10_000)] {
        for (specular, by_material) in [(None, (0.55, 25.0)), (Some((0.4, 9)), (0.9, 2.0))] {
            let count = are_the_formula((width, height), specular, by_material);
            assert!(count > least, "{count}");
        }
    }
}

/// How many channels of a shiny ball were compared.
fn are_the_formula(
    (width, height): (u32, u32),
    specular: Option<(f64, u16)>,
    by_material: (f64, f64),
) -> u32 {
    let view = View {
        width,
        height,
        eye: [0.5, 0.4, 2.6],
        light: [0.5, 0.9, 0.7],
        ambient: 0.15,
        shade: Shade::Gouraud,
        cull: Cull::Back,
        ..View::default()
    };
    let base = [0.4, 0.3, 0.2];
    let (ahead, l) = (unit(view.eye.map(|c| -c)), unit(view.light));
    let right = unit([-ahead[2], 0.0, ahead[0]]);
    let up = [
        right[1] * ahead[2] - right[2] * ahead[1],
        right[2] * ahead[0] - right[0] * ahead[2],
        right[0] * ahead[1] - right[1] * ahead[0],
    ];
    let middle = [width, height].map(|side| f64::from(side) / 2.0);
    let focal = middle[1] / 30f64.to_radians().tan();
    let mut model = Model::default();
    model
        .materials
        .push(material(by_material.0, by_material.1, 1.0));
    sphere(&mut model, [0.0; 3], 1.0, 90, (base, 0));
    let (level, power) = specular.unwrap_or((by_material.0, by_material.1 as u16));
    let effects = Effects {
        specular,
        shadows: false,
        phong: true,
    };
    assert!(effects.are_seen(&model, &view));
    let picture = usual(&model, &view, effects);
    let (mut worst, mut count) = (0.0f64, 0);
    for (x, y) in (0..height).flat_map(|y| (0..width).map(move |x| (x, y))) {
        let (dx, dy) = (
            f64::from(x) + 0.5 - middle[0],
            middle[1] - f64::from(y) - 0.5,
        );
        let way = unit([0, 1, 2].map(|i| ahead[i] * focal + right[i] * dx + up[i] * dy));
        let b = dot(view.eye, way);
        let root = b * b - (dot(view.eye, view.eye) - 1.0);
        if root <= 0.0 {
            continue;
        }
        let n = [0, 1, 2].map(|i| view.eye[i] + way[i] * (-b - root.sqrt()));
        if -dot(n, way) < 0.2 {
            // The rim, where the polygon is not the sphere.
            continue;
        }
        let cosine = dot(n, l).max(0.0);
        let r = [0, 1, 2].map(|i| 2.0 * cosine * n[i] - l[i]);
        let shine = if cosine > 0.0 {
            level * (-dot(r, way)).max(0.0).powi(power.into())
        } else {
            0.0
        };
        let pixel = picture.frame.pixel(x, y).unwrap();
        for i in 0..3 {
            let matt = base[i] * (view.ambient + (1.0 - view.ambient) * cosine);
            let want = 255.0 * (matt + shine).min(1.0);
            // The tool rounds colours to 8 bits first.
            worst = worst.max((f64::from(pixel[i]) - want).abs());
            count += 1;
        }
    }
    println!("{count} channels, at most {worst:.3} levels off");
    assert!(worst <= 2.0, "{worst}");
    count
}

/// Light at pixels falls on one colour a triangle: each has its own, and several are refused.
#[test]
fn light_at_pixels_has_one_colour_a_triangle() {
    let mut model = Model {
        materials: vec![material(0.0, 1.0, 1.0)],
        ..Model::default()
    };
    let at = |x: f64| {
        [
            [x, -2.0, 0.0],
            [x + 2.0, -2.0, 0.0],
            [x + 2.0, 2.0, 0.0],
            [x, 2.0, 0.0],
        ]
    };
    let towards = [0.0, 0.0, 1.0];
    quad(&mut model, at(-2.0), towards, ([0.8, 0.4, 0.2], 0));
    quad(&mut model, at(0.0), towards, ([0.1, 0.6, 0.9], 0));
    let view = View {
        light: towards,
        ambient: 0.5,
        shade: Shade::Gouraud,
        ..View::default()
    };
    let effects = Effects {
        phong: true,
        ..Effects::default()
    };
    let picture = usual(&model, &view, effects).frame;
    for (x, want) in [(100, [204, 102, 51]), (220, [26, 153, 230])] {
        let pixel = picture.pixel(x, 120).unwrap();
        assert!(
            (0..3).all(|i| pixel[i].abs_diff(want[i]) <= 1),
            "{pixel:?} {want:?}"
        );
    }
    model.vertices[5].colour = [0.1, 0.6, 0.8];
    let set = TextureSet::default();
    let skins = Skins {
        set: &set,
        filter: FilterArg::Nearest,
        budget: Budget::BALANCED,
    };
    let format = PixelFormatArg::Rgb888;
    let drawn = draw_effects(
        &model,
        skins,
        (&view, format),
        CrewSettings::default(),
        effects,
    );
    let error = drawn.unwrap_err().to_string();
    assert!(error.contains("triangle 2"), "{error}");
}

#[test]
fn what_is_behind_a_clear_pane_shines_through() {
    let mut rng = Rng::new(4);
    let view = View {
        fov: 90.0,
        ..View::default()
    };
    for _ in 0..6 {
        let d = f64::from(rng.below(256)) / 255.0;
        let front = [0.9, 0.5, 0.1];
        let behind = [0.1, 0.6, 0.8];
        let mut model = Model {
            materials: vec![material(0.0, 0.0, d), material(0.0, 0.0, 1.0)],
            ..Model::default()
        };
        let at = |z: f64| {
            [
                [-3.0, -3.0, z],
                [3.0, -3.0, z],
                [3.0, 3.0, z],
                [-3.0, 3.0, z],
            ]
        };
        // The pane comes first, and is drawn last.
        quad(&mut model, at(1.0), [0.0, 0.0, 1.0], (front, 0));
        quad(&mut model, at(0.0), [0.0, 0.0, 1.0], (behind, 1));
        let effects = Effects::default();
        assert_eq!(effects.are_seen(&model, &view), d < 1.0);
        let picture = usual(&model, &view, effects);
        let pixel = picture.frame.pixel(160, 120).unwrap();
        for ((got, front), behind) in pixel.into_iter().zip(front).zip(behind) {
            let want = 255.0 * (behind + (front - behind) * d);
            let got = f64::from(got);
            assert!((got - want).abs() <= 1.5, "{got} {want}");
        }
    }
}

/// A floor, two balls over it, one clear.
fn still_life() -> (Model, View) {
    let mut model = Model {
        materials: vec![
            material(0.0, 1.0, 1.0),
            material(0.5, 30.0, 1.0),
            material(0.3, 50.0, 0.4),
        ],
        ..Model::default()
    };
    let floor = [
        [-2.0, -0.8, 1.5],
        [2.0, -0.8, 1.5],
        [2.0, -0.8, -2.0],
        [-2.0, -0.8, -2.0],
    ];
    quad(&mut model, floor, [0.0, 1.0, 0.0], ([0.8; 3], 0));
    sphere(&mut model, [-0.5, 0.0, 0.0], 0.5, 12, ([0.8, 0.2, 0.1], 1));
    sphere(&mut model, [0.4, -0.3, 0.5], 0.3, 9, ([0.2, 0.8, 0.3], 2));
    let view = View {
        width: 160,
        height: 120,
        eye: [0.4, 0.9, 3.0],
        light: [0.7, 1.2, 0.5],
        shade: Shade::Gouraud,
        cull: Cull::Back,
        background: [10, 20, 30],
        ..View::default()
    };
    (model, view)
}

#[test]
fn any_cache_and_any_renderers_give_the_same_picture() {
    let (model, view) = still_life();
    for (phong, format) in [
        (false, PixelFormatArg::Rgb888),
        (true, PixelFormatArg::Dithered565),
    ] {
        let effects = Effects {
            specular: None,
            shadows: true,
            phong,
        };
        let whole = drawn(&model, &view, format, CrewSettings::default(), effects);
        for renderers in [1, 3] {
            for slots in [0, 6, 224] {
                let crew = CrewSettings {
                    renderers,
                    slots,
                    ..CrewSettings::default()
                };
                let other = drawn(&model, &view, format, crew, effects);
                assert!(
                    other.frame == whole.frame,
                    "{renderers} renderers, {slots} slots"
                );
            }
        }
    }
}

/// On the floor, where the ball's shadow is found by hand.
///
/// Kills: surfaces that are drawn again in their light, at corners and at pixels.
#[test]
fn a_shadow_leaves_the_light_from_everywhere() {
    let (model, view) = still_life();
    let with = |shadows, phong| {
        let effects = Effects {
            shadows,
            phong,
            ..Effects::default()
        };
        usual(&model, &view, effects).frame
    };
    for phong in [false, true] {
        let (lit, shaded) = (with(false, phong), with(true, phong));
        let (mut dark, mut same) = (0, 0);
        for (x, y) in (0..view.height).flat_map(|y| (0..view.width).map(move |x| (x, y))) {
            let (a, b) = (lit.pixel(x, y).unwrap(), shaded.pixel(x, y).unwrap());
            let is_floor = a[0] == a[1] && a[1] == a[2];
            if is_floor && a != b {
                // 0.8 times the ambient level.
                assert!(b[0].abs_diff(41) <= 1, "({x}, {y}): {b:?}");
                dark += 1;
            }
            same += u32::from(a == b);
            assert!((0..3).all(|i| b[i] <= a[i]), "({x}, {y}): {a:?} {b:?}");
        }
        assert!(dark > 200 && same > 15_000, "{dark} {same}");
    }
    // Unlit colours in shadow, too.
    let unlit = View {
        shade: Shade::None,
        ..view
    };
    let effects = Effects {
        shadows: true,
        ..Effects::default()
    };
    let picture = usual(&model, &unlit, effects).frame;
    let grey = |level: u8| {
        let pixels = picture.rgb().chunks_exact(3);
        pixels
            .filter(|p| p.iter().all(|c| c.abs_diff(level) <= 1))
            .count()
    };
    assert!(
        grey(41) > 200 && grey(204) > 3000,
        "{} {}",
        grey(41),
        grey(204)
    );
}

#[test]
fn without_effects_it_is_the_usual_picture() {
    let (mut model, view) = still_life();
    model.materials.iter_mut().for_each(|m| {
        m.ks = [0.0; 3];
        m.d = 1.0;
    });
    for shade in [Shade::None, Shade::Flat, Shade::Gouraud] {
        let view = View {
            shade,
            ..view.clone()
        };
        let effects = Effects::default();
        assert!(!effects.are_seen(&model, &view));
        let crew = CrewSettings::default();
        let plain = draw(&model, &view, PixelFormatArg::Rgb888, crew).unwrap();
        let other = usual(&model, &view, effects);
        for (a, b) in plain.frame.rgb().iter().zip(other.frame.rgb()) {
            assert!(a.abs_diff(*b) <= 2, "{a} {b}");
        }
        assert_eq!(
            plain.used.assembled.triangles,
            other.used.assembled.triangles
        );
    }
}
