//! Texture places: sides of the texture in a list, texels in a scene.
//!
//! They are made texels of when faces are drawn, because only then it is known of which texture. A
//! strip that goes on keeps the places that it was given.

use super::{Gather, Kind};
use crate::geometry::Coordinate;
use crate::list::{Lent, Place, Reason, Words};
use core::ops::Range;

/// Sides in 4.12 as texels with 8 fraction bits, on a texture with sides of these logarithms.
pub(crate) fn texels([u, v]: [i32; 2], [width, height]: [u8; 2]) -> [i32; 2] {
    // 16 bits and at most 15.
    [u << width.min(15) >> 4, v << height.min(15) >> 4]
}

/// Why there are no places where vertices have some.
const LACKING: Reason = Reason::Lent(Lent::Places);

/// Sides whose texels are a list's places themselves.
pub(super) const RAW: [u8; 2] = [4; 2];

impl<C: Coordinate + Place> Gather<'_, C> {
    /// The places of the vertices from which a strip may go on.
    pub(super) fn kept_places(&self) -> [[i32; 2]; 3] {
        let mut kept = [[0; 2]; 3];
        if matches!(self.kind, Kind::Run { has, .. } if has.places) {
            for (slot, i) in kept.iter_mut().zip(self.strip.corners) {
                let place = self.memory.places.get(self.base + usize::from(i));
                *slot = place.copied().unwrap_or_default();
            }
        }
        kept
    }

    /// Makes texels of the places of what is about to be drawn, on a texture with such sides; which of the memory's places
    /// they are, if there are any.
    ///
    /// # Errors
    /// When there was no memory for them, or they are gone.
    pub(super) fn place<'w>(
        &mut self,
        words: impl Words<'w>,
        run: Range<usize>,
        sides: Option<[u8; 2]>,
    ) -> Result<Option<Range<usize>>, Reason> {
        let Some(sides) = sides else {
            return Ok(None);
        };
        match self.kind {
            Kind::Run { has, .. } if has.places => {
                let places = self.memory.places.get_mut(run.clone());
                for place in places.ok_or(LACKING)? {
                    *place = texels(*place, sides);
                }
                Ok(Some(run))
            }
            Kind::Nothing | Kind::Run { .. } => Ok(None),
            Kind::Table => self.place_table(words, sides),
        }
    }

    /// The same of the table.
    #[inline(never)]
    fn place_table<'w>(
        &mut self,
        words: impl Words<'w>,
        sides: [u8; 2],
    ) -> Result<Option<Range<usize>>, Reason> {
        let textured = self.table.as_mut().and_then(|t| Some((t.texture?, t)));
        let Some((slot, table)) = textured else {
            return Ok(None);
        };
        let n = usize::from(table.count);
        let out = self.memory.places.get_mut(..n).ok_or(LACKING)?;
        if table.placed == Some(sides) {
            return Ok(Some(0..n));
        }
        let first = words.first();
        match table.placed.filter(|_| words.room().is_some()) {
            // Of these no bits were lost.
            Some([width, height]) if width.min(height) >= RAW[0] => {
                for [u, v] in out {
                    let raw = [*u >> (width - RAW[0]), *v >> (height - RAW[1])];
                    [*u, *v] = texels(raw, sides);
                }
            }
            Some(_) if table.at.wrapping_sub(first) >= words.end().wrapping_sub(first) => {
                return Err(LACKING);
            }
            _ => slot.column(words, table.at, out, |_, [u, v, _]| texels([u, v], sides)),
        }
        table.placed = Some(sides);
        Ok(Some(0..n))
    }
}
