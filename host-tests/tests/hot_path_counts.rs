//! M4: spans and pixels that a renderer counts are those of a reference that goes from pixel to pixel, whatever the
//! scene, the slots and the renderers.
//!
//! The reference has coverage from whole numbers and 1/w in f64, and no spans. Where two depths are nearer to each other
//! than depth may err, a line is left out, and counted.

use crate::common::Rng;
use crate::hot::exact::{doubled_area, within};
use crate::hot::values::{
    Cut, FUNCTIONS, Function, NEARER_OR_EQUAL, WHITE, passes, some_corners, some_mode,
};
use crate::hot::{Corner, LineRooms, SceneRooms, Smooth, WordOf, camera, draw_with, line};
use crate::hot_path_depth::{bound, exact};
use scanbeam::frame::Renderer;
use scanbeam::look::{Gouraud, Textured};
use scanbeam::pixel::{PixelFormat, Rgb565Be, Rgb888};
use scanbeam::scene::{
    Blend, BlendMode, Budget, DepthFunction, DepthTest, Draw, Scene, Shadow, Skin, Texture,
    TexturePlace, Wrap,
};
use scanbeam::stats::SpanCounts;
use scanbeam::{Cull, Screen};
use std::cmp::Ordering;
use std::ops::Range;

const BACKGROUND: [u8; 3] = [0; 3];
const SLOTS: [u16; 5] = [0, 1, 3, 9, 128];

/// A texture that leaves colours as they are, with holes in half of its columns.
static HOLED: Texture<'static> = {
    const KEY: u16 = 0x1234;
    static WORDS: [u16; 64] = {
        let mut words = [0xFFFF; 64];
        let mut i = 0;
        while i < 64 {
            if i % 8 < 4 {
                words[i] = KEY;
            }
            i += 1;
        }
        words
    };
    match Texture::words(&WORDS, 8, 8) {
        Ok(texture) => texture.wrapping(Wrap::Repeat).keyed(KEY),
        Err(_) => panic!("8 x 8 texels"),
    }
};

/// What a draw call has for a texture.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Skinned {
    Bare,
    Whole,
    Holed,
}

/// A draw call of one triangle, and its values.
#[derive(Clone, Debug)]
struct Call {
    corners: [Corner; 3],
    cut: Option<Cut>,
    test: [Function; 2],
    blend: Option<BlendMode>,
    priority: u8,
    skin: Skinned,
    dither: bool,
    shadow: Option<Shadow>,
}

/// What scenes have besides triangles.
#[derive(Clone, Copy, Debug, PartialEq)]
enum Kind {
    Bare,
    Ranked,
    Valued,
    ValuedAndRanked,
    Shadowed,
}

const KINDS: [Kind; 5] = [
    Kind::Bare,
    Kind::Ranked,
    Kind::Valued,
    Kind::ValuedAndRanked,
    Kind::Shadowed,
];

impl Call {
    fn new(rng: &mut Rng, screen: Screen, kind: Kind) -> Self {
        let mut call = Self {
            corners: some_corners(rng, screen),
            cut: None,
            test: [NEARER_OR_EQUAL; 2],
            blend: None,
            priority: 0,
            skin: rng.pick(&[Skinned::Bare, Skinned::Whole]),
            dither: false,
            shadow: None,
        };
        for corner in &mut call.corners {
            corner.colour = [255; 3];
        }
        if matches!(kind, Kind::Ranked | Kind::ValuedAndRanked) {
            call.priority = 1 + rng.below(4) as u8;
        }
        if matches!(kind, Kind::Valued | Kind::ValuedAndRanked) {
            call.cut = (rng.below(4) == 0).then(|| Cut::new(rng, screen));
            call.blend = (rng.below(4) == 0).then(|| some_mode(rng));
            call.dither = rng.below(8) == 0;
            if rng.below(4) == 0 {
                call.test = [(); 2].map(|()| rng.pick(&FUNCTIONS));
            }
            if rng.below(4) == 0 {
                call.skin = Skinned::Holed;
            }
        }
        call
    }

