//! Whole triangles: their texels against exact perspective, and what is refused.

use super::super::mapping::{Corner, Mapping, Method, Values, is_affine, texels_of};
use super::{WRAPS, coordinates, draw_mapped, off};
use crate::geometry::{Faces, Mesh};
use crate::look::{Fill, Look, Place, Primitive};
use crate::num::random::Rng;
use crate::scene::{Budget, Draw, DrawState, Draws, Master, NONE, Object, Skin, Texture, Wrap};
use crate::span::{Frame, Triangle};
use std::vec::Vec;

/// A triangle of so many pixels each way, and so many texels, clockwise, at random.
pub(super) fn some_triangle(rng: &mut Rng, pixels: f64, texels: f64) -> Option<[Corner; 3]> {
    let spread = f64::from(1 << 27) * 0.9 * rng.unit().powi(5);
    let mut axis = |size: f64, from: f64| (size * f64::from(rng.signed()) + from) as i32;
    let middle = [axis(80_000.0, 0.0) * 256, axis(200.0, 0.0) * 256];
    let mut corner = || Corner {
        x: axis(pixels * 32.0, 64.0 * 150.0),
        y: axis(pixels * 32.0, 64.0 * 100.0),
        depth: axis(spread, f64::from(1 << 27)) as u32,
        texel: middle.map(|m| (m + axis(texels * 128.0, 0.0)) << 6),
    };
    let c = [corner(), corner(), corner()];
    let d = |i: usize| (i64::from(c[i].x - c[0].x), i64::from(c[i].y - c[0].y));
    let area = d(1).0 * d(2).1 - d(2).0 * d(1).1;
    (area > 1 << 14).then_some(c)
}

/// The picture of triangles.
pub(super) const FRAME: Frame = Frame {
    width: 320,
    height: 240,
};

/// A triangle of three vertices.
pub(super) const OBJECT: Object = Object {
    corner: [0, 1, 2],
    next: NONE,
};

/// The state of a draw call with a texture, or without.
pub(super) fn state_of<'t>(texture: Option<&'t Texture<'t>>, budget: Budget) -> DrawState<'t> {
    let mesh = Mesh::<i16> {
        positions: &[],
        normals: &[],
        colours: &[],
        faces: Faces::Triangles(&[]),
    };
    let call = Draw {
        texture: texture.map(|texture| Skin {
            texture,
            places: &[],
            budget,
        }),
        ..Draw::new(mesh)
    };
    DrawState::new(0, &call, Master::ALL)
}

/// A triangle of the first draw call, set up by a look.
pub(super) fn set_up<L: Look>(triangle: &Triangle<'_>, draws: &Draws<'_>) -> (Fill, L::Planes) {
    let (area, mut planes) = (triangle.area(), L::EMPTY);
    let of = Primitive {
        triangle,
        object: 0,
        size: triangle.size(area),
        area,
        draws,
    };
    (L::set_up(&of, &mut planes), planes)
}

/// A span of so many pixels.
fn span(column: u32, pixels: usize, line: u32) -> Place {
    Place {
        span: column,
        end: column.wrapping_add(pixels as u32),
        column,
        line,
    }
}

/// The place at a pixel in exact perspective, if its centre is inside.
pub(super) fn inside(c: &[Corner; 3], column: i32, line: i32) -> Option<[f64; 2]> {
    let (x, y) = (64 * column, 64 * line);
    let edge = |a: &Corner, b: &Corner| {
        i64::from(b.x - a.x) * i64::from(y - a.y) - i64::from(b.y - a.y) * i64::from(x - a.x)
    };
    let weights = [edge(&c[1], &c[2]), edge(&c[2], &c[0]), edge(&c[0], &c[1])];
    if weights.iter().any(|&w| w < 0) {
        return None;
    }
    let w = [0, 1, 2].map(|i| weights[i] as f64 * f64::from(c[i].depth));
    let sum: f64 = w.iter().sum();
    let of = |axis: usize| -> f64 {
        let at = |i: usize| w[i] * f64::from(c[i].texel[axis]) / 16_384.0;
        (at(0) + at(1) + at(2)) / sum
    };
    Some([of(0), of(1)])
}

