//! Numbers of one to five bytes, and signed differences as unsigned numbers.
//!
//! ```text
//! 1xxxxxxx 1yyyyyyy 0zzzzzzz     seven bits each, the lowest first; the last has no 1
//! 0 1 2 3 4 -> 0 -1 1 -2 2       the lowest bit is the sign
//! ```

/// The most bytes of a number.
const MOST_BYTES: usize = 5;

/// Takes a number from the start of `stream`.
///
/// # Errors
/// Says that the stream ends, or that the number is too long.
pub(super) fn take_number(stream: &mut &[u8]) -> Result<u32, String> {
    let mut number = 0;
    for place in 0..MOST_BYTES {
        let byte = take_byte(stream)?;
        // Bits beyond the 32nd are ignored.
        number |= u32::from(byte & 0x7f) << (7 * place);
        if byte & 0x80 == 0 {
            return Ok(number);
        }
    }
    Err("a number has more than five bytes".into())
}

/// Takes a byte from the start of `stream`.
///
/// # Errors
/// Says that the stream ends.
pub(super) fn take_byte(stream: &mut &[u8]) -> Result<u8, String> {
    let (&byte, rest) = stream.split_first().ok_or("it ends too early")?;
    *stream = rest;
    Ok(byte)
}

/// The difference that `number` stands for, modulo 2^32.
pub(super) const fn difference(number: u32) -> u32 {
    if number & 1 == 0 { number >> 1 } else { !(number >> 1) }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn numbers_have_one_to_five_bytes() {
        // The first two are examples of the specification. Its third one has the bytes of
        // the last line but one and calls them 0x1fd005, which is not LEB128.
        for (bytes, number) in [
            (&[0x7f][..], 0x7f),
            (&[0x81, 0x04], 0x201),
            (&[0xff, 0xa0, 0x05], 0x1507f),
            (&[0xff, 0xff, 0xff, 0xff, 0x7f], u32::MAX),
        ] {
            let mut stream = bytes;
            assert_eq!((take_number(&mut stream), stream.len()), (Ok(number), 0));
            assert!(take_number(&mut &bytes[..bytes.len() - 1]).is_err());
        }
        assert!(take_number(&mut &[0x80; 6][..]).unwrap_err().contains("five"));
    }

    #[test]
    fn differences_alternate() {
        let found = [0, 1, 2, 3, 4].map(|number| difference(number).cast_signed());
        assert_eq!(found, [0, -1, 1, -2, 2]);
        assert_eq!(difference(u32::MAX).cast_signed(), i32::MIN);
    }
}
