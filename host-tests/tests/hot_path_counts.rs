//! M4: spans and pixels that a renderer counts are those of a reference that goes from pixel to pixel, whatever the
//! scene, the slots and the renderers.
//!
//! The reference has coverage from whole numbers and 1/w in f64, and no spans. Where two depths are nearer to each other
//! than depth may err, a line is left out, and counted.

mod calls;
mod row;

use crate::common::Rng;
use crate::hot::exact::within;
use crate::hot::values::{NEARER_OR_EQUAL, draw_each};
use crate::hot::{LineRooms, SceneRooms, Smooth, WordOf, line};
use calls::{Call, KINDS, Kind};
use host_tests::flashed::tally::spans_since;
use row::Row;
use scanbeam::Screen;
use scanbeam::frame::Renderer;
use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{Draw, Scene, TexturePlace};
use scanbeam::stats::SpanCounts;

const BACKGROUND: [u8; 3] = [0; 3];
const SLOTS: [u16; 5] = [0, 1, 3, 9, 128];

/// Draws calls, and hands the scene to `see`.
fn with_calls<L: Smooth, R>(
    screen: Screen,
    calls: &[Call],
    see: impl FnOnce(&Scene<'_, '_, L>) -> R,
) -> R {
    // Faces of volumes that are seen from inside have a state of their own.
    let mut rooms = SceneRooms::new(
        3 * calls.len(),
        calls.len(),
        screen.height().into(),
        2 * calls.len(),
    );
    rooms.places = vec![TexturePlace::EMPTY; rooms.vertices.len()];
    let mut scene = rooms.scene::<L>(screen);
    let dress = |call: &Call, draw: &mut Draw<'_, '_, i32>| call.dress(draw, L::TEXTURED);
    draw_each(&mut scene, calls, |call| call.corners, dress);
    see(&scene)
}

/// Of a call that is drawn alone, the pixels that are no holes.
fn opaque<L: Smooth>(screen: Screen, call: &Call) -> Vec<Vec<bool>>
where
    WordOf<L>: PartialEq,
{
    let alone = Call {
        cut: None,
        test: [NEARER_OR_EQUAL; 2],
        blend: None,
        priority: 0,
        dither: false,
        shadow: None,
        ..call.clone()
    };
    let background = L::Format::from_rgb8(BACKGROUND);
    with_calls::<L, _>(screen, &[alone], |scene| {
        let lines = crate::hot::frame(scene, 128, true, background);
        let is_drawn = |line: Vec<WordOf<L>>| line.iter().map(|&w| w != background).collect();
        lines.into_iter().map(is_drawn).collect()
    })
}

/// The figures of each line of a counting renderer.
fn counted<L: Smooth>(scene: &Scene<'_, '_, L>, slots: u16, depth: bool) -> Vec<SpanCounts> {
    let mut rooms = LineRooms::fitting(scene, slots, depth);
    let mut renderer = rooms.with_shadows().counting();
    let mut before = SpanCounts::default();
    let of_line = |y| {
        line(&mut renderer, scene, y, L::Format::from_rgb8(BACKGROUND));
        let now = renderer.spans();
        spans_since(&now, &core::mem::replace(&mut before, now))
    };
    scene.lines().map(of_line).collect()
}

fn sum(counts: impl IntoIterator<Item = SpanCounts>) -> SpanCounts {
    let mut sum = SpanCounts::default();
    for one in counts {
        sum += one;
    }
    sum
}

/// Holds the figures of each line against the reference; how many lines were compared, and how many left out.
fn hold<L: Smooth>(screen: Screen, calls: &[Call], depth: bool) -> ([u32; 2], SpanCounts)
where
    WordOf<L>: PartialEq,
{
    let opaque: Vec<_> = calls.iter().map(|call| opaque::<L>(screen, call)).collect();
    let is_ranked = calls.iter().any(|call| call.priority > 0);
    with_calls::<L, _>(screen, calls, |scene| {
        let (mut lines, mut all) = ([0; 2], SpanCounts::default());
        for (got, y) in counted(scene, 128, depth).into_iter().zip(0..) {
            let columns = |call: &Call| within(call.corners.map(|c| c.at), y, screen.width());
            let row = Row {
                calls,
                y: y as u16,
                is_textured: L::TEXTURED,
                is_deep: depth && !is_ranked,
                columns: calls.iter().map(columns).collect(),
                opaque: &opaque,
            };
            match row.counts() {
                Some(want) => assert_eq!(got, want, "line {y}: {calls:#?}"),
                None => lines[1] += 1,
            }
            lines[0] += 1;
            all += got;
        }
        (lines, all)
    })
}

