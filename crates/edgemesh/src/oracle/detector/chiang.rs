//! The detector of Chiang, Hsueh and Liu: the Sobel operator on the normal map and on the depth
//! map, and an extra filter that keeps only edges whose depth differs from that of their neighbors
//! (section III.C.1).
//!
//! Bands of rows are processed in parallel. A band converts its rows once, with a texel more at
//! either end: the bytes of the normal map to 16-bit integers, the depth map to floats. A line of
//! texels is then a sum of shifted slices of three rows, which the compiler vectorizes:
//!
//! ```text
//! smooth  = above + 2 center + below      x = smooth of the right - smooth of the left
//! differs = below - above                 y = differs of the left + 2 differs + of the right
//! ```
//!
//! Rejected: a closure for each texel, as in the other detectors, which is ten times as slow; two
//! passes of a separated kernel over whole images, whose intermediate images do not fit the cache.

use rayon::prelude::*;

use super::Image;
use super::depth::{DepthMapping, distance_of};

/// Thresholds of the detector.
#[derive(Debug, Clone, Copy, PartialEq)]
pub struct ChiangOptions {
    /// T of the normal map, with channels from 0 to 1.
    pub normal_threshold: f32,
    /// T of the depth map, with depths from 0 at the near end of the scene to 1 at its far end.
    pub depth_threshold: f32,
    /// Tz, the sum of differences in depth below which an edge is dropped; `None` disables the
    /// extra filter.
    pub extra_threshold: Option<f32>,
    /// Whether to sum the derivatives as printed, which misses edges from bright to dark, instead
    /// of their absolute values.
    pub is_as_printed: bool,
}

/// Number of rows in a band.
const BAND: usize = 16;
/// Bytes of a texel of the normal map.
const CHANNELS: usize = 4;

/// Detects edges: 1 at edges, 0 elsewhere; `None` if the images differ in size. `normals` are
/// colors with a normal in the first three channels, and `depths` those of the depth buffer.
#[must_use]
pub fn chiang(
    normals: &Image<[u8; CHANNELS]>,
    depths: &Image<f32>,
    mapping: &DepthMapping,
    options: &ChiangOptions,
) -> Option<Image<u8>> {
    let [width, height] = normals.size();
    if depths.size() != [width, height] {
        return None;
    }
    let mut edges = vec![0; width * height];
    edges.par_chunks_mut(BAND * width).enumerate().for_each(|(index, edges)| {
        let band = Band::new(normals, depths, mapping, index * BAND, edges.len() / width);
        for (row, edges) in edges.chunks_mut(width).enumerate() {
            band.detect(row, options, edges);
        }
    });
    Image::new(width, edges)
}

/// Rows of both maps, with a row more above and below and a texel more at either end.
struct Band {
    width: usize,
    normals: Vec<i16>,
    depths: Vec<f32>,
}

impl Band {
    fn new(
        normals: &Image<[u8; CHANNELS]>,
        depths: &Image<f32>,
        mapping: &DepthMapping,
        first: usize,
        count: usize,
    ) -> Self {
        let width = normals.size()[0];
        let padded = (count + 2) * (width + 2);
        let mut band = Self {
            width,
            normals: Vec::with_capacity(padded * CHANNELS),
            depths: Vec::with_capacity(padded),
        };
        let [near, far] = mapping.range;
        let per_range = 1.0 / (far - near);
        for row in 0..count + 2 {
            let row = (first + row).cast_signed() - 1;
            let (normals, depths) = (normals.row(row), depths.row(row));
            let ends = [normals[0], normals[width - 1]];
            band.normals.extend(ends[0].map(i16::from));
            band.normals.extend(normals.as_flattened().iter().map(|byte| i16::from(*byte)));
            band.normals.extend(ends[1].map(i16::from));
            let map = |depth: &f32| (distance_of(*depth, mapping) - near) * per_range;
            band.depths.push(map(&depths[0]));
            band.depths.extend(depths.iter().map(map));
            band.depths.push(map(&depths[width - 1]));
        }
        band
    }

    /// The row above, a row of the band, and the row below.
    fn rows<T>(values: &[T], row: usize, length: usize) -> [&[T]; 3] {
        [0, 1, 2].map(|down| &values[(row + down) * length..(row + down + 1) * length])
    }

    fn detect(&self, row: usize, options: &ChiangOptions, edges: &mut [u8]) {
        self.detect_normals(row, options, edges);
        self.detect_depths(row, options, edges);
    }

    fn detect_normals(&self, row: usize, options: &ChiangOptions, edges: &mut [u8]) {
        let [above, center, below] = Self::rows(&self.normals, row, (self.width + 2) * CHANNELS);
        let count = self.width * CHANNELS;
        let right = 2 * CHANNELS;
        let mut gradients = vec![0_i16; count];
        for (at, gradient) in gradients.iter_mut().enumerate() {
            let smooth = |at: usize| above[at] + 2 * center[at] + below[at];
            let differs = |at: usize| below[at] - above[at];
            let x = smooth(at + right) - smooth(at);
            let y = differs(at) + 2 * differs(at + CHANNELS) + differs(at + right);
            *gradient = if options.is_as_printed { x + y } else { x.abs() + y.abs() };
        }
        // In bytes: the least integer that reaches the threshold.
        #[expect(clippy::cast_possible_truncation, reason = "cut to the range of sums")]
        let threshold = (options.normal_threshold * 255.0).ceil().clamp(-4096.0, 4096.0) as i16;
        for (edge, gradient) in edges.iter_mut().zip(gradients.as_chunks::<CHANNELS>().0) {
            *edge = u8::from(gradient[0].max(gradient[1]).max(gradient[2]) >= threshold);
        }
    }

