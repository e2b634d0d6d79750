//! Shared parts of the fuzz targets: `cargo +nightly fuzz run obj FOUND SEEDS`.
//!
//! `FOUND` is a folder for inputs that reach new code, `SEEDS` one with files of
//! the format. An input that ends a run becomes a test of its reader.

use base64::Engine as _;
use base64::engine::general_purpose::STANDARD;
use edgemesh::build::{BuildOptions, build_instanced};
use edgemesh::edge_mesh::{EdgeMesh, InstancedMesh, bounds_with, replicate, replicate_16};
use edgemesh::format::read::{Format, ReadErrorKind, read_model_bytes};
use edgemesh::line::LineClass;
use edgemesh::view::{Camera, count_features};
use flate2::Crc;

/// Reads a model and, where that succeeds, builds and uses its edge mesh.
///
/// # Panics
/// Panics if the reader panicked, which `read_model_bytes` reports as an error.
pub fn read_and_build(bytes: &[u8], format: Format) {
    match read_model_bytes("fuzz", bytes, format) {
        Ok((model, mut report)) => {
            let (mesh, instanced) =
                build_instanced(&model, &BuildOptions::default(), &mut report);
            use_meshes(&mesh, &instanced);
        }
        Err(error) => assert!(error.kind != ReadErrorKind::Internal, "{error}"),
    }
}

/// Uses a mesh and those that have several places.
pub fn use_meshes(mesh: &EdgeMesh, instanced: &[InstancedMesh]) {
    let _ = bounds_with(mesh, instanced);
    use_mesh(mesh);
    instanced.iter().for_each(|instanced| use_mesh(&instanced.mesh));
}

/// Counts the features of an edge mesh and writes its replicated layouts.
fn use_mesh(mesh: &EdgeMesh) {
    let eye = Camera::default_view(&mesh.bounds).view(&mesh.bounds, 1.0).eye;
    let counts = count_features(mesh, eye);
    assert!(counts[LineClass::Contour] as usize <= mesh.records.len());
    assert_eq!(replicate(mesh).len(), replicate_16(mesh).len());
}

/// A ZIP archive of one part, not packed.
#[must_use]
pub fn stored_part(name: &str, content: &[u8]) -> Vec<u8> {
    let size = u32::try_from(content.len()).unwrap_or(u32::MAX).to_le_bytes();
    let name_length = u16::try_from(name.len()).unwrap_or(u16::MAX).to_le_bytes();
    let mut checksum = Crc::new();
    checksum.update(content);
    // Version 2.0, no flags, not packed, no date.
    let header =
        [&[20, 0, 0, 0, 0, 0, 0, 0, 0, 0], &checksum.sum().to_le_bytes()[..], &size, &size]
            .concat();
    let local =
        [b"PK\x03\x04", &header[..], &name_length, &[0, 0], name.as_bytes(), content].concat();
    let record =
        [b"PK\x01\x02", &[20, 0][..], &header, &name_length, &[0; 16], name.as_bytes()].concat();
    let place = [local.len(), record.len()].map(|n| u32::try_from(n).unwrap_or(u32::MAX));
    let [start, length] = place.map(u32::to_le_bytes);
    let end = [b"PK\x05\x06", &[0, 0, 0, 0, 1, 0, 1, 0][..], &length, &start, &[0, 0]].concat();
    [local, record, end].concat()
}

/// A glTF file with a compressed buffer view of `count` elements: positions, or indices
/// behind positions that are zeros. `kind` chooses its mode, filter and stride.
#[must_use]
pub fn compressed_gltf(kind: u8, count: u16, stream: &[u8]) -> String {
    let (mode, filter, stride) = match kind % 10 {
        0 => ("TRIANGLES", "NONE", 2),
        1 => ("TRIANGLES", "NONE", 4),
        2 => ("INDICES", "NONE", 2),
        3 => ("INDICES", "NONE", 4),
        4 => ("ATTRIBUTES", "OCTAHEDRAL", 8),
        5 => ("ATTRIBUTES", "QUATERNION", 8),
        6 => ("ATTRIBUTES", "EXPONENTIAL", 12),
        7 => ("ATTRIBUTES", "COLOR", 8),
        8 => ("ATTRIBUTES", "NONE", 12),
        _ => ("ATTRIBUTES", "NONE", 64),
    };
    let count = u32::from(count) / 3 * 3;
    let (bytes, stream_bytes) = (count * stride, stream.len());
    let component = match stride {
        2 | 8 => 5122 + u32::from(stride == 2),
        _ => 5126 - u32::from(stride == 4),
    };
    let (attributes, indices) = match mode {
        "ATTRIBUTES" => (0, ""),
        _ => (1, r#", "indices": 0"#),
    };
    let kind = if indices.is_empty() { "VEC3" } else { "SCALAR" };
    let data = STANDARD.encode(stream);
    format!(
        r#"{{"asset": {{"version": "2.0"}}, "nodes": [{{"mesh": 0}}],
        "meshes": [{{"primitives": [{{"attributes": {{"POSITION": {attributes}}}{indices}}}]}}],
        "accessors": [
            {{"bufferView": 0, "componentType": {component}, "count": {count}, "type": "{kind}"}},
            {{"componentType": 5126, "count": 9, "type": "VEC3"}}
        ],
        "bufferViews": [{{"buffer": 1, "byteLength": {bytes}, "byteStride": {stride},
            "extensions": {{"KHR_meshopt_compression": {{
                "buffer": 0, "byteLength": {stream_bytes}, "byteStride": {stride},
                "count": {count}, "mode": "{mode}", "filter": "{filter}"
            }}}}
        }}],
        "buffers": [
            {{"byteLength": {stream_bytes}, "uri": "data:;base64,{data}"}}, {{"byteLength": {bytes}}}
        ]}}"#
    )
}
