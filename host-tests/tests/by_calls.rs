//! Models by draw calls, as `view` shows them: near the reference, the same by whoever draws, and what they leave to
//! the presets.

use host_tests::args::PixelFormatArg;
use host_tests::draw::{Called, CrewSettings, MOST_SLOTS, Prepared, draw_by_calls, draw_prepared};
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

pub(crate) fn called(prepared: &Prepared, view: &View, format: PixelFormatArg) -> Option<Called> {
    draw_by_calls(prepared, None, view, format, 1, 64).expect("a view")
}

/// Kills: faces lit as if they were smooth, light where none was asked, faces that are dropped or not, another's camera.
#[test]
fn pictures_are_as_near_the_reference_as_those_of_the_presets() {
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
        for (format, most) in [
            (PixelFormatArg::Rgb565, 8.3),
            (PixelFormatArg::Rgb888, TOLERANCE_LEVELS),
            (PixelFormatArg::Xrgb8888, TOLERANCE_LEVELS),
        ] {
            let by_calls = held(&called(&prepared, &view, format).expect("it fits").frame);
            let drawn = draw_prepared(&prepared, &view, format, CrewSettings::default());
            let by_presets = held(&drawn.expect("a view").frame);
            let what = format!("{shade:?} {cull:?} {format:?}\n{by_calls:?}\n{by_presets:?}");
            assert!(by_calls.max_error_levels < most, "{what}");
            let [mean, other] = [by_calls, by_presets].map(|by| by.mean_error_levels);
            assert!(mean < other + 0.01, "{what}");
            assert_eq!(by_calls.covered_differently_away, 0, "{what}");
            assert!(by_calls.covered_reference > 20_000, "{what}");
        }
    }
}

/// Kills: grey that is a channel, bits that are not packed, or at another place.
#[test]
fn grey_pictures_and_those_of_one_bit_are_those_of_the_presets() {
    let prepared = Prepared::new(&teapot());
    for shade in SHADES {
        let view = view(203, 150, shade);
        for (format, bytes) in [
            (PixelFormatArg::Grey8, 203 * 150),
            (PixelFormatArg::Mono, 26 * 150),
        ] {
            let Called { frame, used, .. } = called(&prepared, &view, format).expect("it fits");
            assert_eq!(used.scan_out.bytes_sent, bytes);
            let drawn = draw_prepared(&prepared, &view, format, CrewSettings::default());
            let drawn = drawn.expect("a view").frame;
            let off = |i: usize| frame.rgb()[i].abs_diff(drawn.rgb()[i]);
            let off: Vec<u8> = (0..frame.rgb().len()).step_by(3).map(off).collect();
            let most = |levels: u8| off.iter().filter(|&&off| off > levels).count();
            // Of 30,450; at a rim another triangle may be in front.
            let more = [0, 1].map(most);
            assert!(
                more[0] < 100 && more[1] < 10,
                "{shade:?} {format:?}: {more:?}"
            );
            let bright = frame.rgb().iter().filter(|&&level| level > 100).count();
            assert!(
                (3_000..60_000).contains(&bright),
                "{shade:?} {format:?}: {bright}"
            );
        }
    }
}

/// Kills: a line that two draw, or nobody; a renderer that is told of another cache; figures of one renderer alone.
#[test]
fn whoever_draws_the_picture_is_the_same() {
    let prepared = Prepared::new(&teapot());
    for shade in SHADES {
        let view = view(90, 61, shade);
        let draw = |renderers, slots| {
            let format = PixelFormatArg::Rgb888;
            let called = draw_by_calls(&prepared, None, &view, format, renderers, slots);
            called.expect("a view").expect("it fits")
        };
        let first = draw(1, 64);
        let begun = |called: &Called| called.used.cache.hits + called.used.cache.spilled;
        let is_empty = |line: &&[u8]| line.iter().all(|&level| level == 0);
        let empty = first.frame.rgb().chunks(3 * 90).filter(is_empty).count() as u32;
        assert!(empty > 10 && first.used.lines_skipped == empty);
        assert_eq!(first.used.scan_out.bytes_sent, 90 * 61 * 3);
        assert!(first.used.assembled.culled < first.used.assembled.triangles);
        for (renderers, slots) in [
            (1, 0),
            (1, 7),
            (1, MOST_SLOTS),
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
            assert!(a.cache.peak <= u32::from(slots), "{what}: {a:?}");
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

#[test]
fn what_draw_calls_do_not_draw_is_left_to_the_presets() {
    let prepared = Prepared::new(&teapot());
    let is_drawn = |format, slots| {
        let view = view(8, 8, Shade::Gouraud);
        let called = draw_by_calls(&prepared, None, &view, format, 1, slots);
        called.expect("a view").is_some()
    };
    use PixelFormatArg::Rgb565;
    assert!(is_drawn(Rgb565, MOST_SLOTS) && !is_drawn(Rgb565, MOST_SLOTS + 1));
}
