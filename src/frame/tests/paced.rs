//! Lines that cost no more than they may (X9).

use super::{Crowd, Seen, WIDE, WIDTH, lines, with_scene};
use crate::frame::{FastMemory, LineError, Memory, Pace, Paid, Renderer};
use crate::link::Link;
use crate::look::{Gouraud, Look, Textured, WordOf};
use crate::num::random::Rng;
use crate::pixel::{PixelFormat, Rgb565, Rgb888};
use crate::scene::{Scene, Texture};
use std::boxed::Box;
use std::vec::Vec;

/// Costs that leave nothing out.
const FREE: Pace = Pace {
    most: u32::MAX,
    ..PACE
};

const PACE: Pace = Pace {
    most: 3_000,
    line: 100,
    column: 2,
    begin: 30,
    large: 40,
    turn: 10,
    span: 5,
    word: 1,
    step: 1,
    pair: 40,
    run: 20,
    pixel: 2,
};

/// The lines of a picture in this order, what they paid, and what the cache did.
struct Drawn<W> {
    lines: Vec<Vec<W>>,
    paid: Paid,
    spilled: u32,
}

fn paced<L: Look>(
    scene: &Scene<'_, '_, L>,
    slots: u16,
    pace: Pace,
    order: &[u16],
) -> Drawn<WordOf<L>> {
    let mut cache = Box::new(FastMemory::<L, 7>::new());
    cache.set_limit(slots);
    let mut links = std::vec![Link::NONE; scene.objects()];
    let mut depth = [0; WIDTH as usize];
    let memory = Memory {
        cache: &mut cache,
        links: &mut links,
        depth: &mut depth,
    };
    let mut renderer = Renderer::new(memory).paced(pace);
    let background = L::Pixel::from_rgb8([9, 9, 9]);
    let line = |&line: &u16| {
        let mut pixels = std::vec![WordOf::<L>::default(); WIDTH.into()];
        let drawn = renderer.draw_line(scene, line, &mut pixels, background);
        drawn.unwrap();
        pixels
    };
    let lines = order.iter().map(line).collect();
    Drawn {
        lines,
        paid: renderer.paid(),
        spilled: renderer.counts().spilled,
    }
}

fn all() -> Vec<u16> {
    (0..WIDE.height).collect()
}

/// Calls `see` with scenes of few and of many triangles, some by priority.
fn each_scene<L: Look>(
    texture: Option<&Texture<'_>>,
    seed: u64,
    mut see: impl FnMut(&Scene<'_, '_, L>, &mut Rng),
) {
    let mut rng = Rng(seed);
    for round in 0..24 {
        let count = [2, 8, 30, 80][round % 4];
        let ranked = round % 8 > 5;
        let crowds = [2, 1].map(|p| Crowd::new(&mut rng, count, if ranked { p } else { 0 }));
        with_scene::<L>(WIDE, &crowds, texture, |scene| see(scene, &mut rng));
    }
}

fn texels() -> Vec<u16> {
    (0..64 * 64).map(|i: u16| i.wrapping_mul(37)).collect()
}

fn differing<W: PartialEq>(a: &[W], b: &[W]) -> u32 {
    a.iter().zip(b).filter(|(a, b)| a != b).count() as u32
}

