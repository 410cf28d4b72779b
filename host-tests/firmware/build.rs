//! Links with `link.x` of cortex-m-rt, so that no rustc flags have to be passed or configured.

use std::path::Path;

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rerun-if-changed=regions.x");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    let regions = Path::new(env!("CARGO_MANIFEST_DIR")).join("regions.x");
    println!(
        "cargo:rustc-link-arg-bin=qemu-firmware=-T{}",
        regions.display()
    );
    // The regions do not start on pages: without this, lld may pad the image to 64 KB.
    println!("cargo:rustc-link-arg-bins=--nmagic");
}