    fn detect_depths(&self, row: usize, options: &ChiangOptions, edges: &mut [u8]) {
        let [above, center, below] = Self::rows(&self.depths, row, self.width + 2);
        let extra_threshold = options.extra_threshold.unwrap_or(f32::NEG_INFINITY);
        for (at, edge) in edges.iter_mut().enumerate() {
            let [a, b, c] = [above, center, below].map(|row| [row[at], row[at + 1], row[at + 2]]);
            let x = a[2] - a[0] + 2.0 * (b[2] - b[0]) + c[2] - c[0];
            let y = c[0] - a[0] + 2.0 * (c[1] - a[1]) + c[2] - a[2];
            let gradient = if options.is_as_printed { x + y } else { x.abs() + y.abs() };
            let from = |depth: f32| (depth - b[1]).abs();
            let corners = from(a[0]) + from(a[2]) + from(c[0]) + from(c[2]);
            let around = corners + 2.0 * (from(a[1]) + from(b[0]) + from(b[2]) + from(c[1]));
            let is_edge = *edge | u8::from(gradient >= options.depth_threshold);
            *edge = is_edge & u8::from(around >= extra_threshold);
        }
    }
}

#[cfg(test)]
mod tests {
    use glam::{Vec3, Vec4};

    use super::super::Texel;
    use super::super::gradient::sobel;
    use super::*;

    /// What the paper says, texel by texel; how far the nearest threshold is as well.
    fn plain(
        normals: &Image<Vec4>,
        depths: &Image<f32>,
        options: &ChiangOptions,
        at: Texel,
    ) -> (bool, f32) {
        let sum = |x: f32, y: f32| if options.is_as_printed { x + y } else { x.abs() + y.abs() };
        let of_normals = sobel(normals, at);
        let channels = [0, 1, 2].map(|channel| sum(of_normals.x[channel], of_normals.y[channel]));
        let of_normals = Vec3::from(channels).max_element();
        let depth_vectors = depths.measured(|at| Vec4::splat(depths.at(at)));
        let of_depths = sobel(&depth_vectors, at);
        let of_depths = sum(of_depths.x.x, of_depths.y.x);
        let mut around = 0.0;
        for [x, y, weight] in [[1, 0, 2], [1, 1, 1], [0, 1, 2], [-1, 1, 1]] {
            for other in [[at[0] + x, at[1] + y], [at[0] - x, at[1] - y]] {
                let weight = if weight == 2 { 2.0 } else { 1.0 };
                around += weight * (depths.at(other) - depths.at(at)).abs();
            }
        }
        let margins = [
            of_normals - options.normal_threshold,
            of_depths - options.depth_threshold,
            options.extra_threshold.map_or(1.0, |threshold| around - threshold),
        ];
        let is_edge = (margins[0] >= 0.0 || margins[1] >= 0.0) && margins[2] >= 0.0;
        (is_edge, margins.into_iter().map(f32::abs).fold(1.0, f32::min))
    }

    #[test]
    fn fast_is_as_plain() {
        let mut state = 7_u32;
        let mut random = || {
            state = state.wrapping_mul(1_664_525).wrapping_add(1_013_904_223);
            state >> 24
        };
        // More rows than a band has, and a last band that is not whole.
        let [width, height] = [23, 2 * BAND + 5];
        let bytes: Vec<[u8; 4]> =
            (0..width * height).map(|_| [0; 4].map(|_| random().to_le_bytes()[0])).collect();
        let depths: Vec<f32> = bytes.iter().map(|bytes| f32::from(bytes[3]) / 255.0).collect();
        let colors = bytes.iter().map(|bytes| Vec4::from(bytes.map(f32::from)) / 255.0).collect();
        let (Some(normals), Some(depths), Some(colors)) =
            (Image::new(width, bytes), Image::new(width, depths), Image::new(width, colors))
        else {
            panic!("whole rows");
        };
        // An orthographic view from 0 to 1 whose depth is 1 there.
        let mapping = DepthMapping { projection: [-1.0, 1.0, 0.0, 1.0], range: [0.0, 1.0] };
        let distances = depths.measured(|at| distance_of(depths.at(at), &mapping));
        for (is_as_printed, extra_threshold) in [(false, None), (true, None), (false, Some(3.0))] {
            let options = ChiangOptions {
                normal_threshold: 1.7,
                depth_threshold: 1.9,
                extra_threshold,
                is_as_printed,
            };
            let Some(found) = chiang(&normals, &depths, &mapping, &options) else {
                panic!("of one size");
            };
            let mut edges = 0;
            for (index, found) in found.texels().iter().enumerate() {
                let at = [(index % width).cast_signed(), (index / width).cast_signed()];
                let (is_edge, margin) = plain(&colors, &distances, &options, at);
                assert!((*found == 1) == is_edge || margin < 1e-4, "{at:?}: {options:?}");
                edges += u32::from(is_edge);
            }
            assert!((100..800).contains(&edges), "{edges} edges");
        }
        let smaller = Image::new(1, vec![0.0]);
        let options = ChiangOptions {
            normal_threshold: 0.0,
            depth_threshold: 0.0,
            extra_threshold: None,
            is_as_printed: false,
        };
        assert_eq!(smaller.and_then(|depths| chiang(&normals, &depths, &mapping, &options)), None);
    }
}
