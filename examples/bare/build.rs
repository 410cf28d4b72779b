//! Puts the linker script of the machine where the linker looks for it.

use std::path::PathBuf;
use std::{env, fs};

fn main() {
    for file in ["virt.x", "an505.x", "build.rs"] {
        println!("cargo:rerun-if-changed={file}");
    }
    let out = PathBuf::from(env::var_os("OUT_DIR").expect("cargo sets it"));
    let target = env::var("TARGET").expect("cargo sets it");
    println!("cargo:rustc-link-search={}", out.display());
    println!("cargo:rustc-link-arg-bins=--nmagic");
    let (from, to, script) = if target.starts_with("riscv") {
        ("virt.x", "virt.x", "virt.x")
    } else {
        ("an505.x", "memory.x", "link.x") // the second is cortex-m-rt's
    };
    fs::copy(from, out.join(to)).expect("the script is beside the manifest");
    println!("cargo:rustc-link-arg-bins=-T{script}");
}
