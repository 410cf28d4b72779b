//! Generates the meshes (see `generate.rs`).

mod generate;

use std::{env, fs, path::PathBuf};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=generate.rs");
    println!("cargo:rerun-if-changed=generate/teapot.rs");
    println!("cargo:rerun-if-changed=teapot_data.rs");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    fs::write(out.join("meshes.rs"), generate::source()).expect("OUT_DIR can be written");
}
