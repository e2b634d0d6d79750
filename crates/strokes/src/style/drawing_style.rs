//! Drawing styles: the strokes of each line class, and the fill under them.
//!
//! Classes that are drawn alike are one *layer*: one list of edges. The strokes of a layer
//! with one visibility are a *stroke set*: what is visible, what is hidden (paper, section
//! 3.5), and for the layer with the contours the silhouette, which is drawn over the contours
//! where they border on other things (section 3.4).
//!
//! ```text
//!   classes --ClassTable--> layers --+--> visible strokes
//!                                    +--> hidden strokes
//!                                    '--> silhouettes, past a stencil
//! ```

use edgemesh::edge_mesh::threshold_steps;
use edgemesh::line::{ClassTable, LineClass, LineKind, Parameterization, Placement};

use crate::style::brush::Brush;
use crate::style::link_style::{LinkStyle, MITRE_LIMIT};

/// Layers that one object can have: one per class. WGSL twin: the constant of this name.
pub const MAX_LAYERS: usize = LineClass::COUNT;

/// Stroke sets that one object can have: the visible and the hidden strokes of each layer, and
/// the silhouettes of both kinds. WGSL twin: the constant of this name.
pub const MAX_STROKE_SETS: usize = 2 * MAX_LAYERS + 2;

/// How wide a stroke is.
#[derive(Debug, Clone, Copy, PartialEq)]
pub enum Width {
    /// The same on the screen at any distance.
    Pixels(f32),
    /// In units of the scene: smaller farther away.
    World(f32),
}

/// How the strokes of a set are drawn.
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
    pub link: Option<LinkStyle>,
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
            link: None,
        }
    }
}

impl StrokeStyle {
    /// How far linked strokes lie from their lines at most, in pixels.
    pub(crate) fn reach_px(&self) -> Option<f32> {
        let Width::Pixels(width) = self.width else { return None };
        let link = self.link.as_ref()?;
        let widest = width * link.width_curve.into_iter().fold(0.0, f32::max);
        // Mitres and points go beyond the width.
        let beyond = link.overshoot_px + link.wobble_px + link.jitter_px;
        Some(MITRE_LIMIT * widest + beyond + 2.0)
    }

    /// Whether edges are linked into strokes.
    pub(crate) const fn is_linked(&self) -> bool {
        self.link.is_some() && !matches!(self.kind, LineKind::Thin | LineKind::Fin)
    }
}

/// Line classes that are drawn alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// The classes.
    pub classes: Vec<LineClass>,
    /// What is visible; `None` leaves it out.
    pub visible: Option<StrokeStyle>,
    /// What is hidden; `None` leaves it out.
    pub hidden: Option<StrokeStyle>,
}

impl Layer {
    /// A layer of `classes` whose visible strokes are drawn in `style`.
    #[must_use]
    pub fn visible(classes: impl Into<Vec<LineClass>>, style: StrokeStyle) -> Self {
        Self { classes: classes.into(), visible: Some(style), hidden: None }
    }
}

/// How the lines of an object are drawn.
#[derive(Debug, Clone, Default, PartialEq)]
pub struct DrawingStyle {
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

/// Which strokes of a layer a set has.
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

/// The strokes of one layer with one visibility.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct StrokeSet {
    pub(crate) layer: u32,
    pub(crate) visibility: Visibility,
    pub(crate) style: StrokeStyle,
    pub(crate) has_contours: bool,
}

impl StrokeSet {
    /// Whether it draws contours over the surface that they bound, which would
    /// swallow them: their fragments ask at the edge whether they are visible.
    pub(crate) const fn lies_over_surface(&self) -> bool {
        let is_wide = !matches!(self.style.kind, LineKind::Thin | LineKind::Fin);
        let reaches_inside = matches!(self.style.placement, Placement::Centred | Placement::Inside);
        self.has_contours && is_wide && reaches_inside
    }
}

impl DrawingStyle {
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

    /// The stroke sets in the order of drawing: what is hidden, then what is visible, each
    /// from the last layer to the first, then the silhouette.
    pub(crate) fn stroke_sets(&self) -> Vec<StrokeSet> {
        let has_contours = |layer: &Layer| layer.classes.contains(&LineClass::Contour);
        let of_layers = |visibility, style: fn(&Layer) -> Option<&StrokeStyle>| {
            self.layers.iter().enumerate().rev().filter_map(move |(layer, of_layer)| {
                let layer = edgemesh::index::to_u32(layer);
                let has_contours = has_contours(of_layer);
                let style = style(of_layer).cloned();
                style.map(|style| StrokeSet { layer, visibility, style, has_contours })
            })
        };
        let hidden = of_layers(Visibility::Hidden, |layer| layer.hidden.as_ref());
        let visible = of_layers(Visibility::Visible, |layer| layer.visible.as_ref());
        let silhouette = self.silhouette.iter().filter_map(|style| {
            let layer = edgemesh::index::to_u32(self.layers.iter().position(has_contours)?);
            let visibility = Visibility::Silhouette;
            Some(StrokeSet { layer, visibility, style: style.clone(), has_contours: true })
        });
        hidden.chain(visible).chain(silhouette).collect()
    }
}
