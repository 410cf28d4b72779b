//! Models as `view` and `render` show them: near the reference in all formats, the same by whoever draws and however what
//! is seen is found.

use host_tests::args::{DepthArg, PixelFormatArg};
use host_tests::draw::{CrewSettings, Drawn, MOST_SLOTS, Prepared, draw_prepared};
use host_tests::image_out::Frame;
use host_tests::model::{Model, obj_text};
use host_tests::reference::{self, Comparison, Cull, Shade, TOLERANCE_LEVELS, View, compare};
use std::path::Path;

const SHADES: [Shade; 3] = [Shade::None, Shade::Flat, Shade::Gouraud];

/// The teapot off the origin, in colours that differ from vertex to vertex.
pub(crate) fn teapot() -> Model {
    let text = obj_text(&scenes::TEAPOT).expect("triangles");
    let mut model = Model::from_obj_text(&text, Path::new("teapot.obj")).expect("an OBJ");
    for vertex in &mut model.vertices {
        // Whole levels, as meshes have them.
        vertex.colour = vertex.position.map(|c| (c * 127.0 + 128.0).round() / 255.0);
        vertex.position[0] += 5.0;
    }
    model
}

/// From so near that the picture's sides cut the teapot.
pub(crate) fn view(width: u32, height: u32, shade: Shade) -> View {
    View {
        width,
        height,
        eye: [5.4, 0.9, 1.1],
        at: [5.0, 0.0, 0.0],
        light: [-0.9, 0.8, 0.5],
        shade,
        ..View::default()
    }
}

pub(crate) fn called(prepared: &Prepared, view: &View, format: PixelFormatArg) -> Drawn {
    draw_prepared(prepared, None, view, format, CrewSettings::default()).expect("a view")
}

/// Kills: faces lit as if they were smooth, light where none was asked, faces that are dropped or not, another's camera.
#[test]
fn pictures_are_near_the_reference() {
    let model = teapot();
    let prepared = Prepared::new(&model);
    for (shade, cull) in SHADES
        .into_iter()
        .flat_map(|shade| [(shade, Cull::Back), (shade, Cull::None)])
    {
        let view = View {
            cull,
            ..view(320, 240, shade)
        };
        let exact = reference::render(&model, &view).expect("a view");
        let held = |frame: &Frame| -> Comparison {
            compare(&exact, view.background, frame).expect("the same size")
        };
        // A pixel of 16 bits is half a step of 8.2 levels off by itself, and colours of small triangles are less than
        // another half.
        for (format, most, mean) in [
            (PixelFormatArg::Rgb565, 8.3, 1.75),
            (PixelFormatArg::Rgb888, TOLERANCE_LEVELS, 0.32),
            (PixelFormatArg::Xrgb8888, TOLERANCE_LEVELS, 0.32),
        ] {
            let held = held(&called(&prepared, &view, format).frame);
            let what = format!("{shade:?} {cull:?} {format:?}\n{held:?}");
            println!("{what}");
            assert!(held.max_error_levels < most, "{what}");
            assert!(held.mean_error_levels < mean, "{what}");
            assert_eq!(held.covered_differently_away, 0, "{what}");
            assert!(held.covered_reference > 20_000, "{what}");
        }
    }
}

/// Kills: grey that is a channel, bits that are not packed, or at another place.
#[test]
fn grey_pictures_and_those_of_one_bit_are_near_the_reference() {
    let model = teapot();
    let prepared = Prepared::new(&model);
    for shade in SHADES {
        let view = view(203, 150, shade);
        let exact = reference::render(&model, &view).expect("a view");
        let luma = |[r, g, b]: [f64; 3]| 0.299 * r + 0.587 * g + 0.114 * b;
        let want: Vec<f64> = exact.colour.iter().map(|colour| luma(*colour)).collect();
        let drawn = |format, bytes| -> Vec<f64> {
            let Drawn { frame, used, .. } = called(&prepared, &view, format);
            assert_eq!(used.scan_out.bytes_sent, bytes);
            let pixels = frame.rgb().chunks_exact(3);
            assert!(
                pixels
                    .clone()
                    .all(|rgb| rgb[0] == rgb[1] && rgb[1] == rgb[2])
            );
            pixels.map(|rgb| f64::from(rgb[0])).collect()
        };
        let grey = drawn(PixelFormatArg::Grey8, 203 * 150);
        let (mut most, mut bright) = (0.0f64, 0);
        for i in 0..want.len() {
            if !exact.near_edge[i] {
                most = most.max((grey[i] - want[i]).abs());
                bright += u32::from(want[i] > 100.0);
            }
        }
        assert!(
            most < TOLERANCE_LEVELS && bright > 300,
            "{shade:?}: {most} {bright}"
        );
        // Of a tile of the dither, so many are white as its mean says.
        let bits = drawn(PixelFormatArg::Mono, 26 * 150);
        assert!(bits.iter().all(|&bit| bit == 0.0 || bit == 255.0));
        let (mut off, mut tiles) = (0.0f64, 0);
        for (x, y) in (0..18).flat_map(|y| (0..25).map(move |x| (8 * x, 8 * y))) {
            let at = |i: usize| (y + i / 8) * 203 + x + i % 8;
            let mean = |of: &[f64]| (0..64).map(|i| of[at(i)]).sum::<f64>() / 64.0;
            tiles += u32::from(mean(&want) > 60.0);
            off = off.max((mean(&bits) - mean(&want)).abs());
        }
        println!("{shade:?}: grey off by {most:.2}, tiles by {off:.2}, {tiles} bright");
        assert!(off < 24.0 && tiles > 50, "{shade:?}: {off} {tiles}");
    }
}

