//! The reader of edge mesh files. The checksum would stop nearly every input, so
//! it is made right first; what is then accepted must be sound.
#![no_main]

use edgemesh::format::edge_mesh_file::{parse, with_checksum};
use edgemesh_fuzz::use_meshes;
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    let _ = parse(bytes);
    if let Ok(stored) = parse(&with_checksum(bytes)) {
        use_meshes(&stored.to_mesh(), &stored.instanced);
    }
});
