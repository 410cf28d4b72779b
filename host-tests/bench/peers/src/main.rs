//! Draws a scene by another renderer: `peers RENDERER SCENE.json FRAMES [PICTURE]`.
//!
//! Each is used as its own examples use it, with floats as it comes.

mod embedded_3dgfx;
mod euc;
#[path = "../../measured.rs"]
mod measured;
mod retrofire;
mod scene;

use measured::Renderer;
use scene::Data;
use std::error::Error;

fn main() -> Result<(), Box<dyn Error>> {
    let words: Vec<String> = std::env::args().skip(1).collect();
    let [renderer, file, frames, picture @ ..] = words.as_slice() else {
        return Err("peers RENDERER SCENE.json FRAMES [PICTURE]".into());
    };
    let data: Data = serde_json::from_slice(&std::fs::read(file)?)?;
    let renderer: Box<dyn Renderer> = match renderer.as_str() {
        "euc" => Box::new(euc::Euc::new(data)),
        "retrofire-core" => Box::new(retrofire::Retrofire::new(data)),
        "embedded-3dgfx" => Box::new(embedded_3dgfx::Embedded::new(data)),
        other => return Err(format!("there is no renderer {other}").into()),
    };
    measured::run(renderer, frames, picture.first().map(String::as_str))
}
