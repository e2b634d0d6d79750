//! Drawing styles: the strokes of each line class, and the fill under them.
//!
//! Classes that are drawn alike are one *layer*: one list of edges. The strokes of a layer
//! with one visibility are a *stroke set*: visible, hidden (paper, section 3.5) and, for the
//! layer with the contours, silhouette: drawn over the contours that separate the object from
//! anything else (section 3.4).
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

/// The most layers of an object: one per class. WGSL twin: the constant of this name.
pub const MAX_LAYERS: usize = LineClass::COUNT;

/// The most stroke sets of an object: the visible and the hidden strokes of each layer, and two
/// for silhouettes. WGSL twin: the constant of this name.
pub const MAX_STROKE_SETS: usize = 2 * MAX_LAYERS + 2;

/// The width of a stroke.
#[derive(Debug, Clone, Copy, PartialEq)]
#[non_exhaustive]
pub enum Width {
    /// In pixels, the same at any distance.
    Pixels(f32),
    /// In units of the scene: smaller in the distance.
    World(f32),
}

/// How the strokes of a set are drawn.
#[derive(Debug, Clone, PartialEq)]
pub struct StrokeStyle {
    /// Premultiplied RGBA, 0 to 1.
    pub color: [f32; 4],
    /// In pixels or in units of the scene.
    pub width: Width,
    /// Thin line, quad or fin, with its ends.
    pub kind: LineKind,
    /// On which side of the edge the stroke lies.
    pub placement: Placement,
    /// How the brush lies along the stroke.
    pub parameterization: Parameterization,
    /// The brush, or `None` for solid ink.
    pub brush: Option<Brush>,
    /// The distances from the eye, in units of the scene, where strokes begin to
    /// fade and where nothing is left of them.
    pub fade: Option<[f32; 2]>,
    /// Factor of the opacity behind transparent surfaces: 1 as elsewhere, 0 for nothing.
    pub behind_glass: f32,
    /// How edges are linked into strokes; `None` draws each edge by itself, as the paper
    /// does. Thin lines and fins are never linked, nor is anything if vertex shaders detect.
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
            behind_glass: 0.4,
            link: None,
        }
    }
}

impl StrokeStyle {
    /// The most pixels between linked strokes and their lines; `None` if the width is in
    /// units of the scene, or nothing is linked.
    pub(crate) fn reach_px(&self) -> Option<f32> {
        let Width::Pixels(width) = self.width else { return None };
        let link = self.link.as_ref()?;
        let widest = width * link.width_curve.into_iter().fold(0.0, f32::max);
        // Mitres and points go beyond the width.
        let beyond = link.overshoot_px + link.wobble_px + link.jitter_px;
        Some(MITRE_LIMIT * widest + beyond + 2.0)
    }

    /// Whether edges are linked into strokes, if compute shaders detect.
    pub(crate) const fn is_linked(&self) -> bool {
        self.link.is_some() && !matches!(self.kind, LineKind::Thin | LineKind::Fin)
    }
}

/// Line classes that are drawn alike.
#[derive(Debug, Clone, PartialEq)]
pub struct Layer {
    /// A class in several layers counts for the first of them.
    pub classes: Vec<LineClass>,
    /// Strokes of what is visible; `None` draws none.
    pub visible: Option<StrokeStyle>,
    /// Strokes of what is hidden; `None` draws none.
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
    /// Premultiplied RGBA of the surface, 0 to 1; `None` fills only the depth, so that lines
    /// are hidden and the background shows through.
    pub fill_color: Option<[f32; 4]>,
    /// At most seven layers, the first drawn last, over all others. A class in none of them is
    /// not drawn.
    pub layers: Vec<Layer>,
    /// Strokes over the contours that separate the object from anything else. It needs a
    /// layer with contours, and targets with a stencil.
    pub silhouette: Option<StrokeStyle>,
    /// The least angles between face normals, in radians, at which edges are ridges and
    /// valleys; `None` for the creases that the mesh was built with.
    pub thresholds: Option<[f64; 2]>,
}

/// Which strokes of a layer are in a set.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash)]
#[repr(u32)]
pub enum Visibility {
    /// Hidden by nothing.
    Visible = 0,
    /// Hidden by a surface.
    Hidden = 1,
    /// Visible, and not in front of the object itself.
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
    /// Whether contours are drawn over the surface that they bound, which would swallow them:
    /// their fragments ask at the edge whether they are visible.
    pub(crate) const fn lies_over_surface(&self) -> bool {
        let is_wide = !matches!(self.style.kind, LineKind::Thin | LineKind::Fin);
        let reaches_inside =
            matches!(self.style.placement, Placement::Centered | Placement::Inside);
        self.has_contours && is_wide && reaches_inside
    }
}

impl DrawingStyle {
    /// Whether any strokes are linked, if compute shaders detect.
    pub(crate) fn is_linked(&self) -> bool {
        let of_layers = self.layers.iter().flat_map(|layer| [&layer.visible, &layer.hidden]);
        of_layers.chain([&self.silhouette]).flatten().any(StrokeStyle::is_linked)
    }

    /// The layer of each class, with the thresholds, as shaders read them.
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

    /// The stroke sets in the order of drawing: hidden, then visible, each from the last layer
    /// to the first, then the silhouette.
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
