//! Textures that are computed (H17), and those that lie in blocks of slow memory behind a cache (B1, B5): pictures are
//! those of the same texels in memory, whatever else a call asks for, and a cache counts what a model of it counts that
//! follows every texel asked for.

use crate::common::{Rng, leaked};
use crate::hot::{Corner, LineRooms, SceneRooms, Smooth, WordOf, camera, draw_with, frame, line};
use scanbeam::look::{Look, Textured};
use scanbeam::pixel::{PixelFormat, Rgb565, Rgb565Be, Rgb565Le, Rgb888, Xrgb8888};
use scanbeam::scene::{
    Application, BlockCache, Blocked, Budget, CacheReads, CacheWord, Checker, Gradient, Sampling,
    Scene, Skin, Texels, Texture, Wrap,
};
use scanbeam::{Cull, Screen};
use std::collections::BTreeSet;
use std::sync::Mutex;

const BUDGETS: [Budget; 3] = [Budget::FAST, Budget::BALANCED, Budget::EXACT];

fn screen() -> Screen {
    Screen::new(96, 64).expect("a screen")
}

/// Any words.
fn words(rng: &mut Rng, count: u32) -> &'static [u16] {
    let words: Vec<u16> = (0..count).map(|_| rng.below(1 << 16) as u16).collect();
    words.leak()
}

/// Texels by a rule: words of a palette, by their places.
#[derive(Clone, Copy)]
struct Rule {
    palette: &'static [u16],
    by: [u32; 2],
}

impl Rule {
    fn some(rng: &mut Rng) -> Self {
        let by = [1 + rng.below(31), 1 + rng.below(31)];
        let palette = words(rng, 256);
        Self { palette, by }
    }

    fn index(&self, column: u32, row: u32) -> u8 {
        ((column * self.by[0]) ^ (row * self.by[1]) ^ ((column * row) >> 2)) as u8
    }

    /// The texels in memory.
    fn stored(&self, [width, height]: [u32; 2]) -> Texture<'static> {
        let rows = (0..height).flat_map(|row| (0..width).map(move |column| (column, row)));
        let indices: Vec<u8> = rows.map(|(column, row)| self.index(column, row)).collect();
        Texture::index8(indices.leak(), self.palette, width, height).expect("powers of two")
    }
}

impl Texels for Rule {
    fn texel(&self, column: u16, row: u16) -> u16 {
        self.palette[usize::from(self.index(column.into(), row.into()))]
    }
}

/// The same texture computed, and in memory, with some wrap, key, filter and levels of detail.
fn some_pair(rng: &mut Rng) -> [&'static Texture<'static>; 2] {
    let logs = [rng.below(11), rng.below(11)];
    let wrap = rng.pick(&[Wrap::Repeat, Wrap::Clamp, Wrap::Mirror]);
    let sampling = rng.pick(&[None, Some(Sampling::NEAREST), Some(Sampling::LINEAR)]);
    let levels = rng.below(1 + logs[0].max(logs[1]).min(4));
    let rules: Vec<Rule> = (0..=levels).map(|_| Rule::some(rng)).collect();
    let key = (rng.below(2) == 0).then(|| rules[0].palette[rng.below(256) as usize]);
    [true, false].map(|is_computed| {
        let level = |(level, rule): (u32, &Rule)| {
            let sides = logs.map(|log| 1 << log.saturating_sub(level));
            match is_computed {
                true => Texture::computed(leaked(*rule), sides[0], sides[1]).expect("the same"),
                false => rule.stored(sides),
            }
        };
        let all: Vec<_> = (0..).zip(&rules).map(level).collect();
        let texture = all[0].wrapping(wrap);
        let texture = key.map_or(texture, |key| texture.keyed(key));
        leaked(match sampling {
            Some(sampling) => {
                let coarser = all[1..].to_vec().leak();
                texture.sampled(sampling, coarser).expect("halves")
            }
            None => texture,
        })
    })
}

/// A triangle with texture places of 8 fraction bits, and what its call says.
#[derive(Clone)]
struct Papered {
    corners: [Corner; 3],
    places: &'static [[i32; 2]],
    budget: Budget,
    application: Application,
    dither: bool,
}

