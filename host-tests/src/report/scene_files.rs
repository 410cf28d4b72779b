//! Pictures of the scene files of the repository, as `render` draws them.

use super::Page;
use crate::draw::{CrewSettings, SceneParts, draw_scene_file};
use crate::scene_file::Loaded;
use std::error::Error;
use std::path::{Path, PathBuf};

/// The scene files of the repository, by name.
///
/// # Errors
/// When their folder cannot be read.
pub fn files() -> Result<Vec<PathBuf>, Box<dyn Error>> {
    let folder = Path::new(env!("CARGO_MANIFEST_DIR")).join("../examples/scene-files");
    let entries = std::fs::read_dir(&folder)
        .and_then(Iterator::collect::<Result<Vec<_>, _>>)
        .map_err(|error| format!("{}: {error}", folder.display()))?;
    let files = entries.iter().map(std::fs::DirEntry::path);
    let is_scene = |file: &PathBuf| {
        file.extension()
            .is_some_and(|extension| extension == "json")
    };
    let mut files: Vec<_> = files.filter(is_scene).collect();
    files.sort();
    Ok(files)
}

/// The section.
pub fn scene_files(page: &mut Page) -> Result<(), Box<dyn Error>> {
    page.section("scenes", "Scene files");
    page.paragraph(
        "The files of `examples/scene-files`, drawn by `render` without a flag: between them they say all that a scene \
         file can say.",
    );
    for file in files()? {
        let loaded = Loaded::load(&file)?;
        let (view, format) = (loaded.scene.view(), loaded.scene.pixel_format());
        let crew = CrewSettings::default();
        let drawn = SceneParts::new(&loaded)
            .and_then(|parts| draw_scene_file(&parts, &view, format, crew))
            .map_err(|error| format!("{}: {error}", file.display()))?;
        let name = file.file_name().unwrap_or_default().to_string_lossy();
        let caption = format!(
            "`{name}`: {} objects, {} triangles in memory",
            loaded.parts.len(),
            drawn.figures.objects
        );
        page.pictures(&[&drawn.frame], &caption)?;
    }
    Ok(())
}
