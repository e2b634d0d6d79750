//! The variables of `strokes`.

use edgemesh::line::{Parameterization, Placement};
use strokes::{BrushFit, CURVE_LENGTH, End, Join, LinkStyle};

use super::curve::parse_curve;
use super::lines::LineSelection;
use super::reader::Reader;
use crate::technique::mistake::Mistake;
use crate::technique::texture_name::TextureName;
use crate::technique::value::Value;
use crate::technique::word::Word;

/// A pass that draws edges as strokes.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Strokes {
    /// Which lines it draws.
    pub(crate) lines: LineSelection,
    /// Color of the ink: red, green, blue, alpha, 0 to 1, not premultiplied.
    pub(crate) color: [f32; 4],
    /// Factor of the color's alpha, 0 to 1.
    pub(crate) opacity: f32,
    /// Width of the strokes.
    pub(crate) width: StrokeWidth,
    /// The brush, or no texture.
    pub(crate) brush: TextureName,
    /// How the brush is mapped onto single edges.
    pub(crate) parameterization: Parameterization,
    /// Position across the edge.
    pub(crate) placement: Placement,
    /// What is drawn along an edge.
    pub(crate) kind: StrokeKind,
    /// What is drawn at the ends.
    pub(crate) ends: StrokeEnds,
    /// Distances from the eye, in units of the model, at which strokes begin and finish
    /// fading.
    pub(crate) fade: Option<[f32; 2]>,
    /// Factor of the opacity behind transparent surfaces.
    pub(crate) behind_glass: f32,
    /// Smallest angle of a ridge in degrees; `None` for that of the mesh.
    pub(crate) ridge_angle_deg: Option<f32>,
    /// Smallest angle of a valley in degrees; `None` for that of the mesh.
    pub(crate) valley_angle_deg: Option<f32>,
    /// Whether edges are linked into strokes.
    pub(crate) is_linked: bool,
    /// How edges are linked, if [`Self::is_linked`].
    pub(crate) link: LinkStyle,
}

/// Width of strokes.
#[derive(Debug, Clone, Copy, PartialEq)]
pub(crate) enum StrokeWidth {
    /// Pixels, at least [`MIN_WIDTH_PX`].
    Pixels(f32),
    /// Units of the model.
    Model(f32),
}

/// The smallest width of a stroke in pixels. The descriptor has a smaller minimum, since
/// `width` can also be in units of the model.
pub(crate) const MIN_WIDTH_PX: f32 = 0.1;

/// If a dash or gap is shorter than this, strokes have no dashes.
const MIN_DASH_PX: f32 = 0.1;

/// Largest factor of `width_curve`.
const MAX_WIDTH_FACTOR: f32 = 10.0;

/// Largest factor of `opacity_curve`.
const MAX_OPACITY_FACTOR: f32 = 1.0;

impl Strokes {
    pub(super) fn read(reader: &mut Reader) -> Self {
        let [fade_begin, fade_end] = reader.vector2("fade");
        let ends = reader.word("ends");
        Self {
            lines: LineSelection::read(reader),
            color: reader.rgba("color"),
            opacity: reader.number("opacity"),
            width: read_width(reader),
            brush: reader.texture("brush"),
            parameterization: reader.word("parameterization"),
            placement: reader.word("placement"),
            kind: reader.word("kind"),
            ends,
            fade: (fade_end > fade_begin).then_some([fade_begin, fade_end]),
            behind_glass: reader.number("behind_glass"),
            ridge_angle_deg: read_unless_negative(reader, "ridge_angle"),
            valley_angle_deg: read_unless_negative(reader, "valley_angle"),
            is_linked: reader.bool("linked"),
            link: read_link(reader, ends),
        }
    }
}