#[test]
fn triangles_show_the_texels_of_exact_perspective_within_the_budget() {
    let words = coordinates();
    let mut rng = Rng(11);
    let mut methods = [0; 3];
    let mut worst = 0f64;
    for i in 0..4000 {
        let pixels = [12.0, 24.0, 60.0, 300.0][i % 4];
        let texels = 600.0 * rng.unit().powi(3) + 1.0;
        let Some(corners) = some_triangle(&mut rng, pixels, texels) else {
            continue;
        };
        let (wrap, budget) = (
            WRAPS[i / 4 % 3],
            [
                Budget::FAST,
                Budget::new(32),
                Budget::BALANCED,
                Budget::EXACT,
            ][i % 7 % 4],
        );
        let texture = Texture::words(&words, 256, 256).unwrap().wrapping(wrap);
        let mapping = Mapping::new(&corners, &texture, budget).unwrap();
        methods[mapping.method as usize] += 1;
        for line in (0..240).step_by(if pixels < 30.0 { 1 } else { 7 }) {
            let columns: Vec<_> = (0..320)
                .filter(|&x| inside(&corners, x, line).is_some())
                .collect();
            let (Some(&first), Some(&last)) = (columns.first(), columns.last()) else {
                continue;
            };
            let mut run = std::vec![0; (last - first) as usize + 1];
            let place = span(first as u32, run.len(), line as u32);
            draw_mapped(&mapping, &mut run, place, &texture, budget);
            for (x, &texel) in (first..).zip(&run) {
                let [u, v] = inside(&corners, x, line).unwrap();
                let off = off(u, texel, wrap).max(off(v, texel >> 8, wrap));
                // Planes of a word and those of any size, and the reciprocal.
                let bound = f64::from(budget.texels()) / 256.0 + 0.012;
                worst = worst.max(off - bound);
                assert!(
                    off <= bound,
                    "{x} {line}: {off} {budget:?} {wrap:?} {mapping:?} {corners:?}"
                );
            }
        }
    }
    assert!(methods.iter().all(|&n| n > 100), "{methods:?}");
    assert!(worst > -0.02, "the bound is loose: {worst}");
}

/// Kills: a base that has no room for the farthest places, in which a clamped texture is another than one that repeats.
#[test]
fn the_far_end_of_a_clamped_texture_is_reached_and_stays_beyond_it() {
    const LAST: u16 = (Texture::MAX_SIDE - 1) as u16;
    let words: Vec<u16> = (0..=LAST).collect();
    let texture = Texture::words(&words, Texture::MAX_SIDE, 1).unwrap();
    let texture = texture.wrapping(Wrap::Clamp);
    for (first, want) in [
        (i32::from(LAST) - 300, None),
        (-3900, Some(0)),
        (6000, Some(LAST)),
        (65_000, Some(LAST)),
        (98_000, Some(LAST)),
        (-66_000, Some(0)),
        (-131_000, Some(0)),
    ] {
        let corners = right_angle(512, 1 << 20).map(|corner| Corner {
            texel: [(first << 14) + corner.texel[0] * 30, 0],
            ..corner
        });
        let mapping = Mapping::new(&corners, &texture, Budget::EXACT).unwrap();
        let mut run = [0; 7];
        draw_mapped(
            &mapping,
            &mut run,
            span(100, 7, 100),
            &texture,
            Budget::EXACT,
        );
        for (x, &got) in (100..).zip(&run) {
            let [u, _] = inside(&corners, x, 100).unwrap();
            let want = want.unwrap_or(u as u16);
            assert!(got.abs_diff(want) <= 1, "{first} {x}: {got} {want}");
        }
    }
}

/// A triangle with its right angle at the first corner, 8 pixels high and so wide, a texel a pixel; the second corner
/// is so much nearer.
fn right_angle(width: i32, nearer: u32) -> [Corner; 3] {
    [[0, 0], [width, 0], [0, 512]].map(|[x, y]| Corner {
        x: 6400 + x,
        y: 6400 + y,
        depth: (1 << 27) + u32::from(x > 0) * nearer,
        texel: [x << 8, y << 8],
    })
}