/// Fails where only rivals submitted later hide a span, pixels beside a scissor or holes of a texture are compared, cells
/// that nobody has written keep their depth, or what is drawn again where no volume is goes uncounted.
#[test]
fn counts_are_those_of_pixels_one_by_one() {
    let mut rng = Rng::new(0xC0_0147);
    let mut sums = [SpanCounts::default(); 10];
    let mut lines = [0; 2];
    for round in 0..1_500 {
        let screen = Screen::new(1 + rng.below(90) as u16, 1 + rng.below(30) as u16).unwrap();
        let (kind, depth) = (KINDS[round % 5], round % 10 < 5 || round % 40 > 30);
        let depth = depth || kind == Kind::Shadowed;
        let calls = Call::some(&mut rng, screen, kind);
        let ([all, out], counts) = match round % 3 {
            0 => hold::<Gouraud<Rgb888>>(screen, &calls, depth),
            _ => hold::<Textured<Rgb565Be>>(screen, &calls, depth),
        };
        lines = [lines[0] + all, lines[1] + out];
        sums[round % 5 + if depth { 0 } else { 5 }] += counts;
    }
    println!("{lines:?} {sums:#?}");
    assert!(lines[1] * 4 < lines[0], "{lines:?}");
    // Each kind with depth and then without, but for shadows, which need it.
    for (i, all) in sums.into_iter().enumerate().take(9) {
        let is_deep = i < 5 && i != 1 && i != 3;
        let has_values = matches!(i % 5, 2..);
        assert!(
            all.spans > 2_500 && all.spans_untested > 300,
            "{i}: {all:?}"
        );
        assert!(
            all.pixels_shaded > 10_000 && all.texture_fetches > 5_000,
            "{i}: {all:?}"
        );
        assert_eq!(
            all.depth_tests > 10_000,
            is_deep && has_values,
            "{i}: {all:?}"
        );
        if is_deep || !has_values {
            assert!(
                all.spans_hidden > 1_000 && all.pixels_hidden > 20_000,
                "{i}: {all:?}"
            );
        }
    }
}

/// Lines in turn by several renderers.
fn shared<L: Smooth>(
    scene: &Scene<'_, '_, L>,
    slots: u16,
    depth: bool,
    renderers: usize,
) -> SpanCounts {
    let mut rooms: Vec<_> = (0..renderers)
        .map(|_| LineRooms::fitting(scene, slots, depth))
        .collect();
    let mut all: Vec<Renderer<'_, L, 4>> = rooms
        .iter_mut()
        .map(|rooms| rooms.with_shadows().counting())
        .collect();
    for y in scene.lines() {
        let own = &mut all[usize::from(y) / 3 % renderers];
        line(own, scene, y, L::Format::from_rgb8(BACKGROUND));
    }
    sum(all.iter().map(Renderer::spans))
}

fn hang_on_nothing_else<L: Smooth>(rng: &mut Rng, screen: Screen, calls: &[Call], depth: bool)
where
    WordOf<L>: PartialEq + std::fmt::Debug,
{
    with_calls::<L, _>(screen, calls, |scene| {
        let want = sum(counted(scene, 128, depth));
        for slots in SLOTS {
            for renderers in [1, 2, 3] {
                let got = shared(scene, slots, depth, renderers);
                assert_eq!(
                    got, want,
                    "{slots} slots, {renderers} renderers: {calls:#?}"
                );
            }
        }
        // Counting changes no pixel, and nothing of what the cache does.
        let slots = rng.pick(&SLOTS);
        let background = L::Format::from_rgb8(BACKGROUND);
        let [mut a, mut b] = [(); 2].map(|()| LineRooms::fitting(scene, slots, depth));
        let (mut plain, mut counting) = (a.with_shadows(), b.with_shadows().counting());
        for y in scene.lines() {
            let want = line(&mut plain, scene, y, background);
            assert_eq!(line(&mut counting, scene, y, background), want);
        }
        assert_eq!(plain.counts(), counting.counts());
        assert_eq!(plain.spans(), SpanCounts::default());
        counting.restart();
        assert_eq!(counting.spans(), SpanCounts::default());
    });
}

/// Fails where a triangle without pixels on a line gives it values or a light, as only one without a slot is asked for
/// none, or where what is counted of shadows counts as set-ups.
#[test]
fn counts_hang_on_no_slots_and_renderers_and_change_nothing() {
    let mut rng = Rng::new(0x5_1075);
    for round in 0..400 {
        let screen = Screen::new(1 + rng.below(70) as u16, 1 + rng.below(24) as u16).unwrap();
        let kind = KINDS[round % 5];
        let depth = round % 3 > 0 || kind == Kind::Shadowed;
        let calls = Call::some(&mut rng, screen, kind);
        match round % 2 {
            0 => hang_on_nothing_else::<Gouraud<Rgb888>>(&mut rng, screen, &calls, depth),
            _ => hang_on_nothing_else::<Textured<Rgb565Be>>(&mut rng, screen, &calls, depth),
        }
    }
}
