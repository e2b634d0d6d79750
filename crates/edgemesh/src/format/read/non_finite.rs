//! Numbers that are not finite, as C libraries print them.
//!
//! ```text
//! nan(ind)  -nan(snan)  nan(0x8000000000000)     C99: `nan` and what the library adds
//! 1.#INF  -1.#IND  1.#QNAN  1.#SNAN              Microsoft before 2015
//! 1.#INF00  -1.#IND000e+000                      with a precision and an exponent
//! 1.#J  1.#IO  1.#R  1.#QO  1.#QNB               rounded to a few "digits"
//! NaNQ  NaNS                                     AIX
//! ```
//!
//! The rounded forms come from libraries that round these letters as if they were digits:
//! with two places, `1.#INF` becomes `1.#IO`.
//!
//! Rejected: any letters after `1.#`. In `1.#note`, a comment follows a number.

/// What stands after `1.#`, in upper case; the longer forms first. Which number a rounded form
/// was is not known.
const AFTER_HASH: [(&[u8], f64); 12] = [
    (b"QNAN", f64::NAN),
    (b"SNAN", f64::NAN),
    (b"QNB", f64::NAN),
    (b"SNB", f64::NAN),
    (b"IND", f64::NAN),
    (b"INF", f64::INFINITY),
    (b"IO", f64::NAN),
    (b"QO", f64::NAN),
    (b"SO", f64::NAN),
    (b"J", f64::NAN),
    (b"R", f64::NAN),
    (b"T", f64::NAN),
];

/// A number at the start of `text` that is spelled in one of the ways above, with its length in
/// bytes; `None` if there is none (as for `nan` and `inf` alone), or if the word goes on after it.
pub(super) fn non_finite_prefix(text: &[u8]) -> Option<(f64, usize)> {
    let unsigned = text.strip_prefix(b"-").or_else(|| text.strip_prefix(b"+")).unwrap_or(text);
    let (number, rest) = match unsigned.first()? {
        b'1' => after_hash(unsigned.strip_prefix(b"1.#")?)?,
        b'n' | b'N' => (f64::NAN, after_nan(unsigned)?),
        _ => return None,
    };
    let goes_on =
        rest.first().is_some_and(|&byte| byte.is_ascii_alphanumeric() || b"._#-/".contains(&byte));
    let number = if text.starts_with(b"-") { -number } else { number };
    (!goes_on).then_some((number, text.len() - rest.len()))
}

/// The number whose end `text` begins with, and the text after it.
fn after_hash(text: &[u8]) -> Option<(f64, &[u8])> {
    let begins =
        |name: &[u8]| text.get(..name.len()).is_some_and(|start| start.eq_ignore_ascii_case(name));
    let &(name, number) = AFTER_HASH.iter().find(|(name, _)| begins(name))?;
    let rest = without(text.get(name.len()..)?, |byte| byte == b'0');
    Some((number, without_exponent(rest)))
}

/// The text after `nan` and what a library adds to it.
fn after_nan(text: &[u8]) -> Option<&[u8]> {
    let (nan, rest) = text.split_at_checked(3)?;
    if !nan.eq_ignore_ascii_case(b"nan") {
        return None;
    }
    match rest {
        [b'(', inside @ ..] => {
            without(inside, |byte| byte.is_ascii_alphanumeric() || byte == b'_').strip_prefix(b")")
        }
        [b'q' | b'Q' | b's' | b'S', rest @ ..] => Some(rest),
        _ => None,
    }
}

/// `text` without an exponent such as `e+000` at its start.
fn without_exponent(text: &[u8]) -> &[u8] {
    let [b'e' | b'E', b'+' | b'-', digits @ ..] = text else { return text };
    without(digits, |byte| byte.is_ascii_digit())
}

/// `text` without the bytes at its start for which `is_skipped` is true.
fn without(text: &[u8], is_skipped: impl Fn(u8) -> bool) -> &[u8] {
    let start = text.iter().position(|&byte| !is_skipped(byte)).unwrap_or(text.len());
    text.get(start..).unwrap_or_default()
}

#[cfg(test)]
mod tests {
    use super::*;

    /// What `printf` of these libraries prints, with any precision and sign.
    #[test]
    fn every_spelling_is_a_number_up_to_its_end() {
        let words = "nan(ind) -nan(ind) nan(snan) -nan(snan) nan(0x8000000000000) nan(1_a) nan() NAN(IND) \
            1.#INF -1.#INF 1.#INF00 1.#INF000 1.#INF00e+000 -1.#IND -1.#IND00 -1.#IND000000 \
            1.#QNAN -1.#QNAN00 1.#SNAN 1.#SNAN00e+000 1.#J -1.#J 1.#IO -1.#IO 1.#R 1.#QO 1.#QNB \
            1.#T 1.#SO 1.#SNB +1.#INF 1.#inf -1.#ind00 NaNQ NaNS -NaNQ";
        for word in words.split_whitespace() {
            for after in ["", " 2", ",", "]", "}", "\n", "\t", ")"] {
                let text = format!("{word}{after}");
                let (number, length) = non_finite_prefix(text.as_bytes()).unwrap_or((0.0, 0));
                assert!(!number.is_finite(), "{text}");
                assert_eq!(length, word.len(), "{text}");
            }
        }
        assert_eq!(non_finite_prefix(b"-1.#INF00 1"), Some((f64::NEG_INFINITY, 9)));
    }

    #[test]
    fn finite_numbers_comments_and_names_are_not_among_them() {
        for text in [
            "",
            "1",
            "1.",
            "1.5",
            "-",
            "1.#",
            "1.# INF",
            "1.#note",
            "1.#INFO",
            "1.#INF5",
            "1.#INFe5",
            "1.#inform",
            "2.#INF",
            "11.#INF",
            "1#INF",
            "nan(",
            "nan(ind",
            "nan(a b)",
            "nano",
            "name",
            "na",
            "nan",
            "nanq-x",
            "nan(x)/y",
            "inf(ind)",
            "1.#IND.5",
            "--1.#INF",
            "nan.obj",
            "1.#J#",
        ] {
            assert_eq!(
                non_finite_prefix(text.as_bytes()).map(|(_, length)| length),
                None,
                "{text}"
            );
        }
    }
}
