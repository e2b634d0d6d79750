//! Detects the format of a file from its first bytes, then from its name.

use std::path::Path;

use super::byte_order_mark::without_mark;
use super::foreign::foreign_model;
use super::format::Format;
use super::off::begins_with_keyword;
use super::stl::size_fits;
use crate::format::edge_mesh_file::is_edge_mesh;

/// First bytes of common files that are not models, and what to call each in a
/// message.
const OTHERS: [(&[u8], &str); 8] = [
    (b"\x89PNG", "a PNG picture"),
    (b"\xff\xd8\xff", "a JPEG picture"),
    (b"GIF8", "a GIF picture"),
    (b"%PDF", "a PDF document"),
    (b"PK\x03\x04", "a ZIP archive: unpack it first"),
    (b"BZh", "bzip2 data: unpack it first"),
    (b"\xff\xfe\0\0", "UTF-32 text: save it as UTF-8"),
    (b"version https://git-lfs", "a Git LFS pointer: fetch the file itself (git lfs pull)"),
];

/// Detects the format of a file from its first bytes, its `size` in bytes (`None`
/// if unknown) and its name.
///
/// # Errors
/// Says what the file is instead, and what to do.
pub(crate) fn sniff(head: &[u8], size: Option<u64>, name: &Path) -> Result<Format, String> {
    if let Some(format) = by_magic(head) {
        return Ok(format);
    }
    if size.is_some_and(|size| size_fits(head, size)) {
        return Ok(Format::Stl);
    }
    if head.starts_with(b"PK\x03\x04")
        && (holds_model_part(head) || Format::of_name(name) == Some(Format::ThreeMf))
    {
        return Ok(Format::ThreeMf);
    }
    if let Some(found) = foreign_model(head, size) {
        return Err(found.into());
    }
    if let Some((_, found)) = OTHERS.iter().find(|(magic, _)| head.starts_with(magic)) {
        return Err((*found).into());
    }
    if is_edge_mesh(head) {
        return Err("already an edge mesh: `edgemesh info` reads it".into());
    }
    let named = Format::of_name(name);
    if head.starts_with(b"\x1f\x8b") {
        return match named {
            Some(Format::Wrl) => Ok(Format::Wrl),
            _ => Err("gzip data: unpack it first (gunzip)".into()),
        };
    }
    let is_utf16 = head.starts_with(b"\xff\xfe") || head.starts_with(b"\xfe\xff");
    if is_utf16 && named != Some(Format::Obj) {
        return Err("UTF-16 text: save it as UTF-8".into());
    }
    let text = without_mark(head).trim_ascii_start();
    let starts =
        |word: &[u8]| text.get(..word.len()).is_some_and(|start| start.eq_ignore_ascii_case(word));
    if starts(b"<!doctype") || starts(b"<html") || starts(b"<?xml") {
        return Err("HTML or XML, perhaps a saved error page".into());
    }
    if starts(b"solid") && named != Some(Format::Obj) {
        return Ok(Format::Stl);
    }
    if starts(b"{") {
        return Ok(Format::Gltf);
    }
    if begins_with_keyword(head) {
        return Ok(Format::Off);
    }
    by_name(head, named, is_utf16)
}

/// Whether the first parts of a ZIP archive have the name of a model part of 3MF.
fn holds_model_part(head: &[u8]) -> bool {
    memchr::memmem::find(head, b"3D/3dmodel.model").is_some()
}

fn by_magic(head: &[u8]) -> Option<Format> {
    let first_line = without_mark(head);
    if head.starts_with(b"glTF") {
        Some(Format::Glb)
    } else if head.starts_with(b"ply\n") || head.starts_with(b"ply\r") {
        Some(Format::Ply)
    } else if first_line.starts_with(b"#VRML") {
        Some(Format::Wrl)
    } else {
        None
    }
}

