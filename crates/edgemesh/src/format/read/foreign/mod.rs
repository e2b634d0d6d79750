//! Names the formats of models that are not read, by their first bytes, and says what converts
//! them.
//!
//! Source: the specifications of these formats, and what programs write.
//!
//! Rejected: the file extension, which is wrong where it matters most, in downloads and in
//! copies renamed to `.obj`.

mod by_magic;
mod text;
mod xml;

/// What a file with these first bytes is, if it is a model in another format, with what converts
/// it; `None` for all other files. `size` is that of the file in bytes, if known.
pub(super) fn foreign_model(head: &[u8], size: Option<u64>) -> Option<&'static str> {
    by_magic::model(head, size).or_else(|| xml::model(head)).or_else(|| text::model(head))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn models_that_are_read_are_not_foreign() {
        for head in [
            &b"# comment\nv 0 0 0\nf 1 2 3\n"[..],
            b"0 0 0\n",
            b"v 0 0 0\n",
            b"solid part\nfacet normal 0 0 1\n",
            b"#VRML V2.0 utf8\n",
            b"#VRML V1.0 ascii\n",
            b"ply\nformat ascii 1.0\n",
            b"glTF\x02\0\0\0",
            b"{\"asset\": {}}",
            b"<html>",
            b"<?xml version=\"1.0\"?>",
            b"",
        ] {
            assert_eq!(foreign_model(head, None), None, "{}", head.escape_ascii());
        }
    }
}
