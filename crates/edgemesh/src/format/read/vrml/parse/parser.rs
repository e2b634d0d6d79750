//! Parses tokens into a [`Document`].
//!
//! Neither version needs a table of nodes: a word before a brace is the type of a node,
//! any other word in a node is the name of a field, and the values of a field end before
//! the next word that is not a value. So unknown nodes are parsed like others, and a `DEF`
//! in them can be used.
//!
//! Prototypes are skipped: their types are stored, but not their bodies, which have
//! separate names.

use super::document::Document;
use super::document_builder::{DocumentBuilder, Slot};
use super::lexer::{Lexeme, Lexer, Token};
use super::origin::Origin;
use super::version::Version;
use crate::format::read::error::{ReadError, ReadErrorKind};
use crate::format::read::number::parse_number;
use crate::report::{Report, WarningCode};

/// Parses the text of a file, including its header.
///
/// # Errors
/// [`ReadErrorKind::Syntax`] for brackets that do not match, with the line of the open
/// one; [`ReadErrorKind::Number`] for a malformed number.
pub(crate) fn parse(
    origin: Origin,
    version: Version,
    text: &[u8],
    report: &mut Report,
) -> Result<Document, ReadError> {
    let lexer = Lexer::new(text, version);
    let builder = DocumentBuilder::new(origin, version);
    let mut parser = Parser { builder, lexer, version, report };
    while let Some(lexeme) = parser.lexer.next() {
        match parser.builder.list_line() {
            Some(opened) => parser.in_list(lexeme, opened)?,
            None => parser.in_body(lexeme)?,
        }
    }
    parser.builder.finish()
}

struct Parser<'a> {
    builder: DocumentBuilder,
    lexer: Lexer<'a>,
    version: Version,
    report: &'a mut Report,
}

impl<'a> Parser<'a> {
    fn syntax(&self, line: u32, what: impl Into<String>) -> ReadError {
        self.builder.origin().error(ReadErrorKind::Syntax, line, what)
    }

    fn unclosed_text(&self, line: u32) -> ReadError {
        self.syntax(line, "the string that begins here has no end: close it with '\"'")
    }

    fn warn(&mut self, code: WarningCode, line: u32, message: impl FnOnce() -> String) {
        self.builder.origin().warn(self.report, code, line, message);
    }

    fn warn_stray(&mut self, line: u32) {
        self.warn(WarningCode::Syntax, line, || "a value without a field was left out".into());
    }

    /// Parses a token within the braces of a node, or outside all nodes.
    fn in_body(&mut self, lexeme: Lexeme<'a>) -> Result<(), ReadError> {
        let line = lexeme.line;
        match lexeme.token {
            Token::Word(word) => return self.body_word(word, line),
            Token::CloseBrace if self.builder.close_node() => {}
            Token::CloseBrace => {
                return Err(self.syntax(line, "'}' closes nothing: a '{' is missing before it"));
            }
            Token::OpenBracket => {
                self.warn_stray(line);
                self.builder.open_field(b"", line);
                self.builder.set_list_line(Some(line));
            }
            Token::CloseBracket => {
                return Err(self.syntax(line, "']' closes nothing: a '[' is missing before it"));
            }
            Token::OpenBrace => {
                return Err(self.syntax(line, "'{' without the type of a node before it"));
            }
            Token::Text(_) => self.warn_stray(line),
            Token::UnclosedText => return Err(self.unclosed_text(line)),
        }
        Ok(())
    }

    /// Parses a token within the list of a field, whose bracket is in line `opened`.
    fn in_list(&mut self, lexeme: Lexeme<'a>, opened: u32) -> Result<(), ReadError> {
        let line = lexeme.line;
        match lexeme.token {
            Token::CloseBracket => self.builder.set_list_line(None),
            Token::Text(text) => self.text(text),
            Token::Word(word) if is_number(word) => self.number(word, line)?,
            Token::Word(word) => self.word(word, line)?,
            Token::UnclosedText => return Err(self.unclosed_text(line)),
            Token::OpenBrace | Token::CloseBrace | Token::OpenBracket => {
                let what = format!("the list that begins here has no ']' before line {line}");
                return Err(self.syntax(opened, what));
            }
        }
        Ok(())
    }

