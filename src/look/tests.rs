//! Textured looks against plain references: f64, or integers of any width.

mod dear;
mod ends;
mod runs;
mod shades;
mod triangles;

use super::Place;
use super::fetch::{FRACTION, Uv, Way, copy, copy_exact, copy_wide};
use super::mapping::Mapping;
use super::perspective::{Homogeneous, Perspective, Within};
use super::stride::stride_within;
use crate::num::random::Rng;
use crate::scene::{Bent, Budget};
use crate::scene::{Texture, TextureError, Wrap};
use std::vec::Vec;

/// Texels of all forms, the larger ones not to be told from each other by chance alone.
struct Texels {
    words: Vec<u16>,
    bytes: Vec<u8>,
}

impl Texels {
    fn new() -> Self {
        let mut rng = Rng(5);
        Self {
            words: (0..1 << 20).map(|_| rng.bits() as u16).collect(),
            bytes: (0..1 << 20).map(|_| rng.bits() as u8).collect(),
        }
    }

    fn texture(&self, form: u32, sides: [u32; 2]) -> Texture<'_> {
        let ([width, height], bytes, palette) = (sides, &self.bytes, &self.words);
        match form {
            0 => Texture::words(&self.words, width, height),
            1 => Texture::index8(bytes, palette, width, height),
            2 => Texture::index4(bytes, palette, width, height),
            3 => Texture::index2(bytes, palette, width, height),
            4 => Texture::index1(bytes, palette, width, height),
            _ => Texture::computed(&Named, width, height),
        }
        .unwrap()
    }

    /// The texel at a column and row of a texture.
    fn texel(&self, form: u32, width: u32, [column, row]: [u32; 2]) -> u16 {
        let i = (row * width + column) as usize;
        if form == 5 {
            return name(column, row);
        }
        let bits = [16, 8, 4, 2, 1][form as usize];
        if form == 0 {
            return self.words[i];
        }
        let byte = u32::from(self.bytes[i * bits / 8]);
        let index = byte >> (i * bits % 8) & ((1 << bits) - 1);
        self.words[index as usize]
    }
}

/// A word for a column and row.
fn name(column: u32, row: u32) -> u16 {
    ((column * 641) ^ (row * 5003)) as u16
}

/// A computed texture, whose texels are those words.
struct Named;

impl crate::scene::Texels for Named {
    fn texel(&self, column: u16, row: u16) -> u16 {
        name(column.into(), row.into())
    }
}

/// The column or row that a wrap shows for any texel, by its words.
fn folded(texel: i64, side: u32, wrap: Wrap) -> u32 {
    let side = i64::from(side);
    let at = match wrap {
        Wrap::Repeat => texel.rem_euclid(side),
        Wrap::Clamp => texel.clamp(0, side - 1),
        Wrap::Mirror => {
            let at = texel.rem_euclid(2 * side);
            at.min(2 * side - 1 - at)
        }
    };
    at as u32
}

const WRAPS: [Wrap; 3] = [Wrap::Repeat, Wrap::Clamp, Wrap::Mirror];

/// Sides from 1 to `1 << most`, and a form.
fn some_texture(rng: &mut Rng, most: u32) -> (u32, [u32; 2]) {
    let mut side = || 1 << rng.below(most + 1);
    let sides = [side(), side()];
    (rng.below(6), sides)
}

