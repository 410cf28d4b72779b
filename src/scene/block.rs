//! Texture memory in blocks (B1, B5).
//!
//! Rows of texels are far apart in memory, so a way across the texture that is not along a row changes the page (or
//! misses the cache line) at almost every texel. In blocks, texels that are near each other on the texture are near in
//! memory. A straight way meets at most `width + height - 1` texels of a block, each once: a constant by which a cache
//! can be dimensioned. `host-tests` counts pages for both layouts.

use super::TextureError;
use super::texture::Sides;

/// A layout of texels: block by block, rows of blocks from the top; inside a block row by row.
///
/// Blocks of one row lie as rows lie, so a texture in rows has blocks too: parts of its rows.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocked {
    log_width: u8,
    log_height: u8,
}

impl Blocked {
    /// Blocks of compressed textures.
    pub(super) const COMPRESSED: Self = Self {
        log_width: 2,
        log_height: 2,
    };

    /// Blocks of `2^log_width` by `2^log_height` texels, each at most 32; `None` for more.
    #[must_use]
    pub const fn new(log_width: u32, log_height: u32) -> Option<Self> {
        if log_width <= 5 && log_height <= 5 {
            Some(Self {
                log_width: log_width as u8,
                log_height: log_height as u8,
            })
        } else {
            None
        }
    }

    /// The largest block of texels of `bits` bits that lies in one page or cache line of `bytes` bytes, as square as it
    /// can be, wider rather than higher; 32 x 32 texels at most.
    #[must_use]
    pub const fn of_page(bytes: usize, bits: usize) -> Self {
        let texels = bytes.saturating_mul(8) / if bits == 0 { 1 } else { bits };
        let log = if texels == 0 { 0 } else { texels.ilog2() };
        let log = if log > 10 { 10 } else { log };
        Self {
            log_width: log.div_ceil(2) as u8,
            log_height: (log / 2) as u8,
        }
    }

    /// Texels a row of a block.
    #[must_use]
    pub const fn width(self) -> u32 {
        1 << self.log_width
    }

    /// Rows of a block.
    #[must_use]
    pub const fn height(self) -> u32 {
        1 << self.log_height
    }

    /// The most different texels of one block that a straight way meets.
    #[must_use]
    pub const fn longest_run(self) -> u32 {
        self.width() + self.height() - 1
    }

    /// The block on a texture of such sides: not larger than the texture itself.
    #[inline(always)]
    pub(super) fn within(self, sides: Sides) -> Self {
        Self {
            log_width: self.log_width.min(sides.log_width),
            log_height: self.log_height.min(sides.log_height),
        }
    }

    /// The power of two that its texels are.
    #[inline(always)]
    pub(super) const fn log_texels(self) -> u8 {
        self.log_width + self.log_height
    }

    /// The column and the row within its block of what lies at an index.
    #[inline(always)]
    pub(super) const fn inside(self, index: u32) -> [u32; 2] {
        let inside = index & ((1 << self.log_texels()) - 1);
        [inside & (self.width() - 1), inside >> self.log_width]
    }

    /// Where a texel lies, of a block that is within a texture of `2^log_across` columns.
    #[inline(always)]
    pub(super) const fn place(self, column: u32, row: u32, log_across: u8) -> u32 {
        let (w, h) = (self.log_width, self.log_height);
        let block = (row >> h) << (log_across - w) | column >> w;
        let inside = (row & ((1 << h) - 1)) << w | column & ((1 << w) - 1);
        block << (w + h) | inside
    }