fn time_enough<L: Look>(texture: Option<&Texture<'_>>, seed: u64)
where
    WordOf<L>: PartialEq,
{
    each_scene::<L>(texture, seed, |scene, _| {
        let (want, missed) = lines(scene, 224, true, &all());
        assert_eq!(missed, 0);
        let got = paced(scene, 224, FREE, &all());
        assert!(got.lines == want);
        let dearest = got.paid.dearest;
        let want = Paid {
            dearest,
            ..Paid::default()
        };
        assert_eq!((got.paid, got.spilled), (want, 0));
    });
}

/// Kills: of equal depths the triangle submitted first is seen; depths compared where spans do not meet alone; runs
/// coloured from their own start.
#[test]
fn with_time_enough_pictures_are_the_same() {
    let words = texels();
    let texture = Texture::words(&words, 64, 64).unwrap();
    time_enough::<Textured<Rgb565>>(Some(&texture), 151);
    time_enough::<Gouraud<Rgb888>>(None, 152);
}

/// Kills: pixels that are not counted where spans are left out, have one colour, or join what is left of them.
#[test]
fn no_more_pixels_differ_than_were_paid() {
    let mut sums = [0; 5];
    for most in [0, 400, 700, 1_000, 1_500, 2_000, 3_000, 6_000] {
        // Nothing begins late.
        let pace = Pace {
            most,
            begin: 0,
            large: 0,
            turn: 0,
            ..PACE
        };
        each_scene::<Gouraud<Rgb888>>(None, 153, |scene, _| {
            let (want, _) = lines(scene, 224, true, &all());
            let Drawn { lines, paid, .. } = paced(scene, 224, pace, &all());
            assert_eq!((paid.late, paid.lost), (0, 0));
            let off: Vec<u32> = lines
                .iter()
                .zip(&want)
                .map(|(a, b)| differing(a, b))
                .collect();
            let (pixels, lines) = (off.iter().sum(), off.iter().filter(|&&n| n > 0).count());
            assert!(
                paid.even + paid.joined + paid.unsorted + paid.left_out >= pixels,
                "{most}: {paid:?}, {pixels}"
            );
            assert!(paid.lines >= lines as u32, "{most}: {paid:?}, {lines}");
            for (sum, part) in
                sums.iter_mut()
                    .zip([paid.even, paid.joined, paid.unsorted, paid.left_out, pixels])
            {
                *sum += part;
            }
        });
    }
    std::println!("{sums:?}");
    assert!(sums.iter().all(|&sum| sum > 5_000), "{sums:?}");
}

/// Kills: what is left for pixels goes on to what begins; waiting triangles that are forgotten where a line is passed over.
#[test]
fn lines_in_any_order_pay_the_same() {
    let (mut late, mut lost) = (0, 0);
    for most in [400, 700, 1_500, 3_000] {
        each_scene::<Gouraud<Rgb888>>(None, 154, |scene, rng| {
            for slots in [2, 20, 224] {
                let pace = Pace { most, ..PACE };
                let want = paced(scene, slots, pace, &all());
                let some: Vec<u16> = (0..30)
                    .map(|_| rng.below(WIDE.height.into()) as u16)
                    .collect();
                let got = paced(scene, slots, pace, &some);
                let same = some
                    .iter()
                    .zip(&got.lines)
                    .all(|(&y, l)| *l == want.lines[usize::from(y)]);
                assert!(same, "{most}, {slots} slots");
                (late, lost) = (late + want.paid.late, lost + want.paid.lost);
            }
        });
    }
    std::println!("{late} {lost}");
    assert!(late > 1_000 && lost > 100, "{late}, {lost}");
}

/// Kills: a triangle that waited begins with the sides of its first line; lines on which one waits are not counted.
#[test]
fn what_waits_for_a_line_is_drawn_below() {
    let mut waited = 0;
    each_scene::<Gouraud<Rgb888>>(None, 155, |scene, _| {
        let (want, _) = lines(scene, 224, true, &all());
        // Eight begin on a line.
        let pace = Pace {
            most: 150_000,
            begin: 9_000,
            large: 9_000,
            column: 0,
            line: 0,
            ..PACE
        };
        let Drawn { lines, paid, .. } = paced(scene, 224, pace, &all());
        if paid.late > 0 && paid.lost == 0 {
            let off = lines.iter().zip(&want).filter(|(a, b)| a != b).count() as u32;
            assert!(off <= paid.lines, "{off}: {paid:?}");
            assert_eq!(lines.last(), want.last());
            waited += 1;
        }
    });
    assert!(waited > 3, "{waited}");
}

/// Triangles that face the eye, all as far away, by the columns and lines of their corners, about.
fn facing(corners: &[[[i32; 2]; 3]]) -> Crowd {
    let mut rng = Rng(157);
    let mut crowd = Crowd::new(&mut rng, corners.len() as u16, 0);
    for (position, at) in crowd.positions.iter_mut().zip(corners.as_flattened()) {
        // A pixel is 2.2 / 60 wide.
        let across = |pixels: i32| (pixels * 601) as i16;
        *position = [across(at[0] - 48), across(20 - at[1]), 0];
    }
    crowd
}

const LEFT: [[i32; 2]; 3] = [[4, 2], [44, 36], [4, 38]];
const RIGHT: [[i32; 2]; 3] = [[52, 2], [92, 36], [52, 38]];

/// Kills: of spans as near as each other the one in the later slot is seen, as what is as near as a span is far is not
/// compared with it.
#[test]
fn of_triangles_that_are_as_near_the_first_is_seen() {
    let below = LEFT.map(|[x, y]| [x + 9, y + 1]);
    for triangles in [[LEFT, below], [below, LEFT]] {
        with_scene::<Gouraud<Rgb888>>(WIDE, &[facing(&triangles)], None, |scene| {
            let (want, _) = lines(scene, 224, true, &all());
            assert!(paced(scene, 224, FREE, &all()).lines == want);
        });
    }
}

/// Kills: triangles that cannot turn are not counted, or turn all the same.
#[test]
fn triangles_that_cannot_turn_are_lost() {
    let turning = |[a, b, _]: [[i32; 2]; 3]| [a, [b[0], 20], [a[0], 38]];
    let crowds = [facing(&[turning(LEFT), turning(RIGHT)])];
    let pace = Pace {
        turn: 50_000,
        most: 40_000,
        ..PACE
    };
    with_scene::<Gouraud<Rgb888>>(WIDE, &crowds, None, |scene| {
        let (want, _) = lines(scene, 224, true, &all());
        let Drawn { lines, paid, .. } = paced(scene, 224, pace, &all());
        assert_eq!(paid.lost, 2);
        assert!(lines[..19] == want[..19]);
        let empty = [Rgb888::from_rgb8([9; 3]); WIDTH as usize];
        assert!(want[30] != empty && lines[30] == empty);
    });
}

/// Kills: nothing begins above its first line, or is seen there; two begin in one slot; a slot stays withheld; begun triangles
/// are said to wait; lines without triangles leave as much as others; lines behind the last have triangles.
#[test]
fn what_begins_on_one_line_has_begun_above_it() {
    let row =
        |from: i32| (0..24).map(move |i| [[4 * i, from], [4 * i + 4, from], [4 * i, from + 6]]);
    let tiles: Vec<_> = row(12).chain(row(26)).collect();
    // Four begin on a line.
    let pace = Pace {
        most: 4_150,
        begin: 1_000,
        large: 1_000,
        column: 0,
        line: 0,
        ..PACE
    };
    with_scene::<Gouraud<Rgb888>>(WIDE, &[facing(&tiles)], None, |scene| {
        let (want, _) = lines(scene, 224, true, &all());
        let empty = |line: usize| want[line] == want[0];
        assert!(empty(11) && !empty(13) && empty(25) && !empty(27));
        let Drawn { lines, paid, .. } = paced(scene, 24, pace, &all());
        assert!(lines == want, "{paid:?}");
        let dearest = paid.dearest;
        let free = Paid {
            dearest,
            ..Paid::default()
        };
        assert_eq!(paid, free);
        // A line on which nothing is takes most of what it may where there are some below, and else nothing.
        for (line, dearest) in [(10, 4_000), (39, 0)] {
            let paid = paced(scene, 24, pace, &[line]).paid;
            assert_eq!((paid.lines, paid.dearest), (0, dearest));
        }
    });
}

/// Kills: what begins below is paid for by what is seen.
#[test]
fn what_is_seen_comes_before_what_begins_below() {
    let tile = |i: i32| [[52 + 12 * i, 20], [60 + 12 * i, 20], [52 + 12 * i, 34]];
    // A line with the large one can pay for one that begins.
    let pace = Pace {
        most: 3_600,
        begin: 1_000,
        large: 1_000,
        pixel: 50,
        column: 0,
        line: 0,
        ..PACE
    };
    let triangles = [LEFT, tile(0), tile(1), tile(2)];
    with_scene::<Gouraud<Rgb888>>(WIDE, &[facing(&triangles)], None, |scene| {
        let paid = paced(scene, 224, pace, &all()).paid;
        let want = Paid {
            late: 2,
            lines: 2,
            dearest: paid.dearest,
            ..Paid::default()
        };
        assert_eq!(paid, want);
    });
}

/// Kills: a triangle that is given up before its first line is drawn from there on all the same, or keeps its slot.
#[test]
fn what_is_given_up_ahead_is_not_drawn() {
    let seen = Seen { height: 64, ..WIDE };
    // The lines of such a picture are 12 more. As the block from 32 on begins, the first is to turn, and not yet on a line.
    let turns = [[4, 22], [44, 50], [4, 51]];
    let below = [[4, 34], [44, 34], [4, 48]];
    let pace = Pace {
        turn: 50_000,
        most: 40_000,
        ..PACE
    };
    with_scene::<Gouraud<Rgb888>>(seen, &[facing(&[turns, below])], None, |scene| {
        let all: Vec<u16> = (0..64).collect();
        let (want, _) = lines(scene, 224, true, &all);
        let Drawn { lines, paid, .. } = paced(scene, 1, pace, &all);
        assert_eq!(paid.lost, 1);
        assert!(lines[..46].iter().all(|line| *line == want[0]));
        assert!(want[40] != want[0] && lines[50] != want[0]);
    });
}

/// Kills: an even run has the colour of its first pixel; all runs of a class are even where one has to be, or none is.
#[test]
fn runs_are_even_where_the_line_cannot_pay_for_them() {
    let crowds = [facing(&[LEFT, RIGHT])];
    // A run and a half of 20 pixels.
    let pace = Pace {
        most: 3_000,
        line: 0,
        column: 0,
        begin: 0,
        large: 0,
        turn: 0,
        span: 0,
        word: 0,
        run: 0,
        pixel: 100,
        ..PACE
    };
    let mut seen = 0;
    with_scene::<Gouraud<Rgb888>>(WIDE, &crowds, None, |scene| {
        let (want, _) = lines(scene, 224, true, &all());
        let got = paced(scene, 224, pace, &all()).lines;
        for (want, got) in want.iter().zip(&got) {
            // Both begin in column 4 of their half.
            let [width, other] = [&want[..48], &want[48..]]
                .map(|half| half.iter().filter(|&&w| w != want[0]).count());
            if other != width || !(16..29).contains(&width) {
                continue;
            }
            let [left, right] = [0, 48].map(|half| {
                let (want, got) = (&want[half..][..48], &got[half..][..48]);
                let middle = want[4 + width / 2];
                let is_even = got[4..][..width].iter().all(|&w| w == middle);
                assert!(want[4..][..width].iter().any(|&w| w != middle));
                assert!(is_even || got == want);
                is_even
            });
            assert!(left != right, "{width}");
            seen += 1;
        }
    });
    assert!(seen > 5, "{seen}");
}

#[test]
fn what_a_paced_renderer_does_not_do_is_refused() {
    let mut rng = Rng(156);
    let crowd = [Crowd::new(&mut rng, 3, 0)];
    with_scene::<Gouraud<Rgb565>>(WIDE, &crowd, None, |scene| {
        let mut cache = FastMemory::<Gouraud<Rgb565>, 1>::new();
        let mut links = std::vec![Link::NONE; scene.objects()];
        for cells in [0, 95, 96] {
            let mut depth = std::vec![0; cells];
            let memory = Memory {
                cache: &mut cache,
                links: &mut links,
                depth: &mut depth,
            };
            let renderer = Renderer::new(memory).paced(PACE);
            let short = LineError::Depth {
                needed: 96,
                have: cells,
            };
            let want = if cells < 96 { Err(short) } else { Ok(()) };
            assert_eq!(renderer.check(scene), want);
            if cells == 96 {
                let renderer = renderer.fetching(100);
                assert_eq!(renderer.check(scene), Err(LineError::Paced));
            }
        }
    });
}
