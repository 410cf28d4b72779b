//! Draws a scene by another renderer: `peers RENDERER SCENE.json FRAMES [PICTURE]`.
//!
//! Each is used as its own examples use it, with floats as it comes.

#![cfg_attr(target_os = "none", no_std, no_main)]

extern crate alloc;

mod embedded_3dgfx;
mod euc;
mod retrofire;
mod scene;

use alloc::{boxed::Box, format, string::String};
use measured::{Failure, Renderer};
use scene::Data;

measured::program!(ready);

fn ready(words: &mut dyn Iterator<Item = String>) -> Result<Box<dyn Renderer>, Failure> {
    let renderer = words.next().ok_or("which renderer?")?;
    let file = words.next().ok_or("which scene?")?;
    let data: Data = serde_json::from_slice(&measured::read(&file)?)?;
    Ok(match renderer.as_str() {
        "euc" => Box::new(euc::Euc::new(data)),
        "retrofire-core" => Box::new(retrofire::Retrofire::new(data)),
        "embedded-3dgfx" => Box::new(embedded_3dgfx::Embedded::new(data)),
        other => return Err(format!("there is no renderer {other}").into()),
    })
}
