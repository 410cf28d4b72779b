//! What has no slot: set up for one line (C5).

use super::renderer::{Renderer, View};
use super::slot::Flags;
use super::spans::{Drawn, Line, Span, colour};
use super::thin::depth_plane;
use crate::active::next;
use crate::link::Link;
use crate::look::{Look, WordOf};

/// A triangle without a slot, set up for one line.
pub(super) struct Alone<P> {
    planes: P,
    flags: Flags,
    object: u16,
    pub(super) span: Span,
}

impl<P> Alone<P> {
    /// As it is drawn.
    #[inline(always)]
    pub(super) fn drawn(&self) -> Drawn<'_, P> {
        Drawn {
            planes: &self.planes,
            flags: self.flags,
            object: self.object,
        }
    }
}

impl<L: Look, const WORDS: usize> Renderer<'_, L, WORDS> {
    /// What has no slot, set up for one line; `None` where it has no pixels there.
    #[inline(never)]
    pub(super) fn set_up_alone(
        &mut self,
        object: u16,
        out: &Line<'_, '_, WordOf<L>>,
    ) -> Option<Alone<L::Planes>> {
        let triangle = out.view.triangle_of(object)?;
        let area = triangle.area();
        let size = triangle.size(area);
        let way = triangle.way();
        let sides = triangle.sides(way, out.number as i32, triangle.lines().turn);
        let (start, end) = sides.columns(way, out.number, out.view.frame);
        if start >= end {
            return None;
        }
        let mut planes = L::EMPTY;
        let fill = L::set_up(&triangle, object, size, area, out.view.draws, &mut planes);
        self.counts.set_ups += 1;
        Some(Alone {
            planes,
            flags: Flags::new(fill, way).without_depth(true),
            object,
            span: Span { start, end },
        })
    }

    /// Colours what has no slot, where nobody is yet; `false` as soon as one meets another. What has ended leaves the
    /// chain.
    #[inline(never)]
    pub(super) fn draw_all_alone(&mut self, out: &mut Line<'_, '_, WordOf<L>>) -> bool {
        let (mut before, mut at) = (Link::NONE, self.cache.spilled);
        let mut misses = 0;
        while at.is_some() {
            let after = next(self.links, at);
            let Some(triangle) = out.view.triangle_of(at.object()) else {
                break;
            };
            if triangle.lines().end <= out.number as i32 {
                self.cache.relink(before, after, self.links);
            } else {
                if let Some(alone) = self.set_up_alone(at.object(), out) {
                    if self.covered.cover(alone.span.start, alone.span.end) != 0 {
                        return false;
                    }
                    colour::<L>(alone.drawn(), alone.span, out);
                }
                misses += 1;
                before = at;
            }
            at = after;
        }
        self.counts.misses += misses;
        true
    }

    /// The plane of depth of what has no slot.
    #[inline(never)]
    pub(super) fn find_depth(alone: &mut Alone<L::Planes>, view: &View<'_>) -> [u32; 3] {
        let triangle = view.triangle_of(alone.object);
        let plane = triangle.and_then(|t| depth_plane(&t));
        alone.flags = alone.flags.without_depth(plane.is_none());
        plane.unwrap_or_default()
    }
}

#[cfg(test)]
mod tests {
    use crate::frame::{FastMemory, Memory as Lines, Renderer};
    use crate::geometry::{Affine, Camera, Cull, Faces, Mesh, Screen};
    use crate::link::Link;
    use crate::look::Gouraud;
    use crate::num::random::Rng;
    use crate::pixel::Rgb565;
    use crate::scene::{Draw, DrawState, Memory, NONE, Object, Scene, Vertex};
    use std::vec;
    use std::vec::Vec;

    type Look = Gouraud<Rgb565>;
    const SIDE: u16 = 96;

    /// A few triangles of all sizes at all distances, of which some meet others: their corners and colours.
    fn triangles(rng: &mut Rng, count: usize) -> (Vec<[i16; 3]>, Vec<[u8; 3]>) {
        let (mut positions, mut colours) = (Vec::new(), Vec::new());
        for i in 0..count {
            let mut at = |size: u32| rng.below(size) as i16 - (size / 2) as i16;
            let size = [600, 3000, 9000][i % 3];
            let middle = [at(24_000), at(24_000), at(20_000)];
            for _ in 0..3 {
                positions.push([middle[0] + at(size), middle[1] + at(size), middle[2]]);
                colours.push([0; 3].map(|_| at(256) as u8));
            }
        }
        (positions, colours)
    }

    /// All lines with so many slots, and on how many of them something had none.
    fn drawn(scene: &Scene<'_, '_, Look>, slots: u16, cells: usize) -> (Vec<u16>, u32) {
        let mut fast = FastMemory::<Look, 2>::new();
        fast.set_limit(slots);
        let (mut links, mut depth) = ([Link::NONE; 32], vec![0; cells]);
        let mut renderer = Renderer::new(Lines {
            cache: &mut fast,
            links: &mut links,
            depth: &mut depth,
        });
        let mut picture = vec![0; usize::from(SIDE * SIDE)];
        for (line, pixels) in (0..).zip(picture.chunks_mut(usize::from(SIDE))) {
            renderer.draw_line(scene, line, pixels, 0x1234).unwrap();
        }
        (picture, renderer.counts().misses)
    }

    #[test]
    fn what_has_no_slot_is_drawn_as_what_has_one() {
        let mut rng = Rng(31);
        let mut missed = 0;
        for round in 0..60 {
            let count = 2 + round % 20;
            let (positions, colours) = triangles(&mut rng, count);
            let corners: Vec<u16> = (0..3 * count as u16).collect();
            let faces: Vec<[u16; 3]> = corners.chunks(3).map(|c| [c[0], c[1], c[2]]).collect();
            let mut rooms = ([Vertex::EMPTY; 96], [Object::EMPTY; 32], [NONE; 96]);
            let mut draws = [DrawState::EMPTY; 1];
            let memory = Memory {
                vertices: &mut rooms.0,
                places: &mut [],
                objects: &mut rooms.1,
                bins: &mut rooms.2,
                draws: &mut draws,
            };
            let mut scene = Scene::<Look>::new(Screen::new(SIDE, SIDE).unwrap(), memory);
            let (eye, up) = ([0.0, 0.0, 2.5], [0.0, 1.0, 0.0]);
            let camera = Camera::look_at(eye, [0.0; 3], up, 200.0, 0.1, 100.0).unwrap();
            scene.begin(&camera).unwrap();
            let mesh = Mesh {
                positions: &positions,
                normals: &[],
                colours: &colours,
                faces: Faces::Triangles(&faces),
            };
            let draw = Draw {
                model: Affine::IDENTITY,
                cull: Cull::None,
                ..Draw::new(mesh)
            };
            scene.draw(&draw).unwrap();
            for cells in [0, usize::from(SIDE)] {
                let (want, misses) = drawn(&scene, 64, cells);
                assert_eq!(misses, 0);
                for slots in [0, 1, 2, 3, 5, 9] {
                    let (got, misses) = drawn(&scene, slots, cells);
                    assert!(got == want, "{slots} slots in round {round}");
                    missed += misses;
                }
            }
        }
        assert!(missed > 5000, "{missed}");
    }
}
