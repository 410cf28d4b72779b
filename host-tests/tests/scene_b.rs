//! Scene B, the textured sphere of the benchmark, against `f64` (H3, H5).

use host_tests::frames::{scene_b_frame, shot_frame};
use host_tests::model::{Model, ModelVertex};
use host_tests::reference::{
    Cull, NO_OBJECT, Options, Reference, Shade, TextureMap, Textures, View, render_textured,
};
use scanbeam::Faces;
use scanbeam::scene::Shading;
use scenes::{SCENES_B, SPHERE, Shot, TEXEL_SIDE, TEXELS_565};

/// What a frame shows, words of 5, 6 and 5 bits.
fn words(name: &str) -> Vec<u16> {
    let scene = SCENES_B.into_iter().find(|scene| scene.name == name);
    let drawn = scene_b_frame(scene.unwrap()).unwrap();
    drawn.words.into_iter().map(u16::from_be).collect()
}

/// The 8-bit levels of a word of 5, 6 and 5 bits, by the field alone.
fn levels(word: u16) -> [f64; 3] {
    let field = |shift: u32, most: u16| f64::from(word >> shift & most) * 255.0 / f64::from(most);
    [field(11, 31), field(5, 63), field(0, 31)]
}

/// The texel at a place, of the texture once around.
fn texel(place: [f64; 2]) -> u16 {
    let side = f64::from(TEXEL_SIDE);
    let [x, y] = place.map(|at| at.floor().rem_euclid(side) as usize);
    TEXELS_565[y * TEXEL_SIDE as usize + x]
}

/// The scene in real numbers: the mesh as it is stored, corners on a grid of so many `steps` a pixel.
fn reference(shade: Shade, steps: f64) -> Reference {
    let unit = |v: [i16; 3]| v.map(|c| f64::from(c) / 16_384.0);
    let vertices = (0..)
        .zip(SPHERE.positions)
        .map(|(i, position)| ModelVertex {
            position: unit(*position),
            normal: unit(*position),
            colour: [1.0; 3],
            uv: [f64::from(i % 33) / 32.0, 1.0 - f64::from(i / 33) / 32.0],
        });
    let Faces::Triangles(faces) = SPHERE.faces else {
        panic!("the sphere has triangles");
    };
    let model = Model {
        vertices: vertices.collect(),
        triangles: faces.iter().map(|face| face.map(u32::from)).collect(),
        triangle_materials: vec![None; faces.len()],
        ..Model::default()
    };
    let side = TEXEL_SIDE;
    let map = TextureMap::made(side, side, |x, y| {
        levels(TEXELS_565[(y * side + x) as usize])
    });
    let textures = Textures {
        maps: &[map],
        of_triangle: &vec![Some(0); faces.len()],
    };
    let view = View {
        eye: [0.0, 0.0, 3.94],
        fov: 2.0 * 0.375f64.atan().to_degrees(),
        light: [0.5, 0.7, 0.8],
        ambient: 0.15,
        shade,
        cull: Cull::Back,
        ..View::default()
    };
    let snapped = Options {
        steps_per_pixel: Some(steps),
    };
    render_textured(&model, textures, &view, snapped).unwrap()
}

/// Indices of pixels where the sphere is seen, and no rounding of its rim changes that.
fn seen(reference: &Reference) -> impl Iterator<Item = usize> {
    (0..reference.object.len())
        .filter(|&i| reference.object[i] != NO_OBJECT && !reference.near_edge[i])
}

#[test]
fn every_pixel_of_scene_a_has_a_texel() {
    let sphere = shot_frame(Shot::Sphere, Shading::Smooth)
        .unwrap()
        .counts
        .spans;
    for scene in SCENES_B {
        let spans = scene_b_frame(scene).unwrap().counts.spans;
        println!("{}: {spans:?}", scene.name);
        assert_eq!(spans.pixels_shaded, sphere.pixels_shaded);
        assert_eq!(spans.texture_fetches, spans.pixels_shaded);
        assert_eq!(spans.spans, sphere.spans);
    }
}

/// The exact way shows another texel than `f64` on at most 0.3 % of pixels, and no way shows one
/// that is farther away than its budget. Places are those of corners on 1/64 pixel.
///
/// Kills: places of corners on 1/8 pixel (`fine` of 0 in `TexturePlace::of_mesh`).
#[test]
fn texels_are_those_of_real_numbers() {
    let reference = reference(Shade::None, 64.0);
    for (name, budget, most) in [
        ("b_upright_unlit_exact", 0.02, 0.003),
        ("b_upright_unlit", 0.27, 0.25),
    ] {
        let words = words(name);
        let (mut pixels, mut other) = (0, 0);
        for i in seen(&reference) {
            let [u, v] = reference.place[i];
            pixels += 1;
            if words[i] == texel([u, v]) {
                continue;
            }
            other += 1;
            let near = [-budget, 0.0, budget];
            let within = near.iter().any(|du| {
                let mut each = near.iter();
                each.any(|dv| words[i] == texel([u + du, v + dv]))
            });
            assert!(within, "{name}: pixel {i} at {u}, {v}");
        }
        let part = f64::from(other) / f64::from(pixels);
        println!(
            "{name}: another texel on {other} of {pixels} pixels, {:.2} %",
            100.0 * part
        );
        assert!(pixels > 7_000 && part <= most, "{name}: {part}");
    }
}

/// Lit, a pixel is its texel times the light of scene A, within one step of the display. Light is that of corners on
/// 1/8 pixel.
#[test]
fn light_multiplies_texels() {
    let (lit, unlit) = (
        reference(Shade::Gouraud, 8.0),
        words("b_upright_unlit_exact"),
    );
    let shown = words("b_upright_exact");
    let (mut worst, mut darker) = ([0.0f64; 3], 0);
    for i in seen(&lit) {
        if unlit[i] != texel(lit.place[i]) {
            continue;
        }
        let (got, want) = (levels(shown[i]), lit.colour[i]);
        darker += u32::from(shown[i] != unlit[i]);
        for channel in 0..3 {
            let off = (got[channel] - want[channel]).abs();
            worst[channel] = worst[channel].max(off);
        }
    }
    println!("lit: off by {worst:.2?} levels, {darker} pixels darker than their texels");
    assert!(darker > 7_000);
    for (off, steps) in worst.into_iter().zip([31.0, 63.0, 31.0]) {
        assert!(off <= 255.0 / steps, "{worst:?}");
    }
}
