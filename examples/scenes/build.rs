//! Hands the baked lists on.
//!
//! The `.list` files were made by `scanbeam bake`; tests bake them anew and compare. A
//! build script that has the baker at hand would run it here instead of copying.

use std::{env, fs, path::PathBuf};

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets OUT_DIR"));
    for name in ["teapot.list", "teapot_meshlets.list", "crate.list"] {
        println!("cargo:rerun-if-changed={name}");
        let list = fs::read(name).expect("the lists are beside build.rs");
        assert!(list.len().is_multiple_of(4), "a list is whole words");
        fs::write(out.join(name), list).expect("OUT_DIR can be written");
    }
}
