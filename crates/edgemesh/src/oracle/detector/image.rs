//! Images for detectors.

use rayon::prelude::*;

/// Column and row, from the upper left. Outside of an image, the nearest texel counts.
pub type Texel = [isize; 2];

/// An image of texels in rows, from the upper left.
#[derive(Debug, Clone, PartialEq)]
pub struct Image<T> {
    width: usize,
    texels: Vec<T>,
}

impl<T: Copy + Sync> Image<T> {
    /// An image with rows of `width` texels; `None` unless there is at least one row and all are
    /// whole.
    #[must_use]
    pub fn new(width: usize, texels: Vec<T>) -> Option<Self> {
        let is_whole = width > 0 && !texels.is_empty() && texels.len().is_multiple_of(width);
        is_whole.then_some(Self { width, texels })
    }

    /// Width and height in texels.
    #[must_use]
    pub fn size(&self) -> [usize; 2] {
        [self.width, self.texels.len() / self.width]
    }

    /// All texels, row by row.
    #[must_use]
    pub fn texels(&self) -> &[T] {
        &self.texels
    }

    /// The texels of a row, or of the nearest row.
    pub(super) fn row(&self, row: isize) -> &[T] {
        let start = inside(row, self.size()[1]) * self.width;
        &self.texels[start..start + self.width]
    }

    /// The texel, or the nearest texel.
    #[must_use]
    pub fn at(&self, [column, row]: Texel) -> T {
        self.row(row)[inside(column, self.width)]
    }

    /// The texels at steps from a texel, or the nearest texels.
    pub(super) fn around<const N: usize>(&self, at: Texel, steps: [Texel; N]) -> [T; N] {
        steps.map(|[x, y]| self.at([at[0] + x, at[1] + y]))
    }

    /// An image with the value of `measure` at each texel; rows are computed in parallel.
    pub fn measured<U: Copy + Send + Sync>(&self, measure: impl Fn(Texel) -> U + Sync) -> Image<U> {
        let texels = (0..self.texels.len()).into_par_iter().with_min_len(self.width);
        let texels = texels.map(|index| {
            let [column, row] = [index % self.width, index / self.width];
            measure([column.cast_signed(), row.cast_signed()])
        });
        Image { width: self.width, texels: texels.collect() }
    }
}

/// Clamps an index to 0 to `count - 1`.
fn inside(index: isize, count: usize) -> usize {
    usize::try_from(index).unwrap_or(0).min(count - 1)
}

#[cfg(test)]
mod tests {
    use super::*;

    #[test]
    fn beyond_an_image_is_its_rim() {
        assert_eq!(Image::new(2, vec![1, 2, 3]), None);
        assert_eq!(Image::<u8>::new(2, Vec::new()), None);
        let Some(image) = Image::new(2, vec![1, 2, 3, 4]) else { panic!("two rows of two") };
        assert_eq!(image.size(), [2, 2]);
        assert_eq!(image.around([0, 0], [[-5, 0], [1, 0], [0, 9], [-1, -1]]), [1, 2, 3, 1]);
        let sums = image.measured(|at| image.at(at) + image.at([at[0] + 1, at[1]]));
        assert_eq!(sums.texels(), [3, 4, 7, 8]);
    }
}
