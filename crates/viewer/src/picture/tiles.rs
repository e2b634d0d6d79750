//! Pictures of any size: what is too large for a texture is drawn in parts.
//!
//! ```text
//!   +----------+----------+---     each part is drawn with a margin around it, so that
//!   |  +- - - -|- -+      |        what looks at its neighbourhood (detectors, wide
//!   |  | part 1|   |part 2|        lines, blurs) finds in it what it finds in the whole
//!   +--|-------+---|------+---
//!      +- - - - - -+
//! ```
//!
//! Where strokes are linked, the whole picture is drawn before them as large as one part.
//! Its depth tells all parts alike where those strokes are seen, so that they begin, end
//! and taper at the same places everywhere.
//!
//! Rejected: drawing large and cutting with a viewport, since a viewport may not be
//! larger than a texture either.

use edgemesh::view::Camera;
use image::RgbaImage;
use strokes::draw::targets::Targets;
use strokes::gpu::device::Gpu;
use strokes::view::tile::Tile;

use crate::error::Error;
use crate::picture::renderer::{FrameStatistics, PictureOptions, PictureRenderer};
use crate::scene::models::Scene;
use crate::technique::Technique;
use crate::technique::core::CoreComponent;
use crate::technique::core_view::Strokes;
use crate::technique::pass::Pass;

/// The most pixels that a part has a side, with its margins.
pub const MAX_PART_PX: u32 = 4096;

/// How far a part is drawn beyond what is taken of it, in pixels.
pub const MARGIN_PX: u32 = 256;

/// Parts begin at multiples of this, so that textures of a part's halves and quarters lie
/// as those of the whole.
const STEP_PX: u32 = 64;

/// A picture that needs more memory on the GPU than this, in bytes, is drawn in parts.
const MAX_BYTES: u64 = 2 << 30;

/// Draws pictures of any size.
#[derive(Debug)]
pub struct AnySizeRenderer {
    gpu: Gpu,
    kind: Kind,
    size: [u32; 2],
    max_part_px: u32,
}

#[derive(Debug)]
enum Kind {
    Whole(Box<PictureRenderer>),
    Parts {
        part: Box<PictureRenderer>,
        /// Where strokes are linked.
        overview: Option<Box<PictureRenderer>>,
        layout: PartLayout,
    },
}

/// Is told how many parts are done, of how many; an error ends the picture.
pub type Progress<'a> = &'a mut dyn FnMut(u32, u32) -> Result<(), Error>;

