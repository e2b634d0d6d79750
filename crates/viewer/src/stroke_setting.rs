//! The variables of strokes: their names, what values they take, and how they change a
//! style.

use std::path::Path;

use edgemesh::build::Frame;
use edgemesh::command::Failure;
use edgemesh::oracle::stroke_quad::Placement;
use edgemesh::oracle::stroke_segment::{LineKind, Parameterization};
use strokes::brush::Brush;
use strokes::graph::path_style::{BrushFit, CURVE_LENGTH, End, Join, PathStyle};
use strokes::look::{StrokeStyle, Width};

use crate::technique::premultiplied;

/// The variables of all passes of strokes.
pub const STROKE_VARIABLES: [(&str, &str); 25] = [
    ("show", "true or false"),
    ("color", "the ink, #rrggbb or #rrggbbaa"),
    ("opacity", "0 to 1"),
    ("width", "0.1 to 100 pixels, or in units of the model as 0.05u"),
    ("brush", "none, pen, charcoal, watercolor, fur, dash, or a PNG file"),
    ("parameterization", "how the brush lies along edges: object or screen"),
    ("placement", "auto (contours outside, others centred), centred, outside, inside"),
    ("kind", "quad, thin (one pixel), fin (along the surface normals)"),
    ("ends", "caps, none, disks; of linked strokes round, flat, pointed"),
    ("fade", "distances where strokes begin to fade and are gone, as 3,8; or none"),
    ("linked", "true or false: edges linked into strokes, or each by itself"),
    ("join", "how the segments of linked strokes meet: round or mitred"),
    ("corner", "degrees of turn at which linked strokes are cut, 0 to 180; none for never"),
    ("cut-hidden", "true or false: whether linked strokes end where they are hidden"),
    ("min-length", "pixels; shorter linked strokes fade; auto for their width"),
    ("max-length", "pixels; longer linked strokes are cut; or none"),
    ("fit", "how the brush lies along linked strokes: tiled or stretched"),
    ("taper", "pixels over which linked strokes grow and shrink, as 20 or 10,40"),
    ("overshoot", "pixels by which linked strokes go on beyond their ends"),
    (
        "width-curve",
        "2 to 8 numbers along linked strokes: what is left of their width, as 0.3,1,0.3",
    ),
    ("opacity-curve", "the same for their opacity"),
    ("wobble", "pixels by which linked strokes swing, as 3, or with the wavelength as 3,60"),
    ("jitter", "pixels by which the hand that draws linked strokes trembles"),
    ("seed", "0 to 65535: another hand"),
    ("dash", "pixels of ink and gap along linked strokes, as 12,8; or none"),
];

/// The widest stroke: the guard band around the picture hides the cut ends of
/// strokes up to this width on pictures of 67 pixels and more.
const MAX_WIDTH_PX: f32 = 100.0;

/// A style that may be switched off.
#[derive(Debug, Clone, PartialEq)]
pub(crate) struct Switched {
    pub(crate) is_shown: bool,
    pub(crate) style: StrokeStyle,
    /// The colour before opacity.
    pub(crate) color: [f32; 4],
    pub(crate) opacity: f32,
    pub(crate) is_linked: bool,
    /// How, where they are linked.
    pub(crate) path: PathStyle,
}

impl Switched {
    pub(crate) fn new(is_shown: bool, style: StrokeStyle) -> Self {
        Self {
            is_shown,
            style,
            color: [0.0, 0.0, 0.0, 1.0],
            opacity: 1.0,
            is_linked: false,
            path: PathStyle::default(),
        }
    }

    /// The style in the units of the scene, where it is shown.
    pub(crate) fn shown(&self, frame: &Frame) -> Option<StrokeStyle> {
        #[expect(clippy::cast_possible_truncation, reason = "a width or a distance")]
        let scaled = |value: f32| (f64::from(value) * frame.scale) as f32;
        let mut style = self.style.clone();
        let [r, g, b, a] = self.color;
        style.color = premultiplied([r, g, b, a * self.opacity]);
        if let Width::World(width) = style.width {
            style.width = Width::World(scaled(width));
        }
        style.fade = style.fade.map(|fade| fade.map(scaled));
        style.path = self.is_linked.then(|| self.path.clone());
        self.is_shown.then_some(style)
    }
}

