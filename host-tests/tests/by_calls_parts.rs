//! Pictures by draw calls that are put together from parts: tiles where a scene cannot be as large, bands of lines where
//! it cannot hold as much.

use crate::by_calls::{called, teapot, view};
use host_tests::args::{self, Command, PixelFormatArg};
use host_tests::draw::{
    CrewSettings, FilterArg, Prepared, Skins, TextureSet, draw_prepared, draw_textured,
};
use host_tests::image_out::Frame;
use host_tests::model::Model;
use host_tests::reference::{
    self, NO_OBJECT, Options, Shade, TOLERANCE_LEVELS, TextureMap, Textures, View, compare,
    render_textured,
};
use host_tests::texture_file::TextureImage;
use host_tests::view::{Scenery, State};
use scanbeam::pixel::{PixelFormat, Rgb565};
use scanbeam::scene::Budget;
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
        let called = called(&prepared, &view, PixelFormatArg::Rgb888);
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

/// The texel of each pixel is that which holds the place of `f64`.
///
/// Kills: a tile's camera that is half a pixel off, textures of the first tile on all.
#[test]
fn textures_of_several_tiles_are_whole() {
    let mut model = grid(9);
    for vertex in &mut model.vertices {
        vertex.uv = [0, 1].map(|k| 2.0 * vertex.position[k]);
    }
    // A texel's pixel says its column and row.
    let rgb = (0..64 * 64u16).flat_map(Rgb565::to_rgb8);
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
    let skins = Skins {
        set: &set,
        filter: FilterArg::Nearest,
        budget: Budget::EXACT,
    };
    let crew = CrewSettings {
        renderers: 2,
        ..CrewSettings::default()
    };
    let drawn = draw_textured(&model, skins, &view, PixelFormatArg::Rgb888, crew);
    let drawn = drawn.expect("a view");
    assert_eq!(drawn.figures.parts, 2);
    let map = TextureMap::made(64, 64, |_, _| [255.0; 3]);
    let of_triangle = vec![Some(0); model.triangles.len()];
    let textures = Textures {
        maps: std::slice::from_ref(&map),
        of_triangle: &of_triangle,
    };
    let exact = render_textured(&model, textures, &view, Options::default()).expect("a view");
    let (mut pixels, mut wrong) = (0, 0);
    for (i, rgb) in drawn.frame.rgb().chunks_exact(3).enumerate() {
        if exact.near_edge[i] || exact.object[i] == NO_OBJECT {
            continue;
        }
        let word = Rgb565::from_rgb8([rgb[0], rgb[1], rgb[2]]);
        let texel = [word % 64, word / 64].map(f64::from);
        let off = [0, 1].map(|k| {
            let off = texel[k] + 0.5 - exact.place[i][k];
            (off - 64.0 * (off / 64.0).round()).abs() - 0.5
        });
        pixels += 1;
        wrong += u32::from(off[0].max(off[1]) > 1.0 / 16.0);
    }
    assert!(pixels > 50_000 && wrong == 0, "{wrong} of {pixels}");
}

/// Kills: tiles that begin where the dither does not.
#[test]
fn a_dither_goes_on_from_tile_to_tile() {
    let text = "v -9 -9 0 .3 .6 .2\nv 9 -9 0 .3 .6 .2\nv 0 9 0 .3 .6 .2\nf 1 2 3\n";
    let model = Model::from_obj_text(text, Path::new("m.obj")).expect("an OBJ");
    let view = View {
        width: 1023,
        height: 1050,
        ..View::default()
    };
    let frame = called(&Prepared::new(&model), &view, PixelFormatArg::Dithered565).frame;
    let mut colours = std::collections::BTreeSet::new();
    for (x, y) in (0..1050).flat_map(|y| (0..1023).map(move |x| (x, y))) {
        assert_eq!(frame.pixel(x, y), frame.pixel(x % 4, y % 4), "{x} {y}");
        colours.insert(frame.pixel(x, y));
    }
    assert!(colours.len() > 2, "{colours:?}");
}

/// Triangles that are on several tiles or bands count once.
///
/// Kills: sums over parts, marks of one tile alone, triangles that are counted by their records.
#[test]
fn triangles_of_pictures_in_parts_count_once() {
    for (cells, shade) in [(40, Shade::Gouraud), (180, Shade::None), (110, Shade::Flat)] {
        let model = grid(cells);
        let prepared = Prepared::new(&model);
        let counts = |width, height| {
            // The picture's sides cut the grid.
            let view = View {
                shade,
                eye: [0.2, 0.1, 0.7],
                at: [0.2, 0.1, 0.0],
                width,
                height,
                ..View::default()
            };
            let drawn = called(&prepared, &view, PixelFormatArg::Rgb888);
            let all = drawn.used.assembled;
            (
                drawn.figures.parts,
                all.triangles,
                all.culled,
                drawn.figures.objects,
            )
        };
        let all = 2 * (cells * cells) as u32;
        // Corners of quarters of pixels are those of pixels of a quarter: the same triangles are seen.
        let (_, triangles, culled, objects) = counts(500, 375);
        assert_eq!(triangles, all, "{cells}");
        let (parts, triangles, again, more) = counts(2000, 1500);
        assert!(parts >= 4 && triangles == all, "{cells}");
        assert!(
            culled > all / 10 && culled < all / 2,
            "{cells}: {culled} of {all}"
        );
        let close = all / 200;
        assert!(
            again.abs_diff(culled) <= close,
            "{cells}: {again}, {culled}"
        );
        assert_eq!(objects, (all - culled) as usize, "{cells}: none is clipped");
        let shared = more - (all - again) as usize;
        assert!(shared > 0 && shared < objects / 4, "{cells}: {shared}");
    }
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
        let crew = CrewSettings {
            renderers: 3,
            ..CrewSettings::default()
        };
        let called = draw_prepared(&prepared, None, &view, PixelFormatArg::Rgb888, crew);
        let called = called.expect("a view");
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
    let called = called(&Prepared::new(&model), &view, PixelFormatArg::Rgb888);
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