impl AnySizeRenderer {
    /// As [`PictureRenderer::new`], for a picture of any size.
    ///
    /// # Errors
    /// As there; the picture cannot be too large.
    pub fn new(
        gpu: &Gpu,
        scene: &Scene,
        technique: &Technique,
        looks: &[Technique],
        options: &PictureOptions,
    ) -> Result<Self, Error> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let fits = options.size.iter().all(|&side| side <= limit)
            && Targets::byte_count(options.size, options.samples) <= MAX_BYTES;
        let max_part_px = if fits { u32::MAX } else { limit.min(MAX_PART_PX) };
        Self::with_parts(gpu, scene, technique, looks, options, max_part_px)
    }

    /// The same in parts of at most so many pixels a side, margins and all; at once where
    /// the picture is not larger.
    ///
    /// # Errors
    /// As [`PictureRenderer::new`].
    pub fn with_parts(
        gpu: &Gpu,
        scene: &Scene,
        technique: &Technique,
        looks: &[Technique],
        options: &PictureOptions,
        max_part_px: u32,
    ) -> Result<Self, Error> {
        let renderer = |size| {
            let options = PictureOptions { size, ..options.clone() };
            PictureRenderer::new(gpu, scene, technique, looks, &options).map(Box::new)
        };
        let size = options.size;
        let kind = if size.iter().all(|&side| side <= max_part_px) {
            Kind::Whole(renderer(size)?)
        } else {
            let layout = PartLayout::new(size, max_part_px);
            Kind::Parts {
                part: renderer(layout.part)?,
                overview: links_strokes(technique, looks)
                    .then(|| renderer(overview_size(size, max_part_px)))
                    .transpose()?,
                layout,
            }
        };
        Ok(Self { gpu: gpu.clone(), kind, size, max_part_px })
    }

    /// As [`PictureRenderer::reload`]; the size stays.
    ///
    /// # Errors
    /// As there.
    pub fn reload(
        &mut self,
        scene: &Scene,
        technique: &Technique,
        looks: &[Technique],
        options: &PictureOptions,
    ) -> Result<(), Error> {
        let reload = |renderer: &mut PictureRenderer| {
            let options = PictureOptions { size: renderer.options().size, ..options.clone() };
            renderer.reload(scene, technique, looks, &options)
        };
        let is_linked = links_strokes(technique, looks);
        match &mut self.kind {
            Kind::Parts { part, overview: Some(overview), .. } => {
                reload(part)?;
                reload(overview)
            }
            // Strokes that are linked from now on ask for an overview.
            Kind::Parts { .. } if is_linked => {
                let options = PictureOptions { size: self.size, ..options.clone() };
                let (gpu, most) = (self.gpu.clone(), self.max_part_px);
                *self = Self::with_parts(&gpu, scene, technique, looks, &options, most)?;
                Ok(())
            }
            Kind::Whole(part) | Kind::Parts { part, .. } => reload(part),
        }
    }

    /// Draws one picture, with premultiplied alpha. Times of parts are added up.
    ///
    /// # Errors
    /// Where the device is lost, an image cannot be read, there is no memory for the
    /// picture, or `progress` says so.
    pub fn render(
        &mut self,
        camera: &Camera,
        progress: Progress,
    ) -> Result<(RgbaImage, FrameStatistics), Error> {
        let (part, overview, layout) = match &mut self.kind {
            Kind::Whole(renderer) => return renderer.render(camera),
            Kind::Parts { part, overview, layout } => (part, overview, layout),
        };
        let mut picture = empty_picture(self.size)?;
        let view = part.view(camera, self.size);
        if let Some(overview) = overview {
            overview.draw_overview(&view)?;
        }
        let mut sum: Option<FrameStatistics> = None;
        let places = layout.places();
        let total = edgemesh::index::to_u32(places.len());
        for (done, place) in (0..).zip(&places) {
            progress(done, total)?;
            let (drawn, statistics) =
                part.render_part(&view, layout.part_at(place), overview.as_deref())?;
            let cut = [place.kept[0] - place.drawn[0], place.kept[1] - place.drawn[1]];
            let [width, height] = place.size;
            let kept = image::imageops::crop_imm(&drawn, cut[0], cut[1], width, height);
            let [left, top] = place.kept.map(i64::from);
            image::imageops::replace(&mut picture, &*kept, left, top);
            sum = Some(match sum {
                None => statistics,
                Some(sum) => sum.plus(statistics),
            });
        }
        progress(total, total)?;
        let statistics = sum.ok_or_else(|| Error::Internal("a picture without parts".into()))?;
        Ok((picture, statistics))
    }
}

/// Whether any strokes that are drawn are linked.
fn links_strokes(technique: &Technique, looks: &[Technique]) -> bool {
    let passes = std::iter::once(technique).chain(looks).flat_map(|look| &look.passes);
    let is_linked = |pass: &Pass| {
        pass.component.core == CoreComponent::Strokes
            && pass.is_rendered()
            && Strokes::of(pass).is_ok_and(|view| view.is_linked)
    };
    passes.into_iter().any(is_linked)
}

/// How a picture is cut.
#[derive(Debug, Clone, PartialEq)]
struct PartLayout {
    picture: [u32; 2],
    /// The size that is drawn.
    part: [u32; 2],
    /// From one part to the next.
    step: [u32; 2],
}

/// Where a part lies, in pixels from the upper left corner of the picture.
#[derive(Debug, Clone, PartialEq)]
struct PartPlace {
    /// The corner of what is drawn.
    drawn: [u32; 2],
    /// The corner of what is taken of it.
    kept: [u32; 2],
    /// The size of what is taken of it.
    size: [u32; 2],
}

