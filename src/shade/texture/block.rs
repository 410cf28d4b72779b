//! Texture memory in blocks (B1, B5).
//!
//! Rows of texels are far apart in memory, so a way across the texture that is not along a row
//! changes the page (or misses the cache line) at almost every texel. In blocks, texels that are
//! near each other on the texture are near in memory. A straight way meets at most
//! `width + height - 1` texels of a block, each once: a constant by which a cache can be
//! dimensioned. `host-tests` counts pages for both layouts.

use super::{Size, TextureError, Uv};

/// Where in memory a texel lies.
pub trait Layout: Copy {
    /// The index of the texel in column and row `(x, y)`, both within the size; below the size's
    /// number of texels, and another for each texel.
    fn index(&self, at: (u32, u32), size: Size) -> usize;
}

/// Row by row.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Linear;

impl Layout for Linear {
    #[inline(always)]
    fn index(&self, (x, y): (u32, u32), size: Size) -> usize {
        (y << size.log_width() | x) as usize
    }
}

/// Block by block, rows of blocks from the top; inside a block row by row.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct Blocked {
    log_width: u8,
    log_height: u8,
}

impl Blocked {
    /// Blocks of `2^log_width` by `2^log_height` texels, each at most 32.
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

    /// The largest block of texels of `bits` bits that lies in one page or cache line of `bytes`
    /// bytes, as square as it can be, wider rather than higher.
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

    /// The block on a texture of this size: not larger than the texture itself.
    #[inline(always)]
    const fn logs(self, size: Size) -> (u32, u32) {
        let (w, h) = (self.log_width as u32, self.log_height as u32);
        (
            if w < size.log_width() {
                w
            } else {
                size.log_width()
            },
            if h < size.log_height() {
                h
            } else {
                size.log_height()
            },
        )
    }

    /// Texels of a block on a texture of this size.
    #[must_use]
    pub const fn texels(self, size: Size) -> usize {
        let (w, h) = self.logs(size);
        1 << (w + h)
    }

    /// The most different texels of one block that a straight way meets.
    #[must_use]
    pub const fn longest_run(self) -> u32 {
        self.width() + self.height() - 1
    }

    /// Copies rows of texels into this layout.
    ///
    /// # Errors
    /// When either slice has fewer texels than the size.
    pub fn arrange<W: Copy>(
        self,
        size: Size,
        rows: &[W],
        blocks: &mut [W],
    ) -> Result<(), TextureError> {
        let needed = size.texels();
        let have = rows.len().min(blocks.len());
        if have < needed {
            return Err(TextureError::Texels { needed, have });
        }
        for (i, texel) in rows.iter().enumerate().take(needed) {
            let (x, y) = (i as u32 & (size.width() - 1), i as u32 >> size.log_width());
            if let Some(to) = blocks.get_mut(self.index((x, y), size)) {
                *to = *texel;
            }
        }
        Ok(())
    }

    /// The pixels of a straight way, block by block.
    #[must_use]
    pub fn runs(self, from: Uv, step: Uv, pixels: u32) -> BlockRuns {
        BlockRuns {
            blocks: self,
            place: from,
            step,
            pixel: 0,
            pixels,
        }
    }
}

impl Layout for Blocked {
    #[inline(always)]
    fn index(&self, (x, y): (u32, u32), size: Size) -> usize {
        let (w, h) = self.logs(size);
        let block = (y >> h) << (size.log_width() - w) | x >> w;
        let inside = (y & ((1 << h) - 1)) << w | x & ((1 << w) - 1);
        (block << (w + h) | inside) as usize
    }
}

/// Pixels of a span that follow each other in one block.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub struct BlockRun {
    /// Column and row of the block, not wrapped.
    pub block: (i32, i32),
    /// The first pixel, counted from the span's.
    pub pixel: u32,
    /// How many pixels, at least 1.
    pub pixels: u32,
}

/// The runs of a straight way: see [`Blocked::runs`].
#[derive(Clone, Copy, Debug)]
pub struct BlockRuns {
    blocks: Blocked,
    place: Uv,
    step: Uv,
    pixel: u32,
    pixels: u32,
}

