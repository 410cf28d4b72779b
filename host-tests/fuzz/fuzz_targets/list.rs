//! Any bytes as an instruction list.
#![no_main]

use libfuzzer_sys::fuzz_target;

fuzz_target!(|data: &[u8]| {
    scanbeam_fuzz::list::run(data);
});
