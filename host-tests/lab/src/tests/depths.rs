//! What is kept of 1/w, and lines of it.

use super::Rng;
use super::methods::random;
use crate::colours::Colours;
use crate::depth::{
    DepthMethod, Depths, bits_16, bits_22, bits_32, block_fix, even_w, resolve, words,
};
use crate::method::Method;
use crate::paint::paint;
use scanbeam::pixel::Rgb565;
use scanbeam_model::BlockFix16;
use std::vec::Vec;

const WIDTH: usize = 40;

/// Lines of depths that cross each other; between 2^-7 of the nearest and all of it.
fn lines(rng: &mut Rng) -> Vec<Depths> {
    let depth = |rng: &mut Rng| (1 << 24) + rng.below((1 << 31) - (1 << 24));
    let make = |rng: &mut Rng| {
        let [from, to] = [depth(rng), depth(rng)].map(i64::from);
        let step = (to - from) / WIDTH as i64;
        Depths {
            at: from as u32,
            step: step as u32,
        }
    };
    (0..6).map(|_| make(rng)).collect()
}

/// The last of the nearest at each pixel, by what is compared.
fn nearest(lines: &[Depths], method: DepthMethod) -> [usize; WIDTH] {
    core::array::from_fn(|x| {
        let key = |line: &Depths| {
            let at = |x: usize| line.at.wrapping_add(line.step.wrapping_mul(x as u32));
            let range = method.range(at(0).max(at(WIDTH)));
            method.key(at(x), range)
        };
        (0..lines.len()).fold(0, |best, i| {
            if key(&lines[i]) >= key(&lines[best]) {
                i
            } else {
                best
            }
        })
    })
}

/// Each line keeps what its method's keys say. Dies where the number of an object counts as depth, and where block-fix
/// bits are compared as a number.
#[test]
fn lines_keep_what_keys_say() {
    let mut rng = Rng(21);
    for _ in 0..2_000 {
        let mut lines = lines(&mut rng);
        // One twice: the last of equals is kept.
        lines.push(lines[2]);
        let [mut c16, mut fix] = [[0u16; WIDTH]; 2];
        let [mut c22, mut c32, mut even] = [[0u32; WIDTH]; 3];
        for (i, depths) in (0..).zip(&lines) {
            let end = depths
                .at
                .wrapping_add(depths.step.wrapping_mul(WIDTH as u32));
            bits_16(&mut c16, *depths);
            // The last has the least number.
            bits_22(&mut c22, *depths, 9 - i);
            let range = DepthMethod::BlockFix.range(depths.at.max(end));
            block_fix(&mut fix, *depths, range);
            bits_32(&mut c32, *depths);
            even_w(&mut even, *depths);
        }
        let kept = |method: DepthMethod, x: usize| {
            let line = lines[nearest(&lines, method)[x]];
            let at = |x: usize| line.at.wrapping_add(line.step.wrapping_mul(x as u32));
            method.key(at(x), method.range(at(0).max(at(WIDTH))))
        };
        let objects = nearest(&lines, DepthMethod::Bits22);
        for x in 0..WIDTH {
            assert_eq!(u32::from(c16[x]), kept(DepthMethod::Bits16, x));
            assert_eq!(9 - (c22[x] & 1023) as usize, objects[x]);
            assert_eq!(
                BlockFix16::from_bits(fix[x]).key(),
                kept(DepthMethod::BlockFix, x)
            );
            assert_eq!(c32[x], kept(DepthMethod::Bits32, x));
            assert_eq!(even[x], kept(DepthMethod::Linear, x));
        }
    }
}

/// The keys of all methods rise with 1/w, and tell apart what is more than a step apart: 2^-16 and 2^-22 of the nearest,
/// and 2^-14 of a block-fix range. Dies where a range has 13 bits, and where ranges are compared first.
#[test]
fn keys_tell_apart_what_is_a_step_apart() {
    let mut rng = Rng(22);
    for _ in 0..200_000 {
        let far = 1 + rng.below((1 << 31) - 1);
        let near = far + rng.below((1 << 31) - far);
        // Triangles whose nearest corners are anywhere nearer.
        let [first, second] = [far, near].map(|depth| depth + rng.below((1 << 31) - depth));
        for (method, step) in [
            (DepthMethod::Bits16, 1 << 15),
            (DepthMethod::Word, 1 << 15),
            (DepthMethod::Bits22, 1 << 9),
            (DepthMethod::Bits32, 1),
        ] {
            let [a, b] = [far, near].map(|depth| method.key(depth, method.range(depth)));
            assert!(
                b >= a && (near - far < step || b > a),
                "{method:?}: {far} {near}"
            );
        }
        let by = DepthMethod::BlockFix;
        let (a, b) = (by.key(far, by.range(first)), by.key(near, by.range(second)));
        let coarser = by.range(first).min(by.range(second));
        let step = 1 << (17 - 3 * coarser);
        assert!(near - far < step || b > a, "{far} {near}: {first} {second}");
        if near > 1 << 24 && far > 1 << 24 {
            let by = DepthMethod::Linear;
            assert!(by.key(near, 0) >= by.key(far, 0));
        }
    }
}

/// Words of depth and colour show what 16 bits of depth and packed colours do. Dies where a pixel's bits are compared, and
/// where a word that nobody has written is taken for a pixel.
#[test]
fn words_are_depth_and_colour() {
    let mut rng = Rng(23);
    let mut hidden = 0;
    for _ in 0..2_000 {
        let mut cells = [0; WIDTH];
        let mut depth = [0u16; WIDTH];
        let (mut by_words, mut apart) = ([7u16; WIDTH], [7u16; WIDTH]);
        // Of the first line a part is left to what is there.
        let mut from = rng.below(WIDTH as u32) as usize;
        let mut lines = lines(&mut rng);
        // One twice: the last of equals is seen.
        lines.push(lines[2]);
        for depths in lines {
            let colours: Colours = loop {
                let (colours, pixels) = random::<Rgb565>(&mut rng);
                if pixels >= WIDTH {
                    break colours;
                }
            };
            words(&mut cells[from..], depths, &colours);
            let mut at = depths.at;
            let mut kept = depth[from..].iter_mut();
            paint::<Rgb565>(Method::Packed8, &colours, &mut apart[from..], &mut || {
                let key = DepthMethod::Word.key(at, 0) as u16;
                at = at.wrapping_add(depths.step);
                let kept = kept.next().unwrap();
                let seen = key >= *kept;
                *kept = key.max(*kept);
                hidden += u32::from(!seen);
                seen
            });
            from = rng.below(8) as usize;
        }
        resolve(&mut cells, &mut by_words);
        assert_eq!(by_words, apart);
        assert_eq!(cells, [0; WIDTH]);
    }
    assert!(hidden > 10_000);
}
