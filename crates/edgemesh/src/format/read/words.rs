//! Reads words and numbers line by line, for the text forms of PLY and STL.
//!
//! A cursor passes over the bytes once: a number is parsed in place, without a
//! search for the end of its word or line.
//!
//! ```text
//! vertex 0.5 1 -2 \r\n
//!        ^at
//! word, number: up to the next blank; None at the end of the line
//! end_line:     past the end of the line: LF, CR LF or CR
//! ```

use super::number::{parse_number, parse_prefix};

/// A message shows at most this many bytes of a word.
const SHOWN_BYTES: usize = 40;

/// A cursor over text.
#[derive(Debug, Clone)]
pub(super) struct Words<'a> {
    bytes: &'a [u8],
    at: usize,
    line: u32,
}

impl<'a> Words<'a> {
    /// A cursor at byte `at`, in line `line`.
    pub(super) const fn new(bytes: &'a [u8], at: usize, line: u32) -> Self {
        Self { bytes, at, line }
    }

    /// The line of the cursor, counted from 1.
    pub(super) const fn line(&self) -> u32 {
        self.line
    }

    /// The offset of the cursor in bytes.
    pub(super) const fn at(&self) -> usize {
        self.at
    }

    /// The bytes from the cursor on.
    pub(super) fn left(&self) -> &'a [u8] {
        self.bytes.get(self.at..).unwrap_or_default()
    }

    /// The next word of this line; `None` at its end.
    pub(super) fn word(&mut self) -> Option<&'a [u8]> {
        self.skip_blanks();
        let text = self.left();
        let length = text.iter().position(|&byte| is_space(byte)).unwrap_or(text.len());
        self.at += length;
        text.get(..length).filter(|word| !word.is_empty())
    }

    /// The next word of this line as a number, or as an error if it is not one;
    /// `None` at the end of the line.
    #[inline]
    pub(super) fn number(&mut self) -> Option<Result<f64, &'a [u8]>> {
        self.skip_blanks();
        let text = self.left();
        if let Some((number, length)) = parse_prefix(text)
            && text.get(length).is_none_or(|&byte| is_space(byte))
        {
            self.at += length;
            return Some(Ok(number));
        }
        self.word().map(|word| parse_number(word).ok_or(word))
    }

    /// The rest of this line without surrounding blanks; moves to the next line.
    pub(super) fn take_rest_of_line(&mut self) -> &'a [u8] {
        let text = self.left();
        let length = text.iter().position(|&byte| is_line_end(byte)).unwrap_or(text.len());
        self.at += length;
        self.step_over_line_end();
        text.get(..length).unwrap_or_default().trim_ascii()
    }

    /// Moves to the next word, over line ends too.
    pub(super) fn skip_space(&mut self) {
        self.skip_blanks();
        while self.left().first().is_some_and(|&byte| is_line_end(byte)) {
            self.step_over_line_end();
            self.skip_blanks();
        }
    }

    #[inline]
    fn skip_blanks(&mut self) {
        while self.left().first().is_some_and(|&byte| is_space(byte) && !is_line_end(byte)) {
            self.at += 1;
        }
    }

    fn step_over_line_end(&mut self) {
        match self.left() {
            [b'\r', b'\n', ..] => self.at += 2,
            [_, ..] => self.at += 1,
            [] => return,
        }
        // A file of 4 GiB can have more lines than 32 bits hold.
        self.line = self.line.saturating_add(1);
    }
}

/// Blank, tab, line feed, vertical tab, form feed or carriage return.
const fn is_space(byte: u8) -> bool {
    matches!(byte, b' ' | b'\t'..=b'\r')
}

const fn is_line_end(byte: u8) -> bool {
    matches!(byte, b'\n' | b'\r')
}

/// `word` in quotation marks for a message: control characters are escaped, and at
/// most [`SHOWN_BYTES`] bytes are shown.
pub(super) fn quoted(word: &[u8]) -> String {
    match word.get(..SHOWN_BYTES) {
        Some(start) if word.len() > SHOWN_BYTES => format!("'{}...'", start.escape_ascii()),
        _ => format!("'{}'", word.escape_ascii()),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn words_and_numbers_end_with_their_line() {
        let mut words = Words::new(b" a\t-1.5 \r\n\r\r\n  2e400 x", 0, 1);
        assert_eq!(words.word(), Some(&b"a"[..]));
        assert_eq!(words.number(), Some(Ok(-1.5)));
        assert_eq!((words.word(), words.number()), (None, None));
        words.skip_space();
        assert_eq!((words.line(), words.at()), (4, 15));
        assert_eq!(words.number(), Some(Ok(f64::INFINITY)), "not on the fast path");
        assert_eq!(words.number(), Some(Err(&b"x"[..])));
        assert_eq!((words.word(), words.number()), (None, None));
        assert!(words.left().is_empty());
    }

    #[test]
    fn a_number_fills_its_word() {
        for word in ["1x", "1.2.3", "1,5", "--1", "1e", "#1"] {
            let mut words = Words::new(word.as_bytes(), 0, 1);
            assert_eq!(words.number(), Some(Err(word.as_bytes())), "{word}");
        }
    }

    #[test]
    fn lines_end_in_three_ways() {
        let mut words = Words::new(b"a b \nc\r\nd\re", 0, 7);
        let mut lines = Vec::new();
        while !words.left().is_empty() {
            lines.push((words.line(), words.take_rest_of_line()));
        }
        assert_eq!(lines, [(7, &b"a b"[..]), (8, b"c"), (9, b"d"), (10, b"e")]);
    }

    #[test]
    fn messages_show_words_safely() {
        assert_eq!(quoted(b"a\x1b[1m'"), r"'a\x1b[1m\''");
        assert_eq!(quoted(&[b'a'; 60]), format!("'{}...'", "a".repeat(40)));
    }
}
