//! The classes of an edge that no view changes, their names, and their order in chains.

use bytemuck::{Pod, Zeroable};

bitflags::bitflags! {
    /// The classes of an edge that no view changes; an edge can have several.
    ///
    /// The paper's record sets `v3 = v0` for marked and boundary edges and cannot tell them apart;
    /// these bits can. WGSL twin: the constants of `shaders/common/feature.wgsl`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
    #[repr(transparent)]
    pub struct EdgeFlags: u32 {
        /// The edge has exactly one face.
        const BOUNDARY = 1 << 0;
        /// Convex: the face normals differ by more than the ridge threshold.
        const RIDGE = 1 << 1;
        /// Concave: the face normals differ by more than the valley threshold.
        const VALLEY = 1 << 2;
        /// Marked by the artist.
        const MARKED = 1 << 3;
        /// The two faces have different materials.
        const MATERIAL = 1 << 4;
        /// One pair of the faces of an edge with more than two, or a face without a partner there,
        /// that is a feature.
        const NON_MANIFOLD = 1 << 5;
        /// The diagonal of a polygon, which can only be a contour.
        const DIAGONAL = 1 << 6;
        /// Both faces traverse the edge in the same direction, on a surface that cannot be
        /// oriented; the facing of face B is reversed.
        const CLASH = 1 << 7;
        /// On a closed component whose faces look outward: it hides the edge if both faces look
        /// away from an eye outside of it. (A surface that intersects itself can enclose a part
        /// inside out; edges there count as hidden, too.)
        const SOLID = 1 << 8;
        /// The two faces have different smoothing groups.
        const SMOOTHING = 1 << 9;
        /// In a groove of a component that has an outside: one of the two triangles hides the edge
        /// where it is a contour, seen from outside.
        const GROOVE = 1 << 10;
        /// One pair of the faces of an edge with more than two, where the surface goes on: no feature
        /// by itself, but it can be a contour.
        const PAIRED = 1 << 11;
    }
}

impl EdgeFlags {
    /// The classes that are drawn in every view.
    pub const ALWAYS_DRAWN: Self = Self::BOUNDARY
        .union(Self::RIDGE)
        .union(Self::VALLEY)
        .union(Self::MARKED)
        .union(Self::MATERIAL)
        .union(Self::NON_MANIFOLD)
        .union(Self::SMOOTHING);
}

/// The names of the classes in files and messages.
const CLASS_NAMES: [(EdgeFlags, &str); 12] = [
    (EdgeFlags::BOUNDARY, "boundary"),
    (EdgeFlags::RIDGE, "ridge"),
    (EdgeFlags::VALLEY, "valley"),
    (EdgeFlags::MARKED, "marked"),
    (EdgeFlags::MATERIAL, "material"),
    (EdgeFlags::NON_MANIFOLD, "non_manifold"),
    (EdgeFlags::DIAGONAL, "diagonal"),
    (EdgeFlags::CLASH, "clash"),
    (EdgeFlags::SOLID, "solid"),
    (EdgeFlags::SMOOTHING, "smoothing"),
    (EdgeFlags::GROOVE, "groove"),
    (EdgeFlags::PAIRED, "paired"),
];

/// The names of the classes in `flags`, in the order of their bits.
pub fn class_names(flags: EdgeFlags) -> impl Iterator<Item = &'static str> {
    let is_set = move |(flag, _): &&(EdgeFlags, &str)| flags.contains(*flag);
    CLASS_NAMES.iter().filter(is_set).map(|(_, name)| *name)
}

/// The class with this name.
pub(crate) fn class_of_name(name: &str) -> Option<EdgeFlags> {
    CLASS_NAMES.iter().find(|(_, other)| *other == name).map(|(flag, _)| *flag)
}

/// The classes that are chained, the strongest first.
pub const CHAIN_CLASSES: [EdgeFlags; 7] = [
    EdgeFlags::MARKED,
    EdgeFlags::BOUNDARY,
    EdgeFlags::NON_MANIFOLD,
    EdgeFlags::MATERIAL,
    EdgeFlags::SMOOTHING,
    EdgeFlags::RIDGE,
    EdgeFlags::VALLEY,
];

/// The index of the first class of `flags` in [`CHAIN_CLASSES`].
#[must_use]
pub fn chain_class_of(flags: EdgeFlags) -> Option<usize> {
    CHAIN_CLASSES.iter().position(|class| flags.intersects(*class))
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn every_class_has_its_name() {
        let words: Vec<&str> = class_names(EdgeFlags::all()).collect();
        let names = EdgeFlags::all().iter_names();
        assert!(names.map(|(name, _)| name.to_lowercase()).eq(words), "in order");
        let some = EdgeFlags::SMOOTHING | EdgeFlags::RIDGE;
        assert!(class_names(some).eq(["ridge", "smoothing"]));
        assert_eq!(class_names(EdgeFlags::empty()).count(), 0);
        for flag in EdgeFlags::all() {
            assert_eq!(class_names(flag).next().and_then(class_of_name), Some(flag));
        }
        assert_eq!(class_of_name("Ridge"), None);
    }
}
