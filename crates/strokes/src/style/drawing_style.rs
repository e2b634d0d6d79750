//! How an object looks: its fill, and the strokes of each class of edge.
//!
//! Classes that look alike are one *layer*; a layer is one list of edges and one
//! draw. Each layer can have a second style for what is hidden (paper, section
//! 3.5), and the one with the contours a third for the silhouette, which is
//! drawn over the contours where they border on other things (section 3.4).
//!
//! ```text
//!   classes --ClassTable--> layers --+--> visible strokes
//!                                    +--> hidden strokes
//!                                    '--> silhouettes, past a stencil
//! ```

use edgemesh::edge_mesh::edge_word::threshold_steps;
use edgemesh::line::class::{ClassTable, LineClass};
use edgemesh::line::kind::LineKind;
use edgemesh::line::placement::{Parameterization, Placement};

use crate::style::brush::Brush;
use crate::style::link_style::MITRE_LIMIT;
pub use crate::style::link_style::PathStyle;

/// Layers that one object can have: one a class. WGSL twin: the constant of this
/// name.
pub const MAX_LAYERS: usize = LineClass::ALL.len();

/// Draws of strokes that one object can have: of each layer the visible and the
/// hidden strokes, and the silhouettes of both kinds. WGSL twin: the constant of
/// this name.
pub const MAX_DRAWS: usize = 2 * MAX_LAYERS + 2;

/// How wide a stroke is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Width {
    /// The same on the screen at any distance.
    Pixels(f32),
    /// In units of the scene: smaller farther away.
    World(f32),
}

/// How one kind of stroke looks.
#[derive(Debug, Clone, PartialEq)]
pub struct StrokeStyle {
    /// Premultiplied colour.
    pub color: [f32; 4],
    /// Its width.
    pub width: Width,
    /// Thin line, quad or fin, and what is at the ends.
    pub kind: LineKind,
    /// Where on the edge it lies.
    pub placement: Placement,
    /// How the brush lies along it.
    pub parameterization: Parameterization,
    /// The brush, or `None` for solid ink.
    pub brush: Option<Brush>,
    /// The distances from the eye, in units of the scene, where strokes begin to
    /// fade and where nothing is left of them.
    pub fade: Option<[f32; 2]>,
    /// How edges are linked into strokes; `None` draws each edge by itself, as the
    /// paper does. Where compute shaders detect; thin lines and fins are never linked.
    pub path: Option<PathStyle>,
}

impl Default for StrokeStyle {
    /// Black ink, two pixels wide.
    fn default() -> Self {
        Self {
            color: [0.0, 0.0, 0.0, 1.0],
            width: Width::Pixels(2.0),
            kind: LineKind::default(),
            placement: Placement::default(),
            parameterization: Parameterization::default(),
            brush: None,
            fade: None,
            path: None,
        }
    }
}

impl StrokeStyle {
    /// How far linked strokes lie from their lines at most, in pixels.
    pub(crate) fn reach_px(&self) -> Option<f32> {
        let Width::Pixels(width) = self.width else { return None };
        let path = self.path.as_ref()?;
        let widest = width * path.width_curve.into_iter().fold(0.0, f32::max);
        // Mitres and points go beyond the width.
        let beyond = path.overshoot_px + path.wobble_px + path.jitter_px;
        Some(MITRE_LIMIT * widest + beyond + 2.0)
    }

    /// Whether edges are linked into strokes.
    pub(crate) const fn is_linked(&self) -> bool {
        self.path.is_some() && !matches!(self.kind, LineKind::Thin | LineKind::Fin)
    }
}

/// The classes that look alike, and how.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// The classes.
    pub classes: Vec<LineClass>,
    /// What is visible; `None` leaves it out.
    pub visible: Option<StrokeStyle>,
    /// What is hidden; `None` leaves it out.
    pub hidden: Option<StrokeStyle>,
}

