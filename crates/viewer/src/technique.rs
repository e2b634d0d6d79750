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

use edgemesh::build::Frame;
use edgemesh::command::{ExitStatus, Failure};
use edgemesh::oracle::feature::EdgeClass;
use strokes::look::{Layer, Look, StrokeStyle, Width};

use crate::stroke_setting::{SettingError, StrokeSetting, Switched, parse_color, parse_number};

/// The techniques, by name, with what each shows.
pub const TECHNIQUES: [(&str, &str); 7] = [
    ("ink", "plain solid strokes over a flat white fill"),
    ("pen", "the strokes of a pen, textured along each edge"),
    ("charcoal", "broad grainy strokes"),
    ("watercolor", "wide translucent strokes with darker rims"),
    ("fur", "tufts of cartoon fur around the model, a pen in its valleys"),
    ("hidden-line", "solid lines where they are visible, dashes where they are hidden"),
    ("linked", "edges linked into long strokes that grow and shrink"),
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
        "linked" => &[
            "strokes.linked=true",
            "hidden.linked=true",
            "silhouette.linked=true",
            "strokes.width=5",
            "strokes.taper=30",
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

pub(crate) fn premultiplied([r, g, b, a]: [f32; 4]) -> [f32; 4] {
    [r * a, g * a, b * a, a]
}

#[cfg(test)]
mod tests {
    use super::*;
    use crate::stroke_setting::STROKE_VARIABLES;

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
