//! Mode 0: elements of any meaning, as differences from the element before.
//!
//! ```text
//! 0xa0 or 0xa1 | block | block | ... | padding | first element's base | channels (a1)
//!
//! block of at most 256 elements:
//!     controls (a1), 2 bits for each byte of an element
//!     byte 0 of all elements | byte 1 of all | ...
//!
//! such a byte of all elements: widths of its groups of 16, 2 bits each, then the groups
//! group, 4 bits wide:  1 7 5 f f 0 ...  a8 03      f stands for a whole byte behind it
//! ```
//!
//! A stream of equal elements is a thousand times as long as its controls. So memory
//! grows block by block, and `super` limits the whole.

/// The elements of a group.
const GROUP: usize = 16;

/// The most bytes and elements of a block.
const BLOCK_BYTES: usize = 8192;
const BLOCK_ELEMENTS: usize = 256;

/// The bits of a difference in a group, by its 2 bits in the header: those of version 0,
/// and those of the controls 0 and 1 of version 1.
const WIDTHS_V0: [u8; 4] = [0, 2, 4, 8];
const WIDTHS_V1: [[u8; 4]; 2] = [[0, 1, 2, 4], [1, 2, 4, 8]];

const TOO_SHORT: &str = "it ends too early";

/// Decodes `count` elements of `stride` bytes.
///
/// # Errors
/// Says what is wrong with the stream.
pub(super) fn decode_attributes(
    stream: &[u8],
    stride: usize,
    count: usize,
) -> Result<Vec<u8>, String> {
    let (version, body) = match stream.split_first() {
        Some((0xa0, body)) => (Version::V0, body),
        Some((0xa1, body)) => (Version::V1, body),
        _ => return Err("it is no stream of attributes".into()),
    };
    let channel_bytes = if version == Version::V1 { stride / 4 } else { 0 };
    let tail = stride + channel_bytes;
    let padded_tail = tail.max(if version == Version::V1 { 24 } else { 32 });
    let (data, padded) = body.len().checked_sub(padded_tail).map_or((body, None), |at| {
        let (data, padded) = body.split_at(at);
        (data, Some(padded))
    });
    let tail = padded.ok_or(TOO_SHORT)?.get(padded_tail - tail..).ok_or(TOO_SHORT)?;
    let (base, channels) = tail.split_at(stride);
    let mut decoder = Decoder { data, version, previous: base.to_vec(), deltas: Vec::new() };
    let most = ((BLOCK_BYTES / stride) & !(GROUP - 1)).min(BLOCK_ELEMENTS);
    let mut elements = Vec::new();
    let mut left = count;
    while left > 0 {
        let block = left.min(most);
        decoder.block(block, channels, &mut elements)?;
        left -= block;
    }
    match decoder.data {
        [] => Ok(elements),
        data => Err(format!("{} bytes are left over", data.len())),
    }
}

#[derive(Debug, Clone, Copy, PartialEq, Eq)]
enum Version {
    V0,
    V1,
}

struct Decoder<'a> {
    /// The data that are not decoded yet.
    data: &'a [u8],
    version: Version,
    /// The last element.
    previous: Vec<u8>,
    /// The coded differences of a block, byte by byte of an element.
    deltas: Vec<u8>,
}

