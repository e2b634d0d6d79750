//! Text formats without a signature of their own at the first byte.

use super::super::byte_order_mark::without_mark;

/// The lines that are examined.
const LINES: usize = 1000;

/// Words of an `LDraw` line, by its type 1 to 5; names of files may have blanks.
const LDRAW_WORDS: [usize; 5] = [15, 8, 11, 14, 14];

pub(super) fn model(head: &[u8]) -> Option<&'static str> {
    let text = without_mark(head).trim_ascii_start();
    if text.starts_with(b"ISO-10303-21") {
        return Some(match holds(text, b"'IFC") {
            true => "an IFC model: convert it to glTF with IfcConvert",
            false => "a STEP model: convert it to STL or OBJ, for example with FreeCAD",
        });
    }
    if is_iges(head) {
        return Some("an IGES model: convert it to STL or OBJ, for example with FreeCAD");
    }
    if is_dxf(text) {
        return Some("a DXF drawing: convert it to STL or OBJ, for example with FreeCAD");
    }
    is_ldraw(text).then_some("an LDraw model: convert it to OBJ, for example with LeoCAD")
}

fn holds(text: &[u8], part: &[u8]) -> bool {
    text.windows(part.len()).any(|found| found == part)
}

/// Lines of IGES have 80 columns; the last 8 are the letter of the section and a number. The
/// first line is the first of section S.
fn is_iges(head: &[u8]) -> bool {
    let Some((text, [b'S', number @ ..])) =
        head.get(..80).and_then(|line| line.split_at_checked(72))
    else {
        return false;
    };
    let number = number.trim_ascii().iter().skip_while(|&&digit| digit == b'0');
    number.eq(b"1") && text.iter().all(|byte| matches!(byte, b' '..=b'~'))
}

/// DXF has a code and a value on alternate lines; code 999 is a comment, and 0 with the value
/// SECTION comes first.
fn is_dxf(text: &[u8]) -> bool {
    let mut lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii).take(LINES);
    while let (Some(code), Some(value)) = (lines.next(), lines.next()) {
        match code {
            b"999" => {}
            b"0" => return value == b"SECTION",
            _ => return false,
        }
    }
    false
}

/// `LDraw` has a type from 0 to 5 at the start of each line, and 0 in the first.
fn is_ldraw(text: &[u8]) -> bool {
    let lines = text.split(|&byte| byte == b'\n').map(<[u8]>::trim_ascii);
    let lines = lines.filter(|line| !line.is_empty()).take(LINES);
    let mut has_part = false;
    for (at, line) in lines.enumerate() {
        let words: Vec<&[u8]> =
            line.split(u8::is_ascii_whitespace).filter(|word| !word.is_empty()).collect();
        match words[..] {
            [b"0"] => {}
            [b"0", word, ..] => has_part |= matches!(word, b"!LDRAW_ORG" | b"FILE" | b"Name:"),
            [[kind @ b'1'..=b'5'], ..] if at > 0 => {
                if words.len() < LDRAW_WORDS[usize::from(kind - b'1')] {
                    // The last line of the head may be cut.
                    return has_part;
                }
                has_part = true;
            }
            _ => return false,
        }
    }
    has_part
}

#[cfg(test)]
mod tests {
    use super::*;

    fn found(text: &str) -> &'static str {
        model(text.as_bytes()).unwrap_or("nothing")
    }

    #[test]
    fn step_and_ifc_differ_in_their_schema() {
        let schema = |name: &str| {
            format!("ISO-10303-21;\nHEADER;\nFILE_SCHEMA(('{name}'));\nENDSEC;\nDATA;\n")
        };
        assert!(found(&schema("AUTOMOTIVE_DESIGN")).contains("STEP"));
        assert!(found(&schema("IFC4X3")).contains("IFC"));
        assert!(found("\u{feff}\nISO-10303-21;").contains("STEP"));
    }

    #[test]
    fn iges_has_eighty_columns() {
        let line = |text: &str, number: &str| format!("{text:<72}S{number:>7}\n");
        assert!(found(&line("a part of our own", "1")).contains("IGES"));
        assert!(found(&line("", "0000001")).contains("IGES"));
        assert_eq!(found(&line("a part", "2")), "nothing");
        assert_eq!(found(&format!("{:<80}\n", "# OBJ with a long comment")), "nothing");
        assert_eq!(found(&line("a part\n", "1")), "nothing");
    }

    #[test]
    fn dxf_begins_with_a_section() {
        assert!(found("  0\r\nSECTION\r\n  2\r\nHEADER\r\n").contains("DXF"));
        assert!(found("999\nmade by us\n0\nSECTION\n2\nENTITIES\n").contains("DXF"));
        for text in ["0\nEOF\n", "999\ncomment\n", "0\n", "1\nSECTION\n"] {
            assert_eq!(found(text), "nothing", "{text}");
        }
    }

    #[test]
    fn ldraw_has_a_type_on_each_line() {
        let part = "1 16 0 0 0 1 0 0 0 1 0 0 0 1 3001.dat";
        for text in [
            format!("0 A brick\r\n0 Name: a.ldr\r\n\r\n{part}\r\n"),
            format!("0 A brick\n{part}\n0 STEP\n1 4 0 -8 0 1 0 0 0 1 0 0 0 1 a brick.dat\n"),
            "0\n3 16 0 0 0 1 0 0 0 1 0\n2 24 0 0 0 1 0 0\n".into(),
            "0 FILE main.ldr\n".into(),
            format!("0 A brick\n{part}\n4 16 0 0 0 1"),
        ] {
            assert!(found(&text).contains("LDraw"), "{text}");
        }
        for text in ["0 0 0\n1 0 0\n0 1 0\n", "0 a title\n", "0 a\nv 0 0 0\n", part, "0\n"] {
            assert_eq!(found(text), "nothing", "{text}");
        }
    }
}