/// A value for a variable of strokes.
pub(crate) enum StrokeSetting {
    Show(bool),
    Color([f32; 4]),
    Opacity(f32),
    Width(Width),
    Brush(Option<Brush>),
    Parameterization(Parameterization),
    Placement(Placement),
    Kind(LineKind),
    Ends(LineKind),
    Fade(Option<[f32; 2]>),
    Linked(bool),
    PathEnds(End),
    Join(Join),
    Corner(f32),
    CutHidden(bool),
    MinLength(Option<f32>),
    MaxLength(f32),
    Fit(BrushFit),
    Taper([f32; 2]),
    Overshoot(f32),
    WidthCurve([f32; CURVE_LENGTH]),
    OpacityCurve([f32; CURVE_LENGTH]),
    Wobble(f32, Option<f32>),
    Jitter(f32),
    Seed(u16),
    Dash(Option<[f32; 2]>),
}

pub(crate) enum SettingError {
    Wrong(String),
    Brush(Failure),
}

impl From<String> for SettingError {
    fn from(what: String) -> Self {
        Self::Wrong(what)
    }
}

impl StrokeSetting {
    pub(crate) fn parse(variable: &str, value: &str) -> Result<Self, SettingError> {
        Ok(match variable {
            "show" => Self::Show(parse_word(value, &[("true", true), ("false", false)])?),
            "color" => Self::Color(parse_color(value)?),
            "opacity" => Self::Opacity(
                parse_number(value, 0.0, 1.0).ok_or("needs a number from 0 to 1".to_owned())?,
            ),
            "width" => Self::Width(parse_width(value)?),
            "brush" => Self::Brush(load_brush(value).map_err(SettingError::Brush)?),
            "parameterization" => Self::Parameterization(parse_word(
                value,
                &[
                    ("object", Parameterization::ObjectSpace),
                    ("screen", Parameterization::ScreenSpace),
                ],
            )?),
            "placement" => Self::Placement(parse_word(
                value,
                &[
                    ("auto", Placement::Automatic),
                    ("centred", Placement::Centred),
                    ("outside", Placement::Outside),
                    ("inside", Placement::Inside),
                ],
            )?),
            "kind" => Self::Kind(parse_word(
                value,
                &[("quad", LineKind::Quad), ("thin", LineKind::Thin), ("fin", LineKind::Fin)],
            )?),
            "ends" => parse_word(
                value,
                &[
                    ("none", Ends::OfEdges(LineKind::Quad)),
                    ("caps", Ends::OfEdges(LineKind::QuadAndCaps)),
                    ("disks", Ends::OfEdges(LineKind::QuadAndDisks)),
                    ("round", Ends::OfPaths(End::Round)),
                    ("flat", Ends::OfPaths(End::Flat)),
                    ("pointed", Ends::OfPaths(End::Pointed)),
                ],
            )?
            .into(),
            "fade" => Self::Fade(parse_fade(value)?),
            _ => Self::parse_path(variable, value)?,
        })
    }