#[test]
fn what_was_not_lent_is_an_error() {
    static WORDS: [u16; 64] = [7; 64];
    static EIGHT: Texture<'_> = match Texture::words(&WORDS, 8, 8) {
        Ok(texture) => texture.wrapping(Wrap::Mirror),
        Err(_) => panic!("8 x 8"),
    };
    assert_eq!(
        (EIGHT.width(), EIGHT.height(), EIGHT.wrap()),
        (8, 8, Wrap::Mirror)
    );
    let bytes = [0u8; 8];
    for (width, height) in [(0, 8), (8, 0), (3, 8), (8, 2048), (1 << 31, 1)] {
        let want = TextureError::Side { width, height };
        assert_eq!(Texture::words(&WORDS, width, height).unwrap_err(), want);
        assert_eq!(
            Texture::index1(&bytes, &WORDS, width, height).unwrap_err(),
            want
        );
    }
    let (needed, have) = (128, 64);
    let error = Texture::words(&WORDS, 16, 8).unwrap_err();
    assert_eq!(error, TextureError::Words { needed, have });
    assert_eq!(
        std::format!("{error}"),
        "texture: 128 words are needed, there are 64"
    );
    let have = 8;
    let error = Texture::index8(&bytes, &WORDS, 4, 4).unwrap_err();
    assert_eq!(error, TextureError::Bytes { needed: 16, have });
    assert!(Texture::index4(&bytes, &WORDS, 4, 4).is_ok());
    let error = Texture::index4(&bytes, &WORDS[..15], 4, 4).unwrap_err();
    assert_eq!(
        error,
        TextureError::Palette {
            needed: 16,
            have: 15
        }
    );
    assert!(Texture::index1(&bytes[..1], &WORDS[..2], 1, 1).is_ok());
    assert!(Texture::index2(&bytes[..1], &WORDS[..4], 2, 4).is_err());
}

#[test]
fn places_in_a_word_show_their_texels() {
    let (texels, mut rng) = (Texels::new(), Rng(6));
    for i in 0..6000 {
        let (mut form, mut sides) = some_texture(&mut rng, 8);
        if i % 2 == 0 {
            // The loops of squares.
            (form, sides) = (0, [32 << (i / 2 % 4); 2]);
        }
        let texture = texels.texture(form, sides);
        let (mut at, step) = (rng.bits(), rng.bits());
        let mut run = std::vec![0; rng.below(400) as usize];
        copy(&mut run, &texture, at, step);
        for (x, &got) in run.iter().enumerate() {
            let column = ((at & 0xFFFF) * sides[0]) >> 16;
            let row = ((u64::from(at) * u64::from(sides[1])) >> 32) as u32;
            let want = texels.texel(form, sides[0], [column, row]);
            assert_eq!(got, want, "pixel {x} of {form} {sides:?}");
            at = at.wrapping_add(step);
        }
    }
}

/// A way whose `pixels` places stay within 4096 texels of the base.
fn some_way(rng: &mut Rng, pixels: usize) -> Way {
    let reach = 1 << (30 - rng.below(16));
    let mut axis = || {
        let [from, to] = [(); 2].map(|()| rng.bits() as i32 % reach);
        [from, (to - from) / pixels as i32]
    };
    let ([u, du], [v, dv]) = (axis(), axis());
    Way {
        base: [(); 2].map(|()| (rng.bits() as i32) >> (11 + rng.below(18))),
        at: Uv { u, v },
        step: Uv { u: du, v: dv },
    }
}

/// Whether a texel is right, 1/10 texel off at most where that is allowed.
fn shows(got: u16, place: [i64; 2], may_be_off: bool, want: impl Fn([i64; 2]) -> u16) -> bool {
    let off = if may_be_off { (1 << FRACTION) / 10 } else { 0 };
    let texel = |d: [i64; 2]| [0, 1].map(|i| (place[i] + d[i]) >> FRACTION);
    [[0, 0], [-off, 0], [off, 0], [0, -off], [0, off]]
        .into_iter()
        .chain([[-off, -off], [-off, off], [off, -off], [off, off]])
        .any(|d| want(texel(d)) == got)
}

