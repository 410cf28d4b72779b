//! `compress`: pictures into blocks of 4 x 4 texels in 8 bytes, for [`Compressed`](scanbeam::scene::Compressed) (H7).

pub mod samples;

pub use host_support::compress::{Blocks, Texel};

use crate::args::CompressArgs;
use crate::image_out::{read_image, write_atomically};
use crate::texture_file::{TextureFileError, TextureImage};
use std::error::Error;

/// Reads a picture, and writes its blocks.
///
/// # Errors
/// When a file cannot be read or written, or is no picture.
pub fn run(args: &CompressArgs) -> Result<(), Box<dyn Error>> {
    let picture = read_image(&args.picture).map_err(TextureFileError::from)?;
    let image = TextureImage::new(&picture).map_err(|error| TextureFileError::Texture {
        file: args.picture.clone(),
        error,
    })?;
    if let Some(note) = &image.note {
        tell!("note: {}: {note}", args.picture.display());
    }
    let texels: Vec<Texel> = image.levels[0].iter().copied().map(Some).collect();
    let blocks = Blocks::new([image.width, image.height], &texels)?;
    write_atomically(&args.output, &blocks.bytes)?;
    say!(
        "{}: {}x{} texels in {} bytes, {:.2} levels off",
        args.output.display(),
        image.width,
        image.height,
        blocks.bytes.len(),
        blocks.error
    );
    Ok(())
}
