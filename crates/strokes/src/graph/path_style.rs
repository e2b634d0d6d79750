//! How the chains of a layer become strokes: where they are cut, how segments join and
//! end, and how a stroke changes along itself.

/// How the segments of a stroke meet.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
#[repr(u32)]
pub enum Join {
    /// An arc around the corner.
    #[default]
    Round = 0,
    /// The sides go on until they meet; round where that would be far away.
    Mitred = 1,
}

/// How a stroke ends.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
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

/// Mitres that would reach further than so many half widths are round. WGSL twin: the
/// constant of this name.
pub const MITRE_LIMIT: f32 = 4.0;

/// How the brush lies along a stroke.
#[derive(Debug, Clone, Copy, PartialEq, Eq, Hash, Default)]
pub enum BrushFit {
    /// Whole repeats of it, held where the stroke has its middle.
    #[default]
    Tiled,
    /// Once, as long as the stroke.
    Stretched,
}

/// How edges are linked into strokes.
#[derive(Debug, Clone, PartialEq)]
pub struct PathStyle {
    /// How segments meet.
    pub join: Join,
    /// How strokes end.
    pub end: End,
    /// Strokes are cut where they turn by more than this angle, in radians; more than
    /// half a turn for never.
    pub corner_rad: f32,
    /// Whether a stroke ends where it is hidden and another begins where it comes out;
    /// else it goes on unseen.
    pub is_cut_where_hidden: bool,
    /// Shorter strokes fade, and those half as long are left out.
    pub min_length_px: f32,
    /// Longer strokes are cut into equal parts; 0 for never.
    pub max_length_px: f32,
    /// How the brush lies along them.
    pub brush_fit: BrushFit,
    /// Over how many pixels a stroke grows to its width, and shrinks again.
    pub taper_px: [f32; 2],
    /// How far a stroke goes on beyond both of its ends.
    pub overshoot_px: f32,
}

impl Default for PathStyle {
    /// Round joins and ends, cut at corners of 60 degrees and where hidden.
    fn default() -> Self {
        Self {
            join: Join::default(),
            end: End::default(),
            corner_rad: std::f32::consts::FRAC_PI_3,
            is_cut_where_hidden: true,
            min_length_px: 0.0,
            max_length_px: 0.0,
            brush_fit: BrushFit::default(),
            taper_px: [0.0; 2],
            overshoot_px: 0.0,
        }
    }
}
