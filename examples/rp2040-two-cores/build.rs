//! Puts this board's `memory.x` where the linker looks for it, and the list of what runs from RAM.

fn main() {
    for file in ["memory.x", "hot", "build.rs"] {
        println!("cargo:rerun-if-changed={file}");
    }
    let folder = std::env::var("CARGO_MANIFEST_DIR").unwrap_or_default();
    let is_small = std::env::var_os("CARGO_FEATURE_HOT_12K").is_some();
    let hot = if is_small { "12k" } else { "all" };
    println!("cargo:rustc-link-search={folder}");
    println!("cargo:rustc-link-search={folder}/hot/{hot}");
    println!("cargo:rustc-link-arg-bins=-Tlink.x");
    println!("cargo:rustc-link-arg-bins=--nmagic");
}
