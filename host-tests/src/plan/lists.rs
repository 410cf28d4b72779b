//! The lists that costs are measured on: shapes that are baked, behind a camera and lights.

use super::samples::SINGLES;
use super::shapes::Shape;
use crate::lists::bake::{BakeSettings, bake};
use crate::lists::writer::{ListWriter, WriteError};
use crate::model::Model;
use scanbeam::list::{CameraWords, LightWords, State};
use std::error::Error;
use std::path::Path;

/// How its surfaces look.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Style {
    /// Colours in two lights that are not white.
    Smooth,
    /// Colours in white light.
    White,
    /// Colours without a light.
    Unlit,
}

impl Style {
    const ALL: [Self; 3] = [Self::Smooth, Self::White, Self::Unlit];

    const fn name(self) -> &'static str {
        match self {
            Self::Smooth => "smooth",
            Self::White => "white light",
            Self::Unlit => "unlit",
        }
    }
}

/// A list that is measured.
#[derive(Debug, Clone)]
pub struct ListSample {
    /// What it shows.
    pub shape: Shape,
    style: Style,
    eye: [f64; 3],
}

/// All of them, by name.
pub(super) fn samples() -> Vec<(String, ListSample)> {
    let mut all = Vec::new();
    for style in Style::ALL {
        for (shape, distance, height) in SINGLES {
            let eye = [0.4, height, distance];
            let name = format!("{}, {} from {distance}", style.name(), shape.name());
            all.push((name, ListSample { shape, style, eye }));
        }
    }
    all
}

impl ListSample {
    /// Its words, of a model in a folder.
    ///
    /// # Errors
    /// When that cannot be read, or not be baked.
    pub fn to_bytes(&self, folder: &Path) -> Result<Vec<u8>, Box<dyn Error>> {
        let model = Model::load(&folder.join(self.shape.file()))?;
        let baked = bake(&model, &BakeSettings::default())?;
        Ok(seen(&baked.words, camera(self.eye), self.lights())?)
    }

    fn lights(&self) -> &'static [LightWords] {
        const AMBIENT: u16 = 6_500;
        const WHITE: LightWords = LightWords {
            direction: [5_461, 10_923, 10_923],
            ambient: AMBIENT,
            colour: [255; 3],
        };
        const WARM: LightWords = LightWords {
            colour: [250, 235, 220],
            ..WHITE
        };
        const COLD: LightWords = LightWords {
            direction: [-14_301, 7_150, 3_575],
            ambient: 0,
            colour: [25, 40, 76],
        };
        match self.style {
            Style::Unlit => &[],
            Style::White => &[WHITE],
            Style::Smooth => &[WARM, COLD],
        }
    }
}

/// A camera at a place that looks at the middle, at an angle of 45 degrees.
#[must_use]
pub fn camera(eye: [f64; 3]) -> CameraWords {
    CameraWords {
        eye: eye.map(|c| c as f32),
        at: [0.0; 3],
        up: [0.0, 1.0, 0.0],
        focal: 289.7,
        near: 0.1,
        far: 100.0,
    }
}

/// The bytes of a list that begins with a camera and lights.
///
/// # Errors
/// When these do not fit 64 words.
pub fn seen(
    list: &[u32],
    camera: CameraWords,
    lights: &[LightWords],
) -> Result<Vec<u8>, WriteError> {
    let mut memory = [0; 64];
    let mut writer = ListWriter::new(&mut memory);
    writer.state(&State::Camera(camera))?;
    for (number, light) in (0..).zip(lights) {
        writer.state(&State::Light {
            number,
            light: *light,
        })?;
    }
    let words = writer.words().iter().chain(list);
    Ok(words.flat_map(|word| word.to_ne_bytes()).collect())
}