impl Papered {
    fn some(rng: &mut Rng) -> Self {
        let size = rng.pick(&[60, 200, 900]);
        let slant = rng.pick(&[1.0, 1.05, 4.0]);
        let middle = [96, 64].map(|side| rng.within(0, 8 * side));
        let (w, texels) = (1.0 + 3.0 * rng.unit(), rng.pick(&[20, 100, 900]));
        let corners = [(); 3].map(|()| Corner {
            at: (
                middle[0] + rng.within(-size, size),
                middle[1] + rng.within(-size, size),
            ),
            w: w * rng.between(1.0, slant),
            colour: [(); 3].map(|()| 255 - rng.below(200) as u8),
        });
        let places = [(); 3].map(|()| [(); 2].map(|()| rng.within(-128 * texels, 128 * texels)));
        let applications = [
            Application::Product,
            Application::Replace,
            Application::Decal,
        ];
        Self {
            corners,
            places: leaked(places),
            budget: rng.pick(&BUDGETS),
            application: rng.pick(&applications),
            dither: rng.below(4) == 0,
        }
    }
}

/// Files triangles, each a call, with one texture.
fn filed<'m, L: Look>(
    rooms: &'m mut SceneRooms,
    all: &[Papered],
    texture: &'static Texture<'static>,
) -> Scene<'m, 'static, L> {
    let mut scene = rooms.scene::<L>(screen());
    scene.begin(&camera()).expect("the rooms are large enough");
    for one in all {
        draw_with(&mut scene, &[one.corners], |call| {
            call.cull = Cull::None;
            call.application = one.application;
            call.dither = one.dither;
            call.texture = Some(Skin {
                texture,
                places: one.places,
                budget: one.budget,
            });
        })
        .expect("there is room");
    }
    scene
}

fn rooms(all: &[Papered]) -> SceneRooms {
    SceneRooms::of_triangles(all.len(), screen())
}

/// The picture by so many slots.
fn picture<L: Smooth>(
    all: &[Papered],
    texture: &'static Texture<'static>,
    slots: u16,
) -> Vec<Vec<WordOf<L>>> {
    let mut rooms = rooms(all);
    let scene = filed::<L>(&mut rooms, all, texture);
    frame(&scene, slots, true, L::Format::from_rgb8([10, 60, 90]))
}

/// Pixels that are the same of a computed texture and of the one in memory, of triangles that a look draws.
fn compared<L: Smooth>(seed: u64) -> usize
where
    WordOf<L>: PartialEq,
{
    let mut rng = Rng::new(seed);
    let mut textured = 0;
    for _ in 0..150 {
        let all: Vec<_> = (0..1 + rng.below(3))
            .map(|_| Papered::some(&mut rng))
            .collect();
        let (textures, slots) = (some_pair(&mut rng), rng.pick(&[1, 8]));
        let [computed, stored] = textures.map(|texture| picture::<L>(&all, texture, slots));
        assert!(computed == stored, "{textures:?}");
        let background = L::Format::from_rgb8([10, 60, 90]);
        let pixels = computed.iter().flatten();
        textured += pixels.filter(|word| **word != background).count();
    }
    textured
}

/// Kills: a texel by row and column in each other's place, rows of lone places by another power of two than the width's.
#[test]
fn computed_texels_are_drawn_as_those_of_memory() {
    let drawn = [
        compared::<Textured<Rgb565>>(1),
        compared::<Textured<Rgb565Be>>(2),
        compared::<Textured<Rgb565Le>>(3),
        compared::<Textured<Rgb888>>(4),
        compared::<Textured<Xrgb8888>>(5),
    ];
    assert!(drawn.iter().all(|&pixels| pixels > 100_000), "{drawn:?}");
}