/// Kills: other sizes up to which both places go in one word, and other lengths of a run in words.
#[test]
fn what_a_word_is_taken_for_ends_where_its_steps_would_err_more() {
    let words = coordinates();
    let of = |log: u32, width: i32, nearer: u32| {
        let side = 1 << log;
        let texels = &words[..1 << (2 * log)];
        let texture = Texture::words(texels, side, side).unwrap();
        Mapping::new(&right_angle(width, nearer), &texture, Budget::FAST).unwrap()
    };
    for (log, pixels) in [(8, 25), (7, 50), (5, 50)] {
        let within = of(log, 64 * pixels - 1, 0);
        assert_eq!(within.method, Method::Word, "{log}");
        assert_ne!(of(log, 64 * pixels, 0).method, Method::Word, "{log}");
    }
    for (log, pixels) in [(8, 16), (7, 32), (6, 64), (5, 64)] {
        let mapping = of(log, 64 * 250, 1 << 22);
        assert_eq!(mapping.quick, pixels + 1, "{log} {mapping:?}");
    }
}

/// What a line is reckoned to cost hangs on it (X9). Kills: long spans, exact budgets, what does not repeat or indices
/// that are drawn at one go.
#[test]
fn what_is_drawn_at_one_go_is_known_by_its_pixels() {
    let words = coordinates();
    let bytes = [0; 1 << 14];
    let texture = Texture::words(&words, 256, 256).unwrap();
    let indices = Texture::index8(&bytes, &[0; 256], 128, 128).unwrap();
    let of = |texture: &Texture<'_>, budget| {
        Mapping::new(&right_angle(64 * 250, 1 << 22), texture, budget).unwrap()
    };
    let mapping = of(&texture, Budget::FAST);
    let most = u32::from(mapping.reach.arc);
    assert!(most > u32::from(mapping.quick) && mapping.quick > 0);
    let are_quick = [1, most, most + 1].map(|pixels| mapping.is_quick(pixels, true));
    assert_eq!(are_quick, [true, true, false]);
    for (texture, budget) in [
        (texture, Budget::EXACT),
        (texture.wrapping(Wrap::Mirror), Budget::FAST),
        (indices, Budget::FAST),
    ] {
        assert!(!of(&texture, budget).is_quick(1, true));
    }
}

#[test]
fn what_is_wider_than_4096_texels_or_has_no_depth_is_refused() {
    let words = coordinates();
    let texture = Texture::words(&words, 256, 256).unwrap();
    let corner = |x, y, u: i32| Corner {
        x,
        y,
        depth: 1 << 20,
        texel: [u, 0],
    };
    let far = 1 << 30;
    let of = |width: i32| {
        [
            corner(0, 0, far),
            corner(6400, 0, far + width),
            corner(0, 6400, far),
        ]
    };
    let values = |c: &[Corner; 3]| Values::new(c, &texture, Budget::FAST);
    let most = 4096 << 14;
    for way in [most - 1, most, -most] {
        let [a, b, _] = values(&of(way)).unwrap().of[0];
        let rise = (i64::from(b) - i64::from(a)) >> 5;
        // At the limit brought nearer, so that a rise has 32 bits.
        assert_eq!(rise, i64::from(way.clamp(1 - most, most - 1)));
    }
    assert!(values(&of(most + 1)).is_none() && values(&of(-1 - most)).is_none());
    let mut none = of(1 << 14);
    none[1].depth = 0;
    assert!(values(&none).is_none());
    // Thin: values, and no planes.
    let thin = [
        corner(0, 0, 0),
        corner(64, 64, 1 << 14),
        corner(128, 128, 2 << 14),
    ];
    let mut none = Mapping::EMPTY;
    let planes = |v: Values| v.planes(&thin, FRAME, &texture, Budget::FAST, &mut none);
    assert_eq!(values(&thin).map(planes), Some(None));
}

