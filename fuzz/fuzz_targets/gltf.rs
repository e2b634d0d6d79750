//! The glTF reader in both of its forms, and the builder behind it.
#![no_main]

use edgemesh::format::read::Format;
use edgemesh_fuzz::read_and_build;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let format = if bytes.starts_with(b"glTF") { Format::Glb } else { Format::Gltf };
    read_and_build(bytes, format);
});