/// Kills: depth that is lent where there is to be none, or not lent; a test that does not compare each pixel.
#[test]
fn what_is_seen_is_the_same_by_any_depth_but_priority() {
    let prepared = Prepared::new(&teapot());
    for shade in SHADES {
        let view = view(203, 150, shade);
        let by = |depth| {
            let crew = CrewSettings {
                counts: true,
                depth,
                ..CrewSettings::default()
            };
            draw_prepared(&prepared, None, &view, PixelFormatArg::Rgb888, crew).expect("a view")
        };
        let auto = by(DepthArg::Auto);
        let spans = |drawn: &Drawn| drawn.spans.expect("they were counted");
        for depth in [DepthArg::Z32, DepthArg::Id] {
            assert!(by(depth).frame == auto.frame, "{shade:?} {depth}");
        }
        let [z32, auto_spans] = [spans(&by(DepthArg::Z32)), spans(&auto)];
        let covered = |s: scanbeam::stats::SpanCounts| s.pixels_shaded + s.pixels_hidden;
        assert_eq!(z32.spans_untested, 0, "{shade:?}");
        assert!(z32.depth_tests >= covered(z32), "{shade:?}: {z32:?}");
        assert!(
            auto_spans.depth_tests < z32.depth_tests / 2,
            "{shade:?}: {auto_spans:?}"
        );
        let priority = by(DepthArg::Priority);
        assert!(priority.frame != auto.frame && spans(&priority).depth_tests == 0);
        assert!(priority.figures.fast_bytes < auto.figures.fast_bytes);
    }
}

/// Kills: a line that two draw, or nobody; a renderer that is told of another cache; figures of one renderer alone.
#[test]
fn whoever_draws_the_picture_is_the_same() {
    let prepared = Prepared::new(&teapot());
    for shade in SHADES {
        let view = view(90, 61, shade);
        let draw_ahead = |renderers, slots, prefetch| {
            let crew = CrewSettings {
                renderers,
                slots,
                prefetch,
                counts: true,
                ..CrewSettings::default()
            };
            draw_prepared(&prepared, None, &view, PixelFormatArg::Rgb888, crew).expect("a view")
        };
        let draw = |renderers, slots| draw_ahead(renderers, slots, 0);
        let first = draw(1, 64);
        for (renderers, slots, bytes) in [(1, 64, 4000), (1, 7, 100), (3, 64, 500), (2, 0, 500)] {
            let ahead = draw_ahead(renderers, slots, bytes);
            let (cache, what) = (ahead.used.cache, format!("{shade:?}, {renderers}, {slots}"));
            assert_eq!(
                (&ahead.frame, ahead.spans),
                (&first.frame, first.spans),
                "{what}"
            );
            assert_eq!(cache.fetched > 0, slots > 0, "{what}");
            assert!(cache.fetched_bytes > 0, "{what}");
        }
        assert_eq!(first.used.cache.fetched, 0);
        let begun = |called: &Drawn| called.used.cache.hits + called.used.cache.spilled;
        let is_empty = |line: &&[u8]| line.iter().all(|&level| level == 0);
        let empty = first.frame.rgb().chunks(3 * 90).filter(is_empty).count() as u32;
        assert!(empty > 10 && first.used.lines_skipped == empty);
        assert_eq!(first.used.scan_out.bytes_sent, 90 * 61 * 3);
        assert!(first.used.assembled.culled < first.used.assembled.triangles);
        for (renderers, slots) in [
            (1, 0),
            (1, 7),
            (1, MOST_SLOTS),
            (1, u16::MAX),
            (2, 64),
            (3, 5),
            (7, 64),
            (61, 64),
            (62, 64),
        ] {
            let again = draw(renderers, slots);
            let what = format!("{shade:?}, {renderers} renderers, {slots} slots");
            assert_eq!(again.frame, first.frame, "{what}");
            let (a, b) = (&again.used, &first.used);
            assert_eq!(a.assembled, b.assembled, "{what}");
            // What found no slot counts until somebody has looked at it, though it may have no pixel.
            let least = empty - u32::from(slots < 64);
            assert!((least..=empty).contains(&a.lines_skipped), "{what}: {a:?}");
            assert_eq!(a.scan_out.bytes_sent, b.scan_out.bytes_sent, "{what}");
            assert_eq!(again.spans, first.spans, "{what}");
            assert!(
                a.cache.peak <= u32::from(slots.min(MOST_SLOTS)),
                "{what}: {a:?}"
            );
            if slots == 0 {
                assert_eq!(a.cache.hits, 0, "{what}");
            }
            if renderers == 1 {
                assert_eq!(begun(&again), begun(&first), "{what}");
            } else {
                // Each has what is on its lines.
                let most = u32::from(renderers) * begun(&first);
                assert!(
                    begun(&again) > begun(&first) && begun(&again) <= most,
                    "{what}"
                );
            }
        }
    }
}
