//! Vertices that were set up beforehand: strips and fans on the screen (H11).

use super::gather::texels;
use crate::list::{Run, Strip, Words};
use crate::scene::ScreenCorner;
use crate::scene::ScreenVertex;
use heapless::Vec;

/// Triangles that are drawn together.
const AT_ONCE: usize = 16;

/// A strip or fan of long vertices, as far as it has come.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LongStrip {
    pub(super) strip: Strip,
    /// Its last three vertices, and room for the next.
    vertices: [ScreenCorner; 4],
    alphas: [u8; 4],
}

impl LongStrip {
    /// Takes the vertices of a block; each of them has this colour, unless it has one of its own. Places on a texture with
    /// sides of these logarithms are made texels of. Triangles go to `draw`, some at a time, with the alphas of their
    /// corners.
    pub(super) fn take<'w>(
        &mut self,
        words: impl Words<'w>,
        run: Run,
        colour: [u8; 3],
        sides: Option<[u8; 2]>,
        mut draw: impl FnMut(&[[ScreenCorner; 3]], &[u8]),
    ) {
        let header = run.header;
        if header.new {
            self.strip.restart();
        }
        let mut rest = (0..).map(|n| words.word(run.at.wrapping_add(n)));
        let mut next = || rest.next().unwrap_or(0);
        let mut faces: Vec<[ScreenCorner; 3], AT_ONCE> = Vec::new();
        let mut alphas: Vec<[u8; 3], AT_ONCE> = Vec::new();
        for _ in 0..header.count {
            let place = next();
            let mut corner = ScreenCorner {
                vertex: ScreenVertex {
                    x: place as i16,
                    y: (place >> 16) as i16,
                    depth: if header.prsp { next() } else { 1 << 31 },
                    colour,
                },
                texel: [0; 2],
            };
            let mut alpha = 255;
            if header.shade {
                let [r, g, b, a] = next().to_le_bytes();
                (corner.vertex.colour, alpha) = ([r, g, b], a);
            }
            if header.text {
                let word = next();
                let sides = sides.unwrap_or_default();
                corner.texel = texels([(word & 0xFFFF) as i32, (word >> 16) as i32], sides);
            }
            let kept = &self.strip.corners[..usize::from(self.strip.have).min(3)];
            // Of four at most three are kept.
            let free = (0..4).find(|i| !kept.contains(i)).unwrap_or_default();
            self.vertices[usize::from(free)] = corner;
            self.alphas[usize::from(free)] = alpha;
            let Some(face) = self.strip.push(free, header.rm) else {
                continue;
            };
            if faces.is_full() {
                draw(&faces, alphas.as_flattened());
                faces.clear();
                alphas.clear();
            }
            // There is room.
            let _ = faces.push(face.map(|i| self.vertices[usize::from(i) & 3]));
            let _ = alphas.push(face.map(|i| self.alphas[usize::from(i) & 3]));
        }
        if !faces.is_empty() {
            draw(&faces, alphas.as_flattened());
        }
    }
}