impl PartLayout {
    fn new(picture: [u32; 2], max_part_px: u32) -> Self {
        let inner = max_part_px.saturating_sub(2 * MARGIN_PX) / STEP_PX * STEP_PX;
        let step = inner.max(STEP_PX);
        let is_cut = picture.map(|side| side > max_part_px);
        Self {
            picture,
            part: [0, 1].map(|axis| match is_cut[axis] {
                true => step + 2 * MARGIN_PX,
                false => picture[axis],
            }),
            step: [0, 1].map(|axis| if is_cut[axis] { step } else { picture[axis] }),
        }
    }

    /// Row by row.
    fn places(&self) -> Vec<PartPlace> {
        let [columns, rows] = [0, 1].map(|axis| self.picture[axis].div_ceil(self.step[axis]));
        let place = |column, row| {
            let at = [column, row];
            let kept: [u32; 2] = [0, 1].map(|axis: usize| at[axis] * self.step[axis]);
            PartPlace {
                drawn: kept.map(|side| side.saturating_sub(MARGIN_PX)),
                kept,
                size: [0, 1].map(|axis| self.step[axis].min(self.picture[axis] - kept[axis])),
            }
        };
        (0..rows).flat_map(|row| (0..columns).map(move |column| place(column, row))).collect()
    }

    fn part_at(&self, place: &PartPlace) -> Tile {
        #[expect(clippy::cast_precision_loss, reason = "pictures have fewer pixels a side")]
        let px = |[x, y]: [u32; 2]| glam::Vec2::new(x as f32, y as f32);
        Tile { picture_px: px(self.picture), corner_px: px(place.drawn), size_px: px(self.part) }
    }
}

/// A picture of the same shape, of at most so many pixels a side.
fn overview_size(size: [u32; 2], max_px: u32) -> [u32; 2] {
    let largest = u64::from(size[0].max(size[1]).max(1));
    size.map(|side| {
        let scaled = u64::from(side) * u64::from(max_px) / largest;
        u32::try_from(scaled).unwrap_or(max_px).clamp(1, side.max(1))
    })
}

/// A picture of nothing, where there is memory for it.
fn empty_picture(size: [u32; 2]) -> Result<RgbaImage, Error> {
    let [width, height] = size;
    let too_large = || Error::NoMemoryForPicture { size };
    let bytes = u64::from(width) * u64::from(height);
    let bytes = bytes.checked_mul(4).and_then(|bytes| usize::try_from(bytes).ok());
    let bytes = bytes.ok_or_else(too_large)?;
    let mut texels: Vec<u8> = Vec::new();
    texels.try_reserve_exact(bytes).map_err(|_| too_large())?;
    texels.resize(bytes, 0);
    RgbaImage::from_raw(width, height, texels).ok_or_else(too_large)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn parts_cover_every_pixel_once() {
        for (size, max_px) in [([1500, 1100], 768), ([900, 5000], 1024), ([641, 1300], 640)] {
            let layout = PartLayout::new(size, max_px);
            let mut covered = vec![0_u8; (size[0] * size[1]) as usize];
            for place in layout.places() {
                let ends = [0, 1].map(|axis| place.kept[axis] + place.size[axis]);
                assert!(place.drawn[0] <= place.kept[0] && place.drawn[1] <= place.kept[1]);
                assert!(ends[0] <= size[0] && ends[1] <= size[1], "{place:?}");
                let drawn = [0, 1].map(|axis| place.drawn[axis] + layout.part[axis]);
                assert!(ends[0] <= drawn[0] && ends[1] <= drawn[1], "{place:?}");
                for y in place.kept[1]..place.kept[1] + place.size[1] {
                    for x in place.kept[0]..place.kept[0] + place.size[0] {
                        covered[(y * size[0] + x) as usize] += 1;
                    }
                }
            }
            assert!(covered.iter().all(|&count| count == 1), "{size:?}");
        }
    }

    #[test]
    fn an_overview_has_the_shape_of_the_picture() {
        assert_eq!(overview_size([20_000, 10_000], 4096), [4096, 2048]);
        assert_eq!(overview_size([20_000, 1], 4096), [4096, 1]);
    }

    #[test]
    fn a_picture_that_no_memory_holds_is_told() {
        let error = empty_picture([u32::MAX; 2]).unwrap_err();
        assert!(matches!(error, Error::NoMemoryForPicture { .. }), "{error:?}");
        assert!(error.to_string().contains("4294967295x4294967295"), "{error}");
    }
}