/// How an object looks.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct Look {
    /// Premultiplied colour of the surface; `None` fills only the depth, so that
    /// what lies behind shows through and lines are still hidden.
    pub fill_color: Option<[f32; 4]>,
    /// The layers, the first drawn last, over all others. A class in none of them
    /// is not drawn.
    pub layers: Vec<Layer>,
    /// Strokes over those contours that are between the object and anything
    /// else; needs a contour layer.
    pub silhouette: Option<StrokeStyle>,
    /// From which angles between the face normals, in radians, edges are ridges
    /// and valleys; `None` for the creases as the mesh was built with.
    pub thresholds: Option<[f64; 2]>,
}

/// Which strokes of a layer a draw draws.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Visibility {
    /// What nothing hides.
    Visible = 0,
    /// What something hides.
    Hidden = 1,
    /// Visible, and not over the object itself.
    Silhouette = 2,
}

/// One draw of strokes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StyledDraw {
    pub(crate) layer: u32,
    pub(crate) visibility: Visibility,
    pub(crate) style: StrokeStyle,
    pub(crate) has_contours: bool,
}

impl StyledDraw {
    /// Whether it draws contours over the surface that they bound, which would
    /// swallow them: their fragments ask at the edge whether they are visible.
    pub(crate) const fn lies_over_surface(&self) -> bool {
        let is_wide = !matches!(self.style.kind, LineKind::Thin | LineKind::Fin);
        let reaches_inside = matches!(self.style.placement, Placement::Centred | Placement::Inside);
        self.has_contours && is_wide && reaches_inside
    }
}

impl Look {
    /// Whether any strokes are linked, where compute shaders detect.
    pub(crate) fn is_linked(&self) -> bool {
        let of_layers = self.layers.iter().flat_map(|layer| [&layer.visible, &layer.hidden]);
        of_layers.chain([&self.silhouette]).flatten().any(StrokeStyle::is_linked)
    }

    /// The layer of each class, and the thresholds.
    #[must_use]
    pub fn class_table(&self) -> ClassTable {
        let mut table = ClassTable::new(|class| {
            let layer = self.layers.iter().position(|layer| layer.classes.contains(&class));
            layer.map(edgemesh::index::to_u32)
        });
        if let Some([ridge, valley]) = self.thresholds {
            table.ridge_steps = threshold_steps(ridge);
            table.valley_steps = threshold_steps(valley);
        }
        // Chains would break where their own solid hides a part of them.
        let needs_hidden =
            self.layers.iter().any(|layer| layer.hidden.is_some()) || self.is_linked();
        table.keeps_hidden = u32::from(needs_hidden);
        table
    }

    /// The draws of strokes in order: what is hidden, then what is visible, each
    /// from the last layer to the first, then the silhouette.
    pub(crate) fn draws(&self) -> Vec<StyledDraw> {
        let has_contours = |layer: &Layer| layer.classes.contains(&LineClass::Contour);
        let of_layers = |visibility, style: fn(&Layer) -> Option<&StrokeStyle>| {
            self.layers.iter().enumerate().rev().filter_map(move |(layer, of_layer)| {
                let layer = edgemesh::index::to_u32(layer);
                let has_contours = has_contours(of_layer);
                let style = style(of_layer).cloned();
                style.map(|style| StyledDraw { layer, visibility, style, has_contours })
            })
        };
        let hidden = of_layers(Visibility::Hidden, |layer| layer.hidden.as_ref());
        let visible = of_layers(Visibility::Visible, |layer| layer.visible.as_ref());
        let silhouette = self.silhouette.iter().filter_map(|style| {
            let layer = edgemesh::index::to_u32(self.layers.iter().position(has_contours)?);
            let visibility = Visibility::Silhouette;
            Some(StyledDraw { layer, visibility, style: style.clone(), has_contours: true })
        });
        hidden.chain(visible).chain(silhouette).collect()
    }
}