#[test]
fn wide_ways_show_their_texels_with_any_wrap() {
    let (texels, mut rng) = (Texels::new(), Rng(7));
    for i in 0..6000 {
        let (mut form, mut sides) = some_texture(&mut rng, 10);
        if i % 4 == 0 {
            (form, sides) = (0, [32 << (i / 4 % 4); 2]);
        }
        let wrap = WRAPS[i % 3];
        let texture = texels.texture(form, sides).wrapping(wrap);
        let mut run = std::vec![0; 1 + rng.below(400) as usize];
        let way = some_way(&mut rng, run.len());
        let is_square = form == 0 && sides[0] == sides[1] && (32..=256).contains(&sides[0]);
        let is_exact = i % 5 == 0;
        if is_exact {
            copy_exact(&mut run, &texture, way);
        } else {
            copy_wide(&mut run, 0, &texture, way);
        }
        for (x, &got) in run.iter().enumerate() {
            let at = way.at.plus(way.step.times(x));
            let place = [(at.u, 0), (at.v, 1)]
                .map(|(at, i)| i64::from(at) + (i64::from(way.base[i]) << FRACTION));
            let right = shows(
                got,
                place,
                wrap == Wrap::Repeat && is_square && !is_exact,
                |t| {
                    let t = [0, 1].map(|i| folded(t[i], sides[i], wrap));
                    texels.texel(form, sides[0], t)
                },
            );
            assert!(right, "pixel {x} of {form} {sides:?} {wrap:?} {way:?}");
        }
    }
}

#[test]
fn far_places_of_what_does_not_repeat_are_not_brought_nearer() {
    let words: Vec<u16> = (0..1024).collect();
    let row = |side: u32, wrap, from: i32, to: i32| -> Vec<u16> {
        let texture = Texture::words(&words, side, 1).unwrap().wrapping(wrap);
        let mut run = [0; 8];
        let step = Uv {
            u: ((to - from) << FRACTION) / 8,
            v: 0,
        };
        let way = Way {
            base: [from, 0],
            at: Uv {
                u: step.u / 2,
                v: 0,
            },
            step,
        };
        copy_wide(&mut run, 0, &texture, way);
        run.to_vec()
    };
    assert_eq!(row(8, Wrap::Clamp, -4, 12), [0, 0, 1, 3, 5, 7, 7, 7]);
    assert_eq!(row(8, Wrap::Clamp, 1024, 1040), [7; 8]);
    assert_eq!(row(8, Wrap::Clamp, -1_000_000, -999_000), [0; 8]);
    assert_eq!(
        row(1024, Wrap::Mirror, 1024, 1032),
        [1023, 1022, 1021, 1020, 1019, 1018, 1017, 1016]
    );
    assert_eq!(row(1024, Wrap::Mirror, -8, 0), [7, 6, 5, 4, 3, 2, 1, 0]);
    assert_eq!(row(4, Wrap::Mirror, 2, 10), [2, 3, 3, 2, 1, 0, 0, 1]);
}

#[test]
fn places_are_within_their_bound() {
    let mut rng = Rng(8);
    for _ in 0..400_000 {
        let q = (1 << 30 >> rng.below(12)) - rng.below(1 << 18);
        let reach = 2000.0 * f64::from(rng.signed());
        let s = (reach * f64::from(q) / 2048.0) as i32;
        let place = Homogeneous { q, s, t: -s }.place();
        let want = f64::from(s) * 2048.0 / f64::from(q);
        let unit = f64::from(1 << q.leading_zeros()) / f64::from(1 << FRACTION);
        let bound = want.abs() / 32_768.0 + unit;
        for (got, want) in [(place.u, want), (place.v, -want)] {
            let off = f64::from(got) / f64::from(1 << FRACTION) - want;
            assert!(off.abs() <= bound, "{s} / {q}: {off} of {bound}");
        }
    }
    // No place, and no panic.
    let _ = Homogeneous {
        q: 0,
        s: i32::MIN,
        t: i32::MAX,
    }
    .place();
}

/// 256 x 256 texels that say where they are.
fn coordinates() -> Vec<u16> {
    (0..=u16::MAX).collect()
}

/// How far a place is from the texel that is shown for it, on a side of 256 texels.
fn off(place: f64, texel: u16, wrap: Wrap) -> f64 {
    let texel = f64::from(texel & 255);
    let place = match wrap {
        Wrap::Repeat => {
            let d = (place - texel).rem_euclid(256.0);
            return if d < 1.0 {
                0.0
            } else {
                (d - 1.0).min(256.0 - d)
            };
        }
        Wrap::Clamp => place.clamp(0.0, 256.0),
        Wrap::Mirror => {
            let place = place.rem_euclid(512.0);
            place.min(512.0 - place)
        }
    };
    (texel - place).max(place - texel - 1.0).max(0.0)
}

