//! Indices into faces: the loop that a list's strips and fans go through.
//!
//! On slices alone, once for strips and fans: 17 instructions a face on a Cortex-M4.

use crate::list::{Header, Strip};

/// What indices mean.
pub(super) struct Rules {
    /// Vertices of the table.
    pub(super) count: u16,
    /// The index that ends a strip.
    restart: u16,
    fan: bool,
    /// Three a triangle, no strips.
    separate: bool,
}

/// Why no more faces were filled in.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub(super) enum End {
    /// All indices were read.
    All,
    /// There is no room for the next face.
    Full,
    /// This index names no vertex.
    Bad(u16),
}

/// What was done.
pub(super) struct Filled {
    /// Indices that were read.
    pub(super) read: usize,
    /// Faces that were filled in.
    pub(super) faces: usize,
    pub(super) end: End,
}

impl Rules {
    /// Those of a block, with a table of so many vertices.
    pub(super) fn of(header: Header, count: u16) -> Self {
        let wide = header.low & Header::WIDE != 0;
        Self {
            count,
            restart: if wide { 0xFFFF } else { 0xFF },
            fan: header.rm,
            separate: header.low & Header::SEPARATE != 0,
        }
    }
}

/// Goes on with a strip, a fan or triangles.
#[inline(never)]
pub(super) fn fill<I: Copy + Into<u16>>(
    indices: &[I],
    out: &mut [[u16; 3]],
    strip: &mut Strip,
    rules: &Rules,
) -> Filled {
    let (mut read, mut faces) = (0, 0);
    let end = loop {
        if strip.have == 0 {
            // Three corners at once, which most strips have.
            let rest = indices.get(read..).unwrap_or_default();
            if let (Some(face), Some(slot)) = (first_face(rest, rules), out.get_mut(faces)) {
                *slot = face;
                (read, faces) = (read + 3, faces + 1);
                strip.corners = face;
                if rules.separate {
                    continue;
                }
                strip.have = 3;
            }
        }
        if strip.have == 3 {
            let rest = indices.get(read..).unwrap_or_default();
            let free = out.get_mut(faces..).unwrap_or_default();
            let done = go_on(rest, free, strip, rules);
            (read, faces) = (read + done, faces + done);
        }
        let Some(&index) = indices.get(read) else {
            break End::All;
        };
        let index: u16 = index.into();
        if index >= rules.count {
            if index != rules.restart || rules.separate {
                break End::Bad(index);
            }
            strip.restart();
            read += 1;
            continue;
        }
        let slot = out.get_mut(faces);
        if strip.have >= 2 && slot.is_none() {
            break End::Full;
        }
        read += 1;
        if let (Some(face), Some(slot)) = (strip.push(index, rules.fan), slot) {
            *slot = face;
            faces += 1;
            if rules.separate {
                strip.restart();
            }
        }
    };
    Filled { read, faces, end }
}

/// The three corners that come, if they all name vertices.
#[inline(always)]
fn first_face<I: Copy + Into<u16>>(rest: &[I], rules: &Rules) -> Option<[u16; 3]> {
    let face = rest.first_chunk::<3>()?.map(Into::into);
    (face.iter().all(|&index| index < rules.count)).then_some(face)
}

/// Goes on with a strip or fan that has three corners, up to an index that names no vertex; how many faces came of it.
fn go_on<I: Copy + Into<u16>>(
    indices: &[I],
    out: &mut [[u16; 3]],
    strip: &mut Strip,
    rules: &Rules,
) -> usize {
    let [a, b, mut newest] = strip.corners;
    let (mut p, mut q) = if strip.odd { (b, a) } else { (a, b) };
    // Which corner the newest one takes the place of: of a strip each in turn, of a fan always the same.
    let mut first = strip.odd == rules.fan;
    let (turns, count) = (!rules.fan, rules.count);
    let mut done = 0;
    for (slot, &index) in out.iter_mut().zip(indices) {
        let index: u16 = index.into();
        if index >= count {
            break;
        }
        if first {
            p = newest;
        } else {
            q = newest;
        }
        newest = index;
        *slot = [p, q, newest];
        first ^= turns;
        done += 1;
    }
    strip.odd = first == rules.fan;
    strip.corners = match strip.odd {
        true => [q, p, newest],
        false => [p, q, newest],
    };
    done
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::list::Id;
    use std::vec::Vec;

    /// Strips and fans in pieces of any length, into memory of any length, are what one vertex at a time makes.
    #[test]
    fn pieces_are_what_single_vertices_make() {
        let mut seed = 1u32;
        let mut below = |n: u32| {
            seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            (seed >> 8) % n
        };
        for round in 0..400 {
            let header = Header {
                rm: round % 2 == 0,
                low: if round % 5 == 0 { Header::SEPARATE } else { 0 },
                ..Header::of(Id::Indexed, 0)
            };
            let rules = Rules::of(header, 200);
            let restarts = if rules.separate { 200 } else { 210 };
            let indices: Vec<u16> = (0..below(60))
                .map(|_| match below(restarts) as u16 {
                    index if index < 200 => index,
                    _ => 0xFF,
                })
                .collect();
            let (mut one, mut want) = (Strip::default(), Vec::new());
            for &index in &indices {
                if index == 0xFF {
                    one.restart();
                } else if let Some(face) = one.push(index, rules.fan) {
                    want.push(face);
                    if rules.separate {
                        one.restart();
                    }
                }
            }
            let (mut strip, mut got) = (Strip::default(), Vec::new());
            let mut rest = &indices[..];
            while !rest.is_empty() {
                let piece = &rest[..1 + below(rest.len() as u32) as usize];
                let mut out = std::vec![[0; 3]; 1 + below(6) as usize];
                let filled = fill(piece, &mut out, &mut strip, &rules);
                assert_eq!(filled.end == End::All, filled.read == piece.len());
                assert_ne!(filled.end, End::Bad(0));
                got.extend_from_slice(&out[..filled.faces]);
                rest = &rest[filled.read..];
            }
            assert_eq!(got, want, "round {round}");
            assert_eq!((strip.have, strip.odd), (one.have, one.odd));
        }
        let rules = Rules::of(Header::of(Id::Indexed, 0), 9);
        let filled = fill(
            &[1u8, 2, 9],
            &mut [[0; 3]; 3],
            &mut Strip::default(),
            &rules,
        );
        assert_eq!((filled.read, filled.end), (2, End::Bad(9)));
    }
}
