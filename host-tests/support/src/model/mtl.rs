//! MTL: `newmtl`, `Kd`, `Ks`, `Ns`, `d` (or `Tr`), `map_Kd`. Other keywords are passed over: many tools add their own.

use super::line::{Statement, statements};
use super::{Material, ModelError};
use std::path::Path;

/// Reads MTL text; paths in it are taken from the folder of `file`.
pub(super) fn read(
    text: &str,
    file: &Path,
    warnings: &mut Vec<ModelError>,
) -> Result<Vec<Material>, ModelError> {
    let mut materials: Vec<Material> = Vec::new();
    for statement in statements(text, file) {
        if statement.keyword() == "newmtl" {
            materials.push(Material {
                name: statement.name()?.to_owned(),
                ..Material::default()
            });
            continue;
        }
        let known = ["Kd", "Ks", "Ns", "d", "Tr", "map_Kd"];
        if !known.contains(&statement.keyword()) {
            continue;
        }
        let Some(material) = materials.last_mut() else {
            return Err(statement.error(format!("`{}` before `newmtl`", statement.keyword())));
        };
        match statement.keyword() {
            "Kd" => material.kd = colour(&statement)?,
            "Ks" => material.ks = colour(&statement)?,
            "Ns" => material.ns = single(&statement)?,
            "d" => material.d = single(&statement)?.clamp(0.0, 1.0),
            "Tr" => material.d = (1.0 - single(&statement)?).clamp(0.0, 1.0),
            _ => {
                let name = statement.name()?;
                if name.starts_with('-') {
                    // Drawn with another scale or offset it would be wrong.
                    let reason = "options of `map_Kd` are not supported: it is left out";
                    warnings.push(statement.error(reason.into()));
                    continue;
                }
                let folder = file.parent().unwrap_or(Path::new(""));
                material.map_kd = Some(folder.join(name));
                material.map_kd_at = Some((file.to_path_buf(), statement.line()));
            }
        }
    }
    Ok(materials)
}

/// Three numbers, or one that stands for all three.
fn colour(statement: &Statement<'_>) -> Result<[f64; 3], ModelError> {
    match statement.numbers()?[..] {
        [grey] => Ok([grey; 3]),
        [r, g, b] => Ok([r, g, b]),
        ref other => Err(statement.error(format!(
            "`{}` needs 3 numbers, found {}",
            statement.keyword(),
            other.len()
        ))),
    }
}

fn single(statement: &Statement<'_>) -> Result<f64, ModelError> {
    match statement.numbers()?[..] {
        [value] => Ok(value),
        ref other => Err(statement.error(format!(
            "`{}` needs 1 number, found {}",
            statement.keyword(),
            other.len()
        ))),
    }
}
