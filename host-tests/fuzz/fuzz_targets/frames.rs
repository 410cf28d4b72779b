//! Any bytes as a scene, from set-up to pixels.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    scanbeam_fuzz::frames::run(data);
});
