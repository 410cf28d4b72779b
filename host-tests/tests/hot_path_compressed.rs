//! Textures of 4 bits a texel (H7): what a block shows against real numbers, pictures of them against those of the same
//! texels in memory, caches of all sizes, what is loaded ahead, and what is refused.

use crate::common::{Rng, leaked};
use crate::hot::{Corner, LineRooms, SceneRooms, camera, draw_with, frame, line};
use host_tests::compress::{Blocks, Texel, samples};
use host_tests::say;
use scanbeam::look::Textured;
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be};
use scanbeam::scene::{
    BlockCache, Budget, CacheError, CacheReads, CacheWord, Compressed, Sampling, Scene, Skin,
    Texels, Texture, TextureError, Wrap,
};
use scanbeam::{Cull, Screen};
use std::collections::BTreeSet;
use std::path::Path;

fn words(count: usize) -> &'static mut [CacheWord] {
    let words: Vec<_> = (0..count).map(|_| CacheWord::new()).collect();
    words.leak()
}

/// What a texel of blocks is by the words of their documentation, in real numbers: a number of 5, 6 and 5 bits, or none
/// where it is transparent.
fn told(blocks: &[u8], width: u32, [x, y]: [u32; 2]) -> Option<u16> {
    let number = y / 4 * width.div_ceil(4) + x / 4;
    let block = &blocks[8 * number as usize..][..8];
    let end = |i: usize| u16::from(block[i]) + 256 * u16::from(block[i + 1]);
    let (first, second) = (end(0), end(2));
    let byte = u32::from(block[4 + (y % 4) as usize]);
    let part = match (byte / 4u32.pow(x % 4) % 4, first > second) {
        (0, _) => 0.0,
        (1, _) => 1.0,
        (2, true) => 11.0 / 32.0,
        (2, false) => 0.5,
        (_, true) => 21.0 / 32.0,
        (_, false) => return None,
    };
    let channel = |shift: u32, most: u16| {
        let [a, b] = [first, second].map(|end| f64::from(end >> shift & most));
        // A half goes up.
        ((a + (b - a) * part + 0.5).floor() as u16) << shift
    };
    Some(channel(11, 31) | channel(5, 63) | channel(0, 31))
}

/// Blocks of any bytes.
fn any_blocks(rng: &mut Rng, [width, height]: [u32; 2]) -> Vec<u8> {
    let count = 8 * width.div_ceil(4) * height.div_ceil(4);
    (0..count).map(|_| rng.below(256) as u8).collect()
}

/// What is made of a number: bytes as they are, and in the other order.
const ORDERS: [fn(u16) -> u16; 2] = [|number| number, u16::swap_bytes];

/// The words that blocks are to show: those of their numbers, where opaque ones are not the key, and the key or black where
/// they are transparent.
fn shown(blocks: &[u8], sides: [u32; 2], word: fn(u16) -> u16, key: Option<u16>) -> Vec<u16> {
    let texels = (0..sides[0] * sides[1]).map(|i| [i % sides[0], i / sides[0]]);
    let texel = |at: [u32; 2]| match told(blocks, sides[0], at) {
        None => key.unwrap_or(0),
        Some(number) if Some(word(number)) == key => word(number ^ 1),
        Some(number) => word(number),
    };
    texels.map(texel).collect()
}

