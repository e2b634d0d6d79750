//! The binary data of a file, with its views and accessors.

use serde_json::{Value, json};

use crate::edge_mesh::Bounds;

const UNSIGNED_BYTE: u32 = 5121;
const UNSIGNED_SHORT: u32 = 5123;
const UNSIGNED_INT: u32 = 5125;
const FLOAT: u32 = 5126;

/// The GPU bindings of a view.
const ARRAY_BUFFER: Option<u32> = Some(34962);
const ELEMENT_ARRAY_BUFFER: Option<u32> = Some(34963);

/// The binary data, with its views and accessors.
#[derive(Default)]
pub(super) struct BinaryData {
    pub(super) bytes: Vec<u8>,
    pub(super) views: Vec<Value>,
    pub(super) accessors: Vec<Value>,
}

/// The type of the elements of an accessor.
#[derive(Clone, Copy)]
pub(super) struct ElementType {
    component: u32,
    shape: &'static str,
    target: Option<u32>,
}

impl ElementType {
    pub(super) const BYTES: Self = Self::new(UNSIGNED_BYTE, "SCALAR", None);
    pub(super) const VECTORS: Self = Self::new(FLOAT, "VEC3", None);
    pub(super) const MATRICES: Self = Self::new(FLOAT, "MAT4", None);
    pub(super) const JOINTS: Self = Self::new(UNSIGNED_SHORT, "VEC4", ARRAY_BUFFER);
    pub(super) const WEIGHTS: Self = Self::new(FLOAT, "VEC4", ARRAY_BUFFER);
    pub(super) const VERTICES: Self = Self::new(FLOAT, "VEC3", ARRAY_BUFFER);
    pub(super) const TEXCOORDS: Self = Self::new(FLOAT, "VEC2", ARRAY_BUFFER);

    pub(super) const COLORS: Self = Self::new(UNSIGNED_SHORT, "VEC4", ARRAY_BUFFER);

    const fn new(component: u32, shape: &'static str, target: Option<u32>) -> Self {
        Self { component, shape, target }
    }

    const fn indices(component: u32, are_drawn: bool) -> Self {
        Self::new(component, "SCALAR", if are_drawn { ELEMENT_ARRAY_BUFFER } else { None })
    }
}

impl BinaryData {
    /// Adds bytes with a view; returns the index of the view.
    pub(super) fn push_view(&mut self, bytes: impl IntoIterator<Item = u8>) -> usize {
        let start = self.bytes.len();
        self.bytes.extend(bytes);
        let length = self.bytes.len() - start;
        self.bytes.resize(self.bytes.len().next_multiple_of(4), 0);
        self.views.push(json!({"buffer": 0, "byteOffset": start, "byteLength": length}));
        self.views.len() - 1
    }

    /// Adds elements with a view and an accessor; returns the index of the accessor.
    pub(super) fn push<const N: usize>(
        &mut self,
        kind: ElementType,
        elements: impl Iterator<Item = [u8; N]>,
    ) -> usize {
        let mut count = 0;
        let view = self.push_view(elements.inspect(|_| count += 1).flatten());
        if let Some(target) = kind.target {
            self.views[view]["target"] = target.into();
        }
        self.accessors.push(json!({
            "bufferView": view,
            "componentType": kind.component,
            "count": count,
            "type": kind.shape
        }));
        self.accessors.len() - 1
    }

    /// Adds positions, which must have bounds.
    pub(super) fn push_positions(&mut self, positions: &[[f32; 3]]) -> usize {
        let accessor = self.push(ElementType::VERTICES, positions.iter().map(|&p| float_bytes(p)));
        let Bounds { min, max } = Bounds::of(positions);
        self.accessors[accessor]["min"] = json!(min);
        self.accessors[accessor]["max"] = json!(max);
        accessor
    }

    /// Adds indices of vertices, in 16 bits if these are enough. The largest number of
    /// either size is not a vertex: it separates line strings.
    pub(super) fn push_indices(
        &mut self,
        vertices: usize,
        are_drawn: bool,
        indices: &[u32],
    ) -> usize {
        if vertices <= usize::from(u16::MAX) {
            let short = |&index: &u32| u16::try_from(index).unwrap_or(u16::MAX).to_le_bytes();
            self.push(ElementType::indices(UNSIGNED_SHORT, are_drawn), indices.iter().map(short))
        } else {
            let long = indices.iter().map(|index| index.to_le_bytes());
            self.push(ElementType::indices(UNSIGNED_INT, are_drawn), long)
        }
    }
}

/// The bytes of a vector.
pub(super) fn float_bytes([x, y, z]: [f32; 3]) -> [u8; 12] {
    let [[a, b, c, d], [e, f, g, h], [i, j, k, l]] = [x, y, z].map(f32::to_le_bytes);
    [a, b, c, d, e, f, g, h, i, j, k, l]
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn indices_have_32_bits_if_16_would_reach_the_restart_value() {
        let push = |vertices| {
            let mut data = BinaryData::default();
            data.push_indices(vertices, false, &[1, u32::MAX, 2]);
            (data.accessors[0]["componentType"].clone(), data.bytes)
        };
        assert_eq!(push(65_535), (5123.into(), vec![1, 0, 255, 255, 2, 0, 0, 0]));
        assert_eq!(push(65_536), (5125.into(), vec![1, 0, 0, 0, 255, 255, 255, 255, 2, 0, 0, 0]));
    }
}
