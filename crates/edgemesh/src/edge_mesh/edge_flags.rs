//! What is known of an edge before there is a view: its classes, the words for them, and the
//! order in which they chain.

use bytemuck::{Pod, Zeroable};

bitflags::bitflags! {
    /// What is known of an edge before there is a view.
    ///
    /// The paper's record cannot tell a marked edge from a boundary, since both
    /// set `v3 = v0`; these bits can. Several may hold at once. WGSL twin: the
    /// constants of `shaders/common/feature.wgsl`.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default, Pod, Zeroable)]
    #[repr(transparent)]
    pub struct EdgeFlags: u32 {
        /// Exactly one face.
        const BOUNDARY = 1 << 0;
        /// Convex, and the face normals differ by more than the ridge threshold.
        const RIDGE = 1 << 1;
        /// Concave, and the face normals differ by more than the valley threshold.
        const VALLEY = 1 << 2;
        /// Chosen by the artist.
        const MARKED = 1 << 3;
        /// The two faces differ in material.
        const MATERIAL = 1 << 4;
        /// One pair of faces of an edge that more than two share.
        const NON_MANIFOLD = 1 << 5;
        /// The diagonal of a polygon: it can be a contour and nothing else.
        const DIAGONAL = 1 << 6;
        /// Both faces traverse the edge in the same direction, on a surface
        /// that cannot be oriented; the facing of face B counts reversed.
        const CLASH = 1 << 7;
        /// On a closed component whose faces look outwards: where both faces
        /// look away from an eye outside of it, the component hides the edge.
        /// (A surface that passes through itself can enclose a part inside out;
        /// edges there count as hidden as well.)
        const SOLID = 1 << 8;
        /// The two faces are of different smoothing groups.
        const SMOOTHING = 1 << 9;
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

/// The classes by the words that files and messages have for them.
const CLASS_NAMES: [(EdgeFlags, &str); 10] = [
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
];

/// The words for all that `flags` have, in the order of their bits.
pub fn class_names(flags: EdgeFlags) -> impl Iterator<Item = &'static str> {
    let is_set = move |(flag, _): &&(EdgeFlags, &str)| flags.contains(*flag);
    CLASS_NAMES.iter().filter(is_set).map(|(_, name)| *name)
}

/// The classes by which edges are chained, the strongest first.
pub const CHAIN_CLASSES: [EdgeFlags; 7] = [
    EdgeFlags::MARKED,
    EdgeFlags::BOUNDARY,
    EdgeFlags::NON_MANIFOLD,
    EdgeFlags::MATERIAL,
    EdgeFlags::SMOOTHING,
    EdgeFlags::RIDGE,
    EdgeFlags::VALLEY,
];

/// The number of the first class in [`CHAIN_CLASSES`] that `flags` have.
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
    }
}
