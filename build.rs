//! Hands `memory.x` to the linker when the feature `memory-x` asks for it.
//!
//! A board with another memory map leaves the feature off and brings its own file.

use std::{env, fs, path::PathBuf};

fn main() {
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rerun-if-changed=build.rs");
    if env::var_os("CARGO_FEATURE_MEMORY_X").is_some() {
        let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
        fs::copy("memory.x", out.join("memory.x")).expect("memory.x is beside build.rs");
        println!("cargo:rustc-link-search={}", out.display());
    }
}
