//! Splits text into brackets, strings and words, each with its line.
//!
//! Both versions ignore white space, commas, and comments from `#` to the end of the line
//! (VRML 97 annex A; VRML 1.0, "Language Basics"). Numbers are words here, because a name
//! may look like a number. VRML 1.0 writes sets of flags as `(SIDES | TOP)`, which is a
//! list with other brackets; in VRML 97 these characters are parts of names. Numbers such
//! as `1.#INF` and `nan(ind)` are one word in both.

use super::version::Version;
use crate::format::read::non_finite::non_finite_prefix;

/// A token of a file.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum Token<'a> {
    /// `{`
    OpenBrace,
    /// `}`
    CloseBrace,
    /// `[`, or `(` in VRML 1.0.
    OpenBracket,
    /// `]`, or `)` in VRML 1.0.
    CloseBracket,
    /// The text between quotes, with its backslashes.
    Text(&'a [u8]),
    /// A string without an end.
    UnclosedText,
    /// A name, a keyword or a number.
    Word(&'a [u8]),
}

/// A token and its first line, counted from 1.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) struct Lexeme<'a> {
    /// The token.
    pub(crate) token: Token<'a>,
    /// Its line.
    pub(crate) line: u32,
}

/// Splits a file into tokens, with one token of lookahead.
#[derive(Debug)]
pub(crate) struct Lexer<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
    version: Version,
    ahead: Option<Lexeme<'a>>,
}

impl<'a> Lexer<'a> {
    /// A lexer at the start of a file.
    pub(crate) fn new(bytes: &'a [u8], version: Version) -> Self {
        let mut lexer = Self { bytes, at: 0, line: 1, version, ahead: None };
        lexer.ahead = lexer.read();
        lexer
    }

    /// The next token; `None` at the end of the file.
    pub(crate) fn next(&mut self) -> Option<Lexeme<'a>> {
        let lexeme = self.ahead?;
        self.ahead = self.read();
        Some(lexeme)
    }

    /// The token that [`Self::next`] will return.
    pub(crate) fn peek(&self) -> Option<Token<'a>> {
        self.ahead.map(|lexeme| lexeme.token)
    }

    fn read(&mut self) -> Option<Lexeme<'a>> {
        self.skip_blanks();
        let line = self.line;
        let first = *self.bytes.get(self.at)?;
        let token = match first {
            b'{' => self.single(Token::OpenBrace),
            b'}' => self.single(Token::CloseBrace),
            b'[' => self.single(Token::OpenBracket),
            b']' => self.single(Token::CloseBracket),
            b'(' if self.version == Version::One => self.single(Token::OpenBracket),
            b')' if self.version == Version::One => self.single(Token::CloseBracket),
            b'"' => self.text(),
            _ => self.word(),
        };
        Some(Lexeme { token, line })
    }

    fn single(&mut self, token: Token<'a>) -> Token<'a> {
        self.at += 1;
        token
    }

    fn skip_blanks(&mut self) {
        while let Some(&byte) = self.bytes.get(self.at) {
            match byte {
                b'#' => {
                    let rest = &self.bytes[self.at..];
                    let length = rest.iter().position(|&byte| byte == b'\n' || byte == b'\r');
                    self.at += length.unwrap_or(rest.len());
                }
                _ if is_blank(byte) || byte == b'|' && self.version == Version::One => {
                    self.count_line(byte);
                    self.at += 1;
                }
                _ => return,
            }
        }
    }

    /// Counts a line if this byte ends it; `\r\n` ends one line.
    fn count_line(&mut self, byte: u8) {
        let is_end = match byte {
            b'\n' => true,
            b'\r' => self.bytes.get(self.at + 1) != Some(&b'\n'),
            _ => false,
        };
        self.line += u32::from(is_end);
    }

    fn text(&mut self) -> Token<'a> {
        self.at += 1;
        let start = self.at;
        while let Some(&byte) = self.bytes.get(self.at) {
            match byte {
                b'"' => {
                    self.at += 1;
                    return Token::Text(&self.bytes[start..self.at - 1]);
                }
                // The byte after it does not end the string, even if it is a quote.
                b'\\' => {
                    self.at += 1;
                    self.count_line(self.bytes.get(self.at).copied().unwrap_or(0));
                }
                _ => self.count_line(byte),
            }
            self.at += 1;
        }
        self.at = self.bytes.len();
        Token::UnclosedText
    }

    fn word(&mut self) -> Token<'a> {
        let rest = &self.bytes[self.at..];
        let is_end =
            |&byte: &u8| ends_word(byte) || self.version == Version::One && ends_flag(byte);
        // The first byte is always taken, so that the lexer makes progress.
        let end_of_word =
            || rest.iter().skip(1).position(is_end).map_or(rest.len(), |length| length + 1);
        let length = non_finite_prefix(rest).map_or_else(end_of_word, |(_, length)| length);
        self.at += length;
        Token::Word(&rest[..length])
    }
}

