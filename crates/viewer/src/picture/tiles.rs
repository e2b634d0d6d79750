//! Pictures of any size: one that is too large for a texture is drawn in tiles.
//!
//! ```text
//!   +----------+----------+---     Each tile is drawn with a margin, so that passes that
//!   |  +- - - -|- -+      |        read neighboring pixels (detectors, wide lines, blurs)
//!   |  | tile 1|   |tile 2|        find the same pixels as in the whole picture.
//!   +--|-------+---|------+---
//!      +- - - - - -+
//! ```
//!
//! If strokes are linked, the whole picture is first drawn in the size of one tile. Its
//! depth decides for all tiles where those strokes are visible, so that they begin, end
//! and taper at the same places in every tile.
//!
//! Rejected: drawing large and cutting with a viewport, since a viewport may not be
//! larger than a texture either.

use edgemesh::view::Camera;
use image::RgbaImage;
use strokes::{Gpu, Targets, Tile};

use crate::error::Error;
use crate::picture::renderer::{
    Emptiness, FrameStatistics, PictureInput, PictureOptions, PictureRenderer,
};
use crate::technique::core::CoreComponent;
use crate::technique::core_view::Strokes;
use crate::technique::pass::Pass;

/// The longest side of a tile in pixels, including its margins.
const MAX_TILE_PX: u32 = 4096;

/// The margin on each side of a tile, in pixels.
const MARGIN_PX: u32 = 256;

/// Tiles begin at multiples of this, so that the texels of textures of half and quarter
/// size lie where those of the whole picture do.
const STEP_PX: u32 = 64;

/// A picture that needs more GPU memory than this, in bytes, is drawn in tiles.
const MAX_BYTES: u64 = 2 << 30;

/// Draws pictures of any size.
#[derive(Debug)]
pub struct AnySizeRenderer {
    gpu: Gpu,
    kind: Kind,
    size: [u32; 2],
    max_tile_px: u32,
}

#[derive(Debug)]
enum Kind {
    Whole(Box<PictureRenderer>),
    Tiles {
        tile: Box<PictureRenderer>,
        /// Draws the whole picture, if strokes are linked.
        overview: Option<Box<PictureRenderer>>,
        layout: TileLayout,
    },
}

/// Receives the number of tiles that are done and of all tiles, before each tile and after
/// the last. An error cancels the picture. Never called for a picture drawn at once.
pub type Progress<'a> = &'a mut dyn FnMut(u32, u32) -> Result<(), Error>;

impl AnySizeRenderer {
    /// As [`PictureRenderer::new`], for a picture of any size.
    ///
    /// # Errors
    /// As [`PictureRenderer::new`], but no size is too large.
    pub(crate) fn new(
        gpu: &Gpu,
        input: PictureInput,
        options: &PictureOptions,
    ) -> Result<Self, Error> {
        let limit = gpu.device.limits().max_texture_dimension_2d;
        let fits = options.size.iter().all(|&side| side <= limit)
            && Targets::byte_count(options.size, options.samples) <= MAX_BYTES;
        let max_tile_px = if fits { u32::MAX } else { limit.min(MAX_TILE_PX) };
        Self::with_tiles(gpu, input, options, max_tile_px)
    }

    /// As [`PictureRenderer::new`], for tiles with sides of at most `max_tile_px` pixels,
    /// including margins; at once if the picture is no larger.
    ///
    /// # Errors
    /// As [`PictureRenderer::new`].
    pub fn with_tiles(
        gpu: &Gpu,
        input: PictureInput,
        options: &PictureOptions,
        max_tile_px: u32,
    ) -> Result<Self, Error> {
        let renderer = |size| {
            let options = PictureOptions { size, ..options.clone() };
            PictureRenderer::new(gpu, input, &options).map(Box::new)
        };
        let size = options.size;
        let kind = if size.iter().all(|&side| side <= max_tile_px) {
            Kind::Whole(renderer(size)?)
        } else {
            let layout = TileLayout::new(size, max_tile_px);
            Kind::Tiles {
                tile: renderer(layout.tile)?,
                overview: links_strokes(input)
                    .then(|| renderer(overview_size(size, max_tile_px)))
                    .transpose()?,
                layout,
            }
        };
        Ok(Self { gpu: gpu.clone(), kind, size, max_tile_px })
    }

    /// As [`PictureRenderer::reload`]; the size stays.
    ///
    /// # Errors
    /// As [`PictureRenderer::reload`].
    pub fn reload(&mut self, input: PictureInput, options: &PictureOptions) -> Result<(), Error> {
        let reload = |renderer: &mut PictureRenderer| {
            let options = PictureOptions { size: renderer.options().size, ..options.clone() };
            renderer.reload(input, &options)
        };
        let is_linked = links_strokes(input);
        match &mut self.kind {
            Kind::Tiles { tile, overview: Some(overview), .. } => {
                reload(tile)?;
                reload(overview)
            }
            // Strokes that are now linked need an overview.
            Kind::Tiles { .. } if is_linked => {
                let options = PictureOptions { size: self.size, ..options.clone() };
                let (gpu, most) = (self.gpu.clone(), self.max_tile_px);
                *self = Self::with_tiles(&gpu, input, &options, most)?;
                Ok(())
            }
            Kind::Whole(renderer) | Kind::Tiles { tile: renderer, .. } => reload(renderer),
        }
    }

    /// Why a picture that this renderer drew is of one color; `None` if it is not, or if there is
    /// nothing in the scene.
    pub(crate) fn why_empty(&self, picture: &RgbaImage, camera: &Camera) -> Option<Emptiness> {
        let (Kind::Whole(renderer) | Kind::Tiles { tile: renderer, .. }) = &self.kind;
        if is_of_one_color(picture) { renderer.why_empty(camera, self.size) } else { None }
    }

