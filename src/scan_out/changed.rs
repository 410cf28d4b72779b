//! Which lines the display shows already, by a hash of 32 bits a line (SPEC X4, M4).
//!
//! The hash goes over a line two 16-bit pixels at a time: exclusive or, fold, multiply, fold. Each step is one to one,
//! so lines that differ in one pair of pixels alone have the same hash only where that of one would be 0, which is
//! not used. Lines of other lengths begin with other numbers. Both folds are needed: with a rotation
//! in their place, one changed bit of a pair is undone by one or two of the next, and the tests found such lines.
//!
//! **A line that has changed in more places is taken for unchanged with a probability of about 2^-32**, as for any hash of
//! 32 bits; not so for pictures that are made to collide. At 240 lines and 60 frames a second, all of them changing,
//! that is one wrong line in 3 days. It stays until it changes again or is [forgotten](ShownLines::forget_line): who
//! forgets one line a frame, in turn, has it mended within as many frames as there are lines.

use bytemuck::{NoUninit, bytes_of};

/// Takes in a number: one to one for each of `hash` and `value`.
#[inline(always)]
pub(super) fn step(hash: u32, value: u32) -> u32 {
    // Upper bits have to reach lower ones before they are multiplied, and again after.
    let mixed = hash ^ value;
    let mixed = (mixed ^ mixed >> 15).wrapping_mul(0x2C1B_3C6D);
    mixed ^ mixed >> 12
}

/// A hash of a line by the bytes of its words, never 0; on all targets the same where these are.
pub(super) fn hash<W: NoUninit>(line: &[W]) -> u32 {
    let hash = match size_of::<W>() {
        0..=2 => line.chunks(2).fold(line.len() as u32, |hash, pair| {
            let pair = match pair {
                [a, b] => number(bytes_of(a)) | number(bytes_of(b)) << 16,
                [a] => number(bytes_of(a)),
                _ => 0,
            };
            step(hash, pair)
        }),
        _ => line.iter().fold(line.len() as u32, |hash, word| {
            let parts = bytes_of(word).chunks(4);
            parts.fold(hash, |hash, part| step(hash, number(part)))
        }),
    };
    hash.max(1)
}

/// Up to four bytes as a number, the lowest first.
#[inline(always)]
fn number(bytes: &[u8]) -> u32 {
    let mut four = [0; 4];
    if let Some(to) = four.get_mut(..bytes.len()) {
        to.copy_from_slice(bytes);
    }
    u32::from_le_bytes(four)
}

/// What each line of the display shows, as far as it is known: 4 bytes a line, lent.
///
/// It is right as long as everything that reaches the display goes through it. After anything else, a reset of the
/// panel or a frame of [`draw_frame`](crate::draw_frame) say, call [`forget`](Self::forget).
#[derive(Debug)]
pub struct ShownLines<'m> {
    /// Of each line from the top, 0 where nobody knows what is shown.
    hashes: &'m mut [u32],
}

impl<'m> ShownLines<'m> {
    /// Nothing is shown yet. Lines for which there is no number are always sent.
    #[must_use]
    pub fn new(hashes: &'m mut [u32]) -> Self {
        hashes.fill(0);
        Self { hashes }
    }

    /// All lines are sent with the next frame.
    pub fn forget(&mut self) {
        self.hashes.fill(0);
    }

    /// The line is sent with the next frame.
    pub fn forget_line(&mut self, line: u16) {
        if let Some(hash) = self.hashes.get_mut(usize::from(line)) {
            *hash = 0;
        }
    }

