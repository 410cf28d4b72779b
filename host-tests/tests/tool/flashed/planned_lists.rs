//! What is planned of lists, beside what boards take.

use super::plans::are_as_planned;
use super::*;
use host_tests::lists::bake::{BakeSettings, bake};
use host_tests::lists::writer::ListWriter;
use host_tests::model::Model;
use host_tests::plan::shapes::Shape;
use scanbeam::list::{CameraWords, LightWords, State};

/// Lists that no cost was measured on: baked shapes, seen from other places in other lights.
fn lists(folder: &Path, count: u32) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut rng = crate::common::Rng::new(0x115);
    let mut files = Vec::new();
    for number in 0..count {
        let mut next = |from: f64, to: f64| rng.between(from, to);
        let shapes = [
            Shape::Ball(next(8.0, 24.0) as u32, next(10.0, 32.0) as u32),
            Shape::Ring(next(12.0, 40.0) as u32, next(8.0, 24.0) as u32),
            Shape::Land(next(12.0, 30.0) as u32),
        ];
        let shape = shapes[next(0.0, 3.0) as usize % 3];
        let model = folder.join(shape.file());
        std::fs::write(&model, shape.to_obj())?;
        let baked = bake(&Model::load(&model)?, &BakeSettings::default())?;
        let camera = CameraWords {
            eye: [next(-1.0, 1.0), next(0.4, 2.0), next(3.5, 6.0)].map(|c| c as f32),
            at: [0.0; 3],
            up: [0.0, 1.0, 0.0],
            focal: 280.0,
            near: 0.1,
            far: 100.0,
        };
        let light = LightWords {
            direction: [0, 9_830, 13_107],
            ambient: 8_000,
            colour: [[255; 3], [255, 210, 190]][number as usize % 2],
        };
        let mut memory = [0; 32];
        let mut writer = ListWriter::new(&mut memory);
        writer.state(&State::Camera(camera))?;
        if number % 3 > 0 {
            writer.state(&State::Light { number: 0, light })?;
        }
        let words = writer.words().iter().chain(&baked.words);
        let bytes: Vec<u8> = words.flat_map(|word| word.to_ne_bytes()).collect();
        let file = folder.join(format!("list-{number}.list"));
        std::fs::write(&file, bytes)?;
        files.push(file);
    }
    Ok(files)
}

/// Kills: vertices of lists that cost as those of scenes, and costs on record that are a third higher than what lists take.
#[test]
fn lists_take_what_was_planned() -> Tried {
    let folder = tempfile::tempdir()?;
    are_as_planned(&lists(folder.path(), 12)?)
}
