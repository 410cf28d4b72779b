//! Any bytes as a model file and its material file.
#![no_main]

use libfuzzer_sys::fuzz_target;
use std::sync::LazyLock;
use tempfile::TempDir;

static FOLDER: LazyLock<TempDir> =
    LazyLock::new(|| tempfile::tempdir().expect("a folder for material files"));

fuzz_target!(|data: &[u8]| {
    scanbeam_fuzz::files::run(data, FOLDER.path());
});
