//! JSON for line-based tools: one line for each member of the document and each element
//! of its lists.
//!
//! ```text
//! {
//! "name":"cube",
//! "positions":[
//! [0.0,0.0,0.0],
//! [1.0,0.0,0.0]],
//! ```
//!
//! Rejected: no line ends, because editors and `grep` fail on a line of 200 megabytes; a
//! line end after every number, which doubles the size.

use std::io::{self, Write};

use serde_json::ser::Formatter;

/// Breaks lines only before the members of the document and the elements of its lists.
#[derive(Debug, Default)]
pub(super) struct LineFormatter {
    depth: usize,
}

impl LineFormatter {
    fn separate<W: ?Sized + Write>(&self, out: &mut W, first: bool) -> io::Result<()> {
        if !first {
            out.write_all(b",")?;
        }
        if self.depth <= 2 { out.write_all(b"\n") } else { Ok(()) }
    }

    fn open<W: ?Sized + Write>(&mut self, out: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth += 1;
        out.write_all(bracket)
    }

    fn close<W: ?Sized + Write>(&mut self, out: &mut W, bracket: &[u8]) -> io::Result<()> {
        self.depth -= 1;
        out.write_all(bracket)
    }
}

impl Formatter for LineFormatter {
    fn begin_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open(out, b"[")
    }

    fn end_array<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.close(out, b"]")
    }

    fn begin_array_value<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.separate(out, first)
    }

    fn begin_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.open(out, b"{")
    }

    fn end_object<W: ?Sized + Write>(&mut self, out: &mut W) -> io::Result<()> {
        self.close(out, b"}")
    }

    fn begin_object_key<W: ?Sized + Write>(&mut self, out: &mut W, first: bool) -> io::Result<()> {
        self.separate(out, first)
    }
}

#[cfg(test)]
mod tests {
    use serde::Serialize as _;
    use serde_json::json;

    use super::*;

    #[test]
    fn lines_break_at_two_depths() {
        let mut bytes = Vec::new();
        let mut serializer =
            serde_json::Serializer::with_formatter(&mut bytes, LineFormatter::default());
        let document = json!({"a": [[1, [2]], {"b": 3, "c": []}], "d": {"e": [4, 5]}, "f": []});
        document.serialize(&mut serializer).unwrap();
        let expected =
            "{\n\"a\":[\n[1,[2]],\n{\"b\":3,\"c\":[]}],\n\"d\":{\n\"e\":[4,5]},\n\"f\":[]}";
        assert_eq!(String::from_utf8(bytes).unwrap(), expected);
    }
}
