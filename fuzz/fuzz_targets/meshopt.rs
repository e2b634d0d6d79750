//! The decoders of `EXT_meshopt_compression` and `KHR_meshopt_compression`, as positions
//! or indices of a glTF file.
#![no_main]

use edgemesh::format::read::Format;
use edgemesh_fuzz::{compressed_gltf, read_and_build};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if let Some((&[kind, low, high], stream)) = bytes.split_first_chunk() {
        let file = compressed_gltf(kind, u16::from_le_bytes([low, high]), stream);
        read_and_build(file.as_bytes(), Format::Gltf);
    }
});
