//! Decimal numbers of text formats, correctly rounded to 64 bits.
//!
//! Numbers that are not finite are read as C libraries print them: `nan`, `-inf`, and the
//! spellings in `non_finite`, two of which hold a character that ends a word or a line in
//! some formats.
//!
//! Rejected: 32 bits, which lose what recentering needs.

use super::non_finite::non_finite_prefix;

/// The number that `word` consists of, as [`str::parse`] reads it (decimal, with
/// infinities and NaN, without hexadecimal) or as a C library prints it.
#[must_use]
pub(crate) fn parse_number(word: &[u8]) -> Option<f64> {
    let decimal = fast_float2::parse(word).ok();
    decimal.or_else(|| {
        non_finite_prefix(word)
            .filter(|&(_, length)| length == word.len())
            .map(|(number, _)| number)
    })
}

/// The number at the start of `text`, with its length in bytes; `None` if there is
/// none, or an `e` without an exponent follows it.
#[inline]
pub(crate) fn parse_prefix(text: &[u8]) -> Option<(f64, usize)> {
    let (number, length) = fast_float2::parse_partial(text).ok()?;
    let is_whole = !matches!(text.get(length), Some(b'e' | b'E'));
    is_whole.then_some((number, length))
}

#[cfg(test)]
mod tests {
    use proptest::prelude::*;

    use super::*;

    /// The bits of the number that the standard library reads.
    fn bits(word: &str) -> Option<u64> {
        word.parse().ok().map(f64::to_bits)
    }

    fn our_bits(word: &str) -> Option<u64> {
        parse_number(word.as_bytes()).map(f64::to_bits)
    }

    #[test]
    fn numbers_are_what_the_standard_library_reads() {
        let words = "0 -0 +1 1. .5 -.5e1 1e3 1E-3 123456789012345678901234567890 9007199254740993 \
            0.1 0.3 1e22 1e23 1e-22 1e-30 1e400 -1e400 3.40282347e38 1.17549435e-38 4.9e-324 inf \
            -Infinity +INF nan 0.000000000000000000000000001 1e-400 2.2250738585072014e-308";
        for word in words.split_whitespace() {
            assert!(our_bits(word).is_some() && our_bits(word) == bits(word), "{word}");
        }
    }

    #[test]
    fn other_words_are_not_numbers() {
        for word in ["", "-", ".", "e5", "1e", "1e+", "0x10", "1,5", "1.2.3", "--1", "1 ", "one"] {
            assert_eq!((parse_number(word.as_bytes()), bits(word)), (None, None), "{word}");
        }
    }

    #[test]
    fn numbers_that_are_not_finite_are_read_as_c_libraries_print_them() {
        for word in ["-nan(ind)", "nan(0x8000)", "1.#QNAN", "-1.#IND00", "-1.#J", "NaNQ"] {
            assert!(parse_number(word.as_bytes()).is_some_and(f64::is_nan), "{word}");
        }
        assert_eq!(parse_number(b"1.#INF"), Some(f64::INFINITY));
        for word in ["nan(ind", "1.#", "1.#INFO", "3.#comment", "nano"] {
            assert_eq!(parse_number(word.as_bytes()), None, "{word}");
        }
    }

    #[test]
    fn a_prefix_ends_where_the_number_ends() {
        for (text, prefix) in [
            ("1.5 2", Some((1.5, 3))),
            ("-2e3/4", Some((-2e3, 4))),
            ("3.1+e2", Some((3.1, 3))),
            ("1e", None),
            ("1e+ 2", None),
            ("x", None),
        ] {
            assert_eq!(parse_prefix(text.as_bytes()), prefix, "{text}");
        }
    }

    proptest! {
        #[test]
        fn all_digits_round_as_in_the_standard_library(
            word in "[+-]?[0-9]{0,25}(\\.[0-9]{0,25})?([eE][+-]?[0-9]{0,4})?"
        ) {
            prop_assert_eq!(our_bits(&word), bits(&word));
        }

        #[test]
        fn every_number_is_read_back(number in any::<f64>(), digits in 0..20_usize) {
            for word in [format!("{number}"), format!("{number:e}"), format!("{number:.digits$e}")] {
                prop_assert_eq!(our_bits(&word), bits(&word));
            }
        }

        #[test]
        fn any_text_is_judged_alike(word in "[-+.0-9eEinfatyINFATY]{0,8}|.{0,6}") {
            prop_assert_eq!(our_bits(&word), bits(&word));
        }
    }
}
