//! Scenes of a file in palettes a line.

use super::{AtPixels, SceneParts, Worn};
use crate::parts::Job;
use crate::scene_file::SceneFile;
use crate::{DrawFailure, Drawn};
use host_support::image_out::Frame;
use scanbeam::look::Gouraud;
use scanbeam::pixel::{Index8, PixelFormat};
use scanbeam::scene::LARGEST;

/// Indices, which become colours by the palette of each line.
pub(super) fn by_palettes<F: PixelFormat>(
    parts: &SceneParts<'_>,
    job: &Job,
) -> Result<Drawn, DrawFailure> {
    let worn = Worn {
        parts,
        textures: &[],
        lights: None,
        at_pixels: &AtPixels::default(),
        dither: false,
    };
    let indices = Job {
        background: Index8::colour(0),
        ..*job
    };
    let mut drawn = worn.draw_all::<Gouraud<Index8>, Index8>(&indices)?;
    let [width, height] = job.size;
    let palettes = &parts.scene.palettes;
    let lines = drawn.frame.rgb().chunks_exact(3 * width as usize);
    let rgb = (0..height).zip(lines).flat_map(|(line, row)| {
        let palette = &palettes[palette_of(parts.scene, line, height)].colours;
        let colour = |index: u8| palette.get(usize::from(index)).copied().unwrap_or([0; 3]);
        // An index is a level of grey.
        row.chunks_exact(3)
            .flat_map(move |pixel| F::to_rgb8(F::from_rgb8(colour(pixel[0]))))
    });
    drawn.frame = Frame::new(width, height, rgb.collect())
        .ok_or_else(|| DrawFailure::View("the picture has another size".into()))?;
    let word = size_of::<F::Word>();
    // The line that is drawn has a byte a pixel; what is sent of it, a word.
    drawn.used.scan_out.bytes_sent *= word as u64;
    drawn.figures.line_bytes = drawn.figures.line_bytes * word + width.min(LARGEST.into()) as usize;
    Ok(drawn)
}

/// The palette of a line of a picture of this height: of one of another height than the file's, the lines in proportion.
fn palette_of(scene: &SceneFile, line: u32, height: u32) -> usize {
    let line = u64::from(line) * u64::from(scene.size[1]) / u64::from(height);
    let begun = (scene.palettes.iter()).filter(|palette| u64::from(palette.from_line) <= line);
    begun.count() - 1
}
