#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| edgeflip_fuzz::check("points", bytes));
