//! Any bytes as tokens, format RAM and vertices of the hardware model.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    scanbeam_fuzz::formats::run(data);
});
