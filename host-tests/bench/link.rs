//! Links a program of this folder for a board in QEMU, and does nothing where it is built for the host.
//!
//! The map of the memory is the project's own; scanbeam would hand it over too, but not to its peers.

use std::{env, fs, path::PathBuf};

fn main() {
    const MAP: &str = "../../../memory.x";
    println!("cargo:rerun-if-changed=../link.rs");
    println!("cargo:rerun-if-changed={MAP}");
    if env::var("CARGO_CFG_TARGET_OS").is_ok_and(|system| system == "none") {
        let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
        fs::copy(MAP, out.join("memory.x")).expect("memory.x is at the top of the project");
        println!("cargo:rustc-link-search={}", out.display());
        println!("cargo:rustc-link-arg-bins=-Tlink.x");
        // The regions do not start on pages: without this, lld may pad the image to 64 KB.
        println!("cargo:rustc-link-arg-bins=--nmagic");
    }
}
