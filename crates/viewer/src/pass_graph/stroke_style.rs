//! Passes of strokes as a drawing style.

use std::path::PathBuf;

use edgemesh::edge_mesh::MeshFrame;
use edgemesh::line::{LineClass, LineKind};
use strokes::{Brush, DrawingStyle, Layer, StrokeStyle, Width};

use crate::error::{Error, ImageError};
use crate::technique::brush_file::brush_from_png;
use crate::technique::core_view::{StrokeEnds, StrokeKind, StrokeWidth, Strokes, Visibility};
use crate::technique::image_file;
use crate::technique::pass::Pass;
use crate::technique::texture_name::TextureSource;

/// A pass of strokes with its style.
struct StyledPass {
    view: Strokes,
    style: StrokeStyle,
}

/// The drawing style of passes of strokes that are drawn together.
///
/// A class of several passes of the same visibility is drawn by the first of them. Classes
/// with the same styles are one layer.
///
/// `built` are the crease thresholds in radians that the mesh was built with, for ridges
/// and valleys, which apply if no pass sets others.
pub(crate) fn style_of_passes(
    passes: &[&Pass],
    folders: &[PathBuf],
    frame: &MeshFrame,
    built: [f64; 2],
) -> Result<DrawingStyle, Error> {
    let passes = passes
        .iter()
        .map(|pass| {
            let view = Strokes::of(pass)?;
            let style = style_of(pass, &view, folders, frame)?;
            Ok(StyledPass { view, style })
        })
        .collect::<Result<Vec<StyledPass>, Error>>()?;
    let style = |visibility: Visibility, class: LineClass| {
        let draws = |pass: &&StyledPass| pass.view.lines.draws(class, visibility);
        passes.iter().find(draws).map(|pass| pass.style.clone())
    };
    let silhouette = style(Visibility::Silhouette, LineClass::Contour);
    let mut layers: Vec<Layer> = Vec::new();
    for class in LineClass::ALL {
        let visible = style(Visibility::Visible, class);
        let hidden = style(Visibility::Hidden, class);
        // A silhouette needs contours, also if they are not drawn themselves.
        let is_needed = class == LineClass::Contour && silhouette.is_some();
        if visible.is_none() && hidden.is_none() && !is_needed {
            continue;
        }
        let same =
            layers.iter_mut().find(|layer| layer.visible == visible && layer.hidden == hidden);
        match same {
            Some(layer) => layer.classes.push(class),
            None => layers.push(Layer { classes: vec![class], visible, hidden }),
        }
    }
    let thresholds = thresholds_of(&passes, built);
    Ok(DrawingStyle { fill_color: None, layers, silhouette, thresholds })
}

/// The crease thresholds in radians: those of the first pass that sets one.
fn thresholds_of(passes: &[StyledPass], built: [f64; 2]) -> Option<[f64; 2]> {
    let angle = |of: fn(&Strokes) -> Option<f32>| {
        let angle = passes.iter().find_map(|pass| of(&pass.view));
        angle.map(|angle| f64::from(angle).to_radians())
    };
    match (angle(|view| view.ridge_angle_deg), angle(|view| view.valley_angle_deg)) {
        (None, None) => None,
        (ridge, valley) => Some([ridge.unwrap_or(built[0]), valley.unwrap_or(built[1])]),
    }
}

fn style_of(
    pass: &Pass,
    view: &Strokes,
    folders: &[PathBuf],
    frame: &MeshFrame,
) -> Result<StrokeStyle, Error> {
    #[expect(clippy::cast_possible_truncation, reason = "a width or a distance")]
    let scaled = |value: f32| (f64::from(value) * frame.scale) as f32;
    let [r, g, b, a] = view.color;
    let alpha = a * view.opacity;
    Ok(StrokeStyle {
        color: [r * alpha, g * alpha, b * alpha, alpha],
        width: match view.width {
            StrokeWidth::Pixels(width) => Width::Pixels(width),
            StrokeWidth::Model(width) => Width::World(scaled(width)),
        },
        kind: match (view.kind, view.ends) {
            (StrokeKind::Thin, _) => LineKind::Thin,
            (StrokeKind::Fin, _) => LineKind::Fin,
            (StrokeKind::Quad, StrokeEnds::None) => LineKind::Quad,
            (StrokeKind::Quad, StrokeEnds::Disks) => LineKind::QuadAndDisks,
            (StrokeKind::Quad, _) => LineKind::QuadAndCaps,
        },
        placement: view.placement,
        parameterization: view.parameterization,
        brush: brush_of(pass, view, folders)?,
        fade: view.fade.map(|distances| distances.map(scaled)),
        behind_glass: view.behind_glass,
        link: view.is_linked.then(|| view.link.clone()),
    })
}

