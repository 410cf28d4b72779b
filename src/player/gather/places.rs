//! Texture places: sides of the texture in a list, texels in a scene.
//!
//! They are made texels of when faces are drawn, because only then it is known of which texture. A
//! strip that goes on keeps the places that it was given.

use super::{Gather, Kind, Out};
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
    /// Makes texels of the places of what is about to be drawn, on a texture with such sides; which of the memory's places
    /// they are, if there are any.
    ///
    /// # Errors
    /// When there was no memory for them, or they are gone.
    pub(super) fn place<'w>(
        &mut self,
        run: Range<usize>,
        out: &Out<'_, C, impl Words<'w>>,
    ) -> Result<Option<Range<usize>>, Reason> {
        let Some(sides) = out.sides else {
            return Ok(None);
        };
        match self.kind {
            Kind::Run { has, .. } if has.places => {
                let places = self.places.get_mut(run.clone());
                for place in places.ok_or(LACKING)? {
                    *place = texels(*place, sides);
                }
                Ok(Some(run))
            }
            Kind::Nothing | Kind::Run { .. } => Ok(None),
            Kind::Table => self.place_table(out.words, sides),
        }
    }

    /// The same of the table.
    #[inline(never)]
    fn place_table<'w>(
        &mut self,
        words: impl Words<'w>,
        sides: [u8; 2],
    ) -> Result<Option<Range<usize>>, Reason> {
        let textured = self
            .table
            .as_mut()
            .and_then(|t| Some((t.layout.texture?, t)));
        let Some((slot, table)) = textured else {
            return Ok(None);
        };
        let (at, n) = (table.run.at, usize::from(table.run.header.count));
        let out = self.places.get_mut(..n).ok_or(LACKING)?;
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
            Some(_) if at.wrapping_sub(first) >= words.end().wrapping_sub(first) => {
                return Err(LACKING);
            }
            _ => slot.column(words, at, out, |_, [u, v, _]| texels([u, v], sides)),
        }
        table.placed = Some(sides);
        Ok(Some(0..n))
    }
}