    fn body_word(&mut self, word: &'a [u8], line: u32) -> Result<(), ReadError> {
        if self.statement(word, line, Slot::Child)? {
            return Ok(());
        }
        match word {
            // The interface of a script: a type and a name; a field also has a value, as
            // elsewhere.
            b"eventIn" | b"eventOut" => self.skip_words(2),
            b"field" | b"exposedField" => self.skip_words(1),
            _ if is_number(word) => self.warn_stray(line),
            _ => return self.field(word, line),
        }
        Ok(())
    }

    /// Parses a statement that may be within braces or brackets; returns whether `word`
    /// begins one.
    fn statement(&mut self, word: &'a [u8], line: u32, slot: Slot) -> Result<bool, ReadError> {
        match word {
            b"DEF" => self.definition(line, slot)?,
            b"USE" => self.reference(line, slot)?,
            b"PROTO" | b"EXTERNPROTO" => self.skip_prototype(word, line)?,
            // ROUTE node.event TO node.event
            b"ROUTE" => self.skip_words(3),
            b"NULL" => {}
            _ if self.lexer.peek() == Some(Token::OpenBrace) => {
                self.lexer.next();
                self.builder.open_node(word, None, line, slot);
            }
            _ => return Ok(false),
        }
        Ok(true)
    }

    /// `DEF name type {`
    fn definition(&mut self, line: u32, slot: Slot) -> Result<(), ReadError> {
        let name = self.take_word(line, "DEF")?;
        let kind = self.take_word(line, "DEF")?;
        match self.lexer.next() {
            Some(Lexeme { token: Token::OpenBrace, line }) => {
                self.builder.open_node(kind, Some(name), line, slot);
                Ok(())
            }
            _ => Err(self.syntax(line, "DEF without a node: write DEF, name, type and '{'")),
        }
    }

    /// `USE name`
    fn reference(&mut self, line: u32, slot: Slot) -> Result<(), ReadError> {
        let name = self.take_word(line, "USE")?;
        if !self.builder.use_node(name, line, slot) {
            let name = String::from_utf8_lossy(name);
            self.warn(WarningCode::Syntax, line, || {
                format!("USE {name} was left out: there is no complete DEF of this name before it")
            });
        }
        Ok(())
    }