fn brush_of(pass: &Pass, view: &Strokes, folders: &[PathBuf]) -> Result<Option<Brush>, Error> {
    if view.brush.source == TextureSource::None {
        return Ok(None);
    }
    let file = image_file::find(&view.brush, folders, &pass.place)
        .map_err(|mistake| Error::BrushNotFound { what: mistake.message })?;
    let unreadable = |error| Error::Image { file: file.name(), reason: ImageError::Io(error) };
    let bytes = file.bytes().map_err(unreadable)?;
    Ok(Some(brush_from_png(&file.name(), &bytes)?))
}

#[cfg(test)]
mod tests {
    use strokes::{End, LinkStyle};

    use super::*;
    use crate::pass_graph::strokes_of;
    use crate::technique::library::Library;

    const BUILT: [f64; 2] = [0.5, 0.6];

    fn style_with(settings: &[&str], frame: &MeshFrame) -> DrawingStyle {
        let mut technique = Library::shipped().technique("ink").unwrap().0;
        for setting in settings {
            technique.set(setting).unwrap();
        }
        strokes_of(&technique, frame, BUILT).unwrap()
    }

    fn layers(settings: &[&str]) -> Vec<Layer> {
        style_with(settings, &MeshFrame::default()).layers
    }

    #[test]
    fn classes_that_look_alike_are_one_layer() {
        assert_eq!(layers(&[]).len(), 1);
        let two = layers(&["ridge.width=4"]);
        assert_eq!(two.len(), 2);
        assert_eq!(two[1].classes, [LineClass::Ridge]);
        let ridge_again = layers(&["ridge.width=4", "strokes.width=4"]);
        assert_eq!(ridge_again.len(), 1, "all are 4 wide now");
        assert_eq!(layers(&["strokes.render=false"]).len(), 0);
        let silhouette = layers(&["strokes.render=false", "silhouette.render=true"]);
        assert_eq!(silhouette[0].classes, [LineClass::Contour], "found, and not drawn");
        assert_eq!(layers(&["hidden.render=true"]).len(), 1);
        assert_eq!(layers(&["hidden-ridge.render=true"]).len(), 2);
    }

    #[test]
    fn units_of_the_model_go_by_its_frame() {
        let frame = MeshFrame { scale: 0.5, ..MeshFrame::default() };
        let style = style_with(
            &["strokes.width=3", "strokes.width_unit=model", "strokes.fade=2,4"],
            &frame,
        );
        let style = style.layers[0].visible.as_ref().unwrap();
        assert_eq!((style.width, style.fade), (Width::World(1.5), Some([1.0, 2.0])));
    }

    #[test]
    fn thresholds_that_are_not_set_are_those_of_the_mesh() {
        let frame = MeshFrame::default();
        assert_eq!(style_with(&[], &frame).thresholds, None);
        let set = style_with(&["strokes.ridge_angle=90"], &frame).thresholds.unwrap();
        assert!((set[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-6, "{set:?}");
        assert_eq!(set[1].to_bits(), BUILT[1].to_bits());
    }

    #[test]
    fn values_outside_mean_what_they_say() {
        let frame = MeshFrame::default();
        let plain = style_with(&["strokes.linked=true"], &frame);
        let path = plain.layers[0].visible.as_ref().unwrap().link.clone().unwrap();
        assert_eq!((path.clone(), path.dash_px), (LinkStyle::default(), None));
        let set = style_with(
            &[
                "strokes.linked=true",
                "strokes.dash=12,8",
                "strokes.min-length=5",
                "strokes.ends=flat",
            ],
            &frame,
        );
        let path = set.layers[0].visible.as_ref().unwrap().link.clone().unwrap();
        assert_eq!(
            (path.dash_px, path.min_length_px, path.end),
            (Some([12.0, 8.0]), Some(5.0), End::Flat)
        );
    }
}
