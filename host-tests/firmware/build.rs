//! Links with `link.x` of cortex-m-rt, so that no rustc flags have to be passed or configured.

fn main() {
    println!("cargo:rerun-if-changed=build.rs");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    // The regions do not start on pages: without this, lld may pad the image to 64 KB.
    println!("cargo:rustc-link-arg-bins=--nmagic");
}
