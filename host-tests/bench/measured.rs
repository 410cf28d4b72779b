//! How a renderer is run to be measured, the same for ours and for its peers.
//!
//! Everybody does the same work: from the model's vertices to a finished RGB565 picture of 320 x 240
//! pixels, clears, transform, light, culling and depth test included. Meshes are made ready once, in
//! the form that a renderer wants. What is counted is the difference between runs of more and of
//! fewer frames.

use std::error::Error;
use std::time::Instant;

/// A renderer with a scene made ready.
pub(crate) trait Renderer {
    /// Draws a frame.
    fn frame(&mut self);
    /// The last frame in RGB565, line by line; it may be drawn again.
    fn picture(&mut self) -> Vec<u16>;
}

/// Draws `frames` frames and prints the least of their times, in milliseconds, since whatever else
/// the machine does only adds to it; a file that is named gets the
/// picture, two bytes a pixel, the low one first.
pub(crate) fn run(
    mut renderer: Box<dyn Renderer>,
    frames: &str,
    file: Option<&str>,
) -> Result<(), Box<dyn Error>> {
    let times = (0..frames.parse::<usize>()?).map(|_| {
        let start = Instant::now();
        renderer.frame();
        start.elapsed().as_secs_f64() * 1e3
    });
    if let Some(least) = times.min_by(f64::total_cmp) {
        println!("{least:.6}");
    }
    if let Some(file) = file {
        renderer.frame();
        let picture = renderer.picture();
        std::fs::write(
            file,
            picture
                .into_iter()
                .flat_map(u16::to_le_bytes)
                .collect::<Vec<_>>(),
        )?;
    }
    Ok(())
}
