//! How the chains of a layer become strokes: where they are cut, how segments join and
//! end, and how a stroke changes along itself.

/// How the segments of a stroke meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
#[repr(u32)]
pub enum Join {
    /// An arc around the corner.
    #[default]
    Round = 0,
    /// The sides go on until they meet; sharp corners are round.
    Mitred = 1,
}

/// How a stroke ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
#[repr(u32)]
pub enum End {
    /// A half disk beyond its end.
    #[default]
    Round = 0,
    /// Straight across.
    Flat = 1,
    /// A triangle beyond its end, as long as the stroke is wide.
    Pointed = 2,
}

/// Mitres that would reach further than this many half widths are round. WGSL twin: the
/// constant of this name.
pub const MITRE_LIMIT: f32 = 4.0;

/// The number of values of a curve along a stroke.
pub const CURVE_LENGTH: usize = 8;

/// How the brush lies along a stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[non_exhaustive]
pub enum BrushFit {
    /// Whole repeats, anchored at the middle of the stroke.
    #[default]
    Tiled,
    /// Once, as long as the stroke.
    Stretched,
}

/// How edges are linked into strokes.
#[derive(Debug, Clone, PartialEq)]
pub struct LinkStyle {
    /// How segments meet.
    pub join: Join,
    /// How strokes end.
    pub end: End,
    /// Strokes are cut where they turn by more than this angle, in radians; an angle of more
    /// than half a turn cuts none. Contours are cut at their cusps in any case.
    pub corner_rad: f32,
    /// Whether a stroke ends where it is hidden, and a new one begins where it comes out;
    /// otherwise it goes on unseen.
    pub is_cut_where_hidden: bool,
    /// Shorter strokes fade, and those less than half as long are left out. `None` stands for
    /// the width: strokes shorter than wide are blots.
    pub min_length_px: Option<f32>,
    /// Longer strokes are cut into equal parts; 0 cuts none.
    pub max_length_px: f32,
    /// How the brush lies along strokes.
    pub brush_fit: BrushFit,
    /// Over how many pixels a stroke grows to its width at its start, and shrinks at its end.
    pub taper_px: [f32; 2],
    /// How far a stroke goes on beyond each of its ends.
    pub overshoot_px: f32,
    /// Factors of the width along a stroke, in even steps.
    pub width_curve: [f32; CURVE_LENGTH],
    /// Factors of the opacity along a stroke, in even steps.
    pub opacity_curve: [f32; CURVE_LENGTH],
    /// How far lines swing from their path: at the same places of the object in every view.
    pub wobble_px: f32,
    /// The wavelength of the swing, to within an octave.
    pub wobble_length_px: f32,
    /// How far strokes tremble around their path.
    pub jitter_px: f32,
    /// Another seed gives another tremble.
    pub seed: u16,
    /// Ink and gap of dashes; `None` for whole lines. Dashes go on where they are hidden,
    /// whatever `is_cut_where_hidden` says.
    pub dash_px: Option<[f32; 2]>,
}

impl Default for LinkStyle {
    /// Round joins and ends, cut at corners of 60 degrees and where hidden.
    fn default() -> Self {
        Self {
            join: Join::default(),
            end: End::default(),
            corner_rad: std::f32::consts::FRAC_PI_3,
            is_cut_where_hidden: true,
            min_length_px: None,
            max_length_px: 0.0,
            brush_fit: BrushFit::default(),
            taper_px: [0.0; 2],
            overshoot_px: 0.0,
            width_curve: [1.0; CURVE_LENGTH],
            opacity_curve: [1.0; CURVE_LENGTH],
            wobble_px: 0.0,
            wobble_length_px: 60.0,
            jitter_px: 0.0,
            seed: 0,
            dash_px: None,
        }
    }
}
