//! Texels, counts and errors of caches of all sizes, and two cores that share one.

use super::*;
use crate::num::random::Rng;
use std::vec;
use std::vec::Vec;

/// Texels of 64 x 32, all different, in rows and in the blocks of a layout.
fn texels(layout: Blocked) -> [Vec<u16>; 2] {
    let rows: Vec<u16> = (0..2048).map(|i| (i * 31) as u16).collect();
    let mut blocks = rows.clone();
    layout.arrange([64, 32], &rows, &mut blocks).unwrap();
    [rows, blocks]
}

fn words(count: usize) -> Vec<CacheWord> {
    (0..count).map(|_| CacheWord::new()).collect()
}

/// Against a model that follows every read.
///
/// Kills: no upper part of the index, one without the 1, a word's place by the block alone, a block that is copied
/// from its middle on, counts that are not added up.
#[test]
fn a_cache_of_any_size_gives_the_same_texels_and_counts_what_it_does() {
    for (log_w, log_h) in [(2, 2), (4, 0), (0, 0), (5, 5)] {
        let layout = Blocked::new(log_w, log_h).unwrap();
        let [rows, blocks] = texels(layout);
        let block = 1usize << (log_w + log_h);
        for slots in [1usize, 2, 8, 2048 / block] {
            // What another cache has left there.
            let mut fast = words(slots * block);
            fast.fill_with(|| CacheWord(AtomicU32::new(1 << 16 | 0xBAD)));
            let slow = Texture::words(&blocks, 64, 32).unwrap();
            let cache = BlockCache::new(slow, layout, &mut fast).unwrap();
            let (mut held, mut last) = (vec![usize::MAX; slots], usize::MAX);
            let (mut rng, mut want) = (Rng(3), CacheReads::default());
            for i in 0..5_000 {
                let at = [rng.below(64), rng.below(32)].map(|n| n as u16);
                let number = usize::from(at[1] >> log_h << (6 - log_w) | at[0] >> log_w);
                want.reads += 1;
                want.page_changes += u32::from(number != last);
                want.misses += u32::from(held[number % slots] != number);
                (held[number % slots], last) = (number, number);
                let texel = usize::from(at[1]) << 6 | usize::from(at[0]);
                if i % 2 == 0 {
                    assert_eq!(cache.texel(at[0], at[1]), rows[texel]);
                } else {
                    let mut pixel = [0];
                    let turn = |n: u16, log: u32| [u32::from(n) << (32 - log), 0];
                    let way = TexelWay::new(turn(at[0], 6), turn(at[1], 5), [6, 5]);
                    cache.fetch(&mut pixel, way);
                    assert_eq!(pixel[0], rows[texel]);
                }
                assert_eq!(cache.reads(), want, "{slots} of {block}");
            }
        }
    }
}

/// Indices in slow memory are words in fast memory; the largest texture has the least cache.
#[test]
fn any_form_and_size_is_read() {
    let bytes: Vec<u8> = (0..1 << 20).map(|i| (i * 7 % 251) as u8).collect();
    let palette: Vec<u16> = (0..256).map(|i| 0x8000 | (i * 3)).collect();
    let slow = Texture::index8(&bytes, &palette, 1024, 1024).unwrap();
    let layout = Blocked::new(4, 0).unwrap();
    let mut fast = words(32);
    let cache = BlockCache::new(slow, layout, &mut fast).unwrap();
    let mut rng = Rng(4);
    for _ in 0..20_000 {
        let [column, row] = [(); 2].map(|()| rng.below(1024));
        let want = palette[usize::from(bytes[(row << 10 | column) as usize])];
        assert_eq!(cache.texel(column as u16, row as u16), want);
    }
}

#[test]
fn what_does_not_fit_is_said() {
    let (texels, layout) = (vec![0; 1 << 20], Blocked::new(2, 2).unwrap());
    let make = |side: u32, count: usize| {
        let mut fast = words(count);
        let slow = Texture::words(&texels, side, side).unwrap();
        BlockCache::new(slow, layout, &mut fast).err()
    };
    assert_eq!(make(64, 48), Some(CacheError::NotPowerOfTwo { have: 48 }));
    let words_error = |needed, have| Some(CacheError::Words { needed, have });
    assert_eq!(make(64, 0), words_error(16, 0));
    assert_eq!(make(64, 8), words_error(16, 8));
    assert_eq!(make(1024, 16), words_error(32, 16));
    // A block is not larger than its texture.
    assert_eq!((make(64, 16), make(2, 4), make(1, 1)), (None, None, None));
    let mut fast = [words(16), words(16)];
    let [first, second] = &mut fast;
    let slow = Texture::words(&texels, 64, 64).unwrap();
    let cache = BlockCache::new(slow, layout, first).unwrap();
    let twice = BlockCache::new(cache.texture(), layout, second);
    assert_eq!(twice.err(), Some(CacheError::Computed));
}

/// A slot as two cores leave it that copy two blocks there at once: each word is of either block.
///
/// Kills: a tag for each block in place of one for each word.
#[test]
fn words_of_two_blocks_in_one_slot_are_told_apart() {
    let layout = Blocked::new(2, 2).unwrap();
    let [rows, blocks] = texels(layout);
    let slow = Texture::words(&blocks, 64, 32).unwrap();
    // One slot: blocks 0 and 1 are both kept there.
    for mixed in 0..1u32 << 16 {
        if mixed.count_ones() != 1 && mixed % 97 != 0 {
            continue;
        }
        let mut fast = words(16);
        let cache = BlockCache::new(slow, layout, &mut fast).unwrap();
        let words_after = |column: u16| {
            let _ = cache.texel(column, 0);
            let words = cache.words.iter().map(|word| word.0.load(Relaxed));
            words.collect::<Vec<_>>()
        };
        let [first, second] = [words_after(0), words_after(4)];
        for column in [0, 1, 5, 4] {
            for (i, word) in cache.words.iter().enumerate() {
                let of = [&first, &second][(mixed >> i & 1) as usize];
                word.0.store(of[i], Relaxed);
            }
            let want = rows[usize::from(column)];
            assert_eq!(cache.texel(column, 0), want, "{mixed:x}");
        }
    }
}

/// Two cores at once: each has its texels, whoever copied them.
#[test]
fn two_cores_read_through_one_cache() {
    let layout = Blocked::new(2, 2).unwrap();
    let [rows, blocks] = texels(layout);
    let mut fast = words(32);
    let slow = Texture::words(&blocks, 64, 32).unwrap();
    let cache = BlockCache::new(slow, layout, &mut fast).unwrap();
    std::thread::scope(|scope| {
        for seed in [1, 2] {
            let (cache, rows) = (&cache, &rows);
            scope.spawn(move || {
                let mut rng = Rng(seed);
                for _ in 0..200_000 {
                    let [column, row] = [rng.below(64), rng.below(32)];
                    let want = rows[(row << 6 | column) as usize];
                    assert_eq!(cache.texel(column as u16, row as u16), want);
                }
            });
        }
    });
}
