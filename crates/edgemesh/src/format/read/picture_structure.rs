//! Whether a PNG or JPEG picture can be decoded, as far as its structure tells.
//!
//! Source: PNG (W3C, third edition), sections 5 and 11; JPEG (ITU-T T.81), annex B.
//!
//! ```text
//! PNG   signature | length IHDR sizes crc | ... | length IDAT data crc | ... | 0 IEND crc
//! JPEG  FFD8 | FFxx length tables | ... | FFC0 length sizes | ... | FFDA length, scan
//! ```
//!
//! Idea: step from part to part by the stated lengths, which reads some kilobytes of a large
//! picture, and finds files that were cut short, empty or overwritten. In a JPEG picture the
//! steps end at the first scan: decoders show what is there of it.
//!
//! Rejected: decoding. A model can have a gigabyte of pictures, and most commands draw none. A
//! fault within the compressed data is found when the picture is drawn.

use std::io::{self, BufReader, Read, Seek};

/// The first bytes of a PNG picture.
const PNG: &[u8] = b"\x89PNG\r\n\x1a\n";

/// The first bytes of a JPEG picture.
const JPEG: &[u8] = b"\xff\xd8\xff";

/// Allowed bits of a sample, by the type of color (PNG, table 8).
const BIT_DEPTHS: [(u8, &[u8]); 5] =
    [(0, &[1, 2, 4, 8, 16]), (2, &[8, 16]), (3, &[1, 2, 4, 8]), (4, &[8, 16]), (6, &[8, 16])];

/// Checks a picture in `file`, which is `size` bytes long and at its start.
///
/// # Errors
/// Fails if it is not PNG or JPEG, or cannot be decoded. The message follows the picture's name
/// in a sentence and reveals nothing of its content.
pub(super) fn check_picture(file: impl Read + Seek, size: u64) -> Result<(), String> {
    let mut parts = Parts { file: BufReader::new(file), at: 0, size };
    let head = parts.take::<8>();
    match head {
        Ok(head) if head == *PNG => check_png(&mut parts),
        Ok(head) if head.starts_with(JPEG) => {
            parts.rewind_to(2)?;
            check_jpeg(&mut parts)
        }
        _ => Err("is not a PNG or JPEG picture".into()),
    }
}

/// A picture that is read part by part.
struct Parts<F> {
    file: BufReader<F>,
    at: u64,
    size: u64,
}

impl<F: Read + Seek> Parts<F> {
    /// The next `N` bytes.
    fn take<const N: usize>(&mut self) -> Result<[u8; N], String> {
        let mut bytes = [0; N];
        self.file.read_exact(&mut bytes).map_err(|error| match error.kind() {
            io::ErrorKind::UnexpectedEof => "is cut short".into(),
            _ => error.to_string(),
        })?;
        self.at += N as u64;
        Ok(bytes)
    }

    /// Steps over `count` bytes, which must be there.
    fn skip(&mut self, count: u64) -> Result<(), String> {
        let end = self.at + count;
        if end > self.size {
            return Err("is cut short".into());
        }
        self.file.seek_relative(count.cast_signed()).map_err(|error| error.to_string())?;
        self.at = end;
        Ok(())
    }

    fn rewind_to(&mut self, at: u64) -> Result<(), String> {
        let back = at.cast_signed() - self.at.cast_signed();
        self.file.seek_relative(back).map_err(|error| error.to_string())?;
        self.at = at;
        Ok(())
    }
}

fn check_png<F: Read + Seek>(parts: &mut Parts<F>) -> Result<(), String> {
    let [a, b, c, d, kind @ ..] = parts.take::<8>()?;
    if (u32::from_be_bytes([a, b, c, d]), &kind) != (13, b"IHDR") {
        return Err("is a PNG picture without its header".into());
    }
    let header = parts.take::<13>()?;
    let is_empty = header[..4] == [0; 4] || header[4..8] == [0; 4];
    let [depth, color] = [header[8], header[9]];
    let is_known =
        BIT_DEPTHS.iter().any(|(known, depths)| *known == color && depths.contains(&depth));
    if is_empty || !is_known {
        return Err("is a PNG picture with a damaged header".into());
    }
    parts.skip(4)?;
    let mut has_data = false;
    loop {
        let [a, b, c, d, kind @ ..] = parts.take::<8>()?;
        // The check sum.
        parts.skip(u64::from(u32::from_be_bytes([a, b, c, d])) + 4)?;
        match &kind {
            b"IDAT" => has_data = true,
            b"IEND" if has_data => return Ok(()),
            b"IEND" => return Err("is a PNG picture without data".into()),
            _ => {}
        }
    }
}