const fn is_blank(byte: u8) -> bool {
    byte <= b' ' || byte == b','
}

const fn ends_word(byte: u8) -> bool {
    is_blank(byte) || matches!(byte, b'{' | b'}' | b'[' | b']' | b'"' | b'#')
}

const fn ends_flag(byte: u8) -> bool {
    matches!(byte, b')' | b'|')
}

#[cfg(test)]
mod tests {
    use super::*;

    fn tokens(text: &str, version: Version) -> Vec<(Token<'_>, u32)> {
        let mut lexer = Lexer::new(text.as_bytes(), version);
        let mut found = Vec::new();
        while let Some(lexeme) = lexer.next() {
            found.push((lexeme.token, lexeme.line));
        }
        found
    }

    fn word(text: &str) -> Token<'_> {
        Token::Word(text.as_bytes())
    }

    #[test]
    fn commas_and_comments_are_blank_and_lines_are_counted() {
        let text = "#VRML V2.0 utf8\r\nDEF a-b.c Box{ # }\nsize 1,2\r3}\n";
        let expected = [
            (word("DEF"), 2),
            (word("a-b.c"), 2),
            (word("Box"), 2),
            (Token::OpenBrace, 2),
            (word("size"), 3),
            (word("1"), 3),
            (word("2"), 3),
            (word("3"), 4),
            (Token::CloseBrace, 4),
        ];
        assert_eq!(tokens(text, Version::Two), expected);
    }

    #[test]
    fn strings_may_hold_brackets_escapes_and_line_ends() {
        let text = "\"a\\\" {#\\\\\"[\"two\nlines\"]\n\"open\\";
        let expected = [
            (Token::Text(b"a\\\" {#\\\\"), 1),
            (Token::OpenBracket, 1),
            (Token::Text(b"two\nlines"), 1),
            (Token::CloseBracket, 2),
            (Token::UnclosedText, 3),
        ];
        assert_eq!(tokens(text, Version::Two), expected);
    }

    #[test]
    fn numbers_that_are_not_finite_are_words() {
        let text = "1.#INF -1.#IND00,nan(ind) [1.#J]#1.#INF\n1.#note\n2";
        for version in [Version::One, Version::Two] {
            let expected = [
                (word("1.#INF"), 1),
                (word("-1.#IND00"), 1),
                (word("nan(ind)"), 1),
                (Token::OpenBracket, 1),
                (word("1.#J"), 1),
                (Token::CloseBracket, 1),
                (word("1."), 2),
                (word("2"), 3),
            ];
            assert_eq!(tokens(text, version), expected);
        }
    }

    #[test]
    fn flags_are_lists_in_the_first_version_and_names_in_the_second() {
        let expected = [
            (word("parts"), 1),
            (Token::OpenBracket, 1),
            (word("SIDES"), 1),
            (word("TOP"), 1),
            (Token::CloseBracket, 1),
        ];
        assert_eq!(tokens("parts (SIDES|TOP)", Version::One), expected);
        assert_eq!(tokens("Box(1) a|b", Version::Two), [(word("Box(1)"), 1), (word("a|b"), 1)]);
    }
}
