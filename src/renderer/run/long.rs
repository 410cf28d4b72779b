//! Vertices that were set up beforehand, straight into the scene (H11).
//!
//! Nothing is gathered: a piece of a strip at a time is unpacked on the stack and drawn.

use super::target::Target;
use crate::event::EventSink;
use crate::geometry::{LightingModel, ScreenVertex, Shading};
use crate::list::{Run, Strip, Words};
use crate::pipeline::Pipeline;
use crate::player::texels;

/// Vertices a piece; up to three of them are those of the piece before.
const PIECE: usize = 32;

/// The last vertices of a strip, and their texture places, in its order of corners.
#[derive(Clone, Copy, Debug, Default)]
pub(super) struct LongStrip {
    strip: Strip,
    vertices: [ScreenVertex; 3],
    places: [[i32; 2]; 3],
}

/// What is drawn together.
struct Piece {
    vertices: [ScreenVertex; PIECE],
    places: [[i32; 2]; PIECE],
    faces: [[u16; 3]; PIECE],
    /// Vertices, and faces, of which there are fewer.
    used: (usize, usize),
}

impl LongStrip {
    /// Takes a strip or fan of long vertices.
    pub(super) fn draw<'w, P: Pipeline, E: EventSink, M: LightingModel>(
        &mut self,
        words: impl Words<'w>,
        run: Run,
        target: &mut Target<'_, '_, P, E, M>,
    ) {
        let header = run.header;
        target.texture = target.texture.filter(|_| header.text);
        if header.new {
            self.strip.restart();
        }
        let mut piece = self.begin_piece();
        let mut at = run.at;
        let mut next = || {
            let word = words.word(at);
            at = at.wrapping_add(1);
            word
        };
        for _ in 0..header.count {
            if piece.used.0 == PIECE {
                self.end_piece(&mut piece, header.prsp, target);
                piece = self.begin_piece();
            }
            let place = next();
            let vertex = ScreenVertex {
                x: place as i16,
                y: (place >> 16) as i16,
                depth: if header.prsp { next() } else { 1 << 31 },
                colour: if header.shade {
                    let [r, g, b, _] = next().to_le_bytes();
                    [r, g, b]
                } else {
                    target.instance.colour
                },
            };
            let mut uv = [0; 2];
            if header.text {
                let word = next();
                uv = [(word & 0xFFFF) as i32, (word >> 16) as i32];
            }
            let (n, faces) = piece.used;
            if let (Some(v), Some(p)) = (piece.vertices.get_mut(n), piece.places.get_mut(n)) {
                (*v, *p) = (vertex, uv);
            }
            piece.used.0 += 1;
            let face = self.strip.push(n as u16, header.rm);
            if let (Some(face), Some(slot)) = (face, piece.faces.get_mut(faces)) {
                *slot = face;
                piece.used.1 += 1;
            }
        }
        self.end_piece(&mut piece, header.prsp, target);
    }

    /// A piece that begins with what the strip keeps.
    fn begin_piece(&mut self) -> Piece {
        let mut piece = Piece {
            vertices: [ScreenVertex::default(); PIECE],
            places: [[0; 2]; PIECE],
            faces: [[0; 3]; PIECE],
            used: (usize::from(self.strip.have), 0),
        };
        let kept = piece.vertices.iter_mut().zip(&mut piece.places);
        let long = self.vertices.iter().zip(&self.places);
        for ((v, p), (vertex, place)) in kept.zip(long) {
            (*v, *p) = (*vertex, *place);
        }
        self.strip.corners = [0, 1, 2];
        piece
    }

    /// Keeps what the strip goes on with, and draws.
    fn end_piece<P: Pipeline, E: EventSink, M: LightingModel>(
        &mut self,
        piece: &mut Piece,
        prsp: bool,
        target: &mut Target<'_, '_, P, E, M>,
    ) {
        for (n, i) in self.strip.corners.into_iter().enumerate() {
            let i = usize::from(i);
            if let (Some(v), Some(p)) = (piece.vertices.get(i), piece.places.get(i)) {
                (self.vertices[n], self.places[n]) = (*v, *p);
            }
        }
        let (vertices, faces) = piece.used;
        let Some(faces) = piece.faces.get(..faces).filter(|f| !f.is_empty()) else {
            return;
        };
        let drawn = piece.vertices.get(..vertices).unwrap_or(&[]);
        let mut places = piece.places.get_mut(..vertices).unwrap_or(&mut []);
        match target.texture {
            Some((bound, _)) if P::Shading::TEXTURED => {
                for place in places.iter_mut() {
                    *place = texels(*place, bound.log_sides);
                }
            }
            _ => places = &mut [],
        }
        let skin = target.skin(places, prsp);
        let before = target.scene.pass_one().untextured;
        let done = target
            .scene
            .draw_screen(drawn, faces, skin, target.instance.cull);
        target.count(vertices as u32, done);
        target.tell_untextured(before);
    }
}