    /// The word after `keyword`.
    fn take_word(&mut self, line: u32, keyword: &str) -> Result<&'a [u8], ReadError> {
        match self.lexer.next() {
            Some(Lexeme { token: Token::Word(word), .. }) => Ok(word),
            _ => Err(self.syntax(line, format!("{keyword} without a name after it"))),
        }
    }

    fn skip_words(&mut self, count: usize) {
        for _ in 0..count {
            if let Some(Token::Word(_)) = self.lexer.peek() {
                self.lexer.next();
            }
        }
    }

    /// Parses a field up to its last value, or to the bracket of its list.
    fn field(&mut self, name: &[u8], line: u32) -> Result<(), ReadError> {
        self.builder.open_field(name, line);
        match self.lexer.peek() {
            Some(Token::OpenBracket) => {
                let opened = self.lexer.next().map(|lexeme| lexeme.line);
                self.builder.set_list_line(opened);
            }
            Some(Token::Text(text)) => {
                self.lexer.next();
                self.text(text);
            }
            Some(Token::Word(word)) if self.is_bare_string(name, word) => {
                self.lexer.next();
                self.builder.push_word(word);
            }
            Some(Token::Word(word)) if is_number(word) => self.numbers()?,
            Some(Token::Word(b"IS")) => self.skip_words(2),
            Some(Token::Word(word)) => {
                self.lexer.next();
                self.word(word, line)?;
            }
            _ => {}
        }
        Ok(())
    }

    /// Whether `word` looks like a number and is a string without quotes, which VRML 1.0
    /// allows, such as the name of a file in `filename 3d.jpg`.
    fn is_bare_string(&self, field: &[u8], word: &[u8]) -> bool {
        const STRING_FIELDS: [&[u8]; 4] = [b"filename", b"name", b"string", b"description"];
        self.version == Version::One && STRING_FIELDS.contains(&field) && is_number(word)
    }

    fn numbers(&mut self) -> Result<(), ReadError> {
        while let Some(Token::Word(word)) = self.lexer.peek() {
            if !is_number(word) {
                break;
            }
            let line = self.lexer.next().map_or(0, |lexeme| lexeme.line);
            self.number(word, line)?;
        }
        Ok(())
    }

    fn number(&mut self, word: &[u8], line: u32) -> Result<(), ReadError> {
        let Some(number) = parse_number(word).or_else(|| parse_hexadecimal(word)) else {
            let what = format!("'{}' is not a number", String::from_utf8_lossy(word));
            return Err(self.builder.origin().error(ReadErrorKind::Number, line, what));
        };
        self.builder.push_number(number, line);
        Ok(())
    }

    /// Parses a value that is a node, or a word such as `TRUE`.
    fn word(&mut self, word: &'a [u8], line: u32) -> Result<(), ReadError> {
        if !self.statement(word, line, Slot::Value)? {
            self.builder.push_word(word);
        }
        Ok(())
    }

    /// Parses a string; a backslash escapes a quote or a backslash.
    fn text(&mut self, raw: &[u8]) {
        if !raw.contains(&b'\\') {
            return self.builder.push_word(raw);
        }
        let mut text = Vec::with_capacity(raw.len());
        let mut rest = raw.iter();
        while let Some(&byte) = rest.next() {
            let escaped = if byte == b'\\' { rest.next() } else { None };
            text.push(*escaped.unwrap_or(&byte));
        }
        self.builder.push_word(&text);
    }

    /// Skips the definition of a node type: its interface, then its body or its URLs.
    fn skip_prototype(&mut self, keyword: &[u8], line: u32) -> Result<(), ReadError> {
        let keyword = String::from_utf8_lossy(keyword);
        let name = self.take_word(line, &keyword)?;
        self.builder.add_prototype(name);
        self.skip_block(line)?;
        match self.lexer.peek() {
            Some(Token::Text(_)) => drop(self.lexer.next()),
            _ => self.skip_block(line)?,
        }
        self.warn(WarningCode::Unsupported, line, || {
            let name = String::from_utf8_lossy(name);
            format!("{keyword} {name} is not supported; replace its nodes by plain nodes")
        });
        Ok(())
    }

    /// Skips brackets with their content.
    fn skip_block(&mut self, line: u32) -> Result<(), ReadError> {
        let mut open: Vec<Lexeme> = Vec::new();
        while let Some(lexeme) = self.lexer.next() {
            let opening = match lexeme.token {
                Token::CloseBrace => Token::OpenBrace,
                Token::CloseBracket => Token::OpenBracket,
                Token::OpenBrace | Token::OpenBracket => {
                    open.push(lexeme);
                    continue;
                }
                Token::UnclosedText => return Err(self.unclosed_text(lexeme.line)),
                Token::Text(_) | Token::Word(_) => continue,
            };
            if open.pop_if(|last| last.token == opening).is_none() {
                break;
            }
            if open.is_empty() {
                return Ok(());
            }
        }
        let line = open.last().map_or(line, |last| last.line);
        Err(self.syntax(
            line,
            "the bracket that begins here is not closed, or by another kind of bracket",
        ))
    }
}

/// Whether a word is read as a number. Some programs write `nan` and `inf`, as the C
/// library prints them. A path such as `../a.jpg`, which VRML 1.0 allows without quotes, is
/// no number.
fn is_number(word: &[u8]) -> bool {
    let is_path = matches!(word, [b'.', b'/' | b'\\', ..] | [b'.', b'.', ..]);
    match word.first() {
        Some(b'+' | b'-' | b'.' | b'0'..=b'9') => !is_path,
        Some(b'n' | b'N' | b'i' | b'I') => parse_number(word).is_some(),
        _ => false,
    }
}