    /// Draws one picture, with premultiplied alpha. The times are sums over the tiles.
    ///
    /// # Errors
    /// If the device is lost, an image cannot be read, memory does not hold the picture, or
    /// `progress` fails.
    pub fn render(
        &mut self,
        camera: &Camera,
        progress: Progress,
    ) -> Result<(RgbaImage, FrameStatistics), Error> {
        let (tile, overview, layout) = match &mut self.kind {
            Kind::Whole(renderer) => return renderer.render(camera),
            Kind::Tiles { tile, overview, layout } => (tile, overview, layout),
        };
        let mut picture = empty_picture(self.size)?;
        let view = tile.view(camera, self.size);
        if let Some(overview) = overview {
            overview.draw_overview(&view)?;
        }
        let mut sum: Option<FrameStatistics> = None;
        let places = layout.places();
        let total = edgemesh::index::to_u32(places.len());
        for (done, place) in (0..).zip(&places) {
            progress(done, total)?;
            let (drawn, statistics) =
                tile.render_tile(&view, layout.tile_at(place), overview.as_deref())?;
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
        let statistics = sum.ok_or_else(|| Error::Internal("a picture without tiles".into()))?;
        Ok((picture, statistics))
    }
}

/// Whether all pixels of a picture have one color.
fn is_of_one_color(picture: &RgbaImage) -> bool {
    let mut pixels = picture.pixels();
    pixels.next().is_none_or(|first| pixels.all(|pixel| pixel == first))
}

/// Whether any rendered pass of strokes links them.
fn links_strokes(input: PictureInput) -> bool {
    let techniques = std::iter::once(input.technique).chain(input.overrides);
    let passes = techniques.flat_map(|technique| &technique.passes);
    let is_linked = |pass: &Pass| {
        pass.component.core == CoreComponent::Strokes
            && pass.is_rendered()
            && Strokes::of(pass).is_ok_and(|view| view.is_linked)
    };
    passes.into_iter().any(is_linked)
}

/// How a picture is cut into tiles; sizes in pixels.
#[derive(Debug, Clone, PartialEq)]
struct TileLayout {
    picture: [u32; 2],
    /// Size of a tile, including its margins.
    tile: [u32; 2],
    /// Distance from one tile to the next.
    step: [u32; 2],
}

/// The place of a tile, in pixels from the upper left corner of the picture.
#[derive(Debug, Clone, PartialEq)]
struct TilePlace {
    /// Corner of the tile, including its margins.
    drawn: [u32; 2],
    /// Corner without the margins.
    kept: [u32; 2],
    /// Size without the margins.
    size: [u32; 2],
}

impl TileLayout {
    fn new(picture: [u32; 2], max_tile_px: u32) -> Self {
        let inner = max_tile_px.saturating_sub(2 * MARGIN_PX) / STEP_PX * STEP_PX;
        let step = inner.max(STEP_PX);
        let is_cut = picture.map(|side| side > max_tile_px);
        Self {
            picture,
            tile: [0, 1].map(|axis| match is_cut[axis] {
                true => step + 2 * MARGIN_PX,
                false => picture[axis],
            }),
            step: [0, 1].map(|axis| if is_cut[axis] { step } else { picture[axis] }),
        }
    }

    /// The tiles, row by row.
    fn places(&self) -> Vec<TilePlace> {
        let [columns, rows] = [0, 1].map(|axis| self.picture[axis].div_ceil(self.step[axis]));
        let place = |column, row| {
            let at = [column, row];
            let kept: [u32; 2] = [0, 1].map(|axis: usize| at[axis] * self.step[axis]);
            TilePlace {
                drawn: kept.map(|side| side.saturating_sub(MARGIN_PX)),
                kept,
                size: [0, 1].map(|axis| self.step[axis].min(self.picture[axis] - kept[axis])),
            }
        };
        (0..rows).flat_map(|row| (0..columns).map(move |column| place(column, row))).collect()
    }

    fn tile_at(&self, place: &TilePlace) -> Tile {
        #[expect(clippy::cast_precision_loss, reason = "pictures have fewer pixels a side")]
        let px = |[x, y]: [u32; 2]| glam::Vec2::new(x as f32, y as f32);
        Tile { picture_px: px(self.picture), corner_px: px(place.drawn), size_px: px(self.tile) }
    }
}

/// The size of a picture of the same shape with sides of at most `max_px` pixels.
fn overview_size(size: [u32; 2], max_px: u32) -> [u32; 2] {
    let largest = u64::from(size[0].max(size[1]).max(1));
    size.map(|side| {
        let scaled = u64::from(side) * u64::from(max_px) / largest;
        u32::try_from(scaled).unwrap_or(max_px).clamp(1, side.max(1))
    })
}

/// A transparent picture; an error if memory does not hold it.
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
    fn tiles_cover_every_pixel_once() {
        for (size, max_px) in [([1500, 1100], 768), ([900, 5000], 1024), ([641, 1300], 640)] {
            let layout = TileLayout::new(size, max_px);
            let mut covered = vec![0_u8; (size[0] * size[1]) as usize];
            for place in layout.places() {
                let ends = [0, 1].map(|axis| place.kept[axis] + place.size[axis]);
                assert!(place.drawn[0] <= place.kept[0] && place.drawn[1] <= place.kept[1]);
                assert!(ends[0] <= size[0] && ends[1] <= size[1], "{place:?}");
                let drawn = [0, 1].map(|axis| place.drawn[axis] + layout.tile[axis]);
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