impl<'a> Decoder<'a> {
    /// Decodes a block of `count` elements.
    fn block(
        &mut self,
        count: usize,
        channels: &[u8],
        elements: &mut Vec<u8>,
    ) -> Result<(), String> {
        let stride = self.previous.len();
        let controls = match self.version {
            Version::V0 => &[],
            Version::V1 => self.take(stride / 4)?,
        };
        self.deltas.clear();
        for byte in 0..stride {
            let control = controls.get(byte / 4).map(|packed| packed >> (2 * (byte % 4)) & 3);
            match control {
                None => self.groups(count, WIDTHS_V0)?,
                Some(0) => self.groups(count, WIDTHS_V1[0])?,
                Some(1) => self.groups(count, WIDTHS_V1[1])?,
                Some(2) => self.deltas.resize(self.deltas.len() + count, 0),
                Some(_) => {
                    let whole = self.take(count)?;
                    self.deltas.extend(whole);
                }
            }
        }
        let mut element = vec![0; stride];
        for at in 0..count {
            for (byte, code) in element.iter_mut().enumerate() {
                *code = self.deltas.get(byte * count + at).copied().unwrap_or_default();
            }
            for (channel, words) in element.as_chunks_mut::<4>().0.iter_mut().enumerate() {
                let mode = channels.get(channel).copied().unwrap_or_default();
                let before = self.previous.as_chunks::<4>().0.get(channel);
                *words = channel_value(mode, before.copied().unwrap_or_default(), *words)?;
            }
            self.previous.copy_from_slice(&element);
            elements.extend(&element);
        }
        Ok(())
    }

    /// Decodes the differences of one byte of `count` elements.
    fn groups(&mut self, count: usize, widths: [u8; 4]) -> Result<(), String> {
        let groups = count.div_ceil(GROUP);
        let header = self.take(groups.div_ceil(4))?;
        let end = self.deltas.len() + count;
        for group in 0..groups {
            let packed = header.get(group / 4).copied().unwrap_or_default();
            let width = widths[usize::from(packed >> (2 * (group % 4)) & 3)];
            let deltas = self.group(width)?;
            self.deltas.extend(deltas);
        }
        // The last group may have more elements than are left.
        self.deltas.truncate(end);
        Ok(())
    }

    /// Decodes a group whose differences have `width` bits.
    fn group(&mut self, width: u8) -> Result<[u8; GROUP], String> {
        let mut deltas = [0; GROUP];
        if width == 0 {
            return Ok(deltas);
        }
        let packed = self.take(GROUP * usize::from(width) / 8)?;
        if width == 8 {
            deltas.copy_from_slice(packed);
            return Ok(deltas);
        }
        let whole = (1 << width) - 1;
        let per_byte = 8 / width;
        for (at, delta) in (0..).zip(&mut deltas) {
            let place = at % per_byte;
            // Single bits begin at the lowest, others at the highest.
            let shift = if width == 1 { place } else { 8 - width * (place + 1) };
            let byte = packed.get(usize::from(at / per_byte)).copied().unwrap_or_default();
            *delta = byte >> shift & whole;
            if *delta == whole {
                *delta = self.take(1)?.first().copied().unwrap_or_default();
            }
        }
        Ok(deltas)
    }

    fn take(&mut self, count: usize) -> Result<&'a [u8], String> {
        let (taken, rest) = self.data.split_at_checked(count).ok_or(TOO_SHORT)?;
        self.data = rest;
        Ok(taken)
    }
}

/// Four bytes of an element, by those before and the coded difference.
fn channel_value(mode: u8, before: [u8; 4], delta: [u8; 4]) -> Result<[u8; 4], String> {
    match (mode & 0xf, mode >> 4) {
        (0, 0) => Ok(std::array::from_fn(|at| {
            let code = delta[at];
            let step = if code & 1 == 0 { code >> 1 } else { !(code >> 1) };
            before[at].wrapping_add(step)
        })),
        (1, 0) => {
            let sum = |[a, b]: [u8; 2], code: [u8; 2]| {
                let code = u16::from_le_bytes(code);
                let step = if code & 1 == 0 { code >> 1 } else { !(code >> 1) };
                u16::from_le_bytes([a, b]).wrapping_add(step).to_le_bytes()
            };
            let ([a, b, c, d], [e, f, g, h]) = (before, delta);
            let ([a, b], [c, d]) = (sum([a, b], [e, f]), sum([c, d], [g, h]));
            Ok([a, b, c, d])
        }
        (2, rotation) => {
            // The difference was rotated to the left when it was coded.
            let delta = u32::from_le_bytes(delta).rotate_right(rotation.into());
            Ok((u32::from_le_bytes(before) ^ delta).to_le_bytes())
        }
        _ => Err(format!("the channel mode {mode:#04x} is not defined")),
    }
}

