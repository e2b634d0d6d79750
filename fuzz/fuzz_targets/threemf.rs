//! The 3MF reader, and the builder behind it. Bytes that are no archive become the model
//! part of one, because hardly any change of a packed part leaves it readable.
#![no_main]

use edgemesh::format::read::Format;
use edgemesh_fuzz::{read_and_build, stored_part};
use libfuzzer_sys::fuzz_target;

fuzz_target!(|bytes: &[u8]| {
    if bytes.starts_with(b"PK") {
        read_and_build(bytes, Format::ThreeMf);
    } else {
        read_and_build(&stored_part("3D/3dmodel.model", bytes), Format::ThreeMf);
    }
});