impl BlockRuns {
    fn block(&self) -> (i32, i32) {
        let (x, y) = self.place.texel();
        (x >> self.blocks.log_width, y >> self.blocks.log_height)
    }
}

impl Iterator for BlockRuns {
    type Item = BlockRun;

    fn next(&mut self) -> Option<BlockRun> {
        if self.pixel >= self.pixels {
            return None;
        }
        let (block, pixel) = (self.block(), self.pixel);
        while self.pixel < self.pixels && self.block() == block {
            self.place = self.place.plus(self.step);
            self.pixel += 1;
        }
        Some(BlockRun {
            block,
            pixel,
            pixels: self.pixel - pixel,
        })
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::num::random::Rng;
    use std::collections::BTreeSet;
    use std::vec;

    #[test]
    fn every_layout_is_a_permutation() {
        for (w, h) in [(1, 1), (1, 64), (64, 1), (8, 8), (64, 16), (128, 128)] {
            let size = Size::new(w, h).unwrap();
            for log_w in 0..6 {
                for log_h in 0..6 {
                    let blocked = Blocked::new(log_w, log_h).unwrap();
                    let mut seen = vec![false; size.texels()];
                    for y in 0..h {
                        for x in 0..w {
                            let index = blocked.index((x, y), size);
                            assert!(!core::mem::replace(&mut seen[index], true));
                        }
                    }
                    // A block is contiguous.
                    let texels = blocked.texels(size);
                    let inside = |x: u32, y: u32| blocked.index((x, y), size) / texels;
                    let (bw, bh) = (blocked.width().min(w), blocked.height().min(h));
                    for (x, y) in [(0, 0), (w - bw, h - bh)] {
                        assert_eq!(inside(x, y), inside(x + bw - 1, y + bh - 1));
                    }
                }
            }
        }
    }

    #[test]
    fn arranging_is_reading_by_index() {
        let size = Size::new(32, 16).unwrap();
        let rows: std::vec::Vec<u32> = (0..512).collect();
        let mut blocks = vec![0; 512];
        let layout = Blocked::of_page(32, 16);
        assert_eq!((layout.width(), layout.height()), (4, 4));
        layout.arrange(size, &rows, &mut blocks).unwrap();
        for y in 0..16 {
            for x in 0..32 {
                assert_eq!(blocks[layout.index((x, y), size)], y * 32 + x);
            }
        }
        assert_eq!(
            layout.arrange(size, &rows[1..], &mut blocks),
            Err(TextureError::Texels {
                needed: 512,
                have: 511
            })
        );
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

    /// No way meets more texels of a block than the constant, and some meet as many.
    #[test]
    fn longest_run_is_a_constant_and_is_reached() {
        let mut rng = Rng(5);
        for (log_w, log_h) in [(0, 0), (2, 2), (3, 1), (4, 4), (5, 5)] {
            let blocked = Blocked::new(log_w, log_h).unwrap();
            let mut most = 0;
            for _ in 0..3_000 {
                let mut place = |n| rng.below(n) as i32 - (n / 2) as i32;
                let (from, step) = (
                    Uv {
                        u: place(1 << 28),
                        v: place(1 << 28),
                    },
                    // Fine steps, so that every texel on the way is met.
                    Uv {
                        u: place(1 << 18),
                        v: place(1 << 18),
                    },
                );
                let mut at = 0;
                for run in blocked.runs(from, step, 400) {
                    assert_eq!(run.pixel, at, "runs follow each other");
                    at += run.pixels;
                    let mut met = BTreeSet::new();
                    for pixel in run.pixel..at {
                        let by = |d: i32| d.wrapping_mul(pixel as i32);
                        let place = from.plus(Uv {
                            u: by(step.u),
                            v: by(step.v),
                        });
                        met.insert(place.texel());
                        let (x, y) = place.texel();
                        assert_eq!(run.block, (x >> log_w, y >> log_h));
                    }
                    most = most.max(met.len() as u32);
                }
                assert_eq!(at, 400, "every pixel is in a run");
            }
            assert_eq!(most, blocked.longest_run());
        }
    }
}
