//! Mode 2: indices of any meaning, as differences from one of two earlier indices.
//!
//! ```text
//! 0xd1 | number, number, ... | 4 bytes of padding
//!         '- lowest bit: which of the two; the others: the difference
//! ```

use super::varint::{difference, take_number};

const HEADER: u8 = 0xd1;
const TAIL_BYTES: usize = 4;

/// Decodes `count` indices.
///
/// # Errors
/// Says what is wrong with the stream.
pub(super) fn decode_indices(stream: &[u8], count: usize) -> Result<Vec<u32>, String> {
    let data = stream.split_last_chunk::<TAIL_BYTES>().and_then(|(data, _)| data.split_first());
    let Some((&HEADER, mut data)) = data else {
        return Err("it is no stream of indices".into());
    };
    if count > data.len() {
        return Err("it ends too early".into());
    }
    let mut last = [0_u32; 2];
    let mut indices = Vec::with_capacity(count);
    for _ in 0..count {
        let number = take_number(&mut data)?;
        let baseline = &mut last[(number & 1) as usize];
        *baseline = baseline.wrapping_add(difference(number >> 1));
        indices.push(*baseline);
    }
    match data {
        [] => Ok(indices),
        _ => Err(format!("{} bytes are left over", data.len())),
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The stream of these numbers, each below 128.
    fn stream(numbers: &[u8]) -> Vec<u8> {
        [&[HEADER], numbers, &[0; TAIL_BYTES]].concat()
    }

    #[test]
    fn differences_count_from_one_of_two_indices() {
        // +5 for the first, +20 for the second, -1 and +1 for each, +0 for the first.
        let numbers = [5 << 2, (20 << 2) | 1, 2, (1 << 2) | 1, 0];
        assert_eq!(decode_indices(&stream(&numbers), 5), Ok(vec![5, 20, 4, 21, 4]));
        let first = [3];
        assert_eq!(decode_indices(&stream(&first), 1), Ok(vec![u32::MAX]), "wraps around");
        assert_eq!(decode_indices(&stream(&[]), 0), Ok(vec![]));
    }

    #[test]
    fn wrong_streams_are_errors() {
        let what = |stream: &[u8], count| decode_indices(stream, count).unwrap_err();
        let sound = stream(&[20, 8]);
        assert!(what(&sound, 3).contains("too early"));
        assert!(what(&sound, 1).contains("1 bytes are left over"));
        assert!(what(&sound, usize::MAX).contains("too early"));
        assert!(what(&[&[0xd0], &sound[1..]].concat(), 2).contains("no stream"));
        assert!(what(&stream(&[0x80]), 1).contains("too early"));
        for end in 0..sound.len() {
            assert!(decode_indices(&sound[..end], 2).is_err(), "{end}");
        }
    }
}
