//! A run of pixels of one surface, by the rules of its finish.

use super::super::spans::{Brush, colour, count_fetches};
use crate::composite::{Blender, PixelAlpha, TextureSource};
use crate::geometry::Blend;
use crate::pipeline::{CellOf, LevelsOf, Pipeline, WordOf};
use crate::shade::Levels;
use crate::visible::{DepthRamp, Everywhere, LineDepth, MOST, Rule};

/// Words on the stack, so aligned that two of 16 bits can be read as one.
#[repr(align(4))]
struct Words<W>([W; MOST + 1]);

/// What pixels of a surface are held against, and their own depth.
pub(super) struct There<'c, P: Pipeline> {
    pub(super) cells: &'c mut [CellOf<P>],
    pub(super) depth: DepthRamp,
    /// How the depth of the surface is rounded.
    pub(super) grain: <P::Depth as LineDepth>::Grain,
}

impl<P: Pipeline> Brush<'_, '_, P> {
    /// Draws at most [`MOST`] pixels by the rules of a finish: their depth is that of the first
    /// and a step. How many are seen.
    #[inline(never)]
    pub(super) fn blend(
        &mut self,
        levels: &LevelsOf<P>,
        (column, line): (i32, i32),
        pixels: &mut [WordOf<P>],
        there: There<'_, P>,
    ) -> u32 {
        let Some(finish) = levels.finish() else {
            return 0;
        };
        let rules = &finish.rules;
        let textures = self.scene.textures();
        let is_factor = matches!(rules.blend, Blend::Factors { .. });
        let by_texel = rules.texel_alpha || rules.force_additive || is_factor;
        let mut alphas = [PixelAlpha::OPAQUE; MOST];
        let mut keep = u32::MAX;
        let varies = finish.varies() || by_texel;
        if varies {
            let alphas = &mut alphas[..pixels.len().min(MOST)];
            if let Some((index, place)) = levels.texture(column, line).filter(|_| by_texel) {
                textures.alphas(index, alphas, (place, levels.detail()));
            }
            for ((i, alpha), column) in alphas.iter_mut().enumerate().zip(column..) {
                alpha.surface = finish.alpha(column, line);
                alpha.additive &= rules.force_additive;
                if !(rules.texel_alpha || is_factor) {
                    alpha.texel = 255;
                }
                if rules.blend == Blend::Replace && alpha.texel == 0 {
                    keep &= !(1 << i);
                }
            }
        }
        let rule = Rule {
            colour_if: rules.colour_if,
            depth_if: rules.depth_if,
        };
        let seen = rule.apply::<P::Depth>(there.cells, there.depth, there.grain, keep);
        if seen == 0 {
            return 0;
        }
        // At the same half of a word as the pixels, which lie anywhere.
        let mut words = Words([WordOf::<P>::default(); MOST + 1]);
        let half = (pixels.as_ptr().addr() / size_of::<WordOf<P>>().max(1)) & 1;
        let words = &mut words.0[half..][..pixels.len().min(MOST)];
        colour::<P, _>(words, levels, (column, line), self.how(), &mut Everywhere);
        let blender = Blender::new(rules);
        let mut rest = seen;
        while rest != 0 {
            // A run of pixels that are seen.
            let from = rest.trailing_zeros();
            let run = (!(rest >> from)).trailing_zeros();
            let range = from as usize..(from + run) as usize;
            rest &= u32::MAX.checked_shl(from + run).unwrap_or(0);
            let (old, new) = (&mut pixels[range.clone()], &words[range.clone()]);
            if varies {
                for ((old, &new), &alpha) in old.iter_mut().zip(new).zip(&alphas[range]) {
                    *old = blender.pixel::<P::Pixel>(*old, new, alpha);
                }
            } else {
                blender.blend::<P::Pixel>(old, new);
            }
        }
        count_fetches::<P>(
            levels,
            (column, line),
            textures,
            seen.count_ones(),
            self.counter,
        );
        seen.count_ones()
    }
}