    /// Whether `pixels` are other than what `line` shows, or may be; they are about to be shown then.
    #[inline]
    pub fn replace<W: NoUninit>(&mut self, line: u16, pixels: &[W]) -> bool {
        let Some(shown) = self.hashes.get_mut(usize::from(line)) else {
            return true;
        };
        let hash = hash(pixels);
        core::mem::replace(shown, hash) != hash
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use std::vec::Vec;

    #[test]
    fn hashes_of_like_lines_collide_as_random_numbers_would() {
        // Lines as pictures have them: one background, a span of few colours somewhere.
        let mut hashes = Vec::new();
        for start in (0..320).step_by(5) {
            for end in (start + 1..=320).step_by(3) {
                for colour in [0x8000u16, 0x0001, 0x8001, 0xF800, 0x07E0, 0xFFFF] {
                    for base in [0u16, 0x8000, 0x1234] {
                        let mut line = [base; 320];
                        line[start..end].fill(colour ^ 0x0100);
                        hashes.push(hash(&line));
                    }
                }
            }
        }
        let count = hashes.len();
        hashes.sort_unstable();
        hashes.dedup();
        // About 62,000 lines: n^2 / 2^33 pairs are expected to collide, that is, 0.4.
        assert!(count > 50_000);
        assert!(count - hashes.len() <= 4, "{}", count - hashes.len());
    }

    #[test]
    fn lines_that_differ_in_up_to_three_bits_of_four_pixels_differ() {
        let mut seed = 3u32;
        for _ in 0..20 {
            let line: [u16; 4] = core::array::from_fn(|_| {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                (seed >> 16) as u16
            });
            let known = hash(&line);
            // Bit 64 is no bit.
            for a in 0..64 {
                for b in a + 1..=64 {
                    for c in b..=64 {
                        let mut other = line;
                        for bit in [a, b, c] {
                            if let Some(pixel) = other.get_mut(bit / 16) {
                                *pixel ^= 1 << (bit % 16);
                            }
                        }
                        assert!(other != line && hash(&other) != known, "{a} {b} {c}");
                    }
                }
            }
        }
    }

    /// Kills: lines of other lengths that have one hash.
    #[test]
    fn a_line_is_not_itself_and_black_pixels() {
        for line in [[1u16, 2, 3, 0], [7, 0, 0, 0], [0; 4]] {
            let hashes: Vec<u32> = (1..=4).map(|len| hash(&line[..len])).collect();
            for (k, hash) in hashes.iter().enumerate() {
                assert!(!hashes[..k].contains(hash), "{line:?} {k}");
            }
        }
        assert_ne!(hash(&[1u8, 2, 3]), hash(&[1u16, 2, 3, 0]));
    }

    /// Kills: a last pixel without a partner that is left out.
    #[test]
    fn lines_of_bytes_have_the_hashes_of_their_words() {
        let mut seed = 5u32;
        for len in 0..8 {
            let mut next = |_| {
                seed = seed.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
                seed >> 8
            };
            let words: Vec<u32> = (0..len).map(&mut next).collect();
            let half: Vec<u16> = words.iter().map(|word| *word as u16).collect();
            let two: Vec<[u8; 2]> = half.iter().map(|word| word.to_le_bytes()).collect();
            assert_eq!(hash(&two), hash(&half));
            let three = words.iter().map(|word| word.to_le_bytes());
            let three: Vec<[u8; 3]> = three.map(|[a, b, c, _]| [a, b, c]).collect();
            assert_eq!(hash(&three), hash(&words));
            if let Some(last) = half.last() {
                let mut other = half.clone();
                other[len - 1] = last ^ 0x100;
                assert!(hash(&other) != hash(&half), "{len}");
            }
        }
    }

    #[test]
    fn a_line_is_shown_once_it_was_replaced_and_until_it_is_forgotten() {
        let mut hashes = [9; 2];
        let mut shown = ShownLines::new(&mut hashes);
        // All zero is a picture too.
        let black = [0u16; 4];
        assert!(shown.replace(0, &black));
        assert!(!shown.replace(0, &black));
        assert!(shown.replace(1, &black));
        shown.forget_line(0);
        assert!(shown.replace(0, &black));
        assert!(!shown.replace(1, &black));
        shown.forget();
        assert!(shown.replace(1, &black));
        // There is no number for this line.
        assert!(shown.replace(2, &black));
        assert!(shown.replace(2, &black));
        assert_ne!(hash::<u32>(&[1, 2]), hash::<u32>(&[2, 1]));
        assert_ne!(hash(&[[1u8, 2, 3]]), hash(&[[1u8, 2, 4]]));
        assert_eq!(hash(&[[1u8, 2], [3, 4]]), hash(&[0x0201u16, 0x0403]));
    }
}