fn check_jpeg<F: Read + Seek>(parts: &mut Parts<F>) -> Result<(), String> {
    let mut has_size = false;
    loop {
        // Any number of 0xff may precede a marker; decoders skip other bytes before them.
        while parts.take::<1>()? != [0xff] {}
        let mut marker = 0xff;
        while marker == 0xff {
            [marker] = parts.take()?;
        }
        match marker {
            // Not a marker, or one without a length.
            0 | 1 | 0xd0..=0xd8 => continue,
            0xd9 => return Err("is a JPEG picture without data".into()),
            _ => {}
        }
        let length = u64::from(u16::from_be_bytes(parts.take()?));
        let end = parts.at + length.saturating_sub(2);
        if matches!(marker, 0xc0..=0xcf) && !matches!(marker, 0xc4 | 0xc8 | 0xcc) {
            // Bits of a sample, lines, samples of a line; the number of lines can follow later.
            let [_, _, _, wide, wider] = parts.take()?;
            if [wide, wider] == [0; 2] {
                return Err("is a JPEG picture with a damaged header".into());
            }
            has_size = true;
        }
        parts.skip(end.saturating_sub(parts.at))?;
        if marker == 0xda {
            // At least a byte of the scan.
            parts.take::<1>()?;
            return if has_size {
                Ok(())
            } else {
                Err("is a JPEG picture without a header".into())
            };
        }
    }
}

/// A PNG and a JPEG picture of one gray pixel.
#[cfg(test)]
pub(super) const SAMPLES: [&[u8]; 2] = [
    b"\x89PNG\r\n\x1a\n\0\0\0\rIHDR\0\0\0\x01\0\0\0\x01\x08\0\0\0\0\x3a\x7e\x9b\x55\
      \0\0\0\nIDATx\xda\x63\x68\0\0\0\x82\0\x81\xda\x45\x08\x3b\0\0\0\0IEND\xae\x42\x60\x82",
    b"\xff\xd8\xff\xe0\0\x10JFIF\0\x01\x01\0\0\x01\0\x01\0\0\xff\xc0\0\x0b\x08\0\x01\0\x01\
      \x01\x01\x11\0\xff\xda\0\x08\x01\x01\0\0\x3f\0\x7f\xff\xd9",
];

#[cfg(test)]
mod tests {
    use std::io::Cursor;

    use super::*;

    fn check(bytes: &[u8]) -> Result<(), String> {
        check_picture(Cursor::new(bytes), bytes.len() as u64)
    }

    #[test]
    fn whole_pictures_are_sound_and_cut_ones_are_not() {
        let [png, jpeg] = SAMPLES;
        assert_eq!((check(png), check(jpeg)), (Ok(()), Ok(())));
        for end in 8..png.len() {
            assert_eq!(check(&png[..end]), Err("is cut short".into()), "{end} bytes");
        }
        // The scan begins 3 bytes before the end.
        for end in 8..jpeg.len() - 2 {
            assert_eq!(check(&jpeg[..end]), Err("is cut short".into()), "{end} bytes");
        }
        let padded = [png, &[0; 5000]].concat();
        assert_eq!(check(&padded), Ok(()));
    }

    #[test]
    fn damaged_pictures_are_named() {
        let png = |at: usize, byte: u8| {
            let mut bytes = SAMPLES[0].to_vec();
            bytes[at] = byte;
            check(&bytes).unwrap_err()
        };
        assert!(png(12, b'X').contains("without its header"));
        assert!(png(19, 0).contains("damaged header"), "no width");
        assert!(png(24, 3).contains("damaged header"), "three bits");
        assert!(png(37, b'X').contains("without data"));
        assert!(png(33, 1).contains("cut short"), "a length of 16 MiB");
        let jpeg = |at: usize, byte: u8| {
            let mut bytes = SAMPLES[1].to_vec();
            bytes[at] = byte;
            check(&bytes)
        };
        assert!(jpeg(21, 0xd9).unwrap_err().contains("without data"));
        assert!(jpeg(21, 0xc4).unwrap_err().contains("without a header"));
        assert!(jpeg(28, 0).unwrap_err().contains("damaged header"), "no width");
        assert!(jpeg(20, 0).unwrap_err().contains("without a header"), "no marker");
        for other in [&b"RIFF\0\0\0\0WEBP"[..], b"GIF89a", b"", b"\xff\xd8\xff"] {
            assert_eq!(check(other), Err("is not a PNG or JPEG picture".into()));
        }
    }
}