/// Parses a hexadecimal number such as `0x1F`, the format of pixels.
fn parse_hexadecimal(word: &[u8]) -> Option<f64> {
    let digits = word.strip_prefix(b"0x").or_else(|| word.strip_prefix(b"0X"))?;
    let digits = std::str::from_utf8(digits).ok()?;
    u32::from_str_radix(digits, 16).ok().map(f64::from)
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::format::read::source::Source;
    use crate::report::Place;

    fn parsed(text: &str, version: Version) -> Result<(Document, Report), ReadError> {
        let origin = Origin::of_model(&Source { name: "a.wrl", folder: None, bytes: b"" });
        let mut report = Report::default();
        parse(origin, version, text.as_bytes(), &mut report).map(|document| (document, report))
    }

    fn two(text: &str) -> Document {
        parsed(text, Version::Two).unwrap().0
    }

    fn failure(text: &str) -> (ReadErrorKind, u32) {
        let error = parsed(text, Version::Two).unwrap_err();
        match error.place {
            Some(Place::Line(line)) => (error.kind, line),
            place => panic!("{place:?}: {}", error.what),
        }
    }

    #[test]
    fn fields_hold_numbers_words_and_nodes() {
        let document =
            two("Transform { translation 1 2,3\nchildren [ Shape { geometry Box { } }\nGroup { } ]
            on FALSE title \"a \\\"b\\\" \\\\\" list [ 0x1F -1 ] }");
        let transform = document.root().first_child().unwrap();
        assert_eq!((transform.kind(), transform.line()), ("Transform", 1));
        assert_eq!(transform.vector("translation", [0.0; 3]), [1.0, 2.0, 3.0]);
        assert!(!transform.flag("on", true) && transform.flag("off", true));
        assert_eq!(transform.word("title"), Some("a \"b\" \\"));
        assert_eq!(transform.numbers("list").values, [31.0, -1.0]);
        let shape = transform.field("children").unwrap().first_node().unwrap();
        assert_eq!((shape.kind(), shape.node_of("geometry").unwrap().kind()), ("Shape", "Box"));
        let group = shape.next().unwrap();
        assert_eq!((group.kind(), group.line()), ("Group", 3));
        assert!(group.next().is_none() && transform.first_child().is_none());
    }

    #[test]
    fn children_of_the_first_version_stand_between_fields() {
        let text = "Separator { renderCulling ON Cube { width 2 } parts (SIDES | TOP)
            fields [ SFFloat radius ] Info { string \"x\" } }";
        let (document, _) = parsed(text, Version::One).unwrap();
        let separator = document.root().first_child().unwrap();
        assert_eq!(separator.word("renderCulling"), Some("ON"));
        assert_eq!(separator.words("parts").collect::<Vec<_>>(), ["SIDES", "TOP"]);
        let cube = separator.first_child().unwrap();
        assert_eq!((cube.kind(), cube.next().unwrap().kind()), ("Cube", "Info"));
    }

    #[test]
    fn a_use_is_the_last_complete_def() {
        let text = "DEF 1 Group { } USE 1 DEF 1 Transform { children USE 1 } USE 1 USE none";
        let (document, report) = parsed(text, Version::Two).unwrap();
        let first = document.root().first_child().unwrap();
        let second = first.next().unwrap();
        assert_eq!(
            (second.target().key(), second.target().name().map(|n| &**n)),
            (first.key(), Some("1"))
        );
        let third = second.next().unwrap();
        assert_eq!(third.node_of("children").unwrap().key(), first.key());
        assert_eq!(third.next().unwrap().target().kind(), "Transform");
        assert_eq!(report.count(WarningCode::Syntax), 1, "{report:?}");
        // Within its node a name is not defined yet, so there are no cycles.
        let (_, report) = parsed("DEF A Group { children USE A }", Version::Two).unwrap();
        assert!(report.warnings()[0].message.contains("USE A"), "{report:?}");
    }

    #[test]
    fn prototypes_routes_and_scripts_are_skipped() {
        let text = "PROTO P [ field MFNode n [ Group { } ] eventIn SFBool b ]
            { PROTO Q [ ] { DEF inside Box { } } Q { size IS n } }
            EXTERNPROTO R [ field SFNode a ] \"r.wrl\" EXTERNPROTO S [ ] [ \"s.wrl\" ]
            P { n Group { } } ROUTE a.b TO c.d
            Script { eventIn SFBool on field SFNode n USE kept field SFString s \"x\" url \"u\" }
            Box { size IS n } USE inside Group { }";
        let (document, report) = parsed(text, Version::Two).unwrap();
        let first = document.root().first_child().unwrap();
        assert!(first.kind() == "P" && first.is_prototype());
        let script = first.next().unwrap();
        assert_eq!(
            (script.kind(), script.word("s"), script.word("url")),
            ("Script", Some("x"), Some("u"))
        );
        let last = script.next().unwrap().next().unwrap();
        assert_eq!(
            (last.kind(), last.is_prototype(), last.next().is_none()),
            ("Group", false, true)
        );
        assert_eq!(report.count(WarningCode::Unsupported), 3);
        assert_eq!(report.count(WarningCode::Syntax), 2, "USE kept, USE inside");
    }

    #[test]
    fn values_without_a_field_give_warnings() {
        let (document, report) = parsed("1 \"x\" [ 2 ] Group { 3 }", Version::Two).unwrap();
        assert_eq!(document.root().first_child().unwrap().kind(), "Group");
        assert_eq!(report.count(WarningCode::Syntax), 4);
    }

    #[test]
    fn brackets_that_do_not_match_are_errors_at_the_open_one() {
        const SYNTAX: ReadErrorKind = ReadErrorKind::Syntax;
        assert_eq!(failure("Group {\nchildren [\nGroup { }\n"), (SYNTAX, 2));
        assert_eq!(failure("Group {\nGroup {\n}\n"), (SYNTAX, 1));
        assert_eq!(failure("Coordinate { point [\n0 0 0 }\n"), (SYNTAX, 1));
        assert_eq!(failure("Coordinate { point [\n0 0 0\n[ }\n"), (SYNTAX, 1));
        assert_eq!(failure("Group { }\n}\n"), (SYNTAX, 2));
        assert_eq!(failure("Group { }\n]\n"), (SYNTAX, 2));
        assert_eq!(failure("Group { }\n{ }\n"), (SYNTAX, 2));
        assert_eq!(failure("Group { title \"\n\n"), (SYNTAX, 1));
        assert_eq!(failure("\nPROTO P [ ]\n{ Group {\n } "), (SYNTAX, 3));
        assert_eq!(failure("PROTO P [\n { ] }"), (SYNTAX, 2));
        assert_eq!(failure("\nDEF A Group\n"), (SYNTAX, 2));
        assert_eq!(failure("\nUSE { }"), (SYNTAX, 2));
    }

    #[test]
    fn malformed_numbers_are_errors_with_their_line() {
        assert_eq!(failure("Sphere {\nradius 1.2.3 }"), (ReadErrorKind::Number, 2));
        assert_eq!(failure("Sphere {\nradius [ 0 \n 1e ] }"), (ReadErrorKind::Number, 3));
        let document = two("Sphere { radius nan }");
        assert!(document.root().first_child().unwrap().number("radius", 1.0).is_nan());
    }

    #[test]
    fn names_of_files_need_no_quotes_in_the_first_version() {
        for name in ["../t.jpg", "./t.jpg", "..\\t.jpg", "a/b.jpg", "3d.jpg", "-1.jpg", "1.2.3"] {
            let text = format!("Texture2 {{ filename {name} image 1 1 1 255 }}");
            let (document, report) = parsed(&text, Version::One).unwrap();
            let texture = document.root().first_child().unwrap();
            assert_eq!(texture.word("filename"), Some(name));
            assert_eq!(texture.numbers("image").values, [1.0, 1.0, 1.0, 255.0]);
            assert_eq!(report, Report::default(), "{name}");
        }
        let inline = two("Inline { url [ ../a.wrl ./b.wrl ] }");
        let urls: Vec<_> = inline.root().first_child().unwrap().words("url").collect();
        assert_eq!(urls, ["../a.wrl", "./b.wrl"]);
        assert_eq!(failure("Sphere {\nradius .x }"), (ReadErrorKind::Number, 2));
        assert_eq!(failure("Sphere {\nradius - }"), (ReadErrorKind::Number, 2));
    }

    #[test]
    fn numbers_that_are_not_finite_are_numbers() {
        let text = "Coordinate3 { point [ -nan(ind) 1.#INF 0, 1.#IND nan -inf ] }";
        for version in [Version::One, Version::Two] {
            let (document, report) = parsed(text, version).unwrap();
            let values = document.root().first_child().unwrap().numbers("point").values.to_vec();
            let finite: Vec<bool> = values.iter().map(|value| value.is_finite()).collect();
            assert_eq!(finite, [false, false, true, false, false, false]);
            assert_eq!(report, Report::default());
        }
    }

    #[test]
    fn a_deep_file_is_parsed_without_a_deep_stack() {
        let depth = 100_000;
        let text = "Group { children [ ".repeat(depth) + &"] } ".repeat(depth);
        assert_eq!(two(&text).nodes.len(), depth + 1);
        assert_eq!(failure(&"Group { children [".repeat(depth)).0, ReadErrorKind::Syntax);
    }
}