/// Texels that are there from the crate: a picture whose pixels are one texel each shows what their words say.
///
/// Kills: the other colour first, a gradient that begins anew in place of going back.
#[test]
fn checkers_and_gradients_are_what_they_say() {
    let checker = leaked(Checker {
        colours: [0x1111, 0x2222],
        log_side: 3,
    });
    let gradient = leaked(Gradient {
        from: [255, 0, 0],
        to: [0, 0, 255],
        log_length: 6,
        word: Rgb565Be::from_rgb8,
    });
    let upright = |texture| {
        let corner = |x: i32, y: i32| Corner {
            at: (8 * x, 8 * y),
            w: 1.0,
            colour: [255; 3],
        };
        let all = [Papered {
            corners: [corner(0, 0), corner(192, 0), corner(0, 128)],
            places: &[[0, 0], [192 << 8, 0], [0, 128 << 8]],
            budget: Budget::EXACT,
            application: Application::Product,
            dither: false,
        }];
        picture::<Textured<Rgb565Be>>(&all, leaked(texture), 8)
    };
    let squares = upright(Texture::computed(checker, 64, 64).expect("powers of two"));
    let way = upright(Texture::computed(gradient, 128, 1).expect("powers of two"));
    for (y, (squares, way)) in squares.iter().zip(&way).enumerate() {
        for (x, (&square, &colour)) in squares.iter().zip(way).enumerate() {
            assert_eq!(square, [0x1111, 0x2222][(x / 8 + y / 8) % 2], "{x} {y}");
            // There in 64 columns, and back.
            let blue = if x < 64 { x } else { 127 - x } as f64 / 64.0 * 255.0;
            let shown = Rgb565Be::to_rgb8(colour).map(f64::from);
            assert!((shown[2] - blue).abs() < 8.0, "{x}: {shown:?}");
            assert!((shown[0] - 255.0 + blue).abs() < 8.0, "{x}: {shown:?}");
        }
    }
}

/// Texels in memory, in rows, that write down which of them is asked for.
struct Noted {
    texels: &'static [u16],
    log_width: u32,
    asked: Mutex<Vec<[u16; 2]>>,
}

impl Texels for Noted {
    fn texel(&self, column: u16, row: u16) -> u16 {
        self.asked.lock().unwrap().push([column, row]);
        self.texels[usize::from(row) << self.log_width | usize::from(column)]
    }
}

/// A texture in rows and in the blocks of a layout.
struct Slow {
    logs: [u32; 2],
    layout: Blocked,
    rows: &'static [u16],
    blocks: &'static [u16],
}

impl Slow {
    fn new(rng: &mut Rng, logs: [u32; 2], layout: Blocked) -> Self {
        let sides = logs.map(|log| 1u32 << log);
        let rows = words(rng, sides[0] * sides[1]);
        let mut blocks = rows.to_vec();
        layout.arrange(sides, rows, &mut blocks).expect("as large");
        Self {
            logs,
            layout,
            rows,
            blocks: blocks.leak(),
        }
    }

    fn noted(&self) -> &'static Noted {
        leaked(Noted {
            texels: self.rows,
            log_width: self.logs[0],
            asked: Mutex::default(),
        })
    }

    fn texture(&self, texels: &'static dyn Texels) -> Texture<'static> {
        let [width, height] = self.logs.map(|log| 1 << log);
        Texture::computed(texels, width, height).expect("powers of two")
    }

    /// A cache of so many words.
    fn cache(&self, count: usize) -> &'static BlockCache<'static> {
        let fast: Vec<_> = (0..count).map(|_| CacheWord::new()).collect();
        let [width, height] = self.logs.map(|log| 1 << log);
        let slow = Texture::words(self.blocks, width, height).expect("powers of two");
        leaked(BlockCache::new(slow, self.layout, fast.leak()).expect("large enough"))
    }

    /// Columns and rows of a block on this texture.
    fn block(&self) -> [u32; 2] {
        let [width, height] = self.logs.map(|log| 1 << log);
        [
            self.layout.width().min(width),
            self.layout.height().min(height),
        ]
    }

    /// What a cache with a slot for each residue of a block's number does, block after block.
    fn followed(&self, asked: &[[u16; 2]], count: usize) -> (CacheReads, usize) {
        let [width, height] = self.block();
        let across = (1 << self.logs[0]) / width;
        let slots = count / (width * height) as usize;
        let (mut held, mut last) = (vec![None; slots], None);
        let (mut done, mut met) = (CacheReads::default(), BTreeSet::new());
        for at in asked {
            let [x, y] = at.map(u32::from);
            let block = y / height * across + x / width;
            met.insert(block);
            done.reads += 1;
            done.page_changes += u32::from(last.replace(block) != Some(block));
            let slot = &mut held[block as usize % slots];
            done.misses += u32::from(slot.replace(block) != Some(block));
        }
        (done, met.len())
    }
}

