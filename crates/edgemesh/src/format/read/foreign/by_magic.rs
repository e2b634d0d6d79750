//! Formats with a signature, most of them binary.

use crate::format::little_endian::u32_at;

/// First bytes, and what to call each in a message.
const MAGIC: [(&[u8], &str); 19] = [
    (b"BLENDER", "a Blender file: export it as glTF from Blender"),
    (b"Kaydara FBX", "an FBX model: convert it to glTF, for example with Blender"),
    (b"; FBX ", "an FBX model: convert it to glTF, for example with Blender"),
    (b"PXR-USDC", "a USD model: convert it to glTF, for example with Blender"),
    (b"#usda", "a USD model: convert it to glTF, for example with Blender"),
    (b"#X3D", "an X3D model: convert it to glTF, for example with Blender"),
    (b"#Inventor", "an Open Inventor model: convert it to VRML, for example with FreeCAD"),
    (b"# vtk DataFile", "a VTK data set: save it as PLY or STL from ParaView"),
    (b"AutoCAD Binary DXF", "a DXF drawing: convert it to STL or OBJ, for example with FreeCAD"),
    (b"AC10", "a DWG drawing: convert it to STL or OBJ, for example with FreeCAD"),
    (b"3D Geometry File Format ", "a Rhino model: export it as OBJ or STL from Rhino"),
    (b"Ogawa", "an Alembic model: convert it to glTF, for example with Blender"),
    (b"//Maya ASCII", "a Maya scene: export it as OBJ or glTF from Maya"),
    (b"DRACO", "a Draco mesh: decode it to PLY or OBJ (draco_decoder)"),
    (b"LASF", "a LAS point cloud, which has no faces: make a mesh of it first"),
    (b"ASTM-E57", "an E57 point cloud, which has no faces: make a mesh of it first"),
    (b"7z\xbc\xaf\x27\x1c", "a 7z archive: unpack it first"),
    (b"\xfd7zXZ\0", "xz data: unpack it first (unxz)"),
    (b"\x28\xb5\x2f\xfd", "zstd data, perhaps a Blender file: unpack it first (unzstd)"),
];

pub(super) fn model(head: &[u8], size: Option<u64>) -> Option<&'static str> {
    if let Some((_, name)) = MAGIC.iter().find(|(magic, _)| head.starts_with(magic)) {
        return Some(name);
    }
    if is_3ds(head, size) {
        return Some("a 3DS model: convert it to OBJ or glTF, for example with Blender or assimp");
    }
    is_usdz(head)
        .then_some("a USD model in an archive: convert it to glTF, for example with Blender")
}

/// The main chunk of 3DS has the length of the file, and begins with a version or an editor
/// chunk.
fn is_3ds(head: &[u8], size: Option<u64>) -> bool {
    let Some(length) = head.strip_prefix(b"MM").and_then(|_| u32_at(head, 2)) else { return false };
    let begins = matches!(head.get(6..8), Some(b"\x02\0" | b"\x3d\x3d"));
    begins && size.is_none_or(|size| u64::from(length) <= size)
}

/// USDZ is a ZIP archive whose first file is the scene, uncompressed.
fn is_usdz(head: &[u8]) -> bool {
    let Some(rest) = head.strip_prefix(b"PK\x03\x04") else { return false };
    let name_length =
        rest.get(22..24).and_then(|bytes| Some(u16::from_le_bytes(*bytes.first_chunk()?)));
    let name = name_length.and_then(|length| rest.get(26..26 + usize::from(length)));
    let endings: [&[u8]; 3] = [b".usdc", b".usda", b".usd"];
    name.is_some_and(|name| endings.iter().any(|ending| name.ends_with(ending)))
}

#[cfg(test)]
mod tests {
    use super::*;

    fn zip(name: &str) -> Vec<u8> {
        let length = u16::try_from(name.len()).unwrap().to_le_bytes();
        [b"PK\x03\x04", &[0; 22][..], &length, &[0; 2], name.as_bytes(), b"data"].concat()
    }

    #[test]
    fn signatures_are_known() {
        let name = |head: &[u8]| model(head, None).unwrap_or_default();
        for (head, expected) in [
            (&b"BLENDER-v293RENDH"[..], "Blender"),
            (b"Kaydara FBX Binary  \0\x1a\0", "FBX"),
            (b"; FBX 7.4.0 project file\n", "FBX"),
            (b"#usda 1.0\n", "USD"),
            (b"PXR-USDC\0\x08", "USD"),
            (b"#X3D V3.3 utf8\n", "X3D"),
            (b"#Inventor V2.1 ascii\n", "Inventor"),
            (b"# vtk DataFile Version 3.0\n", "VTK"),
            (b"AC1032\0\0", "DWG"),
        ] {
            assert!(name(head).contains(expected), "{}: {}", head.escape_ascii(), name(head));
        }
        assert!(name(&zip("scene.usdc")).contains("USD"));
        assert_eq!(model(&zip("3D/3dmodel.model"), None), None);
        assert_eq!(model(&zip("scene.obj")[..28], None), None);
    }

    #[test]
    fn a_3ds_model_states_its_size() {
        let head = b"MM\x20\0\0\0\x02\0\x0a\0\0\0\x03\0\0\0";
        assert!(model(head, Some(32)).is_some_and(|name| name.contains("3DS")));
        assert_eq!(model(head, Some(20)), None);
        assert_eq!(model(b"MM is text", Some(10)), None);
    }
}
