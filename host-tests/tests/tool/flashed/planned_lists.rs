//! What is planned of lists, beside what boards take.

use super::plans::{are_as_planned, ball, ring};
use super::*;
use host_tests::lists::bake::{BakeSettings, bake};
use host_tests::model::Model;
use host_tests::plan::lists::{camera, seen};
use host_tests::plan::shapes::Shape;
use scanbeam::list::{CameraWords, LightWords};

/// Lists that no cost was measured on: baked shapes, seen from other places in other lights.
fn lists(folder: &Path, count: u32) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut rng = crate::common::Rng::new(0x115);
    let mut files = Vec::new();
    for number in 0..count {
        let mut next = |from: f64, to: f64| rng.between(from, to);
        let shapes = [
            ball(&mut next),
            ring(&mut next),
            Shape::Land(next(12.0, 30.0) as u32),
        ];
        let shape = shapes[next(0.0, 3.0) as usize % 3];
        let model = folder.join(shape.file());
        std::fs::write(&model, shape.to_obj())?;
        let baked = bake(&Model::load(&model)?, &BakeSettings::default())?;
        let eye = [next(-1.0, 1.0), next(0.4, 2.0), next(3.5, 6.0)];
        let camera = CameraWords {
            focal: 280.0,
            ..camera(eye)
        };
        let light = LightWords {
            direction: [0, 9_830, 13_107],
            ambient: 8_000,
            colour: [[255; 3], [255, 210, 190]][number as usize % 2],
        };
        let lights = if number % 3 > 0 { &[light][..] } else { &[] };
        let file = folder.join(format!("list-{number}.list"));
        std::fs::write(&file, seen(&baked.words, camera, lights)?)?;
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