/// Every block of any bytes, on textures of all sides, alone and through a cache, in both orders of bytes.
///
/// Kills: the second end for the first one; 10/32 for 11/32; parts that are cut off, not rounded; equal ends read as a
/// first one that is above; an opaque texel that equals the key; rows and columns of a block swapped; a block's first
/// texel for the one that is asked for.
#[test]
fn texels_are_those_of_real_numbers() {
    let mut rng = Rng::new(1);
    let mut seen = [0; 3];
    for round in 0..900 {
        let sides = [(); 2].map(|()| 1 << rng.below(6));
        let mut blocks = any_blocks(&mut rng, sides);
        if round % 4 == 0 {
            // Ends that are alike are of the order with holes.
            blocks.copy_within(0..2, 2);
        }
        let word = rng.pick(&ORDERS);
        // A key that the texture has, or any.
        let first = told(&blocks, sides[0], [0, 0]).unwrap_or(0x1234);
        let any = rng.below(1 << 16) as u16;
        let key = rng.pick(&[None, Some(word(first)), Some(any)]);
        let want = shown(&blocks, sides, word, key);
        let compressed = Compressed::new(&blocks, sides[0], sides[1], word).unwrap();
        let compressed = key.map_or(compressed, |key| compressed.keyed(key));
        assert_eq!(compressed.texture().key(), key);
        let count = (sides[0].min(4) * sides[1].min(4)) as usize;
        let cache = BlockCache::compressed(compressed, words(count << rng.below(3))).unwrap();
        assert_eq!(cache.texture().key(), key);
        for (i, &want) in want.iter().enumerate() {
            let at = [i as u32 % sides[0], i as u32 / sides[0]];
            let [column, row] = at.map(|at| at as u16);
            assert_eq!(compressed.texel(column, row), want, "{sides:?}: {at:?}");
            assert_eq!(cache.texel(column, row), want, "{sides:?}: {at:?}, cached");
            let told = told(&blocks, sides[0], at);
            seen[0] += usize::from(told.is_none());
            seen[1] += usize::from(told.is_some() && told.map(word) == key);
            seen[2] += 1;
        }
        // In any order, so that what is asked for is not the first of its block.
        for _ in 0..64 {
            let at = sides.map(|side| rng.below(side));
            let want = want[(at[1] * sides[0] + at[0]) as usize];
            assert_eq!(cache.texel(at[0] as u16, at[1] as u16), want);
        }
    }
    assert!(seen[0] > 10_000 && seen[1] > 100, "{seen:?}");
}

/// All pairs of levels and all parts: sums of one channel never reach the next.
#[test]
fn what_is_mixed_is_within_half_a_level_of_the_part_and_one_of_the_third() {
    for first in 0..64u16 {
        for second in 0..64u16 {
            let ends = [first, second].map(|level| {
                let five = level / 2;
                five << 11 | level << 5 | (31 - five)
            });
            let mut block = [0u8; 8];
            block[..2].copy_from_slice(&ends[0].to_le_bytes());
            block[2..4].copy_from_slice(&ends[1].to_le_bytes());
            block[4] = 0b1110_0100;
            let compressed = Compressed::new(&block, 4, 4, |number| number).unwrap();
            for column in 0..4 {
                let want = told(&block, 4, [column.into(), 0]).unwrap_or(0);
                let texel = compressed.texel(column, 0);
                assert_eq!(texel, want, "{ends:x?} {column}");
                if ends[0] > ends[1] {
                    let third = [0.0, 3.0, 1.0, 2.0][usize::from(column)] / 3.0;
                    let green = f64::from(first) + (f64::from(second) - f64::from(first)) * third;
                    assert!((f64::from(texel >> 5 & 63) - green).abs() < 1.2);
                }
            }
        }
    }
}

const SCREEN: [u16; 2] = [96, 64];

fn screen() -> Screen {
    Screen::new(SCREEN[0], SCREEN[1]).unwrap()
}

