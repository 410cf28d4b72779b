//! Generates the meshes (see `generate.rs`), and hands the baked list on.
//!
//! `teapot.list` was made by `scanbeam bake`; a test bakes it anew and compares. A build script that
//! has the baker at hand would run it here instead of copying.

mod generate;

use std::{env, fs, path::PathBuf};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=generate.rs");
    println!("cargo:rerun-if-changed=teapot_data.rs");
    println!("cargo:rerun-if-changed=teapot.list");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    let list = fs::read("teapot.list").expect("teapot.list is beside build.rs");
    assert!(list.len().is_multiple_of(4), "a list is whole words");
    fs::write(out.join("teapot.list"), list).expect("OUT_DIR can be written");
    fs::write(out.join("meshes.rs"), generate::source()).expect("OUT_DIR can be written");
}