/// The stream of version 0 of a few elements, with whole bytes as differences.
#[cfg(test)]
pub(super) fn whole_bytes_stream(elements: &[Vec<u8>]) -> Vec<u8> {
    let stride = elements[0].len();
    let mut stream = vec![0xa0];
    for byte in 0..stride {
        let mut group = [0; GROUP];
        for (at, pair) in elements.windows(2).enumerate() {
            group[at + 1] = tests::code(pair[1][byte].wrapping_sub(pair[0][byte]));
        }
        stream.push(3);
        stream.extend(group);
    }
    stream.extend(vec![0; 32_usize.saturating_sub(stride)]);
    stream.extend(&elements[0]);
    stream
}

#[cfg(test)]
mod tests {
    use super::*;

    /// The code of a difference, as the specification's `encode`.
    pub(super) fn code(difference: u8) -> u8 {
        if difference & 0x80 == 0 { difference << 1 } else { !(difference << 1) }
    }

    /// A stream with a tail of this base and these channel modes.
    fn stream(version: u8, data: &[u8], base: &[u8], modes: &[u8]) -> Vec<u8> {
        let tail = [base, modes].concat();
        let least = if version == 0xa0 { 32_usize } else { 24 };
        let padding = vec![0; least.saturating_sub(tail.len())];
        [&[version], data, &padding, &tail].concat()
    }

    /// The bytes that the differences sum up to.
    fn sums(differences: &[i8]) -> Vec<u8> {
        let mut sum = 0_u8;
        let add = |step: &i8| {
            sum = sum.wrapping_add(step.cast_unsigned());
            sum
        };
        differences.iter().map(add).collect()
    }

    #[test]
    fn the_example_of_the_specification() {
        let group = [0x17, 0x5f, 0xf0, 0xbc, 0x77, 0xa9, 0x21, 0x00, 0x34, 0xb5];
        let differences = [-1, -4, -3, 26, -91, 0, -6, 6, -4, -4, 5, -5, 1, -1, 0, 0];
        // Width 4 is 2 in version 0; the other three bytes have width 0.
        let data = [&[2][..], &group, &[0, 0, 0]].concat();
        let found = decode_attributes(&stream(0xa0, &data, &[0; 4], &[]), 4, 16).unwrap();
        let column: Vec<u8> = found.iter().step_by(4).copied().collect();
        assert_eq!(column, sums(&differences));
        assert!(found.iter().skip(1).step_by(4).all(|&byte| byte == 0));
    }

    #[test]
    fn groups_have_each_width() {
        // 1 bit, from the lowest: elements 0 and 9 are whole bytes, 4 (+2) and 3 (-2).
        let one = [0b0000_0001, 0b0000_0010, 4, 3];
        // 2 bits, from the highest: 1 (-1), 2 (+1), whole 200 (+100), 0 and so on.
        let two = [0b0110_1100, 0, 0, 0, 200];
        let whole: Vec<u8> = (0..16).collect();
        let unzigzagged = [0, -1, 1, -2, 2, -3, 3, -4, 4, -5, 5, -6, 6, -7, 7, -8];
        let mut ones = [0; 16];
        (ones[0], ones[9]) = (2, -2);
        let mut twos = [0; 16];
        (twos[0], twos[1], twos[2]) = (-1, 1, 100);
        // Controls of the bytes, the first lowest: 0, 1, 2, 3.
        let data = [&[0b1110_0100, 1][..], &one, &[1], &two, &whole].concat();
        let found = decode_attributes(&stream(0xa1, &data, &[0; 4], &[0]), 4, 16).unwrap();
        let column =
            |byte: usize| -> Vec<u8> { found.iter().skip(byte).step_by(4).copied().collect() };
        assert_eq!([column(0), column(1)], [sums(&ones), sums(&twos)]);
        assert_eq!([column(2), column(3)], [vec![0; 16], sums(&unzigzagged)]);
        // Control 1 with header 3: whole bytes as well.
        let data = [&[0b1010_1001, 3][..], &whole].concat();
        let found = decode_attributes(&stream(0xa1, &data, &[0; 4], &[0]), 4, 16).unwrap();
        assert_eq!(found.iter().step_by(4).copied().collect::<Vec<u8>>(), sums(&unzigzagged));
    }

