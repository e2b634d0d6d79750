//! What a picture looks like: a technique by name, with variables that can be
//! set.
//!
//! This is the small beginning of techniques, a few of them and in code; text
//! files that describe passes of components are to replace it, so nothing else
//! in the crate knows more of a technique than its [`Look`].
//!
//! Each class of edge has two styles, for what is visible and for what is hidden,
//! and the silhouette has one. `strokes.width=3` sets a variable of all visible
//! styles, `hidden.width=1` of all hidden ones, `ridge.width=2` and
//! `hidden-ridge.width=1` of one class.

use std::path::Path;

use edgemesh::build::Frame;
use edgemesh::command::{ExitStatus, Failure};
use edgemesh::oracle::feature::EdgeClass;
use edgemesh::oracle::stroke_quad::Placement;
use edgemesh::oracle::stroke_segment::{LineKind, Parameterization};
use strokes::brush::Brush;
use strokes::graph::path_style::{BrushFit, CURVE_LENGTH, End, Join, PathStyle};
use strokes::look::{Layer, Look, StrokeStyle, Width};

/// The techniques, by name, with what each shows.
pub const TECHNIQUES: [(&str, &str); 6] = [
    ("ink", "plain solid strokes over a flat white fill"),
    ("pen", "the strokes of a pen, textured along each edge"),
    ("charcoal", "broad grainy strokes"),
    ("watercolor", "wide translucent strokes with darker rims"),
    ("fur", "tufts of cartoon fur around the model, a pen in its valleys"),
    ("hidden-line", "solid lines where they are visible, dashes where they are hidden"),
];

/// The passes whose variables can be set.
pub const PASSES: [(&str, &str); 8] = [
    ("background", "color: the paper, #rrggbb or #rrggbbaa"),
    ("fill", "color: the surface, #rrggbb, or none to let what is behind show through"),
    ("creases", "ridge, valley: degrees between the faces from which an edge is one"),
    ("strokes", "the visible strokes of all classes"),
    ("hidden", "the hidden strokes of all classes"),
    ("CLASS", "visible strokes: contour, marked, boundary, material, smoothing, ridge, valley"),
    ("hidden-CLASS", "hidden strokes of one class"),
    ("silhouette", "strokes over the contours around the model"),
];

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
struct Switched {
    is_shown: bool,
    style: StrokeStyle,
    /// The colour before opacity.
    color: [f32; 4],
    opacity: f32,
    is_linked: bool,
    /// How, where they are linked.
    path: PathStyle,
}