/// A span of `pixels` pixels, and its least and most 1/w.
fn some_span(rng: &mut Rng, pixels: usize) -> Perspective {
    let mut q = || (f64::from(1u32 << 30) * 30f64.powf(-rng.unit())) as i32;
    let [q0, q1] = [q(), q()];
    let steps = pixels.max(2) as i32 - 1;
    let reach = 600.0 * rng.unit().powi(3) + 1.0;
    let mut axis = || {
        let mut end = |q: i32| (f64::from(rng.signed()) * reach * f64::from(q) / 2048.0) as i32;
        let (a, b) = (end(q0), end(q1));
        (a, (b - a) / steps)
    };
    let ((s, ds), (t, dt)) = (axis(), axis());
    let (q, dq) = (q0 as u32, ((q1 - q0) / steps) as u32);
    Perspective {
        base: [(); 2].map(|()| (rng.bits() as i32 >> 20) * 256),
        at: Homogeneous { q, s, t },
        step: Homogeneous {
            q: dq,
            s: ds,
            t: dt,
        },
    }
}

/// The exact place of a pixel.
fn truth(span: &Perspective, pixel: usize) -> [f64; 2] {
    let at = span.at.plus(span.step.times(pixel));
    let of = |s: i32, base: i32| f64::from(s) * 2048.0 / f64::from(at.q) + f64::from(base);
    [of(at.s, span.base[0]), of(at.t, span.base[1])]
}

/// Draws a run by a mapping as a look does.
fn draw_mapped(
    mapping: &Mapping,
    run: &mut [u16],
    at: Place,
    texture: &Texture<'_>,
    budget: Budget,
) {
    let square = texture.square();
    if !square.is_some_and(|square| mapping.draw_short(run, at, square)) {
        mapping.draw_any(run, at, texture, budget);
    }
}

/// Draws a span as long ones are drawn: how far exact places are apart, and whether parabolas lie between.
fn draw_reached(
    span: &Perspective,
    run: &mut [u16],
    texture: &Texture<'_>,
    budget: Budget,
) -> (u8, bool) {
    let within = Within::whole(run);
    let reach = span.reach(run.len(), budget, texture.repeated());
    if let (Some(square), 1..) = (texture.bent(), reach.arc) {
        match square {
            Bent::Words(square) if run.len() <= usize::from(reach.arc) => {
                span.arc(run, within, square);
            }
            _ => span.arcs(run, within, square, reach.arc),
        }
        return (reach.arc, true);
    }
    let line = reach.line.min(if budget.is_coarse() { 64 } else { 4 });
    span.draw(run, within, texture, stride_within(line));
    (line, false)
}

/// Kills: a reach of twice as many steps, a turn with the other sign.
#[test]
fn reaches_keep_the_budget_and_use_it() {
    let words = coordinates();
    let square = Texture::words(&words, 256, 256).unwrap();
    let mut rng = Rng(9);
    let (mut lines, mut arcs) = ([0; 4], [0; 3]);
    let mut used = [0f64; 2];
    for i in 0..6000 {
        let mut run = std::vec![0; 1 + rng.below(400) as usize];
        let span = some_span(&mut rng, run.len());
        let budget = [Budget::FAST, Budget::BALANCED, Budget::EXACT][i % 3];
        let wrap = WRAPS[i / 3 % 3];
        let (reach, is_arc) = draw_reached(&span, &mut run, &square.wrapping(wrap), budget);
        match (is_arc, reach) {
            (false, _) => lines[reach.ilog2().min(3) as usize] += 1,
            (true, _) => arcs[usize::from(reach).min(16).ilog2() as usize - 2] += 1,
        }
        let (mut far, mut worst) = (0f64, 0f64);
        for (x, &texel) in run.iter().enumerate() {
            let [u, v] = truth(&span, x);
            far = far
                .max((u - f64::from(span.base[0])).abs())
                .max((v - f64::from(span.base[1])).abs());
            // Of fixed point: places, and 1/400 texel for what is left of its bits.
            let bound = f64::from(budget.texels()) / 256.0 + far / 32_768.0 + 0.0025;
            let off = off(u, texel, wrap).max(off(v, texel >> 8, wrap));
            assert!(
                off <= bound,
                "pixel {x} of {}, {reach}, {is_arc}: {off} {span:?}",
                run.len()
            );
            worst = worst.max(off / bound);
        }
        used[usize::from(is_arc)] = used[usize::from(is_arc)].max(worst);
    }
    assert!(lines.iter().all(|&n| n > 100), "{lines:?}");
    assert!(arcs.iter().all(|&n| n > 30), "{arcs:?}");
    assert!(
        used[0] > 0.65 && used[1] > 0.3,
        "the bounds are loose: {used:?}"
    );
}

