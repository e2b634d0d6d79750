//! The OFF reader in both of its forms, and the builder behind it.
#![no_main]

use edgemesh::format::read::Format;
use edgemesh_fuzz::read_and_build;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| read_and_build(bytes, Format::Off));
