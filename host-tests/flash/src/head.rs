//! What every scene begins with.

use crate::reader::{FlashError, Reader};
use scanbeam::list::CameraWords;
use scanbeam::{Camera, CameraError};

/// Where the emulated boards have the words: behind the code, in the same flash.
pub const FLASH_AT: u32 = 2 << 20;
/// Bytes that there is room for.
pub const FLASH_BYTES: usize = 2 << 20;

/// What a scene is drawn with, and what it is drawn from.
#[derive(Clone, Copy, Debug, PartialEq, Eq)]
pub enum Kind {
    /// Draw calls of smooth colours.
    Smooth,
    /// Draw calls, some with textures.
    Textured,
    /// Draw calls of indices, and palettes.
    Indexed,
    /// A list without textures.
    ListSmooth,
    /// A list with textures.
    ListTextured,
    /// Draw calls that are lit at each pixel.
    Phong,
    /// The same, some with textures.
    TexturedPhong,
}

impl Kind {
    /// By their codes.
    const ALL: [Self; 7] = [
        Self::Smooth,
        Self::Textured,
        Self::Indexed,
        Self::ListSmooth,
        Self::ListTextured,
        Self::Phong,
        Self::TexturedPhong,
    ];

    /// Whether it is drawn by the look of textures.
    #[must_use]
    pub const fn is_textured(self) -> bool {
        matches!(
            self,
            Self::Textured | Self::ListTextured | Self::TexturedPhong
        )
    }
}

/// What a scene has to be lent.
#[derive(Clone, Copy, Debug, Default, PartialEq, Eq)]
pub struct Room {
    /// Vertices; where there are textures as many places.
    pub vertices: u32,
    /// Triangles.
    pub objects: u32,
    /// States of draw calls.
    pub draws: u32,
}

/// What a scene is.
#[derive(Clone, Copy, Debug, PartialEq)]
pub struct Head {
    /// How it is drawn.
    pub kind: Kind,
    /// Columns and lines that are drawn.
    pub size: [u16; 2],
    /// Whether twice as many of both are sent.
    pub doubled: bool,
    /// Colour where nothing is drawn.
    pub background: [u8; 3],
    /// What it has to be lent.
    pub room: Room,
    /// Where it is seen from; its focal length is in pixels of this picture.
    pub camera: CameraWords,
}

impl Head {
    /// How many words it takes.
    pub const WORDS: usize = 20;
    /// The first word: the letters `SCBF`.
    const MAGIC: u32 = u32::from_le_bytes(*b"SCBF");

    /// Of a scene whose words are so many.
    #[must_use]
    pub fn to_words(&self, length: u32) -> [u32; Self::WORDS] {
        let mut words = [0; Self::WORDS];
        let [width, height] = self.size.map(u32::from);
        let [r, g, b] = self.background;
        words[..8].copy_from_slice(&[
            Self::MAGIC,
            length,
            self.kind as u32,
            width | height << 16,
            u32::from_le_bytes([r, g, b, self.doubled.into()]),
            self.room.vertices,
            self.room.objects,
            self.room.draws,
        ]);
        let c = &self.camera;
        let floats = c.eye.iter().chain(&c.at).chain(&c.up);
        let floats = floats.chain([&c.focal, &c.near, &c.far]);
        for (word, float) in words[8..].iter_mut().zip(floats) {
            *word = float.to_bits();
        }
        words
    }

    /// Writes itself over the head of words, which are as many as before.
    pub fn write(&self, words: &mut [u32]) {
        let own = self.to_words(words.len() as u32);
        for (word, new) in words.iter_mut().zip(own) {
            *word = new;
        }
    }

    /// Of words, and the reader of what follows it.
    ///
    /// # Errors
    /// When they are none of a scene.
    pub fn read(words: &[u32]) -> Result<(Self, Reader<'_>), FlashError> {
        let mut reader = Reader::new(words, 0);
        if reader.word()? != Self::MAGIC {
            return Err(reader.bad());
        }
        let length = reader.word()? as usize;
        if length > words.len() {
            return Err(FlashError::Ends(words.len()));
        }
        let code = reader.word()? as usize;
        let kind = *Kind::ALL.get(code).ok_or(reader.bad())?;
        let size = reader.halves()?;
        let [r, g, b, doubled] = reader.word()?.to_le_bytes();
        let [vertices, objects, draws] = reader.array()?;
        let mut place = || reader.array::<3>().map(|words| words.map(f32::from_bits));
        let (eye, at, up) = (place()?, place()?, place()?);
        let [focal, near, far] = place()?;
        let head = Self {
            kind,
            size,
            doubled: doubled != 0,
            background: [r, g, b],
            room: Room {
                vertices,
                objects,
                draws,
            },
            camera: CameraWords {
                eye,
                at,
                up,
                focal,
                near,
                far,
            },
        };
        Ok((head, reader))
    }

    /// Columns and lines that are sent.
    #[must_use]
    pub fn sent(&self) -> [u16; 2] {
        self.size
            .map(|side| side.saturating_mul(1 + u16::from(self.doubled)))
    }

    /// The camera.
    ///
    /// # Errors
    /// When it is one that cannot see.
    pub fn camera(&self) -> Result<Camera, CameraError> {
        let c = &self.camera;
        Camera::look_at(c.eye, c.at, c.up, c.focal, c.near, c.far)
    }
}