    #[test]
    fn channels_have_modes() {
        // Three elements; each byte is a literal of three.
        let decode = |mode: u8, base: [u8; 4], deltas: [[u8; 4]; 3]| {
            let bytes: Vec<u8> = (0..4).flat_map(|byte| deltas.map(|delta| delta[byte])).collect();
            let data = [&[0xff][..], &bytes].concat();
            decode_attributes(&stream(0xa1, &data, &base, &[mode]), 4, 3)
        };
        let words = |words: [[u16; 2]; 3]| -> Vec<u8> {
            words.as_flattened().iter().flat_map(|word| word.to_le_bytes()).collect()
        };
        // 16 bits: +256 is the code 512, -1 the code 1; 65535 + 1 wraps.
        let found = decode(1, [0xff, 0, 0xff, 0xff], [[0, 2, 2, 0], [1, 0, 0, 0], [0; 4]]);
        assert_eq!(found.unwrap(), words([[0x1ff, 0], [0x1fe, 0], [0x1fe, 0]]));
        // 32 bits: the difference 0x0000_00f0, rotated to the left by 8 when coded.
        let found = decode(0x82, [1, 2, 3, 4], [[0, 0xf0, 0, 0], [0; 4], [1, 0, 0, 0]]);
        assert_eq!(found.unwrap(), [0xf1, 2, 3, 4, 0xf1, 2, 3, 4, 0xf1, 2, 3, 5]);
        for mode in [3, 0xf, 0x10, 0x11] {
            assert!(decode(mode, [0; 4], [[0; 4]; 3]).unwrap_err().contains("channel mode"));
        }
    }

    #[test]
    fn blocks_continue_from_each_other() {
        // 300 elements of 4 bytes in version 1: a block of 256, one of 44, all zeros.
        let data = [0b1010_1010; 2];
        let found = decode_attributes(&stream(0xa1, &data, &[9, 8, 7, 6], &[0]), 4, 300).unwrap();
        assert_eq!(found, [9, 8, 7, 6].repeat(300));
        // 40 elements of 256 bytes: blocks of 32 and 8; the first byte counts up.
        let mut data = Vec::new();
        for count in [32, 8] {
            data.push(0b1010_1011);
            data.extend([0b1010_1010; 63]);
            data.extend(vec![2; count]);
        }
        let found = decode_attributes(&stream(0xa1, &data, &[0; 256], &[0; 64]), 256, 40).unwrap();
        let column: Vec<u8> = found.iter().step_by(256).copied().collect();
        assert_eq!(column, (1..=40).collect::<Vec<u8>>());
    }

    #[test]
    fn wrong_streams_are_errors() {
        let sound = whole_bytes_stream(&[vec![1, 2, 3, 4], vec![5, 6, 7, 8]]);
        assert_eq!(decode_attributes(&sound, 4, 2), Ok(vec![1, 2, 3, 4, 5, 6, 7, 8]));
        for end in 0..sound.len() {
            assert!(decode_attributes(&sound[..end], 4, 2).is_err(), "{end}");
        }
        let what = |stream: &[u8], count| decode_attributes(stream, 4, count).unwrap_err();
        assert!(what(&[&[0xa2], &sound[1..]].concat(), 2).contains("no stream"));
        assert!(what(&[&sound[..1], &[0], &sound[1..]].concat(), 2).contains("left over"));
        assert!(what(&sound, usize::MAX).contains("too early"));
        assert!(what(&sound, 0).contains("68 bytes are left over"));
    }
}
