#![no_main]

libfuzzer_sys::fuzz_target!(|bytes: &[u8]| walpha_fuzz::points("p.lmp", bytes));
