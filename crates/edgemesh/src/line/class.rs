//! Line classes, in one table.
//!
//! The number of a class is its index in [`LineClass::ALL`], the strongest first: an edge of
//! several classes is drawn as the strongest that is drawn at all. Counts, layers and bit masks
//! are indexed by this number, in Rust and in WGSL. So a class is added in two places: as a variant
//! with a row of the table below, and as a constant of the WGSL twin.
//!
//! WGSL twin: `shaders/common/line_class.wgsl`.

use bytemuck::{Pod, Zeroable};

use crate::edge_mesh::EdgeFlags;

/// A class of lines.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, PartialOrd, Ord)]
#[repr(u32)]
#[non_exhaustive]
pub enum LineClass {
    /// Between a face toward the eye and one away from it.
    Contour,
    /// Marked by the artist.
    Marked,
    /// On one face, or on more than two.
    Boundary,
    /// Between two materials.
    Material,
    /// Between two smoothing groups.
    Smoothing,
    /// A convex crease.
    Ridge,
    /// A concave crease.
    Valley,
}

/// A row of the table.
struct ClassRow {
    class: LineClass,
    /// The name in techniques, JSON and statistics.
    name: &'static str,
    /// Edges with any of these flags are of the class in every view.
    drawn_by: EdgeFlags,
    /// Edges with this flag count as the class.
    counted_by: EdgeFlags,
}

const fn row(class: LineClass, name: &'static str, flag: EdgeFlags) -> ClassRow {
    ClassRow { class, name, drawn_by: flag, counted_by: flag }
}

/// The table, the strongest class first.
const CLASSES: [ClassRow; LineClass::COUNT] = [
    row(LineClass::Contour, "contour", EdgeFlags::empty()),
    row(LineClass::Marked, "marked", EdgeFlags::MARKED),
    ClassRow {
        drawn_by: EdgeFlags::BOUNDARY.union(EdgeFlags::NON_MANIFOLD),
        ..row(LineClass::Boundary, "boundary", EdgeFlags::BOUNDARY)
    },
    row(LineClass::Material, "material", EdgeFlags::MATERIAL),
    row(LineClass::Smoothing, "smoothing", EdgeFlags::SMOOTHING),
    row(LineClass::Ridge, "ridge", EdgeFlags::RIDGE),
    row(LineClass::Valley, "valley", EdgeFlags::VALLEY),
];

impl LineClass {
    /// The number of classes. WGSL twin: `LINE_CLASS_COUNT`.
    pub const COUNT: usize = 7;

    /// All classes, the strongest first.
    pub const ALL: [Self; Self::COUNT] = {
        let mut all = [Self::Contour; Self::COUNT];
        let mut at = 0;
        while at < Self::COUNT {
            all[at] = CLASSES[at].class;
            assert!(all[at] as usize == at, "rows are in the order of the variants");
            at += 1;
        }
        all
    };

    const fn row(self) -> &'static ClassRow {
        &CLASSES[self as usize]
    }

    /// The name in techniques, JSON and statistics, such as `contour`.
    #[must_use]
    pub const fn name(self) -> &'static str {
        self.row().name
    }

    /// Edges with any of these flags are of the class in every view; empty for classes that
    /// depend on the view.
    #[must_use]
    pub const fn drawn_by(self) -> EdgeFlags {
        self.row().drawn_by
    }

    /// Edges with this flag count as the class; empty for classes that depend on the view.
    #[must_use]
    pub(crate) const fn counted_by(self) -> EdgeFlags {
        self.row().counted_by
    }

    /// The bit of the class in masks.
    #[must_use]
    pub const fn bit(self) -> u32 {
        1 << self as u32
    }
}

/// The capacity of a [`ClassTable`]. WGSL twin: the constant of this name.
pub const MAX_LINE_CLASSES: usize = 32;

/// The layer of a class that is not drawn. WGSL twin: the constant of this name.
pub const NO_LAYER: u32 = 255;

/// The layer of each class, and the angles from which edges are creases.
/// WGSL twin: `shaders/common/line_class.wgsl`.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Pod, Zeroable)]
#[repr(C)]
pub struct ClassTable {
    /// The layer of each class in 8 bits, or [`NO_LAYER`]; class 0 is in the lowest bits of the
    /// first word.
    pub layers: [u32; MAX_LINE_CLASSES / 4],
    /// The bits of the classes that are drawn.
    pub drawn: u32,
    /// The least crease angle of a ridge, in steps; 0 for the ridges of the mesh.
    pub ridge_steps: u32,
    /// The least crease angle of a valley, in steps; 0 for the valleys of the mesh.
    pub valley_steps: u32,
    /// 1 to keep edges hidden by their own solid, for drawing hidden lines; otherwise 0.
    pub keeps_hidden: u32,
}

impl ClassTable {
    /// The table with each class in the layer that `layer_of` returns, from 0 to 254. Classes
    /// without such a layer are not drawn.
    #[must_use]
    pub fn new(layer_of: impl Fn(LineClass) -> Option<u32>) -> Self {
        let mut table = Self { layers: [u32::MAX; MAX_LINE_CLASSES / 4], ..Self::zeroed() };
        for class in LineClass::ALL {
            let Some(layer) = layer_of(class).filter(|&layer| layer < NO_LAYER) else { continue };
            let (word, shift) = (class as usize / 4, 8 * (class as u32 % 4));
            table.layers[word] &= !(0xff << shift) | layer << shift;
            table.drawn |= class.bit();
        }
        table
    }

    /// All classes in layer 0, with the creases of the mesh.
    #[must_use]
    pub fn all_in_one() -> Self {
        Self::new(|_| Some(0))
    }

    /// The layer of the class with a number, or [`NO_LAYER`].
    ///
    /// # Panics
    /// Panics if `class_index` is [`MAX_LINE_CLASSES`] or more.
    #[must_use]
    pub const fn layer(&self, class_index: u32) -> u32 {
        self.layers[class_index as usize / 4] >> (8 * (class_index % 4)) & 0xff
    }
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn a_table_gives_back_the_layers_that_it_was_made_from() {
        let layer_of = |class: LineClass| match class {
            LineClass::Marked => None,
            _ => Some(3 * class as u32 + 1),
        };
        let table = ClassTable::new(layer_of);
        for class in LineClass::ALL {
            assert_eq!(table.layer(class as u32), layer_of(class).unwrap_or(NO_LAYER));
            assert_eq!(table.drawn & class.bit() != 0, layer_of(class).is_some());
        }
        for unused in LineClass::COUNT..MAX_LINE_CLASSES {
            assert_eq!(table.layer(u32::try_from(unused).unwrap()), NO_LAYER);
        }
    }
}