/// Kills: a cache that takes a block for another with the same slot, page changes of the last run alone, blocks larger than
/// the texture.
#[test]
fn any_cache_gives_the_same_picture_and_counts_what_it_does() {
    let mut rng = Rng::new(5);
    let (mut hits, mut once) = (0, 0);
    for round in 0..160 {
        let logs = [2 + rng.below(7), 2 + rng.below(7)];
        let layout = Blocked::new(rng.below(6), rng.below(6)).expect("small");
        let slow = Slow::new(&mut rng, logs, layout);
        let all: Vec<_> = (0..4).map(|_| Papered::some(&mut rng)).collect();
        let sampling = rng.pick(&[None, None, Some(Sampling::LINEAR)]);
        let wrap = rng.pick(&[Wrap::Repeat, Wrap::Clamp, Wrap::Mirror]);
        let dressed = |texture: Texture<'static>| {
            let texture = texture.wrapping(wrap);
            leaked(match sampling {
                Some(sampling) => texture.sampled(sampling, &[]).expect("no levels"),
                None => texture,
            })
        };
        type L = Textured<Rgb565Be>;
        let slots = rng.pick(&[1, 8]);
        let noted = slow.noted();
        let want = picture::<L>(&all, dressed(slow.texture(noted)), slots);
        let asked = noted.asked.lock().unwrap().clone();
        let [width, height] = slow.block();
        let block = (width * height) as usize;
        for more in [0, 1, 3, 20] {
            // One slot, some, and one for each texel.
            let count = (block << more).min(slow.rows.len()).max(block);
            let cache = slow.cache(count);
            let drawn = picture::<L>(&all, dressed(cache.texture()), slots);
            assert!(drawn == want, "{round}: {count} words, {layout:?}");
            let (followed, met) = slow.followed(&asked, count);
            assert_eq!(cache.reads(), followed, "{round}: {count}, {layout:?}");
            hits += followed.reads - followed.misses;
            if count == slow.rows.len() {
                assert_eq!(followed.misses as usize, met, "each block once");
                once += 1;
            }
        }
    }
    assert!(hits > 500_000 && once > 100, "{hits}, {once}");
}

/// Threads draw one scene through one cache: the lines are those of one alone.
#[test]
fn threads_share_a_cache() {
    type L = Textured<Rgb565Be>;
    let mut rng = Rng::new(6);
    for _ in 0..12 {
        let layout = Blocked::new(2, 2).expect("small");
        let slow = Slow::new(&mut rng, [6, 6], layout);
        let all: Vec<_> = (0..6).map(|_| Papered::some(&mut rng)).collect();
        let want = picture::<L>(&all, leaked(slow.texture(slow.noted())), 8);
        let texture = leaked(slow.cache(32).texture());
        let mut memory = rooms(&all);
        let scene = &filed::<L>(&mut memory, &all, texture);
        let background = Rgb565Be::from_rgb8([10, 60, 90]);
        let (first, last) = (scene.lines().start, scene.lines().end);
        std::thread::scope(|scope| {
            for thread in 0..2 {
                let want = &want;
                scope.spawn(move || {
                    let mut rooms = LineRooms::fitting(scene, 8, true);
                    let mut renderer = rooms.renderer();
                    for y in (first..last).filter(|y| y % 2 == thread) {
                        let drawn = line(&mut renderer, scene, y, background);
                        assert!(drawn == want[usize::from(y - first)], "line {y}");
                    }
                });
            }
        });
    }
}