fn by_name(head: &[u8], named: Option<Format>, is_utf16: bool) -> Result<Format, String> {
    let is_binary = head.contains(&0) && !is_utf16;
    match named {
        Some(Format::Wrl) => Err("text without '#VRML' at its start, which VRML needs".into()),
        Some(Format::Ply) => Err("data without 'ply' at its start, which PLY needs".into()),
        Some(Format::Glb) => {
            Err("data without 'glTF' at its start, which binary glTF needs".into())
        }
        Some(Format::ThreeMf) => Err("data without 'PK' at its start, which 3MF needs".into()),
        Some(Format::Gltf) => Err("text without '{' at its start, which glTF needs".into()),
        Some(Format::Stl) => Ok(Format::Stl),
        Some(Format::Obj | Format::Off) | None if is_binary => Err("binary data".into()),
        // A keyword is not needed, and `sniff` has looked for it.
        Some(Format::Off) => Ok(Format::Off),
        // Text of unknown kind: OBJ is the only format without a signature.
        Some(Format::Obj) | None => Ok(Format::Obj),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn other_formats_are_named() {
        let found = |head: &[u8]| sniff(head, None, Path::new("model.obj")).unwrap_err();
        assert!(found(b"\x1f\x8b\x08").contains("gzip"));
        assert!(found(b"\n <!DOCTYPE html>").contains("HTML"));
        assert!(found(b"\x00\x01").contains("binary"));
        assert!(found(b"EDGEMESH").contains("already an edge mesh"));
    }

    #[test]
    fn content_goes_before_the_name() {
        let sniffed = |head: &[u8], name: &str| sniff(head, None, Path::new(name));
        assert_eq!(sniffed(b"\xef\xbb\xbfv 0 0 0\n", "a.obj"), Ok(Format::Obj));
        assert_eq!(sniffed(b"# comment\nv 0 0 0\n", "a.txt"), Ok(Format::Obj));
        assert_eq!(sniffed(b"solid body\n", "a.obj"), Ok(Format::Obj), "the name decides");
        assert_eq!(sniffed(b"solid body\n", "a"), Ok(Format::Stl));
        assert_eq!(sniffed(b"ply\nformat ascii 1.0\n", "a.obj"), Ok(Format::Ply));
        assert_eq!(sniffed(b"glTF\x02\0\0\0", "a.stl"), Ok(Format::Glb));
        assert_eq!(sniffed(b"#VRML V2.0 utf8\n", "a"), Ok(Format::Wrl));
        assert_eq!(sniffed(b"  {\"asset\"", "a"), Ok(Format::Gltf));
        assert_eq!(sniffed(b"# comment\nCOFF 8 6 12\n", "a.obj"), Ok(Format::Off));
        assert_eq!(sniffed(b"OFF BINARY\n\0\0\0\x08", "a"), Ok(Format::Off));
        let package = b"PK\x03\x04...3D/3dmodel.model...";
        assert_eq!(sniffed(package, "a.zip"), Ok(Format::ThreeMf));
        assert_eq!(sniffed(b"PK\x03\x04", "a.3mf"), Ok(Format::ThreeMf));
        assert!(sniffed(b"PK\x03\x04", "a.zip").unwrap_err().contains("unpack it first"));
        assert_eq!(sniffed(b"8 6 12\n", "a.off"), Ok(Format::Off), "the keyword may be missing");
        assert_eq!(sniffed(b"\x1f\x8b\x08", "a.wrl.gz"), Ok(Format::Wrl));
        assert!(sniffed(b"Shape {}", "a.wrl").unwrap_err().contains("#VRML"));
    }

    #[test]
    fn binary_stl_is_known_by_its_size_alone() {
        let mut head = b"solid in name only".to_vec();
        head.resize(84, 0);
        head[80] = 2;
        assert_eq!(sniff(&head, Some(184), Path::new("a.obj")), Ok(Format::Stl));
        assert!(sniff(&head, Some(185), Path::new("a.obj")).is_err());
        assert_eq!(sniff(&head, Some(185), Path::new("a.stl")), Ok(Format::Stl));
    }
}
