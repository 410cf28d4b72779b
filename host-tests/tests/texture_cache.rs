//! A texture in blocks, drawn through a small cache of them (B1, B5): whatever the cache, the
//! picture is that of the same texture in rows, and the counts are those of a model that follows
//! every read.

use host_tests::frames::textured_b;
use scanbeam::pipeline::texture::{
    BlockCache, Blocked, CacheReads, Size, Store, Texture, Textures, Words, Wrap,
};
use scanbeam::pipeline::{Counted, TexturedDepth};
use scanbeam::pixel::Rgb565Be;
use scenes::{CachedB, CachedLookB, SCENES_B, SceneB, TEXEL_SIDE, TEXELS_PANEL};
use std::cell::RefCell;
use std::collections::BTreeSet;
use std::process::Command;

fn size() -> Size {
    Size::new(TEXEL_SIDE, TEXEL_SIDE).unwrap()
}

/// Texels in slow memory that write down which of them is read.
#[derive(Clone, Copy, Debug)]
struct Noted<'t>(&'t [u16], &'t RefCell<Vec<usize>>);

impl Store for Noted<'_> {
    type Texel = u16;

    fn count(&self) -> usize {
        self.0.len()
    }

    fn fetch(&self, index: usize) -> u16 {
        let index = index & (self.0.len() - 1);
        self.1.borrow_mut().push(index);
        self.0[index]
    }

    fn fetch_in<const N: usize>(&self) -> Option<impl Fn(usize) -> u16 + Copy> {
        None::<fn(usize) -> u16>
    }
}

/// The picture from texels in rows.
fn in_rows(scene: SceneB) -> Vec<u8> {
    type Look<'t> = TexturedDepth<'t, Rgb565Be, Texture<Words<'t, u16>>>;
    let texture = Texture::<_, Wrap>::new(Words(&TEXELS_PANEL[..]), size()).unwrap();
    textured_b::<Look<'_>>(scene, Textures(&[texture]))
        .unwrap()
        .0
}

/// The indices of the texels that a scene reads, one after the other, and its picture.
fn noted(scene: SceneB, texels: &[u16], layout: Blocked) -> (Vec<usize>, Vec<u8>) {
    type Look<'t> = TexturedDepth<'t, Rgb565Be, Texture<Noted<'t>, Wrap, Blocked>>;
    let indices = RefCell::default();
    let texture = Texture::arranged(Noted(texels, &indices), size(), layout).unwrap();
    let drawn = textured_b::<Look<'_>>(scene, Textures(&[texture]))
        .unwrap()
        .0;
    (indices.into_inner(), drawn)
}

/// Reads, reads of another block than before, and blocks copied, of a cache with a slot for each
/// residue of a block's number.
fn followed(indices: &[usize], block: usize, slots: usize) -> [u32; 3] {
    let mut held = vec![None; slots];
    let mut last = None;
    let mut counts = [0; 3];
    for number in indices.iter().map(|index| index / block) {
        counts[0] += 1;
        counts[1] += u32::from(last.replace(number) != Some(number));
        let slot = &mut held[number % slots];
        counts[2] += u32::from(slot.replace(number) != Some(number));
    }
    counts
}

#[test]
fn any_cache_gives_the_same_picture_and_counts_what_it_does() {
    let caches = [
        (4, 1),
        (16, 1),
        (16, 2),
        (16, 32),
        (16, 1024),
        (64, 8),
        (512, 4),
        (1024, 16),
    ];
    for scene in SCENES_B {
        let rows = in_rows(scene);
        for (block, slots) in caches {
            let layout = Blocked::of_page(2 * block, 16);
            let mut slow = vec![0; size().texels()];
            layout.arrange(size(), &TEXELS_PANEL, &mut slow).unwrap();
            let (indices, drawn) = noted(scene, &slow, layout);
            assert!(drawn == rows, "{}, blocks of {block}", scene.name);

            let (mut tags, mut fast) = (vec![7; slots], vec![0; slots * block]);
            let mut reads = CacheReads::default();
            let words = Words(&slow[..]);
            let cache = BlockCache::new(words, block, &mut tags, &mut fast, &mut reads).unwrap();
            let textures = [CachedB::arranged(cache, size(), layout).unwrap()];
            type Look<'t> = Counted<CachedLookB<'t>>;
            let (drawn, stats) = textured_b::<Look<'_>>(scene, Textures(&textures)).unwrap();
            let name = format!("{}, {slots} slots of {block} texels", scene.name);
            assert!(drawn == rows, "{name}");

            let done = cache.reads();
            let got = [done.reads, done.page_changes, done.misses];
            let blocks: BTreeSet<usize> = indices.iter().map(|index| index / block).collect();
            println!("{name}: {got:?}, {} blocks", blocks.len());
            assert_eq!(got, followed(&indices, block, slots), "{name}");
            assert_eq!(done.reads, stats.spans.texture_fetches, "{name}");
            let each_once = slots * block >= TEXELS_PANEL.len();
            assert_eq!(done.misses == blocks.len() as u32, each_once, "{name}");
        }
    }
}

/// One command prints what blocks save.
#[test]
fn the_cache_command_prints_blocks_beside_rows() {
    let output = Command::new(env!("CARGO_BIN_EXE_scanbeam"))
        .arg("cache")
        .output();
    let printed = String::from_utf8(output.unwrap().stdout).unwrap();
    for name in [
        "sphere",
        "ground plane",
        "quad, 30 degrees",
        "page changes",
        "texels re-read",
    ] {
        assert!(printed.contains(name), "{name}:\n{printed}");
    }
}
