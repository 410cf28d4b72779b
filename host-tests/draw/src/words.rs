//! Words, as `scene_flash` reads them.

use scanbeam::Affine;
use scanbeam::list::Matrix;

/// Words, one after the other.
#[derive(Default)]
pub(crate) struct Words(Vec<u32>);

impl Words {
    pub(crate) fn all(&self) -> &[u32] {
        &self.0
    }

    pub(crate) fn push(&mut self, word: u32) {
        self.0.push(word);
    }

    pub(crate) fn append(&mut self, words: impl IntoIterator<Item = u32>) {
        self.0.extend(words);
    }

    /// Bytes, padded to a word.
    pub(crate) fn bytes(&mut self, bytes: impl Iterator<Item = u8>) {
        let bytes: Vec<u8> = bytes.collect();
        self.0.extend(bytes.chunks(4).map(|four| {
            let mut word = [0; 4];
            word[..four.len()].copy_from_slice(four);
            u32::from_le_bytes(word)
        }));
    }

    /// Numbers of 16 bits, padded to a word.
    pub(crate) fn halves(&mut self, halves: impl Iterator<Item = u16>) {
        self.bytes(halves.flat_map(u16::to_le_bytes));
    }

    pub(crate) fn colour(&mut self, colour: [u8; 3]) {
        self.bytes(colour.into_iter());
    }

    /// A MATRIX of lists.
    pub(crate) fn matrix(&mut self, model: &Affine) -> Result<(), String> {
        let matrix = Matrix::try_from(model);
        let matrix = matrix.map_err(|_| "`scale` and `place` are too large".to_owned())?;
        self.append(matrix.linear.map(|c| c as u32));
        let exponents = [matrix.linear_exponent, matrix.offset_exponent];
        self.halves(exponents.into_iter().map(|e| e as u16));
        self.append(matrix.offset.map(|c| c as u32));
        Ok(())
    }
}
