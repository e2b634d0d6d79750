//! Decimal numbers, as text formats write them, correctly rounded.
//!
//! Idea: nearly every number of a model has at most 15 digits and a small
//! power of ten, and then one division or multiplication of two exact 64-bit
//! floats rounds correctly (Clinger 1990, "How to Read Floating Point Numbers
//! Accurately", the fast path). All others go to the standard library.
//!
//! Rejected: parsing to 32 bits, which loses what recentring needs.

/// Powers of ten that 64 bits hold exactly.
const EXACT_POWERS: [f64; 23] = [
    1e0, 1e1, 1e2, 1e3, 1e4, 1e5, 1e6, 1e7, 1e8, 1e9, 1e10, 1e11, 1e12, 1e13, 1e14, 1e15, 1e16,
    1e17, 1e18, 1e19, 1e20, 1e21, 1e22,
];

/// Whole numbers up to this are exact in 64 bits.
const LARGEST_EXACT: u64 = 1 << 53;

/// Reads a number that fills `word`; infinities and NaN are read too,
/// hexadecimal is not. `None` where it is no number.
#[must_use]
pub(crate) fn parse_number(word: &[u8]) -> Option<f64> {
    match parse_prefix(word) {
        Some((number, length)) if length == word.len() => Some(number),
        _ => parse_slow(word),
    }
}

/// Reads the plain number at the start of `text` and says how long it is;
/// `None` where it takes more than the fast path.
#[inline]
pub(crate) fn parse_prefix(text: &[u8]) -> Option<(f64, usize)> {
    let mut at = 0;
    let is_negative = text.first() == Some(&b'-');
    if is_negative || text.first() == Some(&b'+') {
        at = 1;
    }
    let start = at;
    let mut mantissa: u64 = 0;
    while let Some(digit) = digit_at(text, at) {
        mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
        at += 1;
    }
    let mut digits = at - start;
    let mut fraction_digits = 0;
    if text.get(at) == Some(&b'.') {
        at += 1;
        let fraction_start = at;
        while let Some(digit) = digit_at(text, at) {
            mantissa = mantissa.wrapping_mul(10).wrapping_add(digit);
            at += 1;
        }
        fraction_digits = at - fraction_start;
        digits += fraction_digits;
    }
    // 19 digits cannot overflow 64 bits.
    if digits == 0 || digits > 19 || mantissa > LARGEST_EXACT {
        return None;
    }
    let mut exponent = -i32::try_from(fraction_digits).ok()?;
    if let Some(b'e' | b'E') = text.get(at) {
        let (stated, length) = parse_exponent(text.get(at + 1..)?)?;
        exponent += stated;
        at += 1 + length;
    }
    #[expect(clippy::cast_precision_loss, reason = "at most LARGEST_EXACT")]
    let exact = mantissa as f64;
    let power = *EXACT_POWERS.get(usize::try_from(exponent.unsigned_abs()).ok()?)?;
    let number = if exponent < 0 { exact / power } else { exact * power };
    Some((if is_negative { -number } else { number }, at))
}

#[inline]
fn digit_at(text: &[u8], at: usize) -> Option<u64> {
    let digit = text.get(at)?.wrapping_sub(b'0');
    (digit < 10).then_some(u64::from(digit))
}

fn parse_exponent(text: &[u8]) -> Option<(i32, usize)> {
    let is_negative = text.first() == Some(&b'-');
    let start = usize::from(is_negative || text.first() == Some(&b'+'));
    let mut exponent = 0_i32;
    let mut at = start;
    while let Some(digit) = digit_at(text, at) {
        exponent = exponent * 10 + i32::try_from(digit).ok()?;
        if exponent > 400 {
            return None;
        }
        at += 1;
    }
    (at > start).then_some((if is_negative { -exponent } else { exponent }, at))
}

#[cold]
fn parse_slow(word: &[u8]) -> Option<f64> {
    std::str::from_utf8(word).ok()?.parse().ok()
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_are_what_the_standard_library_reads() {
        for word in [
            "0",
            "-0",
            "+1",
            "1.",
            ".5",
            "-.5e1",
            "1e3",
            "1E-3",
            "123456789012345678901234567890",
            "9007199254740993",
            "0.1",
            "0.3",
            "1e22",
            "1e23",
            "1e-22",
            "1e-30",
            "1e400",
            "-1e400",
            "3.40282347e38",
            "1.17549435e-38",
            "4.9e-324",
            "inf",
            "-Infinity",
            "nan",
            "0.000000000000000000000000001",
            "179769313486231570000000000000000000000",
        ] {
            let expected: f64 = word.parse().unwrap();
            let found = parse_number(word.as_bytes()).unwrap();
            assert!(found == expected || found.is_nan() && expected.is_nan(), "{word}: {found}");
            assert_eq!(found.is_sign_negative(), expected.is_sign_negative(), "{word}");
        }
    }

    #[test]
    fn what_is_no_number() {
        for word in ["", "-", ".", "e5", "1e", "1e+", "0x10", "1,5", "1.2.3", "--1", "1 ", "one"] {
            assert_eq!(parse_number(word.as_bytes()), None, "{word}");
        }
    }

    #[test]
    fn many_numbers_round_correctly() {
        // A plain generator; the numbers have 1 to 19 digits and a point.
        let mut state = 1_u64;
        for _ in 0..20_000 {
            state = state.wrapping_mul(6_364_136_223_846_793_005).wrapping_add(1);
            let digits = (state >> (state % 60)).to_string();
            let point = usize::try_from(state >> 33).unwrap() % (digits.len() + 1);
            let word = format!("-{}.{}", &digits[..point], &digits[point..]);
            let expected: f64 = word.parse().unwrap();
            assert!(parse_number(word.as_bytes()) == Some(expected), "{word}");
        }
    }
}
