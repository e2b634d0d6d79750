//! Little-endian numbers in the bytes of a file.

/// The 32-bit number at `offset`; `None` if the bytes end before its last byte.
pub(super) fn u32_at(bytes: &[u8], offset: usize) -> Option<u32> {
    bytes.get(offset..)?.first_chunk().copied().map(u32::from_le_bytes)
}

/// The 64-bit number at `offset`; `None` if the bytes end before its last byte.
pub(super) fn u64_at(bytes: &[u8], offset: usize) -> Option<u64> {
    bytes.get(offset..)?.first_chunk().copied().map(u64::from_le_bytes)
}