/// Triangles with places on a texture.
type Papered = ([Corner; 3], &'static [[i32; 2]], Budget);

fn some(rng: &mut Rng) -> Papered {
    let middle = SCREEN.map(|side| rng.within(0, 8 * i32::from(side)));
    let (w, slant) = (1.0 + 3.0 * rng.unit(), rng.pick(&[1.0, 1.05, 4.0]));
    let corners = [(); 3].map(|()| Corner {
        at: (
            middle[0] + rng.within(-500, 500),
            middle[1] + rng.within(-500, 500),
        ),
        w: w * rng.between(1.0, slant),
        colour: [(); 3].map(|()| 255 - rng.below(200) as u8),
    });
    let texels = rng.pick(&[20, 100, 900]);
    let places = [(); 3].map(|()| [(); 2].map(|()| rng.within(-128 * texels, 128 * texels)));
    let budget = rng.pick(&[Budget::FAST, Budget::BALANCED, Budget::EXACT]);
    (corners, leaked(places), budget)
}

type L = Textured<Rgb565Be>;

fn picture(all: &[Papered], texture: &'static Texture<'static>) -> Vec<Vec<u16>> {
    let mut rooms = SceneRooms::of_triangles(all.len(), screen());
    let mut scene: Scene<'_, '_, L> = rooms.scene(screen());
    scene.begin(&camera()).unwrap();
    for (corners, places, budget) in all {
        draw_with(&mut scene, &[*corners], |call| {
            call.cull = Cull::None;
            call.texture = Some(Skin {
                texture,
                places,
                budget: *budget,
            });
        })
        .unwrap();
    }
    frame(&scene, 8, true, background())
}

fn background() -> u16 {
    Rgb565Be::from_rgb8([10, 60, 90])
}

/// Texels in memory, and how many are a row.
struct Table(&'static [u16], u32);

impl Texels for Table {
    fn texel(&self, column: u16, row: u16) -> u16 {
        self.0[usize::from(row) * self.1 as usize + usize::from(column)]
    }
}

/// Frames with wraps, filters and keys: compressed, through caches from one block on, and of words that were decoded
/// beforehand; and what a cache does is what one does that follows each texel.
#[test]
fn frames_are_those_of_the_same_texels_in_memory() {
    let mut rng = Rng::new(2);
    let (mut pixels, mut misses) = (0, BTreeSet::new());
    for round in 0..150 {
        let sides = [(); 2].map(|()| 1 << (2 + rng.below(6)));
        let blocks = any_blocks(&mut rng, sides).leak();
        let key = rng.pick(&[None, Some(0x1FF8)]);
        let compressed = Compressed::new(blocks, sides[0], sides[1], u16::to_be).unwrap();
        let compressed = leaked(key.map_or(compressed, |key| compressed.keyed(key)));
        let decoded = shown(blocks, sides, u16::to_be, key).leak();
        let wrap = rng.pick(&[Wrap::Repeat, Wrap::Clamp, Wrap::Mirror]);
        // Squares of words that repeat have loops with other roundings of places.
        let plain = match sides[0] == sides[1] && sides[0] >= 32 && wrap == Wrap::Repeat {
            true => Texture::computed(leaked(Table(decoded, sides[0])), sides[0], sides[1]),
            false => Texture::words(decoded, sides[0], sides[1]),
        };
        let plain = plain.unwrap();
        let plain = key.map_or(plain, |key| plain.keyed(key));
        let is_filtered = rng.below(3) == 0;
        let dressed = |texture: Texture<'static>| {
            let texture = texture.wrapping(wrap);
            leaked(match is_filtered {
                true => texture.sampled(Sampling::LINEAR, &[]).unwrap(),
                false => texture,
            })
        };
        let all: Vec<_> = (0..3).map(|_| some(&mut rng)).collect();
        let want = picture(&all, dressed(plain));
        assert!(
            picture(&all, dressed(compressed.texture())) == want,
            "{round}"
        );
        let texels = (sides[0] * sides[1]) as usize;
        for count in [16, 64, 1024] {
            let count = texels.min(count);
            let cache = leaked(BlockCache::compressed(*compressed, words(count)).unwrap());
            assert!(picture(&all, dressed(cache.texture())) == want, "{round}");
            let done = cache.reads();
            assert!(done.misses <= done.page_changes && done.loaded == 0);
            assert!(done.reads == 0 || done.misses > 0);
            if count == texels {
                assert!(done.misses as usize <= texels / 16, "each block once");
            }
            misses.insert(done.misses);
        }
        pixels += (want.iter().flatten())
            .filter(|&&pixel| pixel != background())
            .count();
    }
    assert!(pixels > 100_000 && misses.len() > 50, "{pixels}");
}

/// What is loaded ahead is not missed, in whatever steps it is loaded; and what a cache has not room for is missed and
/// right all the same.
///
/// Kills: a last block that is not whole is left out; what is loaded counts as missed; one block more than was asked for;
/// blocks that are there are loaded again.
#[test]
fn what_is_loaded_ahead_is_not_missed() {
    let mut rng = Rng::new(3);
    let mut held = 0;
    for _ in 0..400 {
        let sides = [(); 2].map(|()| 1 << rng.below(7));
        let blocks = any_blocks(&mut rng, sides);
        let compressed = Compressed::new(&blocks, sides[0], sides[1], u16::to_be).unwrap();
        let block = sides.map(|side| side.min(4));
        let texels = (sides[0] * sides[1]) as usize;
        let least = (block[0] * block[1]) as usize;
        let count = (least << rng.below(6)).min(texels);
        let cache = BlockCache::compressed(compressed, words(count)).unwrap();
        let range = |rng: &mut Rng, side: u32| {
            let start = rng.below(side + 1);
            start..start + rng.below(side - start + 1)
        };
        let [columns, rows] = sides.map(|side| range(&mut rng, side));
        let met: BTreeSet<_> = (rows.clone())
            .flat_map(|y| columns.clone().map(move |x| [x / block[0], y / block[1]]))
            .collect();
        // Where two have one place the later one stays.
        let across = sides[0] / block[0];
        let place = |[x, y]: &[u32; 2]| (y * across + x) as usize % (count / least);
        let places: BTreeSet<_> = met.iter().map(place).collect();
        let most = 1 + rng.below(9);
        let mut loaded = 0;
        if places.len() == met.len() {
            loop {
                let more = cache.load(columns.clone(), rows.clone(), most).unwrap();
                assert!(more <= most);
                loaded += more;
                if more == 0 {
                    break;
                }
            }
            assert_eq!(loaded as usize, met.len());
            held += 1;
        } else {
            loaded = cache.load(columns.clone(), rows.clone(), u32::MAX).unwrap();
            assert_eq!(loaded as usize, met.len(), "each once");
        }
        let before = CacheReads {
            loaded,
            ..CacheReads::default()
        };
        assert_eq!(cache.reads(), before);
        let want = shown(&blocks, sides, u16::to_be, None);
        for y in rows.clone() {
            for x in columns.clone() {
                let want = want[(y * sides[0] + x) as usize];
                assert_eq!(cache.texel(x as u16, y as u16), want);
            }
        }
        let misses = cache.reads().misses;
        if places.len() == met.len() {
            assert_eq!(misses, 0, "{sides:?}: {columns:?}, {rows:?}");
        } else {
            assert!(misses > 0);
        }
    }
    assert!((100..350).contains(&held), "{held}");
}

/// A frame whose texture is loaded before each line that begins a row of blocks: no line misses.
#[test]
fn lines_miss_nothing_that_was_loaded_for_them() {
    let blocks = any_blocks(&mut Rng::new(4), [32, 64]).leak();
    let compressed = Compressed::new(blocks, 32, 64, u16::to_be).unwrap();
    // Two rows of blocks.
    let cache = leaked(BlockCache::compressed(compressed, words(256)).unwrap());
    let texture = leaked(cache.texture());
    let corner = |x: i32, y: i32| Corner {
        at: (8 * x, 8 * y),
        w: 1.0,
        colour: [255; 3],
    };
    // A texel a pixel.
    let corners = [corner(0, 0), corner(64, 0), corner(0, 128)];
    let places: &'static [[i32; 2]] = &[[0, 0], [64 << 8, 0], [0, 128 << 8]];
    let mut rooms = SceneRooms::of_triangles(1, screen());
    let mut scene: Scene<'_, '_, L> = rooms.scene(screen());
    scene.begin(&camera()).unwrap();
    draw_with(&mut scene, &[corners], |call| {
        call.cull = Cull::None;
        call.texture = Some(Skin {
            texture,
            places,
            budget: Budget::EXACT,
        });
    })
    .unwrap();
    let decoded = shown(blocks, [32, 64], u16::to_be, None);
    let mut lines = LineRooms::fitting(&scene, 8, true);
    let mut renderer = lines.renderer();
    for y in scene.lines() {
        let rows = u32::from(y) / 4 * 4..(u32::from(y) / 4 * 4 + 4);
        let loaded = cache.load(0..32, rows, 8).unwrap();
        assert_eq!(loaded, if y % 4 == 0 { 8 } else { 0 }, "line {y}");
        let drawn = line(&mut renderer, &scene, y, background());
        let full = usize::from(SCREEN[1] - y) / 2;
        for (x, pixel) in drawn.iter().enumerate().take(full) {
            assert_eq!(*pixel, decoded[usize::from(y) * 32 + x % 32], "{x}, {y}");
        }
    }
    let done = cache.reads();
    assert_eq!((done.misses, done.loaded), (0, 16 * 8));
    assert!(done.reads > 2_000);
}

#[test]
fn what_does_not_fit_is_said() {
    let blocks = [0; 8 * 16];
    let make = |count: usize, width, height| {
        Compressed::new(&blocks[..count], width, height, u16::to_be).err()
    };
    let bytes = |needed, have| Some(TextureError::Bytes { needed, have });
    let side = |width, height| Some(TextureError::Side { width, height });
    assert_eq!(make(128, 16, 16), None);
    assert_eq!(make(127, 16, 16), bytes(128, 127));
    assert_eq!(make(0, 1, 1), bytes(8, 0));
    assert_eq!((make(8, 1, 1), make(8, 2, 4)), (None, None));
    assert_eq!(make(16, 8, 8), bytes(32, 16));
    assert_eq!(
        (make(128, 12, 8), make(128, 0, 4)),
        (side(12, 8), side(0, 4))
    );
    assert_eq!(make(128, 2048, 1), side(2048, 1));
    assert_eq!(make(128, u32::MAX, u32::MAX), side(u32::MAX, u32::MAX));
    let compressed = Compressed::new(&blocks, 16, 16, u16::to_be).unwrap();
    let cached = |count| BlockCache::compressed(compressed, words(count));
    let needed = |needed, have| Some(CacheError::Words { needed, have });
    assert_eq!(cached(8).err(), needed(16, 8));
    assert_eq!(cached(0).err(), needed(16, 0));
    assert_eq!(
        cached(24).err(),
        Some(CacheError::NotPowerOfTwo { have: 24 })
    );
    let cache = cached(16).unwrap();
    let outside = |end| Err(CacheError::Outside { side: 16, end });
    assert_eq!(cache.load(0..17, 0..16, 1), outside(17));
    assert_eq!(cache.load(0..16, 3..99, 1), outside(99));
    assert_eq!(cache.load(0..u32::MAX, 0..1, 1), outside(u32::MAX));
    assert_eq!(cache.reads(), CacheReads::default());
    #[expect(
        clippy::reversed_empty_ranges,
        reason = "what has no texel loads nothing"
    )]
    let none = [cache.load(9..3, 0..4, 9), cache.load(u32::MAX..4, 0..4, 9)];
    assert_eq!(none, [Ok(0), Ok(0)]);
    assert_eq!(cache.load(5..5, 0..4, 9), Ok(0));
    assert_eq!(cache.load(0..16, 0..16, 0), Ok(0));
    assert!(outside(17).unwrap_err().to_string().contains("17"));
}

