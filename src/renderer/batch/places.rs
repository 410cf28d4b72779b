//! Texture places: sides of the texture in a list, texels in a scene.
//!
//! They are made texels of when faces are drawn, because only then it is known of which texture. A
//! strip that goes on keeps the places that it was given.

use super::{Batch, Kind, ListCoordinate, Target};
use crate::event::{Event, EventSink};
use crate::geometry::{LightingModel, Shading};
use crate::list::Words;
use crate::pipeline::Pipeline;
use core::ops::Range;

/// Sides in 4.12 as texels with 8 fraction bits, on a texture with sides of these logarithms.
pub(super) fn texels([u, v]: [i32; 2], [width, height]: [u8; 2]) -> [i32; 2] {
    // 16 bits and at most 15.
    [u << width.min(15) >> 4, v << height.min(15) >> 4]
}

impl<C: ListCoordinate> Batch<'_, C> {
    /// The places of the vertices from which a strip may go on.
    pub(super) fn kept_places<P: Pipeline>(&self) -> [[i32; 2]; 3] {
        let mut kept = [[0; 2]; 3];
        let places = matches!(self.kind, Kind::Run { has, .. } if has.places);
        if P::Shading::TEXTURED && places {
            for (slot, i) in kept.iter_mut().zip(self.strip.corners) {
                let place = self.memory.places.get(self.base + usize::from(i));
                *slot = place.copied().unwrap_or_default();
            }
        }
        kept
    }

    /// Makes texels of the places of what is about to be drawn; where they are then.
    pub(super) fn place<'w, P: Pipeline, E: EventSink, M: LightingModel>(
        &mut self,
        words: impl Words<'w>,
        run: Range<usize>,
        target: &mut Target<'_, '_, P, E, M>,
    ) -> Option<Range<usize>> {
        let (bound, _) = target.texture.filter(|_| P::Shading::TEXTURED)?;
        let sides = bound.log_sides;
        match self.kind {
            Kind::Nothing => None,
            Kind::Run { has, .. } => {
                let places = self.memory.places.get_mut(run.clone());
                for place in places.filter(|_| has.places)? {
                    *place = texels(*place, sides);
                }
                Some(run)
            }
            Kind::Table => {
                let table = self.table.as_mut()?;
                let slot = table.texture?;
                let n = usize::from(table.count);
                let Some(out) = self.memory.places.get_mut(..n) else {
                    target.notice(Event::Full, 0);
                    return None;
                };
                if table.placed != Some(sides) {
                    slot.column(words, table.at, out, |[u, v, _]| texels([u, v], sides));
                    table.placed = Some(sides);
                }
                Some(0..n)
            }
        }
    }
}
