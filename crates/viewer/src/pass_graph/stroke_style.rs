//! From the variables of a pass of strokes to a style, and from several passes to a
//! look.

use std::path::PathBuf;

use edgemesh::edge_mesh::MeshFrame;
use edgemesh::line::class::LineClass;
use edgemesh::line::kind::LineKind;
use edgemesh::line::placement::{Parameterization, Placement};
use strokes::style::brush::Brush;
use strokes::style::drawing_style::{DrawingStyle, Layer, StrokeStyle, Width};
use strokes::style::link_style::{BrushFit, CURVE_LENGTH, End, Join, LinkStyle};

use crate::error::{Error, ImageError};
use crate::technique::brush_file::brush_from_png;
use crate::technique::class_pass::classes_of;
use crate::technique::curve::parse_curve;
use crate::technique::error::TechniqueError;
use crate::technique::image_file;
use crate::technique::pass::Pass;
use crate::technique::texture_name::TextureSource;

/// The least width in pixels.
const MIN_WIDTH_PX: f32 = 0.1;

/// The look of passes of strokes that are drawn together.
///
/// A class that several passes of the same visibility name is drawn by the first of
/// them. Classes that look alike are one layer.
///
/// `built` are the thresholds in radians that meshes were built with: those of passes
/// that set none.
pub(crate) fn style_of_passes(
    passes: &[&Pass],
    folders: &[PathBuf],
    frame: &MeshFrame,
    built: [f64; 2],
) -> Result<DrawingStyle, Error> {
    let styles = passes
        .iter()
        .map(|pass| Ok((*pass, style_of(pass, folders, frame)?)))
        .collect::<Result<Vec<(&Pass, StrokeStyle)>, Error>>()?;
    let style = |visibility: &str, class: LineClass| {
        let draws = |(pass, _): &&(&Pass, StrokeStyle)| {
            let classes = classes_of(pass.string("classes")).unwrap_or_default();
            pass.string("visibility") == visibility && classes.contains(&class)
        };
        styles.iter().find(draws).map(|(_, style)| style.clone())
    };
    let silhouette = style("silhouette", LineClass::Contour);
    let mut layers: Vec<Layer> = Vec::new();
    for class in LineClass::ALL {
        let (visible, hidden) = (style("visible", class), style("hidden", class));
        // Contours that are not drawn themselves are still needed for a silhouette.
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
    Ok(DrawingStyle {
        fill_color: None,
        layers,
        silhouette,
        thresholds: thresholds_of(passes, built),
    })
}

/// The crease thresholds in radians: those that the first pass sets that sets any.
fn thresholds_of(passes: &[&Pass], built: [f64; 2]) -> Option<[f64; 2]> {
    let angle = |variable: &str| {
        let angles = passes.iter().map(|pass| pass.number(variable));
        angles.into_iter().find(|angle| *angle >= 0.0).map(|angle| f64::from(angle).to_radians())
    };
    match (angle("ridge_angle"), angle("valley_angle")) {
        (None, None) => None,
        (ridge, valley) => Some([ridge.unwrap_or(built[0]), valley.unwrap_or(built[1])]),
    }
}

fn style_of(pass: &Pass, folders: &[PathBuf], frame: &MeshFrame) -> Result<StrokeStyle, Error> {
    #[expect(clippy::cast_possible_truncation, reason = "a width or a distance")]
    let scaled = |value: f32| (f64::from(value) * frame.scale) as f32;
    let [r, g, b, a] = pass.numbers("color");
    let alpha = a * pass.number("opacity");
    let width = match pass.string("width_unit") {
        "model" => Width::World(scaled(pass.number("width"))),
        _ => Width::Pixels(pass.number("width").max(MIN_WIDTH_PX)),
    };
    let fade: [f32; 2] = pass.numbers("fade");
    let ends = pass.string("ends");
    let kind = match (pass.string("kind"), ends) {
        ("thin", _) => LineKind::Thin,
        ("fin", _) => LineKind::Fin,
        (_, "none") => LineKind::Quad,
        (_, "disks") => LineKind::QuadAndDisks,
        _ => LineKind::QuadAndCaps,
    };
    Ok(StrokeStyle {
        color: [r * alpha, g * alpha, b * alpha, alpha],
        width,
        kind,
        placement: match pass.string("placement") {
            "centred" => Placement::Centred,
            "outside" => Placement::Outside,
            "inside" => Placement::Inside,
            _ => Placement::Automatic,
        },
        parameterization: match pass.string("parameterization") {
            "screen" => Parameterization::ScreenSpace,
            _ => Parameterization::ObjectSpace,
        },
        brush: brush_of(pass, folders)?,
        fade: (fade[1] > fade[0]).then(|| fade.map(scaled)),
        link: pass.bool("linked").then(|| link_of(pass)).transpose()?,
    })
}

fn link_of(pass: &Pass) -> Result<LinkStyle, Error> {
    let min_length = pass.number("min_length");
    let dash: [f32; 2] = pass.numbers("dash");
    Ok(LinkStyle {
        join: match pass.string("join") {
            "mitred" => Join::Mitred,
            _ => Join::Round,
        },
        end: match pass.string("ends") {
            "flat" => End::Flat,
            "pointed" => End::Pointed,
            _ => End::Round,
        },
        corner_rad: pass.number("corner").to_radians(),
        is_cut_where_hidden: pass.bool("cut_hidden"),
        min_length_px: (min_length >= 0.0).then_some(min_length),
        max_length_px: pass.number("max_length"),
        brush_fit: match pass.string("fit") {
            "stretched" => BrushFit::Stretched,
            _ => BrushFit::Tiled,
        },
        taper_px: pass.numbers("taper"),
        overshoot_px: pass.number("overshoot"),
        width_curve: curve_of(pass, "width_curve", 10.0)?,
        opacity_curve: curve_of(pass, "opacity_curve", 1.0)?,
        wobble_px: pass.number("wobble"),
        wobble_length_px: pass.number("wobble_length"),
        jitter_px: pass.number("jitter"),
        seed: u16::try_from(pass.int("seed")).unwrap_or_default(),
        dash_px: (dash[0] >= 0.1 && dash[1] >= 0.1).then_some(dash),
    })
}

fn brush_of(pass: &Pass, folders: &[PathBuf]) -> Result<Option<Brush>, Error> {
    let name = pass.texture("brush");
    if name.source == TextureSource::None {
        return Ok(None);
    }
    let file = image_file::find(name, folders, pass.place_of("brush"))
        .map_err(|mistake| Error::BrushNotFound { what: mistake.message })?;
    let unreadable = |error| Error::Image { file: file.name(), reason: ImageError::Io(error) };
    let bytes = file.bytes().map_err(unreadable)?;
    Ok(Some(brush_from_png(&file.name(), &bytes)?))
}

fn curve_of(pass: &Pass, variable: &str, most: f32) -> Result<[f32; CURVE_LENGTH], Error> {
    parse_curve(pass.string(variable), most).map_err(|what| {
        let (pass, variable) = (pass.name.clone(), variable.to_owned());
        TechniqueError::Curve { pass, variable, what }.into()
    })
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::pass_graph::strokes_of;
    use crate::technique::library::Library;

    const BUILT: [f64; 2] = [0.5, 0.6];

    fn look(settings: &[&str], frame: &MeshFrame) -> DrawingStyle {
        let mut technique = Library::shipped().technique("ink").unwrap().0;
        for setting in settings {
            technique.set(setting).unwrap();
        }
        strokes_of(&technique, frame, BUILT).unwrap()
    }

    fn layers(settings: &[&str]) -> Vec<Layer> {
        look(settings, &MeshFrame::default()).layers
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
        let look =
            look(&["strokes.width=3", "strokes.width_unit=model", "strokes.fade=2,4"], &frame);
        let style = look.layers[0].visible.as_ref().unwrap();
        assert_eq!((style.width, style.fade), (Width::World(1.5), Some([1.0, 2.0])));
    }

    #[test]
    fn thresholds_that_are_not_set_are_those_of_the_mesh() {
        let frame = MeshFrame::default();
        assert_eq!(look(&[], &frame).thresholds, None);
        let set = look(&["strokes.ridge_angle=90"], &frame).thresholds.unwrap();
        assert!((set[0] - std::f64::consts::FRAC_PI_2).abs() < 1e-6, "{set:?}");
        assert_eq!(set[1].to_bits(), BUILT[1].to_bits());
    }

    #[test]
    fn values_outside_mean_what_they_say() {
        let frame = MeshFrame::default();
        let plain = look(&["strokes.linked=true"], &frame);
        let path = plain.layers[0].visible.as_ref().unwrap().link.clone().unwrap();
        assert_eq!((path.clone(), path.dash_px), (LinkStyle::default(), None));
        let set = look(
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