#[test]
fn every_form_is_drawn_alike_in_perspective() {
    let words = coordinates();
    let square = Texture::words(&words, 256, 256).unwrap();
    // The same texels as indices, in two halves of their bits.
    let bytes: Vec<u8> = (0..1 << 16).map(|i| i as u8).collect();
    let palette: Vec<u16> = (0..256).collect();
    let columns = Texture::index8(&bytes, &palette, 256, 256).unwrap();
    let mut rng = Rng(10);
    for i in 0..1500 {
        let mut run = std::vec![0; 1 + rng.below(60) as usize];
        let mut other = run.clone();
        let span = some_span(&mut rng, run.len());
        let budget = [Budget::FAST, Budget::BALANCED, Budget::EXACT][i % 3];
        let (reach, _) = draw_reached(&span, &mut run, &square, budget);
        draw_reached(&span, &mut other, &columns, budget);
        for (x, (&a, &b)) in run.iter().zip(&other).enumerate() {
            // Places are off by less than half a texel, each.
            let apart = (a & 255).wrapping_sub(b) & 255;
            assert!(matches!(apart, 0 | 1 | 255), "pixel {x}, {reach}: {a} {b}");
        }
        let same = run
            .iter()
            .zip(&other)
            .filter(|(a, b)| **a & 255 == **b)
            .count();
        assert!(reach > 1 || same == run.len());
    }
}

/// Squares of indices have the texels of the same squares of words, along straight ways and parabolas.
///
/// Kills: a side taken for another, the other half of a byte, a turn that is left out, rows that are columns.
#[test]
fn indices_along_a_parabola_are_the_words_of_their_palette() {
    let (texels, mut rng) = (Texels::new(), Rng(11));
    let mut arcs = [0; 3];
    for i in 0..6000 {
        let (bits, log) = ([8, 4][i % 2], 5 + rng.below(4));
        let sides = [1 << log; 2];
        let indices = texels.texture([1, 2][i % 2], sides);
        let count = (sides[0] * sides[1]) as usize;
        let index = |i: usize| texels.bytes[i * bits / 8] >> (i * bits % 8) & (0xFF >> (8 - bits));
        let words: Vec<u16> = (0..count)
            .map(|i| texels.words[usize::from(index(i))])
            .collect();
        let words = Texture::words(&words, sides[0], sides[1]).unwrap();
        let mut run = std::vec![0; 1 + rng.below(200) as usize];
        let mut other = run.clone();
        let span = some_span(&mut rng, run.len());
        if let (Some(words), Some(indices)) = (words.bent(), indices.bent()) {
            arcs[log as usize - 5] += 1;
            let (within, arc) = (Within::whole(&run), 4 + rng.below(60) as u8);
            span.arcs(&mut run, within, words, arc);
            span.arcs(&mut other, within, indices, arc);
            assert_eq!(run, other, "{bits} bits, {sides:?}");
        }
        let (at, step) = (rng.bits(), rng.bits());
        copy(&mut run, &words, at, step);
        copy(&mut other, &indices, at, step);
        assert_eq!(run, other, "{bits} bits, {sides:?}");
        assert_eq!(indices.bent().is_some(), log < 8);
        assert!(indices.wrapping(WRAPS[1 + i % 2]).bent().is_none());
    }
    assert!(arcs.iter().all(|&n| n > 300), "{arcs:?}");
}
