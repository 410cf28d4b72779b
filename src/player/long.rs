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
    strip: Strip,
    /// Its last three vertices, and room for the next.
    vertices: [ScreenCorner; 4],
}

impl LongStrip {
    /// Another one begins.
    pub(super) fn restart(&mut self) {
        self.strip.restart();
    }

    /// Takes the vertices of a block; each of them has this colour, unless it has one of its own. Places on a texture with
    /// sides of these logarithms are made texels of. Triangles go to `draw`, some at a time.
    pub(super) fn take<'w>(
        &mut self,
        words: impl Words<'w>,
        run: Run,
        colour: [u8; 3],
        sides: Option<[u8; 2]>,
        mut draw: impl FnMut(&[[ScreenCorner; 3]]),
    ) {
        let header = run.header;
        if header.new {
            self.strip.restart();
        }
        let mut at = run.at;
        let mut next = || {
            let word = words.word(at);
            at = at.wrapping_add(1);
            word
        };
        let mut faces: Vec<[ScreenCorner; 3], AT_ONCE> = Vec::new();
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
            if header.shade {
                let [r, g, b, _] = next().to_le_bytes();
                corner.vertex.colour = [r, g, b];
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
            let Some(face) = self.strip.push(free, header.rm) else {
                continue;
            };
            let face = face.map(|i| self.vertices[usize::from(i) & 3]);
            if faces.push(face).is_err() {
                draw(&faces);
                faces.clear();
                // There is room now.
                let _ = faces.push(face);
            }
        }
        if !faces.is_empty() {
            draw(&faces);
        }
    }
}
