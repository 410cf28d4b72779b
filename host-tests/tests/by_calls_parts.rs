//! Pictures by draw calls that are put together from parts: tiles where a scene cannot be as large, bands of lines where
//! it cannot hold as much.

use crate::by_calls::{called, teapot, view};
use host_tests::args::{self, Command, PixelFormatArg};
use host_tests::draw::{
    CrewSettings, FilterArg, Prepared, Skins, TextureSet, draw_by_calls, draw_textured,
};
use host_tests::image_out::Frame;
use host_tests::model::Model;
use host_tests::reference::{self, Shade, TOLERANCE_LEVELS, View, compare};
use host_tests::texture_file::TextureImage;
use host_tests::view::{Did, Scenery, State};
use scanbeam::pipeline::texture::Quality;
use std::fmt::Write as _;
use std::path::Path;

/// A square of so many cells a side, each of two triangles, before the eye of [`View::default`].
fn grid(cells: usize) -> Model {
    let mut text = String::new();
    let side = cells + 1;
    for i in 0..side * side {
        let at = |k: usize| k as f64 / cells as f64 - 0.5;
        writeln!(text, "v {} {} 0", at(i % side), at(i / side)).expect("a string");
    }
    for i in 0..cells * cells {
        let a = i / cells * side + i % cells + 1;
        let b = a + side;
        writeln!(text, "f {a} {} {}\nf {a} {} {b}", a + 1, b + 1, b + 1).expect("a string");
    }
    Model::from_obj_text(&text, Path::new("grid.obj")).expect("an OBJ")
}

/// Pixels of which `a` and `b` differ by more than so many levels.
fn differ(a: &Frame, b: &Frame, levels: u8) -> usize {
    let pixels = a.rgb().chunks_exact(3).zip(b.rgb().chunks_exact(3));
    let off = |(a, b): (&[u8], &[u8])| a.iter().zip(b).any(|(a, b)| a.abs_diff(*b) > levels);
    pixels.filter(|&pixels| off(pixels)).count()
}

#[test]
fn pictures_of_several_tiles_are_whole() {
    let model = teapot();
    let prepared = Prepared::new(&model);
    for (width, height, parts) in [
        (1017, 763, 2),
        (763, 1017, 2),
        (1400, 1050, 4),
        (1016, 762, 1),
    ] {
        let view = view(width, height, Shade::Gouraud);
        let exact = reference::render(&model, &view).expect("a view");
        let called = called(&prepared, &view, PixelFormatArg::Rgb888).expect("a picture");
        assert_eq!(called.figures.parts, parts, "{width} x {height}");
        assert_eq!(
            called.used.scan_out.bytes_sent,
            u64::from(3 * width * height)
        );
        let held = compare(&exact, view.background, &called.frame).expect("the same size");
        let what = format!("{width} x {height}: {held:?}");
        assert!(held.max_error_levels < TOLERANCE_LEVELS, "{what}");
        assert_eq!(held.covered_differently_away, 0, "{what}");
        assert!(held.covered_reference > 200_000, "{what}");
    }
}

#[test]
fn textures_of_several_tiles_are_whole() {
    let mut model = grid(9);
    for vertex in &mut model.vertices {
        vertex.uv = [0, 1].map(|k| 2.0 * vertex.position[k]);
    }
    let rgb = (0..64 * 64u32).flat_map(|i| [(i % 64 * 4) as u8, (i / 64 * 4) as u8, 96]);
    let image = TextureImage::new(&Frame::new(64, 64, rgb.collect()).expect("64 x 64"));
    let set = TextureSet::whole(&model, image.expect("a texture"));
    let view = View {
        at: [0.1, 0.05, 0.0],
        ..View {
            width: 1240,
            height: 930,
            ..View::default()
        }
    };
    let (filter, quality) = (FilterArg::Nearest, Quality::Exact);
    let skins = Skins {
        set: &set,
        filter,
        quality,
    };
    let prepared = Prepared::textured(&model, &set, quality);
    let format = PixelFormatArg::Rgb888;
    let called = draw_by_calls(&prepared, Some(skins), &view, format, 2, 64).expect("a view");
    let called = called.expect("a picture");
    assert_eq!(called.figures.parts, 2);
    let crew = CrewSettings::default();
    let drawn = draw_textured(&model, &set, (filter, quality), &view, format, crew);
    // Texels of 4 levels are rounded to 5 bits: a neighbour is 12 off.
    let differ = differ(&called.frame, &drawn.expect("a view").frame, 12);
    assert!(differ < 400, "{differ} pixels");
}

#[test]
fn models_that_are_more_than_a_scene_holds_are_drawn_in_bands() {
    // 24,200 flat triangles need more than 65,536 vertices, and 64,800 are more than a scene holds.
    for (cells, shade, name, parts) in [
        (110, Shade::Gouraud, "gouraud", 1..=1),
        (110, Shade::Flat, "flat", 2..=4),
        (180, Shade::None, "none", 2..=4),
    ] {
        let model = grid(cells);
        let view = View {
            shade,
            eye: [0.0, 0.0, 1.0],
            width: 640,
            height: 480,
            ..View::default()
        };
        let prepared = Prepared::new(&model);
        let format = PixelFormatArg::Rgb888;
        let called = draw_by_calls(&prepared, None, &view, format, 3, 64);
        let called = called.expect("a view").expect("a picture");
        assert!(
            parts.contains(&called.figures.parts),
            "{name}: {:?}",
            called.figures
        );
        assert_eq!(called.overfull, None, "{name}");
        let exact = reference::render(&model, &view).expect("a view");
        let held = compare(&exact, view.background, &called.frame).expect("the same size");
        assert_eq!(held.covered_differently_away, 0, "{name}: {held:?}");
        assert!(held.covered_reference > 150_000, "{name}: {held:?}");

        let scenery = Scenery::new(&model).expect("no textures");
        let words = ["scanbeam", "view", "--shade", name];
        let Ok(Command::View(flags)) = args::parse(words) else {
            panic!("{words:?}");
        };
        let shown = scenery
            .frame(&State::new(&flags), 640, 480)
            .expect("a view");
        assert!(matches!(shown.did, Did::Calls(_)), "{cells} {name}");
        let of = format!("of {} tri", 2 * cells * cells);
        assert!(shown.figures().contains(&of), "{}", shown.figures());
    }
}

#[test]
fn a_line_with_too_many_triangles_is_told() {
    // Each is on the middle line.
    let mut text = String::new();
    for i in 0..70_000 {
        let x = f64::from(i) / 70_000.0 - 0.5;
        writeln!(text, "v {x} -0.2 0\nv {} 0.2 0\nv {x} 0.2 0", x + 0.1).expect("a string");
        writeln!(text, "f {} {} {}", 3 * i + 1, 3 * i + 2, 3 * i + 3).expect("a string");
    }
    let model = Model::from_obj_text(&text, Path::new("many.obj")).expect("an OBJ");
    let view = View {
        width: 64,
        height: 48,
        ..View::default()
    };
    let called = called(&Prepared::new(&model), &view, PixelFormatArg::Rgb888).expect("a picture");
    let overfull = called.overfull.expect("more than a scene holds");
    assert!(
        overfull.lines > 0 && overfull.triangles > 1000,
        "{overfull:?}"
    );
    assert!(
        overfull.to_string().contains("the rest is drawn"),
        "{overfull}"
    );
}
