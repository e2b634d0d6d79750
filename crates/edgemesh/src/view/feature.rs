//! Which edges are features of a view (paper, section 3.2, Equation 1).
//!
//! The indexed layout decides from facing bits and static flags ([`classify_edge`]), the replicated
//! layout of the paper from the edge vertex alone ([`equation_1`](crate::oracle::equation_1)); a
//! property test compares the two. A [`ClassTable`] decides which class of an edge counts, and its
//! layer.
//!
//! WGSL twin of [`classify_edge`]: `shaders/common/feature.wgsl`.

use glam::{Vec3, Vec4};

use crate::edge_mesh::{EdgeFlags, EdgeWord};
use crate::line::{ClassTable, LineClass, NO_LAYER};

bitflags::bitflags! {
    /// The state of an edge in a view. The first three bits are those of the live list of the
    /// GPU, above the index of the edge.
    #[derive(Debug, Clone, Copy, PartialEq, Eq, Default)]
    pub struct LineBits: u32 {
        /// Exactly one of the two faces looks at the eye.
        const CONTOUR = 1 << 31;
        /// Face A looks at the eye. For a contour this tells the outside: a front face lies left
        /// of its direction of traversal.
        const A_FACES = 1 << 30;
        /// The solid of the edge hides it from an eye outside.
        const BEHIND_SOLID = 1 << 29;
        /// The edge is drawn: a contour, or of a class that is always drawn.
        const DRAWN = 1 << 28;
    }
}

/// The facing of the faces of an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct EdgeFaces {
    /// Whether there is a second face; otherwise `b_faces` is unused.
    pub has_b: bool,
    /// Whether face A looks at the eye.
    pub a_faces: bool,
    /// Whether face B looks at the eye.
    pub b_faces: bool,
}

/// An edge in a view.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub struct Line {
    /// Contour, facing, and whether it is drawn.
    pub bits: LineBits,
    /// The layer that draws the edge, or [`NO_LAYER`].
    pub layer: u32,
}

/// The bits of the classes of an edge that no view changes.
#[must_use]
pub(crate) fn static_classes(word: EdgeWord, table: &ClassTable) -> u32 {
    let flags = word.flags();
    let is_crease = |steps: u32, is_concave: bool| {
        word.is_concave() == is_concave && word.crease_steps() >= steps
    };
    let is_of = |class: LineClass| match class {
        LineClass::Ridge if table.ridge_steps > 0 => is_crease(table.ridge_steps, false),
        LineClass::Valley if table.valley_steps > 0 => is_crease(table.valley_steps, true),
        _ => flags.intersects(class.drawn_by()),
    };
    let bits = LineClass::ALL.into_iter().filter(|&class| is_of(class)).map(LineClass::bit);
    bits.fold(0, |classes, bit| classes | bit)
}

/// Classifies an edge in a view.
///
/// Pairs of a non-manifold edge are drawn in every view and are never contours.
///
/// A solid hides its edges whose faces both look away from an eye outside of it; they are not
/// drawn unless the table keeps them. It also hides contours in its grooves: a line of sight beside
/// such a contour would meet the back face first, and so be inside of the solid already. With the
/// depth test alone these edges would show at their ends, where their width reaches past the faces
/// in front. On rough meshes they are half of all contours.
#[must_use]
pub fn classify_edge(
    word: EdgeWord,
    faces: EdgeFaces,
    table: &ClassTable,
    eye_is_outside: bool,
) -> Line {
    let flags = word.flags();
    let b_faces = faces.b_faces != flags.contains(EdgeFlags::CLASH);
    let is_manifold = faces.has_b && !flags.contains(EdgeFlags::NON_MANIFOLD);
    // A contour has exactly one face that looks at the eye.
    let is_contour = is_manifold && faces.a_faces != b_faces;
    let classes = (static_classes(word, table) | u32::from(is_contour)) & table.drawn;
    let is_turned_away = !faces.a_faces && !b_faces;
    let is_behind_solid = eye_is_outside
        && flags.contains(EdgeFlags::SOLID)
        && (is_turned_away || is_contour && flags.contains(EdgeFlags::GROOVE));
    let is_drawn = classes != 0 && (!is_behind_solid || table.keeps_hidden != 0);
    let mut bits = LineBits::empty();
    bits.set(LineBits::CONTOUR, is_contour);
    bits.set(LineBits::A_FACES, faces.a_faces);
    bits.set(LineBits::BEHIND_SOLID, is_behind_solid);
    bits.set(LineBits::DRAWN, is_drawn);
    let class = classes.trailing_zeros();
    let layer = if is_drawn { table.layer(class) } else { NO_LAYER };
    Line { bits, layer }
}