/// Root of the mean square that channels are off, of texels that are there.
fn off(texels: &[Texel], blocks: &Blocks) -> f64 {
    let [width, _] = blocks.sides;
    let (mut sum, mut count) = (0.0, 0);
    for (i, texel) in (0..).zip(texels) {
        let shown = told(&blocks.bytes, width, [i % width, i / width]);
        assert_eq!(shown.is_some(), texel.is_some(), "holes stay holes");
        let (Some(shown), Some(texel)) = (shown.map(Rgb565::to_rgb8), texel) else {
            continue;
        };
        for (a, b) in shown.iter().zip(texel) {
            sum += f64::from(a.abs_diff(*b)).powi(2);
            count += 1;
        }
    }
    (sum / f64::from(count)).sqrt()
}

/// The compressor says how far it is off, is within a bound on each sample, and leaves alone what two colours can show.
///
/// Kills: the outermost colours are taken, and none better is looked for.
#[test]
fn pictures_are_compressed_within_a_bound_and_it_is_told() {
    let two = |x: u32, y: u32| [[255, 0, 0], [0, 255, 255]][(x * y % 2) as usize];
    let two: Vec<Texel> = (0..64).map(|i| Some(two(i % 8, i / 8))).collect();
    // A side below that of a block.
    let thin: Vec<Texel> = (0..16).map(|i| Some([(i * 16) as u8, 0, 0])).collect();
    for (name, sides, texels, most) in [
        ("stone", [64, 64], samples::stone(), 3.6),
        ("leaves", [32, 32], samples::leaves(), 4.5),
        ("hues", [64, 64], samples::hues(), 3.5),
        ("two colours", [8, 8], two, 0.0),
        ("thin", [16, 1], thin, 1.5),
    ] {
        let blocks = Blocks::new(sides, &texels).unwrap();
        let off = off(&texels, &blocks);
        say!("{name}: {off:.3} levels");
        assert!((off - blocks.error).abs() < 1e-9, "{name}: {off}");
        assert!(off <= most, "{name}: {off}");
    }
    let words = |needed, have| Err(TextureError::Words { needed, have });
    assert_eq!(Blocks::new([4, 4], &[None; 15]), words(16, 15));
    let (width, height) = (5, 4);
    let side = TextureError::Side { width, height };
    assert_eq!(Blocks::new([5, 4], &[None; 20]), Err(side));
}

/// The blocks that the firmware's frame has are those of the samples.
#[test]
fn blocks_of_the_frame_are_what_is_compressed() {
    for (file, side, texels) in [
        ("stone.bc1", samples::STONE, samples::stone()),
        ("leaves.bc1", samples::LEAVES, samples::leaves()),
    ] {
        let bytes = Blocks::new([side; 2], &texels).unwrap().bytes;
        let path = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scenes");
        let path = path.join(file);
        if std::fs::read(&path).unwrap_or_default() != bytes {
            std::fs::write(&path, &bytes).unwrap();
            panic!("{} was another; it is written anew", path.display());
        }
    }
}