fn read_link(reader: &mut Reader, ends: StrokeEnds) -> LinkStyle {
    let [dash, gap] = reader.vector2("dash");
    let corner_deg: f32 = reader.number("corner");
    LinkStyle {
        join: reader.word("join"),
        end: match ends {
            StrokeEnds::Flat => End::Flat,
            StrokeEnds::Pointed => End::Pointed,
            _ => End::Round,
        },
        corner_rad: corner_deg.to_radians(),
        is_cut_where_hidden: reader.bool("cut_hidden"),
        min_length_px: read_unless_negative(reader, "min_length"),
        max_length_px: reader.number("max_length"),
        brush_fit: reader.word("fit"),
        taper_px: reader.vector2("taper"),
        overshoot_px: reader.number("overshoot"),
        width_curve: read_curve(reader, "width_curve", MAX_WIDTH_FACTOR),
        opacity_curve: read_curve(reader, "opacity_curve", MAX_OPACITY_FACTOR),
        wobble_px: reader.number("wobble"),
        wobble_length_px: reader.number("wobble_length"),
        jitter_px: reader.number("jitter"),
        seed: reader.integer("seed"),
        dash_px: (dash >= MIN_DASH_PX && gap >= MIN_DASH_PX).then_some([dash, gap]),
    }
}

/// The width; one below [`MIN_WIDTH_PX`] is replaced, with a warning.
fn read_width(reader: &mut Reader) -> StrokeWidth {
    let width = reader.number("width");
    match reader.word("width_unit") {
        WidthUnit::Model => StrokeWidth::Model(width),
        WidthUnit::Pixels if width < MIN_WIDTH_PX => {
            let given = Value::Numbers(vec![width]);
            let used = Value::Numbers(vec![MIN_WIDTH_PX]);
            let place = reader.place("width");
            reader.add(Mistake::out_of_range(Some(place), "width", &given, &used));
            StrokeWidth::Pixels(MIN_WIDTH_PX)
        }
        WidthUnit::Pixels => StrokeWidth::Pixels(width),
    }
}

fn read_unless_negative(reader: &mut Reader, name: &'static str) -> Option<f32> {
    Some(reader.number(name)).filter(|value| *value >= 0.0)
}

fn read_curve(reader: &mut Reader, name: &'static str, largest: f32) -> [f32; CURVE_LENGTH] {
    parse_curve(reader.string(name), largest).unwrap_or_else(|message| {
        reader.add(Mistake::error(reader.place(name), message));
        [1.0; CURVE_LENGTH]
    })
}

/// The variable `width_unit`.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum WidthUnit {
    /// Pixels of the picture.
    Pixels,
    /// Units of the model's file.
    Model,
}

impl Word for WidthUnit {
    const WORDS: &'static [(&'static str, Self)] =
        &[("pixels", Self::Pixels), ("model", Self::Model)];
}

/// The variable `kind`: what is drawn along an edge.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StrokeKind {
    /// A quad.
    Quad,
    /// A line of one pixel.
    Thin,
    /// A quad along the surface normals.
    Fin,
}

impl Word for StrokeKind {
    const WORDS: &'static [(&'static str, Self)] =
        &[("quad", Self::Quad), ("thin", Self::Thin), ("fin", Self::Fin)];
}

/// The variable `ends`: what is drawn at the ends of single edges or of linked strokes.
#[derive(Debug, Clone, Copy, PartialEq, Eq)]
pub(crate) enum StrokeEnds {
    /// Caps of edges, round ends of strokes.
    Auto,
    /// Nothing at the ends of edges.
    None,
    /// Caps of edges.
    Caps,
    /// Half disks of edges.
    Disks,
    /// Round ends of strokes.
    Round,
    /// Flat ends of strokes.
    Flat,
    /// Pointed ends of strokes.
    Pointed,
}

impl Word for StrokeEnds {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("auto", Self::Auto),
        ("none", Self::None),
        ("caps", Self::Caps),
        ("disks", Self::Disks),
        ("round", Self::Round),
        ("flat", Self::Flat),
        ("pointed", Self::Pointed),
    ];
}

impl Word for Parameterization {
    const WORDS: &'static [(&'static str, Self)] =
        &[("object", Self::ObjectSpace), ("screen", Self::ScreenSpace)];
}

impl Word for Placement {
    const WORDS: &'static [(&'static str, Self)] = &[
        ("auto", Self::Automatic),
        ("centred", Self::Centered),
        ("outside", Self::Outside),
        ("inside", Self::Inside),
    ];
}

impl Word for Join {
    const WORDS: &'static [(&'static str, Self)] =
        &[("round", Self::Round), ("mitred", Self::Mitred)];
}

impl Word for BrushFit {
    const WORDS: &'static [(&'static str, Self)] =
        &[("tiled", Self::Tiled), ("stretched", Self::Stretched)];
}