    /// The variables of linked strokes.
    fn parse_path(variable: &str, value: &str) -> Result<Self, SettingError> {
        let truths = [("true", true), ("false", false)];
        Ok(match variable {
            "linked" => Self::Linked(parse_word(value, &truths)?),
            "join" => {
                Self::Join(parse_word(value, &[("round", Join::Round), ("mitred", Join::Mitred)])?)
            }
            "corner" if value == "none" => Self::Corner(180.0),
            "corner" => Self::Corner(
                parse_number(value, 0.0, 180.0)
                    .ok_or("needs degrees from 0 to 180, or none".to_owned())?,
            ),
            "cut-hidden" => Self::CutHidden(parse_word(value, &truths)?),
            "min-length" if value == "auto" => Self::MinLength(None),
            "min-length" => Self::MinLength(Some(parse_pixels(value)?)),
            "max-length" if value == "none" => Self::MaxLength(0.0),
            "max-length" => Self::MaxLength(parse_pixels(value)?),
            "fit" => Self::Fit(parse_word(
                value,
                &[("tiled", BrushFit::Tiled), ("stretched", BrushFit::Stretched)],
            )?),
            "taper" => {
                let (start, end) = value.split_once(',').unwrap_or((value, value));
                Self::Taper([parse_pixels(start)?, parse_pixels(end)?])
            }
            "overshoot" => Self::Overshoot(parse_pixels(value)?),
            "width-curve" => Self::WidthCurve(parse_curve(value, 10.0)?),
            "opacity-curve" => Self::OpacityCurve(parse_curve(value, 1.0)?),
            "wobble" => {
                let (amplitude, wavelength) = value.split_once(',').unzip();
                let wavelength = wavelength.map(parse_pixels).transpose()?;
                Self::Wobble(parse_pixels(amplitude.unwrap_or(value))?, wavelength)
            }
            "jitter" => Self::Jitter(parse_pixels(value)?),
            "seed" => Self::Seed(
                value.parse().map_err(|_| "needs a whole number from 0 to 65535".to_owned())?,
            ),
            "dash" if value == "none" => Self::Dash(None),
            "dash" => {
                let what = || "needs ink and gap, as 12,8; or none".to_owned();
                let parts = value.split_once(',').ok_or_else(what)?;
                let dash = [parse_pixels(parts.0)?, parse_pixels(parts.1)?];
                if dash[0] < 0.1 || dash[1] < 0.1 {
                    return Err("needs at least 0.1 pixels of ink and of gap".to_owned().into());
                }
                Self::Dash(Some(dash))
            }
            _ => {
                let names: Vec<&str> = STROKE_VARIABLES.iter().map(|(name, _)| *name).collect();
                let what = format!("there is no such variable; there are: {}", names.join(", "));
                return Err(what.into());
            }
        })
    }

    pub(crate) fn apply(&self, to: &mut Switched) {
        let style = &mut to.style;
        match self {
            Self::Show(is_shown) => to.is_shown = *is_shown,
            Self::Color(color) => to.color = *color,
            Self::Opacity(opacity) => to.opacity = *opacity,
            Self::Width(width) => style.width = *width,
            Self::Brush(brush) => style.brush.clone_from(brush),
            Self::Parameterization(parameterization) => style.parameterization = *parameterization,
            Self::Placement(placement) => style.placement = *placement,
            // A quad keeps the ends it has.
            Self::Kind(LineKind::Quad) => {
                if matches!(style.kind, LineKind::Thin | LineKind::Fin) {
                    style.kind = LineKind::QuadAndCaps;
                }
            }
            Self::Kind(kind) | Self::Ends(kind) => style.kind = *kind,
            Self::Fade(fade) => style.fade = *fade,
            Self::Linked(is_linked) => to.is_linked = *is_linked,
            Self::PathEnds(end) => to.path.end = *end,
            Self::Join(join) => to.path.join = *join,
            Self::Corner(degrees) => to.path.corner_rad = degrees.to_radians(),
            Self::CutHidden(is_cut) => to.path.is_cut_where_hidden = *is_cut,
            Self::MinLength(pixels) => to.path.min_length_px = *pixels,
            Self::MaxLength(pixels) => to.path.max_length_px = *pixels,
            Self::Fit(fit) => to.path.brush_fit = *fit,
            Self::Taper(pixels) => to.path.taper_px = *pixels,
            Self::Overshoot(pixels) => to.path.overshoot_px = *pixels,
            Self::WidthCurve(curve) => to.path.width_curve = *curve,
            Self::OpacityCurve(curve) => to.path.opacity_curve = *curve,
            Self::Wobble(pixels, wavelength) => {
                to.path.wobble_px = *pixels;
                if let Some(wavelength) = wavelength {
                    to.path.wobble_length_px = wavelength.max(1.0);
                }
            }
            Self::Jitter(pixels) => to.path.jitter_px = *pixels,
            Self::Seed(seed) => to.path.seed = *seed,
            Self::Dash(dash) => to.path.dash_px = *dash,
        }
    }
}

/// One variable for the ends of edges and of linked strokes: no value is of both.
#[derive(Debug, Clone, Copy)]
enum Ends {
    OfEdges(LineKind),
    OfPaths(End),
}

impl From<Ends> for StrokeSetting {
    fn from(ends: Ends) -> Self {
        match ends {
            Ends::OfEdges(kind) => Self::Ends(kind),
            Ends::OfPaths(end) => Self::PathEnds(end),
        }
    }
}

