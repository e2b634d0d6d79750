//! The types of the components of accessors.

/// The type of a component: the six that glTF defines, and signed 32-bit integers, which some
/// programs write as indices.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(super) enum Component {
    I8,
    U8,
    I16,
    U16,
    I32,
    U32,
    F32,
}

impl Component {
    /// The type with this number in the JSON.
    pub(super) const fn of_number(number: u32) -> Option<Self> {
        Some(match number {
            5120 => Self::I8,
            5121 => Self::U8,
            5122 => Self::I16,
            5123 => Self::U16,
            5124 => Self::I32,
            5125 => Self::U32,
            5126 => Self::F32,
            _ => return None,
        })
    }

    /// Its size in bytes.
    pub(super) const fn size(self) -> usize {
        match self {
            Self::I8 | Self::U8 => 1,
            Self::I16 | Self::U16 => 2,
            Self::I32 | Self::U32 | Self::F32 => 4,
        }
    }

    /// Whether it is an integer that can be negative.
    pub(super) const fn is_signed_integer(self) -> bool {
        matches!(self, Self::I8 | Self::I16 | Self::I32)
    }
}