    /// Triangles of a kind; some are there twice, so that depths are equal.
    fn some(rng: &mut Rng, screen: Screen, kind: Kind) -> Vec<Self> {
        let many = rng.pick(&[3, 8, 8, 20]);
        let mut calls: Vec<Self> = Vec::new();
        for _ in 0..1 + rng.below(many) {
            let mut call = Self::new(rng, screen, kind);
            if let (0, Some(last)) = (rng.below(5), calls.last()) {
                call.corners = last.corners;
            }
            calls.push(call);
        }
        if kind != Kind::Shadowed {
            return calls;
        }
        let mut more = Vec::new();
        for call in &calls {
            for _ in 0..rng.below(3) {
                let light = rng.pick(&[0, 5]);
                let mut call = call.clone();
                call.shadow = Some(rng.pick(&[Shadow::Lit(light), Shadow::Shadowed(light)]));
                call.blend = rng.pick(&[None, Some(BlendMode::Add(200))]);
                call.skin = rng.pick(&[Skinned::Bare, Skinned::Whole, Skinned::Holed]);
                call.cut = (rng.below(5) == 0).then(|| Cut::new(rng, screen));
                more.push(call);
            }
        }
        for _ in 0..rng.below(many) {
            let mut call = Self::new(rng, screen, kind);
            call.shadow = Some(Shadow::Volume(rng.pick(&[0, 5, 6])));
            call.cut = (rng.below(5) == 0).then(|| Cut::new(rng, screen));
            more.push(call);
        }
        calls.append(&mut more);
        rng.shuffle(&mut calls);
        calls
    }

    fn dress(&self, call: &mut Draw<'_, '_, i32>, is_textured: bool) {
        let texture = match self.skin {
            Skinned::Bare => None,
            Skinned::Whole => Some(&WHITE),
            Skinned::Holed => Some(&HOLED),
        };
        call.texture = texture.filter(|_| is_textured).map(|texture| Skin {
            texture,
            places: &[[0, 0], [60 << 8, 0], [0, 40 << 8]],
            budget: Budget::BALANCED,
        });
        call.cull = Cull::None;
        call.scissor = self.cut.as_ref().map(Cut::scissor);
        let [colour_if, depth_if] = self.test.map(|(function, _)| function);
        call.depth = DepthTest {
            colour_if,
            depth_if,
        };
        call.priority = self.priority;
        call.blend = self.blend.map(Blend::new);
        call.dither = self.dither;
        call.shadow = self.shadow;
    }

    fn is_translucent(&self) -> bool {
        self.blend.is_some_and(|mode| mode != BlendMode::Replace)
    }

    /// Whether its depth is compared wherever it is.
    fn compares(&self) -> bool {
        let differs = |f: Function| f.0 != DepthFunction::NEARER_OR_EQUAL;
        self.blend.is_some() || self.shadow.is_some() || self.test.into_iter().any(differs)
    }

    fn has_values(&self, is_textured: bool) -> bool {
        let has_holes = is_textured && self.skin == Skinned::Holed;
        self.cut.is_some() || self.dither || has_holes || self.compares()
    }

    /// How it compares with another at a pixel; `None` where that hangs on what depth may err.
    fn compare(&self, other: Option<&Self>, [x, y]: [u16; 2]) -> Option<Ordering> {
        let Some(other) = other else {
            // Nothing is as far as what nobody has drawn.
            return Some(Ordering::Greater);
        };
        let same = |(a, b): (&Corner, &Corner)| a.at == b.at && a.w == b.w;
        if self.corners.iter().zip(&other.corners).all(same) {
            return Some(Ordering::Equal);
        }
        let depth = |call: &Self| exact(&call.corners, x.into(), y);
        let apart = depth(self) - depth(other);
        let off = bound(&self.corners) + bound(&other.corners);
        (apart.abs() > off).then(|| apart.total_cmp(&0.0))
    }
}

/// A line of calls as the reference has it.
struct Row<'a> {
    calls: &'a [Call],
    y: u16,
    is_textured: bool,
    /// Whether depth is compared.
    is_deep: bool,
    /// The columns of each call, before it is cut.
    columns: Vec<Range<usize>>,
    /// Of each call its pixels that are no holes.
    opaque: &'a [Vec<Vec<bool>>],
}

/// What becomes of one call's pixels.
#[derive(Default)]
struct Told {
    all: u32,
    seen: u32,
    hidden: u32,
    tests: u32,
    fetched: u32,
}