impl Switched {
    fn new(is_shown: bool, style: StrokeStyle) -> Self {
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
    fn shown(&self, frame: &Frame) -> Option<StrokeStyle> {
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

/// A technique with its variables.
#[derive(Debug, Clone)]
pub struct Technique {
    background: [f32; 4],
    fill_color: Option<[f32; 4]>,
    /// Visible and hidden, in the order of [`EdgeClass::ALL`].
    classes: Vec<[Switched; 2]>,
    silhouette: Switched,
    /// Degrees.
    thresholds: Option<[f64; 2]>,
    /// The thresholds that meshes are built with.
    built_thresholds: [f64; 2],
}

impl Technique {
    /// The technique called `name`.
    ///
    /// # Errors
    /// Exit status 4, with the names there are.
    pub fn by_name(name: &str) -> Result<Self, Failure> {
        let style = StrokeStyle::default();
        let visible = Switched::new(true, style.clone());
        let mut hidden = Switched::new(false, style.clone());
        hidden.color = [0.5, 0.5, 0.5, 1.0];
        hidden.style.width = Width::Pixels(1.5);
        let mut technique = Self {
            background: [1.0; 4],
            fill_color: Some([1.0; 4]),
            classes: vec![[visible, hidden]; EdgeClass::ALL.len()],
            silhouette: Switched::new(false, style),
            thresholds: None,
            built_thresholds: [30.0; 2],
        };
        technique.silhouette.style.width = Width::Pixels(5.0);
        let Some(settings) = settings_of(name) else {
            let names: Vec<&str> = TECHNIQUES.iter().map(|(name, _)| *name).collect();
            let message = format!(
                "there is no technique '{name}'; there are: {} (technique files are not read yet)",
                names.join(", ")
            );
            return Err(Failure { message, status: ExitStatus::Shader });
        };
        for setting in settings {
            technique.set(setting)?;
        }
        Ok(technique)
    }

    /// Sets a variable from `PASS.VARIABLE=VALUE`.
    ///
    /// # Errors
    /// Exit status 2, with the variables there are or the values allowed; 1 where
    /// a brush cannot be read.
    pub fn set(&mut self, assignment: &str) -> Result<(), Failure> {
        let wrong = |what: &str| Failure::usage(format!("--set {assignment}: {what}"));
        let parts = assignment.split_once('=').and_then(|(path, value)| {
            path.trim().split_once('.').map(|(pass, variable)| (pass, variable, value.trim()))
        });
        let Some((pass, variable, value)) = parts else {
            return Err(wrong("needs the form PASS.VARIABLE=VALUE"));
        };
        match (pass, variable) {
            ("background", "color") => {
                self.background = parse_color(value).map_err(|e| wrong(&e))?
            }
            ("fill", "color") if value == "none" => self.fill_color = None,
            ("fill", "color") => self.fill_color = Some(parse_color(value).map_err(|e| wrong(&e))?),
            ("creases", "ridge" | "valley") => {
                let range = "needs degrees from 0 to 180";
                let degrees = parse_number(value, 0.0, 180.0).ok_or_else(|| wrong(range))?;
                let thresholds = self.thresholds.get_or_insert(self.built_thresholds);
                thresholds[usize::from(variable == "valley")] = f64::from(degrees);
            }
            ("background" | "fill" | "creases", _) => {
                let what = PASSES.iter().find(|(name, _)| *name == pass).map_or("", |pass| pass.1);
                return Err(wrong(&format!("{pass} has the variables {what}")));
            }
            _ => {
                let setting =
                    StrokeSetting::parse(variable, value).map_err(|failure| match failure {
                        SettingError::Wrong(what) => wrong(&what),
                        SettingError::Brush(failure) => failure,
                    })?;
                for style in self.styles_of(pass).map_err(|what| wrong(&what))? {
                    setting.apply(style);
                }
            }
        }
        Ok(())
    }

    /// The styles that a pass stands for.
    fn styles_of(&mut self, pass: &str) -> Result<Vec<&mut Switched>, String> {
        let (visibility, class) = match pass.split_once('-') {
            Some(("hidden", class)) => (1, Some(class)),
            _ if pass == "hidden" => (1, None),
            _ if pass == "strokes" => (0, None),
            _ if pass == "silhouette" => return Ok(vec![&mut self.silhouette]),
            _ => (0, Some(pass)),
        };
        let is_meant = |of: EdgeClass| class.is_none_or(|class| class == of.name());
        let styles: Vec<&mut Switched> = EdgeClass::ALL
            .into_iter()
            .zip(&mut self.classes)
            .filter(|(class, _)| is_meant(*class))
            .map(|(_, styles)| &mut styles[visibility])
            .collect();
        if styles.is_empty() {
            let names: Vec<&str> = PASSES.iter().map(|(name, _)| *name).collect();
            let classes: Vec<&str> = EdgeClass::ALL.iter().map(|class| class.name()).collect();
            return Err(format!(
                "there is no pass '{pass}'; there are: {}; CLASS is one of {}",
                names.join(", "),
                classes.join(", ")
            ));
        }
        Ok(styles)
    }

    /// Tells the thresholds that meshes are built with, in radians, so that
    /// `creases.ridge` alone leaves the valleys as they are.
    pub fn set_built_thresholds(&mut self, thresholds: [f64; 2]) {
        self.built_thresholds = thresholds.map(f64::to_degrees);
    }

    /// Leaves the paper out, so that the picture is transparent behind the model.
    pub const fn make_transparent(&mut self) {
        self.background = [0.0; 4];
    }

    /// The paper, premultiplied.
    #[must_use]
    pub fn background(&self) -> [f64; 4] {
        premultiplied(self.background).map(f64::from)
    }

    /// What the renderer draws of a model in `frame`.
    #[must_use]
    pub fn look(&self, frame: &Frame) -> Look {
        let mut layers: Vec<Layer> = Vec::new();
        for (class, styles) in EdgeClass::ALL.into_iter().zip(&self.classes) {
            let [visible, hidden] = [0, 1].map(|at| styles[at].shown(frame));
            if visible.is_none() && hidden.is_none() && !self.keeps_unseen(class) {
                continue;
            }
            let same =
                layers.iter_mut().find(|layer| layer.visible == visible && layer.hidden == hidden);
            match same {
                Some(layer) => layer.classes.push(class),
                None => layers.push(Layer { classes: vec![class], visible, hidden }),
            }
        }
        Look {
            fill_color: self.fill_color.map(premultiplied),
            layers,
            silhouette: self.silhouette.shown(frame),
            thresholds: self.thresholds.map(|thresholds| thresholds.map(f64::to_radians)),
        }
    }

    /// Contours that are not shown themselves are still needed for a silhouette.
    fn keeps_unseen(&self, class: EdgeClass) -> bool {
        class == EdgeClass::Contour && self.silhouette.is_shown
    }
}

/// How a technique differs from the plainest one.
fn settings_of(name: &str) -> Option<&'static [&'static str]> {
    Some(match name {
        "ink" => &[],
        // A pen's ragged rim takes ink away; a little more width gives it back.
        "pen" => &["strokes.width=3", "strokes.brush=pen", "silhouette.brush=pen"],
        "charcoal" => &[
            "strokes.width=7",
            "strokes.brush=charcoal",
            "strokes.color=#202020",
            "silhouette.brush=charcoal",
        ],
        "watercolor" => &[
            "strokes.width=14",
            "strokes.brush=watercolor",
            "strokes.color=#24507c",
            "strokes.parameterization=screen",
            "fill.color=#f4f1e8",
            "background.color=#fbfaf5",
            "silhouette.brush=watercolor",
        ],
        "fur" => &[
            "strokes.show=false",
            "contour.show=true",
            "contour.width=28",
            "contour.brush=fur",
            "contour.parameterization=screen",
            "boundary.show=true",
            "boundary.width=3",
            "boundary.brush=pen",
            "valley.show=true",
            "valley.width=3",
            "valley.brush=pen",
        ],
        "hidden-line" => &[
            "hidden.show=true",
            "hidden.brush=dash",
            "hidden.parameterization=screen",
            "hidden.placement=centred",
        ],
        _ => return None,
    })
}

/// A value for a variable of strokes.
enum StrokeSetting {
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

enum SettingError {
    Wrong(String),
    Brush(Failure),
}

impl From<String> for SettingError {
    fn from(what: String) -> Self {
        Self::Wrong(what)
    }
}

impl StrokeSetting {
    fn parse(variable: &str, value: &str) -> Result<Self, SettingError> {
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

    fn apply(&self, to: &mut Switched) {
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

fn parse_number(value: &str, least: f32, most: f32) -> Option<f32> {
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

fn premultiplied([r, g, b, a]: [f32; 4]) -> [f32; 4] {
    [r * a, g * a, b * a, a]
}

/// Reads `#rrggbb` or `#rrggbbaa` as sRGB values from 0 to 1.
fn parse_color(text: &str) -> Result<[f32; 4], String> {
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

#[cfg(test)]
mod tests {
    use super::*;

    fn technique(settings: &[&str]) -> Technique {
        let mut technique = Technique::by_name("ink").unwrap();
        for setting in settings {
            technique.set(setting).unwrap();
        }
        technique
    }

    fn layers(settings: &[&str]) -> Vec<Layer> {
        technique(settings).look(&Frame::default()).layers
    }

    #[test]
    fn every_listed_technique_is_there_and_draws() {
        for (name, _) in TECHNIQUES {
            let look = Technique::by_name(name).unwrap().look(&Frame::default());
            assert!(look.layers.iter().any(|layer| layer.visible.is_some()), "{name}");
        }
        let failure = Technique::by_name("oil").unwrap_err();
        assert_eq!(failure.status, ExitStatus::Shader);
        assert!(failure.message.contains("ink, pen"));
    }

    #[test]
    fn every_listed_variable_can_be_set_in_every_pass() {
        let value = |variable: &str| match variable {
            "show" => "true",
            "color" => "#10203040",
            "opacity" => "0.5",
            "width" => "5",
            "brush" => "dash",
            "parameterization" => "screen",
            "placement" => "inside",
            "kind" => "fin",
            "ends" => "disks",
            "fade" => "1,2",
            "linked" | "cut-hidden" => "true",
            "join" => "mitred",
            "corner" => "45",
            "min-length" | "max-length" | "overshoot" => "10",
            "fit" => "stretched",
            "taper" => "10,20",
            "width-curve" | "opacity-curve" => "0.2,1,0.5",
            "wobble" => "3,60",
            "jitter" | "seed" => "2",
            "dash" => "12,8",
            other => panic!("{other} has no value here"),
        };
        for pass in ["strokes", "hidden", "silhouette", "contour", "hidden-valley", "smoothing"] {
            for (variable, _) in STROKE_VARIABLES {
                technique(&[&format!("{pass}.{variable}={}", value(variable))]);
            }
        }
        technique(&["fill.color=none", "background.color=#fff000", "creases.ridge=20"]);
    }

    #[test]
    fn classes_that_look_alike_are_one_layer() {
        assert_eq!(layers(&[]).len(), 1);
        let two = layers(&["ridge.width=4"]);
        assert_eq!(two.len(), 2);
        assert_eq!(two[1].classes, [EdgeClass::Ridge]);
        let ridge_again = layers(&["ridge.width=4", "strokes.width=4"]);
        assert_eq!(ridge_again.len(), 1, "all are 4 wide now");
        assert_eq!(layers(&["strokes.show=false"]).len(), 0);
        let silhouette = layers(&["strokes.show=false", "silhouette.show=true"]);
        assert_eq!(silhouette[0].classes, [EdgeClass::Contour], "found, and not drawn");
        assert_eq!(layers(&["hidden.show=true"]).len(), 1);
        assert_eq!(layers(&["hidden-ridge.show=true"]).len(), 2);
    }

    #[test]
    fn units_of_the_model_go_by_its_frame() {
        let frame = Frame { scale: 0.5, ..Frame::default() };
        let technique = technique(&["strokes.width=3u", "strokes.fade=2,4", "ridge.width=3px"]);
        let look = technique.look(&frame);
        let style = look.layers[0].visible.as_ref().unwrap();
        assert_eq!((style.width, style.fade), (Width::World(1.5), Some([1.0, 2.0])));
        let ridge = look.layers[1].visible.as_ref().unwrap();
        assert_eq!(ridge.width, Width::Pixels(3.0));
    }

    #[test]
    fn one_threshold_leaves_the_other_as_built() {
        let mut technique = technique(&[]);
        assert_eq!(technique.look(&Frame::default()).thresholds, None);
        technique.set_built_thresholds([0.2, 0.3]);
        technique.set("creases.ridge=90").unwrap();
        let [ridge, valley] = technique.look(&Frame::default()).thresholds.unwrap();
        assert!((ridge - 90_f64.to_radians()).abs() < 1e-9 && (valley - 0.3).abs() < 1e-9);
    }

    #[test]
    fn wrong_assignments_say_what_is_right() {
        let mut technique = technique(&[]);
        for (assignment, word) in [
            ("strokes.width", "PASS.VARIABLE=VALUE"),
            ("width=2", "PASS.VARIABLE=VALUE"),
            ("strokes.width=wide", "number of pixels"),
            ("strokes.width=nan", "number of pixels"),
            ("strokes.width=-1u", "number of pixels"),
            ("strokes.widht=2", "width"),
            ("ridges.width=2", "ridge"),
            ("hidden-all.width=2", "hidden-CLASS"),
            ("fill.color=white", "#rrggbb"),
            ("fill.colour=#ffffff", "color"),
            ("fill.color=#ffé0", "#rrggbb"),
            ("contour.ends=square", "caps"),
            ("contour.fade=3,2", "distances"),
            ("contour.opacity=2", "0 to 1"),
            ("creases.ridge=200", "degrees"),
            ("strokes.brush=no/such.png", "charcoal"),
        ] {
            let message = technique.set(assignment).unwrap_err().message;
            assert!(message.contains(word), "{assignment}: {message}");
        }
    }

    #[test]
    fn colors_are_read_as_written() {
        assert_eq!(parse_color("#ff0000"), Ok([1.0, 0.0, 0.0, 1.0]));
        assert_eq!(parse_color("#00000000"), Ok([0.0; 4]));
    }
}