fn load_brush(value: &str) -> Result<Option<Brush>, Failure> {
    if value == "none" {
        return Ok(None);
    }
    if let Some(brush) = Brush::named(value) {
        return brush.map(Some).map_err(|error| Failure::fault(error.to_string()));
    }
    Brush::from_file(Path::new(value)).map(Some).map_err(|error| {
        let names = Brush::NAMES.join(", ");
        Failure::fault(format!(
            "{error}; a brush is a PNG file, or one of the project's own: none, {names}"
        ))
    })
}

fn parse_word<T: Copy>(value: &str, words: &[(&str, T)]) -> Result<T, String> {
    let names: Vec<&str> = words.iter().map(|(name, _)| *name).collect();
    let found = words.iter().find(|(name, _)| *name == value).map(|word| word.1);
    found.ok_or_else(|| format!("needs one of {}", names.join(", ")))
}

pub(crate) fn parse_number(value: &str, least: f32, most: f32) -> Option<f32> {
    value.trim().parse().ok().filter(|number| (least..=most).contains(number))
}

fn parse_pixels(value: &str) -> Result<f32, String> {
    let pixels = value.strip_suffix("px").unwrap_or(value);
    parse_number(pixels, 0.0, 10_000.0).ok_or_else(|| "needs pixels from 0 to 10000".to_owned())
}

/// Two to eight numbers, spread evenly over the values of a curve.
fn parse_curve(value: &str, most: f32) -> Result<[f32; CURVE_LENGTH], String> {
    let what = || format!("needs 2 to {CURVE_LENGTH} numbers from 0 to {most}, as 0.3,1,0.3");
    let numbers: Option<Vec<f32>> =
        value.split(',').map(|number| parse_number(number, 0.0, most)).collect();
    let numbers =
        numbers.filter(|numbers| (2..=CURVE_LENGTH).contains(&numbers.len())).ok_or_else(what)?;
    Ok(std::array::from_fn(|at| {
        // In sevenths of the way: exact where there is a number.
        let place = at * (numbers.len() - 1);
        let (first, part) = (place / (CURVE_LENGTH - 1), place % (CURVE_LENGTH - 1));
        let next = (first + 1).min(numbers.len() - 1);
        #[expect(clippy::cast_precision_loss, reason = "at most seven")]
        let t = part as f32 / (CURVE_LENGTH - 1) as f32;
        numbers[first] * (1.0 - t) + numbers[next] * t
    }))
}

fn parse_width(value: &str) -> Result<Width, String> {
    let what = "needs a number of pixels from 0.1 to 100, or of the model's units as 0.05u";
    let width = if let Some(units) = value.strip_suffix('u') {
        let units: Option<f32> = units.trim().parse().ok();
        units.filter(|units| *units > 0.0 && units.is_finite()).map(Width::World)
    } else {
        let pixels = value.strip_suffix("px").unwrap_or(value);
        parse_number(pixels, 0.1, MAX_WIDTH_PX).map(Width::Pixels)
    };
    width.ok_or_else(|| what.into())
}

fn parse_fade(value: &str) -> Result<Option<[f32; 2]>, String> {
    if value == "none" {
        return Ok(None);
    }
    let distance = |text: &str| parse_number(text, 0.0, f32::MAX);
    let fade =
        value.split_once(',').and_then(|(start, end)| Some([distance(start)?, distance(end)?]));
    match fade {
        Some([start, end]) if start < end => Ok(Some([start, end])),
        _ => Err("needs two distances, the first one smaller, as 3,8; or none".into()),
    }
}

/// Reads `#rrggbb` or `#rrggbbaa` as sRGB values from 0 to 1.
pub(crate) fn parse_color(text: &str) -> Result<[f32; 4], String> {
    let what = || "needs a colour as #rrggbb or #rrggbbaa".to_owned();
    let digits = text.trim().strip_prefix('#').ok_or_else(what)?;
    if !matches!(digits.len(), 6 | 8) || !digits.bytes().all(|byte| byte.is_ascii_hexdigit()) {
        return Err(what());
    }
    let channel = |at: usize| {
        let byte = digits.get(at..at + 2).and_then(|pair| u8::from_str_radix(pair, 16).ok());
        byte.map_or(1.0, |byte| f32::from(byte) / 255.0)
    };
    Ok([channel(0), channel(2), channel(4), channel(6)])
}
