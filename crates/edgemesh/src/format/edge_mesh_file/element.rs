//! Converts between the elements of sections and bytes.
//!
//! On a little-endian machine a list is a view of its bytes. On a big-endian machine the
//! bytes of each number are reversed.

use std::borrow::Cow;

use bytemuck::Pod;

use super::materials::StoredMaterial;
use super::numbers::Placement;
use crate::edge_mesh::{
    Chain, ChainLink, EdgeRecord, EdgeVertex, EdgeVertex16, FacePlane, FillRun, FillVertex,
};

/// An element of a section: numbers of one size, perhaps followed by single bytes.
pub(super) trait Element: Pod {
    /// Bytes of a number.
    const NUMBER_BYTES: usize;
    /// The number of numbers; single bytes follow them.
    const NUMBERS: usize = size_of::<Self>() / Self::NUMBER_BYTES;
}

macro_rules! elements {
    ($($number_bytes:literal: $($element:ty),+;)+) => {
        $($(impl Element for $element { const NUMBER_BYTES: usize = $number_bytes; })+)+
    };
}

elements! {
    1: u8, [u8; 4];
    4: u32, [u32; 3], [f32; 3], FacePlane, EdgeRecord, Chain, ChainLink, FillVertex, FillRun,
        StoredMaterial, EdgeVertex;
    8: u64, f64, [u64; 2], Placement;
}

impl Element for EdgeVertex16 {
    const NUMBER_BYTES: usize = 2;
    // Four points and two normals.
    const NUMBERS: usize = 18;
}

/// The bytes of a list, little-endian.
pub(super) fn to_bytes<T: Element>(items: &[T]) -> Cow<'_, [u8]> {
    let bytes: &[u8] = bytemuck::cast_slice(items);
    if cfg!(target_endian = "little") {
        return Cow::Borrowed(bytes);
    }
    let mut bytes = bytes.to_vec();
    reverse_numbers::<T>(&mut bytes);
    Cow::Owned(bytes)
}

/// The list in some bytes of a file; `None` if their length is not a multiple of the
/// size of an element. Bytes that are not aligned are copied.
pub(super) fn from_bytes<T: Element>(bytes: &[u8]) -> Option<Cow<'_, [T]>> {
    if !bytes.len().is_multiple_of(size_of::<T>()) {
        return None;
    }
    if cfg!(target_endian = "little")
        && let Ok(items) = bytemuck::try_cast_slice(bytes)
    {
        return Some(Cow::Borrowed(items));
    }
    let mut items = vec![T::zeroed(); bytes.len() / size_of::<T>()];
    let copy: &mut [u8] = bytemuck::cast_slice_mut(&mut items);
    copy.copy_from_slice(bytes);
    if cfg!(target_endian = "big") {
        reverse_numbers::<T>(copy);
    }
    Some(Cow::Owned(items))
}

/// Reverses the bytes of each number.
fn reverse_numbers<T: Element>(bytes: &mut [u8]) {
    for element in bytes.chunks_exact_mut(size_of::<T>()) {
        for number in element.chunks_exact_mut(T::NUMBER_BYTES).take(T::NUMBERS) {
            number.reverse();
        }
    }
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_mesh::EdgeFlags;

    #[test]
    fn lists_are_little_endian_wherever_they_lie() {
        let bytes = [9, 1, 0, 0, 0, 2, 1, 0, 0];
        for start in [0, 1] {
            let list = from_bytes::<u32>(&bytes[start..start + 8]).unwrap();
            let expected = [[0x0000_0109, 0x0001_0200], [1, 0x0102]][start];
            assert_eq!(*list, expected);
            assert_eq!(*to_bytes(&list), bytes[start..start + 8]);
        }
        assert!(from_bytes::<u32>(&bytes).is_none(), "two and a quarter");
        assert_eq!(from_bytes::<[f32; 3]>(&[]).unwrap().len(), 0);
    }

    #[test]
    fn an_aligned_list_is_not_copied() {
        let list =
            [EdgeRecord { v0: 1, v1: 2, face_a: 3, face_b: 4, word: EdgeFlags::RIDGE.into() }; 2];
        let bytes = to_bytes(&list);
        let is_borrowed = |list: &Cow<[EdgeRecord]>| matches!(list, Cow::Borrowed(_));
        let same = from_bytes::<EdgeRecord>(&bytes).unwrap();
        assert_eq!(is_borrowed(&same), cfg!(target_endian = "little"));
        let mut moved = vec![0_u32; 11];
        let moved: &mut [u8] = bytemuck::cast_slice_mut(&mut moved);
        moved[1..41].copy_from_slice(&bytes);
        let copied = from_bytes::<EdgeRecord>(&moved[1..41]).unwrap();
        assert!(!is_borrowed(&copied));
        assert_eq!((&*same, &*copied), (&list[..], &list[..]));
    }

    #[test]
    fn numbers_are_reversed_and_single_bytes_stay() {
        let mut bytes: Vec<u8> = (0..80).collect();
        reverse_numbers::<EdgeVertex16>(&mut bytes);
        assert_eq!(bytes[..4], [1, 0, 3, 2]);
        assert_eq!(bytes[34..42], [35, 34, 36, 37, 38, 39, 41, 40]);
        reverse_numbers::<EdgeVertex16>(&mut bytes);
        reverse_numbers::<f64>(&mut bytes);
        assert_eq!(bytes[..9], [7, 6, 5, 4, 3, 2, 1, 0, 15]);
    }
}
