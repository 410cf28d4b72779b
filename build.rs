//! Hands `memory.x` to the linker when the feature `memory-x` asks for it, and finds targets that
//! multiply to 32 bits only.
//!
//! A board with another memory map leaves the feature off and brings its own file.

use std::{env, fs, path::PathBuf};

fn main() {
    println!("cargo:rerun-if-changed=memory.x");
    println!("cargo:rerun-if-changed=build.rs");
    // Processors without long products and divisions: see `num::short`.
    println!("cargo:rustc-check-cfg=cfg(short_multiply)");
    let target = env::var("TARGET").expect("cargo sets TARGET");
    if target.starts_with("thumbv6m") {
        println!("cargo:rustc-cfg=short_multiply");
    }
    if env::var_os("CARGO_FEATURE_MEMORY_X").is_some() {
        let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
        fs::copy("memory.x", out.join("memory.x")).expect("memory.x is beside build.rs");
        println!("cargo:rustc-link-search={}", out.display());
    }
}
