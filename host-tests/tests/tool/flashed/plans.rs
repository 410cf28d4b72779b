//! What is planned of scenes, beside what boards take.

use super::*;
use host_tests::flashed::memory::line_bytes;
use host_tests::plan::record::{Record, SLOTS};
use host_tests::plan::shapes::Shape;
use host_tests::plan::{BOUND, CacheSizes, Plan};

/// Draws a scene on all boards, and holds what was planned against what they take; the greatest error of what is said to
/// be within the bound, if it is said.
fn held(file: &Path) -> Result<Option<f64>, Box<dyn Error>> {
    let plan = Plan::of(file, SLOTS, &Record::read(&Record::path())?)?;
    let measured = plan.flashed.measure(&Toolchain::find()?, &BOARDS, file)?;
    let mut worst = None;
    for (on, board) in plan.boards.iter().zip(&measured) {
        bytes_are_as_planned(&plan.flashed, board)?;
        let Some(reckoned) = on.reckoned.filter(|reckoned| reckoned.is_within) else {
            continue;
        };
        let took = board.output.frames[0].instructions as f64;
        let off = (reckoned.instructions / took - 1.0).abs();
        worst = worst.max(Some(off.to_bits()));
    }
    Ok(worst.map(f64::from_bits))
}

/// Kills: a state of a draw call that is larger on record than on the boards, a cache without what it keeps beside its
/// slots. What few scenes have is among the examples:
/// counts of shadows, doubled lines, caches of texels, indices.
pub(super) fn bytes_are_as_planned(flashed: &Flashed, board: &Measured) -> Tried {
    let figure = |name: &str| board.output.figures[name] as usize;
    let name = board.board.name;
    let record = Record::read(&Record::path())?;
    let (_, known) = record.latest().ok_or("no record")?;
    let slow = flashed.slow_bytes(known[name].draw_bytes);
    match flashed.is_list() {
        true => assert!(slow >= figure("slow_bytes"), "{name}: {slow}"),
        false => assert_eq!(slow, figure("slow_bytes"), "{name}"),
    }
    let cache = CacheSizes::of_kind(flashed.shown.head.kind).bytes(SLOTS);
    let fast = flashed.rest_of_fast_bytes()? + cache;
    assert_eq!(fast, figure("fast_bytes"), "{name}");
    assert_eq!(
        line_bytes(&flashed.shown.head),
        figure("line_bytes"),
        "{name}"
    );
    Ok(())
}

/// A ball of any number of pieces, by a number between two.
pub(super) fn ball(next: &mut impl FnMut(f64, f64) -> f64) -> Shape {
    Shape::Ball(next(8.0, 24.0) as u32, next(10.0, 32.0) as u32)
}

/// Likewise a ring.
pub(super) fn ring(next: &mut impl FnMut(f64, f64) -> f64) -> Shape {
    Shape::Ring(next(12.0, 40.0) as u32, next(8.0, 24.0) as u32)
}

/// Scenes that no cost was measured on: other shapes in other places, by random numbers.
fn scenes(folder: &Path, count: u32) -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let mut rng = crate::common::Rng::new(0x9A11);
    let examples = example("scene-files");
    let mut files = Vec::new();
    for number in 0..count {
        let mut next = |from: f64, to: f64| rng.between(from, to);
        let shapes = [
            ball(&mut next),
            ring(&mut next),
            Shape::Land(next(20.0, 40.0) as u32),
            Shape::Cube(next(2.0, 6.0) as u32),
        ];
        let objects: Vec<Value> = (0..next(1.0, 3.0) as u32)
            .map(|_| {
                let shape = shapes[next(0.0, 4.0) as usize % 4];
                std::fs::write(folder.join(shape.file()), shape.to_obj())?;
                let mut object = json!({
                    "model": folder.join(shape.file()),
                    "scale": next(0.3, 0.8),
                    "turn": [next(-40.0, 40.0), next(0.0, 360.0), 0],
                    "place": [next(-1.5, 1.5), next(-1.0, 1.0), next(-1.5, 0.5)],
                    "cull": "back",
                });
                if number % 2 == 1 {
                    object["texture"] = json!(examples.join("sky.png"));
                }
                Ok(object)
            })
            .collect::<Result<_, std::io::Error>>()?;
        let scene = json!({
            "size": [320, 240],
            "format": "rgb565",
            "camera": { "eye": [next(-1.0, 1.0), next(0.2, 2.0), next(3.5, 6.0)], "at": [0, 0, 0], "fov": 45 },
            "ambient": 0.3,
            "lights": [{ "towards": [1, 2, 2], "colour": [0.7, 0.7, 0.6] }],
            "objects": objects,
        });
        let file = folder.join(format!("scene-{number}.json"));
        std::fs::write(&file, scene.to_string())?;
        files.push(file);
    }
    Ok(files)
}

/// Holds what was planned of files against what boards take.
pub(super) fn are_as_planned(files: &[PathBuf]) -> Tried {
    let mut bounded = 0;
    for file in files {
        if let Some(error) = held(file)? {
            bounded += 1;
            assert!(error <= BOUND, "{}: {error:.3}", file.display());
        }
    }
    // Others have too many large triangles, or too few slots.
    assert!(bounded >= 4, "{bounded}");
    Ok(())
}

/// Kills: costs on record that are a third higher than what scenes take.
#[test]
fn scenes_take_what_was_planned() -> Tried {
    let folder = tempfile::tempdir()?;
    are_as_planned(&scenes(folder.path(), 12)?)
}
