//! Textured pictures against places reckoned in `f64` (H3, X2): the reference draws u/w, v/w and
//! 1/w as colours, which are linear on the screen, and the quotient is the place.

use crate::common::Rng;
use host_tests::args::PixelFormatArg;
use host_tests::draw::{CrewSettings, Drawn, FilterArg, TextureSet, draw_textured};
use host_tests::image_out::Frame;
use host_tests::model::{Model, ModelVertex};
use host_tests::reference::{NO_OBJECT, Options, Reference, View, render_with};
use host_tests::texture_file::TextureImage;
use scanbeam::pipeline::texture::Quality;

const SIDE: u32 = 64;

/// A texture whose texels say where they are.
fn own_places() -> TextureImage {
    let rgb = (0..SIDE)
        .flat_map(|y| (0..SIDE).flat_map(move |x| [x as u8, y as u8, 255]))
        .collect();
    TextureImage::new(&Frame::new(SIDE, SIDE, rgb).unwrap()).unwrap()
}

/// Triangles before the eye at (0, 0, 0), which looks along -z, from 1 to 12 away.
fn soup(rng: &mut Rng, count: u32) -> Model {
    let mut model = Model::default();
    for triangle in 0..count {
        for _ in 0..3 {
            let far = 1.0 + 11.0 * rng.unit();
            let mut side = || (2.0 * rng.unit() - 1.0) * far * 0.55;
            model.vertices.push(ModelVertex {
                position: [side(), side(), -far],
                normal: [0.0, 0.0, 1.0],
                colour: [1.0; 3],
                uv: [3.0 * rng.unit(), 3.0 * rng.unit()],
            });
        }
        model.triangles.push([0, 1, 2].map(|k| 3 * triangle + k));
        model.triangle_materials.push(None);
    }
    model
}

fn view() -> View {
    View {
        eye: [0.0; 3],
        at: [0.0, 0.0, -1.0],
        ..View::default()
    }
}

fn drawn(model: &Model, quality: Quality, crew: CrewSettings) -> Drawn {
    let set = TextureSet::whole(model, own_places());
    let how = (FilterArg::Nearest, quality);
    draw_textured(model, &set, how, &view(), PixelFormatArg::Rgb888, crew).unwrap()
}

/// The reference of u/w, v/w in levels of 1/4 of 255, from vertices rounded to 13.3.
fn homogeneous(model: &Model) -> Reference {
    let mut model = model.clone();
    for vertex in &mut model.vertices {
        let q = -1.0 / vertex.position[2];
        vertex.colour = [vertex.uv[0] * q / 4.0, (3.0 - vertex.uv[1]) * q / 4.0, 0.0];
    }
    let options = Options {
        steps_per_pixel: Some(8.0),
    };
    render_with(&model, &view(), options).unwrap()
}

/// Pixels compared, pixels with another texel, and the farthest of these, in texels.
fn wrong_texels(reference: &Reference, frame: &Frame) -> (u32, u32, f64) {
    let (mut all, mut wrong, mut farthest) = (0, 0, 0.0f64);
    for (i, pixel) in frame.rgb().chunks_exact(3).enumerate() {
        if reference.object[i] == NO_OBJECT || reference.near_edge[i] {
            continue;
        }
        all += 1;
        let mut worst = 0.0f64;
        for (level, texel) in reference.colour[i].iter().zip(&pixel[..2]) {
            let side = f64::from(SIDE);
            let place = level / 255.0 * 4.0 / reference.inverse_w[i] * side;
            // From the place to the texel's square, on a side that repeats.
            let beyond = (place - f64::from(*texel)).rem_euclid(side);
            if beyond >= 1.0 {
                worst = worst.max((beyond - 1.0).min(side - beyond));
            }
        }
        wrong += u32::from(worst > 0.0);
        farthest = farthest.max(worst);
    }
    (all, wrong, farthest)
}

#[test]
fn exact_pictures_choose_the_right_texel_and_others_keep_their_budget() {
    for (quality, per_cent, texels) in [
        (Quality::Exact, 0.3, 1.0),
        (Quality::Balanced, 100.0, 0.25),
        (Quality::Fast, 100.0, 0.5),
    ] {
        let mut rng = Rng::new(9);
        let (mut all, mut wrong, mut farthest) = (0, 0, 0.0f64);
        for _ in 0..12 {
            let model = soup(&mut rng, 12);
            let frame = drawn(&model, quality, CrewSettings::default()).frame;
            let (a, w, far) = wrong_texels(&homogeneous(&model), &frame);
            (all, wrong, farthest) = (all + a, wrong + w, farthest.max(far));
        }
        let share = 100.0 * f64::from(wrong) / f64::from(all);
        println!("{quality:?}: {share:.4} % of {all} wrong, farthest {farthest:.4} texel");
        assert!(all > 100_000, "{all} pixels compared");
        assert!(share <= per_cent, "{quality:?}: {share} %");
        assert!(farthest <= texels, "{quality:?}: {farthest} texels");
    }
}

#[test]
fn every_crew_draws_the_same() {
    let model = soup(&mut Rng::new(4), 40);
    let one = drawn(&model, Quality::Balanced, CrewSettings::default());
    assert!(one.stats.spans.texture_fetches > 10_000);
    assert_eq!(
        one.stats.spans.texture_fetches,
        one.stats.spans.pixels_shaded
    );
    for (renderers, slots, prefetch) in [(1, 0, 0), (1, 3, 0), (2, 16, 900), (3, 64, 0)] {
        let crew = CrewSettings {
            renderers,
            slots,
            prefetch,
            ..CrewSettings::default()
        };
        let other = drawn(&model, Quality::Balanced, crew);
        assert!(other.frame == one.frame, "{crew:?}");
    }
}
