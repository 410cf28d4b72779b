//! Model files: any bytes are a model in which all is in range, or one line that says what is wrong.

use super::model::Model;
use std::path::Path;

/// What parts the OBJ file from its material file; everything after it is the latter.
const CUT: u8 = 0xFF;

/// Reads what the bytes say; panics when something does not hold. How many triangles there are.
///
/// `folder` is where the material file is put. Text that names other files is not read: it
/// could name a device.
pub fn run(data: &[u8], folder: &Path) -> usize {
    let mut parts = data.splitn(2, |byte| *byte == CUT);
    let text = String::from_utf8_lossy(parts.next().unwrap_or_default());
    if text.contains("mtllib") {
        return 0;
    }
    let file = folder.join("m.obj");
    let read = match parts.next() {
        None => Model::from_obj_text(&text, &file),
        Some(materials) => {
            std::fs::write(folder.join("m.mtl"), materials).expect("a folder to write to");
            Model::from_obj_text(&format!("mtllib m.mtl\n{text}"), &file)
        }
    };
    match read {
        Ok(model) => {
            check(&model);
            model.triangles.len()
        }
        Err(error) => {
            let said = error.to_string();
            assert_eq!(said.lines().count(), 1, "{said}");
            assert!(error.line.is_some_and(|line| line > 0), "{said}");
            0
        }
    }
}

fn check(model: &Model) {
    let (vertices, materials) = (model.vertices.len() as u32, model.materials.len() as u32);
    assert!(model.triangles.as_flattened().iter().all(|i| *i < vertices));
    assert_eq!(model.triangles.len(), model.triangle_materials.len());
    assert!(
        model
            .triangle_materials
            .iter()
            .flatten()
            .all(|i| *i < materials)
    );
    let finite = |values: &[f64]| values.iter().all(|v| v.is_finite());
    for v in &model.vertices {
        assert!(finite(&v.position) && finite(&v.uv), "{v:?}");
        let length: f64 = v.normal.iter().map(|c| c * c).sum();
        assert!(length == 0.0 || (length - 1.0).abs() < 1e-9, "{v:?}");
        assert!(v.colour.iter().all(|c| (0.0..=1.0).contains(c)), "{v:?}");
    }
    for m in &model.materials {
        assert!(finite(&m.kd) && finite(&m.ks) && m.ns.is_finite(), "{m:?}");
        assert!((0.0..=1.0).contains(&m.d), "{m:?}");
    }
    assert!(model.bounds().is_none_or(|(a, b)| finite(&a) && finite(&b)));
    for warning in &model.warnings {
        assert_eq!(warning.to_string().lines().count(), 1);
    }
}