/// Whether the eye lies outside of the box from `min` to `max`, and so outside of every solid in
/// it. A viewer at infinity (w = 0) always does.
#[must_use]
pub fn eye_is_outside(eye: Vec4, min: Vec3, max: Vec3) -> bool {
    let eye_point = eye.truncate();
    eye.w == 0.0 || eye_point.cmplt(min).any() || eye_point.cmpgt(max).any()
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::edge_mesh::threshold_steps;

    fn classify(flags: EdgeFlags, a_faces: bool, b_faces: bool, outside: bool) -> LineBits {
        let faces = EdgeFaces { has_b: true, a_faces, b_faces };
        classify_edge(flags.into(), faces, &ClassTable::all_in_one(), outside).bits
    }

    #[test]
    fn a_contour_has_one_face_of_each_kind() {
        let is_contour = |flags, a, b| classify(flags, a, b, true).contains(LineBits::CONTOUR);
        for (a, b) in [(false, false), (true, true)] {
            assert!(!is_contour(EdgeFlags::empty(), a, b));
            assert!(is_contour(EdgeFlags::CLASH, a, b), "a clash turns face B around");
        }
        for (a, b) in [(false, true), (true, false)] {
            assert!(is_contour(EdgeFlags::empty(), a, b));
            assert!(is_contour(EdgeFlags::DIAGONAL, a, b), "a diagonal can be a contour");
            assert!(!is_contour(EdgeFlags::NON_MANIFOLD, a, b));
        }
    }

    #[test]
    fn what_is_drawn_without_a_contour() {
        let is_drawn = |flags| classify(flags, true, true, true).contains(LineBits::DRAWN);
        assert!(!is_drawn(EdgeFlags::empty()));
        assert!(!is_drawn(EdgeFlags::DIAGONAL));
        for flags in EdgeFlags::ALWAYS_DRAWN.iter() {
            assert!(is_drawn(flags), "{flags:?}");
        }
    }

    #[test]
    fn a_solid_hides_its_own_back_from_an_eye_outside() {
        let ridge = EdgeFlags::RIDGE | EdgeFlags::SOLID;
        let is_drawn =
            |flags, a, b, outside| classify(flags, a, b, outside).contains(LineBits::DRAWN);
        assert!(!is_drawn(ridge, false, false, true));
        assert!(is_drawn(ridge, false, false, false), "from inside it is seen");
        assert!(is_drawn(EdgeFlags::RIDGE, false, false, true), "an open surface hides nothing");
        for (a, b) in [(true, true), (true, false), (false, true)] {
            assert!(is_drawn(ridge, a, b, true));
        }
        // A contour in a groove is behind what rises before it.
        let groove = EdgeFlags::GROOVE | EdgeFlags::SOLID;
        assert!(!is_drawn(groove, true, false, true));
        assert!(is_drawn(groove, true, false, false), "from inside");
        assert!(is_drawn(EdgeFlags::GROOVE, true, false, true), "not of a solid");
        assert!(is_drawn(EdgeFlags::SOLID, true, false, true), "on a ridge");
        let keeping = ClassTable { keeps_hidden: 1, ..ClassTable::all_in_one() };
        let faces = EdgeFaces { has_b: true, a_faces: false, b_faces: false };
        let kept = classify_edge(ridge.into(), faces, &keeping, true).bits;
        assert_eq!(kept, LineBits::BEHIND_SOLID | LineBits::DRAWN);
        let outside = |eye: [f32; 4]| eye_is_outside(eye.into(), Vec3::ZERO, Vec3::ONE);
        assert!(outside([0.5, 0.5, 1.1, 1.0]) && !outside([0.5, 0.5, 1.0, 1.0]));
        assert!(outside([0.5, 0.5, 0.5, 0.0]), "a direction");
    }

    #[test]
    fn an_edge_of_several_classes_is_of_the_strongest_that_is_drawn() {
        let faces = EdgeFaces { has_b: true, a_faces: true, b_faces: false };
        let word = EdgeWord::from(EdgeFlags::MARKED | EdgeFlags::RIDGE);
        let layer = |undrawn: &[LineClass]| {
            let table =
                ClassTable::new(|class| (!undrawn.contains(&class)).then_some(2 * class as u32));
            classify_edge(word, faces, &table, true).layer
        };
        assert_eq!(layer(&[]), 0);
        assert_eq!(layer(&[LineClass::Contour]), 2);
        assert_eq!(layer(&[LineClass::Contour, LineClass::Marked]), 10);
        assert_eq!(layer(&[LineClass::Contour, LineClass::Marked, LineClass::Ridge]), NO_LAYER);
    }

    #[test]
    fn thresholds_can_change_and_are_not_met_by_their_own_angle() {
        let word = |degrees: f64, is_concave| {
            EdgeWord::new(EdgeFlags::RIDGE, degrees.to_radians(), is_concave)
        };
        let [ridge_steps, valley_steps] =
            [30.0_f64, 10.0].map(|degrees| threshold_steps(degrees.to_radians()));
        let table = ClassTable { ridge_steps, valley_steps, ..ClassTable::all_in_one() };
        let has = |word, class: LineClass| static_classes(word, &table) >> class as u32 & 1 == 1;
        assert!(has(word(30.01, false), LineClass::Ridge));
        assert!(!has(word(30.0, false), LineClass::Ridge), "whatever it was built as");
        assert!(has(word(10.01, true), LineClass::Valley));
        assert!(!has(word(40.0, true), LineClass::Ridge));
        let built = ClassTable::all_in_one();
        assert!(static_classes(word(1.0, false), &built) != 0, "as built");
    }
}