    /// Copies the rows of `width` by `height` texels into this layout. What is lent beyond that is not touched.
    ///
    /// # Errors
    /// When a side is no power of two up to [`MAX_SIDE`](super::Texture::MAX_SIDE), or either slice has fewer texels.
    pub fn arrange<W: Copy>(
        self,
        [width, height]: [u32; 2],
        rows: &[W],
        blocks: &mut [W],
    ) -> Result<(), TextureError> {
        let sides = Sides::new(width, height)?;
        let needed = sides.texels();
        let have = rows.len().min(blocks.len());
        if have < needed {
            return Err(TextureError::Words { needed, have });
        }
        let across = sides.log_width;
        let block = self.within(sides);
        for (i, texel) in (0..).zip(&rows[..needed]) {
            let place = block.place(i & (width - 1), i >> across, across);
            if let Some(to) = blocks.get_mut(place as usize) {
                *to = *texel;
            }
        }
        Ok(())
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::collections::BTreeSet;
    use std::vec;
    use std::vec::Vec;

    /// Kills: blocks of more texels than there are, and one of none.
    #[test]
    fn blocks_of_pages_have_up_to_1024_texels() {
        let sides = |bytes, bits| {
            let block = Blocked::of_page(bytes, bits);
            [block.width(), block.height()]
        };
        for (bytes, bits, want) in [
            (0, 16, [1, 1]),
            (32, 16, [4, 4]),
            (64, 16, [8, 4]),
            (126, 16, [8, 4]),
            (1024, 8, [32, 32]),
            (2047, 8, [32, 32]),
            (1 << 16, 4, [32, 32]),
            (usize::MAX, 0, [32, 32]),
        ] {
            assert_eq!(sides(bytes, bits), want, "{bytes} bytes of {bits} bits");
        }
    }

    /// Kills: a block that is not kept within the texture, rows of blocks by the other side's power of two.
    #[test]
    fn every_layout_is_a_permutation_whose_blocks_are_in_one_piece() {
        for (w, h) in [(1u32, 1u32), (1, 64), (64, 1), (8, 8), (64, 16), (128, 128)] {
            for log_w in 0..6 {
                for log_h in 0..6 {
                    let blocked = Blocked::new(log_w, log_h).unwrap();
                    let rows: Vec<u32> = (0..w * h).collect();
                    let mut blocks = vec![u32::MAX; rows.len()];
                    blocked.arrange([w, h], &rows, &mut blocks).unwrap();
                    let mut sorted = blocks.clone();
                    sorted.sort_unstable();
                    assert_eq!(sorted, rows, "each texel once");
                    let (bw, bh) = (blocked.width().min(w), blocked.height().min(h));
                    for part in blocks.chunks((bw * bh) as usize) {
                        let of = |i: &u32| (i % w / bw, i / w / bh);
                        let inside: Vec<u32> =
                            part.iter().map(|i| i / w % bh * bw + i % w % bw).collect();
                        assert!(part.iter().all(|i| of(i) == of(&part[0])));
                        assert!(inside.iter().copied().eq(0..bw * bh), "row by row");
                    }
                }
            }
        }
        assert!(Blocked::new(6, 0).is_none() && Blocked::new(0, 6).is_none());
    }

    #[test]
    fn what_does_not_fit_is_said() {
        let (layout, mut blocks) = (Blocked::of_page(32, 16), [0u16; 512]);
        assert_eq!((layout.width(), layout.height()), (4, 4));
        let short = layout.arrange([32, 16], &[0; 511], &mut blocks);
        let (needed, have) = (512, 511);
        assert_eq!(short, Err(TextureError::Words { needed, have }));
        let short = layout.arrange([32, 16], &[0; 512], &mut blocks[1..]);
        assert_eq!(short, Err(TextureError::Words { needed, have }));
        let (width, height) = (0, 16);
        let none = layout.arrange([width, height], &[0; 512], &mut blocks);
        assert_eq!(none, Err(TextureError::Side { width, height }));
    }

    #[test]
    fn page_sizes_give_blocks_that_fit() {
        for bytes in [1, 2, 16, 32, 64, 512, 1024, 2048, 65_536] {
            for bits in [1, 2, 4, 6, 8, 16, 24, 32] {
                let block = Blocked::of_page(bytes, bits);
                let texels = (block.width() * block.height()) as usize;
                assert!(texels * bits <= bytes * 8 || texels == 1);
                assert!(texels * bits * 2 > bytes * 8 || texels == 1024);
            }
        }
    }

    /// No straight way meets more texels of a block than the constant, and some meet as many (B1).
    ///
    /// Kills: one texel more or less.
    #[test]
    fn longest_run_is_a_constant_and_is_reached() {
        let mut rng = Rng(5);
        for (log_w, log_h) in [(0, 0), (2, 2), (3, 1), (4, 4), (5, 5)] {
            let blocked = Blocked::new(log_w, log_h).unwrap();
            let mut most = 0;
            for _ in 0..3_000 {
                // With 19 fraction bits; fine steps, so that every texel on the way is met.
                let mut place = |n: u32| i64::from(rng.below(n)) - i64::from(n / 2);
                let [from, step] = [1 << 28, 1 << 18].map(|n| [place(n), place(n)]);
                let mut met: BTreeSet<[i64; 2]> = BTreeSet::new();
                let mut block = None;
                for pixel in 0..400 {
                    let texel = [0, 1].map(|axis| (from[axis] + pixel * step[axis]) >> 19);
                    let now = Some([texel[0] >> log_w, texel[1] >> log_h]);
                    if now != block {
                        met.clear();
                        block = now;
                    }
                    met.insert(texel);
                    most = most.max(met.len() as u32);
                }
            }
            assert_eq!(most, blocked.longest_run());
        }
    }
}
