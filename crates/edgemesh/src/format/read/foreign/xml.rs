//! XML formats, by the name of their root.

use super::super::byte_order_mark::without_mark;

/// Names of roots, without their prefix, and what to call each in a message.
const ROOTS: [(&[u8], &str); 8] = [
    (b"COLLADA", "a COLLADA model: convert it to glTF, for example with COLLADA2GLTF or Blender"),
    (b"X3D", "an X3D model: convert it to glTF, for example with Blender"),
    (b"VTKFile", "a VTK data set: save it as PLY or STL from ParaView"),
    (b"amf", "an AMF model: convert it to STL or OBJ, for example with FreeCAD"),
    (b"ifcXML", "an IFC model: convert it to glTF with IfcConvert"),
    (b"CityModel", "a CityGML model: convert it to OBJ or glTF first"),
    (b"kml", "a KML document: convert its models to glTF first"),
    (b"svg", "an SVG drawing"),
];

pub(super) fn model(head: &[u8]) -> Option<&'static str> {
    let name = root(without_mark(head))?;
    ROOTS.iter().find(|(root, _)| *root == name).map(|(_, name)| *name)
}

/// The name of the root of an XML text, without its prefix: after the declaration, comments and
/// the document type.
fn root(text: &[u8]) -> Option<&[u8]> {
    let mut rest = text.trim_ascii_start().strip_prefix(b"<")?;
    loop {
        let end: &[u8] = match rest {
            [b'!', b'-', b'-', ..] => b"-->",
            [b'?' | b'!', ..] => b">",
            _ => break,
        };
        let at = rest.windows(end.len()).position(|part| part == end)?;
        rest = rest.get(at + end.len()..)?.trim_ascii_start().strip_prefix(b"<")?;
    }
    let is_end = |byte: &u8| byte.is_ascii_whitespace() || matches!(byte, b'>' | b'/');
    let name = rest.split(is_end).next()?;
    name.rsplit(|&byte| byte == b':').next()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn the_root_is_behind_declaration_comments_and_type() {
        for (text, name) in [
            ("<X3D>", "X3D"),
            ("\u{feff}<?xml version=\"1.0\"?>\n<COLLADA xmlns=\"x\">", "COLLADA"),
            ("\n<?xml version='1.0'?><!-- a > b -- c --><!DOCTYPE X3D PUBLIC \"x\"><X3D\n>", "X3D"),
            ("<ifc:ifcXML id='a'>", "ifcXML"),
            ("<VTKFile type=\"PolyData\">", "VTKFile"),
            ("<svg/>", "svg"),
        ] {
            assert_eq!(root(without_mark(text.as_bytes())), Some(name.as_bytes()), "{text}");
            assert!(model(text.as_bytes()).is_some(), "{text}");
        }
        for text in ["", "x<X3D>", "<", "<?xml", "<!-- open", "<?xml?>", "<html>", "<x3d>"] {
            assert_eq!(model(text.as_bytes()), None, "{text}");
        }
    }
}
