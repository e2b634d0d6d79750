//! The eight number types of PLY.
//!
//! A 64-bit float holds the values of all of them exactly, so every value becomes
//! one.

/// The type of a value.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Scalar {
    /// `char`
    I8,
    /// `uchar`
    U8,
    /// `short`
    I16,
    /// `ushort`
    U16,
    /// `int`
    I32,
    /// `uint`
    U32,
    /// `float`
    F32,
    /// `double`
    F64,
}

impl Scalar {
    /// The type with this name in a header; each type has an old and a new name.
    pub(super) fn of_name(name: &[u8]) -> Option<Self> {
        Some(match name {
            b"char" | b"int8" => Self::I8,
            b"uchar" | b"uint8" => Self::U8,
            b"short" | b"int16" => Self::I16,
            b"ushort" | b"uint16" => Self::U16,
            b"int" | b"int32" => Self::I32,
            b"uint" | b"uint32" => Self::U32,
            b"float" | b"float32" => Self::F32,
            b"double" | b"float64" => Self::F64,
            _ => return None,
        })
    }

    /// The bytes of a value in a binary file.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
            Self::F64 => 8,
        }
    }

    /// Whether it is a floating-point type.
    pub(super) const fn is_float(self) -> bool {
        matches!(self, Self::F32 | Self::F64)
    }

    /// The value of a full color channel.
    ///
    /// Programs that write colors as `int` use the range of a byte.
    pub(super) const fn color_maximum(self) -> f64 {
        match self {
            Self::F32 | Self::F64 => 1.0,
            Self::I16 | Self::U16 => 65535.0,
            Self::I8 | Self::U8 | Self::I32 | Self::U32 => 255.0,
        }
    }

    /// The value at the start of `bytes`; `None` if they are too few.
    #[inline]
    pub(super) fn decode(self, bytes: &[u8], is_big_endian: bool) -> Option<f64> {
        Some(match self {
            Self::I8 => f64::from(i8::from_le_bytes(first(bytes, is_big_endian)?)),
            Self::U8 => f64::from(u8::from_le_bytes(first(bytes, is_big_endian)?)),
            Self::I16 => f64::from(i16::from_le_bytes(first(bytes, is_big_endian)?)),
            Self::U16 => f64::from(u16::from_le_bytes(first(bytes, is_big_endian)?)),
            Self::I32 => f64::from(i32::from_le_bytes(first(bytes, is_big_endian)?)),
            Self::U32 => f64::from(u32::from_le_bytes(first(bytes, is_big_endian)?)),
            Self::F32 => f64::from(f32::from_le_bytes(first(bytes, is_big_endian)?)),
            Self::F64 => f64::from_le_bytes(first(bytes, is_big_endian)?),
        })
    }
}

/// The first `N` bytes, reordered to little-endian.
#[inline]
fn first<const N: usize>(bytes: &[u8], is_big_endian: bool) -> Option<[u8; N]> {
    let mut chunk = *bytes.first_chunk::<N>()?;
    if is_big_endian {
        chunk.reverse();
    }
    Some(chunk)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn types_have_two_names() {
        for (old, new, kind, size) in [
            ("char", "int8", Scalar::I8, 1),
            ("uchar", "uint8", Scalar::U8, 1),
            ("short", "int16", Scalar::I16, 2),
            ("ushort", "uint16", Scalar::U16, 2),
            ("int", "int32", Scalar::I32, 4),
            ("uint", "uint32", Scalar::U32, 4),
            ("float", "float32", Scalar::F32, 4),
            ("double", "float64", Scalar::F64, 8),
        ] {
            assert_eq!(Scalar::of_name(old.as_bytes()), Some(kind));
            assert_eq!(Scalar::of_name(new.as_bytes()), Some(kind));
            assert_eq!(kind.size(), size);
        }
        assert_eq!(Scalar::of_name(b"list"), None);
    }

    #[test]
    fn values_come_in_both_byte_orders() {
        for (kind, little, value) in [
            (Scalar::I8, &[0x80][..], -128.0),
            (Scalar::U8, &[0x80], 128.0),
            (Scalar::I16, &[0xfe, 0xff], -2.0),
            (Scalar::U16, &[0xfe, 0xff], 65534.0),
            (Scalar::I32, &[0, 0, 0, 0x80], -2_147_483_648.0),
            (Scalar::U32, &[0xff; 4], 4_294_967_295.0),
            (Scalar::F32, &[0, 0, 0x20, 0xc0], -2.5),
            (Scalar::F64, &[0, 0, 0, 0, 0, 0, 0x04, 0x40], 2.5),
        ] {
            assert_eq!(kind.decode(little, false), Some(value), "{kind:?}");
            let big: Vec<u8> = little.iter().rev().copied().collect();
            assert_eq!(kind.decode(&big, true), Some(value), "{kind:?}");
            assert_eq!(kind.decode(&big[1..], true), None, "{kind:?}");
        }
    }
}