impl Row<'_> {
    fn is_covered(&self, i: usize, x: usize) -> bool {
        self.columns[i].contains(&x)
    }

    /// The pixels of a call that its scissor keeps.
    fn kept(&self, i: usize) -> Vec<usize> {
        let cut = self.calls[i].cut.as_ref();
        let keeps = |&x: &usize| cut.is_none_or(|cut| cut.keeps(x as u16, self.y));
        self.columns[i].clone().filter(keeps).collect()
    }

    fn has_texels(&self, i: usize) -> bool {
        self.is_textured && self.calls[i].skin != Skinned::Bare
    }

    /// Whether a pixel is a hole.
    fn is_hole(&self, i: usize, x: usize) -> bool {
        let is_holed = self.is_textured && self.calls[i].skin == Skinned::Holed;
        is_holed && !self.opaque[i][usize::from(self.y)][x]
    }

    /// Whether a call shares a column with another.
    fn meets(&self, i: usize) -> bool {
        let meets = |&x: &usize| (0..self.calls.len()).any(|k| k != i && self.is_covered(k, x));
        self.columns[i].clone().any(|x| meets(&x))
    }

    /// The figures; `None` where they hang on what depth may err.
    fn counts(&self) -> Option<SpanCounts> {
        let mut counts = SpanCounts::default();
        let here = |i: &usize| !self.columns[*i].is_empty();
        let all: Vec<usize> = (0..self.calls.len()).filter(here).collect();
        let valued = |&i: &usize| self.calls[i].has_values(self.is_textured);
        if !all.iter().any(valued) {
            self.bare(&all, &mut counts)?;
        } else if self.is_deep {
            self.deep(&all, &mut counts)?;
        } else {
            self.in_order(&all, &mut counts);
        }
        Some(counts)
    }

    fn add(counts: &mut SpanCounts, told: &Told, is_untested: bool) {
        if told.all > 0 {
            counts.spans += 1;
            counts.spans_hidden += u32::from(told.seen == 0);
            counts.spans_untested += u32::from(is_untested);
            counts.pixels_shaded += told.seen;
            counts.pixels_hidden += told.hidden;
            counts.depth_tests += told.tests;
            counts.texture_fetches += told.fetched;
        }
    }

    /// Without values: of each column one call is seen.
    fn bare(&self, all: &[usize], counts: &mut SpanCounts) -> Option<()> {
        for &i in all {
            let mut told = Told::default();
            for x in self.columns[i].clone() {
                let mut is_seen = true;
                for &k in all.iter().filter(|&&k| k != i && self.is_covered(k, x)) {
                    let (a, b) = (&self.calls[i], &self.calls[k]);
                    let order = if self.is_deep {
                        a.compare(Some(b), [x as u16, self.y])?
                    } else {
                        a.priority.cmp(&b.priority)
                    };
                    is_seen &= order.then(i.cmp(&k)).is_gt();
                }
                told.all += 1;
                told.seen += u32::from(is_seen);
                told.hidden += u32::from(!is_seen);
                told.fetched += u32::from(is_seen && self.has_texels(i));
            }
            Self::add(counts, &told, !self.meets(i));
        }
        Some(())
    }

    /// With values and without depth: one over the other.
    fn in_order(&self, all: &[usize], counts: &mut SpanCounts) {
        for &i in all {
            let is_in_vain = matches!(
                self.calls[i].shadow,
                Some(Shadow::Volume(_) | Shadow::Shadowed(_))
            );
            if !is_in_vain {
                let kept = self.kept(i);
                let seen = kept.iter().filter(|&&x| !self.is_hole(i, x)).count() as u32;
                let told = Told {
                    all: kept.len() as u32,
                    seen,
                    fetched: if self.has_texels(i) {
                        kept.len() as u32
                    } else {
                        0
                    },
                    ..Told::default()
                };
                Self::add(counts, &told, !self.meets(i));
            }
        }
    }

    /// With values and depth.
    fn deep(&self, all: &[usize], counts: &mut SpanCounts) -> Option<()> {
        let mut cells: Vec<Option<usize>> = vec![None; 2_000];
        // Where spans meet, or one compares.
        let asked = |x: usize| {
            let here: Vec<_> = all.iter().filter(|&&k| self.is_covered(k, x)).collect();
            here.len() > 1 || here.iter().any(|&&k| self.calls[k].compares())
        };
        let is_late = |i: usize| self.calls[i].shadow.is_some() || self.calls[i].is_translucent();
        for &i in all.iter().filter(|&&i| !is_late(i)) {
            let is_compared = self.columns[i].clone().any(asked);
            let told = self.laid(i, is_compared, &mut cells)?;
            Self::add(counts, &told, !is_compared);
        }
        for light in 0..8 {
            self.light(light, all, &cells, counts)?;
        }
        for &i in all.iter().filter(|&&i| is_late(i)) {
            if self.calls[i].shadow.is_none() {
                let told = self.laid(i, true, &mut cells.clone())?;
                Self::add(counts, &told, false);
            }
        }
        Some(())
    }

    /// A call that is laid over what is there.
    fn laid(&self, i: usize, is_compared: bool, cells: &mut [Option<usize>]) -> Option<Told> {
        let call = &self.calls[i];
        let is_holed = self.is_textured && call.skin == Skinned::Holed;
        let mut told = Told::default();
        for x in self.kept(i) {
            told.all += 1;
            told.fetched += u32::from(is_holed);
            if self.is_hole(i, x) {
                continue;
            }
            let mut is_seen = true;
            if is_compared {
                let there = cells[x].map(|k| &self.calls[k]);
                let order = call.compare(there, [x as u16, self.y])?;
                told.tests += 1;
                is_seen = passes(call.test[0], order);
                if passes(call.test[1], order) {
                    cells[x] = Some(i);
                }
            }
            told.seen += u32::from(is_seen);
            told.hidden += u32::from(!is_seen);
            told.fetched += u32::from(is_seen && !is_holed && self.has_texels(i));
        }
        Some(told)
    }

    /// The volumes of a light, and what is seen again by it.
    fn light(
        &self,
        light: u8,
        all: &[usize],
        cells: &[Option<usize>],
        counts: &mut SpanCounts,
    ) -> Option<()> {
        let of = |i: usize, shadow: Shadow| self.calls[i].shadow == Some(shadow);
        let receives = |&i: &usize| of(i, Shadow::Lit(light)) || of(i, Shadow::Shadowed(light));
        if !all.iter().any(receives) {
            return Some(());
        }
        let mut inside = vec![0; cells.len()];
        for &i in all.iter().filter(|&&i| of(i, Shadow::Volume(light))) {
            let is_front = doubled_area(self.calls[i].corners.map(|c| c.at)) > 0;
            for x in self.kept(i) {
                counts.depth_tests += 1;
                let there = cells[x].map(|k| &self.calls[k]);
                if self.calls[i].compare(there, [x as u16, self.y])? == Ordering::Greater {
                    inside[x] += if is_front { -1 } else { 1 };
                }
            }
        }
        let mut done = vec![false; cells.len()];
        for &i in all.iter().filter(|i| receives(i)) {
            let mut told = Told::default();
            let is_once = self.calls[i].is_translucent();
            for x in self.kept(i) {
                told.all += 1;
                let is_due = (inside[x] != 0) == of(i, Shadow::Shadowed(light));
                let mut is_seen = false;
                if is_due && !(is_once && done[x]) {
                    told.tests += 1;
                    let there = cells[x].map(|k| &self.calls[k]);
                    let order = self.calls[i].compare(there, [x as u16, self.y])?;
                    is_seen = order == Ordering::Equal;
                    done[x] |= is_seen && is_once;
                }
                told.hidden += u32::from(!is_seen);
                told.fetched += u32::from(is_seen && self.has_texels(i));
                told.seen += u32::from(is_seen && !self.is_hole(i, x));
            }
            Self::add(counts, &told, false);
        }
        Some(())
    }
}

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
    scene.begin(&camera()).expect("the rooms are large enough");
    for call in calls {
        draw_with(&mut scene, &[call.corners], |draw| {
            call.dress(draw, L::TEXTURED);
        })
        .expect("there is room");
    }
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
        less(now, core::mem::replace(&mut before, now))
    };
    scene.lines().map(of_line).collect()
}

fn less(a: SpanCounts, b: SpanCounts) -> SpanCounts {
    SpanCounts {
        spans: a.spans - b.spans,
        spans_hidden: a.spans_hidden - b.spans_hidden,
        spans_untested: a.spans_untested - b.spans_untested,
        pixels_shaded: a.pixels_shaded - b.pixels_shaded,
        pixels_hidden: a.pixels_hidden - b.pixels_hidden,
        depth_tests: a.depth_tests - b.depth_tests,
        texture_fetches: a.texture_fetches - b.texture_fetches,
    }
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
