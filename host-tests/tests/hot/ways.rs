//! All ways to draw the lines of a scene, of which none may change a bit: any cache, any order, alone, by several
//! renderers, on several threads.

use super::cover::Picture;
use super::{LineRooms, Smooth, WordOf, frame, line};
use crate::common::Rng;
use scanbeam::scene::Scene;

/// Slots of caches, from none to as many as there are.
pub const SLOTS: [u16; 8] = [0, 1, 2, 3, 7, 16, 64, 128];

/// The lines of a scene as one renderer draws them from the top, with so many slots, and what is behind them.
pub struct Lines<'a, 'm, L: Smooth> {
    pub scene: &'a Scene<'m, 'static, L>,
    pub depth: bool,
    pub background: WordOf<L>,
}

impl<L: Smooth> Lines<'_, '_, L>
where
    WordOf<L>: std::fmt::Debug + PartialEq,
{
    /// The frame, which is the same for every cache.
    pub fn whole(&self, name: &str) -> Picture<WordOf<L>> {
        let picture = |slots| frame(self.scene, slots, self.depth, self.background);
        let want = picture(128);
        for slots in SLOTS {
            let name = format!("{name}, {slots} slots");
            for (y, (want, got)) in (0..).zip(want.iter().zip(picture(slots))) {
                self.same(want, &got, y, &name);
            }
        }
        want
    }

    /// One line by somebody, which has to be that of the frame.
    fn hold(
        &self,
        renderer: &mut scanbeam::Renderer<'_, L, 4>,
        y: u16,
        want: &[Vec<WordOf<L>>],
        name: &str,
    ) {
        let got = line(renderer, self.scene, y, self.background);
        let first = self.scene.lines().start;
        self.same(&want[usize::from(y - first)], &got, y, name);
    }

    fn same(&self, want: &[WordOf<L>], got: &[WordOf<L>], y: u16, name: &str) {
        assert_eq!(want.len(), got.len(), "{name}, line {y}");
        if let Some(x) = want.iter().zip(got).position(|(w, g)| w != g) {
            panic!(
                "{name}, line {y}, column {x}, depth {}: {:?} is drawn {:?}",
                self.depth, want[x], got[x]
            );
        }
    }

    /// Draws the lines in every other way there is.
    pub fn every_way(&self, want: &[Vec<WordOf<L>>], rng: &mut Rng, name: &str) {
        // In random order, by one renderer that keeps its cache; then down with gaps.
        let mut order: Vec<u16> = self.scene.lines().collect();
        rng.shuffle(&mut order);
        let slots = rng.pick(&SLOTS);
        let mut rooms = LineRooms::fitting(self.scene, slots, self.depth);
        let mut renderer = rooms.renderer();
        for &y in &order {
            let name = format!("{name}, random order, {slots} slots");
            self.hold(&mut renderer, y, want, &name);
        }
        let mut y = self.scene.lines().start;
        while self.scene.lines().contains(&y) {
            let name = format!("{name}, gaps, {slots} slots");
            self.hold(&mut renderer, y, want, &name);
            y += 1 + rng.below(9) as u16;
        }
        // Alone, by a fresh renderer in fresh memory.
        for &y in order.iter().take(24) {
            let mut rooms = LineRooms::fitting(self.scene, slots, self.depth);
            let name = format!("{name}, alone, {slots} slots");
            self.hold(&mut rooms.renderer(), y, want, &name);
        }
        for count in 2..=4 {
            let band = 1 + rng.below(5) as u16;
            self.by_several(want, count, band, rng, name);
        }
    }

    /// By several renderers with unlike caches, of which each has so many lines in turn.
    pub fn by_several(
        &self,
        want: &[Vec<WordOf<L>>],
        count: u16,
        band: u16,
        rng: &mut Rng,
        name: &str,
    ) {
        let slots: Vec<_> = (0..count).map(|_| rng.pick(&SLOTS)).collect();
        let name = format!("{name}, by turns of {band} lines with {slots:?} slots");
        let rooms = slots
            .iter()
            .map(|&slots| LineRooms::fitting(self.scene, slots, self.depth));
        let mut rooms: Vec<_> = rooms.collect();
        let mut renderers: Vec<_> = rooms.iter_mut().map(LineRooms::renderer).collect();
        for y in self.scene.lines() {
            let own = &mut renderers[usize::from(y / band % count)];
            self.hold(own, y, want, &name);
        }
        for (renderer, &slots) in renderers.iter().zip(&slots) {
            let counts = renderer.counts();
            assert!(counts.peak <= u32::from(slots), "{name}: {counts:?}");
            assert!(slots > 0 || counts.hits == 0, "{name}: {counts:?}");
        }
    }
}