/// u/w, v/w and 1/w share the triangle's exponent, which cancels (H1, H3): at any distance, places at the corners are those
/// of the corners.
///
/// Kills: a shift by the exponent of each corner's own 1/w, none at all, u/w by half of 1/w.
#[test]
fn corners_share_an_exponent() {
    let words = coordinates();
    let texture = Texture::words(&words, 256, 256).unwrap();
    let mut rng = Rng(16);
    let mut seen = 0;
    for i in 0..60_000 {
        let far = i % 24;
        let ratio = [1.3, 3.0, 60.0][i / 24 % 3];
        let wide = [60.0, 1000.0, 4000.0][i / 72 % 3];
        let base = f64::from(rng.signed()) * 8000.0;
        let corners = [(); 3].map(|()| Corner {
            x: 0,
            y: 0,
            depth: (0.999 * 2f64.powi(31 - far as i32) / (1.0 + (ratio - 1.0) * rng.unit())) as u32,
            texel: [base + rng.unit() * wide, rng.unit() * 50.0].map(|t| (t * 16_384.0) as i32),
        });
        let Some(values) = Values::new(&corners, &texture, Budget::EXACT) else {
            panic!("{corners:?}");
        };
        if values.method != Method::Perspective {
            continue;
        }
        seen += 1;
        let q = values.of[2];
        let most = q.iter().max().unwrap();
        assert!((1 << 29..1 << 30).contains(most), "{q:?}");
        let nearest = corners.map(|c| c.depth).into_iter().max().unwrap();
        for (q, corner) in q.into_iter().zip(&corners) {
            let want = f64::from(corner.depth) / f64::from(nearest) * f64::from(*most);
            assert!((f64::from(q) - want).abs() <= 1.0, "one unit for all");
        }
        for (corner, i) in corners.iter().zip(0..) {
            let [s, t] = [0, 1].map(|axis| values.of[axis][i]);
            let place = super::Homogeneous {
                q: q[i] as u32,
                s,
                t,
            }
            .place();
            for (axis, got) in [place.u, place.v].into_iter().enumerate() {
                let got = f64::from(got) / f64::from(1 << 19);
                let want = f64::from(corner.texel[axis]) / 16_384.0
                    - f64::from(texels_of(values.base)[axis]);
                // The reciprocal's, and a unit of u/w, of which 1/w has the fewest at the farthest corner.
                let bound = want.abs() / 32_768.0 + 2.0 * 2048.0 / f64::from(q[i]) + 0.001;
                assert!((got - want).abs() <= bound, "{corners:?}: {got} {want}");
            }
        }
    }
    assert!(seen > 40_000, "{seen}");
}

#[test]
fn affine_is_what_the_bound_allows() {
    let mut rng = Rng(12);
    let (mut yes, mut doubt) = (0, 0);
    for _ in 0..200_000 {
        let width = rng.below(1 << 20) >> rng.below(18) << 6;
        let most = 1 + (rng.bits() >> 1 >> rng.below(20));
        let depth = [
            most,
            most,
            (f64::from(most) * 1.2f64.powf(-rng.unit())) as u32 + 1,
        ];
        let least = f64::from(depth[2].min(most));
        let budget = Budget::new([32, 64, 128, 40_000][(width / 64 % 4) as usize]);
        let is = f64::from(width) / 64.0 * (f64::from(depth[2].max(most)) - least);
        let may = 4.0 * f64::from(budget.for_curves()) * least;
        let got = is_affine(width, depth, budget);
        assert!(is <= may || !got, "{width} {depth:?}");
        doubt += u32::from(is <= may && !got);
        yes += u32::from(got);
    }
    assert!(yes > 20_000 && doubt * 100 < yes, "{yes} {doubt}");
}

#[test]
fn any_numbers_are_drawn_without_a_panic() {
    let words = coordinates();
    let mut rng = Rng(15);
    let mut run = [0; 77];
    for i in 0..60_000 {
        let few = 1 << rng.below(9);
        let texture = Texture::words(&words, few, 1 << rng.below(8)).unwrap();
        let texture = texture.wrapping(WRAPS[i % 3]);
        let mut bits = || rng.bits() >> (rng.bits() >> 27);
        let mut corner = || Corner {
            x: bits() as i32,
            y: bits() as i32,
            depth: bits(),
            texel: [bits() as i32, bits() as i32],
        };
        let corners = [corner(), corner(), corner()];
        let budget = Budget::new(bits() as u16);
        let mut mapping = Mapping::new(&corners, &texture, budget).unwrap_or(Mapping::EMPTY);
        let pixels = bits() as usize % run.len();
        let at = span(bits(), pixels, bits());
        draw_mapped(&mapping, &mut run[..pixels], at, &texture, budget);
        for method in [Method::Word, Method::Wide, Method::Perspective] {
            mapping.method = method;
            mapping.planes = [(); 3].map(|()| [bits(), bits(), bits()]);
            mapping.base = [bits() as i16, bits() as i16];
            draw_mapped(&mapping, &mut run[..pixels], at, &texture, budget);
        }
    }
}
